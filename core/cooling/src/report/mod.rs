//! The report of a built design: what it is, measured.

mod features;
mod inner_bores;
mod inserts;
mod kept;
mod passages;
mod text;
mod thickness;
mod wall_field;

use crate::build::{BuildError, CooledBlade, FilmHoleGeometry, RadialHoleGeometry, SlotGeometry};
use crate::watch::Watch;
use coolinggen_blade::{Blade, FitReport};
use coolinggen_brep::{Checked, Face, FaceIntegrals, Measures, Model, Numbered, SolidCheck, face_integrals};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use thickness::thinnest_walls;

pub use inner_bores::{CrossoverReport, DustHoleReport, PinReport};
pub use inserts::{InsertReport, JetReport};
pub use kept::KeptMeasures;
pub use passages::{PartReport, PassageReport, StationReport};
pub use thickness::ThinnestWall;
pub use wall_field::WallField;

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
    /// The film holes, row by row from hub to tip.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub holes: Vec<HoleReport>,
    /// The slots, row by row from hub to tip.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub slots: Vec<SlotReport>,
    /// The crossover holes, row by row from hub to tip.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub crossovers: Vec<CrossoverReport>,
    /// The pins, row by row from hub to tip.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pins: Vec<PinReport>,
    /// The dust holes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub dust_holes: Vec<DustHoleReport>,
    /// The inserts.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub inserts: Vec<InsertReport>,
    /// The jets, insert by insert and array by array.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub jets: Vec<JetReport>,
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

/// A film hole.
#[derive(Clone, Debug, Serialize)]
pub struct HoleReport {
    /// Path of its faces: `film/<row>/<number>`.
    pub name: String,
    /// Passage that feeds it.
    pub passage: String,
    /// Where its axis breaks out.
    pub position_mm: [f64; 3],
    /// Unit direction of its axis, out of the blade.
    pub direction: [f64; 3],
    /// Diameter of the metering part.
    pub diameter_mm: f64,
    /// Length of the axis in the metal.
    pub length_mm: f64,
    /// Length over diameter.
    pub length_d: f64,
    /// Angle between the axis and the surface.
    pub inclination_deg: f64,
    /// Angle of the axis about the surface's normal, from downstream towards the tip.
    pub compound_deg: f64,
    /// Area of the exit, normal to the axis where its upstream edge breaks out, over that of the metering part.
    pub area_ratio: f64,
    /// Area of the breakout in the outer surface.
    pub breakout_mm2: f64,
    /// Width of the breakout between its side walls over the distance between holes of the row.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coverage: Option<f64>,
    /// Metal to the nearest other film hole, if it is near.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ligament_mm: Option<f64>,
}

/// A slot.
#[derive(Clone, Debug, Serialize)]
pub struct SlotReport {
    /// Path of its faces: `slot/<row>/<number>`.
    pub name: String,
    /// Passage that feeds it.
    pub passage: String,
    /// Where its axis breaks out.
    pub position_mm: [f64; 3],
    /// Unit direction of its axis, out of the blade.
    pub direction: [f64; 3],
    /// Size along the span.
    pub height_mm: f64,
    /// Size across the blade.
    pub width_mm: f64,
    /// Length of the axis in the metal.
    pub length_mm: f64,
    /// Metal to the next slot of the row.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub land_mm: Option<f64>,
    /// Thinnest metal beside the slot to the suction side, and to the pressure side as far as that reaches.
    pub side_walls_mm: [Option<f64>; 2],
    /// Length of the open part behind the lip, where the pressure side is cut back.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub open_length_mm: Option<f64>,
    /// Area of the breakout in the outer surface.
    pub breakout_mm2: f64,
}

