//! Outlines: closed curves made of one smooth piece a region.

use super::builder;
use super::chain::{self, End};
use super::circle::Circle;
use super::noses::Nose;
use super::ring::Ring;
use crate::blade::Region;
use crate::stream::measure::Measure;
use coolinggen_nurbs::{Curve, NurbsError, ParametricCurve};
use glam::DVec2;
use std::rc::Rc;

/// Accuracy of arc lengths, mm: they only say how fast u runs.
const ARC_ACCURACY: f64 = 1e-6;

/// The curve under a piece.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// Parameter = angle from +x.
    Arc(Circle),
    Spline(Rc<Curve<DVec2>>),
    /// A closed spline, continued around its period.
    Closed(Rc<Curve<DVec2>>),
}

/// A smooth piece of an outline, by arc length.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub(crate) region: Region,
    shape: Shape,
    /// Parameters of its ends; an arc may run backwards.
    range: [f64; 2],
    /// Arc length over the fraction of the range.
    measure: Measure,
}

/// The pieces of one section in the order leading edge, suction side, trailing edge (not if sharp), pressure side.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    pub(crate) pieces: Vec<Piece>,
    /// For every point of the ring: arc length from the start of the leading edge.
    pub(crate) places: Vec<f64>,
}

impl Shape {
    /// Point, first and second derivative.
    pub(super) fn at(&self, t: f64) -> [DVec2; 3] {
        match self {
            Self::Arc(circle) => {
                let e = DVec2::from_angle(t) * circle.radius;
                [circle.center + e, e.perp(), -e]
            }
            Self::Spline(curve) => curve.derivatives(t),
            Self::Closed(curve) => {
                let (start, end) = curve.domain();
                curve.derivatives(start + (t - start).rem_euclid(end - start))
            }
        }
    }

    fn breaks_between(&self, a: f64, b: f64) -> Vec<f64> {
        let inner: Vec<f64> = match self {
            Self::Arc(_) => Vec::new(),
            Self::Spline(curve) => curve.breaks(),
            Self::Closed(curve) => {
                let (start, end) = curve.domain();
                let shifts = [-1.0, 0.0, 1.0].map(|k| k * (end - start));
                shifts.iter().flat_map(|k| curve.breaks().into_iter().map(move |t| t + k)).collect()
            }
        };
        let tiny = 1e-9 * (b - a).abs();
        let mut breaks = vec![a];
        breaks.extend(inner.into_iter().filter(|&t| t > a + tiny && t < b - tiny));
        breaks.push(b);
        breaks.dedup_by(|x, y| *x - *y <= tiny);
        breaks
    }
}

impl Piece {
    pub(crate) fn new(region: Region, shape: Shape, range: [f64; 2]) -> Self {
        let [a, b] = range;
        let fractions: Vec<f64> = match &shape {
            Shape::Arc(_) => vec![0.0, 1.0],
            _ => shape.breaks_between(a, b).into_iter().map(|t| (t - a) / (b - a)).collect(),
        };
        let width = b - a;
        let measure = Measure::new(&fractions, ARC_ACCURACY, |f| {
            let [_, d, dd] = shape.at(a + width * f);
            let speed = d.length();
            (speed * width.abs(), d.dot(dd) / speed * width * width.abs())
        });
        Self { region, shape, range, measure }
    }

    /// Arc length, mm.
    pub(crate) fn length(&self) -> f64 {
        self.measure.total()
    }

    /// Point and unit tangent at arc length `s`, and the curvature, positive to the left.
    pub(crate) fn at(&self, s: f64) -> (DVec2, DVec2, f64) {
        let [a, b] = self.range;
        let [p, d, dd] = self.shape.at(a + (b - a) * self.measure.backward(s));
        let speed = d.length();
        let sense = if b < a { -1.0 } else { 1.0 };
        (p, d * (sense / speed), sense * d.perp_dot(dd) / (speed * speed * speed))
    }

    /// Fraction of the range at parameter `t` of the shape, not clamped; around the period where closed.
    fn fraction(&self, t: f64) -> f64 {
        let [a, b] = self.range;
        let t = match &self.shape {
            Shape::Closed(curve) => {
                let (start, end) = curve.domain();
                let period = end - start;
                // The representative nearest to the middle of the piece.
                t + period * ((0.5 * (a + b) - t) / period).round()
            }
            _ => t,
        };
        (t - a) / (b - a)
    }

    /// How far outside of the piece parameter `t` lies, 0 inside.
    pub(super) fn outside(&self, t: f64) -> f64 {
        let f = self.fraction(t);
        (f - f.clamp(0.0, 1.0)).abs() * self.length()
    }

    /// Arc length at parameter `t` of the shape.
    pub(super) fn place(&self, t: f64) -> f64 {
        self.measure.forward(self.fraction(t).clamp(0.0, 1.0))
    }
}

/// An arc of a circle between two angles, radians; it runs clockwise if they decrease.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArcSpan {
    pub(crate) circle: Circle,
    pub(crate) ends: [f64; 2],
}

impl ArcSpan {
    /// End condition where the arc begins (0) or ends (1).
    fn tangent(&self, end: usize) -> End {
        let sense = (self.ends[1] - self.ends[0]).signum();
        End::Tangent(DVec2::from_angle(self.ends[end]).perp() * sense)
    }

    fn piece(&self, region: Region) -> Piece {
        Piece::new(region, Shape::Arc(self.circle), self.ends)
    }
}

impl Outline {
    /// The outline of two arcs with sides drawn through points, ends included, tangent to the arcs.
    pub(crate) fn drawn(
        leading: &ArcSpan,
        suction: &[DVec2],
        trailing: &ArcSpan,
        pressure: &[DVec2],
    ) -> Result<Self, NurbsError> {
        let side = |region: Region, points: &[DVec2], before: &ArcSpan, after: &ArcSpan| {
            let chain = chain::open(points, before.tangent(1), after.tangent(0), 0.0)?;
            let ends = [chain.parameters[0], chain.parameters[chain.parameters.len() - 1]];
            Ok(Piece::new(region, Shape::Spline(Rc::new(chain.curve)), ends))
        };
        let pieces = vec![
            leading.piece(Region::LeadingEdge),
            side(Region::SuctionSide, suction, leading, trailing)?,
            trailing.piece(Region::TrailingEdge),
            side(Region::PressureSide, pressure, trailing, leading)?,
        ];
        Ok(Self { pieces, places: Vec::new() })
    }

    /// Arc length once around, mm.
    pub(crate) fn length(&self) -> f64 {
        self.pieces.iter().map(Piece::length).sum()
    }

    /// The outline of a ring that runs leading edge, suction side, trailing edge, pressure side, with the noses found.
    /// `slack` is how far in mm the curve may leave points at the ends of arcs.
    pub(crate) fn new(ring: &Ring, leading: &Nose, trailing: &Nose, slack: f64) -> Result<Self, NurbsError> {
        builder::outline(ring, leading, trailing, slack)
    }
}
