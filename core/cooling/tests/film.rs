//! Film holes and slots on the rotor with three chambers: solids, genus, names, and what is refused.

mod common;

use common::sample;
use coolinggen_blade::Fault;
use coolinggen_cooling::design::Design;
use coolinggen_cooling::{Generated, generate};
use serde_json::{Value, json};
use std::path::Path;

fn rotor(rows: Value) -> Result<Generated, Vec<Fault>> {
    rotor_with("film_rows", rows)
}

fn rotor_with(field: &str, rows: Value) -> Result<Generated, Vec<Fault>> {
    let mut design = sample("rotor.json");
    design["cooling"][field] = rows;
    generate(&Design::from_json(&design.to_string())?, Path::new("."))
}

fn built(design: &Value) -> Generated {
    let design = Design::from_json(&design.to_string()).unwrap_or_else(|f| panic!("{f:?}"));
    generate(&design, Path::new(".")).unwrap_or_else(|f| panic!("{f:?}"))
}

fn row(name: &str, side: &str, position: f64, count: u32, hole: Value) -> Value {
    json!({
        "name": name, "side": side, "surface_position": position, "span": [0.15, 0.88], "count": count, "hole": hole
    })
}

fn round(diameter: f64, inclination: f64, compound: f64) -> Value {
    json!({ "diameter": diameter, "inclination_deg": inclination, "compound_deg": compound })
}

fn shaped(diameter: f64, metering_length: f64) -> Value {
    let mut hole = round(diameter, 30.0, 0.0);
    hole["shape"] = json!({
        "kind": "shaped", "metering_length_d": metering_length, "lateral_expansion_deg": 7, "forward_expansion_deg": 7
    });
    hole
}

/// Sound, with as many film holes.
fn check(generated: &Generated, holes: usize) {
    common::check(generated);
    assert_eq!(generated.report.holes.len(), holes);
}

#[test]
fn rows_on_both_sides_and_over_the_leading_edge() {
    let mut conical = round(0.4, 35.0, 30.0);
    conical["shape"] = json!({ "kind": "conical", "expansion_deg": 5 });
    let mut console = round(0.4, 40.0, 0.0);
    console["shape"] = json!({ "kind": "racetrack", "width_d": 2.5 });
    let rows = json!([
        row("ps1", "pressure_side", 0.3, 7, round(0.5, 35.0, 0.0)),
        row("ps2", "pressure_side", 0.6, 7, conical),
        row("ss1", "suction_side", 0.2, 7, console),
        row("ss2", "suction_side", 0.4, 7, shaped(0.4, 2.5)),
        row("sh1", "suction_side", 0.0, 7, round(0.5, 30.0, 90.0)),
        row("sh2", "suction_side", 0.05, 7, round(0.5, 30.0, 90.0)),
        row("sh3", "pressure_side", 0.09, 7, round(0.5, 40.0, 90.0)),
    ]);
    let generated = rotor(rows).unwrap_or_else(|f| panic!("{f:?}"));
    check(&generated, 49);
    // The leading chamber is open at the hub: each of its 35 holes makes a handle. The middle one is a void: the first
    // of its 14 holes opens it, the others make handles.
    assert_eq!(generated.report.genus["metal"].found, Some(35 + 13));
    let crossing = generated.blade.model.faces.iter().filter(|f| f.name.ends_with("/exit/2")).count();
    assert!(crossing > 0, "no hole crosses the border of the leading edge");
}

#[test]
fn a_pitch_makes_as_few_holes_as_keep_it() {
    let mut at_pitch = row("ps1", "pressure_side", 0.3, 1, round(0.5, 35.0, 0.0));
    at_pitch.as_object_mut().unwrap().remove("count");
    at_pitch["pitch"] = json!(3.0);
    let generated = rotor(json!([at_pitch])).unwrap_or_else(|f| panic!("{f:?}"));
    let holes = &generated.report.holes;
    check(&generated, holes.len());
    let at = |i: usize| glam::DVec3::from_array(holes[i].position_mm);
    for i in 1..holes.len() {
        let pitch = at(i).distance(at(i - 1));
        assert!(pitch < 3.05 && pitch > 2.5, "{pitch}");
    }
}

