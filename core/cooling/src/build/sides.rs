//! The sides of the blade by surface distance: where a row of holes breaks out.

use super::sections::{Grid, Section};
use crate::design::Side;
use crate::plan::RowPlacement;
use coolinggen_blade::Blade;
use coolinggen_nurbs::ParametricSurface;
use glam::{DVec2, DVec3};

/// Lengths along both sides on a set of stream surfaces.
#[derive(Clone, Debug)]
pub(super) struct Sides<'a> {
    blade: &'a Blade,
    grid: &'a Grid,
    sections: &'a [Section],
    /// Length in space from the foremost point to each node, one list a section.
    lengths: Vec<Vec<f64>>,
}

/// A point of the outer surface with its directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfacePoint {
    /// The blade's parameters, u in [0, 1].
    pub(super) at: DVec2,
    pub(super) point: DVec3,
    /// Unit normal out of the blade.
    pub(super) normal: DVec3,
    /// Unit tangent along the stream surface, away from the foremost point.
    pub(super) downstream: DVec3,
    /// Unit tangent across it, towards the tip.
    pub(super) spanwise: DVec3,
}

impl<'a> Sides<'a> {
    pub(super) fn new(blade: &'a Blade, grid: &'a Grid, sections: &'a [Section]) -> Self {
        let lengths = sections.iter().map(|section| lengths(blade, grid, section)).collect();
        Self { blade, grid, sections, lengths }
    }

    /// The point of a side where `placement` says, at span fraction `v`.
    pub(super) fn place(&self, side: Side, placement: &RowPlacement, v: f64) -> SurfacePoint {
        let (u, w) = self.over_span(v, |k| {
            let u = self.parameter(k, side, placement, v);
            (u, self.blade_v(k, u))
        });
        // Along the stream surface: the same span fraction a little before and behind.
        let end = if side == Side::SuctionSide { 1.0 } else { -1.0 };
        let step = 1e-4 * end;
        let w_at = |u: f64| self.over_span(v, |k| (u, self.blade_v(k, u))).1;
        let surface = &self.blade.surface;
        let (point, du, dw) = surface.first_derivatives(u.rem_euclid(1.0), w);
        let along = du * end + dw * ((w_at(u + step) - w_at(u - step)) / (2.0 * step.abs()));
        let outward = if self.blade.outward { 1.0 } else { -1.0 };
        let normal = (du.cross(dw) * outward).normalize();
        let downstream = (along - normal * along.dot(normal)).normalize();
        let across = normal.cross(downstream);
        let spanwise = across * across.dot(dw).signum();
        SurfacePoint { at: DVec2::new(u.rem_euclid(1.0), w), point, normal, downstream, spanwise }
    }

    /// Distance in space between two span fractions along the line that `placement` draws.
    pub(super) fn row_length(&self, side: Side, placement: &RowPlacement, span: [f64; 2]) -> f64 {
        const STEPS: u32 = 16;
        let at = |i: u32| {
            self.place(side, placement, span[0] + (span[1] - span[0]) * f64::from(i) / f64::from(STEPS)).point
        };
        (0..STEPS).map(|i| at(i).distance(at(i + 1))).sum()
    }

    /// The grid's parameter in section k where `placement` lies.
    fn parameter(&self, k: usize, side: Side, placement: &RowPlacement, v: f64) -> f64 {
        let nodes = &self.grid.nodes;
        let (lengths, last) = (&self.lengths[k], nodes.len() - 1);
        let end = if side == Side::SuctionSide { last } else { 0 };
        let whole = lengths[end];
        let distance = match placement {
            RowPlacement::Position(law) => law.at(v) * whole,
            RowPlacement::Distance(law) => law.at(v).min(whole),
            RowPlacement::Camber(law) => {
                let circle = self.sections[k].camber.at(law.at(v));
                return if side == Side::SuctionSide { circle.suction } else { circle.pressure };
            }
        };
        let nose = nodes.partition_point(|&u| u < self.grid.nose);
        let between = |a: usize, b: usize| {
            nodes[a] + (nodes[b] - nodes[a]) * ((distance - lengths[a]) / (lengths[b] - lengths[a]))
        };
        if side == Side::SuctionSide {
            let b = (nose + 1..=last).find(|&i| lengths[i] >= distance).unwrap_or(last);
            between(b - 1, b)
        } else {
            let b = (0..nose).rev().find(|&i| lengths[i] >= distance).unwrap_or(0);
            between(b + 1, b)
        }
    }

    /// The blade's w on section k at the grid's parameter u.
    fn blade_v(&self, k: usize, u: f64) -> f64 {
        let nodes = &self.grid.nodes;
        let i = nodes.partition_point(|&n| n <= u).clamp(1, nodes.len() - 1);
        let (a, b) = (self.sections[k].blade_v[i - 1], self.sections[k].blade_v[i]);
        a + (b - a) * (u - nodes[i - 1]) / (nodes[i] - nodes[i - 1])
    }

    /// A pair of values at span fraction `v`, from those of the four nearest sections (Lagrange).
    fn over_span(&self, v: f64, of: impl Fn(usize) -> (f64, f64)) -> (f64, f64) {
        let n = self.sections.len();
        let behind = self.sections.partition_point(|s| s.stream.v() <= v);
        let first = behind.saturating_sub(2).min(n.saturating_sub(4));
        let range = first..(first + 4).min(n);
        let mut out = (0.0, 0.0);
        for i in range.clone() {
            let x = self.sections[i].stream.v();
            let weight: f64 = (range.clone().filter(|&j| j != i))
                .map(|j| (v - self.sections[j].stream.v()) / (x - self.sections[j].stream.v()))
                .product();
            let (a, b) = of(i);
            out = (out.0 + weight * a, out.1 + weight * b);
        }
        out
    }
}

/// Lengths in space along a section from the foremost point to each node.
fn lengths(blade: &Blade, grid: &Grid, section: &Section) -> Vec<f64> {
    let points: Vec<DVec3> = (grid.nodes.iter().zip(&section.blade_v))
        .map(|(u, w)| blade.surface.point(u.rem_euclid(1.0), *w))
        .collect();
    let nose = grid.nodes.partition_point(|&u| u < grid.nose);
    let mut lengths = vec![0.0; points.len()];
    for i in nose + 1..points.len() {
        lengths[i] = lengths[i - 1] + points[i].distance(points[i - 1]);
    }
    for i in (0..nose).rev() {
        lengths[i] = lengths[i + 1] + points[i].distance(points[i + 1]);
    }
    lengths
}
