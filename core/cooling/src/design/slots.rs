//! Slots through the trailing edge.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A row of slots that eject coolant at the trailing edge, with lands between them: straight through it, or with the
/// pressure side cut back.
///
/// How many slots it has is said by one of `count` and `pitch`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SlotRow {
    /// Name, unique among the slot rows.
    #[schemars(regex(pattern = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$"))]
    pub name: String,
    /// Span fractions between which the slots stand, each in the middle of an equal part.
    #[schemars(extend("unit" = "span fraction", "items" = {"type": "number", "minimum": 0.0, "maximum": 1.0}))]
    pub span: [f64; 2],
    /// Number of slots.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 10_000))]
    pub count: Option<u32>,
    /// Greatest distance between neighbouring slots along the span, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.01, max = 10_000.0), extend("unit" = "mm"))]
    pub pitch: Option<f64>,
    /// Size along the span, mm.
    #[schemars(range(min = 0.01, max = 1000.0), extend("unit" = "mm"))]
    pub height: f64,
    /// Size across the blade, mm.
    #[schemars(range(min = 0.01, max = 100.0), extend("unit" = "mm"))]
    pub width: f64,
    /// Radius of the corners, mm; at most half of height and width.
    #[schemars(range(min = 0.001, max = 50.0), extend("unit" = "mm"))]
    pub corner_radius: f64,
    /// Ends the pressure side's wall before the trailing edge; without it the slots are straight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cutback: Option<Cutback>,
}

/// A pressure side cut back: between the lands the slot lies open from a lip to the trailing edge.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cutback {
    /// Thickness of the pressure side's wall at its end, mm, across the slot at half its height.
    #[schemars(range(min = 0.01, max = 100.0), extend("unit" = "mm"))]
    pub lip_thickness: f64,
    /// Angle between the wall's end and the slot's axis, degrees.
    #[serde(default = "steep")]
    #[schemars(range(min = 20.0, max = 80.0), extend("unit" = "deg"))]
    pub lip_angle_deg: f64,
}

fn steep() -> f64 {
    75.0
}
