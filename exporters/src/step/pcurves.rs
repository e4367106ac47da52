//! Parameter curves of edges, in the parameters of STEP's surfaces.
//!
//! Given none, OpenCASCADE projects points of every edge on its surfaces and fits a curve to what it finds. That is slow,
//! and now and then wrong: on a rotor's tip the fit left the edge by 2.5e-5 mm, which FreeCAD's check calls invalid. The
//! model has the curves to 1e-8.

use super::convert::StepSolid;
use crate::forms::pcurve;
use coolinggen_brep::{Model, Solid};
use coolinggen_nurbs::Curve;
use glam::DVec2;

/// A parameter curve of an edge.
pub(crate) struct Pcurve {
    /// Its face, counted over all solids.
    pub(crate) face: usize,
    /// The curve, over the parameters that readers give to the edge's curve in space.
    pub(crate) curve: Curve<DVec2>,
}

/// Parameter curves of all edges, in the order in which truck writes the edges.
pub(crate) fn of_all(model: &Model, solids: &[&Solid], converted: &[StepSolid<'_>]) -> Vec<Vec<Pcurve>> {
    let mut edges: Vec<Vec<Pcurve>> = Vec::new();
    let mut number = 0;
    let shells = solids.iter().zip(converted).flat_map(|(s, c)| s.shells.iter().zip(&c.boundaries));
    for (shell, out) in shells {
        let first = edges.len();
        edges.resize_with(first + out.edges.len(), Vec::new);
        for (used, written) in shell.faces.iter().zip(&out.faces) {
            let face = model.face(used.face);
            for (bound, indices) in face.loops.iter().zip(&written.boundaries) {
                for (coedge, index) in bound.coedges.iter().zip(indices) {
                    if let Some(curve) = pcurve(model, face, coedge, &written.surface) {
                        edges[first + index.index].push(Pcurve { face: number, curve });
                    }
                }
            }
            number += 1;
        }
    }
    // An edge that a face meets twice would have to be a seam curve; readers do without.
    for list in &mut edges {
        if list.windows(2).any(|pair| pair[0].face == pair[1].face) {
            list.clear();
        }
    }
    edges
}
