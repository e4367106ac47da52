//! Basis functions of one knot span, prepared for many evaluations.

use crate::lanes::{Lanes, Real};
use coolinggen_nurbs::{Knots, MAX_DEGREE, VectorSpace};

/// Basis values or slopes; the first `degree + 1` count.
pub(crate) type Weights = [f64; MAX_DEGREE + 1];

/// The non-vanishing basis functions of one span. The reciprocals of the knot differences are the same all over
/// the span: with them at hand an evaluation needs no division.
#[derive(Clone, Debug)]
pub(crate) struct Span {
    degree: usize,
    /// Index of the span in the knot vector.
    pub(crate) index: usize,
    /// Parameter interval.
    pub(crate) start: f64,
    pub(crate) end: f64,
    /// The `2 degree` knots around the span; `start` stands at `degree - 1`.
    knots: [f64; 2 * MAX_DEGREE],
    /// Reciprocal of the knot difference for step `j`, function `r` of the triangle at `j (j - 1) / 2 + r`.
    inverse: [f64; MAX_DEGREE * (MAX_DEGREE + 1) / 2],
}

impl Span {
    /// The span `index` of `knots`, which must not be empty.
    pub(crate) fn new(knots: &Knots, index: usize) -> Self {
        let mut span = Self {
            degree: 0,
            index,
            start: 0.0,
            end: 0.0,
            knots: [0.0; 2 * MAX_DEGREE],
            inverse: [0.0; MAX_DEGREE * (MAX_DEGREE + 1) / 2],
        };
        span.set(knots, index);
        span
    }

    /// Makes this the span `index` of `knots`.
    pub(crate) fn set(&mut self, knots: &Knots, index: usize) {
        let (p, values) = (knots.degree(), knots.values());
        (self.degree, self.index) = (p, index);
        (self.start, self.end) = (values[index], values[index + 1]);
        let around = &values[index + 1 - p..=index + p];
        match p {
            1 => self.fill::<1>(p, around),
            2 => self.fill::<2>(p, around),
            3 => self.fill::<3>(p, around),
            _ => self.fill::<MAX_DEGREE>(p, around),
        }
    }

    /// Takes over the `2 p` knots around the span. `P` is `p` or more: loops of constant length get unrolled.
    #[inline(always)]
    fn fill<const P: usize>(&mut self, p: usize, around: &[f64]) {
        let p = p.min(P);
        self.knots[..2 * p].copy_from_slice(around);
        for j in 1..=P.min(p) {
            for r in 0..P {
                if r < j {
                    self.inverse[j * (j - 1) / 2 + r] = 1.0 / (around[p + r] - around[p + r - j]);
                }
            }
        }
    }

    /// Makes this the span of `t`, if it is not.
    #[inline(always)]
    pub(crate) fn seek(&mut self, knots: &Knots, t: f64) {
        if !(self.start <= t && t <= self.end) {
            self.leave(knots, t);
        }
    }

    /// Whether all four lie in it.
    #[inline(always)]
    pub(crate) fn holds(&self, t: Lanes) -> bool {
        (Lanes::from(self.start) - t).max() <= 0.0 && (t - Lanes::from(self.end)).max() <= 0.0
    }

    /// Along a curve the span looked for is mostly the next one.
    fn leave(&mut self, knots: &Knots, t: f64) {
        let next = self.index + 1;
        let follows = next < knots.control_count() && t >= self.end && t < knots.values()[next + 1];
        let index = if follows { next } else { knots.span(t) };
        if index != self.index {
            self.set(knots, index);
        }
    }

    /// Index of the first control point concerned.
    pub(crate) fn first(&self) -> usize {
        self.index - self.degree
    }

    /// Basis values at `t`; the polynomials are continued outside the span.
    #[inline]
    pub(crate) fn values(&self, t: f64, out: &mut Weights) {
        match self.degree {
            1 => out[..2].copy_from_slice(&self.fixed_values::<2, f64>(t)),
            2 => out[..3].copy_from_slice(&self.fixed_values::<3, f64>(t)),
            3 => out[..4].copy_from_slice(&self.fixed_values::<4, f64>(t)),
            p => self.raise(t, p, out),
        }
    }

    /// Basis values and first derivatives at `t`.
    #[inline]
    pub(crate) fn slopes(&self, t: f64, values: &mut Weights, slopes: &mut Weights) {
        if self.degree == 3 {
            let (n, d) = self.fixed_slopes::<4, f64>(t);
            values[..4].copy_from_slice(&n);
            slopes[..4].copy_from_slice(&d);
        } else {
            self.raise_with_slopes(t, self.degree, values, slopes);
        }
    }

