//! BREP, the text format of OpenCASCADE's own shapes, version 1.
//!
//! It says all that OpenCASCADE keeps: shared faces and edges, parameter curves, tolerances. A reader has nothing to compute,
//! and solids that share faces in the model share them in the shape. It has no names: faces stand in the order of the
//! model's shells, and the manifest tells them by their places.
//!
//! Format: Open CASCADE Technology, "BRep Format", <https://dev.opencascade.org/doc/overview/html/specification__brep_format.html>.

mod geometry;
mod topology;

use crate::ExportError;
use crate::select::select;
use coolinggen_brep::Model;
use std::io::Write;
use topology::Shapes;

/// Writes the solids of these names (all for an empty list) as one shape in millimetres: a solid, or a compound of solids
/// that share the faces they have in common.
///
/// # Errors
/// [`ExportError::UnknownSolid`], [`ExportError::NoSolid`], [`ExportError::BadTopology`], [`ExportError::Io`].
pub fn write_brep(model: &Model, solids: &[&str], out: &mut impl Write) -> Result<(), ExportError> {
    let chosen = select(model, solids)?;
    let shapes = Shapes::of(model, &chosen)?;
    writeln!(out, "DBRep_DrawableShape\n\nCASCADE Topology V1, (c) Matra-Datavision\nLocations 0")?;
    shapes.write_geometry(out)?;
    shapes.write_topology(out)?;
    Ok(())
}
