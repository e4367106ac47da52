//! Faces made from edges.

use crate::solids::{segment, style, tube};
use coolinggen_brep::{
    BuildError, EdgeCurve, EdgeId, LoopEdges, Model, Plane, Revolution, SurfaceGeometry, VertexId,
    interpolated_pcurve, signed_area, straight_pcurve,
};
use coolinggen_nurbs::{Curve, Interpolator, Knots, NurbsError, ParametricCurve, ParametricSurface, Surface};
use glam::{DMat3, DVec2, DVec3};
use proptest::prelude::*;
use std::f64::consts::PI;

#[test]
fn straight_pcurves() {
    let c = straight_pcurve(DVec2::ZERO, DVec2::new(2.0, 4.0), (3.0, 5.0)).unwrap();
    assert_eq!(c.domain(), (3.0, 5.0));
    assert_eq!(c.point(3.5), DVec2::new(0.5, 1.0));
    assert!(matches!(straight_pcurve(DVec2::ZERO, DVec2::X, (1.0, 1.0)), Err(NurbsError::KnotOrder { .. })));
    assert!(matches!(
        straight_pcurve(DVec2::NAN, DVec2::X, (0.0, 1.0)),
        Err(NurbsError::BadPoint { index: 0 })
    ));
}

/// A wavy patch with its corners as vertices.
fn patch() -> (Model, Surface<DVec3>, [VertexId; 4]) {
    let k = Knots::uniform(3, 8).unwrap();
    let g = k.greville();
    let net =
        g.iter().flat_map(|&u| g.iter().map(move |&v| DVec3::new(10.0 * u, 5.0 * v, (4.0 * u * v).sin())));
    let s = Surface::new(k.clone(), k.clone(), net.collect()).unwrap();
    let mut m = Model::default();
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(u, v)| m.add_vertex(s.point(u, v)));
    (m, s, corners)
}

/// The part of a B-spline curve on `[a, b]`, on that domain: what splitting at knots gives.
fn part(c: &Curve<DVec3>, a: f64, b: f64) -> Curve<DVec3> {
    let mut breaks: Vec<f64> = c.breaks().into_iter().filter(|&t| t > a && t < b).collect();
    breaks.insert(0, a);
    breaks.push(b);
    let points: Vec<DVec3> = breaks.iter().map(|&t| c.point(t)).collect();
    let slopes = [a, b].map(|t| c.derivatives(t)[1]);
    Interpolator::with_slopes(&breaks).unwrap().curve_with_slopes(&points, slopes[0], slopes[1]).unwrap()
}

#[test]
fn patches_take_edges_of_either_direction_and_chains() {
    let (mut m, s, v) = patch();
    // Below: two edges on their own domains, the second one backwards. Right: backwards. Above: another domain.
    let below = s.iso_v(0.0);
    let middle = m.add_vertex(below.point(0.37));
    let first = m.add_edge(v[0], middle, part(&below, 0.0, 0.37));
    let second = m.add_edge(v[1], middle, part(&below, 0.37, 1.0).reversed());
    let right = m.add_edge(v[2], v[1], s.iso_u(1.0).reversed());
    let above = m.add_edge(v[3], v[2], s.iso_v(1.0).reparameterized(-2.0, 7.0));
    let left = m.add_edge(v[0], v[3], s.iso_u(0.0));
    let borders: [&[EdgeId]; 4] = [&[first, second], &[right], &[above], &[left]];
    let id = m.patch_face("patch", s.clone(), borders, style()).unwrap();
    let lp = &m.face(id).loops[0];
    assert_eq!(lp.coedges.iter().map(|c| c.forward).collect::<Vec<_>>(), [true, false, false, false, false]);
    assert!((signed_area(lp) - 1.0).abs() < 1e-12);
    for c in &lp.coedges {
        let (a, b) = m.edge(c.edge).curve.domain();
        assert_eq!(c.pcurve.domain(), (a, b));
        for i in 0..=20 {
            let t = a + (b - a) * f64::from(i) / 20.0;
            let (at, p) = (c.pcurve.point(t), m.edge(c.edge).curve.point(t));
            assert!(s.point(at.x, at.y).distance(p) < 1e-12, "edge {} at {t}", c.edge.0);
        }
    }
    // A border that is not there.
    let borders: [&[EdgeId]; 4] = [&[first, second], &[left], &[above], &[right]];
    let error = m.patch_face("patch", s.clone(), borders, style()).unwrap_err();
    assert!(
        matches!(error, BuildError::BorderGap { border: 1, edge, gap_mm } if edge == left && gap_mm > 1.0)
    );
    assert!(error.to_string().contains("u = end"));
    let plane = Plane { origin: DVec3::ZERO, x: DVec3::X, y: DVec3::Y };
    assert_eq!(m.patch_face("p", plane, [&[first], &[], &[], &[]], style()), Err(BuildError::Unbounded));
    let borders: [&[EdgeId]; 4] = [&[EdgeId(99)], &[], &[], &[]];
    assert_eq!(m.patch_face("p", s, borders, style()), Err(BuildError::NoEdge { edge: EdgeId(99) }));
}

