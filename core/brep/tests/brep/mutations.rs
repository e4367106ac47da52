//! Models with anything wrong in them: every question gets an answer, none a panic.

use crate::solids::{cuboid, revolved, sphere, tube};
use coolinggen_brep::{EdgeId, FaceDomain, FaceId, Model, Solid, VertexId};
use coolinggen_nurbs::Curve;
use glam::{DMat3, DVec2, DVec3};
use proptest::prelude::*;

fn base(kind: usize) -> (Model, Solid) {
    match kind {
        0 => cuboid(DVec3::splat(-3.0), DVec3::new(1.0, 2.0, 3.0)),
        1 => revolved(&[(0.0, 3.0), (10.0, 3.0), (10.0, 5.0)].map(|(x, r)| DVec2::new(x, r)), false),
        2 => sphere(5.0, DVec3::X),
        _ => {
            let t = tube(8, 4, &[0.2, 0.1], DMat3::IDENTITY, DVec3::ZERO);
            (t.model, t.solid)
        }
    }
}

fn mutate(model: &mut Model, solid: &mut Solid, what: usize, at: usize, value: f64) {
    let (faces, edges) = (model.faces.len(), model.edges.len());
    let face = &mut model.faces[at % faces];
    let count = face.loops.first().map_or(0, |l| l.coedges.len());
    let uses = solid.shells.first().map_or(0, |s| s.faces.len());
    match what {
        0 => model.vertices[at % 4] = DVec3::splat(if value > 500.0 { f64::NAN } else { value }),
        1 => model.edges[at % edges].start = VertexId(at % 7 * 5),
        2 => model.edges[at % edges].end = VertexId(at % 7),
        3 => face.loops.clear(),
        4 => face.loops.push(Default::default()),
        5 => face.loops.extend(face.loops.clone()),
        6 => face.name = "box".into(),
        7 if uses > 0 => solid.shells[0].faces.truncate(at % uses),
        8 if uses > 0 => solid.shells[0].faces[at % uses].face = FaceId(at % 9),
        9 => solid.shells.extend(solid.shells.clone()),
        10 => solid.shells.clear(),
        _ if count == 0 => {}
        11 => face.loops[0].coedges.swap(0, at % count),
        12 => face.loops[0].coedges[at % count].forward ^= true,
        13 => face.loops[0].coedges[at % count].edge = EdgeId(at % 30),
        14 => face.loops[0].coedges.truncate(at % count),
        _ => {
            let pcurve = &mut face.loops[0].coedges[at % count].pcurve;
            *pcurve = match what {
                15 => pcurve.reparameterized(value, value + 1.0),
                16 => pcurve.reversed(),
                17 => Curve::segment(DVec2::new(value, -value), DVec2::new(-3.0, value)),
                18 => pcurve.map(|_| DVec2::splat(value)),
                _ => pcurve.map(|p| *p * value),
            };
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]
    #[test]
    fn nothing_panics(
        kind in 0usize..4,
        mutations in proptest::collection::vec((0usize..20, 0usize..1000, -1e3f64..1e3), 1..5),
    ) {
        let (mut model, mut solid) = base(kind);
        for (what, at, value) in mutations {
            mutate(&mut model, &mut solid, what, at, value);
        }
        let check = model.check_solid(&solid);
        prop_assert!(!check.watertight || check.faults.iter().all(|f| !f.to_string().is_empty()));
        let integrals = model.face_integrals();
        model.solid_mass(&solid, &integrals);
        model.solid_bounds(&solid);
        for face in &model.faces {
            model.face_bounds(face);
            FaceDomain::new(face).samples(3).count();
        }
    }
}
