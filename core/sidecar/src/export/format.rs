//! Formats and parts: what can be asked for.

use clap::ValueEnum;
use coolinggen_brep::Model;
use coolinggen_exporters::{IgesForm, StepSchema};
use schemars::JsonSchema;
use serde::Deserialize;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Format {
    /// STEP AP214, exact
    Step,
    /// STEP AP242, exact, faces named by shape aspects, too
    #[value(name = "step_ap242")]
    StepAp242,
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
    /// Nastran bulk data, triangles with a property a group
    Nastran,
    /// A script for Gmsh, with the BREP file of all solids that it meshes
    Gmsh,
    /// A case for OpenFOAM: surfaces, and the dictionaries for snappyHexMesh
    Openfoam,
}

impl Format {
    /// Names of all formats, as the command line and the protocol have them.
    pub(crate) fn names() -> Vec<String> {
        let names = Self::value_variants().iter().filter_map(ValueEnum::to_possible_value);
        names.map(|v| v.get_name().to_owned()).collect()
    }

    /// What the names of its files end with.
    pub(super) fn extension(self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::StepAp242 => "ap242.step",
            Self::Brep => "brep",
            Self::Iges => "igs",
            Self::IgesSurfaces => "surfaces.igs",
            Self::Glb => "glb",
            Self::Obj => "obj",
            Self::Stl => "stl",
            Self::Nastran => "nas",
            Self::Gmsh => "gmsh.py",
            Self::Openfoam => "openfoam",
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

    /// The application protocol of a STEP file of this format.
    pub(super) fn step_schema(self) -> StepSchema {
        match self {
            Self::StepAp242 => StepSchema::Ap242,
            _ => StepSchema::Ap214,
        }
    }

    /// Whether it is written from a mesh.
    pub(super) fn is_mesh(self) -> bool {
        matches!(self, Self::Glb | Self::Obj | Self::Stl | Self::Nastran | Self::Openfoam)
    }

    /// Whether several solids in one file stay apart.
    pub(super) fn holds_solids(self) -> bool {
        !matches!(self, Self::Obj | Self::Stl)
    }

    /// Whether it is one for all solids, not a file a part.
    pub(super) fn is_whole(self) -> bool {
        matches!(self, Self::Gmsh | Self::Openfoam)
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
    /// Its part of the files' names.
    pub(super) fn part(self) -> &'static str {
        self.parts().0
    }

    /// The names of its solids.
    pub(super) fn names(self, model: &Model) -> Vec<&str> {
        model.solids.iter().map(|s| s.name.as_str()).filter(|n| n.starts_with(self.parts().1)).collect()
    }

    /// Its part of the files' names, and what the names of its solids begin with.
    fn parts(self) -> (&'static str, &'static str) {
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
