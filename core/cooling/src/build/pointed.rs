//! Tubes that end in a point: the outer surface of a propeller blade, cut at the hub alone.

use super::cap::Ring;
use super::error::BuildError;
use super::tube::{CutTube, Patch, crossing, upright_curve, upright_pcurve};
use coolinggen_blade::StreamSurface;
use coolinggen_brep::{Coedge, EdgeId, Face, Loop, Model, VertexId};
use coolinggen_nurbs::ParametricSurface;
use glam::DVec3;

/// Adds the faces of a tube that is cut by `lower` and whose patches all end in `tip` at the upper end of v. Each face
/// has three edges; the fourth side of its parameters is the tip.
pub(super) fn add_pointed_tube(
    model: &mut Model,
    patches: Vec<Patch>,
    lower: &StreamSurface,
    tip: DVec3,
) -> Result<CutTube, BuildError> {
    let count = patches.len();
    let mut crossings = Vec::with_capacity(count);
    for patch in &patches {
        let (_, (low, high)) = patch.surface.domain();
        let crossing = crossing(&patch.surface, lower, low + 0.05 * (high - low))
            .ok_or_else(|| BuildError::NoCrossing { face: patch.name.clone(), v: lower.v() })?;
        crossings.push(crossing);
    }
    let tip = model.add_vertex(tip);
    let feet: Vec<VertexId> = crossings.iter().map(|c| model.add_vertex(c.curve.points()[0])).collect();
    let mut ring: Vec<EdgeId> = Vec::with_capacity(count);
    let mut uprights = Vec::with_capacity(count);
    for (k, patch) in patches.iter().enumerate() {
        let (start, end) = (feet[k], feet[(k + 1) % count]);
        let curve = crossings[k].curve.clone().with_ends(model.vertex(start), model.vertex(end));
        ring.push(model.add_edge(start, end, curve));
        let ((u, _), (_, high)) = patch.surface.domain();
        let span = [crossings[k].pcurve.points()[0].y, high];
        let curve = upright_curve(&patch.surface, u, span, [model.vertex(start), model.vertex(tip)])?;
        uprights.push((model.add_edge(start, tip, curve), span));
    }
    let mut faces = Vec::with_capacity(count);
    for (k, (patch, crossing)) in patches.into_iter().zip(crossings).enumerate() {
        let ((u0, u1), _) = patch.surface.domain();
        let (left, span) = uprights[k];
        let (right, right_span) = uprights[(k + 1) % count];
        let coedges = vec![
            Coedge { edge: ring[k], forward: true, pcurve: crossing.pcurve },
            Coedge { edge: right, forward: true, pcurve: upright_pcurve(u1, right_span)? },
            Coedge { edge: left, forward: false, pcurve: upright_pcurve(u0, span)? },
        ];
        faces.push(model.add_face(Face {
            name: patch.name,
            surface: patch.surface,
            loops: vec![Loop { coedges }],
            style: patch.style,
        }));
    }
    let lower = Ring { edges: ring.into_iter().map(|e| (e, true)).collect() };
    Ok(CutTube { faces, rings: [lower, Ring::default()] })
}
