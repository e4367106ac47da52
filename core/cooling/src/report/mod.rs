//! The report of a built design: what it is, measured.

mod passages;
mod text;
mod thickness;

use crate::build::{BuildError, CooledBlade, RadialHoleGeometry};
use coolinggen_blade::{Blade, FitReport};
use coolinggen_brep::{Face, FaceIntegrals, Model, face_integrals};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use thickness::thinnest_walls;

pub use passages::{PartReport, PassageReport, StationReport};
pub use thickness::ThinnestWall;

/// Everything measured on a built design. Lengths mm, areas mm2, volumes mm3.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Name of the design.
    pub name: String,
    /// Version of the program.
    pub version: &'static str,
    /// Every edge of every solid bounds exactly two faces, run through once each way.
    pub watertight: bool,
    /// Handles of every solid, counted and implied by the design.
    pub genus: BTreeMap<String, Genus>,
    /// Greatest distance of an edge from a face it bounds, mm.
    pub max_edge_deviation_mm: f64,
    /// Measures of the solids.
    pub solids: BTreeMap<String, SolidReport>,
    /// The blade without its cooling.
    pub blank: Blank,
    /// All faces.
    pub faces: Vec<FaceReport>,
    /// The thinnest metal between a passage and the outer surface.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wall_thickness_mm: Option<ThinnestWall>,
    /// Chains of chambers and turns, from where the coolant enters.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub passages: Vec<PassageReport>,
    /// The radial holes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub radial_holes: Vec<RadialHoleReport>,
    /// How the outer surface compares with the data it was made from.
    pub blade_fit: FitReport,
    /// Time spent, milliseconds.
    pub timings_ms: Timings,
}

/// A genus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Genus {
    /// Counted from vertices, edges, faces and loops; none where a count makes no sense, as in an open shell.
    pub found: Option<usize>,
    /// What the design implies.
    pub expected: usize,
}

/// Measures of a solid.
#[derive(Clone, Debug, Serialize)]
pub struct SolidReport {
    /// Exact volume.
    pub volume_mm3: f64,
    /// Area of all its faces.
    pub area_mm2: f64,
    /// Number of faces.
    pub faces: usize,
    /// Its box.
    pub bounding_box_mm: BoundingBox,
}

/// An axis-parallel box, mm.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct BoundingBox {
    /// Least coordinates.
    pub min: [f64; 3],
    /// Greatest coordinates.
    pub max: [f64; 3],
}

/// The blade without cooling, measured on its own.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Blank {
    /// Volume.
    pub volume_mm3: f64,
    /// Area of the profile on the hub.
    pub hub_area_mm2: f64,
    /// Area of the profile on the tip.
    pub tip_area_mm2: f64,
}

/// A face.
#[derive(Clone, Debug, Serialize)]
pub struct FaceReport {
    /// Name.
    pub name: String,
    /// Area.
    pub area_mm2: f64,
    /// Centre of the area.
    pub centroid_mm: [f64; 3],
    /// Solids that the face bounds.
    pub solids: Vec<String>,
}

/// A radial hole.
#[derive(Clone, Debug, Serialize)]
pub struct RadialHoleReport {
    /// Name.
    pub name: String,
    /// Where its axis meets the hub.
    pub hub_mm: [f64; 3],
    /// Where its axis meets the tip.
    pub tip_mm: [f64; 3],
    /// Diameter at the hub and at the tip.
    pub diameter_mm: [f64; 2],
    /// Thinnest metal to the outer surface.
    pub wall_mm: f64,
}

/// Time spent, milliseconds.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Timings {
    /// The outer surface from its source.
    pub blade: f64,
    /// Chambers, holes and solids.
    pub build: f64,
    /// Checks and measures.
    pub measure: f64,
    /// All of these.
    pub total: f64,
}

