//! Triangles for every face of a model, closed by construction.
//!
//! Each edge is cut once into a polyline (`edges`), which all faces along it take over bit for bit; each face is
//! then triangulated in its parameters between its polylines, on grid lines graded by curvature (`field`): whole
//! rectangles row by row (`rectangle`), everything else by constrained Delaunay (`delaunay`).

mod boundary;
mod delaunay;
mod driver;
mod edges;
mod field;
mod flip;
mod grading;
mod kept;
mod patch;
mod rectangle;

use crate::ExportError;
use coolinggen_brep::{FaceId, FaceUse};
use glam::{DVec2, DVec3};

pub use driver::{tessellate, tessellate_again};
pub use kept::KeptMeshes;

/// How closely a tessellation follows the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TessellationOptions {
    /// Greatest distance between triangles and surfaces, polylines and edges, mm.
    pub chord_mm: f64,
    /// Greatest turn of an edge's tangent over a segment and of a surface's normal over a grid step, and greatest angle
    /// between a triangle's normal and the surface's at its corners, degrees.
    pub angle_deg: f64,
    /// Greatest length of a segment and of a grid step, mm.
    pub max_edge_mm: Option<f64>,
}

impl Default for TessellationOptions {
    fn default() -> Self {
        Self { chord_mm: 0.02, angle_deg: 15.0, max_edge_mm: None }
    }
}

/// Share of the chord tolerance that deviations may reach where they are sampled: a triangle is looked at in a few
/// places, and may be a little worse between them.
const SAMPLED: f64 = 0.92;

impl TessellationOptions {
    /// Greatest deviation at sampled places, mm.
    pub(crate) fn sampled_chord(&self) -> f64 {
        SAMPLED * self.chord_mm
    }

    /// Angle in radians, at most 60 degrees: less than three segments a turn are no circle.
    pub(crate) fn angle(&self) -> f64 {
        self.angle_deg.min(60.0).to_radians()
    }

    fn check(&self) -> Result<(), ExportError> {
        let length = self.max_edge_mm.unwrap_or(1.0);
        for (name, value) in
            [("chord_mm", self.chord_mm), ("angle_deg", self.angle_deg), ("max_edge_mm", length)]
        {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ExportError::BadOption { name, value });
            }
        }
        Ok(())
    }
}

/// The triangles of one face.
#[derive(Clone, Debug, Default)]
pub struct FaceMesh {
    /// Vertices as indices into [`Tessellation::points`].
    pub points: Vec<u32>,
    /// Parameters of the vertices.
    pub parameters: Vec<DVec2>,
    /// Unit normals of the surface at the vertices, along its natural normal.
    pub normals: Vec<DVec3>,
    /// Triangles as indices into the vertices, counterclockwise seen against the natural normal.
    pub triangles: Vec<[u32; 3]>,
}

/// Triangles of a model. Faces share the points of their edges, so that a solid's triangles close by construction.
#[derive(Clone, Debug, Default)]
pub struct Tessellation {
    /// Points, mm: vertices of the model first, then those along edges, then those inside faces.
    pub points: Vec<DVec3>,
    /// Points along each edge, from its start to its end.
    pub edges: Vec<Vec<u32>>,
    /// One mesh a face.
    pub faces: Vec<FaceMesh>,
    /// Faces whose triangles do not keep the tolerances: surfaces with kinks or folds that no refinement resolves.
    pub coarse: Vec<FaceId>,
}

impl Tessellation {
    /// Triangles of a face as indices into its vertices, counterclockwise seen from outside the solid.
    pub fn triangles(&self, used: FaceUse) -> impl Iterator<Item = [u32; 3]> + '_ {
        let triangles = self.faces[used.face.0].triangles.iter();
        triangles.map(move |&[a, b, c]| if used.forward { [a, b, c] } else { [a, c, b] })
    }

    /// Number of triangles over all faces.
    pub fn triangle_count(&self) -> usize {
        self.faces.iter().map(|f| f.triangles.len()).sum()
    }
}
