//! The curve of an edge in a form that CAD readers have natively.

use coolinggen_brep::EdgeCurve;
use coolinggen_nurbs::{Curve, ParametricCurve, RationalCurve};
use glam::DVec3;

/// The curve of an edge.
#[derive(Clone, Copy)]
pub(crate) enum CurveForm<'a> {
    /// A straight segment.
    Line(DVec3, DVec3),
    /// A B-spline.
    BSpline(&'a Curve<DVec3>),
    /// A rational B-spline.
    Rational(&'a RationalCurve<DVec3>),
}

impl CurveForm<'_> {
    /// Parameters that readers give to its ends: lines are measured by length.
    pub(crate) fn domain(&self) -> (f64, f64) {
        match self {
            Self::Line(a, b) => (0.0, a.distance(*b)),
            Self::BSpline(c) => c.domain(),
            Self::Rational(c) => c.domain(),
        }
    }
}

/// The form of an edge's curve.
pub(crate) fn curve(curve: &EdgeCurve) -> CurveForm<'_> {
    match curve {
        EdgeCurve::BSpline(c) if c.degree() == 1 && c.points().len() == 2 => {
            CurveForm::Line(c.points()[0], c.points()[1])
        }
        EdgeCurve::BSpline(c) => CurveForm::BSpline(c),
        EdgeCurve::Rational(c) => CurveForm::Rational(c),
    }
}
