//! Points, curves and surfaces as truck's STEP writer takes them.
//!
//! truck's own geometry is not used: its knot vectors merge knots closer than 1e-6, its numbers near zero are cut
//! to 11 digits, and its surfaces of revolution carry the wrong sense (DESIGN.md section 6).

use super::text::{List, Ref, Text};
use crate::forms::{CurveForm, Form, Placement, SurfaceForm, distinct};
use crate::number::Real;
use coolinggen_nurbs::{Curve, Homogeneous, Knots};
use glam::{DVec2, DVec3};
use std::fmt::{Formatter, Result};
use truck_stepio::out::{DisplayByStep, StepCurve, StepLength, StepSurface};

/// A point.
#[derive(Clone, Copy)]
pub(crate) struct Point(pub(crate) DVec3);

impl DisplayByStep for Point {
    fn fmt(&self, id: usize, f: &mut Formatter<'_>) -> Result {
        writeln!(f, "#{id} = CARTESIAN_POINT('',{});", List(self.0.to_array().into_iter().map(Real)))
    }
}

impl StepLength for Point {
    fn step_length(&self) -> usize {
        1
    }
}

fn direction(id: usize, d: DVec3, f: &mut Formatter<'_>) -> Result {
    writeln!(f, "#{id} = DIRECTION('',{});", List(d.to_array().into_iter().map(Real)))
}

impl StepCurve for CurveForm<'_> {}

impl StepLength for CurveForm<'_> {
    fn step_length(&self) -> usize {
        match self {
            Self::Line(..) => 4,
            Self::BSpline(c) => 1 + c.points().len(),
            Self::Rational(c) => 1 + c.homogeneous().points().len(),
        }
    }
}

impl DisplayByStep for CurveForm<'_> {
    fn fmt(&self, id: usize, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::Line(a, b) => {
                writeln!(f, "#{id} = LINE('',#{},#{});", id + 1, id + 2)?;
                Point(*a).fmt(id + 1, f)?;
                writeln!(f, "#{} = VECTOR('',#{},{});", id + 2, id + 3, Real((*b - *a).length()))?;
                direction(id + 3, (*b - *a).normalize_or_zero(), f)
            }
            Self::BSpline(c) => bspline_curve(id, c, f),
            Self::Rational(c) => {
                let points = c.homogeneous().points();
                let ids = (id + 1..=id + points.len()).map(Ref);
                let (knots, counts) = distinct(c.homogeneous().knots());
                writeln!(
                    f,
                    "#{id} = (BOUNDED_CURVE() B_SPLINE_CURVE({},{},.UNSPECIFIED.,.U.,.U.) \
                     B_SPLINE_CURVE_WITH_KNOTS({},{},.UNSPECIFIED.) CURVE() GEOMETRIC_REPRESENTATION_ITEM() \
                     RATIONAL_B_SPLINE_CURVE({}) REPRESENTATION_ITEM(''));",
                    c.homogeneous().degree(),
                    List(ids),
                    List(&counts),
                    List(knots.iter().map(|&k| Real(k))),
                    List(points.iter().map(|p| Real(p.weight)))
                )?;
                write_points(id + 1, points.iter().map(Homogeneous::project), f)
            }
        }
    }
}

fn bspline_curve(id: usize, c: &Curve<DVec3>, f: &mut Formatter<'_>) -> Result {
    spline(id, c.knots(), f)?;
    write_points(id + 1, c.points().iter().copied(), f)
}

/// A B-spline of any dimension, its control points the entities after it.
fn spline(id: usize, knots: &Knots, f: &mut Formatter<'_>) -> Result {
    let ids = (id + 1..=id + knots.control_count()).map(Ref);
    let (values, counts) = distinct(knots);
    writeln!(
        f,
        "#{id} = B_SPLINE_CURVE_WITH_KNOTS('',{},{},.UNSPECIFIED.,.U.,.U.,{},{},.UNSPECIFIED.);",
        knots.degree(),
        List(ids),
        List(&counts),
        List(values.iter().map(|&k| Real(k)))
    )
}

fn write_points(first: usize, points: impl Iterator<Item = DVec3>, f: &mut Formatter<'_>) -> Result {
    points.enumerate().try_for_each(|(i, p)| Point(p).fmt(first + i, f))
}

/// A curve in the parameters of the surface with entity `surface`.
pub(crate) struct PcurveEntity<'a> {
    pub(crate) surface: usize,
    pub(crate) curve: &'a Curve<DVec2>,
    /// Entity of the two-dimensional context.
    pub(crate) context: usize,
}

impl StepLength for PcurveEntity<'_> {
    fn step_length(&self) -> usize {
        3 + self.curve.points().len()
    }
}

impl DisplayByStep for PcurveEntity<'_> {
    fn fmt(&self, id: usize, f: &mut Formatter<'_>) -> Result {
        writeln!(f, "#{id} = PCURVE('',#{},#{});", self.surface, id + 1)?;
        writeln!(f, "#{} = DEFINITIONAL_REPRESENTATION('',(#{}),#{});", id + 1, id + 2, self.context)?;
        spline(id + 2, self.curve.knots(), f)?;
        for (i, p) in self.curve.points().iter().enumerate() {
            writeln!(f, "#{} = CARTESIAN_POINT('',({},{}));", id + 3 + i, Real(p.x), Real(p.y))?;
        }
        Ok(())
    }
}

