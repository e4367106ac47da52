//! The surface of a face as a B-spline surface, and its loops as they run on it.

use super::circle::circle;
use crate::ExportError;
use crate::forms::{jumps, rather_transposed};
use coolinggen_brep::{Coedge, EdgeId, Face, Loop, Model, Plane, Revolution, SurfaceGeometry, VertexId};
use coolinggen_nurbs::{Curve, Homogeneous, Knots, NurbsError, ParametricCurve, Surface};
use glam::{DVec2, DVec3};
use std::borrow::Cow;

/// Control points and knots of a surface.
pub(super) enum Net<'a> {
    /// Without weights.
    Plain(Cow<'a, Surface<DVec3>>),
    /// With weights.
    Rational(Cow<'a, Surface<Homogeneous<DVec3>>>),
}

/// The surface of a face as a B-spline with the model's own parameters, or with these exchanged.
pub(super) struct Patch<'a> {
    pub(super) net: Net<'a>,
    /// Whether u and v are exchanged, so that the natural normal points to the other side.
    pub(super) swapped: bool,
}

/// A piece of a loop on a patch.
pub(super) struct Side {
    /// Its curve in the patch's parameters, as the loop runs.
    pub(super) curve: Curve<DVec2>,
    pub(super) on: Place,
}

/// Where a piece of a loop is in space.
pub(super) enum Place {
    /// On an edge, along it or against it.
    Edge {
        /// The edge.
        id: EdgeId,
        /// Whether the loop runs along it.
        along: bool,
    },
    /// In a vertex that a whole line of parameters comes to.
    Pole(VertexId),
}

impl<'a> Patch<'a> {
    /// Planes become bilinear over the box of the face's parameter curves, surfaces of revolution polynomial ([`circle`])
    /// over the angles of the face.
    pub(super) fn new(face: &'a Face) -> Result<Self, ExportError> {
        let bad = |_: NurbsError| ExportError::BadTopology {
            at: face.name.clone(),
            what: "a face that has no extent in its parameters",
        };
        let net = match &face.surface {
            SurfaceGeometry::BSpline(s) => Net::Plain(Cow::Borrowed(s)),
            SurfaceGeometry::Rational(s) => Net::Rational(Cow::Borrowed(s.homogeneous())),
            SurfaceGeometry::Plane(p) => Net::Plain(Cow::Owned(bilinear(p, face).map_err(bad)?)),
            SurfaceGeometry::Revolution(r) => Net::Plain(Cow::Owned(revolved(r, face).map_err(bad)?)),
        };
        let (net, swapped) = match net {
            Net::Plain(s) if rather_transposed(s.counts()) => (Net::Plain(Cow::Owned(s.transposed())), true),
            Net::Rational(s) if rather_transposed(s.counts()) => {
                (Net::Rational(Cow::Owned(s.transposed())), true)
            }
            net => (net, false),
        };
        Ok(Self { net, swapped })
    }

    /// The loops of the face, the outer one first: with the face to their left, seen against the patch's natural normal.
    pub(super) fn loops(&self, model: &Model, face: &Face) -> Vec<Vec<Side>> {
        face.loops.iter().map(|bound| self.sides(model, bound)).collect()
    }

    fn sides(&self, model: &Model, bound: &Loop) -> Vec<Side> {
        let mut run: Vec<(&Coedge, bool)> = bound.coedges.iter().map(|c| (c, c.forward)).collect();
        if self.swapped {
            run.reverse();
            run.iter_mut().for_each(|(_, along)| *along = !*along);
        }
        let mut sides: Vec<Side> = Vec::with_capacity(run.len());
        for &(coedge, along) in &run {
            let own = if self.swapped {
                coedge.pcurve.map(|p| DVec2::new(p.y, p.x))
            } else {
                coedge.pcurve.clone()
            };
            let curve = if along { own } else { own.reversed() };
            sides.push(Side { curve, on: Place::Edge { id: coedge.edge, along } });
        }
        let ways: Vec<[DVec2; 2]> = sides.iter().map(|side| ends(&side.curve)).collect();
        for (i, [from, to]) in jumps(&ways) {
            let (coedge, along) = run[i];
            let edge = model.edge(coedge.edge);
            let vertex = if along { edge.end } else { edge.start };
            sides.insert(i + 1, Side { curve: Curve::segment(from, to), on: Place::Pole(vertex) });
        }
        sides
    }
}

fn ends(curve: &Curve<DVec2>) -> [DVec2; 2] {
    let (start, end) = curve.domain();
    [curve.point(start), curve.point(end)]
}

/// Least and greatest parameters of a face: control points bound its parameter curves.
fn parameter_box(face: &Face) -> (DVec2, DVec2) {
    let points = face.loops.iter().flat_map(|l| &l.coedges).flat_map(|c| c.pcurve.points());
    points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)))
}

fn bilinear(plane: &Plane, face: &Face) -> Result<Surface<DVec3>, NurbsError> {
    let (low, high) = parameter_box(face);
    let knots = |low: f64, high: f64| Knots::new(1, vec![low, low, high, high]);
    let at = |u: f64, v: f64| plane.origin + plane.x * u + plane.y * v;
    let points = vec![at(low.x, low.y), at(low.x, high.y), at(high.x, low.y), at(high.x, high.y)];
    Surface::new(knots(low.x, high.x)?, knots(low.y, high.y)?, points)
}

/// The product of circle and meridian: exact in the meridian, as close as the circle in the angle.
fn revolved(revolution: &Revolution, face: &Face) -> Result<Surface<DVec3>, NurbsError> {
    let (low, high) = parameter_box(face);
    let (circle, meridian) = (circle(low.x, high.x)?, revolution.meridian());
    let turned = |turn: &DVec2| {
        let DVec2 { x: sin, y: cos } = *turn;
        meridian.points().iter().map(move |p| DVec3::new(p.x, p.y * sin, p.y * cos))
    };
    let points = circle.points().iter().flat_map(turned).collect();
    Surface::new(circle.knots().clone(), meridian.knots().clone(), points)
}
