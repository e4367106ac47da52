//! Why a turn cannot be built.

use std::fmt;

/// A turn that does not exist; lengths in mm.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum TurnRefusal {
    /// The inner and outer fillets do not fit between the wall's end and the outer side.
    TooLow {
        /// Clearance asked for.
        clearance: f64,
        /// About the least that would do.
        least: f64,
    },
    /// Fillets of one closure overlap where the wall ends.
    FilletTooLarge {
        /// Radius asked for.
        radius: f64,
        /// About the greatest that leaves a straight part.
        greatest: f64,
    },
    /// A fibre across the turn does not meet a side.
    NoSide {
        /// Distance from the wall's mid plane.
        x: f64,
    },
    /// The map of the turn does not reach a chamber's border.
    Unmapped,
    /// A face folds over.
    Fold {
        /// Name of the segment.
        part: &'static str,
    },
    /// The turn comes nearer to the outer surface than the shell allows.
    ThinShell {
        /// Name of the segment.
        part: &'static str,
        /// Metal left.
        found: f64,
        /// Metal asked for.
        asked: f64,
    },
}

impl fmt::Display for TurnRefusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLow { clearance, least } => write!(
                f,
                "a clearance of {clearance:.3} mm does not hold the fillets of both ends; about {least:.3} mm would"
            ),
            Self::FilletTooLarge { radius, greatest } => write!(
                f,
                "fillets of radius {radius:.3} mm overlap where the wall ends; about {greatest:.3} mm would fit"
            ),
            Self::NoSide { x } => {
                write!(f, "{x:.3} mm from the wall the turn meets no side of the shell at the wall's angle")
            }
            Self::Unmapped => write!(f, "the shape between the shell's sides is too uneven for a turn"),
            Self::ThinShell { part, found, asked } => write!(
                f,
                "the turn's {part} leaves {found:.4} mm of metal to the outer surface, {asked:.4} mm are asked for"
            ),
            Self::Fold { part } => write!(f, "the turn's {part} folds over"),
        }
    }
}
