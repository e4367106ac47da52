//! Film holes in rows.

use coolinggen_blade::LawSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A row of film holes.
///
/// Where the row runs is said by one of `surface_position`, `surface_distance` and `camber_position`; how many holes it
/// has by one of `count` and `pitch`. A single hole is a row with a count of 1 whose span begins and ends at one fraction.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FilmRow {
    /// Name, unique among the film rows.
    #[schemars(regex(pattern = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$"))]
    pub name: String,
    /// Side of the blade.
    pub side: Side,
    /// Where the holes break out: fraction of the side's length on each stream surface, from the foremost point to the
    /// trailing edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "fraction of the side", "minimum" = 0.0, "maximum" = 1.0))]
    pub surface_position: Option<LawSpec>,
    /// Where the holes break out: distance along the side on each stream surface, from the foremost point, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "mm", "minimum" = 0.0, "maximum" = 100_000.0))]
    pub surface_distance: Option<LawSpec>,
    /// Where the holes break out: the point of the side that belongs to this fraction of the camber line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "camber fraction", "minimum" = 0.0, "maximum" = 1.0))]
    pub camber_position: Option<LawSpec>,
    /// Span fractions between which the row's holes stand, each in the middle of an equal part.
    #[schemars(extend("unit" = "span fraction", "items" = {"type": "number", "minimum": 0.0, "maximum": 1.0}))]
    pub span: [f64; 2],
    /// Number of holes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 10_000))]
    pub count: Option<u32>,
    /// Greatest distance between neighbouring holes along the span, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.01, max = 10_000.0), extend("unit" = "mm"))]
    pub pitch: Option<f64>,
    /// Shift of the holes towards the tip, as a fraction of their distance: rows of 0.25 and -0.25 stagger.
    #[serde(default)]
    #[schemars(range(min = -0.5, max = 0.5), extend("unit" = "pitches"))]
    pub stagger: f64,
    /// Name of the chamber that feeds the row; without it, the one that each hole meets first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chamber: Option<String>,
    /// The holes.
    pub hole: FilmHole,
}

/// A side of the blade.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The convex side.
    SuctionSide,
    /// The concave side.
    PressureSide,
}

/// A film hole; laws are taken at the hole's span fraction.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FilmHole {
    /// Diameter of the metering part normal to the axis, mm.
    #[schemars(extend("unit" = "mm", "minimum" = 0.01, "maximum" = 100.0))]
    pub diameter: LawSpec,
    /// Angle alpha between the axis and the outer surface, degrees. For showerheads the slant.
    #[schemars(extend("unit" = "deg", "minimum" = 10.0, "maximum" = 90.0))]
    pub inclination_deg: LawSpec,
    /// Compound angle beta: the axis as seen along the surface's normal, from downstream towards the tip, degrees. For
    /// showerheads the skew.
    #[serde(default = "straight")]
    #[schemars(extend("unit" = "deg", "minimum" = -180.0, "maximum" = 180.0))]
    pub compound_deg: LawSpec,
    /// Shape.
    #[serde(default)]
    pub shape: HoleShape,
}

/// Shape of a film hole.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum HoleShape {
    /// Round and straight.
    #[default]
    Cylindrical,
    /// Round, widening all the way to the exit.
    Conical {
        /// Angle of the wall to the axis, degrees.
        #[schemars(range(min = 0.0, max = 30.0), extend("unit" = "deg"))]
        expansion_deg: f64,
    },
    /// A round metering part, then a diffuser that widens to both sides (fan-shaped), towards the surface (laidback) or
    /// both ways: 7-7-7 has 7 degrees each.
    Shaped {
        /// Length of the metering part from the inner breakout along the axis, diameters.
        #[schemars(range(min = 0.1, max = 100.0), extend("unit" = "diameters"))]
        metering_length_d: f64,
        /// Angle of each lateral wall to the axis, degrees.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 30.0), extend("unit" = "deg"))]
        lateral_expansion_deg: f64,
        /// Angle of the downstream wall to the axis, degrees.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 30.0), extend("unit" = "deg"))]
        forward_expansion_deg: f64,
        /// Radius of the exit's corners, diameters.
        #[serde(default = "half")]
        #[schemars(range(min = 0.05, max = 0.5), extend("unit" = "diameters"))]
        corner_radius_d: f64,
    },
    /// Straight with two parallel sides and round ends: a console slot.
    Racetrack {
        /// Width across the axis, diameters; the diameter is its height.
        #[schemars(range(min = 1.05, max = 50.0), extend("unit" = "diameters"))]
        width_d: f64,
    },
}

fn straight() -> LawSpec {
    LawSpec::Constant(0.0)
}

fn half() -> f64 {
    0.5
}
