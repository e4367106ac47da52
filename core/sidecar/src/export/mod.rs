//! The files of a generated design: formats, parts and their names.

mod format;

use coolinggen_cooling::Generated;
use coolinggen_cooling::report::FaceReport;
use coolinggen_exporters as exporters;
use exporters::{
    ExportError, FacePlace, IgesOptions, KeptMeshes, Listed, StepOptions, Tessellation, TessellationOptions,
    manifest, write_atomically,
};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

pub(crate) use format::{Format, SolidChoice};

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
        let files = self.formats.len() + usize::from(self.needs_panels());
        files * self.solids.len() + usize::from(self.needs_mesh()) + 1
    }

    fn needs_panels(&self) -> bool {
        self.formats.iter().any(|f| f.iges_form().is_some())
    }

    fn needs_mesh(&self) -> bool {
        self.formats.iter().any(|f| f.is_mesh())
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
        let (mut written, mut listed) = (Vec::new(), Vec::new());
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
                if *choice == SolidChoice::Assembly && !format.holds_solids() {
                    continue;
                }
                let stem = format!("{}.{part}", generated.report.name);
                let file = format!("{stem}.{}", format.extension());
                let path = self.folder.join(&file);
                step(&path.display().to_string());
                let wrote = self.file(*format, generated, &names, mesh.as_ref(), &path, &stem);
                written.extend(wrote.map_err(|e| ExportFailure::new("write", &path, e))?);
                listed.push(Listed { file, solids: names.iter().map(|n| (*n).to_owned()).collect() });
            }
            if self.needs_panels() {
                let path = self.folder.join(format!("{}.{part}.centaur.csv", generated.report.name));
                step(&path.display().to_string());
                let wrote = self.atomically(&path, |out| {
                    exporters::write_panels(model, &names, &generated.grouping, out)
                });
                wrote.map_err(|e| ExportFailure::new("write", &path, e))?;
                written.push(path);
            }
        }
        let path = self.folder.join(format!("{}.groups.json", generated.report.name));
        step(&path.display().to_string());
        let wrote = self.atomically(&path, |out| {
            let faces = generated.report.faces.iter();
            let place = |f: &FaceReport| FacePlace { area_mm2: f.area_mm2, centroid_mm: f.centroid_mm };
            let places: Vec<FacePlace> = faces.map(place).collect();
            Ok(writeln!(out, "{:#}", manifest(model, &generated.grouping, &places, &listed))?)
        });
        wrote.map_err(|e| ExportFailure::new("write", &path, e))?;
        written.push(path);
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
            (Format::Brep, _) => self.atomically(path, |out| exporters::write_brep(model, names, out))?,
            (Format::Iges | Format::IgesSurfaces, _) => {
                let options = IgesOptions {
                    name: stem.to_owned(),
                    file_name: format!("{stem}.{}", format.extension()),
                    form: format.iges_form().unwrap_or_default(),
                    ..IgesOptions::default()
                };
                self.atomically(path, |out| {
                    exporters::write_iges(model, names, &generated.grouping, &options, out)
                })?;
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
