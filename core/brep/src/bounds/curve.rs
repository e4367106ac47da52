//! Extremes of curves.

use super::{BOUNDS_TOLERANCE_MM, Bounds};
use crate::geometry::EdgeCurve;
use crate::span::full_spans;
use coolinggen_nurbs::{Homogeneous, Knots, ParametricCurve};
use glam::DVec3;

/// Makes `bounds` hold the curve.
pub(super) fn include(curve: &EdgeCurve, bounds: &mut Bounds) {
    let (start, end) = curve.domain();
    bounds.include(curve.point(start));
    bounds.include(curve.point(end));
    match curve {
        EdgeCurve::BSpline(c) => grow(curve, c.knots(), |i| c.points()[i], bounds),
        EdgeCurve::Rational(c) => {
            let h = c.homogeneous();
            grow(curve, h.knots(), |i| Homogeneous::project(&h.points()[i]), bounds);
        }
    }
}

/// Looks at the spans whose control points stick out: the curve lies in the hull of those of each span.
fn grow(curve: &EdgeCurve, knots: &Knots, point: impl Fn(usize) -> DVec3, bounds: &mut Bounds) {
    let p = knots.degree();
    for index in full_spans(knots) {
        let hull = (index - p..=index).map(&point);
        let hull = hull.fold(Bounds::EMPTY, |b, p| b.union(Bounds { min: p, max: p }));
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                if hull.reach(axis, sign) > bounds.reach(axis, sign) + BOUNDS_TOLERANCE_MM {
                    let values = knots.values();
                    let t = summit(curve, axis, sign, values[index], values[index + 1]);
                    bounds.include(curve.point(t));
                }
            }
        }
    }
}

/// Where between `start` and `end` the coordinate times `sign` is greatest: Newton's method for its slope, kept
/// between the neighbours of the best of some samples by halving.
fn summit(curve: &EdgeCurve, axis: usize, sign: f64, start: f64, end: f64) -> f64 {
    const STEPS: usize = 8;
    let at = |i: usize| start + (end - start) * i as f64 / STEPS as f64;
    let value = |i: usize| sign * curve.point(at(i))[axis];
    let best = (0..=STEPS).max_by(|&a, &b| value(a).total_cmp(&value(b))).unwrap_or(0);
    let (mut low, mut high) = (at(best.saturating_sub(1)), at((best + 1).min(STEPS)));
    let mut t = at(best);
    for _ in 0..60 {
        let [_, d, dd] = curve.derivatives(t);
        let (slope, bend) = (sign * d[axis], sign * dd[axis]);
        if slope > 0.0 {
            low = t;
        } else {
            high = t;
        }
        let newton = t - slope / bend;
        let next = if bend < 0.0 && newton > low && newton < high { newton } else { 0.5 * (low + high) };
        // The value is flat at the top: half the digits of t are enough for all of its own.
        if (next - t).abs() <= 1e-10 * (end - start) {
            return next;
        }
        t = next;
    }
    t
}
