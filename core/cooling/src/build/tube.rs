//! Tubes: closed rings of patches that run from hub to tip and are cut off by two stream surfaces. The blade's outer
//! surface is one, a radial hole another.

use super::cap::Ring;
use super::error::BuildError;
use coolinggen_blade::StreamSurface;
use coolinggen_brep::{
    Coedge, EdgeCurve, EdgeId, Face, FaceId, Loop, Model, Style, SurfaceGeometry, VertexId, straight_pcurve,
};
use coolinggen_nurbs::{
    Curve, Interpolator, Knots, NurbsError, ParametricCurve, ParametricSurface, RationalCurve,
};
use glam::{DVec2, DVec3};

/// One patch of a tube: u runs round the tube, v from hub to tip and beyond both.
#[derive(Clone, Debug)]
pub(super) struct Patch {
    pub(super) name: String,
    pub(super) style: Style,
    /// A B-spline surface, rational or not.
    pub(super) surface: SurfaceGeometry,
}

/// A tube cut at both ends.
#[derive(Clone, Debug)]
pub(super) struct CutTube {
    pub(super) faces: Vec<FaceId>,
    /// The lower and the upper ring, in the direction of u; without edges where the tube ends in a point.
    pub(super) rings: [Ring; 2],
}

/// How far an edge may lie from the stream surface or the patch between its nodes, mm. FreeCAD's check allows
/// 7e-8 including the reader's own interpolation (DESIGN 6).
const EDGE_TOLERANCE: f64 = 1e-8;
/// Most parts that a span of the patch is cut into to reach it.
const MOST_PARTS: usize = 200;

/// Where a patch meets a stream surface.
pub(super) struct Crossing {
    pub(super) curve: Curve<DVec3>,
    pub(super) pcurve: Curve<DVec2>,
}

/// Adds the faces of a tube, cut by `ends` (lower, upper), to the model.
pub(super) fn add_tube(
    model: &mut Model,
    patches: Vec<Patch>,
    ends: [&StreamSurface; 2],
) -> Result<CutTube, BuildError> {
    let count = patches.len();
    let mut crossings: [Vec<Crossing>; 2] = [Vec::new(), Vec::new()];
    for patch in &patches {
        let (_, (low, high)) = patch.surface.domain();
        for (side, guess) in [(0, low + 0.05 * (high - low)), (1, high - 0.05 * (high - low))] {
            let crossing = crossing(&patch.surface, ends[side], guess)
                .ok_or_else(|| BuildError::NoCrossing { face: patch.name.clone(), v: ends[side].v() })?;
            crossings[side].push(crossing);
        }
    }
    // One vertex a joint and end: where a patch begins. The patch before ends there, bit for bit.
    let vertices: Vec<[VertexId; 2]> = (0..count)
        .map(|k| [0, 1].map(|side| model.add_vertex(crossings[side][k].curve.points()[0])))
        .collect();
    let mut ring_edges: [Vec<EdgeId>; 2] = [Vec::new(), Vec::new()];
    for side in [0, 1] {
        for k in 0..count {
            let (start, end) = (vertices[k][side], vertices[(k + 1) % count][side]);
            let curve = crossings[side][k].curve.clone().with_ends(model.vertex(start), model.vertex(end));
            ring_edges[side].push(model.add_edge(start, end, curve));
        }
    }
    let mut uprights = Vec::new();
    for (k, patch) in patches.iter().enumerate() {
        let ((u, _), _) = patch.surface.domain();
        let span = [0, 1].map(|side| crossings[side][k].pcurve.points()[0].y);
        let [start, end] = vertices[k];
        let curve = upright_curve(&patch.surface, u, span, [model.vertex(start), model.vertex(end)])?;
        uprights.push((model.add_edge(start, end, curve), span));
    }
    let [lower, upper] = crossings;
    let mut faces = Vec::new();
    for (k, ((patch, low), high)) in patches.into_iter().zip(lower).zip(upper).enumerate() {
        let ((u0, u1), _) = patch.surface.domain();
        let (left, span) = uprights[k];
        let (right, right_span) = uprights[(k + 1) % count];
        let coedges = vec![
            Coedge { edge: ring_edges[0][k], forward: true, pcurve: low.pcurve },
            Coedge { edge: right, forward: true, pcurve: upright_pcurve(u1, right_span)? },
            Coedge { edge: ring_edges[1][k], forward: false, pcurve: high.pcurve },
            Coedge { edge: left, forward: false, pcurve: upright_pcurve(u0, span)? },
        ];
        faces.push(model.add_face(Face {
            name: patch.name,
            surface: patch.surface,
            loops: vec![Loop { coedges }],
            style: patch.style,
        }));
    }
    let rings = ring_edges.map(|edges| Ring { edges: edges.into_iter().map(|e| (e, true)).collect() });
    Ok(CutTube { faces, rings })
}

