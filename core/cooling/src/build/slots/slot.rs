//! One slot: where it runs, whether it fits, and its shape.

use super::super::blank::Blank;
use super::super::style;
use super::SlotGeometry;
use super::walls::{Beside, LipRefusal, Surroundings, runs_into};
use crate::bore::{BoreNames, BoreShape, Frame, Mouth, fanned, rounded_rectangle};
use crate::plan::SlotRowPlan;
use coolinggen_blade::Fault;
use coolinggen_brep::{CastHit, Key};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// A slot to be drilled.
pub(super) struct Slot<'p> {
    pub(super) row: &'p SlotRowPlan,
    /// JSON pointer to the row.
    pub(super) pointer: &'p str,
    pub(super) number: usize,
    /// Point near the edge, direction out of the blade, direction towards the tip.
    pub(super) frame: (DVec3, DVec3, DVec3),
    pub(super) land: Option<f64>,
    /// Least metal beside it, mm.
    pub(super) least: f64,
}

/// A slot that fits.
#[derive(Clone, Debug)]
pub(in super::super) struct PlannedSlot {
    /// Index of the passage.
    passage: usize,
    mouths: [Mouth; 2],
    shape: BoreShape,
    /// Where on the axis the lip is, if the pressure side is cut back.
    lip: Option<f64>,
    side_walls: [Option<f64>; 2],
    exit: DVec3,
    length: f64,
}

