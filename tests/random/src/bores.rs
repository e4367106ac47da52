//! Film holes, slots and radial holes, where the drawing has room for them.

use crate::draw::Draw;
use crate::drawing::{Drawing, Section};
use crate::interior::{Interior, Wall};
use serde_json::{Value, json};

const SIDES: [&str; 2] = ["suction_side", "pressure_side"];

/// Adds rows of film holes and slots.
pub(crate) fn add(draw: &mut Draw, drawing: &Drawing, interior: &Interior, cooling: &mut Value) {
    let mut rows = if draw.once_in(3) { showerhead(draw, drawing, interior) } else { Vec::new() };
    let head = !rows.is_empty();
    for (k, (name, span)) in interior.chambers.iter().enumerate() {
        for side in 0..2 {
            // A showerhead takes up the leading chamber.
            if draw.once_in(2) || (head && k == 0) {
                continue;
            }
            if let Some(mut row) = row(draw, drawing, interior, k, side, *span) {
                row["name"] = json!(format!("{name}{}", rows.len()));
                rows.push(row);
            }
        }
    }
    if !rows.is_empty() {
        cooling["film_rows"] = json!(rows);
    }
    if draw.once_in(3)
        && let Some(slots) = slots(draw, drawing, interior)
    {
        cooling["slot_rows"] = json!([slots]);
    }
}

/// The exit of a hole: its document, and its width across the axis. Its lengths lie between `least` and `length` mm.
fn shape(draw: &mut Draw, d: f64, alpha: f64, [least, length]: [f64; 2]) -> (Value, f64) {
    let round = (json!({ "kind": "cylindrical" }), d);
    match draw.below(6) {
        0 | 1 => round,
        2 => {
            let expansion = draw.between(3.0, 8.0f64);
            let width = d + 2.0 * length * expansion.to_radians().tan();
            (json!({ "kind": "conical", "expansion_deg": expansion }), width)
        }
        3 => {
            let width = draw.between(1.3, 2.5);
            (json!({ "kind": "racetrack", "width_d": width }), d * width)
        }
        _ => {
            // The metering part is round at the inner breakout, the widened one where its upstream edge breaks out.
            let slant = 0.5 / alpha.to_radians().tan();
            let room = least / d - 2.0 * slant;
            if room < 0.8 {
                return round;
            }
            let metering = slant + 0.1 + draw.between(0.2, 0.5) * room;
            let lateral = draw.between(5.0, 14.0f64);
            let forward = *draw.of(&[0.0, 7.0, 10.0]);
            let width = d + 2.0 * (length - metering * d) * lateral.to_radians().tan();
            let shape = json!({ "kind": "shaped", "metering_length_d": metering, "lateral_expansion_deg": lateral,
                "forward_expansion_deg": forward, "corner_radius_d": draw.between(0.2, 0.5) });
            (shape, width)
        }
    }
}

/// Camber fractions whose points on a side have chamber `k` behind them, in the tightest section: behind a point `ahead` mm
/// upstream of it, and half a foot to both sides.
fn extent(
    drawing: &Drawing,
    interior: &Interior,
    (k, side): (usize, usize),
    ahead: f64,
    half: f64,
) -> [f64; 2] {
    let shell = interior.shell[side];
    // The normals of a side do not stand on the camber line: a circle that grows touches ahead of its centre.
    let place = |s: &Section, at: f64| {
        let at = at + ahead / s.length;
        at + (s.radius(at) - shell).max(0.0) * s.growth(at) / s.length
    };
    let edge = |wall: &Wall, sign: f64, s: &Section| {
        let off = wall.half_across(s) + interior.fillet + half;
        wall.place_at(s) + (wall.leaned(s, side, shell) + sign * off) / s.length
    };
    let front = drawing.greatest(|s| match k {
        0 => place(s, interior.ends[0] + half / s.length),
        _ => place(s, edge(&interior.walls[k - 1], 1.0, s)),
    });
    let back = drawing.least(|s| match interior.walls.get(k) {
        None => place(s, interior.ends[1] - half / s.length),
        Some(wall) => place(s, edge(wall, -1.0, s)),
    });
    [front, back]
}

/// A row fed by chamber `k`; none where its holes would not find the chamber.
fn row(
    draw: &mut Draw,
    drawing: &Drawing,
    interior: &Interior,
    k: usize,
    side: usize,
    straight: [f64; 2],
) -> Option<Value> {
    let d = draw.between(0.4, 1.2);
    let alpha = draw.between(25.0, 90.0f64);
    let beta = *draw.of(&[0.0, 0.0, 30.0, 45.0, 60.0, -45.0, 90.0]);
    let shell = interior.shell[side];
    let length = shell / alpha.to_radians().sin();
    let least = interior.thin_shell[side] / alpha.to_radians().sin();
    let (shape, width) = shape(draw, d, alpha, [least, length]);
    let (along, across) = (length * alpha.to_radians().cos(), f64::to_radians(beta));
    let (shift, rise) = (along * across.cos(), (along * across.sin()).abs());
    // Half of the foot on the chamber's side, along the stream surface.
    let reach = 0.5 * d.max(if beta.abs() > 20.0 { width } else { d }) / alpha.to_radians().sin() + 0.3;
    // The sides are a little longer or shorter than the camber line: a tenth of the shift stays free.
    let [low, high] = extent(drawing, interior, (k, side), shift, reach + 0.1 * shift.abs());
    // The breakout must stay clear of the trailing edge.
    if low > high || high > 0.95 {
        return None;
    }
    let place = draw.between(low, high);
    let clear = (rise + 0.5 * width + 1.0) / drawing.height;
    let span = [straight[0] + clear + draw.between(0.0, 0.05), straight[1] - clear - draw.between(0.0, 0.05)];
    // The spans of a row lie at least two holes apart.
    let pitch = (draw.between(3.0, 8.0) * d).max(1.3 * width / across.cos().abs().max(0.35));
    let height = (span[1] - span[0]) * drawing.height;
    let count = (height / pitch).floor();
    if count < 1.0 || span[1] < span[0] {
        return None;
    }
    let mut row = json!({
        "side": SIDES[side], "camber_position": place, "span": span,
        "hole": { "diameter": d, "inclination_deg": alpha, "compound_deg": beta, "shape": shape },
    });
    if draw.once_in(3) {
        row["pitch"] = json!(pitch);
    } else {
        row["count"] = json!(count as u32);
    }
    if draw.once_in(3) {
        row["stagger"] = json!(draw.between(-0.3, 0.3));
    }
    if draw.once_in(2) {
        row["chamber"] = json!(interior.chambers[k].0);
    }
    Some(row)
}

