//! Interpolation: B-splines through given points at given parameters.

use crate::banded::BandedLu;
use crate::curve::Curve;
use crate::error::NurbsError;
use crate::knots::Knots;
use crate::surface::Surface;
use crate::vector::VectorSpace;

/// A factored interpolation problem: knots and parameters, ready for any number of right-hand sides.
///
/// The error against a function with bounded derivative of order `degree + 1` falls as `h^(degree + 1)`; for the
/// cubic with end slopes it is at most `5/384 h^4 max|f''''|` (Hall and Meyer 1976).
#[derive(Clone, Debug)]
pub struct Interpolator {
    knots: Knots,
    lu: BandedLu,
    slopes: bool,
}

impl Interpolator {
    /// Interpolation of `degree` at increasing `parameters`, at least `degree + 1` of them, without conditions at
    /// the ends ("not a knot": for odd degrees the knots are the parameters less `(degree - 1) / 2` next to each
    /// end; for even degrees they lie between parameters).
    ///
    /// # Errors
    /// [`NurbsError::PointCount`], [`NurbsError::BadParameters`], [`NurbsError::Degree`].
    pub fn new(degree: usize, parameters: &[f64]) -> Result<Self, NurbsError> {
        check_increasing(parameters, degree + 1)?;
        let n = parameters.len();
        let half = degree / 2;
        let mut breaks = vec![parameters[0]];
        if degree % 2 == 1 {
            breaks.extend_from_slice(&parameters[half + 1..n - 1 - half]);
        } else {
            breaks.extend((half..n - 1 - half).map(|i| 0.5 * (parameters[i] + parameters[i + 1])));
        }
        breaks.push(parameters[n - 1]);
        let knots = Knots::clamped(degree, &breaks)?;
        let lu = BandedLu::factor(n, degree, |i, row| {
            let basis = knots.basis(parameters[i], 0);
            row[..=degree].copy_from_slice(&basis.values[0][..=degree]);
            basis.first
        })?;
        Ok(Self { knots, lu, slopes: false })
    }

    /// Cubic interpolation with a break at each of the increasing `parameters` (at least 2) and given derivatives
    /// at both ends.
    ///
    /// # Errors
    /// [`NurbsError::PointCount`], [`NurbsError::BadParameters`].
    pub fn with_slopes(parameters: &[f64]) -> Result<Self, NurbsError> {
        check_increasing(parameters, 2)?;
        let n = parameters.len();
        let knots = Knots::clamped(3, parameters)?;
        let lu = BandedLu::factor(n + 2, 3, |i, row| {
            // Rows: first point, first slope, inner points, last slope, last point.
            let (parameter, order) = match i {
                0 => (parameters[0], 0),
                1 => (parameters[0], 1),
                i if i == n => (parameters[n - 1], 1),
                i if i == n + 1 => (parameters[n - 1], 0),
                i => (parameters[i - 1], 0),
            };
            let basis = knots.basis(parameter, order);
            row[..4].copy_from_slice(&basis.values[order][..4]);
            basis.first
        })?;
        Ok(Self { knots, lu, slopes: true })
    }

    /// Knots of the result.
    pub fn knots(&self) -> &Knots {
        &self.knots
    }

    /// The curve through `points`, one a parameter.
    ///
    /// # Errors
    /// [`NurbsError::PointCount`] for a wrong count, or if the interpolator asks for slopes.
    pub fn curve<V: VectorSpace>(&self, points: &[V]) -> Result<Curve<V>, NurbsError> {
        let expected = self.knots.control_count();
        if self.slopes || points.len() != expected {
            return Err(NurbsError::PointCount { count: points.len(), expected });
        }
        let mut right = points.to_vec();
        self.lu.solve(&mut right);
        Curve::new(self.knots.clone(), right)
    }

