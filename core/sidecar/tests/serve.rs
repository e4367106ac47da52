//! The sidecar from outside: the real binary, driven as a client would and worse.

mod client;

use client::{BINARY, Client, LONG, Server, floats, indices, resident, sample};
use serde_json::json;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

#[test]
fn the_page_is_what_the_server_prints() {
    let printed = Command::new(BINARY).args(["serve", "--describe"]).output().unwrap();
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/protocol.md");
    assert_eq!(String::from_utf8(printed.stdout).unwrap(), std::fs::read_to_string(page).unwrap());
}

#[test]
fn a_design_becomes_a_model_with_report_mesh_and_files() {
    let mut server = Server::ready();
    let client = &mut server.client;
    let design = client.result("template/get", &json!({ "name": "rotor" }))["design"].take();
    assert_eq!(design, sample("rotor.json"));
    assert_eq!(client.result("design/validate", &json!({ "design": design }))["faults"], json!([]));

    client.send(7, "design/generate", &json!({ "model": "m", "design": design }));
    let first = client.next();
    assert_eq!((&first["method"], &first["params"]["id"]), (&json!("$/progress"), &json!(7)));
    let reply = client.reply();
    let report = &reply["result"]["report"];
    assert_eq!(report["watertight"], true);
    let again = client.result("model/inspect", &json!({ "model": "m" }));
    assert_eq!(&again["report"], report);

    let mesh = client.result("model/tessellate", &json!({ "model": "m", "solids": ["metal"] }));
    let solids = mesh["solids"].as_array().unwrap();
    assert_eq!(solids.len(), 1);
    let (vertices, triangles) = (floats(&solids[0]["vertices"]), indices(&solids[0]["triangles"]));
    let volume: f64 = triangles
        .chunks_exact(3)
        .map(|t| {
            let [a, b, c] = [0, 1, 2].map(|k| {
                let p = &vertices[3 * t[k] as usize..][..3];
                glam::DVec3::new(p[0].into(), p[1].into(), p[2].into())
            });
            a.dot(b.cross(c)) / 6.0
        })
        .sum();
    let exact = report["solids"]["metal"]["volume_mm3"].as_f64().unwrap();
    assert!((volume / exact - 1.0).abs() < 3e-3, "{volume} {exact}");
    let count = |what: &str| {
        let faces = solids[0]["faces"].as_array().unwrap();
        faces.iter().map(|f| f[what].as_u64().unwrap() as usize).sum::<usize>()
    };
    assert_eq!((3 * count("vertices"), 3 * count("triangles")), (vertices.len(), triangles.len()));

    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().join("blade \u{e4}\u{f6} \u{7ffc}");
    let params = json!({ "model": "m", "folder": inside, "formats": ["step", "obj"] });
    let files = client.result("model/export", &params)["files"].take();
    let listed: Vec<&str> = files.as_array().unwrap().iter().map(|f| f["path"].as_str().unwrap()).collect();
    assert_eq!(listed.len(), std::fs::read_dir(&inside).unwrap().count());
    for file in files.as_array().unwrap() {
        let size = std::fs::metadata(file["path"].as_str().unwrap()).unwrap().len();
        assert_eq!((file["bytes"].as_u64(), file["sha256"].as_str().map(str::len)), (Some(size), Some(64)));
    }
    assert_eq!(client.result("model/close", &json!({ "model": "m" }))["closed"], true);
    assert_eq!(client.error("model/inspect", &json!({ "model": "m" }))["data"][0]["pointer"], "/model");
    assert!(client.result("shutdown", &json!({})).is_null());
    assert_eq!(server.process.wait().unwrap().code(), Some(0));
}

