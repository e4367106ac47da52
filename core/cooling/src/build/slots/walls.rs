//! The metal beside a slot.

use crate::bore::Frame;
use coolinggen_brep::{CastHit, Caster, Model};
use coolinggen_nurbs::line_meets_surface;
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// What a slot may meet.
pub(super) struct Surroundings {
    /// The passages.
    pub(super) passages: Arc<Caster>,
    /// The outer surface.
    pub(super) outer: Arc<Caster>,
    /// Its suction side and its pressure side.
    pub(super) sides: [Arc<Caster>; 2],
}

/// The metal between a slot and the blade's sides. The frame's x points to the suction side, its origin lies at the exit.
pub(super) struct Beside<'a> {
    pub(super) model: &'a Model,
    pub(super) sides: &'a [Arc<Caster>; 2],
    pub(super) frame: Frame,
    /// Half the width and half the height.
    pub(super) half: DVec2,
    pub(super) length: f64,
}

impl Beside<'_> {
    /// Metal to a side (0 suction, 1 pressure) at a place of the slot, mm, negative where the slot breaks through it; none
    /// where the side has ended.
    pub(super) fn wall(&self, side: usize, y: f64, z: f64) -> Option<f64> {
        let out = if side == 0 { self.frame.x } else { -self.frame.x };
        let origin = self.frame.point(DVec2::new(0.0, y), z);
        let CastHit { face, at, along } = self.sides[side].first(origin, out, 0.0)?;
        let surface = &self.model.face(face).surface;
        let exact = line_meets_surface(surface, origin, out, (at.x, at.y), along);
        Some(exact.map_or(along, |hit| hit.along) - self.half.x)
    }

    /// The thinnest metal to a side between the slot's beginning and `end` on the axis.
    pub(super) fn thinnest(&self, side: usize, end: f64) -> Option<f64> {
        const STEPS: u32 = 24;
        let places = (0..=STEPS).flat_map(|i| [-1.0, 0.0, 1.0].map(|y| (y, f64::from(i) / f64::from(STEPS))));
        let walls = places.filter_map(|(y, part)| {
            self.wall(side, y * self.half.y, (end + self.length) * part - self.length)
        });
        walls.min_by(f64::total_cmp)
    }

    /// Where on the axis the metal to the pressure side, half way up, has come down to `thickness` mm; else the least or
    /// the greatest thickness that it comes to.
    pub(super) fn lip(&self, thickness: f64) -> Result<f64, LipRefusal> {
        const STEPS: u32 = 48;
        let z = |i: u32| self.length * (f64::from(i) / f64::from(STEPS) - 1.0);
        let walls: Vec<(f64, f64)> =
            (0..=STEPS).map_while(|i| self.wall(1, 0.0, z(i)).map(|wall| (z(i), wall))).collect();
        let (Some(first), Some(last)) = (walls.first(), walls.last()) else {
            return Err(LipRefusal::AtMost(0.0));
        };
        if first.1 <= thickness {
            return Err(LipRefusal::AtMost(first.1));
        }
        let Some(k) = walls.iter().position(|w| w.1 <= thickness) else {
            return Err(LipRefusal::AtLeast(last.1));
        };
        let (mut low, mut high) = (walls[k - 1].0, walls[k].0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.wall(1, 0.0, middle).is_some_and(|wall| wall > thickness) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(0.5 * (low + high))
    }
}

/// A lip that the pressure side's wall does not have.
pub(super) enum LipRefusal {
    /// The wall is nowhere thicker.
    AtMost(f64),
    /// The wall is nowhere thinner.
    AtLeast(f64),
}

/// Whether a rectangle about the axis runs into the passage for which `own` is true, at its corners and half way up its
/// sides.
pub(super) fn runs_into(
    passages: &Caster,
    frame: &Frame,
    half: DVec2,
    own: impl Fn(&CastHit) -> bool,
) -> bool {
    let rim = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, 0.0), (-1.0, 0.0)];
    let from = |q: (f64, f64)| -> DVec3 { frame.point(half * DVec2::from(q), 0.0) };
    rim.into_iter().all(|q| passages.first(from(q), -frame.axis, 0.0).as_ref().is_some_and(&own))
}
