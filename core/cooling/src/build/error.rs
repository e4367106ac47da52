//! Why a valid-looking design could not be built.

use crate::section::Refusal;
use coolinggen_blade::{BladeError, Fault};
use coolinggen_nurbs::NurbsError;
use std::fmt;

/// A failure of the build: a refusal that names its parameter, or a method that did not reach its goal.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum BuildError {
    /// The design asks for something that does not exist; every fault names its parameter.
    Refused(Vec<Fault>),
    /// The blade.
    Blade(BladeError),
    /// A face does not cross the stream surface that should cut it.
    NoCrossing {
        /// Name of the face.
        face: String,
        /// Span fraction of the stream surface.
        v: f64,
    },
    /// A kernel method.
    Kernel(NurbsError),
}

impl BuildError {
    /// A refusal at span fraction `v`, blamed on the parameter at `pointer`.
    pub(super) fn refused(pointer: &str, v: f64, refusal: &Refusal) -> Self {
        let message = format!("at span fraction {v:.4}: {refusal}");
        let fault = Fault::new(pointer, "geometry", message).unit("mm");
        let fault = match refusal {
            Refusal::ChamberVanishes { radius, needed } => {
                fault.value(*needed).max(*radius).hint("a thinner shell, or smaller radii, leave the room")
            }
            Refusal::FilletTooLarge { radius, greatest, .. } => fault.value(*radius).max(*greatest),
            Refusal::ChamberTooShort { length } => fault.value(*length).min(0.0),
            Refusal::Hump { bend, .. } => fault
                .value(*bend)
                .hint("a rounder side, or a thinner section there: chambers and holes are placed along the camber line"),
            Refusal::NoInscribedCircle | Refusal::WallOutside { .. } => fault,
        };
        Self::Refused(vec![fault])
    }

    /// The failure as faults of the design.
    pub fn into_faults(self) -> Vec<Fault> {
        match self {
            Self::Refused(faults) => faults,
            Self::Blade(error) => vec![Fault::new("/blade", "geometry", error.to_string())],
            other => vec![Fault::new("", "geometry", other.to_string())],
        }
    }
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(faults) => {
                for fault in faults {
                    writeln!(f, "{fault}")?;
                }
                Ok(())
            }
            Self::Blade(error) => error.fmt(f),
            Self::NoCrossing { face, v } => {
                write!(f, "{face} does not cross the stream surface at span fraction {v}")
            }
            Self::Kernel(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for BuildError {}

impl From<BladeError> for BuildError {
    fn from(error: BladeError) -> Self {
        Self::Blade(error)
    }
}

impl From<NurbsError> for BuildError {
    fn from(error: NurbsError) -> Self {
        Self::Kernel(error)
    }
}
