//! The meridian of a stream surface: a curve (x, r) with its two measures.

use super::measure::Measure;
use coolinggen_nurbs::{Curve, ParametricCurve};
use glam::DVec2;
use std::sync::OnceLock;

/// A streamline in the meridional plane, with arc length and with the conformal coordinate M along it.
#[derive(Clone, Debug)]
pub(super) struct Meridian {
    curve: Curve<DVec2>,
    form: Form,
    /// Radius at the reference station, where M = 0, mm.
    pub(super) reference_radius: f64,
    /// Parameter of the reference station.
    reference: f64,
}

#[derive(Clone, Debug)]
enum Form {
    /// A straight line: everything in closed form.
    Straight { start: DVec2, direction: DVec2, length: f64 },
    Curved {
        /// Arc length from the start, once it has been asked for.
        arc: OnceLock<Measure>,
        /// Integral of `r_ref dm / r` from the start.
        conformal: Measure,
        /// Its value at the reference station.
        offset: f64,
        /// Points along the curve, to start the search of closest points.
        samples: Vec<(f64, DVec2)>,
    },
}

/// Accuracy of the tables, mm.
const ACCURACY: f64 = 1e-12;
/// How far beyond the ends of the contour closest points are sought, in its parameter [0, 1].
const BEYOND: f64 = 0.1;

impl Meridian {
    /// Tabulates `curve` with M = 0 at parameter `reference`.
    pub(super) fn new(curve: Curve<DVec2>, reference: f64) -> Self {
        let reference_radius = curve.point(reference).y;
        let form = match straight(&curve) {
            Some((start, direction)) => Form::Straight { start, direction, length: direction.length() },
            None => {
                let breaks = curve.breaks();
                let conformal = Measure::new(&breaks, ACCURACY, |s| {
                    let [p, d, dd] = curve.derivatives(s);
                    let speed = d.length();
                    let f = reference_radius * speed / p.y;
                    (f, f * (d.dot(dd) / (speed * speed) - d.y / p.y))
                });
                let offset = conformal.forward(reference);
                let samples = breaks
                    .windows(2)
                    .flat_map(|w| (0..4).map(move |k| w[0] + (w[1] - w[0]) * f64::from(k) / 4.0))
                    .chain(breaks.last().copied())
                    .map(|s| (s, curve.point(s)))
                    .collect();
                Form::Curved { arc: OnceLock::new(), conformal, offset, samples }
            }
        };
        Self { curve, form, reference_radius, reference }
    }

    pub(super) fn curve(&self) -> &Curve<DVec2> {
        &self.curve
    }

    /// Point (x, r) at parameter `s`.
    pub(super) fn point(&self, s: f64) -> DVec2 {
        match &self.form {
            Form::Straight { start, direction, .. } => *start + *direction * s,
            Form::Curved { .. } => self.curve.point(s),
        }
    }

    /// Point and unit tangent at `s`.
    pub(super) fn tangent(&self, s: f64) -> (DVec2, DVec2) {
        match &self.form {
            Form::Straight { start, direction, length } => (*start + *direction * s, *direction / *length),
            Form::Curved { .. } => {
                let [p, d] = self.curve.first_derivatives(s);
                (p, d.normalize())
            }
        }
    }

    /// M at parameter `s`.
    pub(super) fn conformal(&self, s: f64) -> f64 {
        match &self.form {
            Form::Straight { direction, length, .. } => {
                // r_ref ln(r / r_ref) / (dr/dm), with its limit for dr = 0.
                let ahead = s - self.reference;
                let rise = direction.y * ahead / self.reference_radius;
                length * ahead * if rise == 0.0 { 1.0 } else { rise.ln_1p() / rise }
            }
            Form::Curved { conformal, offset, .. } => conformal.forward(s) - offset,
        }
    }

    /// Parameter at M.
    pub(super) fn at_conformal(&self, m: f64) -> f64 {
        match &self.form {
            Form::Straight { direction, length, .. } => {
                let rise = m * direction.y / (length * self.reference_radius);
                self.reference + m / length * if rise == 0.0 { 1.0 } else { rise.exp_m1() / rise }
            }
            Form::Curved { conformal, offset, .. } => conformal.backward(m + offset),
        }
    }

