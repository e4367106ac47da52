//! The named boundary representation: trimmed surfaces with parameter curves, shells, solids.
//!
//! Topology is built, never found: whoever adds a face says which edges bound it and where they run in its
//! parameters. Solids share faces, so that metal and coolant meet exactly. Nothing here knows of blades.

mod geometry;
mod model;

pub use geometry::{EdgeCurve, Plane, Revolution, RevolutionKind, SurfaceGeometry};
pub use model::{Coedge, Edge, EdgeId, Face, FaceId, FaceUse, Loop, Model, Shell, Solid, Style, VertexId};
