//! The tables of the medial paper with our blades: average error (its Eq. 28) by control points and knots.
//!
//! ```text
//! cargo run --release -p coolinggen-bench-medial
//! ```

use coolinggen_blade::{BladeSource, SpaceSpec, build};
use serde_json::{Value, json};
use std::path::Path;

/// A table of the paper, and a blade of its size and kind.
struct Table {
    name: &'static str,
    design: &'static str,
    /// What the design is scaled by to be as large as the paper's.
    scale: f64,
    /// Control points and the paper's errors, uniform and non-uniform.
    rows: [([usize; 2], [f64; 2]); 5],
}

const TABLES: [Table; 2] = [
    Table {
        name: "Table 1, turbine: paper's box about 115 x 220 x 160, francis.json x 1.15",
        design: include_str!("../../../../samples/francis.json"),
        scale: 1.15,
        rows: [
            ([10, 5], [0.58, 0.54]),
            ([20, 5], [0.25, 0.18]),
            ([10, 10], [0.18, 0.1]),
            ([20, 10], [0.08, 0.06]),
            ([25, 10], [0.05, 0.021]),
        ],
    },
    Table {
        name: "Table 2, propeller: paper's box about 100 x 60 x 40, medial-propeller.json x 1.5",
        design: include_str!("../../../../samples/medial-propeller.json"),
        scale: 1.5,
        rows: [
            ([10, 5], [0.32, 0.21]),
            ([20, 5], [0.21, 0.18]),
            ([10, 10], [0.2, 0.09]),
            ([20, 10], [0.067, 0.047]),
            ([25, 10], [0.059, 0.04]),
        ],
    },
];

/// Average and greatest error of the design with these control points, mm.
fn error(design: &Value, degree: usize, counts: [usize; 2], knots: &str) -> Result<[f64; 2], String> {
    let read = |e: serde_json::Error| e.to_string();
    let mut blade = design["blade"].clone();
    blade["skin"] = json!({ "degree": [degree, degree], "control_points": counts, "knots": knots });
    let space: SpaceSpec = serde_json::from_value(design["space"].clone()).map_err(read)?;
    let source: BladeSource = serde_json::from_value(blade).map_err(read)?;
    let (_, blade) = build(&space, &source, Path::new("."))
        .map_err(|faults| faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))?;
    Ok([blade.fit.average_distance_mm.unwrap_or(f64::NAN), blade.fit.greatest_distance_mm])
}

fn main() -> Result<(), String> {
    for table in TABLES {
        let design: Value = serde_json::from_str(table.design).map_err(|e| e.to_string())?;
        println!("{}\n", table.name);
        println!(
            "| control points | paper, uniform | paper, non-uniform | degree 2, uniform | degree 2, optimised | degree 3, uniform | degree 3, optimised |"
        );
        println!("|---|---|---|---|---|---|---|");
        for (counts, paper) in table.rows {
            print!("| {} x {} | {} | {} |", counts[0], counts[1], paper[0], paper[1]);
            for degree in [2, 3] {
                for knots in ["uniform", "optimised"] {
                    let found = error(&design, degree, counts, knots)?;
                    // Every length of the method scales with the design, and so do the errors.
                    let [average, greatest] = found.map(|e| e * table.scale);
                    print!(" {average:.4} (greatest {greatest:.3}) |");
                }
            }
            println!();
        }
        println!();
    }
    Ok(())
}
