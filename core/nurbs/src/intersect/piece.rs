//! Pieces of plane curves with enclosures, to be halved until they are separate or simple.

use crate::curve::ParametricCurve;
use crate::edit::BezierCurve;
use crate::vector::Homogeneous;
use glam::DVec2;
use std::f64::consts::{FRAC_PI_2, PI};

/// Pieces that a general curve is cut into between its breaks before anything is asked of them.
const FIRST: usize = 8;
/// Halvings of a general curve's piece at most until its enclosure is usable.
const DEPTH: usize = 24;
/// Pieces shorter than this part of the size are not made more usable.
const TINY: f64 = 1e-9;

/// A part of a plane curve and what is known of where it runs.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// Parameter interval.
    pub(crate) a: f64,
    pub(crate) b: f64,
    /// Bezier control points of the piece, or of the cubic near it.
    net: Vec<Homogeneous<DVec2>>,
    /// The same, projected: the piece is within `slack` of their convex hull.
    pub(crate) hull: Vec<DVec2>,
    pub(crate) slack: f64,
    /// Range of tangent directions relative to the chord; wide if unknown.
    cone: Option<(f64, f64)>,
}

impl Piece {
    fn new(a: f64, b: f64, net: Vec<Homogeneous<DVec2>>, slack: f64) -> Self {
        let hull: Vec<DVec2> = net.iter().map(Homogeneous::project).collect();
        let cone = cone_of(&hull, slack);
        Self { a, b, net, hull, slack, cone }
    }

    /// Vector from the first to the last point.
    pub(crate) fn chord(&self) -> DVec2 {
        self.hull[self.hull.len() - 1] - self.hull[0]
    }

    /// Length of the control polygon: the piece is no longer.
    pub(crate) fn length(&self) -> f64 {
        self.hull.windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    /// Tangent directions as angles, if they stay within 90 degrees of the chord.
    pub(crate) fn directions(&self) -> Option<(f64, f64)> {
        let along = self.chord().to_angle();
        self.cone.map(|(low, high)| (along + low, along + high))
    }

    /// Angle between the extreme tangents; a full turn if unknown.
    pub(crate) fn turn(&self) -> f64 {
        self.cone.map_or(2.0 * PI, |(low, high)| high - low)
    }

    /// Extent along a direction.
    fn range(&self, axis: DVec2) -> (f64, f64) {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in &self.hull {
            let x = axis.dot(*p);
            low = low.min(x);
            high = high.max(x);
        }
        (low - self.slack, high + self.slack)
    }

    /// Whether some line keeps the pieces more than `gap` apart: along the axes, the chords and their normals.
    pub(crate) fn separate(&self, other: &Self, gap: f64) -> bool {
        let apart = |axis: DVec2| {
            let ((a, b), (c, d)) = (self.range(axis), other.range(axis));
            c - b > gap || a - d > gap
        };
        if apart(DVec2::X) || apart(DVec2::Y) {
            return true;
        }
        [self.chord(), other.chord()].into_iter().any(|chord| {
            let axis = chord.normalize_or_zero();
            axis != DVec2::ZERO && (apart(axis.perp()) || apart(axis))
        })
    }
}

/// Range of the directions of a control polygon relative to its chord: those of tangents are among them, for positive
/// weights too, since every derivative is a positive combination of the polygon's edges.
fn cone_of(hull: &[DVec2], slack: f64) -> Option<(f64, f64)> {
    let chord = hull[hull.len() - 1] - hull[0];
    let (mut low, mut high) = (0.0f64, 0.0f64);
    for w in hull.windows(2) {
        let edge = w[1] - w[0];
        if edge != DVec2::ZERO {
            // Not `angle_to`, whose arc cosine loses half the digits.
            let angle = chord.perp_dot(edge).atan2(chord.dot(edge));
            low = low.min(angle);
            high = high.max(angle);
        }
    }
    // An error of `slack` with the bend of a quartic turns tangents by so much.
    let margin = if slack > 0.0 { 16.0 * slack / chord.length() } else { 0.0 };
    let known = low - margin > -FRAC_PI_2 && high + margin < FRAC_PI_2;
    known.then_some((low - margin, high + margin))
}

/// Whether some tangent of one piece may be parallel to one of the other.
pub(crate) fn may_be_parallel(a: (f64, f64), b: (f64, f64)) -> bool {
    let turns = ((a.0 - b.1) / PI).ceil();
    // The first shift of b by half turns that does not end before a starts must not start before a ends.
    b.0 + turns * PI <= a.1
}

/// A plane curve as the source of pieces: exact ones of a Bezier curve, or cubics near any other curve.
pub(crate) struct Source<'a> {
    curve: &'a dyn ParametricCurve<DVec2>,
    exact: bool,
    pub(crate) pieces: Vec<Piece>,
    /// Size of the curve's numbers.
    pub(crate) scale: f64,
}

