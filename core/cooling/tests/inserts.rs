//! Impingement inserts: solids, genus, gap and thickness, jets, and what is refused.

mod common;

use common::sample;
use coolinggen_blade::Fault;
use coolinggen_cooling::design::Design;
use coolinggen_cooling::{Generated, generate};
use serde_json::{Value, json};
use std::collections::HashSet;
use std::path::Path;

fn build(design: &Value) -> Result<Generated, Vec<Fault>> {
    generate(&Design::from_json(&design.to_string())?, Path::new("."))
}

/// The rotor with these inserts: its leading and trailing chambers are open at the hub, the middle one begins above.
fn rotor(inserts: Value) -> Result<Generated, Vec<Fault>> {
    let mut design = sample("rotor.json");
    design["cooling"]["inserts"] = inserts;
    build(&design)
}

fn insert(chamber: &str, gap: f64) -> Value {
    json!({ "chamber": chamber, "gap": gap, "thickness": 0.3 })
}

fn with_jets(mut insert: Value, jets: Value) -> Value {
    insert["jets"] = jets;
    insert
}

fn array(name: &str, side: &str, columns: u32, rows: u32) -> Value {
    json!({
        "name": name, "side": side, "diameter": 0.4, "position": [0.15, 0.85], "streamwise_count": columns,
        "span": [0.2, 0.8], "spanwise_count": rows, "stagger": 0.5
    })
}

fn built(inserts: Value) -> Generated {
    let generated = rotor(inserts).unwrap_or_else(|faults| panic!("{faults:?}"));
    check(&generated);
    generated
}

/// As every design, and no face bounds more than two solids: metal and coolant, metal and insert, insert and coolant.
fn check(generated: &Generated) {
    common::check(generated);
    for face in &generated.report.faces {
        assert!([1, 2].contains(&face.solids.len()), "{}", face.name);
    }
}

fn genus(generated: &Generated, solid: &str) -> usize {
    generated.report.genus[solid].found.unwrap()
}

fn face_names(generated: &Generated) -> HashSet<&str> {
    generated.blade.model.faces.iter().map(|f| f.name.as_str()).collect()
}

#[test]
fn without_jets_the_plenum_is_a_solid_of_its_own() {
    let plain = build(&sample("rotor.json")).unwrap();
    for chamber in ["leading", "middle", "trailing"] {
        let gap = if chamber == "trailing" { 0.3 } else { 0.6 };
        let generated = built(json!([insert(chamber, gap)]));
        let solids = &generated.report.solids;
        for name in [format!("insert/{chamber}"), format!("coolant/{chamber}/plenum")] {
            assert!(solids.contains_key(&name), "{name}");
            assert_eq!(genus(&generated, &name), 0);
        }
        // The sheet parts the coolant; where it stands in a seat the metal loses what the seat takes, and no more.
        let chamber_volume = plain.report.solids[&format!("coolant/{chamber}")].volume_mm3;
        let parts =
            [format!("insert/{chamber}"), format!("coolant/{chamber}/plenum"), format!("coolant/{chamber}")];
        let volume: f64 = parts.iter().map(|name| solids[name].volume_mm3).sum();
        let metal = plain.report.solids["metal"].volume_mm3 - solids["metal"].volume_mm3;
        assert!((volume - chamber_volume - metal).abs() < 1e-9 * chamber_volume);
        assert_eq!(metal > 1e-6 * chamber_volume, chamber == "middle", "{metal}");
        // The chamber's opening, or the seat's, is one opening of the metal either way: the middle chamber was a void.
        assert_eq!(genus(&generated, "metal"), genus(&plain, "metal"));
    }
}

#[test]
fn a_seat_closes_the_gap() {
    let seated = built(json!([insert("middle", 0.6)]));
    let names = face_names(&seated);
    assert!(names.contains("insert/middle/seat/pressure_side"));
    assert!(names.contains("coolant/inlet/middle/plenum") && !names.contains("coolant/inlet/middle"));
    let open = built(json!([insert("leading", 0.6)]));
    let names = face_names(&open);
    assert!(names.contains("coolant/inlet/leading/plenum") && names.contains("coolant/inlet/leading"));
    assert!(!names.iter().any(|name| name.contains("/seat/")));
}

