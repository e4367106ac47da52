//! Where the nodes of the surface stand around the blade.

use super::reparameter::Reparameter;
use super::{LoftSection, Sheet, Span};

/// Cells a region is judged by.
const CELLS: usize = 240;
/// Greatest change of spacing per length.
const GRADING: f64 = 0.22;

/// The spacing wanted around the blade.
///
/// It follows the curvature: `h = 0.15 mm (R / 2 mm)^(3/4)` keeps a cubic within 1e-6 mm of an arc, at least 32 nodes a
/// half turn, at most a 90th of the outline; on a surface of revolution also little enough for the cubic to stay on it.
pub(super) struct Grid {
    joints: Vec<f64>,
    /// Spacing in u, CELLS a region.
    wanted: Vec<f64>,
}

impl Grid {
    pub(super) fn new(sections: &[LoftSection], maps: &[Reparameter], joints: &[f64]) -> Self {
        let regions = joints.len() - 1;
        let mut grid = Self { joints: joints.to_vec(), wanted: vec![f64::INFINITY; regions * CELLS] };
        for (section, map) in sections.iter().zip(maps) {
            let most = section.outline.length() / 90.0;
            for (i, wanted) in grid.wanted.iter_mut().enumerate() {
                let k = i / CELLS;
                let u = joints[k] + (joints[k + 1] - joints[k]) * ((i % CELLS) as f64 + 0.5) / CELLS as f64;
                let (s, rate) = map.within(k, u);
                let (q, _, curvature) = section.outline.pieces[k].at(s);
                let h = spacing(curvature.abs(), on_cylinder(&section.sheet, q)).min(most);
                *wanted = wanted.min(h / rate);
            }
        }
        grid
    }

    /// Asks for more where spans leave their sheets or outlines too far.
    pub(super) fn refine(&mut self, spans: &[Span]) {
        for span in spans.iter().filter(|s| s.excess() > 1.0) {
            let [a, b] = span.u;
            // A jump in the third derivative, which the data may have, shows with the third power of the spacing.
            let factor = 0.85 / span.excess().cbrt();
            for i in 0..self.wanted.len() {
                let (low, high) = self.cell(i);
                if low <= b && high >= a {
                    self.wanted[i] = self.wanted[i].min((b - a) * factor);
                }
            }
        }
    }

    /// Nodes of each region, ends included.
    pub(super) fn nodes(&self) -> Vec<Vec<f64>> {
        let mut graded = self.wanted.clone();
        let width = |i: usize| self.cell(i).1 - self.cell(i).0;
        grade(&mut graded, &width);
        self.joints
            .windows(2)
            .zip(graded.chunks_exact(CELLS))
            .map(|(w, wanted)| equidistribute(wanted, w[0], w[1]))
            .collect()
    }

    fn cell(&self, i: usize) -> (f64, f64) {
        let (a, b) = (self.joints[i / CELLS], self.joints[i / CELLS + 1]);
        let at = |k: usize| a + (b - a) * k as f64 / CELLS as f64;
        (at(i % CELLS), at(i % CELLS + 1))
    }
}

fn spacing(curvature: f64, cylinder: Option<f64>) -> f64 {
    let nose = 0.15 * (0.5 / curvature).powf(0.75);
    let round = std::f64::consts::PI / (32.0 * curvature);
    let on_surface = cylinder.map_or(f64::INFINITY, |r| {
        // Cubic interpolation leaves 5/384 h^4 |f''''|; towards the axis f'''' is near 3 curvature^2 / r + 1 / r^3.
        let fourth = 3.0 * curvature * curvature / r + 1.0 / (r * r * r);
        (super::OFF_SHEET * 384.0 / 5.0 / fourth).powf(0.25)
    });
    nose.min(round).min(on_surface)
}

/// Radius of the surface the section lies on, if it is curved.
fn on_cylinder(sheet: &Sheet, q: glam::DVec2) -> Option<f64> {
    match sheet {
        Sheet::Stream(s) | Sheet::Chart(s) if s.meridian().is_some() => {
            let p = sheet.point(q);
            Some(p.y.hypot(p.z))
        }
        _ => None,
    }
}

/// Limits the growth of the spacing from cell to cell, around the blade both ways.
fn grade(wanted: &mut [f64], cell: &impl Fn(usize) -> f64) {
    let n = wanted.len();
    for pass in 0..4 {
        for step in 0..n {
            let (i, before) =
                if pass % 2 == 0 { (step, (step + n - 1) % n) } else { (n - 1 - step, (n - step) % n) };
            wanted[i] = wanted[i].min(wanted[before] + GRADING * cell(i));
        }
    }
}

/// Nodes from `start` to `end` whose gaps follow `wanted`.
fn equidistribute(wanted: &[f64], start: f64, end: f64) -> Vec<f64> {
    let cell = (end - start) / wanted.len() as f64;
    let mut sums = vec![0.0];
    for h in wanted {
        sums.push(sums[sums.len() - 1] + cell / h);
    }
    let total = sums[sums.len() - 1];
    let count = (total.ceil() as usize).clamp(4, 1000);
    let mut nodes = vec![start];
    let mut at = 0;
    for i in 1..count {
        let sum = total * i as f64 / count as f64;
        while sums[at + 1] < sum {
            at += 1;
        }
        nodes.push(start + cell * (at as f64 + (sum - sums[at]) / (sums[at + 1] - sums[at])));
    }
    nodes.push(end);
    nodes
}
