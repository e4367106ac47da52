//! Fillets: tangent at both ends, all of them.

mod common;

use coolinggen_nurbs::{
    Curve, Fillet, Knots, NurbsError, ParametricCurve, RationalCurve, corner_fillet, curvature, fillets,
    signed_curvature,
};
use glam::DVec2;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn circle(centre: DVec2, radius: f64) -> RationalCurve<DVec2> {
    RationalCurve::arc(centre, DVec2::X * radius, DVec2::Y * radius, 0.7, TAU).unwrap()
}

fn verify(f: &Fillet, a: &impl ParametricCurve<DVec2>, b: &impl ParametricCurve<DVec2>, radius: f64) {
    for (c, t, contact) in [(a as &dyn ParametricCurve<DVec2>, f.s, f.first), (b, f.t, f.second)] {
        let [p, d, _] = c.derivatives(t);
        assert!(p.distance(contact) < 1e-14);
        assert!((p.distance(f.centre) - radius).abs() < 1e-10, "{f:?}");
        assert!((p - f.centre).normalize().dot(d.normalize()).abs() < 1e-9 / radius.min(1.0), "{f:?}");
    }
    let arc = f.arc().unwrap();
    assert!(arc.point(0.0).distance(f.first) < 1e-10 && arc.point(1.0).distance(f.second) < 1e-10);
    for k in 0..=10 {
        let x = f64::from(k) / 10.0;
        assert!((arc.point(x).distance(f.centre) - radius).abs() < 1e-12);
    }
    assert!((curvature(&arc, 0.3) * radius - 1.0).abs() < 1e-9);
    let samples = f.sampled(9);
    assert_eq!((samples[0], samples[8]), (f.first, f.second));
    assert!(samples.iter().all(|p| (p.distance(f.centre) - radius).abs() < 1e-10));
    // The arc goes on where the kept part of the first curve ends, and runs into that of the second.
    let travel = |c: &dyn ParametricCurve<DVec2>, t: f64, forward: bool| {
        c.derivatives(t)[1].normalize() * if forward { 1.0 } else { -1.0 }
    };
    let (leave, arrive) = (arc.derivatives(0.0)[1].normalize(), arc.derivatives(1.0)[1].normalize());
    assert!(travel(a, f.s, f.keeps_start).distance(leave) < 1e-8);
    assert!(travel(b, f.t, f.keeps_end).distance(arrive) < 1e-8);
}

proptest! {
    #![proptest_config(common::fixed())]

    #[test]
    fn fillets_of_random_curves_touch_both(
        c in proptest::collection::vec(common::point(), 4..8),
        d in proptest::collection::vec(common::point(), 4..8),
        radius in 0.02f64..0.5,
    ) {
        let smooth = |points: &[glam::DVec3]| {
            let knots = Knots::uniform(3, points.len()).unwrap();
            Curve::new(knots, points.iter().map(|p| p.truncate()).collect()).unwrap()
        };
        let (a, b) = (smooth(&c), smooth(&d));
        prop_assume!([&a, &b].iter().all(|c| (0..=200).all(|k| c.derivatives(f64::from(k) / 200.0)[1].length() > 0.05)));
        for f in fillets(&a, &b, radius).unwrap() {
            if f.sweep.abs() > 1e-6 && f.sweep.abs() < PI - 1e-3 {
                verify(&f, &a, &b, radius);
            }
            let side = signed_curvature(&a, f.s) * (f.centre - f.first).dot(a.derivatives(f.s)[1].perp().normalize());
            prop_assert!((1.0 - side - f.clearance.0).abs() < 1e-9 * (1.0 + side.abs()));
        }
    }

    #[test]
    fn two_crossing_lines_have_four_fillets(angle in 0.1f64..3.0, radius in 0.05f64..0.5) {
        let way = DVec2::from_angle(angle);
        let a = Curve::segment(DVec2::new(-30.0, 0.0), DVec2::new(30.0, 0.0));
        let b = Curve::segment(way * -30.0, way * 30.0);
        let found = fillets(&a, &b, radius).unwrap();
        prop_assert_eq!(found.len(), 4);
        for f in &found {
            verify(f, &a, &b, radius);
            // On the bisectors, at the distance that the half angle says.
            let half = if f.centre.normalize().dot(DVec2::from_angle(0.5 * angle)).abs() > 0.999_999_9 { 0.5 * angle } else { FRAC_PI_2 - 0.5 * angle };
            prop_assert!((f.centre.length() - radius / half.sin()).abs() < 1e-9);
        }
    }
}