#[test]
fn bad_messages_have_error_replies_and_the_server_goes_on() {
    let mut server = Server::with(&[]);
    let client = &mut server.client;
    assert_eq!(client.error("model/list", &json!({}))["code"], -32002);
    assert_eq!(client.error("initialize", &json!({ "protocol_version": 2 }))["data"][0]["max"], 1.0);
    client.result("initialize", &json!({ "protocol_version": 1 }));
    for (line, code) in [
        ("{\"half\n", -32700),
        ("\u{1}\u{2}\n", -32700),
        ("[]\n", -32600),
        ("{\"jsonrpc\":\"2.0\",\"id\":{},\"method\":\"model/list\"}\n", -32600),
        ("{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"model/lost\"}\n", -32601),
    ] {
        client.raw(line.as_bytes());
        assert_eq!(client.reply()["error"]["code"], code, "{line}");
    }
    client.raw(b"{\"jsonrpc\":\"2.0\",\"id\":1,\xff\xfe}\n");
    assert_eq!(client.reply()["error"]["code"], -32700);
    client.raw(format!("{}\n", "[".repeat(100_000)).as_bytes());
    assert_eq!(client.reply()["error"]["code"], -32700);
    // A line that comes in pieces.
    client.raw(b"{\"jsonrpc\":\"2.0\",\"id\":5,");
    thread::sleep(Duration::from_millis(50));
    client.raw(b"\"method\":\"model/list\"}\n");
    assert_eq!(client.reply()["result"]["models"], json!([]));
    // All faults of the parameters at once, and those of the design in them.
    let error = client.error("model/tessellate", &json!({ "chord_mm": -1, "angle": 3 }));
    let mut pointers: Vec<&str> =
        error["data"].as_array().unwrap().iter().map(|f| f["pointer"].as_str().unwrap()).collect();
    pointers.sort_unstable();
    assert_eq!(pointers, ["/angle", "/chord_mm", "/model"]);
    let mut design = sample("rotor.json");
    design["cooling"]["shell"]["suction_side"] = json!(-1);
    design["blade"]["kind"] = json!("bird");
    let error = client.error("design/generate", &json!({ "design": design }));
    let pointers: Vec<&str> =
        error["data"].as_array().unwrap().iter().map(|f| f["pointer"].as_str().unwrap()).collect();
    assert!(
        pointers.contains(&"/design/cooling/shell/suction_side") && pointers.contains(&"/design/blade/kind")
    );
    assert_eq!(server.leave().1, Some(0));
}

#[test]
fn a_line_of_a_hundred_megabytes_is_refused_without_being_kept() {
    let mut server = Server::ready();
    let part = vec![b'x'; 1 << 20];
    for _ in 0..100 {
        server.client.raw(&part);
    }
    server.client.raw(b"\n");
    assert_eq!(server.client.reply()["error"]["code"], -32600);
    if let Some(kilobytes) = resident(&server.process) {
        assert!(kilobytes < 200 << 10, "{kilobytes} kB");
    }
    assert_eq!(server.client.result("model/list", &json!({}))["models"], json!([]));
}

#[test]
fn an_id_in_use_is_refused_and_free_after_its_reply() {
    let mut server = Server::ready();
    let client = &mut server.client;
    let design = json!({ "design": sample("rotor.json"), "report": false });
    client.send(1, "design/generate", &design);
    client.send(1, "model/inspect", &json!({ "model": "rotor" }));
    assert_eq!(client.reply()["error"]["code"], -32600);
    assert_eq!(client.reply()["result"]["model"], "rotor");
    client.send(1, "model/list", &json!({}));
    assert_eq!(client.reply()["result"]["models"], json!(["rotor"]));
}

#[test]
fn cancelled_requests_have_one_reply_whenever_that_comes() {
    let mut server = Server::ready();
    let client = &mut server.client;
    let mut design = sample("rotor.json");
    let (mut cancelled, mut built) = (0, 0);
    for k in 0..40u64 {
        // Another blade each time, so that nothing is reused.
        design["space"]["hub"][0][1] = json!(250.0 + 1e-3 * k as f64);
        client.send(k, "design/generate", &json!({ "model": "m", "design": design, "report": false }));
        thread::sleep(Duration::from_micros(k * 7919 % 100 * 1000));
        client.cancel(k);
        let reply = client.reply();
        assert_eq!(reply["id"], k);
        match reply.get("error") {
            Some(error) => {
                assert_eq!(error["code"], -32800);
                cancelled += 1;
            }
            None => built += 1,
        }
    }
    assert!(cancelled > 0, "{built} were built");
    // Cancelling what is not there is nobody's business, and the model is as good as ever.
    client.cancel("nothing");
    let generated = client.result("design/generate", &json!({ "model": "m", "design": design }));
    assert_eq!(generated["report"]["watertight"], true);
}

#[test]
fn ten_thousand_requests_leave_memory_flat() {
    let mut server = Server::ready();
    let mut design = sample("rotor.json");
    // Allocators give back when they like: the least is what a leak would raise.
    let (mut warm, mut late) = (Vec::new(), Vec::new());
    for k in 0..10_000 {
        if k % 500 == 0 {
            design["cooling"]["shell"]["tip"] = json!(1.0 + 1e-4 * f64::from(k % 1500));
            server.client.result("design/generate", &json!({ "model": "m", "design": design }));
            server.client.result("model/tessellate", &json!({ "model": "m" }));
        }
        match k % 4 {
            0 => drop(server.client.result("model/inspect", &json!({ "model": "m" }))),
            1 => drop(server.client.result("design/validate", &json!({ "design": design }))),
            2 => drop(server.client.error("model/nothing", &json!({}))),
            _ => drop(server.client.result("model/list", &json!({}))),
        }
        match k {
            // Each kind of request has been answered often by each worker.
            2_000..4_000 => warm.extend(resident(&server.process)),
            8_000.. => late.extend(resident(&server.process)),
            _ => {}
        }
    }
    if let (Some(before), Some(after)) = (warm.iter().min(), late.iter().min()) {
        assert!(*after as f64 <= 1.05 * *before as f64, "{before} kB grew to {after} kB");
    }
}

