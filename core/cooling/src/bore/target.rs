//! What a bore ends on: a set of faces joined at their borders.

use super::BoreError;
use coolinggen_brep::{EdgeId, FaceId, Model, SurfaceGeometry, SurfaceProbe};
use coolinggen_nurbs::{LineHit, ParametricCurve, ParametricSurface, line_meets};
use glam::{DMat3, DVec2, DVec3};
use std::cell::RefCell;

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

/// What has been asked of the borders of a target's faces, and answered: nothing else that is found on a target depends
/// on how bores before have parted its faces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inquiry {
    pub(super) face: FaceId,
    side: Side,
    free: f64,
    pub(super) answer: Option<Over>,
}

/// The edge at a place of a face's side, its parameter there, and the face beyond with its parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Over {
    pub(super) edge: EdgeId,
    pub(super) edge_t: f64,
    pub(super) to: FaceId,
    pub(super) to_at: DVec2,
}

impl Inquiry {
    /// The answer that `face` of another target gives in place of this one's, none if it is another: another place of an
    /// edge, or of the face beyond.
    pub(super) fn again(&self, target: &Target<'_>, face: FaceId) -> Option<Option<Over>> {
        let answer = target.asked(face, self.side, self.free).ok();
        let same = match (&self.answer, &answer) {
            (None, None) => true,
            (Some(a), Some(b)) => a.edge_t == b.edge_t && a.to_at == b.to_at,
            _ => false,
        };
        same.then_some(answer)
    }
}

/// A side of a face's rectangle of parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    U(f64),
    V(f64),
}

/// Faces that a bore may end on.
pub(crate) struct Target<'m> {
    model: &'m Model,
    faces: &'m [FaceId],
    /// All that has been asked of the borders.
    inquiries: RefCell<Vec<Inquiry>>,
    /// The face met last: the next meeting is mostly nearby.
    last: RefCell<Option<(FaceId, SurfaceProbe<'m>)>>,
}

impl<'m> Target<'m> {
    pub(super) fn new(model: &'m Model, faces: &'m [FaceId]) -> Self {
        Self { model, faces, inquiries: RefCell::default(), last: RefCell::default() }
    }

    /// All that has been asked of the borders.
    pub(super) fn into_inquiries(self) -> Vec<Inquiry> {
        self.inquiries.into_inner()
    }

