//! Checks of a blade made of sections, and what follows from the space around it.

use super::{SectionsSource, pointer};
use crate::error::BladeError;
use crate::fault::{Fault, Pointer};
use crate::loft::{LoftSection, Sheet};
use crate::stream::{BEYOND, StreamSpace};
use glam::DVec2;

const MOST_SECTIONS: usize = 200;

/// What each section is drawn on.
pub(super) fn sheets(source: &SectionsSource, space: &StreamSpace) -> Result<Vec<Sheet>, Vec<Fault>> {
    let mut faults = Vec::new();
    let count = source.sections.len();
    let least = if matches!(space, StreamSpace::Linear(_)) { 1 } else { 2 };
    if !(least..=MOST_SECTIONS).contains(&count) {
        let message = format!("{count} sections given, {least} to {MOST_SECTIONS} needed");
        faults.push(
            Fault::new("/sections", "section_count", message)
                .value(count)
                .min(f64::from(least as u32))
                .max(MOST_SECTIONS as f64),
        );
        return Err(faults);
    }
    if !(source.tolerance >= 0.0 && source.tolerance <= 0.1) {
        let message = format!("the tolerance {} mm is outside 0 to 0.1 mm", source.tolerance);
        faults.push(
            Fault::new("/tolerance", "out_of_range", message)
                .value(source.tolerance)
                .min(0.0)
                .max(0.1)
                .unit("mm"),
        );
    }
    let planar = source.sections[0].z.is_some();
    let mut sheets = Vec::new();
    for (k, s) in source.sections.iter().enumerate() {
        let at = pointer(k);
        match (s.span, s.z) {
            (Some(_), Some(_)) => {
                faults.push(Fault::new(at, "ambiguous", "give `span` or `z`, not both"));
            }
            (None, None) if count == 1 => sheets.extend(space.surface(0.5).ok().map(Sheet::Stream)),
            (None, None) => {
                let message = "the section has neither `span` nor `z`";
                faults.push(Fault::new(at, "missing", message));
            }
            (Some(v), None) if !(-BEYOND..=1.0 + BEYOND).contains(&v) => {
                let message = format!("span fraction {v} is outside -0.15 to 1.15");
                faults.push(
                    Fault::new(at.at("span"), "out_of_range", message)
                        .value(v)
                        .min(-BEYOND)
                        .max(1.0 + BEYOND),
                );
            }
            (None, Some(z)) if !z.is_finite() => {
                faults.push(Fault::new(at.at("z"), "not_finite", "z is not finite").unit("mm"));
            }
            (Some(_), None) if planar => faults.push(mixed(&at.at("span"))),
            (None, Some(_)) if !planar => faults.push(mixed(&at.at("z"))),
            (Some(v), None) => match space.surface(v) {
                Ok(surface) => sheets.push(Sheet::Stream(surface)),
                Err(e) => faults.push(Fault::new(at.at("span"), "out_of_range", e.to_string())),
            },
            (None, Some(z)) => sheets.push(Sheet::Planar { z }),
        }
    }
    if faults.is_empty() { Ok(sheets) } else { Err(faults) }
}

fn mixed(pointer: &Pointer) -> Fault {
    Fault::new(pointer.clone(), "mixed", "some sections have `span`, others `z`: use one of them in all")
}

/// The surface parameter of a section: its span fraction, or the one in the middle of a planar section.
pub(super) fn parameter(sheet: &Sheet, points: &[DVec2], space: &StreamSpace) -> Result<f64, BladeError> {
    match sheet {
        Sheet::Stream(surface) | Sheet::Chart(surface) => Ok(surface.v()),
        Sheet::Planar { z } => {
            let (low, high) = points
                .iter()
                .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
            space.span_fraction((0.5 * (low + high)).extend(*z))
        }
    }
}

/// Refuses sections that do not follow each other along the span.
pub(super) fn increasing(sections: &[LoftSection]) -> Result<(), Vec<Fault>> {
    let mut faults = Vec::new();
    for (k, pair) in sections.windows(2).enumerate() {
        if !(pair[1].w > pair[0].w + 1e-6) {
            let key = if matches!(pair[1].sheet, Sheet::Planar { .. }) { "z" } else { "span" };
            let message = format!(
                "the section lies at span fraction {:.6}, not beyond the one before at {:.6}",
                pair[1].w, pair[0].w
            );
            faults.push(
                Fault::new(pointer(k + 1).at(key), "not_increasing", message)
                    .value(pair[1].w)
                    .min(pair[0].w)
                    .hint("list the sections from hub to shroud"),
            );
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}
