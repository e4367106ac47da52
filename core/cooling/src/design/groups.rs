//! Groups of faces, where the design wants others than those that the names imply.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Faces that go into a group of the design's choice, in the files for meshers and solvers.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FaceGroup {
    /// Names of the faces; `*` stands for any letters, `?` for one, e.g. `film/head_*/exit`. Of several entries that a
    /// face fits, the first counts.
    #[schemars(length(min = 1, max = 256))]
    pub faces: String,
    /// Name of the group.
    #[schemars(regex(pattern = r"^[A-Za-z0-9][A-Za-z0-9_./-]{0,63}$"))]
    pub name: String,
    /// What the faces are for; without it, what their names imply.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub role: Option<Role>,
}

/// What a face is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// The blade's outer surface, in the hot gas
    HotWall,
    /// The metal's end at the hub
    Hub,
    /// The metal's end at the tip
    Tip,
    /// Walls of chambers, turns and radial holes
    CoolantWall,
    /// Walls of film holes, slots, crossover holes and dust holes
    BoreWall,
    /// Walls of pins
    PinWall,
    /// Sides of an insert's sheet
    InsertWall,
    /// Walls of an insert's jets
    JetWall,
    /// Where coolant enters
    CoolantInlet,
    /// Where coolant leaves a passage at the tip or the hub
    CoolantOutlet,
    /// Where a film hole opens into the hot gas
    FilmExit,
    /// Where a slot opens into the hot gas
    SlotExit,
    /// Where a dust hole opens at the tip
    TipExit,
    /// Hub and shroud as solids of their own
    AnnulusWall,
    /// Anything else
    Other,
}

impl Role {
    /// Its name in designs and files.
    pub fn name(self) -> String {
        let name = serde_json::to_value(self).ok();
        name.as_ref().and_then(|n| n.as_str()).unwrap_or_default().to_owned()
    }
}
