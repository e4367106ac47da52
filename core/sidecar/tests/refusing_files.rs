//! File systems that refuse: full, read-only, or with a limit on the size of files. An error that names the file, an exit
//! code, and no half file, from the command line and from the sidecar.
//!
//! A full disk and a read-only one are small tmpfs mounts in a mount namespace of the test's own, where the system lets
//! users have one (`unshare`); where not, these tests say so and are skipped. A limit on the size of files needs no
//! privilege: it always stands in.
#![cfg(target_os = "linux")]

mod client;

use client::{BINARY, Server, sample};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// How the folder refuses.
#[derive(Clone, Copy, Debug)]
enum Disk {
    /// It has room for less than any of the files.
    Full,
    /// Nothing can be made in it.
    ReadOnly,
    /// Files end after as many kilobytes.
    Limited,
}

/// A folder that refuses, with spaces and letters beyond ASCII in its name.
struct Refusing {
    disk: Disk,
    _above: tempfile::TempDir,
    folder: PathBuf,
}

impl Refusing {
    /// None, said aloud, where the system lets no user mount anything.
    fn new(disk: Disk) -> Option<Self> {
        let above = tempfile::tempdir().unwrap();
        let folder = above.path().join("caf\u{e9} \u{7ffc} out");
        std::fs::create_dir(&folder).unwrap();
        let refusing = Self { disk, _above: above, folder };
        let tried = refusing.command("true", &[]).output();
        let works = tried.as_ref().is_ok_and(|output| output.status.success());
        if !works {
            eprintln!("SKIPPED: no mount namespace for {disk:?} here: {tried:?}");
        }
        works.then_some(refusing)
    }

    /// A command that sees the folder refuse.
    fn command(&self, program: &str, arguments: &[&str]) -> Command {
        let mount = match self.disk {
            Disk::Full => "mount -t tmpfs -o size=16k tmpfs \"$0\" && exec \"$@\"",
            Disk::ReadOnly => "mount -t tmpfs -o ro,size=16k tmpfs \"$0\" && exec \"$@\"",
            // Without the signal the write itself fails.
            Disk::Limited => "trap '' XFSZ && ulimit -f 16 && exec \"$@\"",
        };
        let mut command = match self.disk {
            Disk::Limited => Command::new("sh"),
            _ => {
                let mut command = Command::new("unshare");
                command.args(["--user", "--map-root-user", "--mount", "sh"]);
                command
            }
        };
        command.args(["-c", mount]).arg(&self.folder).arg(program).args(arguments);
        command
    }

    /// What is in the folder as a process that still runs sees it, or as all do.
    fn files(&self, process: Option<u32>) -> Vec<String> {
        let seen = match process {
            Some(id) => PathBuf::from(format!("/proc/{id}/root{}", self.folder.display())),
            None => self.folder.clone(),
        };
        let entries = std::fs::read_dir(&seen).unwrap();
        entries.map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect()
    }

    /// What the system calls it.
    fn reason(&self) -> &'static str {
        match self.disk {
            Disk::Full => "No space left on device",
            Disk::ReadOnly => "Read-only file system",
            Disk::Limited => "File too large",
        }
    }
}

fn sample_path(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name).to_str().unwrap().to_owned()
}

fn on_all(test: impl Fn(&Refusing)) {
    for disk in [Disk::Limited, Disk::Full, Disk::ReadOnly] {
        if let Some(refusing) = Refusing::new(disk) {
            test(&refusing);
        }
    }
}

#[test]
fn the_command_line_says_what_it_could_not_write_and_leaves_nothing() {
    let design = sample_path("c3x.json");
    on_all(|refusing| {
        for format in ["step", "glb", "stl"] {
            let out = refusing.folder.to_str().unwrap();
            let words = ["generate", &design, "--out", out, "--format", format, "--solids", "metal"];
            // The shell lists what is left where only it can see it.
            let mut inside = vec!["-c", "\"$@\"; code=$?; ls -A \"$0\"; exit $code", out, BINARY];
            inside.extend(words);
            let output = refusing.command("sh", &inside).output().unwrap();
            told(refusing, &output, format);
        }
    });
}

fn told(refusing: &Refusing, output: &Output, format: &str) {
    let said = String::from_utf8_lossy(&output.stderr);
    let what = format!("{:?}, {format}: {said}", refusing.disk);
    assert_eq!(output.status.code(), Some(1), "{what}");
    assert!(said.contains("cannot write") && said.contains(refusing.reason()), "{what}");
    assert!(said.contains(&format!("c3x.metal.{format}")), "{what}");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "", "{what}");
}

#[test]
fn the_sidecar_answers_with_the_path_and_goes_on() {
    on_all(|refusing| {
        let mut server = Server::started(&mut refusing.command(BINARY, &["serve"]));
        let client = &mut server.client;
        client.result("initialize", &json!({ "protocol_version": 1 }));
        client.result("design/generate", &json!({ "model": "m", "design": sample("c3x.json") }));
        for format in ["step", "obj", "glb", "stl"] {
            let params =
                json!({ "model": "m", "folder": refusing.folder, "formats": [format], "solids": ["metal"] });
            let error = client.error("model/export", &params);
            assert_eq!(error["code"], -32001, "{:?} {format}: {error}", refusing.disk);
            let path = error["data"]["path"].as_str().unwrap();
            assert!(path.starts_with(refusing.folder.to_str().unwrap()), "{error}");
            assert!(error["message"].as_str().unwrap().contains(refusing.reason()), "{error}");
        }
        // Materials are small enough to be whole where there is a little room.
        let mut left = refusing.files(Some(server.process.id()));
        left.retain(|name| name != "c3x.metal.mtl");
        assert_eq!(left, Vec::<String>::new(), "{:?}", refusing.disk);
        assert_eq!(client.result("model/list", &json!({}))["models"], json!(["m"]));
        assert_eq!(server.leave().1, Some(0));
    });
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    // Nobody makes folders in /proc, not even root.
    let out = "/proc/coolinggen out \u{e9}";
    let design = sample_path("c3x.json");
    let output = Command::new(BINARY).args(["generate", &design, "--out", out]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("cannot make the folder") && said.contains(out), "{said}");
    let output = Command::new(BINARY).args(["generate", &design, "--json", "--out", out]).output().unwrap();
    let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(answer["error"].as_str().unwrap().contains(out), "{answer}");
}

#[test]
fn designs_and_files_they_name_may_have_any_names() {
    let above = tempfile::tempdir().unwrap();
    let folder = above.path().join("d\u{e9}signs \u{1f300} \u{7ffc}");
    std::fs::create_dir(&folder).unwrap();
    let mut design = sample("step.json");
    design["blade"]["file"] = json!("pale \u{e0} \u{7ffc}.step");
    std::fs::copy(sample_path("step-blade.step"), folder.join("pale \u{e0} \u{7ffc}.step")).unwrap();
    let path = folder.join("le dessin.json");
    std::fs::write(&path, design.to_string()).unwrap();
    let out = folder.join("o u t");
    let output = Command::new(BINARY)
        .args(["generate", path.to_str().unwrap(), "--format", "stl", "--out", out.to_str().unwrap()])
        .stderr(Stdio::piped())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(std::fs::read_dir(&out).unwrap().count() > 1);
    let mut server = Server::ready();
    let params = json!({ "model": "m", "design": design, "folder": folder });
    assert_eq!(server.client.result("design/generate", &params)["report"]["watertight"], true);
}
