//! Least-squares fits: optimality, constraints, smoothing, tolerances.

mod common;

use common::knots;
use coolinggen_nurbs::{
    Constraint, ConstraintValue, Curve, Knots, LeastSquares, NurbsError, ParametricCurve, ParametricSurface,
    Smoothing, Surface, fit_function, fit_within, smoothed,
};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::f64::consts::TAU;

fn even(n: usize) -> Vec<f64> {
    (0..=n).map(|i| i as f64 / n as f64).collect()
}

/// Noise of size 1, the same in every run.
fn noise(i: usize) -> f64 {
    (i as f64 * 12.9898).sin() * 43758.5453 % 1.0
}

proptest! {
    #![proptest_config(common::fixed())]

    #[test]
    fn constraints_hold_and_nothing_near_is_better(
        k in knots(2..=5).prop_filter("room for the constraints", |k| k.control_count() > 6),
        data in proptest::collection::vec(common::point(), 60),
        ends in (common::point(), common::point(), common::point()),
        shift in proptest::collection::vec(common::point(), 60),
        weights in proptest::collection::vec(0.1f64..10.0, 60),
    ) {
        let t = even(59);
        let last = k.control_count() - 1;
        let constraints = [
            Constraint::derivative(&k, 0.0, 0).unwrap(),
            Constraint::derivative(&k, 1.0, 0).unwrap(),
            Constraint::derivative(&k, 1.0, 1).unwrap(),
            // One that couples far control points.
            Constraint::new(vec![(2, 1.0), (last - 2, -2.0)]),
        ];
        let values = [ends.0, ends.1, ends.2, DVec3::new(0.1, 0.2, 0.3)];
        let smoothing = Smoothing { order: 2, factor: 1e-4 };
        let problem = LeastSquares::new(k.clone(), &t, Some(&weights), &constraints, Some(smoothing)).unwrap();
        let fit = problem.curve(&data, &values).unwrap();
        let c = &fit.curve;
        prop_assert!(c.point(0.0).distance(ends.0) < 1e-13);
        prop_assert!(c.point(1.0).distance(ends.1) < 1e-13);
        let size = c.derivatives(1.0)[1].length().max(1.0);
        prop_assert!(c.derivatives(1.0)[1].distance(ends.2) < 1e-11 * size.max(100.0));
        let coupled = c.points()[2] - c.points()[last - 2] * 2.0;
        prop_assert!(coupled.distance(values[3]) < 1e-12);
        // Residuals are what the fit says.
        let rms = (t.iter().zip(&data).map(|(&t, p)| c.point(t).distance_squared(*p)).sum::<f64>() / 60.0).sqrt();
        prop_assert!((rms - fit.rms).abs() < 1e-12);

        // A change that keeps the constraints: the difference to the fit of other data. The objective's derivative
        // along it must vanish.
        let other: Vec<DVec3> = data.iter().zip(&shift).map(|(a, b)| *a + *b).collect();
        let d = problem.curve(&other, &values).unwrap().curve;
        let change = Curve::new(k.clone(), d.points().iter().zip(c.points()).map(|(a, b)| *a - *b).collect()).unwrap();
        let mut slope = 0.0;
        let mut scale = 0.0;
        for ((&t, p), w) in t.iter().zip(&data).zip(&weights) {
            let term = w * (c.point(t) - *p).dot(change.point(t));
            slope += term;
            scale += term.abs();
        }
        // The penalty's derivative, exact by Gauss's rule on every polynomial piece.
        for span in k.breaks().windows(2) {
            let (a, wa) = (0.861_136_311_594_052_6, 0.347_854_845_137_453_8);
            let (b, wb) = (0.339_981_043_584_856_3, 0.652_145_154_862_546_1);
            let gauss = [(-a, wa), (-b, wb), (b, wb), (a, wa)];
            for part in 0..4 {
                let h = (span[1] - span[0]) / 4.0;
                for (x, w) in gauss {
                    let t = span[0] + h * (f64::from(part) + 0.5 + 0.5 * x);
                    let term = 1e-4 * 0.5 * h * w * c.derivatives(t)[2].dot(change.derivatives(t)[2]);
                    slope += term;
                    scale += term.abs();
                }
            }
        }
        prop_assert!(slope.abs() < 1e-12 * (1.0 + scale), "{} of {}", slope, scale);
    }

    #[test]
    fn a_spline_is_its_own_fit(k in knots(1..=5), points in proptest::collection::vec(common::point(), 40)) {
        let truth = Curve::new(k.clone(), points[..k.control_count()].to_vec()).unwrap();
        // Enough data everywhere: 8 a span.
        let t: Vec<f64> = k.breaks().windows(2)
            .flat_map(|s| (0..8).map(move |i| s[0] + (s[1] - s[0]) * (f64::from(i) + 0.5) / 8.0)).collect();
        let data: Vec<DVec3> = t.iter().map(|&t| truth.point(t)).collect();
        let fit = LeastSquares::new(k, &t, None, &[], None).unwrap().curve(&data, &[]).unwrap();
        let worst = fit.curve.points().iter().zip(truth.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        prop_assert!(worst < 1e-11, "{}", worst);
        prop_assert!(fit.greatest < 1e-13);
    }

    #[test]
    fn a_function_is_followed_within_the_tolerance(f in 1.0f64..6.0, exponent in 2i32..10) {
        let tolerance = 10f64.powi(-exponent);
        let g = |t: f64| {
            let (sin, cos) = (f * t).sin_cos();
            [DVec2::new(t, sin), DVec2::new(1.0, f * cos)]
        };
        let fit = fit_function(g, &[0.0, 2.0], tolerance).unwrap();
        for i in 0..=1000 {
            let t = f64::from(i) / 500.0;
            prop_assert!(fit.curve.point(t).distance(g(t)[0]) <= tolerance);
        }
        // And not wastefully: the error of a cubic falls with the fourth power of the span.
        let spans = fit.curve.knots().breaks().len() as f64;
        prop_assert!(spans < 4.0 + 6.0 * f / tolerance.powf(0.25), "{}", spans);
    }
}

#[test]
fn a_heavy_weight_pulls_the_curve() {
    let t = even(30);
    let data: Vec<f64> = (0..=30).map(noise).collect();
    let mut weights = vec![1.0; 31];
    weights[17] = 1e10;
    let k = Knots::uniform(3, 8).unwrap();
    let fit = LeastSquares::new(k, &t, Some(&weights), &[], None).unwrap().curve(&data, &[]).unwrap();
    assert!((fit.curve.point(t[17]) - data[17]).abs() < 1e-8);
}

#[test]
fn a_doubled_control_point_is_doubled() {
    let t = even(30);
    let data: Vec<DVec2> = t.iter().map(|t| DVec2::from_angle(2.0 * t)).collect();
    let k = Knots::uniform(3, 8).unwrap();
    let double = [Constraint::difference(0, 1)];
    let fit = LeastSquares::new(k, &t, None, &double, None).unwrap().curve(&data, &[DVec2::ZERO]).unwrap();
    assert!(fit.curve.points()[0].distance(fit.curve.points()[1]) < 1e-14);
    assert!(fit.greatest > 1e-6);
}

#[test]
fn constraints_may_decide_what_data_do_not() {
    // Two data, six control points: ends, slopes and bends are given instead.
    let k = Knots::clamped(5, &[0.0, 1.0]).unwrap();
    let t5 = |t: f64| [t.powi(5), 5.0 * t.powi(4), 20.0 * t.powi(3)];
    let mut constraints = vec![];
    let mut values = vec![];
    for t in [0.0, 1.0] {
        for order in 0..2 {
            constraints.push(Constraint::derivative(&k, t, order).unwrap());
            values.push(t5(t)[order]);
        }
    }
    let data = [t5(0.3)[0], t5(0.6)[0]];
    let fit = LeastSquares::new(k.clone(), &[0.3, 0.6], None, &constraints, None)
        .unwrap()
        .curve(&data, &values)
        .unwrap();
    for i in 0..=10 {
        let t = f64::from(i) / 10.0;
        assert!((fit.curve.point(t) - t5(t)[0]).abs() < 1e-13);
    }
    let free = LeastSquares::new(k.clone(), &[0.3, 0.6], None, &constraints[..2], None);
    assert!(matches!(free, Err(NurbsError::BadParameters { .. })));
    let twice = [constraints[0].clone(), constraints[0].clone()];
    let dependent = LeastSquares::new(k, &even(20), None, &twice, None);
    assert!(matches!(dependent, Err(NurbsError::BadArgument { .. })));
}

#[test]
fn natural_smoothing_splines_have_no_bend_at_their_ends() {
    let t: Vec<f64> = even(40).iter().map(|t| 3.0 * t * (1.0 + 0.2 * t)).collect();
    let data: Vec<f64> = t.iter().enumerate().map(|(i, t)| t.sin() + 0.01 * noise(i)).collect();
    let fit = smoothed(3, &t, &data, false, 0.005).unwrap();
    assert!((fit.rms - 0.005).abs() <= 5.1e-5);
    for end in [t[0], t[40]] {
        assert!(fit.curve.derivatives(end)[2].abs() < 1e-7, "{}", fit.curve.derivatives(end)[2]);
    }
}

#[test]
fn smoothing_takes_the_jumps_out_of_a_closed_measured_profile() {
    let t = even(200);
    let mut data: Vec<DVec2> = t
        .iter()
        .enumerate()
        .map(|(i, t)| {
            let shape = DVec2::new(20.0 * (TAU * t).cos(), 6.0 * (TAU * t).sin());
            shape + 0.002 * DVec2::new(noise(i), noise(i + 1000))
        })
        .collect();
    data[200] = data[0];
    let bends = |c: &Curve<DVec2>| -> f64 {
        let at = |t: f64| {
            let [_, d, dd] = c.derivatives(t);
            d.perp_dot(dd) / d.length().powi(3)
        };
        (0..200).map(|i| (at(t[i + 1].min(0.9999)) - at(t[i])).abs()).fold(0.0, f64::max)
    };
    let fit = smoothed(5, &t, &data, true, 0.002).unwrap();
    assert!((fit.rms - 0.002).abs() < 2.1e-5 && fit.greatest < 0.01);
    let rough = coolinggen_nurbs::interpolate_closed(&t, &data).unwrap();
    // The ellipse alone changes by 0.04 /mm between neighbours at its nose.
    assert!(bends(&rough) > 0.1 && bends(&fit.curve) < 0.05, "{} {}", bends(&rough), bends(&fit.curve));
    let (a, b) = (fit.curve.derivatives(0.0), fit.curve.derivatives(1.0));
    for k in 0..3 {
        assert!(a[k].distance(b[k]) < 1e-9 * (1.0 + a[k].length()), "{k}");
    }
}

#[test]
fn a_fit_of_a_line_may_be_smoother_than_asked() {
    let t = even(20);
    let fit = smoothed(3, &t, &t, false, 0.1).unwrap();
    assert!(fit.rms < 1e-6);
    assert!(matches!(smoothed(4, &t, &t, false, 0.1), Err(NurbsError::Degree { .. })));
    assert!(matches!(smoothed(3, &t, &t, false, -0.1), Err(NurbsError::BadArgument { .. })));
}

#[test]
fn few_knots_reach_a_tolerance() {
    let t = even(400);
    let data: Vec<DVec2> = t.iter().map(|t| DVec2::new(*t, (9.0 * t * t).sin())).collect();
    for tolerance in [1e-2, 1e-4, 1e-6] {
        let fit = fit_within(3, &t, &data, true, tolerance).unwrap();
        assert!(fit.greatest <= tolerance);
        assert!(fit.curve.points()[0].distance(data[0]) < 1e-15);
        assert!(fit.curve.points().len() < 160, "{}", fit.curve.points().len());
    }
    assert!(matches!(fit_within(3, &t, &data, true, 1e-16), Err(NurbsError::NoConvergence { .. })));
}

#[test]
fn chosen_knots_leave_no_control_point_without_data() {
    for degree in 1..=7 {
        for n in [degree + 1, 20, 53] {
            let t: Vec<f64> = (0..n).map(|i| (i as f64 + 0.4 * noise(i).abs()) / n as f64).collect();
            let data: Vec<f64> = (0..n).map(noise).collect();
            for count in (degree + 1..=n).step_by(3) {
                let k = Knots::for_fit(degree, &t, count).unwrap();
                assert_eq!(k.control_count(), count);
                let fit = LeastSquares::new(k, &t, None, &[], None).and_then(|f| f.curve(&data, &[]));
                let Ok(fit) = fit else {
                    assert!(10 * count > 9 * n, "{degree} {n} {count} {fit:?}");
                    continue;
                };
                // Never worse than the curve that is zero everywhere.
                let size = (data.iter().map(|d| d * d).sum::<f64>() / n as f64).sqrt();
                assert!(fit.rms <= size, "{degree} {n} {count} {} {size}", fit.rms);
            }
        }
    }
    assert!(matches!(Knots::for_fit(3, &even(9), 11), Err(NurbsError::PointCount { .. })));
}

#[test]
fn a_surface_fit_reproduces_a_surface_and_meets_its_borders() {
    let k = Knots::uniform(3, 6).unwrap();
    let net = (0..36).map(|i| DVec3::new(f64::from(i / 6), f64::from(i % 6), noise(i as usize))).collect();
    let truth = Surface::new(k.clone(), k.clone(), net).unwrap();
    let t = even(15);
    let grid: Vec<DVec3> =
        t.iter().flat_map(|&u| t.iter().map(move |&v| (u, v))).map(|(u, v)| truth.point(u, v)).collect();
    let free = LeastSquares::new(k.clone(), &t, None, &[], None).unwrap();
    let again = free.surface(&free, &grid, &[], &[]).unwrap();
    for (a, b) in again.points().iter().zip(truth.points()) {
        assert!(a.distance(*b) < 1e-11);
    }
    // Noise in the data; corners and borders' ends are met all the same.
    let rough: Vec<DVec3> = grid.iter().enumerate().map(|(i, p)| *p + DVec3::Z * 0.1 * noise(i)).collect();
    let ends = [Constraint::derivative(&k, 0.0, 0).unwrap(), Constraint::derivative(&k, 1.0, 0).unwrap()];
    let held = LeastSquares::new(k.clone(), &t, None, &ends, None).unwrap();
    let values = [ConstraintValue::Data(0), ConstraintValue::Data(15)];
    let fit = held.surface(&held, &rough, &values, &values).unwrap();
    for (u, v, i) in [(0.0, 0.0, 0), (0.0, 1.0, 15), (1.0, 0.0, 240), (1.0, 1.0, 255)] {
        assert!(fit.point(u, v).distance(rough[i]) < 1e-12);
    }
}
