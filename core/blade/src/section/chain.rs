//! Smooth curves through chains of points.

use coolinggen_nurbs::{
    Constraint, Curve, Interpolator, Knots, LeastSquares, NurbsError, ParametricCurve, Smoothing,
    interpolate_closed,
};
use glam::DVec2;

/// What is known of a chain at an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// Nothing: a kink follows.
    Free,
    /// The unit tangent, as the chain runs.
    Tangent(DVec2),
}

/// A curve with the parameters of the points it passes through.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub(super) curve: Curve<DVec2>,
    pub(super) parameters: Vec<f64>,
}

/// How often parameters are replaced by arc lengths of the curve found: chords are shorter than arcs where points are
/// far apart, which shows in the curvature.
const ROUNDS: usize = 2;

/// The cubic through `points` (two or more) with parameters close to arc length: quick, to try ends with.
pub(super) fn cubic(points: &[DVec2], start: End, end: End) -> Result<Chain, NurbsError> {
    let mut parameters = chord_lengths(points);
    let mut curve = cubic_at(points, &parameters, start, end)?;
    for _ in 0..ROUNDS {
        parameters = arc_lengths(&curve, &parameters);
        curve = cubic_at(points, &parameters, start, end)?;
    }
    Ok(Chain { curve, parameters })
}

/// The quintic through `points` (two or more; a cubic for fewer than four) whose curvature runs most evenly (least
/// integral of the squared third derivative), with parameters close to arc length. It leaves points by up to
/// `tolerance`, mm, if that makes the curvature more even by half.
pub(super) fn open(points: &[DVec2], start: End, end: End, tolerance: f64) -> Result<Chain, NurbsError> {
    let Chain { curve, parameters } = cubic(points, start, end)?;
    if points.len() < 4 {
        return Ok(Chain { curve, parameters });
    }
    let n = points.len();
    let knots = Knots::clamped(5, &parameters)?;
    let (mut constraints, mut values) = (Vec::new(), Vec::new());
    for (condition, k) in [(start, 0), (end, n - 1)] {
        constraints.push(Constraint::derivative(&knots, parameters[k], 0)?);
        values.push(points[k]);
        if let End::Tangent(t) = condition {
            constraints.push(Constraint::derivative(&knots, parameters[k], 1)?);
            values.push(t);
        }
    }
    let curve = even(&knots, &parameters, points, None, (&constraints, &values), tolerance)?;
    Ok(Chain { curve, parameters })
}

/// As [`open`], closed (at least four points, the first not repeated); `parameters` has one entry more.
pub(super) fn closed(points: &[DVec2], tolerance: f64) -> Result<Chain, NurbsError> {
    let mut ring = points.to_vec();
    ring.push(points[0]);
    let mut parameters = chord_lengths(&ring);
    for _ in 0..ROUNDS {
        parameters = arc_lengths(&interpolate_closed(&parameters, &ring)?, &parameters);
    }
    let knots = Knots::clamped(5, &parameters)?;
    let constraints = (0..5).map(|k| Constraint::closure(&knots, k)).collect::<Result<Vec<_>, _>>()?;
    let mut weights = vec![1.0; ring.len()];
    weights[0] = 0.5;
    weights[ring.len() - 1] = 0.5;
    let zeros = [DVec2::ZERO; 5];
    let curve = even(&knots, &parameters, &ring, Some(&weights), (&constraints, &zeros), tolerance)?;
    Ok(Chain { curve, parameters })
}

/// Least smoothing, over the fifth power of the smallest spacing: as good as none.
const NONE: f64 = 1e-4;
/// Factors from one smoothing tried to the next.
const COARSE: f64 = 256.0;
const FINE: f64 = 2.0;
/// Smoothing pays if it brings the integral of the squared third derivative below this fraction.
const PAYS: f64 = 0.5;