/// A meridian that bends.
fn bent() -> Revolution {
    let x: Vec<f64> = (0..=10).map(f64::from).collect();
    let points: Vec<DVec2> = x.iter().map(|&x| DVec2::new(4.0 * x, 250.0 + 6.0 * (0.3 * x).sin())).collect();
    Revolution::new(Interpolator::new(3, &x).unwrap().curve(&points).unwrap()).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn pcurves_on_revolutions_keep_their_bound(
        start in (-3.0f64..3.0, 1.0f64..9.0),
        way in (-0.3f64..0.3, -1.0f64..1.0),
        turn in -2i32..=2,
        spans in 8usize..80,
        straight in proptest::bool::ANY,
    ) {
        let surface: SurfaceGeometry = if straight {
            Revolution::new(Curve::segment(DVec2::new(0.0, 250.0), DVec2::new(10.0, 252.0)).reparameterized(0.0, 10.0))
                .unwrap()
                .into()
        } else {
            bent().into()
        };
        let at = |s: f64| DVec2::new(start.0 + way.0 * s, start.1 + way.1 * s + 0.3 * (3.0 * s).sin());
        let t: Vec<f64> = (0..=spans).map(|i| i as f64 / spans as f64).collect();
        let points: Vec<DVec3> = t.iter().map(|&t| surface.point(at(t).x, at(t).y)).collect();
        let edge = EdgeCurve::BSpline(Interpolator::new(3, &t).unwrap().curve(&points).unwrap());
        let near = at(0.0) + DVec2::new(f64::from(turn) * 2.0 * PI, 0.0);
        // An edge is only as close to the surface as its own interpolation.
        let off = |t: f64| {
            let p = edge.point(t);
            let r = DVec2::new(p.x, p.y.hypot(p.z));
            let SurfaceGeometry::Revolution(s) = &surface else { unreachable!() };
            let mut v = at(t).y;
            for _ in 0..20 {
                let [q, d, _] = s.meridian().derivatives(v);
                v -= (q - r).dot(d) / d.length_squared();
            }
            (s.meridian().point(v) - r).length()
        };
        let distance = (0..2000).map(|i| off(f64::from(i) / 2000.0)).fold(0.0, f64::max);
        let tolerance = (2.0 * distance).max(1e-9);
        let found = interpolated_pcurve(&edge, &surface, near, tolerance).unwrap();
        prop_assert_eq!(found.curve.domain(), edge.domain());
        prop_assert!((found.curve.point(0.0) - near).length() < 1e-9, "{} {near}", found.curve.point(0.0));
        let dense = (0..=3000).map(|i| f64::from(i) / 3000.0).map(|t| {
            let at = found.curve.point(t);
            surface.point(at.x, at.y).distance(edge.point(t))
        });
        let dense = dense.fold(0.0, f64::max);
        prop_assert!(dense < 1.2 * found.deviation_mm.max(1e-10), "{dense} {}", found.deviation_mm);
        prop_assert!(found.deviation_mm <= tolerance);
        // Closer than the edge itself is cannot be had.
        if distance > 1e-7 {
            let refused = interpolated_pcurve(&edge, &surface, near, 0.5 * distance);
            let told = matches!(refused, Err(BuildError::OffSurface { distance_mm, .. }) if distance_mm > 0.5 * distance);
            prop_assert!(told, "{refused:?}");
        }
    }
}

#[test]
fn pcurves_on_splines_follow_newton() {
    let (_, s, _) = patch();
    let at = |t: f64| DVec2::new(0.1 + 0.8 * t, 0.5 + 0.3 * (4.0 * t).sin());
    let t: Vec<f64> = (0..=60).map(|i| f64::from(i) / 60.0).collect();
    let points: Vec<DVec3> = t.iter().map(|&t| s.point(at(t).x, at(t).y)).collect();
    let edge = EdgeCurve::BSpline(Interpolator::new(3, &t).unwrap().curve(&points).unwrap());
    let found = interpolated_pcurve(&edge, &s.into(), DVec2::new(0.2, 0.4), 1e-5).unwrap();
    for t in t {
        assert!((found.curve.point(t) - at(t)).length() < 1e-5);
    }
}

