//! Knot vectors and B-spline basis functions.

use crate::error::NurbsError;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Highest degree that evaluation supports; basis arrays of this size live on the stack. A quintic after
/// a cubic times a function of degree 9 just fits.
pub const MAX_DEGREE: usize = 24;

/// A knot vector with its degree: non-decreasing knots, clamped or not.
///
/// The curve it carries is defined on `[knots[degree], knots[len - degree - 1]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Knots {
    degree: usize,
    values: Vec<f64>,
    last: LastSpan,
}

/// The span found last, where the next search begins: mostly it ends there, too. No result depends on it.
#[derive(Debug, Default)]
struct LastSpan(AtomicUsize);

impl Clone for LastSpan {
    fn clone(&self) -> Self {
        Self(AtomicUsize::new(self.0.load(Ordering::Relaxed)))
    }
}

impl PartialEq for LastSpan {
    fn eq(&self, _: &Self) -> bool {
        true
    }
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
        let knots = Self { degree, values, last: LastSpan::default() };
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
        let k = &self.values[..=high];
        let last = self.last.0.load(Ordering::Relaxed);
        if (low..high).contains(&last) && k[last] <= t && t < k[last + 1] {
            return last;
        }
        let found = self.searched_span(t);
        self.last.0.store(found, Ordering::Relaxed);
        found
    }

    /// [`Knots::span`] by bisection.
    fn searched_span(&self, t: f64) -> usize {
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
        let (p, span) = (self.degree, self.span(t));
        let mut out = Basis { first: span - p, values: [[0.0; MAX_DEGREE + 1]; 3] };
        // The usual degrees have loops of known length: twice as fast.
        match p {
            1 => copy_basis(&self.basis_on::<2>(span, p, t), order, &mut out),
            2 => copy_basis(&self.basis_on::<3>(span, p, t), order, &mut out),
            3 => copy_basis(&self.basis_on::<4>(span, p, t), order, &mut out),
            5 => copy_basis(&self.basis_on::<6>(span, p, t), order, &mut out),
            _ => copy_basis(&self.basis_on::<{ MAX_DEGREE + 1 }>(span, p, t), order, &mut out),
        }
        out
    }

    /// The first control point concerned and the derivatives of `order` (any, zero above the degree) of the basis
    /// functions at `t`, by differences of those of lower degree as in [`Knots::basis`].
    pub(crate) fn derivative_row(&self, t: f64, order: usize) -> (usize, [f64; MAX_DEGREE + 1]) {
        let (p, span) = (self.degree, self.span(t));
        if order > p {
            return (span - p, [0.0; MAX_DEGREE + 1]);
        }
        let k = &self.values;
        let mut n = [0.0; MAX_DEGREE + 1];
        n[0] = 1.0;
        for j in 1..=p {
            let mut saved = 0.0;
            let derive = j > p - order;
            for r in 0..j {
                let (low, high) = (k[span + 1 + r - j], k[span + 1 + r]);
                let term = n[r] / (high - low);
                if derive {
                    n[r] = saved - j as f64 * term;
                    saved = j as f64 * term;
                } else {
                    n[r] = saved + (high - t) * term;
                    saved = (t - low) * term;
                }
            }
            n[j] = saved;
        }
        (span - p, n)
    }

    /// Clamped knots for `count` control points that give every span its share of increasing `parameters` (*The
    /// NURBS Book*, equations 9.68 and 9.69): least-squares fits on them are well posed, unless `count` comes close to the
    /// number of data.
    ///
    /// # Errors
    /// [`NurbsError::PointCount`] unless `degree < count <= parameters.len()`; as [`Knots::new`].
    pub fn for_fit(degree: usize, parameters: &[f64], count: usize) -> Result<Self, NurbsError> {
        let n = parameters.len();
        if count <= degree || count > n {
            return Err(NurbsError::PointCount { count, expected: n.max(degree + 1) });
        }
        let spans = count - degree;
        let mut breaks = vec![parameters[0]];
        for j in 1..spans {
            let at = j as f64 * n as f64 / spans as f64;
            let (i, alpha) = (at.floor() as usize, at.fract());
            breaks.push((1.0 - alpha) * parameters[i - 1] + alpha * parameters[i.min(n - 1)]);
        }
        breaks.push(parameters[n - 1]);
        Self::clamped(degree, &breaks)
    }

    /// Basis functions with first and second derivatives on the span with index `span`; `degree < N`, and where
    /// it is known to be `N - 1` the compiler unrolls.
    #[inline(always)]
    pub(crate) fn basis_on<const N: usize>(&self, span: usize, degree: usize, t: f64) -> [[f64; N]; 3] {
        let p = if N <= MAX_DEGREE { N - 1 } else { degree };
        // The span is from `k[p]` to `k[p + 1]`.
        let k = &self.values[span - p..span + p + 1];
        if N == 4 {
            return cubic_basis(k, t).map(|row| std::array::from_fn(|i| row[i % 4]));
        }
        let mut n = [0.0; N];
        // Functions of degree p - 1 and p - 2, and the inverse widths of the supports of the degrees they belong
        // to: derivatives are differences of them.
        let (mut lower, mut lowest) = ([0.0; N], [0.0; N]);
        let (mut inverse, mut inverse_lower) = ([0.0; N], [0.0; N]);
        n[0] = 1.0;
        for j in 1..=p {
            lowest = lower;
            lower = n;
            inverse_lower = inverse;
            let mut saved = 0.0;
            for r in 0..j {
                let (low, high) = (k[p + 1 + r - j], k[p + 1 + r]);
                inverse[r] = 1.0 / (high - low);
                let term = n[r] * inverse[r];
                n[r] = saved + (high - t) * term;
                saved = (t - low) * term;
            }
            n[j] = saved;
        }
        let first = difference(&lower, &inverse, p);
        let second = if p >= 2 {
            difference(&difference(&lowest, &inverse_lower, p - 1), &inverse, p)
        } else {
            [0.0; N]
        };
        [n, first, second]
    }
}

