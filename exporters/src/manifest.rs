//! The manifest: which face is which, in every file, by its place and not by its number.

use coolinggen_brep::{Bounds, FaceId, Grouping, Model};
use serde_json::{Value, json};

/// Version of the manifest's format.
pub const MANIFEST_FORMAT: &str = "coolinggen-groups/1";

/// What is known of a face besides its name.
#[derive(Clone, Copy, Debug)]
pub struct FacePlace {
    /// Area, mm2.
    pub area_mm2: f64,
    /// Centre of the area, mm.
    pub centroid_mm: [f64; 3],
    /// Size of the hole, slot, pin or wall that it belongs to, mm: what a mesh must resolve there.
    pub feature_mm: Option<f64>,
}

/// A file and the solids in it.
#[derive(Clone, Debug)]
pub struct Listed {
    /// Name of the file, without its folder.
    pub file: String,
    /// Names of the solids, in their order in the file.
    pub solids: Vec<String>,
}

/// The manifest of a model: its groups, its faces with group, role, colour, alias, area, centroid and box, the faces of each
/// solid in the order in which CAD files have them, and what solids each of `files` holds. `places` are those of the
/// model's faces in their order.
pub fn manifest(model: &Model, grouping: &Grouping, places: &[FacePlace], files: &[Listed]) -> Value {
    let mut solids_of: Vec<Vec<&str>> = vec![Vec::new(); model.faces.len()];
    for solid in &model.solids {
        for used in solid.faces() {
            solids_of[used.face.0].push(&solid.name);
        }
    }
    let mut counts = vec![0usize; grouping.groups().len()];
    let mut interfaces = vec![true; grouping.groups().len()];
    let mut faces = Vec::with_capacity(model.faces.len());
    for (index, (face, place)) in model.faces.iter().zip(places).enumerate() {
        let id = FaceId(index);
        let (group, solids) = (grouping.of(id), &solids_of[index]);
        counts[grouping.index_of(id)] += 1;
        interfaces[grouping.index_of(id)] &= solids.len() > 1;
        let Bounds { min, max } = model.face_bounds(face);
        faces.push(json!({
            "name": face.name,
            "alias": grouping.alias(id),
            "group": group.name,
            "role": group.role,
            "color": face.style.color,
            "area_mm2": place.area_mm2,
            "centroid_mm": place.centroid_mm,
            "feature_mm": place.feature_mm,
            "bounding_box_mm": { "min": min.to_array(), "max": max.to_array() },
            "solids": solids,
        }));
    }
    let groups =
        grouping.groups().iter().zip(counts.iter().zip(interfaces)).map(|(group, (count, interface))| {
            json!({
                "name": group.name,
                "alias": group.alias,
                "role": group.role,
                "color": group.color,
                "faces": count,
                "interface": interface,
            })
        });
    let name = |id: FaceId| model.face(id).name.as_str();
    let solids = model.solids.iter().map(|solid| {
        let faces: Vec<&str> = solid.faces().map(|used| name(used.face)).collect();
        json!({ "name": solid.name, "faces": faces })
    });
    let files = files.iter().map(|listed| json!({ "file": listed.file, "solids": listed.solids }));
    json!({
        "format": MANIFEST_FORMAT,
        "unit": "mm",
        "files": files.collect::<Vec<_>>(),
        "groups": groups.collect::<Vec<_>>(),
        "solids": solids.collect::<Vec<_>>(),
        "faces": faces,
    })
}
