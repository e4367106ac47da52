//! Dust holes through the tip.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A round hole from a chamber, or from the turn at its end, through the metal at the tip, by which dust leaves.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DustHole {
    /// Name, unique among the dust holes.
    #[schemars(regex(pattern = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$"))]
    pub name: String,
    /// Name of the chamber.
    pub chamber: String,
    /// Where the axis leaves the chamber's end at the tip: fraction of the chamber's camber line there, from its front to
    /// its back.
    #[schemars(range(min = 0.0, max = 1.0), extend("unit" = "fraction of the chamber"))]
    pub position: f64,
    /// Diameter, mm.
    #[schemars(range(min = 0.01, max = 100.0), extend("unit" = "mm"))]
    pub diameter: f64,
    /// Angle between the axis and the tip surface's normal, degrees.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 60.0), extend("unit" = "deg"))]
    pub inclination_deg: f64,
    /// Where an inclined axis leans to: 0 towards the trailing edge, 90 towards the suction side, degrees.
    #[serde(default)]
    #[schemars(range(min = -180.0, max = 180.0), extend("unit" = "deg"))]
    pub azimuth_deg: f64,
}
