//! The shape of a turn in its box: a ring for every angle.

use super::chart::TurnChart;
use super::closure::{Path, coordinates, paths};
use super::top::{Heights, Top};
use super::{TurnRefusal, TurnSection};
use crate::build::BuildError;
use crate::section::SEGMENTS;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

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
    /// Parameters of the eight segments at which rings are asked for, from 0 to 1.
    pub(crate) nodes: [Vec<f64>; SEGMENTS],
}

/// Distance in t of the two points beside each end of a segment, from which slopes are taken.
pub(super) const STENCIL: f64 = 1e-3;

/// The parameters of a segment with the points of the stencils, increasing.
pub(super) fn stations(nodes: &[f64]) -> Vec<f64> {
    let last = nodes.len() - 1;
    let mut stations = vec![nodes[0], STENCIL, 2.0 * STENCIL];
    stations.extend(&nodes[1..last]);
    stations.extend([1.0 - 2.0 * STENCIL, 1.0 - STENCIL, nodes[last]]);
    stations
}

/// One station of a closure.
#[derive(Clone, Debug)]
struct Station {
    /// As the front and the back chamber go on.
    chambers: [Path; 2],
    /// (eta, zeta) half way round.
    top: DVec2,
}

/// A turn's rings.
#[derive(Clone, Debug)]
pub(crate) struct TurnShape {
    pub(super) chart: TurnChart,
    /// Stations of the closures, empty for the sides.
    closures: [Vec<Station>; SEGMENTS],
    /// For the sides: fractions of the way in x from their first to their last point, in the front and back chamber.
    sides: [Vec<[f64; 2]>; SEGMENTS],
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
        let chart = match TurnChart::new(sections)? {
            Ok(chart) => chart,
            Err(refusal) => return Ok(Err(refusal)),
        };
        let heights = Heights { inner: request.inner, outer: request.outer, radius: request.radius };
        let top = match Top::new(&chart, heights) {
            Ok(top) => top,
            Err(refusal) => return Ok(Err(refusal)),
        };
        let stations = std::array::from_fn(|k| stations(&request.nodes[k]));
        let mut closures: [Vec<Station>; SEGMENTS] = Default::default();
        for k in [1, 2, 3, 5, 6, 7] {
            let ts: &Vec<f64> = &stations[k];
            let both = (paths(&chart, sections, 0, k, ts)?, paths(&chart, sections, 1, k, ts)?);
            let (Some(front), Some(back)) = both else { return Ok(Err(TurnRefusal::Unmapped)) };
            for ((&t, front), back) in ts.iter().zip(front).zip(back) {
                let Some(top) = top.at(k, t) else { return Ok(Err(TurnRefusal::Unmapped)) };
                closures[k].push(Station { chambers: [front, back], top });
            }
        }
        let mut sides: [Vec<[f64; 2]>; SEGMENTS] = Default::default();
        for k in [0, 4] {
            let fractions =
                [0, 1].map(|chamber| side_fractions(&chart, &sections[0], chamber, k, &stations[k]));
            let [Some(front), Some(back)] = fractions else { return Ok(Err(TurnRefusal::Unmapped)) };
            sides[k] = front.into_iter().zip(back).map(|(f, b)| [f, b]).collect();
        }
        let far = |chamber: usize| {
            let outer = closures[5..].iter().flatten();
            outer.map(|s| s.chambers[chamber].at(0.0).x.abs()).fold(0.0, f64::max)
        };
        let widths = [far(0), far(1)];
        let (outer, exponent) = (request.outer, request.exponent);
        Ok(Ok(Self { chart, closures, sides, stations, outer, exponent, widths }))
    }

    /// Polar angle about the wall's end of the ring at `psi`.
    fn polar(&self, psi: f64) -> f64 {
        let half = (0.5 * psi).sin();
        let width = self.widths[0] + (self.widths[1] - self.widths[0]) * half * half;
        (self.outer * psi.sin()).atan2(width * psi.cos())
    }

    /// Points of segment `k` at all its stations, in the ring at `psi`: coordinates in the box.
    pub(super) fn ring(&self, k: usize, psi: f64) -> Vec<DVec3> {
        if !self.closures[k].is_empty() {
            let phi = self.polar(psi);
            return self.closures[k].iter().map(|station| self.closure(k, station, phi)).collect();
        }
        let [from, to] = self.side_ends(k, psi);
        let half = (0.5 * psi).sin();
        let w = half * half;
        let fraction = |[front, back]: &[f64; 2]| front + (back - front) * w;
        self.sides[k].iter().map(|f| from.lerp(to, fraction(f))).collect()
    }

    /// First and last point of a side: where the closures before and after it end.
    fn side_ends(&self, k: usize, psi: f64) -> [DVec3; 2] {
        let phi = self.polar(psi);
        let (before, after) = ((k + SEGMENTS - 1) % SEGMENTS, k + 1);
        let eta = if k == 0 { 1.0 } else { 0.0 };
        let end = |k: usize, station: Option<&Station>| {
            let at = station.map_or(DVec3::ZERO, |s| self.closure(k, s, phi));
            DVec3::new(at.x, eta, at.z)
        };
        [end(before, self.closures[before].last()), end(after, self.closures[after].first())]
    }

    /// A point of a closure at the polar angle `phi`: on the superellipse from the chamber's path to the top.
    fn closure(&self, k: usize, station: &Station, phi: f64) -> DVec3 {
        let exponent = self.exponent_of(k);
        let path = &station.chambers[usize::from(phi > FRAC_PI_2)];
        let (eta_top, height) = (station.top.x, station.top.y);
        let (sin, cos) = (phi.sin().abs(), phi.cos().abs());
        let (rise, run) = (path.at(height).x.abs() * sin, height * cos);
        let norm = (rise.powf(exponent) + run.powf(exponent)).powf(1.0 / exponent);
        let zeta = height * rise / norm;
        let at = path.at(zeta);
        let weight = cos * cos * cos;
        DVec3::new(at.x * run / norm, at.y * weight + eta_top * (1.0 - weight), zeta)
    }

    fn exponent_of(&self, k: usize) -> f64 {
        if k < 4 { 2.0 } else { self.exponent }
    }

    /// Derivative of zeta in psi at the turn's first ring (chamber 0) or last ring (1), at all stations of segment `k`.
    pub(super) fn rise(&self, k: usize, chamber: usize) -> Vec<f64> {
        // With rings turning about the wall's end, zeta grows as x times the polar angle.
        let pace = self.outer / self.widths[chamber] * if chamber == 0 { 1.0 } else { -1.0 };
        let rate = |station: &Station| {
            let path = &station.chambers[chamber];
            path.at(station.top.y).x.abs() * pace
        };
        if !self.closures[k].is_empty() {
            return self.closures[k].iter().map(rate).collect();
        }
        let (before, after) = ((k + SEGMENTS - 1) % SEGMENTS, k + 1);
        let from = self.closures[before].last().map_or(0.0, rate);
        let to = self.closures[after].first().map_or(0.0, rate);
        self.sides[k].iter().map(|f| from + (to - from) * f[chamber]).collect()
    }

    /// Coordinates of the first point of segment `k` in a chamber's end ring.
    pub(super) fn start_of(&self, k: usize, chamber: usize) -> Option<DVec3> {
        self.ring(k, PI * chamber as f64).first().copied()
    }

    /// Flow area of the ring at the fraction `p` of the way round, mm2: the length of its vector area.
    pub(crate) fn area(&self, p: f64) -> f64 {
        let points: Vec<DVec3> = (0..SEGMENTS).flat_map(|k| self.points(k, p)).collect();
        let next = points.iter().cycle().skip(1);
        0.5 * points
            .iter()
            .zip(next)
            .map(|(a, b)| (*a - points[0]).cross(*b - points[0]))
            .sum::<DVec3>()
            .length()
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
        near = coordinates(chart, section, chamber, (k, t), near)?;
        xs.push(near.x);
    }
    let (from, to) = (xs[0], xs[xs.len() - 1]);
    Some(xs.iter().map(|x| (x - from) / (to - from)).collect())
}
