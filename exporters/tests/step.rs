//! What can be said of STEP files without a CAD kernel; OpenCASCADE and FreeCAD have their say in /tests.

mod support;

use coolinggen_exporters::{ExportError, StepOptions, StepSchema, write_step};
use std::collections::BTreeMap;

fn step(model: &coolinggen_brep::Model, solids: &[&str]) -> String {
    step_of(StepSchema::Ap214, model, solids)
}

fn step_of(schema: StepSchema, model: &coolinggen_brep::Model, solids: &[&str]) -> String {
    let mut out = Vec::new();
    let options = StepOptions { name: "blade".to_owned(), schema, ..StepOptions::default() };
    write_step(model, solids, &options, &mut out).unwrap();
    String::from_utf8(out).unwrap()
}

/// Entities by number: everything after ` = `.
fn entities(text: &str) -> BTreeMap<usize, &str> {
    let mut out = BTreeMap::new();
    for line in text.lines().filter(|l| l.starts_with('#')) {
        let (id, body) = line[1..].split_once(" = ").unwrap();
        assert!(body.ends_with(';'), "{line}");
        assert!(out.insert(id.parse().unwrap(), body).is_none(), "#{id} twice");
    }
    out
}

/// Numbers of the entities that `body` refers to, strings left out.
fn references(body: &str) -> Vec<usize> {
    let unquoted: String = body.split('\'').step_by(2).collect();
    let pieces = unquoted.split('#').skip(1);
    pieces.map(|p| p.chars().take_while(char::is_ascii_digit).collect::<String>().parse().unwrap()).collect()
}

fn of_kind<'a>(all: &'a BTreeMap<usize, &str>, kind: &str) -> Vec<(usize, &'a str)> {
    let starts = format!("{kind}(");
    all.iter().filter(|(_, b)| b.starts_with(&starts)).map(|(&i, &b)| (i, b)).collect()
}

#[test]
fn references_resolve_and_counts_are_right() {
    for (name, model) in support::all() {
        let text = step(&model, &[]);
        let all = entities(&text);
        for (id, body) in &all {
            assert!(references(body).iter().all(|r| all.contains_key(r)), "{name} #{id}: {body}");
        }
        let faces: usize = model.solids.iter().map(|s| s.faces().count()).sum();
        let count = |kind: &str| of_kind(&all, kind).len();
        assert_eq!(count("ADVANCED_FACE"), faces, "{name}");
        assert_eq!(count("FACE_OUTER_BOUND"), faces, "{name}");
        assert_eq!(count("STYLED_ITEM"), faces, "{name}");
        assert_eq!(count("PRODUCT"), model.solids.len(), "{name}");
        assert_eq!(count("MANIFOLD_SOLID_BREP") + count("BREP_WITH_VOIDS"), model.solids.len(), "{name}");
        let shells: usize = model.solids.iter().map(|s| s.shells.len()).sum();
        assert_eq!(count("CLOSED_SHELL"), shells, "{name}");
    }
}

/// From each face through its use to its aspect, and from that to its own product, whose representation has the face.
#[test]
fn aspects_of_ap242_name_every_face() {
    let name = |body: &str| body.split('\'').nth(1).unwrap().to_owned();
    for (model_name, model) in support::all() {
        let plain = step(&model, &[]);
        assert!(!plain.contains("SHAPE_ASPECT("), "{model_name}");
        let text = step_of(StepSchema::Ap242, &model, &[]);
        assert!(text.contains("FILE_SCHEMA(('AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF {"));
        let all = entities(&text);
        let mut faces: BTreeMap<usize, String> =
            of_kind(&all, "ADVANCED_FACE").into_iter().map(|(id, body)| (id, name(body))).collect();
        for (_, body) in of_kind(&all, "GEOMETRIC_ITEM_SPECIFIC_USAGE") {
            let [aspect, representation, face] = references(body)[..] else { panic!("{body}") };
            assert_eq!(faces.remove(&face), Some(name(all[&aspect])), "{model_name}: once, by its name");
            let shape = references(all[&aspect])[0];
            assert!(all[&shape].starts_with("PRODUCT_DEFINITION_SHAPE("), "{model_name}");
            let represented = of_kind(&all, "SHAPE_DEFINITION_REPRESENTATION");
            assert!(represented.iter().any(|(_, body)| references(body) == [shape, representation]));
            let brep = references(all[&representation])[1];
            let shells = references(all[&brep]).into_iter().flat_map(|shell| {
                let own = references(all[&shell]);
                // Voids are shells by way of oriented ones.
                let below = own.iter().filter(|id| all[id].starts_with("CLOSED_SHELL"));
                let below: Vec<usize> = below.flat_map(|id| references(all[id])).collect();
                [own, below].concat()
            });
            assert!(shells.into_iter().any(|id| id == face), "{model_name}: its own solid's");
        }
        assert!(faces.is_empty(), "{model_name}: {faces:?}");
    }
}