/// Entities a placement takes.
pub(crate) const PLACEMENT_LENGTH: usize = 4;

impl DisplayByStep for Placement {
    fn fmt(&self, id: usize, f: &mut Formatter<'_>) -> Result {
        writeln!(f, "#{id} = AXIS2_PLACEMENT_3D('',#{},#{},#{});", id + 1, id + 2, id + 3)?;
        Point(self.origin).fmt(id + 1, f)?;
        direction(id + 2, self.axis, f)?;
        direction(id + 3, self.reference, f)
    }
}

impl StepSurface for SurfaceForm<'_> {
    fn same_sense(&self) -> bool {
        self.same_normal
    }
}

impl StepLength for SurfaceForm<'_> {
    fn step_length(&self) -> usize {
        match &self.form {
            Form::Plane(_) | Form::Cylinder { .. } | Form::Cone { .. } => 1 + PLACEMENT_LENGTH,
            Form::Revolved { meridian, .. } => 5 + meridian.points().len(),
            Form::BSpline(s) => 1 + s.points().len(),
            Form::Rational(s) => 1 + s.homogeneous().points().len(),
        }
    }
}

impl DisplayByStep for SurfaceForm<'_> {
    fn fmt(&self, id: usize, f: &mut Formatter<'_>) -> Result {
        match &self.form {
            Form::Plane(placement) => {
                writeln!(f, "#{id} = PLANE('',#{});", id + 1)?;
                placement.fmt(id + 1, f)
            }
            Form::Cylinder { placement, radius } => {
                writeln!(f, "#{id} = CYLINDRICAL_SURFACE('',#{},{});", id + 1, Real(*radius))?;
                placement.fmt(id + 1, f)
            }
            Form::Cone { placement, radius, angle } => {
                writeln!(f, "#{id} = CONICAL_SURFACE('',#{},{},{});", id + 1, Real(*radius), Real(*angle))?;
                placement.fmt(id + 1, f)
            }
            Form::Revolved { meridian, axis } => {
                let axis_id = id + 2 + meridian.points().len();
                writeln!(f, "#{id} = SURFACE_OF_REVOLUTION('',#{},#{axis_id});", id + 1)?;
                bspline_curve(id + 1, meridian, f)?;
                writeln!(f, "#{axis_id} = AXIS1_PLACEMENT('',#{},#{});", axis_id + 1, axis_id + 2)?;
                Point(DVec3::ZERO).fmt(axis_id + 1, f)?;
                direction(axis_id + 2, *axis, f)
            }
            Form::BSpline(s) => {
                let knots = SurfaceKnots::new(s.knots_u(), s.knots_v(), id + 1);
                writeln!(
                    f,
                    "#{id} = B_SPLINE_SURFACE_WITH_KNOTS({},{},{},.UNSPECIFIED.);",
                    knots.head(Some("")),
                    knots.counts,
                    knots.values
                )?;
                write_points(id + 1, s.points().iter().copied(), f)
            }
            Form::Rational(s) => {
                let h = s.homogeneous();
                let knots = SurfaceKnots::new(h.knots_u(), h.knots_v(), id + 1);
                let rows = h.points().chunks(h.counts().1);
                let weights = rows.map(|row| List(row.iter().map(|p| Real(p.weight))).to_string());
                writeln!(
                    f,
                    "#{id} = (BOUNDED_SURFACE() B_SPLINE_SURFACE({}) \
                     B_SPLINE_SURFACE_WITH_KNOTS({},{},.UNSPECIFIED.) GEOMETRIC_REPRESENTATION_ITEM() \
                     RATIONAL_B_SPLINE_SURFACE({}) REPRESENTATION_ITEM('') SURFACE());",
                    knots.head(None),
                    knots.counts,
                    knots.values,
                    List(weights)
                )?;
                write_points(id + 1, h.points().iter().map(Homogeneous::project), f)
            }
        }
    }
}

/// The parts that plain and rational B-spline surfaces share, printed.
struct SurfaceKnots {
    degrees: String,
    net: String,
    counts: String,
    values: String,
}

impl SurfaceKnots {
    fn new(u: &Knots, v: &Knots, first: usize) -> Self {
        let (nu, nv) = (u.control_count(), v.control_count());
        let rows = (0..nu).map(|i| List((first + i * nv..first + (i + 1) * nv).map(Ref)).to_string());
        let ((ku, mu), (kv, mv)) = (distinct(u), distinct(v));
        let reals = |k: &[f64]| List(k.iter().map(|&k| Real(k))).to_string();
        Self {
            degrees: format!("{},{}", u.degree(), v.degree()),
            net: List(rows).to_string(),
            counts: format!("{},{}", List(&mu), List(&mv)),
            values: format!("{},{}", reals(&ku), reals(&kv)),
        }
    }

    /// Degrees, net and flags, after the name where the entity is a simple one.
    fn head(&self, name: Option<&str>) -> String {
        let name = name.map(|n| format!("{},", Text(n))).unwrap_or_default();
        format!("{name}{},{},.UNSPECIFIED.,.U.,.U.,.U.", self.degrees, self.net)
    }
}
