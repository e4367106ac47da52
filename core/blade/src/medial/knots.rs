//! Knots put where they serve best.

use super::medial_surface::points_met;
use coolinggen_nurbs::{Curve, Knots, NurbsError, ParametricCurve};
use glam::DVec3;

/// Rounds over all knots, and the step they begin with, in parts of the gap to a neighbour.
const ROUNDS: usize = 24;
const STEP: f64 = 0.4;
/// Steps of correction at a time.
const STEPS: usize = 6;
/// Spans that refinement begins with.
const START: usize = 6;

/// Moves the inner knots of `start` until least-squares fits of the `lines` (points at `parameters`) leave the least
/// sum of squared distances: one knot after the other, with steps that shrink where they do not help. The points of
/// the indices `met` are met, as in the fit that the knots are for.
pub(super) fn optimised(
    start: Knots,
    parameters: &[f64],
    lines: &[Vec<DVec3>],
    met: &[usize],
) -> Result<Knots, NurbsError> {
    let degree = start.degree();
    let mut breaks = start.breaks();
    let inner = breaks.len() - 2;
    let mut best = left_over(&start, parameters, lines, met)?;
    let mut steps = vec![STEP; inner];
    for _ in 0..ROUNDS {
        let before = best;
        for k in 1..=inner {
            for sign in [1.0, -1.0] {
                let old = breaks[k];
                let gap = if sign > 0.0 { breaks[k + 1] - old } else { old - breaks[k - 1] };
                breaks[k] = old + sign * steps[k - 1] * gap;
                // Spans without data make no fit: such a step is not taken.
                let now = Knots::clamped(degree, &breaks)
                    .and_then(|knots| left_over(&knots, parameters, lines, met))
                    .unwrap_or(f64::INFINITY);
                if now < best {
                    best = now;
                    steps[k - 1] = (1.3 * steps[k - 1]).min(0.6);
                    break;
                }
                breaks[k] = old;
                if sign < 0.0 {
                    steps[k - 1] *= 0.5;
                }
            }
        }
        if best > (1.0 - 1e-4) * before && steps.iter().all(|s| *s < 0.02) {
            break;
        }
    }
    Knots::clamped(degree, &breaks)
}

/// The parameters moved towards the closest points of fits on `knots`, by the mean of what the lines ask for (Hoschek's
/// intrinsic parametrization, common to all lines). They stay in order, and the ends where they are.
pub(super) fn corrected(
    knots: &Knots,
    parameters: &[f64],
    lines: &[Vec<DVec3>],
    met: &[usize],
) -> Result<Vec<f64>, NurbsError> {
    let mut s = parameters.to_vec();
    for _ in 0..STEPS {
        let fit = points_met(knots, &s, met)?.0;
        let mut moves = vec![0.0; s.len()];
        for line in lines {
            let curve = fit.curve(line, &values(line, met))?.curve;
            for (i, step) in moves.iter_mut().enumerate() {
                let [p, d, _] = curve.derivatives(s[i]);
                *step += (line[i] - p).dot(d) / d.length_squared() / lines.len() as f64;
            }
        }
        for i in 1..s.len() - 1 {
            // By less than half of the way to a neighbour.
            let room = 0.45 * (s[i] - s[i - 1]).min(s[i + 1] - s[i]);
            s[i] += moves[i].clamp(-room, room);
        }
    }
    Ok(s)
}

/// Knots for least-squares fits of `lines` that come within `tolerance`: spans are halved where they do not, as long as
/// their data allow it.
pub(super) fn refined(
    degree: usize,
    parameters: &[f64],
    lines: &[Vec<DVec3>],
    met: &[usize],
    tolerance: f64,
) -> Result<Knots, NurbsError> {
    let (first, last) = (parameters[0], parameters[parameters.len() - 1]);
    let mut breaks: Vec<f64> =
        (0..=START).map(|k| first + (last - first) * k as f64 / START as f64).collect();
    loop {
        let knots = Knots::clamped(degree, &breaks)?;
        let fit = points_met(&knots, parameters, met)?.0;
        let mut worst = vec![0.0f64; breaks.len() - 1];
        for line in lines {
            let curve = fit.curve(line, &values(line, met))?.curve;
            for (i, &s) in parameters.iter().enumerate() {
                let span = breaks[1..breaks.len() - 1].partition_point(|&b| b <= s);
                worst[span] = worst[span].max(across(line, i, curve.point(s)).length());
            }
        }
        let mut finer = vec![first];
        for (span, worst) in breaks.windows(2).zip(&worst) {
            let within = |a: f64, b: f64| parameters.iter().filter(|s| (a..=b).contains(s)).count();
            let middle = 0.5 * (span[0] + span[1]);
            let room = within(span[0], middle).min(within(middle, span[1])) > degree;
            if *worst > tolerance && room {
                finer.push(middle);
            }
            finer.push(span[1]);
        }
        if finer.len() == breaks.len() {
            return Ok(knots);
        }
        breaks = finer;
    }
}

fn values(line: &[DVec3], met: &[usize]) -> Vec<DVec3> {
    met.iter().map(|&i| line[i]).collect()
}

/// The distance vector of `point` from datum `i` of a line, without the part along the line: that does not change the
/// shape.
fn across(line: &[DVec3], i: usize, point: DVec3) -> DVec3 {
    let along = line[(i + 1).min(line.len() - 1)] - line[i.saturating_sub(1)];
    (point - line[i]).reject_from(along)
}

/// Sum of squared distances across the lines.
fn left_over(
    knots: &Knots,
    parameters: &[f64],
    lines: &[Vec<DVec3>],
    met: &[usize],
) -> Result<f64, NurbsError> {
    let fit = points_met(knots, parameters, met)?.0;
    let mut sum = 0.0;
    for line in lines {
        let curve: Curve<DVec3> = fit.curve(line, &values(line, met))?.curve;
        sum += (0..line.len())
            .map(|i| across(line, i, curve.point(parameters[i])).length_squared())
            .sum::<f64>();
    }
    Ok(sum)
}
