//! Linear conditions on the control points of a fit.

use crate::error::NurbsError;
use crate::knots::Knots;

/// The left side of a linear condition on control points: a sum of control points times factors. What it equals is
/// said when the fit is solved, since one factored fit serves many right sides.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraint {
    pub(crate) terms: Vec<(usize, f64)>,
}

impl Constraint {
    /// The sum of `factor` times control point `index` over `terms`.
    pub fn new(terms: Vec<(usize, f64)>) -> Self {
        Self { terms }
    }

    /// The derivative of `order` (0: the point) of the curve at `t`.
    ///
    /// # Errors
    /// [`NurbsError::OutOfDomain`], [`NurbsError::Degree`] for an order above the degree.
    pub fn derivative(knots: &Knots, t: f64, order: usize) -> Result<Self, NurbsError> {
        let (start, end) = knots.domain();
        if !(t >= start && t <= end) {
            return Err(NurbsError::OutOfDomain { value: t, start, end });
        }
        if order > knots.degree() {
            return Err(NurbsError::Degree { degree: order, greatest: knots.degree() });
        }
        let (first, row) = knots.derivative_row(t, order);
        let terms = row[..=knots.degree()].iter().enumerate().filter(|(_, f)| **f != 0.0);
        Ok(Self { terms: terms.map(|(k, &f)| (first + k, f)).collect() })
    }

    /// The derivative of `order` at the end of the domain less that at its start: zero for a curve that closes with
    /// this derivative continuous.
    ///
    /// # Errors
    /// [`NurbsError::Degree`] for an order above the degree.
    pub fn closure(knots: &Knots, order: usize) -> Result<Self, NurbsError> {
        let (start, end) = knots.domain();
        let mut terms = Self::derivative(knots, end, order)?.terms;
        terms.extend(Self::derivative(knots, start, order)?.terms.into_iter().map(|(i, f)| (i, -f)));
        Ok(Self { terms })
    }

    /// Control point `i` less control point `j`: zero for a doubled control point.
    pub fn difference(i: usize, j: usize) -> Self {
        Self { terms: vec![(i, 1.0), (j, -1.0)] }
    }

    /// First and last control point concerned.
    pub(crate) fn span(&self) -> (usize, usize) {
        self.terms.iter().fold((usize::MAX, 0), |(low, high), t| (low.min(t.0), high.max(t.0)))
    }
}