#[test]
fn pcurves_on_planes_are_exact() {
    let plane = Plane { origin: DVec3::new(1.0, 2.0, 3.0), x: DVec3::Y, y: DVec3::Z };
    let points = vec![DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 5.0, 1.0), DVec3::new(1.0, 3.0, 7.0)];
    let edge = EdgeCurve::BSpline(Curve::bezier(points.clone()).unwrap());
    let found = interpolated_pcurve(&edge, &plane.into(), DVec2::ZERO, 1e-12).unwrap();
    assert_eq!(found.curve.points(), [(-2.0, -3.0), (3.0, -2.0), (1.0, 4.0)].map(|(u, v)| DVec2::new(u, v)));
    assert_eq!(found.deviation_mm, 0.0);
    let off = Plane { origin: DVec3::new(1.5, 2.0, 3.0), ..plane };
    let error = interpolated_pcurve(&edge, &off.into(), DVec2::ZERO, 1e-6).unwrap_err();
    assert_eq!(error, BuildError::OffSurface { distance_mm: 0.5, tolerance_mm: 1e-6 });
}

#[test]
fn loops_are_turned_the_right_way() {
    let mut m = Model::default();
    let square = |m: &mut Model, size: f64| {
        let v = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| m.add_vertex(DVec3::new(size * x, size * y, 0.0)));
        [0, 1, 2, 3].map(|i| (segment(m, v[i], v[(i + 1) % 4]), true))
    };
    let (outer, inner) = (square(&mut m, 3.0), square(&mut m, 1.0));
    let back: Vec<_> = outer.iter().rev().map(|&(e, f)| (e, !f)).collect();
    let plane = Plane { origin: DVec3::ZERO, x: DVec3::X, y: DVec3::Y };
    let with = |edges| LoopEdges { edges, near: DVec2::ZERO };
    for outer in [&outer[..], &back] {
        let id = m.trimmed_face("face", plane, &[with(outer), with(&inner)], 1e-9, style()).unwrap();
        let areas: Vec<f64> = m.face(id).loops.iter().map(signed_area).collect();
        assert_eq!(areas, [36.0, -4.0]);
    }
    let open = m.trimmed_face("face", plane, &[with(&outer[..3])], 1e-9, style()).unwrap_err();
    assert!(matches!(open, BuildError::OpenLoop { index: 0, .. }));
    let mixed = [outer[0], outer[2]];
    let open = m.trimmed_face("face", plane, &[with(&outer), with(&mixed)], 1e-9, style()).unwrap_err();
    assert!(matches!(open, BuildError::OpenLoop { index: 1, .. }));
    assert!(m.trimmed_face("face", plane, &[with(&[])], 1e-9, style()).is_err());
}

#[test]
fn a_loop_round_the_axis_is_refused() {
    let mut m = Model::default();
    let turns = [0.0, PI].map(|theta| crate::solids::half_turn(1.0, 3.0, theta));
    let v = [0.0, PI].map(|a: f64| m.add_vertex(DVec3::new(1.0, 3.0 * a.sin(), 3.0 * a.cos())));
    let e = [m.add_edge(v[0], v[1], turns[0].clone()), m.add_edge(v[1], v[0], turns[1].clone())];
    let surface = Revolution::new(Curve::segment(DVec2::new(0.0, 3.0), DVec2::new(5.0, 3.0))).unwrap();
    let lp = [LoopEdges { edges: &[(e[0], true), (e[1], true)], near: DVec2::ZERO }];
    let error = m.trimmed_face("ring", surface, &lp, 1e-6, style()).unwrap_err();
    assert!(matches!(error, BuildError::OpenLoop { gap, .. } if (gap - 2.0 * PI).abs() < 1e-6), "{error}");
}

#[test]
fn a_reversed_shell_has_the_opposite_volume() {
    let t = tube(12, 5, &[0.2, 0.1], DMat3::IDENTITY, DVec3::ZERO);
    let mut inside = t.solid.clone();
    inside.shells[0] = inside.shells[0].reversed();
    let integrals = t.model.face_integrals();
    let volume = t.model.solid_mass(&t.solid, &integrals).volume_mm3;
    assert_eq!(t.model.solid_mass(&inside, &integrals).volume_mm3, -volume);
    assert!(t.model.check_solid(&inside).is_sound());
}
