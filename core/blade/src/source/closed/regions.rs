//! Where a closed surface has its edges: joints found on the profile half way up.

use crate::blade::{Blade, FitReport, Region};
use crate::error::BladeError;
use crate::section::{Nose, Ring, farthest_pair, find_noses};
use crate::stream::StreamSurface;
use crate::surface::BladeSurface;
use coolinggen_nurbs::{Knots, ParametricSurface};
use glam::DVec3;

/// Joints of the four regions of a closed surface.
#[derive(Clone, Debug)]
pub(super) struct Joints {
    /// u at which the leading edge begins and ends, in the order leading edge, suction side.
    pub(super) leading: [f64; 2],
    /// u at which the trailing edge begins and ends, equal where it is sharp.
    pub(super) trailing: [f64; 2],
    /// Whether that order runs against u.
    pub(super) reversed: bool,
}

/// A parameter line over which the surface is not smooth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crease {
    pub(super) u: f64,
    /// Angle between the tangents, radians.
    pub(super) angle: f64,
    /// Difference of curvatures times the smaller radius of curvature, 0 to 1.
    pub(super) jump: f64,
}

/// Samples around the profile to begin with.
const SAMPLES: usize = 1200;
/// Between samples the profile turns by less than this, radians.
const TURN: f64 = 0.1;
/// Edges without a jump of curvature reach to where the profile has turned by this from the tip, radians.
const EDGE_TURN: f64 = 1.1;
/// A jump of curvature that ends an edge, and how far from the tip it may be, radians.
const EDGE_JUMP: f64 = 0.3;
const CREASE_TURN: f64 = 1.8;

/// Lines of the closed surface (u in [0, 1]) with a kink or a jump of curvature, seen at `w`; the seam counts as u = 0.
pub(super) fn creases(surface: &BladeSurface, w: f64) -> Vec<Crease> {
    let knots = surface.knots_u();
    let breaks = knots.breaks();
    let rough = |t: f64| knots.multiplicity(t) + 1 >= knots.degree();
    let inner = breaks[1..breaks.len() - 1].iter().copied().filter(|&t| rough(t));
    std::iter::once(0.0)
        .chain(inner)
        .filter_map(|u| {
            let inset = 1e-10;
            let before = surface.derivatives(if u == 0.0 { 1.0 - inset } else { u - inset }, w);
            let after = surface.derivatives(u + inset, w);
            let angle = before.u.angle_between(after.u);
            let bend = |d: DVec3, dd: DVec3| d.cross(dd) / d.length().powi(3);
            let (a, b) = (bend(before.u, before.uu), bend(after.u, after.uu));
            let jump = (a - b).length() / a.length().max(b.length()).max(1e-9);
            (angle > 1e-4 || jump > 0.02).then_some(Crease { u, angle, jump })
        })
        .collect()
}

/// Finds the edges on the profile of the surface at the stream surface given.
pub(super) fn find(
    surface: &BladeSurface,
    stream: &StreamSurface,
    creases: &[Crease],
) -> Result<Joints, BladeError> {
    let profile = Profile::new(surface, stream)?;
    let ring = &profile.ring;
    let (a, b) = farthest_pair(ring);
    let extent = ring.points[a].distance(ring.points[b]);
    let mut noses = [a, b].map(|end| find_noses(ring, end, extent, 1e-5 * extent));
    if profile.middle(&noses[0]) > profile.middle(&noses[1]) {
        noses.reverse();
    }
    let ranges = [&noses[0], &noses[1]].map(|n| profile.range(n, creases));
    let [leading, trailing] = ranges;
    // Along the ring, from tip to tip, the suction side is the longer way.
    let [l, t] = [&noses[0], &noses[1]].map(|nose| profile.tip(nose));
    let follows = ring.length(l, t) >= ring.length(t, l);
    let snap = |position: usize| snapped(profile.u(position), profile.reach(position), creases);
    let order = |(first, last): (usize, usize)| {
        if follows { [snap(first), snap(last)] } else { [snap(last), snap(first)] }
    };
    Ok(Joints { leading: order(leading), trailing: order(trailing), reversed: profile.reversed == follows })
}

/// `u`, or the crease within `reach` of it.
fn snapped(u: f64, reach: f64, creases: &[Crease]) -> f64 {
    let distance = |c: &Crease| {
        let d = (c.u - u).rem_euclid(1.0);
        d.min(1.0 - d)
    };
    let near = creases.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    near.filter(|c| distance(c) <= reach).map_or(u, |c| c.u)
}

/// Points around the surface on a stream surface, counterclockwise.
struct Profile {
    ring: Ring,
    /// Parameters, by the points' origins.
    u: Vec<f64>,
    /// Whether the ring runs against u.
    reversed: bool,
}

