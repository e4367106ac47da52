//! Where a plane curve meets itself.

use super::curves::{Crossing, Search};
use super::piece::{Piece, Source};
use crate::curve::ParametricCurve;
use crate::edit::BezierCurve;
use crate::error::NurbsError;
use glam::DVec2;
use std::f64::consts::PI;

/// Neighbouring pieces shorter than this part of the size meet at their common point only.
const SMALLEST: f64 = 1e-7;
/// Loops within this part of the size are none.
const LOOP: f64 = 1e-6;

/// All points where a B-spline (rational or not) meets itself at two parameters `s < t`, in the order of `s`, as
/// [`intersect_curves`](crate::intersect_curves). The seam of a closed curve is no such point.
///
/// Loops smaller than 1e-6 of the size of the coordinates do not count, nor do both sides of a cusp.
///
/// # Errors
/// As [`intersect_curves`](crate::intersect_curves).
pub fn self_intersections<C>(curve: &C) -> Result<Vec<Crossing>, NurbsError>
where
    C: BezierCurve<Space = DVec2>,
{
    own_crossings(&Source::exact(curve), LOOP)
}

/// All points where a curve of any kind meets itself: [`self_intersections`] with enclosures that are estimated from
/// samples, as [`intersect_parametric`](crate::intersect_parametric).
///
/// # Errors
/// As [`intersect_curves`](crate::intersect_curves).
pub fn self_intersections_parametric(
    curve: &dyn ParametricCurve<DVec2>,
) -> Result<Vec<Crossing>, NurbsError> {
    own_crossings(&Source::adaptive(curve), LOOP)
}

/// Crossings of a curve with itself, without those of loops within `least_loop` of the size.
pub(crate) fn own_crossings(source: &Source<'_>, least_loop: f64) -> Result<Vec<Crossing>, NurbsError> {
    let mut search = Search::new(source, source);
    let (start, end) = source.curve().domain();
    let closed = source.point(start).distance(source.point(end)) <= super::TOUCH;
    // Pieces that turn by less than half a turn do not meet themselves.
    let mut pieces = Vec::with_capacity(source.pieces.len());
    for piece in &source.pieces {
        straighten(source, piece, search.scale, &mut pieces);
    }
    for (i, p) in pieces.iter().enumerate() {
        for q in &pieces[i + 1..] {
            if p.b == q.a {
                neighbours(source, p.clone(), q.clone(), &mut search);
            } else if closed && p.a == start && q.b == end {
                neighbours(source, q.clone(), p.clone(), &mut search);
            } else {
                search.stack.push((p.clone(), q.clone()));
            }
            search.run()?;
        }
    }
    for c in &mut search.found {
        if c.s > c.t {
            (c.s, c.t) = (c.t, c.s);
        }
    }
    // Around a cusp both sides are closer than what counts as touching.
    let small = least_loop * search.scale;
    let stays = |c: &Crossing, from: f64, to: f64| {
        [0.25, 0.5, 0.75].iter().all(|x| source.point(from + x * (to - from)).distance(c.point) <= small)
    };
    search.found.retain(|c| {
        let around = closed && stays(c, start, c.s) && stays(c, c.t, end);
        !stays(c, c.s, c.t) && !around
    });
    Ok(search.merged())
}

/// Cuts a piece until its tangents are known to stay within less than half a turn.
fn straighten(source: &Source<'_>, piece: &Piece, scale: f64, into: &mut Vec<Piece>) {
    let middle = 0.5 * (piece.a + piece.b);
    let tiny = piece.length() <= SMALLEST * scale || !(middle > piece.a && middle < piece.b);
    if piece.directions().is_some() || tiny {
        into.push(piece.clone());
    } else {
        for half in source.split(piece, middle) {
            straighten(source, &half, scale, into);
        }
    }
}

/// Pairs to examine for pieces that follow each other, `p` before `q`: their common point does not count.
fn neighbours(source: &Source<'_>, p: Piece, q: Piece, search: &mut Search<'_>) {
    let (mut p, mut q) = (p, q);
    loop {
        if within_half_turn(&p, &q) || p.length().max(q.length()) <= SMALLEST * search.scale {
            return;
        }
        let (x, y) = (0.5 * (p.a + p.b), 0.5 * (q.a + q.b));
        if !(x > p.a && x < p.b && y > q.a && y < q.b) {
            return;
        }
        let [p0, p1] = source.split(&p, x);
        let [q0, q1] = source.split(&q, y);
        search.stack.extend([(p0.clone(), q0.clone()), (p0, q1.clone()), (p1.clone(), q1)]);
        (p, q) = (p1, q0);
    }
}

/// Whether the tangents of both pieces lie within less than half a turn: then the pieces together do not meet
/// themselves, since they advance along a common direction.
fn within_half_turn(p: &Piece, q: &Piece) -> bool {
    let (Some(x), Some(y)) = (p.directions(), q.directions()) else { return false };
    // The same turn for both.
    let shift = (0.5 * (x.0 + x.1 - y.0 - y.1) / (2.0 * PI)).round() * 2.0 * PI;
    x.1.max(y.1 + shift) - x.0.min(y.0 + shift) < PI
}
