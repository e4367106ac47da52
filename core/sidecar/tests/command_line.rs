//! The binary, driven from outside.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn coolinggen(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_coolinggen")).args(arguments).output().unwrap()
}

fn sample(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name).to_str().unwrap().to_owned()
}

fn files(folder: &Path) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn generate_writes_what_was_asked_for_and_a_report() {
    let folder = tempfile::tempdir().unwrap();
    let out: PathBuf = folder.path().join("with a space/Ünï");
    let done = coolinggen(&[
        "generate",
        &sample("c3x.json"),
        "--out",
        out.to_str().unwrap(),
        "--format",
        "stl,obj",
        "--solids",
        "metal",
        "--json",
    ]);
    assert_eq!(done.status.code(), Some(0), "{}", String::from_utf8_lossy(&done.stderr));
    let meshes = ["c3x.metal.mtl", "c3x.metal.obj", "c3x.metal.stl"];
    assert_eq!(files(&out), [&["c3x.groups.json"], &meshes[..], &["c3x.report.json"]].concat());
    let report: Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!(report["watertight"], true);
    assert_eq!(report["genus"]["metal"]["found"], 10);
    // Meshes close: the OBJ as another reader sees it.
    let (models, _) = tobj::load_obj(out.join("c3x.metal.obj"), &tobj::LoadOptions::default()).unwrap();
    assert!(models.len() >= 26);
}

#[test]
fn a_refused_design_exits_with_2_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let design = folder.path().join("bad.json");
    let text = std::fs::read_to_string(sample("c3x.json")).unwrap().replace("76.2", "-76.2");
    std::fs::write(&design, text).unwrap();
    let out = folder.path().join("out");
    let done = coolinggen(&["generate", design.to_str().unwrap(), "--out", out.to_str().unwrap(), "--json"]);
    assert_eq!(done.status.code(), Some(2));
    let answer: Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!(answer["faults"][0]["pointer"], "/space/height");
    assert_eq!(files(&out), Vec::<String>::new());
}

#[test]
fn what_is_not_there_exits_with_1_and_bad_words_with_2() {
    assert_eq!(coolinggen(&["validate", "nowhere.json"]).status.code(), Some(1));
    assert_eq!(coolinggen(&["generate"]).status.code(), Some(2));
    assert_eq!(coolinggen(&["new", "nothing-like-it"]).status.code(), Some(2));
}

#[test]
fn templates_are_sound() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["rotor", "c3x", "pritchard"] {
        let text = coolinggen(&["new", name]).stdout;
        let design = folder.path().join(format!("{name}.json"));
        std::fs::write(&design, text).unwrap();
        let done = coolinggen(&["validate", design.to_str().unwrap()]);
        assert_eq!(done.status.code(), Some(0), "{name}: {}", String::from_utf8_lossy(&done.stderr));
    }
}
