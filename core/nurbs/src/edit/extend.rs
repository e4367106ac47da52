//! Continuation beyond the ends of the domain.

use crate::curve::{Curve, RationalCurve};
use crate::error::NurbsError;
use crate::knots::{Knots, MAX_DEGREE};
use crate::surface::{RationalSurface, Surface};
use crate::vector::VectorSpace;

/// The blossom of the polynomial that a B-spline is on its span `span`, at `arguments` (one a degree): de Boor's
/// algorithm with another parameter at every level (Ramshaw 1989). Symmetric and affine in each argument.
pub(super) fn blossom<V: VectorSpace>(
    degree: usize,
    values: &[f64],
    points: &[V],
    span: usize,
    arguments: &[f64],
) -> V {
    let mut d = [V::default(); MAX_DEGREE + 1];
    d[..=degree].copy_from_slice(&points[span - degree..=span]);
    for (r, &t) in arguments.iter().enumerate() {
        for j in (r + 1..=degree).rev() {
            let (low, high) = (values[span - degree + j], values[span + j - r]);
            let alpha = (t - low) / (high - low);
            d[j] = d[j - 1] * (1.0 - alpha) + d[j] * alpha;
        }
    }
    d[degree]
}

impl<V: VectorSpace> Curve<V> {
    /// The curve on the domain longer by `before` and `after` (not negative), where its end polynomials go on: a
    /// clamped B-spline without new interior knots. Inside the old domain the points stay the same up to
    /// rounding, which grows with the power `degree` of the extension over the length of the end span.
    ///
    /// New control points are values of the end polynomial's blossom at the new knots; all others are kept.
    ///
    /// # Errors
    /// [`NurbsError::BadArgument`] for a negative or infinite length.
    pub fn extended(&self, before: f64, after: f64) -> Result<Self, NurbsError> {
        for length in [before, after] {
            if !(length >= 0.0) || !length.is_finite() {
                return Err(NurbsError::BadArgument { what: "length of the extension", value: length });
            }
        }
        let forward = self.extended_at_start(before)?;
        Ok(forward.mirrored().extended_at_start(after)?.mirrored())
    }

    fn extended_at_start(&self, length: f64) -> Result<Self, NurbsError> {
        let (p, start) = (self.degree(), self.knots.domain().0);
        if length == 0.0 {
            return Ok(self.clone());
        }
        let old = self.knots.values();
        let mut values = old.to_vec();
        values[..=p].fill(start - length);
        let span = self.knots.span(start);
        let mut points = self.points.clone();
        for i in 0..p {
            points[i] = blossom(p, old, &self.points, span, &values[i + 1..=i + p]);
        }
        Curve::new(Knots::new(p, values)?, points)
    }

    /// The curve run through backwards with negated knots: exact, unlike [`Curve::reversed`].
    fn mirrored(&self) -> Self {
        let values = self.knots.values().iter().rev().map(|k| -k).collect();
        let knots = Knots::new(self.degree(), values).expect("negated knots in reverse keep their order");
        Self { knots, points: self.points.iter().rev().copied().collect() }
    }
}

impl<V: VectorSpace> RationalCurve<V> {
    /// The curve on a longer domain, as [`Curve::extended`].
    ///
    /// # Errors
    /// As [`Curve::extended`]; [`NurbsError::BadPoint`] if a weight would not stay positive.
    pub fn extended(&self, before: f64, after: f64) -> Result<Self, NurbsError> {
        Self::from_homogeneous(self.homogeneous.extended(before, after)?)
    }
}

impl<V: VectorSpace> Surface<V> {
    /// The surface on a domain longer in u, as [`Curve::extended`].
    ///
    /// # Errors
    /// As [`Curve::extended`].
    pub fn extended_u(&self, below: f64, above: f64) -> Result<Self, NurbsError> {
        self.along_u(|c| c.extended(below, above))
    }

    /// The surface on a domain longer in v, as [`Curve::extended`].
    ///
    /// # Errors
    /// As [`Curve::extended`].
    pub fn extended_v(&self, below: f64, above: f64) -> Result<Self, NurbsError> {
        self.along_v(|c| c.extended(below, above))
    }
}

impl<V: VectorSpace> RationalSurface<V> {
    /// The surface on a domain longer in u, as [`Curve::extended`].
    ///
    /// # Errors
    /// As [`RationalCurve::extended`].
    pub fn extended_u(&self, below: f64, above: f64) -> Result<Self, NurbsError> {
        Self::from_homogeneous(self.homogeneous.extended_u(below, above)?)
    }

    /// The surface on a domain longer in v, as [`Curve::extended`].
    ///
    /// # Errors
    /// As [`RationalCurve::extended`].
    pub fn extended_v(&self, below: f64, above: f64) -> Result<Self, NurbsError> {
        Self::from_homogeneous(self.homogeneous.extended_v(below, above)?)
    }
}
