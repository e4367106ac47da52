//! Proposition 2 of the paper, on the functions and on the final B-spline.

use super::*;
use crate::medial::{Skin, SkinSize, TwoSided};
use crate::stream::SpaceSpec;
use serde_json::Value;

fn sample() -> (StreamSpace, PropellerSource) {
    let mut design: Value =
        serde_json::from_str(include_str!("../../../../../../samples/medial-propeller.json")).unwrap();
    design["blade"].as_object_mut().unwrap().remove("kind");
    let space: SpaceSpec = serde_json::from_value(design["space"].clone()).unwrap();
    (space.space(&Pointer::root()).unwrap(), serde_json::from_value(design["blade"].clone()).unwrap())
}

fn sides() -> PointedSides {
    let (space, source) = sample();
    sides_of(&source, &space)
}

fn sides_of(source: &PropellerSource, space: &StreamSpace) -> PointedSides {
    let plan = source.plan(space).unwrap_or_else(|f| panic!("{f:?}"));
    let medial = plan.cut_out().unwrap_or_else(|f| panic!("{f:?}"));
    plan.sides(medial).unwrap_or_else(|f| panic!("{f:?}")).0
}

#[test]
fn the_pressure_side_may_have_its_own_profile_and_scale() {
    let (space, source) = sample();
    let mut other = source.clone();
    other.pressure_side = Some(SideSpec {
        profile: Some(ProfileSpec::Bezier {
            control_points: vec![[0.0, 0.0], [0.0, 0.3], [0.4, 0.5], [1.0, 0.01]],
        }),
        thickness: Some(law()),
    });
    let plan = other.plan(&space).unwrap_or_else(|f| panic!("{f:?}"));
    let (sides, suction) = plan.sides(plan.cut_out().unwrap()).unwrap();
    let [profile, pressure] = [0, 1].map(|k| plan.sections.sides[k].0.clone());
    for (t, v) in [(0.2, 0.1), (0.5, 0.5), (0.8, 0.9)] {
        // The distance from the medial surface is d(v) y(t) of each side's own laws.
        for (k, profile, scale) in [(suction, &profile, &other.thickness), (1 - suction, &pressure, &law())] {
            let scale = scale.law(&Pointer::root()).unwrap().at(v);
            let u = sides.sides[k].pace.at(t);
            let height = sides.point(k, t, v).distance(sides.medial.point(u, v));
            assert!((height - scale * profile.at(t)[0].y).abs() < 1e-12, "{k} {t} {v}");
        }
    }
    // Proposition 2 holds for the final B-spline all the same.
    proposition_2(&sides, &Skin::within(&sides, 1 - suction, [3, 3], 2e-3, 1).unwrap());
    // A scale that does not end at the tip is refused where it stands.
    other.pressure_side.as_mut().unwrap().thickness = Some(LawSpec::Constant(2.0));
    let faults = other.plan(&space).err().unwrap();
    assert_eq!(faults.iter().map(|f| f.pointer.as_str()).collect::<Vec<_>>(), ["/pressure_side/thickness"]);
}

fn law() -> LawSpec {
    LawSpec::Points(vec![[0.0, 5.0], [0.5, 3.0], [1.0, 0.0]])
}

#[test]
fn the_cut_out_function_fulfils_equations_29_to_32() {
    let cut = sides().medial.cut;
    let (rows, columns) = cut.counts();
    let b = |i: usize, j: usize| cut.points()[i * columns + j];
    let (m, n) = (rows - 1, columns - 1);
    for i in 0..=m {
        assert_eq!(b(0, n), b(i, n), "29");
        // 32: with the tip on one line.
        assert_eq!((b(i, n - 1) - b(m, n)).perp_dot(b(0, n - 1) - b(m, n)), 0.0, "32");
    }
    for j in 0..=n {
        assert_eq!(b(0, j), b(1, j), "30");
    }
    assert_eq!(b(m, n), b(m, n - 1), "31");
    assert!(b(0, n - 1).distance(b(m, n)) > 1e-3);
}

#[test]
fn normals_of_the_extended_surface_are_defined_at_the_tip() {
    let medial = sides().medial;
    for (i, j) in (0..=20).flat_map(|i| (0..=20).map(move |j| (i, j))) {
        let c = medial.cut.point(f64::from(i) / 20.0, f64::from(j) / 20.0);
        let (_, along, up) = medial.extended.first_derivatives(c.x, c.y);
        let sine = along.cross(up).length() / (along.length() * up.length());
        assert!(sine > 0.2 && up.length() > 10.0 && along.length() > 10.0, "{c} {sine}");
    }
}

