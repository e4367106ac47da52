//! Degree elevation.

use super::extend::blossom;
use crate::curve::{Curve, RationalCurve};
use crate::error::NurbsError;
use crate::knots::{Knots, MAX_DEGREE};
use crate::surface::{RationalSurface, Surface};
use crate::vector::VectorSpace;

impl<V: VectorSpace> Curve<V> {
    /// The same curve with the degree higher by one; every knot occurs once more. Exact up to rounding.
    ///
    /// New control points are blossoms of degree `p + 1`, each the mean of the old blossom with one argument left
    /// out (Ramshaw 1989). Ends are clamped.
    ///
    /// # Errors
    /// [`NurbsError::Degree`] at [`MAX_DEGREE`], [`NurbsError::Multiplicity`] for a curve that jumps at a knot.
    pub fn elevated(&self) -> Result<Self, NurbsError> {
        let p = self.degree();
        if p == MAX_DEGREE {
            return Err(NurbsError::Degree { degree: p + 1, greatest: MAX_DEGREE });
        }
        let (start, end) = self.knots.domain();
        let clamped = self.restricted(start, end)?;
        let old = clamped.knots.values();
        let breaks = clamped.knots.breaks();
        let mut values = Vec::with_capacity(old.len() + breaks.len());
        for &b in &breaks {
            let multiplicity = clamped.knots.multiplicity(b);
            if multiplicity > p && b > start && b < end {
                return Err(NurbsError::Multiplicity { knot: b, greatest: p });
            }
            values.extend(std::iter::repeat_n(b, multiplicity + 1));
        }
        let count = values.len() - p - 2;
        let mut points = Vec::with_capacity(count);
        for i in 0..count {
            let arguments = &values[i + 1..=i + p + 1];
            // Any span among the arguments gives the same; the middle one keeps the combination near convex.
            let span = clamped.knots.span(0.5 * (arguments[0] + arguments[p]));
            let mut sum = V::default();
            let mut rest = [0.0; MAX_DEGREE];
            for left_out in 0..=p {
                rest[..left_out].copy_from_slice(&arguments[..left_out]);
                rest[left_out..p].copy_from_slice(&arguments[left_out + 1..]);
                sum = sum + blossom(p, old, &clamped.points, span, &rest[..p]);
            }
            points.push(sum * (1.0 / (p + 1) as f64));
        }
        // The ends are the curve's, bit for bit.
        points[0] = clamped.points[0];
        points[count - 1] = clamped.points[clamped.points.len() - 1];
        Self::new(Knots::new(p + 1, values)?, points)
    }

    /// The same curve with at least `degree`, see [`Curve::elevated`].
    ///
    /// # Errors
    /// As [`Curve::elevated`].
    pub fn elevated_to(&self, degree: usize) -> Result<Self, NurbsError> {
        let mut curve = self.clone();
        while curve.degree() < degree {
            curve = curve.elevated()?;
        }
        Ok(curve)
    }

    /// Both curves with the same degree and knots, exact up to rounding. They must have the same domain.
    ///
    /// # Errors
    /// [`NurbsError::OutOfDomain`] for different domains; as [`Curve::elevated`].
    pub fn compatible(&self, other: &Self) -> Result<(Self, Self), NurbsError> {
        let (start, end) = self.knots.domain();
        let theirs = other.knots.domain();
        if theirs != (start, end) {
            let value = if theirs.0 == start { theirs.1 } else { theirs.0 };
            return Err(NurbsError::OutOfDomain { value, start, end });
        }
        let degree = self.degree().max(other.degree());
        let a = self.restricted(start, end)?.elevated_to(degree)?;
        let b = other.restricted(start, end)?.elevated_to(degree)?;
        let missing = |from: &Self, to: &Self| -> Vec<f64> {
            let inner = from.knots.breaks();
            let lacks = |&t: &f64| from.knots.multiplicity(t).saturating_sub(to.knots.multiplicity(t));
            inner[1..inner.len() - 1].iter().flat_map(|t| std::iter::repeat_n(*t, lacks(t))).collect()
        };
        Ok((a.with_knots_inserted(&missing(&b, &a))?, b.with_knots_inserted(&missing(&a, &b))?))
    }

    /// A bound on the distance of the two curves at equal parameters: the greatest distance of control points once
    /// degrees and knots agree (convex hull property).
    ///
    /// # Errors
    /// As [`Curve::compatible`].
    pub fn deviation_bound(&self, other: &Self) -> Result<f64, NurbsError> {
        let (a, b) = self.compatible(other)?;
        Ok(a.points.iter().zip(&b.points).map(|(a, b)| a.distance_to(b)).fold(0.0, f64::max))
    }
}

impl<V: VectorSpace> RationalCurve<V> {
    /// The same curve with the degree higher by one, as [`Curve::elevated`].
    ///
    /// # Errors
    /// As [`Curve::elevated`].
    pub fn elevated(&self) -> Result<Self, NurbsError> {
        Self::from_homogeneous(self.homogeneous.elevated()?)
    }
}

impl<V: VectorSpace> Surface<V> {
    /// The same surface with the degree in u higher by one, as [`Curve::elevated`].
    ///
    /// # Errors
    /// As [`Curve::elevated`].
    pub fn elevated_u(&self) -> Result<Self, NurbsError> {
        self.along_u(Curve::elevated)
    }

    /// The same surface with the degree in v higher by one, as [`Curve::elevated`].
    ///
    /// # Errors
    /// As [`Curve::elevated`].
    pub fn elevated_v(&self) -> Result<Self, NurbsError> {
        self.along_v(Curve::elevated)
    }
}

impl<V: VectorSpace> RationalSurface<V> {
    /// The same surface with the degree in u higher by one, as [`Curve::elevated`].
    ///
    /// # Errors
    /// As [`Curve::elevated`].
    pub fn elevated_u(&self) -> Result<Self, NurbsError> {
        Self::from_homogeneous(self.homogeneous.elevated_u()?)
    }

    /// The same surface with the degree in v higher by one, as [`Curve::elevated`].
    ///
    /// # Errors
    /// As [`Curve::elevated`].
    pub fn elevated_v(&self) -> Result<Self, NurbsError> {
        Self::from_homogeneous(self.homogeneous.elevated_v()?)
    }
}
