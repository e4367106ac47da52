//! Stream space: exact inverses, conformality, closed forms, radial machines, refusals.

use coolinggen_blade::{Pointer, SpaceSpec, StreamSpace};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use serde_json::{Value, json};

fn space(spec: Value) -> StreamSpace {
    let spec: SpaceSpec = serde_json::from_value(spec).unwrap();
    spec.space(&Pointer::root()).unwrap()
}

fn refusals(spec: Value) -> Vec<(String, &'static str)> {
    let spec: SpaceSpec = serde_json::from_value(spec).unwrap();
    let faults = spec.space(&Pointer::root()).unwrap_err();
    faults.into_iter().map(|f| (f.pointer, f.code)).collect()
}

fn with_reference(space: StreamSpace, s: f64, angle: f64) -> StreamSpace {
    match space {
        StreamSpace::Annular(a) => StreamSpace::Annular(a.with_reference(s, angle)),
        other => other,
    }
}

/// A wavy annulus of a turbine.
fn wavy() -> StreamSpace {
    let x = |i: u32| -30.0 + 10.0 * f64::from(i);
    let hub: Vec<_> =
        (0..=11).map(|i| json!([x(i), 250.0 + x(i) / 20.0 + 0.5 * (x(i) / 12.0).sin()])).collect();
    let shroud: Vec<_> = (0..=11).map(|i| json!([x(i), 305.0 + x(i) / 4.0 - (x(i) / 14.0).sin()])).collect();
    space(json!({"kind": "annular", "hub": hub, "shroud": shroud}))
}

/// A radial turbine's passage: from radially inward to axial.
fn radial() -> StreamSpace {
    let arc = |center: [f64; 2], radius: f64| -> Vec<Value> {
        (0..=8)
            .map(|i| {
                let a = f64::from(i) / 8.0 * std::f64::consts::FRAC_PI_2;
                json!([center[0] - radius * a.cos(), center[1] - radius * a.sin()])
            })
            .collect()
    };
    space(json!({"kind": "annular", "hub": arc([60.0, 90.0], 60.0), "shroud": arc([60.0, 90.0], 25.0)}))
}

#[test]
fn a_cylinder_and_a_cone_have_closed_forms() {
    let annulus = with_reference(
        space(json!({"kind": "annular", "hub": [[0, 100], [50, 100]], "shroud": [[0, 140], [50, 170]]})),
        0.4,
        0.7,
    );
    let cylinder = annulus.surface(0.0).unwrap();
    let p = cylinder.to_space(DVec2::new(5.0, 30.0));
    // M = x - 20 and T = 100 (theta - 0.7).
    assert!(p.distance(DVec3::new(25.0, 100.0 * 1f64.sin(), 100.0 * 1f64.cos())) < 1e-12);
    assert_eq!(cylinder.scale(DVec2::new(5.0, 30.0)), 1.0);
    let cone = annulus.surface(1.0).unwrap();
    let (slope, r_ref) = (30.0 / 50f64.hypot(30.0), 140.0 + 30.0 * 0.4);
    for x in [0.0, 3.0, 20.0, 41.0, 50.0] {
        let r = 140.0 + 30.0 * x / 50.0;
        let q = cone.to_chart(DVec3::new(x, 0.0, r));
        assert!((q.x - r_ref / slope * (r / r_ref).ln()).abs() < 1e-12, "{x}");
        assert!((q.y - r_ref * -0.7).abs() < 1e-12);
        let (m, r_theta) = cone.stream_of_chart(q);
        assert!((m - x * 50f64.hypot(30.0) / 50.0).abs() < 1e-12 && r_theta.abs() < 1e-12);
    }
}

#[test]
fn a_collinear_list_is_the_same_as_its_ends() {
    let a = space(
        json!({"kind": "annular", "hub": [[0, 100], [20, 104], [50, 110]], "shroud": [[0, 140], [50, 170]]}),
    );
    let surface = a.surface(0.0).unwrap();
    assert_eq!(surface.meridian().unwrap().degree(), 1);
    assert!(matches!(
        match surface.geometry() {
            coolinggen_brep::SurfaceGeometry::Revolution(r) => r.kind(),
            _ => panic!("not a revolution"),
        },
        coolinggen_brep::RevolutionKind::Cone { .. }
    ));
}

#[test]
fn a_nurbs_contour_and_streamlines_make_the_same_net_as_points() {
    let line = json!({"degree": 1, "knots": [3, 3, 7, 7], "points": [[0, 100], [50, 110]]});
    let a = space(json!({"kind": "annular", "hub": line, "shroud": [[0, 140], [50, 170]]}));
    let b = space(json!({"kind": "streamlines", "streamlines": [
        {"v": 0, "contour": [[0, 100], [50, 110]]},
        {"v": 0.5, "contour": [[0, 120], [50, 140]]},
        {"v": 1, "contour": [[0, 140], [50, 170]]}]}));
    for v in [-0.1, 0.0, 0.3, 1.0, 1.15] {
        let q = DVec2::new(3.0, 4.0);
        let d = a.surface(v).unwrap().to_space(q).distance(b.surface(v).unwrap().to_space(q));
        assert!(d < 1e-11, "{d}");
    }
}

#[test]
fn the_span_fraction_is_that_of_the_surface() {
    for s in [wavy(), radial()] {
        for v in [-0.15, -0.06, 0.0, 0.31, 0.5, 1.0, 1.06, 1.15] {
            let surface = s.surface(v).unwrap();
            let (a, b) = surface.chart_extent();
            for i in 0..=20 {
                let q = DVec2::new(a + (b - a) * f64::from(i) / 20.0, 7.0 * f64::from(i) - 50.0);
                let found = s.span_fraction(surface.to_space(q)).unwrap();
                assert!((found - v).abs() < 1e-11, "{v} {found}");
            }
        }
        assert!(s.surface(1.2).is_err() && s.surface(f64::NAN).is_err());
        assert!(s.span_fraction(DVec3::new(1e4, 0.0, 10.0)).is_err());
    }
}

