//! Degree reduction by as much as is asked for, within a tolerance.

use super::product::{merged, raised, smoothness};
use super::remove::check_continuous;
use crate::curve::Curve;
use crate::error::NurbsError;
use crate::fit::{Constraint, LeastSquares};
use crate::knots::{Basis, Knots};
use crate::quadrature::gauss_on_spans;
use crate::surface::Surface;
use crate::vector::VectorSpace;

/// Spans beyond which a curve counts as not within reach of the degree.
const SPANS: usize = 4_000;

/// Rows of control points over one knot vector, brought to a lower degree together.
struct Rows<V> {
    curves: Vec<Curve<V>>,
    degree: usize,
    /// Where the curves have a kink.
    kinks: Vec<f64>,
}

impl<V: VectorSpace> Rows<V> {
    fn new(curves: Vec<Curve<V>>, degree: usize) -> Result<Self, NurbsError> {
        let knots = &curves[0].knots;
        check_continuous(knots)?;
        let own = knots.degree();
        let breaks = knots.breaks();
        let kinked = |t: &f64| smoothness(own, knots.multiplicity(*t)) == Some(0);
        let kinks = breaks[1..breaks.len() - 1].iter().copied().filter(kinked).collect();
        Ok(Self { curves, degree, kinks })
    }

    /// Knots of the lower degree with these breaks.
    fn knots(&self, breaks: &[f64]) -> Result<Knots, NurbsError> {
        let last = breaks.len() - 1;
        let times = |i: usize| match i {
            _ if i == 0 || i == last => self.degree + 1,
            _ if self.kinks.contains(&breaks[i]) => self.degree,
            _ => 1,
        };
        let values = (0..=last).flat_map(|i| std::iter::repeat_n(breaks[i], times(i))).collect();
        Knots::new(self.degree, values)
    }

    /// The nearest curves on `knots` in the sense of least squares, ends met; and bounds on the distance in each span of
    /// `cuts`, which are the breaks of both.
    fn fitted(&self, knots: &Knots, cuts: &[f64]) -> Result<(Vec<Curve<V>>, Vec<f64>), NurbsError> {
        let own = self.curves[0].degree();
        // Exact for the product of a basis function with the distance.
        let (parameters, weights) = gauss_on_spans(cuts, (own + self.degree) / 2 + 1);
        let (start, end) = knots.domain();
        let ends = [Constraint::derivative(knots, start, 0)?, Constraint::derivative(knots, end, 0)?];
        let problem = LeastSquares::new(knots.clone(), &parameters, Some(&weights), &ends, None)?;
        // One basis for all curves.
        let bases: Vec<Basis> = parameters.iter().map(|&t| self.curves[0].knots.basis(t, 0)).collect();
        let mut bounds = vec![0.0f64; cuts.len() - 1];
        let mut fits = Vec::with_capacity(self.curves.len());
        for curve in &self.curves {
            let point = |b: &Basis| {
                let weighted = b.values[0][..=own].iter().zip(&curve.points[b.first..]);
                weighted.fold(V::default(), |sum, (&n, &p)| sum + p * n)
            };
            let data: Vec<V> = bases.iter().map(point).collect();
            let (first, last) = (curve.points[0], curve.points[curve.points.len() - 1]);
            let fit = problem.curve(&data, &[first, last])?.curve.with_ends(first, last);
            // The distance of Bernstein coefficients of one degree bounds that of the points.
            let pieces = curve.cut_at(cuts)?.into_iter().zip(fit.cut_at(cuts)?);
            for (bound, (exact, near)) in bounds.iter_mut().zip(pieces) {
                let near = raised(&near.points, own - self.degree);
                let apart = exact.points.iter().zip(&near).map(|(a, b)| a.distance_to(b));
                *bound = apart.fold(*bound, f64::max);
            }
            fits.push(fit);
        }
        Ok((fits, bounds))
    }

