//! How a generation tells how far it is, and is told to stop.

use crate::build::BuildError;

/// A stage of a generation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The outer surface from its source.
    Blade,
    /// Chambers, turns, bores and solids.
    Build,
    /// The report.
    Measure,
}

impl Stage {
    /// All stages in their order.
    pub const ALL: [Self; 3] = [Self::Blade, Self::Build, Self::Measure];

    /// Its name, for messages to programs and people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Blade => "blade",
            Self::Build => "build",
            Self::Measure => "measure",
        }
    }

    /// About the share of the whole that is done when it begins.
    pub fn begins_at(self) -> f64 {
        match self {
            Self::Blade => 0.0,
            Self::Build => 0.2,
            Self::Measure => 0.7,
        }
    }
}

/// Someone who watches a generation.
pub trait Watch: Sync {
    /// A stage begins.
    fn begins(&self, stage: Stage);

    /// Whether to stop: asked again and again, from any thread.
    fn cancelled(&self) -> bool;
}

impl dyn Watch + '_ {
    /// An error once it is to stop.
    pub(crate) fn go_on(&self) -> Result<(), BuildError> {
        if self.cancelled() { Err(BuildError::Cancelled) } else { Ok(()) }
    }
}

/// Nobody: nothing is told, nothing stops.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn begins(&self, _: Stage) {}

    fn cancelled(&self) -> bool {
        false
    }
}
