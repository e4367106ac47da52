//! Fibres of a turn in one section: straight lines across the passage that keep the wall's angle to the camber line, but
//! for ends of the turn where they have to fan out.

use super::fan::{Fan, Start};
use super::side::Side;
use super::{TurnRefusal, TurnSection};
use crate::section::angle_between;
use glam::DVec2;

/// The fibres of one section.
pub(super) struct Fibres<'a> {
    section: &'a TurnSection<'a>,
    /// Suction side, pressure side.
    sides: [Side<'a>; 2],
    /// Camber fraction per mm of x.
    rate: f64,
    /// Angle from the camber line to the fibres, radians.
    angle: f64,
    /// Towards the front and the back end.
    fans: [Option<Fan>; 2],
}

/// Least sine of the angle at which fibres that keep the wall's angle may cross a side at its end: 25 degrees.
const LEAST_SINE: f64 = 0.42;
/// Least pace of fibres along a side, relative to the mean on the way to its end: where they go slower they are about to
/// cross each other, as on the inside of a camber line that bends more tightly than the passage is wide.
const LEAST_PACE: f64 = 0.1;
/// Where fibres begin to fan out.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Straight {
    /// Behind this share of the way to the nearer end of a side.
    Share(f64),
    /// At the wall, towards both ends: the camber line bends so tightly that no neighbour can keep the wall's angle.
    None,
}

/// How the fibres of a turn run.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Form {
    /// At the wall's angle wherever they can.
    Kept,
    /// Fanning out towards both ends.
    Fanned(Straight),
}

/// Forms of a turn, tried in turn until its faces are sound.
pub(crate) const FORMS: [Form; 4] = [
    Form::Kept,
    Form::Fanned(Straight::None),
    Form::Fanned(Straight::Share(0.3)),
    Form::Fanned(Straight::Share(0.1)),
];

/// Where fibres may begin to fan out, tried in turn.
const STARTS: [Straight; 5] =
    [Straight::Share(0.3), Straight::Share(0.2), Straight::Share(0.1), Straight::Share(0.05), Straight::None];
/// How many times farther one side may seem to reach than the other from where fibres begin to fan out; tried in turn.
const UNLIKE: [f64; 2] = [3.0, MOST_UNLIKE];
/// The most that is tried.
pub(super) const MOST_UNLIKE: f64 = 8.0;

/// Fans in the order in which they are tried: where they may begin, and how unlike the sides may be.
pub(super) fn fans() -> impl Iterator<Item = (Straight, f64)> {
    UNLIKE.into_iter().flat_map(|unlike| STARTS.map(|start| (start, unlike)))
}

/// How far a continued side may turn beside a fan, relative to what is left to turn of the nose between the sides.
const SHARE_TURNED: f64 = 0.2;

impl<'a> Fibres<'a> {
    /// Fibres of a section; `length` is the length of the camber line, mm, that x is measured by.
    pub(super) fn new(section: &'a TurnSection<'a>, length: f64) -> Self {
        let [front, back] = &section.rings;
        let outline = section.outline;
        let suction = Side::new(outline, &front.segments[0], &back.segments[0]);
        let pressure = Side::new(outline, &back.segments[4], &front.segments[4]);
        let tangent = section.camber.at(section.position).tangent;
        let angle = angle_between(tangent, section.wall[1]);
        Self { section, sides: [suction, pressure], rate: 1.0 / length, angle, fans: [None, None] }
    }

    /// Parameters of the sides at the front (0) or the back end (1): suction side, pressure side.
    fn side_ends(&self, end: usize) -> [f64; 2] {
        let [suction, pressure] = &self.sides;
        if end == 0 { [suction.low, pressure.high] } else { [suction.high, pressure.low] }
    }

    /// Whether fibres at the wall's angle must fan out towards an end: they would graze a side there, pass it, or cross
    /// each other on the way.
    pub(super) fn must_fan(&self, end: usize) -> bool {
        self.steep(end) || self.cross(end)
    }

