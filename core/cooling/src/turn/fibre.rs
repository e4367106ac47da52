//! Fibres of a turn in one section: straight lines across the passage that keep the wall's angle to the camber line.

use super::{TurnRefusal, TurnSection};
use crate::section::{Outline, Segment, angle_between};
use coolinggen_nurbs::ParametricCurve;
use glam::DVec2;

/// A side of the shell's inner outline between the chambers' far ends. Round a nose the outline itself turns away; the
/// side goes on along its tangent there, with a curvature that fades out after [`TURNED`]: twice continuously
/// differentiable, and the two sides of a nose do not meet before its end, since tangents of a circle do not.
struct Side<'a> {
    outline: &'a Outline,
    low: f64,
    high: f64,
}

/// How far a continued side may turn, radians.
const TURNED: f64 = 0.1;

impl Side<'_> {
    fn at(&self, u: f64) -> (DVec2, DVec2) {
        // At its end a side may meet a joint, where derivatives jump: stay on this side of it.
        let inside = 1e-9 * (self.high - self.low);
        let near = u.clamp(self.low + inside, self.high - inside);
        let [p, d, dd] = self.outline.curve().derivatives(near);
        let e = u - near;
        if e == 0.0 {
            return (p, d);
        }
        // dd fades as exp(-|e| / reach).
        let reach = TURNED * d.length_squared() / d.perp_dot(dd).abs();
        let reach = reach.min(10.0 * (self.high - self.low));
        let faded = -(-e.abs() / reach).exp_m1() * reach;
        (p + d * e + dd * (reach * (e.abs() - faded)), d + dd * (faded * e.signum()))
    }
}

/// The fibres of one section.
pub(super) struct Fibres<'a> {
    section: &'a TurnSection<'a>,
    /// Suction side, pressure side.
    sides: [Side<'a>; 2],
    /// Camber fraction per mm of x.
    rate: f64,
    /// Angle from the camber line to the fibres, radians.
    angle: f64,
}

/// Ends of a side segment.
fn side_ends(segment: &Segment) -> (f64, f64) {
    match *segment {
        Segment::Side { from, to } => (from, to),
        Segment::Arc { .. } | Segment::Line { .. } => (0.0, 0.0),
    }
}

impl<'a> Fibres<'a> {
    /// Fibres of a section; `length` is the length of the camber line, mm, that x is measured by.
    pub(super) fn new(section: &'a TurnSection<'a>, length: f64) -> Self {
        let [front, back] = &section.rings;
        let outline = section.outline;
        let suction =
            Side { outline, low: side_ends(&front.segments[0]).0, high: side_ends(&back.segments[0]).1 };
        let pressure =
            Side { outline, low: side_ends(&back.segments[4]).0, high: side_ends(&front.segments[4]).1 };
        let tangent = section.camber.at(section.position).tangent;
        let angle = angle_between(tangent, section.wall[1]);
        Self { section, sides: [suction, pressure], rate: 1.0 / length, angle }
    }

    /// Point on the camber line and direction of the fibre at x.
    fn line(&self, x: f64) -> (DVec2, DVec2) {
        let at = self.section.camber.at(self.section.position + x * self.rate);
        (at.center, DVec2::from_angle(self.angle).rotate(at.tangent))
    }

    /// x of the fibre through a point of the section.
    pub(super) fn x_of(&self, point: DVec2, start: f64) -> Option<f64> {
        let off = |x: f64| {
            let (center, direction) = self.line(x);
            (point - center).perp_dot(direction)
        };
        let step = 1e-4;
        let mut x = start;
        for _ in 0..50 {
            let slope = (off(x + step) - off(x - step)) / (2.0 * step);
            let change = -off(x) / slope;
            if !change.is_finite() {
                return None;
            }
            x += change.clamp(-3.0, 3.0);
            if change.abs() < 1e-7 {
                return Some(x);
            }
        }
        None
    }

    /// Where the fibres at increasing `xs`, those nearest to x = 0 first met, end: on the suction and the pressure side.
    pub(super) fn ends(&self, xs: &[f64]) -> Result<Vec<[DVec2; 2]>, TurnRefusal> {
        let middle = xs.partition_point(|&x| x < 0.0).min(xs.len() - 1);
        let mut ends = vec![[DVec2::ZERO; 2]; xs.len()];
        for (k, side) in self.sides.iter().enumerate() {
            let no_side = |x: f64| TurnRefusal::NoSide { x };
            let start = self.first(side, xs[middle]).ok_or(no_side(xs[middle]))?;
            for order in [&mut (middle..xs.len()) as &mut dyn Iterator<Item = usize>, &mut (0..middle).rev()]
            {
                let mut u = start;
                for i in order {
                    u = self.meet(side, xs[i], u).ok_or(no_side(xs[i]))?;
                    ends[i][k] = side.at(u).0;
                }
            }
        }
        Ok(ends)
    }

    /// About the parameter at which a side meets the fibre at x: the nearest of the samples on it.
    fn first(&self, side: &Side<'_>, x: f64) -> Option<f64> {
        const SAMPLES: u32 = 200;
        let (center, direction) = self.line(x);
        let at = |i: u32| side.low + (side.high - side.low) * f64::from(i) / f64::from(SAMPLES);
        let off = |u: f64| (side.at(u).0 - center).perp_dot(direction).abs();
        (0..=SAMPLES).map(at).min_by(|a, b| off(*a).total_cmp(&off(*b)))
    }

    /// Newton's method for the parameter at which a side meets the fibre at x.
    fn meet(&self, side: &Side<'_>, x: f64, start: f64) -> Option<f64> {
        let (center, direction) = self.line(x);
        let mut u = start;
        for _ in 0..60 {
            let (p, d) = side.at(u);
            let change = -(p - center).perp_dot(direction) / d.perp_dot(direction);
            if !change.is_finite() {
                return None;
            }
            let limit = 0.05 * (side.high - side.low);
            u += change.clamp(-limit, limit);
            if (change * d.length()).abs() < 1e-12 {
                return Some(u);
            }
        }
        let (p, _) = side.at(u);
        ((p - center).perp_dot(direction).abs() < 1e-9).then_some(u)
    }
}
