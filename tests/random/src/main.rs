//! Builds random designs and prints what they came to, by kind.
//!
//! ```text
//! coolinggen-random [--first N] [--count N] [--out DIR]
//! ```
//!
//! With `--out`, every design is written there as `randomNNNN.json`, with `randomNNNN.step` (all solids) if it was built
//! and `randomNNNN.faults.json` if not; `tests/random/occ.py DIR` then asks OpenCASCADE about them.

use coolinggen_exporters::{StepOptions, write_step};
use coolinggen_random::{Outcome, design, outcome};
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

/// What is printed of a design: its kind, and a line.
fn run(seed: u64, options: &Options) -> io::Result<(String, String)> {
    let started = Instant::now();
    let document = design(seed);
    let outcome = outcome(&document);
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
        let kind = if matches!(outcome, Outcome::Built(_)) { "expected.json" } else { "faults.json" };
        std::fs::write(path(kind), text(&record))?;
        if let Outcome::Built(generated) = &outcome {
            let mut file = io::BufWriter::new(std::fs::File::create(path("step"))?);
            write_step(&generated.blade.model, &[], &StepOptions::default(), &mut file)
                .map_err(io::Error::other)?;
        }
    }
    Ok((kind, format!("{seed:4} {:7.0} ms {what}", started.elapsed().as_secs_f64() * 1e3)))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let options = options()?;
    if let Some(out) = &options.out {
        std::fs::create_dir_all(out)?;
    }
    let seeds: Vec<u64> = (options.first..options.first + options.count).collect();
    let results: Vec<_> = seeds.into_par_iter().map(|seed| run(seed, &options)).collect::<io::Result<_>>()?;
    let mut kinds: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (kind, line) in &results {
        kinds.entry(kind).or_default().push(line);
    }
    for (kind, lines) in kinds.iter().filter(|(kind, _)| **kind != "built") {
        println!("{kind}");
        lines.iter().for_each(|line| println!("    {line}"));
    }
    println!("\n{:>6}  outcome", "designs");
    kinds.iter().for_each(|(kind, lines)| println!("{:>6}  {kind}", lines.len()));
    Ok(())
}
