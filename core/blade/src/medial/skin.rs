//! One B-spline surface near both sides of a blade (section 3.5).

use super::composition::Composition;
use super::deviation::Deviation;
use super::knots;
use super::medial_surface::{ends_met, points_met};
use super::nearest::{Foot, Freedom, nearest};
use super::sides::{Tip, TwoSided};
use coolinggen_nurbs::{Constraint, ConstraintValue, Knots, LeastSquares, NurbsError, Surface};
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
    /// The side that is run through first, backwards: its index in [`TwoSided`].
    pub(crate) first: usize,
    places: Places,
}

/// How s depends on t: s goes from the nose with t + c t^2 (1 - t)^2 towards either end.
///
/// x grows with t^2 there, so that in t the nose is close to a parabola, which few spans take. c removes the term in t^2
/// of y, which would have opposite signs on the two sides: s then runs over the nose with two continuous derivatives.
/// Where the scales of the sides differ, so do the parts of s, for one speed at the nose.
#[derive(Clone, Debug)]
struct Places {
    /// Data a side.
    count: usize,
    /// s at the data, evenly in t, from end to end; datum `count` is the nose.
    s: Vec<f64>,
}

/// Least number of data a side, and data for each control point.
const LEAST: usize = 120;
const DENSITY: usize = 6;
/// Rounds of putting knots and correcting parameters in turn.
const CORRECTIONS: usize = 4;
/// Lines of constant v.
const LINES: usize = 48;
/// Points a side and lines that a skin of a size is to be close to: for each control point, and the least.
const FEET: [usize; 2] = [3, 2];
const LEAST_FEET: [usize; 2] = [60, 20];
/// Least data a side and lines where a tolerance is to be kept.
const FINE: [usize; 2] = [300, 128];
/// Step of the differences that give derivatives at the tip.
const STEP: f64 = 1e-5;

impl Skin {
    /// The skin of a size, beginning with side `first`.
    pub(crate) fn new(sides: &dyn TwoSided, first: usize, size: SkinSize) -> Result<Self, NurbsError> {
        let places = Places::new(sides, first, LEAST.max(DENSITY * size.counts[0]));
        let data = Data::new(sides, first, &places, LINES);
        let [p, q] = size.degree;
        let (even_u, even_v) = (Knots::uniform(p, size.counts[0])?, Knots::uniform(q, size.counts[1])?);
        let mut best = data.nearest(sides, first, &even_u, &even_v, &places, size)?;
        if size.optimised {
            // Steps lead to the least distance near where they begin: knots put for data at fixed parameters are another
            // place to begin.
            let (mut knots_u, mut moved) = (even_u, places);
            let lines = data.columns();
            for _ in 0..CORRECTIONS {
                knots_u = knots::optimised(knots_u, &moved.s, &lines, &moved.met())?;
                moved.s = knots::corrected(&knots_u, &moved.s, &lines, &moved.met())?;
            }
            let knots_v = knots::optimised(even_v, &data.v, &data.rows(), &data.ends())?;
            let other = data.nearest(sides, first, &knots_u, &knots_v, &moved, size)?;
            if other.2 < best.2 {
                best = other;
            }
        }
        let (surface, places, _) = best;
        Ok(Self { surface, first, places })
    }

    /// The skin beginning with side `first` that is about within `tolerance` (mm) of the sides, its knots inserted
    /// where they are missed. `fineness` times the least data: knots are as dense as the data allow.
    pub(crate) fn within(
        sides: &dyn TwoSided,
        first: usize,
        degree: [usize; 2],
        tolerance: f64,
        fineness: usize,
    ) -> Result<Self, NurbsError> {
        let places = Places::new(sides, first, fineness * FINE[0]);
        let data = Data::new(sides, first, &places, fineness * FINE[1]);
        // Both directions add to the distance.
        let share = 0.4 * tolerance;
        let knots_u = knots::refined(degree[0], &places.s, &data.columns(), &places.met(), share)?;
        let knots_v = knots::refined(degree[1], &data.v, &data.rows(), &data.ends(), share)?;
        let surface = data.fit(&knots_u, &knots_v, &places, true)?;
        Ok(Self { surface, first, places })
    }

