//! Wall thickness at any point of a built design, for pictures.

use crate::build::{BuildError, Probe};
use crate::generate::Generated;
use coolinggen_brep::{Caster, FaceId, Model};
use coolinggen_nurbs::line_meets_surface;
use glam::DVec3;
use std::collections::HashSet;

/// The metal between passages and the outer surface, as seen from either.
pub struct WallField<'a> {
    probe: Probe<'a>,
    model: &'a Model,
    passages: HashSet<FaceId>,
    outer: HashSet<FaceId>,
    caster: Caster,
    outward: f64,
}

impl<'a> WallField<'a> {
    /// The field of a design.
    pub fn new(generated: &'a Generated) -> Self {
        let blade = &generated.blade;
        Self {
            probe: Probe::new(&generated.surface),
            model: &blade.model,
            passages: blade.passage_faces.iter().copied().collect(),
            outer: blade.outer_faces.iter().copied().collect(),
            caster: Caster::new(&blade.model, blade.passage_faces.iter().copied()),
            outward: if generated.surface.outward { 1.0 } else { -1.0 },
        }
    }

    /// Thickness, mm, at a point of a face with the face's natural normal there. On a passage's side it is the distance to
    /// the outer surface; on the outer surface, the way along the normal to the first passage. None on other faces, and
    /// where there is no passage below.
    ///
    /// # Errors
    /// Where the foot of a point is not found.
    pub fn at(&self, face: FaceId, point: DVec3, normal: DVec3) -> Result<Option<f64>, BuildError> {
        if self.passages.contains(&face) {
            return self.probe.thickness(point).map(Some);
        }
        if !self.outer.contains(&face) {
            return Ok(None);
        }
        let inward = -normal * self.outward;
        let Some(met) = self.caster.first(point, inward, 1e-6) else { return Ok(None) };
        let surface = &self.model.face(met.face).surface;
        let exact = line_meets_surface(surface, point, inward, (met.at.x, met.at.y), met.along);
        Ok(Some(exact.map_or(met.along, |hit| hit.along)))
    }
}