impl Report {
    /// Measures a built design.
    ///
    /// # Errors
    /// [`BuildError`] where a measurement fails.
    pub fn new(name: &str, blade: &Blade, cooled: &CooledBlade) -> Result<Self, BuildError> {
        let model = &cooled.model;
        let integrals: Vec<FaceIntegrals> = model.faces.iter().map(face_integrals).collect();
        let mut report = Self {
            name: name.to_owned(),
            version: env!("CARGO_PKG_VERSION"),
            watertight: true,
            genus: BTreeMap::new(),
            max_edge_deviation_mm: 0.0,
            solids: BTreeMap::new(),
            blank: blank(cooled, blade, &integrals),
            faces: faces(model, &integrals),
            wall_thickness_mm: None,
            passages: Vec::new(),
            radial_holes: Vec::new(),
            blade_fit: blade.fit.clone(),
            timings_ms: Timings::default(),
        };
        report.measure_solids(model, &integrals);
        let passages = cooled.passages.iter().map(|p| passages::passage(model, &p.name, &p.parts));
        report.passages = passages.collect::<Result<_, _>>()?;
        let walls = thinnest_walls(blade, cooled)?;
        report.radial_holes = cooled.radial_holes.iter().map(|hole| radial_hole(hole, &walls)).collect();
        report.wall_thickness_mm = walls.into_iter().min_by(|a, b| a.min.total_cmp(&b.min));
        Ok(report)
    }

    fn measure_solids(&mut self, model: &Model, integrals: &[FaceIntegrals]) {
        for solid in &model.solids {
            let check = model.check_solid(solid);
            self.watertight &= check.watertight;
            let genus = Genus { found: check.genus_found, expected: solid.expected_genus };
            self.genus.insert(solid.name.clone(), genus);
            self.max_edge_deviation_mm = self.max_edge_deviation_mm.max(check.max_edge_distance_mm);
            let mass = model.solid_mass(solid, integrals);
            let bounds = model.solid_bounds(solid);
            self.solids.insert(
                solid.name.clone(),
                SolidReport {
                    volume_mm3: mass.volume_mm3,
                    area_mm2: mass.area_mm2,
                    faces: solid.faces().count(),
                    bounding_box_mm: BoundingBox { min: bounds.min.to_array(), max: bounds.max.to_array() },
                },
            );
        }
    }

    /// The report as JSON.
    pub fn to_json(&self) -> Value {
        serde_json::to_value(self).unwrap_or(Value::Null)
    }

    /// The report for people.
    pub fn to_text(&self) -> String {
        text::render(self)
    }
}

/// The blade without openings: outer faces and the outer loops of hub and tip, integrated on their own.
fn blank(cooled: &CooledBlade, blade: &Blade, integrals: &[FaceIntegrals]) -> Blank {
    let model = &cooled.model;
    let sign = |forward: bool| if forward { 1.0 } else { -1.0 };
    let mut volume =
        cooled.outer_faces.iter().map(|f| integrals[f.0].flux_mm3).sum::<f64>() * sign(blade.outward);
    let mut areas = [0.0; 2];
    for (id, area) in cooled.end_faces.iter().zip(&mut areas) {
        let face = model.face(*id);
        let whole = Face { loops: face.loops[..1].to_vec(), ..face.clone() };
        let whole = face_integrals(&whole);
        let forward = model.solids[0].faces().any(|f| f.face == *id && f.forward);
        volume += whole.flux_mm3 * sign(forward);
        *area = whole.area_mm2;
    }
    Blank { volume_mm3: volume, hub_area_mm2: areas[0], tip_area_mm2: areas[1] }
}

fn faces(model: &Model, integrals: &[FaceIntegrals]) -> Vec<FaceReport> {
    let mut faces: Vec<FaceReport> = (model.faces.iter().zip(integrals))
        .map(|(face, i)| FaceReport {
            name: face.name.clone(),
            area_mm2: i.area_mm2,
            centroid_mm: i.centroid_mm.to_array(),
            solids: Vec::new(),
        })
        .collect();
    for solid in &model.solids {
        for used in solid.faces() {
            faces[used.face.0].solids.push(solid.name.clone());
        }
    }
    faces
}

fn radial_hole(hole: &RadialHoleGeometry, walls: &[ThinnestWall]) -> RadialHoleReport {
    let prefix = format!("radial_hole/{}/", hole.name);
    let own = walls.iter().filter(|w| w.face.starts_with(&prefix)).map(|w| w.min);
    RadialHoleReport {
        name: hole.name.clone(),
        hub_mm: hole.hub.to_array(),
        tip_mm: hole.tip.to_array(),
        diameter_mm: hole.diameters,
        wall_mm: own.fold(f64::INFINITY, f64::min),
    }
}
