//! Distance of meshes from their surfaces.

use coolinggen_brep::{Face, Model, Solid};
use coolinggen_exporters::Tessellation;
use coolinggen_nurbs::ParametricSurface;
use glam::{DVec2, DVec3};

/// Triangles of a solid as indices of points.
pub fn solid_triangles(mesh: &Tessellation, solid: &Solid) -> Vec<[u32; 3]> {
    let mut out = Vec::new();
    for used in solid.faces() {
        let points = &mesh.faces[used.face.0].points;
        out.extend(mesh.triangles(used).map(|t| t.map(|i| points[i as usize])));
    }
    out
}

/// What sampling found on a face.
#[derive(Debug, Default)]
pub struct Found {
    /// Greatest distance of a triangle's points from the surface, mm.
    pub distance: f64,
    /// Least cosine between a triangle's normal and the surface's at its corners.
    pub cosine: f64,
    /// Triangles.
    pub triangles: usize,
}

/// Samples every triangle at 15 places, each projected on the surface by Newton steps from its parameters.
pub fn inspect(model: &Model, mesh: &Tessellation) -> Vec<Found> {
    model.faces.iter().zip(&mesh.faces).map(|(face, m)| inspect_face(face, m, &mesh.points)).collect()
}

fn inspect_face(face: &Face, mesh: &coolinggen_exporters::FaceMesh, points: &[DVec3]) -> Found {
    let mut found = Found { cosine: 1.0, triangles: mesh.triangles.len(), ..Found::default() };
    for t in &mesh.triangles {
        let uv = t.map(|i| mesh.parameters[i as usize]);
        let at = t.map(|i| points[mesh.points[i as usize] as usize]);
        let normal = (at[1] - at[0]).cross(at[2] - at[0]).normalize_or_zero();
        for i in t {
            found.cosine = found.cosine.min(normal.dot(mesh.normals[*i as usize]));
        }
        for i in 0..5u32 {
            for j in 0..5 - i {
                let w = [f64::from(i) / 4.0, f64::from(j) / 4.0, f64::from(4 - i - j) / 4.0];
                let p = at[0] * w[0] + at[1] * w[1] + at[2] * w[2];
                let start = uv[0] * w[0] + uv[1] * w[1] + uv[2] * w[2];
                found.distance = found.distance.max(distance(face, p, start));
            }
        }
    }
    found
}

fn distance(face: &Face, p: DVec3, start: DVec2) -> f64 {
    let mut uv = start;
    let mut best = f64::INFINITY;
    for _ in 0..8 {
        let (q, u, v) = face.surface.first_derivatives(uv.x, uv.y);
        best = best.min(p.distance(q));
        let (e, f, g) = (u.dot(u), u.dot(v), v.dot(v));
        let det = e * g - f * f;
        if !(det > 0.0) {
            break;
        }
        let (a, b) = ((p - q).dot(u), (p - q).dot(v));
        uv += DVec2::new(g * a - f * b, e * b - f * a) / det;
    }
    best
}