    /// The skin that the composition of the sides comes to when its degree is reduced and knots are removed within
    /// `tolerance`, mm.
    pub(crate) fn composed(
        composition: &Composition,
        first: usize,
        degree: [usize; 2],
        tolerance: f64,
    ) -> Result<Self, NurbsError> {
        let places = Places { count: 1, s: vec![0.0, composition.nose, 1.0] };
        Ok(Self { surface: composition.within(degree, tolerance)?, first, places })
    }

    /// s at `t` of side `k`.
    pub(crate) fn place(&self, k: usize, t: f64) -> f64 {
        self.places.at(k != self.first, t)
    }

    /// Eq. 28 on a grid of `around` points a side and `along` lines.
    pub(crate) fn deviation(
        &self,
        sides: &dyn TwoSided,
        around: usize,
        along: usize,
    ) -> Result<Deviation, NurbsError> {
        Deviation::of(&self.surface, sides, |k, t| self.place(k, t), around, along)
    }
}

impl Places {
    fn new(sides: &dyn TwoSided, first: usize, count: usize) -> Self {
        let noses = [sides.nose(first), sides.nose(1 - first)];
        let (speed, bend) = (noses.map(|n| n.0), noses.map(|n| n.1.clamp(-2.0, 2.0)));
        let nose = speed[0] / (speed[0] + speed[1]);
        let along = |k: usize, t: f64| t + bend[k] * (t * (1.0 - t)).powi(2);
        let s = (0..=2 * count).map(|i| {
            let t = (i as f64 - count as f64) / count as f64;
            if t > 0.0 { nose + (1.0 - nose) * along(1, t) } else { nose * (1.0 - along(0, -t)) }
        });
        Self { count, s: s.collect() }
    }

    /// Indices of the data that are met: trailing edge, leading edge, trailing edge.
    fn met(&self) -> [usize; 3] {
        [0, self.count, 2 * self.count]
    }

    /// s at `t` of the side run through first or second, by interpolation.
    fn at(&self, second: bool, t: f64) -> f64 {
        let place = if second { 1.0 + t } else { 1.0 - t } * self.count as f64;
        let i = (place as usize).min(2 * self.count - 1);
        self.s[i] + (place - i as f64) * (self.s[i + 1] - self.s[i])
    }
}

/// Node `i` of the way round: backwards along the first side, then along the other.
fn side_point(sides: &dyn TwoSided, first: usize, count: usize, i: usize, v: f64) -> DVec3 {
    let t = (i as f64 - count as f64) / count as f64;
    if t <= 0.0 { sides.point(first, -t, v) } else { sides.point(1 - first, t, v) }
}

/// Points of the sides on a grid.
struct Data {
    v: Vec<f64>,
    /// `[around][along]`.
    points: Vec<Vec<DVec3>>,
    /// Derivatives in v at v = 1, if there is a tip.
    rates: Vec<DVec3>,
    tip: Option<Tip>,
}

impl Data {
    fn new(sides: &dyn TwoSided, first: usize, places: &Places, lines: usize) -> Self {
        let v: Vec<f64> = (0..=lines).map(|j| j as f64 / lines as f64).collect();
        let t: Vec<f64> = (0..=places.count).map(|i| i as f64 / places.count as f64).collect();
        // Backwards along the first side, then along the other from behind the leading edge.
        let mut points = sides.grid(first, &t, &v);
        points.reverse();
        points.extend(sides.grid(1 - first, &t[1..], &v));
        let tip = sides.tip();
        let rate = |i: usize| {
            // One-sided, exact for cubics.
            let at = |k: f64| side_point(sides, first, places.count, i, 1.0 - k * STEP);
            (at(0.0) * 11.0 - at(1.0) * 18.0 + at(2.0) * 9.0 - at(3.0) * 2.0) / (6.0 * STEP)
        };
        let rates = if tip.is_some() { (0..=2 * places.count).map(rate).collect() } else { Vec::new() };
        Self { v, points, rates, tip }
    }

