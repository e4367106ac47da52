//! No design brings the crate down: thousands of mutated ones are built or refused with pointers.

mod common;

use common::*;
use coolinggen_blade::{BladeSource, Fault, SpaceSpec, build};
use proptest::prelude::*;
use serde_json::{Value, json};
use std::path::Path;

fn designs() -> Vec<Value> {
    let stadium: Vec<Value> = (0..=24)
        .map(|i| {
            let a = f64::from(i % 24) / 24.0 * std::f64::consts::TAU;
            json!([[20.0 * a.cos(), 6.0 * a.sin(), 0.0], [18.0 * a.cos(), 6.0 * a.sin(), 80.0]])
        })
        .collect();
    let mut knots = vec![0.0; 3];
    knots.extend((0..=22).map(f64::from));
    knots.extend([22.0; 3]);
    vec![
        c3x(),
        rotor(&[0.0, 0.5, 1.0]),
        json!({"space": {"kind": "annular", "hub": [[-20, 135], [60, 137]],
            "shroud": {"degree": 2, "knots": [0, 0, 0, 1, 1, 1], "points": [[-20, 165], [20, 169], [60, 175]]}},
            "blade": {"kind": "pritchard", "axial_chord": [[0, 30], [1, 26]], "tangential_chord": 12,
            "unguided_turning_deg": 6.3, "inlet_angle_deg": [[0, 38], [1, 20]], "inlet_half_wedge_deg": 9,
            "leading_edge_radius": 1.4, "exit_angle_deg": [[0, -56], [1, -61]], "trailing_edge_radius": 0.5,
            "blade_count": 50, "throat": [[0, 8.9], [1, 9.9]], "x": 12}}),
        json!({"space": linear(), "blade": {"kind": "surface", "degree_u": 3, "degree_v": 1, "knots_u": knots,
            "knots_v": [0, 0, 1, 1], "points": stadium}}),
        json!({"space": {"kind": "streamlines", "streamlines": [
            {"v": 0, "contour": [[0, 100], [50, 110]]}, {"v": 0.5, "contour": [[0, 120], [20, 121], [50, 140]]},
            {"v": 1, "contour": [[0, 140], [50, 170]]}]},
            "blade": {"kind": "step", "file": "nowhere.step", "faces": ["a"]}}),
    ]
}

/// Every number, list and object in `value`, counted in a fixed order.
fn count(value: &Value) -> usize {
    1 + match value {
        Value::Array(items) => items.iter().map(count).sum(),
        Value::Object(fields) => fields.values().map(count).sum(),
        _ => 0,
    }
}

/// Changes the value number `at`.
fn mutate(value: &mut Value, at: &mut usize, kind: u8, number: f64) -> bool {
    if *at == 0 {
        *value = match (kind % 10, &*value) {
            (0, _) => Value::Null,
            (1, _) => json!(number),
            (2, Value::Number(n)) => json!(n.as_f64().unwrap_or(0.0) * number),
            (3, Value::Number(n)) => json!(n.as_f64().unwrap_or(0.0) + number),
            (4, Value::Number(_)) => json!(0),
            (5, Value::Array(items)) => json!(items.iter().rev().collect::<Vec<_>>()),
            (6, Value::Array(items)) => json!(items[..items.len() / 2]),
            (7, Value::Array(items)) => json!(items.iter().chain(items).collect::<Vec<_>>()),
            (8, _) => json!([]),
            (9, Value::Array(items)) if !items.is_empty() => {
                let mut items = items.clone();
                let k = (number.abs() * 7.0) as usize % items.len();
                items.remove(k);
                json!(items)
            }
            (_, Value::Number(n)) => json!(-n.as_f64().unwrap_or(1.0)),
            (_, other) => other.clone(),
        };
        return true;
    }
    *at -= 1;
    match value {
        Value::Array(items) => items.iter_mut().any(|v| mutate(v, at, kind, number)),
        Value::Object(fields) => fields.values_mut().any(|v| mutate(v, at, kind, number)),
        _ => false,
    }
}

fn check(faults: &[Fault]) {
    assert!(!faults.is_empty());
    for f in faults {
        assert!(f.pointer.starts_with("/space") || f.pointer.starts_with("/blade"), "{f:?}");
        assert!(!f.message.is_empty() && !f.message.contains("NaN"), "{f:?}");
        serde_json::to_string(f).unwrap();
    }
}

proptest! {
    #[test]
    fn mutated_designs_are_built_or_refused(
        which in 0usize..5,
        changes in proptest::collection::vec((any::<usize>(), any::<u8>(), prop_oneof![-3.0f64..3.0, -1e9f64..1e9, Just(1e-12)]), 1..4),
    ) {
        let mut design = designs().swap_remove(which);
        for (at, kind, number) in changes {
            let mut at = at % count(&design);
            mutate(&mut design, &mut at, kind, number);
        }
        let space: Result<SpaceSpec, _> = serde_json::from_value(design["space"].clone());
        let blade: Result<BladeSource, _> = serde_json::from_value(design["blade"].clone());
        if let (Ok(space), Ok(blade)) = (space, blade) {
            match build(&space, &blade, Path::new("/nonexistent")) {
                Ok((space, blade)) => {
                    // What is built can be used.
                    for v in [0.0, 0.5, 1.0] {
                        let surface = space.surface(v).unwrap();
                        let _ = blade.profile(&surface, &around(50));
                    }
                    prop_assert!(blade.regions.len() >= 3);
                    prop_assert!(blade.fit.greatest_distance_mm.is_finite());
                }
                Err(faults) => check(&faults),
            }
        }
    }
}

#[test]
fn unknown_fields_are_refused() {
    for mut design in designs() {
        design["blade"]["colour"] = json!("red");
        assert!(
            serde_json::from_value::<BladeSource>(design["blade"].clone()).is_err(),
            "{}",
            design["blade"]["kind"]
        );
        design["space"]["colour"] = json!("red");
        assert!(serde_json::from_value::<SpaceSpec>(design["space"].clone()).is_err());
    }
    let _ = schemars::schema_for!(BladeSource);
    let schema = serde_json::to_value(schemars::schema_for!(SpaceSpec)).unwrap();
    assert!(schema.to_string().contains("meridional") || schema.to_string().contains("shroud"));
}
