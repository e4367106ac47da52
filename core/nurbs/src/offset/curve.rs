//! Offset curves, untrimmed.

use crate::curve::{Curve, ParametricCurve};
use crate::error::NurbsError;
use crate::fit::{Fit, fit_function};
use glam::DVec2;

/// A distance along a curve: constant, or a law in the curve's parameter.
pub trait OffsetLaw {
    /// Distance with first and second derivative at `t`.
    fn distance(&self, t: f64) -> [f64; 3];

    /// Parameters between which the law is smooth, besides the curve's own breaks.
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }
}

impl OffsetLaw for f64 {
    fn distance(&self, _: f64) -> [f64; 3] {
        [*self, 0.0, 0.0]
    }
}

impl OffsetLaw for Curve<f64> {
    fn distance(&self, t: f64) -> [f64; 3] {
        self.derivatives(t)
    }
    fn breaks(&self) -> Vec<f64> {
        ParametricCurve::breaks(self)
    }
}

/// The curve at a distance to the left of another (negative: to the right): `O = C + d n` with the unit normal `n`,
/// the tangent turned left by a right angle (thesis definition 2.3.11, for varying distances too). For a closed curve
/// that runs counterclockwise left is inside.
///
/// Where the distance exceeds the radius of curvature on the inner side the offset turns back in cusps; see
/// [`trimmed_offset`](crate::trimmed_offset). Points and both derivatives are exact; where the curve's speed vanishes
/// they are not finite.
#[derive(Clone, Debug)]
pub struct OffsetCurve<C, D> {
    curve: C,
    law: D,
}

impl<C: ParametricCurve<DVec2>, D: OffsetLaw> OffsetCurve<C, D> {
    /// The offset of `curve` (or a reference to one) by `law`.
    pub fn new(curve: C, law: D) -> Self {
        Self { curve, law }
    }

    /// The curve offset from.
    pub fn curve(&self) -> &C {
        &self.curve
    }

    /// How fast the offset runs along the tangent, relative to the curve: `1 - curvature * distance`. Negative where it
    /// runs back, zero at cusps of a constant offset.
    pub fn stretch(&self, t: f64) -> f64 {
        let [_, d, dd] = self.curve.derivatives(t);
        1.0 - d.perp_dot(dd) / d.length().powi(3) * self.law.distance(t)[0]
    }

    /// A cubic B-spline within `tolerance` of the offset at equal parameters, see [`fit_function`].
    ///
    /// # Errors
    /// As [`fit_function`]: also where the curve has kinks, which an offset does not survive in one piece.
    pub fn fitted(&self, tolerance: f64) -> Result<Fit<DVec2>, NurbsError> {
        let f = |t: f64| {
            let [p, d, _] = self.derivatives(t);
            [p, d]
        };
        fit_function(f, &self.breaks(), tolerance)
    }
}

impl<C: ParametricCurve<DVec2>, D: OffsetLaw> ParametricCurve<DVec2> for OffsetCurve<C, D> {
    fn domain(&self) -> (f64, f64) {
        self.curve.domain()
    }

    fn point(&self, t: f64) -> DVec2 {
        let [p, d, _] = self.curve.derivatives(t);
        p + d.perp() * (self.law.distance(t)[0] / d.length())
    }

    fn derivatives(&self, t: f64) -> [DVec2; 3] {
        let [p, d1, d2] = self.curve.derivatives(t);
        let d3 = self.curve.third_derivative(t);
        let [distance, slope, bend] = self.law.distance(t);
        let speed = d1.length();
        let (tangent, normal) = (d1 / speed, d1.perp() / speed);
        let cube = speed * speed * speed;
        let curvature = d1.perp_dot(d2) / cube;
        let speed_slope = d1.dot(d2) / speed;
        let curvature_slope = d1.perp_dot(d3) / cube - 3.0 * curvature * speed_slope / speed;
        // T' = k v n and n' = -k v T.
        let turn = curvature * speed;
        let along = speed * (1.0 - curvature * distance);
        let along_slope = speed_slope * (1.0 - curvature * distance)
            - speed * (curvature_slope * distance + curvature * slope);
        [
            p + normal * distance,
            tangent * along + normal * slope,
            tangent * (along_slope - slope * turn) + normal * (along * turn + bend),
        ]
    }

    fn breaks(&self) -> Vec<f64> {
        let (start, end) = self.domain();
        let mut all = self.curve.breaks();
        all.extend(self.law.breaks().into_iter().filter(|t| *t > start && *t < end));
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }
}
