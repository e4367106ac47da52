//! Warm generations against cold ones: the same model bit for bit, with nothing made again that has not changed.
//!
//! `COOLINGGEN_LONG=1` draws many edits instead of a few.

mod common;

use common::{check, sample};
use coolinggen_brep::{Key, Model};
use coolinggen_cooling::design::Design;
use coolinggen_cooling::{Generated, Made, Stopped, Unwatched, Warm, generate};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Instant;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples")
}

fn samples() -> Vec<String> {
    let files = std::fs::read_dir(folder()).unwrap().map(|e| e.unwrap().path());
    let designs = files.filter(|p| p.extension().is_some_and(|e| e == "json"));
    let mut names: Vec<String> = designs.map(|p| p.file_name().unwrap().to_str().unwrap().into()).collect();
    names.sort();
    names
}

fn warmly(warm: &mut Warm, design: &Value) -> Result<Generated, Stopped> {
    let design = Design::from_json(&design.to_string()).map_err(Stopped::Refused)?;
    warm.generate(&design, &folder(), &Unwatched)
}

fn coldly(design: &Value) -> Result<Generated, Stopped> {
    let design = Design::from_json(&design.to_string()).map_err(Stopped::Refused)?;
    generate(&design, &folder()).map_err(Stopped::Refused)
}

/// Everything in a model, bit by bit.
fn bits(model: &Model) -> Key {
    let mut key = model.vertices.iter().fold(Key::default(), |key, vertex| key.and(*vertex));
    for edge in &model.edges {
        key = key.and((edge.start.0, edge.end.0, &edge.curve));
    }
    for face in &model.faces {
        key = key.and((&*face.name, &face.surface)).and(&*face.style.layer);
        for bound in &face.loops {
            key = key.and(&*bound.coedges);
            key = bound.coedges.iter().fold(key, |key, coedge| key.and(coedge.edge.0));
        }
    }
    for solid in &model.solids {
        key = key.and((&*solid.name, solid.expected_genus, solid.shells.len()));
        key = solid.faces().fold(key, |key, used| key.and((used.face.0, used.forward)));
    }
    key
}

fn report(generated: &Generated) -> Value {
    let mut report = generated.report.to_json();
    report.as_object_mut().unwrap().remove("timings_ms").unwrap();
    report
}

/// Fails unless both are the same, refusals included.
fn same(warm: &Result<Generated, Stopped>, cold: &Result<Generated, Stopped>, what: &str) {
    match (warm, cold) {
        (Ok(warm), Ok(cold)) => {
            assert!(report(warm) == report(cold), "the reports of {what} differ");
            assert!(bits(&warm.blade.model) == bits(&cold.blade.model), "the models of {what} differ");
        }
        (Err(warm), Err(cold)) => assert_eq!(warm, cold, "{what}"),
        (warm, cold) => panic!("{what}: warm {:?}, cold {:?}", warm.is_ok(), cold.is_ok()),
    }
}

/// A generator of the same numbers each time (Knuth's MMIX).
struct Draw(u64);

impl Draw {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % n
    }
}

/// Pointers of all numbers below a value.
fn numbers(value: &Value, pointer: &str, out: &mut Vec<String>) {
    match value {
        Value::Number(_) => out.push(pointer.to_owned()),
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, item)| numbers(item, &format!("{pointer}/{i}"), out));
        }
        Value::Object(members) => {
            members.iter().for_each(|(name, member)| numbers(member, &format!("{pointer}/{name}"), out));
        }
        _ => {}
    }
}

