//! Curves evaluated at successive parameters.

use crate::geometry::EdgeCurve;
use crate::lanes::Lanes;
use crate::span::Span;
use coolinggen_nurbs::{Curve, ParametricCurve, RationalCurve, VectorSpace};
use glam::DVec3;

/// Evaluates a curve at parameters that mostly stay in one span.
#[derive(Clone, Debug)]
pub(crate) struct Cursor<'a, V> {
    curve: &'a Curve<V>,
    /// The span of the last evaluation.
    pub(crate) span: Span,
}

impl<'a, V: VectorSpace> Cursor<'a, V> {
    /// A cursor at the start of `curve`.
    pub(crate) fn new(curve: &'a Curve<V>) -> Self {
        let knots = curve.knots();
        Self { curve, span: Span::new(knots, knots.span(knots.domain().0)) }
    }

    /// Moves to the span `index`.
    pub(crate) fn enter(&mut self, index: usize) {
        if index != self.span.index {
            self.span.set(self.curve.knots(), index);
        }
    }

    /// The curve.
    pub(crate) fn curve(&self) -> &'a Curve<V> {
        self.curve
    }

    /// Degree of the curve.
    pub(crate) fn degree(&self) -> usize {
        self.curve.degree()
    }

    /// Moves to the span of `t`.
    #[inline]
    pub(crate) fn seek(&mut self, t: f64) {
        self.span.seek(self.curve.knots(), t);
    }

    /// The point at `t`.
    #[inline]
    pub(crate) fn point(&mut self, t: f64) -> V {
        self.seek(t);
        self.point_in_span(t)
    }

    /// The points at four neighbouring parameters, coordinate by coordinate.
    #[inline(always)]
    pub(crate) fn four<const D: usize>(&mut self, t: Lanes) -> [Lanes; D] {
        let points = self.curve.points();
        self.seek(t.0[1]);
        if self.span.holds(t) {
            let (out, []) = self.span.four(t, points, points);
            return out;
        }
        let mut out = [Lanes::from(0.0); D];
        for lane in 0..4 {
            let point = self.point(t.0[lane]);
            (0..D).for_each(|i| out[i].0[lane] = point.component(i));
        }
        out
    }

    /// Point and derivative at `t`.
    pub(crate) fn at(&mut self, t: f64) -> (V, V) {
        self.seek(t);
        self.slope_in_span(t)
    }

    /// The point at `t` on the polynomial of the present span.
    #[inline]
    pub(crate) fn point_in_span(&self, t: f64) -> V {
        self.span.point(t, self.curve.points())
    }

    /// Point and derivative at `t` on the polynomial of the present span.
    #[inline]
    pub(crate) fn slope_in_span(&self, t: f64) -> (V, V) {
        self.span.slope(t, self.curve.points())
    }
}

/// Evaluates an edge's curve at parameters that mostly stay in one span.
#[derive(Clone, Debug)]
pub(crate) enum EdgeCursor<'a> {
    BSpline(Box<Cursor<'a, DVec3>>),
    Rational(&'a RationalCurve<DVec3>),
}

impl<'a> EdgeCursor<'a> {
    /// A cursor at the start of `curve`.
    pub(crate) fn new(curve: &'a EdgeCurve) -> Self {
        match curve {
            EdgeCurve::BSpline(curve) => Self::BSpline(Box::new(Cursor::new(curve))),
            EdgeCurve::Rational(curve) => Self::Rational(curve),
        }
    }

    /// The point at `t`.
    #[inline]
    pub(crate) fn point(&mut self, t: f64) -> DVec3 {
        match self {
            Self::BSpline(cursor) => cursor.point(t),
            Self::Rational(curve) => curve.point(t),
        }
    }
}