#[test]
fn proposition_2_holds_for_the_sides() {
    let sides = sides();
    let tip = sides.tip().unwrap();
    let rate = |k: usize, t: f64| {
        let h = 1e-5;
        // One-sided, exact for cubics.
        let p = |i: f64| sides.point(k, t, 1.0 - i * h);
        (p(0.0) * 11.0 - p(1.0) * 18.0 + p(2.0) * 9.0 - p(3.0) * 2.0) / (6.0 * h)
    };
    for (k, i) in [0, 1].into_iter().flat_map(|k| (0..=20).map(move |i| (k, i))) {
        let t = f64::from(i) / 20.0;
        assert!(sides.point(k, t, 1.0).distance(tip.point) < 1e-12);
        // 2: all derivatives in v in one plane.
        let d = rate(k, t);
        assert!(d.dot(tip.normal).abs() < 1e-5 * d.length(), "{t} {:e}", d.dot(tip.normal) / d.length());
    }
    // 3: the boundary curves have collinear tangents.
    let ends = [rate(0, 1.0), rate(1, 1.0)];
    assert!(ends[0].cross(ends[1]).length() < 1e-5 * ends[0].length() * ends[1].length());
    assert!(ends[0].dot(ends[1]) < 0.0);
    // 1: opposite derivatives at the leading edge.
    for v in [0.0, 0.3, 0.6, 0.9] {
        let rate = |k: usize| {
            let h = 1e-6;
            let p = |i: f64| sides.point(k, i * h, v);
            (p(0.0) * -11.0 + p(1.0) * 18.0 - p(2.0) * 9.0 + p(3.0) * 2.0) / (6.0 * h)
        };
        let (a, b) = (rate(0), rate(1));
        assert!((a + b).length() < 1e-6 * a.length(), "{v} {:e}", (a + b).length() / a.length());
    }
}

#[test]
fn proposition_2_holds_for_the_final_b_splines() {
    let sides = sides();
    let small = SkinSize { degree: [2, 2], counts: [20, 10], optimised: true };
    proposition_2(&sides, &Skin::new(&sides, 1, small).unwrap());
    proposition_2(&sides, &Skin::within(&sides, 1, [3, 3], 1e-3, 1).unwrap());
}

fn proposition_2(sides: &PointedSides, skin: &Skin) {
    let tip = sides.tip().unwrap();
    let nose = skin.place(0, 0.0);
    for i in 0..=200 {
        let s = f64::from(i) / 200.0;
        let d = skin.surface.derivatives(s, 1.0);
        assert!(d.point.distance(tip.point) < 1e-12);
        assert!(d.u.length() < 1e-9);
        assert!(d.v.dot(tip.normal).abs() < 1e-9 * d.v.length(), "{s} {:e}", d.v.dot(tip.normal));
    }
    for i in 0..=20 {
        let v = f64::from(i) / 20.0;
        let [a, b] = [skin.surface.restricted_u(0.0, nose), skin.surface.restricted_u(nose, 1.0)]
            .map(|part| part.unwrap().first_derivatives(nose, v));
        assert!((a.1 - b.1).length() <= 1e-9 * a.1.length() + 1e-12);
    }
    // The two boundary lines at the trailing edge leave the tip along one line.
    let ends = [0.0, 1.0].map(|s| skin.surface.derivatives(s, 1.0).v);
    let turned = ends[0].cross(ends[1]).length() / (ends[0].length() * ends[1].length());
    assert!(turned < 1e-9, "{turned:e}");
}

#[test]
fn few_control_points_are_enough() {
    // Table 2, for a blade of its size: the sample is half as large.
    let sides = sides();
    let table = [([10, 5], 0.21), ([10, 10], 0.09), ([20, 10], 0.0235)];
    for (counts, paper) in table {
        let skin = Skin::new(&sides, 1, SkinSize { degree: [2, 2], counts, optimised: true }).unwrap();
        let error = 2.0 * skin.deviation(&sides, 61, 25).unwrap().average;
        assert!(error < paper, "{counts:?}: {error} {paper}");
    }
}

#[test]
fn edges_that_make_no_tip_are_refused() {
    let (space, source) = sample();
    let mut other = source.clone();
    other.phi1_deg = LawSpec::Constant(40.0);
    other.thickness = LawSpec::Constant(4.0);
    other.leading_edge = ContourSpec::Points(vec![[-14.0, 12.0], [10.0, 60.0]]);
    let faults = other.plan(&space).err().unwrap();
    let pointers: Vec<&str> = faults.iter().map(|f| f.pointer.as_str()).collect();
    assert_eq!(pointers, ["/thickness", "/phi1_deg", "/leading_edge"], "{faults:?}");
}
