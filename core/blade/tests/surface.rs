//! Blades from surfaces: whatever the parametrisation, the same blade, exactly.

mod common;

use common::*;
use coolinggen_blade::{Blade, BladeSurface};
use coolinggen_nurbs::{Knots, ParametricSurface, RationalSurface, Surface};
use glam::{DVec2, DVec3};
use serde_json::{Value, json};

fn net(blade: &Blade) -> Surface<DVec3> {
    match &blade.surface {
        BladeSurface::BSpline(s) => s.clone(),
        BladeSurface::Rational(_) => panic!("rational"),
    }
}

fn source(s: &Surface<DVec3>) -> Value {
    let columns = s.counts().1;
    let points: Vec<Vec<[f64; 3]>> =
        s.points().chunks_exact(columns).map(|row| row.iter().map(DVec3::to_array).collect()).collect();
    json!({"kind": "surface", "degree_u": s.knots_u().degree(), "degree_v": s.knots_v().degree(),
        "knots_u": s.knots_u().values(), "knots_v": s.knots_v().values(), "points": points})
}

/// The same surface begun at u = `start`, both halves joined with a full knot.
fn begun_at(s: &Surface<DVec3>, start: f64) -> Surface<DVec3> {
    let (front, back) = (s.restricted_u(start, 1.0).unwrap(), s.restricted_u(0.0, start).unwrap());
    let shift = |k: &f64, by: f64| k + by;
    let degree = s.knots_u().degree();
    let mut knots: Vec<f64> = front.knots_u().values().iter().map(|k| shift(k, 0.0)).collect();
    knots.pop();
    knots.extend(back.knots_u().values()[degree + 1..].iter().map(|k| shift(k, 1.0)));
    let mut points = front.points().to_vec();
    points.extend_from_slice(&back.points()[s.counts().1..]);
    Surface::new(Knots::new(degree, knots).unwrap(), s.knots_v().clone(), points).unwrap()
}

fn reversed_u(s: &Surface<DVec3>) -> Surface<DVec3> {
    let (a, b) = s.knots_u().domain();
    let knots = s.knots_u().values().iter().rev().map(|k| a + (b - k)).collect();
    let points = s.points().chunks_exact(s.counts().1).rev().flatten().copied().collect();
    Surface::new(Knots::new(s.knots_u().degree(), knots).unwrap(), s.knots_v().clone(), points).unwrap()
}

fn same(a: &Blade, b: &Blade, tolerance: f64) {
    assert_eq!(a.outward, b.outward);
    assert_eq!(a.regions.len(), b.regions.len());
    for (x, y) in a.regions.iter().zip(&b.regions) {
        assert_eq!(x.0, y.0);
        assert!((x.1[0] - y.1[0]).abs() < 1e-9 && (x.1[1] - y.1[1]).abs() < 1e-9, "{x:?} {y:?}");
    }
    for u in around(300) {
        for w in [0.0, 0.3, 1.0] {
            let p = a.surface.point(u, w);
            let foot = b.closest(p, (u, w)).unwrap();
            assert!(foot.distance < tolerance, "{u} {w} {}", foot.distance);
        }
    }
}

#[test]
fn a_blade_comes_back_from_its_own_surface_however_it_is_turned() {
    let reference = built(&rotor(&[0.0, 0.3, 0.7, 1.0])).1;
    let given = net(&reference);
    let back = |s: &Surface<DVec3>| built(&json!({"space": annulus(), "blade": source(s)})).1;
    same(&reference, &back(&given), 1e-11);
    let turned = reversed_u(&begun_at(&given, 0.3123));
    same(&reference, &back(&turned), 1e-9);
    same(&reference, &back(&turned.transposed()), 1e-9);
    let upside_down = reversed_u(&turned.transposed()).transposed();
    let blade = back(&upside_down);
    same(&reference, &blade, 1e-9);
    // The seam that was inside the suction side has gone.
    assert!(blade.fit.notes.is_empty(), "{:?}", blade.fit.notes);
    assert_eq!(blade.surface.knots_u().control_count(), given.counts().0);
}

#[test]
fn edges_may_be_given_and_short_surfaces_are_extended() {
    let reference = built(&c3x()).1;
    let given = net(&reference);
    let mut spec = source(&given.restricted_v(0.05, 0.97).unwrap());
    let [l, s, t, p] = [0, 1, 2, 3].map(|k| reference.regions[k].1);
    spec["edges"] = json!({"leading_edge": [l[0], s[0]], "trailing_edge": [t[0], p[0]]});
    let (_, blade) = built(&json!({"space": linear(), "blade": spec}));
    same(&reference, &blade, 1e-10);
    let (_, (low, high)) = blade.surface.domain();
    assert!(low < -0.059 && high > 1.059);
    let mut bad = spec.clone();
    bad["edges"]["trailing_edge"] = json!([0.01, 7.0]);
    assert_eq!(
        refused(&json!({"space": linear(), "blade": bad})),
        [("/blade/edges/trailing_edge/1".to_owned(), "out_of_range")]
    );
}

