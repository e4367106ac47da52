//! The whole way from a design to a measured model.

use crate::build::{BuildError, CooledBlade, KeptBuild, add_row, build};
use crate::design::Design;
use crate::groups::grouping;
use crate::plan::Plan;
use crate::report::{KeptMeasures, Report, Timings};
use crate::watch::{Stage, Unwatched, Watch};
use coolinggen_blade::{Blade, BladeSource, Fault, SpaceSpec, StreamSpace};
use coolinggen_brep::Grouping;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Instant, SystemTime};

/// A built and measured design.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The outer surface.
    pub surface: Arc<Blade>,
    /// The model with its solids.
    pub blade: CooledBlade,
    /// Its faces in groups, for meshers and solvers.
    pub grouping: Grouping,
    /// Its measures.
    pub report: Report,
}

/// Why a generation came to no model.
#[derive(Clone, Debug, PartialEq)]
pub enum Stopped {
    /// The design was refused: all faults found.
    Refused(Vec<Fault>),
    /// [`Watch::cancelled`] said so.
    Cancelled,
}

/// Builds a design; `folder` is what relative paths in it refer to.
///
/// # Errors
/// All faults found: those of blade, space and cooling that need no geometry together, else those of the geometry.
pub fn generate(design: &Design, folder: &Path) -> Result<Generated, Vec<Fault>> {
    let mut once = Warm { build: KeptBuild::once(), measures: KeptMeasures::once(), ..Warm::default() };
    once.generate(design, folder, &Unwatched).map_err(|stopped| match stopped {
        Stopped::Refused(faults) => faults,
        Stopped::Cancelled => Vec::new(),
    })
}

/// What is kept from one generation for the next of a similar design: the last outer surface, the last blade with its
/// passages, what is known of its bores, and the measures of faces. Each is used again where everything that it was made
/// from is as it was, bit by bit: the result is that of [`generate`].
#[derive(Clone, Debug, Default)]
pub struct Warm {
    outer: Option<Arc<Outer>>,
    build: KeptBuild,
    measures: KeptMeasures,
    outers: u64,
}

/// How often what can be kept has been made so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Made {
    /// Outer surfaces.
    pub outers: u64,
    /// Blades with their passages.
    pub hollows: u64,
    /// Bores found, in the last of these.
    pub bores: u64,
    /// Loops of faces integrated.
    pub loops: u64,
    /// Faces checked.
    pub checks: u64,
}

/// A blade's outer surface with what it was made from.
#[derive(Debug)]
struct Outer {
    from: OuterKey,
    space: StreamSpace,
    surface: Arc<Blade>,
}

/// Everything that an outer surface depends on.
#[derive(Clone, Debug, PartialEq)]
struct OuterKey {
    space: SpaceSpec,
    source: BladeSource,
    folder: PathBuf,
    /// Time and length of the file that the source names.
    file: Option<(SystemTime, u64)>,
}

impl OuterKey {
    fn new(design: &Design, folder: &Path) -> Self {
        let stamp = |file: &Path| {
            let data = std::fs::metadata(folder.join(file)).ok()?;
            Some((data.modified().ok()?, data.len()))
        };
        let file = design.blade.file().and_then(stamp);
        Self { space: design.space.clone(), source: design.blade.clone(), folder: folder.to_owned(), file }
    }
}

impl Warm {
    /// As [`generate`], reusing what a generation before made from the same parameters, and telling `watch`.
    ///
    /// # Errors
    /// See [`Stopped`].
    pub fn generate(
        &mut self,
        design: &Design,
        folder: &Path,
        watch: &dyn Watch,
    ) -> Result<Generated, Stopped> {
        let result = self.generated(design, folder, watch);
        self.build.end_round(result.is_ok());
        self.measures.end_round(result.is_ok());
        result
    }

    /// What has been made so far, and not been used again.
    pub fn made(&self) -> Made {
        let ([hollows, bores], [loops, checks]) = (self.build.made(), self.measures.made());
        Made { outers: self.outers, hollows, bores, loops, checks }
    }

    fn generated(&mut self, design: &Design, folder: &Path, watch: &dyn Watch) -> Result<Generated, Stopped> {
        let started = Instant::now();
        let begin = |stage: Stage| {
            watch.begins(stage);
            if watch.cancelled() { Err(Stopped::Cancelled) } else { Ok(Instant::now()) }
        };
        let refused = |error: BuildError| match error {
            BuildError::Cancelled => Stopped::Cancelled,
            error => Stopped::Refused(error.into_faults()),
        };
        let milliseconds = |since: Instant| since.elapsed().as_secs_f64() * 1e3;

        begin(Stage::Blade)?;
        let plan = design.cooling.as_ref().map_or_else(|| Ok(Plan::default()), Plan::new);
        let (outer, plan) = match (self.outer(design, folder), plan) {
            (Ok(outer), Ok(plan)) => (outer, plan),
            (outer, plan) => {
                let mut faults = outer.err().unwrap_or_default();
                faults.extend(plan.err().unwrap_or_default());
                return Err(Stopped::Refused(faults));
            }
        };
        let blade_ms = milliseconds(started);
        let built = begin(Stage::Build)?;
        let mut blade =
            build(&outer.surface, &outer.space, &plan, &mut self.build, watch).map_err(refused)?;
        if let Some(pattern) = &design.pattern {
            add_row(&mut blade.model, &outer.surface, &outer.space, pattern, watch).map_err(refused)?;
        }
        let build_ms = milliseconds(built);
        let measured = begin(Stage::Measure)?;
        let report = Report::new(&design.name, &outer.surface, &blade, &mut self.measures, watch);
        let mut report = report.map_err(refused)?;
        report.timings_ms = Timings {
            blade: blade_ms,
            build: build_ms,
            measure: milliseconds(measured),
            total: milliseconds(started),
        };
        let grouping = grouping(&blade.model, &design.groups);
        Ok(Generated { surface: Arc::clone(&outer.surface), blade, grouping, report })
    }

    /// The outer surface of the design, the last one if nothing that it depends on has changed.
    fn outer(&mut self, design: &Design, folder: &Path) -> Result<Arc<Outer>, Vec<Fault>> {
        let from = OuterKey::new(design, folder);
        if let Some(outer) = self.outer.as_ref().filter(|outer| outer.from == from) {
            return Ok(Arc::clone(outer));
        }
        let (space, surface) = coolinggen_blade::build(&design.space, &design.blade, folder)?;
        let outer = Arc::new(Outer { from, space, surface: Arc::new(surface) });
        self.outer = Some(Arc::clone(&outer));
        self.outers += 1;
        Ok(outer)
    }
}
