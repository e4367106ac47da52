//! Shell, walls, chambers and turns; what is bored comes from [`super::bores`].

use crate::bores;
use crate::draw::Draw;
use crate::drawing::{Drawing, Section};
use serde_json::{Value, json};

/// What the holes must know of the chambers.
pub(crate) struct Interior {
    /// Shell on suction and pressure side, mm (the thicker end of a law).
    pub(crate) shell: [f64; 2],
    /// The same at the thinner end, mm.
    pub(crate) thin_shell: [f64; 2],
    /// Fillet radius, mm.
    pub(crate) fillet: f64,
    /// Walls from front to back.
    pub(crate) walls: Vec<Wall>,
    /// Chambers from front to back: name and the span fractions that are surely straight.
    pub(crate) chambers: Vec<(String, [f64; 2])>,
    /// Camber fractions at which the first chamber begins and the last one ends.
    pub(crate) ends: [f64; 2],
}

/// A wall as drawn at hub and tip.
pub(crate) struct Wall {
    place: [f64; 2],
    angle_deg: [f64; 2],
    /// Where it is thickest, mm.
    thickness: f64,
}

impl Wall {
    fn angle(&self, section: &Section) -> f64 {
        (self.angle_deg[0] + (self.angle_deg[1] - self.angle_deg[0]) * section.v).to_radians()
    }

    /// Camber fraction in a section.
    pub(crate) fn place_at(&self, section: &Section) -> f64 {
        self.place[0] + (self.place[1] - self.place[0]) * section.v
    }

    /// How far behind its place on the camber line it meets the inside of a shell (side 0: suction side), mm.
    pub(crate) fn leaned(&self, section: &Section, side: usize, shell: f64) -> f64 {
        let leaned = (section.radius(self.place_at(section)) - shell).max(0.0) / self.angle(section).tan();
        if side == 0 { leaned } else { -leaned }
    }

    /// Half its thickness along the camber line, mm.
    pub(crate) fn half_across(&self, section: &Section) -> f64 {
        0.5 * self.thickness / self.angle(section).sin()
    }

    /// Least length of the chamber between this wall and the next one along the sides, mm: across a bent camber line walls
    /// come nearer to each other towards the pressure side.
    fn apart(&self, next: &Self, drawing: &Drawing, shell: [f64; 2]) -> f64 {
        drawing.least(|s| {
            let at_side = |wall: &Self, side: usize| {
                let room = (s.radius(wall.place_at(s)) - shell[side]).max(0.0);
                s.across(wall.place_at(s), wall.angle(s), room, side)
            };
            let apart = |side: usize| at_side(self, side).distance(at_side(next, side));
            apart(0).min(apart(1)) - self.half_across(s) - next.half_across(s)
        })
    }
}

/// A law: constant, or changing by up to a share from hub to tip; with its greatest and its least value.
fn law(draw: &mut Draw, value: f64, share: f64) -> (Value, [f64; 2]) {
    if draw.once_in(2) {
        return (json!(value), [value; 2]);
    }
    let ends = [value, value * (1.0 - draw.between(0.0, share))];
    let law = match draw.below(3) {
        0 => json!([[0, ends[0]], [1, ends[1]]]),
        1 => json!([[0, ends[0]], [0.5, draw.between(ends[1], ends[0])], [1, ends[1]]]),
        _ => json!([[0, ends[1]], [1, ends[0]]]),
    };
    (law, ends)
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
    let (suction, [shell_s, thin_s]) = {
        let t = draw.between(0.8, most);
        law(draw, t, 0.25)
    };
    let (pressure, [shell_p, thin_p]) = {
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
        let (thick, [most, _]) = law(draw, thickness, 0.2);
        let place_tip = if draw.once_in(2) { place } else { place + 0.3 * draw.between(-jitter, jitter) };
        let own_tip = if draw.once_in(2) { own } else { own + draw.between(-6.0, 6.0) };
        documents.push(json!({ "name": format!("w{k}"), "thickness": thick }));
        walls.push(Wall { place: [place, place_tip], angle_deg: [own, own_tip], thickness: most });
    }
    // Walls that come so near to each other that their fillets meet are drawn parallel instead; then with smaller fillets;
    // and if not even those fit, there is a wall too many.
    let shell = [shell_s, shell_p];
    let room = |walls: &[Wall]| {
        let apart = walls.windows(2).map(|pair| pair[0].apart(&pair[1], drawing, shell));
        let tightest = apart.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        tightest.map_or((0, f64::INFINITY), |(k, apart)| (k, (apart - 0.5) / 2.2))
    };
    if room(&walls).1 < fillet {
        walls.iter_mut().for_each(|wall| wall.angle_deg = [angle; 2]);
    }
    while room(&walls).1 < 0.3 {
        let (tightest, _) = room(&walls);
        walls.remove(tightest + 1);
        documents.remove(tightest + 1);
    }
    let fillet = fillet.min(room(&walls).1);
    let count = walls.len() + 1;
    for (document, wall) in documents.iter_mut().zip(&walls) {
        let law = |[hub, tip]: [f64; 2]| if hub == tip { json!(hub) } else { json!([[0, hub], [1, tip]]) };
        document["position"] = law(wall.place);
        document["angle_deg"] = law(wall.angle_deg);
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
    let interior = Interior { shell, thin_shell: [thin_s, thin_p], fillet, walls, chambers: straight, ends };
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
