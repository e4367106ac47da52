//! Lengths, curvatures and rays against closed forms.

mod common;

use common::{blade, curve, revolved};
use coolinggen_nurbs::{
    ArcLength, Curve, CurveProjector, Knots, NurbsError, ParametricCurve, ParametricSurface, RationalCurve,
    SurfaceProjector, curvature, march_to_curve, march_to_surface, ray_meets_surface, signed_curvature,
};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn circle(radius: f64) -> RationalCurve<DVec2> {
    RationalCurve::arc(DVec2::new(0.3, -0.2), DVec2::X * radius, DVec2::Y * radius, 0.0, TAU).unwrap()
}

proptest! {
    #![proptest_config(common::fixed())]

    #[test]
    fn lengths_and_parameters_are_inverse(c in curve(1..=5), share in 0.0f64..=1.0) {
        let length = ArcLength::new(&c, 1e-10).unwrap();
        // Chords fall short by the curvature.
        let polygon: f64 = c.knots().breaks().windows(2).map(|b| {
            let at = |i: i32| c.point(b[0] + (b[1] - b[0]) * f64::from(i) / 4000.0);
            (0..4000).map(|i| at(i).distance(at(i + 1))).sum::<f64>()
        }).sum();
        prop_assert!(length.total() > polygon - 1e-9 && length.total() < polygon * (1.0 + 1e-5), "{} {}", length.total(), polygon);
        let t = length.parameter(share * length.total());
        prop_assert!((length.length(t) - share * length.total()).abs() < 1e-12 * length.total());
    }

    #[test]
    fn rays_meet_a_circle_where_they_should(from in 0.0f64..TAU, at in -1.2f64..1.2, far in 2.0f64..9.0) {
        let c = circle(1.5);
        let projector = CurveProjector::new(&c, true);
        let centre = DVec2::new(0.3, -0.2);
        let way = DVec2::from_angle(from);
        let origin = centre + way.perp() * (1.5 * at) - way * far;
        let hit = march_to_curve(&projector, origin, way * 3.0).unwrap();
        if at.abs() > 1.0 {
            prop_assert!(hit.is_none());
        } else {
            let hit = hit.unwrap();
            let expected = far - 1.5 * (1.0 - at * at).sqrt();
            // Near grazing the length is less certain than the point.
            let slack = 1e-12 / (1.0 - at * at).sqrt().max(1e-6);
            prop_assert!((hit.distance - expected).abs() < slack, "{} {}", hit.distance, expected);
            prop_assert!(hit.point.distance(origin + way * hit.distance) < 1e-9);
            prop_assert!(hit.point.distance(c.point(hit.t)) < 1e-14);
        }
    }

    #[test]
    fn the_first_of_several_hits_is_found(c in curve(2..=4), q in common::point(), angle in 0.0f64..TAU) {
        let c: Curve<DVec2> = c.map(|p| p.truncate());
        let (origin, way) = (q.truncate() * 1.5, DVec2::from_angle(angle));
        let hit = march_to_curve(&CurveProjector::new(&c, false), origin, way).unwrap();
        // Sign changes of the distance from the ray, by brute force.
        let side = |t: f64| way.perp_dot(c.point(t) - origin);
        let mut first = f64::INFINITY;
        for i in 0..4000 {
            let (mut a, mut b) = (f64::from(i) / 4000.0, f64::from(i + 1) / 4000.0);
            if side(a) * side(b) < 0.0 {
                for _ in 0..60 {
                    let m = 0.5 * (a + b);
                    if side(a) * side(m) <= 0.0 { b = m } else { a = m }
                }
                let s = way.dot(c.point(a) - origin);
                if s >= 0.0 { first = first.min(s) }
            }
        }
        match hit {
            Some(h) => {
                prop_assert!(h.point.distance(origin + way * h.distance) < 1e-9);
                // A touch may come before the first crossing that brute force sees.
                prop_assert!(h.distance <= first + 1e-8, "{} {}", h.distance, first);
            }
            None => prop_assert!(first == f64::INFINITY, "missed {}", first),
        }
    }

    #[test]
    fn rays_meet_a_sphere_where_they_should(dir in common::point(), side in common::point(), at in 0.0f64..1.2) {
        prop_assume!(dir.length() > 0.1 && dir.cross(side).length() > 0.1);
        let h = 0.5f64.sqrt();
        let meridian = [(0.0, -2.0), (2.0, -2.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        let knots = Knots::new(2, vec![0., 0., 0., 1., 1., 2., 2., 2.]).unwrap();
        let projector = SurfaceProjector::new(revolved(knots, &meridian, &[1., h, 1., h, 1.]), true);
        let way = dir.normalize();
        let across = (side - way * side.dot(way)).normalize();
        let origin = across * (2.0 * at) - way * 5.0;
        let hit = march_to_surface(&projector, origin, dir).unwrap();
        if at > 1.0 {
            prop_assert!(hit.is_none());
        } else {
            let hit = hit.unwrap();
            let root = (1.0 - at * at).sqrt();
            prop_assert!((hit.distance - (5.0 - 2.0 * root)).abs() < 1e-11 / root.max(1e-5), "{:?}", hit);
            prop_assert!(hit.point.distance(origin + way * hit.distance) < 1e-9);
        }
    }

    #[test]
    fn a_ray_from_a_known_place_comes_back(u in 0.0f64..=1.0, v in 0.05f64..=0.95, tilt in common::point(), far in 0.1f64..20.0) {
        // A bore's ray: from a point off the blade back to it, with a hint a little off.
        let s = blade();
        let at = s.derivatives(u, v);
        let way = (at.normal() + 0.5 * tilt / tilt.length().max(1.0)).normalize();
        let hit = ray_meets_surface(&s, at.point - way * far, way, (u + 0.004, v - 0.004), far * 0.9, true).unwrap();
        prop_assert!(hit.point.distance(at.point) < 1e-9, "{:?}", hit);
        prop_assert!((hit.distance - far).abs() < 1e-9);
        let same = (hit.u - u).abs();
        prop_assert!(same.min(1.0 - same) < 1e-9 && (hit.v - v).abs() < 1e-9);
    }

    #[test]
    fn curvature_of_a_circle_is_one_over_its_radius(radius in 0.01f64..100.0, t in 0.0f64..=1.0) {
        let c = circle(radius);
        prop_assert!((signed_curvature(&c, t) * radius - 1.0).abs() < 1e-12);
        prop_assert!((curvature(&c, t) * radius - 1.0).abs() < 1e-12);
        prop_assert!((signed_curvature(&RationalCurve::from_homogeneous(c.homogeneous().reversed()).unwrap(), t) * radius + 1.0).abs() < 1e-12);
    }
}

#[test]
fn the_length_of_a_circle_and_of_an_ellipse() {
    let length = ArcLength::new(circle(2.0), 1e-13).unwrap();
    assert!((length.total() - 4.0 * PI).abs() < 1e-13);
    assert!((length.parameter(PI) - 0.25).abs() < 1e-14);
    // Semi-axes 2 and 1: 8 E(3/4), E the complete elliptic integral (Abramowitz and Stegun 17.1).
    let ellipse = RationalCurve::arc(DVec2::ZERO, DVec2::X * 2.0, DVec2::Y, 0.0, TAU).unwrap();
    let length = ArcLength::new(ellipse, 1e-12).unwrap();
    assert!((length.total() - 9.688448220547675).abs() < 1e-12, "{}", length.total());
    assert!(matches!(ArcLength::new(circle(1.0), 0.0), Err(NurbsError::BadArgument { .. })));
}

#[test]
fn the_length_over_a_cusp_is_that_of_both_sides() {
    // (t^2, t^3) from -1 to 1: 2/27 (13 sqrt 13 - 8).
    let c = Curve::bezier(vec![
        DVec2::new(1.0, -1.0),
        DVec2::new(-1.0 / 3.0, 1.0),
        DVec2::new(-1.0 / 3.0, -1.0),
        DVec2::new(1.0, 1.0),
    ])
    .unwrap();
    let length = ArcLength::new(&c, 1e-12).unwrap();
    assert!((length.total() - 2.0 / 27.0 * (13.0 * 13f64.sqrt() - 8.0)).abs() < 1e-12, "{}", length.total());
}

#[test]
fn a_touching_ray_touches() {
    let c = circle(1.5);
    let projector = CurveProjector::new(&c, true);
    let hit = march_to_curve(&projector, DVec2::new(-4.0, 1.3), DVec2::X).unwrap().unwrap();
    assert!(
        hit.point.distance(DVec2::new(0.3, 1.3)) < 1e-6
            && hit.point.distance(DVec2::new(hit.point.x, 1.3)) < 1e-9
    );
    assert!(march_to_curve(&projector, DVec2::new(-4.0, 1.3 + 1e-6), DVec2::X).unwrap().is_none());
    let h = 0.5f64.sqrt();
    let meridian = [(0.0, -2.0), (2.0, -2.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
    let knots = Knots::new(2, vec![0., 0., 0., 1., 1., 2., 2., 2.]).unwrap();
    let sphere = SurfaceProjector::new(revolved(knots, &meridian, &[1., h, 1., h, 1.]), true);
    let hit = march_to_surface(&sphere, DVec3::new(-4.0, 2.0, 0.3), DVec3::X).unwrap();
    assert!(hit.is_none());
    let y = (4.0 - 0.09f64).sqrt();
    let hit = march_to_surface(&sphere, DVec3::new(-4.0, y, 0.3), DVec3::X).unwrap().unwrap();
    assert!(
        hit.point.distance(DVec3::new(0.0, y, 0.3)) < 1e-4
            && hit.point.distance(DVec3::new(hit.point.x, y, 0.3)) < 1e-9
    );
    let zero = march_to_surface(&sphere, DVec3::ZERO, DVec3::ZERO);
    assert!(matches!(zero, Err(NurbsError::BadArgument { .. })));
    // From inside the sphere, from on it, and away from it.
    let inside = march_to_surface(&sphere, DVec3::ZERO, DVec3::new(1.0, 1.0, 0.2)).unwrap().unwrap();
    assert!((inside.distance - 2.0).abs() < 1e-12);
    let away = march_to_surface(&sphere, DVec3::X * 3.0, DVec3::X).unwrap();
    assert!(away.is_none());
}