/// The only fault's code and message.
fn refusal(rows: Value) -> (&'static str, String) {
    let faults = rotor(rows).expect_err("refused");
    assert!(faults.iter().all(|f| f.pointer.starts_with("/cooling/film_rows/")), "{faults:?}");
    (faults[0].code, faults[0].message.clone())
}

#[test]
fn refusals_name_row_and_hole() {
    let lone = |position: f64, hole: Value| json!([row("r", "suction_side", position, 1, hole)]);
    let (code, message) = refusal(lone(0.97, round(0.5, 90.0, 0.0)));
    assert_eq!(code, "reaches_no_chamber", "{message}");
    let (code, message) = refusal(lone(0.4, shaped(0.5, 20.0)));
    assert_eq!(code, "wall_too_thin", "{message}");
    let (code, message) = refusal(json!([row("r", "pressure_side", 0.3, 300, round(0.5, 35.0, 0.0))]));
    assert_eq!(code, "ligament", "{message}");
    assert!(message.contains("of film row \"r\" meets hole "), "{message}");
    let mut named = row("r", "suction_side", 0.4, 1, round(0.5, 90.0, 0.0));
    named["chamber"] = json!("trailing");
    let (code, message) = refusal(json!([named]));
    assert_eq!(code, "other_chamber", "{message}");
    let mut high = row("r", "pressure_side", 0.3, 1, round(0.5, 90.0, 0.0));
    high["span"] = json!([0.999, 1.0]);
    let (code, message) = refusal(json!([high]));
    assert!(["leaves_blade", "meets_wall", "reaches_no_chamber"].contains(&code), "{code} {message}");
    // Across the wall between the chambers: some of the rim meets one, some the other or the wall.
    let swept: Vec<Value> = (0..60)
        .map(|i| row(&format!("r{i}"), "suction_side", 0.25 + 0.005 * f64::from(i), 1, round(1.2, 90.0, 0.0)))
        .collect();
    let codes: Vec<&str> =
        swept.into_iter().filter_map(|row| rotor(json!([row])).err().map(|faults| faults[0].code)).collect();
    assert!(codes.contains(&"meets_wall"), "{codes:?}");
    assert!(!codes.contains(&"geometry"), "{codes:?}");
}

#[test]
fn place_and_number_must_be_said_once() {
    let mut twice = row("r", "suction_side", 0.4, 3, round(0.5, 90.0, 0.0));
    twice["surface_distance"] = json!(3.0);
    twice["pitch"] = json!(3.0);
    let faults = rotor(json!([twice])).expect_err("refused");
    assert_eq!(faults.iter().filter(|f| f.code == "one_of").count(), 2, "{faults:?}");
}

fn slots(count: u32, height: f64, width: f64) -> Value {
    json!([{ "name": "te", "span": [0.05, 0.9], "count": count, "height": height, "width": width, "corner_radius": 0.1 }])
}

#[test]
fn slots_through_the_trailing_edge() {
    let generated = rotor_with("slot_rows", slots(9, 2.0, 0.4)).unwrap_or_else(|f| panic!("{f:?}"));
    check(&generated, 0);
    assert_eq!(generated.report.genus["metal"].found, Some(9));
    assert_eq!(generated.report.slots.len(), 9);
    for slot in &generated.report.slots {
        assert_eq!(slot.passage, "trailing");
        // The rectangle less its corners, a little more where the edge is round.
        let section = 2.0 * 0.4 - (4.0 - std::f64::consts::PI) * 0.01;
        assert!(slot.breakout_mm2 > section && slot.breakout_mm2 < 1.1 * section, "{}", slot.breakout_mm2);
    }
}

