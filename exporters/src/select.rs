//! Which solids of a model are exported.

use crate::ExportError;
use coolinggen_brep::{FaceUse, Model, Solid};

/// The solids of these names in the order of the names; all solids for an empty list.
pub(crate) fn select<'a>(model: &'a Model, names: &[&str]) -> Result<Vec<&'a Solid>, ExportError> {
    let chosen: Vec<&Solid> = if names.is_empty() {
        model.solids.iter().collect()
    } else {
        let find = |name: &&str| {
            model.solid(name).ok_or_else(|| ExportError::UnknownSolid {
                name: (*name).to_owned(),
                known: model.solids.iter().map(|s| s.name.clone()).collect(),
            })
        };
        names.iter().map(find).collect::<Result<_, _>>()?
    };
    if chosen.is_empty() {
        return Err(ExportError::NoSolid);
    }
    for solid in &chosen {
        check(model, solid)?;
    }
    Ok(chosen)
}

/// A face of some solids.
#[derive(Clone, Copy)]
pub(crate) struct Met {
    /// The face as the first of the solids uses it.
    pub(crate) used: FaceUse,
    /// How many of the solids use it.
    pub(crate) times: usize,
}

/// The faces of solids, each once, in the order in which the solids meet them.
pub(crate) fn each_face_once(model: &Model, solids: &[&Solid]) -> Vec<Met> {
    let mut place: Vec<Option<usize>> = vec![None; model.faces.len()];
    let mut met: Vec<Met> = Vec::new();
    for used in solids.iter().flat_map(|s| s.faces()) {
        match place[used.face.0] {
            Some(known) => met[known].times += 1,
            None => {
                place[used.face.0] = Some(met.len());
                met.push(Met { used, times: 1 });
            }
        }
    }
    met
}

/// What every exporter takes for granted: no empty shell, and no face without a border.
fn check(model: &Model, solid: &Solid) -> Result<(), ExportError> {
    let bad = |at: &str, what| Err(ExportError::BadTopology { at: at.to_owned(), what });
    if solid.shells.is_empty() || solid.shells.iter().any(|s| s.faces.is_empty()) {
        return bad(&solid.name, "a shell without faces");
    }
    for used in solid.faces() {
        let Some(face) = model.faces.get(used.face.0) else {
            return bad(&solid.name, "a shell names a face that is not in the model");
        };
        if face.loops.is_empty() || face.loops.iter().any(|l| l.coedges.is_empty()) {
            return bad(&face.name, "a face without a border");
        }
        if face.loops.iter().flat_map(|l| &l.coedges).any(|c| c.edge.0 >= model.edges.len()) {
            return bad(&face.name, "a loop names an edge that is not in the model");
        }
    }
    Ok(())
}
