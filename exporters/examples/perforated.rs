//! Times tessellation and writing of a wall with many holes: `perforated ROWS COLUMNS CHORD_MM ANGLE_DEG [FOLDER]`.

#[path = "../tests/support/mod.rs"]
mod support;

use coolinggen_exporters::{
    ExportError, StepOptions, TessellationOptions, tessellate, write_atomically, write_glb, write_obj,
    write_step, write_stl,
};
use std::path::Path;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [rows, columns, chord, angle, rest @ ..] = words.as_slice() else {
        return Err("usage: perforated ROWS COLUMNS CHORD_MM ANGLE_DEG [FOLDER]".into());
    };
    let model = support::perforated::sector(rows.parse()?, columns.parse()?);
    let options =
        TessellationOptions { chord_mm: chord.parse()?, angle_deg: angle.parse()?, max_edge_mm: None };
    let timed = |what: &str, start: Instant| println!("{what}: {:?}", start.elapsed());
    let start = Instant::now();
    let mesh = tessellate(&model, &options)?;
    timed("tessellate", start);
    println!("{} triangles", mesh.triangle_count());
    for face in &model.faces[model.faces.len() - 6..] {
        let index = model.faces.iter().position(|f| f.name == face.name).unwrap_or_default();
        println!("  {}: {}", face.name, mesh.faces[index].triangles.len());
    }
    let Some(folder) = rest.first() else { return Ok(()) };
    let folder = Path::new(folder);
    std::fs::create_dir_all(folder)?;
    type Writer<'a> = Box<dyn Fn(&mut std::io::BufWriter<std::fs::File>) -> Result<(), ExportError> + 'a>;
    let writers: [(&str, Writer<'_>); 4] = [
        ("step", Box::new(|w| write_step(&model, &[], &StepOptions::default(), w))),
        ("glb", Box::new(|w| write_glb(&model, &[], &mesh, w))),
        ("obj", Box::new(|w| write_obj(&model, &[], &mesh, "x.mtl", w))),
        ("stl", Box::new(|w| write_stl(&model, &[], &mesh, w))),
    ];
    for (ending, write) in writers {
        let start = Instant::now();
        let path = folder.join(format!("perforated.{ending}"));
        write_atomically(&path, write)?;
        timed(ending, start);
        println!("  {} bytes", std::fs::metadata(&path)?.len());
    }
    Ok(())
}
