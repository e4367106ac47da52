//! Integrals that take short ways - inside small loops, and over whole ruled faces - beside plain quadrature.

use crate::mass_trimmed::{assert_areas_close, assert_close, assert_volumes_close, blob, coedge, face};
use coolinggen_brep::{FaceIntegrals, Loop, face_integrals};
use coolinggen_nurbs::{Curve, Knots, ParametricCurve, ParametricSurface, Surface};
use glam::{DVec2, DVec3, Vec2Swizzles};
use proptest::prelude::*;

/// Gauss's rule with five points on [0, 1], over `parts` equal parts.
fn nodes(parts: usize) -> Vec<(f64, f64)> {
    let root = (10.0f64 / 7.0).sqrt();
    let [near, far] = [-1.0, 1.0].map(|sign| (5.0 + sign * 2.0 * root).sqrt() / 3.0);
    let weight = |sign: f64| (322.0 + sign * 13.0 * 70.0f64.sqrt()) / 900.0;
    let rule = [
        (0.0, 128.0 / 225.0),
        (near, weight(1.0)),
        (-near, weight(1.0)),
        (far, weight(-1.0)),
        (-far, weight(-1.0)),
    ];
    let h = 1.0 / parts as f64;
    let part = |k: usize| rule.map(|(x, w)| (h * (k as f64 + 0.5 + 0.5 * x), 0.5 * h * w));
    (0..parts).flat_map(part).collect()
}

/// Integrals inside a loop about `center`, along rays from there.
fn fan(surface: &Surface<DVec3>, lp: &Loop, center: DVec2) -> FaceIntegrals {
    let mut sums = FaceIntegrals::default();
    for c in &lp.coedges {
        for pair in c.pcurve.breaks().windows(2) {
            for (s, w) in nodes(6) {
                let [p, d, _] = c.pcurve.derivatives(pair[0] + (pair[1] - pair[0]) * s);
                let across =
                    (p - center).perp_dot(d) * w * (pair[1] - pair[0]) * if c.forward { 1.0 } else { -1.0 };
                for (part, w) in nodes(6) {
                    let q = center + (p - center) * part;
                    let (x, u, v) = surface.first_derivatives(q.x, q.y);
                    let (normal, weight) = (u.cross(v), across * part * w);
                    sums.area_mm2 += weight * normal.length();
                    sums.centroid_mm += x * (weight * normal.length());
                    sums.vector_area_mm2 += normal * weight;
                    sums.flux_mm3 += x.dot(normal) * weight / 3.0;
                    sums.moment_mm4 += x * (x.dot(normal) * weight / 4.0);
                }
            }
        }
    }
    sums.centroid_mm /= sums.area_mm2;
    sums
}

/// A bicubic patch over [0, 10] in u and v, with bumps.
fn patch(bumps: &[f64]) -> Surface<DVec3> {
    let knots = Knots::clamped(3, &[0.0, 10.0]).unwrap();
    let at = |k: usize| 10.0 * k as f64 / 3.0;
    let point = |k: usize| {
        let bump = DVec3::new(bumps[3 * k], bumps[3 * k + 1], 2.0 * bumps[3 * k + 2]);
        DVec3::new(at(k / 4), at(k % 4), 30.0) + bump
    };
    Surface::new(knots.clone(), knots, (0..16).map(point).collect()).unwrap()
}

/// The border of the rectangle [0, 1] by [0, 1].
fn border() -> Loop {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
    Loop { coedges: (0..4).map(|k| coedge(Curve::segment(corners[k], corners[(k + 1) % 4]))).collect() }
}

/// The loop with u and v exchanged, and turned round for it.
fn transposed(lp: &Loop) -> Loop {
    let swapped = |c: &coolinggen_brep::Coedge| coolinggen_brep::Coedge {
        pcurve: c.pcurve.map(|q| q.yx()),
        ..c.clone()
    };
    Loop { coedges: lp.coedges.iter().map(swapped).collect() }.reversed()
}

