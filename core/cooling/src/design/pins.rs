//! Arrays of pins.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An array of round pins between the sides of a chamber: rows along the span, one behind the other. They may end on
/// the fillets beside the sides, not on a wall.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PinArray {
    /// Name, unique among the pin arrays.
    #[schemars(regex(pattern = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$"))]
    pub name: String,
    /// Name of the chamber that they stand in.
    pub chamber: String,
    /// Span fractions between which the axes stand.
    #[schemars(extend("unit" = "span fraction", "items" = {"type": "number", "minimum": 0.0, "maximum": 1.0}))]
    pub span: [f64; 2],
    /// Fractions of the outer profile's camber line between which the axes stand; the first row stands at the first.
    #[schemars(extend("unit" = "camber fraction", "items" = {"type": "number", "minimum": 0.0, "maximum": 1.0}))]
    pub camber: [f64; 2],
    /// Diameter, mm.
    #[schemars(range(min = 0.01, max = 100.0), extend("unit" = "mm"))]
    pub diameter: f64,
    /// S/D: distance between neighbouring pins of a row along the span, diameters.
    #[schemars(range(min = 1.0, max = 1000.0), extend("unit" = "diameters"))]
    pub spanwise_pitch_d: f64,
    /// X/D: distance between neighbouring rows along the camber line, diameters.
    #[schemars(range(min = 0.1, max = 1000.0), extend("unit" = "diameters"))]
    pub streamwise_pitch_d: f64,
    /// Shift of every other row towards the tip, as a fraction of the distance between its pins: 0 in line.
    #[serde(default = "half")]
    #[schemars(range(min = 0.0, max = 0.5), extend("unit" = "pitches"))]
    pub stagger: f64,
}

fn half() -> f64 {
    0.5
}
