//! Steps along a branch of a section.

use super::{CERTIFIED, Plane, PlaneBranch};
use crate::edit::BezierSurface;
use crate::error::NurbsError;
use glam::{DMat2, DVec2, DVec3};

/// Rest of the corrector, relative to the size of the surface.
const RESIDUAL: f64 = 1e-14;
/// Shortest step, relative to the size of the surface.
const SHORTEST: f64 = 1e-9;
/// Steps this short, relative to the size of the surface, may be stuck at a saddle.
const SADDLE: f64 = 1e-5;
/// Cosine of the greatest turn in one step.
const TURN: f64 = 0.92;
const STEPS: usize = 200_000;
const NEWTON: usize = 12;

pub(super) struct Marcher<'a, S> {
    plane: &'a Plane<'a, S>,
    sagitta: f64,
    longest: f64,
    size: f64,
    low: DVec2,
    high: DVec2,
}

/// A point of a branch.
#[derive(Clone, Copy, Debug)]
struct Place {
    p: DVec2,
    x: DVec3,
    /// Unit tangent of the section, and the change of parameters along it.
    tangent: DVec3,
    change: DVec2,
}

impl<'a, S: BezierSurface<Space = DVec3>> Marcher<'a, S> {
    pub(super) fn new(plane: &'a Plane<'a, S>, sagitta: f64, longest: f64) -> Self {
        let ((u0, u1), (v0, v1)) = plane.surface.domain();
        let (low, high) = (DVec2::new(u0, v0), DVec2::new(u1, v1));
        let corners = [low, DVec2::new(u0, v1), DVec2::new(u1, v0), high, 0.5 * (low + high)];
        let points = corners.map(|c| plane.surface.point(c.x, c.y));
        let size =
            points.iter().fold(0.0, |m: f64, p| m.max(p.distance(points[4])).max(p.abs().max_element()));
        Self { plane, sagitta, longest, size, low, high }
    }

    fn place(&self, p: DVec2) -> Option<Place> {
        let (_, gradient, x, u, v) = self.plane.at(p);
        // Along the level line of the distance.
        let change = DVec2::new(-gradient.y, gradient.x);
        let along = u * change.x + v * change.y;
        let length = along.length();
        (length > 0.0 && length.is_finite()).then(|| Place {
            p,
            x,
            tangent: along / length,
            change: change / length,
        })
    }

    /// Newton's method on "in the plane" and "at a length along a direction from a point".
    fn correct(&self, mut p: DVec2, from: DVec3, direction: DVec3, length: f64) -> Option<DVec2> {
        let range = self.high - self.low;
        for _ in 0..NEWTON {
            let (g, gradient, x, u, v) = self.plane.at(p);
            let value = DVec2::new(g, (x - from).dot(direction) - length);
            if value.abs().max_element() <= RESIDUAL * self.size {
                return Some(p);
            }
            let jacobian = DMat2::from_cols(
                DVec2::new(gradient.x, u.dot(direction)),
                DVec2::new(gradient.y, v.dot(direction)),
            );
            let step = jacobian.inverse() * value;
            if !step.is_finite() || (step / range).abs().max_element() > 0.5 {
                return None;
            }
            p -= step;
        }
        let (g, ..) = self.plane.at(p);
        (g.abs() <= 0.1 * CERTIFIED).then_some(p)
    }

    /// The branch through a start point, or none if that is a point of contact.
    pub(super) fn branch(&self, seed: DVec2) -> Result<Option<PlaneBranch>, NurbsError> {
        let Some(start) = self.settle(seed) else { return Ok(None) };
        let (mut forward, closed) = self.follow(start, 1.0)?;
        let mut all = if closed { vec![] } else { self.follow(start, -1.0)?.0 };
        all.reverse();
        all.push(start);
        all.append(&mut forward);
        if all.len() < 2 {
            return Ok(None);
        }
        let mut branch = PlaneBranch {
            closed,
            parameters: all.iter().map(|a| a.p).collect(),
            points: all.iter().map(|a| a.x).collect(),
        };
        let last = branch.points.len() - 1;
        if closed {
            branch.points[last] = branch.points[0];
            branch.parameters[last] = branch.parameters[0];
        } else if last > 2 && branch.points[0].distance(branch.points[last]) <= CERTIFIED {
            // Closed over the seam: the same point with parameters on both sides.
            branch.closed = true;
            branch.points[last] = branch.points[0];
        }
        for x in &branch.points {
            let residual = self.plane.normal.dot(*x - self.plane.origin).abs();
            if !(residual <= CERTIFIED) {
                return Err(NurbsError::NoConvergence { what: "point of a plane section", residual });
            }
        }
        Ok(Some(branch))
    }

