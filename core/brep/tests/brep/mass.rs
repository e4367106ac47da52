//! Volumes and areas against closed forms.

use crate::solids::{cuboid, polygon_mass, revolved, rotation, solid, sphere, torus, tube};
use coolinggen_brep::{Coedge, Face, Loop, face_integrals};
use coolinggen_nurbs::Curve;
use glam::{DMat3, DVec2, DVec3};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// Relative distance.
fn off(found: f64, exact: f64) -> f64 {
    (found - exact).abs() / exact.abs()
}

#[test]
fn box_volume_area_and_centroid() {
    let (origin, size) = (DVec3::new(300.0, -20.0, 7.0), DVec3::new(3.0, 4.0, 5.0));
    let (model, solid) = cuboid(origin, size);
    let mass = model.solid_mass(&solid, &model.face_integrals());
    assert!(off(mass.volume_mm3, 60.0) < 1e-12, "{}", mass.volume_mm3);
    assert!(off(mass.area_mm2, 94.0) < 1e-13);
    assert!((mass.centroid_mm - (origin + size / 2.0)).length() < 1e-10);
    assert!(mass.open_area_mm2 < 1e-12);
    assert_eq!(mass.shell_volumes_mm3, vec![mass.volume_mm3]);
}

#[test]
fn revolved_polygons_obey_pappus() {
    let tube_with_hole = [(0.0, 3.0), (10.0, 3.0), (10.0, 5.0), (0.0, 5.0)];
    let frustum = [(2.0, 1.0), (12.0, 1.0), (9.0, 6.0), (2.0, 8.0)];
    let ring = [(-1.0, 250.0), (3.0, 251.0), (2.0, 260.0), (0.5, 258.0), (-4.0, 262.0)];
    for polygon in [&tube_with_hole[..], &frustum, &ring] {
        let polygon: Vec<DVec2> = polygon.iter().map(|&(x, r)| DVec2::new(x, r)).collect();
        let (model, solid) = revolved(&polygon, true);
        let mass = model.solid_mass(&solid, &model.face_integrals());
        let (area, centroid) = polygon_mass(&polygon);
        let surface: f64 = (0..polygon.len())
            .map(|i| {
                let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
                PI * (a.y + b.y) * (b - a).length()
            })
            .sum();
        assert!(off(mass.volume_mm3, TAU * centroid.y * area) < 1e-12, "{}", mass.volume_mm3);
        assert!(off(mass.area_mm2, surface) < 1e-12);
        assert!((mass.centroid_mm.y.hypot(mass.centroid_mm.z)) < 1e-10);
        assert!(mass.open_area_mm2 < 1e-10);
    }
}

#[test]
fn cylinder_and_cone_faces_have_their_area_and_centroid() {
    let polygon = [(0.0, 3.0), (10.0, 3.0), (10.0, 5.0), (0.0, 7.0)].map(|(x, r)| DVec2::new(x, r));
    let (model, _) = revolved(&polygon, true);
    // Half cylinder r = 3: the centroid lies at 2 r / pi from the axis.
    let f = face_integrals(&model.faces[0]);
    assert!(off(f.area_mm2, PI * 30.0) < 1e-13);
    assert!((f.centroid_mm - DVec3::new(5.0, 6.0 / PI, 0.0)).length() < 1e-13);
    // Half frustum.
    let f = face_integrals(&model.faces[4]);
    assert!(off(f.area_mm2, PI * 6.0 * 104f64.sqrt()) < 1e-13);
}

#[test]
fn rational_torus() {
    let (great, small) = (7.0, 2.0);
    let shift = DVec3::new(12.0, -30.0, 5.0);
    let (model, solid) = torus(great, small, rotation(0.3, 1.1, -0.4), shift);
    let mass = model.solid_mass(&solid, &model.face_integrals());
    assert!(off(mass.volume_mm3, 2.0 * PI * PI * great * small * small) < 1e-12, "{}", mass.volume_mm3);
    assert!(off(mass.area_mm2, 4.0 * PI * PI * great * small) < 1e-12);
    assert!((mass.centroid_mm - shift).length() < 1e-11);
}

#[test]
fn rational_sphere_with_poles() {
    let center = DVec3::new(1.0, 2.0, 3.0);
    let (model, solid) = sphere(5.0, center);
    let mass = model.solid_mass(&solid, &model.face_integrals());
    assert!(off(mass.volume_mm3, 4.0 / 3.0 * PI * 125.0) < 1e-12, "{}", mass.volume_mm3);
    assert!(off(mass.area_mm2, 4.0 * PI * 25.0) < 1e-12);
    assert!((mass.centroid_mm - center).length() < 1e-12);
}

