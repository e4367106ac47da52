//! Fields of the design: what no type knows is refused.

mod common;

use common::*;
use coolinggen_blade::{BladeSource, SpaceSpec};
use serde_json::{Value, json};

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
