//! Bad designs: every fault at once, with its pointer, and never a panic.

use coolinggen_blade::Fault;
use coolinggen_cooling::design::{Design, design_schema};
use coolinggen_cooling::generate;
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

/// A straight vane in a cascade, where the chart is the plane of the section: lengths in it are lengths in space.
fn straight_vane(fillets: [f64; 2]) -> Value {
    let mut design = sample("c3x.json");
    design["cooling"] = json!({
        "shell": {"suction_side": 2.0, "pressure_side": 2.0},
        "walls": [{"name": "w", "position": 0.4, "angle_deg": 80, "thickness": 1.5}],
        "chambers": [{"name": "front", "fillet_radius": fillets[0]}, {"name": "back", "fillet_radius": fillets[1]}],
    });
    design
}

#[test]
fn the_greatest_fillet_is_told_exactly() {
    assert_eq!(faults(&straight_vane([1.0, 1.0])), Vec::new());
    for chamber in [0, 1] {
        let with = |radius: f64| {
            let mut fillets = [1.0, 1.0];
            fillets[chamber] = radius;
            faults(&straight_vane(fillets))
        };
        // On the wall the fillets overlap, in front of it and behind it, where the rounded end shrinks with them.
        let asked = [12.0, 9.0][chamber];
        let found = with(asked);
        let at = format!("/cooling/chambers/{chamber}/fillet_radius");
        let fault = found.iter().find(|f| f.pointer == at).unwrap_or_else(|| panic!("{found:?}"));
        assert_eq!((fault.value.clone(), fault.unit), (Some(json!(asked)), "mm"));
        let greatest = fault.max.expect("the greatest is told");
        assert_eq!(with(0.999 * greatest), Vec::new(), "{fault:?}");
        assert!(!with(1.001 * greatest).is_empty(), "{fault:?}");
    }
}

#[test]
fn the_greatest_fillet_is_told_exactly_in_an_annulus_too() {
    // The trailing chamber's end moves with the radius, and with it the part of the shell that is corrected for lean.
    for (chamber, too_great) in [(1, 1.001), (2, 1.005)] {
        let with = |radius: f64| {
            let mut design = sample("rotor.json");
            design["cooling"]["chambers"][chamber]["fillet_radius"] = json!(radius);
            faults(&design)
        };
        let found = with(4.0);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].value, Some(json!(4.0)));
        let greatest = found[0].max.expect("the greatest is told");
        assert_eq!(with(0.999 * greatest), Vec::new());
        assert!(!with(too_great * greatest).is_empty());
    }
}

#[test]
fn a_shell_too_thick_is_told_by_how_much() {
    let with = |shell: f64| {
        let mut design = sample("rotor.json");
        design["cooling"]["shell"] = json!({"suction_side": shell, "pressure_side": shell});
        faults(&design)
    };
    for shell in [2.5, 2.8, 2.9, 2.95, 2.98, 3.0, 3.05, 3.1, 3.15, 3.2, 3.5, 4.0] {
        let found = with(shell);
        assert!(!found.is_empty());
        for fault in found {
            let (value, max) = (fault.value.as_ref().and_then(Value::as_f64).unwrap(), fault.max.unwrap());
            assert!(
                value > max && fault.unit == "mm" && fault.message.contains("span fraction"),
                "{fault:?}"
            );
            // At most two ends are too great for the shell: as thick as told, that one has room.
            if fault.pointer == "/cooling/shell" {
                let still = with(0.999 * max).into_iter().find(|f| f.pointer == fault.pointer);
                assert!(
                    still.is_none_or(
                        |f| f.message.split("radius").nth(1) != fault.message.split("radius").nth(1)
                    )
                );
            }
        }
    }
}

#[test]
fn walls_that_cross_or_miss_the_sides_are_blamed() {
    let mut design = sample("rotor.json");
    design["cooling"]["walls"][1]["angle_deg"] = json!(30);
    design["cooling"]["walls"][0]["angle_deg"] = json!(150);
    let found = pointers(&design);
    assert!(found.iter().any(|p| p == "/cooling/walls/1"), "{found:?}");
}

/// The Pritchard sample with a short tangential chord, which drives a hump into the suction side at the throat.
fn humped(throat: f64) -> Value {
    let mut design = sample("pritchard.json");
    design["blade"]["tangential_chord"] = json!(10);
    design["blade"]["throat"] = json!([[0, 8.9], [1, throat]]);
    design
}

#[test]
fn a_hump_is_passed_or_named_with_place_and_radius() {
    // At the tip the side bends with 4.24 mm beneath a circle of 4.27 mm, just where marching used to start.
    assert_eq!(faults(&humped(9.9)), Vec::new());
    let found = faults(&humped(9.3));
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].pointer, "/blade");
    assert!(found[0].message.contains("at 38 % of the suction side"), "{found:?}");
    assert!(found[0].hint.is_some());
}
