//! The named boundary representation: trimmed surfaces with parameter curves, shells, solids.
//!
//! Topology is built, never found: whoever adds a face says which edges bound it and where they run in its
//! parameters. Solids share faces, so that metal and coolant meet exactly. Nothing here knows of blades.
//!
//! - Build: [`Model`] with [`Model::patch_face`] and [`Model::trimmed_face`], which make the parameter curves.
//! - Check: [`Model::check_solid`] counts edges and genus, and measures how closely edges keep to faces.
//! - Weigh: [`face_integrals`] and [`Model::solid_mass`], exact areas, volumes and centroids.
//! - Group: [`Grouping`], faces that are treated alike, and short names.
//! - Ask: [`Model::solid_bounds`], [`FaceDomain::contains`], [`FaceDomain::samples`].
//!
//! Lengths in mm, angles in radians. No function panics on a model, whatever is wrong with it, but those that
//! take an index of something the model does not have.

mod boundary;
mod bounds;
mod build;
mod cast;
mod check;
mod cursor;
mod domain;
mod foot;
mod gauss;
mod geometry;
mod group;
mod imprint;
mod lanes;
mod mass;
mod measures;
mod memo;
mod model;
mod probe;
mod sample;
mod span;

pub use bounds::{BOUNDS_TOLERANCE_MM, Bounds};
pub use build::{BORDER_TOLERANCE_MM, BuildError, LoopEdges, Pcurve, interpolated_pcurve, straight_pcurve};
pub use cast::{CastHit, Caster};
pub use check::{EDGE_TOLERANCE_MM, EdgePlace, Fault, SolidCheck, VERTEX_TOLERANCE_MM, deviation_amid_spans};
pub use domain::{FaceDomain, signed_area};
pub use geometry::{EdgeCurve, Plane, Revolution, RevolutionKind, SurfaceGeometry};
pub use group::{Group, Grouping};
pub use imprint::{Imprint, RingPiece};
pub use mass::{FaceIntegrals, SolidMass, face_integrals};
pub use measures::{Checked, Measures, Numbered};
pub use memo::{Content, Key, Memo};
pub use model::{Coedge, Edge, EdgeId, Face, FaceId, FaceUse, Loop, Model, Shell, Solid, Style, VertexId};
pub use probe::SurfaceProbe;
pub use sample::FaceSamples;