    /// The `N` basis values at `t` for degree `N - 1`, kept in registers.
    #[inline(always)]
    pub(crate) fn fixed_values<const N: usize, T: Real>(&self, t: T) -> [T; N] {
        let mut n = [T::from(0.0); N];
        n[0] = T::from(1.0);
        for j in 1..N {
            n = self.fixed_step(t, j, n);
        }
        n
    }

    #[inline(always)]
    pub(crate) fn fixed_slopes<const N: usize, T: Real>(&self, t: T) -> ([T; N], [T; N]) {
        let p = N - 1;
        let (mut n, mut d) = ([T::from(0.0); N], [T::from(0.0); N]);
        n[0] = T::from(1.0);
        for j in 1..p {
            n = self.fixed_step(t, j, n);
        }
        let mut before = T::from(0.0);
        for r in 0..p {
            let term = n[r] * T::from(self.inverse[p * (p - 1) / 2 + r]) * T::from(p as f64);
            d[r] = before - term;
            before = term;
        }
        d[p] = before;
        (self.fixed_step(t, p, n), d)
    }

    /// From degree `j - 1` to degree `j` of `N - 1`. The loop has a constant length, as the compiler needs it to
    /// unroll the triangle.
    #[inline(always)]
    fn fixed_step<const N: usize, T: Real>(&self, t: T, j: usize, n: [T; N]) -> [T; N] {
        let mut out = [T::from(0.0); N];
        let mut saved = T::from(0.0);
        for r in 0..N - 1 {
            if r < j {
                let term = n[r] * T::from(self.inverse[j * (j - 1) / 2 + r]);
                out[r] = saved + (T::from(self.knots[N - 1 + r]) - t) * term;
                saved = (t - T::from(self.knots[N - 1 + r - j])) * term;
            }
        }
        out[j] = saved;
        out
    }

    #[inline(always)]
    fn raise(&self, t: f64, p: usize, n: &mut [f64]) {
        n[0] = 1.0;
        for j in 1..=p {
            self.step(t, p, j, n);
        }
    }

    #[inline(always)]
    fn raise_with_slopes(&self, t: f64, p: usize, n: &mut [f64], d: &mut [f64]) {
        n[0] = 1.0;
        for j in 1..p {
            self.step(t, p, j, n);
        }
        let mut before = 0.0;
        for r in 0..p {
            let term = n[r] * self.inverse[p * (p - 1) / 2 + r] * p as f64;
            d[r] = before - term;
            before = term;
        }
        d[p] = before;
        self.step(t, p, p, n);
    }

    /// From degree `j - 1` to degree `j`.
    #[inline(always)]
    fn step(&self, t: f64, p: usize, j: usize, n: &mut [f64]) {
        let mut saved = 0.0;
        for r in 0..j {
            let term = n[r] * self.inverse[j * (j - 1) / 2 + r];
            n[r] = saved + (self.knots[p + r] - t) * term;
            saved = (t - self.knots[p + r - j]) * term;
        }
        n[j] = saved;
    }

    /// The point at `t` of the curve with these control points.
    #[inline]
    pub(crate) fn point<V: VectorSpace>(&self, t: f64, points: &[V]) -> V {
        let points = &points[self.first()..=self.index];
        match self.degree {
            1 => weighted_sum(&self.fixed_values::<2, f64>(t), points),
            2 => weighted_sum(&self.fixed_values::<3, f64>(t), points),
            3 => weighted_sum(&self.fixed_values::<4, f64>(t), points),
            _ => self.blend(t, points),
        }
    }

    /// The point at `t` of the curve whose control points for this span are the first of `points`.
    #[inline]
    pub(crate) fn blend<V: VectorSpace>(&self, t: f64, points: &[V]) -> V {
        let mut n = [0.0; MAX_DEGREE + 1];
        self.values(t, &mut n);
        weighted_sum(&n[..=self.degree], points)
    }

