//! Crossover holes through walls.

use coolinggen_blade::LawSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A row of holes through the wall between two chambers. What they join becomes one coolant solid.
///
/// How many holes it has is said by one of `count` and `pitch`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CrossoverRow {
    /// Name, unique among the crossover rows.
    #[schemars(regex(pattern = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$"))]
    pub name: String,
    /// Name of the wall that the holes pass.
    pub wall: String,
    /// Span fractions between which the holes stand, each in the middle of an equal part.
    #[schemars(extend("unit" = "span fraction", "items" = {"type": "number", "minimum": 0.0, "maximum": 1.0}))]
    pub span: [f64; 2],
    /// Number of holes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 10_000))]
    pub count: Option<u32>,
    /// Greatest distance between neighbouring holes along the wall, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.01, max = 10_000.0), extend("unit" = "mm"))]
    pub pitch: Option<f64>,
    /// Where the middles of the holes lie across the wall's flat faces: 0 at the pressure side's fillets, 1 at the
    /// suction side's.
    #[serde(default = "middle")]
    #[schemars(extend("unit" = "fraction of the wall", "minimum" = 0.0, "maximum" = 1.0))]
    pub position: LawSpec,
    /// Width of a hole normal to its axis, mm; the diameter of a round one.
    #[schemars(extend("unit" = "mm", "minimum" = 0.01, "maximum" = 100.0))]
    pub diameter: LawSpec,
    /// Size along the span over `diameter`: 1 is a round hole, more a racetrack with round ends.
    #[serde(default = "round")]
    #[schemars(range(min = 1.0, max = 20.0), extend("unit" = "diameters"))]
    pub height_d: f64,
    /// Angle between the wall's normal and the axis, which runs towards the trailing edge, towards the tip, degrees.
    #[serde(default = "straight")]
    #[schemars(extend("unit" = "deg", "minimum" = -60.0, "maximum" = 60.0))]
    pub inclination_deg: LawSpec,
    /// Angle between the wall's normal and the axis towards the suction side, degrees.
    #[serde(default = "straight")]
    #[schemars(extend("unit" = "deg", "minimum" = -60.0, "maximum" = 60.0))]
    pub skew_deg: LawSpec,
}

fn middle() -> LawSpec {
    LawSpec::Constant(0.5)
}

fn straight() -> LawSpec {
    LawSpec::Constant(0.0)
}

fn round() -> f64 {
    1.0
}
