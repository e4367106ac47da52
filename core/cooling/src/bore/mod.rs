//! Bores: one idea for film holes, slots, jets, crossovers, pins and dust holes (thesis 4.3 to 4.5, DESIGN 5.5).
//!
//! A bore is a closed family of lines between two surfaces. Its shape is a row of sections across an axis, each a closed
//! chain of arcs and straight lines; between sections it is ruled. The lines of the first and the last stage go on until
//! they meet the surfaces that the bore joins; the hits are the two delimiting curves, interpolated as cubics in the same
//! parameter, and imprinted into the faces they lie on.

mod build;
mod found;
mod legs;
mod ligament;
mod rims;
mod ring;
mod shape;
mod target;

pub(crate) use build::{BoreNames, Bored, Drill, Wholes};
pub(crate) use ligament::{Hull, neighbours};
pub(crate) use rims::{Rim, Rims};
pub(crate) use shape::{BoreShape, Frame, circle, fanned, racetrack, rounded_rectangle, stretched_circle};
pub(crate) use target::Mouth;

use std::fmt;

/// Bores nearer to each other than this meet, whatever the least ligament is, mm.
pub(crate) const TOUCHING: f64 = 1e-6;

/// Why a bore cannot be made.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum BoreError {
    /// A line of the bore does not meet the surface it should end on.
    Misses,
    /// The border of the bore runs over the end of a passage, or over hub or tip; the name of the face it leaves.
    Leaves(String),
    /// The bore's end lies beyond its neighbouring section: the wall is too thin for the shape, or the hole too
    /// oblique. By how much, mm.
    TooShort(f64),
    /// The bore breaks out beyond hub or tip, by how much, mm.
    BeyondEnds(f64),
    /// Its border overlaps another bore's (negative gap) or comes nearer to it than the least ligament, mm.
    Meets { other: String, gap: f64, least: f64 },
    /// A delimiting curve could not be brought within the tolerance of its surface.
    Inaccurate,
    /// A kernel or topology method failed.
    Geometry(String),
}

impl BoreError {
    /// The fault's code.
    pub(crate) fn code(&self) -> &'static str {
        match self {
            Self::Leaves(_) => "leaves_face",
            Self::TooShort(_) => "wall_too_thin",
            Self::BeyondEnds(_) => "leaves_blade",
            Self::Meets { .. } => "ligament",
            Self::Misses | Self::Inaccurate | Self::Geometry(_) => "geometry",
        }
    }
}

impl fmt::Display for BoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Misses => write!(f, "does not meet the surface it should end on"),
            Self::Leaves(face) => write!(f, "runs over the end of {face}"),
            Self::TooShort(by) => write!(f, "is {by:.3} mm too short for its shape"),
            Self::BeyondEnds(by) => write!(f, "breaks out {by:.3} mm beyond hub or tip"),
            Self::Meets { other, gap, .. } if *gap < 0.0 => write!(f, "meets {other} by {:.3} mm", -gap),
            Self::Meets { other, gap, least } => {
                write!(f, "leaves {gap:.3} mm to {other}, {least} mm is the least ligament")
            }
            Self::Inaccurate => write!(f, "meets its surface at too flat an angle"),
            Self::Geometry(message) => write!(f, "{message}"),
        }
    }
}

impl From<coolinggen_nurbs::NurbsError> for BoreError {
    fn from(error: coolinggen_nurbs::NurbsError) -> Self {
        Self::Geometry(error.to_string())
    }
}

impl From<coolinggen_brep::BuildError> for BoreError {
    fn from(error: coolinggen_brep::BuildError) -> Self {
        Self::Geometry(error.to_string())
    }
}