/// The straight parameter curve of an upright edge, whose curve has the domain `span`.
pub(super) fn upright_pcurve(u: f64, [start, end]: [f64; 2]) -> Result<Curve<DVec2>, NurbsError> {
    straight_pcurve(DVec2::new(u, start), DVec2::new(u, end), (start, end))
}

/// The line of constant u between two values of v, exact, with the vertices' points at its ends.
pub(super) fn upright_curve(
    surface: &SurfaceGeometry,
    u: f64,
    span: [f64; 2],
    ends: [DVec3; 2],
) -> Result<EdgeCurve, NurbsError> {
    match surface {
        SurfaceGeometry::BSpline(s) => {
            let iso = s.iso_u(u).restricted(span[0], span[1])?;
            Ok(iso.with_ends(ends[0], ends[1]).into())
        }
        SurfaceGeometry::Rational(s) => {
            let iso = s.homogeneous().iso_u(u).restricted(span[0], span[1])?;
            Ok(EdgeCurve::Rational(RationalCurve::from_homogeneous(iso)?))
        }
        SurfaceGeometry::Plane(_) | SurfaceGeometry::Revolution(_) => {
            Err(NurbsError::NotFound { what: "an upright edge of a patch that is no spline" })
        }
    }
}

/// Parameter v at which the line of constant u meets a stream surface.
pub(super) fn meet(
    surface: &impl ParametricSurface<DVec3>,
    u: f64,
    guess: f64,
    stream: &StreamSurface,
) -> Option<f64> {
    let (_, (low, high)) = surface.domain();
    let mut v = guess;
    for _ in 0..40 {
        let (point, _, along) = surface.first_derivatives(u, v);
        let (level, gradient) = stream.level(point);
        let step = level / gradient.dot(along);
        if !step.is_finite() {
            return None;
        }
        let limit = 0.2 * (high - low);
        v = (v - step.clamp(-limit, limit)).clamp(low, high);
        if (step * along.length()).abs() < 1e-12 {
            return Some(v);
        }
    }
    let level = stream.level(surface.point(u, v)).0;
    (level.abs() < 1e-10).then_some(v)
}

/// The pace of an edge along a patch: u over a parameter in [0, 1] in which the spans of the patch are about equally
/// long.
///
/// Readers interpolate parameter curves of their own at equal steps of the edge's parameter (OpenCASCADE: some four
/// a span, spread over the whole edge). The patch's spans are short where its curvature changes fast; at this pace
/// the steps are, too. Beside a trailing edge of 0.6 mm it takes the reader's error from 2e-6 mm below 1e-8 mm.
///
/// The quintic with every fourth break for a control point increases as they do and is much smoother than they are.
fn pace(breaks: &[f64]) -> Result<Curve<f64>, NurbsError> {
    const DEGREE: usize = 5;
    let last = breaks.len() - 1;
    let knots = Knots::uniform(DEGREE, (last / 4).max(DEGREE + 1))?;
    let controls = knots.greville().into_iter().map(|g| {
        let place = g * last as f64;
        let i = (place as usize).min(last - 1);
        breaks[i] + (breaks[i + 1] - breaks[i]) * (place - i as f64)
    });
    let controls = controls.collect();
    Curve::new(knots, controls)
}

