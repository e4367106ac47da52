//! Surfaces of revolution: the angle is integrated in closed form, what is left runs along the loops.

use super::Sums;
use crate::boundary::{Path, cuts, walk};
use crate::cursor::Cursor;
use crate::gauss;
use crate::geometry::Revolution;
use crate::model::Loop;
use glam::DVec3;

/// Largest step in theta, radians, that one rule takes: 14 points then integrate the circular functions to the
/// last digit.
const STEP: f64 = 0.5;

/// Sums over the part of `surface` inside `loops`.
pub(super) fn integrate(surface: &Revolution, loops: &[Loop]) -> Sums {
    let meridian = surface.meridian();
    let degree = meridian.degree();
    let mut cursor = Cursor::new(meridian);
    let mut pieces = Vec::new();
    let mut sums = Sums::default();
    for lp in loops {
        let Some(first) = lp.coedges.first() else { continue };
        let base = first.parameter_at(0.0).x;
        let (sin_base, cos_base) = base.sin_cos();
        walk(lp, |path| {
            if matches!(path, Path::Line { from, to } if from.y == to.y) {
                return;
            }
            cuts(path, [None, Some(meridian.knots())], &mut pieces);
            for piece in pieces.windows(2) {
                let [a, m, b] = [piece[0], 0.5 * (piece[0] + piece[1]), piece[1]].map(|s| path.point(s));
                let way = (m - a).abs().max((b - m).abs()) * 2.0;
                cursor.seek(m.y);
                let share = way.y / (cursor.span.end - cursor.span.start);
                // Most pieces of an interpolated parameter curve are short, against the meridian's spans too.
                let n = if way.x == 0.0 {
                    // Volumes along meridians are polynomials of degree 4 d - 1; the arc length is not.
                    (2 * degree).max(12)
                } else if share < 0.03 && way.x < 0.02 {
                    5
                } else if share < 0.25 && way.x < 0.1 {
                    8
                } else {
                    14
                };
                let steps = (way.x / STEP).ceil().clamp(1.0, 100.0);
                let length = (piece[1] - piece[0]) / steps;
                for step in 0..steps as usize {
                    let start = piece[0] + length * step as f64;
                    for &(s, w) in gauss::rule(n) {
                        let (at, slope) = path.slope(start + length * s);
                        let (p, d) = cursor.at(at.y);
                        let (sin, cos) = at.x.sin_cos();
                        // Integrals of 1, sin and cos from the base angle.
                        let (h, hs, hc) = (at.x - base, cos_base - cos, sin - sin_base);
                        let weight = w * length * slope.y * p.y;
                        let (x, r, height) = (p.x, p.y, p.x * d.y - p.y * d.x);
                        let arc = weight * d.length();
                        sums += Sums {
                            area: arc * h,
                            position: DVec3::new(x * h, r * hs, r * hc) * arc,
                            normal: DVec3::new(d.y * h, -d.x * hs, -d.x * hc) * weight,
                            flux: height * weight * h,
                            moment: DVec3::new(x * h, r * hs, r * hc) * (height * weight),
                        };
                    }
                }
            }
        });
    }
    sums
}
