//! Laws: values along the span.

use crate::fault::{Fault, Pointer};
use coolinggen_nurbs::{Curve, Knots, NurbsError, ParametricCurve, fit_function};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A value along the span: a number, or control points `[[v, value], ...]` of a clamped B-spline of degree 3 (less
/// with fewer than four points) over the span fraction v. The abscissae must increase; the law holds its end values
/// beyond them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(extend("law" = true))]
pub enum LawSpec {
    /// The same value everywhere.
    Constant(f64),
    /// Control points `[v, value]` with increasing v.
    Points(Vec<[f64; 2]>),
}

impl From<f64> for LawSpec {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

/// A law ready to be evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    form: Form,
}

#[derive(Clone, Debug, PartialEq)]
enum Form {
    Constant(f64),
    /// Abscissa and value as B-splines over one parameter in [0, 1].
    Spline(Curve<glam::DVec2>),
    /// A law and a multiple of another one.
    Sum(Box<Law>, f64, Box<Law>),
}

/// Most control points a law may have.
const MOST_POINTS: usize = 1000;

impl LawSpec {
    /// Checks the law and makes it ready.
    ///
    /// # Errors
    /// Every fault of the law, with pointers below `pointer`.
    pub fn law(&self, pointer: &Pointer) -> Result<Law, Vec<Fault>> {
        let points = match self {
            Self::Constant(value) if value.is_finite() => {
                return Ok(Law { form: Form::Constant(*value) });
            }
            Self::Constant(_) => {
                return Err(vec![Fault::new(pointer.clone(), "not_finite", "the value is not finite")]);
            }
            Self::Points(points) => points,
        };
        let mut faults = Vec::new();
        if points.is_empty() || points.len() > MOST_POINTS {
            let message = format!("a law has 1 to {MOST_POINTS} control points, here are {}", points.len());
            faults.push(
                Fault::new(pointer.clone(), "point_count", message)
                    .value(points.len())
                    .min(1.0)
                    .max(MOST_POINTS as f64),
            );
            return Err(faults);
        }
        for (i, p) in points.iter().enumerate() {
            if !(p[0].is_finite() && p[1].is_finite()) {
                faults.push(Fault::new(pointer.at(i), "not_finite", "the control point is not finite"));
            } else if i > 0 && !(p[0] > points[i - 1][0]) {
                let message =
                    format!("abscissa {} does not exceed the one before, {}", p[0], points[i - 1][0]);
                faults.push(
                    Fault::new(pointer.at(i).at(0), "not_increasing", message)
                        .value(p[0])
                        .min(points[i - 1][0])
                        .hint("control points [v, value] come in the order of increasing v"),
                );
            }
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        if let [[_, value]] = points[..] {
            return Ok(Law { form: Form::Constant(value) });
        }
        let controls: Vec<_> = points.iter().map(|&p| glam::DVec2::from_array(p)).collect();
        let curve = Knots::uniform(3.min(points.len() - 1), points.len())
            .and_then(|knots| Curve::new(knots, controls))
            .map_err(|e| vec![Fault::new(pointer.clone(), "bad_law", e.to_string())])?;
        Ok(Law { form: Form::Spline(curve) })
    }
}

impl Law {
    /// The law that has `value` everywhere.
    pub fn constant(value: f64) -> Self {
        Self { form: Form::Constant(value) }
    }

    /// This law and `factor` times another one.
    #[must_use]
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        Self { form: Form::Sum(Box::new(self.clone()), factor, Box::new(other.clone())) }
    }

    /// `factor` times this law.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        Self::constant(0.0).plus(factor, self)
    }

    /// Value at span fraction `v`; the end values beyond the ends. Exact to rounding.
    pub fn at(&self, v: f64) -> f64 {
        self.with_slope(v).0
    }

    /// The law over [0, 1] as a B-spline function of v, and how far that is off: not at all for a constant and where the
    /// abscissae of the control points run evenly with the parameter, else a cubic within `tolerance`.
    pub(crate) fn function(&self, tolerance: f64) -> Result<(Curve<f64>, f64), NurbsError> {
        match &self.form {
            Form::Constant(value) => return Ok((Curve::segment(*value, *value), 0.0)),
            Form::Spline(curve) => {
                let even = curve.knots().greville();
                let runs_evenly = even.iter().zip(curve.points()).all(|(t, p)| (t - p.x).abs() <= 1e-15);
                if runs_evenly {
                    return Ok((curve.map(|p| p.y), 0.0));
                }
            }
            Form::Sum(..) => (),
        }
        let mut breaks = self.breaks();
        breaks.extend([0.0, 1.0]);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        let value = |v: f64| <[f64; 2]>::from(self.with_slope(v));
        let fit = fit_function(value, &breaks, tolerance)?;
        Ok((fit.curve, fit.greatest))
    }

    /// Value and its derivative in v at `v`.
    pub fn with_slope(&self, v: f64) -> (f64, f64) {
        let curve = match &self.form {
            Form::Constant(value) => return (*value, 0.0),
            Form::Spline(curve) => curve,
            Form::Sum(a, factor, b) => {
                let (a, b) = (a.with_slope(v), b.with_slope(v));
                return (a.0 + factor * b.0, a.1 + factor * b.1);
            }
        };
        let (first, last) = (curve.points()[0], curve.points()[curve.points().len() - 1]);
        if v <= first.x {
            return (first.y, 0.0);
        }
        if v >= last.x {
            return (last.y, 0.0);
        }
        // The abscissa increases with the parameter (increasing control values): Newton between bisection bounds.
        let (mut low, mut high) = (0.0, 1.0);
        let mut t = (v - first.x) / (last.x - first.x);
        for _ in 0..100 {
            let [p, d] = curve.first_derivatives(t);
            let miss = p.x - v;
            if miss > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - miss / d.x;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if miss == 0.0 || (next - t).abs() <= 2.0 * f64::EPSILON {
                break;
            }
            t = next;
        }
        let [p, d] = curve.first_derivatives(t);
        (p.y, d.y / d.x)
    }

    /// Span fractions between the ends at which the law is less smooth than elsewhere: its inner knots.
    pub(crate) fn breaks(&self) -> Vec<f64> {
        let curve = match &self.form {
            Form::Constant(_) => return Vec::new(),
            Form::Spline(curve) => curve,
            Form::Sum(a, _, b) => return [a.breaks(), b.breaks()].concat(),
        };
        let (first, last) = (curve.points()[0].x, curve.points()[curve.points().len() - 1].x);
        let inner = curve.breaks().into_iter().map(|t| curve.point(t).x);
        inner.filter(|v| *v > 0.0 && *v < 1.0 && (first..=last).contains(v)).collect()
    }

    /// Bounds of the values: least and greatest control value (the convex hull), so the law stays within them.
    pub fn bounds(&self) -> (f64, f64) {
        match &self.form {
            Form::Constant(value) => (*value, *value),
            Form::Spline(curve) => curve
                .points()
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |b, p| (b.0.min(p.y), b.1.max(p.y))),
            Form::Sum(a, factor, b) => {
                let (a, (low, high)) = (a.bounds(), b.bounds());
                let (low, high) = (factor * low, factor * high);
                (a.0 + low.min(high), a.1 + low.max(high))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn law(points: &[[f64; 2]]) -> Law {
        LawSpec::Points(points.to_vec()).law(&Pointer::root()).unwrap()
    }

    #[test]
    fn two_points_are_a_straight_law_and_ends_hold() {
        let l = law(&[[0.0, 1.0], [1.0, 3.0]]);
        assert!((l.at(0.25) - 1.5).abs() < 1e-15);
        assert_eq!((l.at(-1.0), l.at(2.0)), (1.0, 3.0));
        assert_eq!(law(&[[0.3, 7.0]]).at(0.9), 7.0);
    }

    #[test]
    fn a_sum_of_laws_adds_values_slopes_and_bounds() {
        let sum = law(&[[0.0, 1.0], [1.0, 3.0]]).plus(-0.5, &law(&[[0.0, 2.0], [0.5, 0.0]]));
        assert!((sum.at(0.25) - (1.5 - 0.5)).abs() < 1e-15);
        assert!((sum.with_slope(0.25).1 - (2.0 + 2.0)).abs() < 1e-12);
        assert_eq!(sum.bounds(), (0.0, 3.0));
        assert_eq!(sum.at(1.0), 3.0);
    }

    #[test]
    fn refuses_every_bad_abscissa_at_once() {
        let spec = LawSpec::Points(vec![[0.0, 1.0], [0.0, 2.0], [-1.0, f64::NAN]]);
        let faults = spec.law(&Pointer::root().at("thickness")).unwrap_err();
        assert_eq!(faults.len(), 2);
        assert_eq!(faults[0].pointer, "/thickness/1/0");
        assert!(LawSpec::Points(Vec::new()).law(&Pointer::root()).is_err());
    }

    proptest! {
        #[test]
        fn stays_in_the_hull_and_reproduces_lines(gaps in proptest::collection::vec(0.01f64..1.0, 1..9), v in 0.0f64..1.0) {
            let mut points = vec![[0.0, 5.0]];
            for g in gaps {
                let x = points[points.len() - 1][0] + g;
                points.push([x, 5.0 - 2.0 * x]);
            }
            let l = law(&points);
            let x = v * points[points.len() - 1][0];
            prop_assert!((l.at(x) - (5.0 - 2.0 * x)).abs() < 1e-12);
            prop_assert!((l.with_slope(x).1 + 2.0).abs() < 1e-9);
        }
    }
}
