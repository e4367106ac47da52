//! Formats and parts: what can be asked for.

use clap::ValueEnum;
use coolinggen_exporters::IgesForm;
use schemars::JsonSchema;
use serde::Deserialize;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Format {
    /// STEP AP214, exact
    Step,
    /// OpenCASCADE's own format, exact and fastest to read
    Brep,
    /// IGES 5.3, solids whose faces share edges, with the table of panels for CENTAUR
    Iges,
    /// IGES 5.3, a trimmed surface a face, with the same table
    #[value(name = "iges_surfaces")]
    IgesSurfaces,
    /// Binary glTF
    Glb,
    /// Wavefront OBJ with its materials
    Obj,
    /// ASCII STL with a region a face
    Stl,
}

impl Format {
    /// Names of all formats, as the command line and the protocol have them.
    pub(crate) fn names() -> Vec<String> {
        Self::value_variants().iter().copied().map(Self::name).collect()
    }

    fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned())
    }

    /// What the names of its files end with.
    pub(super) fn extension(self) -> String {
        match self {
            Self::Iges => "igs".to_owned(),
            Self::IgesSurfaces => "surfaces.igs".to_owned(),
            other => other.name(),
        }
    }

    /// What an IGES file of this format is made of.
    pub(super) fn iges_form(self) -> Option<IgesForm> {
        match self {
            Self::Iges => Some(IgesForm::Solids),
            Self::IgesSurfaces => Some(IgesForm::TrimmedSurfaces),
            _ => None,
        }
    }

    /// Whether it is written from a mesh.
    pub(super) fn is_mesh(self) -> bool {
        matches!(self, Self::Glb | Self::Obj | Self::Stl)
    }

    /// Whether several solids in one file stay apart.
    pub(super) fn holds_solids(self) -> bool {
        !matches!(self, Self::Obj | Self::Stl)
    }
}

/// Which solids go into one file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum SolidChoice {
    /// The blade's material
    Metal,
    /// The sheets in its chambers, a solid an insert
    Insert,
    /// What fills its passages, a solid a passage
    Coolant,
    /// The hub, where the design asks for it
    Hub,
    /// The shroud, where the design asks for it
    Shroud,
    /// Everything in one file
    Assembly,
}

impl SolidChoice {
    /// Its part of the files' names, and what the names of its solids begin with.
    pub(super) fn parts(self) -> (&'static str, &'static str) {
        match self {
            Self::Metal => ("metal", "metal"),
            Self::Insert => ("insert", "insert/"),
            Self::Coolant => ("coolant", "coolant/"),
            Self::Hub => ("hub", "hub"),
            Self::Shroud => ("shroud", "shroud"),
            Self::Assembly => ("assembly", ""),
        }
    }
}