#[test]
fn a_void_counts_negative() {
    let (mut model, outer) = cuboid(DVec3::ZERO, DVec3::splat(10.0));
    let (inner, _) = cuboid(DVec3::splat(3.0), DVec3::splat(2.0));
    // The void's faces, moved into the model.
    let (v, e, f) = (model.vertices.len(), model.edges.len(), model.faces.len());
    model.vertices.extend(inner.vertices);
    for mut edge in inner.edges {
        (edge.start.0, edge.end.0) = (edge.start.0 + v, edge.end.0 + v);
        model.edges.push(edge);
    }
    for mut face in inner.faces {
        face.name = format!("void/{}", face.name);
        face.loops.iter_mut().flat_map(|l| &mut l.coedges).for_each(|c| c.edge.0 += e);
        model.faces.push(face);
    }
    let mut both = outer;
    let void: Vec<_> = (f..f + 6).map(|i| (coolinggen_brep::FaceId(i), false)).collect();
    both.shells.push(solid("void", &void, 0).shells.remove(0));
    assert!(model.check_solid(&both).is_sound(), "{:?}", model.check_solid(&both).faults);
    let mass = model.solid_mass(&both, &model.face_integrals());
    assert!((mass.volume_mm3 - 992.0).abs() < 1e-10);
    assert!((mass.shell_volumes_mm3[1] + 8.0).abs() < 1e-10);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn moving_a_tube_moves_its_centroid_alone(
        wave in proptest::collection::vec(-0.6f64..0.6, 3),
        angles in proptest::array::uniform3(-3.0f64..3.0),
        shift in proptest::array::uniform3(-100.0f64..100.0),
    ) {
        let still = tube(12, 5, &wave, DMat3::IDENTITY, DVec3::ZERO);
        let (turn, shift) = (rotation(angles[0], angles[1], angles[2]), DVec3::from(shift));
        let moved = tube(12, 5, &wave, turn, shift);
        let a = still.model.solid_mass(&still.solid, &still.model.face_integrals());
        let b = moved.model.solid_mass(&moved.solid, &moved.model.face_integrals());
        prop_assert!(a.volume_mm3 > 500.0);
        prop_assert!(off(b.volume_mm3, a.volume_mm3) < 1e-12, "{} {}", a.volume_mm3, b.volume_mm3);
        prop_assert!(off(b.area_mm2, a.area_mm2) < 1e-12);
        prop_assert!((b.centroid_mm - turn * a.centroid_mm - shift).length() < 1e-9);
        prop_assert!(b.open_area_mm2 < 1e-10);
    }

    /// Both parts of a tube cut along a section share a face.
    #[test]
    fn parts_of_a_tube_make_up_the_tube(wave in proptest::collection::vec(-0.6f64..0.6, 3)) {
        let t = tube(12, 5, &wave, DMat3::IDENTITY, DVec3::new(3.0, -20.0, 8.0));
        let integrals = t.model.face_integrals();
        let whole = t.model.solid_mass(&t.solid, &integrals);
        // The third section of five lies in its plane.
        let cut = |low: f64, high: f64, face: &Face| Face {
            loops: vec![rectangle(DVec2::new(0.0, low), DVec2::new(1.0, high))],
            ..face.clone()
        };
        let mut parts = t.model.clone();
        let mut ids = Vec::new();
        for (low, high) in [(0.0, 0.5), (0.5, 1.0)] {
            for wall in t.walls {
                ids.push(parts.add_face(cut(low, high, t.model.face(wall))));
            }
        }
        let shared = {
            let mut face = t.model.face(t.caps[0]).clone();
            let coolinggen_brep::SurfaceGeometry::Plane(plane) = &mut face.surface else { unreachable!() };
            plane.origin.z += 10.0;
            let origin = plane.origin;
            for (half, coedge) in face.loops[0].coedges.iter_mut().enumerate() {
                let coolinggen_brep::SurfaceGeometry::BSpline(s) = &t.model.face(t.walls[half]).surface else {
                    unreachable!()
                };
                coedge.pcurve = s.iso_v(0.5).map(|p| (*p - origin).truncate());
            }
            parts.add_face(face)
        };
        let integrals = parts.face_integrals();
        let lower = solid("lower", &[(ids[0], true), (ids[1], true), (t.caps[0], false), (shared, true)], 0);
        let upper = solid("upper", &[(ids[2], true), (ids[3], true), (shared, false), (t.caps[1], true)], 0);
        let (lower, upper) = (parts.solid_mass(&lower, &integrals), parts.solid_mass(&upper, &integrals));
        prop_assert!(off(lower.volume_mm3 + upper.volume_mm3, whole.volume_mm3) < 1e-12);
        prop_assert!(lower.open_area_mm2 < 1e-10 && upper.open_area_mm2 < 1e-10);
        let centroid = (lower.centroid_mm * lower.volume_mm3 + upper.centroid_mm * upper.volume_mm3) / whole.volume_mm3;
        prop_assert!((centroid - whole.centroid_mm).length() < 1e-10);
    }
}

/// A loop round a rectangle of the parameter plane; its edges do not matter.
fn rectangle(low: DVec2, high: DVec2) -> Loop {
    let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    let coedges = (0..4)
        .map(|i| Coedge {
            edge: coolinggen_brep::EdgeId(0),
            forward: true,
            pcurve: Curve::segment(corners[i], corners[(i + 1) % 4]),
        })
        .collect();
    Loop { coedges }
}