    /// Whether a side runs so steeply at an end that fibres at the wall's angle graze it, or pass it.
    fn steep(&self, end: usize) -> bool {
        let ends = self.side_ends(end);
        let across = self.angle.sin().signum();
        (self.sides.iter().zip(ends).zip([1.0, -1.0])).any(|((side, u), sense)| {
            let (at, slope) = side.at(u);
            // The suction side runs with x, the pressure side against it.
            let sine = |x: f64| slope.normalize().perp_dot(self.line(x).1) * sense * across;
            !self.x_of(at, 0.0).is_some_and(|x| sine(x) > LEAST_SINE)
        })
    }

    /// Whether fibres at the wall's angle cross each other on the way to an end, or nearly so.
    fn cross(&self, end: usize) -> bool {
        const STEPS: u32 = 40;
        let (ends, far) = (self.side_ends(end), self.far(end));
        let far = far[0].max(far[1]) * [-1.0, 1.0][end];
        self.sides.iter().zip(ends).any(|(side, last)| {
            let Some(start) = self.first(side, 0.0).and_then(|u| self.meet(side, 0.0, u)) else {
                return true;
            };
            let step = (last - start) / f64::from(STEPS);
            let mut u = start;
            for i in 1..=STEPS {
                let Some(next) = self.meet(side, far * f64::from(i) / f64::from(STEPS), u) else {
                    return true;
                };
                if !((next - u) / step > LEAST_PACE) {
                    return true;
                }
                if (next - start) / (last - start) > 1.0 {
                    return false;
                }
                u = next;
            }
            false
        })
    }

    /// About x of the sides' ends, by magnitude.
    fn far(&self, end: usize) -> [f64; 2] {
        let ends = self.side_ends(end);
        [0, 1].map(|k| self.chord(self.sides[k].at(ends[k]).0) * [-1.0, 1.0][end])
    }

    /// Lets the fibres towards an end fan out; those towards the other end, too, if they do so at the wall.
    pub(super) fn fan_out(
        &mut self,
        end: usize,
        (straight, unlike): (Straight, f64),
    ) -> Result<(), TurnRefusal> {
        match straight {
            Straight::Share(share) => self.fan_out_behind(end, share, unlike),
            Straight::None => self.fan_out_at_wall(unlike),
        }
    }

    /// Lets the fibres towards an end fan out, behind a `share` of the way on which they keep the wall's angle.
    fn fan_out_behind(&mut self, end: usize, share: f64, unlike: f64) -> Result<(), TurnRefusal> {
        const STEP: f64 = 1e-3;
        let ends = self.bend_less(end);
        // x of the sides' ends, as far as they tell: where a side is steep they need not.
        let far = self.far(end);
        let from = share * far[0].min(far[1]) * [-1.0, 1.0][end];
        let none = TurnRefusal::NoSide { x: from };
        let mut starts = [Start { u: 0.0, rate: 0.0, end: 0.0 }; 2];
        for (k, side) in self.sides.iter().enumerate() {
            let near = self.first(side, 0.0).and_then(|u| self.meet(side, 0.0, u)).ok_or(none.clone())?;
            let at = |x: f64, near: f64| self.meet(side, x, near).ok_or(none.clone());
            let near = at(0.5 * from, near)?;
            let u = at(from, near)?;
            let rate = (at(from + STEP, u)? - at(from - STEP, u)?) / (2.0 * STEP);
            starts[k] = Start { u, rate, end: ends[k] };
        }
        self.fans[end] = Some(Fan::new(from, starts, unlike).ok_or(none)?);
        Ok(())
    }

