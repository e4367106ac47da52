//! Meshes inside messages.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use coolinggen_brep::{Model, Solid};
use coolinggen_exporters::Tessellation;
use serde_json::{Value, json};

/// The solids of a model: for each the vertices (x, y, z in mm) and unit normals as little-endian 32-bit floats, and
/// triangles as 32-bit vertex indices, counterclockwise from outside, all in base64; and for each of its faces, in
/// their order, the name, the colour and the number of vertices and triangles. Vertices are one a face, so that normals
/// may differ over an edge. `walls` are values of the vertices of every face, to be given with them.
pub(super) fn solids(
    model: &Model,
    mesh: &Tessellation,
    wanted: impl Fn(&str) -> bool,
    walls: Option<&[Vec<f32>]>,
) -> Value {
    let chosen = model.solids.iter().filter(|solid| wanted(&solid.name));
    chosen
        .map(|s| {
            let mut made = solid(model, s, mesh);
            if let Some(walls) = walls {
                let values = s.faces().flat_map(|used| &walls[used.face.0]);
                let bytes: Vec<u8> = values.flat_map(|value| value.to_le_bytes()).collect();
                made["wall_thickness_mm"] = STANDARD.encode(bytes).into();
            }
            made
        })
        .collect()
}

fn solid(model: &Model, solid: &Solid, mesh: &Tessellation) -> Value {
    let (mut vertices, mut normals, mut triangles, mut faces) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let mut first = 0u32;
    for used in solid.faces() {
        let (face, part) = (model.face(used.face), &mesh.faces[used.face.0]);
        let points = part.points.iter().map(|&p| mesh.points[p as usize]);
        vertices.extend(points.flat_map(|p| p.as_vec3().to_array()).flat_map(f32::to_le_bytes));
        let sign = if used.forward { 1.0 } else { -1.0 };
        normals.extend(
            part.normals.iter().flat_map(|n| (*n * sign).as_vec3().to_array()).flat_map(f32::to_le_bytes),
        );
        triangles.extend(mesh.triangles(used).flatten().flat_map(|k| (k + first).to_le_bytes()));
        first += part.points.len() as u32;
        faces.push(json!({ "name": face.name, "layer": face.style.layer, "color": face.style.color,
            "vertices": part.points.len(), "triangles": part.triangles.len() }));
    }
    json!({ "name": solid.name, "vertices": STANDARD.encode(vertices), "normals": STANDARD.encode(normals),
        "triangles": STANDARD.encode(triangles), "faces": faces })
}
