//! Why a face could not be made.

use crate::model::EdgeId;
use coolinggen_nurbs::NurbsError;
use std::fmt;

/// A face that cannot be made from what was given.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum BuildError {
    /// A curve could not be made.
    Nurbs(NurbsError),
    /// An edge that the model does not have.
    NoEdge {
        /// The edge asked for.
        edge: EdgeId,
    },
    /// The surface has no borders of its own.
    Unbounded,
    /// An end of an edge does not lie on the border, or does not meet the edge before.
    BorderGap {
        /// 0 at `v = start`, 1 at `u = end`, 2 at `v = end`, 3 at `u = start`.
        border: usize,
        /// The edge.
        edge: EdgeId,
        /// Distance, mm.
        gap_mm: f64,
    },
    /// An edge does not lie on the surface as closely as asked, however fine its parameter curve is made.
    OffSurface {
        /// Greatest distance found, mm.
        distance_mm: f64,
        /// Distance asked for, mm.
        tolerance_mm: f64,
    },
    /// The edges of a loop do not make a closed chain.
    OpenLoop {
        /// Index of the loop.
        index: usize,
        /// What is open between end and start in the parameter plane; infinite if vertices do not match.
        gap: f64,
    },
}

impl From<NurbsError> for BuildError {
    fn from(error: NurbsError) -> Self {
        Self::Nurbs(error)
    }
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nurbs(error) => write!(f, "{error}"),
            Self::NoEdge { edge } => write!(f, "edge {} does not exist", edge.0),
            Self::Unbounded => write!(f, "the surface has no borders of its own: give loops"),
            Self::BorderGap { border, edge, gap_mm } => {
                let border = ["v = start", "u = end", "v = end", "u = start"][border % 4];
                write!(f, "edge {} misses the border {border} by {gap_mm:e} mm", edge.0)
            }
            Self::OffSurface { distance_mm, tolerance_mm } => {
                write!(f, "an edge is {distance_mm:e} mm off its surface, {tolerance_mm:e} mm allowed")
            }
            Self::OpenLoop { index, gap } => {
                write!(f, "loop {index} does not close: {gap:e} open in the parameter plane")
            }
        }
    }
}

impl std::error::Error for BuildError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Nurbs(error) => Some(error),
            _ => None,
        }
    }
}
