//! Why a section cannot be built.

use std::fmt;

/// A geometry that does not exist; lengths in millimetres of the chart.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// No circle fits between the two sides where one must.
    NoInscribedCircle,
    /// The greatest inscribed circle of a chamber is smaller than its end radius: the shell leaves no room.
    ChamberVanishes {
        /// Radius of the greatest circle that fits.
        radius: f64,
        /// Radius needed.
        needed: f64,
    },
    /// The two fillets of a wall overlap.
    FilletTooLarge {
        /// Name of the wall.
        wall: String,
        /// The fillet radius asked for.
        radius: f64,
        /// About the greatest radius that leaves a straight part.
        greatest: f64,
    },
    /// A wall's fillet touches no point of a side: the wall stands outside the offset profile.
    WallOutside {
        /// Name of the wall.
        wall: String,
    },
    /// The front closure of a chamber reaches past its back closure.
    ChamberTooShort {
        /// Length left along the shorter side, negative.
        length: f64,
    },
    /// The circle that ends the leading chamber touches the shell where the blade is too sharp for it.
    NoseTooSharp,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoInscribedCircle => write!(f, "the two sides leave no room for an inscribed circle"),
            Self::ChamberVanishes { radius, needed } => write!(
                f,
                "the shell leaves room for a circle of radius {radius:.3} mm, the chamber's end needs {needed:.3} mm"
            ),
            Self::FilletTooLarge { wall, radius, greatest } => write!(
                f,
                "the fillets of radius {radius:.3} mm overlap at wall {wall}; about {greatest:.3} mm would fit"
            ),
            Self::WallOutside { wall } => write!(f, "wall {wall} does not meet both sides of the chamber"),
            Self::NoseTooSharp => {
                write!(f, "the shell is too thick for the sharpness of the nose where the chamber ends")
            }
            Self::ChamberTooShort { length } => {
                write!(f, "the chamber's ends overlap by {:.3} mm", -length)
            }
        }
    }
}
