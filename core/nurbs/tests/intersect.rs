//! Meetings of plane curves: closed forms, brute force, touching, running together.

mod common;

use common::curve;
use coolinggen_nurbs::{
    Crossing, Curve, Knots, NurbsError, ParametricCurve, RationalCurve, TOUCH, intersect_curves,
    intersect_parametric, self_intersections, self_intersections_parametric,
};
use glam::{DMat2, DVec2};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn circle(centre: DVec2, radius: f64) -> RationalCurve<DVec2> {
    RationalCurve::arc(centre, DVec2::X * radius, DVec2::Y * radius, 0.3, TAU).unwrap()
}

/// Crossings of two polygons, as pairs of parameters.
fn polygon_crossings(
    a: &impl ParametricCurve<DVec2>,
    b: &impl ParametricCurve<DVec2>,
    n: i32,
) -> Vec<(f64, f64)> {
    let sample = |c: &dyn ParametricCurve<DVec2>| -> Vec<DVec2> {
        let (s, e) = c.domain();
        (0..=n).map(|i| c.point(s + (e - s) * f64::from(i) / f64::from(n))).collect()
    };
    let (p, q) = (sample(a), sample(b));
    let mut found = vec![];
    for (i, x) in p.windows(2).enumerate() {
        for (j, y) in q.windows(2).enumerate() {
            let (d, e) = (x[1] - x[0], y[1] - y[0]);
            let sides = [
                d.perp_dot(y[0] - x[0]),
                d.perp_dot(y[1] - x[0]),
                e.perp_dot(x[0] - y[0]),
                e.perp_dot(x[1] - y[0]),
            ];
            if sides[0] * sides[1] < 0.0 && sides[2] * sides[3] < 0.0 {
                found.push(((i as f64 + 0.5) / f64::from(n), (j as f64 + 0.5) / f64::from(n)));
            }
        }
    }
    found
}

/// The crossing near a start value, if there is one: polygons may cross where curves only pass close by.
fn newton(a: &Curve<DVec2>, b: &Curve<DVec2>, start: (f64, f64)) -> Option<(f64, f64)> {
    let (mut s, mut t) = start;
    for _ in 0..50 {
        let ([p, d, _], [q, e, _]) = (a.derivatives(s), b.derivatives(t));
        let step = DMat2::from_cols(d, -e).inverse() * (q - p);
        (s, t) = ((s + step.x).clamp(0.0, 1.0), (t + step.y).clamp(0.0, 1.0));
    }
    (a.point(s).distance(b.point(t)) < 1e-12).then_some((s, t))
}

fn check(found: &[Crossing], a: &impl ParametricCurve<DVec2>, b: &impl ParametricCurve<DVec2>) {
    for c in found {
        let (p, q) = (a.point(c.s), b.point(c.t));
        assert!(p.distance(q) <= if c.tangential { TOUCH } else { 2.0 * TOUCH }, "{c:?} {:e}", p.distance(q));
        assert!(p.distance(c.point) <= TOUCH);
    }
    assert!(found.windows(2).all(|w| w[0].s <= w[1].s));
}

