//! What can be said of IGES files without a CAD kernel; OpenCASCADE has its say in /tests.

mod support;

use coolinggen_brep::{Grouping, Model, SurfaceGeometry};
use coolinggen_exporters::{ExportError, IgesForm, IgesOptions, write_iges, write_panels};
use coolinggen_nurbs::{Curve, ParametricCurve, ParametricSurface, RationalCurve, RationalSurface};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use support::iges::{Entity, File, curve, flat, surface};

/// Greatest distance of an edge from its faces, mm: what the models keep.
const CLOSE: f64 = 1e-7;

fn grouping(model: &Model) -> Grouping {
    Grouping::new(model, |f| (f.style.layer.clone(), "coolant_inlet".to_owned()))
}

fn text(model: &Model, form: IgesForm) -> String {
    let options = IgesOptions {
        name: "blade".to_owned(),
        file_name: "x.igs".to_owned(),
        form,
        ..IgesOptions::default()
    };
    let mut out = Vec::new();
    write_iges(model, &[], &grouping(model), &options, &mut out).unwrap();
    String::from_utf8(out).unwrap()
}

fn read(model: &Model, form: IgesForm) -> File {
    File::read(&text(model, form))
}

/// Faces that the solids use.
fn used(model: &Model) -> BTreeSet<usize> {
    model.solids.iter().flat_map(coolinggen_brep::Solid::faces).map(|f| f.face.0).collect()
}

/// A curve on a surface keeps to the curve in space, parameter by parameter.
fn assert_together(
    name: &str,
    s: &RationalSurface<DVec3>,
    c: &RationalCurve<DVec3>,
    on: &RationalCurve<DVec3>,
) {
    assert_eq!(on.domain(), c.domain(), "{name}");
    let (start, end) = c.domain();
    for i in 0..=20 {
        let t = start + (end - start) * f64::from(i) / 20.0;
        let p = flat(on.point(t));
        let off = s.point(p.x, p.y).distance(c.point(t));
        assert!(off < CLOSE, "{name}: {off:e} at {t}");
    }
}

/// The curves end where the next begins.
fn assert_chained(name: &str, curves: &[RationalCurve<DVec3>], within: f64) {
    for (a, b) in curves.iter().zip(curves.iter().cycle().skip(1)) {
        let gap = a.point(a.domain().1).distance(b.point(b.domain().0));
        assert!(gap <= within, "{name}: {gap:e}");
    }
}

#[test]
fn solids_have_their_faces_edges_and_vertices_once() {
    for (name, model) in support::all() {
        let file = read(&model, IgesForm::Solids);
        let counts = [186, 514, 510, 504, 502].map(|kind| file.of_kind(kind).len());
        let shells: usize = model.solids.iter().map(|s| s.shells.len()).sum();
        assert_eq!(counts, [model.solids.len(), shells, used(&model).len(), 1, 1], "{name}");
        let (edges, vertices) = (file.of_kind(504)[0], file.of_kind(502)[0]);
        assert_eq!(edges.integer(0), model.edges.len(), "{name}");
        assert_eq!(vertices.integer(0), model.vertices.len(), "{name}");
        let vertex = |i: usize| DVec3::from_array([0, 1, 2].map(|k| vertices.real(1 + 3 * (i - 1) + k)));
        for e in 0..edges.integer(0) {
            let c = curve(file.at(edges, 1 + 5 * e, 126));
            let ends = [3, 5].map(|k| vertex(edges.integer(k + 5 * e)));
            // Weights round the ends of rational curves.
            assert!(c.point(c.domain().0).distance(ends[0]) < 1e-13, "{name}");
            assert!(c.point(c.domain().1).distance(ends[1]) < 1e-13, "{name}");
        }
    }
}

#[test]
fn loops_run_round_their_faces_with_edges_on_them() {
    for (name, model) in support::all() {
        let file = read(&model, IgesForm::Solids);
        for face in file.of_kind(510) {
            let s = surface(file.at(face, 0, 128));
            assert_eq!(face.integer(2), 1, "{name}");
            for l in 0..face.integer(1) {
                let bound = file.at(face, 3 + l, 508);
                let (mut round, mut space) = (Vec::new(), Vec::new());
                for k in 0..bound.integer(0) {
                    let at = 1 + 7 * k;
                    assert_eq!((bound.integer(at), bound.integer(at + 4)), (0, 1), "{name}");
                    let edges = file.at(bound, at + 1, 504);
                    let c = curve(file.at(edges, 1 + 5 * (bound.integer(at + 2) - 1), 126));
                    let c = if bound.integer(at + 3) == 1 { c } else { reversed(&c) };
                    let on = curve(file.at(bound, at + 6, 126));
                    let points = on.homogeneous().points();
                    let iso = [0, 1]
                        .iter()
                        .any(|&i| points.iter().all(|p| p.project()[i] == points[0].project()[i]));
                    assert_eq!(bound.integer(at + 5) == 1, iso, "{name}");
                    assert_together(name, &s, &c, &on);
                    round.push(on);
                    space.push(c);
                }
                assert_chained(name, &space, 1e-12);
                assert_chained(name, &round, 1e-6);
                assert_eq!(area(&round) > 0.0, l == 0, "{name}: the face is not to the left of loop {l}");
            }
        }
    }
}

