//! Faces as trimmed surfaces (144), each bounded by curves on its surface (142).

use super::entities::{composite, curve, pcurve};
use super::lines::{Directory, File, Pointer, Status};
use super::patch::{Patch, Place, Side};
use super::{Faces, entities};
use crate::ExportError;
use coolinggen_brep::{Model, Solid};

/// Writes the faces of these solids, each once.
pub(super) fn write(file: &mut File, faces: &mut Faces<'_>, solids: &[&Solid]) -> Result<(), ExportError> {
    let model = faces.model;
    for id in faces.of(solids) {
        let face = model.face(id);
        let patch = Patch::new(face)?;
        let surface = faces.surface(file, id, &patch);
        let loops = patch.loops(model, face);
        let bounds: Vec<Pointer> = loops.iter().map(|sides| bound(file, model, surface, sides)).collect();
        let entry = faces.directory(file, id, Directory::new(144, 0, Status::Independent));
        file.add(&entry, |r| {
            r.pointer(surface);
            // The outer boundary is not that of the surface.
            r.integer(1);
            r.integer(bounds.len() - 1);
            bounds.iter().for_each(|&b| r.pointer(b));
        });
    }
    Ok(())
}

/// A loop as a curve on the surface: in parameters and in space, where a pole has no length.
fn bound(file: &mut File, model: &Model, surface: Pointer, sides: &[Side]) -> Pointer {
    let flat: Vec<Pointer> = sides.iter().map(|side| pcurve(file, &side.curve)).collect();
    let mut space = Vec::with_capacity(sides.len());
    for side in sides {
        if let Place::Edge { id, along } = side.on {
            space.push(curve(file, &model.edge(id).curve, along));
        }
    }
    // How it was made is not said; which of both to take: space where there is a pole, else it is all one.
    let preference = if space.len() < flat.len() { 2 } else { 3 };
    let flat = composite(file, Status::Parametric, &flat);
    let space = entities::composite(file, Status::Dependent, &space);
    file.add(&Directory::new(142, 0, Status::Dependent), |r| {
        r.integer(0);
        [surface, flat, space].into_iter().for_each(|p| r.pointer(p));
        r.integer(preference);
    })
}
