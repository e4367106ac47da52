//! Sound solids pass, broken ones are told what is wrong with them.

use crate::solids::{cuboid, revolved, rotation, solid, sphere, torus, tube};
use coolinggen_brep::{EDGE_TOLERANCE_MM, Fault, LoopEdges, Model, Plane, Solid, SurfaceGeometry};
use coolinggen_nurbs::Curve;
use glam::{DMat3, DVec2, DVec3};
use proptest::prelude::*;

fn ring() -> (Model, Solid) {
    let polygon = [(0.0, 3.0), (10.0, 3.0), (10.0, 5.0), (0.0, 7.0)].map(|(x, r)| DVec2::new(x, r));
    revolved(&polygon, false)
}

#[test]
fn sound_solids_are_sound() {
    let solids = [
        cuboid(DVec3::splat(-3.0), DVec3::new(1.0, 2.0, 3.0)),
        ring(),
        torus(7.0, 2.0, rotation(0.3, 1.1, -0.4), DVec3::X),
        sphere(5.0, DVec3::new(1.0, 2.0, 3.0)),
    ];
    for ((model, solid), genus) in solids.into_iter().zip([0, 1, 1, 0]) {
        let check = model.check_solid(&solid);
        assert!(check.is_sound() && check.watertight, "{}: {:?}", solid.name, check.faults);
        assert_eq!(check.genus_found, Some(genus));
        assert!(check.max_vertex_gap_mm < 1e-14, "{}", check.max_vertex_gap_mm);
        assert!(check.max_edge_deviation_mm < 2e-7, "{} {}", solid.name, check.max_edge_deviation_mm);
        assert!(check.max_edge_distance_mm <= check.max_edge_deviation_mm);
    }
}

#[test]
fn deviation_and_distance_are_told_apart() {
    let (mut model, solid) = ring();
    let before = model.check_solid(&solid);
    // A straight parameter curve on an arc: right place, wrong pace.
    let face = solid.shells[0].faces[0].face;
    let arc = &mut model.faces[face.0].loops[0].coedges[0];
    let (edge, points) = (arc.edge, arc.pcurve.points());
    arc.pcurve = Curve::segment(points[0], points[points.len() - 1]);
    let check = model.check_solid(&solid);
    assert!(check.max_edge_deviation_mm > 1e-3, "{}", check.max_edge_deviation_mm);
    let place = check.max_edge_deviation_at.unwrap();
    assert_eq!((place.face, place.edge), (face, edge));
    // Along the normal there is only the second-order part.
    let expected = check.max_edge_deviation_mm.powi(2) / (2.0 * 3.0);
    assert!(check.max_edge_distance_mm < 1.1 * expected, "{}", check.max_edge_distance_mm);
    assert!(before.max_edge_distance_mm < 1e-12, "{}", before.max_edge_distance_mm);
    assert!(!check.watertight);
    assert!(matches!(&check.faults[..], [Fault::EdgeDeviation { deviation_mm, .. }] if *deviation_mm > 1e-3));
}

#[test]
fn a_moved_control_point_is_found() {
    for step in [1e-9, 1e-7, 1e-5] {
        let mut t = tube(20, 5, &[0.3, 0.1, -0.2], DMat3::IDENTITY, DVec3::ZERO);
        assert!(t.model.check_solid(&t.solid).max_edge_deviation_mm < 1e-12);
        let SurfaceGeometry::BSpline(s) = &t.model.face(t.walls[0]).surface else { unreachable!() };
        let (nu, nv) = s.counts();
        let (ku, kv) = (s.knots_u().clone(), s.knots_v().clone());
        let mut net = s.points().to_vec();
        // In the middle of the lower border, outwards.
        net[(nu / 2) * nv].x += step;
        net[(nu / 2) * nv].y += step;
        t.model.faces[t.walls[0].0].surface = coolinggen_nurbs::Surface::new(ku, kv, net).unwrap().into();
        let check = t.model.check_solid(&t.solid);
        // The basis function's peak is 2/3, at a knot, and samples are between knots.
        let exact = step * 2f64.sqrt() * 2.0 / 3.0;
        assert!(
            (check.max_edge_deviation_mm / exact - 1.0).abs() < 0.03,
            "{} {exact}",
            check.max_edge_deviation_mm
        );
        assert_eq!(check.max_edge_deviation_at.unwrap().face, t.walls[0]);
        assert_eq!(check.watertight, check.max_edge_deviation_mm <= EDGE_TOLERANCE_MM);
    }
}

