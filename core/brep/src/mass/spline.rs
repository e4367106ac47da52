//! B-spline surfaces, rational too.
//!
//! With the integral over `b` (one parameter) inside the one over `a` (the other), a loop contributes
//! `-+ integral of F(a, b) da` along itself, `F` the integral over `b` from a fixed line. Of that, the part up to
//! the knot line nearest to the loop is a sum over rectangles, done with tabulated basis functions; what is left
//! between knot line and loop is a strip within one row of spans. Small loops (`cells`) and whole ruled faces (`ruled`)
//! take shorter ways.

use super::net::{Frame, Net, Rectangle};
use super::pairs::{Pair, PairSums, Row};
use super::{Sums, cells, ruled};
use crate::boundary::{Path, cuts, walk};
use crate::gauss::{self, MAX_POINTS};
use crate::lanes::Lanes;
use crate::model::Loop;
use crate::span::{Span, weighted_sum};
use coolinggen_nurbs::{MAX_DEGREE, RationalSurface, Surface};
use glam::{DVec2, DVec3};

/// What one loop adds to the sums over a part of `surface`.
pub(super) fn integrate(surface: &Surface<DVec3>, bound: &Loop) -> Sums {
    if let Some(sums) = ruled::integrate(surface, bound).or_else(|| cells::integrate(surface, bound)) {
        return sums;
    }
    // X (X . n) has degree 4 p - 1 in each parameter; six points at least, for the root in the area.
    let points = |degree: usize| (2 * degree).max(6);
    let (p, q) = (surface.knots_u().degree(), surface.knots_v().degree());
    sum_over_loop(surface, bound, [points(p), points(q)])
}

/// Sums over the part of `surface` inside `loops`: rules of growing order until two agree.
pub(super) fn integrate_rational(surface: &RationalSurface<DVec3>, loops: &[Loop]) -> Sums {
    let h = surface.homogeneous();
    let mut small = Sums::default();
    let mut large = Vec::with_capacity(loops.len());
    for bound in loops {
        match cells::integrate(h, bound) {
            Some(sums) => small += sums,
            None => large.push(bound),
        }
    }
    let of_order = |n: usize| super::total(large.iter().map(|bound| sum_over_loop(h, bound, [n, n])));
    let mut last = of_order(10);
    for n in [14, 20, 28, MAX_POINTS] {
        let next = of_order(n);
        // What the moments would be if nothing cancelled.
        let size = next.position.length() + next.area.abs().powf(1.5);
        let moved = (next.flux - last.flux).abs().max((next.position - last.position).length());
        let done = moved <= 1e-13 * size && (next.area - last.area).abs() <= 1e-13 * next.area.abs();
        last = next;
        if done {
            break;
        }
    }
    last += small;
    last
}

fn sum_over_loop<V: Frame>(surface: &Surface<V>, bound: &Loop, order: [usize; 2]) -> Sums {
    let outer = cheaper_outer_axis(surface, bound);
    let mut net = Net::new(surface, outer, order);
    let spans = net.knots.map(|knots| Span::new(knots, knots.span(knots.domain().0)));
    let mut sweep = Sweep { net: &mut net, spans, open: None, base: None, sums: Sums::default() };
    let mut pieces = Vec::new();
    walk(bound, |path| {
        cuts(path, [Some(surface.knots_u()), Some(surface.knots_v())], &mut pieces);
        for piece in pieces.windows(2) {
            sweep.piece(path, piece[0], piece[1]);
        }
    });
    sweep.close();
    // Green's theorem has a sign for each axis.
    sweep.sums.scaled(if outer == 0 { -1.0 } else { 1.0 })
}

/// The outer axis along which the loop makes less work: borders on which the outer parameter is constant make
/// none, and every other piece makes rows as long as the loop is wide in the inner parameter.
fn cheaper_outer_axis<V: Frame>(surface: &Surface<V>, lp: &Loop) -> usize {
    let knots = [surface.knots_u(), surface.knots_v()];
    let ordinal = |axis: usize, t: f64| knots[axis].values().partition_point(|&k| k <= t) as f64;
    let mut work = [0.0; 2];
    let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for coedge in &lp.coedges {
        let points = coedge.pcurve.points();
        let mut crossed = [0.0; 2];
        for axis in 0..2 {
            let low = points.iter().fold(f64::INFINITY, |m, p| m.min(p[axis]));
            let high = points.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p[axis]));
            let spans = [ordinal(axis, low), ordinal(axis, high)];
            range[axis] = [range[axis][0].min(spans[0]), range[axis][1].max(spans[1])];
            crossed[axis] = if low == high { -1.0 } else { spans[1] - spans[0] };
        }
        for axis in 0..2 {
            if crossed[axis] >= 0.0 {
                work[axis] += crossed[0].max(0.0) + crossed[1].max(0.0) + 1.0;
            }
        }
    }
    let width = |axis: usize| range[axis][1] - range[axis][0] + 1.0;
    usize::from(work[1] * width(0) < work[0] * width(1))
}

