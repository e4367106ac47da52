//! ASCII STL with one named region a face or a group.

use crate::materials::word;
use crate::select::{each_face_once, select};
use crate::{ExportError, Tessellation};
use coolinggen_brep::{FaceUse, Grouping, Model};
use glam::DVec3;
use std::io::Write;

/// Writes the solids as ASCII STL in millimetres, one `solid <face name>` region a face, numbers as the shortest
/// decimals that read back as the same doubles: a vertex has the same text wherever it occurs.
///
/// The format has no solids beyond regions; give the name of one solid where the reader expects a closed surface.
///
/// # Errors
/// [`ExportError::UnknownSolid`], [`ExportError::NoSolid`], [`ExportError::Io`].
pub fn write_stl(
    model: &Model,
    solids: &[&str],
    mesh: &Tessellation,
    out: &mut impl Write,
) -> Result<(), ExportError> {
    for used in select(model, solids)?.iter().flat_map(|s| s.faces()) {
        write_region(&model.face(used.face).name, &[used], mesh, 1.0, out)?;
    }
    Ok(())
}

/// As [`write_stl`], with one region a group, called as `names` says for each of the groups, all lengths times `scale`. A
/// face that two of the solids share stands in the file once, seen from the first of them.
///
/// # Errors
/// [`ExportError::UnknownSolid`], [`ExportError::NoSolid`], [`ExportError::Io`].
pub(crate) fn write_stl_of_groups(
    model: &Model,
    solids: &[&str],
    mesh: &Tessellation,
    (grouping, names): (&Grouping, &[String]),
    scale: f64,
    out: &mut impl Write,
) -> Result<(), ExportError> {
    let mut groups: Vec<Vec<FaceUse>> = vec![Vec::new(); names.len()];
    for met in each_face_once(model, &select(model, solids)?) {
        groups[grouping.index_of(met.used.face)].push(met.used);
    }
    for (name, faces) in names.iter().zip(&groups).filter(|(_, faces)| !faces.is_empty()) {
        write_region(name, faces, mesh, scale, out)?;
    }
    Ok(())
}

fn write_region(
    name: &str,
    faces: &[FaceUse],
    mesh: &Tessellation,
    scale: f64,
    out: &mut impl Write,
) -> Result<(), ExportError> {
    let name = word(name);
    writeln!(out, "solid {name}")?;
    for used in faces {
        let face = &mesh.faces[used.face.0];
        for triangle in mesh.triangles(*used) {
            let corners = triangle.map(|i| mesh.points[face.points[i as usize] as usize]);
            let [a, b, c] = corners;
            // Length first: tiny triangles would underflow in the cross product.
            let n = (b - a).normalize_or_zero().cross((c - a).normalize_or_zero()).normalize_or_zero();
            writeln!(out, "facet normal {}\nouter loop", Triple(n))?;
            for p in corners {
                writeln!(out, "vertex {}", Triple(p * scale))?;
            }
            writeln!(out, "endloop\nendfacet")?;
        }
    }
    writeln!(out, "endsolid {name}")?;
    Ok(())
}

/// Three shortest round-trip decimals.
pub(crate) struct Triple(pub(crate) DVec3);

impl std::fmt::Display for Triple {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // Adding zero turns -0 into 0.
        write!(f, "{} {} {}", self.0.x + 0.0, self.0.y + 0.0, self.0.z + 0.0)
    }
}
