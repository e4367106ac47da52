//! Chambers: rings of eight segments lofted over the span (DESIGN 5.3).

use super::cap::Ring;
use super::clearance::ChamberPolygon;
use super::error::BuildError;
use super::nodes::{Nodes, Strand};
use super::tube::CutTube;
use crate::section::{ChamberRing, Outline, SEGMENTS};
use coolinggen_blade::StreamSurface;
use coolinggen_brep::{Coedge, Face, Loop, Model, Style, SurfaceGeometry, VertexId, straight_pcurve};
use coolinggen_nurbs::{Curve, Interpolator, NurbsError, ParametricSurface, Surface};
use glam::{DVec2, DVec3};

/// A chamber's ring on one stream surface.
#[derive(Clone, Debug)]
pub(super) struct RingSection<'a> {
    pub(super) stream: &'a StreamSurface,
    pub(super) outline: &'a Outline,
    pub(super) ring: ChamberRing,
}

impl RingSection<'_> {
    /// Point of segment `k` at `t` in space, with its derivative.
    pub(super) fn evaluate(&self, k: usize, t: f64) -> (DVec3, DVec3) {
        let (q, dq) = self.ring.segments[k].evaluate(self.outline, t);
        let (point, dm, dt) = self.stream.to_space_derivatives(q);
        (point, dm * dq.x + dt * dq.y)
    }

    /// The ring in the chart, coarsely.
    pub(super) fn polygon(&self, chamber: &str) -> ChamberPolygon {
        const STEPS: usize = 12;
        let segments = self.ring.segments.iter();
        let points = segments.flat_map(|s| (0..STEPS).map(move |i| (s, i as f64 / STEPS as f64)));
        ChamberPolygon {
            part: format!("chamber \"{chamber}\""),
            stream: self.stream.clone(),
            points: points.map(|(s, t)| s.evaluate(self.outline, t).0).collect(),
        }
    }
}

/// Indices in a chamber's ring of its back closure, seen from the suction side, and of its front closure, seen from the
/// pressure side: at a wall a fillet, the flat face and a fillet.
pub(super) const BACK: [usize; 3] = [1, 2, 3];
pub(super) const FRONT: [usize; 3] = [5, 6, 7];

/// Names of the eight faces below a path, from those of the front and the back closure.
pub(super) fn segment_names(path: &str, front: &str, back: &str) -> [String; SEGMENTS] {
    let path = |part: &str| format!("{path}/{part}");
    let closure = |end: &str, first: &str, last: &str| {
        let (middle, side) = match end.strip_prefix("wall/") {
            Some(_) => (end.to_owned(), "fillet_"),
            None => (end.to_owned(), ""),
        };
        [path(&format!("{end}/{side}{first}")), path(&middle), path(&format!("{end}/{side}{last}"))]
    };
    let [b0, b1, b2] = closure(back, "suction_side", "pressure_side");
    let [f0, f1, f2] = closure(front, "pressure_side", "suction_side");
    [path("suction_side"), b0, b1, b2, path("pressure_side"), f0, f1, f2]
}

/// Names and looks of the eight faces of a tube.
#[derive(Clone, Debug)]
pub(super) struct TubeLook {
    pub(super) names: [String; SEGMENTS],
    pub(super) style: Style,
}

