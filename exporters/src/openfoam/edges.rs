//! The edge mesh: lines that the cells must keep.

use super::{SCALE, dictionaries};
use crate::Tessellation;
use coolinggen_brep::{FaceId, Grouping, Model};
use glam::DVec3;
use std::io::Write as _;

/// Cosine of the least angle between the normals on both sides of an edge that is a line to keep: 30 degrees.
const SHARP: f64 = 0.866_025_403_784_438_6;

/// Edges between groups, and sharp ones, as polylines of the mesh.
pub(super) fn edge_mesh(model: &Model, mesh: &Tessellation, grouping: &Grouping) -> Vec<u8> {
    let mut beside: Vec<Vec<FaceId>> = vec![Vec::new(); model.edges.len()];
    for (index, face) in model.faces.iter().enumerate() {
        for coedge in face.loops.iter().flat_map(|l| &l.coedges) {
            beside[coedge.edge.0].push(FaceId(index));
        }
    }
    let kept = |edge: &usize| {
        let faces = &beside[*edge];
        let sharp = || {
            let Some(&middle) = mesh.edges[*edge].get(mesh.edges[*edge].len() / 2) else { return false };
            let normals: Vec<DVec3> = faces.iter().filter_map(|f| normal(mesh, *f, middle)).collect();
            // Natural normals of neighbours may be opposite: only the line between them counts.
            normals.windows(2).any(|pair| pair[0].dot(pair[1]).abs() < SHARP)
        };
        let group = |f: &FaceId| grouping.index_of(*f);
        faces.windows(2).any(|pair| group(&pair[0]) != group(&pair[1])) || sharp()
    };
    let lines: Vec<&[u32]> = (0..model.edges.len()).filter(kept).map(|e| mesh.edges[e].as_slice()).collect();
    let mut number = vec![usize::MAX; mesh.points.len()];
    let mut used = Vec::new();
    for &point in lines.iter().copied().flatten() {
        let slot = &mut number[point as usize];
        if *slot == usize::MAX {
            *slot = used.len();
            used.push(mesh.points[point as usize] * SCALE);
        }
    }
    let mut out = dictionaries::head("featureEdgeMesh", "constant/triSurface", "blade.eMesh").into_bytes();
    // Writing into memory does not fail.
    let _ = writeln!(out, "{}\n(", used.len());
    for p in &used {
        let _ = writeln!(out, "({:?} {:?} {:?})", p.x, p.y, p.z);
    }
    let segments: usize = lines.iter().map(|line| line.len().saturating_sub(1)).sum();
    let _ = writeln!(out, ")\n{segments}\n(");
    for pair in lines.iter().flat_map(|line| line.windows(2)) {
        let _ = writeln!(out, "({} {})", number[pair[0] as usize], number[pair[1] as usize]);
    }
    let _ = writeln!(out, ")");
    out
}

/// The surface's normal of a face at a point of its mesh.
fn normal(mesh: &Tessellation, face: FaceId, point: u32) -> Option<DVec3> {
    let face = &mesh.faces[face.0];
    face.points.iter().position(|p| *p == point).map(|i| face.normals[i])
}
