//! Turns with strange numbers, drawn: annular and linear, two to seven chambers, from the hub and from the tip. What is
//! built joins without a jump; what is refused is refused at what was drawn, with numbers.

mod common;
#[path = "mutations/draw.rs"]
mod draw;

use common::{check, sample};
use coolinggen_blade::Fault;
use coolinggen_brep::{Face, SurfaceGeometry};
use coolinggen_cooling::design::Design;
use coolinggen_cooling::{Generated, generate};
use coolinggen_nurbs::ParametricSurface;
use draw::Draw;
use glam::DVec3;
use serde_json::{Value, json};
use std::collections::HashSet;
use std::path::Path;

/// A design of a seed: a sample's blade with a serpentine of its own.
fn design(seed: u64) -> Value {
    let mut draw = Draw::new(seed);
    let linear = draw.once_in(2);
    // A vane three times as large: lengths are in proportion.
    let (mut design, scale) =
        if linear { (sample("c3x.json"), 2.5) } else { (sample("rotor-serpentine.json"), 1.0) };
    let count = 2 + draw.below(6);
    let [low, high] = if linear { [0.14, 0.6] } else { [0.16, 0.7] };
    let share = |i: usize| low + (high - low) * (i as f64 + 0.5) / (count - 1) as f64;
    let law = |draw: &mut Draw, low: f64, high: f64| {
        let (from, to) = (draw.between(low, high), draw.between(low, high));
        if draw.once_in(2) { json!(from) } else { json!([[0, from], [0.5, 0.5 * (from + to)], [1, to]]) }
    };
    let walls: Vec<Value> = (0..count - 1)
        .map(|i| {
            let thickness = law(&mut draw, 0.5 * scale, 1.3 * scale);
            json!({"name": format!("w{i}"), "position": share(i), "angle_deg": law(&mut draw, 72.0, 108.0),
                "thickness": thickness})
        })
        .collect();
    let chambers: Vec<Value> = (0..count)
        .map(|i| json!({"name": format!("c{i}"), "fillet_radius": draw.between(0.3, 0.55) * scale}))
        .collect();
    let first = *draw.of(&[0, 1]);
    let turns: Vec<Value> = (1..count)
        .map(|i| {
            let (end, between) = (["hub", "tip"][(i + first) % 2], [format!("c{}", i - 1), format!("c{i}")]);
            let mut turn = json!({"name": format!("t{i}"), "between": between, "end": end,
                "exponent": draw.between(2.0, 8.0)});
            if draw.once_in(2) {
                turn["clearance"] = json!(draw.between(2.5, 8.0) * scale);
            }
            turn
        })
        .collect();
    let shell = if linear { [2.5, 3.5] } else { [0.9, 1.4] };
    design["cooling"] = json!({
        "shell": {"suction_side": law(&mut draw, shell[0], shell[1]), "pressure_side": law(&mut draw, shell[0], shell[1]),
            "tip": draw.between(1.0, 2.5), "hub": draw.between(1.0, 2.5)},
        "walls": walls, "chambers": chambers, "turns": turns,
    });
    design
}

fn built(seed: u64) -> Result<Generated, Vec<Fault>> {
    generate(&Design::from_json(&design(seed).to_string())?, Path::new("."))
}

type Bits = Vec<[u64; 3]>;

/// The control points of a face's borders across the passage, in both directions, bit for bit.
fn borders(generated: &Generated, path: &str) -> Vec<[Bits; 2]> {
    let faces = generated.blade.model.faces.iter().filter(|f| f.name.starts_with(path));
    let ends = faces.filter_map(|face| match &face.surface {
        SurfaceGeometry::BSpline(s) => {
            let count = s.counts().1;
            let column = |j: usize| -> Bits {
                let points = s.points().iter().skip(j).step_by(count);
                points.map(|p: &DVec3| p.to_array().map(f64::to_bits)).collect()
            };
            Some([column(0), column(count - 1)])
        }
        _ => None,
    });
    ends.collect()
}

/// What holds of every serpentine that is built.
fn holds(seed: u64, generated: &Generated) {
    check(generated);
    let mut of_chambers: HashSet<Bits> = HashSet::new();
    for [start, end] in borders(generated, "chamber/") {
        for border in [start, end] {
            of_chambers.insert(border.iter().rev().copied().collect());
            of_chambers.insert(border);
        }
    }
    let turns = borders(generated, "turn/");
    assert!(!turns.is_empty() && turns.len().is_multiple_of(SEGMENTS), "{seed}");
    for border in turns.iter().flatten() {
        assert!(of_chambers.contains(border), "{seed}: a turn ends beside its chamber");
    }
    let faces: Vec<_> = generated.blade.model.faces.iter().filter(|f| f.name.starts_with("turn/")).collect();
    for turn in faces.chunks(SEGMENTS) {
        let areas: Vec<f64> = (0..=STEPS).map(|i| area(turn, f64::from(i) / f64::from(STEPS))).collect();
        let greatest = areas.iter().fold(0.0f64, |a, b| a.max(*b));
        for pair in areas.windows(2) {
            assert!((pair[0] - pair[1]).abs() < 0.1 * greatest, "{seed} {}: {areas:?}", turn[0].name);
        }
    }
}

/// Faces of a turn, in the order of the ring.
const SEGMENTS: usize = 8;
/// Steps on the way round a turn.
const STEPS: u32 = 200;

/// Area of the ring at `q` of a turn's faces: the length of its vector area.
fn area(turn: &[&Face], q: f64) -> f64 {
    const POINTS: u32 = 10;
    let along = |f: &&Face| {
        let surface = f.surface.clone();
        (0..POINTS).map(move |i| surface.point(f64::from(i) / f64::from(POINTS), q))
    };
    let points: Vec<DVec3> = turn.iter().flat_map(along).collect();
    let next = points.iter().cycle().skip(1);
    0.5 * points.iter().zip(next).map(|(a, b)| (*a - points[0]).cross(*b - points[0])).sum::<DVec3>().length()
}

/// A refusal blames what was drawn, and says how much.
fn explained(seed: u64, faults: &[Fault]) {
    for fault in faults {
        let known = ["/cooling/turns", "/cooling/chambers", "/cooling/walls", "/cooling/shell"];
        assert!(known.iter().any(|k| fault.pointer.starts_with(k)), "{seed}: {fault}");
        assert!(fault.message.contains("mm") || fault.value.is_some(), "{seed}: {fault}");
    }
}

/// How many of the seeds are built.
fn tried(seeds: std::ops::Range<u64>) -> usize {
    let mut count = 0;
    for seed in seeds {
        match built(seed) {
            Ok(generated) => {
                count += 1;
                holds(seed, &generated);
            }
            Err(faults) => {
                println!("{seed}: {}", faults[0]);
                explained(seed, &faults);
            }
        }
    }
    count
}

#[test]
fn strange_turns_join_their_chambers_or_are_refused_with_reasons() {
    let count = tried(0..10);
    assert!(count >= 5, "{count}");
}

#[test]
#[ignore = "takes minutes: cargo test --release -p coolinggen-cooling --test turn_properties -- --ignored"]
fn a_hundred_and_fifty_strange_turns() {
    let count = tried(10..160);
    assert!(count >= 75, "{count}");
}
