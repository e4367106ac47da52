//! Whole ruled faces, straight in v: on each line the integrals over v are closed forms, but for the area's where the
//! normal turns along the line.

use super::Sums;
use crate::boundary::{Path, walk};
use crate::gauss;
use crate::model::Loop;
use crate::span::{Span, full_spans};
use coolinggen_nurbs::{MAX_DEGREE, ParametricSurface, Surface};
use glam::DVec3;

/// Sums inside a loop that is the border of the whole rectangle of a surface with one straight span in v; none for other
/// loops.
pub(super) fn integrate(surface: &Surface<DVec3>, bound: &Loop) -> Option<Sums> {
    if surface.counts().1 != 2 {
        return None;
    }
    let sign = way_round(surface, bound)?;
    let knots = surface.knots_u();
    let p = knots.degree();
    let mut sums = Sums::default();
    let (mut n, mut d) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
    let mut span = Span::new(knots, knots.span(knots.domain().0));
    for index in full_spans(knots) {
        span.set(knots, index);
        let points = &surface.points()[2 * span.first()..2 * (index + 1)];
        // X (X . n) has degree 4 p - 1; six points at least, for the root in the area.
        for &(s, w) in gauss::rule((2 * p).max(6)) {
            span.slopes(span.start + (span.end - span.start) * s, &mut n, &mut d);
            let mut ends = [DVec3::ZERO; 2];
            let mut slopes = [DVec3::ZERO; 2];
            for ((pair, &n), &d) in points.chunks_exact(2).zip(&n[..=p]).zip(&d[..=p]) {
                for k in 0..2 {
                    ends[k] += pair[k] * n;
                    slopes[k] += pair[k] * d;
                }
            }
            sums.add_line(w * (span.end - span.start) * sign, ends, slopes);
        }
    }
    Some(sums)
}

/// 1 where the loop is the border of the surface's rectangle, counterclockwise; -1 where clockwise.
fn way_round(surface: &Surface<DVec3>, bound: &Loop) -> Option<f64> {
    let ((u0, u1), (v0, v1)) = surface.domain();
    let (mut sides, mut straight, mut area) = (0, true, 0.0);
    walk(bound, |path| {
        let Path::Line { from, to } = *path else {
            straight = false;
            return;
        };
        sides += 1;
        straight &= [from, to].iter().all(|q| (q.x == u0 || q.x == u1) && (q.y == v0 || q.y == v1));
        area += 0.5 * from.perp_dot(to);
    });
    let whole = (u1 - u0) * (v1 - v0);
    let ratio = area / whole;
    // Four sides between corners with the area of the rectangle run round it once.
    (straight && sides == 4 && (ratio.abs() - 1.0).abs() < 1e-9).then(|| ratio.signum())
}

impl Sums {
    /// Adds the line between two points with weight `weight`; `slopes` are the points' derivatives in u.
    #[inline(always)]
    fn add_line(&mut self, weight: f64, [from, to]: [DVec3; 2], slopes: [DVec3; 2]) {
        // X = from + s along, n = normal + s turn; both vectors of n are normal to `along`.
        let along = to - from;
        let normal = slopes[0].cross(along);
        let turn = (slopes[1] - slopes[0]).cross(along);
        let (height, rise) = (from.dot(normal) * weight, from.dot(turn) * weight);
        self.normal += (normal + turn * 0.5) * weight;
        self.flux += height + 0.5 * rise;
        self.moment += from * (height + 0.5 * rise) + along * (0.5 * height + rise / 3.0);
        // |n| is linear where n keeps its direction and does not flip; else it has a root, smooth unless n vanishes nearby.
        let end = normal + turn;
        let steady = normal.length_squared().min(end.length_squared());
        let straight =
            normal.cross(turn).length_squared() <= 1e-12 * steady * steady && normal.dot(end) > 0.0;
        let points = if straight { 2 } else { 6 };
        for &(s, w) in gauss::rule(points) {
            let area = weight * w * (normal + turn * s).length();
            self.area += area;
            self.position += (from + along * s) * area;
        }
    }
}