#[test]
fn slots_that_do_not_fit_are_refused() {
    let codes =
        |rows| rotor_with("slot_rows", rows).expect_err("refused").iter().map(|f| f.code).collect::<Vec<_>>();
    assert_eq!(codes(slots(40, 2.0, 0.4)), ["ligament"]);
    assert_eq!(codes(slots(1, 2.0, 2.5)), ["meets_wall"]);
    assert_eq!(codes(slots(1, 2.0, 0.15)), ["limit"]);
}

/// One serpentine passage with 108 film holes, three rows of them a showerhead, and 12 slots that part the face of the
/// chamber's end between them.
#[test]
fn a_serpentine_with_a_hundred_holes_and_slots() {
    let generated = built(&sample("rotor-serpentine.json"));
    check(&generated, 108);
    // Open at the hub, closed at the other end: every bore makes a handle.
    assert_eq!(generated.report.genus["metal"].found, Some(108 + 12));
    assert_eq!(generated.report.genus["coolant/leading"].found, Some(0));
}

/// The serpentine's rows with smaller holes, nearer to each other, and more of them.
#[test]
fn a_serpentine_with_four_hundred_holes() {
    let mut design = sample("rotor-serpentine.json");
    let rows = design["cooling"]["film_rows"].as_array_mut().unwrap();
    for row in rows.iter_mut() {
        row["count"] = json!(50);
        row["hole"]["diameter"] = json!(0.25);
        if row["hole"]["shape"].is_object() {
            row["hole"]["shape"]["metering_length_d"] = json!(6.5);
        }
    }
    for (name, position) in [("pressure_2", 0.5), ("pressure_3", 0.58), ("pressure_4", 0.66)] {
        rows.push(row(name, "pressure_side", position, 50, round(0.25, 35.0, 0.0)));
    }
    let generated = built(&design);
    check(&generated, 400);
    assert_eq!(generated.report.genus["metal"].found, Some(400 + 12));
    assert_eq!(generated.report.genus["coolant/leading"].found, Some(0));
}

#[test]
fn rows_by_camber_position_single_holes_and_laws_along_a_row() {
    let mut camber = row("camber", "suction_side", 0.0, 6, round(0.4, 40.0, 0.0));
    camber.as_object_mut().unwrap().remove("surface_position");
    camber["camber_position"] = json!(0.45);
    camber["hole"]["diameter"] = json!([[0, 0.3], [1, 0.5]]);
    camber["hole"]["inclination_deg"] = json!([[0, 30], [1, 50]]);
    camber["hole"]["compound_deg"] = json!([[0, -20], [1, 20]]);
    let mut single = row("single", "pressure_side", 0.4, 1, round(0.5, 60.0, 0.0));
    single["span"] = json!([0.5, 0.5]);
    let generated = rotor(json!([camber, single])).unwrap_or_else(|f| panic!("{f:?}"));
    check(&generated, 7);
    let holes = &generated.report.holes;
    for (i, hole) in holes[..6].iter().enumerate() {
        // In the middle of its sixth of the span from 0.15 to 0.88.
        let v = 0.15 + (0.88 - 0.15) * (i as f64 + 0.5) / 6.0;
        for (found, [from, to]) in [
            (hole.diameter_mm, [0.3, 0.5]),
            (hole.inclination_deg, [30.0, 50.0]),
            (hole.compound_deg, [-20.0, 20.0]),
        ] {
            assert!((found - (from + (to - from) * v)).abs() < 1e-12, "hole {i}: {found}");
        }
    }
    let lone = &holes[6];
    assert!(lone.coverage.is_none());
    let at = glam::DVec3::from_array(lone.position_mm);
    let design = Design::from_json(&sample("rotor.json").to_string()).unwrap();
    let (space, _) = coolinggen_blade::build(&design.space, &design.blade, Path::new(".")).unwrap();
    assert!((space.span_fraction(at).unwrap() - 0.5).abs() < 1e-6);
}

/// The rotor's trailing slots with the pressure side cut back.
fn cutback(lip: f64, width: f64) -> Value {
    let mut rows = slots(9, 2.0, width);
    rows[0]["cutback"] = json!({ "lip_thickness": lip });
    rows
}

