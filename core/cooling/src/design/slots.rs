//! Slots through the trailing edge.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A row of straight slots that eject coolant through the trailing edge, with lands between them.
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
}
