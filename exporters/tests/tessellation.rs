//! Meshes are closed, keep their tolerances, face outward, and do not depend on the number of threads.

mod support;

use coolinggen_brep::{Model, Plane, Style, SurfaceGeometry};
use coolinggen_exporters::{
    ExportError, KeptMeshes, Tessellation, TessellationOptions, tessellate, tessellate_again,
};
use glam::DVec3;
use proptest::prelude::*;
use support::{closed, mesh, surfaces};

fn options(chord_mm: f64, angle_deg: f64) -> TessellationOptions {
    TessellationOptions { chord_mm, angle_deg, max_edge_mm: None }
}

#[test]
fn meshes_are_closed_and_keep_the_chord() {
    let mut models = support::all();
    models.push(("bumps", surfaces::trimmed_bumps(6.0, 0.0, 0.1)));
    for (name, model) in models {
        for (chord_mm, angle_deg) in [(0.5, 60.0), (0.1, 30.0), (0.02, 15.0), (0.005, 10.0)] {
            let t = tessellate(&model, &options(chord_mm, angle_deg)).unwrap();
            assert_eq!(t.coarse, [], "{name} at {chord_mm}");
            for solid in &model.solids {
                let triangles = mesh::solid_triangles(&t, solid);
                assert_eq!(closed::open_sides(&triangles), 0, "{name} {} at {chord_mm}", solid.name);
            }
            for (face, found) in model.faces.iter().zip(mesh::inspect(&model, &t)) {
                let at = format!("{name} {} at {chord_mm}: {found:?}", face.name);
                assert!(found.distance <= chord_mm, "{at}");
                // A chord turns by half the angle at either end; twist adds to that.
                assert!(found.cosine > angle_deg.to_radians().cos(), "{at}");
            }
        }
    }
}

/// Two borders that run side by side, nearer than chords are to them, are cut so finely that no triangle between them
/// turns over.
#[test]
fn borders_near_each_other_keep_their_order() {
    for gap in [1e-4, 3e-4, 1e-3, 5e-3, 0.02, 0.3] {
        let model = surfaces::window_near_border(gap);
        for (chord_mm, angle_deg) in [(0.1, 30.0), (0.02, 15.0)] {
            let t = tessellate(&model, &options(chord_mm, angle_deg)).unwrap();
            let found = &mesh::inspect(&model, &t)[0];
            let at = format!("gap {gap} at {chord_mm}: {found:?}");
            assert_eq!(t.coarse, [], "{at}");
            assert!(found.distance <= chord_mm && found.cosine > angle_deg.to_radians().cos(), "{at}");
            assert!(found.triangles < 400, "{at}");
        }
    }
}

#[test]
fn volumes_converge_from_within_the_chord() {
    for (name, model) in support::all() {
        let volumes = |chord: f64| -> Vec<f64> {
            let t = tessellate(&model, &options(chord, 10.0)).unwrap();
            let volume = |s| closed::volume(&mesh::solid_triangles(&t, s), &t.points);
            model.solids.iter().map(volume).collect()
        };
        for (coarse, fine) in volumes(0.02).into_iter().zip(volumes(0.0005)) {
            assert!(fine > 0.0, "{name}");
            // Area times chord is far more than the difference; the shapes' areas are below 1e4 mm^2.
            assert!((coarse - fine).abs() < 0.02 * 1e4, "{name}: {coarse} {fine}");
            assert!((coarse - fine).abs() < 5e-3 * fine, "{name}: {coarse} {fine}");
        }
    }
}

#[test]
fn known_volumes() {
    for (name, solid, volume) in [
        ("box", "metal", 6000.0),
        ("void", "metal", 5680.0),
        ("saddle", "metal", 16200.0),
        ("round", "metal", 200.0 * std::f64::consts::PI),
        ("hole", "metal", 2000.0 - 10.0 / 3.0 * std::f64::consts::PI * (1.5 * 1.5 + 3.0 + 4.0)),
        ("disc", "metal", 5.0 * std::f64::consts::PI / 6.0 * 500.0),
        // OpenCASCADE's, both integration rules.
        ("cone", "coolant", 8_607.677_862),
        ("general", "metal", 9_455.000_323),
    ] {
        let model = &support::all().into_iter().find(|(n, _)| *n == name).unwrap().1;
        let t = tessellate(model, &options(1e-4, 15.0)).unwrap();
        let found = closed::volume(&mesh::solid_triangles(&t, model.solid(solid).unwrap()), &t.points);
        assert!((found - volume).abs() < 1e-4 * volume, "{name}: {found}, not {volume}");
    }
}

