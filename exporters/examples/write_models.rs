//! Writes the hand-built test models in every format: `cargo run --example write_models -- FOLDER`.

#[path = "../tests/support/mod.rs"]
mod support;

use coolinggen_brep::Grouping;
use coolinggen_exporters::{
    IgesForm, IgesOptions, StepOptions, TessellationOptions, tessellate, write_atomically, write_glb,
    write_iges, write_mtl, write_obj, write_step, write_stl,
};
use std::path::Path;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("usage: write_models FOLDER")?;
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    for (name, model) in support::all() {
        let options = StepOptions { name: name.to_owned(), ..StepOptions::default() };
        let start = Instant::now();
        let mesh = tessellate(&model, &TessellationOptions::default())?;
        println!("{name}: {} triangles in {:?}", mesh.triangle_count(), start.elapsed());
        let path = |ending: &str| folder.join(format!("{name}.{ending}"));
        write_atomically(&path("step"), |w| write_step(&model, &[], &options, w))?;
        let grouping = Grouping::new(&model, |f| (f.style.layer.clone(), "wall".to_owned()));
        for (ending, form) in [("igs", IgesForm::Solids), ("surfaces.igs", IgesForm::TrimmedSurfaces)] {
            let options = IgesOptions { name: name.to_owned(), form, ..IgesOptions::default() };
            write_atomically(&path(ending), |w| write_iges(&model, &[], &grouping, &options, w))?;
        }
        write_atomically(&path("glb"), |w| write_glb(&model, &[], &mesh, w))?;
        write_atomically(&path("obj"), |w| write_obj(&model, &[], &mesh, &format!("{name}.mtl"), w))?;
        write_atomically(&path("mtl"), |w| write_mtl(&model, &[], w))?;
        for solid in &model.solids {
            let path = path(&format!("{}.stl", solid.name));
            write_atomically(&path, |w| write_stl(&model, &[&solid.name], &mesh, w))?;
        }
    }
    Ok(())
}
