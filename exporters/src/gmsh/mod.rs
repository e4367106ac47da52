//! A script that meshes a model with Gmsh.

use crate::ExportError;
use std::io::Write;

/// The script; what is between two `@` is put in.
const SCRIPT: &str = include_str!("script.py");

/// Writes a Python script for Gmsh that meshes the solids of the BREP file `shape` and makes a physical group of each
/// group of the file `manifest` (see [`crate::manifest`]), both beside the script.
///
/// # Errors
/// [`ExportError::Io`].
pub fn write_gmsh_script(
    name: &str,
    shape: &str,
    manifest: &str,
    out: &mut impl Write,
) -> Result<(), ExportError> {
    let script = SCRIPT.replace("@NAME@", name).replace("@SHAPE@", shape).replace("@MANIFEST@", manifest);
    Ok(out.write_all(script.as_bytes())?)
}