impl Profile {
    fn new(surface: &BladeSurface, stream: &StreamSurface) -> Result<Self, BladeError> {
        let blade =
            Blade { surface: surface.clone(), regions: Vec::new(), outward: true, fit: FitReport::default() };
        let mut u = samples(surface.knots_u());
        let mut points: Vec<_> = blade.profile(stream, &u)?.into_iter().map(|(_, q)| q).collect();
        for _ in 0..6 {
            // Halve gaps beside points at which the profile turns too far; kinks stay.
            let n = u.len();
            let ring = Ring { points: points.clone(), origins: (0..n).collect() };
            let wide = |i: usize| ring.turn(i as isize).abs() > TURN;
            let mut more: Vec<f64> = Vec::new();
            for i in 0..n {
                let next = if i + 1 < n { u[i + 1] } else { 1.0 };
                if (wide(i) || wide((i + 1) % n)) && next - u[i] > 1e-5 {
                    more.push(0.5 * (u[i] + next));
                }
            }
            if more.is_empty() {
                break;
            }
            let found = blade.profile(stream, &more)?;
            let mut all: Vec<_> = u.into_iter().zip(points).collect();
            all.extend(more.into_iter().zip(found.into_iter().map(|(_, q)| q)));
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            (u, points) = all.into_iter().unzip();
        }
        // Spans of zero length on the surface would repeat points.
        let mut kept = Ring { points: Vec::new(), origins: Vec::new() };
        for (i, p) in points.iter().enumerate() {
            if kept.points.last().is_none_or(|q| q.distance(*p) > 1e-7) {
                kept.points.push(*p);
                kept.origins.push(i);
            }
        }
        if kept.len() < 8 {
            return Err(BladeError::Nurbs(coolinggen_nurbs::NurbsError::PointCount {
                count: kept.len(),
                expected: 8,
            }));
        }
        let reversed = kept.area() < 0.0;
        if reversed {
            kept.reverse();
        }
        Ok(Self { ring: kept, u, reversed })
    }

    fn u(&self, position: usize) -> f64 {
        self.u[self.ring.origins[position]]
    }

    /// How far a crease may lie from a joint to be meant: the gaps around it.
    fn reach(&self, position: usize) -> f64 {
        let at = |i: isize| self.u[self.ring.origins[self.ring.index(i)]];
        let gap = |a: f64, b: f64| {
            let d = (a - b).rem_euclid(1.0);
            d.min(1.0 - d)
        };
        let i = position as isize;
        3.0 * gap(at(i - 1), at(i)).max(gap(at(i), at(i + 1)))
    }

    /// Position of the middle of a nose.
    fn tip(&self, nose: &Nose) -> usize {
        match nose {
            Nose::Sharp { at } | Nose::Smooth { tip: at } => *at,
            Nose::Arc { first, last, .. } | Nose::Blunt { first, last } => {
                let n = self.ring.len();
                (first + (last + n - first) % n / 2) % n
            }
        }
    }

    /// Position along the flow.
    fn middle(&self, nose: &Nose) -> f64 {
        match nose {
            Nose::Arc { circle, .. } => circle.center.x,
            Nose::Sharp { at } | Nose::Smooth { tip: at } => self.ring.points[*at].x,
            Nose::Blunt { first, last } => 0.5 * (self.ring.points[*first].x + self.ring.points[*last].x),
        }
    }

    /// From the tip of a nose to where it ends: at a crease with a jump of curvature, or where it has turned enough.
    fn walk(&self, tip: usize, step: isize, creases: &[Crease]) -> usize {
        let (mut i, mut turned, mut walked) = (tip as isize, 0.0, 0.0);
        let most = 0.1 * self.ring.perimeter();
        let mut smooth_end = None;
        while turned < CREASE_TURN && walked < most {
            turned += 0.5 * (self.ring.turn(i) + self.ring.turn(i + step));
            walked += self.ring.at(i).distance(self.ring.at(i + step));
            i += step;
            let position = self.ring.index(i);
            if creases.iter().any(|c| c.u == self.u(position) && c.jump > EDGE_JUMP) {
                return position;
            }
            if turned >= EDGE_TURN && smooth_end.is_none() {
                smooth_end = Some(position);
            }
        }
        smooth_end.unwrap_or(self.ring.index(i))
    }

    /// First and last position of a nose.
    fn range(&self, nose: &Nose, creases: &[Crease]) -> (usize, usize) {
        match nose {
            Nose::Arc { first, last, .. } | Nose::Blunt { first, last } => (*first, *last),
            Nose::Sharp { at } => (*at, *at),
            Nose::Smooth { tip } => (self.walk(*tip, -1, creases), self.walk(*tip, 1, creases)),
        }
    }
}

/// Parameters around the surface, every break among them, 1 not.
fn samples(knots: &Knots) -> Vec<f64> {
    let breaks = knots.breaks();
    let each = SAMPLES.div_ceil(breaks.len()).max(4);
    breaks
        .windows(2)
        .flat_map(|w| (0..each).map(move |k| w[0] + (w[1] - w[0]) * k as f64 / each as f64))
        .collect()
}

/// The regions that the joints make once the surface begins with the leading edge and runs in their order.
pub(super) fn regions(joints: &Joints) -> Vec<(Region, [f64; 2])> {
    let start = joints.leading[0];
    let along = |u: f64| {
        let d = if joints.reversed { start - u } else { u - start };
        d.rem_euclid(1.0)
    };
    let (a, b, c) = (along(joints.leading[1]), along(joints.trailing[0]), along(joints.trailing[1]));
    let mut regions = vec![(Region::LeadingEdge, [0.0, a]), (Region::SuctionSide, [a, b])];
    if c > b {
        regions.push((Region::TrailingEdge, [b, c]));
    }
    regions.push((Region::PressureSide, [c, 1.0]));
    regions
}
