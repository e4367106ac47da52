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
    /// A solid was built and is not what it must be.
    Unsound {
        /// Name of the solid.
        solid: String,
        /// What is wrong with it.
        what: String,
    },
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
            Refusal::ChamberTooShort { length, .. } => fault
                .value(*length)
                .min(0.0)
                .hint("walls farther apart, steeper or thinner, or smaller fillets"),
            Refusal::Hump { bend, .. } => fault
                .value(*bend)
                .hint("a rounder side, or a thinner section there: chambers and holes are placed along the camber line"),
            Refusal::NoInscribedCircle | Refusal::WallOutside { .. } => fault,
        };
        Self::Refused(vec![fault])
    }

    /// The failure as a fault of the parameter at `pointer`, unless it names its parameters already.
    pub(super) fn blamed_on(self, pointer: &str) -> Self {
        Self::Refused(self.faults_at(pointer))
    }

    /// The failure as faults of the design; what names no parameter is the blade's.
    pub fn into_faults(self) -> Vec<Fault> {
        self.faults_at("/blade")
    }

    fn faults_at(self, pointer: &str) -> Vec<Fault> {
        let message = self.to_string();
        let hint = match self {
            Self::Refused(faults) => return faults,
            Self::Blade(BladeError::OutsideContours { .. }) => {
                "hub and shroud must run past everything that stands between them"
            }
            Self::Blade(_) | Self::NoCrossing { .. } => {
                "what runs from hub to tip must cross every stream surface on its way, once and not along it"
            }
            Self::Kernel(_) => "a shape there is too small, too sharp or folded",
            Self::Unsound { .. } => {
                "smoother contours and blade surfaces, or other places of what meets there, help"
            }
        };
        vec![Fault::new(pointer, "geometry", message).hint(hint)]
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
            Self::Unsound { solid, what } => write!(f, "the solid {solid} came out unsound: {what}"),
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
