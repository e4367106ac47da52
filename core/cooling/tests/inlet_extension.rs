//! Straight extensions of the coolant below the hub: exact volumes, all in one direction, refused where there is none.

mod common;

use common::{check, sample};
use coolinggen_blade::Fault;
use coolinggen_cooling::design::Design;
use coolinggen_cooling::report::Report;
use coolinggen_cooling::{Generated, generate};
use serde_json::{Value, json};
use std::path::Path;

fn tried(design: &Value) -> Result<Generated, Vec<Fault>> {
    generate(&Design::from_json(&design.to_string())?, Path::new("."))
}

fn built(design: &Value) -> Generated {
    tried(design).unwrap_or_else(|faults| panic!("{faults:?}"))
}

fn refused(design: &Value) -> Fault {
    let faults = tried(design).map(|_| ()).expect_err("refused");
    assert_eq!(faults[0].pointer, "/cooling/inlet_extension");
    faults[0].clone()
}

/// The coolant goes on straight below the hub; the metal stays what it is.
#[test]
fn inlets_go_on_below_the_hub() {
    for (name, inlets) in [("rotor-serpentine.json", 1), ("rotor.json", 2), ("c3x-film.json", 7)] {
        let mut design = sample(name);
        let before = built(&design).report;
        design["cooling"]["inlet_extension"] = json!(12.0);
        let generated = built(&design);
        let report = &generated.report;
        assert!(report.watertight);
        for (solid, genus) in &report.genus {
            assert_eq!(genus.found, Some(genus.expected), "{solid}");
        }
        let metal = |report: &Report| report.solids["metal"].volume_mm3;
        assert_eq!(metal(report), metal(&before), "{name}");
        let mut extended = 0;
        for face in before.faces.iter().filter(|f| f.name.starts_with("coolant/inlet/")) {
            let solid = &face.solids[0];
            let added = report.solids[solid].volume_mm3 - before.solids[solid].volume_mm3;
            // A cylinder on the inlet's area, as its projection along the hub's normal in its middle: the inlet is
            // nearly flat.
            assert!((added / (12.0 * face.area_mm2) - 1.0).abs() < 0.01, "{name} {solid}: {added}");
            let walls = format!("{}/inlet_extension/", face.name);
            assert!(
                report.faces.iter().filter(|f| f.name.starts_with(&walls)).count() >= 2,
                "{name} {solid}"
            );
            extended += 1;
        }
        assert_eq!(extended, inlets, "{name}");
    }
    let mut shallow = sample("rotor.json");
    shallow["cooling"]["inlet_extension"] = json!(0.01);
    let fault = refused(&shallow);
    assert!(fault.min.unwrap() > 0.01);
}

/// A blade that winds round its hub, 30 mm in radius, by `turn_deg`, with three chambers one behind the other.
fn screw(turn_deg: f64) -> Value {
    json!({"format": "coolinggen/1", "name": "screw",
        "space": {"kind": "annular", "hub": [[-80, 30], [80, 30]], "shroud": [[-80, 46], [80, 46]]},
        "blade": {"kind": "medial-turbine",
            "leading_edge": [[-20, 30], [-20, 46]], "trailing_edge": [[20, 30], [20, 46]],
            "phi0_deg": 0, "phi1_deg": turn_deg, "beta0_deg": 30, "beta1_deg": 30, "zeta0": 0.4, "zeta1": 0.4,
            "profile": {"kind": "bezier", "control_points": [[0, 0], [0, 0.32], [0.1, 0.62], [0.35, 0.62], [0.7, 0.15], [1, 0.07]]},
            "thickness": 9, "closing": "rounded"},
        "cooling": {
            "shell": {"suction_side": 1.2, "pressure_side": 1.2},
            "walls": [
                {"name": "w1", "position": 0.3, "thickness": 1.2}, {"name": "w2", "position": 0.6, "thickness": 1.2}],
            "chambers": [
                {"name": "leading", "fillet_radius": 0.5}, {"name": "middle", "fillet_radius": 0.5},
                {"name": "trailing", "fillet_radius": 0.5}],
            "inlet_extension": 20}})
}

/// Inlets round half the hub have one direction, far from their own normals; round two thirds of it they have none.
#[test]
fn inlets_that_face_apart_are_refused_with_the_angle() {
    assert!(built(&screw(160.0)).report.watertight);
    let fault = refused(&screw(240.0));
    let angle = fault.value.as_ref().and_then(Value::as_f64).unwrap();
    // Half the turn and less: the first inlet's middle lies behind the leading edge.
    assert!(angle > 60.0 && angle < 120.0, "{fault:?}");
    assert_eq!((fault.max, fault.unit), (Some(60.0), "deg"));
    // What a blade of the same shape is refused by is the extension alone.
    let mut bare = screw(240.0);
    bare["cooling"].as_object_mut().unwrap().remove("inlet_extension");
    check(&built(&bare));
}