#[test]
fn jets_join_plenum_and_gap() {
    let jets = json!([
        array("ss", "suction_side", 3, 6),
        array("ps", "pressure_side", 2, 5),
        array("head", "front", 1, 7)
    ]);
    let generated = built(json!([with_jets(insert("leading", 0.6), jets)]));
    let n = 3 * 6 + 2 * 5 + 7;
    assert_eq!(generated.report.jets.len(), n);
    // A ball with n holes through it; two balls joined by n bars.
    assert_eq!(genus(&generated, "insert/leading"), n);
    assert_eq!(genus(&generated, "coolant/leading"), n - 1);
    assert!(!generated.report.solids.contains_key("coolant/leading/plenum"));
    for jet in &generated.report.jets {
        assert!((jet.length_mm - 0.3).abs() < 0.01, "{} {}", jet.name, jet.length_mm);
        // The gap is the least distance to the chamber; along the sheet's normal it is as short at its sides.
        let target = jet.target_mm.unwrap();
        let side = !jet.name.contains("/head/");
        assert!(target > 0.6 - 1e-3 && (target < 0.61 || !side), "{} {target}", jet.name);
        assert!((jet.target_d.unwrap() - target / 0.4).abs() < 1e-12);
    }
}

/// Two inserts of one blade, opening at opposite ends; both chambers run through from hub to tip.
#[test]
fn inserts_open_at_either_end() {
    let mut design = sample("rotor.json");
    design["cooling"]["shell"].as_object_mut().unwrap().remove("tip");
    design["cooling"]["chambers"][1].as_object_mut().unwrap().remove("span");
    let mut from_tip = with_jets(insert("leading", 0.6), json!([array("ps", "pressure_side", 2, 4)]));
    from_tip["closed_end"] = json!("hub");
    let from_hub = with_jets(insert("middle", 0.6), json!([array("wall", "back", 1, 4)]));
    design["cooling"]["inserts"] = json!([from_tip, from_hub]);
    let generated = build(&design).unwrap_or_else(|faults| panic!("{faults:?}"));
    check(&generated);
    let names = face_names(&generated);
    for inlet in ["coolant/inlet/leading/plenum", "coolant/inlet/middle/plenum", "coolant/outlet/middle"] {
        assert!(names.contains(inlet), "{inlet}");
    }
    let inlet = generated.report.faces.iter().find(|f| f.name == "coolant/inlet/leading/plenum").unwrap();
    let hub = generated.report.faces.iter().find(|f| f.name == "coolant/inlet/leading").unwrap();
    let radius = |at: [f64; 3]| at[1].hypot(at[2]);
    assert!(radius(inlet.centroid_mm) > radius(hub.centroid_mm) + 40.0);
}

/// On an upright vane both are exact; on the leaned rotor corners and noses are arcs of inclined sections.
#[test]
fn gap_and_thickness_are_what_was_asked_for() {
    let mut design = sample("vane-insert.json");
    let cooling = design["cooling"].as_object_mut().unwrap();
    for bores in ["film_rows", "slot_rows", "crossover_rows", "pin_arrays"] {
        cooling.remove(bores);
    }
    cooling["inserts"][0].as_object_mut().unwrap().remove("jets");
    let generated = build(&design).unwrap();
    check(&generated);
    let report = &generated.report.inserts[0];
    assert!((report.thickness_mm.min - 0.7).abs() < 1e-4, "{:?}", report.thickness_mm);
    assert!((report.thickness_mm.max - 0.7).abs() < 1e-4, "{:?}", report.thickness_mm);
    // The gap's law at the seat: 2 + 0.4 v.
    assert!((report.gap_mm.min - 2.024).abs() < 1e-3, "{:?}", report.gap_mm);

    let mut asked = insert("leading", 0.6);
    asked["gap"] = json!([[0, 0.5], [1, 0.8]]);
    asked["thickness"] = json!([[0, 0.3], [1, 0.25]]);
    let generated = built(json!([asked]));
    let report = &generated.report.inserts[0];
    assert!((report.gap_mm.min - 0.5).abs() < 2e-3, "{:?}", report.gap_mm);
    let range = report.thickness_mm;
    assert!(range.min > 0.97 * 0.25 && range.max < 1.08 * 0.3, "{range:?}");
}

