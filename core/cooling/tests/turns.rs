//! Turns, measured on built designs: they join chambers without creases, keep the shell, and are refused where there is
//! no room for them.

use coolinggen_blade::{Fault, Pointer};
use coolinggen_brep::{Coedge, Face, Model, SurfaceGeometry};
use coolinggen_cooling::design::Design;
use coolinggen_cooling::{Generated, generate};
use coolinggen_nurbs::{ParametricCurve, ParametricSurface};
use glam::DVec3;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;

fn sample(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// The sample without its holes and slots.
fn serpentine() -> Value {
    let mut design = sample("rotor-serpentine.json");
    let cooling = design["cooling"].as_object_mut().unwrap();
    cooling.remove("film_rows");
    cooling.remove("slot_rows");
    design
}

fn tried(design: &Value) -> Result<Generated, Vec<Fault>> {
    generate(&Design::from_json(&design.to_string())?, Path::new("."))
}

fn built(design: &Value) -> Generated {
    tried(design).unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// The serpentine with other chambers: walls at `positions`, turns in turn at the tip and at the hub.
fn chain(positions: &[f64], exponent: f64) -> Value {
    let mut design = serpentine();
    set_chain(&mut design["cooling"], positions, exponent, 0.9, [0.5, 0.4]);
    design
}

/// Walls, chambers and turns of a serpentine; the radii are those of all chambers but the last, and of the last.
fn set_chain(cooling: &mut Value, positions: &[f64], exponent: f64, thickness: f64, radii: [f64; 2]) {
    let count = positions.len() + 1;
    cooling["walls"] = (positions.iter().enumerate())
        .map(|(i, p)| json!({"name": format!("w{i}"), "position": p, "thickness": thickness}))
        .collect();
    let radius = |i: usize| radii[usize::from(i + 1 == count)];
    cooling["chambers"] =
        (0..count).map(|i| json!({"name": format!("c{i}"), "fillet_radius": radius(i)})).collect();
    cooling["turns"] = (1..count)
        .map(|i| {
            let (end, between) = (["hub", "tip"][i % 2], [format!("c{}", i - 1), format!("c{i}")]);
            json!({"name": format!("t{i}"), "between": between, "end": end, "exponent": exponent})
        })
        .collect();
}

/// The C3X vane, a linear cascade, with a serpentine behind its leading chamber that begins at the hub.
fn vane(positions: &[f64]) -> Value {
    let mut design = sample("c3x.json");
    design["cooling"] = json!({"shell": {"suction_side": 3, "pressure_side": 3, "tip": 4, "hub": 4}});
    set_chain(&mut design["cooling"], positions, 2.5, 2.5, [1.5, 1.2]);
    let turns = design["cooling"]["turns"].as_array_mut().unwrap();
    turns.remove(0);
    for (i, turn) in turns.iter_mut().enumerate() {
        turn["end"] = json!(["tip", "hub"][i % 2]);
    }
    design
}

fn check_solids(generated: &Generated) {
    let report = &generated.report;
    assert!(report.watertight);
    assert!(report.max_edge_deviation_mm < 1e-8, "{}", report.max_edge_deviation_mm);
    for (name, genus) in &report.genus {
        assert_eq!(genus.found, Some(genus.expected), "{name}");
    }
    let volume: f64 = report.solids.values().map(|s| s.volume_mm3).sum();
    assert!((volume / report.blank.volume_mm3 - 1.0).abs() < 1e-9);
}

fn face<'m>(model: &'m Model, name: &str) -> &'m Face {
    model.faces.iter().find(|f| f.name == name).unwrap_or_else(|| panic!("no face {name}"))
}

fn normal(face: &Face, coedge: &Coedge, t: f64) -> DVec3 {
    let q = coedge.pcurve.point(t);
    let (_, u, v) = face.surface.first_derivatives(q.x, q.y);
    u.cross(v).normalize()
}

/// Greatest angle, degrees, between the normals of the two faces at each inner edge.
fn creases(model: &Model) -> BTreeMap<(String, String), f64> {
    let mut uses: BTreeMap<usize, Vec<(&Face, &Coedge)>> = BTreeMap::new();
    for face in &model.faces {
        for coedge in face.loops.iter().flat_map(|l| &l.coedges) {
            uses.entry(coedge.edge.0).or_default().push((face, coedge));
        }
    }
    let mut found = BTreeMap::new();
    for pair in uses.values().filter(|u| u.len() == 2) {
        let [(fa, a), (fb, b)] = [pair[0], pair[1]];
        let (start, end) = a.pcurve.domain();
        let angle = (0..=400)
            .map(|i| start + (end - start) * f64::from(i) / 400.0)
            .map(|t| normal(fa, a, t).cross(normal(fb, b, t)).length().asin().to_degrees())
            .fold(0.0, f64::max);
        found.insert((fa.name.clone(), fb.name.clone()), angle);
    }
    found
}

