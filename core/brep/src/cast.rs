//! Casting lines at faces: which face a line meets first, and about where.

use crate::geometry::SurfaceGeometry;
use crate::model::{FaceId, Model};
use coolinggen_nurbs::ParametricSurface;
use glam::{DVec2, DVec3};
use std::ops::Range;

/// Faces as coarse triangles, to find which a line meets; exact positions are for Newton's method to find.
#[derive(Clone, Debug)]
pub struct Caster {
    faces: Vec<CastFace>,
}

#[derive(Clone, Debug)]
struct CastFace {
    id: FaceId,
    nodes: Vec<Node>,
    triangles: Vec<[(DVec3, DVec2); 3]>,
}

/// Triangles that lie together, and the boxes about them: a tree, laid out so that a node's parts follow it.
#[derive(Clone, Debug)]
struct Node {
    bounds: Bounds,
    /// Index of the node after all of its parts.
    next: usize,
    /// Its triangles, where it has no parts.
    triangles: Range<usize>,
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
        let inverse = direction.recip();
        for face in &self.faces {
            let mut at_node = 0;
            while let Some(node) = face.nodes.get(at_node) {
                let farthest = best.map_or(f64::INFINITY, |b| b.along);
                if !node.bounds.may_meet(origin, inverse, farthest) {
                    at_node = node.next;
                    continue;
                }
                at_node += 1;
                for triangle in &face.triangles[node.triangles.clone()] {
                    let Some((along, at)) = meet(triangle, origin, direction) else { continue };
                    if along > least && best.is_none_or(|b| along < b.along) {
                        best = Some(CastHit { face: face.id, at, along });
                    }
                }
            }
        }
        best
    }
}

impl Bounds {
    const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The box of points and a little more: triangles reach beyond their sides, too.
    fn of(points: impl Iterator<Item = DVec3>) -> Self {
        let tight = points.fold(Self::EMPTY, |b, p| Self { min: b.min.min(p), max: b.max.max(p) });
        let margin = DVec3::splat(2.0 * BEYOND * tight.min.distance(tight.max));
        Self { min: tight.min - margin, max: tight.max + margin }
    }

    /// The box around both.
    fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Whether the line passes through the box ahead of its origin and before `farthest`; `inverse` has the reciprocals
    /// of its direction.
    fn may_meet(&self, origin: DVec3, inverse: DVec3, farthest: f64) -> bool {
        let (a, b) = ((self.min - origin) * inverse, (self.max - origin) * inverse);
        let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
        !(near > far) && !(far < 0.0) && !(near > farthest)
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
    let mut face = CastFace { id, nodes: Vec::new(), triangles: Vec::with_capacity(2 * STEPS.0 * STEPS.1) };
    face.add(&points, 0..STEPS.0, 0..STEPS.1);
    Some(face)
}

impl CastFace {
    /// Adds the node of the quadrangles `i` by `j`, and its parts; answers with its box.
    fn add(&mut self, points: &[(DVec3, DVec2)], i: Range<usize>, j: Range<usize>) -> Bounds {
        let place = |i: usize, j: usize| points[i * (STEPS.1 + 1) + j];
        let node = self.nodes.len();
        let first = self.triangles.len();
        self.nodes.push(Node { bounds: Bounds::EMPTY, next: 0, triangles: first..first });
        let bounds = if i.len() * j.len() <= LEAF {
            let inside = (i.start..=i.end).flat_map(|i| (j.start..=j.end).map(move |j| (i, j)));
            let bounds = Bounds::of(inside.map(|(i, j)| place(i, j).0));
            for (i, j) in i.flat_map(|i| j.clone().map(move |j| (i, j))) {
                let [a, b, c, d] = [place(i, j), place(i, j + 1), place(i + 1, j), place(i + 1, j + 1)];
                self.triangles.extend([[a, c, d], [a, d, b]]);
            }
            self.nodes[node].triangles = first..self.triangles.len();
            bounds
        } else if i.len() >= j.len() {
            let middle = i.start + i.len() / 2;
            self.add(points, i.start..middle, j.clone()).union(self.add(points, middle..i.end, j))
        } else {
            let middle = j.start + j.len() / 2;
            self.add(points, i.clone(), j.start..middle).union(self.add(points, i, middle..j.end))
        };
        (self.nodes[node].bounds, self.nodes[node].next) = (bounds, self.nodes.len());
        bounds
    }
}

/// Quadrangles that are not parted any more.
const LEAF: usize = 2;

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
