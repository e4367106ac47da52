//! Medial turbine and propeller blades as sources: samples, closings, faults.

mod common;

use common::*;
use coolinggen_blade::{Blade, Region};
use coolinggen_nurbs::ParametricSurface;
use glam::{DVec2, DVec3};
use serde_json::{Value, json};

fn sample(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

fn francis() -> Value {
    sample(include_str!("../../../samples/francis.json"))
}

fn propeller() -> Value {
    sample(include_str!("../../../samples/propeller.json"))
}

/// Greatest distance between the two borders in u.
fn gap(blade: &Blade) -> f64 {
    (0..=40)
        .map(|i| {
            let w = f64::from(i) / 40.0;
            blade.surface.point(0.0, w).distance(blade.surface.point(1.0, w))
        })
        .fold(0.0, f64::max)
}

/// Angle between the surface's normals on both sides of a joint, radians.
fn kink(blade: &Blade, u: f64, w: f64) -> f64 {
    let normal = |u: f64| {
        let (_, a, b) = blade.surface.first_derivatives(u, w);
        a.cross(b).normalize()
    };
    normal(u - 1e-9).angle_between(normal((u + 1e-9).rem_euclid(1.0)))
}

#[test]
fn a_runner_blade_is_closed_and_reaches_past_hub_and_shroud() {
    let (space, blade) = built(&francis());
    assert!(gap(&blade) < 1e-11 && blade.fit.greatest_distance_mm <= 1e-3);
    for v in [0.0, 0.5, 1.0] {
        let surface = space.surface(v).unwrap();
        for (w, _) in blade.profile(&surface, &around(400)).unwrap() {
            assert!((-0.3..1.3).contains(&w));
        }
    }
    // The convex side is called suction side, and is longer.
    let length = |region| {
        let [a, b] = blade.range(region).unwrap();
        let at = |i: u32| blade.surface.point(a + (b - a) * f64::from(i) / 400.0, 0.5);
        (0..400).map(|i| at(i).distance(at(i + 1))).sum::<f64>()
    };
    assert!(length(Region::SuctionSide) > length(Region::PressureSide));
}

#[test]
fn trailing_edges_are_sharp_blunt_or_rounded() {
    let mut design = francis();
    design["blade"]["closing"] = json!("rounded");
    let (_, rounded) = built(&design);
    let [a, b] = rounded.range(Region::TrailingEdge).unwrap();
    for w in [0.1, 0.5, 0.9] {
        for u in [a, 0.5 * (a + b), b] {
            assert!(kink(&rounded, u, w) < 1e-4, "{u} {w} {:e}", kink(&rounded, u, w));
        }
        // A circle that spans the gap.
        let (start, end) = (rounded.surface.point(a, w), rounded.surface.point(b, w));
        let radius = 0.5 * start.distance(end);
        for i in 1..20 {
            let d = rounded.surface.derivatives(a + (b - a) * f64::from(i) / 20.0, w);
            let curvature = d.u.cross(d.uu).length() / d.u.length().powi(3);
            assert!((curvature * radius - 1.0).abs() < 0.05, "{w} {i} {}", curvature * radius);
        }
    }
    design["blade"]["closing"] = json!("blunt");
    let (_, blunt) = built(&design);
    let [a, _] = blunt.range(Region::TrailingEdge).unwrap();
    assert!(kink(&blunt, a, 0.5) > 1.0);
    design["blade"]["closing"] = json!("sharp");
    assert_eq!(refused(&design), [("/blade/closing".to_owned(), "closing")]);
    design["blade"]["profile"] = json!({"kind": "naca_4_digit", "closed": true});
    assert!(built(&design).1.is_sharp());
}

#[test]
fn sides_may_differ() {
    let mut design = francis();
    let (_, equal) = built(&design);
    design["blade"]["pressure_side"] = json!({"thickness": [[0, 6], [1, 4]]});
    let (_, thinner) = built(&design);
    let area = |blade: &Blade| {
        let points: Vec<DVec3> = around(600).iter().map(|&u| blade.surface.point(u, 0.5)).collect();
        let center = points.iter().sum::<DVec3>() / points.len() as f64;
        let next = points.iter().cycle().skip(1);
        points.iter().zip(next).map(|(a, b)| (*a - center).cross(*b - center)).sum::<DVec3>().length()
    };
    let part = area(&thinner) / area(&equal);
    assert!((0.70..0.80).contains(&part), "{part}");
}

#[test]
fn chosen_control_points_are_kept() {
    let mut design = francis();
    design["blade"]["skin"] = json!({"degree": [3, 3], "control_points": [20, 10], "knots": "optimised"});
    let (_, blade) = built(&design);
    assert!(blade.fit.average_distance_mm.unwrap() < 0.03, "{:?}", blade.fit.average_distance_mm);
    design["blade"]["skin"]["knots"] = json!("uniform");
    let (_, uniform) = built(&design);
    assert!(uniform.fit.average_distance_mm > blade.fit.average_distance_mm);
}

#[test]
fn composed_skins_are_asked_for_by_name() {
    let mut design = francis();
    design["blade"]["skin"] = json!({"method": "composed"});
    let (_, blade) = built(&design);
    assert!(blade.fit.greatest_distance_mm <= 1e-3);
    assert!(blade.fit.notes.iter().any(|n| n.contains("of degree 23 x 6")), "{:?}", blade.fit.notes);
    design["blade"]["pressure_side"] = json!({"thickness": [[0, 3], [1, 8]]});
    assert_eq!(refused(&design), [("/blade/skin/method".to_owned(), "no_composition")]);
    let mut propeller = propeller();
    propeller["blade"]["skin"] = json!({"method": "composed", "control_points": [20, 10]});
    let expected = [("/blade/skin/method", "no_composition"), ("/blade/skin/control_points", "excludes")];
    assert_eq!(refused(&propeller), expected.map(|(p, c)| (p.to_owned(), c)));
}

#[test]
fn all_faults_come_at_once() {
    let mut design = francis();
    let blade = design["blade"].as_object_mut().unwrap();
    blade.insert("beta0_deg".into(), json!([[0, 78], [1, 190]]));
    blade.insert("zeta1".into(), json!(-1));
    blade.insert("thickness".into(), json!(0));
    blade.insert("trailing_edge".into(), json!([[84, 68], [100, 90]]));
    blade.insert("skin".into(), json!({"degree": [1, 3], "tolerance": 0}));
    blade.insert("profile".into(), json!({"kind": "bezier", "control_points": [[0, 0], [0.1, 0.5], [1, 0]]}));
    let found = refused(&design);
    let expected = [
        ("/blade/trailing_edge", "short_of_contour"),
        ("/blade/beta0_deg", "out_of_range"),
        ("/blade/zeta1", "out_of_range"),
        ("/blade/thickness", "out_of_range"),
        ("/blade/profile/control_points/1", "profile_end"),
        ("/blade/skin/degree/0", "out_of_range"),
        ("/blade/skin/tolerance", "out_of_range"),
    ];
    assert_eq!(found, expected.map(|(p, c)| (p.to_owned(), c)));
}

#[test]
fn blades_too_thick_for_their_curvature_are_refused() {
    let mut design = sample(include_str!("../../../samples/medial-cooled.json"));
    design["blade"]["thickness"] = json!(90);
    assert_eq!(refused(&design), [("/blade/thickness".to_owned(), "folded")]);
    let mut turning = francis();
    turning["blade"]["zeta0"] = json!(1);
    turning["blade"]["zeta1"] = json!(1);
    turning["blade"]["beta1_deg"] = json!(160);
    assert_eq!(refused(&turning)[0].1, "runs_back");
    let mut cascade = francis();
    cascade["space"] = json!({"kind": "linear", "height": 50});
    assert_eq!(refused(&cascade), [("/blade/kind".to_owned(), "space")]);
}

/// A section of the DTMB 4119 blade at r/R, unrolled along its pitch helix: (along, off) of suction and pressure side.
fn section(blade: &Blade, part: f64, pitch: f64) -> [Vec<DVec2>; 2] {
    let w = 1.0 - ((1.0 - part) / 0.8).sqrt();
    let r = 152.4 * part;
    let (sin, cos) = (pitch * 304.8 / std::f64::consts::TAU / r).atan().sin_cos();
    let suction = blade.range(Region::SuctionSide).unwrap();
    let trailing = blade.range(Region::TrailingEdge).unwrap();
    // The sides meet at u = 0; the foremost point, which parts them here, is not far from it.
    let leading = [-0.02, 0.02];
    let at = |u: f64| {
        let p = blade.surface.point(u.rem_euclid(1.0), w);
        assert!((p.y.hypot(p.z) - r).abs() < 2e-3);
        // Right-handed: against the way it turns is towards smaller theta.
        let against = -p.y.atan2(p.z) * r;
        DVec2::new(p.x * sin + against * cos, against * sin - p.x * cos)
    };
    let n = 6000;
    let along = |a: f64, b: f64| (0..=n).map(|i| at(a + (b - a) * i as f64 / n as f64)).collect::<Vec<_>>();
    let nose = along(leading[0], leading[1]);
    let foremost = (0..=n).min_by(|&i, &j| nose[i].x.total_cmp(&nose[j].x)).unwrap();
    let start = leading[0] + (leading[1] - leading[0]) * foremost as f64 / n as f64;
    [along(start, suction[1]), along(start, trailing[1] - 1.0)]
}

#[test]
fn the_propeller_has_the_sections_of_its_table() {
    let (_, blade) = built(&propeller());
    assert!(blade.surface.tip().is_some_and(|p| p.distance(DVec3::new(0.0, 0.0, 152.4)) < 1e-9));
    for (part, chord, pitch, camber, thickness) in
        [(0.7, 0.4622, 1.084, 0.02003, 0.05418), (0.4, 0.4048, 1.098, 0.02303, 0.118)]
    {
        let chord = chord * 304.8;
        let [suction, pressure] = section(&blade, part, pitch);
        let reach = suction.last().unwrap().x - suction[0].x;
        assert!((reach / chord - 1.0).abs() < 2e-3, "{part}: {reach} {chord}");
        let off = |side: &[DVec2], x: f64| {
            let i = side.partition_point(|p| p.x < x).clamp(1, side.len() - 1);
            let (a, b) = (side[i - 1], side[i]);
            a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x)
        };
        let (mut thick, mut high) = (0.0f64, 0.0f64);
        for i in 5..=95 {
            let x = (f64::from(i) / 100.0 - 0.5) * chord;
            let (s, p) = (off(&suction, x), off(&pressure, x));
            thick = thick.max(s - p);
            high = high.max(0.5 * (s + p));
        }
        assert!((thick / (thickness * chord) - 1.0).abs() < 2e-3, "{part}: {thick}");
        assert!((high / (camber * chord) - 1.0).abs() < 5e-3, "{part}: {high}");
    }
}

