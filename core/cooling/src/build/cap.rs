//! Caps: pieces of stream surfaces bounded by rings of edges.

use super::error::BuildError;
use coolinggen_blade::StreamSurface;
use coolinggen_brep::{EdgeId, FaceId, LoopEdges, Model, Style};
use coolinggen_nurbs::ParametricSurface;

/// A closed chain of edges on a stream surface, with the sense in which it runs through each.
#[derive(Clone, Debug, Default)]
pub(super) struct Ring {
    pub(super) edges: Vec<(EdgeId, bool)>,
}

/// Distance allowed between an edge and the image of its parameter curve, mm; edges keep to 1e-8 mm of the surface.
const PCURVE_TOLERANCE: f64 = 3e-8;

/// Adds a face of the stream surface bounded by `outer` and with the openings `inner`.
pub(super) fn add_cap(
    model: &mut Model,
    name: String,
    style: Style,
    stream: &StreamSurface,
    outer: &Ring,
    inner: &[Ring],
) -> Result<FaceId, BuildError> {
    let loops: Vec<LoopEdges<'_>> = [outer]
        .into_iter()
        .chain(inner)
        .map(|ring| {
            let (edge, forward) = ring.edges[0];
            let edge = model.edge(edge);
            let start = model.vertex(if forward { edge.start } else { edge.end });
            LoopEdges { edges: &ring.edges, near: stream.parameters(start) }
        })
        .collect();
    Ok(model.trimmed_face(name, stream.geometry().clone(), &loops, PCURVE_TOLERANCE, style)?)
}

/// Whether the natural normal of the cap's surface points towards the shroud.
pub(super) fn points_up(model: &Model, cap: FaceId, stream: &StreamSurface) -> bool {
    let face = model.face(cap);
    let q = face.loops[0].coedges[0].parameter_at(0.0);
    let (point, u, v) = face.surface.first_derivatives(q.x, q.y);
    u.cross(v).dot(stream.level(point).1) > 0.0
}