fn copy_basis<const N: usize>(values: &[[f64; N]; 3], order: usize, out: &mut Basis) {
    for (to, from) in out.values.iter_mut().zip(values).take(order + 1) {
        to[..N].copy_from_slice(from);
    }
}

/// [`Knots::basis_on`] for cubics, written out: half the work of the loops, and bit for bit their results.
#[inline(always)]
fn cubic_basis(k: &[f64], t: f64) -> [[f64; 4]; 3] {
    let &[_, k1, k2, k3, k4, k5, k6] = k else { return [[0.0; 4]; 3] };
    let (right1, right2, right3) = (k4 - t, k5 - t, k6 - t);
    let (left1, left2, left3) = (t - k3, t - k2, t - k1);
    // Degree 1, 2 and 3, each by way of its predecessor over the widths of the supports.
    let inverse = 1.0 / (k4 - k3);
    let a = [right1 * inverse, left1 * inverse];
    let inverse2 = [1.0 / (k4 - k2), 1.0 / (k5 - k3)];
    let term = [a[0] * inverse2[0], a[1] * inverse2[1]];
    let b = [right1 * term[0], left2 * term[0] + right2 * term[1], left1 * term[1]];
    let inverse3 = [1.0 / (k4 - k1), 1.0 / (k5 - k2), 1.0 / (k6 - k3)];
    let term = [b[0] * inverse3[0], b[1] * inverse3[1], b[2] * inverse3[2]];
    let n = [
        right1 * term[0],
        left3 * term[0] + right2 * term[1],
        left2 * term[1] + right3 * term[2],
        left1 * term[2],
    ];
    let rise = |lower: [f64; 3]| {
        let [f, g, h] = [0, 1, 2].map(|i| 3.0 * lower[i] * inverse3[i]);
        [0.0 - f, f - g, g - h, h]
    };
    let [f, g] = [0, 1].map(|i| 2.0 * a[i] * inverse2[i]);
    [n, rise(b), rise([0.0 - f, f - g, g])]
}

/// Raises `lower` (functions of degree `p - 1`, or derivatives of them) to the derivative at degree `p`, given the
/// inverse widths of their supports.
#[inline(always)]
fn difference<const N: usize>(lower: &[f64; N], inverse: &[f64; N], p: usize) -> [f64; N] {
    let mut out = [0.0; N];
    let mut saved = 0.0;
    for r in 0..p {
        let slope = p as f64 * lower[r] * inverse[r];
        out[r] = saved - slope;
        saved = slope;
    }
    out[p] = saved;
    out
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
