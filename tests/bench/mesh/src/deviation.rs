//! How far triangles are from their surface, and how far their normals are from its.

use coolinggen_brep::Model;
use coolinggen_exporters::Tessellation;
use coolinggen_nurbs::ParametricSurface;
use glam::DVec2;

/// Places in a triangle, barycentric: the middles of its sides, its centre, and the middles between that and its corners.
const PLACES: [[f64; 3]; 7] = {
    const NEAR: f64 = 2.0 / 3.0;
    const FAR: f64 = 1.0 / 6.0;
    [
        [0.5, 0.5, 0.0],
        [0.0, 0.5, 0.5],
        [0.5, 0.0, 0.5],
        [1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0],
        [NEAR, FAR, FAR],
        [FAR, NEAR, FAR],
        [FAR, FAR, NEAR],
    ]
};

/// What sampling found on a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deviation {
    /// Greatest distance from the surface's tangent plane at the same parameters, mm.
    pub(crate) distance: f64,
    /// Greatest angle between a triangle's normal and the surface's at a corner, degrees.
    pub(crate) turn_deg: f64,
}

/// Samples the triangles of each face at seven places.
pub(crate) fn deviations(model: &Model, mesh: &Tessellation) -> Vec<Deviation> {
    let of_face = |(face, m): (&coolinggen_brep::Face, &coolinggen_exporters::FaceMesh)| {
        let mut found = Deviation { distance: 0.0, turn_deg: 0.0 };
        for t in &m.triangles {
            let at = t.map(|i| mesh.points[m.points[i as usize] as usize]);
            let uv = t.map(|i| m.parameters[i as usize]);
            let normal = (at[1] - at[0]).cross(at[2] - at[0]).normalize_or_zero();
            for i in t {
                let turn = normal.angle_between(m.normals[*i as usize]);
                found.turn_deg = found.turn_deg.max(turn.to_degrees());
            }
            for w in PLACES {
                let place: DVec2 = (0..3).map(|k| uv[k] * w[k]).sum();
                let (p, u, v) = face.surface.first_derivatives(place.x, place.y);
                let Some(normal) = u.cross(v).try_normalize() else { continue };
                let on = at[0] * w[0] + at[1] * w[1] + at[2] * w[2];
                found.distance = found.distance.max((on - p).dot(normal).abs());
            }
        }
        found
    };
    model.faces.iter().zip(&mesh.faces).map(of_face).collect()
}