/// Each case breaks the box in one way and must be told so.
#[test]
fn faults_are_named() {
    type Break = fn(&mut Model, &mut Solid);
    type Expected = fn(&Fault) -> bool;
    let cases: [(&str, Break, Expected); 14] = [
        (
            "face missing",
            |_, s| s.shells[0].faces.truncate(5),
            |f| matches!(f, Fault::EdgeUses { faces, .. } if faces.len() == 1),
        ),
        (
            "face turned",
            |_, s| s.shells[0].faces[2].forward = false,
            |f| matches!(f, Fault::EdgeSense { faces, .. } if faces.contains(&"front".to_string())),
        ),
        (
            "face twice",
            |_, s| {
                let f = s.shells[0].faces[0];
                s.shells[0].faces.push(f);
            },
            |f| matches!(f, Fault::FaceUsedTwice { face } if face == "bottom"),
        ),
        (
            "name twice",
            |m, _| m.faces[1].name = "bottom".into(),
            |f| matches!(f, Fault::Name { name, count: 2 } if name == "bottom"),
        ),
        (
            "no name",
            |m, _| m.faces[1].name.clear(),
            |f| matches!(f, Fault::Name { name, count: 1 } if name.is_empty()),
        ),
        (
            "loop broken",
            |m, _| m.faces[3].loops[0].coedges.swap(0, 1),
            |f| matches!(f, Fault::OpenLoop { face, index: 0, .. } if face == "back"),
        ),
        (
            "loop turned",
            |m, _| m.faces[3].loops[0] = m.faces[3].loops[0].clone().reversed(),
            |f| matches!(f, Fault::LoopSense { face, index: 0, .. } if face == "back"),
        ),
        (
            "loop empty",
            |m, _| m.faces[3].loops[0].coedges.clear(),
            |f| matches!(f, Fault::EmptyLoop { face, index: 0 } if face == "back"),
        ),
        (
            "vertex moved",
            |m, _| m.vertices[0].x += 1e-6,
            |f| matches!(f, Fault::VertexGap { gap_mm, .. } if (*gap_mm - 1e-6).abs() < 1e-12),
        ),
        (
            "pcurve moved",
            |m, _| {
                let c = &mut m.faces[5].loops[0].coedges[1];
                c.pcurve = c.pcurve.map(|p| *p + DVec2::new(0.0, 1e-3));
            },
            |f| matches!(f, Fault::EdgeDeviation { face, deviation_mm, .. } if face == "right" && (*deviation_mm - 1e-3).abs() < 1e-9),
        ),
        (
            "pcurve's domain",
            |m, _| {
                let c = &mut m.faces[5].loops[0].coedges[1];
                c.pcurve = c.pcurve.reparameterized(0.0, 2.0);
            },
            |f| matches!(f, Fault::PcurveDomain { face, .. } if face == "right"),
        ),
        (
            "no such edge",
            |m, _| m.faces[0].loops[0].coedges[0].edge.0 = 99,
            |f| matches!(f, Fault::NoEdge { face, .. } if face == "bottom"),
        ),
        (
            "no such face",
            |_, s| s.shells[0].faces[1].face.0 = 99,
            |f| matches!(f, Fault::NoFace { index: 99 }),
        ),
        ("genus", |_, s| s.expected_genus = 2, |f| matches!(f, Fault::Genus { found: Some(0), expected: 2 })),
    ];
    for (what, break_it, expected) in cases {
        let (mut model, mut solid) = cuboid(DVec3::ZERO, DVec3::ONE);
        break_it(&mut model, &mut solid);
        let check = model.check_solid(&solid);
        assert!(check.faults.iter().any(expected), "{what}: {:?}", check.faults);
        let harmless = ["name twice", "no name", "loop turned", "genus"];
        assert_eq!(
            check.watertight,
            harmless[..2].contains(&what) || what == "genus",
            "{what}: {:?}",
            check.faults
        );
        assert!(check.faults.iter().all(|f| !f.to_string().is_empty()));
    }
}

