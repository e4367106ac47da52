//! Closest points on surfaces: against closed forms, brute force and the conditions of a minimum.

mod common;

use common::{revolved, surface};
use coolinggen_nurbs::{Knots, NurbsError, ParametricSurface, RationalSurface, Surface, project_on_surface};
use glam::DVec3;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Least distance over a fine grid.
fn brute_force(s: &impl ParametricSurface<DVec3>, p: DVec3, n: i32) -> f64 {
    let at = |(a, b): (f64, f64), i: i32| a + (b - a) * f64::from(i) / f64::from(n);
    let (du, dv) = s.domain();
    (0..=n)
        .flat_map(|i| (0..=n).map(move |j| (i, j)))
        .map(|(i, j)| s.point(at(du, i), at(dv, j)).distance(p))
        .fold(f64::INFINITY, f64::min)
}

/// A sphere of radius 2 as a surface of revolution of a half circle, u around, v from pole to pole.
fn sphere() -> RationalSurface<DVec3> {
    let h = 0.5f64.sqrt();
    let meridian = [(0.0, -2.0), (2.0, -2.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
    revolved(Knots::new(2, vec![0., 0., 0., 1., 1., 2., 2., 2.]).unwrap(), &meridian, &[1., h, 1., h, 1.])
}

/// A torus, tube 1 around a circle of 3.
fn torus() -> RationalSurface<DVec3> {
    let h = 0.5f64.sqrt();
    let square =
        [(4., 0.), (4., 1.), (3., 1.), (2., 1.), (2., 0.), (2., -1.), (3., -1.), (4., -1.), (4., 0.)];
    let knots = Knots::new(2, vec![0., 0., 0., 1., 1., 2., 2., 3., 3., 4., 4., 4.]).unwrap();
    revolved(knots, &square, &[1., h, 1., h, 1., h, 1., h, 1.])
}

proptest! {
    #![proptest_config(common::fixed())]

    #[test]
    fn the_result_is_a_minimum_near_the_hint(s in surface(), q in common::point(), hint in (0.0f64..=1.0, 0.0f64..=1.0)) {
        // Kinked, folded and self-intersecting surfaces: whatever descent finds must be a local minimum.
        let found = project_on_surface(&s, q, hint, false).unwrap();
        prop_assert!((found.point.distance(q) - found.distance).abs() < 1e-14);
        prop_assert!(found.point.distance(s.point(found.u, found.v)) < 1e-13);
        prop_assert!(found.distance <= s.point(hint.0, hint.1).distance(q) + 1e-14);
        for k in 0..24 {
            let (sin, cos) = (TAU * f64::from(k) / 24.0).sin_cos();
            let u = (found.u + 1e-6 * cos).clamp(0.0, 1.0);
            let v = (found.v + 1e-6 * sin).clamp(0.0, 1.0);
            prop_assert!(s.point(u, v).distance(q) > found.distance - 1e-12, "{:?}", found);
        }
    }

    #[test]
    fn the_foot_on_a_sphere_is_radial(q in common::point(), hint in (0.0f64..4.0, 0.2f64..1.8)) {
        prop_assume!(q.length() > 0.05 && q.truncate().length() > 1e-3);
        for q in [q, 3.0 * q / q.length()] {
            let found = project_on_surface(&sphere(), q, hint, true).unwrap();
            prop_assert!((found.distance - (q.length() - 2.0).abs()).abs() < 1e-12, "{:?}", found);
            prop_assert!(found.point.distance(q * (2.0 / q.length())) < 1e-11, "{:?}", found);
        }
    }

    #[test]
    fn the_foot_on_a_torus_is_on_the_radius_of_its_tube(
        a in 0.0f64..TAU, b in 0.0f64..TAU, r in prop_oneof![0.2f64..0.99, 1.01f64..1.9],
        off in (-0.3f64..0.3, -0.3f64..0.3),
    ) {
        let ring = DVec3::new(a.cos(), a.sin(), 0.0);
        let q = ring * (3.0 + r * b.cos()) + DVec3::Z * (r * b.sin());
        let hint = (a / TAU * 4.0 + off.0, (b / TAU * 4.0 + off.1).clamp(0.0, 4.0));
        let found = project_on_surface(&torus(), q, hint, true).unwrap();
        // Near the ring's equator v = 0 the hint may be held at the border v = 0, 4 of a surface not closed in v.
        if b > 0.3 && b < TAU - 0.3 {
            prop_assert!((found.distance - (r - 1.0).abs()).abs() < 1e-12, "{:?}", found);
        }
    }

    #[test]
    fn a_point_off_the_surface_along_the_normal_comes_back(
        u in 0.0f64..=1.0, v in 0.0f64..=1.0, d in -0.5f64..0.5, shift in (-0.02f64..0.02, -0.02f64..0.02),
    ) {
        let s = common::blade();
        let at = s.derivatives(u, v);
        let q = at.point + at.normal() * d;
        let found = project_on_surface(&s, q, (u + shift.0, v + shift.1), true).unwrap();
        prop_assert!((found.distance - d.abs()).abs() < 1e-11, "{:?}", found);
        prop_assert!(found.point.distance(at.point) < 1e-10);
    }
}

#[test]
fn brute_force_agrees_on_a_wavy_patch() {
    let points = (0..64).map(|k| {
        let (i, j) = (f64::from(k / 8), f64::from(k % 8));
        DVec3::new(i, j, 0.4 * (1.3 * i).sin() * (0.9 * j).cos())
    });
    let k = Knots::uniform(3, 8).unwrap();
    let s = Surface::new(k.clone(), k, points.collect()).unwrap();
    for k in 0..40 {
        let q = DVec3::new(f64::from(k * 37 % 80) / 10.0 - 0.5, f64::from(k * 53 % 80) / 10.0 - 0.5, 0.9);
        let hint = (q.x / 7.0, q.y / 7.0);
        let found = project_on_surface(&s, q, hint, false).unwrap();
        let least = brute_force(&s, q, 400);
        assert!(found.distance <= least + 1e-12 && found.distance > least - 1e-3, "{q} {found:?} {least}");
    }
}

#[test]
fn the_seam_of_a_closed_kinked_surface_is_no_obstacle() {
    // A drop: the seam is a sharp edge at +x. From outside the edge is the closest; from inside a side is.
    let outline = [(2.0, 0.0), (0.0, 1.0), (-1.0, 0.8), (-1.0, -0.8), (0.0, -1.0), (2.0, 0.0)];
    let net = outline.iter().flat_map(|&(x, y)| [0.0, 1.0].map(|z| DVec3::new(x, y, z))).collect();
    let s = Surface::new(Knots::uniform(3, 6).unwrap(), Knots::uniform(1, 2).unwrap(), net).unwrap();
    for hint in [0.01, 0.99] {
        let edge = project_on_surface(&s, DVec3::new(2.5, 0.1, 0.5), (hint, 0.2), true).unwrap();
        assert!(edge.point.distance(DVec3::new(2.0, 0.0, 0.5)) < 1e-12);
        // Within the edge each side has its minimum.
        let inside = project_on_surface(&s, DVec3::new(1.5, 0.05, 0.5), (hint, 0.2), true).unwrap();
        assert!((inside.point.y > 0.0) == (hint < 0.5) && inside.distance < 0.3, "{inside:?}");
        // From the other side of the edge the descent goes over it.
        let above = project_on_surface(&s, DVec3::new(1.8, 0.8, 0.5), (hint, 0.2), true).unwrap();
        assert!(above.point.y > 0.0 && above.u < 0.2 && above.u > 0.0, "{above:?}");
    }
}

#[test]
fn a_stationary_start_that_is_no_minimum_is_left() {
    let s = sphere();
    // The far side of the sphere, exactly opposite: a maximum of the distance.
    let q = DVec3::new(1.0, 0.0, 0.0);
    let found = project_on_surface(&s, q, (2.0, 1.0), true).unwrap();
    assert!((found.distance - 1.0).abs() < 1e-12, "{found:?}");
}

#[test]
fn a_flat_patch_through_the_origin_and_nonsense() {
    let net = vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::X + DVec3::Y];
    let k = Knots::uniform(1, 2).unwrap();
    let s = Surface::new(k.clone(), k, net).unwrap();
    let found = project_on_surface(&s, DVec3::ZERO, (0.7, 0.3), false).unwrap();
    assert!(found.distance < 1e-15 && found.u.abs() < 1e-15);
    let corner = project_on_surface(&s, DVec3::new(2.0, -1.0, 1.0), (0.2, 0.3), false).unwrap();
    assert_eq!((corner.u, corner.v), (1.0, 0.0));
    let nonsense = project_on_surface(&s, DVec3::ZERO, (f64::NAN, 0.3), false);
    assert!(matches!(nonsense, Err(NurbsError::BadArgument { .. })));
    let nonsense = project_on_surface(&s, DVec3::NAN, (0.0, 0.3), false);
    assert!(matches!(nonsense, Err(NurbsError::BadArgument { .. })));
}
