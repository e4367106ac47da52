//! Blade sources: where a blade's surface comes from.

mod assemble;
pub(crate) mod closed;
pub(crate) mod medial;
pub(crate) mod pritchard;
pub(crate) mod sections;
pub(crate) mod step;
pub(crate) mod surface;

use crate::blade::Blade;
use crate::fault::{Fault, Pointer};
use crate::stream::{SpaceSpec, StreamSpace};
use coolinggen_nurbs::ParametricSurface;
use glam::DVec2;
use medial::{PropellerSource, PropellerTableSource, TurbineSource};
use pritchard::PritchardSource;
use schemars::JsonSchema;
use sections::SectionsSource;
use serde::{Deserialize, Serialize};
use std::path::Path;
use step::StepSource;
use surface::SurfaceSource;

/// Code of faults that say that the blade leaves the contours.
pub(crate) const OUTSIDE_CONTOURS: &str = "outside_contours";

/// Where the blade comes from. Lengths in mm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum BladeSource {
    /// Points of sections.
    Sections(SectionsSource),
    /// The eleven parameters of an axial turbine section.
    Pritchard(Box<PritchardSource>),
    /// A turbine blade from hydraulic parameters.
    #[serde(rename = "medial-turbine")]
    MedialTurbine(Box<TurbineSource>),
    /// A propeller blade from hydraulic parameters, closed at the tip.
    #[serde(rename = "medial-propeller")]
    MedialPropeller(Box<PropellerSource>),
    /// A propeller blade from radial tables.
    #[serde(rename = "propeller-table")]
    PropellerTable(Box<PropellerTableSource>),
    /// A surface, inline.
    Surface(SurfaceSource),
    /// The surface or surfaces in a STEP file.
    Step(StepSource),
}

/// Makes the stream space and the blade of a design. Files named in it are sought relative to `folder`.
///
/// # Errors
/// Every fault found, with pointers that begin with `/space` or `/blade`.
pub fn build(
    space: &SpaceSpec,
    source: &BladeSource,
    folder: &Path,
) -> Result<(StreamSpace, Blade), Vec<Fault>> {
    let space_pointer = Pointer::root().at("space");
    let space = space.space(&space_pointer)?;
    let blade = source.blade(&space, folder).map_err(|faults| relative_to_design(faults, &space_pointer))?;
    let space = settle(space, &blade, &space_pointer)?;
    Ok((space, blade))
}

/// Faults of the source with pointers from the design's root. That the blade leaves the contours is blamed on these.
fn relative_to_design(faults: Vec<Fault>, space: &Pointer) -> Vec<Fault> {
    let moved = faults.into_iter().map(|f| {
        if f.code != OUTSIDE_CONTOURS {
            return f.under("/blade");
        }
        let at_space = Fault { pointer: space.to_string(), ..f };
        at_space.hint("hub and shroud must run past the blade's leading and trailing edge")
    });
    let mut moved: Vec<_> = moved.collect();
    moved.dedup();
    moved
}

impl BladeSource {
    /// The file that it names, if it names one; relative paths are to the design's folder.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Step(source) => Some(Path::new(&source.file)),
            _ => None,
        }
    }

    /// Makes the blade.
    ///
    /// # Errors
    /// Every fault found, with pointers relative to the source.
    pub fn blade(&self, space: &StreamSpace, folder: &Path) -> Result<Blade, Vec<Fault>> {
        match self {
            Self::Sections(source) => source.blade(space),
            Self::Pritchard(source) => source.blade(space),
            Self::MedialTurbine(source) => source.blade(space),
            Self::MedialPropeller(source) => source.blade(space),
            Self::PropellerTable(source) => source.blade(space),
            Self::Surface(source) => source.blade(space),
            Self::Step(source) => source.blade(space, folder),
        }
    }
}

/// Checks that the contours cover the blade, and puts the reference of the charts into its middle.
fn settle(space: StreamSpace, blade: &Blade, pointer: &Pointer) -> Result<StreamSpace, Vec<Fault>> {
    let StreamSpace::Annular(annular) = space else { return Ok(space) };
    let samples = 96;
    let (mut low, mut high) = ((f64::INFINITY, DVec2::ZERO), (f64::NEG_INFINITY, DVec2::ZERO));
    let (mut sin, mut cos) = (0.0, 0.0);
    for w in [0.0, 0.25, 0.5, 0.75, 1.0] {
        for i in 0..samples {
            let p = blade.surface.point(f64::from(i) / f64::from(samples), w);
            let q = DVec2::new(p.x, p.y.hypot(p.z));
            (sin, cos) = (sin + p.y / q.y, cos + p.z / q.y);
            let Ok((s, _)) = annular.coordinates(q) else {
                return Err(vec![uncovered(pointer, q, None)]);
            };
            if s < low.0 {
                low = (s, q);
            }
            if s > high.0 {
                high = (s, q);
            }
        }
    }
    for (s, q) in [low, high] {
        if !(0.0..=1.0).contains(&s) {
            return Err(vec![uncovered(pointer, q, Some(s))]);
        }
    }
    Ok(StreamSpace::Annular(annular.with_reference(0.5 * (low.0 + high.0), sin.atan2(cos))))
}

fn uncovered(pointer: &Pointer, q: DVec2, s: Option<f64>) -> Fault {
    let end = match s {
        Some(s) if s < 0.0 => "start",
        Some(_) => "end",
        None => "start or end",
    };
    let message = format!(
        "the contours do not cover the blade: it reaches x = {:.4} mm, r = {:.4} mm, beyond their {end}",
        q.x, q.y
    );
    Fault::new(pointer.clone(), OUTSIDE_CONTOURS, message)
        .value(q.x)
        .unit("mm")
        .hint("lengthen hub and shroud past the blade's leading and trailing edge")
}
