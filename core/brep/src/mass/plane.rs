//! Planes: area and first moments of the loops are all there is to know.

use super::Sums;
use crate::boundary::{Path, walk};
use crate::gauss;
use crate::geometry::Plane;
use crate::model::Loop;
use glam::DVec2;

/// Sums over the part of `plane` inside `loops`.
pub(super) fn integrate(plane: &Plane, loops: &[Loop]) -> Sums {
    let Some(first) = loops.iter().flat_map(|l| &l.coedges).next() else { return Sums::default() };
    // Moments about a point of the boundary: about a far origin they would cancel.
    let base = first.parameter_at(0.0);
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    for lp in loops {
        walk(lp, |path| {
            let degree = match path {
                Path::Line { .. } => 1,
                Path::Spline { cursor, .. } => cursor.degree(),
            };
            // Products of two coordinates and a derivative: degree 3 d - 1.
            for &(s, w) in gauss::rule((3 * degree).div_ceil(2)) {
                let (p, d) = path.slope(s);
                let p = p - base;
                area += 0.5 * w * p.perp_dot(d);
                moment += 0.5 * w * DVec2::new(p.x * p.x * d.y, -p.y * p.y * d.x);
            }
        });
    }
    let normal = plane.x.cross(plane.y);
    let origin = plane.origin + plane.x * base.x + plane.y * base.y;
    let position = origin * area + plane.x * moment.x + plane.y * moment.y;
    let height = plane.origin.dot(normal);
    Sums { area, position, normal: normal * area, flux: height * area, moment: position * height }
}