impl<'a> Source<'a> {
    /// Pieces of a B-spline: the control polygons of its Bezier segments enclose them.
    pub(crate) fn exact<C: BezierCurve<Space = DVec2>>(curve: &'a C) -> Self {
        let pieces = curve.homogeneous_segments().into_iter().map(|s| {
            let (a, b) = s.knots().domain();
            Piece::new(a, b, s.points().to_vec(), 0.0)
        });
        Self { curve, exact: true, pieces: pieces.collect(), scale: 0.0 }.measured()
    }

    /// Pieces of any curve: cubics through their ends with the curve's derivatives there, and an estimate of the
    /// distance from the curve's points between. A curve that wiggles within an eighth of the interval between two
    /// breaks may escape it.
    pub(crate) fn adaptive(curve: &'a dyn ParametricCurve<DVec2>) -> Self {
        let intervals: Vec<(f64, f64)> = curve.breaks().windows(2).map(|w| (w[0], w[1])).collect();
        Self::adaptive_on(curve, &intervals)
    }

    /// Pieces of the parts of a curve on the given intervals, in order; the curve may jump between them.
    pub(crate) fn adaptive_on(curve: &'a dyn ParametricCurve<DVec2>, intervals: &[(f64, f64)]) -> Self {
        let at =
            |(a, b): (f64, f64), k: usize| if k == FIRST { b } else { a + (b - a) * k as f64 / FIRST as f64 };
        let ends = intervals.iter().flat_map(|&i| (0..FIRST).map(move |k| at(i, k)));
        let scale = ends.fold(0.0, |m: f64, t| m.max(curve.point(t).abs().max_element()));
        let mut source = Self { curve, exact: false, pieces: vec![], scale };
        for &i in intervals {
            for k in 0..FIRST {
                source.refine(at(i, k), at(i, k + 1), DEPTH);
            }
        }
        source.measured()
    }

    fn measured(mut self) -> Self {
        let points = self.pieces.iter().flat_map(|p| p.hull.iter());
        self.scale = points.fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
        self
    }

    fn refine(&mut self, a: f64, b: f64, depth: usize) {
        let piece = self.near(a, b);
        let middle = 0.5 * (a + b);
        let usable = piece.slack <= 0.02 * piece.chord().length() && piece.turn() < 1.0;
        // Near a cusp nothing is ever straight, and in the end all is rounding.
        let tiny = piece.length() <= TINY * self.scale;
        if usable || tiny || depth == 0 || !(middle > a && middle < b) {
            self.pieces.push(piece);
        } else {
            self.refine(a, middle, depth - 1);
            self.refine(middle, b, depth - 1);
        }
    }

    /// The cubic near a part of a general curve.
    fn near(&self, a: f64, b: f64) -> Piece {
        let (start, end) = (self.at(a, a, b), self.at(b, a, b));
        let third = (b - a) / 3.0;
        let points = [start[0], start[0] + start[1] * third, end[0] - end[1] * third, end[0]];
        let mut error = 0.0f64;
        for k in 1..4 {
            let x = f64::from(k) / 4.0;
            let y = 1.0 - x;
            let cubic = points[0] * (y * y * y)
                + (points[1] * y + points[2] * x) * (3.0 * x * y)
                + points[3] * (x * x * x);
            error = error.max(cubic.distance(self.curve.point(a + (b - a) * x)));
        }
        // The error of Hermite interpolation is greatest in the middle; twice that leaves room for higher terms.
        Piece::new(a, b, points.iter().map(|&p| Homogeneous::new(p, 1.0)).collect(), 2.0 * error)
    }

    /// Derivatives at a parameter of the piece on `[a, b]`: at its end those from within.
    pub(crate) fn at(&self, t: f64, a: f64, b: f64) -> [DVec2; 3] {
        let end = self.curve.domain().1;
        self.curve.derivatives(if t >= b && b < end { b.next_down().max(a) } else { t })
    }

    /// Point at a parameter.
    pub(crate) fn point(&self, t: f64) -> DVec2 {
        self.curve.point(t)
    }

    /// The curve behind.
    pub(crate) fn curve(&self) -> &'a dyn ParametricCurve<DVec2> {
        self.curve
    }

    /// The parts of a piece before and after `t`, which lies inside.
    pub(crate) fn split(&self, piece: &Piece, t: f64) -> [Piece; 2] {
        let (a, b) = (piece.a, piece.b);
        if !self.exact {
            return [self.near(a, t), self.near(t, b)];
        }
        // De Casteljau.
        let x = (t - a) / (b - a);
        let mut right = piece.net.clone();
        let mut left = right.clone();
        for r in 1..right.len() {
            for i in 0..right.len() - r {
                right[i] = right[i] * (1.0 - x) + right[i + 1] * x;
            }
            left[r] = right[0];
        }
        [Piece::new(a, t, left, 0.0), Piece::new(t, b, right, 0.0)]
    }

    /// The part of a piece on `[from, to]` inside it, or none if that is empty.
    pub(crate) fn part(&self, piece: &Piece, from: f64, to: f64) -> Option<Piece> {
        if !(from < to) {
            return None;
        }
        let head = if to < piece.b { self.split(piece, to)[0].clone() } else { piece.clone() };
        Some(if from > piece.a { self.split(&head, from)[1].clone() } else { head })
    }
}
