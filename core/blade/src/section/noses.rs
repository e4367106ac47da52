//! The two ends of a section: circular, smooth, sharp or blunt.

use super::circle::Circle;
use super::ring::Ring;
use glam::DVec2;

/// What an end of a section is. Indices are positions in the ring, `first` before `last` as it runs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Nose {
    /// A circular arc that meets both sides with a jump of curvature.
    Arc { circle: Circle, first: usize, last: usize },
    /// The two sides meet in a kink.
    Sharp { at: usize },
    /// Two corners with a base between.
    Blunt { first: usize, last: usize },
    /// Rounded, without such jumps; `tip` is the most curved point.
    Smooth { tip: usize },
}

/// A corner is a point at which the polygon turns by more than this, radians.
pub(crate) const CORNER: f64 = 0.96;
/// Circular noses turn by at least this.
const LEAST_ARC: f64 = 0.7;
/// Outside the arc the curvature is at most this fraction of the arc's.
const JUMP: f64 = 0.6;
/// Noses are looked for within this fraction of the greatest extent from an end.
const NEIGHBOURHOOD: f64 = 0.2;

/// The two points of the ring farthest from each other.
pub(crate) fn farthest_pair(ring: &Ring) -> (usize, usize) {
    let n = ring.len();
    let stride = n.div_ceil(500);
    let mut best = (0.0, 0, n / 2);
    for i in (0..n).step_by(stride) {
        for j in (i + 1..n).step_by(stride) {
            let d = ring.points[i].distance_squared(ring.points[j]);
            if d > best.0 {
                best = (d, i, j);
            }
        }
    }
    let mut pair = (best.1, best.2);
    // Settle between the points skipped.
    for _ in 0..4 {
        pair.1 = farthest_from(ring, ring.points[pair.0]);
        pair.0 = farthest_from(ring, ring.points[pair.1]);
    }
    pair
}

/// The point of the ring farthest from `p`.
pub(crate) fn farthest_from(ring: &Ring, p: DVec2) -> usize {
    let far = |i: &usize| ring.points[*i].distance_squared(p);
    (0..ring.len()).max_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0)
}

/// Recognises the nose around point `end` of a counterclockwise ring; `extent` is the section's greatest extent and
/// `tolerance` how far in mm points may lie off a circle.
pub(crate) fn find(ring: &Ring, end: usize, extent: f64, tolerance: f64) -> Nose {
    let around = neighbourhood(ring, end, NEIGHBOURHOOD * extent);
    let corners: Vec<isize> = around.clone().filter(|&i| ring.turn(i).abs() > CORNER).collect();
    match corners[..] {
        [] => {}
        [at] => return Nose::Sharp { at: ring.index(at) },
        [first, .., last] => return Nose::Blunt { first: ring.index(first), last: ring.index(last) },
    }
    // Arcs that are exact but for rounding count in any case.
    if let Some(arc) = best_arc(ring, around.clone(), tolerance.max(1e-6)) {
        return arc;
    }
    Nose::Smooth { tip: ring.index(most_curved(ring, around, 0.02 * extent)) }
}

/// Positions within `reach` along the ring from `end`, as a contiguous range around it.
fn neighbourhood(ring: &Ring, end: usize, reach: f64) -> std::ops::RangeInclusive<isize> {
    let end = end as isize;
    let most = ring.len() as isize / 3;
    let walk = |step: isize| {
        let (mut i, mut length) = (end, 0.0);
        while (i - end).abs() < most {
            length += ring.at(i).distance(ring.at(i + step));
            if length > reach {
                break;
            }
            i += step;
        }
        i
    };
    walk(-1)..=walk(1)
}

/// The point around which the polygon turns most within `window` mm to either side.
fn most_curved(ring: &Ring, around: std::ops::RangeInclusive<isize>, window: f64) -> isize {
    let turned = |i: isize| {
        let near = |step: isize| {
            let (mut j, mut sum) = (i + step, 0.0);
            for _ in 0..ring.len() / 4 {
                let d = ring.at(j).distance(ring.at(i));
                if d >= window {
                    break;
                }
                sum += ring.turn(j) * (1.0 - d / window);
                j += step;
            }
            sum
        };
        ring.turn(i) + near(-1) + near(1)
    };
    let (low, high) = (*around.start(), *around.end());
    around.max_by(|a, b| turned(*a).total_cmp(&turned(*b))).unwrap_or((low + high) / 2)
}

fn best_arc(ring: &Ring, around: std::ops::RangeInclusive<isize>, tolerance: f64) -> Option<Nose> {
    let mut best: Option<(f64, Nose)> = None;
    let mut next = *around.start();
    while next <= *around.end() {
        let seed = next;
        next += 1;
        let Some((circle, first, last)) = grow(ring, seed, tolerance) else { continue };
        next = next.max(last);
        let angle: f64 = (first + 1..last).map(|i| ring.turn(i)).sum::<f64>()
            + 0.5 * (ring.at(first).distance(ring.at(first + 1)) + ring.at(last).distance(ring.at(last - 1)))
                / circle.radius;
        // Curvature right outside the arc.
        let outside = ring.curvature(first - 1).max(ring.curvature(last + 1)) * circle.radius;
        if angle >= LEAST_ARC && outside <= JUMP && best.as_ref().is_none_or(|(b, _)| angle > *b) {
            let nose = Nose::Arc { circle, first: ring.index(first), last: ring.index(last) };
            best = Some((angle, nose));
        }
    }
    best.map(|(_, nose)| nose)
}

/// The longest run of points around `seed` on one convex circle, at least five.
fn grow(ring: &Ring, seed: isize, tolerance: f64) -> Option<(Circle, isize, isize)> {
    let points = |first: isize, last: isize| (first..=last).map(|i| ring.at(i)).collect::<Vec<_>>();
    let fits = |first: isize, last: isize| {
        let run = points(first, last);
        let circle = Circle::fit(&run)?;
        run.iter().all(|p| circle.miss(*p) <= tolerance).then_some(circle)
    };
    let (mut first, mut last) = (seed - 2, seed + 2);
    let convex = (first + 1..last).all(|i| ring.turn(i) > 0.0);
    let mut circle = fits(first, last).filter(|_| convex)?;
    // A nose that is not round enough to reach the least angle on a third of the ring is none.
    let most = (ring.len() / 2) as isize;
    if (first + 1..last).map(|i| ring.turn(i)).sum::<f64>() < 1e-4 {
        return None;
    }
    let (mut open_first, mut open_last) = (true, true);
    while (open_first || open_last) && last - first < most {
        if open_last {
            match fits(first, last + 1) {
                Some(c) => (circle, last) = (c, last + 1),
                None => open_last = false,
            }
        }
        if open_first {
            match fits(first - 1, last) {
                Some(c) => (circle, first) = (c, first - 1),
                None => open_first = false,
            }
        }
    }
    // The tolerance let a few points of the sides in: keep those that are as close as the rest.
    let margin = (last - first) / 8 + 1;
    if last - first - 2 * margin >= 4 {
        let core = points(first + margin, last - margin);
        let inner = Circle::fit(&core)?;
        let noise = core.iter().map(|p| inner.miss(*p)).fold(0.0, f64::max);
        let close = (2.5 * noise).max(1e-7 * inner.radius);
        while inner.miss(ring.at(first)) > close && first < seed - 2 {
            first += 1;
        }
        while inner.miss(ring.at(last)) > close && last > seed + 2 {
            last -= 1;
        }
        circle = Circle::fit(&points(first, last))?;
    }
    (last - first >= 4).then_some((circle, first, last))
}
