//! Smooth curves through chains of points.

use coolinggen_nurbs::{Curve, Interpolator, NurbsError, ParametricCurve, interpolate_closed};
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

/// The C2 cubic through `points` (two or more) with parameters close to arc length.
pub(super) fn open(points: &[DVec2], start: End, end: End) -> Result<Chain, NurbsError> {
    let mut parameters = chord_lengths(points);
    let mut curve = open_at(points, &parameters, start, end)?;
    for _ in 0..ROUNDS {
        parameters = arc_lengths(&curve, &parameters);
        curve = open_at(points, &parameters, start, end)?;
    }
    Ok(Chain { curve, parameters })
}

fn open_at(
    points: &[DVec2],
    parameters: &[f64],
    start: End,
    end: End,
) -> Result<Curve<DVec2>, NurbsError> {
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

/// The closed C2 cubic through `points` (four or more, the first not repeated); `parameters` has one entry more.
pub(super) fn closed(points: &[DVec2]) -> Result<Chain, NurbsError> {
    let mut ring = points.to_vec();
    ring.push(points[0]);
    let mut parameters = chord_lengths(&ring);
    let mut curve = interpolate_closed(&parameters, &ring)?;
    for _ in 0..ROUNDS {
        parameters = arc_lengths(&curve, &parameters);
        curve = interpolate_closed(&parameters, &ring)?;
    }
    Ok(Chain { curve, parameters })
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
        let speed = |t: f64| curve.derivatives(t)[1].length();
        let mut sum = WEIGHTS[0] * speed(middle);
        for k in 1..3 {
            sum += WEIGHTS[k] * (speed(middle - half * NODES[k]) + speed(middle + half * NODES[k]));
        }
        lengths.push(lengths[lengths.len() - 1] + half * sum);
    }
    lengths
}

/// Integral of the squared third derivative over the first `spans` spans: how unevenly the curvature runs.
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
