//! Faces without boilerplate: parameter curves and loops made from edges and a surface.

mod error;
mod pcurve;

pub use error::BuildError;
pub use pcurve::{Pcurve, interpolated_pcurve, straight_pcurve};

use crate::domain::signed_area;
use crate::geometry::SurfaceGeometry;
use crate::model::{Coedge, EdgeId, Face, FaceId, FaceUse, Loop, Model, Shell, Style};
use coolinggen_nurbs::{ParametricCurve, ParametricSurface};
use glam::{DVec2, DVec3};

/// Distance within which edge and border must meet for [`Model::patch_face`], mm. Whether they meet between
/// their ends is for [`Model::check_solid`] to say.
pub const BORDER_TOLERANCE_MM: f64 = 1e-6;

/// A closed chain of edges to be traced on a surface: see [`Model::trimmed_face`].
#[derive(Clone, Debug)]
pub struct LoopEdges<'a> {
    /// The edges in order, each with whether the loop runs along it.
    pub edges: &'a [(EdgeId, bool)],
    /// About where the loop starts in the surface's parameters. On a surface of revolution it picks the turn of
    /// theta, on B-spline surfaces the search starts there; on planes it is not used.
    pub near: DVec2,
}

impl Model {
    /// Adds the face that covers the whole of `surface`, whose borders are parameter lines.
    ///
    /// `borders` are the edges on the borders at `v = start`, `u = end`, `v = end` and `u = start`, each a chain in
    /// the order of the counterclockwise loop: along +u, +v, -u, -v. Edges may have either direction. Between its
    /// ends each edge must run at the same pace as the parameter line it lies on, up to an affine map of the
    /// parameter. A border without edges is one that has shrunk to a point.
    ///
    /// # Errors
    /// [`BuildError::Unbounded`] for planes and revolutions, [`BuildError::BorderGap`] if ends of edges are farther
    /// than [`BORDER_TOLERANCE_MM`] from the border or from each other.
    pub fn patch_face(
        &mut self,
        name: impl Into<String>,
        surface: impl Into<SurfaceGeometry>,
        borders: [&[EdgeId]; 4],
        style: Style,
    ) -> Result<FaceId, BuildError> {
        let surface = surface.into();
        let ((u0, u1), (v0, v1)) = surface.domain();
        if ![u0, u1, v0, v1].iter().all(|x| x.is_finite()) {
            return Err(BuildError::Unbounded);
        }
        let corners = [DVec2::new(u0, v0), DVec2::new(u1, v0), DVec2::new(u1, v1), DVec2::new(u0, v1)];
        let mut coedges = Vec::new();
        for (border, edges) in borders.into_iter().enumerate() {
            let line = [corners[border], corners[(border + 1) % 4]];
            self.trace_border(&surface, border, edges, line, &mut coedges)?;
        }
        let loops = vec![Loop { coedges }];
        Ok(self.add_face(Face { name: name.into(), surface, loops, style }))
    }

    /// Lays the chain `edges` along the parameter line from `line[0]` to `line[1]`.
    fn trace_border(
        &self,
        surface: &SurfaceGeometry,
        border: usize,
        edges: &[EdgeId],
        line: [DVec2; 2],
        coedges: &mut Vec<Coedge>,
    ) -> Result<(), BuildError> {
        let mut here = line[0];
        for (i, &id) in edges.iter().enumerate() {
            let edge = self.edges.get(id.0).ok_or(BuildError::NoEdge { edge: id })?;
            let at = surface.point(here.x, here.y);
            let ends = [edge.curve.domain().0, edge.curve.domain().1].map(|t| edge.curve.point(t));
            let forward = ends[0].distance(at) <= ends[1].distance(at);
            let (near, far) = if forward { (ends[0], ends[1]) } else { (ends[1], ends[0]) };
            let next = if i + 1 == edges.len() { line[1] } else { foot_on_line(surface, here, line[1], far) };
            let gap = near.distance(at).max(far.distance(surface.point(next.x, next.y)));
            if !(gap <= BORDER_TOLERANCE_MM) {
                return Err(BuildError::BorderGap { border, edge: id, gap_mm: gap });
            }
            let (from, to) = if forward { (here, next) } else { (next, here) };
            coedges.push(Coedge {
                edge: id,
                forward,
                pcurve: straight_pcurve(from, to, edge.curve.domain())?,
            });
            here = next;
        }
        Ok(())
    }