#[test]
fn edges_are_shared_bit_for_bit_and_keep_the_greatest_length() {
    for (name, model) in support::all() {
        let o = TessellationOptions { max_edge_mm: Some(1.5), ..options(0.1, 30.0) };
        let t = tessellate(&model, &o).unwrap();
        for (edge, polyline) in model.edges.iter().zip(&t.edges) {
            assert_eq!(polyline[0] as usize, edge.start.0);
            assert_eq!(polyline[polyline.len() - 1] as usize, edge.end.0);
            for pair in polyline.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(|i| t.points[i as usize]);
                assert!(a.distance(b) <= 1.5 * 1.1, "{name}: {}", a.distance(b));
            }
        }
        for (face, m) in model.faces.iter().zip(&t.faces) {
            for triangle in &m.triangles {
                for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                    let [a, b] = [a, b].map(|k: usize| t.points[m.points[triangle[k] as usize] as usize]);
                    // Diagonals, and gaps next to the border.
                    assert!(a.distance(b) <= 1.5 * 2.2, "{name} {}: {}", face.name, a.distance(b));
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn any_bumps_keep_the_chord(
        height in 0.0f64..9.0,
        phase in 0.0f64..6.0,
        hole in 0.005f64..0.3,
        chord_mm in 0.01f64..1.0,
        angle_deg in 10.0f64..60.0,
    ) {
        let model = surfaces::trimmed_bumps(height, phase, hole);
        let t = tessellate(&model, &options(chord_mm, angle_deg)).unwrap();
        let found = &mesh::inspect(&model, &t)[0];
        prop_assert!(found.distance <= chord_mm, "{:?}", found);
        prop_assert!(found.cosine > (2.0 * angle_deg).min(90.0).to_radians().cos(), "{:?}", found);
        // One side a border segment, two triangles an inner side.
        let m = &t.faces[0];
        let border: usize = t.edges.iter().map(|e| e.len() - 1).sum();
        let euler = m.points.len() as i64 - ((3 * m.triangles.len() + border) / 2) as i64 + m.triangles.len() as i64;
        prop_assert_eq!(euler, 0);
    }
}

#[test]
fn threads_do_not_matter() {
    let model = support::perforated::sector(3, 4);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| tessellate(&model, &options(0.02, 15.0)).unwrap())
    };
    same(&run(1), &run(4));
}

fn same(a: &Tessellation, b: &Tessellation) {
    assert_eq!(a.points, b.points);
    assert_eq!(a.edges, b.edges);
    assert_eq!(a.coarse, b.coarse);
    assert_eq!(a.faces.len(), b.faces.len());
    for (a, b) in a.faces.iter().zip(&b.faces) {
        assert_eq!(a.points, b.points);
        assert_eq!(a.parameters, b.parameters);
        assert_eq!(a.triangles, b.triangles);
        assert_eq!(a.normals, b.normals);
    }
}

/// Also where segments of edges are halved, for tilted triangles in the first rounds and for turned ones in the others.
#[test]
fn what_is_kept_does_not_matter() {
    let mut kept = KeptMeshes::default();
    let mut models: Vec<Model> = [1e-4, 3e-4, 1e-4, 1e-3, 5e-3].map(surfaces::window_near_border).into();
    models.push(support::perforated::sector(3, 4));
    models.push(surfaces::window_near_border(3e-4));
    for model in models {
        for o in [options(0.1, 30.0), options(0.02, 15.0), options(0.1, 30.0)] {
            let cold = tessellate(&model, &o).unwrap();
            same(&tessellate_again(&model, &o, &mut kept, &|| false).unwrap(), &cold);
            let made = kept.made();
            same(&tessellate_again(&model, &o, &mut kept, &|| false).unwrap(), &cold);
            assert_eq!(kept.made(), made);
        }
    }
}

#[test]
fn bad_requests_are_refused() {
    let model = support::blocks::cuboid();
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(tessellate(&model, &options(value, 15.0)), Err(ExportError::BadOption { .. })));
        assert!(matches!(tessellate(&model, &options(0.1, value)), Err(ExportError::BadOption { .. })));
    }
    let o = TessellationOptions { max_edge_mm: Some(1e-6), ..options(0.1, 15.0) };
    assert!(matches!(tessellate(&model, &o), Err(ExportError::TooLarge { .. })));
}

#[test]
fn a_loop_the_wrong_way_round_is_refused() {
    let mut model = support::blocks::cuboid();
    let bound = &mut model.faces[0].loops[0];
    bound.coedges.reverse();
    bound.coedges.iter_mut().for_each(|c| c.forward = !c.forward);
    assert!(matches!(tessellate(&model, &options(0.1, 15.0)), Err(ExportError::BadTopology { .. })));
}

#[test]
fn a_border_that_crosses_itself_is_refused() {
    let mut m = Model::default();
    let corners = [(0.0, 0.0), (9.0, 0.0), (2.0, 5.0), (8.0, 7.0)];
    let v: Vec<_> = corners.iter().map(|&(x, y)| m.add_vertex(DVec3::new(x, y, 0.0))).collect();
    let edges: Vec<_> = (0..4).map(|i| (support::line(&mut m, v[i], v[(i + 1) % 4]), true)).collect();
    let plane = Plane { origin: DVec3::ZERO, x: DVec3::X, y: DVec3::Y };
    let bound = support::plane_loop(&m, &plane, &edges);
    let style = Style { layer: String::new(), color: [0.0; 3] };
    support::face(&mut m, "crossed", SurfaceGeometry::Plane(plane), vec![bound], style);
    let refused = tessellate(&m, &options(0.1, 15.0));
    assert!(matches!(refused, Err(ExportError::Untriangulable { face }) if face == "crossed"));
}