/// The least-squares quintic with as much smoothing as pays within `tolerance`.
fn even(
    knots: &Knots,
    parameters: &[f64],
    points: &[DVec2],
    weights: Option<&[f64]>,
    (constraints, values): (&[Constraint], &[DVec2]),
    tolerance: f64,
) -> Result<Curve<DVec2>, NurbsError> {
    let spacing = parameters.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
    let fit = |factor: f64| -> Result<(Curve<DVec2>, f64, f64), NurbsError> {
        let smoothing = Some(Smoothing { order: 3, factor });
        let fit = LeastSquares::new(knots.clone(), parameters, weights, constraints, smoothing)?
            .curve(points, values)?;
        let jerk = jerk(&fit.curve);
        Ok((fit.curve, fit.greatest, jerk))
    };
    let start = NONE * spacing.powi(5);
    let (through, _, jerk_through) = fit(start)?;
    if !(tolerance > 0.0) {
        return Ok(through);
    }
    // The most smoothing that stays within the tolerance, a tenth of which is left to what follows: coarse steps, smaller
    // where they went too far. Clean data are seen early: the curve leaves them and is hardly smoother.
    let smoothed = |factor: f64| fit(factor).ok().filter(|(_, greatest, _)| *greatest <= 0.9 * tolerance);
    let (mut most, mut step) = (None, COARSE);
    let mut factor = start * COARSE;
    for _ in 0..24 {
        match smoothed(factor) {
            Some((_, greatest, jerk)) => {
                if jerk > 0.9 * jerk_through && greatest > 0.05 * tolerance {
                    return Ok(through);
                }
                most = Some((factor, jerk));
            }
            None => {
                factor /= step;
                step = step.sqrt();
                if step < FINE {
                    break;
                }
            }
        }
        factor *= step;
    }
    let Some((most, least)) = most.filter(|(_, jerk)| *jerk < PAYS * jerk_through) else {
        return Ok(through);
    };
    // The least smoothing that does nearly as well: noise goes first, shape last.
    let enough = 1.2 * least;
    let mut best = most;
    while best > start && smoothed(best / FINE).is_some_and(|(_, _, jerk)| jerk <= enough) {
        best /= FINE;
    }
    Ok(smoothed(best).map_or(through, |(curve, ..)| curve))
}

/// Integral of the squared third derivative, by three Gauss points a span: a quintic's is of degree four.
fn jerk(curve: &Curve<DVec2>) -> f64 {
    let breaks = curve.breaks();
    let offset = 0.6f64.sqrt();
    let mut sum = 0.0;
    for w in breaks.windows(2) {
        let (middle, half) = (0.5 * (w[0] + w[1]), 0.5 * (w[1] - w[0]));
        let at = |x: f64| curve.third_derivative(middle + half * x).length_squared();
        sum += half * (5.0 * at(-offset) + 8.0 * at(0.0) + 5.0 * at(offset)) / 9.0;
    }
    sum
}

fn cubic_at(points: &[DVec2], parameters: &[f64], start: End, end: End) -> Result<Curve<DVec2>, NurbsError> {
    let (first, last) = (parameters[0], parameters[parameters.len() - 1]);
    let free = |at: f64| -> Result<DVec2, NurbsError> {
        let degree = 3.min(points.len() - 1);
        Ok(Interpolator::new(degree, parameters)?.curve(points)?.derivatives(at)[1])
    };
    let slope = |condition: End, at: f64| match condition {
        End::Tangent(t) => Ok(t),
        End::Free => free(at),
    };
    Interpolator::with_slopes(parameters)?.curve_with_slopes(points, slope(start, first)?, slope(end, last)?)
}

fn chord_lengths(points: &[DVec2]) -> Vec<f64> {
    let mut t = vec![0.0];
    for w in points.windows(2) {
        t.push(t[t.len() - 1] + w[0].distance(w[1]));
    }
    t
}

/// Arc lengths of `curve` at `parameters`, by Gauss-Legendre quadrature with five points a span.
fn arc_lengths(curve: &Curve<DVec2>, parameters: &[f64]) -> Vec<f64> {
    const NODES: [f64; 3] = [0.0, 0.538_469_310_105_683_1, 0.906_179_845_938_664];
    const WEIGHTS: [f64; 3] = [0.568_888_888_888_888_9, 0.478_628_670_499_366_47, 0.236_926_885_056_189_08];
    let mut lengths = vec![0.0];
    for w in parameters.windows(2) {
        let (middle, half) = (0.5 * (w[0] + w[1]), 0.5 * (w[1] - w[0]));
        let speed = |t: f64| curve.first_derivatives(t)[1].length();
        let mut sum = WEIGHTS[0] * speed(middle);
        for k in 1..3 {
            sum += WEIGHTS[k] * (speed(middle - half * NODES[k]) + speed(middle + half * NODES[k]));
        }
        lengths.push(lengths[lengths.len() - 1] + half * sum);
    }
    lengths
}

/// Integral of the squared third derivative of a cubic over the first `spans` spans: how unevenly the curvature runs.
pub(super) fn unevenness(chain: &Chain, spans: usize) -> f64 {
    let t = &chain.parameters;
    (0..spans.min(t.len() - 1))
        .map(|i| {
            let h = t[i + 1] - t[i];
            let second = |at: f64| chain.curve.derivatives(at)[2];
            // A cubic's second derivative is linear on a span.
            let (a, b) = (second(t[i] + 0.25 * h), second(t[i] + 0.75 * h));
            ((b - a) / (0.5 * h)).length_squared() * h
        })
        .sum()
}