#[test]
fn edits_give_warm_what_they_give_cold() {
    let edits = if std::env::var_os("COOLINGGEN_LONG").is_some() { 40 } else { 3 };
    let mut draw = Draw(2026);
    for name in samples() {
        let first = sample(&name);
        let mut warm = Warm::default();
        let (mut before, mut design) = (first.clone(), first.clone());
        same(&warmly(&mut warm, &design), &coldly(&design), &name);
        for _ in 0..edits {
            let mut places = Vec::new();
            numbers(&design["cooling"], "/cooling", &mut places);
            // Blades of curves and points have many numbers: one edit in eight is theirs.
            if places.is_empty() || draw.below(8) == 0 {
                places.clear();
                numbers(&design["blade"], "/blade", &mut places);
            }
            let what = if draw.below(6) == 0 {
                // Back to what it was: undo.
                std::mem::swap(&mut before, &mut design);
                format!("{name} undone")
            } else {
                let place = &places[draw.below(places.len())];
                let number = design.pointer(place).unwrap();
                let factor = [0.9, 0.98, 1.01, 1.1][draw.below(4)];
                let changed = match number.as_u64() {
                    Some(count) if place.ends_with("count") => json!(count + 1),
                    _ => json!(number.as_f64().unwrap() * factor),
                };
                before = design.clone();
                *design.pointer_mut(place).unwrap() = changed;
                format!("{name} with another {place}")
            };
            same(&warmly(&mut warm, &design), &coldly(&design), &what);
        }
    }
}

fn less(after: Made, before: Made) -> Made {
    Made {
        outers: after.outers - before.outers,
        hollows: after.hollows - before.hollows,
        bores: after.bores - before.bores,
        loops: after.loops - before.loops,
        checks: after.checks - before.checks,
    }
}

/// The film row that has one parameter changed: 22 of 120 bores.
const ROW: &str = "/cooling/film_rows/3/hole/inclination_deg";

#[test]
fn a_changed_row_is_all_that_is_made_again() {
    let mut design = sample("rotor-serpentine.json");
    let mut warm = Warm::default();
    let started = Instant::now();
    let cold = warmly(&mut warm, &design).unwrap();
    let cold_time = started.elapsed();
    check(&cold);
    let first = warm.made();
    // Nothing changed, nothing made.
    same(&warmly(&mut warm, &design), &Ok(cold), "the same design");
    assert_eq!(warm.made(), first);
    let angle = design.pointer(ROW).unwrap().as_f64().unwrap();
    let mut least = f64::INFINITY;
    for k in 1..=4 {
        let before = warm.made();
        *design.pointer_mut(ROW).unwrap() = json!(angle + 0.1 * f64::from(k));
        let started = Instant::now();
        let changed = warmly(&mut warm, &design);
        least = least.min(started.elapsed().as_secs_f64() / cold_time.as_secs_f64());
        let made = less(warm.made(), before);
        assert_eq!((made.outers, made.hollows, made.bores), (0, 0, 22), "{made:?}");
        let faces = changed.as_ref().unwrap().report.faces.len() as u64;
        assert!(made.checks < faces / 3, "{made:?} of {faces} faces");
        assert!(made.loops < first.loops / 3, "{made:?} of {first:?}");
        if k == 4 {
            same(&changed, &coldly(&design), "the changed row");
        }
    }
    // A fifth is asked of it with the mesh; other tests run beside this one.
    assert!(least < 0.3, "warm takes {least:.2} of cold");
}

#[test]
fn going_back_costs_nothing_and_a_refusal_spoils_nothing() {
    let first = sample("rotor-serpentine.json");
    let mut second = first.clone();
    *second.pointer_mut(ROW).unwrap() = json!(33.0);
    let mut refused = first.clone();
    // Holes that meet.
    *refused.pointer_mut("/cooling/film_rows/3/hole/diameter").unwrap() = json!(4.0);
    let mut warm = Warm::default();
    warmly(&mut warm, &first).unwrap();
    warmly(&mut warm, &second).unwrap();
    let made = warm.made();
    warmly(&mut warm, &first).unwrap();
    for _ in 0..10 {
        assert!(matches!(warmly(&mut warm, &refused), Err(Stopped::Refused(_))));
    }
    warmly(&mut warm, &second).unwrap();
    assert_eq!(warm.made(), made);
}
