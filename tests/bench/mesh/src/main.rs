//! Tessellates each solid of a design on one thread and says how long it took, how many triangles it has and how
//! closely they follow the faces; writes the solids as STEP, for others to do the same (`mesh.py`).
//!
//!     cargo run --release -p coolinggen-bench-mesh -- DESIGN.json FOLDER [CHORD_MM [ANGLE_DEG [RUNS [faces]]]]

mod alone;
mod deviation;

use coolinggen_brep::Model;
use coolinggen_cooling::design::Design;
use coolinggen_exporters::{
    ExportError, StepOptions, TessellationOptions, tessellate, write_atomically, write_step,
};
use serde_json::{Value, json};
use std::path::Path;

/// Processor seconds after which a mean is good enough.
const ENOUGH: f64 = 0.1;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, default: f64| arguments.get(i).map_or(Ok(default), |t| t.parse());
    let [design, folder] = arguments.first_chunk().ok_or("a design and a folder are needed")?;
    let options =
        TessellationOptions { chord_mm: number(2, 0.02)?, angle_deg: number(3, 15.0)?, max_edge_mm: None };
    let runs = number(4, 5.0)? as usize;
    let by_face = arguments.get(5).is_some_and(|a| a == "faces");
    let design = Path::new(design);
    let generated = Design::from_file(design)
        .and_then(|d| coolinggen_cooling::generate(&d, Design::folder_of(design)))
        .map_err(|faults| format!("{faults:?}"))?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let model = &generated.blade.model;
    let mut rows: Vec<Value> = Vec::new();
    for (i, solid) in model.solids.iter().enumerate() {
        let part = alone::alone(model, solid);
        let step = Path::new(folder).join(format!("{i}.step"));
        write_atomically(&step, |out| write_step(&part, &[], &StepOptions::default(), out))?;
        let mut least = f64::INFINITY;
        let mesh = pool.install(|| tessellate(&part, &options))?;
        for _ in 0..runs {
            least = least.min(pool.install(|| seconds(&part, &options))?);
        }
        let found = deviation::deviations(&part, &mesh);
        let mut row = json!({
            "solid": solid.name,
            "step": step,
            "milliseconds": 1e3 * least,
            "triangles": mesh.triangle_count(),
            "chord_mm": found.iter().map(|d| d.distance).fold(0.0, f64::max),
            "turn_deg": found.iter().map(|d| d.turn_deg).fold(0.0, f64::max),
            "coarse": mesh.coarse.iter().map(|f| &part.face(*f).name).collect::<Vec<_>>(),
        });
        if by_face {
            let mut faces: Vec<Value> = Vec::new();
            for ((face, mesh), d) in part.faces.iter().zip(&mesh.faces).zip(&found) {
                faces.push(json!([face.name, mesh.triangles.len(), d.distance, d.turn_deg]));
            }
            row["faces"] = faces.into();
        }
        rows.push(row);
    }
    println!("{}", Value::Array(rows));
    Ok(())
}

/// Processor seconds of a tessellation, the mean of many: the clock steps by milliseconds.
fn seconds(model: &Model, options: &TessellationOptions) -> Result<f64, ExportError> {
    let before = processor_seconds()?;
    for count in 1.. {
        tessellate(model, options)?;
        let spent = processor_seconds()? - before;
        if spent > ENOUGH {
            return Ok(spent / f64::from(count));
        }
    }
    Ok(f64::INFINITY)
}

/// Seconds that this thread has been on a processor, by Linux.
fn processor_seconds() -> Result<f64, ExportError> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat")?;
    let spent = text.split_whitespace().next().and_then(|ns| ns.parse::<f64>().ok());
    spent.map(|ns| ns * 1e-9).ok_or_else(|| std::io::Error::other("no schedstat").into())
}