proptest! {
    #![proptest_config(common::fixed())]

    #[test]
    fn circles_meet_where_they_should(angle in 0.0f64..TAU, r in 0.2f64..2.0, far in 0.0f64..3.2) {
        let apart = (far - (1.0 - r).abs()).abs().min((far - (1.0 + r)).abs());
        prop_assume!(apart > 1e-6);
        let (a, b) = (circle(DVec2::ZERO, 1.0), circle(DVec2::from_angle(angle) * far, r));
        let found = intersect_curves(&a, &b).unwrap();
        check(&found, &a, &b);
        let expected = if far > (1.0 - r).abs() && far < 1.0 + r { 2 } else { 0 };
        prop_assert_eq!(found.len(), expected, "{:?}", found);
        for c in &found {
            let along = (1.0 + far * far - r * r) / (2.0 * far);
            let across = (1.0 - along * along).sqrt();
            let local = c.point.rotate(DVec2::from_angle(-angle));
            prop_assert!(!c.tangential);
            prop_assert!((local.x - along).abs() < 1e-11 && (local.y.abs() - across).abs() < 1e-11 / across.max(1e-3));
        }
        prop_assert_eq!(intersect_parametric(&a, &b).unwrap().len(), expected);
    }

    #[test]
    fn touching_circles_touch_once(angle in 0.0f64..TAU, r in 0.2f64..0.9) {
        for far in [1.0 - r, 1.0 + r] {
            let (a, b) = (circle(DVec2::ZERO, 1.0), circle(DVec2::from_angle(angle) * far, r));
            for found in [intersect_curves(&a, &b).unwrap(), intersect_parametric(&a, &b).unwrap()] {
                // At the seam of a circle the point has two parameters.
                let seam = |t: f64| !(1e-3..=1.0 - 1e-3).contains(&t);
                prop_assert!(found.len() == 1 || found.iter().all(|c| seam(c.s) || seam(c.t)), "{:?}", found);
                prop_assert!(!found.is_empty() && found[0].tangential);
                prop_assert!(found[0].point.distance(DVec2::from_angle(angle)) < 1e-9, "{:?}", found);
            }
        }
    }

    #[test]
    fn almost_touching_circles_are_told_apart(angle in 0.0f64..TAU, r in 0.2f64..0.9, gap in -9.0f64..-4.0) {
        let gap = 10f64.powf(gap);
        let a = circle(DVec2::ZERO, 1.0);
        let outside = circle(DVec2::from_angle(angle) * (1.0 + r + gap), r);
        prop_assert_eq!(intersect_curves(&a, &outside).unwrap().len(), 0);
        let across = circle(DVec2::from_angle(angle) * (1.0 + r - gap), r);
        let found = intersect_curves(&a, &across).unwrap();
        // Below 1e-6 of the size, that is gaps below about 1e-12, the two would count as one.
        prop_assert_eq!(found.len(), 2, "{:?}", found);
    }

    #[test]
    fn random_curves_meet_where_polygons_do(c in curve(1..=5), d in curve(1..=5)) {
        let (a, b): (Curve<DVec2>, Curve<DVec2>) = (c.map(|p| p.truncate()), d.map(|p| p.truncate()));
        let found = intersect_curves(&a, &b).unwrap();
        check(&found, &a, &b);
        let general = intersect_parametric(&a, &b).unwrap();
        check(&general, &a, &b);
        prop_assert_eq!(found.len(), general.len());
        for (s, t) in polygon_crossings(&a, &b, 400).into_iter().filter_map(|p| newton(&a, &b, p)) {
            let near = found.iter().any(|c| (c.s - s).abs() < 1e-5 && (c.t - t).abs() < 1e-5);
            prop_assert!(near, "{} {} {:?}", s, t, found);
        }
    }

    #[test]
    fn random_curves_meet_themselves_where_polygons_do(c in curve(2..=5)) {
        let a: Curve<DVec2> = c.map(|p| p.truncate());
        let found = self_intersections(&a).unwrap();
        check(&found, &a, &a);
        prop_assert!(found.iter().all(|c| c.s < c.t));
        let polygons = polygon_crossings(&a, &a, 400).into_iter().filter_map(|p| newton(&a, &a, p));
        for (s, t) in polygons.filter(|(s, t)| t - s > 0.01) {
            let near = found.iter().any(|c| (c.s - s).abs() < 1e-5 && (c.t - t).abs() < 1e-5);
            prop_assert!(near, "{} {} {:?}", s, t, found);
        }
        prop_assert_eq!(self_intersections_parametric(&a).unwrap().len(), found.len());
    }
}

#[test]
fn two_cubics_meet_nine_times() {
    // Graphs of Chebyshev polynomials of degree 3, one turned by a right angle.
    let x = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0];
    let y = [-1.0, 5.0, -5.0, 1.0];
    let a = Curve::bezier(x.iter().zip(&y).map(|(&x, &y)| DVec2::new(x, y)).collect()).unwrap();
    let b = a.map(|p| DVec2::new(p.y, p.x));
    let found = intersect_curves(&a, &b).unwrap();
    check(&found, &a, &b);
    assert_eq!(found.len(), 9, "{found:?}");
    for c in &found {
        // T3(T3(x)) = T9(x) = x has the roots cos(k pi / 4) and cos(k pi / 5).
        let angle = c.point.x.clamp(-1.0, 1.0).acos() / PI;
        let (four, five) = ((4.0 * angle).round() / 4.0, (5.0 * angle).round() / 5.0);
        let nearest = (angle - four).abs().min((angle - five).abs());
        assert!(nearest < 1e-7, "{c:?} {nearest}");
    }
}

