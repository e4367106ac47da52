//! What a live preview asks of the sidecar: changed parameters show at once, and what is no longer wanted stops.

mod client;

use client::{BINARY, Server, floats, sample};
use serde_json::{Value, json};
use std::process::Command;
use std::thread;
use std::time::{Duration, Instant};

/// A server with as many threads for one request.
fn server(threads: u32) -> Server {
    let mut command = Command::new(BINARY);
    let mut server = Server::started(command.arg("serve").env("RAYON_NUM_THREADS", threads.to_string()));
    server.client.result("initialize", &json!({ "protocol_version": 1 }));
    server
}

/// Builds a design and takes its mesh: how long it took, and the mesh.
fn shown(server: &mut Server, model: &str, design: &Value) -> (Duration, Value) {
    let started = Instant::now();
    let params = json!({ "model": model, "design": design, "report": false });
    server.client.result("design/generate", &params);
    let mesh = server.client.result("model/tessellate", &json!({ "model": model, "chord_mm": 0.05 }));
    (started.elapsed(), mesh)
}

/// The most that a changed row may take of the time of the whole. A fifth is asked for, of an optimised build on a quiet
/// machine; less optimisation and what else runs cost short builds more than long ones.
const SHARE: f64 = 0.4;

#[test]
fn a_changed_film_row_shows_in_little_of_the_time() {
    for threads in [1, 2] {
        let mut server = server(threads);
        let mut design = sample("rotor-serpentine.json");
        let mut cold = Duration::MAX;
        for model in ["a", "b", "c"] {
            cold = cold.min(shown(&mut server, model, &design).0);
        }
        let mut warm = Duration::MAX;
        let mut mesh = Value::Null;
        for k in 0..5 {
            *design.pointer_mut("/cooling/film_rows/3/hole/inclination_deg").unwrap() =
                json!(33.0 + 0.5 * f64::from(k));
            let (took, made) = shown(&mut server, "a", &design);
            warm = warm.min(took);
            mesh = made;
        }
        // The mesh of a model that nobody has warmed.
        assert!(shown(&mut server, "d", &design).1 == mesh, "the warm mesh is another one");
        let ratio = warm.as_secs_f64() / cold.as_secs_f64();
        eprintln!("{threads} threads: cold {cold:.0?}, warm {warm:.0?}, {ratio:.3} of it");
        assert!(ratio <= SHARE, "{threads} threads: {warm:?} is {ratio:.3} of {cold:?}");
    }
}

/// `rotor.json` with 400 film holes, of a hub radius that makes another blade of it.
fn four_hundred(hub: f64) -> Value {
    let mut design = sample("rotor.json");
    design["space"]["hub"][0][1] = json!(hub);
    let row = |(k, (side, position)): (usize, (&str, f64))| {
        json!({ "name": format!("r{k}"), "side": side, "surface_position": position, "span": [0.14, 0.86],
            "count": 40, "hole": { "diameter": 0.25, "inclination_deg": 60 } })
    };
    let (suction, pressure) = ("suction_side", "pressure_side");
    let places = [
        (suction, 0.1),
        (suction, 0.16),
        (suction, 0.45),
        (suction, 0.51),
        (suction, 0.74),
        (pressure, 0.15),
        (pressure, 0.21),
        (pressure, 0.47),
        (pressure, 0.53),
        (pressure, 0.75),
    ];
    design["cooling"]["film_rows"] = places.into_iter().enumerate().map(row).collect();
    design
}

/// A cancelled request.
#[derive(Debug)]
struct Answer {
    /// Processor time that the server took from the cancel to the reply.
    work: Duration,
    /// Time that passed.
    wall: Duration,
    method: &'static str,
    after: Duration,
}

/// Processor time that a process has taken so far; none where the system does not tell.
fn processor_time(process: u32) -> Duration {
    let text = std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    // Behind the name, which may hold anything; in hundredths of a second.
    let behind = text.rsplit(')').next().unwrap_or_default();
    let ticks = behind.split_whitespace().skip(11).take(2).filter_map(|t| t.parse::<u64>().ok());
    Duration::from_millis(10 * ticks.sum::<u64>())
}

/// Sends a request and cancels it after a while; none if its reply was ready before.
fn cancelled(server: &mut Server, method: &'static str, params: &Value, after: Duration) -> Option<Answer> {
    let process = server.process.id();
    server.client.send("work", method, params);
    thread::sleep(after);
    let (before, started) = (processor_time(process), Instant::now());
    server.client.cancel("work");
    let reply = server.client.reply();
    let (wall, work) = (started.elapsed(), processor_time(process) - before);
    assert_eq!(reply["id"], "work");
    let error = reply.get("error")?;
    assert_eq!(error["code"], -32800, "{error}");
    Some(Answer { work, wall, method, after })
}

