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
    /// A face that its edges do not bound.
    Topology(coolinggen_brep::BuildError),
    /// A kernel method.
    Kernel(NurbsError),
    /// A solid was built and is not what it must be.
    Unsound {
        /// Name of the solid.
        solid: String,
        /// What is wrong with it.
        what: String,
    },
    /// [`crate::Watch::cancelled`] said so.
    Cancelled,
}

impl BuildError {
    /// A refusal at span fraction `v`, blamed on the parameter at `pointer`.
    pub(super) fn refused(pointer: &str, v: f64, refusal: &Refusal) -> Self {
        Self::Refused(vec![Self::fault(pointer, v, refusal)])
    }

    /// The fault for a refusal at span fraction `v`.
    pub(super) fn fault(pointer: &str, v: f64, refusal: &Refusal) -> Fault {
        let message = format!("at span fraction {v:.4}: {refusal}");
        let fault = Fault::new(pointer, "geometry", message).unit("mm");
        match refusal {
            Refusal::ChamberVanishes { radius, needed } => {
                fault.value(*needed).max(*radius).hint("a thinner shell, or smaller radii, leave the room")
            }
            Refusal::ShellTooThick { thickness, greatest, .. } => {
                fault.value(*thickness).max(*greatest).hint("a thinner shell, or smaller radii, leave the room")
            }
            Refusal::FilletTooLarge { radius, greatest, .. } => fault.value(*radius).max(*greatest),
            Refusal::ChamberTooShort { length, .. } => fault
                .value(*length)
                .min(0.0)
                .hint("walls farther apart, steeper or thinner, or smaller fillets"),
            Refusal::Hump { bend, .. } => fault
                .value(*bend)
                .hint("a rounder side, or a thinner section there: chambers and holes are placed along the camber line"),
            Refusal::NoseTooSharp => fault.hint("a thinner shell at the nose, or a greater fillet radius"),
            Refusal::WallOutside { past, .. } if *past > 0.0 => fault
                .value(*past)
                .max(0.0)
                .hint("a wall farther from the edge, or a thinner shell"),
            Refusal::WallOutside { .. } => fault.hint("a wall more across the camber line"),
            Refusal::NoInscribedCircle => fault,
        }
    }

    /// Refusals with one fault a parameter: the section where it is worst says most; how many others there are is
    /// added.
    pub(super) fn worst(faults: Vec<Fault>) -> Self {
        let mut kept: Vec<(Fault, usize)> = Vec::new();
        for fault in faults {
            match kept.iter_mut().find(|(k, _)| k.pointer == fault.pointer) {
                None => kept.push((fault, 1)),
                Some((worst, count)) => {
                    *count += 1;
                    if excess(&fault) > excess(worst) {
                        *worst = fault;
                    }
                }
            }
        }
        let counted = kept.into_iter().map(|(mut fault, count)| {
            if count > 1 {
                fault.message = format!("{} (worst of {count} sections)", fault.message);
            }
            fault
        });
        Self::Refused(counted.collect())
    }

    /// The failure as a fault of the parameter at `pointer`, unless it names its parameters already.
    pub(super) fn blamed_on(self, pointer: &str) -> Self {
        match self {
            Self::Cancelled => self,
            _ => Self::Refused(self.faults_at(pointer)),
        }
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
            Self::Cancelled => return Vec::new(),
            Self::Kernel(_) | Self::Topology(_) => "a shape there is too small, too sharp or folded",
            Self::Unsound { .. } => {
                "smoother contours and blade surfaces, or other places of what meets there, help"
            }
        };
        vec![Fault::new(pointer, "geometry", message).hint(hint)]
    }
}

/// How far a fault's value is beyond its limits.
fn excess(fault: &Fault) -> f64 {
    let value = fault.value.as_ref().and_then(serde_json::Value::as_f64).unwrap_or(0.0);
    fault.max.map_or(0.0, |m| value - m) + fault.min.map_or(0.0, |m| m - value)
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
            Self::Topology(error) => error.fmt(f),
            Self::Kernel(error) => error.fmt(f),
            Self::Cancelled => write!(f, "the build was cancelled"),
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

impl From<coolinggen_brep::BuildError> for BuildError {
    fn from(error: coolinggen_brep::BuildError) -> Self {
        Self::Topology(error)
    }
}

impl From<NurbsError> for BuildError {
    fn from(error: NurbsError) -> Self {
        Self::Kernel(error)
    }
}
