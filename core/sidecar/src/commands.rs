//! The commands: read, build, write, print.

use crate::arguments::GenerateOptions;
use crate::export::Export;
use crate::outcome::Failure;
use crate::progress::Progress;
use crate::templates::TEMPLATES;
use coolinggen_blade::Fault;
use coolinggen_cooling::design::{Design, design_schema};
use coolinggen_cooling::{Generated, generate as build};
use coolinggen_exporters::{TessellationOptions, write_atomically};
use std::io::Write;
use std::mem::ManuallyDrop;
use std::path::Path;
use std::time::Instant;

/// Prints a template.
pub(crate) fn new(template: Option<&str>) -> Result<(), Failure> {
    let chosen = match template {
        None => Some(&TEMPLATES[0]),
        Some(name) => TEMPLATES.iter().find(|(n, _)| *n == name),
    };
    match chosen {
        Some((_, text)) => print(text),
        None => {
            let names: Vec<&str> = TEMPLATES.iter().map(|(n, _)| *n).collect();
            let message = format!("there is no template \"{}\"", template.unwrap_or_default());
            let fault = Fault::new("", "template", message).hint(format!("one of {}", names.join(", ")));
            Err(Failure::refused(vec![fault], false))
        }
    }
}

/// Prints the schema.
pub(crate) fn schema() -> Result<(), Failure> {
    print(&format!("{:#}\n", design_schema()))
}

/// Reads and builds a design, to say what is wrong with it.
pub(crate) fn validate(path: &Path, json: bool) -> Result<(), Failure> {
    read_and_build(path, json)?;
    print(if json { "{\n  \"faults\": []\n}\n" } else { "the design is sound\n" })
}

/// Prints the report.
pub(crate) fn inspect(path: &Path, json: bool) -> Result<(), Failure> {
    // What ends with the process needs no freeing.
    let generated = ManuallyDrop::new(read_and_build(path, json)?);
    if json {
        print(&format!("{:#}\n", *ManuallyDrop::new(generated.report.to_json())))
    } else {
        print(&generated.report.to_text())
    }
}

/// Builds a design and writes the files.
pub(crate) fn generate(options: &GenerateOptions) -> Result<(), Failure> {
    let json = options.json;
    let generated = ManuallyDrop::new(read_and_build(&options.design, json)?);
    let mut report = generated.report.to_json();
    let started = Instant::now();
    write_solids(options, &generated)?;
    report["timings_ms"]["export"] = (started.elapsed().as_secs_f64() * 1e3).into();
    let text = format!("{report:#}\n");
    let path = options.out.join(format!("{}.report.json", generated.report.name));
    write_atomically(&path, |out| Ok(out.write_all(text.as_bytes())?))
        .map_err(|e| Failure::file("write", &path, e, json))?;
    if json { print(&text) } else { print(&generated.report.to_text()) }
}

fn read_and_build(path: &Path, json: bool) -> Result<Generated, Failure> {
    let refuse = |faults| Failure::refused(faults, json);
    if !path.is_file() {
        return Err(Failure::other(format!("there is no file {}", path.display()), json));
    }
    let design = Design::from_file(path).map_err(refuse)?;
    let progress = Progress::new(1);
    progress.step("building");
    let generated = build(&design, Design::folder_of(path)).map_err(refuse)?;
    progress.done();
    Ok(generated)
}

fn write_solids(options: &GenerateOptions, generated: &Generated) -> Result<(), Failure> {
    let export = Export {
        folder: &options.out,
        formats: &options.format,
        solids: &options.solids,
        tessellation: TessellationOptions {
            chord_mm: options.chord,
            angle_deg: options.angle,
            ..TessellationOptions::default()
        },
        stop: &|| false,
    };
    let progress = Progress::new(export.steps() as u64);
    let mut started = false;
    let written = export.write(generated, &mut |step| {
        if std::mem::replace(&mut started, true) {
            progress.done();
        }
        progress.step(step);
    });
    match written {
        Ok(_) => Ok(()),
        Err(failure) => Err(Failure::file(failure.what, &failure.path, failure.error, options.json)),
    }
}

/// Prints to standard output; a closed pipe is the reader's wish, not an error.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(Failure::other(error, false)),
        _ => Ok(()),
    }
}
