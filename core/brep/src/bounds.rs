//! Bounding boxes of faces and solids.

mod curve;
mod surface;

use crate::model::{EdgeId, Face, Model, Solid};
use glam::DVec3;

/// Greatest distance by which a box may fall short of the thing inside, mm.
pub const BOUNDS_TOLERANCE_MM: f64 = 1e-9;

/// An axis-parallel box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates, mm.
    pub min: DVec3,
    /// Greatest coordinates, mm.
    pub max: DVec3,
}

impl Bounds {
    /// The box that holds nothing: the neutral element of [`Bounds::union`].
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// Lengths of the sides, mm.
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }

    /// The box around both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Makes the box hold `point`.
    pub fn include(&mut self, point: DVec3) {
        *self = self.union(Self { min: point, max: point });
    }

    /// Whether `point` is inside or not farther outside than `tolerance` in any direction.
    pub fn contains(&self, point: DVec3, tolerance: f64) -> bool {
        point.cmpge(self.min - tolerance).all() && point.cmple(self.max + tolerance).all()
    }

    /// The limit in the direction `sign` (1 or -1) of axis `axis`, times the sign.
    fn reach(&self, axis: usize, sign: f64) -> f64 {
        if sign > 0.0 { self.max[axis] } else { -self.min[axis] }
    }
}

impl Model {
    /// The tightest box around a face, to [`BOUNDS_TOLERANCE_MM`].
    ///
    /// Extremes lie on the edges or where the normal is parallel to an axis; between knots, control points tell
    /// which spans can hold one, and Newton's method finds it from the best of some samples. On surfaces that turn
    /// by more than a right angle within one knot span, an extreme may be missed.
    pub fn face_bounds(&self, face: &Face) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for edge in face.loops.iter().flat_map(|l| &l.coedges).map(|c| c.edge) {
            self.include_edge(edge, &mut bounds);
        }
        surface::include(face, &mut bounds);
        bounds
    }

    /// The tightest box around a solid, to [`BOUNDS_TOLERANCE_MM`]: the union of those of its faces, found faster,
    /// for most edges and faces are well inside what is known already.
    pub fn solid_bounds(&self, solid: &Solid) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        let faces = || solid.faces().filter_map(|f| self.faces.get(f.face.0));
        let edges = || faces().flat_map(|f| &f.loops).flat_map(|l| &l.coedges).map(|c| c.edge);
        for edge in edges().filter_map(|e| self.edges.get(e.0)) {
            for vertex in [edge.start, edge.end] {
                self.vertices.get(vertex.0).into_iter().for_each(|&p| bounds.include(p));
            }
        }
        let mut seen = vec![false; self.edges.len()];
        for edge in edges() {
            if seen.get(edge.0) == Some(&false) {
                seen[edge.0] = true;
                self.include_edge(edge, &mut bounds);
            }
        }
        faces().for_each(|f| surface::include(f, &mut bounds));
        bounds
    }

    fn include_edge(&self, edge: EdgeId, bounds: &mut Bounds) {
        if let Some(edge) = self.edges.get(edge.0) {
            curve::include(&edge.curve, bounds);
        }
    }
}