/// The only fault.
fn refusal(inserts: Value) -> Fault {
    let faults = rotor(inserts).expect_err("refused");
    assert!(faults[0].pointer.starts_with("/cooling/inserts/"), "{faults:?}");
    faults[0].clone()
}

#[test]
fn what_does_not_fit_is_refused_with_what_would() {
    for (field, chamber) in
        [("gap", "middle"), ("thickness", "leading"), ("gap", "trailing"), ("thickness", "middle")]
    {
        let mut wide = insert(chamber, 0.3);
        wide[field] = json!(6.0);
        let fault = refusal(json!([wide]));
        assert_eq!(
            (fault.pointer.as_str(), fault.code),
            (&*format!("/cooling/inserts/0/{field}"), "no_room")
        );
        let greatest = fault.max.unwrap();
        assert!(greatest > 0.1 && greatest < 6.0, "{field} of {chamber}: {greatest}");
        wide[field] = json!(greatest);
        if field == "gap" {
            // What fits between the chamber's faces must still leave room for a sheet.
            wide["thickness"] = json!(0.011);
            wide["corner_radius"] = json!(0.6);
        }
        built(json!([wide]));
    }
}

#[test]
fn inserts_are_refused_by_name() {
    let code = |inserts| {
        let fault = refusal(inserts);
        (fault.code, fault.pointer)
    };
    assert_eq!(code(json!([insert("none", 0.6)])).0, "unknown_name");
    assert_eq!(code(json!([insert("leading", 0.6), insert("leading", 0.5)])).0, "taken");
    let spans = [([0.1, 0.8], "limit", "0"), ([0.0, 0.999], "limit", "1"), ([0.0, 0.001], "no_room", "")];
    for (span, expected, end) in spans {
        let mut short = insert("leading", 0.6);
        short["span"] = json!(span);
        let (found, pointer) = code(json!([short]));
        assert_eq!(found, expected);
        assert!(pointer.ends_with(end), "{pointer}");
    }
    let mut sharp = insert("leading", 0.3);
    sharp["corner_radius"] = json!(0.2);
    assert_eq!(code(json!([sharp])), ("limit", "/cooling/inserts/0/corner_radius".to_owned()));
}

#[test]
fn an_insert_needs_its_chambers_opening() {
    let mut design = sample("rotor-serpentine.json");
    let chambers = design["cooling"]["chambers"].as_array().unwrap().clone();
    let names: Vec<&str> = chambers.iter().map(|c| c["name"].as_str().unwrap()).collect();
    design["cooling"].as_object_mut().unwrap().remove("film_rows");
    design["cooling"].as_object_mut().unwrap().remove("slot_rows");
    let mut inserts = json!([insert(names[0], 0.6)]);
    design["cooling"]["inserts"] = inserts.clone();
    check(&build(&design).unwrap_or_else(|faults| panic!("{faults:?}")));
    // The turn at the tip is where this one would open.
    inserts[0]["closed_end"] = json!("hub");
    design["cooling"]["inserts"] = inserts;
    let faults = build(&design).expect_err("refused");
    assert_eq!((faults[0].code, faults[0].pointer.as_str()), ("taken", "/cooling/inserts/0/closed_end"));
}

#[test]
fn jets_are_refused_by_array_and_number() {
    let refused = |jets: Value| refusal(json!([with_jets(insert("leading", 0.6), jets)]));
    let fault = refused(json!([array("ss", "suction_side", 3, 200)]));
    assert_eq!(fault.code, "ligament");
    assert!(fault.message.contains("of array \"ss\" meets jet "), "{}", fault.message);
    assert!(fault.value.as_ref().unwrap().as_f64().unwrap() < 0.0 && fault.min == Some(0.0));
    let mut beyond = array("ss", "suction_side", 3, 3);
    beyond["span"] = json!([0.2, 0.99]);
    let fault = refused(json!([beyond]));
    assert_eq!((fault.code, fault.pointer.as_str()), ("limit", "/cooling/inserts/0/jets/0/span/1"));
    let mut high = array("ss", "suction_side", 1, 1);
    high["span"] = json!([fault.max.unwrap() - 1e-3, fault.max.unwrap() - 1e-3]);
    let fault = refused(json!([high]));
    assert!(["leaves_face", "reaches_no_chamber"].contains(&fault.code), "{}", fault.message);
    let mut twice = array("ss", "suction_side", 3, 3);
    twice["streamwise_pitch_d"] = json!(4.0);
    assert_eq!(refused(json!([twice])).code, "one_of");
}

