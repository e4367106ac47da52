//! A solid as a model of its own.

use coolinggen_brep::{EdgeId, FaceId, Model, Solid};

/// The faces and edges of `solid` alone, so that what is measured is what this solid costs.
pub(crate) fn alone(model: &Model, solid: &Solid) -> Model {
    let mut out = Model { vertices: model.vertices.clone(), ..Model::default() };
    let mut solid = solid.clone();
    let mut moved = vec![None; model.edges.len()];
    for used in solid.shells.iter_mut().flat_map(|s| &mut s.faces) {
        let mut face = model.face(used.face).clone();
        for coedge in face.loops.iter_mut().flat_map(|l| &mut l.coedges) {
            let EdgeId(old) = coedge.edge;
            coedge.edge = *moved[old].get_or_insert_with(|| {
                out.edges.push(model.edges[old].clone());
                EdgeId(out.edges.len() - 1)
            });
        }
        used.face = FaceId(out.faces.len());
        out.faces.push(face);
    }
    out.solids.push(solid);
    out
}