#[test]
fn ends_on_the_other_curve_count() {
    let a = Curve::segment(DVec2::new(-1.0, 0.0), DVec2::new(1.0, 0.0));
    let b = Curve::segment(DVec2::new(0.3, 0.0), DVec2::new(0.5, 2.0));
    let found = intersect_curves(&a, &b).unwrap();
    assert_eq!(found.len(), 1);
    assert!(found[0].point.distance(DVec2::new(0.3, 0.0)) < 1e-12 && found[0].t == 0.0);
    let corner = Curve::segment(DVec2::new(1.0, 0.0), DVec2::new(1.0, 1.0));
    assert_eq!(intersect_curves(&a, &corner).unwrap().len(), 1);
    let short = Curve::segment(DVec2::new(1.0 + 1e-8, 0.0), DVec2::new(1.0, 1.0));
    assert_eq!(intersect_curves(&a, &short).unwrap().len(), 0);
}

#[test]
fn curves_that_run_together_are_refused() {
    let a = circle(DVec2::ZERO, 1.0);
    let part = a.restricted(0.1, 0.6).unwrap();
    assert!(matches!(intersect_curves(&a, &part), Err(NurbsError::Coincident { .. })));
    let line = Curve::segment(DVec2::ZERO, DVec2::X);
    let longer = Curve::segment(DVec2::new(0.5, 0.0), DVec2::new(3.0, 0.0));
    assert!(matches!(intersect_curves(&line, &longer), Err(NurbsError::Coincident { .. })));
    let next = Curve::segment(DVec2::new(1.0, 0.0), DVec2::new(3.0, 0.0));
    let found = intersect_curves(&line, &next).unwrap();
    assert!(found.len() == 1 && found[0].point.distance(DVec2::X) < 1e-9, "{found:?}");
}

#[test]
fn contacts_of_higher_order_are_one_point() {
    // y = 0 against y = x^3 (crossing with equal curvature) and y = x^4 (touching with equal curvature).
    let line = Curve::segment(DVec2::new(-1.0, 0.0), DVec2::new(1.3, 0.0));
    let t3 = Curve::bezier(
        vec![(-1.0, -1.0), (-1.0 / 3.0, 1.0), (1.0 / 3.0, -1.0), (1.0, 1.0)]
            .into_iter()
            .map(DVec2::from)
            .collect(),
    )
    .unwrap();
    let t4 = Curve::bezier(
        vec![(-1.0, 1.0), (-0.5, -1.0), (0.0, 1.0), (0.5, -1.0), (1.0, 1.0)]
            .into_iter()
            .map(DVec2::from)
            .collect(),
    )
    .unwrap();
    for c in [t3, t4] {
        let found = intersect_curves(&line, &c).unwrap();
        assert_eq!(found.len(), 1, "{found:?}");
        // |x|^3 stays below 1e-10 for half a thousandth.
        assert!(found[0].tangential && found[0].point.length() < 5e-3, "{found:?}");
    }
}

#[test]
fn a_nodal_cubic_meets_itself_at_its_node() {
    // (t^2 - 1, t^3 - t) for t in [-1.5, 1.5] passes the origin at t = -1 and 1.
    let knots = Knots::clamped(3, &[-1.5, 1.5]).unwrap();
    let f = |a: f64, b: f64, c: f64| {
        DVec2::new((a * b + a * c + b * c) / 3.0 - 1.0, a * b * c - (a + b + c) / 3.0)
    };
    let (l, h) = (-1.5, 1.5);
    let c = Curve::new(knots, vec![f(l, l, l), f(l, l, h), f(l, h, h), f(h, h, h)]).unwrap();
    for found in [self_intersections(&c).unwrap(), self_intersections_parametric(&c).unwrap()] {
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(
            (found[0].s + 1.0).abs() < 1e-12
                && (found[0].t - 1.0).abs() < 1e-12
                && found[0].point.length() < 1e-12
        );
    }
    // A cusp is no crossing, a closed curve's seam neither.
    let cusp = Curve::bezier(
        vec![(1.0, -1.0), (-1.0 / 3.0, 1.0), (-1.0 / 3.0, -1.0), (1.0, 1.0)]
            .into_iter()
            .map(DVec2::from)
            .collect(),
    )
    .unwrap();
    assert_eq!(self_intersections(&cusp).unwrap(), vec![]);
    assert_eq!(self_intersections(&circle(DVec2::ZERO, 2.0)).unwrap(), vec![]);
    let drop = coolinggen_nurbs::interpolate_closed(
        &[0.0, 0.2, 0.5, 0.8, 1.0],
        &[(2.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (2.0, 0.0)].map(DVec2::from),
    )
    .unwrap();
    assert_eq!(self_intersections(&drop).unwrap(), vec![]);
}
