//! The boundary of a face in its parameter plane, as a walk over polynomial pieces.

use crate::cursor::Cursor;
use crate::model::{Coedge, Loop};
use crate::span::full_spans;
use coolinggen_nurbs::{Curve, Knots};
use glam::DVec2;

/// A polynomial piece of a loop, run through as the loop runs, over `s` in [0, 1].
#[derive(Clone, Debug)]
pub(crate) enum Path<'a> {
    /// A straight segment run through evenly.
    Line { from: DVec2, to: DVec2 },
    /// One span of a parameter curve, from `start` to `end`; backwards where `start > end`.
    Spline { cursor: &'a Cursor<'a, DVec2>, start: f64, end: f64 },
}

impl Path<'_> {
    /// The point at `s`.
    pub(crate) fn point(&self, s: f64) -> DVec2 {
        match *self {
            Self::Line { from, to } => from.lerp(to, s),
            Self::Spline { cursor, start, end } => cursor.point_in_span(start + (end - start) * s),
        }
    }

    /// A rectangle that holds the piece.
    pub(crate) fn hull(&self) -> (DVec2, DVec2) {
        match *self {
            Self::Line { from, to } => (from.min(to), from.max(to)),
            Self::Spline { cursor, .. } => {
                let points = &cursor.curve().points()[cursor.span.first()..=cursor.span.index];
                points.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)))
            }
        }
    }

    /// Point and derivative at `s`.
    pub(crate) fn slope(&self, s: f64) -> (DVec2, DVec2) {
        match *self {
            Self::Line { from, to } => (from.lerp(to, s), to - from),
            Self::Spline { cursor, start, end } => {
                let (p, d) = cursor.slope_in_span(start + (end - start) * s);
                (p, d * (end - start))
            }
        }
    }
}

