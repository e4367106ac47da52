//! The table beside an IGES file: which panel is which face, in what group, and what to set at it.

use crate::ExportError;
use crate::select::select;
use coolinggen_brep::{FaceId, Grouping, Model};
use std::borrow::Cow;
use std::io::Write;

/// Writes the faces of the solids of these names (all for an empty list), each once and in the order of the IGES file, as
/// comma-separated values: alias (the label in the file), face, level, group, role, and a boundary type for a mesher of the
/// fluid, such as CENTAUR. A face between two of the solids is an interface.
///
/// # Errors
/// [`ExportError::UnknownSolid`], [`ExportError::NoSolid`], [`ExportError::BadTopology`], [`ExportError::Io`].
pub fn write_panels(
    model: &Model,
    solids: &[&str],
    grouping: &Grouping,
    out: &mut impl Write,
) -> Result<(), ExportError> {
    let chosen = select(model, solids)?;
    let mut uses = vec![0_usize; model.faces.len()];
    chosen.iter().flat_map(|s| s.faces()).for_each(|used| uses[used.face.0] += 1);
    writeln!(out, "alias,face,level,group,role,boundary")?;
    for FaceId(face) in chosen.iter().flat_map(|s| s.faces()).map(|used| used.face) {
        let count = std::mem::replace(&mut uses[face], 0);
        if count == 0 {
            continue;
        }
        let id = FaceId(face);
        let group = grouping.of(id);
        let boundary = if count > 1 { "interface" } else { boundary(&group.role) };
        let (alias, level) = (grouping.alias(id), grouping.index_of(id) + 1);
        let name = quoted(&model.face(id).name);
        writeln!(out, "{alias},{name},{level},{},{},{boundary}", quoted(&group.name), quoted(&group.role))?;
    }
    Ok(())
}

/// The boundary type that a role suggests: flow enters and leaves through the coolant's openings, all else is wall.
fn boundary(role: &str) -> &'static str {
    match role {
        "coolant_inlet" => "inflow",
        "coolant_outlet" | "film_exit" | "slot_exit" | "tip_exit" => "outflow",
        _ => "viscous wall",
    }
}

/// A field, in quotes where it needs them.
fn quoted(field: &str) -> Cow<'_, str> {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\"")).into()
    } else {
        field.into()
    }
}