#[test]
fn a_pitch_makes_as_few_jets_as_keep_it() {
    let mut pitched = array("ss", "suction_side", 1, 1);
    for field in ["streamwise_count", "spanwise_count"] {
        pitched.as_object_mut().unwrap().remove(field);
    }
    pitched["streamwise_pitch_d"] = json!(5.0);
    pitched["spanwise_pitch_d"] = json!(8.0);
    let generated = built(json!([with_jets(insert("leading", 0.6), json!([pitched]))]));
    let jet = &generated.report.jets[0];
    let (x, y) = (jet.streamwise_pitch_d.unwrap(), jet.spanwise_pitch_d.unwrap());
    assert!(x <= 5.0 && x > 2.5, "{x}");
    assert!(y <= 8.0 && y > 7.0, "{y}");
}

/// Gap and plenum go on side by side below the hub, every inlet by the same length; metal and inserts stay what they are.
#[test]
fn inlets_beside_inserts_go_on_below_the_hub() {
    const LENGTH: f64 = 60.0;
    let jets = json!([array("ss", "suction_side", 2, 4)]);
    // The leading chamber's gap is open at the hub, the middle one's is closed by a seat, the trailing one has no insert.
    let inserts = json!([with_jets(insert("leading", 0.6), jets), insert("middle", 0.6)]);
    let mut design = sample("rotor.json");
    design["cooling"]["inserts"] = inserts;
    let before = build(&design).unwrap().report;
    design["cooling"]["inlet_extension"] = json!(LENGTH);
    let generated = build(&design).unwrap_or_else(|faults| panic!("{faults:?}"));
    let report = &generated.report;
    assert!(report.watertight);
    let names = face_names(&generated);
    for (solid, genus) in &report.genus {
        assert_eq!(genus.found, Some(before.genus[solid].expected), "{solid}");
    }
    for solid in ["metal", "insert/leading", "insert/middle"] {
        assert_eq!(report.solids[solid].volume_mm3, before.solids[solid].volume_mm3, "{solid}");
    }
    let inlets = ["leading", "leading/plenum", "middle/plenum", "trailing"];
    for solid in ["coolant/leading", "coolant/middle/plenum", "coolant/trailing"] {
        let area = |face: &&coolinggen_cooling::report::FaceReport| {
            let inlet = inlets.iter().any(|name| face.name == format!("coolant/inlet/{name}"));
            (inlet && face.solids.iter().any(|s| s == solid)).then_some(face.area_mm2)
        };
        let area: f64 = before.faces.iter().filter_map(|face| area(&face)).sum();
        let added = report.solids[solid].volume_mm3 - before.solids[solid].volume_mm3;
        assert!((added / (LENGTH * area) - 1.0).abs() < 0.01, "{solid}: {added}");
    }
    for name in inlets {
        assert!(names.contains(&*format!("coolant/inlet/{name}/inlet_extension/8")), "{name}");
    }
    for k in 1..=8 {
        let insert = |name: &str| format!("coolant/inlet/{name}/inlet_extension/insert/{k}");
        assert!(names.contains(&*insert("leading")) && !names.contains(&*insert("middle/plenum")));
    }
    // The ducts of gap and plenum end in one plane, and all ducts run one way.
    let plane = |name: &str| {
        let face =
            generated.blade.model.faces.iter().find(|f| f.name == format!("coolant/inlet/{name}")).unwrap();
        match &face.surface {
            coolinggen_brep::SurfaceGeometry::Plane(plane) => (plane.origin, plane.x.cross(plane.y)),
            _ => panic!("{name} ends in no plane"),
        }
    };
    let (origin, across) = plane("leading");
    assert!((plane("leading/plenum").0 - origin).dot(across).abs() < 1e-9);
    assert!(inlets.iter().all(|name| plane(name).1.angle_between(across) < 1e-9));
}