    /// The surface of a face.
    pub(super) fn surface(&self, face: FaceId) -> &'m SurfaceGeometry {
        &self.model.face(face).surface
    }

    /// Where a ray meets a face, from parameters nearby.
    pub(super) fn meet(&self, face: FaceId, ray: &Ray, near: DVec2, along: f64) -> Option<Hit> {
        let surface = self.surface(face);
        let mut last = self.last.borrow_mut();
        let probe = match &mut *last {
            Some((id, probe)) if *id == face => probe,
            other => &mut other.insert((face, SurfaceProbe::new(surface))).1,
        };
        let at = |u, v| probe.first_derivatives(u, v);
        let hit = line_meets(surface.domain(), at, ray.origin, ray.direction, (near.x, near.y), along)?;
        Some(with_slopes(&hit, ray))
    }

    /// Where on a face to look for the next hit, which slopes promise `by` from the one at `last`: there, or at `last`
    /// itself where they point far or off the face. Hits at a flat angle do not follow them so far, and the search would
    /// end on another part of the continued surface.
    pub(super) fn ahead(&self, face: FaceId, last: DVec2, by: DVec2) -> DVec2 {
        const FAR: f64 = 0.1;
        let ((u0, u1), (v0, v1)) = self.surface(face).domain();
        let near = by.x.abs() <= FAR * (u1 - u0) && by.y.abs() <= FAR * (v1 - v0);
        if near && self.holds(face, last + by) { last + by } else { last }
    }

    /// Where a ray meets the target near a place of `face`: on that face, or on a neighbour if the place was not exact.
    pub(super) fn find(
        &self,
        mut face: FaceId,
        ray: &Ray,
        near: DVec2,
        along: f64,
    ) -> Result<(FaceId, Hit), BoreError> {
        const MOST_STEPS: usize = 4;
        let mut hit = self.meet(face, ray, near, along).ok_or(BoreError::Misses)?;
        for _ in 0..MOST_STEPS {
            let Some(side) = self.left_over(face, hit.at) else { return Ok((face, hit)) };
            let free = match side {
                Side::U(_) => hit.at.y,
                Side::V(_) => hit.at.x,
            };
            let Over { to, to_at, .. } = self.over_border(face, side, free)?;
            face = to;
            hit = self.meet(face, ray, to_at, hit.along).ok_or(BoreError::Misses)?;
        }
        Err(BoreError::Misses)
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

    /// Where between two hits, as a part of the way, the path may come nearest to a border of the face and over it: the
    /// extremes of the cubics through the hits with their slopes. None where it stays well inside.
    pub(super) fn outmost(&self, face: FaceId, [from, to]: [&Hit; 2], step: f64) -> Option<f64> {
        const NEAR: f64 = 1e-3;
        let ((u0, u1), (v0, v1)) = self.model.face(face).surface.domain();
        let along = |k: usize, low: f64, high: f64| {
            let scale = 1.0 / (high - low);
            let [p, q] = [from, to].map(|h| (h.at[k] - low) * scale);
            let [m, n] = [from, to].map(|h| h.at_slope[k] * step * scale);
            // The derivative a x^2 + b x + m of the cubic.
            let (a, b) = (6.0 * (p - q) + 3.0 * (m + n), 6.0 * (q - p) - 4.0 * m - 2.0 * n);
            let root = (b * b - 4.0 * a * m).max(0.0).sqrt();
            let extremes = [2.0 * m / (-b - root), 2.0 * m / (-b + root)];
            let value = move |x: f64| p + x * (m + x * (0.5 * b + x * a / 3.0));
            let out = move |x: f64| (-value(x)).max(value(x) - 1.0);
            let found = extremes.into_iter().filter(|x| (0.01..0.99).contains(x));
            found
                .map(move |x| (x, out(x)))
                .filter(move |(_, o)| *o > -NEAR && *o > (-p).max(p - 1.0).max(-q).max(q - 1.0))
        };
        let found = along(0, u0, u1).chain(along(1, v0, v1));
        found.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(x, _)| x)
    }

    /// Where a family of rays leaves `face` between the parameters `inside` and `outside`, given where it hits the face
    /// there (parameters and multiple of the ray) and beyond the border. The hits on the continued surface bracket the
    /// crossing, also where the rays graze the border (regula falsi, Illinois variant).
    pub(super) fn crossing(
        &self,
        face: FaceId,
        rays: &dyn Fn(f64) -> Ray,
        (inside, outside): (f64, f64),
        last: (DVec2, f64),
        beyond: &Hit,
    ) -> Result<Crossing, BoreError> {
        let side = self.left_over(face, beyond.at).ok_or(BoreError::Misses)?;
        let ((u0, u1), (v0, v1)) = self.model.face(face).surface.domain();
        let over = |at: DVec2| match side {
            Side::U(u) => (at.x - u) / (u1 - u0) * if u == u0 { -1.0 } else { 1.0 },
            Side::V(v) => (at.y - v) / (v1 - v0) * if v == v0 { -1.0 } else { 1.0 },
        };
        let mut near = last;
        let mut at = |t: f64| -> Result<Hit, BoreError> {
            let hit = self.meet(face, &rays(t), near.0, near.1).ok_or(BoreError::Misses)?;
            near = (hit.at, hit.along);
            Ok(hit)
        };
        let (mut low, mut high) = (inside, outside);
        let (mut f_low, mut f_high) = (over(last.0), over(beyond.at));
        if f_low > -1e-12 {
            // The rays have just come over this border: they must lead inside before they leave again.
            const STEPS: u32 = 16;
            let within = (1..STEPS).map(|k| inside + (outside - inside) * f64::from(k) / f64::from(STEPS));
            for t in within {
                let f = over(at(t)?.at);
                if f < 0.0 {
                    (low, f_low) = (t, f);
                    break;
                }
            }
            if f_low > -1e-12 {
                return Err(BoreError::Misses);
            }
        }
        let (mut t, mut kept_low) = (high, false);
        let mut hit = *beyond;
        for _ in 0..100 {
            let next = low - f_low * (high - low) / (f_high - f_low);
            if next == t {
                break;
            }
            t = next;
            hit = at(t)?;
            let f = over(hit.at);
            if f.abs() < 1e-15 {
                break;
            }
            let above = f > 0.0;
            if above {
                (high, f_high) = (t, f);
            } else {
                (low, f_low) = (t, f);
            }
            // The end that stays twice weighs half.
            match (above, kept_low) {
                (true, true) => f_low *= 0.5,
                (false, false) => f_high *= 0.5,
                _ => kept_low = above,
            }
        }
        let free = match side {
            Side::U(_) => hit.at.y,
            Side::V(_) => hit.at.x,
        };
        let Over { edge, edge_t, to, to_at } = self.over_border(face, side, free)?;
        Ok(Crossing { t, edge, edge_t, to, to_at, along: hit.along })
    }

    /// What lies over a place of a face's side.
    fn over_border(&self, face: FaceId, side: Side, free: f64) -> Result<Over, BoreError> {
        let answer = self.asked(face, side, free);
        let inquiry = Inquiry { face, side, free, answer: answer.as_ref().ok().copied() };
        self.inquiries.borrow_mut().push(inquiry);
        answer
    }

    fn asked(&self, face: FaceId, side: Side, free: f64) -> Result<Over, BoreError> {
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
                    return Ok(Over { edge: coedge.edge, edge_t: t, to, to_at: twin.pcurve.point(t) });
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