    /// A start point brought onto the plane, along the border if it is on one.
    fn settle(&self, seed: DVec2) -> Option<Place> {
        let mut p = seed;
        for _ in 0..NEWTON {
            let (g, mut gradient, ..) = self.plane.at(p);
            if p.x == self.low.x || p.x == self.high.x {
                gradient.x = 0.0;
            }
            if p.y == self.low.y || p.y == self.high.y {
                gradient.y = 0.0;
            }
            let square = gradient.length_squared();
            if g.abs() <= RESIDUAL * self.size || square == 0.0 {
                break;
            }
            p = (p - gradient * (g / square)).clamp(self.low, self.high);
        }
        let place = self.place(p)?;
        (self.plane.at(p).0.abs() <= CERTIFIED).then_some(place)
    }

    /// Follows a branch in one direction until it ends or closes; the start point is not repeated unless it closes.
    fn follow(&self, start: Place, sense: f64) -> Result<(Vec<Place>, bool), NurbsError> {
        let mut done: Vec<Place> = vec![];
        let mut here = start;
        let mut step = self.longest.min(0.01 * self.size);
        let mut way = sense;
        for _ in 0..STEPS {
            let direction = here.tangent * way;
            let next = self.try_step(&here, way, step);
            let Some((next, turn)) = next else {
                // The border first: a short way from it no step fits.
                if let Some(end) = self.border(&here, way, step) {
                    finish(&mut done, &start, end);
                    return Ok((done, false));
                }
                step *= 0.5;
                if step < SADDLE * self.size
                    && let Some(next) = self.over_saddle(&here, way)
                {
                    way = -way;
                    done.push(next);
                    here = next;
                    step = self.longest.min(1e-3 * self.size);
                    continue;
                }
                if step < SHORTEST * self.size {
                    let residual = self.plane.at(here.p).1.length();
                    return Err(NurbsError::NoConvergence { what: "march along a plane section", residual });
                }
                continue;
            };
            let along = (next.x - here.x).dot(direction);
            let back = (start.x - here.x).dot(direction);
            if done.len() > 2 && back > 0.0 && back <= along && self.same(&here, direction, back, &start) {
                finish(&mut done, &here, start);
                return Ok((done, true));
            }
            done.push(next);
            here = next;
            if turn < 0.25 {
                step = (1.5 * step).min(self.longest);
            }
        }
        Err(NurbsError::NoConvergence { what: "end of a plane section", residual: self.size })
    }

    /// A step of a length, and its sagitta over the one allowed; none if it is too long or leaves the domain.
    fn try_step(&self, here: &Place, way: f64, step: f64) -> Option<(Place, f64)> {
        let direction = here.tangent * way;
        let ahead = here.change * (way * step);
        let p = self.correct(here.p + ahead, here.x, direction, step)?;
        let range = self.high - self.low;
        // Far from where it was expected the point may be on another branch, or beyond a loop of this one.
        if !(((p - here.p - ahead) / range).length() <= 0.3 * (ahead / range).length()) || !self.inside(p) {
            return None;
        }
        // Near a border the branch may leave the domain and come back within the step.
        let room = (p - self.low).min(self.high - p).min((here.p - self.low).min(self.high - here.p));
        if (room / range).min_element() < ((p - here.p) / range).length() {
            let half = self.correct(here.p + 0.5 * (p - here.p), here.x, direction, 0.5 * step)?;
            if !self.inside(half) {
                return None;
            }
        }
        let next = self.place(p.clamp(self.low, self.high))?;
        self.turn(here, way, &next).map(|turn| (next, turn))
    }

    /// Whether parameters are in the domain, but for rounding: a branch may run along a border that lies in the plane.
    fn inside(&self, p: DVec2) -> bool {
        let slack = 1e-10 * (self.high - self.low);
        (p - self.low + slack).min_element() >= 0.0 && (self.high + slack - p).min_element() >= 0.0
    }

    /// The sagitta of a step over the one allowed, if that is at most one and the step goes on along the branch.
    fn turn(&self, here: &Place, way: f64, next: &Place) -> Option<f64> {
        let chord = next.x - here.x;
        let length = chord.length();
        let along = chord.dot(here.tangent * way) / length;
        // With its sign: the tangent turns with the gradient, which is opposite on a branch next to this one.
        let cosine = here.tangent.dot(next.tangent);
        let sagitta = length * cosine.clamp(0.0, 1.0).acos() / 8.0 / self.sagitta;
        (cosine >= TURN && along >= TURN && sagitta <= 1.0).then_some(sagitta)
    }

    /// Whether a branch that passes `here` along `direction` meets `there` after the length `back`.
    fn same(&self, here: &Place, direction: DVec3, back: f64, there: &Place) -> bool {
        let rate = here.change * here.tangent.dot(direction);
        self.correct(here.p + rate * back, here.x, direction, back)
            .is_some_and(|p| self.plane.surface.point(p.x, p.y).distance(there.x) <= 1e-7 * self.size)
    }