fn reversed(c: &RationalCurve<DVec3>) -> RationalCurve<DVec3> {
    RationalCurve::from_homogeneous(c.homogeneous().reversed()).unwrap()
}

/// Area inside a loop of curves in parameters.
fn area(round: &[RationalCurve<DVec3>]) -> f64 {
    let point = |c: &RationalCurve<DVec3>, i: u32| {
        let (start, end) = c.domain();
        flat(c.point(start + (end - start) * f64::from(i) / 32.0))
    };
    let points: Vec<_> = round.iter().flat_map(|c| (0..32).map(move |i| point(c, i))).collect();
    points.iter().zip(points.iter().cycle().skip(1)).map(|(a, b)| 0.5 * a.perp_dot(*b)).sum()
}

#[test]
fn every_edge_of_a_shell_is_used_once_each_way() {
    for (name, model) in support::all() {
        let file = read(&model, IgesForm::Solids);
        for shell in file.of_kind(514) {
            let mut uses: BTreeMap<usize, [usize; 2]> = BTreeMap::new();
            for f in 0..shell.integer(0) {
                let face = file.at(shell, 1 + 2 * f, 510);
                let outward = shell.integer(2 + 2 * f) == 1;
                for l in 0..face.integer(1) {
                    let bound = file.at(face, 3 + l, 508);
                    for k in 0..bound.integer(0) {
                        let along = bound.integer(4 + 7 * k) == 1;
                        uses.entry(bound.integer(3 + 7 * k)).or_default()[usize::from(along == outward)] += 1;
                    }
                }
            }
            assert!(uses.values().all(|u| *u == [1, 1]), "{name}: {uses:?}");
        }
    }
}

#[test]
fn trimmed_surfaces_have_both_curves_of_every_loop() {
    for (name, model) in support::all() {
        let file = read(&model, IgesForm::TrimmedSurfaces);
        let trimmed = file.of_kind(144);
        assert_eq!(trimmed.len(), used(&model).len(), "{name}");
        for face in trimmed {
            assert_eq!(face.integer(1), 1, "{name}");
            let s = surface(file.at(face, 0, 128));
            for l in 0..=face.integer(2) {
                let bound = file.at(face, 3 + l, 142);
                assert_eq!(bound.parameters[1], face.parameters[0], "{name}");
                let [round, space] = [2, 3].map(|i| {
                    let all = file.at(bound, i, 102);
                    (0..all.integer(0)).map(|k| curve(file.at(all, 1 + k, 126))).collect::<Vec<_>>()
                });
                assert_eq!(round.len(), space.len(), "{name}");
                round.iter().zip(&space).for_each(|(on, c)| assert_together(name, &s, c, on));
                assert_chained(name, &space, 1e-12);
                assert_chained(name, &round, 1e-6);
                assert_eq!(area(&round) > 0.0, l == 0, "{name}");
            }
        }
    }
}

#[test]
fn labels_levels_and_colours_are_those_of_the_faces() {
    for (name, model) in support::all() {
        let grouping = grouping(&model);
        for (form, kind) in [(IgesForm::Solids, 510), (IgesForm::TrimmedSurfaces, 144)] {
            let file = read(&model, form);
            let of_label: BTreeMap<&str, &Entity> =
                file.of_kind(kind).into_iter().map(|e| (e.label.as_str(), e)).collect();
            for face in used(&model) {
                let id = coolinggen_brep::FaceId(face);
                let entity = of_label[grouping.alias(id)];
                assert_eq!(entity.level, grouping.index_of(id) + 1, "{name}");
                let percent = file.color(entity);
                for (linear, shown) in model.face(id).style.color.into_iter().zip(percent) {
                    // sRGB within what its power alone gives.
                    assert!((shown / 100.0 - linear.powf(1.0 / 2.2)).abs() < 0.04, "{linear} {shown}");
                }
            }
            // Curves in parameters say so; faces of shells depend on them, trimmed surfaces stand alone.
            let expected = if kind == 510 { "00010000" } else { "00000000" };
            assert!(
                file.of_kind(kind).iter().all(|e| e.status == expected && e.form == usize::from(kind == 510))
            );
            assert!(file.of_kind(126).iter().any(|e| e.status == "00010500"));
        }
    }
}

