//! What a design came to.

use crate::sound::check_report;
use coolinggen_blade::Fault;
use coolinggen_cooling::design::Design;
use coolinggen_cooling::report::Report;
use coolinggen_cooling::{Generated, generate};
use serde_json::Value;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// What a design came to.
pub enum Outcome {
    /// Built, and sound by every check of ours.
    Built(Box<Generated>),
    /// Refused.
    Refused(Vec<Fault>),
    /// Built, but unsound; or the program broke down.
    Wrong(String),
}

/// Builds a design and checks what comes out.
pub fn outcome(document: &Value) -> Outcome {
    let design = match Design::from_json(&document.to_string()) {
        Ok(design) => design,
        Err(faults) => return Outcome::Refused(faults),
    };
    match catch_unwind(AssertUnwindSafe(|| generate(&design, Path::new(".")))) {
        Err(_) => Outcome::Wrong("the program panicked".into()),
        Ok(Err(faults)) => Outcome::Refused(faults),
        Ok(Ok(generated)) => {
            match check_report(&generated.report).and_then(|()| genus(document, &generated.report)) {
                Ok(()) => Outcome::Built(Box::new(generated)),
                Err(what) => Outcome::Wrong(what),
            }
        }
    }
}

/// The metal's handles counted from the document: a passage with n mouths makes n - 1 of them; its mouths are its open
/// ends, its film holes and its slots.
fn genus(document: &Value, report: &Report) -> Result<(), String> {
    let cooling = &document["cooling"];
    let list = |name: &str| cooling[name].as_array().cloned().unwrap_or_default();
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let chambers: Vec<String> = list("chambers").iter().map(|c| text(&c["name"])).collect();
    // A turn closes an end of both its chambers and makes them one passage, called after the first of them.
    let mut passage: Vec<usize> = (0..chambers.len()).collect();
    let mut open: Vec<[bool; 2]> = list("chambers")
        .iter()
        .map(|c| match c["span"].as_array() {
            Some(span) => [span[0].as_f64() == Some(0.0), span[1].as_f64() == Some(1.0)],
            None => [true, cooling["shell"]["tip"].is_null()],
        })
        .collect();
    for turn in list("turns") {
        let front = chambers.iter().position(|c| *c == text(&turn["between"][0])).unwrap_or(0);
        let end = usize::from(turn["end"] == "tip");
        open[front][end] = false;
        open[front + 1][end] = false;
        passage[front + 1] = passage[front];
    }
    let mut mouths: BTreeMap<String, usize> = BTreeMap::new();
    for (k, ends) in open.iter().enumerate() {
        let count = ends.iter().filter(|e| **e).count();
        *mouths.entry(chambers[passage[k]].clone()).or_default() += count;
    }
    for hole in list("radial_holes") {
        mouths.insert(text(&hole["name"]), 2);
    }
    for (field, bores) in [("film_rows", report.holes.len()), ("slot_rows", report.slots.len())] {
        let rows = list(field);
        let counted: Option<u64> = rows.iter().map(|r| r["count"].as_f64().map(|c| c as u64)).sum();
        if let Some(counted) = counted.filter(|c| *c != bores as u64) {
            return Err(format!("{counted} {field} asked for, {bores} made"));
        }
    }
    let fed = report.holes.iter().map(|h| &h.passage).chain(report.slots.iter().map(|s| &s.passage));
    for name in fed {
        *mouths.get_mut(name).ok_or_else(|| format!("there is no passage {name}"))? += 1;
    }
    let expected: usize = mouths.values().map(|n| n.saturating_sub(1)).sum();
    let found = report.genus["metal"].found;
    if found == Some(expected) {
        Ok(())
    } else {
        Err(format!("the metal has genus {found:?}, the document says {expected}"))
    }
}
