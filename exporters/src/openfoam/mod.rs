//! A case for OpenFOAM: closed surfaces, and the dictionaries with which snappyHexMesh makes a mesh with a region a solid.
//!
//! Faces that two solids share are between two regions: all of them come from one surface, in which each face stands once.
//! Lengths are metres, as OpenFOAM wants them.

mod dictionaries;
mod edges;
mod inside;

use crate::boundary::Boundary;
use crate::manifest::FacePlace;
use crate::materials::word;
use crate::select::select;
use crate::stl::write_stl_of_groups;
use crate::{ExportError, Tessellation};
use coolinggen_brep::{FaceId, Grouping, Model, Solid};
use std::collections::HashSet;

/// Metres in a millimetre.
const SCALE: f64 = 1e-3;

/// A file of a case.
#[derive(Clone, Debug)]
pub struct CaseFile {
    /// Path below the case's folder, with slashes.
    pub path: String,
    /// What is in it.
    pub content: Vec<u8>,
}

/// What a case needs to know of a model besides its shape.
pub struct CaseOptions<'a> {
    /// Whether the solid of this name is filled with fluid.
    pub is_fluid: &'a dyn Fn(&str) -> bool,
    /// What is known of the model's faces, in their order: cells must resolve the smallest thing at each group.
    pub places: &'a [FacePlace],
}

/// A region of the mesh: a solid of the model.
struct Region {
    name: String,
    fluid: bool,
    /// A point inside, m.
    inside: [f64; 3],
}

/// A patch: a group of the model.
struct Patch {
    name: String,
    boundary: Boundary,
    feature_mm: Option<f64>,
}

/// The files of a case with all solids of a model.
///
/// # Errors
/// [`ExportError::NoSolid`]; [`ExportError::BadTopology`] where no point inside a solid is found.
pub fn openfoam_case(
    model: &Model,
    mesh: &Tessellation,
    grouping: &Grouping,
    options: &CaseOptions<'_>,
) -> Result<Vec<CaseFile>, ExportError> {
    let solids = select(model, &[])?;
    let regions = solids.iter().map(|s| region(s, mesh, options)).collect::<Result<Vec<_>, _>>()?;
    let names = patch_names(grouping);
    let mut patches: Vec<Patch> = grouping
        .groups()
        .iter()
        .zip(&names)
        .map(|(group, name)| Patch {
            name: name.clone(),
            boundary: Boundary::of_role(&group.role),
            feature_mm: None,
        })
        .collect();
    for (face, place) in options.places.iter().enumerate() {
        let least = &mut patches[grouping.index_of(FaceId(face))].feature_mm;
        *least = [*least, place.feature_mm].into_iter().flatten().reduce(f64::min);
    }

    let mut files = dictionaries::all(mesh, &regions, &patches);
    let surface =
        |path: String, content: Vec<u8>| CaseFile { path: format!("constant/triSurface/{path}"), content };
    let mut blade = Vec::new();
    write_stl_of_groups(model, &[], mesh, (grouping, &names), SCALE, &mut blade)?;
    files.push(surface("blade.stl".to_owned(), blade));
    files.push(surface("blade.eMesh".to_owned(), edges::edge_mesh(model, mesh, grouping)));
    for (solid, region) in solids.iter().zip(&regions) {
        let mut own = Vec::new();
        write_stl_of_groups(model, &[&solid.name], mesh, (grouping, &names), SCALE, &mut own)?;
        files.push(surface(format!("{}.stl", region.name), own));
    }
    Ok(files)
}

fn region(solid: &Solid, mesh: &Tessellation, options: &CaseOptions<'_>) -> Result<Region, ExportError> {
    let inside = inside::point_inside(solid, mesh)
        .ok_or_else(|| ExportError::BadTopology { at: solid.name.clone(), what: "its mesh has no inside" })?;
    let fluid = (options.is_fluid)(&solid.name);
    Ok(Region { name: plain(&solid.name), fluid, inside: (inside * SCALE).to_array() })
}

/// Names of patches: those of the groups as words; where two come to the same word, the later with its alias.
fn patch_names(grouping: &Grouping) -> Vec<String> {
    let mut taken = HashSet::new();
    let unique = |group: &coolinggen_brep::Group| {
        let name = plain(&group.name);
        if taken.insert(name.clone()) { name } else { format!("{name}_{}", group.alias) }
    };
    grouping.groups().iter().map(unique).collect()
}

/// A name as a word of OpenFOAM: letters, digits, `_`, `.` and `-`.
fn plain(name: &str) -> String {
    word(name).chars().map(|c| if c.is_alphanumeric() || "_.-".contains(c) { c } else { '_' }).collect()
}