/// Rows of slanted holes round the leading edge, skewed towards the tip.
fn showerhead(draw: &mut Draw, drawing: &Drawing, interior: &Interior) -> Vec<Value> {
    let (_, straight) = &interior.chambers[0];
    let d = draw.between(0.4, 0.8);
    let alpha = draw.between(25.0, 60.0f64);
    let nose = drawing.least(|s| s.nose[0].min(s.nose[1]));
    // Rows converge inwards: a staggered neighbour must pass between two holes.
    let pitch = draw.between(4.0, 8.0f64).max(2.8 / alpha.to_radians().sin()) * d;
    // The metal ahead of the leading chamber: more of it than the shell means that it ends far behind the nose.
    let ahead = drawing.greatest(|s| s.length) * interior.ends[0] - interior.fillet - 0.2;
    if ahead > 1.5 * interior.shell[0].max(interior.shell[1]) {
        return Vec::new();
    }
    let rise = interior.shell[0].max(interior.shell[1]) / alpha.to_radians().tan();
    let clear = (rise + d + 1.0) / drawing.height;
    let span = [straight[0] + clear, straight[1] - clear];
    let count = ((span[1] - span[0]) * drawing.height / pitch).floor();
    if count < 2.0 {
        return Vec::new();
    }
    let rows = *draw.of(&[1, 2, 3]);
    let stagger = 0.25;
    let head = |name: &str, side: usize, distance: f64, stagger: f64| {
        json!({ "name": name, "side": SIDES[side], "surface_distance": distance, "span": span, "count": count as u32,
            "stagger": stagger, "chamber": interior.chambers[0].0,
            "hole": { "diameter": d, "inclination_deg": alpha, "compound_deg": 90 } })
    };
    let mut out = vec![head("head", 0, draw.between(0.0, 0.2) * nose, -stagger)];
    // Neighbouring rows leave a diameter of metal, and stay on the nose.
    let apart = draw.between(2.2, 3.0) * d;
    if apart < 1.2 * nose {
        if rows > 1 {
            out.push(head("head_p", 1, apart, stagger));
        }
        if rows > 2 {
            out.push(head("head_s", 0, apart + 0.2 * nose, stagger));
        }
    }
    out
}

/// A row of slots; none where the trailing edge is too thin for them.
fn slots(draw: &mut Draw, drawing: &Drawing, interior: &Interior) -> Option<Value> {
    let (_, straight) = interior.chambers.last()?;
    // Lips of 0.2 mm at least on both sides, all along the slot's axis: one that begins far ahead in a bent section would
    // come out of a side.
    let beside = drawing.least(|s| s.beside_slot(interior.shell, interior.fillet).unwrap_or(0.0));
    let most = (2.0 * beside - 0.4).min(1.2 * interior.fillet);
    if most < 0.3 {
        return None;
    }
    let width = draw.between(0.3, most.max(0.31));
    let height = draw.between(1.0, 3.0);
    let clear = (0.5 * height + 1.0) / drawing.height;
    let span = [straight[0] + clear, straight[1] - clear];
    let pitch = height * draw.between(1.6, 3.0);
    let count = ((span[1] - span[0]) * drawing.height / pitch).floor();
    (count >= 1.0).then(|| {
        json!({ "name": "te", "span": span, "count": count as u32, "height": height, "width": width,
            "corner_radius": draw.between(0.08, 0.45) * width })
    })
}

/// One to five radial holes along the camber line, here and there with a film row that the first of them feeds.
pub(crate) fn radial_holes_alone(draw: &mut Draw, drawing: &Drawing) -> Value {
    let thickest = 2.0 * drawing.least(Section::greatest_radius);
    let Some(range) = drawing.thicker((0.5 * thickest).max(2.0)) else { return json!({}) };
    let count = 1 + draw.below(5);
    let length = drawing.least(|s| s.length) * (range[1] - range[0]);
    let room = length / count as f64;
    let holes: Vec<Value> = (0..count)
        .filter_map(|i| {
            let at = range[0] + (range[1] - range[0]) * (i as f64 + 0.5) / count as f64;
            // A millimetre of metal all round, and a straight axis in a bent blade.
            let most = (2.0 * (drawing.least(|s| s.radius(at)) - drawing.bow(at)) - 2.0).min(room - 1.0);
            let d = draw.between(0.4, 0.8) * most.min(6.0);
            if d < 0.4 {
                return None;
            }
            let diameter = if draw.once_in(2) { json!(d) } else { json!([[0, d], [1, 0.8 * d]]) };
            Some(json!({ "name": format!("{i}"), "diameter": diameter, "at": { "frame": "camber", "position": at } }))
        })
        .collect();
    json!({ "radial_holes": holes })
}