/// Least and greatest of a length, mm.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Range {
    /// Least.
    pub min: f64,
    /// Greatest.
    pub max: f64,
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
    /// Measures a built design, reusing what `kept` has from the report before.
    ///
    /// # Errors
    /// [`BuildError`] where a measurement fails or a solid is unsound: open, of another genus than implied, or with
    /// edges farther than 3e-8 mm off their faces; [`BuildError::Cancelled`].
    pub fn new(
        name: &str,
        blade: &Blade,
        cooled: &CooledBlade,
        kept: &mut KeptMeasures,
        watch: &dyn Watch,
    ) -> Result<Self, BuildError> {
        let model = &cooled.model;
        let stop = || watch.cancelled();
        let numbered = kept.faces.numbered(model);
        let integrals = kept.faces.face_integrals(model, &numbered, &stop);
        watch.go_on()?;
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
            holes: cooled.bores.film_holes.iter().map(|hole| hole_report(hole, &integrals)).collect(),
            slots: cooled.bores.slots.iter().map(|slot| slot_report(slot, &integrals)).collect(),
            crossovers: cooled.bores.crossovers.iter().map(CrossoverReport::new).collect(),
            pins: cooled.bores.pins.iter().map(PinReport::new).collect(),
            dust_holes: (cooled.bores.dust_holes.iter())
                .map(|hole| DustHoleReport::new(hole, integrals[hole.breakout.0].area_mm2))
                .collect(),
            inserts: Vec::new(),
            jets: cooled.bores.jets.iter().map(inserts::jet_report).collect(),
            blade_fit: blade.fit.clone(),
            timings_ms: Timings::default(),
        };
        report.measure_solids(model, &integrals, (&mut kept.faces, &numbered), watch)?;
        for passage in &cooled.passages {
            watch.go_on()?;
            let key = passages::key(passage, &numbered);
            let make = || passages::passage(model, &passage.name, &passage.parts);
            report.passages.push(kept.passages.get(key, make)?);
        }
        for insert in &cooled.inserts {
            let gaps = (&mut kept.gaps, &numbered);
            let made = inserts::insert_report(model, &integrals, insert, &cooled.bores.jets, gaps, watch)?;
            report.inserts.push(made);
        }
        let walls = thinnest_walls(blade, cooled, kept, &numbered, watch)?;
        report.radial_holes = cooled.radial_holes.iter().map(|hole| radial_hole(hole, &walls)).collect();
        report.wall_thickness_mm = walls.into_iter().min_by(|a, b| a.min.total_cmp(&b.min));
        Ok(report)
    }

    fn measure_solids(
        &mut self,
        model: &Model,
        integrals: &[FaceIntegrals],
        (kept, numbered): (&mut Measures, &Numbered),
        watch: &dyn Watch,
    ) -> Result<(), BuildError> {
        let mut checked = Checked::default();
        for solid in &model.solids {
            let faces = (numbered, &mut checked);
            let check = kept.check_solid(model, solid, faces, &|| watch.cancelled());
            watch.go_on()?;
            if let Some(what) = unsound(model, &check) {
                return Err(BuildError::Unsound { solid: solid.name.clone(), what });
            }
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
        Ok(())
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

/// Greatest distance of an edge from a face that readers take: FreeCAD's check refuses 1e-7 with its own
/// interpolation's part in it (DESIGN 6).
const GREATEST_EDGE_DISTANCE: f64 = 3e-8;

/// The first thing wrong with a solid, if any: the last gate before anything is written.
fn unsound(model: &Model, check: &SolidCheck) -> Option<String> {
    if let Some(fault) = check.faults.first() {
        return Some(fault.to_string());
    }
    let distance = check.max_edge_distance_mm;
    (!(distance <= GREATEST_EDGE_DISTANCE)).then(|| {
        let face = check.max_edge_distance_at.map_or("a face", |at| model.face(at.face).name.as_str());
        format!("an edge lies {distance:.1e} mm off {face}, {GREATEST_EDGE_DISTANCE:.0e} mm is allowed")
    })
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

fn hole_report(hole: &FilmHoleGeometry, integrals: &[FaceIntegrals]) -> HoleReport {
    HoleReport {
        name: format!("film/{}/{:03}", hole.row, hole.number),
        passage: hole.passage.clone(),
        position_mm: hole.exit.to_array(),
        direction: hole.axis.to_array(),
        diameter_mm: hole.diameter,
        length_mm: hole.length,
        length_d: hole.length / hole.diameter,
        inclination_deg: hole.angles_deg[0],
        compound_deg: hole.angles_deg[1],
        area_ratio: hole.area_ratio,
        breakout_mm2: hole.exits.iter().map(|f| integrals[f.0].area_mm2).sum(),
        coverage: hole.coverage,
        ligament_mm: hole.ligament,
    }
}

fn slot_report(slot: &SlotGeometry, integrals: &[FaceIntegrals]) -> SlotReport {
    SlotReport {
        name: format!("slot/{}/{:03}", slot.row, slot.number),
        passage: slot.passage.clone(),
        position_mm: slot.exit.to_array(),
        direction: slot.axis.to_array(),
        height_mm: slot.size[0],
        width_mm: slot.size[1],
        length_mm: slot.length,
        land_mm: slot.land,
        side_walls_mm: slot.side_walls,
        open_length_mm: slot.open_length,
        breakout_mm2: slot.exits.iter().map(|f| integrals[f.0].area_mm2).sum(),
    }
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
