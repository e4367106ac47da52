//! Boxes against closed forms and against dense samples.

use crate::solids::{cuboid, revolved, rotation, sphere, torus, tube};
use coolinggen_brep::{FaceDomain, Model, Solid};
use coolinggen_nurbs::{ParametricCurve, ParametricSurface};
use glam::{DMat3, DVec2, DVec3};
use proptest::prelude::*;

fn assert_box(model: &Model, solid: &Solid, min: DVec3, max: DVec3) {
    let b = model.solid_bounds(solid);
    assert!((b.min - min).length() < 1e-9 && (b.max - max).length() < 1e-9, "{b:?} for {min} {max}");
    let union = solid.faces().map(|f| model.face_bounds(model.face(f.face)));
    let union = union.reduce(coolinggen_brep::Bounds::union).unwrap();
    assert!((b.min - union.min).length() < 2e-9 && (b.max - union.max).length() < 2e-9, "{b:?} {union:?}");
}

#[test]
fn boxes_of_known_solids() {
    let (model, solid) = cuboid(DVec3::splat(-3.0), DVec3::new(1.0, 2.0, 3.0));
    assert_box(&model, &solid, DVec3::splat(-3.0), DVec3::new(-2.0, -1.0, 0.0));
    let polygon = [(0.0, 3.0), (10.0, 3.0), (10.0, 5.0), (0.0, 7.0)].map(|(x, r)| DVec2::new(x, r));
    let (model, solid) = revolved(&polygon, false);
    assert_box(&model, &solid, DVec3::new(0.0, -7.0, -7.0), DVec3::new(10.0, 7.0, 7.0));
    // The inner cylinder's half alone.
    let b = model.face_bounds(&model.faces[0]);
    assert!((b.min - DVec3::new(0.0, 0.0, -3.0)).length() < 1e-9, "{b:?}");
    assert!((b.max - DVec3::new(10.0, 3.0, 3.0)).length() < 1e-9, "{b:?}");
    let center = DVec3::new(1.0, 2.0, 3.0);
    let (model, solid) = sphere(5.0, center);
    assert_box(&model, &solid, center - 5.0, center + 5.0);
}

#[test]
fn a_turned_torus_has_the_box_of_its_support_function() {
    for k in 0..20 {
        let turn = rotation(0.3 * f64::from(k), 1.1 + 0.2 * f64::from(k), -0.4 * f64::from(k));
        let (model, solid) = torus(7.0, 2.0, turn, DVec3::ZERO);
        // Support of a torus with axis a in direction e: R |e - (e.a) a| + r.
        let axis = turn.z_axis;
        let reach = DVec3::from_array([0, 1, 2].map(|i| 7.0 * (1.0 - axis[i] * axis[i]).sqrt() + 2.0));
        assert_box(&model, &solid, -reach, reach);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn boxes_of_random_tubes_are_tight(
        wave in proptest::collection::vec(-0.6f64..0.6, 3),
        angles in proptest::array::uniform3(-3.0f64..3.0),
    ) {
        let t = tube(12, 5, &wave, rotation(angles[0], angles[1], angles[2]), DVec3::new(3.0, -200.0, 40.0));
        for face in &t.model.faces {
            let b = t.model.face_bounds(face);
            let mut found = coolinggen_brep::Bounds::EMPTY;
            let domain = FaceDomain::new(face);
            for at in domain.samples(2000) {
                let p = face.surface.point(at.x, at.y);
                prop_assert!(b.contains(p, 2e-9), "{b:?} {p}");
                found.include(p);
            }
            for c in &face.loops[0].coedges {
                for i in 0..=500 {
                    let p = t.model.edge(c.edge).curve.point(f64::from(i) / 500.0);
                    prop_assert!(b.contains(p, 2e-9), "{b:?} {p}");
                    found.include(p);
                }
            }
            prop_assert!((found.min - b.min).length() < 0.05 && (found.max - b.max).length() < 0.05);
        }
    }
}

#[test]
fn the_empty_box_is_neutral() {
    let b = coolinggen_brep::Bounds { min: DVec3::ZERO, max: DVec3::ONE };
    assert_eq!(coolinggen_brep::Bounds::EMPTY.union(b), b);
    assert_eq!(b.size(), DVec3::ONE);
    let t = tube(8, 4, &[0.1], DMat3::IDENTITY, DVec3::ZERO);
    let nothing = Solid { name: "nothing".into(), shells: vec![], expected_genus: 0 };
    assert_eq!(t.model.solid_bounds(&nothing), coolinggen_brep::Bounds::EMPTY);
}