/// Lofts the rings and adds the faces to the model; their natural normals point as the blade's do.
pub(super) fn add_chamber(
    model: &mut Model,
    look: &TubeLook,
    sections: &[RingSection<'_>],
    nodes: &[Nodes],
) -> Result<CutTube, BuildError> {
    let (tube, _) = add_parted(model, [look, look], sections, nodes, sections.len() - 1)?;
    Ok(tube)
}

/// As [`add_chamber`], with the faces parted at a section: the tube up to it and, unless it is the last section, the one
/// beyond. They share the ring there.
pub(super) fn add_parted(
    model: &mut Model,
    looks: [&TubeLook; 2],
    sections: &[RingSection<'_>],
    nodes: &[Nodes],
    at: usize,
) -> Result<(CutTube, Option<CutTube>), BuildError> {
    let vs: Vec<f64> = sections.iter().map(|s| s.stream.v()).collect();
    let across = Interpolator::new(3, &vs)?;
    // Corners once a section: both neighbours take the same point, bit for bit.
    let corners: Vec<[DVec3; SEGMENTS]> =
        sections.iter().map(|s| std::array::from_fn(|k| s.evaluate(k, 0.0).0)).collect();
    let mut surfaces: Vec<Surface<DVec3>> = Vec::with_capacity(SEGMENTS);
    for k in 0..SEGMENTS {
        let curves = sections.iter().zip(&corners).map(|(section, corner)| {
            let strand = Strand { section, segment: k, reversed: false };
            nodes[k].curve(&strand, Some((corner[k], corner[(k + 1) % SEGMENTS])))
        });
        surfaces.push(across.loft(&curves.collect::<Result<Vec<_>, _>>()?)?);
    }
    let last = vs.len() - 1;
    if at == last {
        let lower = add_ring(model, &surfaces, 0)?;
        return Ok((add_faces(model, looks[0], surfaces, lower)?, None));
    }
    let part = |from: f64, to: f64| {
        surfaces.iter().map(|s| s.restricted_v(from, to)).collect::<Result<Vec<_>, NurbsError>>()
    };
    let (below, above) = (part(vs[0], vs[at])?, part(vs[at], vs[last])?);
    let start = add_ring(model, &below, 0)?;
    let below = add_faces(model, looks[0], below, start)?;
    let middle = below.rings[1].clone();
    let above = add_faces(model, looks[1], above, middle)?;
    Ok((below, Some(above)))
}

/// The edges of the surfaces' borders at the lower (0) or upper (1) end, with new vertices.
fn add_ring(model: &mut Model, surfaces: &[Surface<DVec3>], side: usize) -> Result<Ring, BuildError> {
    let end = |s: &Surface<DVec3>| side * (s.counts().1 - 1);
    let vertices: Vec<VertexId> = surfaces.iter().map(|s| model.add_vertex(s.points()[end(s)])).collect();
    let mut ring = Ring::default();
    for (k, surface) in surfaces.iter().enumerate() {
        let (start, finish) = (vertices[k], vertices[(k + 1) % vertices.len()]);
        ring.edges.push((model.add_edge(start, finish, column(surface, end(surface))?), true));
    }
    Ok(ring)
}

/// Faces of surfaces whose lower borders are there.
fn add_faces(
    model: &mut Model,
    look: &TubeLook,
    surfaces: Vec<Surface<DVec3>>,
    lower: Ring,
) -> Result<CutTube, BuildError> {
    let rings = [lower, add_ring(model, &surfaces, 1)?];
    let start = |model: &Model, side: usize, k: usize| model.edge(rings[side].edges[k].0).start;
    let mut uprights = Vec::with_capacity(SEGMENTS);
    for (k, surface) in surfaces.iter().enumerate() {
        let row = surface.points()[..surface.counts().1].to_vec();
        let curve = Curve::new(surface.knots_v().clone(), row)?;
        let (from, to) = (start(model, 0, k), start(model, 1, k));
        uprights.push(model.add_edge(from, to, curve));
    }
    let mut faces = Vec::with_capacity(SEGMENTS);
    for (k, (surface, name)) in surfaces.into_iter().zip(&look.names).enumerate() {
        let (_, (v0, v1)) = surface.domain();
        let line = |start: (f64, f64), end: (f64, f64), domain: (f64, f64)| {
            straight_pcurve(DVec2::from(start), DVec2::from(end), domain)
        };
        let along = |v: f64| line((0.0, v), (1.0, v), (0.0, 1.0));
        let upright = |u: f64| line((u, v0), (u, v1), (v0, v1));
        let coedges = vec![
            Coedge { edge: rings[0].edges[k].0, forward: true, pcurve: along(v0)? },
            Coedge { edge: uprights[(k + 1) % SEGMENTS], forward: true, pcurve: upright(1.0)? },
            Coedge { edge: rings[1].edges[k].0, forward: false, pcurve: along(v1)? },
            Coedge { edge: uprights[k], forward: false, pcurve: upright(0.0)? },
        ];
        let surface = SurfaceGeometry::BSpline(surface);
        let (name, style) = (name.clone(), look.style.clone());
        faces.push(model.add_face(Face { name, surface, loops: vec![Loop { coedges }], style }));
    }
    Ok(CutTube { faces, rings })
}

/// The curve of the control points in column `j`: the border of a clamped surface.
pub(super) fn column(surface: &Surface<DVec3>, j: usize) -> Result<Curve<DVec3>, BuildError> {
    let (_, count) = surface.counts();
    let points = surface.points().iter().skip(j).step_by(count).copied().collect();
    Ok(Curve::new(surface.knots_u().clone(), points)?)
}