    /// Some lines of constant v.
    fn columns(&self) -> Vec<Vec<DVec3>> {
        let step = (self.v.len() - 1) / 6;
        // A tip is no line.
        let count = self.v.len() - usize::from(self.tip.is_some());
        (0..count).step_by(step).map(|j| self.points.iter().map(|row| row[j]).collect()).collect()
    }

    /// Some lines of constant s.
    fn rows(&self) -> Vec<Vec<DVec3>> {
        let step = (self.points.len() - 1) / 16;
        self.points.iter().step_by(step).cloned().collect()
    }

    fn ends(&self) -> [usize; 2] {
        [0, self.v.len() - 1]
    }

    /// The best surface that meets both trailing edges and the leading edge, and a tip with its tangent plane; with the
    /// derivatives in v there, too, if `rates` are to be met.
    fn fit(
        &self,
        knots_u: &Knots,
        knots_v: &Knots,
        places: &Places,
        rates: bool,
    ) -> Result<Surface<DVec3>, NurbsError> {
        let (fit_u, values_u) = points_met(knots_u, &places.s, &places.met())?;
        let surface = if rates && self.tip.is_some() {
            let (fit_v, values_v) = self.tip_met(knots_v)?;
            let rows = self.points.iter().zip(&self.rates);
            let points: Vec<DVec3> = rows.flat_map(|(row, rate)| row.iter().chain([rate])).copied().collect();
            fit_u.surface(&fit_v, &points, &values_u, &values_v)?
        } else {
            let (fit_v, values_v) = ends_met(knots_v, &self.v)?;
            let points: Vec<DVec3> = self.points.iter().flatten().copied().collect();
            fit_u.surface(&fit_v, &points, &values_u, &values_v)?
        };
        match &self.tip {
            Some(tip) => self.with_tip(&surface, tip, &fit_u, &values_u, knots_v),
            None => Ok(surface),
        }
    }

    /// A fit along v that meets both ends and the derivative at the tip, which follows the points of a line as data.
    ///
    /// Near the tip the blade is a cone over these derivatives, and at the trailing edge thinner than any tolerance:
    /// fitted to points alone its sides may change places there.
    fn tip_met(&self, knots_v: &Knots) -> Result<(LeastSquares, Vec<ConstraintValue>), NurbsError> {
        let count = self.v.len();
        let parameters: Vec<f64> = self.v.iter().copied().chain([1.0]).collect();
        let weights: Vec<f64> = (0..=count).map(|j| if j < count { 1.0 } else { 0.0 }).collect();
        let constraints = [(0.0, 0), (1.0, 0), (1.0, 1)];
        let constraints = constraints
            .into_iter()
            .map(|(v, order)| Constraint::derivative(knots_v, v, order))
            .collect::<Result<Vec<_>, _>>()?;
        let fit = LeastSquares::new(knots_v.clone(), &parameters, Some(&weights), &constraints, None)?;
        let values = [0, count - 1, count].map(ConstraintValue::Data);
        Ok((fit, values.to_vec()))
    }

