//! Knot vectors and B-spline basis functions.

use crate::error::NurbsError;

/// Highest degree that evaluation supports; basis arrays of this size live on the stack.
pub const MAX_DEGREE: usize = 15;

/// A knot vector with its degree: non-decreasing knots, clamped or not.
///
/// The curve it carries is defined on `[knots[degree], knots[len - degree - 1]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Knots {
    degree: usize,
    values: Vec<f64>,
}

/// Values and derivatives of the `degree + 1` basis functions that do not vanish on one span.
#[derive(Clone, Copy, Debug)]
pub struct Basis {
    /// Index of the first control point concerned.
    pub first: usize,
    /// `[derivative order][k]`: derivative of basis function `first + k`.
    pub values: [[f64; MAX_DEGREE + 1]; 3],
}

impl Knots {
    /// Checks degree (1 to [`MAX_DEGREE`]), order and count of `values`.
    ///
    /// # Errors
    /// [`NurbsError::Degree`], [`NurbsError::KnotCount`], [`NurbsError::KnotOrder`].
    pub fn new(degree: usize, values: Vec<f64>) -> Result<Self, NurbsError> {
        if !(1..=MAX_DEGREE).contains(&degree) {
            return Err(NurbsError::Degree { degree, greatest: MAX_DEGREE });
        }
        if values.len() < 2 * (degree + 1) {
            return Err(NurbsError::KnotCount { count: values.len(), least: 2 * (degree + 1) });
        }
        if let Some(i) = (1..values.len()).find(|&i| !(values[i] >= values[i - 1]) || !values[i].is_finite())
        {
            return Err(NurbsError::KnotOrder { index: i, before: values[i - 1], value: values[i] });
        }
        let knots = Self { degree, values };
        let (start, end) = knots.domain();
        if !(start < end) || !start.is_finite() {
            return Err(NurbsError::KnotOrder { index: degree, before: start, value: end });
        }
        Ok(knots)
    }

    /// Clamped knots over the given break points, each interior one simple.
    ///
    /// # Errors
    /// As [`Knots::new`].
    pub fn clamped(degree: usize, breaks: &[f64]) -> Result<Self, NurbsError> {
        let (Some(&first), Some(&last)) = (breaks.first(), breaks.last()) else {
            return Err(NurbsError::KnotCount { count: 0, least: 2 });
        };
        let mut values = vec![first; degree];
        values.extend_from_slice(breaks);
        values.extend(std::iter::repeat_n(last, degree));
        Self::new(degree, values)
    }

    /// Clamped uniform knots on [0, 1] for `count` control points.
    ///
    /// # Errors
    /// As [`Knots::new`]; `count` must be at least `degree + 1`.
    pub fn uniform(degree: usize, count: usize) -> Result<Self, NurbsError> {
        if count <= degree {
            return Err(NurbsError::PointCount { count, expected: degree + 1 });
        }
        let spans = count - degree;
        let breaks: Vec<f64> = (0..=spans).map(|i| i as f64 / spans as f64).collect();
        Self::clamped(degree, &breaks)
    }

    /// Degree of the basis.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// All knots, non-decreasing.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Number of control points: knots less degree less one.
    pub fn control_count(&self) -> usize {
        self.values.len() - self.degree - 1
    }

    /// Parameter interval.
    pub fn domain(&self) -> (f64, f64) {
        (self.values[self.degree], self.values[self.values.len() - self.degree - 1])
    }

    /// Index `i` with `knots[i] <= t < knots[i + 1]`, the last non-empty span at the end; `t` outside is clamped.
    pub fn span(&self, t: f64) -> usize {
        let (low, high) = (self.degree, self.control_count());
        let inner = &self.values[low + 1..high];
        let mut i = low + inner.partition_point(|&k| k <= t);
        // At the end of the domain with repeated interior knots the span may be empty: step back to a full one.
        while i > low && self.values[i] >= self.values[high] {
            i -= 1;
        }
        while i + 1 < high && self.values[i + 1] <= self.values[i] {
            i += 1;
        }
        i
    }

    /// Distinct knots inside the domain, its ends included.
    pub fn breaks(&self) -> Vec<f64> {
        let (start, end) = self.domain();
        let mut breaks = vec![start];
        for &k in &self.values[self.degree..=self.control_count()] {
            if k > breaks[breaks.len() - 1] && k <= end {
                breaks.push(k);
            }
        }
        breaks
    }

    /// How often `t` occurs, compared exactly.
    pub fn multiplicity(&self, t: f64) -> usize {
        self.values.iter().filter(|&&k| k == t).count()
    }

