//! From the model's solids to truck's compressed ones.

use super::geometry::Point;
use crate::forms::{CurveForm, SurfaceForm, curve, surface};
use coolinggen_brep::{Model, Shell, Solid};
use truck_stepio::out::StepLength;
use truck_topology::compress::{
    CompressedEdge, CompressedEdgeIndex, CompressedFace, CompressedShell, CompressedSolid,
};

pub(crate) type StepShell<'a> = CompressedShell<Point, CurveForm<'a>, SurfaceForm<'a>>;
pub(crate) type StepSolid<'a> = CompressedSolid<Point, CurveForm<'a>, SurfaceForm<'a>>;

/// The solid with its own copies of the vertices, edges and faces it uses, numbered as the faces meet them.
pub(crate) fn solid<'a>(model: &'a Model, solid: &Solid) -> StepSolid<'a> {
    CompressedSolid { boundaries: solid.shells.iter().map(|s| shell(model, s)).collect() }
}

fn shell<'a>(model: &'a Model, shell: &Shell) -> StepShell<'a> {
    let mut vertex_of = vec![usize::MAX; model.vertices.len()];
    let mut edge_of = vec![usize::MAX; model.edges.len()];
    let mut out = CompressedShell { vertices: Vec::new(), edges: Vec::new(), faces: Vec::new() };
    for used in &shell.faces {
        let face = model.face(used.face);
        let mut boundaries = Vec::with_capacity(face.loops.len());
        for bound in &face.loops {
            let mut indices = Vec::with_capacity(bound.coedges.len());
            for coedge in &bound.coedges {
                let slot = &mut edge_of[coedge.edge.0];
                if *slot == usize::MAX {
                    *slot = out.edges.len();
                    let edge = model.edge(coedge.edge);
                    let mut vertex = |id: usize| {
                        if vertex_of[id] == usize::MAX {
                            vertex_of[id] = out.vertices.len();
                            out.vertices.push(Point(model.vertices[id]));
                        }
                        vertex_of[id]
                    };
                    let vertices = (vertex(edge.start.0), vertex(edge.end.0));
                    out.edges.push(CompressedEdge { vertices, curve: curve(&edge.curve) });
                }
                indices.push(CompressedEdgeIndex { index: *slot, orientation: coedge.forward });
            }
            boundaries.push(indices);
        }
        // truck reverses the bounds of a face with orientation false: the loops are given as seen against the
        // natural normal, which then points into the material.
        out.faces.push(CompressedFace { boundaries, orientation: used.forward, surface: surface(face) });
    }
    out
}

/// An upper bound of the number of entities that truck writes for a solid.
pub(crate) fn entities(solid: &StepSolid<'_>) -> usize {
    let bounds = |f: &CompressedFace<SurfaceForm<'_>>| -> usize {
        f.boundaries.iter().map(|b| 2 + b.len()).sum::<usize>() + 1 + f.surface.step_length()
    };
    let shell = |s: &StepShell<'_>| -> usize {
        let edges = s.edges.iter().map(|e| 1 + e.curve.step_length()).sum::<usize>();
        2 + s.faces.iter().map(bounds).sum::<usize>() + edges + 2 * s.vertices.len()
    };
    1 + solid.boundaries.iter().map(shell).sum::<usize>()
}