/// Two boxes that share nothing, an edge, or a vertex.
#[test]
fn boxes_that_touch_are_no_solid() {
    let (mut model, _) = cuboid(DVec3::ZERO, DVec3::ONE);
    let (other, _) = cuboid(DVec3::ONE, DVec3::ONE);
    let (e, f) = (model.edges.len(), model.faces.len());
    // Corner 7 of the first is corner 0 of the second.
    let map = |i: usize| if i == 0 { 7 } else { i + 7 };
    model.vertices.extend(&other.vertices[1..]);
    for mut edge in other.edges {
        (edge.start.0, edge.end.0) = (map(edge.start.0), map(edge.end.0));
        model.edges.push(edge);
    }
    for mut face in other.faces {
        face.name = format!("other/{}", face.name);
        face.loops.iter_mut().flat_map(|l| &mut l.coedges).for_each(|c| c.edge.0 += e);
        model.faces.push(face);
    }
    let faces: Vec<_> = (0..2 * f).map(|i| (coolinggen_brep::FaceId(i), true)).collect();
    let check = model.check_solid(&solid("both", &faces, 0));
    assert!(check.faults.iter().any(|f| matches!(f, Fault::PartedShell { faces, .. } if faces.len() == 2)));
    assert_eq!(check.genus_found, None);
    assert!(!check.watertight);
}

#[test]
fn a_plate_with_a_hole_has_genus_one() {
    // A prism with a prismatic hole: caps with inner loops, edges shared all round.
    let mut m = Model::default();
    let ring = |m: &mut Model, r: f64, z: f64| -> Vec<_> {
        (0..3)
            .map(|i| m.add_vertex(DVec2::from_angle(2.1 * f64::from(i)).extend(0.0) * r + DVec3::Z * z))
            .collect()
    };
    let mut faces = Vec::new();
    let mut loops = [Vec::new(), Vec::new()];
    for (k, r) in [5.0, 2.0].into_iter().enumerate() {
        let rings = [ring(&mut m, r, 0.0), ring(&mut m, r, 1.0)];
        let seg = crate::solids::segment;
        let flat = [0, 1]
            .map(|z| (0..3).map(|i| seg(&mut m, rings[z][i], rings[z][(i + 1) % 3])).collect::<Vec<_>>());
        let up: Vec<_> = (0..3).map(|i| seg(&mut m, rings[0][i], rings[1][i])).collect();
        for i in 0..3 {
            let (a, b) = (m.vertex(rings[0][i]), m.vertex(rings[0][(i + 1) % 3]));
            let plane = Plane { origin: a, x: (b - a).normalize(), y: DVec3::Z };
            let lp = [(flat[0][i], true), (up[(i + 1) % 3], true), (flat[1][i], false), (up[i], false)];
            let lp = [LoopEdges { edges: &lp, near: DVec2::ZERO }];
            let id =
                m.trimmed_face(format!("side/{k}/{i}"), plane, &lp, 1e-12, crate::solids::style()).unwrap();
            faces.push((id, k == 0));
        }
        for z in 0..2 {
            loops[z].push(flat[z].iter().map(|&e| (e, true)).collect::<Vec<_>>());
        }
    }
    for (z, name) in ["bottom", "top"].into_iter().enumerate() {
        let plane = Plane { origin: DVec3::Z * z as f64, x: DVec3::X, y: DVec3::Y };
        let lp: Vec<_> = loops[z].iter().map(|edges| LoopEdges { edges, near: DVec2::ZERO }).collect();
        faces.push((m.trimmed_face(name, plane, &lp, 1e-12, crate::solids::style()).unwrap(), z == 1));
    }
    let plate = solid("plate", &faces, 1);
    let check = m.check_solid(&plate);
    assert!(check.is_sound(), "{:?}", check.faults);
    assert_eq!(check.genus_found, Some(1));
    let area = |r: f64| {
        let p: Vec<DVec2> = (0..3).map(|i| DVec2::from_angle(2.1 * f64::from(i)) * r).collect();
        crate::solids::polygon_mass(&p).0
    };
    let mass = m.solid_mass(&plate, &m.face_integrals());
    assert!((mass.volume_mm3 - (area(5.0) - area(2.0))).abs() < 1e-12);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn random_tubes_are_sound(
        wave in proptest::collection::vec(-0.6f64..0.6, 3),
        angles in proptest::array::uniform3(-3.0f64..3.0),
        n in 4usize..40,
    ) {
        let t = tube(n, 5, &wave, rotation(angles[0], angles[1], angles[2]), DVec3::new(300.0, 0.0, -6300.0));
        let check = t.model.check_solid(&t.solid);
        prop_assert!(check.is_sound(), "{:?}", check.faults);
        prop_assert!(check.max_edge_deviation_mm < 1e-10);
    }
}
