//! Shell, walls, chambers and turns; what is bored comes from [`super::bores`].

use crate::bores;
use crate::draw::Draw;
use crate::drawing::{Drawing, Section};
use serde_json::{Value, json};

/// What the holes must know of the chambers.
pub(crate) struct Interior {
    /// Shell on suction and pressure side, mm (the thicker end of a law).
    pub(crate) shell: [f64; 2],
    /// Fillet radius, mm.
    pub(crate) fillet: f64,
    /// Walls: position, angle in degrees, thickness.
    pub(crate) walls: Vec<[f64; 3]>,
    /// Chambers from front to back: name and the span fractions that are surely straight.
    pub(crate) chambers: Vec<(String, [f64; 2])>,
    /// Camber fractions at which the first chamber begins and the last one ends.
    pub(crate) ends: [f64; 2],
}

/// A law: constant, or changing by up to a share from hub to tip.
fn law(draw: &mut Draw, value: f64, share: f64) -> (Value, f64) {
    if draw.once_in(2) {
        return (json!(value), value);
    }
    let ends = [value, value * (1.0 - draw.between(0.0, share))];
    let law = match draw.below(3) {
        0 => json!([[0, ends[0]], [1, ends[1]]]),
        1 => json!([[0, ends[0]], [0.5, draw.between(ends[1], ends[0])], [1, ends[1]]]),
        _ => json!([[0, ends[1]], [1, ends[0]]]),
    };
    (law, ends[0])
}

/// The whole of `cooling`.
pub(crate) fn cooling(draw: &mut Draw, drawing: &Drawing) -> Value {
    // One in eight has radial holes alone.
    if draw.once_in(8) {
        return bores::radial_holes_alone(draw, drawing);
    }
    let room = 2.0 * drawing.least(Section::greatest_radius);
    // Walls of 0.8 to 2 mm, as long as half of the thickest part is left to flow.
    let most = (0.25 * room).clamp(0.8, 2.0);
    let (suction, shell_s) = {
        let t = draw.between(0.8, most);
        law(draw, t, 0.25)
    };
    let (pressure, shell_p) = {
        let t = draw.between(0.8, most);
        law(draw, t, 0.25)
    };
    let fillet = draw.between(0.3, 1.0f64.min(0.15 * room).max(0.31));
    let least_room = shell_s + shell_p + 2.0 * fillet + 0.4;
    let mut cooling = json!({ "shell": { "suction_side": suction, "pressure_side": pressure } });
    let tip = draw.between(0.8, 2.0);
    cooling["shell"]["tip"] = json!(tip);
    let Some(ends) = drawing.thicker(least_room) else {
        return bores::radial_holes_alone(draw, drawing);
    };
    let length = drawing.least(|s| s.length) * (ends[1] - ends[0]);
    let thickness = draw.between(0.8, 2.0);
    // A chamber is at least 3 mm long, and its fillets fit.
    let least_length = (3.0f64).max(2.5 * fillet + 1.0);
    let greatest = ((length + thickness) / (least_length + thickness)).floor().clamp(1.0, 7.0) as usize;
    let count = 1 + draw.below(greatest);
    let names = ["a", "b", "c", "d", "e", "f", "g"];
    let mean = length / count as f64;
    let slack = (mean - thickness - least_length).max(0.0);
    let angle = draw.between(70.0, 110.0);
    let mut walls = Vec::new();
    let mut documents = Vec::new();
    for k in 1..count {
        let place = ends[0] + (ends[1] - ends[0]) * k as f64 / count as f64;
        let jitter = 0.25 * slack.min(0.5 * mean) / drawing.least(|s| s.length);
        let place = place + draw.between(-jitter, jitter);
        let own = angle + draw.between(-4.0, 4.0);
        let (thick, most) = law(draw, thickness, 0.2);
        let place_law = if draw.once_in(2) {
            json!(place)
        } else {
            json!([[0, place], [1, place + 0.3 * draw.between(-jitter, jitter)]])
        };
        let angle_law =
            if draw.once_in(2) { json!(own) } else { json!([[0, own], [1, own + draw.between(-6.0, 6.0)]]) };
        documents.push(json!({ "name": format!("w{k}"), "position": place_law, "angle_deg": angle_law, "thickness": thick }));
        walls.push([place, own, most]);
    }
    cooling["walls"] = json!(documents);
    let turned = turns(draw, drawing, count, mean);
    let mut straight = Vec::new();
    let mut chambers = Vec::new();
    for k in 0..count {
        let (radius, _) = law(draw, fillet, 0.3);
        let mut chamber = json!({ "name": names[k], "fillet_radius": radius });
        let joined = turned.iter().any(|t| t.0 == k || t.0 + 1 == k);
        let mut span = [0.0, 1.0 - 1.5 * tip / drawing.height];
        if joined {
            // Turns take about as much height as the chambers are long, and the metal beyond.
            let share = (1.3 * mean + 2.0 * tip + 1.0) / drawing.height;
            span = [share, 1.0 - share];
        } else if draw.once_in(3) {
            span = [if draw.once_in(2) { 0.0 } else { draw.between(0.05, 0.2) }, draw.between(0.7, 0.93)];
            chamber["span"] = json!(span);
        }
        chambers.push(chamber);
        straight.push((names[k].to_owned(), span));
    }
    cooling["chambers"] = json!(chambers);
    if !turned.is_empty() {
        cooling["shell"]["hub"] = json!(draw.between(1.0, 2.5));
        let turns = turned.iter().map(|(k, end)| {
            let mut turn =
                json!({ "name": format!("t{k}"), "between": [names[*k], names[k + 1]], "end": end });
            if draw.once_in(3) {
                turn["exponent"] = json!(draw.between(2.0, 4.0));
            }
            turn
        });
        cooling["turns"] = json!(turns.collect::<Vec<_>>());
    }
    let interior = Interior { shell: [shell_s, shell_p], fillet, walls, chambers: straight, ends };
    bores::add(draw, drawing, &interior, &mut cooling);
    cooling
}

/// Chains of turns, by the chamber before the wall and the end; none in a third of the designs, nor where the blade is
/// too short for them.
fn turns(draw: &mut Draw, drawing: &Drawing, chambers: usize, mean: f64) -> Vec<(usize, &'static str)> {
    if chambers < 2 || draw.once_in(3) || drawing.height < 4.0 * mean + 8.0 {
        return Vec::new();
    }
    let mut end = *draw.of(&["tip", "hub"]);
    let mut out = Vec::new();
    for k in 0..chambers - 1 {
        // Here and there the chain ends and another passage begins.
        if draw.once_in(4) {
            continue;
        }
        out.push((k, end));
        end = if end == "tip" { "hub" } else { "tip" };
    }
    out
}
