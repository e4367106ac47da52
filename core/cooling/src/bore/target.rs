//! What a bore ends on: a set of faces joined at their borders.

use super::BoreError;
use coolinggen_brep::{EdgeId, FaceId, Model};
use coolinggen_nurbs::{LineHit, ParametricCurve, ParametricSurface, line_meets_surface};
use glam::{DMat3, DVec2, DVec3};

/// A line with its derivatives in the parameter of the section's path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    pub(crate) origin: DVec3,
    pub(crate) direction: DVec3,
    pub(crate) origin_slope: DVec3,
    pub(crate) direction_slope: DVec3,
}

/// Where a bore's axis meets a target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mouth {
    pub(crate) face: FaceId,
    /// Parameters in the face.
    pub(crate) at: DVec2,
    /// Where on the axis, mm.
    pub(crate) z: f64,
}

/// Where a ray meets a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    pub(crate) along: f64,
    pub(crate) at: DVec2,
    pub(crate) point: DVec3,
    /// Derivatives of point and parameters in the path's parameter.
    pub(crate) slope: DVec3,
    pub(crate) at_slope: DVec2,
}

/// Where a family of rays crosses the border of a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// Parameter of the path.
    pub(crate) t: f64,
    /// The border's edge and its parameter there.
    pub(crate) edge: EdgeId,
    pub(crate) edge_t: f64,
    /// The face on the other side, and the parameters there.
    pub(crate) to: FaceId,
    pub(crate) to_at: DVec2,
    /// Multiple of the ray's direction.
    pub(crate) along: f64,
}

/// A side of a face's rectangle of parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    U(f64),
    V(f64),
}

/// Faces that a bore may end on.
#[derive(Clone, Copy)]
pub(crate) struct Target<'m> {
    pub(crate) model: &'m Model,
    pub(crate) faces: &'m [FaceId],
}

impl Target<'_> {
    /// Where a ray meets a face, from parameters nearby.
    pub(super) fn meet(&self, face: FaceId, ray: &Ray, near: DVec2, along: f64) -> Option<Hit> {
        let surface = &self.model.face(face).surface;
        let hit = line_meets_surface(surface, ray.origin, ray.direction, (near.x, near.y), along)?;
        Some(with_slopes(&hit, ray))
    }

    /// The side of the face's rectangle over which a point has left it.
    fn left_over(&self, face: FaceId, at: DVec2) -> Option<Side> {
        let ((u0, u1), (v0, v1)) = self.model.face(face).surface.domain();
        // The side left by most, relative to the rectangle.
        let by = [
            (Side::U(u0), (u0 - at.x) / (u1 - u0)),
            (Side::U(u1), (at.x - u1) / (u1 - u0)),
            (Side::V(v0), (v0 - at.y) / (v1 - v0)),
            (Side::V(v1), (at.y - v1) / (v1 - v0)),
        ];
        by.into_iter().filter(|(_, by)| *by > 0.0).max_by(|a, b| a.1.total_cmp(&b.1)).map(|(side, _)| side)
    }

    /// Whether a point of a face lies within its rectangle.
    pub(super) fn holds(&self, face: FaceId, at: DVec2) -> bool {
        self.left_over(face, at).is_none()
    }

    /// Where a family of rays leaves `face` between the parameters `inside` and `outside`; `at` and `along` are of the
    /// hit at `outside`, beyond the border.
    pub(super) fn crossing(
        &self,
        face: FaceId,
        rays: &dyn Fn(f64) -> Ray,
        (inside, outside): (f64, f64),
        beyond: &Hit,
    ) -> Result<Crossing, BoreError> {
        let side = self.left_over(face, beyond.at).ok_or(BoreError::Misses)?;
        let surface = &self.model.face(face).surface;
        let (mut t, mut along) = (outside, beyond.along);
        let mut free = match side {
            Side::U(_) => beyond.at.y,
            Side::V(_) => beyond.at.x,
        };
        let mut left = f64::INFINITY;
        for _ in 0..40 {
            let at = match side {
                Side::U(u) => DVec2::new(u, free),
                Side::V(v) => DVec2::new(free, v),
            };
            let (point, du, dv) = surface.first_derivatives(at.x, at.y);
            let ray = rays(t);
            let miss = ray.origin + ray.direction * along - point;
            let now = miss.length();
            if now < 1e-10 && now >= 0.25 * left {
                let (edge, edge_t, to, to_at) = self.over_border(face, side, free)?;
                return Ok(Crossing { t, edge, edge_t, to, to_at, along });
            }
            left = now;
            let border = if matches!(side, Side::U(_)) { dv } else { du };
            let across = ray.origin_slope + ray.direction_slope * along;
            let step = DMat3::from_cols(across, ray.direction, -border).inverse() * miss;
            if !step.is_finite() {
                break;
            }
            // Keep to the interval, a little beyond its ends: where two borders are near, the other may come first.
            let (low, high) = (inside.min(outside), inside.max(outside));
            let slack = high - low;
            t = (t - step.x).clamp(low - slack, high + slack);
            (along, free) = (along - step.y, free - step.z);
        }
        Err(BoreError::Misses)
    }

    /// The edge at a place of a face's side, its parameter there, and the face beyond with its parameters.
    fn over_border(
        &self,
        face: FaceId,
        side: Side,
        free: f64,
    ) -> Result<(EdgeId, f64, FaceId, DVec2), BoreError> {
        let leaves = || BoreError::Leaves(self.model.face(face).name.clone());
        let place = match side {
            Side::U(u) => DVec2::new(u, free),
            Side::V(v) => DVec2::new(free, v),
        };
        let border = |face: FaceId| self.model.face(face).loops.iter().take(1).flat_map(|l| &l.coedges);
        for coedge in border(face) {
            let (start, end) = coedge.pcurve.domain();
            let (from, to) = (coedge.pcurve.point(start), coedge.pcurve.point(end));
            let (fixed, low, high) = match side {
                Side::U(u) => ((from.x - u).abs().max((to.x - u).abs()), from.y, to.y),
                Side::V(v) => ((from.y - v).abs().max((to.y - v).abs()), from.x, to.x),
            };
            let fraction = (free - low) / (high - low);
            if fixed > 1e-9 || !(0.0..=1.0).contains(&fraction) {
                continue;
            }
            let t = start + (end - start) * fraction;
            // A border runs at the pace of its edge.
            if coedge.pcurve.point(t).distance(place) > 1e-9 {
                continue;
            }
            for &to in self.faces.iter().filter(|f| **f != face) {
                if let Some(twin) = border(to).find(|c| c.edge == coedge.edge) {
                    return Ok((coedge.edge, t, to, twin.pcurve.point(t)));
                }
            }
            return Err(leaves());
        }
        Err(leaves())
    }
}

/// A hit with its derivatives, from the surface's and the ray's.
fn with_slopes(hit: &LineHit, ray: &Ray) -> Hit {
    let moved = ray.origin_slope + ray.direction_slope * hit.along;
    // S_u u' + S_v v' - D s' = P' + s D'.
    let rates = DMat3::from_cols(hit.du, hit.dv, -ray.direction).inverse() * moved;
    Hit {
        along: hit.along,
        at: DVec2::new(hit.u, hit.v),
        point: hit.point,
        slope: hit.du * rates.x + hit.dv * rates.y,
        at_slope: DVec2::new(rates.x, rates.y),
    }
}
