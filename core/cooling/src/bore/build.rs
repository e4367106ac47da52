//! From shape to topology: the faces of a bore, and the holes they leave in the faces they end on.

use super::BoreError;
use super::found::{EndTrace, Found, Piece, key_of};
use super::legs::Leg;
use super::rims::Rim;
use super::ring::{Interpolators, Trace};
use super::shape::BoreShape;
use super::target::Mouth;
use coolinggen_brep::{
    Coedge, EdgeId, Face, FaceId, Imprint, Loop, LoopEdges, Memo, Model, Plane, RingPiece, Style,
    SurfaceGeometry, VertexId, straight_pcurve,
};
use coolinggen_nurbs::{Curve, Knots, ParametricCurve, ParametricSurface, Surface};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Makes bores; keeps what they have in common, and what was found of each.
#[derive(Clone, Debug, Default)]
pub(crate) struct Drill {
    interpolators: Interpolators,
    found: Memo<Arc<Found>>,
}

impl Drill {
    /// For bores that are made once: nothing is kept of them.
    pub(crate) fn once() -> Self {
        Self { found: Memo::idle(), ..Self::default() }
    }
}

/// The faces that bores have parted.
pub(crate) trait Wholes {
    /// The face that a part was split off from, or the face itself.
    fn whole(&self, face: FaceId) -> FaceId;

    /// Whether the face will be the same one in the next build: no face that is made after bores is.
    fn lasts(&self, face: FaceId) -> bool;
}

/// A finished bore.
#[derive(Clone, Debug)]
pub(crate) struct Bored {
    /// Its faces, each with whether its natural normal points away from the axis.
    pub(crate) faces: Vec<(FaceId, bool)>,
    /// What it did to the faces at its lower and upper end.
    pub(crate) imprints: [Imprint; 2],
}

/// Name and looks of a bore's faces: `<path>/<stage>/<number>`.
pub(crate) struct BoreNames<'a> {
    pub(crate) path: &'a str,
    pub(crate) stages: &'a [&'a str],
    pub(crate) style: &'a Style,
}

/// How far a plane face's edges may lie off it, mm: they are made to lie on it.
const PLANE_TOLERANCE: f64 = 1e-8;

/// A ring of the bore, a vertex where each piece begins and an edge for each piece that has a length.
struct Ring {
    vertices: Vec<VertexId>,
    edges: Vec<Option<EdgeId>>,
}

impl Drill {
    /// Bores from the faces `lower` to the faces `upper`; the mouths are where the axis meets them. `clear` sees the
    /// rims at both ends before anything is changed and may refuse.
    pub(crate) fn bore(
        &mut self,
        model: &mut Model,
        shape: &BoreShape,
        ends: [(&[FaceId], Mouth); 2],
        names: &BoreNames<'_>,
        wholes: &dyn Wholes,
        clear: &mut dyn FnMut([Rim; 2]) -> Result<(), BoreError>,
    ) -> Result<Bored, BoreError> {
        let found = self.found(model, shape, ends, wholes)?;
        let Found { legs, pieces, traces, middles, .. } = &*found;
        let last = shape.sections.len() - 1;
        clear([rim(&traces[0]), rim(&traces[1])])?;
        // From here on the model changes.
        let crossed = split_borders(model, legs)?;
        let mut rings = Vec::with_capacity(last + 1);
        for section in 0..=last {
            let side = if section == 0 {
                Some(0)
            } else if section == last {
                Some(1)
            } else {
                None
            };
            let curves: Vec<Option<Curve<DVec3>>> = match side {
                Some(side) => traces[side].iter().map(|t| t.as_ref().map(|t| t.1.curve.clone())).collect(),
                None => middles[section - 1].clone(),
            };
            let at_border = |piece: &Piece| {
                side.and_then(|s| {
                    crossed[s].iter().find(|c| c.0 == piece.path && c.1 == piece.from).map(|c| c.2)
                })
            };
            rings.push(ring(model, pieces, curves, at_border));
        }
        let faces = faces(model, shape, pieces, &rings, names)?;
        let mut imprints = Vec::with_capacity(2);
        for (side, section) in [(0, 0), (1, last)] {
            let ring = hole(model, shape, &ends[side].1, &rings[section], &traces[side]);
            imprints.push(model.imprint(&ring)?);
        }
        let upper = imprints.pop().unwrap_or_default();
        let lower = imprints.pop().unwrap_or_default();
        Ok(Bored { faces, imprints: [lower, upper] })
    }

    /// What is found of a bore, now or before.
    fn found(
        &mut self,
        model: &Model,
        shape: &BoreShape,
        ends: [(&[FaceId], Mouth); 2],
        wholes: &dyn Wholes,
    ) -> Result<Arc<Found>, BoreError> {
        let mouths = ends.map(|(_, mouth)| mouth);
        if self.found.is_idle() || !mouths.iter().all(|mouth| wholes.lasts(wholes.whole(mouth.face))) {
            return Ok(Arc::new(Found::new(&mut self.interpolators, model, shape, ends, wholes)?));
        }
        let key = key_of(shape, mouths, wholes);
        if let Some(again) = self.found.find(&key).and_then(|found| found.again(model, ends, wholes)) {
            return Ok(Arc::new(again));
        }
        let found = Arc::new(Found::new(&mut self.interpolators, model, shape, ends, wholes)?);
        self.found.keep(key, Arc::clone(&found));
        Ok(found)
    }

