//! Slots: bores of rounded rectangles from the trailing chamber through the trailing edge, straight or with the pressure
//! side cut back.

mod slot;
mod walls;

use super::blank::Blank;
use super::error::BuildError;
use super::sections::{Section, over_span};
use crate::plan::SlotRowPlan;
use coolinggen_blade::{Fault, Region};
use coolinggen_brep::FaceId;
use coolinggen_nurbs::{Curve, ParametricCurve};
use glam::DVec3;
pub(super) use slot::PlannedSlot;
use slot::Slot;
use walls::Surroundings;

/// A slot as built.
#[derive(Clone, Debug)]
pub struct SlotGeometry {
    /// Name of its row.
    pub row: String,
    /// Number in the row, from 1 at the hub.
    pub number: usize,
    /// The passage that feeds it.
    pub passage: String,
    /// Where the axis breaks out, mm.
    pub exit: DVec3,
    /// Unit direction of the axis, out of the blade.
    pub axis: DVec3,
    /// Height along the span and width across the blade, mm.
    pub size: [f64; 2],
    /// Length of the axis in the metal, mm.
    pub length: f64,
    /// Metal to the next slot of the row, mm; none for a lone slot.
    pub land: Option<f64>,
    /// Thinnest metal beside the slot: to the suction side, and to the pressure side as far as that reaches, mm; none
    /// where the side ends before the slot begins.
    pub side_walls: [Option<f64>; 2],
    /// Length of the open part behind the lip along the axis, mm, if the pressure side is cut back.
    pub open_length: Option<f64>,
    /// Faces of the breakout in the outer surface.
    pub exits: Vec<FaceId>,
}

/// The middle of the trailing edge and the middle of the trailing chamber's end, over the span.
struct TrailingEdge {
    edge: Curve<DVec3>,
    tail: Curve<DVec3>,
}

/// Widths of the trailing edge that a chamber must end ahead of the middle between the sides' ends for that to give the
/// slots their direction.
const LEAST_AHEAD: f64 = 2.0;

impl TrailingEdge {
    fn new(sections: &[Section], tails: &[DVec3]) -> Result<Self, BuildError> {
        // Ends of the sides, where the trailing edge begins, in the chart.
        let ends = |s: &Section| {
            let (start, end) = s.outline.domain();
            [start, end].map(|u| s.outline.curve().point(u))
        };
        let between = |s: &Section| {
            let [a, b] = ends(s);
            s.stream.to_space(0.5 * (a + b))
        };
        // A chamber may end about the centre of a round trailing edge: there the slots aim at the end of the camber line.
        let near = |(s, tail): (&Section, &DVec3)| {
            let [a, b] = ends(s).map(|q| s.stream.to_space(q));
            between(s).distance(*tail) < LEAST_AHEAD * a.distance(b)
        };
        let blunt = sections.iter().zip(tails).any(near);
        let edge = |s: &Section| if blunt { s.stream.to_space(s.camber.at(1.0).center) } else { between(s) };
        Ok(Self {
            edge: over_span(sections, |i| edge(&sections[i]))?,
            tail: over_span(sections, |i| tails[i])?,
        })
    }

    /// A point near the trailing edge's middle, the direction out of the blade and the one towards the tip.
    fn frame(&self, v: f64) -> (DVec3, DVec3, DVec3) {
        let [edge, up, _] = self.edge.derivatives(v);
        let out = (edge - self.tail.point(v)).normalize();
        (edge, out, (up - out * up.dot(out)).normalize())
    }
}

/// Drills all rows of slots; `tails` are the middles of the trailing chamber's end on each section. Metal between
/// neighbours and beside them must be `least` mm.
pub(super) fn add_slot_rows(
    blank: &mut Blank<'_>,
    sections: &[Section],
    tails: &[DVec3],
    rows: &[SlotRowPlan],
    least: f64,
) -> Result<Vec<SlotGeometry>, BuildError> {
    if rows.is_empty() {
        return Ok(Vec::new());
    }
    let edge = TrailingEdge::new(sections, tails)?;
    let around = Surroundings {
        passages: blank.passage_caster(),
        outer: blank.caster(&blank.outer.clone()),
        sides: [Region::SuctionSide, Region::PressureSide].map(|side| blank.outer_caster(side)),
    };
    let (mut made, mut faults) = (Vec::new(), Vec::new());
    for (k, row) in rows.iter().enumerate() {
        let ends = row.span.map(|v| edge.edge.point(v));
        let length = ends[0].distance(ends[1]);
        let count = row.slots.on(length);
        let land = (count > 1).then(|| length / count as f64 - row.height);
        let pointer = format!("/cooling/slot_rows/{k}");
        if let Some(land) = land.filter(|land| !(*land > 0.0 && *land >= least)) {
            let message = if land > 0.0 {
                format!("slots of row \"{}\" leave {land:.3} mm between them", row.name)
            } else {
                format!("slots of row \"{}\" overlap by {:.3} mm", row.name, -land)
            };
            let fault = Fault::new(format!("{pointer}/height"), "ligament", message);
            faults.push(fault.value(row.height).max(row.height + land - least).unit("mm"));
            continue;
        }
        for i in 0..count {
            blank.watch.go_on()?;
            let v = row.span[0] + (row.span[1] - row.span[0]) * (i as f64 + 0.5) / count as f64;
            let slot = Slot { row, pointer: &pointer, number: i + 1, frame: edge.frame(v), land, least };
            match slot.drill(blank, &around) {
                Ok(slot) => made.push(slot),
                Err(fault) => faults.push(fault),
            }
        }
    }
    if faults.is_empty() { Ok(made) } else { Err(BuildError::Refused(faults)) }
}
