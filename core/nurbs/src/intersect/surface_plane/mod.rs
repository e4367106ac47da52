//! Where a surface and a plane meet.
//!
//! Marching after Barnhill and Kersey (1990), thesis 2.3.6: steps along the line in which the plane meets the tangent
//! plane, each corrected back. Start points come from subdivision of the signed distance in Bernstein form, so that no
//! branch is missed; branches are followed to both ends, or until they close.

mod join;
mod march;
mod start;

use crate::curve::Curve;
use crate::edit::BezierSurface;
use crate::error::NurbsError;
use crate::fit::{Interpolator, interpolate_closed};
use crate::knots::Knots;
use crate::surface::{ParametricSurface, RationalSurface, Surface};
use crate::vector::Homogeneous;
use glam::{DVec2, DVec3};
use march::Marcher;

/// How far points of a section may be from the plane.
const CERTIFIED: f64 = 1e-9;

/// A branch of the section of a surface by a plane.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneBranch {
    /// Whether the last point repeats the first.
    pub closed: bool,
    /// Surface parameters of the points.
    pub parameters: Vec<DVec2>,
    /// Points, on the surface by their parameters, within 1e-9 of the plane.
    pub points: Vec<DVec3>,
}

impl PlaneBranch {
    /// The cubic B-spline through the points, parametrised by chord length on [0, length of the chords]; closed branches
    /// smoothly closed. Its control points lie in the plane as the points do.
    ///
    /// # Errors
    /// [`NurbsError::PointCount`] for fewer than four points.
    pub fn interpolated(&self) -> Result<Curve<DVec3>, NurbsError> {
        let mut t = vec![0.0];
        for w in self.points.windows(2) {
            t.push(t[t.len() - 1] + w[0].distance(w[1]));
        }
        if self.closed {
            interpolate_closed(&t, &self.points)
        } else {
            Interpolator::new(3, &t)?.curve(&self.points)
        }
    }
}

/// The section of a surface by a plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlaneSection {
    /// Curves.
    pub branches: Vec<PlaneBranch>,
    /// Parameters of points where the plane touches the surface from one side.
    pub contacts: Vec<DVec2>,
}

/// The section of `surface` by the plane through `origin` across `normal` (of any length).
///
/// Steps are chosen so that the branch departs from its chords by about `sagitta` at most, and are no longer than
/// `longest`. Every point is on the surface at its parameters and within 1e-9 of the plane. No branch is missed but
/// loops smaller than about 1e-6 of a Bezier patch. Branches end at borders, at the seam of a surface closed in u as well
/// (points there are given for either side of the seam); one that starts and ends at the same point of the seam counts as
/// closed. Kinks are crossed. Where the plane touches the surface in a saddle two branches cross.
///
/// # Errors
/// [`NurbsError::BadArgument`] for a normal of length zero or lengths that are not positive; [`NurbsError::Coincident`]
/// where a patch lies in the plane; [`NurbsError::NoConvergence`] where the march stalls or a point cannot be certified.
pub fn intersect_plane<S: BezierSurface<Space = DVec3>>(
    surface: &S,
    origin: DVec3,
    normal: DVec3,
    sagitta: f64,
    longest: f64,
) -> Result<PlaneSection, NurbsError> {
    let length = normal.length();
    if !(length > 0.0 && length.is_finite() && origin.is_finite()) {
        return Err(NurbsError::BadArgument { what: "normal of a plane", value: length });
    }
    for value in [sagitta, longest] {
        if !(value > 0.0) {
            return Err(NurbsError::BadArgument { what: "step of a march", value });
        }
    }
    let form = surface.homogeneous_form();
    let (kinks_u, kinks_v) = kinks(surface, &form);
    let way = Way { origin, normal: normal / length, sagitta, longest };
    if kinks_u.len() == 2 && kinks_v.len() == 2 {
        return section(surface, &way);
    }
    // A march does not turn corners: one smooth block after the other.
    let mut parts = vec![];
    for u in kinks_u.windows(2) {
        for v in kinks_v.windows(2) {
            let block = form.restricted_u(u[0], u[1])?.restricted_v(v[0], v[1])?;
            let end = (u[1] == kinks_u[kinks_u.len() - 1], v[1] == kinks_v[kinks_v.len() - 1]);
            let found = section(&RationalSurface::from_homogeneous(block)?, &way)?;
            parts.push(join::without_border(found, DVec2::new(u[1], v[1]), end));
        }
    }
    Ok(join::joined(parts))
}