impl Slot<'_> {
    fn fault(&self, field: &str, code: &'static str, what: impl std::fmt::Display) -> Fault {
        let message = format!("slot {} of row \"{}\" {what}", self.number, self.row.name);
        Fault::new(format!("{}{field}", self.pointer), code, message)
    }

    /// Drills the slot.
    pub(super) fn drill(&self, blank: &mut Blank<'_>, around: &Surroundings) -> Result<SlotGeometry, Fault> {
        let key = self.key();
        let planned = match blank.kept.slots.find(&key) {
            Some(known) => known,
            None => {
                let planned = Arc::new(self.planned(blank, around)?);
                blank.kept.slots.keep(key, Arc::clone(&planned));
                planned
            }
        };
        let PlannedSlot { passage, mouths, shape, lip, side_walls, exit, length } = &*planned;
        let path = format!("slot/{}/{:03}", self.row.name, self.number);
        let style = style::slot();
        let names = BoreNames { path: &path, stages: &["bore", "cutback"], style: &style };
        let exits = blank
            .bore_out(shape, *passage, *mouths, &names)
            .map_err(|error| self.fault("", error.code(), error))?;
        Ok(SlotGeometry {
            row: self.row.name.clone(),
            number: self.number,
            passage: blank.passages[*passage].name.clone(),
            exit: *exit,
            axis: self.frame.1,
            size: [self.row.height, self.row.width],
            length: *length,
            land: self.land,
            side_walls: *side_walls,
            open_length: lip.map(|z| -z),
            exits,
        })
    }

    /// Everything that it depends on before it is drilled, besides the surfaces around.
    fn key(&self) -> Key {
        let row = self.row;
        let cutback = row.cutback.map(|cutback| (cutback.lip_thickness, cutback.lip_angle_deg));
        Key::of(self.frame).and((row.height, row.width, row.corner_radius)).and((cutback, self.least))
    }

    /// Where the slot runs, and whether it fits.
    fn planned(&self, blank: &Blank<'_>, around: &Surroundings) -> Result<PlannedSlot, Fault> {
        let (edge, axis, up) = self.frame;
        let passage_of = |hit: &CastHit| blank.passages.iter().position(|p| p.faces.contains(&hit.face));
        let none = || self.fault("", "reaches_no_chamber", "reaches no chamber along its axis");
        let inner = around.passages.first(edge, -axis, 0.0).ok_or_else(none)?;
        let passage = passage_of(&inner).ok_or_else(none)?;
        let chamber = edge - axis * inner.along;
        let leaves = || self.fault("", "leaves_blade", "does not reach the trailing edge");
        let outer = around.outer.first(chamber, axis, 1e-6).ok_or_else(leaves)?;
        let length = outer.along;
        let exit = chamber + axis * length;
        let half = 0.5 * DVec2::new(self.row.width, self.row.height);
        let frame = toward_suction_side(around, Frame::along(exit, axis, up), length);
        let own = |hit: &CastHit| passage_of(hit) == Some(passage);
        if !runs_into(&around.passages, &frame, half, own) {
            return Err(self.too_large(half, &blank.passages[passage].name, |half| {
                runs_into(&around.passages, &frame, half, own)
            }));
        }
        let beside = Beside { model: blank.model, sides: &around.sides, frame, half, length };
        let (shape, lip) = self.shape(&beside)?;
        let side_walls = [beside.thinnest(0, 0.0), beside.thinnest(1, lip.unwrap_or(0.0))];
        self.check(side_walls)?;
        let mouths = [
            Mouth { face: inner.face, at: inner.at, z: -length },
            Mouth { face: outer.face, at: outer.at, z: 0.0 },
        ];
        Ok(PlannedSlot { passage, mouths, shape, lip, side_walls, exit, length })
    }

    /// The slot's shape, and where on the axis the lip is if the pressure side is cut back: from there on the slot's
    /// pressure side runs out steeply, and what it leaves is open.
    fn shape(&self, beside: &Beside<'_>) -> Result<(BoreShape, Option<f64>), Fault> {
        let (frame, half, length) = (beside.frame, beside.half, beside.length);
        let outline = rounded_rectangle(-length, -half, half, self.row.corner_radius);
        let Some(cutback) = self.row.cutback else {
            return Ok((BoreShape::straight(frame, outline, length), None));
        };
        let lip = beside.lip(cutback.lip_thickness).map_err(|refusal| {
            let fault = |what| {
                let fault = self.fault("/cutback/lip_thickness", "lip_thickness", what);
                fault.value(cutback.lip_thickness).unit("mm")
            };
            match refusal {
                LipRefusal::AtMost(greatest) => {
                    fault(format!("begins where the pressure side is {greatest:.3} mm thick")).max(greatest)
                }
                LipRefusal::AtLeast(least) => {
                    fault(format!("ends where the pressure side is still {least:.3} mm thick")).min(least)
                }
            }
        })?;
        let reach = half.x;
        let steepness = cutback.lip_angle_deg.to_radians().tan();
        let low = -half - DVec2::X * (reach * steepness);
        let radius = self.row.corner_radius;
        // About the share of a land's lines that end at the trailing edge; the others fan out over the pressure side.
        let share = self.row.width / (self.row.width - lip * steepness);
        let sections = [
            outline,
            rounded_rectangle(lip, -half, half, radius),
            rounded_rectangle(lip + reach, low, half, radius),
        ];
        let sections = sections.map(|section| fanned(section, 1.0 + 1.0 / share)).to_vec();
        Ok((BoreShape { frame, sections }, Some(lip)))
    }

    /// Refuses too little metal beside the slot.
    fn check(&self, side_walls: [Option<f64>; 2]) -> Result<(), Fault> {
        for (wall, side) in side_walls.into_iter().zip(["suction", "pressure"]) {
            let Some(wall) = wall.filter(|wall| !(*wall > 0.0 && *wall >= self.least)) else { continue };
            let what = if wall > 0.0 {
                format!("leaves {wall:.3} mm to the {side} side")
            } else {
                format!("breaks {:.3} mm through the {side} side", -wall)
            };
            // The slot stands in the middle: less width is shared by both sides.
            let greatest = (self.row.width + 2.0 * (wall - self.least)).max(0.0);
            let fault = self.fault("/width", "side_wall", what).value(self.row.width).max(greatest);
            return Err(fault.unit("mm"));
        }
        Ok(())
    }

    /// The fault of a slot that is wider or higher than the chamber, with the greatest size that fits.
    fn too_large(&self, half: DVec2, chamber: &str, fits: impl Fn(DVec2) -> bool) -> Fault {
        let greatest = |at: &dyn Fn(f64) -> DVec2| {
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..30 {
                let middle = 0.5 * (low + high);
                if fits(at(middle)) { low = middle } else { high = middle }
            }
            low
        };
        let width = 2.0 * half.x * greatest(&|part| DVec2::new(half.x * part, half.y));
        let fault = if width > 0.0 {
            self.fault("/width", "meets_wall", format!("is wider than chamber \"{chamber}\""))
                .value(self.row.width)
                .max(width)
        } else {
            let height = 2.0 * half.y * greatest(&|part| DVec2::new(0.0, half.y * part));
            self.fault("/height", "meets_wall", format!("is higher than chamber \"{chamber}\""))
                .value(self.row.height)
                .max(height)
        };
        fault.unit("mm")
    }
}

/// The frame with its x towards the suction side.
fn toward_suction_side(around: &Surroundings, frame: Frame, length: f64) -> Frame {
    let inside = frame.point(DVec2::ZERO, -length);
    if around.sides[0].first(inside, frame.x, 0.0).is_some() {
        return frame;
    }
    Frame { x: -frame.x, y: -frame.y, ..frame }
}
