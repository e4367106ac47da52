//! Legs: a path's hits on a target, parted where they cross from face to face.

use super::BoreError;
use super::target::{Crossing, Hit, Ray, Target};
use coolinggen_brep::FaceId;
use glam::DVec2;

/// The part of a path that lies on one face.
#[derive(Clone, Debug)]
pub(super) struct Leg {
    pub(super) face: FaceId,
    /// Where on the face, and on its ray, the leg starts.
    pub(super) start: (DVec2, f64),
    /// Parameter of the path at its end.
    pub(super) to: f64,
    /// How it crosses to the next leg; none at the end of the path.
    pub(super) crossing: Option<Crossing>,
}

/// Rays tried along a path to see where it crosses borders.
const STEPS: usize = 12;
/// Most borders that one path may cross.
const MOST_CROSSINGS: usize = 12;

/// Follows the hits of a path over the faces of a target. `start` is a face with parameters near the first hit, and the
/// multiple of the ray there. Answers with the legs and where the path ends.
pub(super) fn legs(
    target: &Target<'_>,
    rays: &dyn Fn(f64) -> Ray,
    start: (FaceId, DVec2, f64),
) -> Result<(Vec<Leg>, (FaceId, Hit)), BoreError> {
    let (face, first) = target.find(start.0, &rays(0.0), start.1, start.2)?;
    let leg = Leg { face, start: (first.at, first.along), to: 1.0, crossing: None };
    let mut walk = Walk { target, rays, out: Vec::new(), leg, at: 0.0, hit: first };
    for k in 1..=STEPS {
        walk.step(k as f64 / STEPS as f64, 0)?;
    }
    let Walk { mut out, leg, hit, .. } = walk;
    let face = leg.face;
    out.push(leg);
    Ok((out, (face, hit)))
}

/// A path followed so far.
struct Walk<'w, 'm> {
    target: &'w Target<'m>,
    rays: &'w dyn Fn(f64) -> Ray,
    out: Vec<Leg>,
    /// The leg it is on.
    leg: Leg,
    /// Parameter reached, and the hit there.
    at: f64,
    hit: Hit,
}

impl Walk<'_, '_> {
    /// Goes on to `t`; first to where it may have been over a border in between and come back.
    fn step(&mut self, t: f64, depth: usize) -> Result<(), BoreError> {
        const DEEPEST: usize = 6;
        const LEAST_STEP: f64 = 1e-4;
        let ray = (self.rays)(t);
        // A small face, a fillet's, need not go on far enough beyond its border; and hits may run far in one step.
        let halves = |walk: &mut Self, error: BoreError| {
            if t - walk.at < LEAST_STEP {
                return Err(error);
            }
            walk.step(0.5 * (walk.at + t), depth)?;
            walk.step(t, depth)
        };
        let near = self.target.ahead(self.leg.face, self.hit.at, self.hit.at_slope * (t - self.at));
        let Some(hit) = self.target.meet(self.leg.face, &ray, near, self.hit.along) else {
            return halves(self, BoreError::Misses);
        };
        if self.target.holds(self.leg.face, hit.at) {
            let part = self.target.outmost(self.leg.face, [&self.hit, &hit], t - self.at);
            if let Some(part) = part.filter(|_| depth < DEEPEST) {
                self.step(self.at + (t - self.at) * part, depth + 1)?;
                return self.step(t, depth + 1);
            }
            (self.at, self.hit) = (t, hit);
            return Ok(());
        }
        if self.out.len() == MOST_CROSSINGS {
            return Err(BoreError::Misses);
        }
        let last = (self.hit.at, self.hit.along);
        let crossing = match self.target.crossing(self.leg.face, self.rays, (self.at, t), last, &hit) {
            Ok(crossing) => crossing,
            Err(error) => return halves(self, error),
        };
        let next =
            Leg { face: crossing.to, start: (crossing.to_at, crossing.along), to: 1.0, crossing: None };
        let before = std::mem::replace(&mut self.leg, next);
        self.out.push(Leg { to: crossing.t, crossing: Some(crossing), ..before });
        let ray = (self.rays)(crossing.t);
        self.hit =
            (self.target.meet(crossing.to, &ray, crossing.to_at, crossing.along)).ok_or(BoreError::Misses)?;
        // On the border to the last bit, as `crossing` has it.
        self.hit.at = crossing.to_at;
        self.at = crossing.t;
        self.step(t, depth)
    }
}
