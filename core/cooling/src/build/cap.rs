//! Caps: pieces of stream surfaces bounded by rings of edges.

use super::error::BuildError;
use coolinggen_blade::StreamSurface;
use coolinggen_brep::{Coedge, EdgeId, Face, FaceId, Loop, Model, Style, SurfaceGeometry};
use coolinggen_nurbs::{Curve, Interpolator, ParametricCurve, ParametricSurface};
use glam::DVec2;

/// A closed chain of edges on a stream surface, with the sense in which it runs through each.
#[derive(Clone, Debug, Default)]
pub(super) struct Ring {
    pub(super) edges: Vec<(EdgeId, bool)>,
}

/// Adds a face of the stream surface bounded by `outer` and with the openings `inner`.
pub(super) fn add_cap(
    model: &mut Model,
    name: String,
    style: Style,
    stream: &StreamSurface,
    outer: &Ring,
    inner: &[Ring],
) -> Result<FaceId, BuildError> {
    let mut loops = vec![cap_loop(model, stream, outer, 1.0)?];
    for ring in inner {
        loops.push(cap_loop(model, stream, ring, -1.0)?);
    }
    Ok(model.add_face(Face { name, surface: stream.geometry().clone(), loops, style }))
}

/// Whether the natural normal of the cap's surface points towards the shroud.
pub(super) fn points_up(model: &Model, cap: FaceId, stream: &StreamSurface) -> bool {
    let face = model.face(cap);
    let q = face.loops[0].coedges[0].parameter_at(0.0);
    let (point, u, v) = face.surface.first_derivatives(q.x, q.y);
    u.cross(v).dot(stream.level(point).1) > 0.0
}

/// The ring in the cap's parameters, run through counterclockwise (`sense` +1) or clockwise (-1).
fn cap_loop(model: &Model, stream: &StreamSurface, ring: &Ring, sense: f64) -> Result<Loop, BuildError> {
    let mut coedges = Vec::with_capacity(ring.edges.len());
    for &(edge, forward) in &ring.edges {
        let pcurve = pcurve_on_cap(stream.geometry(), stream, &model.edge(edge).curve)?;
        coedges.push(Coedge { edge, forward, pcurve });
    }
    if signed_area(&coedges) * sense < 0.0 {
        coedges.reverse();
        for coedge in &mut coedges {
            coedge.forward = !coedge.forward;
        }
    }
    Ok(Loop { coedges })
}

/// Parameters of an edge on a cap: interpolated at the edge's knots and between them.
fn pcurve_on_cap(
    surface: &SurfaceGeometry,
    stream: &StreamSurface,
    curve: &impl ParametricCurve<glam::DVec3>,
) -> Result<Curve<DVec2>, BuildError> {
    let breaks = curve.breaks();
    let mut nodes = Vec::with_capacity(2 * breaks.len());
    for pair in breaks.windows(2) {
        nodes.extend([pair[0], 0.5 * (pair[0] + pair[1])]);
    }
    nodes.push(breaks[breaks.len() - 1]);
    let points: Vec<DVec2> = nodes.iter().map(|&t| stream.parameters(curve.point(t))).collect();
    let slope = |t: f64, q: DVec2| {
        let direction = curve.derivatives(t)[1];
        let (_, u, v) = surface.first_derivatives(q.x, q.y);
        let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
        let (a, b) = (direction.dot(u), direction.dot(v));
        DVec2::new(a * vv - b * uv, b * uu - a * uv) / (uu * vv - uv * uv)
    };
    let last = nodes.len() - 1;
    let (start, end) = (slope(nodes[0], points[0]), slope(nodes[last], points[last]));
    Ok(Interpolator::with_slopes(&nodes)?.curve_with_slopes(&points, start, end)?)
}

/// Twice the signed area that a chain of coedges encloses in the parameter plane; enough samples to tell its sign.
fn signed_area(coedges: &[Coedge]) -> f64 {
    const SAMPLES: usize = 16;
    let mut sum = 0.0;
    for coedge in coedges {
        let mut before = coedge.parameter_at(0.0);
        for i in 1..=SAMPLES {
            let here = coedge.parameter_at(i as f64 / SAMPLES as f64);
            sum += before.perp_dot(here);
            before = here;
        }
    }
    sum
}
