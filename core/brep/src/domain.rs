//! The part of the parameter plane that a face covers.

use crate::boundary::{Path, walk};
use crate::cursor::Cursor;
use crate::gauss;
use crate::geometry::SurfaceGeometry;
use crate::model::{Face, Loop};
use coolinggen_nurbs::{Curve, MAX_DEGREE};
use glam::DVec2;
use std::f64::consts::TAU;

/// Area that `lp` encloses in the parameter plane: positive where it runs counterclockwise.
pub fn signed_area(lp: &Loop) -> f64 {
    let Some(first) = lp.coedges.first() else { return 0.0 };
    let base = first.parameter_at(0.0);
    let mut area = 0.0;
    walk(lp, |path| {
        let degree = match path {
            Path::Line { .. } => 1,
            Path::Spline { cursor, .. } => cursor.degree(),
        };
        for &(s, w) in gauss::rule(degree) {
            let (p, d) = path.slope(s);
            area += 0.5 * w * (p - base).perp_dot(d);
        }
    });
    area
}

/// The loops of a face, prepared for [`FaceDomain::contains`]. Building one costs about as much as a hundred
/// queries.
#[derive(Clone, Debug)]
pub struct FaceDomain<'a> {
    face: &'a Face,
    pieces: Vec<Piece>,
    low: DVec2,
    high: DVec2,
}

/// A polynomial piece of a loop as Bezier points, in the direction of the loop.
#[derive(Clone, Debug)]
struct Piece {
    points: Vec<DVec2>,
    low: DVec2,
    high: DVec2,
}

impl<'a> FaceDomain<'a> {
    /// Prepares the loops of `face`.
    pub fn new(face: &'a Face) -> Self {
        let mut pieces: Vec<Piece> = Vec::new();
        for lp in &face.loops {
            let begin = pieces.len();
            walk(lp, |path| {
                let points = match path {
                    Path::Line { from, to } => vec![*from, *to],
                    Path::Spline { cursor, start, end } => bezier(cursor, *start, *end),
                };
                pieces.push(Piece { points, low: DVec2::ZERO, high: DVec2::ZERO });
            });
            // Pieces must meet bit for bit, or a ray could slip through between two of them.
            let lp = &mut pieces[begin..];
            for i in 0..lp.len() {
                let next = lp[(i + 1) % lp.len()].points[0];
                if let Some(last) = lp[i].points.last_mut() {
                    *last = next;
                }
            }
        }
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for piece in &mut pieces {
            (piece.low, piece.high) = hull(&piece.points);
            (low, high) = (low.min(piece.low), high.max(piece.high));
        }
        Self { face, pieces, low, high }
    }

    /// The face.
    pub fn face(&self) -> &'a Face {
        self.face
    }

    /// A rectangle around the loops, `(low, high)`; that of the control points, not the tightest.
    pub fn bounds(&self) -> (DVec2, DVec2) {
        (self.low, self.high)
    }

    /// Whether the face covers the parameters `at`. Exact up to rounding in the evaluation of the loops; points on
    /// a loop may go either way. On surfaces of revolution theta may be off by whole turns.
    pub fn contains(&self, at: DVec2) -> bool {
        if let SurfaceGeometry::Revolution(_) = self.face.surface {
            let at = DVec2::new(at.x - TAU * ((at.x - self.low.x) / TAU).floor(), at.y);
            return self.winding(at) > 0 || self.winding(DVec2::new(at.x - TAU, at.y)) > 0;
        }
        self.winding(at) > 0
    }

    /// How often the loops run counterclockwise round `at`: 1 inside, 0 outside and in holes.
    fn winding(&self, at: DVec2) -> i32 {
        if !(at.cmpge(self.low).all() && at.cmple(self.high).all()) {
            return 0;
        }
        self.pieces.iter().map(|p| crossings(&p.points, p.low, p.high, at, 0)).sum()
    }
}

/// Signed crossings of the ray from `at` along +u with the Bezier curve `points`, upward ones positive.
fn crossings(points: &[DVec2], low: DVec2, high: DVec2, at: DVec2, depth: usize) -> i32 {
    if at.y < low.y || at.y > high.y || at.x > high.x {
        return 0;
    }
    let (from, to) = (points[0], points[points.len() - 1]);
    let by_ends = i32::from(from.y <= at.y && to.y > at.y) - i32::from(to.y <= at.y && from.y > at.y);
    if at.x < low.x {
        // All of the curve lies ahead: only the ends count.
        return by_ends;
    }
    if points.len() == 2 || depth > 50 {
        let left = (to - from).perp_dot(at - from) * f64::from(by_ends) > 0.0;
        return if left { by_ends } else { 0 };
    }
    // Halve by de Casteljau's scheme.
    let n = points.len();
    let (mut first, mut second) = ([DVec2::ZERO; MAX_DEGREE + 1], [DVec2::ZERO; MAX_DEGREE + 1]);
    second[..n].copy_from_slice(points);
    for i in 0..n {
        first[i] = second[0];
        for j in 0..n - 1 - i {
            second[j] = 0.5 * (second[j] + second[j + 1]);
        }
    }
    let half = |points: &[DVec2]| {
        let (low, high) = hull(points);
        crossings(points, low, high, at, depth + 1)
    };
    half(&first[..n]) + half(&second[..n])
}

fn hull(points: &[DVec2]) -> (DVec2, DVec2) {
    points.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)))
}

/// Bezier points of the cursor's span from `start` to `end`: the blossom at mixed arguments.
fn bezier(cursor: &Cursor<'_, DVec2>, start: f64, end: f64) -> Vec<DVec2> {
    let (curve, span): (&Curve<DVec2>, _) = (cursor.curve(), cursor.span.index);
    let (p, k) = (curve.degree(), curve.knots().values());
    let blossom = |ends: usize| {
        let mut d = [DVec2::ZERO; MAX_DEGREE + 1];
        d[..=p].copy_from_slice(&curve.points()[span - p..=span]);
        for r in 1..=p {
            let t = if r <= ends { end } else { start };
            for j in (r..=p).rev() {
                let (a, b) = (k[span - p + j], k[span + 1 + j - r]);
                d[j] = d[j - 1].lerp(d[j], (t - a) / (b - a));
            }
        }
        d[p]
    };
    (0..=p).map(blossom).collect()
}