#[test]
fn turns_join_chambers_and_their_own_faces_without_creases() {
    let generated = built(&serpentine());
    check_solids(&generated);
    let found = creases(&generated.blade.model);
    let mut joints = 0;
    for ((a, b), angle) in &found {
        match (a.starts_with("turn/"), b.starts_with("turn/")) {
            (false, true) if a.starts_with("chamber/") => {
                joints += 1;
                assert!(*angle < 1e-3, "{a} | {b}: {angle} deg");
            }
            (true, true) => assert!(*angle < 0.5, "{a} | {b}: {angle} deg"),
            // The shell is smooth over the joints of the leading edge.
            _ if a.starts_with("chamber/leading/") && b.starts_with("chamber/leading/leading_edge") => {
                assert!(*angle < 0.02, "{a} | {b}: {angle} deg");
            }
            _ => {}
        }
    }
    assert_eq!(joints, 2 * 2 * 8);
}

#[test]
fn ends_of_a_turn_are_the_chambers_own_bit_for_bit() {
    let generated = built(&serpentine());
    let model = &generated.blade.model;
    let points = |name: &str| match &face(model, name).surface {
        SurfaceGeometry::BSpline(s) => (s.points().to_vec(), s.counts().1),
        _ => panic!("{name} is no spline"),
    };
    let column = |(points, count): &(Vec<DVec3>, usize), j: usize| -> Vec<DVec3> {
        points.iter().skip(j).step_by(*count).copied().collect()
    };
    for (turn, front, back) in [
        ("suction_side", "suction_side", "suction_side"),
        ("inner", "wall/w1", "wall/w1"),
        ("inner/fillet_pressure_side", "wall/w1/fillet_pressure_side", "wall/w1/fillet_pressure_side"),
        ("outer", "leading_edge", "wall/w2"),
    ] {
        let own = points(&format!("turn/tip/{turn}"));
        let (leading, middle) =
            (points(&format!("chamber/leading/{front}")), points(&format!("chamber/middle/{back}")));
        assert_eq!(column(&own, 0), column(&leading, leading.1 - 1), "{turn}");
        let mut far = column(&own, own.1 - 1);
        far.reverse();
        assert_eq!(far, column(&middle, middle.1 - 1), "{turn}");
    }
}

#[test]
fn sides_of_turns_keep_the_shell() {
    let design = serpentine();
    let generated = built(&design);
    let parsed = Design::from_json(&design.to_string()).unwrap();
    let shell = parsed.cooling.as_ref().unwrap().shell.as_ref().unwrap().clone();
    let (space, _) = coolinggen_blade::build(&parsed.space, &parsed.blade, Path::new(".")).unwrap();
    let blade = &generated.surface;
    let grid: Vec<(DVec3, (f64, f64))> = (0..400)
        .flat_map(|i| (0..30).map(move |j| (f64::from(i) / 400.0, f64::from(j) / 29.0)))
        .map(|(u, w)| (blade.surface.point(u, w), (u, w)))
        .collect();
    for (turn, side, spec) in [
        ("tip", "suction_side", &shell.suction_side),
        ("tip", "pressure_side", &shell.pressure_side),
        ("hub", "suction_side", &shell.suction_side),
        ("hub", "pressure_side", &shell.pressure_side),
    ] {
        let law = spec.law(&Pointer::root()).unwrap();
        let surface = &face(&generated.blade.model, &format!("turn/{turn}/{side}")).surface;
        let mut worst = 0.0f64;
        for (i, j) in (0..=10).flat_map(|i| (0..=20).map(move |j| (i, j))) {
            let p = surface.point(f64::from(i) / 10.0, f64::from(j) / 20.0);
            let near = grid.iter().min_by(|a, b| a.0.distance_squared(p).total_cmp(&b.0.distance_squared(p)));
            let foot = blade.closest(p, near.unwrap().1).unwrap();
            let asked = law.at(space.span_fraction(p).unwrap());
            worst = worst.max((foot.distance / asked - 1.0).abs());
        }
        assert!(worst < 2e-3, "turn/{turn}/{side}: {worst}");
    }
}

