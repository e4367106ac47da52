//! Slots: straight bores of rounded rectangles from the trailing chamber through the trailing edge.

use super::blank::Blank;
use super::error::BuildError;
use super::sections::{Section, over_span};
use super::style;
use crate::bore::{BoreNames, BoreShape, Drill, Frame, Mouth, rounded_rectangle};
use crate::plan::SlotRowPlan;
use coolinggen_blade::Fault;
use coolinggen_brep::{CastHit, Caster, FaceId};
use coolinggen_nurbs::{Curve, ParametricCurve};
use glam::{DVec2, DVec3};

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
    /// Faces of the breakout in the outer surface.
    pub exits: Vec<FaceId>,
}

/// The middle of the trailing edge and the middle of the trailing chamber's end, over the span.
struct TrailingEdge {
    edge: Curve<DVec3>,
    tail: Curve<DVec3>,
}

impl TrailingEdge {
    fn new(sections: &[Section], tails: &[DVec3]) -> Result<Self, BuildError> {
        let edge = |s: &Section| {
            let (start, end) = s.outline.domain();
            let curve = s.outline.curve();
            s.stream.to_space(0.5 * (curve.point(start) + curve.point(end)))
        };
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

/// Drills all rows of slots; `tails` are the middles of the trailing chamber's end on each section.
pub(super) fn add_slot_rows(
    blank: &mut Blank<'_>,
    sections: &[Section],
    tails: &[DVec3],
    rows: &[SlotRowPlan],
) -> Result<Vec<SlotGeometry>, BuildError> {
    if rows.is_empty() {
        return Ok(Vec::new());
    }
    let edge = TrailingEdge::new(sections, tails)?;
    let casters = [
        Caster::new(blank.model, blank.passages.iter().flat_map(|p| p.faces.iter().copied())),
        Caster::new(blank.model, blank.outer.iter().copied()),
    ];
    let mut drill = Drill::default();
    let (mut made, mut faults) = (Vec::new(), Vec::new());
    for (k, row) in rows.iter().enumerate() {
        let ends = row.span.map(|v| edge.edge.point(v));
        let length = ends[0].distance(ends[1]);
        let count = row.slots.on(length);
        let land = (count > 1).then(|| length / count as f64 - row.height);
        if let Some(land) = land.filter(|land| !(*land > 0.0)) {
            let message = format!("slots of row \"{}\" overlap by {:.3} mm", row.name, -land);
            let fault = Fault::new(format!("/cooling/slot_rows/{k}/height"), "ligament", message);
            faults.push(fault.value(row.height).max(row.height + land).unit("mm"));
            continue;
        }
        for i in 0..count {
            let v = row.span[0] + (row.span[1] - row.span[0]) * (i as f64 + 0.5) / count as f64;
            let slot = Slot { row, number: i + 1, frame: edge.frame(v), land };
            let drilled = slot.drill(blank, &casters, &mut drill);
            match drilled {
                Ok(slot) => made.push(slot),
                Err((code, what)) => {
                    let message = format!("slot {} of row \"{}\" {what}", i + 1, row.name);
                    faults.push(Fault::new(format!("/cooling/slot_rows/{k}"), code, message));
                }
            }
        }
    }
    if faults.is_empty() { Ok(made) } else { Err(BuildError::Refused(faults)) }
}

/// A slot to be drilled.
struct Slot<'p> {
    row: &'p SlotRowPlan,
    number: usize,
    /// Point near the edge, direction out of the blade, direction towards the tip.
    frame: (DVec3, DVec3, DVec3),
    land: Option<f64>,
}

impl Slot<'_> {
    /// Drills the slot; else a code and what is wrong.
    fn drill(
        &self,
        blank: &mut Blank<'_>,
        [inside, outside]: &[Caster; 2],
        drill: &mut Drill,
    ) -> Result<SlotGeometry, (&'static str, String)> {
        let (edge, axis, up) = self.frame;
        let passage_of = |hit: &CastHit| blank.passages.iter().position(|p| p.faces.contains(&hit.face));
        let none = || ("reaches_no_chamber", "reaches no chamber along its axis".to_owned());
        let inner = inside.first(edge, -axis, 0.0).ok_or_else(none)?;
        let passage = passage_of(&inner).ok_or_else(none)?;
        let chamber = edge - axis * inner.along;
        let outer = outside
            .first(chamber, axis, 1e-6)
            .ok_or_else(|| ("leaves_blade", "does not reach the trailing edge".to_owned()))?;
        let length = outer.along;
        let exit = chamber + axis * length;
        let frame = Frame::along(exit, axis, up);
        let half = 0.5 * DVec2::new(self.row.width, self.row.height);
        for corner in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, 0.0), (-1.0, 0.0)] {
            let rim = frame.point(half * DVec2::from(corner), 0.0);
            let met = inside.first(rim, -axis, 0.0).as_ref().and_then(passage_of);
            if met != Some(passage) {
                let what = format!("is wider than chamber \"{}\"", blank.passages[passage].name);
                return Err(("meets_wall", what));
            }
        }
        let outline = rounded_rectangle(-length, -half, half, self.row.corner_radius);
        let shape = BoreShape::straight(frame, outline, length);
        let mouths = [
            Mouth { face: inner.face, at: inner.at, z: -length },
            Mouth { face: outer.face, at: outer.at, z: 0.0 },
        ];
        let path = format!("slot/{}/{:03}", self.row.name, self.number);
        let style = style::slot();
        let names = BoreNames { path: &path, stages: &["bore"], style: &style };
        let exits = blank
            .bore_out(drill, &shape, passage, mouths, &names)
            .map_err(|error| (error.code(), error.to_string()))?;
        Ok(SlotGeometry {
            row: self.row.name.clone(),
            number: self.number,
            passage: blank.passages[passage].name.clone(),
            exit,
            axis,
            size: [self.row.height, self.row.width],
            length,
            land: self.land,
            exits,
        })
    }
}
