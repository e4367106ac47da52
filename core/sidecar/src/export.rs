//! The files of a generated design: formats, parts and their names.

use clap::ValueEnum;
use coolinggen_cooling::Generated;
use coolinggen_exporters as exporters;
use exporters::{ExportError, StepOptions, Tessellation, TessellationOptions, write_atomically};
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Format {
    /// STEP AP214, exact
    Step,
    /// Binary glTF
    Glb,
    /// Wavefront OBJ with its materials
    Obj,
    /// ASCII STL with a region a face
    Stl,
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

/// What to write, and where.
pub(crate) struct Export<'a> {
    pub(crate) folder: &'a Path,
    pub(crate) formats: &'a [Format],
    pub(crate) solids: &'a [SolidChoice],
    pub(crate) tessellation: TessellationOptions,
}

/// A failed export: what could not be done with which file, and why.
pub(crate) struct ExportFailure {
    pub(crate) what: &'static str,
    pub(crate) path: PathBuf,
    pub(crate) error: ExportError,
}

impl ExportFailure {
    pub(crate) fn new(what: &'static str, path: &Path, error: impl Into<ExportError>) -> Self {
        Self { what, path: path.to_owned(), error: error.into() }
    }
}

impl Export<'_> {
    /// Steps that [`Export::write`] tells at most.
    pub(crate) fn steps(&self) -> usize {
        self.formats.len() * self.solids.len() + usize::from(self.needs_mesh())
    }

    fn needs_mesh(&self) -> bool {
        self.formats.iter().any(|f| *f != Format::Step)
    }

    /// Writes the files `<name>.<part>.<extension>`, each complete or not at all, and tells each `step` before it is
    /// made; `step` stops the work by answering false. The answer is what was written.
    pub(crate) fn write(
        &self,
        generated: &Generated,
        step: &mut dyn FnMut(&str) -> bool,
    ) -> Result<Vec<PathBuf>, ExportFailure> {
        let model = &generated.blade.model;
        std::fs::create_dir_all(self.folder)
            .map_err(|e| ExportFailure::new("make the folder", self.folder, e))?;
        let mut written = Vec::new();
        let mesh = if self.needs_mesh() {
            if !step("tessellating") {
                return Ok(written);
            }
            let mesh = exporters::tessellate(model, &self.tessellation);
            Some(mesh.map_err(|e| ExportFailure::new("write into", self.folder, e))?)
        } else {
            None
        };
        for choice in self.solids {
            let (part, chosen) = choice.parts();
            let names: Vec<&str> =
                model.solids.iter().map(|s| s.name.as_str()).filter(|n| n.starts_with(chosen)).collect();
            if names.is_empty() {
                continue;
            }
            for format in self.formats {
                if *choice == SolidChoice::Assembly && matches!(format, Format::Obj | Format::Stl) {
                    continue;
                }
                let stem = format!("{}.{part}", generated.report.name);
                let extension =
                    format.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned());
                let path = self.folder.join(format!("{stem}.{extension}"));
                if !step(&path.display().to_string()) {
                    return Ok(written);
                }
                let wrote = self.file(*format, generated, &names, mesh.as_ref(), &path, &stem);
                written.extend(wrote.map_err(|e| ExportFailure::new("write", &path, e))?);
            }
        }
        Ok(written)
    }

    fn file(
        &self,
        format: Format,
        generated: &Generated,
        names: &[&str],
        mesh: Option<&Tessellation>,
        path: &Path,
        stem: &str,
    ) -> Result<Vec<PathBuf>, ExportError> {
        let model = &generated.blade.model;
        let mut written = vec![path.to_owned()];
        match (format, mesh) {
            (Format::Step, _) => {
                let options = StepOptions { name: stem.to_owned(), ..StepOptions::default() };
                write_atomically(path, |out| exporters::write_step(model, names, &options, out))?;
            }
            (_, None) => written.clear(),
            (Format::Glb, Some(mesh)) => {
                write_atomically(path, |out| exporters::write_glb(model, names, mesh, out))?;
            }
            (Format::Stl, Some(mesh)) => {
                write_atomically(path, |out| exporters::write_stl(model, names, mesh, out))?;
            }
            (Format::Obj, Some(mesh)) => {
                let library = format!("{stem}.mtl");
                let beside = self.folder.join(&library);
                write_atomically(&beside, |out| exporters::write_mtl(model, names, out))?;
                write_atomically(path, |out| exporters::write_obj(model, names, mesh, &library, out))?;
                written.push(beside);
            }
        }
        Ok(written)
    }
}