#[test]
fn numbers_read_back_as_the_same_doubles() {
    let model = support::airfoil::hollow(support::airfoil::Walls::Cone, 0.0, true);
    let file = read(&model, IgesForm::Solids);
    let edges = file.of_kind(504)[0];
    let listed: Vec<_> = (0..edges.integer(0)).map(|e| curve(file.at(edges, 1 + 5 * e, 126))).collect();
    for edge in &model.edges {
        let coolinggen_brep::EdgeCurve::BSpline(own) = &edge.curve else { unreachable!() };
        let same = |c: &&RationalCurve<DVec3>| {
            c.homogeneous().knots() == own.knots()
                && c.homogeneous().points().iter().map(|p| p.weighted).eq(own.points().iter().copied())
        };
        assert_eq!(listed.iter().filter(same).count(), 1);
    }
}

#[test]
fn surfaces_of_revolution_keep_their_parameters() {
    let mut tried = 0;
    for (name, model) in support::all() {
        let grouping = grouping(&model);
        let file = read(&model, IgesForm::TrimmedSurfaces);
        for id in used(&model).into_iter().map(coolinggen_brep::FaceId) {
            let SurfaceGeometry::Revolution(_) = &model.face(id).surface else { continue };
            tried += 1;
            let face = file.of_kind(144).into_iter().find(|e| e.label == grouping.alias(id)).unwrap();
            let made = surface(file.at(face, 0, 128));
            // Quintic in the angle, which may be either parameter.
            let swapped = made.homogeneous().knots_v().degree() == 5;
            let ((u0, u1), (v0, v1)) = made.domain();
            for (i, j) in (0..40).flat_map(|i| (0..40).map(move |j| (i, j))) {
                let at = |a: f64, b: f64, i: i32| a + (b - a) * f64::from(i) / 39.0;
                let (u, v) = (at(u0, u1, i), at(v0, v1, j));
                let (theta, t) = if swapped { (v, u) } else { (u, v) };
                let exact = model.face(id).surface.point(theta, t);
                let off = made.point(u, v).distance(exact);
                assert!(off < 5e-13 * (1.0 + exact.length()), "{name}: {off:e}");
            }
        }
    }
    assert!(tried > 10);
}

#[test]
fn the_global_section_says_millimetres_and_no_time() {
    let model = support::blocks::cuboid();
    let global = read(&model, IgesForm::Solids).global;
    let plain: String = global.split_whitespace().collect();
    assert!(plain.starts_with("1H,,1H;,5Hblade,5Hx.igs,10Hcoolinggen,"), "{plain}");
    assert!(plain.contains(",5Hblade,1.0,2,2HMM,1,0.0,15H19700101.000000,1.E-6,30.0,,,11,0,"), "{plain}");
    for form in [IgesForm::Solids, IgesForm::TrimmedSurfaces] {
        assert_eq!(text(&model, form), text(&model, form));
    }
}

#[test]
fn the_table_of_panels_has_a_line_a_face() {
    let model = support::blocks::box_with_void();
    let grouping = grouping(&model);
    let table = |solids: &[&str]| {
        let mut out = Vec::new();
        write_panels(&model, solids, &grouping, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    };
    let metal = table(&["metal"]);
    assert_eq!(metal.lines().next(), Some("alias,face,level,group,role,boundary"));
    assert_eq!(metal.lines().count(), 13);
    let id = coolinggen_brep::FaceId(0);
    let first = format!("{},outer/front,1,outer,coolant_inlet,inflow", grouping.alias(id));
    assert_eq!(metal.lines().nth(1), Some(first.as_str()));
    let both = table(&[]);
    assert_eq!(both.lines().filter(|l| l.ends_with(",void,coolant_inlet,interface")).count(), 6);
    assert_eq!(both.lines().count(), 13);
}

#[test]
fn bad_requests_are_refused() {
    let model = support::blocks::cuboid();
    let write = |solids: &[&str], options: &IgesOptions| {
        write_iges(&model, solids, &grouping(&model), options, &mut Vec::new())
    };
    assert!(matches!(write(&["x"], &IgesOptions::default()), Err(ExportError::UnknownSolid { .. })));
    let options = IgesOptions { resolution_mm: f64::NAN, ..IgesOptions::default() };
    assert!(matches!(write(&[], &options), Err(ExportError::BadOption { .. })));
    let mut flat = model.clone();
    for coedge in flat.faces[0].loops.iter_mut().flat_map(|l| &mut l.coedges) {
        coedge.pcurve = Curve::segment(glam::DVec2::ZERO, glam::DVec2::X);
    }
    let refused = write_iges(&flat, &[], &grouping(&flat), &IgesOptions::default(), &mut Vec::new());
    assert!(matches!(refused, Err(ExportError::BadTopology { .. })));
}