#[test]
fn a_left_handed_propeller_is_the_mirror_image() {
    let (_, right) = built(&propeller());
    let mut design = propeller();
    design["blade"]["hand"] = json!("left");
    let (_, left) = built(&design);
    assert_ne!(right.outward, left.outward);
    for u in around(100) {
        let (p, q) = (right.surface.point(u, 0.4), left.surface.point(u, 0.4));
        assert!(p.distance(DVec3::new(q.x, -q.y, q.z)) < 1e-9);
    }
}

#[test]
fn tables_without_a_tip_are_refused() {
    let mut design = propeller();
    let rows = design["blade"]["rows"].as_array_mut().unwrap();
    rows[9]["chord_d"] = json!(0.1);
    rows[3]["radius_r"] = json!(0.35);
    rows[4]["thickness_c"] = json!(0);
    design["blade"]["diameter"] = json!(-3);
    let expected = [
        ("/blade/diameter", "out_of_range"),
        ("/blade/rows/4/thickness_c", "out_of_range"),
        ("/blade/rows/3/radius_r", "not_increasing"),
        ("/blade/rows/9", "tip"),
    ];
    assert_eq!(refused(&design), expected.map(|(p, c)| (p.to_owned(), c)));
}

#[test]
fn a_medial_propeller_ends_in_its_tip() {
    let (_, blade) = built(&sample(include_str!("../../../samples/medial-propeller.json")));
    let tip = blade.surface.tip().unwrap();
    assert!((tip.x - 10.0).abs() < 1e-6 && (tip.y.hypot(tip.z) - 60.0).abs() < 1e-4, "{tip}");
    assert!(gap(&blade) < 1e-11);
    // All derivatives lie in one plane.
    let rates: Vec<DVec3> = around(200).iter().map(|&u| blade.surface.derivatives(u, 1.0).v).collect();
    let crosses = rates.iter().flat_map(|a| rates.iter().map(move |b| a.cross(*b)));
    let normal = crosses.max_by(|a, b| a.length().total_cmp(&b.length())).unwrap().normalize();
    for (u, d) in around(200).iter().zip(rates) {
        // In the middle of the trailing edge's strip the derivative vanishes.
        assert!(d.dot(normal).abs() < 1e-8 * d.length() + 1e-10, "{u} {:e}", d.dot(normal));
    }
}