/// What counts is what the server does before it answers: on a quiet machine that is the time that passes.
#[test]
fn a_cancel_is_answered_at_once_at_any_moment() {
    const LIMIT: Duration = Duration::from_millis(100);
    const MOMENTS: u32 = 12;
    let mut server = server(1);
    let folder = tempfile::tempdir().unwrap();
    let params = |hub: f64| json!({ "model": "m", "design": four_hundred(hub), "report": false });
    let started = Instant::now();
    server.client.result("design/generate", &params(250.0));
    let whole = started.elapsed();
    let tessellate = json!({ "model": "m", "chord_mm": 0.01 });
    let export = json!({ "model": "m", "folder": folder.path(), "formats": ["step", "glb", "obj", "stl"] });
    let (mut answers, mut hub) = (Vec::new(), 250.0);
    for k in 1..MOMENTS {
        // Spread over the whole, in no order.
        let part = f64::from(k * 7 % MOMENTS) / f64::from(MOMENTS);
        hub += 1e-3;
        for (method, params, share) in [
            ("design/generate", &params(hub), 1.0),
            ("model/tessellate", &tessellate, 0.4),
            ("model/export", &export, 0.8),
        ] {
            answers.extend(cancelled(&mut server, method, params, whole.mul_f64(part * share)));
        }
    }
    answers.sort_by_key(|answer| answer.work);
    let last = &answers[answers.len() - 1];
    let Answer { work, wall, method, after } = last;
    eprintln!(
        "{} of {whole:.0?} cancelled; most work {work:?}, {wall:.0?} by the clock: {method} after {after:.0?}",
        answers.len()
    );
    assert!(answers.len() > MOMENTS as usize, "{answers:?}");
    assert!(*work <= LIMIT, "{last:?} of {whole:?}");
    // No temporary file is left.
    for file in std::fs::read_dir(folder.path()).unwrap() {
        let name = file.unwrap().file_name();
        assert!(!name.to_string_lossy().starts_with('.'), "{name:?} is left");
    }
}

#[test]
fn a_request_that_waits_is_cancelled_without_waiting() {
    let mut server = server(1);
    let design = sample("rotor-serpentine.json");
    // More than there are workers, all of one model: each waits for the one before.
    for k in 0..12 {
        server.client.send(k, "design/generate", &json!({ "model": "m", "design": design, "report": false }));
    }
    thread::sleep(Duration::from_millis(20));
    for k in (1..12).rev() {
        server.client.cancel(k);
        let reply = server.client.reply();
        assert_eq!((&reply["id"], &reply["error"]["code"]), (&json!(k), &json!(-32800)));
    }
    assert_eq!(server.client.reply()["result"]["model"], "m");
}

#[test]
fn walls_have_their_thickness_at_every_vertex() {
    let mut server = server(2);
    let generated =
        server.client.result("design/generate", &json!({ "model": "m", "design": sample("rotor.json") }));
    let least = generated["report"]["wall_thickness_mm"]["min"].as_f64().unwrap();
    let params = json!({ "model": "m", "solids": ["metal"], "wall_thickness": true });
    let mesh = server.client.result("model/tessellate", &params);
    let solid = &mesh["solids"][0];
    let walls = floats(&solid["wall_thickness_mm"]);
    assert_eq!(3 * walls.len(), floats(&solid["vertices"]).len());
    // Sides are as thick as the shell, or as far from the outer surface as a wall reaches; hub and tip have none.
    let mut first = 0;
    for face in solid["faces"].as_array().unwrap() {
        let name = face["name"].as_str().unwrap();
        let own = &walls[first..first + face["vertices"].as_u64().unwrap() as usize];
        first += own.len();
        let thinnest = own.iter().copied().filter(|t| !t.is_nan()).fold(f32::INFINITY, f32::min);
        if name.starts_with("chamber/") && name.ends_with("_side") {
            assert!(f64::from(thinnest) >= least - 1e-4 && thinnest < 3.0, "{name}: {thinnest}");
        }
        if name == "blade/suction_side" {
            assert!((0.9 * least..3.0).contains(&f64::from(thinnest)), "{name}: {thinnest}");
        }
        if name == "blade/tip" {
            assert!(own.iter().all(|t| t.is_nan()), "{name}");
        }
    }
    assert_eq!(first, walls.len());
}
