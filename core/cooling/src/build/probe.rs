//! Thickness of the metal at any point of a passage.

use super::error::BuildError;
use coolinggen_blade::Blade;
use coolinggen_nurbs::ParametricSurface;
use glam::DVec3;

/// Measures distances to the outer surface, starting each search at the nearest of a grid of its points.
pub(crate) struct Probe<'a> {
    blade: &'a Blade,
    grid: Vec<(DVec3, (f64, f64))>,
}

impl<'a> Probe<'a> {
    pub(crate) fn new(blade: &'a Blade) -> Self {
        const AROUND: usize = 96;
        const ALONG: usize = 9;
        let mut grid = Vec::with_capacity(AROUND * ALONG);
        for i in 0..AROUND {
            for j in 0..ALONG {
                let (u, w) = (i as f64 / AROUND as f64, j as f64 / (ALONG - 1) as f64);
                grid.push((blade.surface.point(u, w), (u, w)));
            }
        }
        Self { blade, grid }
    }

    /// Distance into the material, negative outside.
    pub(crate) fn thickness(&self, p: DVec3) -> Result<f64, BuildError> {
        let mut best = (f64::INFINITY, (0.0, 0.0));
        for (q, hint) in &self.grid {
            let d = q.distance_squared(p);
            if d < best.0 {
                best = (d, *hint);
            }
        }
        let foot = self.blade.closest(p, best.1)?;
        let (_, u, w) = self.blade.surface.first_derivatives(foot.u, foot.v);
        let outward = u.cross(w) * if self.blade.outward { 1.0 } else { -1.0 };
        let inside = outward.dot(p - foot.point) <= 0.0;
        Ok(if inside { foot.distance } else { -foot.distance })
    }
}
