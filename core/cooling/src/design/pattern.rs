//! The row that the blade is one of.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A row of equal blades around the machine axis, and the walls of the annulus they stand in, each a solid of its own.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pattern {
    /// Number of blades, evenly spread over the turn. Those after the first have the solids of the first, their names
    /// followed by the blade's number.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 200))]
    pub count: u32,
    /// The hub as a solid of its own, `hub`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hub: Option<AnnulusWall>,
    /// The shroud as a solid of its own, `shroud`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shroud: Option<AnnulusWall>,
}

/// A wall of the annulus: a solid of revolution between the contour and a parallel of it, as long as the contour.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AnnulusWall {
    /// Thickness, away from the flow, mm.
    #[schemars(range(min = 0.01, max = 10_000.0), extend("unit" = "mm"))]
    pub thickness: f64,
}

fn one() -> u32 {
    1
}