#[test]
fn the_level_grows_towards_the_shroud() {
    for s in [wavy(), radial(), space(json!({"kind": "linear", "height": 50}))] {
        let (low, high) = (s.surface(0.4).unwrap(), s.surface(0.41).unwrap());
        for i in 1..20 {
            let (a, b) = match low.chart_extent() {
                (a, _) if a.is_infinite() => (-10.0, 10.0),
                extent => extent,
            };
            let q = DVec2::new(a + (b - a) * f64::from(i) / 20.0, 5.0);
            let p = high.to_space(q);
            let (level, gradient) = low.level(p);
            assert!(level > 0.0 && (gradient.length() - 1.0).abs() < 1e-12);
            assert!(low.level(low.to_space(q)).0.abs() < 1e-12 * 400.0);
            // The gradient is that of the level.
            let d = DVec3::new(0.3, -0.2, 0.5) * 1e-5;
            let change = low.level(p + d).0 - low.level(p - d).0;
            assert!((change - 2.0 * gradient.dot(d)).abs() < 1e-11, "{change}");
        }
    }
}

#[test]
fn refuses_bad_spaces_with_pointers() {
    let ok = json!([[0, 100], [50, 100]]);
    let refused =
        |hub: Value, shroud: Value| refusals(json!({"kind": "annular", "hub": hub, "shroud": shroud}));
    let swapped = refused(json!([[0, 150], [50, 150]]), ok.clone());
    assert_eq!(swapped, vec![("/shroud".to_owned(), "hub_above_shroud")]);
    let crossing = refused(json!([[0, 90], [50, 120]]), ok.clone());
    assert_eq!(crossing[0].1, "hub_above_shroud");
    let both = refused(json!([[0, -1], [50, 90]]), json!([[0, 100], [0, 100]]));
    assert_eq!(
        both,
        vec![("/hub/0/1".to_owned(), "out_of_range"), ("/shroud/1".to_owned(), "duplicate_point")]
    );
    assert_eq!(refused(json!([[0, 90]]), ok.clone())[0].1, "point_count");
    let kinked =
        json!({"degree": 2, "knots": [0,0,0,1,1,2,2,2], "points": [[0,50],[10,50],[20,50],[30,50],[40,60]]});
    assert_eq!(refused(kinked, ok)[0], ("/hub/knots".to_owned(), "bad_contour"));
    assert_eq!(
        refusals(json!({"kind": "linear", "height": -3})),
        vec![("/height".to_owned(), "out_of_range")]
    );
    let lines = json!({"kind": "streamlines", "streamlines": [
        {"v": 0.1, "contour": [[0, 100], [50, 110]]}, {"v": 0.05, "contour": [[0, 140], [50, 170]]}]});
    assert_eq!(refusals(lines).len(), 2);
    assert!(serde_json::from_value::<SpaceSpec>(json!({"kind": "linear", "height": 3, "hight": 1})).is_err());
}

proptest! {
    #[test]
    fn the_chart_is_inverse_and_conformal(
        which in 0usize..3, v in -0.15f64..=1.15, f in 0.0f64..=1.0, t in -150.0f64..150.0, angle in -3.0f64..3.0,
    ) {
        let s = [wavy(), radial(), space(json!({"kind": "annular", "hub": [[0, 60], [50, 90]], "shroud": [[0, 100], [60, 120]]}))];
        let s = with_reference(s[which].clone(), 0.3, angle);
        let surface = s.surface(v).unwrap();
        let (a, b) = surface.chart_extent();
        let q = DVec2::new(a + (b - a) * f, t);
        let p = surface.to_space(q);
        prop_assert!(surface.to_chart(p).distance(q) < 1e-10);
        prop_assert!(surface.level(p).0.abs() < 1e-11);
        let (p2, dm, dt) = surface.to_space_derivatives(q);
        let scale = surface.scale(q);
        prop_assert!(p2.distance(p) < 1e-12);
        prop_assert!(dm.dot(dt).abs() < 1e-13 && (dm.length() - scale).abs() < 1e-13 && (dt.length() - scale).abs() < 1e-13);
        let h = 1e-4;
        let numeric = (surface.to_space(q + DVec2::new(0.0, h)) - surface.to_space(q - DVec2::new(0.0, h))) / (2.0 * h);
        prop_assert!(numeric.distance(dt) < 1e-6);
        if f > 0.01 && f < 0.99 {
            let numeric = (surface.to_space(q + DVec2::new(h, 0.0)) - surface.to_space(q - DVec2::new(h, 0.0))) / (2.0 * h);
            prop_assert!(numeric.distance(dm) < 1e-6);
        }
        let (m, r_theta) = surface.stream_of_chart(q);
        prop_assert!(surface.chart_of_stream(m, r_theta).distance(q) < 1e-10);
        prop_assert!(surface.stream_to_space(m, r_theta).distance(p) < 1e-10);
        // The parameters give the same point of the cap.
        let uv = surface.parameters(p);
        let on_cap = coolinggen_nurbs::ParametricSurface::point(surface.geometry(), uv.x, uv.y);
        prop_assert!(on_cap.distance(p) < 1e-10);
        prop_assert!(surface.parameters_of_chart(q).distance(uv) < 1e-12);
    }
}