    /// Lets the fibres fan out towards both ends from the wall itself.
    fn fan_out_at_wall(&mut self, unlike: f64) -> Result<(), TurnRefusal> {
        let none = TurnRefusal::NoSide { x: 0.0 };
        let ends = [0, 1].map(|end| self.bend_less(end));
        let reach = [0, 1].map(|end| {
            let far = self.far(end);
            0.5 * (far[0] + far[1]) * [-1.0, 1.0][end]
        });
        let mut starts = [[Start { u: 0.0, rate: 0.0, end: 0.0 }; 2]; 2];
        for (k, side) in self.sides.iter().enumerate() {
            let u = self.first(side, 0.0).and_then(|u| self.meet(side, 0.0, u)).ok_or(none.clone())?;
            let rate = (ends[1][k] - ends[0][k]) / (reach[1] - reach[0]);
            for end in [0, 1] {
                starts[end][k] = Start { u, rate, end: ends[end][k] };
            }
        }
        for end in [0, 1] {
            self.fans[end] = Some(Fan::new(0.0, starts[end], unlike).ok_or(none.clone())?);
        }
        Ok(())
    }

    /// Ends of the sides towards an end, beyond which they turn no more than what is left to turn of the nose between
    /// them bears.
    fn bend_less(&mut self, end: usize) -> [f64; 2] {
        let ends = self.side_ends(end);
        let slopes = [0, 1].map(|k| self.sides[k].at(ends[k]).1);
        let turn = 0.5 * angle_between(slopes[0], slopes[1]).abs();
        for (k, side) in self.sides.iter_mut().enumerate() {
            let turned = &mut side.turned[usize::from(ends[k] == side.high)];
            *turned = turned.min(SHARE_TURNED * turn);
        }
        ends
    }

    /// About x of a point: its distance from the wall's mid line along the camber line's tangent.
    fn chord(&self, point: DVec2) -> f64 {
        let (center, direction) = self.line(0.0);
        let camber = self.section.camber;
        let tangent = camber.at(self.section.position).tangent;
        (point - center).perp_dot(direction) / (tangent.perp_dot(direction) * camber.length() * self.rate)
    }

    /// Whether fibres reach all of the ring towards an end.
    pub(super) fn reaches(&self, end: usize) -> bool {
        self.ring_extent(end).is_some()
    }

    /// Range of x that the rings take, their closures included.
    pub(super) fn extent(&self) -> Option<[f64; 2]> {
        let [front, back] = [self.ring_extent(0)?, self.ring_extent(1)?];
        Some([front[0].min(back[0]), front[1].max(back[1])])
    }

    /// Range of x that the ring towards an end takes, and x = 0.
    fn ring_extent(&self, end: usize) -> Option<[f64; 2]> {
        const SAMPLES: u32 = 8;
        let ring = &self.section.rings[end];
        let samples = |k: usize| {
            let at = move |i: u32| {
                ring.segments[k].evaluate(self.section.outline, f64::from(i) / f64::from(SAMPLES)).0
            };
            (0..=SAMPLES).map(at)
        };
        if let Some(fan) = &self.fans[end] {
            let closure = if end == 0 { 5..8 } else { 1..4 };
            let inner: Vec<DVec2> = closure.flat_map(samples).collect();
            let x = fan.beyond(&self.sides, &inner, self.section.wall[0])?;
            return Some([x.min(0.0), x.max(0.0)]);
        }
        let (mut low, mut high, mut x) = (0.0f64, 0.0f64, 0.0);
        for point in (0..ring.segments.len()).flat_map(samples) {
            x = self.x_of(point, x)?;
            (low, high) = (low.min(x), high.max(x));
        }
        Some([low, high])
    }

    /// Point on the camber line and direction of the fibre at x.
    fn line(&self, x: f64) -> (DVec2, DVec2) {
        let at = self.section.camber.at(self.section.position + x * self.rate);
        (at.center, DVec2::from_angle(self.angle).rotate(at.tangent))
    }

    /// x of the fibre through a point of the section.
    fn x_of(&self, point: DVec2, start: f64) -> Option<f64> {
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
                    if let Some(fan) = self.fans.iter().flatten().find(|fan| fan.holds(xs[i])) {
                        ends[i][k] = fan.ends(&self.sides, xs[i])[k];
                        continue;
                    }
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
