//! Rows of blades, and hub and shroud as solids: closed forms, copies that match, refusals.

use coolinggen_blade::Fault;
use coolinggen_brep::SurfaceGeometry;
use coolinggen_cooling::design::Design;
use coolinggen_cooling::{Generated, generate};
use coolinggen_nurbs::ParametricSurface;
use glam::DVec3;
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};
use std::path::Path;

fn sample(text: &str, pattern: Value) -> Value {
    let mut design: Value = serde_json::from_str(text).unwrap();
    design["pattern"] = pattern;
    design
}

fn propeller(pattern: Value) -> Value {
    sample(include_str!("../../../samples/propeller.json"), pattern)
}

fn cooled(pattern: Value) -> Value {
    sample(include_str!("../../../samples/medial-cooled.json"), pattern)
}

fn built(design: &Value) -> Result<Generated, Vec<Fault>> {
    Design::from_json(&design.to_string()).and_then(|design| generate(&design, Path::new(".")))
}

fn refused(design: &Value) -> Fault {
    let mut faults = built(design).err().unwrap();
    assert_eq!(faults.len(), 1, "{faults:?}");
    faults.remove(0)
}

#[test]
fn walls_of_a_cylindrical_annulus_have_the_volumes_of_rings() {
    let design = propeller(json!({"hub": {"thickness": 8}, "shroud": {"thickness": 4}}));
    let Generated { report, blade, .. } = built(&design).unwrap();
    let names: Vec<&String> = report.solids.keys().collect();
    assert_eq!(names, ["hub", "metal", "shroud"]);
    for (name, radii) in [("hub", [22.48, 30.48]), ("shroud", [152.4, 156.4])] {
        let exact = PI * (radii[1] * radii[1] - radii[0] * radii[0]) * 120.0;
        let found = report.solids[name].volume_mm3;
        assert!((found / exact - 1.0).abs() < 1e-12, "{name} {found} {exact}");
        assert_eq!(report.genus[name].found, Some(1));
    }
    // The blade's root stands on the hub's own surface.
    let face = |name: &str| &blade.model.faces.iter().find(|f| f.name == name).unwrap().surface;
    assert_eq!(face("blade/hub"), face("hub/contour/1"));
    assert!(matches!(face("hub/contour/1"), SurfaceGeometry::Revolution(_)));
}

#[test]
fn blades_of_a_row_are_the_first_one_turned() {
    for count in [3, 10] {
        let Generated { report, blade, .. } = built(&cooled(json!({"count": count}))).unwrap();
        assert!(report.watertight);
        let model = &blade.model;
        assert_eq!(model.solids.len(), 4 * count);
        let each = model.faces.len() / count;
        for k in 1..count {
            let turn = |p: DVec3| {
                let (sin, cos) = (TAU * k as f64 / count as f64).sin_cos();
                DVec3::new(p.x, p.y * cos + p.z * sin, p.z * cos - p.y * sin)
            };
            for solid in &model.solids[..4] {
                let copy = format!("{}/{}", solid.name, k + 1);
                let [a, b] = [&solid.name, &copy].map(|name| &report.solids[name.as_str()]);
                assert!((a.volume_mm3 / b.volume_mm3 - 1.0).abs() < 1e-11, "{copy}");
                assert_eq!(report.genus[&copy].found, report.genus[&solid.name].found);
            }
            for (face, copy) in model.faces[..each].iter().zip(&model.faces[k * each..]) {
                assert_eq!(copy.name, format!("{}/{}", face.name, k + 1));
                for (a, b) in
                    face.loops.iter().zip(&copy.loops).flat_map(|(a, b)| a.coedges.iter().zip(&b.coedges))
                {
                    let [p, q] = [(face, a), (copy, b)].map(|(f, c)| {
                        let at = c.parameter_at(0.4);
                        f.surface.point(at.x, at.y)
                    });
                    assert!(turn(p).distance(q) < 1e-10, "{}", copy.name);
                }
            }
        }
    }
}

#[test]
fn a_hub_that_is_curved_lies_on_its_contour() {
    let text = include_str!("../../../samples/francis.json");
    let design = sample(text, json!({"count": 9, "hub": {"thickness": 6}, "shroud": {"thickness": 6}}));
    let report = built(&design).unwrap().report;
    assert!(report.watertight);
    assert_eq!(report.solids.len(), 11);
    assert!(report.max_edge_deviation_mm < 3e-8);
}

#[test]
fn what_does_not_fit_is_refused_with_what_would() {
    let fault = refused(&cooled(json!({"count": 200})));
    assert_eq!(fault.pointer, "/pattern/count");
    let most = fault.max.unwrap() as u32;
    assert!((10..200).contains(&most));
    // As many as it says do fit, one more do not.
    assert!(built(&cooled(json!({"count": most}))).is_ok());
    assert_eq!(refused(&cooled(json!({"count": most + 1}))).pointer, "/pattern/count");

    let fault = refused(&propeller(json!({"hub": {"thickness": 31}})));
    assert_eq!(fault.pointer, "/pattern/hub/thickness");
    assert!((fault.max.unwrap() - 30.48).abs() < 1e-12);

    let cascade = sample(include_str!("../../../samples/c3x.json"), json!({"count": 2}));
    assert_eq!(refused(&cascade).pointer, "/pattern");
}
