//! The files of a generated design: formats, parts and their names.

use clap::ValueEnum;
use coolinggen_cooling::Generated;
use coolinggen_exporters as exporters;
use exporters::{ExportError, KeptMeshes, StepOptions, Tessellation, TessellationOptions, write_atomically};
use schemars::JsonSchema;
use serde::Deserialize;
use std::fs::File;
use std::io::{self, BufWriter, Write};
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
    /// Says when to stop.
    pub(crate) stop: &'a (dyn Fn() -> bool + Sync),
}

/// A writer that fails once it is to stop.
struct Stoppable<'a, W> {
    out: &'a mut W,
    stop: &'a (dyn Fn() -> bool + Sync),
}

impl<W: Write> Write for Stoppable<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if (self.stop)() { Err(io::Error::other("it was told to stop")) } else { self.out.write(bytes) }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
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
    /// made. The answer is what was written; an error where it was told to stop.
    pub(crate) fn write(
        &self,
        generated: &Generated,
        step: &mut dyn FnMut(&str),
    ) -> Result<Vec<PathBuf>, ExportFailure> {
        let model = &generated.blade.model;
        std::fs::create_dir_all(self.folder)
            .map_err(|e| ExportFailure::new("make the folder", self.folder, e))?;
        let mut written = Vec::new();
        let mesh = if self.needs_mesh() {
            step("tessellating");
            let kept = &mut KeptMeshes::default();
            let mesh = exporters::tessellate_again(model, &self.tessellation, kept, self.stop);
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
                step(&path.display().to_string());
                let wrote = self.file(*format, generated, &names, mesh.as_ref(), &path, &stem);
                written.extend(wrote.map_err(|e| ExportFailure::new("write", &path, e))?);
            }
        }
        Ok(written)
    }

    /// Writes a file in one piece or not at all.
    fn atomically(
        &self,
        path: &Path,
        write: impl FnOnce(&mut Stoppable<'_, BufWriter<File>>) -> Result<(), ExportError>,
    ) -> Result<(), ExportError> {
        write_atomically(path, |out| write(&mut Stoppable { out, stop: self.stop }))
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
                self.atomically(path, |out| exporters::write_step(model, names, &options, out))?;
            }
            (_, None) => written.clear(),
            (Format::Glb, Some(mesh)) => {
                self.atomically(path, |out| exporters::write_glb(model, names, mesh, out))?;
            }
            (Format::Stl, Some(mesh)) => {
                self.atomically(path, |out| exporters::write_stl(model, names, mesh, out))?;
            }
            (Format::Obj, Some(mesh)) => {
                let library = format!("{stem}.mtl");
                let beside = self.folder.join(&library);
                self.atomically(&beside, |out| exporters::write_mtl(model, names, out))?;
                self.atomically(path, |out| exporters::write_obj(model, names, mesh, &library, out))?;
                written.push(beside);
            }
        }
        Ok(written)
    }
}
