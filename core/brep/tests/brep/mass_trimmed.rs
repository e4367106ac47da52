//! Integrals over faces with curved parameter curves and holes.

use crate::solids::style;
use coolinggen_brep::{
    Coedge, EdgeId, Face, FaceIntegrals, Loop, Plane, Revolution, SurfaceGeometry, face_integrals,
    signed_area,
};
use coolinggen_nurbs::{
    Curve, Homogeneous, Interpolator, Knots, ParametricCurve, RationalSurface, Surface, interpolate_closed,
};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::f64::consts::TAU;

pub(crate) fn coedge(pcurve: Curve<DVec2>) -> Coedge {
    Coedge { edge: EdgeId(0), forward: true, pcurve }
}

/// A closed curve, counterclockwise, of mean radius `radius` with `n` spans.
pub(crate) fn blob(n: usize, center: DVec2, radius: f64, wave: &[f64]) -> Loop {
    let t: Vec<f64> = (0..=n).map(|i| i as f64).collect();
    let points: Vec<DVec2> = (0..=n)
        .map(|i| {
            let a = TAU * (i % n) as f64 / n as f64;
            let r = 1.0 + wave.iter().enumerate().map(|(k, w)| w * ((k + 2) as f64 * a).cos()).sum::<f64>();
            center + DVec2::from_angle(a) * (radius * r)
        })
        .collect();
    Loop { coedges: vec![coedge(interpolate_closed(&t, &points).unwrap())] }
}

/// The surface over `knots` whose control points are `f` of their Greville abscissae.
fn greville(knots_u: &Knots, knots_v: &Knots, f: impl Fn(f64, f64) -> DVec3) -> Surface<DVec3> {
    let (gu, gv) = (knots_u.greville(), knots_v.greville());
    let points = gu.iter().flat_map(|&u| gv.iter().map(move |&v| (u, v))).map(|(u, v)| f(u, v)).collect();
    Surface::new(knots_u.clone(), knots_v.clone(), points).unwrap()
}

fn knots(degree: usize, gaps: &[f64]) -> Knots {
    let mut breaks = vec![0.0];
    for g in gaps {
        breaks.push(breaks[breaks.len() - 1] + g);
    }
    let end = breaks[breaks.len() - 1];
    breaks.iter_mut().for_each(|b| *b *= 10.0 / end);
    Knots::clamped(degree, &breaks).unwrap()
}

pub(crate) fn face(surface: impl Into<SurfaceGeometry>, loops: Vec<Loop>) -> Face {
    Face { name: "face".into(), surface: surface.into(), loops, style: style() }
}

pub(crate) fn assert_close(a: &FaceIntegrals, b: &FaceIntegrals, tolerance: f64) {
    assert_areas_close(a, b, tolerance);
    assert_volumes_close(a, b, tolerance);
}

/// What has a root in its integrand.
pub(crate) fn assert_areas_close(a: &FaceIntegrals, b: &FaceIntegrals, tolerance: f64) {
    let off = (a.area_mm2 - b.area_mm2).abs() / b.area_mm2;
    assert!(off < tolerance, "area {} {}", a.area_mm2, b.area_mm2);
    let off = (a.centroid_mm - b.centroid_mm).length() / (1.0 + b.centroid_mm.length());
    assert!(off < tolerance, "{a:?} {b:?}");
}

/// What has a polynomial for an integrand, on surfaces that are not rational.
pub(crate) fn assert_volumes_close(a: &FaceIntegrals, b: &FaceIntegrals, tolerance: f64) {
    let size = b.area_mm2 * (1.0 + b.centroid_mm.length());
    assert!((a.flux_mm3 - b.flux_mm3).abs() < tolerance * size, "flux {} {}", a.flux_mm3, b.flux_mm3);
    assert!((a.vector_area_mm2 - b.vector_area_mm2).length() < tolerance * b.area_mm2);
    let size = size * (1.0 + b.centroid_mm.length());
    assert!((a.moment_mm4 - b.moment_mm4).length() < tolerance * size);
}

