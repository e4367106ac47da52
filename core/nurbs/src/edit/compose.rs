//! Composition with functions.

use super::product::{merged, product, smoothness};
use super::remove::check_continuous;
use crate::curve::{Curve, ParametricCurve};
use crate::error::NurbsError;
use crate::knots::{Knots, MAX_DEGREE};
use crate::surface::Surface;
use crate::vector::VectorSpace;

impl<V: VectorSpace> Curve<V> {
    /// The curve run through by another parameter, `t -> C(inner(t))`: a B-spline whose degree is the product of both, with
    /// the knots of `inner` and a knot where `inner` passes one of this curve. Exact up to rounding.
    ///
    /// `inner` must grow (increasing control points) and stay in the domain. De Casteljau's algorithm with the
    /// polynomial `inner` in place of its parameter, on every piece (T. D. DeRose, R. N. Goldman, H. Hagen, S. Mann,
    /// *Functional composition algorithms via blossoming*, 1993).
    ///
    /// # Errors
    /// [`NurbsError::BadParameters`] with the index of a control point of `inner` that does not exceed the one before,
    /// [`NurbsError::OutOfDomain`] where `inner` leaves the domain, [`NurbsError::Degree`] above [`MAX_DEGREE`],
    /// [`NurbsError::Multiplicity`] for one that jumps at a knot.
    pub fn composed(&self, inner: &Curve<f64>) -> Result<Self, NurbsError> {
        let (start, end) = self.knots.domain();
        let (p, q) = (self.degree(), inner.degree());
        if p * q > MAX_DEGREE {
            return Err(NurbsError::Degree { degree: p * q, greatest: MAX_DEGREE });
        }
        check_continuous(&self.knots)?;
        check_continuous(&inner.knots)?;
        let u = inner.points();
        if let Some(index) = (1..u.len()).find(|&i| !(u[i] > u[i - 1])) {
            return Err(NurbsError::BadParameters { index });
        }
        if let Some(&value) = u.iter().find(|u| !(start..=end).contains(*u)) {
            return Err(NurbsError::OutOfDomain { value, start, end });
        }
        // Where inner passes a knot of this curve, with the knot.
        let (first, last) = inner.knots.domain();
        let passed: Vec<(f64, f64)> = self
            .knots
            .breaks()
            .into_iter()
            .filter(|b| *b > inner.point(first) && *b < inner.point(last))
            .map(|b| (parameter_of(inner, b), b))
            .collect();
        let cuts = merged(inner.knots.breaks(), &passed.iter().map(|k| k.0).collect::<Vec<_>>());
        let pieces = cuts.windows(2).zip(inner.cut_at(&cuts)?).map(|(ends, inner)| {
            let middle = inner.point(0.5 * (ends[0] + ends[1]));
            let own = self.piece_at(middle)?;
            let (low, high) = own.knots.domain();
            let part: Vec<f64> = inner.points.iter().map(|u| (u - low) / (high - low)).collect();
            Self::new(Knots::clamped(p * q, ends)?, composed(&own.points, &part))
        });
        let pieces = pieces.collect::<Result<Vec<_>, _>>()?;
        let least = |t: f64| {
            let knot = passed.iter().find(|k| k.0 == t).map_or(0, |k| self.knots.multiplicity(k.1));
            smoothness(p, knot).into_iter().chain(smoothness(q, inner.knots.multiplicity(t))).min()
        };
        Self::joined_smoothly(&pieces, least)
    }

    /// The Bezier piece that holds `t`.
    fn piece_at(&self, t: f64) -> Result<Self, NurbsError> {
        let span = self.knots.span(t);
        self.restricted(self.knots.values()[span], self.knots.values()[span + 1])
    }
}

/// Bernstein coefficients of a polynomial on the unit interval after another one.
fn composed<V: VectorSpace>(outer: &[V], inner: &[f64]) -> Vec<V> {
    let rest: Vec<f64> = inner.iter().map(|w| 1.0 - w).collect();
    let mut level: Vec<Vec<V>> = outer.iter().map(|&c| vec![c]).collect();
    while level.len() > 1 {
        let between = |w: &[Vec<V>]| {
            let (a, b) = (product(&w[0], &rest), product(&w[1], inner));
            a.into_iter().zip(b).map(|(a, b)| a + b).collect()
        };
        level = level.windows(2).map(between).collect();
    }
    level.swap_remove(0)
}

/// Where a growing function has a value that lies between those at its ends, to the last bit.
fn parameter_of(f: &Curve<f64>, value: f64) -> f64 {
    let (mut low, mut high) = f.knots.domain();
    loop {
        let middle = 0.5 * (low + high);
        if !(middle > low && middle < high) {
            return if value - f.point(low) < f.point(high) - value { low } else { high };
        }
        if f.point(middle) < value {
            low = middle;
        } else {
            high = middle;
        }
    }
}

impl<V: VectorSpace> Surface<V> {
    /// The surface `(t, v) -> S(inner(t), v)`, as [`Curve::composed`] on every column of the net.
    ///
    /// # Errors
    /// As [`Curve::composed`].
    pub fn composed_u(&self, inner: &Curve<f64>) -> Result<Self, NurbsError> {
        self.along_u(|column| column.composed(inner))
    }
}
