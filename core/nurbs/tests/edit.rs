//! Edits keep the points: insertion, restriction, extension.

mod common;

use common::{curve, surface, worst_difference, worst_surface_difference};
use coolinggen_nurbs::{Curve, Homogeneous, NurbsError, ParametricCurve, ParametricSurface, RationalCurve};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

proptest! {
    #![proptest_config(common::fixed())]

    #[test]
    fn insertion_keeps_the_curve(c in curve(1..=7), at in proptest::collection::vec(0.01f64..0.99, 1..5)) {
        let finer = c.with_knots_inserted(&at).unwrap();
        prop_assert_eq!(finer.points().len(), c.points().len() + at.len());
        prop_assert!(worst_difference(&c, &finer, 0.0, 1.0) < 1e-14);
    }

    #[test]
    fn a_restriction_is_the_curve_on_less(c in curve(1..=7), a in 0.0f64..0.45, b in 0.5f64..=1.0) {
        let part = c.restricted(a, b).unwrap();
        prop_assert_eq!(part.domain(), (a, b));
        prop_assert!(worst_difference(&c, &part, a, b) < 1e-14);
        prop_assert!(part.points()[0].distance(c.point(a)) < 1e-14);
    }

    #[test]
    fn halves_share_their_point_and_give_the_whole(c in curve(1..=7), t in 0.01f64..0.99) {
        let (left, right) = c.split(t).unwrap();
        prop_assert_eq!(left.points().last(), right.points().first());
        prop_assert!(worst_difference(&c, &left, 0.0, t) < 1e-14);
        prop_assert!(worst_difference(&c, &right, t, 1.0) < 1e-14);
    }

    #[test]
    fn an_extension_continues_the_end_polynomials(
        c in curve(1..=5), before in 0.0f64..0.2, after in 0.0f64..0.2,
    ) {
        let longer = c.extended(before, after).unwrap();
        prop_assert_eq!(longer.domain(), (-before, 1.0 + after));
        prop_assert_eq!(longer.knots().breaks().len(), c.knots().breaks().len());
        // Evaluation outside the domain continues the end polynomials: the same claim by other means. Rounding
        // grows with the control points, which the extension moves away.
        let size = longer.points().iter().fold(1.0, |m: f64, p| m.max(p.length()));
        prop_assert!(worst_difference(&c, &longer, -before, 1.0 + after) < 1e-12 * size);
        // And going back gives the curve again.
        let back = longer.restricted(0.0, 1.0).unwrap();
        prop_assert!(worst_difference(&c, &back, 0.0, 1.0) < 1e-12 * size);
    }

    #[test]
    fn surfaces_are_edited_along_both_directions(s in surface(), a in 0.0f64..0.4, b in 0.5f64..=1.0) {
        let part = s.restricted_u(a, b).unwrap().restricted_v(a, b).unwrap();
        prop_assert_eq!(part.domain(), ((a, b), (a, b)));
        prop_assert!(worst_surface_difference(&s, &part, (a, b), (a, b)) < 1e-14);
        let finer = s.with_knots_inserted_u(&[a + 0.05, b - 0.01]).unwrap().with_knots_inserted_v(&[b - 0.02]).unwrap();
        prop_assert!(worst_surface_difference(&s, &finer, (0.0, 1.0), (0.0, 1.0)) < 1e-14);
        let longer = s.extended_u(0.03, 0.0).unwrap().extended_v(0.06, 0.06).unwrap();
        prop_assert_eq!(longer.domain(), ((-0.03, 1.0), (-0.06, 1.06)));
        let size = longer.points().iter().fold(1.0, |m: f64, p| m.max(p.length()));
        prop_assert!(worst_surface_difference(&s, &longer, (-0.03, 1.0), (-0.06, 1.06)) < 1e-12 * size);
    }

    #[test]
    fn rational_curves_are_edited_in_homogeneous_form(c in curve(2..=4), a in 0.0f64..0.4, b in 0.5f64..=1.0) {
        let weighted: Curve<Homogeneous<DVec2>> = c.map(|p| Homogeneous::new(DVec2::new(p.x, p.y), 1.5 + p.z));
        let c = RationalCurve::from_homogeneous(weighted).unwrap();
        let part = c.restricted(a, b).unwrap();
        let finer = c.with_knots_inserted(&[a + 0.05]).unwrap();
        for i in 0..=40 {
            let t = a + (b - a) * f64::from(i) / 40.0;
            prop_assert!(c.point(t).distance(part.point(t)) < 1e-13);
            prop_assert!(c.point(t).distance(finer.point(t)) < 1e-13);
        }
    }
}

