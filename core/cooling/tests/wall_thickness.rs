//! The shell is as thick as asked for, measured in space by an independent search.

use coolinggen_blade::{Blade, BladeSurface, Law, Pointer, Region};
use coolinggen_cooling::design::Design;
use coolinggen_cooling::{Generated, generate};
use coolinggen_nurbs::{ParametricSurface, SurfaceProjector};
use serde_json::json;
use std::path::Path;

fn sample(name: &str) -> serde_json::Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn build(design: &serde_json::Value) -> (Design, Generated) {
    let design = Design::from_json(&design.to_string()).unwrap_or_else(|f| panic!("{f:?}"));
    let generated = generate(&design, Path::new(".")).unwrap_or_else(|f| panic!("{f:?}"));
    (design, generated)
}

fn projector(blade: &Blade) -> SurfaceProjector<coolinggen_nurbs::Surface<glam::DVec3>> {
    match &blade.surface {
        BladeSurface::BSpline(surface) => SurfaceProjector::new(surface.clone(), true),
        BladeSurface::Rational(_) => panic!("the samples are polynomial"),
    }
}

/// Greatest excess of the error over the allowance (1 % or 0.01 mm), over 2,000 points a side.
fn check_sides(design: &Design, generated: &Generated) {
    let shell = design.cooling.as_ref().unwrap().shell.as_ref().unwrap();
    let law = |spec: &coolinggen_blade::LawSpec| -> Law { spec.law(&Pointer::root()).unwrap() };
    let (suction, pressure) = (law(&shell.suction_side), law(&shell.pressure_side));
    let outer = projector(&generated.surface);
    let mut checked = 0;
    for face in &generated.blade.model.faces {
        let law = match face.name.rsplit('/').next().unwrap() {
            "suction_side" if face.name.matches('/').count() == 2 => &suction,
            "pressure_side" if face.name.matches('/').count() == 2 => &pressure,
            _ => continue,
        };
        let (_, (v0, v1)) = face.surface.domain();
        for i in 0..2000u32 {
            // A low-discrepancy set (Roberts' R2 sequence).
            let u = (0.5 + 0.754_877_666_246_692_7 * f64::from(i)).fract();
            let v = v0 + (v1 - v0) * (0.5 + 0.569_840_290_998_053_3 * f64::from(i)).fract();
            let foot = outer.closest(face.surface.point(u, v)).unwrap();
            let thickness = foot.distance;
            let asked = law.at(v);
            // Over the leading edge the thickness passes from one side's law to the other's.
            let blends = generated.surface.region_at(foot.u) == Region::LeadingEdge;
            let other = if blends { suction.at(v) + pressure.at(v) - asked } else { asked };
            let allowed = (0.01 * asked).max(0.01);
            assert!(
                thickness >= asked.min(other) - allowed && thickness <= asked.max(other) + allowed,
                "{} at ({u:.3}, {v:.3}): {thickness:.5} mm, asked {asked:.5} mm",
                face.name
            );
            checked += 1;
        }
    }
    assert_eq!(checked, 2 * 2000 * design.cooling.as_ref().unwrap().chambers.len());
}

#[test]
fn on_the_rotor() {
    let (design, generated) = build(&sample("rotor.json"));
    check_sides(&design, &generated);
}

/// The rotor leaned by `degrees`: its sections turned about the axis in proportion to their height.
fn leaned(degrees: f64) -> serde_json::Value {
    const HEIGHT: f64 = 58.0;
    let mut design = sample("rotor.json");
    for section in design["blade"]["sections"].as_array_mut().unwrap() {
        let shift = HEIGHT * degrees.to_radians().tan() * (section["span"].as_f64().unwrap() - 0.5);
        for side in ["suction_side", "pressure_side"] {
            for point in section[side].as_array_mut().unwrap() {
                point[1] = (point[1].as_f64().unwrap() + shift).into();
            }
        }
    }
    design
}

#[test]
fn on_leaned_blades() {
    for degrees in [20.0, 30.0, -30.0] {
        let (design, generated) = build(&leaned(degrees));
        check_sides(&design, &generated);
        assert!(generated.report.watertight, "{degrees} degrees");
        assert!(generated.report.max_edge_deviation_mm < 3e-8, "{degrees} degrees");
    }
}

/// The rotor with one chamber inside a shell of one thickness.
fn hollow(thickness: f64) -> serde_json::Value {
    let mut design = sample("rotor.json");
    let cooling = &mut design["cooling"];
    cooling["shell"] = json!({ "suction_side": thickness, "pressure_side": thickness, "tip": 1.2 });
    cooling["walls"] = json!([]);
    cooling["chambers"] = json!([{ "name": "one", "fillet_radius": 0.4 }]);
    design
}

/// From where the chamber follows the nose, over where it does in some sections and is rounded in others, to where it
/// is rounded in all and its offset would cross itself at both ends.
#[test]
fn until_the_chamber_vanishes() {
    for tenths in [3, 9, 14, 15, 16, 17, 19, 22, 25, 28, 30] {
        let thickness = f64::from(tenths) / 10.0;
        let (design, generated) = build(&hollow(thickness));
        check_sides(&design, &generated);
        assert!(generated.report.watertight, "{thickness} mm");
        assert!(generated.report.max_edge_deviation_mm < 3e-8, "{thickness} mm");
    }
    let design = Design::from_json(&hollow(3.5).to_string()).unwrap();
    let faults = generate(&design, Path::new(".")).unwrap_err();
    assert_eq!(faults.len(), 1, "{faults:?}");
    assert_eq!(faults[0].pointer, "/cooling/shell");
    assert!(faults[0].message.contains("span fraction"), "{}", faults[0].message);
    // The thickest circle of the tip's sections has a radius of about 3.5 mm, the chamber's end one of 0.4.
    assert!(
        (faults[0].max.unwrap() - 3.15).abs() < 0.05 && faults[0].value == Some(3.5.into()),
        "{:?}",
        faults[0]
    );
}
