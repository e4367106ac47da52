//! A control net seen with an outer and an inner parameter, and sums over rectangles of it.

use super::Sums;
use super::pairs::{Pair, PairSums, Row};
use crate::gauss;
use crate::lanes::Lanes;
use crate::span::{Span, full_spans, weighted_sum};
use coolinggen_nurbs::{Homogeneous, Knots, MAX_DEGREE, Surface, VectorSpace};
use glam::DVec3;

/// Control points that make a point of space with its derivatives.
pub(super) trait Frame: VectorSpace {
    /// Point and first derivatives in space, from those of the control points' space.
    fn frame(self, a: Self, b: Self) -> [DVec3; 3];
}

impl Frame for DVec3 {
    #[inline(always)]
    fn frame(self, a: Self, b: Self) -> [DVec3; 3] {
        [self, a, b]
    }
}

impl Frame for Homogeneous<DVec3> {
    #[inline(always)]
    fn frame(self, a: Self, b: Self) -> [DVec3; 3] {
        let inverse = 1.0 / self.weight;
        let point = self.weighted * inverse;
        let slope = |d: Self| (d.weighted - point * d.weight) * inverse;
        [point, slope(a), slope(b)]
    }
}

/// The part of the parameter plane with `a` from `start` to `end` and `b` between two knot lines; its sign turns
/// with each pair that is not in order.
pub(super) struct Rectangle {
    pub(super) start: f64,
    pub(super) end: f64,
    /// Ordinals of the knot lines.
    pub(super) lower: usize,
    pub(super) upper: usize,
}

/// A control net with `a` the parameter of the axis `outer` and `b` the other.
pub(super) struct Net<'s, V> {
    points: &'s [V],
    /// Distance in `points` from one control point to the next along each axis.
    strides: [usize; 2],
    pub(super) knots: [&'s Knots; 2],
    pub(super) outer: usize,
    /// Gauss points a span along each axis.
    pub(super) order: [usize; 2],
    /// Distinct knots in `b`, and the index of the span after each but the last.
    lines: Vec<f64>,
    spans: Vec<usize>,
    /// For each Gauss point in `b`: weight, basis values, basis slopes. Filled when first needed.
    table: Vec<f64>,
    rows: [Vec<V>; 2],
}

impl<'s, V: Frame> Net<'s, V> {
    pub(super) fn new(surface: &'s Surface<V>, outer: usize, order: [usize; 2]) -> Self {
        let knots = [surface.knots_u(), surface.knots_v()];
        let inner = knots[1 - outer];
        let (lines, spans) = (inner.breaks(), full_spans(inner).collect());
        let (strides, points) = ([surface.counts().1, 1], surface.points());
        let rows = [0, 1].map(|_| vec![V::default(); inner.control_count()]);
        Self { points, strides, knots, outer, order, lines, spans, table: Vec::new(), rows }
    }

    /// Ordinal of a knot line.
    pub(super) fn line(&self, value: f64) -> usize {
        self.lines.partition_point(|&k| k < value)
    }

    /// Combines over `a` the control points from `first_a` in the row `b`: value and derivative in `a`.
    #[inline(always)]
    pub(super) fn across(&self, first_a: usize, b: usize, values: &[f64], slopes: &[f64]) -> (V, V) {
        let (step, mut at) = (self.strides[self.outer], b * self.strides[1 - self.outer]);
        at += first_a * step;
        let (mut value, mut slope) = (V::default(), V::default());
        for (&n, &d) in values.iter().zip(slopes) {
            let point = self.points[at];
            value = value + point * n;
            slope = slope + point * d;
            at += step;
        }
        (value, slope)
    }

    /// Adds a quadrature point given by value and derivatives in `a` and `b`.
    #[inline(always)]
    pub(super) fn add(&self, sums: &mut Sums, weight: f64, value: V, a: V, b: V) {
        let [point, a, b] = value.frame(a, b);
        let normal = if self.outer == 0 { a.cross(b) } else { b.cross(a) };
        sums.add(weight, point, normal);
    }