#[test]
fn the_end_of_input_ends_a_busy_server_within_a_second() {
    for wait in [0, 5, 20, 60] {
        let mut server = Server::ready();
        let folder = tempfile::tempdir().unwrap();
        for k in 0..6 {
            let params = json!({ "model": k.to_string(), "design": sample("rotor-serpentine.json") });
            server.client.send(k, "design/generate", &params);
            let params =
                json!({ "model": k.to_string(), "folder": folder.path(), "formats": ["step", "stl"] });
            server.client.send(10 + k, "model/export", &params);
        }
        thread::sleep(Duration::from_millis(wait));
        let (took, code) = server.leave();
        assert!(took < Duration::from_secs(1), "{took:?}");
        assert_eq!(code, Some(0));
        for file in std::fs::read_dir(folder.path()).unwrap() {
            let name = file.unwrap().file_name();
            assert!(!name.to_string_lossy().starts_with('.'), "{name:?} is left");
        }
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_an_error_with_its_path() {
    let mut server = Server::ready();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "in the way").unwrap();
    server.client.result("design/generate", &json!({ "model": "m", "design": sample("c3x.json") }));
    let inside = file.join("out");
    let error =
        server.client.error("model/export", &json!({ "model": "m", "folder": inside, "formats": ["stl"] }));
    assert_eq!((&error["code"], &error["data"]["path"]), (&json!(-32001), &json!(inside)));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::net::UnixStream;

    fn connect(path: &Path) -> Client<UnixStream> {
        let deadline = Instant::now() + LONG;
        let stream = loop {
            match UnixStream::connect(path) {
                Ok(stream) => break stream,
                Err(error) => assert!(Instant::now() < deadline, "{error}"),
            }
            thread::sleep(Duration::from_millis(10));
        };
        let mut client = Client::new(stream.try_clone().unwrap(), stream);
        client.result("initialize", &json!({ "protocol_version": 1, "client": { "name": "test" } }));
        client
    }

    #[test]
    fn two_clients_share_a_model_and_do_not_wait_for_each_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a socket");
        let mut server = Server::with(&["--socket", path.to_str().unwrap()]);
        let (mut one, mut two) = (connect(&path), connect(&path));
        one.send(1, "design/generate", &json!({ "model": "m", "design": sample("rotor-serpentine.json") }));
        // Both take the same id, which is each one's own.
        two.send(1, "design/generate", &json!({ "model": "n", "design": sample("c3x.json") }));
        assert_eq!(two.reply()["result"]["model"], "n");
        assert_eq!(one.reply()["result"]["model"], "m");
        assert!(two.result("model/inspect", &json!({ "model": "m" }))["report"].is_object());
        drop(one.out.shutdown(std::net::Shutdown::Both));
        // The first client's model stays, for the second has used it.
        assert!(two.result("model/inspect", &json!({ "model": "m" }))["report"].is_object());
        assert!(server.process.try_wait().unwrap().is_none());
        // A second server does not take the socket away.
        let second = Command::new(BINARY)
            .args(["serve", "--detached", "--socket", path.to_str().unwrap()])
            .stdin(Stdio::null())
            .output()
            .unwrap();
        assert_eq!(second.status.code(), Some(1));
        two.result("shutdown", &json!({}));
        assert_eq!(server.process.wait().unwrap().code(), Some(0));
        assert!(!path.exists());
    }

    #[test]
    fn a_detached_server_takes_the_place_of_a_dead_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("socket");
        let start = || {
            let mut command = Command::new(BINARY);
            command.args(["serve", "--detached", "--socket", path.to_str().unwrap()]);
            command.stdin(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
        };
        let mut dead = start();
        drop(connect(&path));
        dead.kill().unwrap();
        dead.wait().unwrap();
        assert!(path.exists());
        let mut server = start();
        connect(&path).result("shutdown", &json!({}));
        assert_eq!(server.wait().unwrap().code(), Some(0));
    }

    #[test]
    fn the_death_of_the_parent_ends_the_server() {
        // A shell starts a server whose input stays open in the shell's own parent, and is killed.
        let mut shell = Command::new("sh")
            .args(["-c", &format!("exec 3<&0; '{BINARY}' serve <&3 & echo $!; wait")])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(shell.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let process = format!("/proc/{}", line.trim());
        thread::sleep(Duration::from_millis(300));
        let input = shell.stdin.take();
        shell.kill().unwrap();
        shell.wait().unwrap();
        let deadline = Instant::now() + Duration::from_secs(5);
        while Path::new(&process).exists() {
            assert!(Instant::now() < deadline, "the server lives on");
            thread::sleep(Duration::from_millis(20));
        }
        drop(input);
    }
}
