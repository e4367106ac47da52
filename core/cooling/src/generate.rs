//! The whole way from a design to a measured model.

use crate::build::{BuildError, CooledBlade, build};
use crate::design::Design;
use crate::plan::Plan;
use crate::report::{Report, Timings};
use coolinggen_blade::{Blade, Fault};
use std::path::Path;
use std::time::Instant;

/// A built and measured design.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The outer surface.
    pub surface: Blade,
    /// The model with its solids.
    pub blade: CooledBlade,
    /// Its measures.
    pub report: Report,
}

/// Builds a design; `folder` is what relative paths in it refer to.
///
/// # Errors
/// All faults found: those of blade, space and cooling that need no geometry together, else those of the geometry.
pub fn generate(design: &Design, folder: &Path) -> Result<Generated, Vec<Fault>> {
    let started = Instant::now();
    let plan = design.cooling.as_ref().map_or_else(|| Ok(Plan::default()), Plan::new);
    let source = coolinggen_blade::build(&design.space, &design.blade, folder);
    let ((space, surface), plan) = match (source, plan) {
        (Ok(source), Ok(plan)) => (source, plan),
        (source, plan) => {
            let mut faults = source.err().unwrap_or_default();
            faults.extend(plan.err().unwrap_or_default());
            return Err(faults);
        }
    };
    let milliseconds = |since: Instant| since.elapsed().as_secs_f64() * 1e3;
    let blade_ms = milliseconds(started);
    let built = Instant::now();
    let blade = build(&surface, &space, &plan).map_err(BuildError::into_faults)?;
    let build_ms = milliseconds(built);
    let measured = Instant::now();
    let mut report = Report::new(&design.name, &surface, &blade).map_err(BuildError::into_faults)?;
    report.timings_ms = Timings {
        blade: blade_ms,
        build: build_ms,
        measure: milliseconds(measured),
        total: milliseconds(started),
    };
    Ok(Generated { surface, blade, report })
}
