//! Offsets: exact derivatives, and trimmed ones whose every point has the right distance.

mod common;

use common::curve;
use coolinggen_nurbs::{
    BezierCurve, Curve, CurveProjector, Knots, NurbsError, OffsetCurve, OffsetPiece, OffsetSpan,
    ParametricCurve, RationalCurve, interpolate_closed, self_intersections_parametric, trimmed_offset,
};
use glam::DVec2;
use proptest::prelude::*;
use std::f64::consts::TAU;

fn circle(radius: f64, sense: f64) -> RationalCurve<DVec2> {
    RationalCurve::arc(DVec2::new(0.3, -0.2), DVec2::X * radius, DVec2::Y * radius, 0.3, sense * TAU).unwrap()
}

/// A closed curve through points, counterclockwise.
fn closed(points: &[(f64, f64)]) -> Curve<DVec2> {
    let mut points: Vec<DVec2> = points.iter().copied().map(DVec2::from).collect();
    points.push(points[0]);
    let mut t = vec![0.0];
    for w in points.windows(2) {
        t.push(t[t.len() - 1] + w[0].distance(w[1]).sqrt());
    }
    interpolate_closed(&t, &points).unwrap()
}

/// An airfoil of chord 40: camber 6, thickest 7 near the nose, a trailing edge of radius about 0.6. Starts at the
/// trailing edge, counterclockwise, the seam in the middle of the trailing circle. With a `bead` the trailing edge is
/// thicker than what leads to it.
fn airfoil(bead: f64) -> Curve<DVec2> {
    let n = 60;
    let mut points = vec![];
    for i in 0..2 * n {
        let a = TAU * f64::from(i) / f64::from(2 * n);
        // From the trailing edge over the upper side to the nose and back below.
        let x = 0.5 * (1.0 + a.cos());
        let thick = 0.6 * (2.0 * (1.0 - x).max(0.0)).sqrt() * x
            + 3.4 * (x * (1.0 - x)).max(0.0).sqrt() * (1.0 - x)
            + 0.55 * a.sin().abs()
            + bead * (-((x - 0.93) / 0.04).powi(2)).exp();
        let camber = 24.0 * x * (1.0 - x);
        points.push((40.0 * x, camber + thick * a.sin().signum()));
    }
    points[0].1 = 0.0;
    points[n as usize].1 = 0.0;
    closed(&points)
}

fn dumbbell() -> Curve<DVec2> {
    let points: Vec<(f64, f64)> = (0..48)
        .map(|i| {
            let a = TAU * f64::from(i) / 48.0;
            (4.0 * a.cos(), a.sin() * (0.7 + 1.0 * a.cos().powi(2)))
        })
        .collect();
    closed(&points)
}

/// Every point at the distance, densely; spans joined; loops closed; B-splines within their tolerance.
fn verify<C: BezierCurve<Space = DVec2>>(
    source: &C,
    is_closed: bool,
    d: f64,
    pieces: &[OffsetPiece],
    tolerance: f64,
) {
    let projector = CurveProjector::new(source, is_closed);
    for piece in pieces {
        assert!(!piece.spans.is_empty());
        let ends: Vec<(DVec2, DVec2)> = piece
            .spans
            .iter()
            .map(|s| {
                let c = s.fitted();
                let (a, b) = c.domain();
                (c.point(a), c.point(b))
            })
            .collect();
        for w in ends.windows(2) {
            assert!(w[0].1.distance(w[1].0) < 1e-8, "gap {}", w[0].1.distance(w[1].0));
        }
        if piece.closed {
            assert!(ends[ends.len() - 1].1.distance(ends[0].0) < 1e-8);
        }
        for span in &piece.spans {
            let (a, b) = span.fitted().domain();
            for k in 0..=60 {
                let t = a + (b - a) * f64::from(k) / 60.0;
                let exact = match span {
                    OffsetSpan::Along { .. } => OffsetCurve::new(source, d).point(t.min(b.next_down())),
                    OffsetSpan::Around { arc, .. } => arc.point(t),
                };
                let off = projector.closest(exact).unwrap().distance - d.abs();
                assert!(off.abs() < 1e-8, "{off:e} at {t}");
                let fitted = span.fitted().point(t);
                let off = projector.closest(fitted).unwrap().distance - d.abs();
                assert!(off.abs() < tolerance + 1e-8, "{off:e} at {t}");
                if let OffsetSpan::Along { .. } = span {
                    assert!(fitted.distance(exact) <= tolerance, "{:e}", fitted.distance(exact));
                }
            }
        }
    }
}

