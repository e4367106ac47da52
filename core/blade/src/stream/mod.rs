//! Stream space (m, t, v): the space all profile work happens in.

mod annular;
pub(crate) mod measure;
mod meridian;
mod net;
mod spec;
mod surface;

pub use annular::Annular;
pub use spec::{ContourSpec, SpaceSpec, SplineSpec, StreamlineSpec};
pub use surface::StreamSurface;

use crate::error::BladeError;
use glam::DVec3;

/// How far beyond hub (v = 0) and shroud (v = 1) stream surfaces are extrapolated.
pub(crate) const BEYOND: f64 = 0.15;

/// The space between hub and shroud, filled with stream surfaces of span fraction v: 0 at the hub, 1 at the shroud.
#[derive(Clone, Debug)]
pub enum StreamSpace {
    /// Around the machine axis x.
    Annular(Annular),
    /// A straight row of prismatic or nearly prismatic blades.
    Linear(Linear),
}

/// A linear cascade: m = x and t = y in planes of constant z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// z at v = 0, mm.
    pub z0: f64,
    /// Span from v = 0 to v = 1, mm, positive.
    pub height: f64,
}

impl StreamSpace {
    /// The stream surface at span fraction `v`, linearly extrapolated beyond hub and shroud.
    ///
    /// # Errors
    /// [`BladeError::SpanFraction`] for `v` outside [-0.15, 1.15].
    pub fn surface(&self, v: f64) -> Result<StreamSurface, BladeError> {
        if !(-BEYOND..=1.0 + BEYOND).contains(&v) {
            return Err(BladeError::SpanFraction { v });
        }
        match self {
            Self::Annular(annular) => annular.surface(v),
            Self::Linear(linear) => Ok(StreamSurface::plane(v, linear.z0 + linear.height * v)),
        }
    }

    /// Span fraction of a point, by Newton's method on the net in an annulus (1e-12 of the span).
    ///
    /// # Errors
    /// [`BladeError::OutsideContours`] where no stream surface passes between the ends of the contours.
    pub fn span_fraction(&self, p: DVec3) -> Result<f64, BladeError> {
        match self {
            Self::Annular(annular) => annular.coordinates(surface::meridional(p)).map(|(_, v)| v),
            Self::Linear(linear) => Ok((p.z - linear.z0) / linear.height),
        }
    }

    /// Distance from hub to shroud in the middle of the contours, mm.
    pub fn height(&self) -> f64 {
        match self {
            Self::Annular(annular) => annular.height(),
            Self::Linear(linear) => linear.height,
        }
    }
}
