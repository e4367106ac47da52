//! Products with functions.

use super::remove::check_continuous;
use crate::bernstein::binomials;
use crate::curve::Curve;
use crate::error::NurbsError;
use crate::knots::{Knots, MAX_DEGREE};
use crate::surface::Surface;
use crate::vector::VectorSpace;

/// Bernstein coefficients of the product of two polynomials on one interval.
pub(super) fn product<V: VectorSpace>(a: &[V], b: &[f64]) -> Vec<V> {
    let (p, q) = (a.len() - 1, b.len() - 1);
    let (of_a, of_b, of_both) = (binomials(p), binomials(q), binomials(p + q));
    let mut out = vec![V::default(); p + q + 1];
    for (i, &a) in a.iter().enumerate() {
        for (j, &b) in b.iter().enumerate() {
            out[i + j] = out[i + j] + a * (of_a[i] * of_b[j] * b);
        }
    }
    for (c, n) in out.iter_mut().zip(of_both) {
        *c = *c * (1.0 / n);
    }
    out
}

/// Bernstein coefficients of the same polynomial with a degree higher by `more`.
pub(super) fn raised<V: VectorSpace>(a: &[V], more: usize) -> Vec<V> {
    product(a, &vec![1.0; more + 1])
}

/// How often the derivatives go through a knot that occurs `multiplicity` times, none elsewhere.
pub(super) fn smoothness(degree: usize, multiplicity: usize) -> Option<usize> {
    (multiplicity > 0).then(|| degree.saturating_sub(multiplicity))
}

impl<V: VectorSpace> Curve<V> {
    /// The product with a function over the same domain, `t -> factor(t) C(t)`: its degree is the sum of both, its knots are
    /// those of both, as often as the less smooth of them asks for. Exact up to rounding.
    ///
    /// Piece by piece on Bernstein coefficients (R. T. Farouki, V. T. Rajan, *Algorithms for polynomials in Bernstein form*,
    /// 1988); then knots are removed that both are smoother than.
    ///
    /// # Errors
    /// [`NurbsError::OutOfDomain`] for different domains, [`NurbsError::Degree`] above [`MAX_DEGREE`],
    /// [`NurbsError::Multiplicity`] for one that jumps at a knot.
    pub fn times(&self, factor: &Curve<f64>) -> Result<Self, NurbsError> {
        let (start, end) = self.knots.domain();
        let theirs = factor.knots.domain();
        if theirs != (start, end) {
            let value = if theirs.0 == start { theirs.1 } else { theirs.0 };
            return Err(NurbsError::OutOfDomain { value, start, end });
        }
        let degree = self.degree() + factor.degree();
        if degree > MAX_DEGREE {
            return Err(NurbsError::Degree { degree, greatest: MAX_DEGREE });
        }
        check_continuous(&self.knots)?;
        check_continuous(&factor.knots)?;
        let cuts = merged(self.knots.breaks(), &factor.knots.breaks());
        let (a, b) = (self.cut_at(&cuts)?, factor.cut_at(&cuts)?);
        let pieces = cuts
            .windows(2)
            .zip(a.iter().zip(&b))
            .map(|(ends, (a, b))| Self::new(Knots::clamped(degree, ends)?, product(&a.points, &b.points)));
        let pieces = pieces.collect::<Result<Vec<_>, _>>()?;
        let least = |t: f64| {
            let own = smoothness(self.degree(), self.knots.multiplicity(t));
            own.into_iter().chain(smoothness(factor.degree(), factor.knots.multiplicity(t))).min()
        };
        Self::joined_smoothly(&pieces, least)
    }

    /// The Bezier pieces between `cuts`, which hold all breaks.
    pub(super) fn cut_at(&self, cuts: &[f64]) -> Result<Vec<Self>, NurbsError> {
        let (start, end) = self.knots.domain();
        let clamped = self.restricted(start, end)?;
        let missing = |t: &f64| clamped.knots.multiplicity(*t) == 0;
        let inserted: Vec<f64> = cuts.iter().copied().filter(missing).collect();
        Ok(clamped.with_knots_inserted(&inserted)?.bezier_segments())
    }

    /// One curve from Bezier pieces that are known to go over into each other with as many derivatives as `smoothness`
    /// says of the knot (all of them where it says none).
    pub(super) fn joined_smoothly(
        pieces: &[Self],
        smoothness: impl Fn(f64) -> Option<usize>,
    ) -> Result<Self, NurbsError> {
        let joined = Self::joined(pieces, f64::INFINITY)?;
        let p = joined.degree();
        joined.with_multiplicities(|t| smoothness(t).map_or(0, |derivatives| p - derivatives.min(p)))
    }
}

/// Both lists in order, each value once.
pub(super) fn merged(mut a: Vec<f64>, b: &[f64]) -> Vec<f64> {
    a.extend_from_slice(b);
    a.sort_by(f64::total_cmp);
    a.dedup();
    a
}

impl<V: VectorSpace> Surface<V> {
    /// The product with a function of u, as [`Curve::times`] on every column of the net.
    ///
    /// # Errors
    /// As [`Curve::times`].
    pub fn times_u(&self, factor: &Curve<f64>) -> Result<Self, NurbsError> {
        self.along_u(|column| column.times(factor))
    }

    /// The product with a function of v, as [`Curve::times`] on every row of the net.
    ///
    /// # Errors
    /// As [`Curve::times`].
    pub fn times_v(&self, factor: &Curve<f64>) -> Result<Self, NurbsError> {
        self.along_v(|row| row.times(factor))
    }
}
