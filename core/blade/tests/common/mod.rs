//! Blades for the tests.
#![allow(unreachable_pub)]
#![allow(dead_code)]

use coolinggen_blade::{Blade, BladeSource, Fault, SpaceSpec, StreamSpace, build};
use glam::DVec2;
use serde_json::{Value, json};
use std::path::Path;

/// The C3X vane's points, mm; the last repeats the first.
pub fn c3x_points() -> Vec<DVec2> {
    let table = include_str!("../data/c3x_profile.csv");
    let rows = table.lines().filter(|l| l.starts_with(|c: char| c.is_ascii_digit()));
    rows.map(|l| {
        let mut fields = l.split(',').skip(1).map(|f| f.parse::<f64>().unwrap() * 10.0);
        DVec2::new(fields.next().unwrap(), fields.next().unwrap())
    })
    .collect()
}

pub fn listed(points: &[DVec2]) -> Value {
    json!(points.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>())
}

pub fn linear() -> Value {
    json!({"kind": "linear", "height": 76.2})
}

pub fn c3x() -> Value {
    json!({"space": linear(), "blade": {"kind": "sections", "sections": [{"points": listed(&c3x_points())}]}})
}

/// A turbine annulus with wavy contours.
pub fn annulus() -> Value {
    let x = |i: u32| -30.0 + 10.0 * f64::from(i);
    let hub: Vec<_> = (0..=11).map(|i| [x(i), 250.0 + x(i) / 20.0 + 0.5 * (x(i) / 12.0).sin()]).collect();
    let shroud: Vec<_> = (0..=11).map(|i| [x(i), 305.0 + x(i) / 4.0 - (x(i) / 14.0).sin()]).collect();
    json!({"kind": "annular", "hub": hub, "shroud": shroud})
}

/// Points of a turbine section in order leading edge (pressure side end) to suction side to trailing edge to pressure
/// side: exact arcs at both ends, `n` points a side.
pub fn section(v: f64, n: usize) -> Vec<DVec2> {
    let chord = 45.0 - 3.0 * v;
    let (inlet, exit) = ((42.0 - 20.0 * v).to_radians(), (-62.0 - 3.0 * v).to_radians());
    let steps = 4000;
    let angle = |s: f64| inlet + (exit - inlet) * (0.35 * s * s * (3.0 - 2.0 * s) + 0.65 * s);
    let radius = |s: f64| 2.2 + s * (9.0 + s * (-16.6 + 6.0 * s));
    let slope = |s: f64| 9.0 + s * (-33.2 + 18.0 * s);
    let mut camber = vec![DVec2::ZERO];
    for i in 0..steps {
        let s = (i as f64 + 0.5) / steps as f64;
        camber.push(camber[i] + DVec2::from_angle(angle(s)) / steps as f64);
    }
    let length = chord / camber[steps].length();
    let at = |s: f64| {
        let i = ((s * steps as f64) as usize).min(steps - 1);
        let f = s * steps as f64 - i as f64;
        let c = (camber[i] * (1.0 - f) + camber[i + 1] * f) * length;
        let (tangent, r, dr) = (DVec2::from_angle(angle(s)), radius(s), slope(s) / length);
        let along = tangent * (-r * dr);
        let across = tangent.perp() * (r * (1.0 - dr * dr).sqrt());
        (c, c + along + across, c + along - across)
    };
    let side = |k: usize| {
        let s = k as f64 / (n - 1) as f64;
        at(0.5 - 0.5 * (std::f64::consts::PI * s).cos() * 0.6 - (1.0 - 2.0 * s) * 0.2)
    };
    let arc = |from: DVec2, to: DVec2, center: DVec2| {
        let (a, r) = ((from - center).to_angle(), (from - center).length());
        let turn = ((to - center).to_angle() - a).rem_euclid(std::f64::consts::TAU) - std::f64::consts::TAU;
        (1..14)
            .map(move |i| center + DVec2::from_angle(a + turn * f64::from(i) / 14.0) * r)
            .collect::<Vec<_>>()
    };
    let (lead, trail) = (at(0.0), at(1.0));
    let mut points = arc(lead.2, lead.1, lead.0);
    points.extend((0..n).map(|k| side(k).1));
    points.extend(arc(trail.1, trail.2, trail.0));
    points.extend((0..n).rev().map(|k| side(k).2));
    let middle = at(0.4).0;
    let lean = DVec2::new(
        48.0 + v,
        (v - 0.5) * 58.0 * 12f64.to_radians().tan() + 1.5 * (std::f64::consts::PI * v).sin(),
    );
    points.into_iter().map(|p| p - middle + lean).collect()
}

/// A leaned, twisted rotor in the annulus, sections at `spans`.
pub fn rotor(spans: &[f64]) -> Value {
    let sections: Vec<_> =
        spans.iter().map(|&v| json!({"span": v, "points": listed(&section(v, 60))})).collect();
    json!({"space": annulus(), "blade": {"kind": "sections", "sections": sections}})
}

pub fn built_in(design: &Value, folder: &Path) -> Result<(StreamSpace, Blade), Vec<Fault>> {
    let space: SpaceSpec = serde_json::from_value(design["space"].clone()).unwrap();
    let source: BladeSource = serde_json::from_value(design["blade"].clone()).unwrap();
    build(&space, &source, folder)
}

pub fn built(design: &Value) -> (StreamSpace, Blade) {
    match built_in(design, Path::new(".")) {
        Ok(built) => built,
        Err(faults) => panic!("{}", faults.iter().map(|f| format!("{f}\n")).collect::<String>()),
    }
}

/// Pointers and codes of the faults of a design.
pub fn refused(design: &Value) -> Vec<(String, &'static str)> {
    match built_in(design, Path::new(".")) {
        Ok(_) => Vec::new(),
        Err(faults) => faults.into_iter().map(|f| (f.pointer, f.code)).collect(),
    }
}

/// `n` parameters around.
pub fn around(n: usize) -> Vec<f64> {
    (0..n).map(|i| i as f64 / n as f64).collect()
}

pub fn polygon_area(points: &[DVec2]) -> f64 {
    let next = points.iter().cycle().skip(1);
    0.5 * points.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
}