/// Parameter at which an increasing curve over [0, 1] has the value `u`: Newton's method between bisection bounds.
fn inverse(pace: &Curve<f64>, u: f64, guess: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    let mut t = guess;
    for _ in 0..60 {
        let [value, slope] = pace.first_derivatives(t);
        let miss = value - u;
        *(if miss > 0.0 { &mut high } else { &mut low }) = t;
        let newton = t - miss / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - t).abs() < 1e-15 {
            break;
        }
        t = next;
    }
    t
}

/// Intersection of a patch with a stream surface, u running over the patch's whole domain: nodes at every knot in u
/// and between, with the exact slopes at the ends, refined until it lies on both.
pub(super) fn crossing(surface: &SurfaceGeometry, stream: &StreamSurface, guess: f64) -> Option<Crossing> {
    let breaks = surface.breaks_u();
    // Where a line of constant v crosses, readers take the straight parameter line, which needs no pace.
    let level_v = meet(surface, breaks[0], guess, stream)?;
    let level_at = |u: f64| stream.level(surface.point(u, level_v)).0.abs();
    let straight = breaks.iter().all(|&u| level_at(u) < 1e-11);
    let pace =
        if straight { Curve::segment(breaks[0], breaks[breaks.len() - 1]) } else { pace(&breaks).ok()? };
    let mut parts = 2;
    loop {
        let count = (breaks.len() - 1) * parts;
        let mut nodes = vec![0.0];
        let mut parameters = vec![DVec2::new(breaks[0], level_v)];
        for i in 1..=count {
            let (span, part) = ((i - 1) / parts, (i - 1) % parts + 1);
            let u = breaks[span] + (breaks[span + 1] - breaks[span]) * part as f64 / parts as f64;
            let before = (nodes[i - 1], parameters[i - 1]);
            nodes.push(if i == count { 1.0 } else { inverse(&pace, u, before.0) });
            parameters.push(DVec2::new(u, meet(surface, u, before.1.y, stream)?));
        }
        let slope = |t: f64, p: DVec2| {
            let (point, along_u, along_v) = surface.first_derivatives(p.x, p.y);
            let gradient = stream.level(point).1;
            let v = -gradient.dot(along_u) / gradient.dot(along_v);
            let speed = pace.first_derivatives(t)[1];
            (DVec2::new(1.0, v) * speed, (along_u + along_v * v) * speed)
        };
        let ((first_2d, first), (last_2d, last)) = (slope(0.0, parameters[0]), slope(1.0, parameters[count]));
        let points: Vec<DVec3> = parameters.iter().map(|p| surface.point(p.x, p.y)).collect();
        let interpolator = Interpolator::with_slopes(&nodes).ok()?;
        let curve = interpolator.curve_with_slopes(&points, first, last).ok()?;
        let pcurve = interpolator.curve_with_slopes(&parameters, first_2d, last_2d).ok()?;
        let worst = nodes.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).fold(0.0f64, |worst, t| {
            let (point, q) = (curve.point(t), pcurve.point(t));
            let (on_patch, du, dv) = surface.first_derivatives(q.x, q.y);
            let off_patch = (point - on_patch).dot(du.cross(dv).normalize()).abs();
            let (level, gradient) = stream.level(point);
            worst.max(off_patch).max(level.abs() / gradient.length())
        });
        if worst <= EDGE_TOLERANCE {
            return Some(Crossing { curve, pcurve });
        }
        if parts >= MOST_PARTS || !worst.is_finite() {
            return None;
        }
        // The error falls with the fourth power of the step.
        let finer = parts as f64 * 1.1 * (worst / EDGE_TOLERANCE).powf(0.25);
        parts = (finer.ceil() as usize).clamp(parts + 1, MOST_PARTS);
    }
}