/// Enclosed area of closed pieces.
fn area(pieces: &[OffsetPiece]) -> f64 {
    let along = |c: &Curve<DVec2>| -> f64 {
        let (a, b) = c.domain();
        let at = |k: i32| c.point(a + (b - a) * f64::from(k) / 2000.0);
        (0..2000).map(|k| 0.5 * at(k).perp_dot(at(k + 1))).sum()
    };
    pieces.iter().flat_map(|p| &p.spans).map(|s| along(s.fitted())).sum()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..common::fixed() })]

    #[test]
    fn derivatives_of_offsets_are_exact(c in curve(3..=5), d in -0.5f64..0.5, law in proptest::array::uniform4(-0.5f64..0.5), t in 0.01f64..0.99) {
        let c: Curve<DVec2> = c.map(|p| p.truncate());
        let k = c.knots().breaks();
        prop_assume!(k.iter().all(|b| (t - b).abs() > 1e-3));
        let law = Curve::bezier(law.to_vec()).unwrap();
        let speed = c.derivatives(t)[1].length();
        prop_assume!(speed > 0.3);
        for o in [&OffsetCurve::new(&c, d) as &dyn ParametricCurve<DVec2>, &OffsetCurve::new(&c, law.clone())] {
            let h = 1e-5;
            let [p, d1, d2] = o.derivatives(t);
            prop_assert!(p.distance(o.point(t)) < 1e-14);
            let (before, after) = (o.derivatives(t - h), o.derivatives(t + h));
            let size = d2.length() + 1.0;
            prop_assert!(((after[0] - before[0]) / (2.0 * h)).distance(d1) < 1e-5 * size.max(after[2].distance(before[2]) / h * 1e-3), "{}", size);
            let third = (after[2].distance(before[2]) / h).max(1.0);
            prop_assert!(((after[1] - before[1]) / (2.0 * h)).distance(d2) < 1e-3 * size.max(third * 1e-2));
        }
    }

    #[test]
    fn random_closed_curves_keep_their_distance(
        waves in proptest::collection::vec((-0.25f64..0.25, 0.0f64..TAU), 5), d in -0.8f64..0.8,
    ) {
        prop_assume!(d.abs() > 0.02);
        let radius = |a: f64| 1.0 + waves.iter().enumerate().map(|(k, (w, p))| w * ((k as f64 + 2.0) * a + p).sin()).sum::<f64>();
        let points: Vec<(f64, f64)> = (0..60).map(|i| TAU * f64::from(i) / 60.0)
            .map(|a| (radius(a).max(0.1) * a.cos(), radius(a).max(0.1) * a.sin())).collect();
        let c = closed(&points);
        prop_assume!(coolinggen_nurbs::self_intersections(&c).unwrap().is_empty());
        let pieces = trimmed_offset(&c, true, d, 1e-5).unwrap();
        verify(&c, true, d, &pieces, 1e-5);
        enclosed(&c, d, &pieces);
    }

    #[test]
    fn random_open_curves_keep_their_distance(
        points in proptest::collection::vec(common::point(), 4..10), d in prop_oneof![0.02f64..0.6, -0.6f64..-0.02],
    ) {
        let knots = Knots::uniform(3, points.len()).unwrap();
        let c = Curve::new(knots, points.iter().map(|p| p.truncate()).collect()).unwrap();
        prop_assume!((0..=400).all(|k| c.derivatives(f64::from(k) / 400.0)[1].length() > 0.05));
        let pieces = trimmed_offset(&c, false, d, 1e-5).unwrap();
        verify(&c, false, d, &pieces, 1e-5);
        // Nothing is missing: whatever of the raw offset has the distance is in a span.
        let projector = CurveProjector::new(&c, false);
        let raw = OffsetCurve::new(&c, d);
        for k in 0..=500 {
            let t = f64::from(k) / 500.0;
            if projector.closest(raw.point(t)).unwrap().distance >= d.abs() - 1e-12 {
                let spans = pieces.iter().flat_map(|p| &p.spans);
                let there = spans.map(|s| s.fitted().domain()).any(|(a, b)| t >= a - 1e-9 && t <= b + 1e-9);
                prop_assert!(there, "{} is missing", t);
            }
        }
    }

    #[test]
    fn circles_shrink_to_circles_and_vanish(radius in 0.5f64..3.0, share in 0.01f64..1.5) {
        let d = radius * share;
        prop_assume!((share - 1.0).abs() > 1e-3);
        for sense in [1.0, -1.0] {
            let c = circle(radius, sense);
            let inside = trimmed_offset(&c, true, sense * d, 1e-7).unwrap();
            prop_assert_eq!(inside.len(), usize::from(share < 1.0));
            let outside = trimmed_offset(&c, true, -sense * d, 1e-7).unwrap();
            prop_assert_eq!(outside.len(), 1);
            verify(&c, true, sense * d, &inside, 1e-7);
            verify(&c, true, -sense * d, &outside, 1e-7);
            prop_assert!((area(&outside) * sense - 0.5 * TAU * (radius + d).powi(2)).abs() < 1e-3);
        }
    }
}

