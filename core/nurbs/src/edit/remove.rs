//! Knot removal within a tolerance.

use crate::curve::{Curve, RationalCurve};
use crate::error::NurbsError;
use crate::knots::Knots;
use crate::surface::{RationalSurface, Surface};
use crate::vector::{Homogeneous, VectorSpace};

/// Rows of control points over one knot vector: a curve is one row, a surface has one for every control point
/// across.
struct Rows<V> {
    degree: usize,
    values: Vec<f64>,
    rows: Vec<Vec<V>>,
    /// Breaks of the curve as it came, and for each span between them a bound on what the removals have moved.
    breaks: Vec<f64>,
    moved: Vec<f64>,
}

/// A removal that is possible: the new points `first - 1 + k`, row after row, and the bound.
struct Removal<V> {
    index: usize,
    first: usize,
    points: Vec<Vec<V>>,
    bound: f64,
}

impl<V: VectorSpace> Rows<V> {
    fn new(knots: &Knots, rows: Vec<Vec<V>>) -> Self {
        let breaks = knots.breaks();
        let moved = vec![0.0; breaks.len() - 1];
        Self { degree: knots.degree(), values: knots.values().to_vec(), rows, breaks, moved }
    }

    /// The removal of the last occurrence `index` of a knot: points from both ends of those concerned that would
    /// insert back to the present ones, and how far the insertion of the result is off (Tiller, *Knot-removal
    /// algorithms for NURBS curves and surfaces*, 1992). By the convex hull property the curve moves by no more.
    fn removal(&self, index: usize) -> Removal<V> {
        let (p, u) = (self.degree, &self.values);
        let t = u[index];
        let multiplicity = u.iter().filter(|&&k| k == t).count();
        let (first, last) = (index - p, index - multiplicity);
        let alpha = |i: usize| (t - u[i]) / (u[i + p + 1] - u[i]);
        // Places `first - 1 ..= last` afterwards; the outer two are kept.
        let count = last + 2 - first;
        // Alpha falls from 1 to 0: both recurrences are stable if they meet where it passes one half.
        let half = (first..=last).find(|&i| alpha(i) < 0.5).unwrap_or(last);
        let nearer = half > first && alpha(half - 1) - 0.5 < 0.5 - alpha(half);
        let middle = if nearer { half - 1 } else { half };
        let mut bound = 0.0f64;
        let mut points = Vec::with_capacity(self.rows.len());
        for row in &self.rows {
            let mut new = vec![V::default(); count];
            new[0] = row[first - 1];
            new[count - 1] = row[last + 1];
            // One equation more than unknown points: `middle` is left out and tells the error. From the left each
            // step divides by alpha, from the right by its complement.
            for i in first..middle {
                let a = alpha(i);
                new[i - first + 1] = (row[i] - new[i - first] * (1.0 - a)) * (1.0 / a);
            }
            for i in (middle + 1..=last).rev() {
                let a = alpha(i);
                new[i - first] = (row[i] - new[i - first + 1] * a) * (1.0 / (1.0 - a));
            }
            for i in first..=last {
                let a = alpha(i);
                let again = new[i - first + 1] * a + new[i - first] * (1.0 - a);
                bound = bound.max(again.distance_to(&row[i]));
            }
            points.push(new);
        }
        Removal { index, first, points, bound }
    }

    /// Whether the removal keeps every span's bound within `tolerance`; counts it if so.
    fn admit(&mut self, removal: &Removal<V>, tolerance: f64) -> bool {
        let (from, to) = (self.values[removal.first], self.values[removal.index + 1 + self.degree]);
        let spans = |b: &[f64]| b[1] > from && b[0] < to;
        let breaks = self.breaks.windows(2).zip(&self.moved);
        if breaks.into_iter().any(|(b, moved)| spans(b) && !(moved + removal.bound <= tolerance)) {
            return false;
        }
        for (b, moved) in self.breaks.windows(2).zip(&mut self.moved) {
            if spans(b) {
                *moved += removal.bound;
            }
        }
        true
    }

    fn apply(&mut self, removal: Removal<V>) {
        let count = removal.points[0].len();
        for (row, new) in self.rows.iter_mut().zip(removal.points) {
            let start = removal.first - 1;
            row.splice(start..=start + count, new);
        }
        self.values.remove(removal.index);
    }

    /// Removes knots, the least harmful first, as long as the sum of bounds stays within `tolerance` on every span.
    fn simplify(&mut self, tolerance: f64) {
        loop {
            let (p, n) = (self.degree, self.values.len() - self.degree - 1);
            let (start, end) = (self.values[p], self.values[n]);
            let last_of_its_value = |&i: &usize| {
                self.values[i] > start && self.values[i] < end && self.values[i + 1] > self.values[i]
            };
            let mut removals: Vec<Removal<V>> =
                (p + 1..n).filter(last_of_its_value).map(|i| self.removal(i)).collect();
            removals.sort_by(|a, b| a.bound.total_cmp(&b.bound));
            match removals.into_iter().find(|r| self.admit(r, tolerance)) {
                Some(removal) => self.apply(removal),
                None => return,
            }
        }
    }

    fn bound(&self) -> f64 {
        self.moved.iter().fold(0.0, |m: f64, b| m.max(*b))
    }
}

impl<V: VectorSpace> Curve<V> {
    /// The curve with interior knots removed until each occurs as often as `multiplicity` says, for a curve that is known
    /// to be smooth enough: exact up to rounding.
    pub(super) fn with_multiplicities(
        &self,
        multiplicity: impl Fn(f64) -> usize,
    ) -> Result<Self, NurbsError> {
        let mut rows = Rows::new(&self.knots, vec![self.points.clone()]);
        let breaks = rows.breaks.clone();
        for &t in &breaks[1..breaks.len() - 1] {
            for _ in multiplicity(t)..self.knots.multiplicity(t) {
                let index = rows.values.partition_point(|&k| k <= t) - 1;
                let removal = rows.removal(index);
                rows.apply(removal);
            }
        }
        let points = rows.rows.swap_remove(0);
        Self::new(Knots::new(self.degree(), rows.values)?, points)
    }

