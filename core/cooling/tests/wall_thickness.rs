//! The shell is as thick as asked for, measured in space by an independent search.

use coolinggen_blade::{Blade, BladeSurface, Law, Pointer};
use coolinggen_cooling::design::Design;
use coolinggen_cooling::{Generated, generate};
use coolinggen_nurbs::{ParametricSurface, SurfaceProjector};
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
            let thickness = outer.closest(face.surface.point(u, v)).unwrap().distance;
            let asked = law.at(v);
            let allowed = (0.01 * asked).max(0.01);
            assert!(
                (thickness - asked).abs() <= allowed,
                "{} at ({u:.3}, {v:.3}): {thickness:.5} mm, asked {asked:.5} mm",
                face.name
            );
            checked += 1;
        }
    }
    assert_eq!(checked, 6 * 2000);
}

#[test]
fn on_the_rotor() {
    let (design, generated) = build(&sample("rotor.json"));
    check_sides(&design, &generated);
}