/// Loops with a hole, and knots, for the tests below.
fn scene() -> impl Strategy<Value = (Vec<Loop>, Knots, Knots)> {
    let gaps = || proptest::collection::vec(0.2f64..1.0, 1..9);
    let wave = || proptest::collection::vec(-0.12f64..0.12, 3);
    (gaps(), gaps(), wave(), wave(), 6usize..60, 1usize..=4, 1usize..=4).prop_map(
        |(gu, gv, a, b, n, p, q)| {
            let outer = blob(n, DVec2::new(5.2, 4.9), 3.4, &a);
            let hole = blob(8, DVec2::new(5.5, 5.5), 1.1, &b).reversed();
            (vec![outer, hole], knots(p, &gu), knots(q, &gv))
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_flat_spline_face_is_a_plane_face((loops, ku, kv) in scene()) {
        let (origin, x, y) = (DVec3::new(50.0, -3.0, 8.0), DVec3::new(0.6, 0.8, 0.0), DVec3::new(0.0, 0.0, 1.0));
        let spline = greville(&ku, &kv, |u, v| origin + x * u + y * v);
        let flat = face_integrals(&face(Plane { origin, x, y }, loops.clone()));
        let found = face_integrals(&face(spline.clone(), loops.clone()));
        assert_close(&found, &flat, 2e-13);
        let weighted = spline.map(|&p| Homogeneous::new(p, 0.7));
        let rational = RationalSurface::from_homogeneous(weighted).unwrap();
        assert_close(&face_integrals(&face(rational, loops)), &flat, 2e-13);
    }

    #[test]
    fn a_trimmed_paraboloid_has_its_moments((loops, ku, kv) in scene()) {
        // z = u v + u^2 on the knots, exactly: by interpolation at degree 2 or more.
        let p = ku.degree().max(2);
        let (ku, kv) = (Knots::clamped(p, &ku.breaks()).unwrap(), Knots::clamped(2, &kv.breaks()).unwrap());
        // The blossom of u^2 at the knots is the mean of their products in pairs.
        let square = |k: &Knots, i: usize| {
            let (d, k) = (k.degree(), k.values());
            let s: f64 = k[i + 1..=i + d].iter().sum();
            let q: f64 = k[i + 1..=i + d].iter().map(|k| k * k).sum();
            (s * s - q) / (d * (d - 1)) as f64
        };
        let (gu, gv) = (ku.greville(), kv.greville());
        let mut net = Vec::new();
        for i in 0..gu.len() {
            for &v in &gv {
                net.push(DVec3::new(gu[i], v, gu[i] * v + square(&ku, i)));
            }
        }
        let surface = Surface::new(ku.clone(), kv.clone(), net).unwrap();
        // X . n = z - u z_u - v z_v = -z; its integral by Green with the antiderivative in u.
        let mut exact = 0.0;
        for lp in &loops {
            for c in &lp.coedges {
                let breaks = c.pcurve.breaks();
                for pair in breaks.windows(2) {
                    // Simpson on many pieces is plain, and plainly right.
                    let n = 400;
                    let f = |i: usize| {
                        let t = pair[0] + (pair[1] - pair[0]) * i as f64 / (2 * n) as f64;
                        let [p, d, _] = c.pcurve.derivatives(t);
                        (p.x * p.x * p.y / 2.0 + p.x.powi(3) / 3.0) * d.y
                    };
                    let sum: f64 = (0..n).map(|i| f(2 * i) + 4.0 * f(2 * i + 1) + f(2 * i + 2)).sum();
                    exact -= sum * (pair[1] - pair[0]) / (6 * n) as f64 * if c.forward { 1.0 } else { -1.0 };
                }
            }
        }
        let found = face_integrals(&face(surface, loops));
        assert!((found.flux_mm3 * 3.0 - exact).abs() < 1e-10 * exact.abs(), "{} {exact}", found.flux_mm3 * 3.0);
    }

    #[test]
    fn parts_of_a_wavy_face_make_up_the_face(
        (_, ku, kv) in scene(),
        heights in proptest::collection::vec(-2.0f64..2.0, 200),
        levels in proptest::collection::vec(2.0f64..8.0, 5..20),
        lying in proptest::bool::ANY,
    ) {
        let ku = Knots::clamped(3, &ku.breaks()).unwrap();
        let kv = Knots::clamped(3, &kv.breaks()).unwrap();
        let index = std::cell::Cell::new(0);
        let surface = greville(&ku, &kv, |u, v| {
            index.set(index.get() + 1);
            DVec3::new(u, v, heights[index.get() % heights.len()])
        });
        // A wavy curve from border to border.
        let n = levels.len();
        let t: Vec<f64> = (0..n).map(|i| 10.0 * i as f64 / (n - 1) as f64).collect();
        let place = |a: f64, b: f64| if lying { DVec2::new(a, b) } else { DVec2::new(b, a) };
        let points: Vec<DVec2> = (0..n).map(|i| place(t[i], levels[i])).collect();
        let cut = Interpolator::new(3, &t).unwrap().curve(&points).unwrap();
        let side = |a: DVec2, b: DVec2| coedge(Curve::segment(a, b));
        let (start, end) = (points[0], points[n - 1]);
        let below = vec![side(place(0.0, 0.0), place(10.0, 0.0)), side(place(10.0, 0.0), end),
            Coedge { forward: false, ..coedge(cut.clone()) }, side(start, place(0.0, 0.0))];
        let above = vec![coedge(cut), side(end, place(10.0, 10.0)), side(place(10.0, 10.0), place(0.0, 10.0)),
            side(place(0.0, 10.0), start)];
        let whole = vec![side(place(0.0, 0.0), place(10.0, 0.0)), side(place(10.0, 0.0), place(10.0, 10.0)),
            side(place(10.0, 10.0), place(0.0, 10.0)), side(place(0.0, 10.0), place(0.0, 0.0))];
        let turn = |coedges: Vec<Coedge>| {
            let lp = Loop { coedges };
            if lying { lp } else { lp.reversed() }
        };
        let [below, above, whole] = [below, above, whole].map(|c| face_integrals(&face(surface.clone(), vec![turn(c)])));
        let sum = FaceIntegrals {
            area_mm2: below.area_mm2 + above.area_mm2,
            centroid_mm: (below.centroid_mm * below.area_mm2 + above.centroid_mm * above.area_mm2) / whole.area_mm2,
            vector_area_mm2: below.vector_area_mm2 + above.vector_area_mm2,
            flux_mm3: below.flux_mm3 + above.flux_mm3,
            moment_mm4: below.moment_mm4 + above.moment_mm4,
        };
        let size = whole.area_mm2 * 10.0;
        prop_assert!((sum.flux_mm3 - whole.flux_mm3).abs() < 1e-11 * size, "{} {}", sum.flux_mm3, whole.flux_mm3);
        prop_assert!((sum.vector_area_mm2 - whole.vector_area_mm2).length() < 1e-11 * size);
        prop_assert!((sum.moment_mm4 - whole.moment_mm4).length() < 1e-10 * size, "off {:e} {:e}", (sum.moment_mm4 - whole.moment_mm4).length() / size, sum.moment_mm4.length()/size);
        // Random heights make a rough surface: the area has no polynomial integrand.
        prop_assert!((sum.area_mm2 - whole.area_mm2).abs() < 1e-3 * size);
    }

    #[test]
    fn a_trimmed_cylinder_is_a_trimmed_plane((loops, _, _) in scene(), radius in 1.0f64..300.0) {
        let meridian = Curve::segment(DVec2::new(0.0, radius), DVec2::new(10.0, radius)).reparameterized(0.0, 10.0);
        let surface = Revolution::new(meridian).unwrap();
        let area: f64 = loops.iter().map(signed_area).sum();
        let found = face_integrals(&face(surface, loops));
        prop_assert!((found.area_mm2 - area * radius).abs() < 1e-12 * found.area_mm2);
        // The normal of theta cross t points to the axis.
        prop_assert!((found.flux_mm3 + area * radius * radius / 3.0).abs() < 1e-12 * area * radius * radius);
        // On a cylinder X . n = -r, so moment and centroid tell the same.
        let moment = found.centroid_mm * found.area_mm2 * -radius / 4.0;
        prop_assert!((found.moment_mm4 - moment).length() < 1e-11 * area * radius * radius * (radius + 10.0));
    }
}

#[test]
fn a_curved_meridian_agrees_with_the_rational_sphere() {
    // A zone of a sphere, r^2 = 25 - x^2 for |x| < 3, by a fine meridian: area 2 pi R h, volume integrals alike.
    let n = 400;
    let t: Vec<f64> =
        (0..=n).map(|i| f64::from(i) / f64::from(n) * 2.0 * 0.6f64.asin() - 0.6f64.asin()).collect();
    let points: Vec<DVec2> = t.iter().map(|a| DVec2::new(5.0 * a.sin(), 5.0 * a.cos())).collect();
    let slopes = [t[0], t[n as usize]].map(|a| DVec2::new(5.0 * a.cos(), -5.0 * a.sin()));
    let meridian =
        Interpolator::with_slopes(&t).unwrap().curve_with_slopes(&points, slopes[0], slopes[1]).unwrap();
    let (start, end) = meridian.domain();
    let corners = [(0.0, start), (TAU, start), (TAU, end), (0.0, end)].map(|(u, v)| DVec2::new(u, v));
    let coedges = (0..4).map(|i| coedge(Curve::segment(corners[i], corners[(i + 1) % 4]))).collect();
    let f = face_integrals(&face(Revolution::new(meridian).unwrap(), vec![Loop { coedges }]));
    assert!((f.area_mm2 - TAU * 5.0 * 6.0).abs() < 1e-9, "{}", f.area_mm2);
    assert!((f.flux_mm3 + TAU * 5.0 * 6.0 * 5.0 / 3.0).abs() < 1e-8, "{}", f.flux_mm3);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn parts_of_a_rational_patch_make_up_the_patch(levels in proptest::collection::vec(0.2f64..0.8, 5..20)) {
        let (model, _) = crate::solids::torus(7.0, 2.0, glam::DMat3::IDENTITY, DVec3::new(3.0, 4.0, 5.0));
        let whole = &model.faces[5];
        let n = levels.len();
        let t: Vec<f64> = (0..n).map(|i| i as f64 / (n - 1) as f64).collect();
        let points: Vec<DVec2> = (0..n).map(|i| DVec2::new(t[i], levels[i])).collect();
        let cut = Interpolator::new(3, &t).unwrap().curve(&points).unwrap();
        let side = |a: (f64, f64), b: (f64, f64)| coedge(Curve::segment(DVec2::from(a), DVec2::from(b)));
        let (start, end) = ((0.0, levels[0]), (1.0, levels[n - 1]));
        let below = vec![side((0.0, 0.0), (1.0, 0.0)), side((1.0, 0.0), end),
            Coedge { forward: false, ..coedge(cut.clone()) }, side(start, (0.0, 0.0))];
        let above = vec![coedge(cut), side(end, (1.0, 1.0)), side((1.0, 1.0), (0.0, 1.0)), side((0.0, 1.0), start)];
        let [a, b] = [below, above].map(|c| face_integrals(&face(whole.surface.clone(), vec![Loop { coedges: c }])));
        let whole = face_integrals(whole);
        prop_assert!((a.area_mm2 + b.area_mm2 - whole.area_mm2).abs() < 1e-12 * whole.area_mm2);
        prop_assert!((a.flux_mm3 + b.flux_mm3 - whole.flux_mm3).abs() < 1e-12 * whole.area_mm2 * 10.0);
        prop_assert!((a.moment_mm4 + b.moment_mm4 - whole.moment_mm4).length() < 1e-12 * whole.area_mm2 * 100.0);
    }
}