    /// The point on the border that the branch leaves through within a step, if it does.
    fn border(&self, here: &Place, way: f64, step: f64) -> Option<Place> {
        let rate = here.change * way;
        let mut best: Option<(f64, Place)> = None;
        for axis in 0..2 {
            for bound in [self.low[axis], self.high[axis]] {
                // Whether two steps ahead are beyond: a branch along the border is not.
                let ahead = here.p[axis] + 2.0 * step * rate[axis];
                let slack = 1e-11 * (self.high - self.low)[axis];
                let length = (bound - here.p[axis]) / rate[axis];
                let beyond = ahead < self.low[axis] - slack || ahead > self.high[axis] + slack;
                let reached = length >= -SHORTEST * self.size && length <= 2.0 * step;
                if !(beyond && reached) {
                    continue;
                }
                // Newton's method along the border.
                let other = 1 - axis;
                let mut p = here.p + rate * length;
                p[axis] = bound;
                for _ in 0..NEWTON {
                    let (g, gradient, ..) = self.plane.at(p);
                    if g.abs() <= RESIDUAL * self.size {
                        break;
                    }
                    p[other] -= g / gradient[other];
                }
                let slack = 1e-10 * (self.high - self.low)[other];
                let inside = p[other] >= self.low[other] - slack && p[other] <= self.high[other] + slack;
                if !inside || !p.is_finite() || self.plane.at(p).0.abs() > 0.1 * CERTIFIED {
                    continue;
                }
                let Some(end) = self.place(p.clamp(self.low, self.high)) else { continue };
                let ahead = (end.x - here.x).dot(here.tangent * way);
                // The end of this branch, not a point of another one on the same border.
                let short = end.x.distance(here.x) <= 2.0 * step && self.turn(here, way, &end).is_some();
                let touching = end.x.distance(here.x) <= CERTIFIED;
                if (short || touching) && best.is_none_or(|b| ahead < b.0) {
                    best = Some((ahead, end));
                }
            }
        }
        best.map(|b| b.1)
    }

    /// Whether two points of the surface are close together.
    pub(super) fn near(&self, a: DVec2, b: DVec2) -> bool {
        let [a, b] = [a, b].map(|p| self.plane.surface.point(p.x, p.y));
        a.distance(b) <= 1e-3 * self.size
    }

    /// Whether a branch is so short that it is rounding around a point.
    pub(super) fn is_speck(&self, branch: &PlaneBranch) -> bool {
        branch.points.iter().all(|p| p.distance(branch.points[0]) <= 1e-6 * self.size)
    }

    /// The point beyond a saddle in the plane just ahead, where two branches cross and the gradient changes its sense.
    fn over_saddle(&self, here: &Place, way: f64) -> Option<Place> {
        let saddle = super::start::saddle(self.plane, here.p)?;
        let x = self.plane.surface.point(saddle.x, saddle.y);
        let ahead = (x - here.x).dot(here.tangent * way);
        if !(ahead > 0.0 && ahead <= 1e-3 * self.size) {
            return None;
        }
        // Far enough that the branches are apart again.
        let length = (2.0 * ahead).max(1e-4 * self.size);
        let direction = here.tangent * way;
        let p = self.correct(here.p + here.change * (way * length), here.x, direction, length)?;
        let next = self.place(p.clamp(self.low, self.high))?;
        let straight = (next.x - here.x).dot(direction) >= TURN * next.x.distance(here.x);
        (straight && next.tangent.dot(here.tangent) <= -TURN).then_some(next)
    }

    /// Whether a branch already found passes a start point.
    pub(super) fn passes(&self, branch: &PlaneBranch, seed: DVec2) -> bool {
        let Some(seed) = self.settle(seed) else { return true };
        (1..branch.points.len()).any(|i| {
            let (a, b) = (branch.points[i - 1], branch.points[i]);
            let chord = b - a;
            let length = chord.length();
            let direction = chord / length;
            let back = (seed.x - a).dot(direction);
            let slack = 1e-6 * self.size;
            if back < -slack || back > length + slack || (seed.x - a).dot(self.plane.normal).abs() > slack {
                return false;
            }
            // Cheap first: far from the chord is far from the branch.
            if (seed.x - a - direction * back).length() > 4.0 * self.sagitta + slack {
                return false;
            }
            let share = (back / length).clamp(0.0, 1.0);
            let (p, q) = (branch.parameters[i - 1], branch.parameters[i]);
            self.correct(p + (q - p) * share, a, direction, back).is_some_and(|p| {
                // At a seam the same point has other parameters, and another branch.
                let same = ((p - seed.p) / (self.high - self.low)).abs().max_element() < 1e-3;
                same && self.plane.surface.point(p.x, p.y).distance(seed.x) <= 1e-7 * self.size
            })
        })
    }
}

/// Adds the last point of a branch, in place of one that is the same but for rounding.
fn finish(done: &mut Vec<Place>, first: &Place, end: Place) {
    match done.last_mut() {
        Some(last) if last.x.distance(end.x) <= CERTIFIED => *last = end,
        None if first.x.distance(end.x) <= CERTIFIED => {}
        _ => done.push(end),
    }
}
