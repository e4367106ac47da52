//! Bad designs: every fault at once, with its pointer, and never a panic.

use coolinggen_blade::Fault;
use coolinggen_cooling::design::{Design, design_schema};
use coolinggen_cooling::generate;
use proptest::prelude::*;
use serde_json::{Value, json};
use std::path::Path;

fn sample(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn faults(design: &Value) -> Vec<Fault> {
    match Design::from_json(&design.to_string()) {
        Ok(design) => generate(&design, Path::new(".")).err().unwrap_or_default(),
        Err(faults) => faults,
    }
}

fn pointers(design: &Value) -> Vec<String> {
    faults(design).into_iter().map(|f| f.pointer).collect()
}

#[test]
fn every_fault_is_found_at_once() {
    let mut design = sample("c3x.json");
    design["format"] = json!("coolinggen/0");
    design["space"]["heigth"] = json!(1);
    design["cooling"]["radial_holes"][3]["diameter"] = json!(-1);
    design["cooling"]["radial_holes"][4]["at"]["frame"] = json!("polar");
    design["cooling"]["radial_holes"][5].as_object_mut().unwrap().remove("name");
    design["cooling"]["radial_holes"][6]["diameter"] = json!([[0, 6], [1, "six"]]);
    let found = pointers(&design);
    let expected = [
        "/format",
        "/space/heigth",
        "/cooling/radial_holes/3/diameter",
        "/cooling/radial_holes/4/at/frame",
        "/cooling/radial_holes/5/name",
        "/cooling/radial_holes/6/diameter/1/1",
    ];
    for pointer in expected {
        assert!(found.iter().any(|p| p == pointer), "{pointer} is not among {found:?}");
    }
    assert_eq!(found.len(), expected.len(), "{found:?}");
}

#[test]
fn a_fault_says_value_limit_and_unit() {
    let mut design = sample("c3x.json");
    design["cooling"]["radial_holes"][3]["diameter"] = json!(-1);
    let fault = faults(&design).remove(0);
    assert_eq!((fault.value, fault.min, fault.unit), (Some(json!(-1)), Some(0.01), "mm"));
}

#[test]
fn limits_of_a_law_are_its_values_not_its_abscissae() {
    let mut design = sample("rotor.json");
    design["cooling"]["shell"]["suction_side"] = json!([[0, 1.2], [1, 1.0]]);
    assert_eq!(Design::from_json(&design.to_string()).map(|_| ()), Ok(()));
}

#[test]
fn walls_out_of_order_and_missing_chambers_are_named() {
    let mut design = sample("rotor.json");
    design["cooling"]["walls"][1]["position"] = json!(0.2);
    design["cooling"]["chambers"].as_array_mut().unwrap().pop();
    let found = pointers(&design);
    assert!(found.contains(&"/cooling/walls/1/position".to_owned()), "{found:?}");
    assert!(found.contains(&"/cooling/chambers".to_owned()), "{found:?}");
}

#[test]
fn holes_that_meet_or_leave_are_refused_by_name() {
    let mut design = sample("c3x.json");
    design["cooling"]["radial_holes"][4]["diameter"] = json!(60);
    let found = faults(&design);
    let leaves = found.iter().find(|f| f.code == "leaves_blade").expect("the hole leaves the vane");
    assert_eq!(leaves.pointer, "/cooling/radial_holes/4/diameter");
    assert!(found.iter().any(|f| f.code == "holes_meet"));
    // The number given would fit.
    design["cooling"]["radial_holes"] = json!([design["cooling"]["radial_holes"][4].clone()]);
    design["cooling"]["radial_holes"][0]["diameter"] = json!(leaves.max.unwrap() * 0.999);
    assert_eq!(faults(&design), Vec::new());
}

#[test]
fn a_shell_too_thick_is_refused_with_place_and_amount() {
    let mut design = sample("rotor.json");
    design["cooling"]["shell"]["suction_side"] = json!(3.5);
    design["cooling"]["shell"]["pressure_side"] = json!(3.5);
    let found = faults(&design);
    assert!(!found.is_empty());
    assert!(found.iter().all(|f| f.message.contains("span fraction")), "{found:?}");
}

#[test]
fn the_schema_describes_every_field() {
    fn walk(schema: &Value, path: &str, bare: &mut Vec<String>) {
        if let Some(properties) = schema.get("properties").and_then(Value::as_object) {
            for (name, property) in properties {
                if property.get("description").is_none() && property.get("const").is_none() {
                    bare.push(format!("{path}/{name}"));
                }
            }
        }
        let children = schema.as_object().into_iter().flatten().map(|(k, v)| (k.clone(), v));
        let items = schema.as_array().into_iter().flatten().enumerate().map(|(i, v)| (i.to_string(), v));
        for (key, child) in children.chain(items) {
            walk(child, &format!("{path}/{key}"), bare);
        }
    }
    let mut bare = Vec::new();
    walk(design_schema(), "", &mut bare);
    assert_eq!(bare, Vec::<String>::new());
}

/// All places of a document, as pointers.
fn places(value: &Value, at: String, out: &mut Vec<String>) {
    match value {
        Value::Object(members) => members.iter().for_each(|(k, v)| places(v, format!("{at}/{k}"), out)),
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, v)| places(v, format!("{at}/{i}"), out));
        }
        _ => {}
    }
    out.push(at);
}

fn strange() -> impl Strategy<Value = Value> {
    prop_oneof![
        Just(Value::Null),
        Just(json!([])),
        Just(json!({})),
        Just(json!("")),
        Just(json!(true)),
        Just(json!(0)),
        Just(json!(1e308)),
        Just(json!([[0, 1], [0, 1]])),
        (-5.0f64..5.0).prop_map(Value::from),
        (-1e3f64..1e3).prop_map(Value::from),
    ]
}

/// Puts strange values at places, or scales the number there.
fn mutated(mut design: Value, changes: &[(proptest::sample::Index, Option<Value>, f64)]) -> Value {
    for (index, value, factor) in changes {
        let mut all = Vec::new();
        places(&design, String::new(), &mut all);
        let place = design.pointer_mut(&all[index.index(all.len())]).unwrap();
        match (value, place.as_f64()) {
            (Some(value), _) => *place = value.clone(),
            (None, Some(number)) => *place = json!(number * factor),
            (None, None) => {}
        }
    }
    design
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_mutated_document_panics(
        name in prop_oneof![Just("c3x.json"), Just("rotor.json"), Just("pritchard.json"), Just("surface.json")],
        changes in proptest::collection::vec((any::<proptest::sample::Index>(), proptest::option::of(strange()), 0.5f64..2.0), 1..5),
    ) {
        let _ = Design::from_json(&mutated(sample(name), &changes).to_string());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_mutated_cooling_panics(
        changes in proptest::collection::vec((any::<proptest::sample::Index>(), 0.3f64..3.0), 1..4),
    ) {
        let mut design = sample("pritchard.json");
        design["cooling"] = sample("rotor.json")["cooling"].clone();
        let changes: Vec<_> = changes.into_iter().map(|(i, f)| (i, None, f)).collect();
        design["cooling"] = mutated(design["cooling"].clone(), &changes);
        let _ = faults(&design);
    }
}
