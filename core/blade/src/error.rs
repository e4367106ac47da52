//! Questions to the space or the blade that have no answer.

use coolinggen_nurbs::NurbsError;
use std::fmt;

/// Why a call on the stream space or the blade has no answer.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum BladeError {
    /// A span fraction outside of what the space is extrapolated to.
    SpanFraction {
        /// The span fraction asked for.
        v: f64,
    },
    /// A point that lies in no stream surface between the ends of the contours.
    OutsideContours {
        /// Axial position, mm.
        x: f64,
        /// Radius, mm.
        r: f64,
    },
    /// A parameter line of the blade that does not meet a stream surface.
    NoCrossing {
        /// Parameter of the line.
        u: f64,
        /// Span fraction of the stream surface.
        v: f64,
        /// Distance left, mm.
        distance: f64,
    },
    /// A method of the kernel failed.
    Nurbs(NurbsError),
}

impl fmt::Display for BladeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SpanFraction { v } => write!(f, "span fraction {v} is outside [-0.15, 1.15]"),
            Self::OutsideContours { x, r } => {
                write!(f, "x = {x:.4} mm, r = {r:.4} mm lies beyond the ends of hub and shroud")
            }
            Self::NoCrossing { u, v, distance } => write!(
                f,
                "the blade's line u = {u} does not meet the stream surface v = {v} ({distance} mm are left)"
            ),
            Self::Nurbs(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for BladeError {}

impl From<NurbsError> for BladeError {
    fn from(error: NurbsError) -> Self {
        Self::Nurbs(error)
    }
}
