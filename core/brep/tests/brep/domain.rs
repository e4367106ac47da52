//! Points in faces, and points spread over faces.

use crate::solids::{revolved, sphere, style, tube};
use coolinggen_brep::{Coedge, EdgeId, Face, FaceDomain, Loop, Plane, signed_area};
use coolinggen_nurbs::{Curve, ParametricCurve, ParametricSurface, interpolate_closed};
use glam::{DMat3, DVec2, DVec3};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// A closed curve round `center`, cut into two coedges, one of them against its edge.
fn blob(n: usize, center: DVec2, radius: f64, wave: &[f64]) -> (Loop, Curve<DVec2>) {
    let t: Vec<f64> = (0..=n).map(|i| i as f64).collect();
    let points: Vec<DVec2> = (0..=n)
        .map(|i| {
            let a = TAU * (i % n) as f64 / n as f64;
            let r = 1.0 + wave.iter().enumerate().map(|(k, w)| w * ((k + 2) as f64 * a).cos()).sum::<f64>();
            center + DVec2::from_angle(a) * (radius * r)
        })
        .collect();
    let whole = interpolate_closed(&t, &points).unwrap();
    let coedges = vec![Coedge { edge: EdgeId(0), forward: false, pcurve: whole.reversed() }];
    (Loop { coedges }, whole)
}

fn plane_face(loops: Vec<Loop>) -> Face {
    let plane = Plane { origin: DVec3::ZERO, x: DVec3::X, y: DVec3::Y };
    Face { name: "face".into(), surface: plane.into(), loops, style: style() }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn points_beside_a_loop_are_told_apart(
        n in 4usize..60,
        wave in proptest::collection::vec(-0.12f64..0.12, 3),
        times in proptest::collection::vec(0.0f64..1.0, 50),
    ) {
        let center = DVec2::new(0.3, -0.7);
        let (outer, curve) = blob(n, center, 3.0, &wave);
        let (hole, inner) = blob(n, center, 1.0, &wave);
        let face = plane_face(vec![outer, hole.reversed()]);
        let domain = FaceDomain::new(&face);
        prop_assert!(!domain.contains(center));
        for t in times.iter().map(|t| t * n as f64).chain((0..=n).map(|i| i as f64)) {
            for (curve, out_is_in) in [(&curve, false), (&inner, true)] {
                let [p, d, _] = curve.derivatives(t);
                let outwards = -d.perp().normalize();
                prop_assert_eq!(domain.contains(p + outwards * 1e-9), out_is_in);
                prop_assert_eq!(domain.contains(p - outwards * 1e-9), !out_is_in);
            }
        }
        // Levels of knots are where a ray could slip through.
        for i in 0..n {
            let level = curve.point(i as f64).y;
            prop_assert!(!domain.contains(DVec2::new(-50.0, level)));
            prop_assert!(!domain.contains(DVec2::new(face.loops[0].coedges[0].parameter_at(0.0).x - 20.0, level)));
        }
    }

    #[test]
    fn shares_of_samples_are_shares_of_area(
        wave in proptest::collection::vec(-0.12f64..0.12, 3),
        cut in -1.5f64..1.5,
    ) {
        let (outer, _) = blob(24, DVec2::ZERO, 3.0, &wave);
        let (hole, _) = blob(24, DVec2::ZERO, 1.0, &wave);
        let area = signed_area(&outer) - signed_area(&hole);
        let face = plane_face(vec![outer, hole.reversed()]);
        let domain = FaceDomain::new(&face);
        let samples: Vec<DVec2> = domain.samples(2000).collect();
        prop_assert_eq!(samples.len(), 2000);
        let left = samples.iter().filter(|p| p.x < cut).count() as f64 / 2000.0;
        // The share by dense counting.
        let (mut inside, mut total) = (0.0, 0.0);
        for i in 0..200 {
            for j in 0..200 {
                let p = DVec2::new(f64::from(i) - 99.5, f64::from(j) - 99.5) * 0.045;
                if domain.contains(p) {
                    total += 1.0;
                    inside += f64::from(u8::from(p.x < cut));
                }
            }
        }
        prop_assert!((total * 0.045 * 0.045 / area - 1.0).abs() < 0.01);
        prop_assert!((left - inside / total).abs() < 0.015, "{left} {}", inside / total);
        // Far from as close as random points come.
        let mut nearest = f64::INFINITY;
        for i in 0..500 {
            for j in 0..i {
                nearest = nearest.min(samples[i].distance(samples[j]));
            }
        }
        prop_assert!(nearest > 0.2 * (area / 500.0).sqrt(), "{nearest}");
    }
}

#[test]
fn samples_of_a_pole_are_even_on_the_sphere() {
    let (model, _) = sphere(5.0, DVec3::ZERO);
    for face in &model.faces {
        let domain = FaceDomain::new(face);
        let heights: Vec<f64> =
            domain.samples(1000).map(|at| face.surface.point(at.x, at.y).z.abs() / 5.0).collect();
        assert_eq!(heights.len(), 1000);
        // Archimedes: equal heights, equal areas.
        for k in 1..10 {
            let share = heights.iter().filter(|&&z| z < 0.1 * f64::from(k)).count() as f64 / 1000.0;
            assert!((share - 0.1 * f64::from(k)).abs() < 0.02, "{k}: {share}");
        }
    }
}

#[test]
fn turns_of_theta_do_not_matter() {
    let polygon = [(0.0, 3.0), (10.0, 3.0), (10.0, 5.0)].map(|(x, r)| DVec2::new(x, r));
    let (model, _) = revolved(&polygon, true);
    let halves = [&model.faces[0], &model.faces[1]].map(FaceDomain::new);
    for k in -3..=3 {
        for (i, theta) in [0.1, 3.0, 3.3, 6.2].into_iter().enumerate() {
            let at = DVec2::new(theta + TAU * f64::from(k), 0.5);
            assert_eq!(halves[0].contains(at), i < 2, "{theta}");
            assert_eq!(halves[1].contains(at), i >= 2, "{theta}");
        }
        assert!(!halves[0].contains(DVec2::new(PI * 0.5 + TAU * f64::from(k), 1.1)));
    }
}

#[test]
fn the_same_samples_every_time() {
    let t = tube(12, 5, &[0.2, 0.1], DMat3::IDENTITY, DVec3::ZERO);
    let domain = FaceDomain::new(t.model.face(t.walls[1]));
    let once: Vec<DVec2> = domain.samples(50).collect();
    assert_eq!(once, domain.samples(50).collect::<Vec<_>>());
    assert_eq!(once[..20], domain.samples(20).collect::<Vec<_>>());
    let (low, high) = domain.bounds();
    assert!(once.iter().all(|p| p.cmpge(low).all() && p.cmple(high).all()));
}

#[test]
fn signed_areas() {
    let corners = [(0.0, 0.0), (3.0, 0.0), (3.0, 2.0), (0.0, 2.0)].map(|(u, v)| DVec2::new(u, v));
    let side = |i: usize| Coedge {
        edge: EdgeId(0),
        forward: true,
        pcurve: Curve::segment(corners[i], corners[(i + 1) % 4]),
    };
    let lp = Loop { coedges: (0..4).map(side).collect() };
    assert_eq!(signed_area(&lp), 6.0);
    assert_eq!(signed_area(&lp.reversed()), -6.0);
    assert_eq!(signed_area(&Loop::default()), 0.0);
    let empty = plane_face(Vec::new());
    assert!(!FaceDomain::new(&empty).contains(DVec2::ZERO));
    assert_eq!(FaceDomain::new(&empty).samples(5).count(), 0);
}