#[test]
fn every_edge_of_a_shell_is_used_once_each_way() {
    for (name, model) in support::all() {
        let text = step(&model, &[]);
        let all = entities(&text);
        for (_, shell) in of_kind(&all, "CLOSED_SHELL") {
            let mut uses: BTreeMap<usize, [usize; 2]> = BTreeMap::new();
            for face in references(shell) {
                for bound in references(all[&face]).into_iter().filter(|b| all[b].contains("_BOUND(")) {
                    let kept = all[&bound].ends_with(".T.);");
                    for oriented in references(all[&references(all[&bound])[0]]) {
                        let body = all[&oriented];
                        let along = body.ends_with(".T.);") == kept;
                        uses.entry(references(body)[0]).or_default()[usize::from(along)] += 1;
                    }
                }
            }
            assert!(uses.values().all(|u| *u == [1, 1]), "{name}: {uses:?}");
        }
    }
}

#[test]
fn edges_carry_a_parameter_curve_for_each_face() {
    for (name, model) in support::all() {
        let text = step(&model, &[]);
        let all = entities(&text);
        let (edges, pcurves) = (of_kind(&all, "EDGE_CURVE"), of_kind(&all, "PCURVE"));
        // Rational curves in a plane go without.
        let missing = if name == "round" { 8 } else { 0 };
        assert_eq!(pcurves.len(), 2 * edges.len() - missing, "{name}");
        let mut surfaces: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (_, body) in of_kind(&all, "ADVANCED_FACE") {
            let refs = references(body);
            for bound in &refs[..refs.len() - 1] {
                for oriented in references(all[&references(all[bound])[0]]) {
                    surfaces.entry(references(all[&oriented])[0]).or_default().push(refs[refs.len() - 1]);
                }
            }
        }
        for (edge, body) in edges {
            let curve = all[&references(body)[2]];
            let on: Vec<usize> = references(curve)[1..].iter().map(|p| references(all[p])[0]).collect();
            assert!(
                curve.starts_with("SURFACE_CURVE(") && on.iter().all(|s| surfaces[&edge].contains(s)),
                "{name}"
            );
        }
    }
    let options = StepOptions { pcurves: false, ..StepOptions::default() };
    let mut out = Vec::new();
    write_step(&support::blocks::cuboid(), &[], &options, &mut out).unwrap();
    assert!(!String::from_utf8(out).unwrap().contains("PCURVE"));
}

#[test]
fn names_are_written_and_escaped() {
    let model = support::blocks::cuboid();
    let text = step(&model, &["metal"]);
    assert!(text.contains("ADVANCED_FACE('bl\\X2\\00F6\\X0\\ck a''s/top',"));
    assert!(text.contains("PRODUCT('metal','metal','',(#8))"));
    assert!(text.contains("MANIFOLD_SOLID_BREP('metal',"));
    assert!(text.contains("PRESENTATION_LAYER_ASSIGNMENT('bl\\X2\\00F6\\X0\\ck a''s','',("));
    assert!(text.contains("FILE_NAME('blade','1970-01-01T00:00:00',(''),(''),"));
    assert!(text.is_ascii());
}

#[test]
fn surfaces_are_native_where_they_can_be() {
    let kinds = |name: &str| {
        let model = support::all().into_iter().find(|(n, _)| *n == name).unwrap().1;
        let text = step(&model, &["metal"]);
        let all = entities(&text);
        [
            "PLANE",
            "CYLINDRICAL_SURFACE",
            "CONICAL_SURFACE",
            "SURFACE_OF_REVOLUTION",
            "B_SPLINE_SURFACE_WITH_KNOTS",
        ]
        .map(|kind| of_kind(&all, kind).len())
    };
    assert_eq!(kinds("disc"), [4, 2, 0, 0, 0]);
    assert_eq!(kinds("cylinder"), [0, 3, 0, 0, 8]);
    assert_eq!(kinds("cone_back"), [0, 0, 3, 0, 8]);
    assert_eq!(kinds("general"), [0, 0, 0, 3, 8]);
    assert_eq!(kinds("saddle"), [5, 0, 0, 0, 1]);
}

#[test]
fn cone_angles_are_positive_and_knots_keep_all_digits() {
    let model = support::airfoil::hollow(support::airfoil::Walls::Cone, 0.0, true);
    let text = step(&model, &[]);
    for (_, cone) in of_kind(&entities(&text), "CONICAL_SURFACE") {
        let angle: f64 = cone.trim_end_matches(");").rsplit(',').next().unwrap().parse().unwrap();
        assert!(angle > 0.0);
    }
    let knot = match &model.edges[0].curve {
        coolinggen_brep::EdgeCurve::BSpline(c) => c.knots().breaks()[3],
        coolinggen_brep::EdgeCurve::Rational(_) => unreachable!(),
    };
    assert!(text.contains(&format!("{knot:?}")));
}

#[test]
fn output_is_the_same_every_time() {
    let run = || step(&support::airfoil::hollow(support::airfoil::Walls::General, 0.1, false), &[]);
    assert!(run() == run());
}

#[test]
fn bad_requests_are_refused() {
    let model = support::blocks::cuboid();
    let write = |solids: &[&str], options: &StepOptions| write_step(&model, solids, options, &mut Vec::new());
    assert!(matches!(write(&["x"], &StepOptions::default()), Err(ExportError::UnknownSolid { .. })));
    let options = StepOptions { uncertainty_mm: 0.0, ..StepOptions::default() };
    assert!(matches!(write(&[], &options), Err(ExportError::BadOption { .. })));
}
