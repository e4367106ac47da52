//! Records of curves and surfaces.

use crate::forms::{CurveForm, Form, Placement, SurfaceForm, distinct};
use crate::number::Real;
use coolinggen_nurbs::{Curve, Homogeneous, Knots};
use glam::{DVec2, DVec3};
use std::fmt::{Display, Formatter};
use std::io::{self, Write};

// Numbers of the kinds of records.
const LINE: u8 = 1;
const BSPLINE_CURVE: u8 = 7;
const PLANE: u8 = 1;
const CYLINDER: u8 = 2;
const CONE: u8 = 3;
const REVOLUTION: u8 = 7;
const BSPLINE_SURFACE: u8 = 9;

/// A curve in the parameters of a surface.
pub(super) fn curve_2d(curve: &Curve<DVec2>, out: &mut impl Write) -> io::Result<()> {
    curve_head(false, curve.knots(), out)?;
    for p in curve.points() {
        write!(out, "  {} {}", Real(p.x), Real(p.y))?;
    }
    knots(curve.knots(), out)
}

/// A curve in space.
pub(super) fn curve_3d(curve: &CurveForm<'_>, out: &mut impl Write) -> io::Result<()> {
    match curve {
        CurveForm::Line(a, b) => {
            let direction = (*b - *a).normalize_or_zero();
            writeln!(out, "{LINE} {} {}", Spaced(*a), Spaced(direction))
        }
        CurveForm::BSpline(c) => bspline(c, out),
        CurveForm::Rational(c) => {
            let c = c.homogeneous();
            curve_head(true, c.knots(), out)?;
            weighted(c.points(), out)?;
            knots(c.knots(), out)
        }
    }
}

fn bspline(c: &Curve<DVec3>, out: &mut impl Write) -> io::Result<()> {
    curve_head(false, c.knots(), out)?;
    plain(c.points(), out)?;
    knots(c.knots(), out)
}

/// A surface.
pub(super) fn surface(surface: &SurfaceForm<'_>, out: &mut impl Write) -> io::Result<()> {
    match &surface.form {
        Form::Plane(p) => writeln!(out, "{PLANE} {}", Axes(p)),
        Form::Cylinder { placement, radius } => {
            writeln!(out, "{CYLINDER} {} {}", Axes(placement), Real(*radius))
        }
        Form::Cone { placement, radius, angle } => {
            writeln!(out, "{CONE} {} {} {}", Axes(placement), Real(*radius), Real(*angle))
        }
        Form::Revolved { meridian, axis } => {
            writeln!(out, "{REVOLUTION} {} {}", Spaced(DVec3::ZERO), Spaced(*axis))?;
            bspline(meridian, out)
        }
        Form::BSpline(s) => {
            surface_head(false, s.knots_u(), s.knots_v(), out)?;
            plain(s.points(), out)?;
            knots(s.knots_u(), out)?;
            knots(s.knots_v(), out)
        }
        Form::Rational(s) => {
            let s = s.homogeneous();
            surface_head(true, s.knots_u(), s.knots_v(), out)?;
            weighted(s.points(), out)?;
            knots(s.knots_u(), out)?;
            knots(s.knots_v(), out)
        }
    }
}

/// Kind, rational, periodic, degree, and how many control points and distinct knots.
fn curve_head(rational: bool, knots: &Knots, out: &mut impl Write) -> io::Result<()> {
    let (rational, degree, points) = (u8::from(rational), knots.degree(), knots.control_count());
    write!(out, "{BSPLINE_CURVE} {rational} 0 {degree} {points} {}", distinct(knots).0.len())
}

fn surface_head(rational: bool, u: &Knots, v: &Knots, out: &mut impl Write) -> io::Result<()> {
    let rational = u8::from(rational);
    write!(out, "{BSPLINE_SURFACE} {rational} {rational} 0 0 {} {}", u.degree(), v.degree())?;
    write!(out, " {} {}", u.control_count(), v.control_count())?;
    write!(out, " {} {}", distinct(u).0.len(), distinct(v).0.len())
}

fn plain(points: &[DVec3], out: &mut impl Write) -> io::Result<()> {
    points.iter().try_for_each(|p| write!(out, "  {}", Spaced(*p)))
}

fn weighted(points: &[Homogeneous<DVec3>], out: &mut impl Write) -> io::Result<()> {
    points.iter().try_for_each(|p| write!(out, "  {} {}", Spaced(p.project()), Real(p.weight)))
}

fn knots(knots: &Knots, out: &mut impl Write) -> io::Result<()> {
    let (values, counts) = distinct(knots);
    values.iter().zip(counts).try_for_each(|(value, count)| write!(out, "\n{} {count}", Real(*value)))?;
    writeln!(out)
}

/// Three numbers.
pub(super) struct Spaced(pub(super) DVec3);

impl Display for Spaced {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {} {}", Real(self.0.x), Real(self.0.y), Real(self.0.z))
    }
}

/// Origin, axis, x and y directions.
struct Axes<'a>(&'a Placement);

impl Display for Axes<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let Placement { origin, axis, reference } = *self.0;
        let across = axis.cross(reference);
        write!(f, "{} {} {} {}", Spaced(origin), Spaced(axis), Spaced(reference), Spaced(across))
    }
}
