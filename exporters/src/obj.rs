//! Wavefront OBJ with a group a face, and its material library.

use crate::materials::{Materials, word};
use crate::select::select;
use crate::stl::Triple;
use crate::{ExportError, Tessellation};
use coolinggen_brep::Model;
use std::io::Write;

/// Writes the solids as OBJ in millimetres and double precision: an object a solid with its own, welded vertices, a
/// group a face with its name, `usemtl` by layer, exact surface normals. `library` is the file name of the
/// materials that [`write_mtl`] writes.
///
/// # Errors
/// [`ExportError::UnknownSolid`], [`ExportError::NoSolid`], [`ExportError::Io`].
pub fn write_obj(
    model: &Model,
    solids: &[&str],
    mesh: &Tessellation,
    library: &str,
    out: &mut impl Write,
) -> Result<(), ExportError> {
    let chosen = select(model, solids)?;
    let materials = Materials::of(model, &chosen);
    writeln!(out, "# millimetres\nmtllib {library}")?;
    let (mut vertices, mut normals) = (0usize, 0usize);
    for solid in chosen {
        writeln!(out, "o {}", word(&solid.name))?;
        // Number of each point within this solid, given when it is first met.
        let mut number = vec![0usize; mesh.points.len()];
        for used in solid.faces() {
            for &p in &mesh.faces[used.face.0].points {
                if number[p as usize] == 0 {
                    vertices += 1;
                    number[p as usize] = vertices;
                    writeln!(out, "v {}", Triple(mesh.points[p as usize]))?;
                }
            }
        }
        for used in solid.faces() {
            let (face, triangles) = (model.face(used.face), &mesh.faces[used.face.0]);
            let material = &materials.list[materials.index(used.face.0)];
            writeln!(out, "g {}\nusemtl {}", word(&face.name), word(&material.name))?;
            for &n in &triangles.normals {
                writeln!(out, "vn {}", Triple(if used.forward { n } else { -n }))?;
            }
            for t in mesh.triangles(used) {
                let [a, b, c] =
                    t.map(|i| (number[triangles.points[i as usize] as usize], normals + 1 + i as usize));
                writeln!(out, "f {}//{} {}//{} {}//{}", a.0, a.1, b.0, b.1, c.0, c.1)?;
            }
            normals += triangles.normals.len();
        }
    }
    Ok(())
}

/// Writes the material library of [`write_obj`]: a diffuse colour a layer.
///
/// # Errors
/// [`ExportError::UnknownSolid`], [`ExportError::NoSolid`], [`ExportError::Io`].
pub fn write_mtl(model: &Model, solids: &[&str], out: &mut impl Write) -> Result<(), ExportError> {
    let chosen = select(model, solids)?;
    for material in Materials::of(model, &chosen).list {
        let [r, g, b] = material.color;
        writeln!(out, "newmtl {}\nKd {r} {g} {b}\nillum 1", word(&material.name))?;
    }
    Ok(())
}