#[test]
fn an_extended_circle_stays_on_the_circle() {
    let points = [DVec2::new(1.0, 0.0), DVec2::new(1.0, 1.0), DVec2::new(0.0, 1.0)];
    let knots = coolinggen_nurbs::Knots::clamped(2, &[0.0, 1.0]).unwrap();
    let arc = RationalCurve::new(knots, &points, &[1.0, 0.5f64.sqrt(), 1.0]).unwrap();
    let longer = arc.extended(0.1, 0.3).unwrap();
    for i in 0..=100 {
        let t = -0.1 + 1.4 * f64::from(i) / 100.0;
        assert!((longer.point(t).length() - 1.0).abs() < 1e-14);
    }
}

#[test]
fn bad_arguments_are_refused() {
    let c = Curve::bezier(vec![DVec3::ZERO, DVec3::X, DVec3::Y]).unwrap();
    assert!(matches!(c.split(0.0), Err(NurbsError::OutOfDomain { .. })));
    assert!(matches!(c.split(f64::NAN), Err(NurbsError::OutOfDomain { .. })));
    assert!(matches!(c.restricted(0.5, 0.5), Err(NurbsError::OutOfDomain { .. })));
    assert!(matches!(c.restricted(0.5, 1.5), Err(NurbsError::OutOfDomain { .. })));
    assert!(matches!(c.extended(-1.0, 0.0), Err(NurbsError::BadArgument { .. })));
    assert!(matches!(c.with_knots_inserted(&[0.5, 0.5, 0.5]), Err(NurbsError::Multiplicity { .. })));
}

#[test]
fn curves_without_clamped_ends_are_restricted_and_extended() {
    let knots = coolinggen_nurbs::Knots::new(3, (-3..=7).map(f64::from).collect()).unwrap();
    let points =
        (0..7).map(|i| DVec3::new(f64::from(i), f64::from(i * i % 5), f64::from(i * 3 % 4))).collect();
    let c = Curve::new(knots, points).unwrap();
    let whole = c.restricted(0.0, 4.0).unwrap();
    assert_eq!(whole.points()[0], whole.point(0.0));
    assert!(worst_difference(&c, &whole, 0.0, 4.0) < 1e-14);
    let longer = c.extended(0.5, 0.5).unwrap();
    assert_eq!(longer.domain(), (-0.5, 4.5));
    assert!(worst_difference(&c, &longer, -0.5, 4.5) < 1e-13);
}

