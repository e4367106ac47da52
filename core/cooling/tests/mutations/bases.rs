//! What is mutated: every sample, and forms of the samples that are quicker to build or that no sample has.

use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// A design that can be built, and how often it is drawn.
pub(crate) struct Base {
    pub(crate) design: Value,
    pub(crate) weight: u32,
}

/// The samples' folder, which the paths in them refer to.
pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples")
}

fn sample(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// All of them, in the order of their files' names.
pub(crate) fn bases() -> Vec<Base> {
    let entries = std::fs::read_dir(folder()).unwrap().map(|e| e.unwrap().path());
    let mut files: Vec<PathBuf> = entries.filter(|p| p.extension().is_some_and(|e| e == "json")).collect();
    files.sort();
    let mut bases: Vec<Base> = files.iter().map(|path| Base { design: sample(path), weight: 1 }).collect();
    let rotor = sample(&folder().join("rotor.json"));
    let pritchard = sample(&folder().join("pritchard.json"));
    bases.push(Base { design: vane(), weight: 3 });
    bases.push(Base { design: streamlines(&rotor), weight: 2 });
    bases.push(Base { design: short_chambers(&pritchard), weight: 3 });
    bases.push(Base { design: chambers_and_hole(&pritchard), weight: 2 });
    bases.push(Base { design: inner_bores(&rotor), weight: 1 });
    bases
}

/// A round-ended surface given inline in a linear cascade, with one hole and one chamber.
fn vane() -> Value {
    let points: Vec<Value> = (0..=24)
        .map(|i| {
            let a = f64::from(i % 24) / 24.0 * std::f64::consts::TAU;
            json!([[20.0 * a.cos(), 6.0 * a.sin(), 0.0], [18.0 * a.cos(), 6.0 * a.sin(), 80.0]])
        })
        .collect();
    let mut knots = vec![0.0; 3];
    knots.extend((0..=22).map(f64::from));
    knots.extend([22.0; 3]);
    json!({
        "format": "coolinggen/1", "name": "vane",
        "space": {"kind": "linear", "z0": 10, "height": 60},
        "blade": {"kind": "surface", "degree_u": 3, "degree_v": 1, "knots_u": knots, "knots_v": [0, 0, 1, 1],
            "points": points},
        "cooling": {"radial_holes": [
            {"name": "a", "diameter": [[0, 3], [1, 2]], "at": {"frame": "stream", "m": 2, "t": 0.5}},
            {"name": "b", "diameter": 2, "at": {"frame": "camber", "position": 0.7, "offset": -0.2}}]}
    })
}

/// The rotor between streamlines instead of contours, one of them a B-spline, with nothing inside.
fn streamlines(rotor: &Value) -> Value {
    let mut design = rotor.clone();
    design["name"] = json!("streamlines");
    design["space"] = json!({"kind": "streamlines", "streamlines": [
        {"v": 0, "contour": [[-15, 249.4], [20, 251.5], [75, 253]]},
        {"v": 0.5, "contour": {"degree": 2, "knots": [0, 0, 0, 1, 1, 1],
            "points": [[-15, 275.5], [20, 280.4], [75, 285.5]]}},
        {"v": 1, "contour": [[-15, 301.5], [20, 309.2], [75, 318]]}]});
    design["cooling"]["walls"] = json!([]);
    design["cooling"]["chambers"] = json!([{"name": "only", "span": [0.2, 0.4], "fillet_radius": 0.5}]);
    design
}

/// Two chambers over a part of the span, one of them a closed void.
fn short_chambers(pritchard: &Value) -> Value {
    let mut design = pritchard.clone();
    design["name"] = json!("short");
    design["cooling"] = json!({
        "shell": {"suction_side": [[0, 0.8], [1, 0.6]], "pressure_side": 0.7, "tip": 1.0},
        "walls": [{"name": "w", "position": [[0, 0.4], [1, 0.42]], "angle_deg": 85, "thickness": 0.8}],
        "chambers": [{"name": "front", "span": [0, 0.3], "fillet_radius": 0.3},
            {"name": "back", "span": [0.1, 0.3], "fillet_radius": [[0, 0.3], [1, 0.25]]}]});
    design
}

/// A chamber and a radial hole beside it.
fn chambers_and_hole(pritchard: &Value) -> Value {
    let mut design = short_chambers(pritchard);
    design["name"] = json!("mixed");
    design["cooling"]["radial_holes"] =
        json!([{"name": "h", "diameter": 0.3, "at": {"frame": "camber", "position": 0.415}}]);
    design["cooling"]["walls"][0]["thickness"] = json!(2.0);
    design
}

/// Crossover holes, pins and a dust hole.
fn inner_bores(rotor: &Value) -> Value {
    let mut design = rotor.clone();
    design["name"] = json!("inner");
    design["cooling"]["crossover_rows"] = json!([{"name": "x", "wall": "w1", "span": [0.3, 0.6], "count": 2,
        "position": 0.4, "diameter": [[0, 0.9], [1, 0.8]], "height_d": 1.5, "inclination_deg": 10, "skew_deg": -5}]);
    design["cooling"]["pin_arrays"] = json!([{"name": "p", "chamber": "trailing", "span": [0.4, 0.6],
        "camber": [0.68, 0.72], "diameter": 0.8, "spanwise_pitch_d": 4, "streamwise_pitch_d": 3, "stagger": 0.3}]);
    design["cooling"]["dust_holes"] = json!([{"name": "d", "chamber": "middle", "position": 0.4, "diameter": 1,
        "inclination_deg": 20, "azimuth_deg": 45}]);
    design["cooling"]["least_ligament"] = json!(0.2);
    design
}
