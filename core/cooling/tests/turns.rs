//! Turns, measured on built designs.

use coolinggen_brep::{Coedge, Face, Model};
use coolinggen_cooling::design::Design;
use coolinggen_cooling::{Generated, generate};
use coolinggen_nurbs::{ParametricCurve, ParametricSurface};
use glam::DVec3;
use std::collections::BTreeMap;
use std::path::Path;

fn built(name: &str) -> Generated {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name);
    let design = Design::from_file(&path).expect("the sample reads");
    generate(&design, Design::folder_of(&path)).expect("the sample builds")
}

fn normal(face: &Face, coedge: &Coedge, t: f64) -> DVec3 {
    let q = coedge.pcurve.point(t);
    let (_, u, v) = face.surface.first_derivatives(q.x, q.y);
    u.cross(v).normalize()
}

/// Greatest angle, degrees, between the normals of the two faces at each edge of a turn.
fn creases(model: &Model) -> BTreeMap<String, f64> {
    let mut uses: BTreeMap<usize, Vec<(usize, &Coedge)>> = BTreeMap::new();
    for (f, face) in model.faces.iter().enumerate() {
        for coedge in face.loops.iter().flat_map(|l| &l.coedges) {
            uses.entry(coedge.edge.0).or_default().push((f, coedge));
        }
    }
    let mut found = BTreeMap::new();
    for pair in uses.values().filter(|u| u.len() == 2) {
        let [a, b] = [pair[0], pair[1]];
        let (fa, fb) = (&model.faces[a.0], &model.faces[b.0]);
        if !(fa.name.starts_with("turn/") || fb.name.starts_with("turn/")) {
            continue;
        }
        let (start, end) = a.1.pcurve.domain();
        let angle = (0..=400)
            .map(|i| start + (end - start) * f64::from(i) / 400.0)
            .map(|t| normal(fa, a.1, t).cross(normal(fb, b.1, t)).length().asin().to_degrees())
            .fold(0.0, f64::max);
        found.insert(format!("{} | {}", fa.name, fb.name), angle);
    }
    found
}

#[test]
fn measure() {
    let generated = built("rotor-serpentine.json");
    let model = &generated.blade.model;
    for (name, angle) in creases(model) {
        println!("{angle:9.5} {name}");
    }
    let grid: Vec<(DVec3, (f64, f64))> = (0..400)
        .flat_map(|i| (0..30).map(move |j| (f64::from(i) / 400.0, f64::from(j) / 29.0)))
        .map(|(u, w)| (generated.surface.surface.point(u, w), (u, w)))
        .collect();
    for face in model.faces.iter().filter(|f| f.name.starts_with("turn/")) {
        let (mut low, mut high, mut at) = (f64::INFINITY, 0.0f64, 0.0);
        let mut radii = (f64::INFINITY, 0.0f64);
        for i in 0..=12 {
            for j in 0..=24 {
                let (u, v) = (f64::from(i) / 12.0, f64::from(j) / 24.0);
                let d = face.surface.derivatives(u, v);
                let near = grid
                    .iter()
                    .min_by(|a, b| a.0.distance_squared(d.point).total_cmp(&b.0.distance_squared(d.point)))
                    .unwrap();
                let foot = generated.surface.closest(d.point, near.1).unwrap();
                if foot.distance < low {
                    (low, at) = (foot.distance, v);
                }
                high = high.max(foot.distance);
                let k = d.principal_curvatures().map(f64::abs).into_iter().fold(0.0, f64::max);
                radii = (radii.0.min(1.0 / k), radii.1.max(1.0 / k));
            }
        }
        println!(
            "{:45} shell {low:.5} (q {at:.2}) .. {high:.5}  radius {:.3} .. {:.3}",
            face.name, radii.0, radii.1
        );
        if face.name.contains("fillet") {
            let mut row = String::new();
            for j in 0..=12 {
                let d = face.surface.derivatives(0.5, f64::from(j) / 12.0);
                let k = d.principal_curvatures().map(f64::abs).into_iter().fold(0.0, f64::max);
                row.push_str(&format!(" {:.3}", 1.0 / k));
            }
            println!("      mid radii {row}");
        }
    }
}

#[test]
fn locate() {
    let generated = built("rotor-serpentine.json");
    let model = &generated.blade.model;
    for (a, b) in [
        ("turn/tip/pressure_side", "turn/tip/outer/fillet_pressure_side"),
        ("turn/tip/suction_side", "turn/tip/outer/fillet_suction_side"),
        ("turn/hub/outer/fillet_pressure_side", "turn/hub/outer"),
        ("chamber/leading/pressure_side", "chamber/leading/leading_edge/pressure_side"),
    ] {
        let face = |n: &str| model.faces.iter().find(|f| f.name == n).unwrap();
        let (fa, fb) = (face(a), face(b));
        for ca in &fa.loops[0].coedges {
            for cb in &fb.loops[0].coedges {
                if ca.edge == cb.edge {
                    let (s, e) = ca.pcurve.domain();
                    let row: Vec<String> = (0..=24)
                        .map(|i| {
                            let t = s + (e - s) * f64::from(i) / 24.0;
                            format!(
                                "{:.3}",
                                normal(fa, ca, t).cross(normal(fb, cb, t)).length().asin().to_degrees()
                            )
                        })
                        .collect();
                    println!("turn/ {a} {row:?}");
                }
            }
        }
    }
}
