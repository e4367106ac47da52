//! How far a B-spline surface is from the sides it stands for (Eq. 28).

use super::sides::TwoSided;
use coolinggen_nurbs::{NurbsError, Surface, project_on_surface};
use glam::DVec3;

/// Distances of points of the sides from the closest points of a surface, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Deviation {
    /// Their mean, e of Eq. 28.
    pub(crate) average: f64,
    /// The greatest.
    pub(crate) greatest: f64,
}

impl Deviation {
    /// Measures on a grid even in t and v, `around` points a side and `along` lines, ends included. `place(k, t)` is
    /// about the s of the closest point.
    pub(crate) fn of(
        surface: &Surface<DVec3>,
        sides: &dyn TwoSided,
        place: impl Fn(usize, f64) -> f64,
        around: usize,
        along: usize,
    ) -> Result<Self, NurbsError> {
        let (mut sum, mut count, mut greatest) = (0.0, 0.0, 0.0f64);
        for j in 0..along {
            let v = j as f64 / (along - 1) as f64;
            for (k, i) in (0..2).flat_map(|k| (0..around).map(move |i| (k, i))) {
                let t = i as f64 / (around - 1) as f64;
                let d = project_on_surface(surface, sides.point(k, t, v), (place(k, t), v), false)?.distance;
                (sum, count, greatest) = (sum + d, count + 1.0, greatest.max(d));
            }
        }
        Ok(Self { average: sum / count, greatest })
    }
}
