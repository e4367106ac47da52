//! The design: one JSON document, its types, and what may be said in it.
//!
//! The types here are the one definition of every parameter: the JSON Schema, the help, the add-ons' fields and the
//! reference page are generated from them. Lengths are millimetres, angles degrees.

mod chambers;
mod crossovers;
mod dust_holes;
mod film;
mod groups;
mod inserts;
mod pattern;
mod pins;
mod radial_holes;
mod read;
mod schema;
mod slots;
mod spelling;
mod turns;
mod words;

pub use chambers::{Chamber, Shell, Wall};
pub use crossovers::CrossoverRow;
pub use dust_holes::DustHole;
pub use film::{FilmHole, FilmRow, HoleShape, Side};
pub use groups::{FaceGroup, Role};
pub use inserts::{Insert, InsertSide, JetArray};
pub use pattern::{AnnulusWall, Pattern};
pub use pins::PinArray;
pub use radial_holes::{HolePlacement, RadialHole};
pub use schema::{design_schema, faults_against, schema_faults};
pub use slots::{Cutback, SlotRow};
pub use turns::{Automatic, Clearance, SpanEnd, Turn};

use crate::plan::Plan;
use coolinggen_blade::{BladeSource, Fault, SpaceSpec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The format this version reads.
pub const FORMAT: &str = "coolinggen/1";

/// A blade and its cooling.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Design {
    /// Version of the format: `coolinggen/1`.
    #[schemars(extend("const" = "coolinggen/1"))]
    pub format: String,
    /// Name of the design; the names of the files written begin with it.
    #[schemars(regex(pattern = r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,63}$"))]
    #[schemars(extend("group" = "Design"))]
    pub name: String,
    /// A sentence about the design.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("group" = "Design"))]
    pub description: Option<String>,
    /// Where the blade stands: an annulus or a linear cascade.
    #[schemars(extend("group" = "Blade"))]
    pub space: SpaceSpec,
    /// The blade's outer surface.
    #[schemars(extend("group" = "Blade"))]
    pub blade: BladeSource,
    /// What is inside; a blade without it is exported solid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cooling: Option<Cooling>,
    /// The row that the blade is one of; without it, one blade alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("group" = "Row"))]
    pub pattern: Option<Pattern>,
    /// Groups of faces other than those that the names imply.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    #[schemars(extend("group" = "Groups"))]
    pub groups: Vec<FaceGroup>,
}

/// What is inside the blade.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cooling {
    /// Metal between the outer surface and the chambers. Needed when there are chambers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("group" = "Chambers"))]
    pub shell: Option<Shell>,
    /// Walls between chambers, from the leading to the trailing edge.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 32))]
    #[schemars(extend("group" = "Chambers"))]
    pub walls: Vec<Wall>,
    /// Chambers from the leading to the trailing edge, one more than walls.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 33))]
    #[schemars(extend("group" = "Chambers"))]
    pub chambers: Vec<Chamber>,
    /// Turns: each joins two neighbouring chambers at the tip or at the hub into one passage.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 64))]
    #[schemars(extend("group" = "Chambers"))]
    pub turns: Vec<Turn>,
    /// Impingement inserts: sheet-metal tubes in chambers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 33))]
    #[schemars(extend("group" = "Inserts"))]
    pub inserts: Vec<Insert>,
    /// Round passages straight from hub to tip.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    #[schemars(extend("group" = "Holes"))]
    pub radial_holes: Vec<RadialHole>,
    /// Rows of film holes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    #[schemars(extend("group" = "Film cooling"))]
    pub film_rows: Vec<FilmRow>,
    /// Rows of slots through the trailing edge.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    #[schemars(extend("group" = "Trailing edge"))]
    pub slot_rows: Vec<SlotRow>,
    /// Rows of holes through walls.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    #[schemars(extend("group" = "Holes"))]
    pub crossover_rows: Vec<CrossoverRow>,
    /// Arrays of pins between the sides of chambers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    #[schemars(extend("group" = "Pins"))]
    pub pin_arrays: Vec<PinArray>,
    /// Holes through the tip.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 1000))]
    #[schemars(extend("group" = "Holes"))]
    pub dust_holes: Vec<DustHole>,
    /// Least metal between neighbouring holes, between neighbouring slots, and between a slot and the blade's sides, and
    /// least passage between neighbouring pins, mm; less is refused.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0), extend("unit" = "mm"))]
    #[schemars(extend("group" = "Holes"))]
    pub least_ligament: f64,
    /// Length by which the coolant goes on straight before its inlets at the hub, along the hub's normal in the middle of
    /// all inlets to planes across it, mm from the middle of each: room for a flow solver's inlet. The gap round an insert
    /// and its plenum go on side by side, as far apart as the sheet parts them. Metal and insert are as without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.01, max = 10_000.0), extend("unit" = "mm"))]
    #[schemars(extend("group" = "Chambers"))]
    pub inlet_extension: Option<f64>,
}

/// Greatest size of a design document, bytes.
const LARGEST: usize = 64 << 20;

impl Design {
    /// Reads a design: its syntax, then the schema with every fault in it.
    ///
    /// # Errors
    /// All faults found, each with its JSON pointer.
    pub fn from_json(text: &str) -> Result<Self, Vec<Fault>> {
        if text.len() > LARGEST {
            let message = format!("the design has {} bytes", text.len());
            return Err(vec![Fault::new("", "too_large", message).max(LARGEST as f64).unit("bytes")]);
        }
        let (value, mut faults) = read::read(text)?;
        let cut: Vec<String> = faults.iter().map(|f| f.pointer.clone()).collect();
        faults.extend(schema_faults(&value).into_iter().filter(|f| !cut.contains(&f.pointer)));
        if !faults.is_empty() {
            // What is of the right types may be wrong in other ways, too: say so at once.
            if let Ok(design) = serde_json::from_value::<Self>(value) {
                let known: Vec<String> = faults.iter().map(|f| f.pointer.clone()).collect();
                let more = design.cooling.as_ref().and_then(|c| Plan::new(c).err()).unwrap_or_default();
                faults.extend(more.into_iter().filter(|f| !known.iter().any(|k| f.pointer.starts_with(k))));
            }
            return Err(faults);
        }
        serde_json::from_value(value).map_err(|e| {
            // The schema accepts what the types do not: a fault of ours, said rather than hidden.
            vec![Fault::new("", "type", format!("the design does not fit its schema: {e}"))]
        })
    }

    /// Reads a design from a file; paths in it are relative to the file's folder, see [`Design::folder_of`].
    ///
    /// # Errors
    /// As [`Design::from_json`], or a single fault if the file cannot be read.
    pub fn from_file(path: &Path) -> Result<Self, Vec<Fault>> {
        let bytes = std::fs::read(path)
            .map_err(|e| vec![Fault::new("", "file", format!("cannot read {}: {e}", path.display()))])?;
        let text = String::from_utf8(bytes)
            .map_err(|e| vec![Fault::new("", "syntax", format!("{} is not UTF-8: {e}", path.display()))])?;
        Self::from_json(&text)
    }

    /// The folder that relative paths in the design of this file refer to.
    pub fn folder_of(path: &Path) -> &Path {
        path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."))
    }
}
