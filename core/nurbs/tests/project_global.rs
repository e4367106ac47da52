//! Closest points without start values: global minima against brute force and closed forms; curves too.

mod common;

use common::{blade, curve, revolved, surface};
use coolinggen_nurbs::{
    Curve, CurveProjector, Homogeneous, Knots, NurbsError, ParametricCurve, ParametricSurface, RationalCurve,
    SurfaceProjector, project_on_curve,
};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// The unit circle in four quarters on [0, 4].
fn circle() -> RationalCurve<DVec2> {
    let h = 0.5f64.sqrt();
    let square =
        [(1., 0.), (1., 1.), (0., 1.), (-1., 1.), (-1., 0.), (-1., -1.), (0., -1.), (1., -1.), (1., 0.)];
    let knots = Knots::new(2, vec![0., 0., 0., 1., 1., 2., 2., 3., 3., 4., 4., 4.]).unwrap();
    let points = square.map(DVec2::from);
    RationalCurve::new(knots, &points, &[1., h, 1., h, 1., h, 1., h, 1.]).unwrap()
}

proptest! {
    #![proptest_config(common::fixed())]

    #[test]
    fn no_sample_of_a_surface_is_closer(s in surface(), q in common::point()) {
        // Folded, kinked and self-intersecting surfaces with many local minima.
        let found = SurfaceProjector::new(&s, false).closest(q).unwrap();
        prop_assert!((s.point(found.u, found.v).distance(q) - found.distance).abs() < 1e-14);
        for i in 0..=60 {
            for j in 0..=60 {
                let p = s.point(f64::from(i) / 60.0, f64::from(j) / 60.0);
                prop_assert!(p.distance(q) > found.distance - 1e-13);
            }
        }
    }

    #[test]
    fn no_sample_of_a_curve_is_closer(c in curve(1..=7), q in common::point()) {
        let found = CurveProjector::new(&c, false).closest(q).unwrap();
        prop_assert!((c.point(found.t).distance(q) - found.distance).abs() < 1e-14);
        for i in 0..=2000 {
            prop_assert!(c.point(f64::from(i) / 2000.0).distance(q) > found.distance - 1e-13);
        }
    }

    #[test]
    fn no_sample_of_a_rational_curve_is_closer(c in curve(2..=4), q in common::point()) {
        let weighted: Curve<Homogeneous<DVec2>> =
            c.map(|p| Homogeneous::new(p.truncate(), 1.2 + p.z));
        let c = RationalCurve::from_homogeneous(weighted).unwrap();
        let found = CurveProjector::new(&c, false).closest(q.truncate()).unwrap();
        for i in 0..=2000 {
            prop_assert!(c.point(f64::from(i) / 2000.0).distance(q.truncate()) > found.distance - 1e-13);
        }
    }

    #[test]
    fn the_foot_on_a_circle_is_radial(q in common::point(), hint in -9.0f64..9.0) {
        let q = 2.0 * q.truncate();
        prop_assume!(q.length() > 1e-3);
        let (c, angle) = (circle(), q.to_angle().rem_euclid(TAU));
        for found in [CurveProjector::new(&c, true).closest(q).unwrap(), project_on_curve(&c, q, hint, true).unwrap()] {
            prop_assert!((found.distance - (q.length() - 1.0).abs()).abs() < 1e-14);
            let turn = (found.point.to_angle() - angle).rem_euclid(TAU);
            prop_assert!(turn.min(TAU - turn) < 1e-11);
        }
    }

    #[test]
    fn a_point_off_the_blade_knows_its_distance(u in 0.0f64..=1.0, v in 0.0f64..=1.0, d in -0.4f64..3.0) {
        // Outside a convex side and slightly inside, the foot is known.
        let s = blade();
        let at = s.derivatives(u, v);
        let outward = if at.normal().dot(at.point - DVec3::new(0.1 * 70.0 * v, 0.0, at.point.z)) > 0.0 { 1.0 } else { -1.0 };
        let q = at.point + at.normal() * (d * outward);
        let found = SurfaceProjector::new(&s, true).closest(q).unwrap();
        prop_assert!(found.distance <= d.abs() + 1e-12);
    }
}

#[test]
fn the_centre_of_a_sphere_is_as_far_as_the_radius() {
    let h = 0.5f64.sqrt();
    let meridian = [(0.0, -2.0), (2.0, -2.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
    let knots = Knots::new(2, vec![0., 0., 0., 1., 1., 2., 2., 2.]).unwrap();
    let sphere = revolved(knots, &meridian, &[1., h, 1., h, 1.]);
    let projector = SurfaceProjector::new(sphere, true);
    let found = projector.closest(DVec3::ZERO).unwrap();
    assert!((found.distance - 2.0).abs() < 1e-14);
    for k in 0..200 {
        let (a, z) = (f64::from(k) * 2.4, f64::from(k) / 100.0 - 0.995);
        let q = DVec3::new((1.0 - z * z).sqrt() * a.cos(), (1.0 - z * z).sqrt() * a.sin(), z)
            * (0.02 * f64::from(k) + 0.01);
        let found = projector.closest(q).unwrap();
        assert!((found.distance - (q.length() - 2.0).abs()).abs() < 1e-12, "{q} {found:?}");
    }
    let (centre, radius) = projector.bounding_sphere();
    assert!(centre.length() < 1e-14 && radius < 2.0 * 3f64.sqrt() + 1e-12);
}

#[test]
fn every_point_of_a_torus_axis_is_solved() {
    // All directions are equally close: the proof must not take forever.
    let h = 0.5f64.sqrt();
    let square =
        [(4., 0.), (4., 1.), (3., 1.), (2., 1.), (2., 0.), (2., -1.), (3., -1.), (4., -1.), (4., 0.)];
    let knots = Knots::new(2, vec![0., 0., 0., 1., 1., 2., 2., 3., 3., 4., 4., 4.]).unwrap();
    let torus = revolved(knots, &square, &[1., h, 1., h, 1., h, 1., h, 1.]);
    let projector = SurfaceProjector::new(torus, true);
    for z in [0.0, 0.3, 1.0, 4.0] {
        let found = projector.closest(DVec3::Z * z).unwrap();
        assert!((found.distance - (DVec2::new(3.0, z).length() - 1.0)).abs() < 1e-12, "{z} {found:?}");
    }
}

#[test]
fn the_minimum_on_a_kink_is_found() {
    let roof = Curve::new(
        Knots::clamped(1, &[0.0, 1.0, 2.0]).unwrap(),
        vec![DVec2::new(-1.0, 0.0), DVec2::new(0.0, 1.0), DVec2::new(1.0, 0.0)],
    )
    .unwrap();
    for hint in [0.0, 0.3, 1.0, 1.9] {
        let found = project_on_curve(&roof, DVec2::new(0.05, 2.0), hint, false).unwrap();
        assert!(found.point.distance(DVec2::Y) < 1e-14, "{found:?}");
    }
    // Below the ridge both slopes have a minimum: the hint decides, the projector takes the closer one.
    let near = DVec2::new(0.1, 0.5);
    assert!(project_on_curve(&roof, near, 0.5, false).unwrap().t < 1.0);
    assert!(CurveProjector::new(&roof, false).closest(near).unwrap().t > 1.0);
    assert!(matches!(
        project_on_curve(&roof, near, f64::INFINITY, false),
        Err(NurbsError::BadArgument { .. })
    ));
}