    /// See [`Memo::end_round`].
    pub(crate) fn end_round(&mut self, complete: bool) {
        self.found.end_round(complete);
    }

    /// How many bores have been found so far that were not known.
    pub(crate) fn made(&self) -> u64 {
        self.found.made()
    }
}

/// The delimiting curves of one end as a polygon.
fn rim(traces: &[EndTrace]) -> Rim {
    const LEAST_STEPS: usize = 24;
    let traces: Vec<&(FaceId, Trace)> = traces.iter().flatten().collect();
    let steps = LEAST_STEPS.div_ceil(traces.len().max(1));
    let points = traces
        .iter()
        .flat_map(|(_, trace)| (0..steps).map(move |i| trace.curve.point(i as f64 / steps as f64)));
    let mut faces: Vec<FaceId> = traces.iter().map(|(face, _)| *face).collect();
    faces.sort();
    faces.dedup();
    Rim::new(faces, points.collect())
}

/// Path, parameter and vertex of each crossing of one end.
type Crossings = Vec<(usize, f64, VertexId)>;

/// Splits the borders that both ends cross.
fn split_borders(model: &mut Model, end_legs: &[Vec<Vec<Leg>>; 2]) -> Result<[Crossings; 2], BoreError> {
    let mut crossings = Vec::new();
    for (side, paths) in end_legs.iter().enumerate() {
        for (path, legs) in paths.iter().enumerate() {
            crossings.extend(legs.iter().filter_map(|leg| leg.crossing.map(|c| (side, path, leg.face, c))));
        }
    }
    let mut out = [Vec::new(), Vec::new()];
    for i in 0..crossings.len() {
        let (side, path, from, crossing) = crossings[i];
        let added = EdgeId(model.edges.len());
        let vertex = model.split_edge(crossing.edge, crossing.edge_t, &[from, crossing.to])?;
        // Both ends of a short bore may cross one border.
        for (_, _, _, later) in &mut crossings[i + 1..] {
            if later.edge == crossing.edge && later.edge_t > crossing.edge_t {
                later.edge = added;
            }
        }
        out[side].push((path, crossing.t, vertex));
    }
    Ok(out)
}

/// The vertices and edges of a ring; `at_border` knows the vertex of a piece that begins at a border.
fn ring(
    model: &mut Model,
    pieces: &[Piece],
    curves: Vec<Option<Curve<DVec3>>>,
    at_border: impl Fn(&Piece) -> Option<VertexId>,
) -> Ring {
    let n = pieces.len();
    let mut vertices = vec![VertexId(usize::MAX); n];
    // Begin where the piece before has a length; those without share the vertex before them.
    let first = (0..n).find(|j| curves[(j + n - 1) % n].is_some()).unwrap_or(0);
    for k in 0..n {
        let j = (first + k) % n;
        let before = (j + n - 1) % n;
        vertices[j] = match (at_border(&pieces[j]), &curves[j], &curves[before]) {
            (Some(vertex), ..) => vertex,
            (None, _, None) => vertices[before],
            (None, Some(curve), Some(_)) => model.add_vertex(curve.points()[0]),
            (None, None, Some(curve)) => model.add_vertex(curve.points()[curve.points().len() - 1]),
        };
    }
    let edges = curves.into_iter().enumerate().map(|(j, curve)| {
        let (start, end) = (vertices[j], vertices[(j + 1) % n]);
        let curve = curve?.with_ends(model.vertex(start), model.vertex(end));
        Some(model.add_edge(start, end, curve))
    });
    let edges = edges.collect();
    Ring { vertices, edges }
}

/// The faces of all stages, each with whether its natural normal points away from the axis.
fn faces(
    model: &mut Model,
    shape: &BoreShape,
    pieces: &[Piece],
    rings: &[Ring],
    names: &BoreNames<'_>,
) -> Result<Vec<(FaceId, bool)>, BoreError> {
    let n = pieces.len();
    let mut out = Vec::new();
    for (stage, pair) in rings.windows(2).enumerate() {
        let (lower, upper) = (&pair[0], &pair[1]);
        let absent = |j: usize| lower.edges[j].is_none() && upper.edges[j].is_none();
        let mut seams = vec![EdgeId(usize::MAX); n];
        let first = (0..n).find(|j| !absent((j + n - 1) % n)).unwrap_or(0);
        for k in 0..n {
            let j = (first + k) % n;
            let before = (j + n - 1) % n;
            seams[j] = if absent(before) {
                seams[before]
            } else {
                let (start, end) = (lower.vertices[j], upper.vertices[j]);
                model.add_edge(start, end, Curve::segment(model.vertex(start), model.vertex(end)))
            };
        }
        let mut number = 0;
        for j in 0..n {
            if absent(j) {
                continue;
            }
            number += 1;
            let name = format!("{}/{}/{number}", names.path, names.stages[stage]);
            let side = [seams[j], seams[(j + 1) % n]];
            let face = match (lower.edges[j], upper.edges[j]) {
                (Some(a), Some(b)) => ruled(model, name, names.style, [a, b], side)?,
                (Some(a), None) | (None, Some(a)) => {
                    triangle(model, name, names.style, a, side, lower.edges[j].is_none())?
                }
                (None, None) => continue,
            };
            out.push((face, points_away(model, face, shape)));
        }
    }
    Ok(out)
}

