//! Blades: the sample rotor bent in many ways, Pritchard's sections, the C3X vane; in an annulus and in a cascade.

use crate::draw::Draw;
use serde_json::{Value, json};

/// Space and blade of a design.
pub(crate) fn blade(draw: &mut Draw) -> (Value, Value) {
    match draw.below(5) {
        0 | 1 => rotor(draw),
        2 | 3 => pritchard(draw),
        _ => vane(draw),
    }
}

fn sample(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or(Value::Null)
}

/// The numbers of a list of points.
fn points(list: &Value) -> Vec<[f64; 2]> {
    let pair = |p: &Value| Some([p.get(0)?.as_f64()?, p.get(1)?.as_f64()?]);
    list.as_array().into_iter().flatten().filter_map(pair).collect()
}

/// The sample's sections, scaled, made thicker or thinner across the flow, twisted, leaned and swept.
fn rotor(draw: &mut Draw) -> (Value, Value) {
    let rotor = sample(include_str!("../../../samples/rotor.json"));
    let scale = draw.between(0.8, 1.6);
    let span = draw.between(0.7, 1.7);
    let (twist, lean, sweep) = (draw.between(-6.0, 6.0), draw.between(-4.0, 4.0), draw.between(-3.0, 3.0));
    let stagger = draw.between(-5.0, 5.0f64);
    let space = if draw.once_in(3) {
        json!({ "kind": "linear", "z0": 0, "height": (50.0 * scale * span).round() })
    } else {
        let hub = points(&rotor["space"]["hub"]);
        let shroud = points(&rotor["space"]["shroud"]);
        let raised =
            hub.iter().zip(&shroud).map(|(h, s)| [s[0] * scale, (h[1] + (s[1] - h[1]) * span) * scale]);
        let raised: Vec<_> = raised.collect();
        let hub: Vec<_> = hub.iter().map(|p| p.map(|x| x * scale)).collect();
        json!({ "kind": "annular", "hub": hub, "shroud": raised })
    };
    let mut blade = rotor["blade"].clone();
    for section in blade["sections"].as_array_mut().into_iter().flatten() {
        let v = section["span"].as_f64().unwrap_or(0.0);
        let turn = glam::DVec2::from_angle((stagger + twist * (v - 0.5)).to_radians());
        let pivot = glam::DVec2::new(35.0, -5.0);
        for side in ["suction_side", "pressure_side"] {
            let moved = points(&section[side]).into_iter().map(|p| {
                let q = turn.rotate(glam::DVec2::from(p) - pivot) + pivot;
                [(q.x + sweep * v) * scale, (q.y + lean * v) * scale]
            });
            section[side] = json!(moved.collect::<Vec<_>>());
        }
    }
    (space, blade)
}

/// Pritchard's eleven parameters as turbine rows have them, with the throat that the exit angle asks for.
fn pritchard(draw: &mut Draw) -> (Value, Value) {
    let chord = draw.between(30.0, 70.0);
    let height = draw.between(0.9, 2.0) * chord;
    let exit = draw.between(-64.0, -52.0);
    let inlet = draw.between(10.0, 40.0);
    let pitch = chord * draw.between(0.52, 0.62);
    let opening = draw.between(0.9, 0.96);
    let taper = draw.between(0.8, 1.0);
    let linear = draw.once_in(3);
    let radius = draw.between(4.0, 9.0) * chord;
    let count = (2.0 * std::f64::consts::PI * radius / pitch).round();
    let pitch_at = |r: f64| 2.0 * std::f64::consts::PI * r / count;
    let throat = |r: f64, angle: f64| pitch_at(r) * angle.to_radians().cos() * opening;
    // Towards the tip: more pitch, more exit angle, less turning, less chord.
    let tip = radius + height;
    let law = |hub: f64, tip: f64| if linear { json!(hub) } else { json!([[0, hub], [1, tip]]) };
    let steeper = exit - draw.between(1.0, 4.0);
    let (leading, trailing) = (draw.between(0.04, 0.06) * chord, draw.between(0.012, 0.018) * chord);
    // Edges as far apart as a camber line of these angles puts them.
    let fuller = draw.between(0.26, 0.34);
    let tangential = |inlet: f64, exit: f64, chord: f64| {
        chord * (fuller - 0.2 * (inlet.to_radians().tan() + exit.to_radians().tan()))
    };
    let less = draw.between(0.0, 10.0);
    let edges = law(tangential(inlet, exit, chord), tangential(inlet - less, steeper, chord * taper));
    let wedge = draw.between(7.0, 11.0);
    let mut blade = json!({
        "kind": "pritchard", "blade_count": count as u32, "stacking": "centroid",
        "axial_chord": law(chord, chord * taper), "tangential_chord": edges,
        "unguided_turning_deg": draw.between(4.0, 9.0), "inlet_angle_deg": law(inlet, inlet - less),
        "inlet_half_wedge_deg": wedge, "leading_edge_radius": law(leading, leading * taper),
        "exit_angle_deg": law(exit, steeper), "trailing_edge_radius": law(trailing, trailing * taper),
        "throat": law(throat(radius, exit), throat(tip, steeper)),
        "x": 0.4 * chord, "r_theta": json!([[0, 0], [1, draw.between(-0.06, 0.06) * chord]]),
    });
    let space = if linear {
        blade["radius"] = json!(radius);
        json!({ "kind": "linear", "z0": 0, "height": height })
    } else {
        let (cone, flare) = (draw.between(0.0, 0.1), draw.between(0.0, 0.2));
        let ends = [-0.6 * chord, 1.5 * chord];
        let contour = |r: f64, slope: f64| ends.map(|x| [x, r + slope * x]);
        json!({ "kind": "annular", "hub": contour(radius, cone), "shroud": contour(tip, flare) })
    };
    (space, blade)
}

/// The C3X vane, smaller or larger, in its cascade.
fn vane(draw: &mut Draw) -> (Value, Value) {
    let c3x = sample(include_str!("../../../samples/c3x.json"));
    let scale = draw.between(0.45, 1.1);
    let mut blade = c3x["blade"].clone();
    for section in blade["sections"].as_array_mut().into_iter().flatten() {
        let scaled = points(&section["points"]).into_iter().map(|p| p.map(|x| x * scale));
        section["points"] = json!(scaled.collect::<Vec<_>>());
    }
    let height = draw.between(40.0, 100.0) * scale.max(0.7);
    (json!({ "kind": "linear", "z0": 0, "height": height }), blade)
}
