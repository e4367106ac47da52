//! Surface parameters of points on a surface, one after the other along a curve.

use crate::cursor::Cursor;
use crate::geometry::{Plane, SurfaceGeometry};
use coolinggen_nurbs::{ParametricCurve, ParametricSurface};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Feet of successive points; each search starts from the foot before.
#[derive(Clone, Debug)]
pub(crate) struct Feet<'a> {
    surface: &'a SurfaceGeometry,
    /// The meridian of a revolution.
    meridian: Option<Cursor<'a, DVec2>>,
    last: DVec2,
}

impl<'a> Feet<'a> {
    /// Starts near the parameters `near`.
    pub(crate) fn new(surface: &'a SurfaceGeometry, near: DVec2) -> Self {
        let meridian = match surface {
            SurfaceGeometry::Revolution(s) => Some(Cursor::new(s.meridian())),
            _ => None,
        };
        Self { surface, meridian, last: near }
    }

    /// Parameters of the foot of `point`; theta is the one nearest to the last one.
    pub(crate) fn next(&mut self, point: DVec3) -> DVec2 {
        self.last = match (self.surface, &mut self.meridian) {
            (SurfaceGeometry::Plane(plane), _) => on_plane(plane, point),
            (_, Some(meridian)) => on_revolution(meridian, point, self.last),
            (surface, None) => on_surface(surface, point, self.last),
        };
        self.last
    }
}

fn on_plane(plane: &Plane, point: DVec3) -> DVec2 {
    let d = point - plane.origin;
    DVec2::new(d.dot(plane.x), d.dot(plane.y))
}

fn on_revolution(meridian: &mut Cursor<'_, DVec2>, point: DVec3, near: DVec2) -> DVec2 {
    let theta = point.y.atan2(point.z);
    let theta = theta + TAU * ((near.x - theta) / TAU).round();
    let goal = DVec2::new(point.x, point.y.hypot(point.z));
    let curve = meridian.curve();
    let (start, end) = curve.domain();
    if let ([a, b], 1) = (curve.points(), curve.degree()) {
        let d = *b - *a;
        return DVec2::new(theta, start + (end - start) * (goal - *a).dot(d) / d.length_squared());
    }
    // Gauss and Newton: quadratic, for the point lies on the surface or close to it.
    let mut foot = |mut t: f64| {
        for _ in 0..30 {
            let (p, d) = meridian.at(t);
            let step = (p - goal).dot(d) / d.length_squared();
            // Half a length beyond the ends the continued polynomial is of no use.
            t = (t - step).clamp(start - 0.5 * (end - start), end + 0.5 * (end - start));
            if !(step.abs() > 1e-9 * (end - start)) {
                break;
            }
        }
        // The last step was quadratic: what it left is below rounding.
        t
    };
    let off = |t: f64| (curve.point(t) - goal).length();
    let t = foot(near.y);
    if off(t) < 1e-3 {
        return DVec2::new(theta, t);
    }
    // The start was no use: look everywhere.
    const STEPS: usize = 100;
    let all = (0..=STEPS).map(|i| start + (end - start) * i as f64 / STEPS as f64);
    let other = foot(all.min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(start));
    DVec2::new(theta, if off(other) < off(t) { other } else { t })
}

/// Newton's method for the nearest point, from `near`; within the surface's domain.
fn on_surface(surface: &SurfaceGeometry, point: DVec3, near: DVec2) -> DVec2 {
    let ((u0, u1), (v0, v1)) = surface.domain();
    let (low, high) = (DVec2::new(u0, v0), DVec2::new(u1, v1));
    let mut at = near.clamp(low, high);
    for _ in 0..30 {
        let d = surface.derivatives(at.x, at.y);
        let off = d.point - point;
        let gradient = DVec2::new(off.dot(d.u), off.dot(d.v));
        let (mut a, mut b, mut c) = (d.u.length_squared(), d.u.dot(d.v), d.v.length_squared());
        let full = (a + off.dot(d.uu), b + off.dot(d.uv), c + off.dot(d.vv));
        // Away from the foot the full matrix may point uphill; Gauss-Newton's never does.
        if full.0 > 0.0 && full.0 * full.2 - full.1 * full.1 > 0.1 * (a * c - b * b) {
            (a, b, c) = full;
        }
        let det = a * c - b * b;
        let step = DVec2::new(c * gradient.x - b * gradient.y, a * gradient.y - b * gradient.x) / det;
        if !step.is_finite() {
            break;
        }
        let next = (at - step).clamp(low, high);
        let moved = (next - at).abs() / (high - low);
        at = next;
        if moved.max_element() < 1e-15 {
            break;
        }
    }
    at
}
