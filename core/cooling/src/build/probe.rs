//! Thickness of the metal at any point of a passage.

use super::error::BuildError;
use coolinggen_blade::Blade;
use coolinggen_nurbs::{ParametricSurface, Projection};
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

    /// The point of the outer surface nearest to `p`.
    pub(crate) fn foot(&self, p: DVec3) -> Result<Projection, BuildError> {
        let mut best = (f64::INFINITY, (0.0, 0.0));
        for (q, hint) in &self.grid {
            let d = q.distance_squared(p);
            if d < best.0 {
                best = (d, *hint);
            }
        }
        Ok(self.blade.closest(p, best.1)?)
    }

    /// Distance into the material, negative outside.
    pub(crate) fn thickness(&self, p: DVec3) -> Result<f64, BuildError> {
        Ok(self.thickness_at(p, &self.foot(p)?))
    }

    /// Distance into the material of a point whose foot is known.
    pub(crate) fn thickness_at(&self, p: DVec3, foot: &Projection) -> f64 {
        let (_, u, w) = self.blade.surface.first_derivatives(foot.u, foot.v);
        let outward = u.cross(w) * if self.blade.outward { 1.0 } else { -1.0 };
        if outward.dot(p - foot.point) <= 0.0 { foot.distance } else { -foot.distance }
    }
}