    /// Adds the part of `surface` inside `loops`, the outer one first. Parameter curves come from
    /// [`interpolated_pcurve`]; loops are turned round where they run the wrong way, so that any of the two ways
    /// will do.
    ///
    /// # Errors
    /// As [`interpolated_pcurve`], with `tolerance_mm` the bound on the distance between each edge and its image;
    /// [`BuildError::OpenLoop`] if the edges do not make a closed chain or do not close in the parameter plane (a
    /// loop round the axis of a revolution must be cut by seams).
    pub fn trimmed_face(
        &mut self,
        name: impl Into<String>,
        surface: impl Into<SurfaceGeometry>,
        loops: &[LoopEdges<'_>],
        tolerance_mm: f64,
        style: Style,
    ) -> Result<FaceId, BuildError> {
        let (name, surface) = (name.into(), surface.into());
        let mut traced = Vec::with_capacity(loops.len());
        for (index, lp) in loops.iter().enumerate() {
            let lp = self.trace_loop(&surface, lp, index, tolerance_mm)?;
            let outwards = signed_area(&lp) > 0.0;
            traced.push(if outwards == (index == 0) { lp } else { lp.reversed() });
        }
        Ok(self.add_face(Face { name, surface, loops: traced, style }))
    }

    fn trace_loop(
        &self,
        surface: &SurfaceGeometry,
        lp: &LoopEdges<'_>,
        index: usize,
        tolerance: f64,
    ) -> Result<Loop, BuildError> {
        let mut coedges: Vec<Coedge> = Vec::with_capacity(lp.edges.len());
        let mut near = lp.near;
        for &(id, forward) in lp.edges {
            let edge = self.edges.get(id.0).ok_or(BuildError::NoEdge { edge: id })?;
            let start = if forward { edge.start } else { edge.end };
            if coedges.last().is_some_and(|c| self.end_of(c) != start) {
                return Err(BuildError::OpenLoop { index, gap: f64::INFINITY });
            }
            // The search runs along the edge, so it must know where the edge starts in the loop's turn of theta:
            // trace against the loop's end where the loop runs against the edge.
            let pcurve = if forward {
                interpolated_pcurve(&edge.curve, surface, near, tolerance)?
            } else {
                pcurve::interpolated_backwards(&edge.curve, surface, near, tolerance)?
            };
            let coedge = Coedge { edge: id, forward, pcurve: pcurve.curve };
            near = coedge.parameter_at(1.0);
            coedges.push(coedge);
        }
        let (Some(first), Some(last)) = (coedges.first(), coedges.last()) else {
            return Err(BuildError::OpenLoop { index, gap: f64::INFINITY });
        };
        let (start, end) = (first.parameter_at(0.0), last.parameter_at(1.0));
        let gap = surface.point(start.x, start.y).distance(surface.point(end.x, end.y));
        let turn = matches!(surface, SurfaceGeometry::Revolution(_)) && (start.x - end.x).abs() > 1.0;
        if self.start_of(first) != self.end_of(last) || turn || !(gap <= tolerance * 4.0) {
            return Err(BuildError::OpenLoop { index, gap: start.distance(end) });
        }
        Ok(Loop { coedges })
    }
}

/// The parameter between `from` and `to` (on a parameter line) at which the surface comes nearest to `point`.
fn foot_on_line(surface: &SurfaceGeometry, from: DVec2, to: DVec2, point: DVec3) -> DVec2 {
    let at = |s: f64| from.lerp(to, s);
    let distance = |s: f64| {
        let p = at(s);
        surface.point(p.x, p.y).distance_squared(point)
    };
    const STEPS: usize = 200;
    let nearest =
        (1..=STEPS).map(|i| i as f64 / STEPS as f64).min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
    let mut s = nearest.unwrap_or(1.0);
    for _ in 0..30 {
        let p = at(s);
        let d = surface.derivatives(p.x, p.y);
        let way = to - from;
        let first = d.u * way.x + d.v * way.y;
        let second = d.uu * (way.x * way.x) + d.uv * (2.0 * way.x * way.y) + d.vv * (way.y * way.y);
        let off = d.point - point;
        let step = off.dot(first) / (first.length_squared() + off.dot(second)).abs();
        if !step.is_finite() || step.abs() < 1e-16 {
            break;
        }
        s = (s - step).clamp(0.0, 1.0);
    }
    at(s)
}

impl Loop {
    /// The same edges run through the other way.
    pub fn reversed(mut self) -> Self {
        self.coedges.reverse();
        for coedge in &mut self.coedges {
            coedge.forward = !coedge.forward;
        }
        self
    }
}

impl Shell {
    /// The same faces seen from the other side: the coolant's passage from the metal's.
    pub fn reversed(&self) -> Self {
        let turn = |f: &FaceUse| FaceUse { face: f.face, forward: !f.forward };
        Self { faces: self.faces.iter().map(turn).collect() }
    }
}