#[test]
fn fillets_run_through_the_turn_with_about_their_radius() {
    let generated = built(&serpentine());
    // Fillets of walls: (face, ends' radii, part of the way where both closures are a wall's).
    for (name, radii, [from, to]) in [
        ("turn/tip/inner/fillet_suction_side", [0.596, 0.644], [0.0, 1.0]),
        ("turn/tip/inner/fillet_pressure_side", [0.594, 0.646], [0.0, 1.0]),
        ("turn/tip/outer/fillet_suction_side", [0.596, 0.644], [0.5, 1.0]),
        ("turn/tip/outer/fillet_pressure_side", [0.594, 0.646], [0.5, 1.0]),
        ("turn/hub/inner/fillet_suction_side", [0.396, 0.77], [0.0, 1.0]),
        ("turn/hub/outer/fillet_suction_side", [0.58, 0.77], [0.5, 1.0]),
    ] {
        let surface = &face(&generated.blade.model, name).surface;
        for j in 0..=20 {
            let q = from + (to - from) * f64::from(j) / 20.0;
            let greatest = surface.derivatives(0.5, q).principal_curvatures().map(f64::abs);
            let radius = 1.0 / greatest.into_iter().fold(0.0, f64::max);
            assert!(radius > 0.88 * radii[0] && radius < 1.12 * radii[1], "{name} at {q}: {radius}");
        }
    }
}

#[test]
fn the_wall_ends_below_the_outer_side_by_the_clearance() {
    let mut design = serpentine();
    for (turn, clearance) in [(0, 5.0), (1, 7.5)] {
        design["cooling"]["turns"][turn]["clearance"] = json!(clearance);
    }
    let generated = built(&design);
    for (turn, clearance) in [("tip", 5.0), ("hub", 7.5)] {
        let middle =
            |part: &str| face(&generated.blade.model, &format!("turn/{turn}/{part}")).surface.point(0.5, 0.5);
        let found = middle("inner").distance(middle("outer"));
        assert!((found - clearance).abs() < 0.02 * clearance, "turn {turn}: {found}");
    }
}

#[test]
fn the_flow_area_runs_through_and_the_automatic_clearance_keeps_it() {
    let report = built(&serpentine()).report;
    let passage = &report.passages[0];
    assert_eq!(passage.name, "leading");
    let parts: Vec<&str> = passage.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(parts, ["chamber/leading", "turn/tip", "chamber/middle", "turn/hub", "chamber/trailing"]);
    for three in passage.stations.windows(3) {
        let [a, b, c] = [0, 1, 2].map(|i| three[i].area_mm2);
        assert!((a - 2.0 * b + c).abs() < 0.08 * b, "{a} {b} {c}");
    }
    let at = |length: f64| {
        let near = |s: &&coolinggen_cooling::report::StationReport| s.length_mm >= length - 1e-9;
        passage.stations.iter().find(near).unwrap()
    };
    for part in passage.parts.iter().filter(|p| p.name.starts_with("turn/")) {
        let [from, to] = part.from_to_mm;
        let mean = 0.5 * (at(from).area_mm2 + at(to).area_mm2);
        // Half way round in the ring's parameter, among 17 stations.
        let first = passage.stations.iter().position(|s| s.length_mm >= from - 1e-9).unwrap();
        let top = &passage.stations[first + 8];
        assert!((top.area_mm2 / mean - 1.0).abs() < 0.05, "{}: {} {mean}", part.name, top.area_mm2);
    }
    for station in &passage.stations {
        let expected = 4.0 * station.area_mm2 / station.perimeter_mm;
        assert!((station.hydraulic_diameter_mm - expected).abs() < 1e-12);
    }
}

