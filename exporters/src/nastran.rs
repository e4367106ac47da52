//! Nastran bulk data: triangles with a property a group.

use crate::select::{each_face_once, select};
use crate::{ExportError, Tessellation};
use coolinggen_brep::{FaceUse, Grouping, Model};
use std::io::Write;

/// Writes the surfaces of the solids as `CTRIA3` in millimetres, a property a group, with the group's name in the
/// comments that ANSA and HyperMesh write and STAR-CCM+, OpenFOAM and others read. A face that two solids share stands in
/// the file once, seen from the first of them. Coordinates are in fields of 16 characters: ten digits or more.
///
/// # Errors
/// [`ExportError::UnknownSolid`], [`ExportError::NoSolid`], [`ExportError::Io`].
pub fn write_nastran(
    model: &Model,
    solids: &[&str],
    mesh: &Tessellation,
    grouping: &Grouping,
    out: &mut impl Write,
) -> Result<(), ExportError> {
    let faces: Vec<FaceUse> =
        each_face_once(model, &select(model, solids)?).iter().map(|met| met.used).collect();
    let mut groups: Vec<usize> = faces.iter().map(|used| grouping.index_of(used.face)).collect();
    groups.sort_unstable();
    groups.dedup();

    writeln!(out, "$ millimetres\nBEGIN BULK")?;
    for &group in &groups {
        let (id, name) = (group + 1, &grouping.groups()[group].name);
        writeln!(out, "$ANSA_NAME;{id};PSHELL;\n${name}\n$HMNAME PROP{id:>20}\"{name}\"")?;
        writeln!(out, "PSHELL  {id:<8}1       1.")?;
    }
    writeln!(out, "MAT1    1       1.              0.3")?;
    // Number of each point, given when it is first met.
    let mut number = vec![0usize; mesh.points.len()];
    let mut points = 0;
    for used in &faces {
        for &p in &mesh.faces[used.face.0].points {
            if number[p as usize] == 0 {
                points += 1;
                number[p as usize] = points;
                let [x, y, z] = mesh.points[p as usize].to_array().map(field);
                writeln!(out, "{:<8}{points:>16}{:>16}{x}{y}*\n{:<8}{z}", "GRID*", "", "*")?;
            }
        }
    }
    let mut triangles = 0;
    for used in &faces {
        let (face, property) = (&mesh.faces[used.face.0], grouping.index_of(used.face) + 1);
        for triangle in mesh.triangles(*used) {
            triangles += 1;
            let [a, b, c] = triangle.map(|i| number[face.points[i as usize] as usize]);
            writeln!(out, "CTRIA3  {triangles:<8}{property:<8}{a:<8}{b:<8}{c:<8}")?;
        }
    }
    if triangles.max(points) >= 100_000_000 {
        return Err(ExportError::TooLarge { what: "the numbers of triangles or points" });
    }
    writeln!(out, "ENDDATA")?;
    Ok(())
}

/// A real with a point in 16 characters, with as many digits as fit.
fn field(value: f64) -> String {
    let value = value + 0.0;
    let text = format!("{value:?}");
    if text.len() <= 16 && text.contains('.') {
        return format!("{text:>16}");
    }
    let fits = |text: String| (text.len() <= 16).then_some(text);
    let plain =
        (0..15).rev().find_map(|digits| fits(format!("{value:.digits$}")).filter(|t| t.contains('.')));
    let exponent =
        || (0..12).rev().find_map(|digits| fits(format!("{value:.digits$e}")).filter(|t| t.contains('.')));
    // Plain numbers lose digits where they begin with zeros.
    let chosen = if (1e-2..1e9).contains(&value.abs()) { plain.or_else(exponent) } else { exponent() };
    format!("{:>16}", chosen.unwrap_or_else(|| "0.0".to_owned()))
}

#[cfg(test)]
mod tests {
    use super::field;

    #[test]
    fn fields_are_sixteen_characters_with_a_point() {
        for value in [
            0.0,
            -0.0,
            1.0,
            -301.123_456_789_012_3,
            6300.0 / 7.0,
            1e-7,
            -1.234_567_890_123e-17,
            1e12,
            -1e-300,
        ] {
            let text = field(value);
            assert_eq!(text.len(), 16, "{text}");
            assert!(text.contains('.'), "{text}");
            let read: f64 = text.trim().parse().unwrap();
            assert!((read - value).abs() <= 1e-8 * value.abs(), "{text} for {value}");
        }
    }
}
