//! Documents far larger than any design are refused in little time and memory.
#![cfg(target_os = "linux")]

use serde_json::Value;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// Address space that the program gets, KiB; a run on the rotor takes a tenth of it.
const MEMORY_KIB: usize = 1 << 20;
/// Seconds are enough without optimisation and beside other tests.
const TIME: Duration = Duration::from_secs(20);

/// The sample with the text of the list at `pointer` replaced.
fn with_list(sample: &str, pointer: &str, list: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(sample);
    let mut design: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    *design.pointer_mut(pointer).unwrap() = "HERE".into();
    design.to_string().replace("\"HERE\"", list)
}

fn million(entry: &str) -> String {
    format!("[{}]", vec![entry; 1_000_000].join(","))
}

#[test]
fn a_million_of_anything_is_refused_where_it_stands() {
    let section = r#"{"span":0.5,"suction_side":[[0,0]],"pressure_side":[[0,0]]}"#;
    let hole = r#"{"name":"a","diameter":1,"at":{"frame":"stream","m":1,"t":1}}"#;
    let wall = r#"{"name":"w","position":0.5,"thickness":1}"#;
    let cases = [
        ("rotor.json", "/blade/sections", section),
        ("rotor.json", "/blade/sections/0/suction_side", "[0.5,1]"),
        ("rotor.json", "/space/hub", "[0.5,250]"),
        ("rotor.json", "/cooling/shell/suction_side", "[0.5,1]"),
        ("rotor.json", "/cooling/walls", wall),
        ("c3x.json", "/cooling/radial_holes", hole),
        ("surface.json", "/blade/knots_u", "0"),
        ("surface.json", "/blade/points", "[[0,0,0],[0,0,1],[0,1,1],[0,0,0]]"),
    ];
    for (sample, pointer, entry) in cases {
        let folder = tempfile::tempdir().unwrap();
        let design = folder.path().join("design.json");
        std::fs::write(&design, with_list(sample, pointer, &million(entry))).unwrap();
        let out = folder.path().join("out");
        let started = Instant::now();
        let done = Command::new("sh")
            .args(["-c", &format!("ulimit -v {MEMORY_KIB} && exec \"$@\""), "sh"])
            .args([env!("CARGO_BIN_EXE_coolinggen"), "generate", "--json", "--out"])
            .args([&out, &design])
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&done.stdout);
        assert_eq!(
            done.status.code(),
            Some(2),
            "{pointer}: {said} {}",
            String::from_utf8_lossy(&done.stderr)
        );
        assert!(started.elapsed() < TIME, "{pointer} took {:?}", started.elapsed());
        let answer: Value = serde_json::from_str(&said).unwrap();
        let faults = answer["faults"].as_array().unwrap();
        assert!(
            faults.iter().any(|f| f["pointer"] == pointer && f["value"] == 1_000_000),
            "{pointer}: {said}"
        );
        assert!(!out.exists(), "{pointer} left files");
    }
}
