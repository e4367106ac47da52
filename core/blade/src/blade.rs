//! The blade: one closed surface, parted into named regions.

use crate::error::BladeError;
use crate::stream::StreamSurface;
use crate::surface::BladeSurface;
use coolinggen_nurbs::{ParametricSurface, Projection, project_on_surface};
use glam::{DVec2, DVec3};
use serde::Serialize;

/// A part of the blade's outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Region {
    /// The nose that meets the flow.
    LeadingEdge,
    /// The convex side.
    SuctionSide,
    /// The end that the flow leaves; absent where it is sharp.
    TrailingEdge,
    /// The concave side.
    PressureSide,
}

impl Region {
    /// Its name in designs, face names and reports, e.g. `leading_edge`.
    pub fn name(self) -> &'static str {
        match self {
            Self::LeadingEdge => "leading_edge",
            Self::SuctionSide => "suction_side",
            Self::TrailingEdge => "trailing_edge",
            Self::PressureSide => "pressure_side",
        }
    }
}

/// How the surface compares with what the source gave.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FitReport {
    /// Points the source gave; 0 for sources that give a surface.
    pub points: usize,
    /// Greatest distance of a given point from the surface, mm.
    pub greatest_distance_mm: f64,
    /// JSON pointer to that point, relative to the blade; empty if there are no points.
    pub worst_point: String,
    /// Mean distance from the surface of a grid of points of the sides that it stands for, mm (medial sources: Eq. 28 of
    /// their paper); none for other sources.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub average_distance_mm: Option<f64>,
    /// Greatest distance of the surface's section curves from their stream surfaces, mm (sources with sections on
    /// stream surfaces).
    pub off_stream_surface_mm: f64,
    /// Spans of the surface around the blade.
    pub spans_around: usize,
    /// Spans of the surface along the blade.
    pub spans_along: usize,
    /// What was decided about the data, in sentences: sections put in order, edges found, patches joined.
    pub notes: Vec<String>,
}

/// A blade: a surface `B(u, w)`, closed in u over [0, 1], which reaches about 6 % of the span past hub and shroud, or ends
/// in a point, its tip ([`BladeSurface::tip`]).
///
/// w is close to the span fraction but not the same: [`Blade::crossing`] finds where a line of constant u meets a
/// stream surface. u runs around in the order leading edge, suction side, trailing edge, pressure side and is 0 at the
/// joint where the leading edge begins. The surface is twice continuously differentiable inside each region.
#[derive(Clone, Debug, PartialEq)]
pub struct Blade {
    /// The surface.
    pub surface: BladeSurface,
    /// Regions with their ranges of u, in order, from 0 to 1 without gaps.
    pub regions: Vec<(Region, [f64; 2])>,
    /// Whether `dB/du cross dB/dw` points out of the blade; the order of regions decides it.
    pub outward: bool,
    /// How the surface compares with what the source gave.
    pub fit: FitReport,
}

impl Blade {
    /// The region at `u`, taken modulo 1; at a joint the one that begins there.
    pub fn region_at(&self, u: f64) -> Region {
        let u = u - u.floor();
        let at = self.regions.iter().rev().find(|(_, range)| range[0] <= u).or(self.regions.first());
        at.map_or(Region::LeadingEdge, |(region, _)| *region)
    }

    /// The range of u of a region, if the blade has it.
    pub fn range(&self, region: Region) -> Option<[f64; 2]> {
        self.regions.iter().find(|(r, _)| *r == region).map(|(_, range)| *range)
    }

    /// Whether the two sides meet in a kink instead of a trailing-edge region.
    pub fn is_sharp(&self) -> bool {
        self.range(Region::TrailingEdge).is_none()
    }

    /// The w at which the line of constant `u` (taken modulo 1) meets `surface`, within 1e-11 mm or the rounding of
    /// coordinates; `hint` is a w nearby.
    ///
    /// # Errors
    /// [`BladeError::NoCrossing`] where the surface ends before.
    pub fn crossing(&self, u: f64, surface: &StreamSurface, hint: Option<f64>) -> Result<f64, BladeError> {
        self.cross(u, surface, hint, &mut None).map(|(w, _)| w)
    }

    /// As [`Blade::crossing`], for each of `u` in turn (neighbours near each other make it fastest): w and the point
    /// in the chart of `surface`.
    ///
    /// # Errors
    /// [`BladeError::NoCrossing`].
    pub fn profile(&self, surface: &StreamSurface, u: &[f64]) -> Result<Vec<(f64, DVec2)>, BladeError> {
        let (mut hint, mut station) = (None, None);
        let mut out = Vec::with_capacity(u.len());
        for &u in u {
            let (w, point) = self.cross(u, surface, hint, &mut station)?;
            hint = Some(w);
            out.push((w, surface.chart_at(point, station)));
        }
        Ok(out)
    }

    /// The closest point of the blade's surface to `p` near `hint` = (u, w); u wraps around.
    ///
    /// # Errors
    /// [`BladeError::Nurbs`] where the search does not converge.
    pub fn closest(&self, p: DVec3, hint: (f64, f64)) -> Result<Projection, BladeError> {
        Ok(match &self.surface {
            BladeSurface::BSpline(s) => project_on_surface(s, p, hint, true)?,
            BladeSurface::Rational(s) => project_on_surface(s, p, hint, true)?,
        })
    }

    /// Newton's method on the level along the line of constant u; `station` is carried from point to point.
    fn cross(
        &self,
        u: f64,
        surface: &StreamSurface,
        hint: Option<f64>,
        station: &mut Option<f64>,
    ) -> Result<(f64, DVec3), BladeError> {
        let u = if (0.0..=1.0).contains(&u) { u } else { u - u.floor() };
        let (_, (low, high)) = self.surface.domain();
        let mut w = hint.unwrap_or(surface.v()).max(low).min(high);
        let mut left = f64::INFINITY;
        for _ in 0..50 {
            let (point, _, along) = self.surface.first_derivatives(u, w);
            let (level, gradient) = surface.level_near(point, station);
            let step = level / gradient.dot(along);
            // Good enough, or no better than before: rounding is all that is left.
            let size = 1e-12 + 4.0 * f64::EPSILON * (point.x.abs() + point.y.abs() + point.z.abs());
            if level.abs() <= size || (level.abs() < 1e-10 && level.abs() >= left) {
                return Ok((w, point));
            }
            left = level.abs();
            if !step.is_finite() {
                break;
            }
            let next = (w - step.clamp(-0.25, 0.25)).max(low).min(high);
            if next == w {
                break;
            }
            w = next;
        }
        Err(BladeError::NoCrossing { u, v: surface.v(), distance: left })
    }
}
