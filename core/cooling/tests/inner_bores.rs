//! Crossover holes, pins and dust holes: closed forms on a plate, topology on the rotors, and what is refused.

mod common;

use common::{check, sample};
use coolinggen_blade::Fault;
use coolinggen_cooling::design::Design;
use coolinggen_cooling::{Generated, generate};
use glam::DVec3;
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::path::Path;

/// A design with other values of fields of its cooling.
fn with(mut design: Value, fields: &[(&str, Value)]) -> Result<Generated, Vec<Fault>> {
    for (field, value) in fields {
        design["cooling"][*field] = value.clone();
    }
    generate(&Design::from_json(&design.to_string())?, Path::new("."))
}

/// A prismatic plate in a linear cascade, 40 mm high, 8 mm thick up to x = 50 and tapered from there on, its camber line
/// 95 mm long from x = -4. Between walls 2 mm thick stand three chambers 5 mm wide, open at the hub and 2 mm below the tip.
fn plate() -> Value {
    let side = |up: f64| -> Vec<[f64; 2]> {
        let arc = |x: f64, radius: f64, i: u32| {
            let angle = PI - PI / 24.0 * f64::from(i);
            [x + radius * angle.cos(), up * radius * angle.sin()]
        };
        let front = (0..=12).map(|i| arc(0.0, 4.0, i));
        let side = (1..90).map(|i| {
            let s = ((f64::from(i) - 50.0) / 40.0).max(0.0);
            [f64::from(i), up * (4.0 - 3.0 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s))]
        });
        front.chain(side).chain((12..=24).map(|i| arc(90.0, 1.0, i))).collect()
    };
    let wall = |name: &str, position: f64| json!({ "name": name, "position": position, "angle_deg": 90, "thickness": 2 });
    let chambers =
        ["leading", "middle", "trailing"].map(|name| json!({ "name": name, "fillet_radius": 0.6 }));
    json!({
        "format": "coolinggen/1", "name": "plate", "space": { "kind": "linear", "z0": 0, "height": 40 },
        "blade": { "kind": "sections", "tolerance": 0, "sections": [
            { "span": 0, "suction_side": side(1.0), "pressure_side": side(-1.0) }
        ] },
        "cooling": {
            "shell": { "suction_side": 1.5, "pressure_side": 1.5, "tip": 2 },
            "walls": [wall("w1", 0.2), wall("w2", 0.45)],
            "chambers": chambers
        }
    })
}

fn volume(generated: &Generated, solid: &str) -> f64 {
    generated.report.solids[solid].volume_mm3
}

fn genus(generated: &Generated, solid: &str) -> usize {
    generated.report.genus[solid].found.unwrap()
}

fn ok(result: Result<Generated, Vec<Fault>>) -> Generated {
    let generated = result.unwrap_or_else(|faults| panic!("{faults:?}"));
    check(&generated);
    generated
}

/// What the metal has more than it has without.
fn gained(generated: &Generated) -> f64 {
    volume(generated, "metal") - volume(&ok(with(plate(), &[])), "metal")
}

/// Greatest error of volumes that a delimiting curve within 2e-8 mm of its surface can make, mm3.
const VOLUME: f64 = 1e-5;

fn pins(span: [f64; 2], camber: [f64; 2], diameter: f64, pitches: [f64; 2]) -> Value {
    json!([{
        "name": "p", "chamber": "middle", "span": span, "camber": camber, "diameter": diameter,
        "spanwise_pitch_d": pitches[0], "streamwise_pitch_d": pitches[1]
    }])
}

#[test]
fn pins_between_parallel_sides() {
    let array = pins([0.1, 0.9], [0.25, 0.4], 1.2, [2.5, 2.5]);
    let generated = ok(with(plate(), &[("pin_arrays", array)]));
    let pins = &generated.report.pins;
    // Rows 3 mm apart within 14.25 mm, pins 3 mm apart within 32 mm, every other row shifted.
    let rows: Vec<usize> =
        (1..=5).map(|row| pins.iter().filter(|p| p.name.contains(&format!("/0{row}/"))).count()).collect();
    assert_eq!(rows, [11, 10, 11, 10, 11]);
    assert_eq!(pins.len(), 53);
    for pin in pins {
        assert!((pin.length_mm - 5.0).abs() < 1e-4, "{}", pin.length_mm);
        assert!(DVec3::from_array(pin.direction).distance(DVec3::Y) < 1e-6);
        assert!((pin.gap_mm.unwrap() - (3.0 - 1.2)).abs() < 1e-9, "{:?}", pin.gap_mm);
    }
    let at = |i: usize| DVec3::from_array(pins[i].position_mm);
    assert!((at(1) - at(0)).distance(3.0 * DVec3::Z) < 1e-9);
    assert!((at(11) - at(0)).distance(DVec3::new(3.0, 0.0, 1.5)) < 1e-4, "{}", at(11) - at(0));
    let lengths: f64 = pins.iter().map(|p| p.length_mm).sum();
    assert!((gained(&generated) - lengths * 0.36 * PI).abs() < VOLUME * 53.0);
    assert_eq!(genus(&generated, "coolant/middle"), 53);
    assert_eq!(genus(&generated, "metal"), 53);
}

