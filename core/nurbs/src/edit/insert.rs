//! Knot insertion.

use crate::curve::{Curve, RationalCurve};
use crate::error::NurbsError;
use crate::knots::Knots;
use crate::surface::{RationalSurface, Surface};
use crate::vector::VectorSpace;

/// Inserts `t` once into `values` and `points` of a B-spline of `degree`, by Boehm's algorithm (*Inserting new
/// knots into B-spline curves*, 1980). Every new point is a convex combination of two old ones.
///
/// `t` must lie in the domain, and its multiplicity be below `degree`.
pub(super) fn insert_once<V: VectorSpace>(degree: usize, values: &mut Vec<f64>, points: &mut Vec<V>, t: f64) {
    let after = values.partition_point(|&k| k <= t);
    let before = values.partition_point(|&k| k < t);
    // The points `after - degree ..= before - 1` are new: all whose support has `t` strictly inside.
    let first = after - degree;
    let mut previous = points[first - 1];
    for i in first..before {
        let old = points[i];
        let alpha = (t - values[i]) / (values[i + degree] - values[i]);
        points[i] = previous * (1.0 - alpha) + old * alpha;
        previous = old;
    }
    points.insert(before, previous);
    values.insert(after, t);
}

impl<V: VectorSpace> Curve<V> {
    /// The same curve with the knots `inserted` added, in any order, repeated as often as given. Exact up to
    /// rounding; control points whose support holds no new knot are kept bit for bit.
    ///
    /// # Errors
    /// [`NurbsError::OutOfDomain`] for a knot outside the open domain, [`NurbsError::Multiplicity`] for one that
    /// would occur more than `degree` times.
    pub fn with_knots_inserted(&self, inserted: &[f64]) -> Result<Self, NurbsError> {
        let (start, end) = self.knots.domain();
        let degree = self.degree();
        let mut values = self.knots.values().to_vec();
        let mut points = self.points.clone();
        for &t in inserted {
            if !(t > start && t < end) {
                return Err(NurbsError::OutOfDomain { value: t, start, end });
            }
            if values.iter().filter(|&&k| k == t).count() >= degree {
                return Err(NurbsError::Multiplicity { knot: t, greatest: degree });
            }
            insert_once(degree, &mut values, &mut points, t);
        }
        Curve::new(Knots::new(degree, values)?, points)
    }
}

impl<V: VectorSpace> RationalCurve<V> {
    /// The same curve with knots added: [`Curve::with_knots_inserted`] on the homogeneous form.
    ///
    /// # Errors
    /// As [`Curve::with_knots_inserted`].
    pub fn with_knots_inserted(&self, inserted: &[f64]) -> Result<Self, NurbsError> {
        Self::from_homogeneous(self.homogeneous.with_knots_inserted(inserted)?)
    }
}

impl<V: VectorSpace> Surface<V> {
    /// Applies an edit of curves to every row of the control net, that is along v.
    pub(crate) fn along_v(
        &self,
        edit: impl Fn(&Curve<V>) -> Result<Curve<V>, NurbsError>,
    ) -> Result<Self, NurbsError> {
        let rows = self.points.chunks_exact(self.knots_v.control_count());
        let mut net = Vec::with_capacity(self.points.len());
        let mut knots_v = None;
        let mut curve = Curve { knots: self.knots_v.clone(), points: Vec::new() };
        for row in rows {
            curve.points.clear();
            curve.points.extend_from_slice(row);
            let edited = edit(&curve)?;
            net.extend_from_slice(&edited.points);
            knots_v = Some(edited.knots);
        }
        Surface::new(self.knots_u.clone(), knots_v.unwrap_or_else(|| self.knots_v.clone()), net)
    }

    /// Applies an edit of curves to every column of the control net, that is along u.
    pub(crate) fn along_u(
        &self,
        edit: impl Fn(&Curve<V>) -> Result<Curve<V>, NurbsError>,
    ) -> Result<Self, NurbsError> {
        Ok(self.transposed().along_v(edit)?.transposed())
    }

    /// The same surface with knots added in u: [`Curve::with_knots_inserted`] on every column of the net.
    ///
    /// # Errors
    /// As [`Curve::with_knots_inserted`].
    pub fn with_knots_inserted_u(&self, inserted: &[f64]) -> Result<Self, NurbsError> {
        self.along_u(|c| c.with_knots_inserted(inserted))
    }

    /// The same surface with knots added in v: [`Curve::with_knots_inserted`] on every row of the net.
    ///
    /// # Errors
    /// As [`Curve::with_knots_inserted`].
    pub fn with_knots_inserted_v(&self, inserted: &[f64]) -> Result<Self, NurbsError> {
        self.along_v(|c| c.with_knots_inserted(inserted))
    }
}

impl<V: VectorSpace> RationalSurface<V> {
    /// The same surface with knots added in u.
    ///
    /// # Errors
    /// As [`Curve::with_knots_inserted`].
    pub fn with_knots_inserted_u(&self, inserted: &[f64]) -> Result<Self, NurbsError> {
        Self::from_homogeneous(self.homogeneous.with_knots_inserted_u(inserted)?)
    }

    /// The same surface with knots added in v.
    ///
    /// # Errors
    /// As [`Curve::with_knots_inserted`].
    pub fn with_knots_inserted_v(&self, inserted: &[f64]) -> Result<Self, NurbsError> {
        Self::from_homogeneous(self.homogeneous.with_knots_inserted_v(inserted)?)
    }
}