#[test]
fn sides_do_not_change_places_at_the_tip_at_any_tolerance() {
    let samples = [
        include_str!("../../../samples/propeller.json"),
        include_str!("../../../samples/medial-propeller.json"),
    ];
    for (text, tolerance) in samples.iter().flat_map(|s| [5e-4, 2e-3, 2e-2].map(|t| (s, t))) {
        let mut design = sample(text);
        design["blade"]["skin"] = json!({ "tolerance": tolerance });
        let (_, blade) = built(&design);
        assert!(blade.fit.greatest_distance_mm <= tolerance);
        // A leading edge of its own would be a sliver there.
        assert!(blade.range(Region::LeadingEdge).is_none());
        for region in [Region::SuctionSide, Region::PressureSide] {
            let [start, end] = blade.range(region).unwrap();
            let at = |i: u32| start + (end - start) * f64::from(i) / 400.0;
            let rates: Vec<DVec3> = (0..=400).map(|i| blade.surface.derivatives(at(i), 1.0).v).collect();
            let turns: Vec<DVec3> = rates.windows(2).map(|r| r[0].cross(r[1])).collect();
            let whole: DVec3 = turns.iter().sum();
            // Near the tip the side is the cone over these: it folds where they turn back.
            assert!(turns.iter().all(|t| t.dot(whole) > 0.0), "{region:?} at {tolerance}");
        }
    }
}