proptest! {
    #![proptest_config(common::fixed())]

    #[test]
    fn an_inserted_knot_can_be_removed(c in curve(1..=7), t in 0.01f64..0.99) {
        prop_assume!(c.knots().multiplicity(t) == 0);
        let finer = c.with_knots_inserted(&[t]).unwrap();
        let (back, bound) = finer.with_knot_removed(t, 1e-9).unwrap();
        prop_assert!(bound < 1e-12, "{}", bound);
        prop_assert_eq!(back.points().len(), c.points().len());
        prop_assert!(worst_difference(&c, &back, 0.0, 1.0) < 1e-12);
    }

    #[test]
    fn a_removal_moves_nothing_farther_than_its_bound(c in curve(1..=7), tolerance in 0.0f64..1.0) {
        for &t in &c.knots().breaks()[1..c.knots().breaks().len() - 1] {
            let (less, bound) = c.with_knot_removed(t, f64::INFINITY).unwrap();
            let moved = worst_difference(&c, &less, 0.0, 1.0);
            prop_assert!(moved <= bound * (1.0 + 1e-9) + 1e-12, "{} {}", moved, bound);
            prop_assert!(bound == 0.0 || c.with_knot_removed(t, 0.99 * bound).is_err());
        }
        let (less, bound) = c.simplified(tolerance).unwrap();
        prop_assert!(bound <= tolerance);
        prop_assert!(worst_difference(&c, &less, 0.0, 1.0) <= bound + 1e-12);
        prop_assert_eq!(less.points()[0], c.points()[0]);
    }

    #[test]
    fn elevation_keeps_the_curve_and_reduction_undoes_it(c in curve(1..=6)) {
        let higher = c.elevated().unwrap();
        prop_assert_eq!(higher.degree(), c.degree() + 1);
        prop_assert!(worst_difference(&c, &higher, 0.0, 1.0) < 1e-13);
        prop_assert!(c.deviation_bound(&higher).unwrap() < 1e-12);
        let (back, bound) = higher.reduced().unwrap();
        prop_assert_eq!(back.knots(), c.knots());
        prop_assert!(bound < 1e-10, "{}", bound);
        prop_assert!(worst_difference(&c, &back, 0.0, 1.0) <= bound + 1e-13);
    }

    #[test]
    fn a_reduction_stays_within_its_bound(c in curve(2..=6)) {
        let (lower, bound) = c.reduced().unwrap();
        prop_assert!(worst_difference(&c, &lower, 0.0, 1.0) <= bound + 1e-13);
        prop_assert!(lower.point(0.0).distance(c.point(0.0)) < 1e-13);
        prop_assert!(lower.point(1.0).distance(c.point(1.0)) < 1e-13);
    }

    #[test]
    fn pieces_are_the_curve_and_join_again(c in curve(1..=7)) {
        let pieces = c.bezier_segments();
        prop_assert_eq!(pieces.len() + 1, c.knots().breaks().len());
        for piece in &pieces {
            let (a, b) = piece.domain();
            prop_assert_eq!(piece.points().len(), c.degree() + 1);
            prop_assert!(worst_difference(&c, piece, a, b) < 1e-13);
            // The convex hull property, in the form of the box.
            for i in 0..=20 {
                let p = piece.point(a + (b - a) * f64::from(i) / 20.0);
                let low = piece.points().iter().fold(DVec3::INFINITY, |m, p| m.min(*p));
                let high = piece.points().iter().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
                prop_assert!((p - low).min_element() > -1e-14 && (high - p).min_element() > -1e-14);
            }
        }
        let joined = Curve::joined(&pieces, 0.0).unwrap();
        prop_assert!(worst_difference(&c, &joined, 0.0, 1.0) < 1e-13);
        let (simple, bound) = joined.simplified(1e-9).unwrap();
        prop_assert!(bound < 1e-9);
        prop_assert_eq!(simple.knots(), c.knots());
    }

    #[test]
    fn patches_are_the_surface_and_edits_of_surfaces_agree(s in surface()) {
        let patches = s.bezier_patches();
        let (nu, nv) = (s.breaks_u().len() - 1, s.breaks_v().len() - 1);
        prop_assert_eq!(patches.len(), nu * nv);
        for patch in &patches {
            let (u, v) = patch.domain();
            prop_assert!(worst_surface_difference(&s, patch, u, v) < 1e-13);
        }
        let higher = s.elevated_u().unwrap().elevated_v().unwrap();
        prop_assert!(worst_surface_difference(&s, &higher, (0.0, 1.0), (0.0, 1.0)) < 1e-13);
        let ((back, du), dv) = { let (r, dv) = higher.reduced_v().unwrap(); (r.reduced_u().unwrap(), dv) };
        prop_assert!(worst_surface_difference(&s, &back, (0.0, 1.0), (0.0, 1.0)) <= du + dv + 1e-13 && du + dv < 1e-10);
        let (simple, bound) = s.with_knots_inserted_u(&[0.123]).unwrap().simplified_u(1e-9).unwrap();
        prop_assert!(simple.counts().0 <= s.counts().0);
        prop_assert!(worst_surface_difference(&s, &simple, (0.0, 1.0), (0.0, 1.0)) <= bound + 1e-12);
    }

    #[test]
    fn affine_maps_commute_with_evaluation(c in curve(1..=7), m in proptest::array::uniform9(-2.0f64..2.0), d in common::point()) {
        let map = glam::DAffine3::from_mat3_translation(glam::DMat3::from_cols_array(&m), d);
        let mapped = c.map(|p| map.transform_point3(*p));
        for i in 0..=50 {
            let t = f64::from(i) / 50.0;
            prop_assert!(mapped.point(t).distance(map.transform_point3(c.point(t))) < 1e-13);
        }
    }

    #[test]
    fn rational_removal_stays_within_its_tolerance(c in curve(2..=4), tolerance in 1e-4f64..0.3) {
        let weighted: Curve<Homogeneous<DVec2>> = c.map(|p| Homogeneous::new(DVec2::new(p.x, p.y), 1.5 + p.z));
        let c = RationalCurve::from_homogeneous(weighted).unwrap();
        let less = c.simplified(tolerance).unwrap();
        let higher = c.elevated().unwrap();
        for i in 0..=200 {
            let t = f64::from(i) / 200.0;
            prop_assert!(c.point(t).distance(less.point(t)) <= tolerance + 1e-12);
            prop_assert!(c.point(t).distance(higher.point(t)) < 1e-12);
        }
    }
}