/// Visits the pieces of `lp` in order. A jump between two coedges, as at the pole of a surface where a whole
/// parameter line is one point, is visited as a straight line.
pub(crate) fn walk(lp: &Loop, mut visit: impl FnMut(&Path<'_>)) {
    let count = lp.coedges.len();
    for (i, coedge) in lp.coedges.iter().enumerate() {
        walk_coedge(coedge, &mut visit);
        let (from, to) = (coedge.parameter_at(1.0), lp.coedges[(i + 1) % count].parameter_at(0.0));
        // Less than rounding leaves no trace in any integral.
        if (to - from).abs().max_element() > 1e-14 * (1.0 + to.abs().max_element()) {
            visit(&Path::Line { from, to });
        }
    }
}

fn walk_coedge(coedge: &Coedge, visit: &mut impl FnMut(&Path<'_>)) {
    let pcurve = &coedge.pcurve;
    if is_even_line(pcurve) {
        visit(&Path::Line { from: coedge.parameter_at(0.0), to: coedge.parameter_at(1.0) });
        return;
    }
    let mut cursor = Cursor::new(pcurve);
    let mut step = |index: usize| {
        cursor.enter(index);
        let (start, end) = (cursor.span.start, cursor.span.end);
        let (start, end) = if coedge.forward { (start, end) } else { (end, start) };
        if pcurve.degree() == 1 {
            visit(&Path::Line { from: cursor.point_in_span(start), to: cursor.point_in_span(end) });
        } else {
            visit(&Path::Spline { cursor: &cursor, start, end });
        }
    };
    if coedge.forward {
        full_spans(pcurve.knots()).for_each(&mut step);
    } else {
        full_spans(pcurve.knots()).rev().for_each(&mut step);
    }
}

/// Whether the curve is a straight segment run through evenly, whatever its degree and knots: its control points
/// then stand on the segment at the Greville abscissae.
pub(crate) fn is_even_line(curve: &Curve<DVec2>) -> bool {
    let (points, knots) = (curve.points(), curve.knots());
    let (first, last) = (points[0], points[points.len() - 1]);
    let p = knots.degree();
    let greville = |i: usize| knots.values()[i + 1..=i + p].iter().sum::<f64>() / p as f64;
    let (start, end) = (greville(0), greville(points.len() - 1));
    let tolerance = 4e-15 * (first.abs().max_element() + last.abs().max_element());
    // From the middle outwards a curved one is found out at once.
    let even = |i: usize| {
        let line = first.lerp(last, (greville(i) - start) / (end - start));
        (points[i] - line).abs().max_element() <= tolerance
    };
    even(points.len() / 2) && (0..points.len()).all(even)
}

/// Parameters of `path` between which it crosses no interior knot of `knots[0]` in u or of `knots[1]` in v, 0 and 1
/// included, into `out`. What is missed are wiggles across a knot and back within an eighth of the piece.
pub(crate) fn cuts(path: &Path<'_>, knots: [Option<&Knots>; 2], out: &mut Vec<f64>) {
    out.clear();
    out.push(0.0);
    let (low, high) = path.hull();
    let inner = [0, 1].map(|axis| knots[axis].map_or(&[][..], |k| inner_knots(k, low[axis], high[axis])));
    if inner.iter().any(|k| !k.is_empty()) {
        // Between two stations both coordinates rise or fall all the way.
        let (stations, count) = stations(path);
        for pair in stations[..count].windows(2) {
            let ends = [path.point(pair[0]), path.point(pair[1])];
            for axis in 0..2 {
                let (a, b) = (ends[0][axis], ends[1][axis]);
                let (low, high) = (a.min(b), a.max(b));
                for &k in inner[axis].iter().filter(|&&k| k > low && k <= high) {
                    let value = |s: f64| path.point(s)[axis] - k;
                    out.push(root(value, [pair[0], pair[1]], [a - k, b - k]));
                }
            }
        }
    }
    out.push(1.0);
    out.sort_by(f64::total_cmp);
    // Slivers would cost as much as whole pieces.
    out.dedup_by(|later, earlier| *later - *earlier < 1e-13);
    if let Some(last) = out.last_mut() {
        *last = 1.0;
    }
}

/// The knots strictly inside the domain and between `low` and `high`.
fn inner_knots(knots: &Knots, low: f64, high: f64) -> &[f64] {
    let (start, end) = knots.domain();
    let values = knots.values();
    let from = values.partition_point(|&k| k <= low.max(start));
    let to = values.partition_point(|&k| k < high.min(end));
    &values[from..to.max(from)]
}

/// Eighths in which turning points are looked for; a cubic piece seldom has more than one in each coordinate.
const EIGHTHS: usize = 8;

/// Ends of `path`, and where a coordinate turns, in order, with their number.
fn stations(path: &Path<'_>) -> ([f64; 2 * EIGHTHS + 2], usize) {
    let mut out = [0.0; 2 * EIGHTHS + 2];
    let mut count = 1;
    if let Path::Spline { .. } = path {
        let mut before = path.slope(0.0).1;
        for i in 0..EIGHTHS {
            let s = [i, i + 1].map(|i| i as f64 / EIGHTHS as f64);
            let after = path.slope(s[1]).1;
            for axis in 0..2 {
                if (before[axis] > 0.0) != (after[axis] > 0.0) {
                    out[count] = root(|s| path.slope(s).1[axis], s, [before[axis], after[axis]]);
                    count += 1;
                }
            }
            before = after;
        }
    }
    out[count] = 1.0;
    out[..=count].sort_by(f64::total_cmp);
    (out, count + 1)
}

/// Root of `f`, which has the values `y` of opposite signs (or zero) at `s`: false position, Illinois variant.
fn root(f: impl Fn(f64) -> f64, mut s: [f64; 2], mut y: [f64; 2]) -> f64 {
    let mut kept = None;
    for _ in 0..60 {
        let at = (s[0] * y[1] - s[1] * y[0]) / (y[1] - y[0]);
        if !(at > s[0] && at < s[1]) {
            break;
        }
        let value = f(at);
        if value == 0.0 || s[1] - s[0] < 1e-15 {
            return at;
        }
        let keep = usize::from((value > 0.0) == (y[0] > 0.0));
        if kept == Some(keep) {
            // An end that stays twice would slow convergence down to linear.
            y[keep] *= 0.5;
        }
        kept = Some(keep);
        (s[1 - keep], y[1 - keep]) = (at, value);
    }
    if y[0].abs() < y[1].abs() { s[0] } else { s[1] }
}