    /// The points at four parameters of two curves on the same knots, coordinate by coordinate.
    #[inline(always)]
    pub(crate) fn four<V: VectorSpace, W: VectorSpace, const D: usize, const E: usize>(
        &self,
        t: Lanes,
        a: &[V],
        b: &[W],
    ) -> ([Lanes; D], [Lanes; E]) {
        let (a, b) = (&a[self.first()..=self.index], &b[self.first()..=self.index]);
        match self.degree {
            2 => fixed_four(&self.fixed_values::<3, Lanes>(t), a, b),
            3 => fixed_four(&self.fixed_values::<4, Lanes>(t), a, b),
            _ => {
                let mut out = ([Lanes::from(0.0); D], [Lanes::from(0.0); E]);
                for (lane, &t) in t.0.iter().enumerate() {
                    let (a, b) = (self.blend(t, a), self.blend(t, b));
                    (0..D).for_each(|i| out.0[i].0[lane] = a.component(i));
                    (0..E).for_each(|i| out.1[i].0[lane] = b.component(i));
                }
                out
            }
        }
    }

    /// Point and derivative at `t` of the curve with these control points.
    #[inline]
    pub(crate) fn slope<V: VectorSpace>(&self, t: f64, points: &[V]) -> (V, V) {
        let points = &points[self.first()..=self.index];
        match self.degree {
            1 => self.fixed_slope::<2, V>(t, points),
            2 => self.fixed_slope::<3, V>(t, points),
            3 => self.fixed_slope::<4, V>(t, points),
            p => {
                let (mut n, mut d) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
                self.slopes(t, &mut n, &mut d);
                (weighted_sum(&n[..=p], points), weighted_sum(&d[..=p], points))
            }
        }
    }

    #[inline(always)]
    fn fixed_slope<const N: usize, V: VectorSpace>(&self, t: f64, points: &[V]) -> (V, V) {
        let (n, d) = self.fixed_slopes::<N, f64>(t);
        let (mut sum, mut slope) = (V::default(), V::default());
        for k in 0..N {
            (sum, slope) = (sum + points[k] * n[k], slope + points[k] * d[k]);
        }
        (sum, slope)
    }
}

#[inline(always)]
fn fixed_four<V: VectorSpace, W: VectorSpace, const N: usize, const D: usize, const E: usize>(
    n: &[Lanes; N],
    a: &[V],
    b: &[W],
) -> ([Lanes; D], [Lanes; E]) {
    let mut out = ([Lanes::from(0.0); D], [Lanes::from(0.0); E]);
    for k in 0..N {
        let (a, b) = (a[k], b[k]);
        (0..D).for_each(|i| out.0[i] = out.0[i] + n[k] * Lanes::from(a.component(i)));
        (0..E).for_each(|i| out.1[i] = out.1[i] + n[k] * Lanes::from(b.component(i)));
    }
    out
}

/// `sum weights[k] points[k]` over the weights.
#[inline(always)]
pub(crate) fn weighted_sum<V: VectorSpace>(weights: &[f64], points: &[V]) -> V {
    let mut sum = V::default();
    for (&w, &p) in weights.iter().zip(points) {
        sum = sum + p * w;
    }
    sum
}

/// Indices of the spans of `knots` that are not empty, in order.
pub(crate) fn full_spans(knots: &Knots) -> impl DoubleEndedIterator<Item = usize> + '_ {
    let values = knots.values();
    (knots.degree()..knots.control_count()).filter(move |&i| values[i] < values[i + 1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_span_gives_the_basis_of_its_knots(
            degree in 1usize..=9,
            gaps in proptest::collection::vec(0.0f64..1.0, 1..9),
            at in 0.0f64..1.0,
        ) {
            let mut breaks = vec![0.0];
            // Some gaps vanish: repeated knots.
            for g in gaps { breaks.push(breaks[breaks.len() - 1] + if g < 0.2 { 0.0 } else { g }); }
            breaks.push(breaks[breaks.len() - 1] + 0.5);
            let Ok(knots) = Knots::clamped(degree, &breaks) else { return Ok(()) };
            let t = at * breaks[breaks.len() - 1];
            let span = Span::new(&knots, knots.span(t));
            let (mut n, mut d) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
            span.slopes(t, &mut n, &mut d);
            let mut alone = [0.0; MAX_DEGREE + 1];
            span.values(t, &mut alone);
            prop_assert_eq!(n, alone);
            let basis = knots.basis(t, 1);
            prop_assert_eq!(span.first(), basis.first);
            let size = basis.values[1].iter().fold(1.0f64, |m, v| m.max(v.abs()));
            for k in 0..=degree {
                prop_assert!((n[k] - basis.values[0][k]).abs() < 1e-14);
                prop_assert!((d[k] - basis.values[1][k]).abs() < 1e-13 * size);
            }
        }
    }
}