    /// Curves on the fewest halves of spans that are within `tolerance`, with the bound kept.
    fn within(&self, tolerance: f64) -> Result<(Vec<Curve<V>>, f64), NurbsError> {
        let own = self.curves[0].knots.breaks();
        let mut breaks = vec![own[0]];
        breaks.extend_from_slice(&self.kinks);
        breaks.push(own[own.len() - 1]);
        loop {
            let cuts = merged(own.clone(), &breaks);
            let (fits, bounds) = self.fitted(&self.knots(&breaks)?, &cuts)?;
            let worst = bounds.iter().fold(0.0, |w: f64, b| w.max(*b));
            if worst <= tolerance {
                return Ok((fits, worst));
            }
            let mut finer = vec![breaks[0]];
            for span in breaks.windows(2) {
                let inside = cuts.windows(2).zip(&bounds).filter(|(c, _)| c[0] >= span[0] && c[1] <= span[1]);
                let middle = 0.5 * (span[0] + span[1]);
                if inside.into_iter().any(|(_, b)| !(*b <= tolerance)) && middle > span[0] && middle < span[1]
                {
                    finer.push(middle);
                }
                finer.push(span[1]);
            }
            if finer.len() == breaks.len() || finer.len() > SPANS {
                return Err(NurbsError::NoConvergence {
                    what: "degree reduction within a tolerance",
                    residual: worst,
                });
            }
            breaks = finer;
        }
    }
}

impl<V: VectorSpace> Curve<V> {
    /// A curve of a lower `degree` within `tolerance` of this one at equal parameters, with the same ends, and a bound on the
    /// distance. Its knots are simple, kinks excepted: it has `degree - 1` continuous derivatives also where this one has
    /// fewer. Spans are halved where the curve nearest in the sense of least squares is too far; knots that were not
    /// needed stay: [`Curve::simplified`] removes them. A curve of that degree or less comes back as it is.
    ///
    /// The bound is rigorous: the distance of the Bernstein coefficients, brought to one degree.
    ///
    /// # Errors
    /// [`NurbsError::Degree`] for degree 0, [`NurbsError::Multiplicity`] for a curve that jumps at a knot,
    /// [`NurbsError::NoConvergence`] with the bound where halving ends above the tolerance.
    pub fn lowered(&self, degree: usize, tolerance: f64) -> Result<(Self, f64), NurbsError> {
        let (mut rows, bound) = lowered(vec![self.clone()], degree, tolerance)?;
        Ok((rows.swap_remove(0), bound))
    }
}

fn lowered<V: VectorSpace>(
    rows: Vec<Curve<V>>,
    degree: usize,
    tolerance: f64,
) -> Result<(Vec<Curve<V>>, f64), NurbsError> {
    if degree == 0 {
        return Err(NurbsError::Degree { degree, greatest: crate::MAX_DEGREE });
    }
    if rows[0].degree() <= degree {
        return Ok((rows, 0.0));
    }
    Rows::new(rows, degree)?.within(tolerance)
}

impl<V: VectorSpace> Surface<V> {
    /// The surface with a lower degree in v, as [`Curve::lowered`] on all rows of the net together.
    ///
    /// # Errors
    /// As [`Curve::lowered`].
    pub fn lowered_v(&self, degree: usize, tolerance: f64) -> Result<(Self, f64), NurbsError> {
        let rows = self.points.chunks_exact(self.knots_v.control_count());
        let rows = rows.map(|row| Curve { knots: self.knots_v.clone(), points: row.to_vec() }).collect();
        let (rows, bound) = lowered(rows, degree, tolerance)?;
        let knots_v = rows[0].knots.clone();
        let points = rows.into_iter().flat_map(|row| row.points).collect();
        Ok((Self::new(self.knots_u.clone(), knots_v, points)?, bound))
    }

    /// The surface with a lower degree in u, as [`Curve::lowered`] on all columns of the net together.
    ///
    /// # Errors
    /// As [`Curve::lowered`].
    pub fn lowered_u(&self, degree: usize, tolerance: f64) -> Result<(Self, f64), NurbsError> {
        let (turned, bound) = self.transposed().lowered_v(degree, tolerance)?;
        Ok((turned.transposed(), bound))
    }
}
