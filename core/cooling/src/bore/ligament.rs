//! Ligaments: the metal between neighbouring bores.

use glam::DVec3;
use std::collections::HashMap;

/// A bore as a cone with round ends about its axis: all of it lies inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hull {
    /// Ends of the axis.
    pub(crate) ends: [DVec3; 2],
    /// Radii there.
    pub(crate) radii: [f64; 2],
}

/// The nearest neighbour of a bore.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Neighbour {
    pub(crate) index: usize,
    /// Metal between the two hulls, mm; negative where they overlap.
    pub(crate) gap: f64,
}

impl Hull {
    /// The hull of a straight bore that does not reach beyond its ends, where other bodies begin: round ends lie within.
    pub(crate) fn inside([from, to]: [DVec3; 2], radius: f64) -> Self {
        let inset = (radius / from.distance(to)).min(0.5);
        Self { ends: [from.lerp(to, inset), to.lerp(from, inset)], radii: [radius; 2] }
    }

    /// Metal to another bore, mm, negative where the two overlap: the distance of the axes less both radii at its feet.
    fn gap(&self, other: &Self) -> f64 {
        let (s, t) = nearest(self.ends, other.ends);
        let at = |hull: &Self, s: f64| hull.ends[0].lerp(hull.ends[1], s);
        let radius = |hull: &Self, s: f64| hull.radii[0] + (hull.radii[1] - hull.radii[0]) * s;
        // The radii vary along the axes: the ends may be nearer than the feet of the shortest distance.
        let trials = [(s, t), (0.0, 0.0), (1.0, 1.0), (s, 1.0), (1.0, t), (s, 0.0), (0.0, t)];
        let gap =
            |(s, t): (f64, f64)| at(self, s).distance(at(other, t)) - radius(self, s) - radius(other, t);
        trials.into_iter().map(gap).fold(f64::INFINITY, f64::min)
    }

    fn reach(&self) -> f64 {
        0.5 * self.ends[0].distance(self.ends[1]) + self.radii[0].max(self.radii[1])
    }
}

/// Parameters in [0, 1] of the points of two segments that are nearest to each other (Ericson, Real-Time Collision
/// Detection, 5.1.9).
fn nearest([p0, p1]: [DVec3; 2], [q0, q1]: [DVec3; 2]) -> (f64, f64) {
    let (d, e, r) = (p1 - p0, q1 - q0, p0 - q0);
    let (a, b, c, f, g) = (d.dot(d), d.dot(e), d.dot(r), e.dot(e), e.dot(r));
    let denominator = a * f - b * b;
    let clamp = |x: f64| if x.is_finite() { x.clamp(0.0, 1.0) } else { 0.0 };
    let s = if denominator > 1e-12 * a * f { clamp((b * g - c * f) / denominator) } else { 0.5 };
    let t = clamp((b * s + g) / f);
    (clamp((b * t - c) / a), t)
}

/// For each bore the nearest among those before and behind it in the list, if there is one within `reach` of it.
pub(crate) fn neighbours(hulls: &[Hull], reach: f64) -> Vec<Option<Neighbour>> {
    let cell = hulls.iter().map(Hull::reach).fold(0.0, f64::max) * 2.0 + reach;
    let middle =
        |hull: &Hull| (0.5 * (hull.ends[0] + hull.ends[1]) / cell).floor().to_array().map(|x| x as i64);
    let mut cells: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    for (i, hull) in hulls.iter().enumerate() {
        cells.entry(middle(hull)).or_default().push(i);
    }
    let nearest = |(i, hull): (usize, &Hull)| {
        let home = middle(hull);
        let mut best: Option<Neighbour> = None;
        for step in 0..27 {
            let at = [home[0] + step % 3 - 1, home[1] + step / 3 % 3 - 1, home[2] + step / 9 - 1];
            for &index in cells.get(&at).into_iter().flatten().filter(|&&j| j != i) {
                let gap = hull.gap(&hulls[index]);
                if gap < reach && best.is_none_or(|b| gap < b.gap) {
                    best = Some(Neighbour { index, gap });
                }
            }
        }
        best
    };
    hulls.iter().enumerate().map(nearest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hull(x: f64, radius: f64) -> Hull {
        Hull { ends: [DVec3::new(x, 0.0, 0.0), DVec3::new(x, 0.0, 2.0)], radii: [radius, radius] }
    }

    #[test]
    fn gaps_are_those_of_cylinders_and_the_nearest_is_found() {
        let hulls = [hull(0.0, 0.4), hull(1.0, 0.4), hull(1.7, 0.4), hull(9.0, 0.1)];
        let found = neighbours(&hulls, 3.0);
        assert!((found[0].unwrap().gap - 0.2).abs() < 1e-15);
        assert_eq!(found[1].unwrap().index, 2);
        assert!((found[2].unwrap().gap + 0.1).abs() < 1e-15);
        assert_eq!(found[3], None);
    }

    #[test]
    fn crossing_axes_overlap_by_both_radii() {
        let a = Hull { ends: [DVec3::new(-1.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 0.0)], radii: [0.2, 0.2] };
        let b = Hull { ends: [DVec3::new(0.0, -1.0, 0.3), DVec3::new(0.0, 1.0, 0.3)], radii: [0.2, 0.2] };
        assert!((a.gap(&b) + 0.1).abs() < 1e-12);
    }
}
