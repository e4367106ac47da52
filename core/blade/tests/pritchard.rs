//! Blades from the eleven-parameter section.

mod common;

use common::*;
use coolinggen_blade::Region;
use coolinggen_nurbs::ParametricSurface;
use serde_json::{Value, json};

fn cascade() -> Value {
    json!({"space": {"kind": "linear", "height": 50}, "blade": {"kind": "pritchard",
        "radius": 139.7, "axial_chord": 28, "tangential_chord": 15, "unguided_turning_deg": 6.3,
        "inlet_angle_deg": 35, "inlet_half_wedge_deg": 8, "leading_edge_radius": 0.79, "exit_angle_deg": -57,
        "trailing_edge_radius": 0.4, "blade_count": 51, "throat": 8.56}})
}

fn rotor() -> Value {
    json!({"space": {"kind": "annular", "hub": [[-20, 135], [60, 137]], "shroud": [[-20, 165], [20, 169], [60, 175]]},
        "blade": {"kind": "pritchard", "axial_chord": [[0, 30], [1, 26]], "tangential_chord": [[0, 15], [1, 10]],
        "unguided_turning_deg": 6.3, "inlet_angle_deg": [[0, 38], [0.5, 25], [1, 20]],
        "inlet_half_wedge_deg": [[0, 9], [1, 8]], "leading_edge_radius": [[0, 1.6], [1, 1.2]],
        "exit_angle_deg": [[0, -56], [1, -61]], "trailing_edge_radius": 0.5, "blade_count": 50,
        "throat": [[0, 8.9], [1, 9.9]], "x": 12, "r_theta": [[0, -3], [1, 3]], "stacking": "centroid"}})
}

#[test]
fn a_cascade_has_the_chord_and_edges_asked_for() {
    let (space, blade) = built(&cascade());
    assert!(blade.fit.greatest_distance_mm < 5e-4);
    let surface = space.surface(0.5).unwrap();
    let n = 40_000;
    let outline: Vec<_> = blade.profile(&surface, &around(n)).unwrap().into_iter().map(|(_, q)| q).collect();
    let low = outline.iter().map(|p| p.x).fold(f64::INFINITY, f64::min);
    let high = outline.iter().map(|p| p.x).fold(f64::NEG_INFINITY, f64::max);
    // The leading-edge circle touches x = 0, where the section stands, and the trailing-edge circle x = chord.
    assert!(low.abs() < 1e-6 && (high - 28.0).abs() < 1e-6, "{low} {high}");
    for (region, radius) in [(Region::LeadingEdge, 0.79), (Region::TrailingEdge, 0.4)] {
        let [a, b] = blade.range(region).unwrap();
        for i in 1..20 {
            let d = blade.surface.derivatives(a + (b - a) * f64::from(i) / 20.0, 0.5);
            assert!((d.u.cross(d.uu).length() / d.u.length().powi(3) * radius - 1.0).abs() < 1e-3);
        }
    }
    // The throat, from the next blade's trailing-edge circle to this suction side, is as asked.
    let pitch = std::f64::consts::TAU * 139.7 / 51.0;
    let center = glam::DVec2::new(28.0 - 0.4, -15.0 + pitch);
    let throat = outline.iter().map(|p| p.distance(center)).fold(f64::INFINITY, f64::min) - 0.4;
    assert!((throat - 8.56).abs() < 1e-3, "{throat}");
    // Turned over, it is its mirror image.
    let mut design = cascade();
    design["blade"]["mirrored"] = json!(true);
    let (_, mirrored) = built(&design);
    assert_ne!(mirrored.outward, blade.outward);
    for u in around(200) {
        let (p, q) = (blade.surface.point(u, 0.5), mirrored.surface.point(u, 0.5));
        assert!((p.y + q.y).abs() < 1e-12 && (p.x - q.x).abs() < 1e-12);
    }
}

#[test]
fn an_annular_rotor_follows_its_laws_between_the_sections() {
    let (space, blade) = built(&rotor());
    assert!(blade.fit.greatest_distance_mm < 5e-4, "{}", blade.fit.greatest_distance_mm);
    assert_eq!(blade.regions.len(), 4);
    for v in [0.0, 0.37, 1.0] {
        let surface = space.surface(v).unwrap();
        let profile = blade.profile(&surface, &around(3000)).unwrap();
        // The centroid of the developed section stands at x = 12.
        let points: Vec<_> = profile.iter().map(|(_, q)| *q).collect();
        let mut sum = glam::DVec2::ZERO;
        for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
            sum += (*a + *b) * a.perp_dot(*b) / 6.0;
        }
        let p = surface.to_space(sum / polygon_area(&points));
        assert!((p.x - 12.0).abs() < 0.02, "{p}");
        let r_theta = p.y.atan2(p.z) * p.y.hypot(p.z);
        assert!((r_theta - (6.0 * v - 3.0)).abs() < 0.05, "{r_theta}");
    }
}

#[test]
fn refuses_with_pointers() {
    let change = |key: &str, value: Value| {
        let mut design = cascade();
        design["blade"][key] = value;
        refused(&design)
    };
    let one = |pointer: &str, code: &'static str| vec![(format!("/blade/{pointer}"), code)];
    assert_eq!(change("throat", json!(30)), one("throat", "out_of_range"));
    assert_eq!(change("axial_chord", json!(-3)), one("axial_chord", "out_of_range"));
    assert_eq!(change("radius", Value::Null), one("radius", "missing"));
    assert_eq!(change("leading_edge_radius", json!(40)).len(), 1);
    assert_eq!(
        change("inlet_angle_deg", json!([[0, 10], [0, 20]])),
        one("inlet_angle_deg/1/0", "not_increasing")
    );
    assert_eq!(change("blade_count", json!(1)), one("blade_count", "out_of_range"));
    let mut many = cascade();
    many["blade"]["throat"] = json!(-1);
    many["blade"]["exit_angle_deg"] = json!(-120);
    assert_eq!(refused(&many).len(), 2);
    let mut away = rotor();
    away["blade"]["x"] = json!(70);
    assert_eq!(refused(&away)[0].0, "/blade/x");
    away["blade"]["x"] = json!(50);
    assert_eq!(refused(&away)[0], ("/space".to_owned(), "outside_contours"));
}
