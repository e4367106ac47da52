//! From shape to topology: the faces of a bore, and the holes they leave in the faces they end on.

use super::BoreError;
use super::legs::{Leg, legs};
use super::rims::Rim;
use super::ring::{Interpolators, Stretch, Trace};
use super::shape::{BoreShape, Path};
use super::target::{Mouth, Ray, Target};
use coolinggen_brep::{
    Coedge, EdgeId, Face, FaceId, Imprint, Loop, LoopEdges, Model, Plane, RingPiece, Style, SurfaceGeometry,
    VertexId, straight_pcurve,
};
use coolinggen_nurbs::{Curve, Knots, ParametricCurve, ParametricSurface, Surface};
use glam::{DVec2, DVec3};

/// Makes bores; keeps what they have in common.
#[derive(Debug, Default)]
pub(crate) struct Drill {
    interpolators: Interpolators,
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

/// A piece of the bore between two neighbouring seams: part of one path.
#[derive(Clone, Copy, Debug)]
struct Piece {
    path: usize,
    from: f64,
    to: f64,
}

/// A delimiting curve with the face it lies on; none for a point.
type EndTrace = Option<(FaceId, Trace)>;

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
        clear: &mut dyn FnMut([Rim; 2]) -> Result<(), BoreError>,
    ) -> Result<Bored, BoreError> {
        let targets = [0, 1].map(|side| Target::new(&*model, ends[side].0));
        let last = shape.sections.len() - 1;
        let end_legs =
            [end_legs(&targets[0], shape, 0, &ends[0].1)?, end_legs(&targets[1], shape, last, &ends[1].1)?];
        let pieces = pieces(shape, &end_legs);
        let mut spans = Vec::with_capacity(pieces.len());
        let mut traces: [Vec<EndTrace>; 2] = [Vec::new(), Vec::new()];
        for piece in &pieces {
            let (count, pair) = self.end_traces(shape, &targets, &end_legs, piece)?;
            spans.push(count);
            for (traces, trace) in traces.iter_mut().zip(pair) {
                traces.push(trace);
            }
        }
        clear([rim(&traces[0]), rim(&traces[1])])?;
        // From here on the model changes.
        let crossed = split_borders(model, &end_legs)?;
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
                None => (pieces.iter().zip(&spans))
                    .map(|(piece, &spans)| self.middle_curve(shape, section, piece, spans))
                    .collect::<Result<_, _>>()?,
            };
            let at_border = |piece: &Piece| {
                side.and_then(|s| {
                    crossed[s].iter().find(|c| c.0 == piece.path && c.1 == piece.from).map(|c| c.2)
                })
            };
            rings.push(ring(model, &pieces, curves, at_border));
        }
        let faces = faces(model, shape, &pieces, &rings, names)?;
        let mut imprints = Vec::with_capacity(2);
        for (side, section) in [(0, 0), (1, last)] {
            let ring = hole(model, shape, &ends[side].1, &rings[section], &traces[side]);
            imprints.push(model.imprint(&ring)?);
        }
        let upper = imprints.pop().unwrap_or_default();
        let lower = imprints.pop().unwrap_or_default();
        Ok(Bored { faces, imprints: [lower, upper] })
    }

    /// The delimiting curves of a piece at both ends, with the faces they lie on, in as many spans as both need; none
    /// for points.
    fn end_traces(
        &mut self,
        shape: &BoreShape,
        targets: &[Target<'_>; 2],
        end_legs: &[Vec<Vec<Leg>>; 2],
        piece: &Piece,
    ) -> Result<(usize, [EndTrace; 2]), BoreError> {
        let mut spans = match shape.sections[0].paths[piece.path] {
            // As fine as keeps a middle ring within 1e-6 of its radius.
            Path::Arc { sweep, .. } => {
                (14.0 * sweep.abs() * (piece.to - piece.from) / 1.57).ceil().max(4.0) as usize
            }
            Path::Line { .. } | Path::Fan { .. } | Path::Point(_) => 4,
        };
        let last = shape.sections.len() - 1;
        let rays = [0, last].map(|section| move |t: f64| ray(shape, section, piece.path, t));
        let ends = [0, 1].map(|side| {
            let section = [0, last][side];
            (!shape.sections[section].paths[piece.path].is_point()).then(|| {
                let leg = leg_of(&end_legs[side][piece.path], piece);
                stretch(shape, piece, &targets[side], leg, &rays[side])
            })
        });
        let mut traces = [None, None];
        for (end, trace) in ends.iter().zip(&mut traces) {
            if let Some(stretch) = end {
                let (count, found) = stretch.traced_closely(&mut self.interpolators, spans)?;
                spans = count;
                *trace = Some((count, stretch.face, found));
            }
        }
        // What served one end may be too few for the other.
        let mut out = [None, None];
        for ((end, trace), out) in ends.iter().zip(traces).zip(&mut out) {
            *out = match (end, trace) {
                (Some(stretch), Some((count, face, _))) if count != spans => {
                    Some((face, stretch.traced(&mut self.interpolators, spans)?))
                }
                (_, trace) => trace.map(|(_, face, trace)| (face, trace)),
            };
        }
        Ok((spans, out))
    }

    /// The curve of a piece in a section between the ends.
    fn middle_curve(
        &mut self,
        shape: &BoreShape,
        section: usize,
        piece: &Piece,
        spans: usize,
    ) -> Result<Option<Curve<DVec3>>, BoreError> {
        let section = &shape.sections[section];
        let path = &section.paths[piece.path];
        if path.is_point() {
            return Ok(None);
        }
        let (grading, range) = (path.grading(), (piece.from, piece.to));
        let at = |k: usize| path.evaluate(grading.at(range, k, spans));
        let points: Vec<DVec3> = (0..=spans).map(|k| shape.frame.point(at(k).0, section.z)).collect();
        let slope = |k: usize| shape.frame.vector(at(k).1) * grading.end_speed(range);
        Ok(Some(self.interpolators.of(spans)?.curve_with_slopes(&points, slope(0), slope(spans))?))
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

/// What is to be traced of a piece on its leg.
fn stretch<'a, 'm>(
    shape: &BoreShape,
    piece: &Piece,
    target: &'a Target<'m>,
    leg: &Leg,
    rays: &'a dyn Fn(f64) -> Ray,
) -> Stretch<'a, 'm> {
    let (range, grading) = ((piece.from, piece.to), shape.sections[0].paths[piece.path].grading());
    Stretch { target, face: leg.face, rays, range, grading, start: leg.start }
}

/// The line of a path at `t` that ends at the first section or at the last one.
fn ray(shape: &BoreShape, section: usize, path: usize, t: f64) -> Ray {
    let lower = section.min(shape.sections.len() - 2);
    let (a, b) = (&shape.sections[lower], &shape.sections[lower + 1]);
    let ((p, dp), (q, dq)) = (a.paths[path].evaluate(t), b.paths[path].evaluate(t));
    let (origin, end) = (shape.frame.point(p, a.z), shape.frame.point(q, b.z));
    let (origin_slope, end_slope) = (shape.frame.vector(dp), shape.frame.vector(dq));
    Ray { origin, direction: end - origin, origin_slope, direction_slope: end_slope - origin_slope }
}

/// The legs of every path at one end, none for points.
fn end_legs(
    target: &Target<'_>,
    shape: &BoreShape,
    section: usize,
    mouth: &Mouth,
) -> Result<Vec<Vec<Leg>>, BoreError> {
    let lower = section.min(shape.sections.len() - 2);
    let (a, b) = (shape.sections[lower].z, shape.sections[lower + 1].z);
    let frame = &shape.frame;
    // From the axis out to the rim.
    let rim = ray(shape, section, 0, 0.0);
    let (origin, direction) = (frame.point(DVec2::ZERO, a), frame.axis * (b - a));
    let spoke = |t: f64| Ray {
        origin: origin + (rim.origin - origin) * t,
        direction: direction + (rim.direction - direction) * t,
        origin_slope: rim.origin - origin,
        direction_slope: rim.direction - direction,
    };
    let along = (mouth.z - a) / (b - a);
    let (_, (face, hit)) = legs(target, &spoke, (mouth.face, mouth.at, along))?;
    let mut start = (face, hit.at, hit.along);
    let mut out = Vec::with_capacity(shape.sections[section].paths.len());
    for (k, path) in shape.sections[section].paths.iter().enumerate() {
        if path.is_point() {
            out.push(Vec::new());
            continue;
        }
        let rays = |t: f64| ray(shape, section, k, t);
        let (path_legs, (face, hit)) = legs(target, &rays, start)?;
        start = (face, hit.at, hit.along);
        // A bore of several stages must not end within another stage.
        if shape.sections.len() > 2 {
            let beyond = if section == 0 { hit.along - 1.0 } else { -hit.along };
            if beyond > 0.0 {
                return Err(BoreError::TooShort(beyond * (b - a)));
            }
        }
        out.push(path_legs);
    }
    Ok(out)
}

/// The paths cut wherever one of their ends crosses a border.
fn pieces(shape: &BoreShape, end_legs: &[Vec<Vec<Leg>>; 2]) -> Vec<Piece> {
    let mut out = Vec::new();
    for path in 0..shape.sections[0].paths.len() {
        let crossings = end_legs.iter().flat_map(|legs| &legs[path]).filter_map(|leg| leg.crossing);
        let mut cuts: Vec<f64> = [0.0, 1.0].into_iter().chain(crossings.map(|c| c.t)).collect();
        cuts.sort_by(f64::total_cmp);
        out.extend(cuts.windows(2).map(|pair| Piece { path, from: pair[0], to: pair[1] }));
    }
    out
}

/// The leg on which a piece lies.
fn leg_of<'l>(legs: &'l [Leg], piece: &Piece) -> &'l Leg {
    let middle = 0.5 * (piece.from + piece.to);
    legs.iter().find(|leg| middle <= leg.to).unwrap_or(&legs[legs.len() - 1])
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
