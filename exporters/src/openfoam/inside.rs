//! A point well inside a solid.

use crate::Tessellation;
use coolinggen_brep::{FaceUse, Solid};
use glam::DVec3;

/// Triangles from which a way into the solid is tried, the largest ones.
const TRIED: usize = 24;

/// The middle of the longest way straight in from one of the largest triangles to the other side. None for a solid without
/// triangles or without thickness.
pub(super) fn point_inside(solid: &Solid, mesh: &Tessellation) -> Option<DVec3> {
    let corners = |used: FaceUse| {
        let face = &mesh.faces[used.face.0];
        mesh.triangles(used).map(|t| t.map(|i| mesh.points[face.points[i as usize] as usize]))
    };
    let triangles: Vec<[DVec3; 3]> = solid.faces().flat_map(corners).collect();
    let across = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|&i, &j| {
        across(triangles[j]).length_squared().total_cmp(&across(triangles[i]).length_squared())
    });
    let ways = order.iter().take(TRIED).filter_map(|&own| {
        let triangle = triangles[own];
        let start = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
        let inwards = -across(triangle).try_normalize()?;
        let others = triangles.iter().enumerate().filter(|(k, _)| *k != own);
        let hits = others.filter_map(|(_, t)| distance(start, inwards, *t));
        let depth = hits.fold(f64::INFINITY, f64::min);
        (depth.is_finite() && depth > 0.0).then_some((depth, start + inwards * (0.5 * depth)))
    });
    ways.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, point)| point)
}

/// Distance along a ray to a triangle (Moeller and Trumbore, "Fast, Minimum Storage Ray-Triangle Intersection", 1997).
fn distance(start: DVec3, direction: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let volume = ab.dot(p);
    if volume == 0.0 {
        return None;
    }
    let from_a = start - a;
    let u = from_a.dot(p) / volume;
    let q = from_a.cross(ab);
    let v = direction.dot(q) / volume;
    let way = ac.dot(q) / volume;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && way > 0.0).then_some(way)
}
