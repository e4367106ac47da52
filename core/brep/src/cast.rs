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
    whole: Box3,
    strips: Vec<Strip>,
}

/// The triangles between two neighbouring lines of equal u.
#[derive(Clone, Debug)]
struct Strip {
    bounds: Box3,
    triangles: Vec<[(DVec3, DVec2); 3]>,
}

/// An axis-parallel box.
#[derive(Clone, Copy, Debug)]
struct Box3 {
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
        for face in self.faces.iter().filter(|f| f.whole.may_meet(origin, direction)) {
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

impl Box3 {
    /// The box of points, a little greater, as triangles are met a little beyond their sides.
    fn around(points: impl Iterator<Item = DVec3> + Clone) -> Self {
        let min = points.clone().fold(DVec3::INFINITY, DVec3::min);
        let max = points.fold(DVec3::NEG_INFINITY, DVec3::max);
        let margin = DVec3::splat(2.0 * BEYOND * min.distance(max));
        Self { min: min - margin, max: max + margin }
    }

    /// Whether the line passes through the box.
    fn may_meet(&self, origin: DVec3, direction: DVec3) -> bool {
        let (a, b) = ((self.min - origin) / direction, (self.max - origin) / direction);
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
    let corner = |i: usize, j: usize| points[i * (STEPS.1 + 1) + j];
    let strips = (0..STEPS.0).map(|i| {
        let triangles = (0..STEPS.1).flat_map(|j| {
            let (a, b, c, d) = (corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
            [[a, b, c], [a, c, d]]
        });
        let lines = &points[i * (STEPS.1 + 1)..(i + 2) * (STEPS.1 + 1)];
        Strip { bounds: Box3::around(lines.iter().map(|p| p.0)), triangles: triangles.collect() }
    });
    let (strips, whole) = (strips.collect(), Box3::around(points.iter().map(|p| p.0)));
    Some(CastFace { id, whole, strips })
}

/// How far beyond its sides a triangle is met, relative to its size.
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
