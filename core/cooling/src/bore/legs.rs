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
    let (mut face, first) = target.find(start.0, &rays(0.0), start.1, start.2)?;
    let mut leg = Leg { face, start: (first.at, first.along), to: 1.0, crossing: None };
    let mut out = Vec::new();
    let mut last = (first.at, first.along);
    let mut before = 0.0;
    let mut end = first;
    for k in 1..=STEPS {
        let t = k as f64 / STEPS as f64;
        let mut hit = target.meet(face, &rays(t), last.0, last.1).ok_or(BoreError::Misses)?;
        while !target.holds(face, hit.at) {
            if out.len() == MOST_CROSSINGS {
                return Err(BoreError::Misses);
            }
            let crossing = target.crossing(face, rays, (before, t), last, &hit)?;
            leg.to = crossing.t;
            leg.crossing = Some(crossing);
            out.push(leg);
            face = crossing.to;
            leg = Leg { face, start: (crossing.to_at, crossing.along), to: 1.0, crossing: None };
            before = crossing.t;
            last = (crossing.to_at, crossing.along);
            hit = target.meet(face, &rays(t), crossing.to_at, crossing.along).ok_or(BoreError::Misses)?;
        }
        (last, before, end) = ((hit.at, hit.along), t, hit);
    }
    out.push(leg);
    Ok((out, (face, end)))
}
