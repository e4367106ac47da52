//! Curves and surfaces for the tests.
#![allow(dead_code, unreachable_pub, missing_docs)]

use coolinggen_nurbs::{
    Curve, Interpolator, Knots, ParametricCurve, ParametricSurface, RationalSurface, Surface,
    interpolate_closed,
};
use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::ops::RangeInclusive;

/// The same cases in every run; `PROPTEST_CASES` still sets their number.
pub fn fixed() -> ProptestConfig {
    ProptestConfig { rng_seed: RngSeed::Fixed(2022), failure_persistence: None, ..ProptestConfig::default() }
}

/// A control point in the unit cube.
pub fn point() -> impl Strategy<Value = DVec3> {
    proptest::array::uniform3(-1.0f64..1.0).prop_map(DVec3::from)
}

/// Clamped knots on [0, 1] with up to 5 interior breaks of any multiplicity.
pub fn knots(degree: RangeInclusive<usize>) -> impl Strategy<Value = Knots> {
    (degree, proptest::collection::vec((0.2f64..1.0, 1usize..=7), 0..=5)).prop_map(|(p, gaps)| {
        let total: f64 = gaps.iter().map(|g| g.0).sum::<f64>() + 0.6;
        let mut values = vec![0.0; p + 1];
        let mut at = 0.0;
        for (gap, multiplicity) in gaps {
            at += gap;
            // Mostly simple knots, sometimes multiple ones.
            let times = if multiplicity <= 4 { 1 } else { multiplicity - 3 };
            values.extend(std::iter::repeat_n(at / total, times.min(p)));
        }
        values.extend(std::iter::repeat_n(1.0, p + 1));
        Knots::new(p, values).unwrap()
    })
}

/// A curve of a degree in the range, on [0, 1].
pub fn curve(degree: RangeInclusive<usize>) -> impl Strategy<Value = Curve<DVec3>> {
    knots(degree)
        .prop_flat_map(|k| {
            let count = k.control_count();
            (Just(k), proptest::collection::vec(point(), count))
        })
        .prop_map(|(k, points)| Curve::new(k, points).unwrap())
}

/// A surface of degrees 1 to 4 on the unit square.
pub fn surface() -> impl Strategy<Value = Surface<DVec3>> {
    (knots(1..=4), knots(1..=4))
        .prop_flat_map(|(u, v)| {
            let count = u.control_count() * v.control_count();
            (Just(u), Just(v), proptest::collection::vec(point(), count))
        })
        .prop_map(|(u, v, points)| Surface::new(u, v, points).unwrap())
}

/// Greatest distance of equal parameters of two curves on `[a, b]`.
pub fn worst_difference(
    a: &impl ParametricCurve<DVec3>,
    b: &impl ParametricCurve<DVec3>,
    start: f64,
    end: f64,
) -> f64 {
    (0..=200)
        .map(|i| start + (end - start) * f64::from(i) / 200.0)
        .map(|t| a.point(t).distance(b.point(t)))
        .fold(0.0, f64::max)
}

/// Greatest distance of equal parameters of two surfaces on a rectangle.
pub fn worst_surface_difference(
    a: &impl ParametricSurface<DVec3>,
    b: &impl ParametricSurface<DVec3>,
    (u0, u1): (f64, f64),
    (v0, v1): (f64, f64),
) -> f64 {
    let at = |a: f64, b: f64, i: i32| a + (b - a) * f64::from(i) / 25.0;
    (0..=25)
        .flat_map(|i| (0..=25).map(move |j| (at(u0, u1, i), at(v0, v1, j))))
        .map(|(u, v)| a.point(u, v).distance(b.point(u, v)))
        .fold(0.0, f64::max)
}

/// The meridian `(r, z)` turned around the z axis, u around in four quarters (0 to 4), v along.
pub fn revolved(knots_v: Knots, meridian: &[(f64, f64)], weights: &[f64]) -> RationalSurface<DVec3> {
    let h = 0.5f64.sqrt();
    let square =
        [(1., 0.), (1., 1.), (0., 1.), (-1., 1.), (-1., 0.), (-1., -1.), (0., -1.), (1., -1.), (1., 0.)];
    let knots_u = Knots::new(2, vec![0., 0., 0., 1., 1., 2., 2., 3., 3., 4., 4., 4.]).unwrap();
    let mut net = vec![];
    let mut all = vec![];
    for (i, &(x, y)) in square.iter().enumerate() {
        for (&(r, z), w) in meridian.iter().zip(weights) {
            net.push(DVec3::new(r * x, r * y, z));
            all.push(if i % 2 == 1 { w * h } else { *w });
        }
    }
    RationalSurface::new(knots_u, knots_v, &net, &all).unwrap()
}

/// A blade-like surface of 20 x 8 control points, closed in u and smooth over the seam, bicubic.
pub fn blade() -> Surface<DVec3> {
    let t: Vec<f64> = (0..=24).map(|i| f64::from(i) / 24.0).collect();
    let sections: Vec<Curve<DVec3>> = (0..8)
        .map(|j| {
            let z = f64::from(j) * 10.0;
            let points: Vec<DVec3> = (0..=24)
                .map(|i| {
                    let a = f64::from(i % 24) / 24.0 * std::f64::consts::TAU;
                    let camber = 6.0 * a.cos() * a.cos();
                    DVec3::new(20.0 * a.cos() + 0.1 * z, 5.0 * a.sin() + camber + 0.002 * z * z, z)
                })
                .collect();
            interpolate_closed(&t, &points).unwrap()
        })
        .collect();
    let v: Vec<f64> = (0..8).map(|j| f64::from(j) / 7.0).collect();
    Interpolator::new(3, &v).unwrap().loft(&sections).unwrap()
}
