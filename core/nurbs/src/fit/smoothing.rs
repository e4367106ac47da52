//! Fits that choose for themselves: how much to smooth, where to put knots.

use super::constraint::Constraint;
use super::least_squares::{Fit, LeastSquares, Smoothing};
use crate::error::NurbsError;
use crate::knots::Knots;
use crate::vector::VectorSpace;

/// The smoothing spline of odd `degree` (3: least second derivative, 5: least third) with a knot at every parameter
/// whose root mean square deviation from `points` is `rms`, within 1 %. Below the noise of the data the curvature
/// jumps that stall offsets are gone (Reinsch 1967; the thesis's blades need it for measured data).
///
/// With `closed` the last point must repeat the first, and all derivatives below the degree continue over the seam;
/// otherwise the ends are smoothed like the rest. Parameters must increase. If even the smoothest curve (a
/// polynomial of degree `(degree - 1) / 2`) deviates less than `rms`, that one is returned.
///
/// # Errors
/// [`NurbsError::Degree`] for an even degree, [`NurbsError::PointCount`] for less than `degree + 1` points,
/// [`NurbsError::KnotOrder`] for parameters that do not increase, [`NurbsError::BadArgument`] for an `rms` that is
/// not positive, [`NurbsError::NoConvergence`] if no smoothing gives it.
pub fn smoothed<V: VectorSpace>(
    degree: usize,
    parameters: &[f64],
    points: &[V],
    closed: bool,
    rms: f64,
) -> Result<Fit<V>, NurbsError> {
    if degree.is_multiple_of(2) {
        return Err(NurbsError::Degree { degree, greatest: crate::MAX_DEGREE });
    }
    if points.len() != parameters.len() || points.len() <= degree {
        let expected = parameters.len().max(degree + 1);
        return Err(NurbsError::PointCount { count: points.len(), expected });
    }
    if !(rms > 0.0) || !rms.is_finite() {
        return Err(NurbsError::BadArgument { what: "deviation of a smoothing spline", value: rms });
    }
    if let Some(i) = (1..parameters.len()).find(|&i| !(parameters[i] > parameters[i - 1])) {
        return Err(NurbsError::KnotOrder { index: i, before: parameters[i - 1], value: parameters[i] });
    }
    let knots = Knots::clamped(degree, parameters)?;
    let order = degree.div_ceil(2);
    let constraints = if closed {
        (0..degree).map(|k| Constraint::closure(&knots, k)).collect::<Result<Vec<_>, _>>()?
    } else {
        Vec::new()
    };
    let zeros = vec![V::default(); constraints.len()];
    // The last point repeats the first: half the weight each.
    let mut weights = vec![1.0; points.len()];
    if closed {
        weights[0] = 0.5;
        weights[points.len() - 1] = 0.5;
    }
    let fit = |exponent: f64| -> Result<Fit<V>, NurbsError> {
        let smoothing = Some(Smoothing { order, factor: exponent.exp() });
        LeastSquares::new(knots.clone(), parameters, Some(&weights), &constraints, smoothing)?
            .curve(points, &zeros)
    };
    // The penalty balances the data when the factor is about the spacing to the power 2 order - 1.
    let spacing = (parameters[points.len() - 1] - parameters[0]) / (points.len() - 1) as f64;
    let middle = (2 * order - 1) as f64 * spacing.ln();
    // Beyond the factor that balances them over the whole length nothing changes any more.
    let reach = (2 * order - 1) as f64 * (points.len() as f64).ln() + 5.0;
    bisect(middle, reach, rms, fit)
}