#[test]
fn an_airfoil_shrinks_splits_into_loops_and_vanishes() {
    let c = airfoil(0.0);
    assert_eq!(coolinggen_nurbs::self_intersections(&c).unwrap(), vec![]);
    let mut last = f64::INFINITY;
    let mut counts = vec![];
    for k in 1..=24 {
        let d = 0.125 * f64::from(k);
        let pieces = trimmed_offset(&c, true, d, 1e-5).unwrap();
        verify(&c, true, d, &pieces, 1e-5);
        assert!(pieces.iter().all(|p| p.closed));
        let now = area(&pieces);
        assert!((now < last && now > 0.0) || pieces.is_empty(), "{d} {now} {last}");
        last = now;
        counts.push(pieces.len());
        // The raw offset does meet itself.
        if k == 8 {
            let raw = OffsetCurve::new(&c, d);
            assert!(!self_intersections_parametric(&raw).unwrap().is_empty());
        }
        let outside = trimmed_offset(&c, true, -d, 1e-5).unwrap();
        assert_eq!(outside.len(), 1);
        verify(&c, true, -d, &outside, 1e-5);
    }
    assert_eq!(counts[0], 1);
    assert_eq!(counts[23], 0, "{counts:?}");
}

#[test]
fn an_airfoil_with_a_thick_trailing_edge_splits_there() {
    let c = airfoil(0.9);
    for (d, count) in [(0.3, 1), (0.7, 1), (0.8, 2), (1.1, 2), (1.2, 1), (1.6, 1), (2.4, 0)] {
        let pieces = trimmed_offset(&c, true, d, 1e-5).unwrap();
        assert_eq!(pieces.len(), count, "{d}");
        verify(&c, true, d, &pieces, 1e-5);
        enclosed(&c, d, &pieces);
    }
}

#[test]
fn a_sharp_trailing_edge_is_rounded_outside_and_kept_inside() {
    // A drop with an edge of about 50 degrees at its seam, both ways round.
    let outline = [(4.0, 0.0), (1.5, 1.2), (-1.5, 1.6), (-2.5, 0.0), (-1.5, -1.2), (1.5, -0.8), (4.0, 0.0)];
    let points: Vec<DVec2> = outline.into_iter().map(DVec2::from).collect();
    let c = Curve::new(Knots::uniform(3, 7).unwrap(), points).unwrap();
    for d in [0.05, 0.3, 0.6, 0.9, -0.05, -0.5, -2.0] {
        let pieces = trimmed_offset(&c, true, d, 1e-6).unwrap();
        assert_eq!(pieces.len(), 1, "{d}");
        verify(&c, true, d, &pieces, 1e-6);
        enclosed(&c, d, &pieces);
        let arcs = pieces[0].spans.iter().filter(|s| matches!(s, OffsetSpan::Around { .. })).count();
        assert_eq!(arcs, usize::from(d < 0.0));
        // The curve run through backwards has its inside on the right.
        let back = c.reversed();
        let mirrored = trimmed_offset(&back, true, -d, 1e-6).unwrap();
        verify(&back, true, -d, &mirrored, 1e-6);
        assert!((area(&mirrored) + area(&pieces)).abs() < 1e-4);
    }
    assert_eq!(trimmed_offset(&c, true, 1.4, 1e-6).unwrap(), vec![]);
}