    /// The cubic through `points` with end derivatives `start` and `end`.
    ///
    /// # Errors
    /// [`NurbsError::PointCount`] for a wrong count, or if the interpolator was made without slopes.
    pub fn curve_with_slopes<V: VectorSpace>(
        &self,
        points: &[V],
        start: V,
        end: V,
    ) -> Result<Curve<V>, NurbsError> {
        let expected = self.knots.control_count() - 2;
        if !self.slopes || points.len() != expected {
            return Err(NurbsError::PointCount { count: points.len(), expected });
        }
        let mut right = Vec::with_capacity(expected + 2);
        right.extend([points[0], start]);
        right.extend_from_slice(&points[1..expected - 1]);
        right.extend([end, points[expected - 1]]);
        self.lu.solve(&mut right);
        Curve::new(self.knots.clone(), right)
    }

    /// The loft through `sections`, curves with the same knots, one a parameter of this interpolator (which then
    /// runs in v): control points are interpolated, so that equal control points stay equal bit for bit.
    ///
    /// # Errors
    /// [`NurbsError::PointCount`] for a wrong number of sections or control points.
    pub fn loft<V: VectorSpace>(&self, sections: &[Curve<V>]) -> Result<Surface<V>, NurbsError> {
        let expected = self.knots.control_count();
        let Some(first) = sections.first().filter(|_| sections.len() == expected && !self.slopes) else {
            return Err(NurbsError::PointCount { count: sections.len(), expected });
        };
        let count = first.points.len();
        let mut net = Vec::with_capacity(count * expected);
        for i in 0..count {
            let start = net.len();
            for s in sections {
                let point = s.points.get(i).filter(|_| s.points.len() == count);
                net.push(*point.ok_or(NurbsError::PointCount { count: s.points.len(), expected: count })?);
            }
            self.lu.solve(&mut net[start..]);
        }
        Surface::new(first.knots.clone(), self.knots.clone(), net)
    }
}

fn check_increasing(parameters: &[f64], least: usize) -> Result<(), NurbsError> {
    if parameters.len() < least {
        return Err(NurbsError::PointCount { count: parameters.len(), expected: least });
    }
    match (1..parameters.len()).find(|&i| !(parameters[i] > parameters[i - 1])) {
        Some(index) => Err(NurbsError::BadParameters { index }),
        None => Ok(()),
    }
}

/// The closed C2 cubic through `points` at `parameters`; the last point must repeat the first, and the parameters
/// run over one period.
///
/// # Errors
/// [`NurbsError::PointCount`] for fewer than 4 points, [`NurbsError::BadParameters`].
pub fn interpolate_closed<V: VectorSpace>(parameters: &[f64], points: &[V]) -> Result<Curve<V>, NurbsError> {
    check_increasing(parameters, 4)?;
    if points.len() != parameters.len() {
        return Err(NurbsError::PointCount { count: points.len(), expected: parameters.len() });
    }
    let slope = closed_slope(parameters, points);
    Interpolator::with_slopes(parameters)?.curve_with_slopes(points, slope, slope)
}

