//! The shape of a turn in its box: a ring for every angle.

use super::chart::TurnChart;
use super::closure::{Place, Strip, anywhere, coordinates};
use super::top::{Heights, Top};
use super::{Form, TurnRefusal, TurnSection};
use crate::build::BuildError;
use crate::section::SEGMENTS;
use glam::DVec3;
use std::f64::consts::PI;

/// What a turn is made from; lengths in mm.
#[derive(Clone, Debug)]
pub(crate) struct TurnRequest<'a> {
    /// At least four, ordered away from the chambers, from the straight parts' end to the turn's top or beyond.
    pub(crate) sections: &'a [TurnSection<'a>],
    /// Half the wall's thickness: radius of the wall's end.
    pub(crate) inner: f64,
    /// Distance of the outer side from the straight parts' end.
    pub(crate) outer: f64,
    /// Radius of the fillets half way round.
    pub(crate) radius: f64,
    /// Exponent of the outer side.
    pub(crate) exponent: f64,
    /// How the fibres across it run.
    pub(crate) form: Form,
    /// Parameters of the eight segments at which rings are asked for, from 0 to 1.
    pub(crate) nodes: [Vec<f64>; SEGMENTS],
}

/// Distance in t of the two points beside each end of a segment, from which slopes are taken.
pub(super) const STENCIL: f64 = 1e-3;

/// The parameters of a segment with the points of the stencils, increasing.
fn stations(nodes: &[f64]) -> Vec<f64> {
    let last = nodes.len() - 1;
    let mut stations = vec![nodes[0], STENCIL, 2.0 * STENCIL];
    stations.extend(&nodes[1..last]);
    stations.extend([1.0 - 2.0 * STENCIL, 1.0 - STENCIL, nodes[last]]);
    stations
}

/// A turn's rings.
#[derive(Clone, Debug)]
pub(crate) struct TurnShape {
    pub(super) chart: TurnChart,
    /// The inner closure (segments 1 to 3) and the outer one (5 to 7).
    closures: [Vec<Strip>; 2],
    /// The two sides (segments 0 and 4): how far along x their stations are from the first to the last, in the front and
    /// the back chamber.
    sides: [Vec<[f64; 2]>; 2],
    /// Stations of each segment.
    pub(super) stations: [Vec<f64>; SEGMENTS],
    outer: f64,
    exponent: f64,
    /// Widths of the two chambers, wall's mid plane to farthest point.
    widths: [f64; 2],
}

impl TurnShape {
    pub(crate) fn new(request: &TurnRequest<'_>) -> Result<Result<Self, TurnRefusal>, BuildError> {
        let sections = request.sections;
        let chart = match TurnChart::new(sections, request.form)? {
            Ok(chart) => chart,
            Err(refusal) => return Ok(Err(refusal)),
        };
        let heights = Heights { inner: request.inner, outer: request.outer, radius: request.radius };
        let top = match Top::new(&chart, heights) {
            Ok(top) => top,
            Err(refusal) => return Ok(Err(refusal)),
        };
        let stations = std::array::from_fn(|k| stations(&request.nodes[k]));
        let closures = [1, 5].map(|first| Strip::closure(&chart, sections, &top, first, &request.nodes));
        let [inner, outer] = closures;
        let (Some(inner), Some(outer)) = (inner?, outer?) else { return Ok(Err(TurnRefusal::Unmapped)) };
        let mut sides: [Vec<[f64; 2]>; 2] = Default::default();
        for k in [0, 4] {
            let fractions =
                [0, 1].map(|chamber| side_fractions(&chart, &sections[0], chamber, k, &stations[k]));
            let [Some(front), Some(back)] = fractions else { return Ok(Err(TurnRefusal::Unmapped)) };
            sides[k / 4] = front.into_iter().zip(back).map(|(f, b)| [f, b]).collect();
        }
        let far = |chamber: usize| {
            let ends = outer.iter().zip(&stations[5..]);
            let points = ends.flat_map(|(strip, ts)| ts.iter().map(move |&t| strip.chamber_end(chamber, t)));
            points.map(|q| q.x.abs()).fold(0.0, f64::max)
        };
        let widths = [far(0), far(1)];
        let closures = [inner, outer];
        let (outer, exponent) = (request.outer, request.exponent);
        Ok(Ok(Self { chart, closures, sides, stations, outer, exponent, widths }))
    }

    /// The place on the way round at `psi` from 0 to pi.
    fn place(&self, psi: f64) -> Place {
        let half = (0.5 * psi).sin();
        let back = half * half;
        let width = self.widths[0] + (self.widths[1] - self.widths[0]) * back;
        Place { polar: (self.outer * psi.sin()).atan2(width * psi.cos()), back }
    }