    /// The curve with one occurrence of the interior knot `t` removed, and a bound on how far any point moves.
    ///
    /// # Errors
    /// [`NurbsError::NotFound`] if `t` is no interior knot, [`NurbsError::NoConvergence`] with the bound if that
    /// exceeds `tolerance`.
    pub fn with_knot_removed(&self, t: f64, tolerance: f64) -> Result<(Self, f64), NurbsError> {
        let (start, end) = self.knots.domain();
        let index = self.knots.values().iter().rposition(|&k| k == t).filter(|_| t > start && t < end);
        let index = index.ok_or(NurbsError::NotFound { what: "interior knot to remove" })?;
        if self.knots.multiplicity(t) > self.degree() {
            return Err(NurbsError::Multiplicity { knot: t, greatest: self.degree() });
        }
        let mut rows = Rows::new(&self.knots, vec![self.points.clone()]);
        let removal = rows.removal(index);
        let bound = removal.bound;
        if !(bound <= tolerance) {
            return Err(NurbsError::NoConvergence {
                what: "knot removal within a tolerance",
                residual: bound,
            });
        }
        rows.apply(removal);
        let points = rows.rows.swap_remove(0);
        Ok((Self::new(Knots::new(self.degree(), rows.values)?, points)?, bound))
    }

    /// The curve with as many interior knots removed, the least harmful first, as `tolerance` allows, and a bound on
    /// how far any point has moved (at most the tolerance). End points stay.
    ///
    /// # Errors
    /// [`NurbsError::Multiplicity`] for a curve that jumps at a knot.
    pub fn simplified(&self, tolerance: f64) -> Result<(Self, f64), NurbsError> {
        check_continuous(&self.knots)?;
        let mut rows = Rows::new(&self.knots, vec![self.points.clone()]);
        rows.simplify(tolerance);
        let bound = rows.bound();
        let points = rows.rows.swap_remove(0);
        Ok((Self::new(Knots::new(self.degree(), rows.values)?, points)?, bound))
    }
}

pub(super) fn check_continuous(knots: &Knots) -> Result<(), NurbsError> {
    let (start, end) = knots.domain();
    let (p, k) = (knots.degree(), knots.values());
    match (p..k.len()).find(|&i| k[i] == k[i - p] && k[i] > start && k[i] < end) {
        Some(i) => Err(NurbsError::Multiplicity { knot: k[i], greatest: p }),
        None => Ok(()),
    }
}

/// The tolerance in homogeneous coordinates that keeps projected points within `tolerance`: Tiller's
/// `tolerance * least weight / (1 + greatest distance from the origin)`.
fn homogeneous_tolerance<V: VectorSpace>(points: &[Homogeneous<V>], tolerance: f64) -> f64 {
    let weight = points.iter().fold(f64::INFINITY, |m, p| m.min(p.weight));
    let size = points.iter().fold(0.0, |m: f64, p| m.max(p.project().norm()));
    // Removal may lower the least weight by as much again as it moves points.
    tolerance * weight / (1.0 + size + tolerance)
}

impl<V: VectorSpace> RationalCurve<V> {
    /// The curve with as many interior knots removed as `tolerance` allows, as [`Curve::simplified`]; no point has
    /// moved by more than `tolerance`.
    ///
    /// # Errors
    /// As [`Curve::simplified`]; [`NurbsError::BadPoint`] if a weight would not stay positive.
    pub fn simplified(&self, tolerance: f64) -> Result<Self, NurbsError> {
        let tolerance = homogeneous_tolerance(&self.homogeneous.points, tolerance);
        Self::from_homogeneous(self.homogeneous.simplified(tolerance)?.0)
    }
}

impl<V: VectorSpace> Surface<V> {
    /// The surface with as many knots in v removed as `tolerance` allows, and a bound on how far any point has moved.
    ///
    /// # Errors
    /// As [`Curve::simplified`].
    pub fn simplified_v(&self, tolerance: f64) -> Result<(Self, f64), NurbsError> {
        check_continuous(&self.knots_v)?;
        let chunks = self.points.chunks_exact(self.knots_v.control_count());
        let mut rows = Rows::new(&self.knots_v, chunks.map(<[V]>::to_vec).collect());
        rows.simplify(tolerance);
        let bound = rows.bound();
        let knots_v = Knots::new(self.knots_v.degree(), rows.values)?;
        Ok((Self::new(self.knots_u.clone(), knots_v, rows.rows.concat())?, bound))
    }

    /// The surface with as many knots in u removed as `tolerance` allows, and a bound on how far any point has moved.
    ///
    /// # Errors
    /// As [`Curve::simplified`].
    pub fn simplified_u(&self, tolerance: f64) -> Result<(Self, f64), NurbsError> {
        let (turned, bound) = self.transposed().simplified_v(tolerance)?;
        Ok((turned.transposed(), bound))
    }
}

impl<V: VectorSpace> RationalSurface<V> {
    /// The surface with as many knots in u and v removed as `tolerance` allows, half of it for either direction; no
    /// point has moved by more.
    ///
    /// # Errors
    /// As [`RationalCurve::simplified`].
    pub fn simplified(&self, tolerance: f64) -> Result<Self, NurbsError> {
        let half = 0.5 * homogeneous_tolerance(&self.homogeneous.points, tolerance);
        Self::from_homogeneous(self.homogeneous.simplified_u(half)?.0.simplified_v(half)?.0)
    }
}
