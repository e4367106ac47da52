//! The reports of the samples against those kept in `tests/golden`: nothing changes unseen.
//!
//! `COOLINGGEN_GOLDEN=write cargo test -p coolinggen-cooling --test golden` writes them anew; what changed is then in
//! the diff for people to judge.

use coolinggen_cooling::design::Design;
use coolinggen_cooling::generate;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Greatest relative difference of volumes and areas, which are exact integrals.
const INTEGRALS: f64 = 1e-7;
/// Greatest difference of lengths and of the coordinates of centroids and boxes, mm.
const LENGTHS: f64 = 1e-6;
/// Greatest difference of the place where a wall is thinnest, mm: along the wall the thickness is flat there.
const PLACES: f64 = 0.01;
/// Significant digits kept.
const DIGITS: usize = 10;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Names of the samples, in order.
fn samples() -> Vec<String> {
    let entries = std::fs::read_dir(root().join("samples")).unwrap().map(|e| e.unwrap().path());
    let designs = entries.filter(|p| p.extension().is_some_and(|e| e == "json"));
    let mut names: Vec<String> =
        designs.map(|p| p.file_stem().unwrap().to_str().unwrap().to_owned()).collect();
    names.sort();
    names
}

/// The report of a sample less what a machine, a moment or a release puts into it.
fn report(name: &str) -> Value {
    let path = root().join("samples").join(format!("{name}.json"));
    let design = Design::from_file(&path).unwrap();
    let generated = generate(&design, Design::folder_of(&path)).unwrap();
    let mut report = generated.report.to_json();
    let members = report.as_object_mut().unwrap();
    for name in ["timings_ms", "version"] {
        members.remove(name).unwrap();
    }
    // What is left of rounding and interpolation; its limit is checked when a design is built.
    members.remove("max_edge_deviation_mm").unwrap();
    rounded(&mut report);
    report
}

fn rounded(value: &mut Value) {
    match value {
        Value::Number(n) if n.is_f64() => {
            let number = n.as_f64().unwrap();
            *value = format!("{number:.*e}", DIGITS - 1).parse::<f64>().unwrap().into();
        }
        Value::Array(items) => items.iter_mut().for_each(rounded),
        Value::Object(members) => members.values_mut().for_each(rounded),
        _ => {}
    }
}

/// Allowed difference of a number of the size of `kept` in the field `name`.
fn allowed(name: &str, kept: f64) -> f64 {
    match name {
        _ if name.ends_with("_mm3") || name.ends_with("_mm2") => INTEGRALS * kept.abs(),
        "at_mm" => PLACES,
        _ => LENGTHS,
    }
}

/// Adds what differs, with its pointer; `name` is the field that numbers belong to.
fn compare(found: &Value, kept: &Value, pointer: &str, name: &str, differences: &mut Vec<String>) {
    match (found, kept) {
        (Value::Number(a), Value::Number(b)) if a.is_f64() && b.is_f64() => {
            let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
            if !((a - b).abs() <= allowed(name, b)) {
                differences.push(format!("{pointer}: {a}, kept {b}, allowed {:e}", allowed(name, b)));
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (i, (a, b)) in a.iter().zip(b).enumerate() {
                compare(a, b, &format!("{pointer}/{i}"), name, differences);
            }
        }
        (Value::Object(a), Value::Object(b)) if a.keys().eq(b.keys()) => {
            for ((key, a), b) in a.iter().zip(b.values()) {
                let own =
                    if matches!(key.as_str(), "min" | "max") && name.ends_with("_mm") { name } else { key };
                compare(a, b, &format!("{pointer}/{key}"), own, differences);
            }
        }
        (a, b) if a == b => {}
        (a, b) => differences.push(format!("{pointer}: {a}, kept {b}")),
    }
}

#[test]
fn reports_are_as_kept() {
    let write = std::env::var("COOLINGGEN_GOLDEN").is_ok_and(|v| v == "write");
    let mut differences = Vec::new();
    for name in samples() {
        let path = root().join("tests/golden").join(format!("{name}.report.json"));
        let found = report(&name);
        if write {
            std::fs::write(&path, format!("{found:#}\n")).unwrap();
        }
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let kept: Value = serde_json::from_str(&text).unwrap();
        compare(&found, &kept, &name, "", &mut differences);
    }
    assert!(differences.is_empty(), "{}", differences.join("\n"));
}

#[test]
fn every_kept_report_has_its_sample() {
    let entries = std::fs::read_dir(root().join("tests/golden")).unwrap();
    let mut kept: Vec<String> = entries
        .filter_map(|e| Some(e.unwrap().file_name().to_str()?.strip_suffix(".report.json")?.to_owned()))
        .collect();
    kept.sort();
    assert_eq!(kept, samples());
}

#[test]
fn a_difference_is_seen() {
    let kept = report("pritchard");
    for (pointer, factor) in [
        ("/solids/metal/volume_mm3", 1.0 + 2e-7),
        ("/faces/0/area_mm2", 1.0 - 2e-7),
        ("/solids/metal/bounding_box_mm/max/0", 1.0 + 1e-6),
    ] {
        let mut found = kept.clone();
        let place = found.pointer_mut(pointer).unwrap();
        *place = (place.as_f64().unwrap() * factor).into();
        let mut differences = Vec::new();
        compare(&found, &kept, "", "", &mut differences);
        assert_eq!(differences.len(), 1, "{pointer}: {differences:?}");
        assert!(differences[0].starts_with(pointer));
    }
    let mut found = kept.clone();
    found["faces"].as_array_mut().unwrap().pop();
    let mut differences = Vec::new();
    compare(&found, &kept, "", "", &mut differences);
    assert_eq!(differences.len(), 1);
}