/// Parameters in u and v across which the surface has an edge, the ends of the domain included.
fn kinks<S: BezierSurface<Space = DVec3>>(
    surface: &S,
    form: &Surface<Homogeneous<DVec3>>,
) -> (Vec<f64>, Vec<f64>) {
    let size = form.points().iter().fold(0.0, |m: f64, p| m.max(p.project().abs().max_element()));
    // Knots of full multiplicity do not make an edge yet: circles have them. Compare tangents on both sides.
    let edge = |before: DVec3, after: DVec3| {
        let pole = before.length().max(after.length()) <= 1e-12 * size;
        !pole && !(before.normalize().distance(after.normalize()) < 1e-9)
    };
    let samples = |(a, b): (f64, f64)| (0..=32).map(move |k| a + (b - a) * f64::from(k) / 32.0);
    let (du, dv) = surface.domain();
    let along = |knots: &Knots, edge_at: &dyn Fn(f64) -> bool| -> Vec<f64> {
        let (start, end) = knots.domain();
        let kink =
            |&b: &f64| b == start || b == end || (knots.multiplicity(b) >= knots.degree() && edge_at(b));
        knots.breaks().into_iter().filter(kink).collect()
    };
    let u = along(form.knots_u(), &|u| {
        let tangent = |u: f64, v: f64| surface.first_derivatives(u, v).1;
        samples(dv).any(|v| edge(tangent(u.next_down(), v), tangent(u, v)))
    });
    let v = along(form.knots_v(), &|v| {
        let tangent = |u: f64, v: f64| surface.first_derivatives(u, v).2;
        samples(du).any(|u| edge(tangent(u, v.next_down()), tangent(u, v)))
    });
    (u, v)
}

/// The plane and how to march along it.
struct Way {
    origin: DVec3,
    normal: DVec3,
    sagitta: f64,
    longest: f64,
}

/// The section of a surface without kinks.
fn section<S: BezierSurface<Space = DVec3>>(surface: &S, way: &Way) -> Result<PlaneSection, NurbsError> {
    let plane = Plane { surface, origin: way.origin, normal: way.normal };
    let found = start::start_points(&plane)?;
    let marcher = Marcher::new(&plane, way.sagitta, way.longest);
    let mut section = PlaneSection { branches: vec![], contacts: found.contacts };
    for seed in found.seeds {
        let mut known = false;
        for branch in &section.branches {
            known = known || marcher.passes(branch, seed);
        }
        if known {
            continue;
        }
        // Rounding around a point of contact looks like tiny branches, or like none that can be followed.
        let found = marcher.branch(seed);
        let doubtful = found.as_ref().map_or(true, |b| b.as_ref().is_some_and(|b| marcher.is_speck(b)));
        let contact = if doubtful { start::contact(&plane, seed) } else { None };
        match (contact.filter(|c| marcher.near(*c, seed)), found) {
            (Some(contact), _) => start::add_contact(&mut section.contacts, contact),
            (_, found) => section.branches.extend(found?),
        }
    }
    Ok(section)
}

/// A surface and a plane.
struct Plane<'a, S> {
    surface: &'a S,
    origin: DVec3,
    normal: DVec3,
}

impl<S: ParametricSurface<DVec3>> Plane<'_, S> {
    /// Signed distance of a surface point from the plane, with the point and its derivatives.
    fn at(&self, p: DVec2) -> (f64, DVec2, DVec3, DVec3, DVec3) {
        let (x, u, v) = self.surface.first_derivatives(p.x, p.y);
        let gradient = DVec2::new(self.normal.dot(u), self.normal.dot(v));
        (self.normal.dot(x - self.origin), gradient, x, u, v)
    }
}
