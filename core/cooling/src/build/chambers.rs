//! Chambers: rings of eight segments lofted over the span (DESIGN 5.3).

use super::cap::Ring;
use super::clearance::ChamberPolygon;
use super::error::BuildError;
use super::nodes::{Nodes, Strand};
use super::style;
use super::tube::CutTube;
use crate::section::{ChamberRing, Outline, SEGMENTS};
use coolinggen_blade::StreamSurface;
use coolinggen_brep::{Coedge, EdgeId, Face, Loop, Model, SurfaceGeometry, VertexId, straight_pcurve};
use coolinggen_nurbs::{Curve, Interpolator, Surface};
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

/// Names of the eight faces, from those of the front and the back closure.
pub(super) fn segment_names(chamber: &str, front: &str, back: &str) -> [String; SEGMENTS] {
    let path = |part: &str| format!("chamber/{chamber}/{part}");
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

/// Lofts the rings and adds the faces to the model; their natural normals point as the blade's do.
pub(super) fn add_chamber(
    model: &mut Model,
    chamber: &str,
    names: [String; SEGMENTS],
    sections: &[RingSection<'_>],
    nodes: &[Nodes],
) -> Result<CutTube, BuildError> {
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
    let vertices: Vec<[VertexId; 2]> =
        surfaces.iter().map(|s| [0, last].map(|j| model.add_vertex(s.points()[j]))).collect();
    let mut rings: [Ring; 2] = [Ring::default(), Ring::default()];
    for k in 0..SEGMENTS {
        for (side, j) in [(0, 0), (1, last)] {
            let (start, end) = (vertices[k][side], vertices[(k + 1) % SEGMENTS][side]);
            let column = column(&surfaces[k], j)?;
            rings[side].edges.push((model.add_edge(start, end, column), true));
        }
    }
    let uprights: Vec<EdgeId> = (0..SEGMENTS)
        .map(|k| {
            let row = surfaces[k].points()[..=last].to_vec();
            let curve = Curve::new(across.knots().clone(), row)?;
            Ok(model.add_edge(vertices[k][0], vertices[k][1], curve))
        })
        .collect::<Result<_, BuildError>>()?;
    let style = style::chamber(chamber);
    let (v0, v1) = (vs[0], vs[last]);
    let mut faces = Vec::with_capacity(SEGMENTS);
    for (k, (surface, name)) in surfaces.into_iter().zip(names).enumerate() {
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
        faces.push(model.add_face(Face {
            name,
            surface,
            loops: vec![Loop { coedges }],
            style: style.clone(),
        }));
    }
    Ok(CutTube { faces, rings })
}

/// The curve of the control points in column `j`: the border of a clamped surface.
pub(super) fn column(surface: &Surface<DVec3>, j: usize) -> Result<Curve<DVec3>, BuildError> {
    let (_, count) = surface.counts();
    let points = surface.points().iter().skip(j).step_by(count).copied().collect();
    Ok(Curve::new(surface.knots_u().clone(), points)?)
}