    /// The strip of a closure's segment; none for a side.
    fn strip(&self, k: usize) -> Option<&Strip> {
        match k {
            1..=3 => self.closures[0].get(k - 1),
            5..=7 => self.closures[1].get(k - 5),
            _ => None,
        }
    }

    /// Point of a closure's segment `k` at `t`.
    fn closure_point(&self, k: usize, t: f64, place: Place) -> DVec3 {
        let exponent = if k < 4 { 2.0 } else { self.exponent };
        self.strip(k).map_or(DVec3::NAN, |strip| strip.at(t, place, exponent))
    }

    /// Points of segment `k` at all its stations, in the ring at `psi`: coordinates in the box.
    fn ring(&self, k: usize, psi: f64) -> Vec<DVec3> {
        let place = self.place(psi);
        if self.strip(k).is_some() {
            return self.stations[k].iter().map(|&t| self.closure_point(k, t, place)).collect();
        }
        let (before, after) = ((k + SEGMENTS - 1) % SEGMENTS, k + 1);
        let mut from = self.closure_point(before, 1.0, place);
        let mut to = self.closure_point(after, 0.0, place);
        // On the side itself, to the last bit.
        (from.y, to.y) = if k == 0 { (1.0, 1.0) } else { (0.0, 0.0) };
        let fraction = |[front, back]: &[f64; 2]| front + (back - front) * place.back;
        self.sides[k / 4].iter().map(|f| from.lerp(to, fraction(f))).collect()
    }

    /// Derivative of zeta in psi at the turn's first ring (chamber 0) or last ring (1), at all stations of segment `k`.
    pub(super) fn rise(&self, k: usize, chamber: usize) -> Vec<f64> {
        // With rings turning about the wall's end, zeta grows as x times the polar angle.
        let pace = self.outer / self.widths[chamber] * if chamber == 0 { 1.0 } else { -1.0 };
        let rate = |k: usize, t: f64| self.strip(k).map_or(f64::NAN, |strip| strip.rise(chamber, t) * pace);
        if self.strip(k).is_some() {
            return self.stations[k].iter().map(|&t| rate(k, t)).collect();
        }
        let (from, to) = (rate((k + SEGMENTS - 1) % SEGMENTS, 1.0), rate(k + 1, 0.0));
        self.sides[k / 4].iter().map(|f| from + (to - from) * f[chamber]).collect()
    }

    /// Coordinates of the stations of segment `k` in a chamber's end ring.
    pub(super) fn end_ring(&self, k: usize, chamber: usize) -> Vec<DVec3> {
        self.ring(k, PI * chamber as f64)
    }

    /// Flow area of the ring at the fraction `p` of the way round, mm2: the length of its vector area.
    pub(crate) fn area(&self, p: f64) -> f64 {
        let points: Vec<DVec3> = (0..SEGMENTS).flat_map(|k| self.points(k, p)).collect();
        let next = points.iter().cycle().skip(1);
        let fan = points.iter().zip(next).map(|(a, b)| (*a - points[0]).cross(*b - points[0]));
        0.5 * fan.sum::<DVec3>().length()
    }

    /// Width of the passage at the outer side above the wall's end, mm.
    pub(crate) fn width(&self) -> f64 {
        let at = |eta: f64| self.chart.point(DVec3::new(0.0, eta, self.outer));
        at(1.0).distance(at(0.0))
    }

    /// Points in space of segment `k` in the ring at the fraction `p` of the way round.
    pub(super) fn points(&self, k: usize, p: f64) -> Vec<DVec3> {
        self.ring(k, p * PI).into_iter().map(|q| self.chart.point(q)).collect()
    }
}

/// How far along x the points of a side are from its first to its last, in the chamber's end ring.
fn side_fractions(
    chart: &TurnChart,
    section: &TurnSection<'_>,
    chamber: usize,
    k: usize,
    stations: &[f64],
) -> Option<Vec<f64>> {
    let sign = if chamber == 0 { -1.0 } else { 1.0 };
    // Sides run from the outer to the inner end on the suction side, back on the pressure side.
    let start = if k == 0 { DVec3::new(5.0 * sign, 1.0, 0.0) } else { DVec3::new(sign, 0.0, 0.0) };
    let mut near = start;
    let mut xs = Vec::with_capacity(stations.len());
    for &t in stations {
        near = coordinates(chart, section, chamber, (k, t), near)
            .or_else(|| anywhere(chart, section, chamber, (k, t), 0.0).filter(|_| xs.is_empty()))?;
        xs.push(near.x);
    }
    let (from, to) = (xs[0], xs[xs.len() - 1]);
    Some(xs.iter().map(|x| (x - from) / (to - from)).collect())
}
