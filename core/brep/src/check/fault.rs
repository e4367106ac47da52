//! What can be wrong with a solid.

use crate::model::{EdgeId, VertexId};
use std::fmt;

/// Something wrong with a solid, with the faces concerned by name.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// A face that the model does not have.
    NoFace {
        /// Its index.
        index: usize,
    },
    /// An edge that the model does not have.
    NoEdge {
        /// Face whose loop asks for it.
        face: String,
        /// The edge.
        edge: EdgeId,
    },
    /// An edge at a vertex that the model does not have.
    NoVertex {
        /// Face whose loop uses the edge.
        face: String,
        /// The edge.
        edge: EdgeId,
    },
    /// An edge that starts and ends in the same vertex.
    ClosedEdge {
        /// Face whose loop uses it.
        face: String,
        /// The edge.
        edge: EdgeId,
    },
    /// A name that is empty or used by several faces of the model.
    Name {
        /// The name.
        name: String,
        /// Faces that have it.
        count: usize,
    },
    /// A face used more than once.
    FaceUsedTwice {
        /// The face.
        face: String,
    },
    /// A face without loops, or a loop without edges.
    EmptyLoop {
        /// The face.
        face: String,
        /// Index of the loop.
        index: usize,
    },
    /// A loop whose next edge does not start where the last one ends.
    OpenLoop {
        /// The face.
        face: String,
        /// Index of the loop.
        index: usize,
        /// The edge after which it breaks.
        edge: EdgeId,
    },
    /// An edge that does not join exactly two faces of a shell.
    EdgeUses {
        /// The edge.
        edge: EdgeId,
        /// The faces that use it, once for each use.
        faces: Vec<String>,
    },
    /// An edge that its two faces run through in the same direction: one of them looks the wrong way.
    EdgeSense {
        /// The edge.
        edge: EdgeId,
        /// The faces.
        faces: [String; 2],
    },
    /// A shell in several pieces.
    PartedShell {
        /// Index of the shell.
        shell: usize,
        /// One face of each piece.
        faces: Vec<String>,
    },
    /// A vertex in which a shell touches itself.
    PinchedVertex {
        /// The vertex.
        vertex: VertexId,
        /// One face of each of the fans that meet there.
        faces: Vec<String>,
    },
    /// Not the genus that the design implies.
    Genus {
        /// Genus found, if the shells are closed surfaces.
        found: Option<usize>,
        /// Genus implied.
        expected: usize,
    },
    /// The end of an edge's curve is not at its vertex.
    VertexGap {
        /// A face that uses the edge.
        face: String,
        /// The edge.
        edge: EdgeId,
        /// Distance, mm.
        gap_mm: f64,
    },
    /// A parameter curve without the domain of its edge.
    PcurveDomain {
        /// The face.
        face: String,
        /// The edge.
        edge: EdgeId,
    },
    /// A parameter curve whose image is not the edge.
    EdgeDeviation {
        /// The face.
        face: String,
        /// The edge.
        edge: EdgeId,
        /// Greatest distance, mm.
        deviation_mm: f64,
    },
    /// A loop that jumps in the parameter plane, and not in a pole.
    ParameterGap {
        /// The face.
        face: String,
        /// Index of the loop.
        index: usize,
        /// The edge after which it jumps.
        edge: EdgeId,
        /// How far the jump leads away from the vertex, mm.
        gap_mm: f64,
    },
    /// An outer loop that runs clockwise in the parameter plane, or an inner one that runs counterclockwise.
    LoopSense {
        /// The face.
        face: String,
        /// Index of the loop; the outer one is 0.
        index: usize,
        /// Area enclosed in the parameter plane, positive if counterclockwise.
        area: f64,
    },
}

impl Fault {
    /// Whether the solid is not watertight because of it.
    pub(super) fn leaks(&self) -> bool {
        !matches!(
            self,
            Self::Name { .. } | Self::Genus { .. } | Self::PinchedVertex { .. } | Self::LoopSense { .. }
        )
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoFace { index } => write!(f, "face {index} does not exist"),
            Self::NoEdge { face, edge } => write!(f, "{face}: edge {} does not exist", edge.0),
            Self::NoVertex { face, edge } => write!(f, "{face}: edge {} has no vertex", edge.0),
            Self::ClosedEdge { face, edge } => {
                write!(f, "{face}: edge {} starts and ends in the same vertex", edge.0)
            }
            Self::Name { name, .. } if name.is_empty() => write!(f, "a face has no name"),
            Self::Name { name, count } => write!(f, "{count} faces have the name {name}"),
            Self::FaceUsedTwice { face } => write!(f, "{face}: used more than once"),
            Self::EmptyLoop { face, index } => write!(f, "{face}: loop {index} has no edges"),
            Self::OpenLoop { face, index, edge } => {
                write!(f, "{face}: loop {index} breaks after edge {}", edge.0)
            }
            Self::EdgeUses { edge, faces } => {
                write!(f, "edge {} joins {} faces, not 2: {}", edge.0, faces.len(), faces.join(", "))
            }
            Self::EdgeSense { edge, faces: [a, b] } => {
                write!(f, "edge {} is run through in the same direction by {a} and {b}", edge.0)
            }
            Self::PartedShell { shell, faces } => {
                write!(f, "shell {shell} is in {} pieces, with {}", faces.len(), faces.join(", "))
            }
            Self::PinchedVertex { vertex, faces } => {
                write!(f, "the shell touches itself in vertex {}: {}", vertex.0, faces.join(", "))
            }
            Self::Genus { found: Some(found), expected } => write!(f, "genus {found}, {expected} expected"),
            Self::Genus { found: None, expected } => {
                write!(f, "no closed surface, genus {expected} expected")
            }
            Self::VertexGap { face, edge, gap_mm } => {
                write!(f, "{face}: edge {} ends {gap_mm:e} mm from its vertex", edge.0)
            }
            Self::PcurveDomain { face, edge } => {
                write!(f, "{face}: the parameter curve of edge {} has another domain", edge.0)
            }
            Self::EdgeDeviation { face, edge, deviation_mm } => {
                write!(f, "{face}: edge {} is {deviation_mm:e} mm off", edge.0)
            }
            Self::ParameterGap { face, index, edge, gap_mm } => {
                write!(f, "{face}: loop {index} jumps by {gap_mm:e} mm after edge {}", edge.0)
            }
            Self::LoopSense { face, index, area } => {
                let way = if *area > 0.0 { "counterclockwise" } else { "clockwise" };
                write!(f, "{face}: loop {index} runs {way}")
            }
        }
    }
}