    /// The table of arc length: much of what stands on stream surfaces never asks for it.
    fn measured<'a>(&self, arc: &'a OnceLock<Measure>) -> &'a Measure {
        arc.get_or_init(|| {
            Measure::new(&self.curve.breaks(), ACCURACY, |s| {
                let [_, d, dd] = self.curve.derivatives(s);
                let speed = d.length();
                (speed, d.dot(dd) / speed)
            })
        })
    }

    /// Arc length from the start of the contour to parameter `s`, mm.
    pub(super) fn arc(&self, s: f64) -> f64 {
        match &self.form {
            Form::Straight { length, .. } => length * s,
            Form::Curved { arc, .. } => self.measured(arc).forward(s),
        }
    }

    /// Parameter at arc length `m`.
    pub(super) fn at_arc(&self, m: f64) -> f64 {
        match &self.form {
            Form::Straight { length, .. } => m / length,
            Form::Curved { arc, .. } => self.measured(arc).backward(m),
        }
    }

    /// Arc length of the whole, mm.
    pub(super) fn length(&self) -> f64 {
        match &self.form {
            Form::Straight { length, .. } => *length,
            Form::Curved { arc, .. } => self.measured(arc).total(),
        }
    }

    /// Parameter at which the curve first reaches the axial position `x`, none if it does not.
    pub(super) fn at_axial(&self, x: f64) -> Option<f64> {
        let steps = 16 * (self.curve.breaks().len() - 1);
        let at = |i: usize| i as f64 / steps as f64;
        let miss = |s: f64| self.point(s).x - x;
        let first = (0..steps).find(|&i| miss(at(i)) * miss(at(i + 1)) <= 0.0)?;
        let (mut low, mut high) = (at(first), at(first + 1));
        let rising = miss(low) < miss(high);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (miss(middle) < 0.0) == rising {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(0.5 * (low + high))
    }

    /// Parameter of the closest point to `p`, up to [`BEYOND`] outside the ends; sought from `hint` on, or from the
    /// closest of a row of samples.
    pub(super) fn nearest(&self, p: DVec2, hint: Option<f64>) -> f64 {
        self.foot(p, hint).0
    }

    /// As [`Meridian::nearest`]: the parameter, the closest point and the unit tangent there.
    pub(super) fn foot(&self, p: DVec2, hint: Option<f64>) -> (f64, DVec2, DVec2) {
        match &self.form {
            Form::Straight { start, direction, length } => {
                let s = (p - *start).dot(*direction) / direction.length_squared();
                (s, *start + *direction * s, *direction / *length)
            }
            Form::Curved { samples, .. } => {
                let mut s = hint.unwrap_or_else(|| {
                    let mut best = (f64::INFINITY, 0.0);
                    for &(s, q) in samples {
                        let d = q.distance_squared(p);
                        if d < best.0 {
                            best = (d, s);
                        }
                    }
                    best.1
                });
                let (mut foot, mut slope) = (DVec2::ZERO, DVec2::ZERO);
                for _ in 0..40 {
                    let [c, d, dd] = self.curve.derivatives(s);
                    let (gap, speed) = (c - p, d.length_squared());
                    let bend = speed + gap.dot(dd);
                    // Beyond the centre of curvature the distance has no minimum near: step as on a line.
                    let newton = bend > 0.25 * speed;
                    let step = gap.dot(d) / if newton { bend } else { speed };
                    // Halley's correction, but for the third derivative: near the curve that hardly matters.
                    let uneven = 1.5 * step * d.dot(dd) / bend;
                    let step = if newton && uneven.abs() < 0.25 { step / (1.0 - uneven) } else { step };
                    let next = (s - step.clamp(-BEYOND, BEYOND)).clamp(-BEYOND, 1.0 + BEYOND);
                    let moved = next - s;
                    s = next;
                    // So short a step is a Taylor series to the last digit.
                    foot = c + (d + dd * (0.5 * moved)) * moved;
                    slope = d + dd * moved;
                    // Convergence is quadratic: the next step would be the square of this one; near the curve it is cubic.
                    let near = gap.length_squared() <= 1e-6 * speed;
                    if moved.abs() <= if newton { if near { 1e-6 } else { 1e-9 } } else { 1e-15 } {
                        break;
                    }
                }
                (s, foot, slope.normalize())
            }
        }
    }
}

/// Start and direction over [0, 1] if `curve` runs straight and evenly.
fn straight(curve: &Curve<DVec2>) -> Option<(DVec2, DVec2)> {
    let points = curve.points();
    let direct = curve.degree() == 1 && points.len() == 2 && curve.domain() == (0.0, 1.0);
    direct.then(|| (points[0], points[1] - points[0]))
}
