//! Degree reduction.

use crate::curve::{Curve, ParametricCurve};
use crate::error::NurbsError;
use crate::fit::{Constraint, LeastSquares};
use crate::knots::Knots;
use crate::quadrature::gauss_on_spans;
use crate::surface::Surface;
use crate::vector::VectorSpace;

impl<V: VectorSpace> Curve<V> {
    /// The curve of a degree lower by one nearest to this one in the least-squares sense, with the same end points,
    /// and a bound on the distance at equal parameters. Interior knots of multiplicity m get m - 1, at least 1, so
    /// that an elevated curve comes back exactly.
    ///
    /// The bound is rigorous: see [`Curve::deviation_bound`].
    ///
    /// # Errors
    /// [`NurbsError::Degree`] for degree 1, [`NurbsError::Multiplicity`] for a curve that jumps at a knot.
    pub fn reduced(&self) -> Result<(Self, f64), NurbsError> {
        let p = self.degree();
        if p == 1 {
            return Err(NurbsError::Degree { degree: 0, greatest: crate::MAX_DEGREE });
        }
        let (start, end) = self.knots.domain();
        let breaks = self.knots.breaks();
        let mut values = vec![start; p];
        for &b in &breaks[1..breaks.len() - 1] {
            let multiplicity = self.knots.multiplicity(b);
            if multiplicity > p {
                return Err(NurbsError::Multiplicity { knot: b, greatest: p });
            }
            values.extend(std::iter::repeat_n(b, (multiplicity - 1).max(1)));
        }
        values.extend(std::iter::repeat_n(end, p));
        let knots = Knots::new(p - 1, values)?;
        // The integral of the squared distance, by a rule that is exact for it.
        let (parameters, weights) = gauss_on_spans(&breaks, p + 1);
        let ends = [Constraint::derivative(&knots, start, 0)?, Constraint::derivative(&knots, end, 0)?];
        let data: Vec<V> = parameters.iter().map(|&t| self.point(t)).collect();
        let problem = LeastSquares::new(knots, &parameters, Some(&weights), &ends, None)?;
        let curve = problem.curve(&data, &[self.point(start), self.point(end)])?.curve;
        let bound = self.deviation_bound(&curve)?;
        Ok((curve, bound))
    }
}

impl<V: VectorSpace> Surface<V> {
    /// The surface with the degree in u lower by one, as [`Curve::reduced`] on every column of the net, and a bound
    /// on the distance at equal parameters.
    ///
    /// # Errors
    /// As [`Curve::reduced`].
    pub fn reduced_u(&self) -> Result<(Self, f64), NurbsError> {
        let (turned, bound) = self.transposed().reduced_v()?;
        Ok((turned.transposed(), bound))
    }

    /// The surface with the degree in v lower by one, as [`Curve::reduced`] on every row of the net, and a bound on
    /// the distance at equal parameters.
    ///
    /// # Errors
    /// As [`Curve::reduced`].
    pub fn reduced_v(&self) -> Result<(Self, f64), NurbsError> {
        let worst = std::cell::Cell::new(0.0f64);
        let reduced = self.along_v(|row| {
            let (reduced, bound) = row.reduced()?;
            worst.set(worst.get().max(bound));
            Ok(reduced)
        })?;
        Ok((reduced, worst.get()))
    }
}
