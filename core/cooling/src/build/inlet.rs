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

/// The hub's normal in the middle of all inlets, against which they go on; none where there are none. One direction keeps them
/// apart; along normals of their own those of neighbouring chambers would meet below the hub.
///
/// # Errors
/// A fault of `/cooling/inlet_extension` where the hub turns too far between the inlets to have one direction.
pub(super) fn upward<'a>(
    model: &Model,
    stream: &StreamSurface,
    inlets: impl Iterator<Item = (&'a str, &'a Ring)>,
) -> Result<Option<DVec3>, BuildError> {
    let middles: Vec<(&str, DVec3)> =
        inlets.map(|(name, ring)| (name, middle(&outline(model, ring)))).collect();
    if middles.is_empty() {
        return Ok(None);
    }
    let normal = |p: DVec3| stream.level(p).1;
    let up = normal(middles.iter().map(|m| m.1).sum::<DVec3>() / middles.len() as f64);
    let tilted = middles.iter().map(|&(name, at)| (name, normal(at).angle_between(up).to_degrees()));
    match tilted.max_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((name, angle)) if angle > MOST_TILT_DEG => {
            let message = format!(
                "the hub at the inlet \"{name}\" is turned by {angle:.1} deg from that between all inlets"
            );
            let fault = Fault::new("/cooling/inlet_extension", "geometry", message).value(angle);
            let hint = "no extension, or inlets that lie nearer to each other round the hub";
            Err(BuildError::Refused(vec![fault.max(MOST_TILT_DEG).unit("deg").hint(hint)]))
        }
        _ => Ok(Some(up)),
    }
}

/// Where the inlets of one chamber go on, the gap round an insert and its plenum alike: straight down to a plane across.
pub(super) struct Duct {
    /// The middle of its ring.
    middle: DVec3,
    /// Against the direction in which it runs.
    up: DVec3,
    /// How far below the middle its plane lies, mm.
    length: f64,
}

impl Duct {
    /// The duct below a ring; `name` is that of the inlet.
    ///
    /// # Errors
    /// A fault of `/cooling/inlet_extension` where the hub at the inlet is so curved that the plane would cut it.
    pub(super) fn new(
        model: &Model,
        name: &str,
        ring: &Ring,
        up: DVec3,
        length: f64,
    ) -> Result<Self, BuildError> {
        let points = outline(model, ring);
        let duct = Self { middle: middle(&points), up, length };
        let lowest = points.iter().map(|&p| duct.above(p) - length).fold(0.0, f64::min);
        if !(length + lowest > LEAST_PART * length) {
            let message = format!("the inlet \"{name}\" reaches {:.3} mm down from its middle", -lowest);
            let fault = Fault::new("/cooling/inlet_extension", "geometry", message).value(length);
            return Err(BuildError::Refused(vec![fault.min(-lowest / (1.0 - LEAST_PART)).unit("mm")]));
        }
        Ok(duct)
    }

    /// How far a point lies above the duct's plane, mm.
    fn above(&self, p: DVec3) -> f64 {
        (p - self.middle).dot(self.up) + self.length
    }

    /// Adds the walls `<name>/inlet_extension/<k>` from the ring of an inlet down, `<name>/inlet_extension/insert/<k>`
    /// from that of an insert that stands in it, and the plane face `name` that closes them, which comes last. The faces
    /// are the coolant's, in place of the inlet's cap.
    pub(super) fn extend(
        &self,
        model: &mut Model,
        name: &str,
        ring: &Ring,
        inserted: Option<&Ring>,
    ) -> Result<Vec<FaceUse>, BuildError> {
        let mut faces = Vec::with_capacity(2 * ring.edges.len() + 1);
        let walls = format!("{name}/inlet_extension");
        let mut bottoms = vec![self.walls(model, &walls, ring, true, &mut faces)?];
        if let Some(ring) = inserted {
            bottoms.push(self.walls(model, &format!("{walls}/insert"), ring, false, &mut faces)?);
        }
        // Looking down, out of the coolant.
        let x = self.up.any_orthonormal_vector();
        let plane = Plane { origin: self.middle - self.up * self.length, x, y: x.cross(self.up) };
        let plane = SurfaceGeometry::Plane(plane);
        let loops: Vec<LoopEdges<'_>> =
            bottoms.iter().map(|edges| LoopEdges { edges, near: DVec2::ZERO }).collect();
        let face = model.trimmed_face(name, plane, &loops, PLANE_TOLERANCE, style::inlet())?;
        faces.push(FaceUse { face, forward: true });
        Ok(faces)
    }

    /// The walls below a ring, `around` the coolant or within it; answers with their lower edges.
    fn walls(
        &self,
        model: &mut Model,
        name: &str,
        ring: &Ring,
        around: bool,
        faces: &mut Vec<FaceUse>,
    ) -> Result<Vec<(EdgeId, bool)>, BuildError> {
        let left_turning = area_about(&outline(model, ring), self.middle, self.up) > 0.0;
        let dropped = |p: DVec3| p - self.up * self.above(p);
        let first = ring.edges.iter().map(|&(id, forward)| {
            let edge = model.edge(id);
            if forward { edge.start } else { edge.end }
        });
        let upper: Vec<VertexId> = first.collect();
        let lower: Vec<VertexId> =
            upper.iter().map(|&id| model.add_vertex(dropped(model.vertex(id)))).collect();
        let seams: Vec<EdgeId> = (upper.iter().zip(&lower))
            .map(|(&a, &b)| model.add_edge(a, b, Curve::segment(model.vertex(a), model.vertex(b))))
            .collect();
        let mut bottom = Vec::with_capacity(ring.edges.len());
        for (k, &(id, forward)) in ring.edges.iter().enumerate() {
            let next = (k + 1) % ring.edges.len();
            let EdgeCurve::BSpline(top) = model.edge(id).curve.clone() else {
                return Err(NurbsError::NotFound { what: "the spline of an inlet's edge" }.into());
            };
            let (from, to) = if forward { (k, next) } else { (next, k) };
            let projected = top.points().iter().map(|&p| dropped(p)).collect();
            let projected = Curve::new(top.knots().clone(), projected)?
                .with_ends(model.vertex(lower[from]), model.vertex(lower[to]));
            let net = top.points().iter().zip(projected.points()).flat_map(|(p, q)| [*p, *q]).collect();
            let surface = Surface::new(top.knots().clone(), Knots::clamped(1, &[0.0, 1.0])?, net)?;
            let edge = model.add_edge(lower[from], lower[to], projected);
            bottom.push((edge, forward));
            let borders: [&[EdgeId]; 4] = [&[id], &[seams[to]], &[edge], &[seams[from]]];
            let face = model.patch_face(format!("{name}/{}", k + 1), surface, borders, style::inlet())?;
            // The natural normal is the edge's direction times down: into a ring that it runs round to the left.
            faces.push(FaceUse { face, forward: (left_turning == forward) != around });
        }
        Ok(bottom)
    }
}

/// Part of the length that must be left where the hub reaches down farthest.
const LEAST_PART: f64 = 0.05;
/// How far the hub at an inlet may be turned from the common direction, degrees.
const MOST_TILT_DEG: f64 = 60.0;

fn middle(points: &[DVec3]) -> DVec3 {
    points.iter().sum::<DVec3>() / points.len() as f64
}

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