    /// The surface with the tangent plane at the tip: heights over it are fitted again, with derivatives in v that are
    /// zero there. So are the trailing edge's lines, across the direction that they leave the tip in.
    fn with_tip(
        &self,
        surface: &Surface<DVec3>,
        tip: &Tip,
        fit_u: &LeastSquares,
        values_u: &[ConstraintValue],
        knots_v: &Knots,
    ) -> Result<Surface<DVec3>, NurbsError> {
        let constraints = [(0.0, 0), (1.0, 0), (1.0, 1)];
        let constraints = constraints
            .into_iter()
            .map(|(v, order)| Constraint::derivative(knots_v, v, order))
            .collect::<Result<Vec<_>, _>>()?;
        let still = LeastSquares::new(knots_v.clone(), &self.v, None, &constraints, None)?;
        let last = self.v.len() - 1;
        let values_v = [ConstraintValue::Data(0), ConstraintValue::Data(last), ConstraintValue::Zero];
        let height = |p: &DVec3| tip.normal.dot(*p - tip.point);
        let heights: Vec<f64> = self.points.iter().flatten().map(height).collect();
        let heights = fit_u.surface(&still, &heights, values_u, &values_v)?;
        let columns = surface.counts().1;
        let mut points = surface.points().to_vec();
        for (p, h) in points.iter_mut().zip(heights.points()) {
            *p += tip.normal * (h - height(p));
        }
        if let Some(edge) = tip.edge {
            let last = points.len() - columns;
            for (at, data) in [(0, &self.points[0]), (last, &self.points[self.points.len() - 1])] {
                let ends = [data[0], data[self.v.len() - 1], DVec3::ZERO];
                let flat = still.curve(data, &ends)?.curve;
                for (p, q) in points[at..at + columns].iter_mut().zip(flat.points()) {
                    *p = *q + edge * edge.dot(*p - *q);
                }
            }
        }
        // What the constraints leave of zero is rounding.
        points.chunks_exact_mut(columns).for_each(|row| tip.meet(row));
        Surface::new(surface.knots_u().clone(), knots_v.clone(), points)
    }

    /// The surface nearest to the sides that is found from the best fit at fixed parameters, its places, and the sum of
    /// squared distances. The lines of the trailing edge stay, and so do a tip and its plane.
    fn nearest(
        &self,
        sides: &dyn TwoSided,
        first: usize,
        knots_u: &Knots,
        knots_v: &Knots,
        places: &Places,
        size: SkinSize,
    ) -> Result<(Surface<DVec3>, Places, f64), NurbsError> {
        let [rows, columns] = size.counts;
        let around = LEAST_FEET[0].max(FEET[0] * rows);
        let along = LEAST_FEET[1].max(FEET[1] * columns);
        // A tip is no line.
        let lines = along + usize::from(self.tip.is_none());
        let foot = |i: usize, j: usize| {
            let t = (i as f64 - around as f64) / around as f64;
            let (s, v) = (places.at(t > 0.0, t.abs()), j as f64 / along as f64);
            Foot { target: side_point(sides, first, around, i, v), s, v, asked: (s, v) }
        };
        let mut feet: Vec<Foot> =
            (0..=2 * around).flat_map(|i| (0..lines).map(move |j| foot(i, j))).collect();
        let freedom = |i: usize, j: usize| match &self.tip {
            _ if i == 0 || i + 1 == rows => Freedom::Held,
            Some(_) if j + 1 == columns => Freedom::Held,
            Some(tip) if j + 2 == columns => Freedom::InPlane(tip.normal),
            _ => Freedom::Free,
        };
        let start = self.fit(knots_u, knots_v, places, false)?;
        let (surface, sum) = nearest(start, &mut feet, lines, &freedom, size.optimised)?;
        let mut points = surface.points().to_vec();
        if let Some(tip) = &self.tip {
            // What the steps leave of zero is rounding.
            points.chunks_exact_mut(columns).for_each(|row| tip.meet(row));
        }
        let surface = Surface::new(surface.knots_u().clone(), knots_v.clone(), points)?;
        let s = feet.chunks_exact(lines).map(|row| row[0].asked.0).collect();
        Ok((surface, Places { count: around, s }, sum))
    }
}

impl Tip {
    /// Puts the last two points of a row to the tip and into its plane, exactly.
    fn meet(&self, row: &mut [DVec3]) {
        let last = row.len() - 1;
        row[last] = self.point;
        row[last - 1] -= self.normal * self.normal.dot(row[last - 1] - self.point);
    }
}