fn row(name: &str, wall: &str, count: u32, diameter: f64) -> Value {
    json!({ "name": name, "wall": wall, "span": [0.1, 0.8], "count": count, "diameter": diameter })
}

#[test]
fn crossovers_through_flat_walls() {
    let round = row("a", "w1", 7, 1.5);
    let mut racetrack = row("b", "w2", 4, 1.0);
    racetrack["height_d"] = json!(2.5);
    racetrack["inclination_deg"] = json!(25);
    racetrack["skew_deg"] = json!(10);
    let generated = ok(with(plate(), &[("crossover_rows", json!([round, racetrack]))]));
    let table = &generated.report.crossovers;
    assert_eq!(table.len(), 11);
    for hole in table {
        let axis = DVec3::from_array(hole.direction);
        assert!((hole.length_mm - 2.0 / axis.x).abs() < 1e-4, "{} {axis}", hole.length_mm);
    }
    assert_eq!(table[0].chambers, ["leading", "middle"]);
    let axis = DVec3::from_array(table[7].direction);
    assert!((axis.z / axis.x - 25f64.to_radians().tan()).abs() < 1e-6);
    assert!((axis.y / axis.x - 10f64.to_radians().tan()).abs() < 1e-6);
    assert!((table[7].area_mm2 - (0.25 * PI + 1.5)).abs() < 1e-12);
    let bored: f64 = table.iter().map(|h| h.area_mm2 * h.length_mm).sum();
    assert!((gained(&generated) + bored).abs() < VOLUME * 11.0, "{} {bored}", gained(&generated));
    // One coolant solid of three passages and 11 holes.
    let coolant = "coolant/leading+middle+trailing";
    assert_eq!(generated.report.solids.len(), 2);
    assert_eq!(genus(&generated, coolant), 11 - 3 + 1);
    // Three openings at the hub.
    assert_eq!(genus(&generated, "metal"), 11 - 3 + 1 + 2);
}

#[test]
fn crossovers_join_only_what_they_meet() {
    let generated = ok(with(plate(), &[("crossover_rows", json!([row("a", "w2", 1, 1.5)]))]));
    let names: Vec<&String> = generated.report.solids.keys().collect();
    assert_eq!(names, ["coolant/leading", "coolant/middle+trailing", "metal"]);
    assert_eq!(genus(&generated, "coolant/middle+trailing"), 0);
    // The inlets keep their names.
    let inlet = generated.report.faces.iter().find(|f| f.name == "coolant/inlet/middle").unwrap();
    assert_eq!(inlet.solids, ["coolant/middle+trailing"]);
}

fn dust(name: &str, chamber: &str, position: f64, diameter: f64, inclination: f64) -> Value {
    json!({
        "name": name, "chamber": chamber, "position": position, "diameter": diameter,
        "inclination_deg": inclination, "azimuth_deg": 20
    })
}

#[test]
fn dust_holes_through_a_flat_tip() {
    let holes = json!([
        dust("a", "leading", 0.5, 1.0, 0.0),
        dust("b", "middle", 0.3, 1.2, 30.0),
        dust("c", "middle", 0.7, 1.2, 0.0),
    ]);
    let generated = ok(with(plate(), &[("dust_holes", holes)]));
    let table = &generated.report.dust_holes;
    let lengths: Vec<f64> = table.iter().map(|h| h.length_mm).collect();
    for (length, expected) in lengths.iter().zip([2.0, 2.0 / 30f64.to_radians().cos(), 2.0]) {
        assert!((length - expected).abs() < 1e-9, "{length} {expected}");
    }
    let breakout = 0.36 * PI / 30f64.to_radians().cos();
    assert!((table[1].breakout_mm2 - breakout).abs() < 1e-6, "{}", table[1].breakout_mm2);
    let bored: f64 = table.iter().map(|h| 0.25 * PI * h.diameter_mm.powi(2) * h.length_mm).sum();
    assert!((gained(&generated) + bored).abs() < VOLUME * 3.0);
    // Every hole is a second or third opening of its chamber.
    assert_eq!(genus(&generated, "metal"), 3);
    assert!((table[0].ligament_mm - 3.5).abs() < 1e-3, "{}", table[0].ligament_mm);
}

