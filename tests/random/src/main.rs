//! Builds random designs and prints what they came to, by kind.
//!
//! ```text
//! coolinggen-random [--first N] [--count N] [--out DIR]
//! ```
//!
//! With `--out`, every design is written there as `randomNNNN.json`, with `randomNNNN.step` (all solids) if it was built
//! and `randomNNNN.faults.json` if not; `tests/random/occ.py DIR` then asks OpenCASCADE about them.

use coolinggen_exporters::{StepOptions, write_step};
use coolinggen_random::{Confirmation, Outcome, confirm, design, outcome};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io;
use std::path::PathBuf;
use std::time::Instant;

struct Options {
    first: u64,
    count: u64,
    out: Option<PathBuf>,
}

fn options() -> Result<Options, String> {
    let mut options = Options { first: 0, count: 1000, out: None };
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or_else(|| format!("{name} needs a value"))?;
        let number = || value.parse().map_err(|_| format!("{value} is no whole number"));
        match name.as_str() {
            "--first" => options.first = number()?,
            "--count" => options.count = number()?,
            "--out" => options.out = Some(value.into()),
            _ => return Err(format!("{name} is not known: --first, --count, --out")),
        }
    }
    Ok(options)
}

/// What a design came to: its kind, a line to print, and what the check says of a refusal.
struct Run {
    kind: String,
    line: String,
    confirmation: Option<Confirmation>,
}

/// Draws, builds and checks the design of a seed, and writes it if files are asked for.
fn run(seed: u64, options: &Options) -> io::Result<Run> {
    let started = Instant::now();
    let document = design(seed);
    let outcome = outcome(&document);
    let confirmation = match &outcome {
        Outcome::Refused(faults) => Some(confirm(&document, &faults[0])),
        Outcome::Built(_) | Outcome::Wrong(_) => None,
    };
    let confirmed = match &confirmation {
        Some(Confirmation::Confirmed(what)) => format!("\n            confirmed: {what}"),
        Some(Confirmation::Contradicted(what)) => format!("\n            NOT CONFIRMED: {what}"),
        Some(Confirmation::Unchecked) => "\n            NOT CONFIRMED: no check".into(),
        None => String::new(),
    };
    let (kind, what, record) = match &outcome {
        Outcome::Built(generated) => {
            let genus: BTreeMap<_, _> = generated.report.genus.iter().map(|(n, g)| (n, g.expected)).collect();
            let volume: BTreeMap<_, _> =
                generated.report.solids.iter().map(|(n, s)| (n, s.volume_mm3)).collect();
            ("built".to_owned(), String::new(), json!({ "genus": genus, "volume_mm3": volume }))
        }
        Outcome::Refused(faults) => {
            let first = &faults[0];
            let place: String = first.pointer.chars().filter(|c| !c.is_ascii_digit()).collect();
            (format!("refused: {} at {place}", first.code), first.to_string(), json!(faults))
        }
        Outcome::Wrong(what) => ("wrong".to_owned(), what.clone(), json!(what)),
    };
    if let Some(out) = &options.out {
        let path = |extension: &str| out.join(format!("random{seed:04}.{extension}"));
        let text = |value: &Value| format!("{value:#}\n");
        std::fs::write(path("json"), text(&document))?;
        let (kind, others) = match outcome {
            Outcome::Built(_) => ("expected.json", &["faults.json"][..]),
            Outcome::Refused(_) | Outcome::Wrong(_) => {
                ("faults.json", &["expected.json", "step", "occ.json"][..])
            }
        };
        // What an earlier run has left of another outcome would be read as this one's.
        for other in others.iter().map(|other| path(other)) {
            if other.exists() {
                std::fs::remove_file(other)?;
            }
        }
        std::fs::write(path(kind), text(&record))?;
        if let Outcome::Built(generated) = &outcome {
            // Whole or not at all: OpenCASCADE may be reading while this runs.
            let mut file = io::BufWriter::new(std::fs::File::create(path("step.part"))?);
            write_step(&generated.blade.model, &[], &StepOptions::default(), &mut file)
                .map_err(io::Error::other)?;
            file.into_inner().map_err(io::IntoInnerError::into_error)?;
            std::fs::rename(path("step.part"), path("step"))?;
        }
    }
    let line = format!("{seed:4} {:7.0} ms {what}{confirmed}", started.elapsed().as_secs_f64() * 1e3);
    Ok(Run { kind, line, confirmation })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let options = options()?;
    if let Some(out) = &options.out {
        std::fs::create_dir_all(out)?;
    }
    let seeds: Vec<u64> = (options.first..options.first + options.count).collect();
    let results: Vec<Run> =
        seeds.into_par_iter().map(|seed| run(seed, &options)).collect::<io::Result<_>>()?;
    let mut kinds: BTreeMap<&str, Vec<&Run>> = BTreeMap::new();
    for result in &results {
        kinds.entry(&result.kind).or_default().push(result);
    }
    for (kind, results) in kinds.iter().filter(|(kind, _)| **kind != "built") {
        println!("{kind}");
        results.iter().for_each(|result| println!("    {}", result.line));
    }
    println!("\n{:>6}  {:>9}  outcome", "designs", "confirmed");
    for (kind, results) in kinds {
        let refused = results.iter().filter_map(|r| r.confirmation.as_ref());
        let confirmed = refused.filter(|c| matches!(c, Confirmation::Confirmed(_))).count();
        let confirmed = if kind == "built" { String::new() } else { confirmed.to_string() };
        println!("{:>6}  {confirmed:>9}  {kind}", results.len());
    }
    if results.iter().any(|result| result.kind == "wrong") {
        return Err("designs were built wrong".into());
    }
    Ok(())
}