/// A rod with a stadium section: two half circles (exact, rational) and two straight sides.
fn stadium() -> Value {
    let w = 0.5f64.sqrt();
    let half = |x: f64, sign: f64| {
        vec![
            (DVec2::new(x, -5.0 * sign), 1.0),
            (DVec2::new(x + 5.0 * sign, -5.0 * sign), w),
            (DVec2::new(x + 5.0 * sign, 0.0), 1.0),
            (DVec2::new(x + 5.0 * sign, 5.0 * sign), w),
            (DVec2::new(x, 5.0 * sign), 1.0),
        ]
    };
    let mut points = half(10.0, 1.0);
    points.push((DVec2::new(0.0, 5.0), 1.0));
    points.extend(half(-10.0, -1.0));
    points.push((DVec2::new(0.0, -5.0), 1.0));
    points.push(points[0]);
    let rows: Vec<Value> = points.iter().map(|(p, _)| json!([[p.x, p.y, -10.0], [p.x, p.y, 90.0]])).collect();
    let weights: Vec<Value> = points.iter().map(|(_, w)| json!([w, w])).collect();
    json!({"kind": "surface", "degree_u": 2, "degree_v": 1,
        "knots_u": [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 6], "knots_v": [0, 0, 1, 1],
        "points": rows, "weights": weights})
}

#[test]
fn a_rational_surface_stays_exact() {
    let (space, blade) = built(&json!({"space": linear(), "blade": stadium()}));
    assert!(matches!(blade.surface, BladeSurface::Rational(_)));
    assert_eq!(blade.regions.len(), 4);
    for (region, [a, b]) in &blade.regions {
        for i in 0..=40 {
            let p = blade.surface.point(a + (b - a) * f64::from(i) / 40.0, 0.4);
            let on = match region.name() {
                "leading_edge" => p.truncate().distance(DVec2::new(-10.0, 0.0)) - 5.0,
                "trailing_edge" => p.truncate().distance(DVec2::new(10.0, 0.0)) - 5.0,
                _ => p.y.abs() - 5.0,
            };
            assert!(on.abs() < 1e-12, "{region:?} {p} {on}");
        }
    }
    // It reached far beyond the cascade, and is kept.
    let (_, (low, high)) = blade.surface.domain();
    assert!((low + 10.0 / 76.2).abs() < 1e-12 && (high - 90.0 / 76.2).abs() < 1e-12);
    let surface = space.surface(0.25).unwrap();
    let profile = blade.profile(&surface, &around(64)).unwrap();
    assert!(profile.iter().all(|(w, _)| (w - 0.25).abs() < 1e-12));
    let RationalSurface { .. } = match &blade.surface {
        BladeSurface::Rational(r) => r,
        BladeSurface::BSpline(_) => panic!("not rational"),
    };
}

#[test]
fn refuses_bad_surfaces() {
    let change = |key: &str, value: Value| {
        let mut spec = stadium();
        spec[key] = value;
        refused(&json!({"space": linear(), "blade": spec}))
    };
    let at = |pointer: &str, code: &'static str| vec![(format!("/blade/{pointer}"), code)];
    assert_eq!(change("degree_u", json!(0)), at("degree_u", "out_of_range"));
    assert_eq!(change("knots_v", json!([0, 0, 1])), at("knots_v", "bad_knots"));
    assert_eq!(
        change("knots_v", json!([0, 0, 0.5, 1, 1])),
        [("/blade/points/0".to_owned(), "point_count"), ("/blade/weights/0".to_owned(), "point_count")]
    );
    let mut open = stadium();
    open["points"][12] = json!([[99, 0, -10], [99, 0, 90]]);
    assert_eq!(refused(&json!({"space": linear(), "blade": open}))[0].1, "not_closed");
    let mut away = stadium();
    for row in away["points"].as_array_mut().unwrap() {
        for p in row.as_array_mut().unwrap() {
            p[2] = json!(p[2].as_f64().unwrap() + 500.0);
        }
    }
    assert!(!refused(&json!({"space": linear(), "blade": away})).is_empty());
    // A square rod has corners where it may not.
    let square: Vec<Value> = [[-9, -5], [9, -5], [9, 5], [-9, 5], [-9, -5]]
        .iter()
        .map(|p| json!([[p[0], p[1], -10], [p[0], p[1], 90]]))
        .collect();
    let square = json!({"kind": "surface", "degree_u": 1, "degree_v": 1,
        "knots_u": [0, 0, 1, 2, 3, 4, 4], "knots_v": [0, 0, 1, 1], "points": square});
    assert!(!refused(&json!({"space": linear(), "blade": square})).is_empty());
}
