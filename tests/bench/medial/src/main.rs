//! The tables of the medial paper with our blades: average error (its Eq. 28) by control points and knots.
//!
//! ```text
//! cargo run --release -p coolinggen-bench-medial
//! ```

use coolinggen_blade::{BladeSource, SpaceSpec, build};
use serde_json::{Value, json};
use std::path::Path;

/// Control points and the paper's errors, uniform and non-uniform (Table 1).
const TURBINE: [([usize; 2], [f64; 2]); 5] = [
    ([10, 5], [0.58, 0.54]),
    ([20, 5], [0.25, 0.18]),
    ([10, 10], [0.18, 0.1]),
    ([20, 10], [0.08, 0.06]),
    ([25, 10], [0.05, 0.021]),
];

fn error(design: &Value, degree: usize, counts: [usize; 2], knots: &str) -> Result<[f64; 2], String> {
    let read = |e: serde_json::Error| e.to_string();
    let mut blade = design["blade"].clone();
    blade["skin"] = json!({ "degree": [degree, degree], "control_points": counts, "knots": knots });
    let space: SpaceSpec = serde_json::from_value(design["space"].clone()).map_err(read)?;
    let source: BladeSource = serde_json::from_value(blade).map_err(read)?;
    let (_, blade) = build(&space, &source, Path::new("."))
        .map_err(|faults| faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))?;
    Ok([blade.fit.average_distance_mm, blade.fit.greatest_distance_mm])
}

fn main() -> Result<(), String> {
    let text = include_str!("../../../../samples/francis.json");
    let design: Value = serde_json::from_str(text).map_err(|e| e.to_string())?;
    println!(
        "| control points | paper, uniform | paper, non-uniform | degree 2, uniform | degree 2, optimised | degree 3, uniform | degree 3, optimised |"
    );
    println!("|---|---|---|---|---|---|---|");
    for (counts, paper) in TURBINE {
        print!("| {} x {} | {} | {} |", counts[0], counts[1], paper[0], paper[1]);
        for degree in [2, 3] {
            for knots in ["uniform", "optimised"] {
                let [average, greatest] = error(&design, degree, counts, knots)?;
                print!(" {average:.4} (greatest {greatest:.3}) |");
            }
        }
        println!();
    }
    Ok(())
}
