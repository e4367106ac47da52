//! The files of a generated design: formats, parts and their names.

mod format;

use coolinggen_cooling::Generated;
use coolinggen_cooling::report::FaceReport;
use coolinggen_exporters as exporters;
use exporters::{
    CaseFile, CaseOptions, ExportError, FacePlace, IgesOptions, KeptMeshes, Listed, StepOptions,
    Tessellation, TessellationOptions, manifest, write_atomically,
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
        let of_format = |format: &Format| match format {
            // A case is one step, however many files it has.
            Format::Openfoam => 1,
            // The shape, the script.
            Format::Gmsh => 2,
            // With the materials, with the table of panels.
            Format::Obj | Format::Iges | Format::IgesSurfaces => 2 * self.solids.len(),
            _ => self.solids.len(),
        };
        let files: usize = self.formats.iter().map(of_format).sum();
        files + usize::from(self.needs_mesh()) + 1
    }

    fn needs_mesh(&self) -> bool {
        self.formats.iter().any(|f| f.is_mesh())
    }

    /// Writes the files `<name>.<part>.<extension>` and `<name>.groups.json`, each complete or not at all, and tells each
    /// `step` before it is made. The answer is what was written; an error where it was told to stop.
    pub(crate) fn write(
        &self,
        generated: &Generated,
        step: &mut dyn FnMut(&str),
    ) -> Result<Vec<PathBuf>, ExportFailure> {
        std::fs::create_dir_all(self.folder)
            .map_err(|e| ExportFailure::new("make the folder", self.folder, e))?;
        let mesh = if self.needs_mesh() {
            step("tessellating");
            let kept = &mut KeptMeshes::default();
            let mesh =
                exporters::tessellate_again(&generated.blade.model, &self.tessellation, kept, self.stop);
            mesh.map_err(|e| ExportFailure::new("write into", self.folder, e))?
        } else {
            Tessellation::default()
        };
        let places = places(generated);
        let mut writing =
            Writing { export: self, generated, places, mesh, step, written: Vec::new(), listed: Vec::new() };
        for choice in self.solids {
            let names = choice.names(&generated.blade.model);
            let kept = |f: &&Format| !f.is_whole() && (*choice != SolidChoice::Assembly || f.holds_solids());
            for format in self.formats.iter().filter(kept).filter(|_| !names.is_empty()) {
                writing.part(*format, *choice, &names)?;
            }
        }
        for format in self.formats.iter().filter(|f| f.is_whole()) {
            writing.whole(*format)?;
        }
        writing.manifest()?;
        Ok(writing.written)
    }
}

type Out<'a> = Stoppable<'a, BufWriter<File>>;

/// The files of one design, being written.
struct Writing<'a> {
    export: &'a Export<'a>,
    generated: &'a Generated,
    /// What is known of each face.
    places: Vec<FacePlace>,
    /// Without a triangle where no format needs any.
    mesh: Tessellation,
    step: &'a mut dyn FnMut(&str),
    written: Vec<PathBuf>,
    listed: Vec<Listed>,
}

