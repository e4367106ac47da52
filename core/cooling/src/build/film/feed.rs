//! What feeds a film hole.

use super::super::blank::Blank;
use super::hole::Hole;
use crate::bore::{BoreShape, Hull, Mouth};
use coolinggen_blade::Fault;
use coolinggen_brep::Caster;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// What feeds a hole, and the hole's shape between there and the outer surface.
#[derive(Clone, Debug)]
pub(in super::super) struct Feed {
    /// Index of the passage.
    pub(super) passage: usize,
    pub(super) mouth: Mouth,
    pub(super) length: f64,
    pub(super) shape: BoreShape,
    pub(super) area_ratio: f64,
    /// Width of the breakout between the side walls, mm.
    pub(super) width: f64,
    pub(super) hull: Hull,
}

/// Finds the passage that a hole meets first along its axis, and all round its rim.
pub(super) fn feed(blank: &Blank<'_>, caster: &Caster, hole: &Hole<'_>) -> Result<Feed, Fault> {
    const AROUND: u32 = 8;
    let fed_by = |from: DVec3| {
        let met = caster.first(from, -hole.axis, 1e-6)?;
        let passage = blank.passages.iter().position(|p| p.faces.contains(&met.face))?;
        Some((passage, met))
    };
    let none = || hole.fault("reaches_no_chamber", "reaches no chamber along its axis");
    let (passage, met) = fed_by(hole.at.point).ok_or_else(none)?;
    let name = &blank.passages[passage].name;
    let face = &blank.model.face(met.face).name;
    let other = |chamber: &&String| !face.starts_with(&format!("chamber/{chamber}/"));
    if let Some(wanted) = hole.row.chamber.as_ref().filter(other) {
        let what = format!("meets {face} before chamber \"{wanted}\"");
        return Err(hole.fault("other_chamber", what));
    }
    let length = met.along;
    let (shape, area_ratio, width) = hole.shape(length)?;
    for i in 0..AROUND {
        let direction = DVec2::from_angle(f64::from(i) * 2.0 * PI / f64::from(AROUND)) * hole.radius;
        let rim = hole.at.point + shape.frame.vector(direction);
        match fed_by(rim) {
            Some((other, _)) if other == passage => {}
            Some((other, _)) => {
                let what = format!("meets both \"{name}\" and \"{}\"", blank.passages[other].name);
                return Err(hole.fault("meets_wall", what));
            }
            None => return Err(hole.fault("meets_wall", format!("runs past the side of \"{name}\""))),
        }
    }
    let ends = [hole.at.point - hole.axis * length, hole.at.point];
    let hull = Hull { ends, radii: [hole.radius, 0.5 * width] };
    let mouth = Mouth { face: met.face, at: met.at, z: -length };
    Ok(Feed { passage, mouth, length, shape, area_ratio, width, hull })
}
