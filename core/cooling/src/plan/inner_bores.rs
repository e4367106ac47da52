//! Bores that do not meet the sides: crossover holes, pins and dust holes.

use super::{Maker, RowHoles};
use crate::design::{Cooling, CrossoverRow, DustHole, PinArray};
use coolinggen_blade::{Fault, Law, Pointer};

/// A row of crossover holes; see [`crate::design::CrossoverRow`].
#[derive(Clone, Debug, PartialEq)]
pub struct CrossoverRowPlan {
    /// Name.
    pub name: String,
    /// Index in the design's list.
    pub index: usize,
    /// Index of the wall: that of the chamber before it, too.
    pub wall: usize,
    /// Span fractions.
    pub span: [f64; 2],
    /// Number of holes or greatest pitch, mm.
    pub holes: RowHoles,
    /// Fraction of the wall, from the pressure side.
    pub position: Law,
    /// Millimetres.
    pub diameter: Law,
    /// Diameters.
    pub height_d: f64,
    /// Degrees, towards the tip.
    pub inclination_deg: Law,
    /// Degrees, towards the suction side.
    pub skew_deg: Law,
}

/// An array of pins; see [`crate::design::PinArray`].
#[derive(Clone, Debug, PartialEq)]
pub struct PinArrayPlan {
    /// Name.
    pub name: String,
    /// Index in the design's list.
    pub index: usize,
    /// Index of the chamber.
    pub chamber: usize,
    /// Span fractions.
    pub span: [f64; 2],
    /// Camber fractions.
    pub camber: [f64; 2],
    /// Millimetres.
    pub diameter: f64,
    /// Distances along the span and along the camber line, mm.
    pub pitches: [f64; 2],
    /// Fraction of the distance along the span.
    pub stagger: f64,
}

/// A dust hole; see [`crate::design::DustHole`].
#[derive(Clone, Debug, PartialEq)]
pub struct DustHolePlan {
    /// Name.
    pub name: String,
    /// Index in the design's list.
    pub index: usize,
    /// Index of the chamber.
    pub chamber: usize,
    /// Fraction of the chamber's camber line at its end.
    pub position: f64,
    /// Millimetres.
    pub diameter: f64,
    /// Degrees, from the tip surface's normal.
    pub inclination_deg: f64,
    /// Degrees, from downstream towards the suction side.
    pub azimuth_deg: f64,
}

impl Maker {
    /// The index of a name; else a fault that lists the known ones.
    pub(super) fn known<'n>(
        &mut self,
        kind: &str,
        name: &str,
        known: impl Iterator<Item = &'n str>,
        at: &Pointer,
    ) -> Option<usize> {
        let known: Vec<&str> = known.collect();
        let found = known.iter().position(|k| *k == name);
        if found.is_none() {
            let mut fault = Fault::new(at.clone(), "unknown_name", format!("there is no {kind} \"{name}\""));
            if !known.is_empty() {
                fault = fault.hint(format!("one of {}", known.join(", ")));
            }
            self.faults.push(fault.value(name));
        }
        found
    }

    pub(super) fn crossover_rows(&mut self, cooling: &Cooling, list: &Pointer) -> Vec<CrossoverRowPlan> {
        self.unique(cooling.crossover_rows.iter().map(|r| r.name.as_str()), list);
        let rows = cooling.crossover_rows.iter().enumerate();
        rows.filter_map(|(i, row)| self.crossover_row(cooling, i, row, &list.at(i))).collect()
    }

    /// None, with faults, where the row's number is not said once or there is no such wall.
    fn crossover_row(
        &mut self,
        cooling: &Cooling,
        index: usize,
        row: &CrossoverRow,
        at: &Pointer,
    ) -> Option<CrossoverRowPlan> {
        self.ordered_span(row.span, at);
        let wall =
            self.known("wall", &row.wall, cooling.walls.iter().map(|w| w.name.as_str()), &at.at("wall"));
        let numbers = [row.count.map(RowHoles::Count), row.pitch.map(RowHoles::Pitch)];
        let holes = self.one_of(numbers, at, "count or pitch");
        let position = self.law(&row.position, &at.at("position"));
        let diameter = self.law(&row.diameter, &at.at("diameter"));
        let inclination_deg = self.law(&row.inclination_deg, &at.at("inclination_deg"));
        let skew_deg = self.law(&row.skew_deg, &at.at("skew_deg"));
        Some(CrossoverRowPlan {
            name: row.name.clone(),
            index,
            wall: wall?,
            span: row.span,
            holes: holes?,
            position,
            diameter,
            height_d: row.height_d,
            inclination_deg,
            skew_deg,
        })
    }

    pub(super) fn pin_arrays(&mut self, cooling: &Cooling, list: &Pointer) -> Vec<PinArrayPlan> {
        self.unique(cooling.pin_arrays.iter().map(|a| a.name.as_str()), list);
        let arrays = cooling.pin_arrays.iter().enumerate();
        arrays.filter_map(|(i, array)| self.pin_array(cooling, i, array, &list.at(i))).collect()
    }

    /// None, with faults, where there is no such chamber.
    fn pin_array(
        &mut self,
        cooling: &Cooling,
        index: usize,
        array: &PinArray,
        at: &Pointer,
    ) -> Option<PinArrayPlan> {
        self.ordered_span(array.span, at);
        let [start, end] = array.camber;
        if end < start {
            let message = format!("the camber [{start}, {end}] must not end before it starts");
            let fault = Fault::new(at.at("camber"), "order", message).value(end).min(start);
            self.faults.push(fault.unit("camber fraction"));
        }
        let chamber = self.chamber(cooling, &array.chamber, at)?;
        Some(PinArrayPlan {
            name: array.name.clone(),
            index,
            chamber,
            span: array.span,
            camber: array.camber,
            diameter: array.diameter,
            pitches: [array.spanwise_pitch_d, array.streamwise_pitch_d].map(|d| d * array.diameter),
            stagger: array.stagger,
        })
    }

    pub(super) fn dust_holes(&mut self, cooling: &Cooling, list: &Pointer) -> Vec<DustHolePlan> {
        self.unique(cooling.dust_holes.iter().map(|h| h.name.as_str()), list);
        let holes = cooling.dust_holes.iter().enumerate();
        holes.filter_map(|(i, hole)| self.dust_hole(cooling, i, hole, &list.at(i))).collect()
    }

    /// None, with a fault, where there is no such chamber.
    fn dust_hole(
        &mut self,
        cooling: &Cooling,
        index: usize,
        hole: &DustHole,
        at: &Pointer,
    ) -> Option<DustHolePlan> {
        let chamber = self.chamber(cooling, &hole.chamber, at)?;
        Some(DustHolePlan {
            name: hole.name.clone(),
            index,
            chamber,
            position: hole.position,
            diameter: hole.diameter,
            inclination_deg: hole.inclination_deg,
            azimuth_deg: hole.azimuth_deg,
        })
    }

    /// The index of the chamber that the field `chamber` at `at` names, else a fault.
    fn chamber(&mut self, cooling: &Cooling, name: &str, at: &Pointer) -> Option<usize> {
        self.known("chamber", name, cooling.chambers.iter().map(|c| c.name.as_str()), &at.at("chamber"))
    }
}