impl Writing<'_> {
    /// A step: a file of the folder.
    fn file(
        &mut self,
        name: &str,
        write: impl FnOnce(&Self, &mut Out<'_>) -> Result<(), ExportError>,
    ) -> Result<(), ExportFailure> {
        self.tell(name);
        self.place(name, write)
    }

    /// Tells of a step that makes the file or the folder of this name.
    fn tell(&mut self, name: &str) {
        (self.step)(&self.export.folder.join(name).display().to_string());
    }

    /// Writes a file of the folder in one piece or not at all.
    fn place(
        &mut self,
        name: &str,
        write: impl FnOnce(&Self, &mut Out<'_>) -> Result<(), ExportError>,
    ) -> Result<(), ExportFailure> {
        let path = self.export.folder.join(name);
        write_atomically(&path, |out| write(self, &mut Stoppable { out, stop: self.export.stop }))
            .map_err(|e| ExportFailure::new("write", &path, e))?;
        self.written.push(path);
        Ok(())
    }

    /// The files of some solids in a format.
    fn part(&mut self, format: Format, choice: SolidChoice, names: &[&str]) -> Result<(), ExportFailure> {
        let model = &self.generated.blade.model;
        let stem = format!("{}.{}", self.generated.report.name, choice.part());
        let file = format!("{stem}.{}", format.extension());
        if self.listed.iter().any(|listed| listed.file == file) {
            return Ok(());
        }
        let library = format!("{stem}.mtl");
        if format == Format::Obj {
            self.file(&library, |_, out| exporters::write_mtl(model, names, out))?;
        }
        self.file(&file, |this, out| match format {
            Format::Step | Format::StepAp242 => {
                let options = StepOptions {
                    name: stem.clone(),
                    schema: format.step_schema(),
                    ..StepOptions::default()
                };
                exporters::write_step(model, names, &options, out)
            }
            Format::Brep => exporters::write_brep(model, names, out),
            Format::Iges | Format::IgesSurfaces => {
                let options = IgesOptions {
                    name: stem.clone(),
                    file_name: file.clone(),
                    form: format.iges_form().unwrap_or_default(),
                    ..IgesOptions::default()
                };
                exporters::write_iges(model, names, &this.generated.grouping, &options, out)
            }
            Format::Glb => exporters::write_glb(model, names, &this.mesh, out),
            Format::Obj => exporters::write_obj(model, names, &this.mesh, &library, out),
            Format::Stl => exporters::write_stl(model, names, &this.mesh, out),
            Format::Nastran => {
                exporters::write_nastran(model, names, &this.mesh, &this.generated.grouping, out)
            }
            // Not of parts: see `whole`.
            Format::Gmsh | Format::Openfoam => Ok(()),
        })?;
        if format.iges_form().is_some() {
            self.panels(&stem, names)?;
        }
        self.listed.push(Listed { file, solids: names.iter().map(|n| (*n).to_owned()).collect() });
        Ok(())
    }

    /// The table of panels beside the IGES files of some solids, once.
    fn panels(&mut self, stem: &str, names: &[&str]) -> Result<(), ExportFailure> {
        let table = format!("{stem}.centaur.csv");
        if self.written.contains(&self.export.folder.join(&table)) {
            return Ok(());
        }
        let Generated { blade, grouping, .. } = self.generated;
        self.file(&table, |_, out| exporters::write_panels(&blade.model, names, grouping, out))
    }

    /// What a format writes of all solids at once.
    fn whole(&mut self, format: Format) -> Result<(), ExportFailure> {
        let name = self.generated.report.name.clone();
        let target = format!("{name}.{}", format.extension());
        if format == Format::Openfoam {
            return self.openfoam_case(&target);
        }
        let assembly = SolidChoice::Assembly;
        self.part(Format::Brep, assembly, &assembly.names(&self.generated.blade.model))?;
        self.file(&target, |_, out| {
            let shape = format!("{name}.{}.{}", assembly.part(), Format::Brep.extension());
            exporters::write_gmsh_script(&name, &shape, &manifest_name(&name), out)
        })
    }

    /// The files of a case, in a folder of their own.
    fn openfoam_case(&mut self, folder: &str) -> Result<(), ExportFailure> {
        self.tell(folder);
        let Generated { blade, grouping, .. } = self.generated;
        let options = CaseOptions { is_fluid: &|solid| solid.starts_with("coolant/"), places: &self.places };
        let path = self.export.folder.join(folder);
        let files = exporters::openfoam_case(&blade.model, &self.mesh, grouping, &options)
            .map_err(|e| ExportFailure::new("write", &path, e))?;
        for CaseFile { path, content } in files {
            let path = format!("{folder}/{path}");
            let parent = self.export.folder.join(&path);
            let parent = parent.parent().unwrap_or(self.export.folder);
            std::fs::create_dir_all(parent).map_err(|e| ExportFailure::new("make the folder", parent, e))?;
            self.place(&path, |_, out| Ok(out.write_all(&content)?))?;
        }
        Ok(())
    }

    /// What is where in the files.
    fn manifest(&mut self) -> Result<(), ExportFailure> {
        let Generated { blade, grouping, report, .. } = self.generated;
        self.file(&manifest_name(&report.name), |this, out| {
            Ok(writeln!(out, "{:#}", manifest(&blade.model, grouping, &this.places, &this.listed))?)
        })
    }
}

/// What the report knows of each face.
fn places(generated: &Generated) -> Vec<FacePlace> {
    let report = &generated.report;
    let place = |(face, feature_mm): (&FaceReport, Option<f64>)| FacePlace {
        area_mm2: face.area_mm2,
        centroid_mm: face.centroid_mm,
        feature_mm,
    };
    report.faces.iter().zip(report.feature_sizes_mm()).map(place).collect()
}

fn manifest_name(design: &str) -> String {
    format!("{design}.groups.json")
}
