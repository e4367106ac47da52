//! A segment of a closure in the box of the turn: what the chambers would be beyond the straight parts' end, what the
//! turn is half way round, and the rings between.

use super::chart::TurnChart;
use super::pace::Pace;
use super::top::Top;
use super::{TurnSection, mirrored};
use crate::build::BuildError;
use coolinggen_nurbs::{Curve, Interpolator, ParametricCurve, ParametricSurface, Surface};
use glam::{DVec2, DVec3};

/// One segment of a closure.
#[derive(Clone, Debug)]
pub(super) struct Strip {
    /// (x, eta) over (t, zeta): the front and the back chamber, going on.
    chambers: [Surface<DVec2>; 2],
    /// (eta, zeta) over t, half way round.
    top: Curve<DVec2>,
    /// Of the front chamber, the back chamber and the top.
    paces: [Pace; 3],
}

/// A place on the way round.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Polar angle about the wall's end, from 0 at the front chamber to pi at the back chamber.
    pub(super) polar: f64,
    /// Share of the back chamber in how segments are run through.
    pub(super) back: f64,
}

impl Strip {
    /// The three segments from `first` on (1 inner, 5 outer); none where the box does not reach them.
    pub(super) fn closure(
        chart: &TurnChart,
        sections: &[TurnSection<'_>],
        top: &Top<'_>,
        first: usize,
        nodes: &[Vec<f64>],
    ) -> Result<Option<Vec<Self>>, BuildError> {
        let mut parts = Vec::with_capacity(3);
        for k in first..first + 3 {
            let front = chamber_strip(chart, sections, 0, k, &nodes[k])?;
            let back = chamber_strip(chart, sections, 1, k, &nodes[k])?;
            let (Some(front), Some(back), Some(top)) = (front, back, top_strip(top, k)?) else {
                return Ok(None);
            };
            parts.push(([front, back], top));
        }
        let speeds = |speed: &dyn Fn(usize, f64) -> f64| [0, 1, 2].map(|k| [speed(k, 0.0), speed(k, 1.0)]);
        let in_chamber = |chamber: usize| {
            Pace::of_three(speeds(&|k, t| {
                let surface: &Surface<DVec2> = &parts[k].0[chamber];
                let (at, slope, _) = surface.first_derivatives(t, 0.0);
                chart.speed(DVec3::new(at.x, at.y, 0.0), DVec3::new(slope.x, slope.y, 0.0))
            }))
        };
        let above = Pace::of_three(speeds(&|k, t| {
            let [at, slope, _] = parts[k].1.derivatives(t);
            chart.speed(DVec3::new(0.0, at.x, at.y), DVec3::new(0.0, slope.x, slope.y))
        }));
        let (front, back) = (in_chamber(0), in_chamber(1));
        let strips = parts.into_iter().enumerate().map(|(k, (chambers, top))| Self {
            chambers,
            top,
            paces: [front[k], back[k], above[k]],
        });
        Ok(Some(strips.collect()))
    }

    /// (x, eta) of a chamber's ring at the straight parts' end.
    pub(super) fn chamber_end(&self, chamber: usize, t: f64) -> DVec2 {
        self.chambers[chamber].point(t, 0.0)
    }

    /// The chamber's x at the height where the point `t` of its ring passes over the wall's end, by magnitude: how fast
    /// the point rises per polar angle where it leaves the chamber.
    pub(super) fn rise(&self, chamber: usize, t: f64) -> f64 {
        let top = self.top.point(self.paces[2].inverse(self.paces[chamber].at(t)));
        self.chambers[chamber].point(t, top.y).x.abs()
    }

    /// The point of the ring at a place: on the superellipse from the chamber, going on, to the top.
    pub(super) fn at(&self, t: f64, place: Place, exponent: f64) -> DVec3 {
        let s = self.paces[0].at(t) * (1.0 - place.back) + self.paces[1].at(t) * place.back;
        let top = self.top.point(self.paces[2].inverse(s));
        let chamber = usize::from(place.polar > std::f64::consts::FRAC_PI_2);
        let surface = &self.chambers[chamber];
        let t = self.paces[chamber].inverse(s);
        let (sin, cos) = (place.polar.sin().abs(), place.polar.cos().abs());
        let (rise, run) = (surface.point(t, top.y).x.abs() * sin, top.y * cos);
        let norm = (rise.powf(exponent) + run.powf(exponent)).powf(1.0 / exponent);
        let zeta = top.y * rise / norm;
        let at = surface.point(t, zeta);
        // Where the closure still stands at its full x it keeps the chamber's form, which the shell bounds.
        let share = run / norm;
        let weight = share * share * share;
        DVec3::new(at.x * share, at.y * weight + top.x * (1.0 - weight), zeta)
    }
}

/// Chart point of segment `k` of the turn at `t`, as the front (0) or back (1) chamber has it in a section.
fn ring_point(section: &TurnSection<'_>, chamber: usize, k: usize, t: f64) -> DVec2 {
    let ring = &section.rings[chamber];
    match chamber {
        0 => ring.segments[k].evaluate(section.outline, t).0,
        _ => ring.segments[mirrored(k)].evaluate(section.outline, 1.0 - t).0,
    }
}

/// Coordinates in the box of segment `k` of the chamber's ring at `t` in a section, found from coordinates nearby.
pub(super) fn coordinates(
    chart: &TurnChart,
    section: &TurnSection<'_>,
    chamber: usize,
    (k, t): (usize, f64),
    near: DVec3,
) -> Option<DVec3> {
    let point = section.stream.to_space(ring_point(section, chamber, k, t));
    chart.inverse(point, near)
}

/// As [`coordinates`], searched for from all over the chamber's half of the box.
pub(super) fn anywhere(
    chart: &TurnChart,
    section: &TurnSection<'_>,
    chamber: usize,
    at: (usize, f64),
    zeta: f64,
) -> Option<DVec3> {
    const STEPS: u32 = 40;
    let far = chart.extent[chamber];
    let starts =
        (0..=STEPS).flat_map(|i| [0.05, 0.35, 0.65, 0.95].map(|eta| (f64::from(i) / f64::from(STEPS), eta)));
    starts
        .filter_map(|(share, eta)| {
            coordinates(chart, section, chamber, at, DVec3::new(far * share, eta, zeta))
        })
        .find(|q| (-0.01..=1.01).contains(&q.y) && q.x * far > 0.0)
}

/// Segment `k` of a chamber in all sections.
fn chamber_strip(
    chart: &TurnChart,
    sections: &[TurnSection<'_>],
    chamber: usize,
    k: usize,
    nodes: &[f64],
) -> Result<Option<Surface<DVec2>>, BuildError> {
    let (along, across) = (Interpolator::new(3, nodes)?, Interpolator::new(3, &chart.levels)?);
    let mut curves = Vec::with_capacity(sections.len());
    // About where the segment begins; every point after it lies near the one before.
    let far = if k < 4 { 1.0 } else { 5.0 };
    let side = if chamber == 0 { -far } else { far };
    for (section, &zeta) in sections.iter().zip(&chart.levels) {
        let mut near = DVec3::new(side, 0.5, zeta);
        let mut points = Vec::with_capacity(nodes.len());
        for &t in nodes {
            let found = coordinates(chart, section, chamber, (k, t), near)
                .or_else(|| (t == 0.0).then(|| anywhere(chart, section, chamber, (k, t), zeta)).flatten());
            let Some(q) = found else { return Ok(None) };
            points.push(q.truncate());
            near = q;
        }
        curves.push(along.curve(&points)?);
    }
    Ok(Some(across.loft(&curves)?))
}

/// Segment `k` half way round.
fn top_strip(top: &Top<'_>, k: usize) -> Result<Option<Curve<DVec2>>, BuildError> {
    const SPANS: u32 = 24;
    let nodes: Vec<f64> = (0..=SPANS).map(|i| f64::from(i) / f64::from(SPANS)).collect();
    let points: Option<Vec<DVec2>> = nodes.iter().map(|&t| top.at(k, t)).collect();
    let Some(points) = points else { return Ok(None) };
    Ok(Some(Interpolator::new(3, &nodes)?.curve(&points)?))
}
