//! The table beside an IGES file: which panel is which face, in what group, and what to set at it.

use crate::ExportError;
use crate::boundary::Boundary;
use crate::select::{each_face_once, select};
use coolinggen_brep::{Grouping, Model};
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
    writeln!(out, "alias,face,level,group,role,boundary")?;
    for met in each_face_once(model, &select(model, solids)?) {
        let id = met.used.face;
        let group = grouping.of(id);
        let boundary = match Boundary::of_role(&group.role) {
            _ if met.times > 1 => "interface",
            Boundary::Inflow => "inflow",
            Boundary::Outflow => "outflow",
            Boundary::Wall => "viscous wall",
        };
        let (alias, level) = (grouping.alias(id), grouping.index_of(id) + 1);
        let name = quoted(&model.face(id).name);
        writeln!(out, "{alias},{name},{level},{},{},{boundary}", quoted(&group.name), quoted(&group.role))?;
    }
    Ok(())
}

/// A field, in quotes where it needs them.
fn quoted(field: &str) -> Cow<'_, str> {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\"")).into()
    } else {
        field.into()
    }
}
