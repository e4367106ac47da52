//! Casting lines at faces: which face a line meets first, and about where.

use crate::geometry::SurfaceGeometry;
use crate::model::{FaceId, Model};
use coolinggen_nurbs::ParametricSurface;
use glam::{DVec2, DVec3};

/// Faces as coarse triangles, to find which a line meets; exact positions are for Newton's method to find.
#[derive(Clone, Debug)]
pub struct Caster {
    faces: Vec<CastFace>,
}

#[derive(Clone, Debug)]
struct CastFace {
    id: FaceId,
    bounds: Bounds,
    strips: Vec<Strip>,
}

/// The triangles between two neighbouring lines of constant u.
#[derive(Clone, Debug)]
struct Strip {
    bounds: Bounds,
    triangles: Vec<[(DVec3, DVec2); 3]>,
}

/// An axis-parallel box.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    min: DVec3,
    max: DVec3,
}

/// A meeting of a line and a face, as near as the triangles tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CastHit {
    /// The face.
    pub face: FaceId,
    /// Its parameters.
    pub at: DVec2,
    /// Multiple of the direction.
    pub along: f64,
}

/// Steps across each rectangle of a face's parameters.
const STEPS: (usize, usize) = (24, 16);

impl Caster {
    /// Prepares the whole parameter rectangle of B-spline faces; others are left out.
    pub fn new(model: &Model, faces: impl IntoIterator<Item = FaceId>) -> Self {
        let faces = faces.into_iter().filter_map(|id| cast_face(id, &model.face(id).surface)).collect();
        Self { faces }
    }

    /// The first meeting after `least` along the line.
    pub fn first(&self, origin: DVec3, direction: DVec3, least: f64) -> Option<CastHit> {
        let mut best: Option<CastHit> = None;
        for face in self.faces.iter().filter(|f| f.bounds.may_meet(origin, direction)) {
            let strips = face.strips.iter().filter(|s| s.bounds.may_meet(origin, direction));
            for triangle in strips.flat_map(|s| &s.triangles) {
                let Some((along, at)) = meet(triangle, origin, direction) else { continue };
                if along > least && best.is_none_or(|b| along < b.along) {
                    best = Some(CastHit { face: face.id, at, along });
                }
            }
        }
        best
    }
}

impl Bounds {
    /// The box of points.
    fn of(points: &[(DVec3, DVec2)]) -> Self {
        let empty = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
        points.iter().fold(empty, |b, (p, _)| Self { min: b.min.min(*p), max: b.max.max(*p) })
    }

    /// Whether the line passes through the box, or a little beside it: triangles reach beyond their sides, too.
    fn may_meet(&self, origin: DVec3, direction: DVec3) -> bool {
        let margin = DVec3::splat(2.0 * BEYOND * self.min.distance(self.max));
        let (a, b) = ((self.min - margin - origin) / direction, (self.max + margin - origin) / direction);
        let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
        !(near > far) && !(far < 0.0)
    }
}

fn cast_face(id: FaceId, surface: &SurfaceGeometry) -> Option<CastFace> {
    if !matches!(surface, SurfaceGeometry::BSpline(_) | SurfaceGeometry::Rational(_)) {
        return None;
    }
    let ((u0, u1), (v0, v1)) = surface.domain();
    let mut points = Vec::with_capacity((STEPS.0 + 1) * (STEPS.1 + 1));
    for i in 0..=STEPS.0 {
        for j in 0..=STEPS.1 {
            let at = DVec2::new(
                u0 + (u1 - u0) * i as f64 / STEPS.0 as f64,
                v0 + (v1 - v0) * j as f64 / STEPS.1 as f64,
            );
            points.push((surface.point(at.x, at.y), at));
        }
    }
    let strip = |line: &[(DVec3, DVec2)]| {
        let (lower, upper) = line.split_at(STEPS.1 + 1);
        let quads = lower.windows(2).zip(upper.windows(2));
        let triangles = quads.flat_map(|(a, b)| [[a[0], b[0], b[1]], [a[0], b[1], a[1]]]);
        Strip { bounds: Bounds::of(line), triangles: triangles.collect() }
    };
    let lines = points.windows(2 * (STEPS.1 + 1)).step_by(STEPS.1 + 1);
    Some(CastFace { id, bounds: Bounds::of(&points), strips: lines.map(strip).collect() })
}

/// How far beyond its sides a triangle is still met, relative to them.
const BEYOND: f64 = 1e-6;

/// Where a line meets a triangle (Möller and Trumbore, 1997), a little beyond its sides too.
fn meet(triangle: &[(DVec3, DVec2); 3], origin: DVec3, direction: DVec3) -> Option<(f64, DVec2)> {
    let [(a, qa), (b, qb), (c, qc)] = *triangle;
    let (e1, e2) = (b - a, c - a);
    let p = direction.cross(e2);
    let determinant = e1.dot(p);
    let to = origin - a;
    let u = to.dot(p) / determinant;
    let q = to.cross(e1);
    let v = direction.dot(q) / determinant;
    let inside = u >= -BEYOND && v >= -BEYOND && u + v <= 1.0 + BEYOND;
    inside.then(|| (e2.dot(q) / determinant, qa + (qb - qa) * u + (qc - qa) * v))
}
