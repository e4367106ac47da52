//! Parameter curves of edges, in the parameters of native surfaces.

use super::curve::{CurveForm, curve};
use super::surface::{Form, Placement, SurfaceForm, seam};
use coolinggen_brep::{Coedge, Face, Model, Revolution, SurfaceGeometry};
use coolinggen_nurbs::{Curve, ParametricCurve};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// The parameter curve of an edge on the form of the surface, over [`CurveForm::domain`]; none where it is no B-spline
/// there, which only happens in planes.
pub(crate) fn pcurve(
    model: &Model,
    face: &Face,
    coedge: &Coedge,
    entity: &SurfaceForm<'_>,
) -> Option<Curve<DVec2>> {
    let own = &coedge.pcurve;
    let space = curve(&model.edge(coedge.edge).curve);
    let placed = match (&entity.form, &face.surface) {
        (Form::Plane(placement), _) => in_plane(&space, placement, own)?,
        (Form::BSpline(_), _) if entity.same_normal => own.clone(),
        (Form::BSpline(_), _) => own.map(|p| DVec2::new(p.y, p.x)),
        (Form::Rational(_), _) => own.clone(),
        (Form::Revolved { .. }, _) => {
            let seam = seam(face);
            in_first_turn(&own.map(|p| DVec2::new(p.x - seam, p.y)))
        }
        (Form::Cylinder { placement, .. } | Form::Cone { placement, .. }, SurfaceGeometry::Revolution(r)) => {
            about_axis(r, placement, seam(face), own)?
        }
        _ => return None,
    };
    Some(match space {
        // Readers measure lines by length.
        CurveForm::Line(a, b) => placed.reparameterized(0.0, a.distance(b)),
        _ => placed,
    })
}

/// Curves in a plane are their own parameter curves.
fn in_plane(space: &CurveForm<'_>, placement: &Placement, own: &Curve<DVec2>) -> Option<Curve<DVec2>> {
    let across = placement.axis.cross(placement.reference);
    let flat = |p: &DVec3| {
        let d = *p - placement.origin;
        DVec2::new(d.dot(placement.reference), d.dot(across))
    };
    match space {
        CurveForm::BSpline(c) => Some(c.map(flat)),
        CurveForm::Line(a, b) => {
            let (start, end) = own.domain();
            Some(Curve::segment(flat(a), flat(b)).reparameterized(start, end))
        }
        CurveForm::Rational(_) => None,
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
