//! Which solids of a model are exported.

use crate::ExportError;
use coolinggen_brep::{Model, Solid};

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
