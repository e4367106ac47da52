//! Topology by index: vertices, edges, named faces, shells and solids that share them.

use crate::geometry::{EdgeCurve, SurfaceGeometry};
use coolinggen_nurbs::{Curve, ParametricCurve};
use glam::{DVec2, DVec3};

/// Index of a vertex of a [`Model`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct VertexId(pub usize);

/// Index of an edge of a [`Model`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct EdgeId(pub usize);

/// Index of a face of a [`Model`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FaceId(pub usize);

/// An edge between two vertices, never the same one: closed curves are cut into two edges.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Vertex at the start of the curve.
    pub start: VertexId,
    /// Vertex at the end of the curve.
    pub end: VertexId,
    /// The curve; its ends are the vertices' points bit for bit.
    pub curve: EdgeCurve,
}

/// An edge as a loop of a face runs through it.
#[derive(Clone, Debug)]
pub struct Coedge {
    /// The edge.
    pub edge: EdgeId,
    /// Whether the loop runs along the edge, not against it.
    pub forward: bool,
    /// The edge in the face's parameters. It has the domain and the direction of the **edge** curve, also where
    /// `forward` is false: the surface at `pcurve(t)` is the edge curve at `t`.
    pub pcurve: Curve<DVec2>,
}

/// A closed chain of edges.
#[derive(Clone, Debug, Default)]
pub struct Loop {
    /// The edges, each ending where the next begins.
    pub coedges: Vec<Coedge>,
}

/// How a face looks and where it belongs in the exports.
#[derive(Clone, Debug, PartialEq)]
pub struct Style {
    /// Layer in STEP, material in the meshes, e.g. `blade` or `chamber/leading`.
    pub layer: String,
    /// Red, green, blue in 0..=1, linear.
    pub color: [f64; 3],
}

/// A named, trimmed surface.
#[derive(Clone, Debug)]
pub struct Face {
    /// Path that says where the face comes from, e.g. `chamber/leading/suction_side`; unique in the model.
    pub name: String,
    /// The surface. It may extend beyond the loops.
    pub surface: SurfaceGeometry,
    /// The outer loop, then the inner ones. In the parameter plane the outer one runs counterclockwise, the inner
    /// ones clockwise: seen against the natural normal (u cross v), material of the face lies to the left.
    pub loops: Vec<Loop>,
    /// Looks.
    pub style: Style,
}

/// A face as a shell uses it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaceUse {
    /// The face.
    pub face: FaceId,
    /// Whether the surface's natural normal points out of the solid.
    pub forward: bool,
}

/// A closed set of faces.
#[derive(Clone, Debug, Default)]
pub struct Shell {
    /// The faces, in a fixed order.
    pub faces: Vec<FaceUse>,
}

/// A named solid: an outer shell, then the shells of its voids.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Name, e.g. `metal`.
    pub name: String,
    /// Shells, all with normals out of the material; the first is the outer one.
    pub shells: Vec<Shell>,
    /// Sum of the genera of the shells that the design implies: what a count must find.
    pub expected_genus: usize,
}

/// Solids that share faces, faces that share edges, edges that share vertices.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// Points of the vertices, mm.
    pub vertices: Vec<DVec3>,
    /// Edges.
    pub edges: Vec<Edge>,
    /// Faces.
    pub faces: Vec<Face>,
    /// Solids.
    pub solids: Vec<Solid>,
}

impl Model {
    /// Adds a vertex.
    pub fn add_vertex(&mut self, point: DVec3) -> VertexId {
        self.vertices.push(point);
        VertexId(self.vertices.len() - 1)
    }

    /// Adds an edge.
    pub fn add_edge(&mut self, start: VertexId, end: VertexId, curve: impl Into<EdgeCurve>) -> EdgeId {
        self.edges.push(Edge { start, end, curve: curve.into() });
        EdgeId(self.edges.len() - 1)
    }

    /// Adds a face.
    pub fn add_face(&mut self, face: Face) -> FaceId {
        self.faces.push(face);
        FaceId(self.faces.len() - 1)
    }

    /// The point of a vertex, mm.
    pub fn vertex(&self, id: VertexId) -> DVec3 {
        self.vertices[id.0]
    }

    /// An edge.
    pub fn edge(&self, id: EdgeId) -> &Edge {
        &self.edges[id.0]
    }

    /// A face.
    pub fn face(&self, id: FaceId) -> &Face {
        &self.faces[id.0]
    }

    /// The solid of this name.
    pub fn solid(&self, name: &str) -> Option<&Solid> {
        self.solids.iter().find(|s| s.name == name)
    }

    /// Vertex at which `coedge` begins as its loop runs.
    pub fn start_of(&self, coedge: &Coedge) -> VertexId {
        let edge = self.edge(coedge.edge);
        if coedge.forward { edge.start } else { edge.end }
    }

    /// Vertex at which `coedge` ends as its loop runs.
    pub fn end_of(&self, coedge: &Coedge) -> VertexId {
        let edge = self.edge(coedge.edge);
        if coedge.forward { edge.end } else { edge.start }
    }
}

impl Solid {
    /// All face uses, shell by shell.
    pub fn faces(&self) -> impl Iterator<Item = FaceUse> + '_ {
        self.shells.iter().flat_map(|s| s.faces.iter().copied())
    }
}

impl Coedge {
    /// Parameter-plane point at fraction 0 (start) or 1 (end) of the way the loop runs.
    pub fn parameter_at(&self, fraction: f64) -> DVec2 {
        let (start, end) = self.pcurve.domain();
        let f = if self.forward { fraction } else { 1.0 - fraction };
        self.pcurve.point(start + (end - start) * f)
    }
}
