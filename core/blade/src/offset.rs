//! Offsets of a blade: where the surface a given depth inside it crosses a stream surface.

use crate::blade::Blade;
use crate::error::BladeError;
use crate::stream::StreamSurface;
use coolinggen_nurbs::ParametricSurface;
use glam::{DVec2, DVec3};

/// Most steps of the search.
const STEPS: usize = 40;
/// Greatest change of w in a step.
const GREATEST_STEP: f64 = 0.1;

impl Blade {
    /// The profile of the surface that lies `depth[i]` mm inside the blade at `u[i]` (taken modulo 1): points in the
    /// chart of `surface`, each with its foot on the line of that u, so that joints of the blade's regions are joints of
    /// the profile. `w` says where these lines cross `surface` ([`Blade::profile`]); neighbours near each other make it
    /// fastest. Where the foot is past the end of the blade's surface, that is continued straight.
    ///
    /// The profile is not trimmed: where the blade is bent more tightly than the depth it turns back.
    ///
    /// # Errors
    /// [`BladeError::NoCrossing`] where the offset of a line does not cross the stream surface.
    pub fn offset_profile(
        &self,
        surface: &StreamSurface,
        u: &[f64],
        depth: &[f64],
        w: &[f64],
    ) -> Result<Vec<DVec2>, BladeError> {
        let (mut shift, mut station) = (0.0, None);
        let mut out = Vec::with_capacity(u.len());
        for ((&u, &depth), &w) in u.iter().zip(depth).zip(w) {
            let (foot, point) = self.cross_offset(u, depth, surface, w + shift, &mut station)?;
            shift = foot - w;
            out.push(surface.chart_at(point, station));
        }
        Ok(out)
    }

    /// The secant method on the level along the offset of the line of constant u: the foot's w and the point.
    fn cross_offset(
        &self,
        u: f64,
        depth: f64,
        surface: &StreamSurface,
        start: f64,
        station: &mut Option<f64>,
    ) -> Result<(f64, DVec3), BladeError> {
        let u = if (0.0..=1.0).contains(&u) { u } else { u - u.floor() };
        let inward = if self.outward { -depth } else { depth };
        let (_, (low, high)) = self.surface.domain();
        let mut w = start;
        // The w before this one with its level.
        let mut before: Option<(f64, f64)> = None;
        for _ in 0..STEPS {
            let at = w.max(low).min(high);
            let (foot, around, along) = self.surface.first_derivatives(u, at);
            let normal = around.cross(along).normalize();
            let point = foot + along * (w - at) + normal * inward;
            let (level, gradient) = surface.level_near(point, station);
            let size = 1e-12 + 4.0 * f64::EPSILON * (point.x.abs() + point.y.abs() + point.z.abs());
            let slope = before.map_or(gradient.dot(along), |(w0, level0)| (level - level0) / (w - w0));
            let step = -level / slope;
            let stuck = before.is_some_and(|(_, level0)| level.abs() >= level0.abs());
            if level.abs() <= size || (level.abs() < 1e-10 && stuck) {
                return Ok((w, point));
            }
            if !step.is_finite() {
                break;
            }
            before = Some((w, level));
            w += step.clamp(-GREATEST_STEP, GREATEST_STEP);
        }
        let distance = before.map_or(f64::INFINITY, |(_, level)| level.abs());
        Err(BladeError::NoCrossing { u, v: surface.v(), distance })
    }
}