#[test]
fn two_circles_have_eight_common_touching_circles() {
    let (a, b) = (circle(DVec2::ZERO, 2.0), circle(DVec2::new(2.0, 0.0), 1.5));
    let found = fillets(&a, &b, 0.6).unwrap();
    assert_eq!(found.len(), 8, "{found:?}");
    for f in &found {
        verify(f, &a, &b, 0.6);
        let (x, y) = (f.centre.length(), f.centre.distance(DVec2::new(2.0, 0.0)));
        assert!((x - 2.6).abs().min((x - 1.4).abs()) < 1e-11 && (y - 2.1).abs().min((y - 0.9).abs()) < 1e-11);
    }
    // A circle that encloses the small one touches it from outside; there its clearance is negative.
    let small = circle(DVec2::new(2.4, 0.0), 0.3);
    let found = fillets(&a, &small, 0.6).unwrap();
    assert!(found.iter().any(|f| f.clearance.1 < 0.0) && found.iter().any(|f| f.clearance.1 > 0.0));
}

#[test]
fn the_thesis_example_has_its_centre_at_the_origin() {
    // Figure 2.13: (2t - 1, 1) and (1, 2t - 1) with radius 1.
    let a = Curve::segment(DVec2::new(-1.0, 1.0), DVec2::new(1.0, 1.0));
    let b = Curve::segment(DVec2::new(1.0, -1.0), DVec2::new(1.0, 1.0));
    let found = fillets(&a, &b, 1.0).unwrap();
    assert_eq!(found.len(), 1);
    let f = found[0];
    assert!(
        f.centre.length() < 1e-14
            && f.first.distance(DVec2::Y) < 1e-14
            && f.second.distance(DVec2::X) < 1e-14
    );
    assert_eq!((f.first_part((0.0, 1.0)), f.second_part((0.0, 1.0))), ((0.0, 0.5), (0.0, 0.5)));
    let next = Curve::segment(DVec2::new(1.0, 1.0), DVec2::new(1.0, -1.0));
    let corner = corner_fillet(&a, &next, 0.25).unwrap();
    assert!(
        corner.centre.distance(DVec2::new(0.75, 0.75)) < 1e-14 && (corner.sweep + FRAC_PI_2).abs() < 1e-14
    );
    assert_eq!(corner.second_part((0.0, 1.0)), (0.125, 1.0));
    let (before, after) = corner.trimmed(&a, &next).unwrap();
    assert!(
        before.point(corner.s).distance(corner.first) < 1e-14
            && after.point(corner.t).distance(corner.second) < 1e-14
    );
    assert_eq!((before.point(0.0), after.point(1.0)), (a.point(0.0), next.point(1.0)));
    assert!(matches!(corner_fillet(&a, &next, 2.5), Err(NurbsError::NotFound { .. })));
    assert!(matches!(fillets(&a, &next, -1.0), Err(NurbsError::BadArgument { .. })));
    let parallel = Curve::segment(DVec2::new(-1.0, 3.0), DVec2::new(1.0, 3.0));
    assert!(matches!(fillets(&a, &parallel, 1.0), Err(NurbsError::Coincident { .. })));
    assert_eq!(fillets(&a, &parallel, 0.9).unwrap(), vec![]);
}