/// The winding number of closed pieces around a point, by sampling.
fn winding(pieces: &[OffsetPiece], q: DVec2) -> f64 {
    let mut turn = 0.0;
    for span in pieces.iter().flat_map(|p| &p.spans) {
        // The fit has more breaks where the offset turns faster.
        for w in span.fitted().knots().breaks().windows(2) {
            let at = |k: i32| span.fitted().point(w[0] + (w[1] - w[0]) * f64::from(k) / 4.0) - q;
            turn += (0..4).map(|k| at(k).perp_dot(at(k + 1)).atan2(at(k).dot(at(k + 1)))).sum::<f64>();
        }
    }
    turn / TAU
}

/// Nothing is missing: points inside farther than d from the curve are enclosed once, others not at all.
fn enclosed(source: &Curve<DVec2>, d: f64, pieces: &[OffsetPiece]) {
    let projector = CurveProjector::new(source, true);
    let (a, b) = source.domain();
    let itself: Vec<DVec2> = (0..2000).map(|k| source.point(a + (b - a) * f64::from(k) / 2000.0)).collect();
    let (centre, radius) = projector.bounding_sphere();
    for i in 0..24 {
        for j in 0..24 {
            let q = centre + DVec2::new(f64::from(i) / 12.0 - 0.96, f64::from(j) / 12.0 - 0.96) * radius;
            let distance = projector.closest(q).unwrap().distance;
            if (distance - d.abs()).abs() < 0.01 * radius || distance < 0.01 * radius {
                continue;
            }
            let around: f64 = (0..2000)
                .map(|k| (itself[k] - q, itself[(k + 1) % 2000] - q))
                .map(|(x, y)| x.perp_dot(y).atan2(x.dot(y)))
                .sum();
            let inside = around > 3.0;
            let expected = if d > 0.0 { inside && distance > d } else { inside || distance < -d };
            let found = winding(pieces, q).round();
            assert_eq!(found, f64::from(u8::from(expected)), "{q} {distance} {d}");
        }
    }
}

#[test]
fn a_dumbbell_splits_into_two_loops() {
    let c = dumbbell();
    for (d, count) in [(0.3, 1), (0.6, 1), (0.69, 1), (0.72, 2), (0.82, 2), (1.0, 0)] {
        let pieces = trimmed_offset(&c, true, d, 1e-6).unwrap();
        assert_eq!(pieces.len(), count, "{d}");
        verify(&c, true, d, &pieces, 1e-6);
        enclosed(&c, d, &pieces);
        assert!(count == 0 || area(&pieces) > 0.0);
    }
}

#[test]
fn kinks_get_arcs_outside_and_corners_inside() {
    let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0), (0.0, 0.0)].map(DVec2::from);
    let c = Curve::new(Knots::clamped(1, &[0.0, 1.0, 2.0, 3.0, 4.0]).unwrap(), square.to_vec()).unwrap();
    let inside = trimmed_offset(&c, true, 1.0, 1e-7).unwrap();
    assert_eq!(inside.len(), 1);
    assert_eq!(inside[0].spans.len(), 4);
    verify(&c, true, 1.0, &inside, 1e-7);
    assert!((area(&inside) - 2.0).abs() < 1e-9);
    let outside = trimmed_offset(&c, true, -1.0, 1e-7).unwrap();
    verify(&c, true, -1.0, &outside, 1e-7);
    assert_eq!(outside[0].spans.len(), 8);
    assert!((area(&outside) - (12.0 + 14.0 + 0.5 * TAU)).abs() < 1e-5, "{}", area(&outside));
    assert_eq!(trimmed_offset(&c, true, 1.6, 1e-7).unwrap(), vec![]);
    // In the middle between parallel sides the offset runs along itself.
    assert!(matches!(trimmed_offset(&c, true, 1.5, 1e-7), Err(NurbsError::Coincident { .. })));
}