/// All kinds on the serpentine: crossovers that close the passage in itself, through its wall's fillets too, pins over
/// the borders of the trailing chamber's end, dust holes out of the turn and beside it.
#[test]
fn all_kinds_on_the_serpentine() {
    let mut high = row("fillet", "w1", 3, 1.0);
    high["position"] = json!(1.0);
    high["span"] = json!([0.3, 0.6]);
    let mut low = row("w2", "w2", 4, 0.9);
    low["span"] = json!([0.3, 0.75]);
    let film = json!([{
        "name": "ps", "side": "pressure_side", "surface_position": 0.3, "span": [0.2, 0.8], "count": 9,
        "hole": { "diameter": 0.5, "inclination_deg": 35 }
    }]);
    let pins = json!([{
        "name": "te", "chamber": "trailing", "span": [0.3, 0.8], "camber": [0.68, 0.84], "diameter": 0.7,
        "spanwise_pitch_d": 3, "streamwise_pitch_d": 3
    }]);
    let dust = json!([dust("turn", "leading", 0.5, 0.8, 10.0), dust("end", "trailing", 0.3, 0.6, 0.0)]);
    let fields = [
        ("crossover_rows", json!([high, low])),
        ("film_rows", film),
        ("pin_arrays", pins),
        ("dust_holes", dust),
    ];
    let mut serpentine = sample("rotor-serpentine.json");
    serpentine["cooling"].as_object_mut().unwrap().remove("slot_rows");
    let generated = ok(with(serpentine, &fields));
    let report = &generated.report;
    let pins = report.pins.len();
    assert!(pins > 10, "{pins}");
    assert_eq!(genus(&generated, "coolant/leading"), 7 + pins);
    // One opening at the hub, nine film holes, two dust holes.
    assert_eq!(genus(&generated, "metal"), 7 + pins + 9 + 2);
    let on = |face: &str| report.faces.iter().any(|f| f.name == face);
    assert!(on("crossover/fillet/003/bore/2") && on("dust_hole/turn/exit"));
}

fn refusal(fields: &[(&str, Value)]) -> Fault {
    let mut faults = with(plate(), fields).expect_err("refused");
    faults.swap_remove(0)
}

#[test]
fn crossovers_that_do_not_fit_are_refused() {
    let lone = |change: &dyn Fn(&mut Value)| {
        let mut row = row("r", "w1", 1, 1.0);
        change(&mut row);
        refusal(&[("crossover_rows", json!([row]))])
    };
    let fault = lone(&|row| row["wall"] = json!("w3"));
    assert_eq!((fault.code, fault.pointer.as_str()), ("unknown_name", "/cooling/crossover_rows/0/wall"));
    let fault = lone(&|row| row["span"] = json!([0.1, 0.99]));
    assert_eq!(fault.code, "beyond_wall");
    assert!((fault.max.unwrap() - 0.95).abs() < 1e-9);
    // The wall is 5 mm wide: what is wider runs over its fillets.
    let fault = lone(&|row| row["diameter"] = json!(6));
    assert_eq!(fault.code, "leaves_wall");
    assert!(fault.message.starts_with("hole 1 of crossover row \"r\""), "{}", fault.message);
    let most = fault.max.unwrap();
    assert!(most > 4.5 && most <= 5.0, "{most}");
    ok(with(plate(), &[("crossover_rows", json!([row("r", "w1", 1, 0.99 * most)]))]));
    let fault = lone(&|row| {
        row["position"] = json!(1.0);
        row["skew_deg"] = json!(60);
    });
    assert_eq!((fault.code, fault.pointer.as_str()), ("meets_no_wall", "/cooling/crossover_rows/0/skew_deg"));
    // From the end of the flat the axis may run up to where it grazes the fillet, whose centre is 1.6 mm away.
    let most = fault.max.unwrap();
    assert!((most - (0.6f64 / 1.6).asin().to_degrees()).abs() < 0.5, "{most}");
    // A wide hole much inclined, whose middle section pokes out of the wall.
    let mut wide = row("r", "w1", 1, 3.0);
    wide["inclination_deg"] = json!(50);
    ok(with(plate(), &[("crossover_rows", json!([wide]))]));
    // Eight of 3 mm on 28 mm.
    let fault = lone(&|row| {
        row["count"] = json!(10);
        row["diameter"] = json!(3);
    });
    assert_eq!(fault.code, "ligament");
    assert!((fault.value.unwrap().as_f64().unwrap() + 0.2).abs() < 1e-3);
    let fault = lone(&|row| {
        row.as_object_mut().unwrap().remove("count");
    });
    assert_eq!(fault.code, "one_of");
}

