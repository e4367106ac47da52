//! The frame of a profile's pressure-side bitangent: the straight edge that a workshop lays on a vane.

use super::error::BuildError;
use coolinggen_blade::{Blade, StreamSurface};
use glam::DVec2;

/// Origin at the leading-edge extreme on the bitangent, unit axes; chart coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct BitangentFrame {
    pub(super) origin: DVec2,
    /// Normal to the bitangent, towards the suction side.
    pub(super) u: DVec2,
    /// Along the bitangent, from leading to trailing edge.
    pub(super) v: DVec2,
}

impl BitangentFrame {
    /// The origin, or the point of the bitangent across from `from`.
    pub(super) fn origin_at(&self, from: Option<[f64; 2]>) -> DVec2 {
        from.map_or(self.origin, |from| {
            self.origin + self.v * (DVec2::from_array(from) - self.origin).dot(self.v)
        })
    }
}

/// The frame in which NASA CR-168015 gives the holes of the C3X: the longest edge of the profile's convex hull is
/// the straight edge; V = 0 lies at the extreme of the profile along it.
pub(super) fn bitangent_frame(blade: &Blade, stream: &StreamSurface) -> Result<BitangentFrame, BuildError> {
    const SAMPLES: usize = 1500;
    let at = |u: &[f64]| -> Result<Vec<DVec2>, BuildError> {
        Ok(blade.profile(stream, u)?.into_iter().map(|(_, q)| q).collect())
    };
    let parameters: Vec<f64> = (0..SAMPLES).map(|i| i as f64 / SAMPLES as f64).collect();
    let points = at(&parameters)?;
    let hull = convex_hull(&points);
    let edge = (0..hull.len()).map(|i| (hull[i], hull[(i + 1) % hull.len()]));
    let length = |&(a, b): &(usize, usize)| points[a].distance_squared(points[b]);
    let (a, b) = edge.max_by(|x, y| length(x).total_cmp(&length(y))).unwrap_or((0, 0));
    // The suction side's u is below a half, the leading edge's near zero: the edge's end nearer u = 0 is its front.
    let from_nose = |i: usize| parameters[i].min(1.0 - parameters[i]);
    let (front, back) = if from_nose(a) < from_nose(b) { (a, b) } else { (b, a) };
    let (mut front_u, mut back_u) = (parameters[front], parameters[back]);
    let (mut front_q, mut back_q) = (points[front], points[back]);
    let inside = points.iter().sum::<DVec2>() / SAMPLES as f64;
    let outward = |front: DVec2, back: DVec2| {
        let normal = (back - front).normalize().perp();
        normal * (front - inside).dot(normal).signum()
    };
    // Touching points to rounding: the profile's extreme along the normal, on ever finer samples.
    let mut width = 1.5 / SAMPLES as f64;
    for _ in 0..5 {
        let normal = outward(front_q, back_q);
        for (u, q) in [(&mut front_u, &mut front_q), (&mut back_u, &mut back_q)] {
            (*u, *q) = extreme(&at, *u, width, normal)?;
        }
        width /= 10.0;
    }
    let v = (back_q - front_q).normalize();
    let u = -outward(front_q, back_q);
    let first = (0..SAMPLES).min_by(|&i, &j| points[i].dot(v).total_cmp(&points[j].dot(v))).unwrap_or(0);
    let (mut nose_u, mut nose) = (parameters[first], points[first]);
    let mut width = 1.5 / SAMPLES as f64;
    for _ in 0..5 {
        (nose_u, nose) = extreme(&at, nose_u, width, -v)?;
        width /= 10.0;
    }
    let origin = front_q + v * (nose - front_q).dot(v);
    Ok(BitangentFrame { origin, u, v })
}

/// The profile's farthest point along `direction` within `width` of the parameter `u`.
fn extreme(
    at: &impl Fn(&[f64]) -> Result<Vec<DVec2>, BuildError>,
    u: f64,
    width: f64,
    direction: DVec2,
) -> Result<(f64, DVec2), BuildError> {
    let parameters: Vec<f64> = (-20..=20).map(|i| u + width * f64::from(i) / 20.0).collect();
    let points = at(&parameters)?;
    let far =
        (0..points.len()).max_by(|&i, &j| points[i].dot(direction).total_cmp(&points[j].dot(direction)));
    let i = far.unwrap_or(20);
    Ok((parameters[i], points[i]))
}

/// Indices of the convex hull, counterclockwise (Andrew's monotone chain).
fn convex_hull(points: &[DVec2]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&i, &j| points[i].x.total_cmp(&points[j].x).then(points[i].y.total_cmp(&points[j].y)));
    let turn = |a: usize, b: usize, c: usize| (points[b] - points[a]).perp_dot(points[c] - points[a]);
    let chain = |order: &mut dyn Iterator<Item = usize>| {
        let mut chain: Vec<usize> = Vec::new();
        for i in order {
            while chain.len() >= 2 && turn(chain[chain.len() - 2], chain[chain.len() - 1], i) <= 0.0 {
                chain.pop();
            }
            chain.push(i);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut order.iter().copied());
    hull.extend(chain(&mut order.iter().rev().copied()));
    hull
}