#[test]
fn an_open_parabola_has_an_offset_without_its_swallowtail() {
    // y = x^2, offset inwards by 2: the radius of curvature at the vertex is 1/2.
    let c = Curve::bezier(vec![DVec2::new(-2.0, 4.0), DVec2::new(0.0, -4.0), DVec2::new(2.0, 4.0)]).unwrap();
    let pieces = trimmed_offset(&c, false, 2.0, 1e-7).unwrap();
    verify(&c, false, 2.0, &pieces, 1e-7);
    assert_eq!(pieces.len(), 1);
    assert!(!pieces[0].closed);
    assert_eq!(pieces[0].spans.len(), 2);
    // Both branches meet on the axis.
    let OffsetSpan::Along { from, to, fitted } = &pieces[0].spans[0] else { panic!() };
    assert!(*from == 0.0 && fitted.point(*to).x.abs() < 1e-9);
    // At distance d the crossing is where the normal of (x, x^2) reaches the axis: x^2 + 1/4 = d^2.
    assert!((c.point(*to).x + (4.0f64 - 0.25).sqrt()).abs() < 1e-9);
    let outside = trimmed_offset(&c, false, -2.0, 1e-7).unwrap();
    verify(&c, false, -2.0, &outside, 1e-7);
    assert_eq!((outside.len(), outside[0].spans.len()), (1, 1));
}

#[test]
fn a_spiral_that_comes_back_is_cut_by_its_other_side() {
    let t: Vec<f64> = (0..=40).map(|i| f64::from(i) / 40.0).collect();
    let points: Vec<DVec2> = t.iter().map(|t| DVec2::from_angle(9.0 * t) * (1.0 + 1.2 * t)).collect();
    let c = coolinggen_nurbs::Interpolator::new(3, &t).unwrap().curve(&points).unwrap();
    for d in [0.3, 0.6, 1.0, -0.3, -0.6, -1.0] {
        let pieces = trimmed_offset(&c, false, d, 1e-6).unwrap();
        verify(&c, false, d, &pieces, 1e-6);
        assert!(!pieces.is_empty() && pieces.iter().all(|p| !p.closed), "{d}");
    }
}

#[test]
fn an_offset_with_a_law_is_fitted_within_its_tolerance() {
    let c = airfoil(0.0);
    let (a, b) = c.domain();
    let law = Curve::new(Knots::clamped(2, &[a, b]).unwrap(), vec![0.1, 0.6, 0.1]).unwrap();
    let offset = OffsetCurve::new(&c, law.clone());
    let fit = offset.fitted(1e-4).unwrap();
    assert!(fit.greatest <= 1e-4);
    for k in 0..=3000 {
        let t = a + (b - a) * f64::from(k) / 3000.0;
        assert!(fit.curve.point(t).distance(offset.point(t)) <= 1e-4);
        assert!((offset.point(t).distance(c.point(t)) - law.point(t)).abs() < 1e-12);
    }
}

#[test]
fn nonsense_is_refused() {
    let c = circle(1.0, 1.0);
    assert!(matches!(trimmed_offset(&c, true, 0.0, 1e-6), Err(NurbsError::BadArgument { .. })));
    assert!(matches!(trimmed_offset(&c, true, f64::NAN, 1e-6), Err(NurbsError::BadArgument { .. })));
    let open = c.restricted(0.0, 0.7).unwrap();
    assert!(matches!(trimmed_offset(&open, true, 0.1, 1e-6), Err(NurbsError::NotJoined { .. })));
    let point = Curve::bezier(vec![DVec2::X, DVec2::X, DVec2::Y]).unwrap();
    assert!(matches!(trimmed_offset(&point, false, 0.1, 1e-6), Err(NurbsError::BadArgument { .. })));
}
