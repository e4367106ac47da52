//! Straight extensions of the coolant before its inlets, for flow solvers; the metal is as it was.

use super::cap::Ring;
use super::error::BuildError;
use super::style;
use coolinggen_blade::{Fault, StreamSurface};
use coolinggen_brep::{EdgeCurve, EdgeId, FaceUse, LoopEdges, Model, Plane, SurfaceGeometry, VertexId};
use coolinggen_nurbs::{Curve, Knots, NurbsError, ParametricCurve, Surface};
use glam::{DVec2, DVec3};

/// Distance allowed between the lower edges and the plane they are made to lie on, mm.
const PLANE_TOLERANCE: f64 = 1e-8;

/// Adds the walls `<name>/inlet_extension/<k>` from the ring of an inlet down along the hub's normal, and the plane face
/// `name` that closes them `length` mm below the ring's middle. The faces are the coolant's, in place of the inlet's cap.
///
/// # Errors
/// A fault of `/cooling/inlet_extension` where the hub at the inlet is so curved that the plane would cut it.
pub(super) fn add_extension(
    model: &mut Model,
    name: &str,
    stream: &StreamSurface,
    ring: &Ring,
    length: f64,
) -> Result<Vec<FaceUse>, BuildError> {
    let points = outline(model, ring);
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    let up = stream.level(middle).1;
    let below = |p: DVec3| (p - middle).dot(up) + length;
    let lowest = points.iter().map(|&p| below(p) - length).fold(0.0, f64::min);
    if !(length + lowest > LEAST_PART * length) {
        let message = format!("the inlet \"{name}\" reaches {:.3} mm down from its middle", -lowest);
        let fault = Fault::new("/cooling/inlet_extension", "geometry", message).value(length);
        return Err(BuildError::Refused(vec![fault.min(-lowest / (1.0 - LEAST_PART)).unit("mm")]));
    }
    let first = ring.edges.iter().map(|&(id, forward)| {
        let edge = model.edge(id);
        if forward { edge.start } else { edge.end }
    });
    let upper: Vec<VertexId> = first.collect();
    let lower: Vec<VertexId> = (upper.iter())
        .map(|&id| {
            let p = model.vertex(id);
            model.add_vertex(p - up * below(p))
        })
        .collect();
    let seams: Vec<EdgeId> = (upper.iter().zip(&lower))
        .map(|(&a, &b)| model.add_edge(a, b, Curve::segment(model.vertex(a), model.vertex(b))))
        .collect();
    let mut faces = Vec::with_capacity(ring.edges.len() + 1);
    let mut bottom = Vec::with_capacity(ring.edges.len());
    let left_turning = area_about(&points, middle, up) > 0.0;
    for (k, &(id, forward)) in ring.edges.iter().enumerate() {
        let next = (k + 1) % ring.edges.len();
        let EdgeCurve::BSpline(top) = model.edge(id).curve.clone() else {
            return Err(NurbsError::NotFound { what: "the spline of an inlet's edge" }.into());
        };
        let (from, to) = if forward { (k, next) } else { (next, k) };
        let projected = top.points().iter().map(|&p| p - up * below(p)).collect();
        let projected = Curve::new(top.knots().clone(), projected)?
            .with_ends(model.vertex(lower[from]), model.vertex(lower[to]));
        let net = top.points().iter().zip(projected.points()).flat_map(|(p, q)| [*p, *q]).collect();
        let surface = Surface::new(top.knots().clone(), Knots::clamped(1, &[0.0, 1.0])?, net)?;
        let edge = model.add_edge(lower[from], lower[to], projected);
        bottom.push((edge, forward));
        let borders: [&[EdgeId]; 4] = [&[id], &[seams[to]], &[edge], &[seams[from]]];
        let path = format!("{name}/inlet_extension/{}", k + 1);
        let face = model.patch_face(path, surface, borders, style::inlet())?;
        // The natural normal is the edge's direction times down: out of the coolant where the edge runs clockwise.
        faces.push(FaceUse { face, forward: left_turning != forward });
    }
    // Looking down, out of the coolant.
    let x = up.any_orthonormal_vector();
    let plane = Plane { origin: middle - up * length, x, y: x.cross(up) };
    let closing = LoopEdges { edges: &bottom, near: DVec2::ZERO };
    let plane = SurfaceGeometry::Plane(plane);
    let face = model.trimmed_face(name, plane, &[closing], PLANE_TOLERANCE, style::inlet())?;
    faces.push(FaceUse { face, forward: true });
    Ok(faces)
}

/// Part of the length that must be left where the hub reaches down farthest.
const LEAST_PART: f64 = 0.05;

/// Points along a ring.
fn outline(model: &Model, ring: &Ring) -> Vec<DVec3> {
    const STEPS: u32 = 16;
    let along = |&(id, forward): &(EdgeId, bool)| {
        let curve = &model.edge(id).curve;
        let (start, end) = curve.domain();
        let at = move |i: u32| {
            let t = f64::from(i) / f64::from(STEPS);
            let t = if forward { t } else { 1.0 - t };
            curve.point(start + (end - start) * t)
        };
        (0..STEPS).map(at)
    };
    ring.edges.iter().flat_map(along).collect()
}

/// Area of a closed polygon as seen against `up`, positive where it turns left.
fn area_about(points: &[DVec3], middle: DVec3, up: DVec3) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| (*a - middle).cross(*b - middle).dot(up)).sum()
}