#[test]
fn the_pressure_side_cut_back() {
    let generated = rotor_with("slot_rows", cutback(0.45, 0.4)).unwrap_or_else(|f| panic!("{f:?}"));
    check(&generated, 0);
    assert_eq!(generated.report.genus["metal"].found, Some(9));
    let model = &generated.blade.model;
    let [straight, open] = [slots(9, 2.0, 0.4), cutback(0.45, 0.4)]
        .map(|rows| rotor_with("slot_rows", rows).unwrap_or_else(|f| panic!("{f:?}")).report);
    for (slot, before) in open.slots.iter().zip(&straight.slots) {
        let length = slot.open_length_mm.unwrap();
        assert!(length > 0.5 && length < slot.length_mm, "{length}");
        // Open over the slot's height and the open part's length, which the lip's slope shortens.
        assert!(slot.breakout_mm2 > 0.6 * length * 2.0 && slot.breakout_mm2 < 1.1 * (length + 0.4) * 2.0);
        assert!(slot.breakout_mm2 > 3.0 * before.breakout_mm2);
        // As far as the lip the wall is no thinner than there.
        let [suction, pressure] = slot.side_walls_mm.map(Option::unwrap);
        assert!(pressure > 0.3 && pressure <= 0.45 + 1e-6, "{pressure}");
        assert!(suction > 0.0);
    }
    // Each slot opens on the pressure side and at the trailing edge.
    let exits = model.faces.iter().filter(|f| f.name.starts_with("slot/te/001/exit")).count();
    assert_eq!(exits, 2);
    assert!(generated.report.to_text().contains("slot row"));
}

#[test]
fn slots_beside_thin_sides_are_refused_with_what_fits() {
    let refused = |rows: Value, least: f64| {
        let mut design = sample("rotor.json");
        design["cooling"]["slot_rows"] = rows;
        design["cooling"]["least_ligament"] = json!(least);
        let faults = generate(&Design::from_json(&design.to_string()).unwrap(), Path::new("."))
            .map(|_| ())
            .expect_err("refused");
        faults[0].clone()
    };
    let fault = refused(slots(1, 2.0, 0.4), 0.5);
    assert_eq!(
        (fault.pointer.as_str(), fault.code),
        ("/cooling/slot_rows/0/width", "side_wall"),
        "{fault:?}"
    );
    let width = fault.max.unwrap();
    assert!(width < 0.4);
    if width > 0.25 {
        rotor_with("slot_rows", slots(1, 2.0, width - 1e-6)).unwrap_or_else(|f| panic!("{f:?}"));
    }
    let fault = refused(slots(1, 2.0, 2.5), 0.0);
    assert_eq!(
        (fault.pointer.as_str(), fault.code),
        ("/cooling/slot_rows/0/width", "meets_wall"),
        "{fault:?}"
    );
    assert!(fault.max.unwrap() < 2.5);
    for (lip, over) in [(9.0, true), (0.02, false)] {
        let fault = refused(cutback(lip, 0.3), 0.0);
        assert_eq!(fault.pointer, "/cooling/slot_rows/0/cutback/lip_thickness");
        assert_eq!((fault.max.is_some(), fault.min.is_some()), (over, !over), "{fault:?}");
    }
}

/// Film holes need no chambers: here they are fed by a radial hole of the C3X vane.
#[test]
fn film_holes_fed_by_a_radial_hole() {
    let mut design = sample("c3x.json");
    design["cooling"]["film_rows"] = json!([{
        "name": "head", "side": "pressure_side", "surface_position": 0.02, "span": [0.2, 0.8], "count": 5,
        "hole": round(1.0, 90.0, 0.0)
    }]);
    let design = Design::from_json(&design.to_string()).unwrap();
    let generated = generate(&design, Path::new(".")).unwrap_or_else(|f| panic!("{f:?}"));
    check(&generated, 5);
    assert_eq!(generated.report.genus["metal"].found, Some(10 + 5));
}
