//! Why a section cannot be built.

use std::fmt;

/// A geometry that does not exist; lengths in millimetres of the chart.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// No circle fits between the two sides where one must.
    NoInscribedCircle,
    /// The shell is so thick that it leaves the chamber's end no room.
    ShellTooThick {
        /// Thickness of the shell, the mean of both sides, mm in space.
        thickness: f64,
        /// The greatest with which the chamber's end has room.
        greatest: f64,
        /// Radius of the chamber's end.
        end: f64,
    },
    /// A side bends more tightly than the circle between the sides: the camber line would fork into the hump.
    Hump {
        /// Name of the side.
        side: &'static str,
        /// Where, as a fraction of the side from the foremost point, by the blade's parameter.
        fraction: f64,
        /// Radius of the bend.
        bend: f64,
        /// Radius of the circle that touches both sides.
        radius: f64,
    },
    /// The greatest inscribed circle of a chamber is smaller than its end radius.
    ChamberVanishes {
        /// Radius of the greatest circle that fits.
        radius: f64,
        /// Radius needed.
        needed: f64,
    },
    /// The fillets at a wall leave the chamber no room: they overlap, or reach past the chamber's other end.
    FilletTooLarge {
        /// Name of the wall.
        wall: String,
        /// The fillet radius asked for.
        radius: f64,
        /// The greatest radius with which the section can be built.
        greatest: f64,
    },
    /// A wall's fillet touches no point of a side: the wall stands outside the offset profile.
    WallOutside {
        /// Name of the wall.
        wall: String,
        /// How far its mid line stands past the foremost or the last circle between the sides; negative where its
        /// direction misses them.
        past: f64,
    },
    /// The front closure of a chamber reaches past its back closure, on one side or on both: walls that cross, or
    /// stand too near to each other or to an end.
    ChamberTooShort {
        /// What closes the chamber in front and at the back.
        ends: [String; 2],
        /// Length left along the shorter side, negative.
        length: f64,
    },
    /// The circle that ends the leading chamber touches the shell where the blade is too sharp for it.
    NoseTooSharp,
}

impl Refusal {
    /// The same refusal with lengths in space: `scale` is that of the chart, and the radius in question was asked for as
    /// `asked` mm.
    #[must_use]
    pub fn in_space(self, scale: f64, asked: f64) -> Self {
        match self {
            Self::WallOutside { wall, past } => Self::WallOutside { wall, past: past * scale },
            Self::ChamberTooShort { ends, length } => Self::ChamberTooShort { ends, length: length * scale },
            Self::FilletTooLarge { wall, radius, greatest } => {
                Self::FilletTooLarge { wall, radius: asked, greatest: greatest * (asked / radius) }
            }
            Self::ChamberVanishes { radius, needed } => {
                Self::ChamberVanishes { radius: radius * (asked / needed), needed: asked }
            }
            other => other,
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoInscribedCircle => write!(f, "the two sides leave no room for an inscribed circle"),
            Self::ShellTooThick { thickness, greatest, end } => write!(
                f,
                "the shell of {thickness:.3} mm leaves no room for the chamber's end of radius {end:.3} mm; up to \
                 {greatest:.3} mm would"
            ),
            Self::Hump { side, fraction, bend, radius } => write!(
                f,
                "at {:.0} % of the {side} the surface bends with a radius of {bend:.3} mm, as tightly as the circle of \
                 {radius:.3} mm that touches both sides: there is no one camber line past such a hump",
                100.0 * fraction
            ),
            Self::ChamberVanishes { radius, needed } => write!(
                f,
                "the shell leaves room for a circle of radius {radius:.3} mm, the chamber's end needs {needed:.3} mm"
            ),
            Self::FilletTooLarge { wall, radius, greatest } => write!(
                f,
                "fillets of radius {radius:.3} mm do not fit at wall {wall}, the greatest that fits has {greatest:.4} mm"
            ),
            Self::WallOutside { wall, past } if *past > 0.0 => write!(
                f,
                "wall {wall} does not meet both sides of the chamber: it stands {past:.3} mm past the last circle that \
                 fits between them"
            ),
            Self::WallOutside { wall, .. } => {
                write!(f, "wall {wall} runs so that it does not meet both sides of the chamber")
            }
            Self::NoseTooSharp => {
                write!(f, "the shell is too thick for the sharpness of the nose where the chamber ends")
            }
            Self::ChamberTooShort { ends: [front, back], length } => {
                write!(
                    f,
                    "{front} and {back} cross in the chamber or overlap, by {:.3} mm along a side",
                    -length
                )
            }
        }
    }
}