    /// Adds the integral over a rectangle.
    pub(super) fn rectangle(&mut self, rectangle: &Rectangle, sums: &mut Sums) {
        let &Rectangle { start, end, lower, upper } = rectangle;
        let sign = if (start <= end) == (lower <= upper) { 1.0 } else { -1.0 };
        let (low, high) = (start.min(end), start.max(end));
        let (lower, upper) = (lower.min(upper), lower.max(upper));
        if low == high || lower == upper {
            return;
        }
        self.tabulate();
        let knots = self.knots[self.outer];
        let (domain_start, domain_end) = knots.domain();
        let (mut n, mut d) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
        let p = knots.degree();
        let mut span = Span::new(knots, knots.span(low));
        for index in full_spans(knots) {
            span.set(knots, index);
            // Outside the domain the end polynomials go on.
            let from = if span.start == domain_start { low } else { low.max(span.start) };
            let to = if span.end == domain_end { high } else { high.min(span.end) };
            if !(from < to) {
                continue;
            }
            for &(s, w) in gauss::rule(self.order[self.outer]) {
                span.slopes(from + (to - from) * s, &mut n, &mut d);
                self.fill_rows(span.first(), &n[..=p], &d[..=p], lower, upper);
                self.row(w * (to - from) * sign, lower, upper, sums);
            }
        }
    }

    /// Curves of points and of derivatives in `a`, at one `a`, for the spans between two knot lines.
    fn fill_rows(&mut self, first: usize, n: &[f64], d: &[f64], lower: usize, upper: usize) {
        let degree = self.knots[1 - self.outer].degree();
        for b in self.spans[lower] - degree..=self.spans[upper - 1] {
            let (value, slope) = self.across(first, b, n, d);
            (self.rows[0][b], self.rows[1][b]) = (value, slope);
        }
    }

    /// Adds the integral over `b` between two knot lines along the rows at hand.
    fn row(&self, weight: f64, lower: usize, upper: usize, sums: &mut Sums) {
        match self.knots[1 - self.outer].degree() {
            1 => self.row_of_degree(1, weight, lower, upper, sums),
            2 => self.row_of_degree(2, weight, lower, upper, sums),
            3 => self.row_of_degree(3, weight, lower, upper, sums),
            5 => self.row_of_degree(5, weight, lower, upper, sums),
            degree => self.row_of_degree(degree, weight, lower, upper, sums),
        }
    }

    #[inline(always)]
    fn row_of_degree(&self, q: usize, weight: f64, lower: usize, upper: usize, sums: &mut Sums) {
        let stride = 2 * q + 3;
        let points = self.order[1 - self.outer];
        // Sums of their own: the compiler keeps them in registers.
        let (mut row, mut pairs) = (Sums::default(), PairSums::zero());
        for k in lower..upper {
            let first = self.spans[k] - q;
            let (values, slopes) = (&self.rows[0][first..=first + q], &self.rows[1][first..=first + q]);
            if q == 3
                && points.is_multiple_of(2)
                && let Some(control) = Row::new(values, slopes)
            {
                let table = &self.table[k * points * stride..(k + 1) * points * stride];
                for nodes in table.chunks_exact(2 * stride) {
                    let (one, two) = nodes.split_at(stride);
                    let (mut n, mut d) = ([Pair::from(0.0); 4], [Pair::from(0.0); 4]);
                    for k in 0..4 {
                        n[k] = Lanes([one[k + 1], two[k + 1]]);
                        d[k] = Lanes([one[k + 5], two[k + 5]]);
                    }
                    pairs.add(&control, Lanes([one[0] * weight, two[0] * weight]), &n, &d);
                }
                continue;
            }
            for node in self.table[k * points * stride..(k + 1) * points * stride].chunks_exact(stride) {
                let (n, d) = (&node[1..q + 2], &node[q + 2..]);
                let value = weighted_sum(n, values);
                let along_a = weighted_sum(n, slopes);
                let along_b = weighted_sum(d, values);
                self.add(&mut row, node[0] * weight, value, along_a, along_b);
            }
        }
        row += pairs.total(self.sense());
        *sums += row;
    }

    /// 1 where the derivatives in `a` and `b` come in the order of the surface's parameters, else -1.
    pub(super) fn sense(&self) -> f64 {
        if self.outer == 0 { 1.0 } else { -1.0 }
    }

    fn tabulate(&mut self) {
        if !self.table.is_empty() {
            return;
        }
        let knots = self.knots[1 - self.outer];
        let q = knots.degree();
        let (mut n, mut d) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
        let mut span = Span::new(knots, knots.span(self.lines[0]));
        for &index in &self.spans {
            span.set(knots, index);
            for &(s, w) in gauss::rule(self.order[1 - self.outer]) {
                span.slopes(span.start + (span.end - span.start) * s, &mut n, &mut d);
                self.table.push(w * (span.end - span.start));
                self.table.extend_from_slice(&n[..=q]);
                self.table.extend_from_slice(&d[..=q]);
            }
        }
    }
}
