//! The reparameterization u(t) that lets the medial surface run as the profile does (section 3.2).

use super::profile::Profile;
use coolinggen_nurbs::{BandedLu, Curve, Knots, NurbsError, ParametricCurve, ParametricSurface};
use glam::DVec3;

/// A B-spline function u(t) over [0, 1] with u(0) = 0, u(1) = 1, for which |d/dt m(u(t), v)| is close to lambda(v) x'(t)
/// (Eq. 19) at all v; lambda is the length of the line of constant v.
#[derive(Clone, Debug)]
pub(crate) struct Pace {
    curve: Curve<f64>,
    /// Root mean square of `|m_1| u' / lambda - x'`, whose second term has the mean 1.
    pub(crate) residual: f64,
}

/// Greatest number of control points.
const MOST: usize = 80;
/// Steps of Gauss-Newton between knot insertions, and the relative gain of one that ends them.
const STEPS: usize = 30;
const SETTLED: f64 = 1e-4;
/// Lines of constant v that the condition is imposed on, and places in each span of t.
const LINES: u32 = 5;
const PLACES: u32 = 6;

impl Pace {
    /// Solves Eq. 20 by Gauss-Newton (Eq. 21 to 25), from u(t) = t, with knots inserted where the condition is missed most,
    /// until the residual is `tolerance` or knots stop helping. The paper takes `degree` 2; 3 keeps the sides twice
    /// differentiable.
    pub(crate) fn new(
        medial: &impl ParametricSurface<DVec3>,
        profile: &Profile,
        degree: usize,
        tolerance: f64,
    ) -> Result<Self, NurbsError> {
        // The line at the end has no length where the surface ends in a point.
        let ends_in_point = medial.point(0.0, 1.0).distance(medial.point(1.0, 1.0)) < 1e-9;
        let last = if ends_in_point { 0.9 } else { 1.0 };
        let v = |j: u32| last * f64::from(j) / f64::from(LINES - 1);
        let lines: Vec<Line> = (0..LINES).map(|j| Line::new(medial, v(j))).collect();
        let knots = Knots::uniform(degree, degree + 1)?;
        let mut best = solved(Curve::new(knots.clone(), knots.greville())?, medial, profile, &lines)?;
        while best.residual > tolerance && best.curve.points().len() < MOST {
            let inserted = best.worst_spans(medial, profile, &lines);
            let finer = solved(best.curve.with_knots_inserted(&inserted)?, medial, profile, &lines)?;
            if !(finer.residual < 0.999 * best.residual) {
                break;
            }
            best = finer;
        }
        Ok(best)
    }

    /// u(t).
    pub(crate) fn at(&self, t: f64) -> f64 {
        self.curve.point(t).clamp(0.0, 1.0)
    }

    /// u(t) as a B-spline.
    pub(super) fn curve(&self) -> &Curve<f64> {
        &self.curve
    }

    /// u(t) and u'(t).
    pub(crate) fn with_slope(&self, t: f64) -> (f64, f64) {
        let [u, slope, _] = self.curve.derivatives(t);
        (u, slope)
    }

    /// Number of its control points.
    #[cfg(test)]
    pub(crate) fn count(&self) -> usize {
        self.curve.points().len()
    }

    /// Middles of the spans with the greater half of the sum of squares.
    fn worst_spans(
        &self,
        medial: &impl ParametricSurface<DVec3>,
        profile: &Profile,
        lines: &[Line],
    ) -> Vec<f64> {
        let breaks = self.curve.breaks();
        let sums: Vec<f64> =
            breaks.windows(2).map(|span| squares(span, medial, profile, &self.curve, lines)).collect();
        let mean = sums.iter().sum::<f64>() / sums.len() as f64;
        let bad = breaks.windows(2).zip(&sums).filter(|(_, s)| **s >= mean);
        bad.map(|(span, _)| 0.5 * (span[0] + span[1])).collect()
    }
}

/// A line of constant v and its length.
struct Line {
    v: f64,
    length: f64,
}

impl Line {
    fn new(medial: &impl ParametricSurface<DVec3>, v: f64) -> Self {
        let breaks = medial.breaks_u();
        let steps = 24;
        let point = |w: &[f64], k: i32| {
            medial.derivatives(w[0] + (w[1] - w[0]) * f64::from(k) / f64::from(steps), v).u
        };
        // Simpson's rule on the speed.
        let simpson = |w: &[f64]| {
            let sum: f64 = (0..=steps)
                .map(|k| match k {
                    0 => 1.0,
                    k if k == steps => 1.0,
                    k if k % 2 == 1 => 4.0,
                    _ => 2.0,
                } * point(w, k).length())
                .sum();
            sum * (w[1] - w[0]) / (3.0 * f64::from(steps))
        };
        Self { v, length: breaks.windows(2).map(simpson).sum() }
    }
}