/// Finds the exponent whose fit has the deviation asked for; deviations grow with it.
fn bisect<V: VectorSpace>(
    middle: f64,
    reach: f64,
    rms: f64,
    fit: impl Fn(f64) -> Result<Fit<V>, NurbsError>,
) -> Result<Fit<V>, NurbsError> {
    const STEP: f64 = 5.0;
    let (mut low, mut high) = (None, None);
    let mut best: Option<Fit<V>> = None;
    // Whether a curve was found to be too smooth, or the arithmetic gave out before.
    let mut exceeded = false;
    let mut at = middle;
    for _ in 0..60 {
        match fit(at) {
            Ok(found) if (found.rms - rms).abs() <= 0.01 * rms => return Ok(found),
            Ok(found) if found.rms < rms => {
                low = Some(at);
                best = Some(found);
            }
            Ok(_) => {
                high = Some(at);
                exceeded = true;
            }
            Err(_) if at > middle => high = Some(at),
            Err(_) => low = Some(at),
        }
        at = match (low, high) {
            (Some(a), Some(b)) => 0.5 * (a + b),
            (Some(a), None) => a + STEP,
            (None, Some(b)) => b - STEP,
            (None, None) => middle,
        };
        if at - middle > reach || middle - at > 60.0 {
            break;
        }
    }
    // Only the smoothest curve of all may deviate less.
    let residual = best.as_ref().map_or(f64::INFINITY, |b| rms - b.rms);
    best.filter(|_| !exceeded)
        .ok_or(NurbsError::NoConvergence { what: "smoothing spline with a given deviation", residual })
}

/// The least-squares spline with few knots that stays within `tolerance` of all `points` (greatest distance at the
/// same parameter): knots are added where it does not, each in the middle of the data of its span.
///
/// The first and last point are met exactly if `ends` says so. Parameters must increase.
///
/// # Errors
/// [`NurbsError::PointCount`], [`NurbsError::KnotOrder`] for parameters that do not increase,
/// [`NurbsError::NoConvergence`] with the deviation left if the data allow no more knots.
pub fn fit_within<V: VectorSpace>(
    degree: usize,
    parameters: &[f64],
    points: &[V],
    ends: bool,
    tolerance: f64,
) -> Result<Fit<V>, NurbsError> {
    let n = parameters.len();
    if points.len() != n || n <= degree {
        return Err(NurbsError::PointCount { count: points.len(), expected: n.max(degree + 1) });
    }
    if let Some(i) = (1..n).find(|&i| !(parameters[i] > parameters[i - 1])) {
        return Err(NurbsError::KnotOrder { index: i, before: parameters[i - 1], value: parameters[i] });
    }
    let mut breaks = vec![parameters[0], parameters[n - 1]];
    loop {
        let knots = Knots::clamped(degree, &breaks)?;
        let (start, end) = knots.domain();
        let (mut constraints, mut values) = (Vec::new(), Vec::new());
        if ends {
            constraints =
                vec![Constraint::derivative(&knots, start, 0)?, Constraint::derivative(&knots, end, 0)?];
            values = vec![points[0], points[n - 1]];
        }
        let fit = LeastSquares::new(knots, parameters, None, &constraints, None)?.curve(points, &values)?;
        if fit.greatest <= tolerance {
            return Ok(fit);
        }
        let refined = refine(&breaks, parameters, points, &fit, tolerance);
        if refined.len() == breaks.len() {
            let what = "least-squares fit within a tolerance";
            return Err(NurbsError::NoConvergence { what, residual: fit.greatest });
        }
        breaks = refined;
    }
}

/// The breaks with one more in every span that misses its data and has enough of them left.
fn refine<V: VectorSpace>(
    breaks: &[f64],
    parameters: &[f64],
    points: &[V],
    fit: &Fit<V>,
    tolerance: f64,
) -> Vec<f64> {
    use crate::curve::ParametricCurve;
    let mut refined = vec![breaks[0]];
    for span in breaks.windows(2) {
        let from = parameters.partition_point(|&t| t < span[0]);
        let to = parameters.partition_point(|&t| t < span[1]);
        let misses = |i: usize| fit.curve.point(parameters[i]).distance_to(&points[i]) > tolerance;
        // Two data a span keep the Schoenberg-Whitney condition.
        if to - from >= 4 && (from..to).any(misses) {
            let middle = (from + to) / 2;
            refined.push(0.5 * (parameters[middle - 1] + parameters[middle]));
        }
        refined.push(span[1]);
    }
    refined
}