#[test]
fn serpentines_of_two_to_seven_passages_and_several_in_one_blade() {
    for positions in [
        &[0.5][..],
        &[0.3, 0.6],
        &[0.25, 0.45, 0.65],
        &[0.2, 0.36, 0.52, 0.68],
        &[0.16, 0.29, 0.42, 0.55, 0.68],
        &[0.15, 0.26, 0.37, 0.48, 0.59, 0.7],
    ] {
        let generated = built(&chain(positions, 2.5));
        check_solids(&generated);
        assert_eq!(generated.report.solids.len(), 2);
        assert!(generated.report.solids.contains_key("coolant/c0"));
        // With an even number of chambers both ends are open at the hub: the metal has a handle.
        assert_eq!(generated.report.genus["metal"].found, Some(positions.len() % 2));
    }
    let mut two = chain(&[0.2, 0.36, 0.52, 0.68], 4.0);
    two["cooling"]["turns"] = json!([
        {"name": "a", "between": ["c1", "c0"], "end": "tip"},
        {"name": "b", "between": ["c3", "c4"], "end": "tip", "clearance": 4.0, "exponent": 2.0},
    ]);
    let generated = built(&two);
    check_solids(&generated);
    let names: Vec<&str> = generated.report.solids.keys().map(String::as_str).collect();
    assert_eq!(names, ["coolant/c0", "coolant/c2", "coolant/c3", "metal"]);
    for name in ["coolant/inlet/c0", "coolant/outlet/c1", "coolant/inlet/c2", "coolant/outlet/c4"] {
        face(&generated.blade.model, name);
    }
}

#[test]
fn serpentines_of_two_to_seven_passages_in_a_linear_cascade() {
    for positions in [
        &[0.3, 0.5][..],
        &[0.25, 0.4, 0.55],
        &[0.2, 0.32, 0.44, 0.56],
        &[0.2, 0.3, 0.4, 0.5, 0.6],
        &[0.15, 0.24, 0.33, 0.42, 0.51, 0.6],
        &[0.12, 0.2, 0.28, 0.36, 0.44, 0.52, 0.6],
    ] {
        let generated = built(&vane(positions));
        check_solids(&generated);
        let names: Vec<&str> = generated.report.solids.keys().map(String::as_str).collect();
        assert_eq!(names, ["coolant/c0", "coolant/c1", "metal"]);
        // A serpentine of an even number of chambers begins and ends at the hub.
        assert_eq!(generated.report.genus["metal"].found, Some(1 - positions.len() % 2), "{positions:?}");
        let found = creases(&generated.blade.model);
        let joints = found.iter().filter(|((a, b), _)| a.starts_with("chamber/") && b.starts_with("turn/"));
        for ((a, b), angle) in joints {
            assert!(*angle < 1e-3, "{positions:?} {a} | {b}: {angle} deg");
        }
    }
}

#[test]
fn a_turn_of_the_leading_chamber_of_a_blunt_vane_joins_without_creases() {
    for first in ["tip", "hub"] {
        let mut design = sample("c3x.json");
        design["cooling"] = json!({"shell": {"suction_side": 3, "pressure_side": 3, "tip": 4, "hub": 4}});
        set_chain(&mut design["cooling"], &[0.2, 0.4], 2.5, 2.5, [1.5, 1.2]);
        let ends = if first == "tip" { ["tip", "hub"] } else { ["hub", "tip"] };
        for (turn, end) in design["cooling"]["turns"].as_array_mut().unwrap().iter_mut().zip(ends) {
            turn["end"] = json!(end);
            turn["clearance"] = json!(8.0);
        }
        let generated = built(&design);
        check_solids(&generated);
        let found = creases(&generated.blade.model);
        for ((a, b), angle) in found.iter().filter(|((_, b), _)| b.starts_with("turn/t1/")) {
            let most = if a.starts_with("chamber/") { 1e-3 } else { 0.5 };
            assert!(*angle < most, "{first} {a} | {b}: {angle} deg");
        }
    }
}

/// The faults of the serpentine changed by `change`, as (pointer, code, value, min, max).
fn faults(change: impl Fn(&mut Value)) -> Vec<Fault> {
    let mut design = serpentine();
    change(&mut design["cooling"]);
    tried(&design).map(|_| ()).expect_err("the design should be refused")
}

fn refused(change: impl Fn(&mut Value), pointer: &str, code: &str) -> Fault {
    let found = faults(change);
    let fault = found.iter().find(|f| f.pointer == pointer && f.code == code);
    fault.unwrap_or_else(|| panic!("no {code} at {pointer} in {found:?}")).clone()
}

