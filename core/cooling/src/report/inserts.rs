//! Inserts and their jets, measured.

use super::Range;
use crate::build::{BuildError, InsertGeometry, JetGeometry};
use crate::watch::Watch;
use coolinggen_brep::{FaceId, FaceIntegrals, Key, Memo, Model, Numbered};
use coolinggen_nurbs::{ParametricSurface, project_on_surface};
use serde::Serialize;
use std::f64::consts::PI;

/// An insert.
#[derive(Clone, Debug, Serialize)]
pub struct InsertReport {
    /// Name of its solid: `insert/<chamber>`.
    pub name: String,
    /// Area of the sheet towards the gap, without the plate.
    pub area_mm2: f64,
    /// Thickness of the sheet: distance from points of its inner face to the outer one.
    pub thickness_mm: Range,
    /// Distance from points of the sheet to the faces of the chamber.
    pub gap_mm: Range,
    /// Number of jets.
    pub jets: usize,
    /// Area of the jets' sections together.
    pub jet_area_mm2: f64,
}

/// A jet of an insert.
#[derive(Clone, Debug, Serialize)]
pub struct JetReport {
    /// Path of its faces: `insert/<chamber>/jet/<array>/<number>`.
    pub name: String,
    /// Where its axis leaves the sheet.
    pub position_mm: [f64; 3],
    /// Unit direction of its axis, out of the insert.
    pub direction: [f64; 3],
    /// Diameter.
    pub diameter_mm: f64,
    /// Length of the axis in the sheet.
    pub length_mm: f64,
    /// Face of the chamber that it impinges on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<String>,
    /// Distance along the axis from the sheet to that face.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target_mm: Option<f64>,
    /// The same over the diameter: z/d.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target_d: Option<f64>,
    /// Greatest distance to the next column over the diameter: x/d.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub streamwise_pitch_d: Option<f64>,
    /// Distance to the next row over the diameter: y/d.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spanwise_pitch_d: Option<f64>,
}

pub(super) fn jet_report(jet: &JetGeometry) -> JetReport {
    let [streamwise_pitch_d, spanwise_pitch_d] = jet.pitch_d;
    let target_mm = jet.target.as_ref().map(|(distance, _)| *distance);
    JetReport {
        name: format!("insert/{}/jet/{}/{:03}", jet.insert, jet.array, jet.number),
        position_mm: jet.exit.to_array(),
        direction: jet.axis.to_array(),
        diameter_mm: jet.diameter,
        length_mm: jet.length,
        target: jet.target.as_ref().map(|(_, face)| face.clone()),
        target_mm,
        target_d: target_mm.map(|distance| distance / jet.diameter),
        streamwise_pitch_d,
        spanwise_pitch_d,
    }
}

pub(super) fn insert_report(
    model: &Model,
    integrals: &[FaceIntegrals],
    insert: &InsertGeometry,
    jets: &[JetGeometry],
    (kept, numbered): (&mut Memo<Range>, &Numbered),
    watch: &dyn Watch,
) -> Result<InsertReport, BuildError> {
    let mut between = |from: &[FaceId], to: &[FaceId]| {
        let key = from.iter().chain(to).fold(Key::default(), |key, &face| key.and(numbered.of(face)));
        kept.get(key, || distances(model, from, to, watch))
    };
    let thickness_mm = between(&insert.inside, &insert.outside)?;
    let gap_mm = between(&insert.outside, &insert.chamber)?;
    let own = || jets.iter().filter(|jet| jet.insert == insert.name);
    Ok(InsertReport {
        name: format!("insert/{}", insert.name),
        area_mm2: insert.sheet.iter().map(|face| integrals[face.0].area_mm2).sum(),
        thickness_mm,
        gap_mm,
        jets: own().count(),
        jet_area_mm2: own().fold(0.0, |sum, jet| sum + 0.25 * PI * jet.diameter * jet.diameter),
    })
}

/// Distances from points of one tube to another, whose eight faces stand opposite its own. Points beyond the other one's
/// ends are left out.
fn distances(model: &Model, from: &[FaceId], to: &[FaceId], watch: &dyn Watch) -> Result<Range, BuildError> {
    const ACROSS: u32 = 16;
    const ALONG: u32 = 12;
    let surface = |id: FaceId| &model.face(id).surface;
    let (_, own) = surface(from[0]).domain();
    let (_, other) = surface(to[0]).domain();
    let (low, high) = (own.0.max(other.0), own.1.min(other.1));
    let mut range = Range { min: f64::INFINITY, max: 0.0 };
    let count = from.len();
    for (k, &face) in from.iter().enumerate() {
        watch.go_on()?;
        for (i, j) in (0..=ACROSS).flat_map(|i| (0..=ALONG).map(move |j| (i, j))) {
            let (t, v) =
                (f64::from(i) / f64::from(ACROSS), low + (high - low) * f64::from(j) / f64::from(ALONG));
            let point = surface(face).point(t, v);
            let mut nearest = f64::INFINITY;
            // A foot may lie round the corner.
            for (opposite, near) in [((k + count - 1) % count, 1.0), (k, t), ((k + 1) % count, 0.0)] {
                let foot = project_on_surface(surface(to[opposite]), point, (near, v), false)?;
                nearest = nearest.min(foot.distance);
            }
            range = Range { min: range.min.min(nearest), max: range.max.max(nearest) };
        }
    }
    Ok(range)
}
