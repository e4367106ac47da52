//! One B-spline surface near both sides of a blade (section 3.5).

use super::deviation::Deviation;
use super::knots;
use super::medial_surface::ends_met;
use super::sides::Sides;
use coolinggen_nurbs::{Knots, NurbsError, Surface};
use glam::DVec3;

/// What a skin is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SkinSize {
    /// Degree around the blade and along it.
    pub(crate) degree: [usize; 2],
    /// Control points around the blade, from trailing edge to trailing edge, and along it.
    pub(crate) counts: [usize; 2],
    /// Whether knots are put where they serve best, not evenly.
    pub(crate) optimised: bool,
}

/// A B-spline surface S(s, v) near both sides: s runs over [0, 1] from the trailing edge along one side to the leading
/// edge and along the other side back. One surface without a knot line of full multiplicity at the leading edge: both
/// sides have opposite derivatives there (Eq. 27) and one normal.
#[derive(Clone, Debug)]
pub(crate) struct Skin {
    /// The surface.
    pub(crate) surface: Surface<DVec3>,
    /// s at the leading edge.
    pub(crate) nose: f64,
    /// The side that is run through first, backwards: its index in [`Sides`].
    pub(crate) first: usize,
    places: Places,
}

/// How s depends on t, by interpolation between nodes.
#[derive(Clone, Debug)]
struct Places {
    /// Nodes a side.
    count: usize,
    /// s at node `k` from the start; node `count` is the nose.
    s: Vec<f64>,
}

/// Least number of data a side, and data for each control point.
const LEAST: usize = 120;
const DENSITY: usize = 6;
/// Data a side where a tolerance is to be kept.
const FINE: usize = 400;

impl Skin {
    /// The skin of a size, beginning with side `first`.
    pub(crate) fn new(sides: &Sides, first: usize, size: SkinSize) -> Result<Self, NurbsError> {
        let places = Places::new(sides, first, LEAST.max(DENSITY * size.counts[0]));
        let data = Data::new(sides, first, &places);
        let [p, q] = size.degree;
        let mut knots_u = Knots::uniform(p, size.counts[0])?;
        let mut knots_v = Knots::uniform(q, size.counts[1])?;
        if size.optimised {
            knots_u = knots::optimised(knots_u, &places.s, &data.columns())?;
            knots_v = knots::optimised(knots_v, &data.v, &data.rows())?;
        }
        let surface = data.fit(&knots_u, &knots_v, &places.s)?;
        Ok(Self { surface, nose: places.s[places.count], first, places })
    }

    /// The skin beginning with side `first` that is about within `tolerance` (mm) of the sides, its knots inserted
    /// where they are missed.
    pub(crate) fn within(
        sides: &Sides,
        first: usize,
        degree: [usize; 2],
        tolerance: f64,
    ) -> Result<Self, NurbsError> {
        let places = Places::new(sides, first, FINE);
        let data = Data::new(sides, first, &places);
        // Both directions add to the distance.
        let share = 0.4 * tolerance;
        let knots_u = knots::refined(degree[0], &places.s, &data.columns(), share)?;
        let knots_v = knots::refined(degree[1], &data.v, &data.rows(), share)?;
        let surface = data.fit(&knots_u, &knots_v, &places.s)?;
        Ok(Self { surface, nose: places.s[places.count], first, places })
    }

    /// s at `t` of side `k`.
    pub(crate) fn place(&self, k: usize, t: f64) -> f64 {
        self.places.at(k != self.first, t)
    }

    /// Eq. 28 on a grid of `around` points a side and `along` lines.
    pub(crate) fn deviation(
        &self,
        sides: &Sides,
        around: usize,
        along: usize,
    ) -> Result<Deviation, NurbsError> {
        Deviation::of(&self.surface, sides, |k, t| self.place(k, t), around, along)
    }
}

impl Places {
    fn new(sides: &Sides, first: usize, count: usize) -> Self {
        // The mean over some lines of the arc length, as a part of its total.
        let lines = 7;
        let mut s = vec![0.0; 2 * count + 1];
        for j in 0..lines {
            let v = f64::from(j) / f64::from(lines - 1);
            let mut walked = vec![0.0];
            let mut before = sides.point(first, 1.0, v);
            for i in 1..=2 * count {
                let here = side_point(sides, first, count, i, v);
                walked.push(walked[i - 1] + here.distance(before));
                before = here;
            }
            let total = walked[2 * count];
            s.iter_mut().zip(walked).for_each(|(s, w)| *s += w / total / f64::from(lines));
        }
        s[2 * count] = 1.0;
        Self { count, s }
    }

    fn at(&self, second: bool, t: f64) -> f64 {
        let place = if second { 1.0 + t } else { 1.0 - t } * self.count as f64;
        let i = (place as usize).min(2 * self.count - 1);
        self.s[i] + (place - i as f64) * (self.s[i + 1] - self.s[i])
    }
}

/// Node `i` of the way round: backwards along the first side, then along the other.
fn side_point(sides: &Sides, first: usize, count: usize, i: usize, v: f64) -> DVec3 {
    let t = (i as f64 - count as f64) / count as f64;
    if t <= 0.0 { sides.point(first, -t, v) } else { sides.point(1 - first, t, v) }
}

/// Points of the sides on a grid.
struct Data {
    v: Vec<f64>,
    /// `[around][along]`.
    points: Vec<Vec<DVec3>>,
}

impl Data {
    fn new(sides: &Sides, first: usize, places: &Places) -> Self {
        let lines = 48;
        let v: Vec<f64> = (0..=lines).map(|j| f64::from(j) / f64::from(lines)).collect();
        let row = |i: usize| v.iter().map(|&v| side_point(sides, first, places.count, i, v)).collect();
        let points = (0..places.s.len()).map(row).collect();
        Self { v, points }
    }

    /// Some lines of constant v.
    fn columns(&self) -> Vec<Vec<DVec3>> {
        let step = (self.v.len() - 1) / 6;
        (0..self.v.len()).step_by(step).map(|j| self.points.iter().map(|row| row[j]).collect()).collect()
    }

    /// Some lines of constant s.
    fn rows(&self) -> Vec<Vec<DVec3>> {
        let step = (self.points.len() - 1) / 16;
        self.points.iter().step_by(step).cloned().collect()
    }

    fn fit(&self, knots_u: &Knots, knots_v: &Knots, s: &[f64]) -> Result<Surface<DVec3>, NurbsError> {
        let (fit_u, values_u) = ends_met(knots_u, s)?;
        let (fit_v, values_v) = ends_met(knots_v, &self.v)?;
        let points: Vec<DVec3> = self.points.iter().flatten().copied().collect();
        fit_u.surface(&fit_v, &points, &values_u, &values_v)
    }
}
