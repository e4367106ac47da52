//! Points spread over a face.

use crate::domain::FaceDomain;
use coolinggen_nurbs::ParametricSurface;
use glam::DVec2;

/// Cells in each parameter over which the spread is evened out.
const CELLS: usize = 24;

/// Parameters inside a face, spread evenly over its area: see [`FaceDomain::samples`].
#[derive(Clone, Debug)]
pub struct FaceSamples<'a> {
    domain: &'a FaceDomain<'a>,
    /// Share of the area below each row of cells in u, from 0 to 1.
    rows: [f64; CELLS + 1],
    /// The same along v in each row.
    cells: Vec<[f64; CELLS + 1]>,
    next: u32,
    left: usize,
    tries: usize,
}

impl FaceDomain<'_> {
    /// `count` parameters inside the face, the same ones each time: the R2 sequence (Roberts 2018), whose points
    /// keep apart, mapped so that equal areas of the surface get about equally many. Fewer, if the face fills less
    /// than a thousandth of the rectangle around it.
    pub fn samples(&self, count: usize) -> FaceSamples<'_> {
        let (low, high) = self.bounds();
        let surface = &self.face().surface;
        let mut rows = [0.0; CELLS];
        let mut cells = Vec::with_capacity(CELLS);
        for (i, row) in rows.iter_mut().enumerate() {
            let mut areas = [0.0; CELLS];
            for (j, area) in areas.iter_mut().enumerate() {
                let at = DVec2::new(i as f64 + 0.5, j as f64 + 0.5) / CELLS as f64;
                let at = low + (high - low) * at;
                let (_, du, dv) = surface.first_derivatives(at.x, at.y);
                *area = du.cross(dv).length();
            }
            *row = areas.iter().sum();
            cells.push(shares(&areas));
        }
        let tries = count.saturating_mul(1000);
        FaceSamples { domain: self, rows: shares(&rows), cells, next: 0, left: count, tries }
    }
}

/// Running sums of `weights` scaled to end at 1; even steps if the weights are of no use.
fn shares(weights: &[f64; CELLS]) -> [f64; CELLS + 1] {
    let total: f64 = weights.iter().sum();
    let usable = total.is_finite() && total > 0.0;
    let mut out = [0.0; CELLS + 1];
    for i in 0..CELLS {
        out[i + 1] = out[i] + if usable { weights[i] / total } else { 1.0 / CELLS as f64 };
    }
    out
}

/// Cell and place in [0, 1] at which the running sum is `share`.
fn invert(sums: &[f64; CELLS + 1], share: f64) -> (usize, f64) {
    let i = sums[1..CELLS].partition_point(|&s| s <= share);
    let width = sums[i + 1] - sums[i];
    let within = if width > 0.0 { ((share - sums[i]) / width).clamp(0.0, 1.0) } else { 0.5 };
    (i, (i as f64 + within) / CELLS as f64)
}

impl Iterator for FaceSamples<'_> {
    type Item = DVec2;

    fn next(&mut self) -> Option<DVec2> {
        // Powers of the reciprocal of the plastic number.
        const STEP: DVec2 = DVec2::new(0.754_877_666_246_692_8, 0.569_840_290_998_053_3);
        let (low, high) = self.domain.bounds();
        while self.left > 0 && self.tries > 0 {
            self.tries -= 1;
            let r = (DVec2::splat(0.5) + STEP * f64::from(self.next)).fract();
            self.next = self.next.wrapping_add(1);
            let (row, u) = invert(&self.rows, r.x);
            let (_, v) = invert(&self.cells[row], r.y);
            let at = low + (high - low) * DVec2::new(u, v);
            if self.domain.contains(at) {
                self.left -= 1;
                return Some(at);
            }
        }
        None
    }
}
