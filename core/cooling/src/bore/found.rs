//! What is found of a bore on the faces it ends on, before the model changes: where its lines meet them, the borders it
//! crosses, the delimiting curves.
//!
//! All of it follows from the bore's shape, the faces' surfaces, and what lies over the borders that it crosses: a bore
//! that was found before on the same surfaces, and asks the same of the borders, is found again.

use super::BoreError;
use super::build::Wholes;
use super::legs::{Leg, legs};
use super::ring::{Interpolators, Stretch, Trace};
use super::shape::{BoreShape, Path};
use super::target::{Inquiry, Mouth, Ray, Target};
use coolinggen_brep::{Content, EdgeId, FaceId, Key, Model};
use coolinggen_nurbs::Curve;
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// A piece of the bore between two neighbouring seams: part of one path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) path: usize,
    pub(super) from: f64,
    pub(super) to: f64,
}

/// A delimiting curve with the face it lies on; none for a point.
pub(super) type EndTrace = Option<(FaceId, Trace)>;

/// What is found of a bore.
#[derive(Clone, Debug)]
pub(super) struct Found {
    /// The legs of every path at both ends.
    pub(super) legs: [Vec<Vec<Leg>>; 2],
    pub(super) pieces: Vec<Piece>,
    /// The delimiting curves at both ends, none where a piece has no length.
    pub(super) traces: [Vec<EndTrace>; 2],
    /// The curves of the sections between the ends.
    pub(super) middles: Vec<Vec<Option<Curve<DVec3>>>>,
    /// The faces at which the search began.
    mouths: [FaceId; 2],
    /// What was asked of the borders at both ends.
    inquiries: [Vec<Inquiry>; 2],
    /// The whole of every face in these, of which it is a part or all.
    wholes: HashMap<FaceId, FaceId>,
}

/// Everything that is found of a bore depends on, but for the borders.
pub(super) fn key_of(shape: &BoreShape, mouths: [Mouth; 2], wholes: &dyn Wholes) -> Key {
    mouths.iter().fold(Key::of(shape), |key, mouth| key.and((wholes.whole(mouth.face).0, mouth.at, mouth.z)))
}

impl Found {
    pub(super) fn new(
        interpolators: &mut Interpolators,
        model: &Model,
        shape: &BoreShape,
        ends: [(&[FaceId], Mouth); 2],
        wholes: &dyn Wholes,
    ) -> Result<Self, BoreError> {
        let targets = ends.map(|(faces, _)| Target::new(model, faces));
        let last = shape.sections.len() - 1;
        let legs =
            [end_legs(&targets[0], shape, 0, &ends[0].1)?, end_legs(&targets[1], shape, last, &ends[1].1)?];
        let pieces = pieces(shape, &legs);
        let mut spans = Vec::with_capacity(pieces.len());
        let mut traces: [Vec<EndTrace>; 2] = [Vec::new(), Vec::new()];
        for piece in &pieces {
            let (count, pair) = end_traces(interpolators, shape, &targets, &legs, piece)?;
            spans.push(count);
            for (traces, trace) in traces.iter_mut().zip(pair) {
                traces.push(trace);
            }
        }
        let mut middles = Vec::with_capacity(last.saturating_sub(1));
        for section in 1..last {
            let curves = (pieces.iter().zip(&spans))
                .map(|(piece, &spans)| middle_curve(interpolators, shape, section, piece, spans));
            middles.push(curves.collect::<Result<_, _>>()?);
        }
        let inquiries = targets.map(Target::into_inquiries);
        let mouths = ends.map(|(_, mouth)| mouth.face);
        let beyond = inquiries.iter().flatten().filter_map(|inquiry| inquiry.answer.map(|over| over.to));
        let wholes = mouths.into_iter().chain(beyond).map(|face| (face, wholes.whole(face))).collect();
        Ok(Self { legs, pieces, traces, middles, mouths, inquiries, wholes })
    }

    /// What was found, on faces that bores before have parted otherwise; none if that makes a difference.
    pub(super) fn again(
        &self,
        model: &Model,
        ends: [(&[FaceId], Mouth); 2],
        wholes: &dyn Wholes,
    ) -> Option<Self> {
        let mut found = self.clone();
        for side in 0..2 {
            let (faces, mouth) = ends[side];
            let target = Target::new(model, faces);
            let mut now = Renamed::default();
            now.face(self.mouths[side], mouth.face)?;
            for inquiry in &self.inquiries[side] {
                let answer = inquiry.again(&target, *now.faces.get(&inquiry.face)?)?;
                if let (Some(before), Some(over)) = (inquiry.answer, answer) {
                    now.face(before.to, over.to)?;
                    now.edge(before.edge, over.edge)?;
                }
            }
            for leg in found.legs[side].iter_mut().flatten() {
                leg.face = *now.faces.get(&leg.face)?;
                if let Some(crossing) = &mut leg.crossing {
                    crossing.to = *now.faces.get(&crossing.to)?;
                    crossing.edge = *now.edges.get(&crossing.edge)?;
                }
            }
            for (face, _) in found.traces[side].iter_mut().flatten() {
                *face = *now.faces.get(face)?;
            }
            // Parts have the surfaces of their wholes, and nothing else of them was looked at.
            if now.faces.iter().any(|(before, after)| self.wholes.get(before) != Some(&wholes.whole(*after)))
            {
                return None;
            }
        }
        Some(found)
    }
}

/// What faces and edges are called now; each has one name.
#[derive(Default)]
struct Renamed {
    faces: HashMap<FaceId, FaceId>,
    edges: HashMap<EdgeId, EdgeId>,
}

impl Renamed {
    fn face(&mut self, before: FaceId, now: FaceId) -> Option<()> {
        (*self.faces.entry(before).or_insert(now) == now).then_some(())
    }

    fn edge(&mut self, before: EdgeId, now: EdgeId) -> Option<()> {
        (*self.edges.entry(before).or_insert(now) == now).then_some(())
    }
}

impl Content for BoreShape {
    fn write(&self, key: &mut Key) {
        let frame = &self.frame;
        ((frame.origin, frame.x, frame.y), frame.axis, self.sections.len()).write(key);
        for section in &self.sections {
            (section.z, section.paths.len()).write(key);
            for path in &section.paths {
                match *path {
                    Path::Arc { center, radius, start, sweep } => {
                        ((0_usize, center), radius, (start, sweep)).write(key);
                    }
                    Path::Line { from, to } => (1_usize, from, to).write(key),
                    Path::Fan { from, to, pace } => ((2_usize, from), to, pace).write(key),
                    Path::Point(at) => (3_usize, at).write(key),
                }
            }
        }
    }
}

/// The delimiting curves of a piece at both ends, in as many spans as both need, and their number.
fn end_traces(
    interpolators: &mut Interpolators,
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
            let (count, found) = stretch.traced_closely(interpolators, spans)?;
            spans = count;
            *trace = Some((count, stretch.face, found));
        }
    }
    // What served one end may be too few for the other.
    let mut out = [None, None];
    for ((end, trace), out) in ends.iter().zip(traces).zip(&mut out) {
        *out = match (end, trace) {
            (Some(stretch), Some((count, face, _))) if count != spans => {
                Some((face, stretch.traced(interpolators, spans)?))
            }
            (_, trace) => trace.map(|(_, face, trace)| (face, trace)),
        };
    }
    Ok((spans, out))
}

/// The curve of a piece in a section between the ends.
fn middle_curve(
    interpolators: &mut Interpolators,
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
    Ok(Some(interpolators.of(spans)?.curve_with_slopes(&points, slope(0), slope(spans))?))
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
