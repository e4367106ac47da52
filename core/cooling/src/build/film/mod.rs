//! Film holes: from rows to bores between the outer surface and the passages.

mod feed;
mod hole;
#[cfg(test)]
mod tests;

use super::blank::Blank;
use super::error::BuildError;
use super::sides::Sides;
use super::style;
use crate::bore::{BoreNames, Mouth};
use crate::plan::FilmRowPlan;
use coolinggen_blade::Fault;
use coolinggen_brep::{Caster, FaceId};
pub(super) use feed::Feed;
use feed::feed;
use glam::DVec3;
use hole::{Hole, holes};
use std::sync::Arc;

/// A film hole as built.
#[derive(Clone, Debug)]
pub struct FilmHoleGeometry {
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
    /// Diameter of the metering part, mm.
    pub diameter: f64,
    /// Length of the axis in the metal, mm.
    pub length: f64,
    /// Angles to the surface and about its normal, degrees.
    pub angles_deg: [f64; 2],
    /// Area of the exit's section normal to the axis over that of the metering part.
    pub area_ratio: f64,
    /// Width of the exit across the axis over the distance between holes; none for a lone hole.
    pub coverage: Option<f64>,
    /// Metal to the nearest other film hole, mm; none if that is far.
    pub ligament: Option<f64>,
    /// Faces of the breakout in the outer surface.
    pub exits: Vec<FaceId>,
}

/// Drills all rows.
pub(super) fn add_film_rows(
    blank: &mut Blank<'_>,
    sides: &Sides<'_>,
    rows: &[FilmRowPlan],
) -> Result<Vec<FilmHoleGeometry>, BuildError> {
    if rows.is_empty() {
        return Ok(Vec::new());
    }
    let caster = blank.passage_caster();
    let mut faults = Vec::new();
    let mut planned = Vec::new();
    for (k, row) in rows.iter().enumerate() {
        let pointer = format!("/cooling/film_rows/{k}");
        for hole in holes(sides, row, &pointer) {
            blank.watch.go_on()?;
            match known_feed(blank, &caster, &hole) {
                Ok(feed) => planned.push((hole, feed)),
                Err(fault) => faults.push(fault),
            }
        }
    }
    let hulls = planned.iter().map(|(hole, feed)| (feed.hull, hole.label()));
    let least = blank.least_ligament;
    let (ligaments, near) = blank.ligaments.add(hulls, least, |i, what| planned[i].0.fault("ligament", what));
    faults.extend(near);
    // Holes that meet cannot be drilled, and say all there is to say.
    if !faults.is_empty() {
        return Err(BuildError::Refused(faults));
    }
    let mut drilled = Vec::with_capacity(planned.len());
    for ((hole, feed), ligament) in planned.iter().zip(ligaments) {
        blank.watch.go_on()?;
        match drill_hole(blank, hole, feed, ligament) {
            Ok(made) => drilled.push(made),
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok(drilled) } else { Err(BuildError::Refused(faults)) }
}

/// What feeds a hole, now or before.
fn known_feed(blank: &mut Blank<'_>, caster: &Caster, hole: &Hole<'_>) -> Result<Arc<Feed>, Fault> {
    let key = hole.key();
    if let Some(known) = blank.kept.feeds.find(&key) {
        return Ok(known);
    }
    let found = Arc::new(feed(blank, caster, hole)?);
    blank.kept.feeds.keep(key, Arc::clone(&found));
    Ok(found)
}

fn drill_hole(
    blank: &mut Blank<'_>,
    hole: &Hole<'_>,
    feed: &Feed,
    ligament: Option<f64>,
) -> Result<FilmHoleGeometry, Fault> {
    let leaves = || hole.fault("leaves_blade", "breaks out beyond the sides");
    let face = blank.outer_face(hole.at.at).ok_or_else(leaves)?;
    let outer = Mouth { face, at: hole.at.at, z: 0.0 };
    let path = format!("film/{}/{:03}", hole.row.name, hole.number);
    let stages: &[&str] = match feed.shape.sections.len() {
        2 => &["bore"],
        3 => &["metering", "diffuser"],
        _ => &["metering", "transition", "diffuser"],
    };
    let style = style::film();
    let names = BoreNames { path: &path, stages, style: &style };
    let exits = blank
        .bore_out(&feed.shape, feed.passage, [feed.mouth, outer], &names)
        .map_err(|error| hole.fault(error.code(), error))?;
    Ok(FilmHoleGeometry {
        row: hole.row.name.clone(),
        number: hole.number,
        passage: blank.passages[feed.passage].name.clone(),
        exit: hole.at.point,
        axis: hole.axis,
        diameter: 2.0 * hole.radius,
        length: feed.length,
        angles_deg: hole.angles_deg,
        area_ratio: feed.area_ratio,
        coverage: hole.pitch.map(|pitch| feed.width / pitch),
        ligament,
        exits,
    })
}
