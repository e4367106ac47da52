//! Parameter curves of edges, in the parameters of STEP's surfaces.
//!
//! Given none, OpenCASCADE projects points of every edge on its surfaces and fits a curve to what it finds. That is slow,
//! and now and then wrong: on a rotor's tip the fit left the edge by 2.5e-5 mm, which FreeCAD's check calls invalid. The
//! model has the curves to 1e-8.

use super::convert::{self, StepSolid};
use super::geometry::{CurveEntity, Form, Placement, SurfaceEntity};
use coolinggen_brep::{Coedge, Face, Model, Revolution, Solid, SurfaceGeometry};
use coolinggen_nurbs::{Curve, ParametricCurve};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A parameter curve of an edge.
pub(crate) struct Pcurve {
    /// Its face, counted over all solids.
    pub(crate) face: usize,
    /// The curve, over the parameters that readers give to the edge's curve in space.
    pub(crate) curve: Curve<DVec2>,
}

/// Parameter curves of all edges, in the order in which truck writes the edges.
pub(crate) fn of_all(model: &Model, solids: &[&Solid], converted: &[StepSolid<'_>]) -> Vec<Vec<Pcurve>> {
    let mut edges: Vec<Vec<Pcurve>> = Vec::new();
    let mut number = 0;
    let shells = solids.iter().zip(converted).flat_map(|(s, c)| s.shells.iter().zip(&c.boundaries));
    for (shell, out) in shells {
        let first = edges.len();
        edges.resize_with(first + out.edges.len(), Vec::new);
        for (used, written) in shell.faces.iter().zip(&out.faces) {
            let face = model.face(used.face);
            for (bound, indices) in face.loops.iter().zip(&written.boundaries) {
                for (coedge, index) in bound.coedges.iter().zip(indices) {
                    if let Some(curve) = pcurve(model, face, coedge, &written.surface) {
                        edges[first + index.index].push(Pcurve { face: number, curve });
                    }
                }
            }
            number += 1;
        }
    }
    // An edge that a face meets twice would have to be a seam curve; readers do without.
    for list in &mut edges {
        if list.windows(2).any(|pair| pair[0].face == pair[1].face) {
            list.clear();
        }
    }
    edges
}

/// The parameter curve on STEP's form of the surface; none where it is no B-spline there.
fn pcurve(model: &Model, face: &Face, coedge: &Coedge, entity: &SurfaceEntity<'_>) -> Option<Curve<DVec2>> {
    let own = &coedge.pcurve;
    let space = convert::curve(&model.edge(coedge.edge).curve);
    let curve = match (&entity.form, &face.surface) {
        (Form::Plane(placement), _) => in_plane(&space, placement, own)?,
        (Form::BSpline(_), _) if entity.same_normal => own.clone(),
        (Form::BSpline(_), _) => own.map(|p| DVec2::new(p.y, p.x)),
        (Form::Rational(_), _) => own.clone(),
        (Form::Revolved { .. }, _) => {
            let seam = convert::seam(face);
            in_first_turn(&own.map(|p| DVec2::new(p.x - seam, p.y)))
        }
        (Form::Cylinder { placement, .. } | Form::Cone { placement, .. }, SurfaceGeometry::Revolution(r)) => {
            about_axis(r, placement, convert::seam(face), own)?
        }
        _ => return None,
    };
    Some(match space {
        // Readers measure lines by length.
        CurveEntity::Line(a, b) => curve.reparameterized(0.0, a.distance(b)),
        _ => curve,
    })
}

/// Curves in a plane are their own parameter curves.
fn in_plane(space: &CurveEntity<'_>, placement: &Placement, own: &Curve<DVec2>) -> Option<Curve<DVec2>> {
    let across = placement.axis.cross(placement.reference);
    let flat = |p: &DVec3| {
        let d = *p - placement.origin;
        DVec2::new(d.dot(placement.reference), d.dot(across))
    };
    match space {
        CurveEntity::BSpline(c) => Some(c.map(flat)),
        CurveEntity::Line(a, b) => {
            let (start, end) = own.domain();
            Some(Curve::segment(flat(a), flat(b)).reparameterized(start, end))
        }
        CurveEntity::Rational(_) => None,
    }
}

/// On cylinders and cones: the angle about the placement's axis, and the distance along it.
fn about_axis(r: &Revolution, placement: &Placement, seam: f64, own: &Curve<DVec2>) -> Option<Curve<DVec2>> {
    let [a, b] = r.meridian().points() else { return None };
    let (start, end) = r.meridian().domain();
    let axis = placement.axis.x;
    let x = |t: f64| a.x + (b.x - a.x) * (t - start) / (end - start);
    // Theta turns about -x.
    let map = |p: &DVec2| DVec2::new(axis * (seam - p.x), axis * (x(p.y) - placement.origin.x));
    Some(in_first_turn(&own.map(map)))
}

/// The curve moved by whole turns so that its angles lie within one turn from zero: the seam is opposite to the face.
fn in_first_turn(curve: &Curve<DVec2>) -> Curve<DVec2> {
    let middle = curve.points()[curve.points().len() / 2].x;
    let turns = (middle / TAU).floor() * TAU;
    curve.map(|p| DVec2::new(p.x - turns, p.y))
}