    /// Greville abscissae, one a control point: the mean of `degree` successive knots.
    pub fn greville(&self) -> Vec<f64> {
        (0..self.control_count())
            .map(|i| self.values[i + 1..=i + self.degree].iter().sum::<f64>() / self.degree as f64)
            .collect()
    }

    /// Basis functions and their derivatives up to `order` (at most 2) at `t`, by the triangular scheme of
    /// Piegl and Tiller, *The NURBS Book*, algorithm A2.3. Outside the domain the end polynomials are continued.
    pub fn basis(&self, t: f64, order: usize) -> Basis {
        let p = self.degree;
        let span = self.span(t);
        let k = &self.values;
        let mut out = Basis { first: span - p, values: [[0.0; MAX_DEGREE + 1]; 3] };
        // Values of degree p - 2, p - 1 and p are kept: derivatives are differences of the lower ones.
        let mut n = [0.0; MAX_DEGREE + 1];
        let mut lower = [[0.0; MAX_DEGREE + 1]; 2];
        n[0] = 1.0;
        for j in 1..=p {
            if order >= 2 && j + 1 == p {
                lower[1] = n;
            }
            if order >= 1 && j == p {
                lower[0] = n;
            }
            let mut saved = 0.0;
            for r in 0..j {
                let right = k[span + r + 1] - t;
                let left = t - k[span + 1 + r - j];
                let term = n[r] / (right + left);
                n[r] = saved + right * term;
                saved = left * term;
            }
            n[j] = saved;
        }
        out.values[0] = n;
        if order >= 1 {
            difference(&lower[0], k, span, p, &mut out.values[1]);
        }
        if order >= 2 && p >= 2 {
            let mut first = [0.0; MAX_DEGREE + 1];
            difference(&lower[1], k, span, p - 1, &mut first);
            difference(&first, k, span, p, &mut out.values[2]);
        }
        out
    }
}

/// Raises `lower` (functions of degree `p - 1`, or derivatives of them) to the derivative at degree `p`.
fn difference(
    lower: &[f64; MAX_DEGREE + 1],
    k: &[f64],
    span: usize,
    p: usize,
    out: &mut [f64; MAX_DEGREE + 1],
) {
    let scale = p as f64;
    for r in 0..=p {
        let mut d = 0.0;
        if r > 0 {
            d += lower[r - 1] / (k[span + r] - k[span + r - p]);
        }
        if r < p {
            d -= lower[r] / (k[span + r + 1] - k[span + r + 1 - p]);
        }
        out[r] = scale * d;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn spans_skip_empty_intervals_and_close_at_the_end() {
        let k = Knots::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0]).unwrap();
        assert_eq!([k.span(-1.0), k.span(0.0), k.span(1.0), k.span(2.0), k.span(9.0)], [2, 2, 4, 4, 4]);
        assert_eq!(k.breaks(), vec![0.0, 1.0, 2.0]);
    }

    #[test]
    fn refuses_bad_knots() {
        assert!(matches!(Knots::new(0, vec![0.0, 1.0]), Err(NurbsError::Degree { .. })));
        assert!(matches!(Knots::new(1, vec![0.0, 0.0, 1.0]), Err(NurbsError::KnotCount { .. })));
        assert!(matches!(Knots::new(1, vec![0.0, 0.0, -1.0, 1.0]), Err(NurbsError::KnotOrder { .. })));
        assert!(matches!(Knots::new(1, vec![0.0, 0.0, f64::NAN, 1.0]), Err(NurbsError::KnotOrder { .. })));
        assert!(matches!(Knots::new(1, vec![1.0; 4]), Err(NurbsError::KnotOrder { .. })));
    }

    proptest! {
        #[test]
        fn basis_is_a_partition_of_unity(
            degree in 1usize..=7,
            gaps in proptest::collection::vec(0.01f64..1.0, 1..9),
            at in 0.0f64..=1.0,
        ) {
            let mut breaks = vec![0.0];
            for g in gaps { breaks.push(breaks[breaks.len() - 1] + g); }
            let k = Knots::clamped(degree, &breaks).unwrap();
            let b = k.basis(at * breaks[breaks.len() - 1], 2);
            let sum = |o: usize| b.values[o][..=degree].iter().sum::<f64>();
            prop_assert!((sum(0) - 1.0).abs() < 1e-13);
            let size = b.values[2].iter().fold(1.0f64, |m, v| m.max(v.abs()));
            prop_assert!(sum(1).abs() < 1e-12 * size && sum(2).abs() < 1e-12 * size);
            prop_assert!(b.values[0].iter().all(|&v| v >= -1e-15));
        }
    }
}