/// The ruled face between two edges in the same parameter.
fn ruled(
    model: &mut Model,
    name: String,
    style: &Style,
    [lower, upper]: [EdgeId; 2],
    [left, right]: [EdgeId; 2],
) -> Result<FaceId, BoreError> {
    let curve = |id: EdgeId| match &model.edge(id).curve {
        coolinggen_brep::EdgeCurve::BSpline(curve) => Ok(curve.clone()),
        coolinggen_brep::EdgeCurve::Rational(_) => {
            Err(BoreError::Geometry("a rational delimiting curve".into()))
        }
    };
    let (a, b) = (curve(lower)?, curve(upper)?);
    let points: Vec<DVec3> = a.points().iter().zip(b.points()).flat_map(|(p, q)| [*p, *q]).collect();
    let surface = Surface::new(a.knots().clone(), Knots::clamped(1, &[0.0, 1.0])?, points)?;
    let line =
        |from: (f64, f64), to: (f64, f64)| straight_pcurve(DVec2::from(from), DVec2::from(to), (0.0, 1.0));
    let coedges = vec![
        Coedge { edge: lower, forward: true, pcurve: line((0.0, 0.0), (1.0, 0.0))? },
        Coedge { edge: right, forward: true, pcurve: line((1.0, 0.0), (1.0, 1.0))? },
        Coedge { edge: upper, forward: false, pcurve: line((0.0, 1.0), (1.0, 1.0))? },
        Coedge { edge: left, forward: false, pcurve: line((0.0, 0.0), (0.0, 1.0))? },
    ];
    let surface = SurfaceGeometry::BSpline(surface);
    Ok(model.add_face(Face { name, surface, loops: vec![Loop { coedges }], style: style.clone() }))
}

/// The plane face between an edge and the point where both seams meet, below it or above it.
fn triangle(
    model: &mut Model,
    name: String,
    style: &Style,
    edge: EdgeId,
    [left, right]: [EdgeId; 2],
    apex_below: bool,
) -> Result<FaceId, BoreError> {
    let apex = if apex_below { model.edge(left).start } else { model.edge(left).end };
    let origin = model.vertex(apex);
    let along = |id| model.vertex(id) - origin;
    let (from, to) = (along(model.edge(edge).start), along(model.edge(edge).end));
    let x = from.normalize();
    let y = (to - x * to.dot(x)).normalize();
    let surface = SurfaceGeometry::Plane(Plane { origin, x, y });
    let edges = if apex_below {
        [(right, true), (edge, false), (left, false)]
    } else {
        [(edge, true), (right, true), (left, false)]
    };
    let border = LoopEdges { edges: &edges, near: DVec2::ZERO };
    Ok(model.trimmed_face(name, surface, &[border], PLANE_TOLERANCE, style.clone())?)
}

/// Whether the natural normal of a face points away from the axis.
fn points_away(model: &Model, face: FaceId, shape: &BoreShape) -> bool {
    let face = model.face(face);
    let corners = face.loops[0].coedges.iter().map(|c| c.parameter_at(0.5));
    let q = corners.sum::<DVec2>() / face.loops[0].coedges.len() as f64;
    let (point, u, v) = face.surface.first_derivatives(q.x, q.y);
    let from_origin = point - shape.frame.origin;
    let across = from_origin - shape.frame.axis * from_origin.dot(shape.frame.axis);
    u.cross(v).dot(across) > 0.0
}

/// A ring as the border of a hole in the faces it lies on.
fn hole(model: &Model, shape: &BoreShape, mouth: &Mouth, ring: &Ring, traces: &[EndTrace]) -> Vec<RingPiece> {
    let (_, u, v) = model.face(mouth.face).surface.first_derivatives(mouth.at.x, mouth.at.y);
    // Rings run counterclockwise about the axis; holes clockwise about the face's normal.
    let forward = u.cross(v).dot(shape.frame.axis) < 0.0;
    let pieces = ring.edges.iter().zip(traces).filter_map(|(edge, trace)| {
        let (edge, (face, trace)) = ((*edge)?, trace.as_ref()?);
        Some(RingPiece { face: *face, coedge: Coedge { edge, forward, pcurve: trace.pcurve.clone() } })
    });
    let mut pieces: Vec<RingPiece> = pieces.collect();
    if !forward {
        pieces.reverse();
    }
    pieces
}
