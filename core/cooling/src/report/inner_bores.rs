//! Tables of the bores inside: crossover holes, pins and dust holes.

use crate::build::{CrossoverGeometry, DustHoleGeometry, PinGeometry};
use serde::Serialize;

/// A crossover hole.
#[derive(Clone, Debug, Serialize)]
pub struct CrossoverReport {
    /// Path of its faces: `crossover/<row>/<number>`.
    pub name: String,
    /// The chambers before and behind the wall.
    pub chambers: [String; 2],
    /// Middle of its axis.
    pub position_mm: [f64; 3],
    /// Unit direction of its axis, from the chamber before the wall to the one behind it.
    pub direction: [f64; 3],
    /// Width normal to the axis.
    pub diameter_mm: f64,
    /// Size along the span.
    pub height_mm: f64,
    /// Length of the axis in the wall.
    pub length_mm: f64,
    /// Flow area normal to the axis.
    pub area_mm2: f64,
    /// Metal to the nearest other bore, if it is near.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ligament_mm: Option<f64>,
}

/// A pin.
#[derive(Clone, Debug, Serialize)]
pub struct PinReport {
    /// Path of its faces: `pin/<array>/<row>/<number>`.
    pub name: String,
    /// The chamber that it stands in.
    pub chamber: String,
    /// Middle of its axis.
    pub position_mm: [f64; 3],
    /// Unit direction of its axis, from the pressure side to the suction side.
    pub direction: [f64; 3],
    /// Diameter.
    pub diameter_mm: f64,
    /// Height: length of the axis in the coolant.
    pub length_mm: f64,
    /// Passage to the nearest other pin, if it is near.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gap_mm: Option<f64>,
}

/// A dust hole.
#[derive(Clone, Debug, Serialize)]
pub struct DustHoleReport {
    /// Path of its faces: `dust_hole/<name>`.
    pub name: String,
    /// Passage that it empties.
    pub passage: String,
    /// Where its axis breaks out.
    pub position_mm: [f64; 3],
    /// Unit direction of its axis, out of the blade.
    pub direction: [f64; 3],
    /// Diameter.
    pub diameter_mm: f64,
    /// Length of the axis in the metal.
    pub length_mm: f64,
    /// Area of the breakout in the tip.
    pub breakout_mm2: f64,
    /// Metal to the border of the tip, to an opening in it or to the nearest other bore.
    pub ligament_mm: f64,
}

impl CrossoverReport {
    pub(super) fn new(hole: &CrossoverGeometry) -> Self {
        let (d, straight) = (hole.diameter, hole.height - hole.diameter);
        Self {
            name: format!("crossover/{}/{:03}", hole.row, hole.number),
            chambers: hole.chambers.clone(),
            position_mm: hole.center.to_array(),
            direction: hole.axis.to_array(),
            diameter_mm: d,
            height_mm: hole.height,
            length_mm: hole.length,
            area_mm2: 0.25 * std::f64::consts::PI * d * d + d * straight,
            ligament_mm: hole.ligament,
        }
    }
}

impl PinReport {
    pub(super) fn new(pin: &PinGeometry) -> Self {
        let [row, number] = pin.place;
        Self {
            name: format!("pin/{}/{row:02}/{number:03}", pin.array),
            chamber: pin.chamber.clone(),
            position_mm: pin.center.to_array(),
            direction: pin.axis.to_array(),
            diameter_mm: pin.diameter,
            length_mm: pin.length,
            gap_mm: pin.gap,
        }
    }
}

impl DustHoleReport {
    pub(super) fn new(hole: &DustHoleGeometry, breakout_mm2: f64) -> Self {
        Self {
            name: format!("dust_hole/{}", hole.name),
            passage: hole.passage.clone(),
            position_mm: hole.exit.to_array(),
            direction: hole.axis.to_array(),
            diameter_mm: hole.diameter,
            length_mm: hole.length,
            breakout_mm2,
            ligament_mm: hole.ligament,
        }
    }
}
