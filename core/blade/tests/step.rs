//! Blades from STEP files: one face or several, in any orientation, unit and degree.

mod common;

use common::*;
use coolinggen_blade::{Blade, BladeSurface};
use coolinggen_nurbs::{Knots, ParametricSurface, Surface};
use glam::DVec3;
use proptest::prelude::*;
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::PathBuf;

/// A file in a folder of its own that goes away with it.
struct File(PathBuf);

impl File {
    fn new(name: &str, text: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("coolinggen-blade-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("blade.step"), text).unwrap();
        Self(folder)
    }

    fn built(&self, space: Value, more: Value) -> Result<Blade, Vec<(String, &'static str)>> {
        let mut blade = json!({"kind": "step", "file": "blade.step"});
        for (key, value) in more.as_object().unwrap() {
            blade[key] = value.clone();
        }
        let design = json!({"space": space, "blade": blade});
        let built = built_in(&design, &self.0)
            .map_err(|faults| faults.iter().map(|f| (f.pointer.clone(), f.code)).collect::<Vec<_>>());
        built.map(|(_, blade)| blade)
    }
}

impl Drop for File {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

const MILLIMETRE: &str = "#1=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n";
const INCH: &str = "#1=(CONVERSION_BASED_UNIT('INCH',#2)LENGTH_UNIT()NAMED_UNIT(#4));\n\
    #2=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#3);\n\
    #3=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n#4=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n";

/// A STEP file with these surfaces, each on a face of its name; coordinates divided by `unit`.
fn step(patches: &[(&str, Surface<DVec3>)], unit: (&str, f64), rational: bool) -> String {
    let mut out = format!(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('a blade; with a semicolon'),'2;1');\nENDSEC;\nDATA;\n{}\
         #5=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#1)) REPRESENTATION_CONTEXT('',''));\n",
        unit.0
    );
    let mut id = 10;
    for (name, s) in patches {
        let (rows, columns) = s.counts();
        let first = id;
        for p in s.points() {
            let p = *p / unit.1;
            writeln!(out, "#{id} = CARTESIAN_POINT('',({:?},{:?},\n  {:?}));", p.x, p.y, p.z).unwrap();
            id += 1;
        }
        let list = |items: Vec<String>| format!("({})", items.join(","));
        let net = |f: &dyn Fn(usize) -> String| {
            list((0..rows).map(|i| list((0..columns).map(|j| f(i * columns + j)).collect())).collect())
        };
        let points = net(&|k| format!("#{}", first + k));
        let knots = |k: &Knots| {
            let mut values = k.breaks();
            values.dedup();
            let m = list(values.iter().map(|t| k.multiplicity(*t).to_string()).collect());
            (m, list(values.iter().map(|t| format!("{t:?}")).collect()))
        };
        let ((mu, ku), (mv, kv)) = (knots(s.knots_u()), knots(s.knots_v()));
        let (p, q) = (s.knots_u().degree(), s.knots_v().degree());
        if rational {
            let weights = net(&|_| "1.".to_owned());
            writeln!(
                out,
                "#{id}=( BOUNDED_SURFACE() B_SPLINE_SURFACE({p},{q},{points},.UNSPECIFIED.,.F.,.F.,.F.) \
                 B_SPLINE_SURFACE_WITH_KNOTS({mu},{mv},{ku},{kv},.UNSPECIFIED.) GEOMETRIC_REPRESENTATION_ITEM() \
                 RATIONAL_B_SPLINE_SURFACE({weights}) REPRESENTATION_ITEM('') SURFACE() );"
            )
        } else {
            writeln!(
                out,
                "#{id}=B_SPLINE_SURFACE_WITH_KNOTS('',{p},{q},{points},.UNSPECIFIED.,.F.,.F.,.F.,{mu},{mv},\n{ku},{kv},.UNSPECIFIED.);"
            )
        }
        .unwrap();
        writeln!(out, "#{}=ADVANCED_FACE('{name}',(#9999),#{id},.T.);", id + 1).unwrap();
        id += 2;
    }
    out.push_str("ENDSEC;\nEND-ISO-10303-21;\n");
    out
}

fn net(blade: &Blade) -> Surface<DVec3> {
    match &blade.surface {
        BladeSurface::BSpline(s) => s.clone(),
        BladeSurface::Rational(_) => panic!("rational"),
    }
}

fn reversed_u(s: &Surface<DVec3>) -> Surface<DVec3> {
    let (a, b) = s.knots_u().domain();
    let knots = s.knots_u().values().iter().rev().map(|k| a + (b - k)).collect();
    let points = s.points().chunks_exact(s.counts().1).rev().flatten().copied().collect();
    Surface::new(Knots::new(s.knots_u().degree(), knots).unwrap(), s.knots_v().clone(), points).unwrap()
}

fn same(a: &Blade, b: &Blade, tolerance: f64) {
    assert_eq!(a.outward, b.outward);
    assert_eq!(
        a.regions.iter().map(|r| r.0).collect::<Vec<_>>(),
        b.regions.iter().map(|r| r.0).collect::<Vec<_>>()
    );
    for ((_, x), (_, y)) in a.regions.iter().zip(&b.regions) {
        for i in 0..=60 {
            for w in [0.0, 0.4, 1.0] {
                let f = f64::from(i) / 60.0;
                let p = a.surface.point(x[0] + (x[1] - x[0]) * f, w);
                // Regions have the same ends; inside, u may run at another speed.
                let foot = b.closest(p, (y[0] + (y[1] - y[0]) * f, w)).unwrap();
                assert!(foot.distance < tolerance, "{f} {w} {}", foot.distance);
                let off = (foot.u - if i == 0 { y[0] } else { y[1] }).abs();
                assert!(i % 60 != 0 || off.min(1.0 - off) < 1e-7, "{f} {w} {off}");
            }
        }
    }
}

/// The rotor cut along the joints of its regions.
fn patches(s: &Surface<DVec3>, blade: &Blade) -> Vec<Surface<DVec3>> {
    blade.regions.iter().map(|(_, r)| s.restricted_u(r[0], r[1]).unwrap()).collect()
}

#[test]
fn one_closed_face_is_read() {
    let reference = built(&rotor(&[0.0, 0.5, 1.0])).1;
    let given = net(&reference);
    for (k, (unit, rational)) in
        [((MILLIMETRE, 1.0), false), ((MILLIMETRE, 1.0), true), ((INCH, 25.4), false)].into_iter().enumerate()
    {
        let file = File::new(&format!("one{k}"), &step(&[("", given.clone())], unit, rational));
        let blade = file.built(annulus(), json!({})).unwrap();
        same(&reference, &blade, 1e-9);
        assert!(matches!(blade.surface, BladeSurface::BSpline(_)));
    }
}

#[test]
fn patches_in_any_orientation_degree_and_order_are_joined() {
    let reference = built(&rotor(&[0.0, 0.5, 1.0])).1;
    let all = patches(&net(&reference), &reference);
    let turned = [
        all[2].transposed(),
        reversed_u(&all[0]).elevated_v().unwrap(),
        reversed_u(&reversed_u(&all[3]).transposed()).with_knots_inserted_u(&[0.31, 0.62]).unwrap(),
        all[1].elevated_u().unwrap(),
    ];
    let mut named: Vec<(&str, Surface<DVec3>)> = ["te", "le", "ps", "ss"].into_iter().zip(turned).collect();
    // A platform, which is no part of the blade.
    let flat = |x: f64, y: f64| DVec3::new(x, y, 250.0);
    let platform = Surface::new(
        Knots::uniform(1, 2).unwrap(),
        Knots::uniform(1, 2).unwrap(),
        vec![flat(-50.0, -60.0), flat(-50.0, 60.0), flat(80.0, -60.0), flat(80.0, 60.0)],
    )
    .unwrap();
    named.insert(2, ("platform", platform));
    let file = File::new("four", &step(&named, (MILLIMETRE, 1.0), false));
    let blade = file.built(annulus(), json!({})).unwrap();
    same(&reference, &blade, 1e-9);
    assert!(blade.fit.notes[0].contains("surfaces"), "{:?}", blade.fit.notes);
    let blade = file.built(annulus(), json!({"faces": ["le", "ss", "te", "ps"]})).unwrap();
    same(&reference, &blade, 1e-9);
    let faults = file.built(annulus(), json!({"faces": ["le", "se", "te", "ps"]})).unwrap_err();
    assert_eq!(faults, [("/blade/faces/1".to_owned(), "not_found")]);
    let faults = file.built(annulus(), json!({"faces": ["le", "ss", "te"]})).unwrap_err();
    assert_eq!(faults, [("/blade/file".to_owned(), "not_closed")]);
    // A gap of 5 um is closed if the tolerance allows it, and said.
    let moved = named[0].1.map(|p| *p + DVec3::new(0.0, 0.0, 5e-3));
    named[0].1 = moved;
    let file = File::new("gap", &step(&named, (MILLIMETRE, 1.0), false));
    assert_eq!(file.built(annulus(), json!({})).unwrap_err()[0].1, "not_closed");
    let blade = file.built(annulus(), json!({"tolerance": 0.01})).unwrap();
    assert!(blade.fit.notes[1].contains("moved"), "{:?}", blade.fit.notes);
}

/// The C3X vane drawn in build123d 0.13 (OpenCASCADE 8): splines through the table's sides, arcs at the edges, lofted,
/// converted to NURBS; rational patches among six faces.
#[test]
fn a_file_from_opencascade_is_read() {
    let file = File::new("occ", include_str!("data/c3x_opencascade.step"));
    let blade = file.built(linear(), json!({})).unwrap();
    let reference = built(&c3x()).1;
    assert!(matches!(blade.surface, BladeSurface::Rational(_)));
    assert_eq!(blade.outward, reference.outward);
    assert_eq!(blade.regions.len(), 4);
    let points = c3x_points();
    for (k, p) in points[..78].iter().enumerate() {
        let p = p.extend(30.0);
        let near = around(2000).into_iter().min_by(|a, b| {
            let d = |u: f64| blade.surface.point(u, 0.4).distance(p);
            d(*a).total_cmp(&d(*b))
        });
        let foot = blade.closest(p, (near.unwrap(), 0.4)).unwrap();
        assert!(foot.distance < 2.5e-3, "{k} {}", foot.distance);
    }
    // Edges end where the arcs do, next to the table's points there.
    let joints = [67, 0, 28, 39];
    for ((region, [u, _]), k) in blade.regions.iter().zip(joints) {
        let p = blade.surface.point(*u, 0.4).truncate();
        assert!(p.distance(points[k]) < 2.5e-3, "{region:?} {p} {}", points[k]);
    }
}

#[test]
fn refuses_what_is_no_blade() {
    let given = net(&built(&c3x()).1);
    let whole = step(&[("", given.clone())], (MILLIMETRE, 1.0), false);
    let refused =
        |name: &str, text: &str| File::new(name, text).built(linear(), json!({})).map(|_| ()).unwrap_err();
    let bad = vec![("/blade/file".to_owned(), "bad_step")];
    assert_eq!(refused("empty", ""), bad);
    assert_eq!(refused("text", "solid blade\nfacet"), bad);
    assert_eq!(refused("cut", &whole[..whole.len() / 2]), bad);
    assert_eq!(refused("dangling", &whole.replacen("#17 = ", "#1700000 = ", 1)), bad);
    let none = "ISO-10303-21;\nDATA;\n#1=PLANE('',#2);\nENDSEC;\nEND-ISO-10303-21;\n";
    assert_eq!(refused("none", none), [("/blade/file".to_owned(), "no_surface")]);
    let open = given.restricted_u(0.1, 0.9).unwrap();
    let open = step(&[("", open)], (MILLIMETRE, 1.0), false);
    assert_eq!(refused("open", &open), [("/blade/file".to_owned(), "not_closed")]);
    let missing = json!({"space": linear(), "blade": {"kind": "step", "file": "nowhere.step"}});
    assert_eq!(common::refused(&missing), [("/blade/file".to_owned(), "cannot_read")]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]
    #[test]
    fn damaged_files_are_read_or_refused(changes in proptest::collection::vec((any::<u32>(), any::<u8>(), 1usize..200), 1..6)) {
        let mut text = include_str!("data/c3x_opencascade.step").as_bytes().to_vec();
        for (at, kind, length) in changes {
            let at = at as usize % text.len();
            let end = (at + length).min(text.len());
            match kind % 5 {
                0 => text[at] = b"0123456789.,;()#'$*-E"[length % 21],
                1 => drop(text.drain(at..end)),
                2 => text.extend_from_within(at..end),
                3 => text.insert(at, b"()#';,.1"[length % 8]),
                // Another number for one.
                _ => {
                    let digit = text[at..].iter().position(u8::is_ascii_digit).map_or(at, |d| at + d);
                    text[digit] = b'0' + (length % 10) as u8;
                }
            }
        }
        let file = File::new("damaged", &String::from_utf8_lossy(&text));
        if let Err(faults) = file.built(linear(), json!({})) {
            prop_assert!(!faults.is_empty());
        }
    }
}