/// What rules of six points a span may leave of an area where bumps and rim are large.
const ROOT: f64 = 1e-4;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_rim_holds_what_rays_from_inside_sum_up(
        bumps in proptest::collection::vec(-1.0f64..1.0, 48),
        wave in proptest::collection::vec(-0.1f64..0.1, 3),
        spans in 6usize..60,
        radius in 0.05f64..1.5,
        at in (1.8f64..8.2, 1.8f64..8.2),
        clockwise in proptest::bool::ANY,
        gentle in proptest::bool::ANY,
    ) {
        // The root in the integrand of an area asks for small loops to be exact.
        let scale = if gentle { 0.4 } else { 1.0 };
        let area_tolerance = if gentle { 1e-11 } else { ROOT };
        let (bumps, radius) = (bumps.iter().map(|b| scale * b).collect::<Vec<_>>(), scale * radius);
        let (surface, center) = (patch(&bumps), DVec2::from(at));
        let mut rim = blob(spans, center, radius, &wave);
        if clockwise {
            rim = rim.reversed();
        }
        let mut exact = fan(&surface, &rim, center);
        let mut found = face_integrals(&face(surface.clone(), vec![rim.clone()]));
        // Clockwise all but the centroid is negative, and sizes are asked to be positive.
        if clockwise {
            for f in [&mut exact, &mut found] {
                f.area_mm2 = -f.area_mm2;
            }
        }
        assert_volumes_close(&found, &exact, 1e-11);
        assert_areas_close(&found, &exact, area_tolerance);
        // Knot lines through the rim change nothing.
        let lines = [center.x - 0.6 * radius, center.x + 0.1 * radius];
        let parted = surface.with_knots_inserted_u(&lines).unwrap();
        let parted = parted.with_knots_inserted_v(&[center.y - 0.3 * radius]).unwrap();
        let mut parted = face_integrals(&face(parted, vec![rim]));
        if clockwise {
            parted.area_mm2 = -parted.area_mm2;
        }
        assert_volumes_close(&parted, &found, 1e-12);
        assert_areas_close(&parted, &found, area_tolerance);
    }

    #[test]
    fn a_ruled_face_is_its_transposed(
        ends in proptest::collection::vec(-1.0f64..1.0, 36),
        twist in prop_oneof![Just(0.0), Just(1e-9), Just(1e-5), 0.01f64..1.0],
        backwards in proptest::bool::ANY,
    ) {
        // Lower and upper line a shift of each other, and turned away from that by `twist`.
        let knots = Knots::uniform(3, 6).unwrap();
        let at = |k: usize, side: usize| DVec3::from_slice(&ends[18 * side + 3 * k..]);
        let pair = |k: usize| {
            let lower = DVec3::new(2.0 * k as f64, 0.0, 20.0) + at(k, 0);
            [lower, lower + DVec3::new(1.0, 5.0, 0.5) + at(k, 1) * twist]
        };
        let surface = Surface::new(knots, Knots::uniform(1, 2).unwrap(), (0..6).flat_map(pair).collect()).unwrap();
        let lp = if backwards { border().reversed() } else { border() };
        let mut found = face_integrals(&face(surface.clone(), vec![lp.clone()]));
        let mut other = face_integrals(&face(surface.transposed(), vec![transposed(&lp)]));
        // The natural normal turns with the exchange.
        other.vector_area_mm2 = -other.vector_area_mm2;
        other.flux_mm3 = -other.flux_mm3;
        other.moment_mm4 = -other.moment_mm4;
        if backwards {
            found.area_mm2 = -found.area_mm2;
            other.area_mm2 = -other.area_mm2;
        }
        assert_close(&found, &other, if twist > 1e-3 { 1e-7 } else { 1e-8 });
        let size = found.area_mm2 * 30.0;
        prop_assert!((found.flux_mm3 - other.flux_mm3).abs() < 1e-13 * size, "{found:?} {other:?}");
        prop_assert!((found.moment_mm4 - other.moment_mm4).length() < 1e-13 * size * 30.0);
    }
}
