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

/// How often a step between them may be halved where the hits run far.
const MOST_HALVINGS: u32 = 10;

/// How far along a path its hits are known.
#[derive(Clone)]
struct Walk {
    /// The leg that the walk is on.
    leg: Leg,
    /// The last hit: parameter of the path, parameters in the face, multiple of the ray.
    t: f64,
    at: DVec2,
    along: f64,
    hit: Hit,
}

/// Follows the hits of a path over the faces of a target. `start` is a face with parameters near the first hit, and the
/// multiple of the ray there. Answers with the legs and where the path ends.
pub(super) fn legs(
    target: &Target<'_>,
    rays: &dyn Fn(f64) -> Ray,
    start: (FaceId, DVec2, f64),
) -> Result<(Vec<Leg>, (FaceId, Hit)), BoreError> {
    let (face, first) = target.find(start.0, &rays(0.0), start.1, start.2)?;
    let leg = Leg { face, start: (first.at, first.along), to: 1.0, crossing: None };
    let mut walk = Walk { leg, t: 0.0, at: first.at, along: first.along, hit: first };
    let mut out = Vec::new();
    let whole = 1usize << MOST_HALVINGS;
    let (mut ticks, mut step) = (0, whole);
    while ticks < STEPS * whole {
        // Steps end at multiples of their length.
        let next = ticks + step;
        match walk_on(target, rays, &walk, next as f64 / (STEPS * whole) as f64, out.len()) {
            Ok((done, on)) => {
                out.extend(done);
                walk = on;
                ticks = next;
                while step < whole && ticks.is_multiple_of(2 * step) {
                    step *= 2;
                }
            }
            Err(_) if step > 1 => step /= 2,
            Err(error) => return Err(error),
        }
    }
    let end = (walk.leg.face, walk.hit);
    out.push(walk.leg);
    Ok((out, end))
}

/// One step on: the legs that end within it, and where it leads. `before` legs have ended already.
fn walk_on(
    target: &Target<'_>,
    rays: &dyn Fn(f64) -> Ray,
    from: &Walk,
    t: f64,
    before: usize,
) -> Result<(Vec<Leg>, Walk), BoreError> {
    let mut walk = from.clone();
    let mut done = Vec::new();
    let mut hit = target.meet(walk.leg.face, &rays(t), walk.at, walk.along).ok_or(BoreError::Misses)?;
    while !target.holds(walk.leg.face, hit.at) {
        if before + done.len() == MOST_CROSSINGS {
            return Err(BoreError::Misses);
        }
        let crossing = target.crossing(walk.leg.face, rays, (walk.t, t), (walk.at, walk.along), &hit)?;
        walk.leg.to = crossing.t;
        walk.leg.crossing = Some(crossing);
        done.push(walk.leg);
        walk.leg =
            Leg { face: crossing.to, start: (crossing.to_at, crossing.along), to: 1.0, crossing: None };
        (walk.t, walk.at, walk.along) = (crossing.t, crossing.to_at, crossing.along);
        hit = target.meet(crossing.to, &rays(t), crossing.to_at, crossing.along).ok_or(BoreError::Misses)?;
    }
    (walk.t, walk.at, walk.along, walk.hit) = (t, hit.at, hit.along, hit);
    Ok((done, walk))
}