/// A walk along one loop.
struct Sweep<'n, 's, V> {
    net: &'n mut Net<'s, V>,
    /// The spans in u and v that the present piece crosses.
    spans: [Span; 2],
    /// Start in `a` and upper knot line of the rectangle that the pieces so far stand on.
    open: Option<(Rectangle, f64)>,
    /// Knot line from which `F` counts.
    base: Option<usize>,
    sums: Sums,
}

impl<V: Frame> Sweep<'_, '_, V> {
    /// Adds the piece of `path` from `start` to `end`, which crosses no knot line.
    fn piece(&mut self, path: &Path<'_>, start: f64, end: f64) {
        let outer = self.net.outer;
        let inner = 1 - outer;
        let (from, to) = (path.point(start), path.point(end));
        let middle = path.point(0.5 * (start + end));
        let even = matches!(path, Path::Line { .. });
        if even && from[outer] == to[outer] {
            return;
        }
        for axis in 0..2 {
            self.spans[axis].seek(self.net.knots[axis], middle[axis]);
        }
        let (below, above) = (self.spans[inner].start, self.spans[inner].end);
        let line = if middle[inner] - below <= above - middle[inner] { below } else { above };
        let upper = self.net.line(line);
        let lower = *self.base.get_or_insert(upper);
        let domain = self.net.knots[outer].domain();
        let tolerance = 1e-14 * (domain.1 - domain.0);
        // A new knot line ends the rectangle under the last one.
        match &mut self.open {
            Some((rectangle, at)) if rectangle.upper == upper && (*at - from[outer]).abs() <= tolerance => {
                rectangle.end = to[outer];
                *at = to[outer];
            }
            _ => {
                self.close();
                let rectangle = Rectangle { start: from[outer], end: to[outer], lower, upper };
                self.open = Some((rectangle, to[outer]));
            }
        }
        if even && from[inner] == line && to[inner] == line {
            return;
        }
        self.strip(path, start, end, line);
    }

    /// Adds the integral between the knot line and the path.
    fn strip(&mut self, path: &Path<'_>, start: f64, end: f64, line: f64) {
        let (outer, inner) = (self.net.outer, 1 - self.net.outer);
        let mut span_a = self.spans[outer].clone();
        let span_b = &self.spans[inner];
        let order = self.net.order;
        let (from, to) = (path.point(start), path.point(end));
        let n = match path {
            Path::Line { .. } if from[inner] == to[inner] => order[outer],
            // The inner integral adds the degree in `b`.
            Path::Line { .. } => order[outer] + order[inner],
            Path::Spline { .. } => {
                // The degree along a cubic path is 71, but little of it shows where the path is short, or nearly
                // straight, against the span.
                let middle = path.point(0.5 * (start + end));
                let ratio = |s: &Span, way: f64| way.abs() / (s.end - s.start);
                let extent = |way: DVec2| ratio(&span_a, way[outer]).max(ratio(span_b, way[inner]));
                let bend = extent(0.5 * (from + to) - middle);
                if extent(middle - from).max(extent(to - middle)) < 0.05 {
                    order[outer].max(order[inner]) + 2
                } else {
                    order[outer] + order[inner] + if bend < 0.01 { 0 } else { 12 }
                }
            }
        };
        let (mut na, mut da) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
        let (mut nb, mut db) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
        let mut rows = [[V::default(); MAX_DEGREE + 1]; 2];
        let mut pairs = PairSums::zero();
        let (p, q) = (self.net.knots[outer].degree(), self.net.knots[inner].degree());
        for &(s, w) in gauss::rule(n) {
            let (at, slope) = path.slope(start + (end - start) * s);
            let height = at[inner] - line;
            if height == 0.0 {
                continue;
            }
            let weight = w * (end - start) * slope[outer] * height;
            // Should a knot have been missed, it shows as little as it can.
            span_a.seek(self.net.knots[outer], at[outer]);
            span_a.slopes(at[outer], &mut na, &mut da);
            for k in 0..=q {
                let b = span_b.first() + k;
                (rows[0][k], rows[1][k]) = self.net.across(span_a.first(), b, &na[..=p], &da[..=p]);
            }
            let rule = gauss::rule(order[inner]);
            if q == 3
                && rule.len().is_multiple_of(2)
                && let Some(control) = Row::new(&rows[0][..=q], &rows[1][..=q])
            {
                for nodes in rule.chunks_exact(2) {
                    let b = Lanes([line + height * nodes[0].0, line + height * nodes[1].0]);
                    let (n, d) = span_b.fixed_slopes::<4, Pair>(b);
                    pairs.add(&control, Lanes([weight * nodes[0].1, weight * nodes[1].1]), &n, &d);
                }
                continue;
            }
            for &(s, w) in rule {
                span_b.slopes(line + height * s, &mut nb, &mut db);
                let value = weighted_sum(&nb[..=q], &rows[0]);
                let along_a = weighted_sum(&nb[..=q], &rows[1]);
                let along_b = weighted_sum(&db[..=q], &rows[0]);
                self.net.add(&mut self.sums, weight * w, value, along_a, along_b);
            }
        }
        self.sums += pairs.total(self.net.sense());
    }

    /// Adds the rectangle under the pieces so far.
    fn close(&mut self) {
        if let Some((rectangle, _)) = self.open.take() {
            self.net.rectangle(&rectangle, &mut self.sums);
        }
    }
}