#[test]
fn turns_that_name_the_wrong_chambers_are_refused() {
    let turn = |name: &str, a: &str, b: &str, end: &str| json!({"name": name, "between": [a, b], "end": end});
    let add = |turns: Vec<Value>| move |c: &mut Value| c["turns"] = json!(turns.clone());
    refused(add(vec![turn("a", "leading", "nose", "tip")]), "/cooling/turns/0/between/1", "unknown_name");
    refused(add(vec![turn("a", "leading", "trailing", "tip")]), "/cooling/turns/0/between", "not_neighbours");
    let both = vec![turn("a", "leading", "middle", "tip"), turn("b", "middle", "leading", "hub")];
    refused(add(both), "/cooling/turns/1/between", "ring");
    let same = vec![turn("a", "leading", "middle", "tip"), turn("b", "middle", "trailing", "tip")];
    refused(add(same), "/cooling/turns/1/between", "taken");
    let spans = |c: &mut Value| {
        c["chambers"][0]["span"] = json!([0, 0.8]);
        c["chambers"][1]["span"] = json!([0.2, 0.7]);
    };
    let fault = refused(spans, "/cooling/turns/0/between", "spans_differ");
    assert_eq!((fault.value, fault.min), (Some(json!(0.7)), Some(0.8)));
    refused(|c| c["chambers"][0]["span"] = json!([0, 1]), "/cooling/turns/0", "no_room");
    refused(|c| c["turns"][0]["clearance"] = json!("wide"), "/cooling/turns/0/clearance", "choice");
    refused(|c| c["turns"][0]["exponent"] = json!(1.5), "/cooling/turns/0/exponent", "range");
}

#[test]
fn turns_without_room_are_refused_with_the_number_that_fits() {
    let low = refused(|c| c["turns"][0]["clearance"] = json!(0.9), "/cooling/turns/0/clearance", "geometry");
    let least = low.min.expect("a least clearance");
    assert!(least > 0.9);
    built(&{
        let mut design = serpentine();
        design["cooling"]["turns"][0]["clearance"] = json!(least * 1.02);
        design
    });
    let high = |c: &mut Value| {
        c["chambers"][0]["span"] = json!([0, 0.85]);
        c["turns"][0]["clearance"] = json!(9.0);
    };
    let fault = refused(high, "/cooling/turns/0/clearance", "no_room");
    let most = fault.max.expect("a greatest clearance");
    built(&{
        let mut design = serpentine();
        high(&mut design["cooling"]);
        design["cooling"]["turns"][0]["clearance"] = json!(most * 0.999);
        design
    });
    let bare = |c: &mut Value| {
        c["shell"].as_object_mut().unwrap().remove("tip");
    };
    refused(bare, "/cooling/shell/tip", "missing");
}

/// A shell that thins out fast towards the tip: round the turn, which bulges into it, less would be left than is asked for.
#[test]
fn turns_that_would_thin_the_shell_are_refused_with_what_is_left() {
    let falling = |c: &mut Value, least: f64| {
        c["shell"]["suction_side"] = json!([[0, 2.2], [0.5, 1], [1, 0.9]]);
        c["shell"]["pressure_side"] = json!([[0, 2.7], [0.5, 1], [1, least]]);
    };
    let fault = refused(|c| falling(c, 0.7), "/cooling/turns/0", "geometry");
    let (left, asked) = (fault.value.as_ref().and_then(Value::as_f64).unwrap(), fault.min.unwrap());
    // Between what the law gives at the tip and in the middle of the span, and missed by more than the tolerance.
    assert!((0.7..1.0).contains(&asked) && left < asked * (1.0 - 1e-3) && left > 0.9 * asked, "{fault:?}");
    assert!(fault.message.contains("of metal to the outer surface"), "{fault:?}");
    assert_eq!(fault.unit, "mm");
}

/// Film holes open into the sides of turns at the tip and at the hub.
#[test]
fn film_holes_open_into_turns() {
    let mut design = serpentine();
    let row = |name: &str, side: &str, position: f64, span: [f64; 2], count: usize| {
        json!({"name": name, "side": side, "surface_position": position, "span": span, "count": count,
            "hole": {"diameter": 0.5, "inclination_deg": 40}})
    };
    design["cooling"]["film_rows"] = json!([
        row("tip_ss", "suction_side", 0.32, [0.86, 0.95], 4),
        row("tip_ps", "pressure_side", 0.35, [0.86, 0.95], 4),
        row("hub_ss", "suction_side", 0.62, [0.05, 0.14], 4),
        row("hub_ps", "pressure_side", 0.6, [0.05, 0.14], 4),
    ]);
    let generated = built(&design);
    check_solids(&generated);
    assert_eq!(generated.report.genus["metal"].found, Some(16));
    for turn in ["tip", "hub"] {
        for side in ["suction_side", "pressure_side"] {
            let face = face(&generated.blade.model, &format!("turn/{turn}/{side}"));
            assert_eq!(face.loops.len(), 1 + 4, "{}", face.name);
        }
    }
}
