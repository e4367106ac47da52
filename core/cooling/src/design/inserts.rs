//! Impingement inserts: sheet-metal tubes in chambers, with jets.

use super::SpanEnd;
use coolinggen_blade::LawSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A sheet-metal tube in a chamber, closed at one end. Coolant enters it at the other end, where the chamber opens, and
/// leaves it as jets that impinge on the chamber's sides.
///
/// At its open end the tube ends with the blade. A chamber whose span begins there leaves the gap round the tube open,
/// too; one whose span begins farther in closes it: up to there the tube stands in a seat of metal.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Insert {
    /// Name of the chamber that it stands in; each has one insert at most.
    pub chamber: String,
    /// Distance between the sheet and the chamber's sides, walls and closed end, mm, measured in space. In corners and
    /// where the sides come together at an edge of the blade it is greater; the report says by how much.
    #[schemars(extend("unit" = "mm", "minimum" = 0.01, "maximum" = 1000.0))]
    pub gap: LawSpec,
    /// Thickness of the sheet, mm, measured in space at its sides; corners and rounded ends have it in each section. Its
    /// greatest value is that of the plate at the closed end.
    #[schemars(extend("unit" = "mm", "minimum" = 0.01, "maximum" = 100.0))]
    pub thickness: LawSpec,
    /// Radius of the sheet's outer corners, mm. It exceeds the thickness, and is at least the chamber's fillet radius less
    /// the gap. Without it the corners are concentric with the chamber's, or as sharp as twice the thickness.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "mm", "minimum" = 0.01, "maximum" = 1000.0))]
    pub corner_radius: Option<LawSpec>,
    /// Span fractions at which the tube begins and ends, the plate included; the open end is the blade's: 0 at the hub, 1
    /// at the tip. Without it the closed end keeps the gap to the chamber's end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "span fraction", "items" = {"type": "number", "minimum": 0.0, "maximum": 1.0}))]
    pub span: Option<[f64; 2]>,
    /// The end with the plate; the other one is open.
    #[serde(default = "tip")]
    pub closed_end: SpanEnd,
    /// Arrays of jets.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100))]
    pub jets: Vec<JetArray>,
}

/// Round bores through one side of an insert, normal to the sheet, in rows and columns.
///
/// How many columns stand beside each other along the stream is said by one of `streamwise_pitch_d` and
/// `streamwise_count`; how many rows lie over the span by one of `spanwise_pitch_d` and `spanwise_count`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JetArray {
    /// Name, unique among the arrays of the insert.
    #[schemars(regex(pattern = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$"))]
    pub name: String,
    /// Side of the insert.
    pub side: InsertSide,
    /// Diameter d of the jets, mm.
    #[schemars(range(min = 0.01, max = 100.0), extend("unit" = "mm"))]
    pub diameter: f64,
    /// Part of the side's length, from the leading to the trailing edge (`front`: from the pressure to the suction side,
    /// `back`: from the suction to the pressure side), on which the columns stand, each in the middle of an equal part.
    #[serde(default = "whole")]
    #[schemars(extend("unit" = "fraction of the side", "items" = {"type": "number", "minimum": 0.0, "maximum": 1.0}))]
    pub position: [f64; 2],
    /// Greatest distance x/d between columns, diameters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1.0, max = 1000.0), extend("unit" = "diameters"))]
    pub streamwise_pitch_d: Option<f64>,
    /// Number of columns.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1000))]
    pub streamwise_count: Option<u32>,
    /// Span fractions between which the rows lie, each in the middle of an equal part.
    #[schemars(extend("unit" = "span fraction", "items" = {"type": "number", "minimum": 0.0, "maximum": 1.0}))]
    pub span: [f64; 2],
    /// Greatest distance y/d between rows, diameters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1.0, max = 1000.0), extend("unit" = "diameters"))]
    pub spanwise_pitch_d: Option<f64>,
    /// Number of rows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1000))]
    pub spanwise_count: Option<u32>,
    /// Shift of every second row against the first, as a fraction of the distance between columns: 0 stands in line, 0.5
    /// staggers. All rows stay within `position`.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 0.5), extend("unit" = "pitches"))]
    pub stagger: f64,
}

/// A side of an insert.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InsertSide {
    /// Towards the blade's convex side.
    SuctionSide,
    /// Towards the blade's concave side.
    PressureSide,
    /// Round the front: the leading edge, or the wall there with its corners.
    Front,
    /// Round the back: the wall there with its corners, or the trailing edge.
    Back,
}

fn tip() -> SpanEnd {
    SpanEnd::Tip
}

fn whole() -> [f64; 2] {
    [0.0, 1.0]
}