#[test]
fn pieces_that_do_not_meet_are_refused() {
    let a = Curve::segment(DVec2::ZERO, DVec2::X);
    let b = Curve::segment(DVec2::new(1.0, 0.1), DVec2::Y).reparameterized(1.0, 2.0);
    assert!(matches!(
        Curve::joined(&[a.clone(), b.clone()], 1e-3),
        Err(NurbsError::NotJoined { index: 1, .. })
    ));
    assert!(Curve::joined(&[a.clone(), b], 0.2).is_ok());
    assert!(matches!(Curve::joined(&[a.clone(), a], 0.0), Err(NurbsError::KnotOrder { .. })));
}

/// A growing function on [0, 1] with values from 0 to 1.
fn growing() -> impl Strategy<Value = Curve<f64>> {
    (common::knots(1..=3), proptest::collection::vec(0.1f64..1.0, 60)).prop_map(|(knots, gaps)| {
        let count = knots.control_count();
        let total: f64 = gaps[1..count].iter().sum();
        let mut at = 0.0;
        let rising = (0..count).map(|i| {
            at += if i == 0 { 0.0 } else { gaps[i] / total };
            if i + 1 == count { 1.0 } else { at }
        });
        Curve::new(knots, rising.collect()).unwrap()
    })
}

proptest! {
    #![proptest_config(common::fixed())]

    #[test]
    fn a_product_is_the_product_of_the_points(c in curve(1..=7), f in curve(1..=7)) {
        let f = f.map(|p| p.x);
        let both = c.times(&f).unwrap();
        prop_assert_eq!(both.degree(), c.degree() + f.degree());
        for i in 0..=300 {
            let t = f64::from(i) / 300.0;
            prop_assert!(both.point(t).distance(c.point(t) * f.point(t)) < 1e-13);
        }
        // As smooth as the less smooth of both, and no smoother: a knot of either is there as often as it asks for.
        for b in both.breaks() {
            let (m, n) = (c.knots().multiplicity(b), f.knots().multiplicity(b));
            let asked = (if m > 0 { m + f.degree() } else { 0 }).max(if n > 0 { n + c.degree() } else { 0 });
            let ends = b == 0.0 || b == 1.0;
            prop_assert_eq!(both.knots().multiplicity(b), if ends { both.degree() + 1 } else { asked });
        }
    }

    #[test]
    fn a_composition_is_the_curve_after_the_function(c in curve(1..=4), u in growing()) {
        let after = c.composed(&u).unwrap();
        prop_assert_eq!(after.degree(), c.degree() * u.degree());
        for i in 0..=300 {
            let t = f64::from(i) / 300.0;
            prop_assert!(after.point(t).distance(c.point(u.point(t))) < 1e-12);
        }
        prop_assert_eq!(after.points()[0], c.points()[0]);
        let inner = |k: &Curve<DVec3>| k.breaks().len() - 2;
        prop_assert!(inner(&after) <= inner(&c) + u.breaks().len() - 2);
    }

    #[test]
    fn a_lowered_curve_keeps_tolerance_ends_and_kinks(
        c in curve(5..=8), degree in 2usize..=4, tolerance in 1e-6f64..1e-2,
    ) {
        let (low, bound) = c.lowered(degree, tolerance).unwrap();
        prop_assert_eq!(low.degree(), degree);
        prop_assert!(bound <= tolerance);
        prop_assert!(worst_difference(&c, &low, 0.0, 1.0) <= bound);
        prop_assert_eq!((low.points()[0], low.points().last()), (c.points()[0], c.points().last()));
        let times = |k: &Curve<DVec3>, t: f64| k.knots().multiplicity(t);
        for &b in &low.breaks()[1..low.breaks().len() - 1] {
            let kink = times(&c, b) == c.degree();
            prop_assert_eq!(times(&low, b), if kink { degree } else { 1 });
        }
    }

    #[test]
    fn a_raised_curve_comes_back(c in curve(2..=4)) {
        let (back, bound) = c.elevated().unwrap().elevated().unwrap().lowered(c.degree(), 1e-6).unwrap();
        prop_assert!(bound <= 1e-6);
        prop_assert!(worst_difference(&c, &back, 0.0, 1.0) <= 1e-6);
    }

    #[test]
    fn surfaces_are_multiplied_composed_and_lowered(s in surface(), u in growing(), f in curve(1..=3)) {
        let f = f.map(|p| p.y);
        let made = s.composed_u(&u).unwrap().times_v(&f).unwrap().times_u(&f).unwrap();
        let (low, of_u) = made.lowered_u(3, 1e-3).unwrap();
        let (low, of_v) = low.lowered_v(3, 1e-3).unwrap();
        for i in 0..=20 {
            for j in 0..=20 {
                let (t, v) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
                let asked = s.point(u.point(t), v) * (f.point(t) * f.point(v));
                prop_assert!(made.point(t, v).distance(asked) < 1e-12);
                prop_assert!(low.point(t, v).distance(asked) <= of_u + of_v + 1e-12);
            }
        }
    }
}

#[test]
fn products_and_compositions_say_what_they_cannot() {
    let line = Curve::segment(0.0, 1.0);
    let square = Curve::bezier(vec![0.0, 0.0, 1.0]).unwrap();
    let high = Curve::bezier(vec![0.0; 14]).unwrap();
    assert!(matches!(high.times(&high), Err(NurbsError::Degree { degree: 26, .. })));
    assert!(matches!(line.composed(&square), Err(NurbsError::BadParameters { index: 1 })));
    assert!(matches!(line.composed(&Curve::segment(0.0, 2.0)), Err(NurbsError::OutOfDomain { .. })));
    assert!(matches!(high.composed(&high), Err(NurbsError::Degree { degree: 169, .. })));
    assert!(matches!(line.times(&line.reparameterized(0.0, 2.0)), Err(NurbsError::OutOfDomain { .. })));
    assert!(matches!(high.lowered(0, 1.0), Err(NurbsError::Degree { .. })));
}