#[test]
fn pins_that_do_not_fit_are_refused() {
    let fault = refusal(&[("pin_arrays", pins([0.1, 0.9], [0.25, 0.4], 1.2, [2.5, 0.4]))]);
    assert_eq!(fault.code, "ligament");
    assert!(fault.message.contains("of array \"p\" meets pin "), "{}", fault.message);
    let fault = refusal(&[("pin_arrays", pins([0.1, 0.9], [0.25, 0.4], 0.05, [2.0, 2.0]))]);
    assert_eq!((fault.code, fault.max), ("count", Some(10_000.0)));
    let near = [("pin_arrays", pins([0.1, 0.9], [0.25, 0.4], 1.2, [2.5, 2.5])), ("least_ligament", json!(2))];
    assert_eq!(refusal(&near).code, "ligament");
    // Into the wall, which a thinner pin would clear.
    let fault = refusal(&[("pin_arrays", pins([0.1, 0.9], [0.214, 0.214], 1.2, [2.5, 2.5]))]);
    assert_eq!(fault.code, "leaves_chamber");
    let most = fault.max.unwrap();
    assert!(most < 1.2, "{most}");
    // In the wall.
    let fault = refusal(&[("pin_arrays", pins([0.1, 0.9], [0.2, 0.2], 1.2, [2.5, 2.5]))]);
    assert_eq!((fault.code, fault.pointer.as_str()), ("leaves_chamber", "/cooling/pin_arrays/0/camber"));
    let fault = refusal(&[("pin_arrays", pins([0.1, 0.97], [0.25, 0.4], 1.2, [2.5, 2.5]))]);
    assert_eq!((fault.code, fault.max), ("beyond_chamber", Some(0.95)));
    // Where a film hole begins.
    let film = json!([{
        "name": "f", "side": "suction_side", "surface_position": 0.3, "span": [0.1, 0.9], "count": 40,
        "hole": { "diameter": 0.6, "inclination_deg": 90 }
    }]);
    let fault =
        refusal(&[("film_rows", film), ("pin_arrays", pins([0.1, 0.9], [0.25, 0.4], 1.2, [2.5, 2.5]))]);
    assert_eq!(fault.code, "ligament");
    assert!(fault.message.contains("meets film/f/"), "{}", fault.message);
}

#[test]
fn dust_holes_that_do_not_fit_are_refused() {
    let fault = refusal(&[("dust_holes", json!([dust("d", "leading", 0.5, 6.0, 0.0)]))]);
    assert_eq!((fault.code, fault.pointer.as_str()), ("leaves_tip", "/cooling/dust_holes/0"));
    let most = fault.max.unwrap();
    assert!(most > 4.9 && most < 5.01, "{most}");
    let pair = json!([dust("d", "leading", 0.5, 1.0, 0.0), dust("e", "leading", 0.52, 1.0, 0.0)]);
    let fault = refusal(&[("dust_holes", pair)]);
    assert_eq!(fault.code, "ligament");
    let edge = [("dust_holes", json!([dust("d", "leading", 0.5, 1.0, 0.0)])), ("least_ligament", json!(3.6))];
    let fault = refusal(&edge);
    assert_eq!((fault.code, fault.min), ("ligament", Some(3.6)));
    let mut open = plate();
    open["cooling"]["chambers"][0]["span"] = json!([0.0, 1.0]);
    open["cooling"]["dust_holes"] = json!([dust("d", "leading", 0.5, 1.0, 0.0)]);
    assert_eq!(with(open, &[]).expect_err("refused")[0].code, "open_chamber");
}