/// Derivative at the seam of the periodic cubic spline: the cyclic tridiagonal system for the slopes, solved by
/// bordering (the Sherman-Morrison formula).
pub fn closed_slope<V: VectorSpace>(parameters: &[f64], points: &[V]) -> V {
    let n = parameters.len() - 1;
    let h = |i: usize| parameters[i % n + 1] - parameters[i % n];
    let secant = |i: usize| (points[i % n + 1] - points[i % n]) * (1.0 / h(i));
    // Row i: h_i m_(i-1) + 2 (h_(i-1) + h_i) m_i + h_(i-1) m_(i+1) = 3 (h_i s_(i-1) + h_(i-1) s_i).
    let before = |i: usize| h(i + n - 1);
    let (lower, upper) = (|i: usize| h(i), |i: usize| before(i));
    let gamma = -2.0 * (before(0) + h(0));
    let mut diagonal: Vec<f64> = (0..n).map(|i| 2.0 * (before(i) + h(i))).collect();
    diagonal[0] -= gamma;
    diagonal[n - 1] -= lower(0) * upper(n - 1) / gamma;
    let mut x: Vec<V> = (0..n).map(|i| (secant(i + n - 1) * h(i) + secant(i) * before(i)) * 3.0).collect();
    let mut z = vec![0.0; n];
    z[0] = gamma;
    z[n - 1] = upper(n - 1);
    for i in 1..n {
        let factor = lower(i) / diagonal[i - 1];
        diagonal[i] -= factor * upper(i - 1);
        x[i] = x[i] - x[i - 1] * factor;
        z[i] -= z[i - 1] * factor;
    }
    x[n - 1] = x[n - 1] * (1.0 / diagonal[n - 1]);
    z[n - 1] /= diagonal[n - 1];
    for i in (0..n - 1).rev() {
        x[i] = (x[i] - x[i + 1] * upper(i)) * (1.0 / diagonal[i]);
        z[i] = (z[i] - z[i + 1] * upper(i)) / diagonal[i];
    }
    let corner = lower(0) / gamma;
    let factor = 1.0 / (1.0 + z[0] + corner * z[n - 1]);
    x[0] - (x[0] + x[n - 1] * corner) * (z[0] * factor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::ParametricCurve;
    use glam::DVec2;
    use proptest::prelude::*;

    #[test]
    fn a_closed_interpolant_of_a_circle_is_smooth_over_the_seam() {
        let t: Vec<f64> = (0..=48).map(|i| (f64::from(i) + 0.2 * f64::from(i % 2)) / 48.0).collect();
        let mut points: Vec<DVec2> = t.iter().map(|t| DVec2::from_angle(t * std::f64::consts::TAU)).collect();
        points[48] = points[0];
        let c = interpolate_closed(&t, &points).unwrap();
        let (a, b) = (c.derivatives(0.0), c.derivatives(1.0));
        for k in 0..3 {
            assert!((a[k] - b[k]).length() < 1e-9 * (1.0 + a[k].length()), "{k}: {} {}", a[k], b[k]);
        }
        let worst =
            (0..1000).map(|i| (c.point(f64::from(i) / 1000.0).length() - 1.0).abs()).fold(0.0, f64::max);
        assert!(worst < 6e-6, "{worst}");
    }

    proptest! {
        #[test]
        fn passes_through_its_points_and_reproduces_polynomials(
            degree in 1usize..=7,
            gaps in proptest::collection::vec(0.2f64..1.0, 8..20),
            c in proptest::array::uniform4(-1.0f64..1.0),
        ) {
            let mut t = vec![0.0];
            for g in &gaps { t.push(t[t.len() - 1] + g); }
            let end = t[t.len() - 1];
            let f = |t: f64| {
                let x = t / end;
                (0..=degree.min(3)).map(|k| c[k] * x.powi(k as i32)).sum::<f64>()
            };
            let values: Vec<f64> = t.iter().map(|&t| f(t)).collect();
            let curve = Interpolator::new(degree, &t).unwrap().curve(&values).unwrap();
            for i in 0..=50 {
                let x = end * f64::from(i) / 50.0;
                prop_assert!((curve.point(x) - f(x)).abs() < 1e-9);
            }
        }

        #[test]
        fn the_cubic_with_slopes_keeps_its_error_bound(n in 5usize..60) {
            let t: Vec<f64> = (0..=n).map(|i| i as f64 / n as f64).collect();
            let values: Vec<f64> = t.iter().map(|t| t.sin()).collect();
            let curve = Interpolator::with_slopes(&t).unwrap().curve_with_slopes(&values, 1.0, 1f64.cos()).unwrap();
            let bound = 5.0 / 384.0 * (1.0 / n as f64).powi(4) * 1f64.sin() + 1e-14;
            for i in 0..=400 {
                let x = f64::from(i) / 400.0;
                prop_assert!((curve.point(x) - x.sin()).abs() <= bound);
            }
        }
    }
}