/// The integral over a span of the squares of `|m_1| u' / lambda - x'`, the mean over the lines.
fn squares(
    span: &[f64],
    medial: &impl ParametricSurface<DVec3>,
    profile: &Profile,
    u: &Curve<f64>,
    lines: &[Line],
) -> f64 {
    let at = |(t, weight): (f64, f64)| {
        let ([value, slope, _], x) = (u.derivatives(t), profile.at(t)[1].x);
        let value = value.clamp(0.0, 1.0);
        let miss = |l: &Line| medial.first_derivatives(value, l.v).1.length() * slope / l.length - x;
        weight * lines.iter().map(|l| miss(l).powi(2)).sum::<f64>()
    };
    places(span).map(at).sum()
}

/// Places in a span with their weights.
fn places(span: &[f64]) -> impl Iterator<Item = (f64, f64)> {
    let (start, size) = (span[0], span[1] - span[0]);
    (0..PLACES).map(move |k| {
        (start + size * (f64::from(k) + 0.5) / f64::from(PLACES), size / f64::from(PLACES * LINES))
    })
}

/// Gauss-Newton on the control points between the first and the last, with the step halved until it helps.
fn solved(
    start: Curve<f64>,
    medial: &impl ParametricSurface<DVec3>,
    profile: &Profile,
    lines: &[Line],
) -> Result<Pace, NurbsError> {
    let total = |u: &Curve<f64>| -> f64 {
        u.breaks().windows(2).map(|span| squares(span, medial, profile, u, lines)).sum()
    };
    let (mut curve, mut value) = (start.clone(), total(&start));
    for _ in 0..STEPS {
        let step = update(&curve, medial, profile, lines)?;
        let mut h = 1.0;
        let mut moved = false;
        while h > 1e-3 && !moved {
            let mut index = 0;
            let next = curve.map(|&d| {
                index += 1;
                d + h * step[index - 1]
            });
            // u must grow: increasing control points make sure of it.
            let grows = next.points().windows(2).all(|w| w[1] > w[0]);
            let after = if grows { total(&next) } else { f64::INFINITY };
            if after < (1.0 - SETTLED) * value {
                (curve, value, moved) = (next, after, true);
            } else {
                h *= 0.5;
            }
        }
        if !moved {
            break;
        }
    }
    Ok(Pace { curve, residual: value.sqrt() })
}

/// The step of Gauss-Newton, zero for the first and the last control point.
fn update(
    u: &Curve<f64>,
    medial: &impl ParametricSurface<DVec3>,
    profile: &Profile,
    lines: &[Line],
) -> Result<Vec<f64>, NurbsError> {
    let (n, p) = (u.points().len(), u.degree());
    let free = n - 2;
    let mut matrix = vec![0.0; free * (2 * p + 1)];
    let mut right = vec![0.0; free];
    for (t, weight) in u.breaks().windows(2).flat_map(places) {
        let basis = u.knots().basis(t, 1);
        let [value, slope, _] = u.derivatives(t);
        let x = profile.at(t)[1].x;
        for line in lines {
            let d = medial.derivatives(value.clamp(0.0, 1.0), line.v);
            let speed = d.u.length();
            let change = if speed > 0.0 { d.u.dot(d.uu) / speed } else { d.uu.length() };
            let miss = speed * slope / line.length - x;
            let mut row = [0.0; coolinggen_nurbs::MAX_DEGREE + 1];
            for k in 0..=p {
                row[k] = (change * slope * basis.values[0][k] + speed * basis.values[1][k]) / line.length;
            }
            for a in (0..=p).filter(|a| (1..=free).contains(&(basis.first + a))) {
                let i = basis.first + a - 1;
                right[i] -= weight * row[a] * miss;
                for b in (0..=p).filter(|b| (1..=free).contains(&(basis.first + b))) {
                    let j = basis.first + b - 1;
                    matrix[i * (2 * p + 1) + j + p - i] += weight * row[a] * row[b];
                }
            }
        }
    }
    let lu = BandedLu::factor(free, p, |i, row| {
        let lead = p.saturating_sub(i);
        let entries = &matrix[i * (2 * p + 1) + lead..(i + 1) * (2 * p + 1)];
        row[..entries.len()].copy_from_slice(entries);
        i.saturating_sub(p)
    })?;
    lu.solve(&mut right);
    Ok([0.0].into_iter().chain(right).chain([0.0]).collect())
}
