//! Parts of curves and surfaces, exact, by knot insertion.

use super::insert::insert_once;
use crate::curve::{Curve, RationalCurve};
use crate::error::NurbsError;
use crate::knots::Knots;
use crate::surface::{RationalSurface, Surface};
use crate::vector::VectorSpace;

impl<V: VectorSpace> Curve<V> {
    /// The part on `[a, b]` as a clamped B-spline with the same parameters: `a` and `b` are inserted until the
    /// curve passes through a control point there, and what lies outside is dropped. Exact up to rounding; parts
    /// that meet share their end point bit for bit.
    ///
    /// # Errors
    /// [`NurbsError::OutOfDomain`] for an end outside the domain, or `b` if it does not come after `a`.
    pub fn restricted(&self, a: f64, b: f64) -> Result<Self, NurbsError> {
        let (start, end) = self.knots.domain();
        if !(a >= start && a < end) {
            return Err(NurbsError::OutOfDomain { value: a, start, end });
        }
        if !(b > a && b <= end) {
            return Err(NurbsError::OutOfDomain { value: b, start: a, end });
        }
        let degree = self.degree();
        // From the span of `a` to that of `b`: what is farther out has no part in it.
        let knots = self.knots.values();
        let (first, end) = (knots.partition_point(|&k| k <= a) - 1, knots.partition_point(|&k| k < b));
        let mut values = knots[first - degree..end + degree + 1].to_vec();
        let mut points = self.points[first - degree..end].to_vec();
        for t in [a, b] {
            for _ in values.iter().filter(|&&k| k == t).count()..degree {
                insert_once(degree, &mut values, &mut points, t);
            }
        }
        // The first span starts at the last knot `a`, the last one ends at the first knot `b`.
        let after_a = values.partition_point(|&k| k <= a);
        let at_b = values.partition_point(|&k| k < b);
        let mut kept = vec![a; degree + 1];
        kept.extend_from_slice(&values[after_a..at_b]);
        kept.extend(std::iter::repeat_n(b, degree + 1));
        Curve::new(Knots::new(degree, kept)?, points[after_a - 1 - degree..at_b].to_vec())
    }

    /// The two parts before and after `t`, see [`Curve::restricted`].
    ///
    /// # Errors
    /// [`NurbsError::OutOfDomain`] for `t` outside the open domain.
    pub fn split(&self, t: f64) -> Result<(Self, Self), NurbsError> {
        let (start, end) = self.knots.domain();
        Ok((self.restricted(start, t)?, self.restricted(t, end)?))
    }
}

impl<V: VectorSpace> RationalCurve<V> {
    /// The part on `[a, b]`, as [`Curve::restricted`].
    ///
    /// # Errors
    /// As [`Curve::restricted`].
    pub fn restricted(&self, a: f64, b: f64) -> Result<Self, NurbsError> {
        Self::from_homogeneous(self.homogeneous.restricted(a, b)?)
    }

    /// The two parts before and after `t`, as [`Curve::split`].
    ///
    /// # Errors
    /// As [`Curve::split`].
    pub fn split(&self, t: f64) -> Result<(Self, Self), NurbsError> {
        let (before, after) = self.homogeneous.split(t)?;
        Ok((Self::from_homogeneous(before)?, Self::from_homogeneous(after)?))
    }
}

impl<V: VectorSpace> Surface<V> {
    /// The part with u in `[a, b]`, as [`Curve::restricted`].
    ///
    /// # Errors
    /// As [`Curve::restricted`].
    pub fn restricted_u(&self, a: f64, b: f64) -> Result<Self, NurbsError> {
        self.along_u(|c| c.restricted(a, b))
    }

    /// The part with v in `[a, b]`, as [`Curve::restricted`].
    ///
    /// # Errors
    /// As [`Curve::restricted`].
    pub fn restricted_v(&self, a: f64, b: f64) -> Result<Self, NurbsError> {
        self.along_v(|c| c.restricted(a, b))
    }
}

impl<V: VectorSpace> RationalSurface<V> {
    /// The part with u in `[a, b]`, as [`Curve::restricted`].
    ///
    /// # Errors
    /// As [`Curve::restricted`].
    pub fn restricted_u(&self, a: f64, b: f64) -> Result<Self, NurbsError> {
        Self::from_homogeneous(self.homogeneous.restricted_u(a, b)?)
    }

    /// The part with v in `[a, b]`, as [`Curve::restricted`].
    ///
    /// # Errors
    /// As [`Curve::restricted`].
    pub fn restricted_v(&self, a: f64, b: f64) -> Result<Self, NurbsError> {
        Self::from_homogeneous(self.homogeneous.restricted_v(a, b)?)
    }
}
