//! How long the checks and integrals take: medians over repeated runs, printed.

use coolinggen_brep::{
    Coedge, EdgeCurve, EdgeId, Face, FaceDomain, FaceId, FaceUse, Loop, LoopEdges, Model, Plane, Revolution,
    Shell, Solid, Style, SurfaceGeometry, VertexId, face_integrals,
};
use coolinggen_nurbs::{Curve, Interpolator, Knots, ParametricCurve, ParametricSurface, Surface};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Instant;

fn style() -> Style {
    Style { layer: String::new(), color: [0.5; 3] }
}

fn time<T>(what: &str, runs: usize, mut f: impl FnMut() -> T) {
    // `cargo bench -- words` picks by name.
    let words: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    if !words.iter().all(|w| what.contains(w.as_str())) {
        return;
    }
    let mut times = Vec::with_capacity(runs);
    let before = processor_time();
    for _ in 0..runs {
        let start = Instant::now();
        black_box(f());
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    let mean =
        processor_time().zip(before).map_or(f64::NAN, |(after, before)| (after - before) * 1e3 / runs as f64);
    times.sort_by(f64::total_cmp);
    println!(
        "{what:<56} median {:8.3} ms, best {:8.3} ms, processor {mean:8.3} ms",
        times[runs / 2],
        times[0]
    );
}

/// Seconds this thread has run for, where Linux tells: on a busy machine the clock on the wall says little.
fn processor_time() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    stat.split_whitespace().next()?.parse::<f64>().ok().map(|ns| ns * 1e-9)
}

fn patch(spans_u: usize, spans_v: usize) -> Surface<DVec3> {
    let knots = |n: usize| Knots::uniform(3, n + 3).unwrap();
    let (ku, kv) = (knots(spans_u), knots(spans_v));
    let (gu, gv) = (ku.greville(), kv.greville());
    let points = gu.iter().flat_map(|&u| gv.iter().map(move |&v| (u, v)));
    let points =
        points.map(|(u, v)| DVec3::new(30.0 * u, 50.0 * v + 250.0, 3.0 * (4.0 * u + v).sin())).collect();
    Surface::new(ku, kv, points).unwrap()
}

fn face(surface: SurfaceGeometry, pcurves: Vec<Curve<DVec2>>) -> Face {
    let coedges =
        pcurves.into_iter().map(|pcurve| Coedge { edge: EdgeId(0), forward: true, pcurve }).collect();
    Face { name: "face".into(), surface, loops: vec![Loop { coedges }], style: style() }
}

/// A blade without caps: the model, the rings of edges at both ends, the surfaces they lie on.
struct Blade {
    model: Model,
    rings: [Vec<(EdgeId, bool)>; 2],
    caps: [SurfaceGeometry; 2],
}

/// A blade of `strips` patches between two surfaces, each patch `spans` long.
fn blade(strips: usize, spans: usize, flat: bool) -> Blade {
    let caps = [250.0, 300.0].map(|r: f64| {
        if flat {
            return SurfaceGeometry::Plane(Plane {
                origin: DVec3::new(0.0, 0.0, r),
                x: DVec3::X,
                y: DVec3::NEG_Y,
            });
        }
        let x: Vec<f64> = (0..=20).map(|i| -25.0 + 2.5 * f64::from(i)).collect();
        let points: Vec<DVec2> = x.iter().map(|&x| DVec2::new(x, r + 2.0 * (x / 20.0).sin())).collect();
        let meridian = Interpolator::new(3, &x).unwrap().curve(&points).unwrap();
        SurfaceGeometry::Revolution(Revolution::new(meridian).unwrap())
    });
    let at = |cap: &SurfaceGeometry, a: f64| {
        let (x, w) = (20.0 * a.cos(), 6.0 * a.sin() - 3.0 * (2.0 * a).cos());
        match cap {
            SurfaceGeometry::Plane(_) => cap.point(x, w),
            _ => cap.point(w / 280.0, x),
        }
    };
    let mut m = Model::default();
    let step = TAU / strips as f64;
    let v: Vec<[VertexId; 2]> =
        (0..strips).map(|i| [0, 1].map(|k| m.add_vertex(at(&caps[k], step * i as f64)))).collect();
    let rising: Vec<EdgeId> = (0..strips)
        .map(|i| {
            let c = Curve::segment(m.vertex(v[i][0]), m.vertex(v[i][1]));
            m.add_edge(v[i][0], v[i][1], c)
        })
        .collect();
    let t: Vec<f64> = (0..=spans).map(|k| k as f64 / spans as f64).collect();
    let fit = Interpolator::new(3, &t).unwrap();
    let mut rings: [Vec<(EdgeId, bool)>; 2] = Default::default();
    for i in 0..strips {
        let next = (i + 1) % strips;
        let rows = [0, 1].map(|k| {
            let points: Vec<DVec3> = t
                .iter()
                .enumerate()
                .map(|(j, t)| match j {
                    0 => m.vertex(v[i][k]),
                    j if j == spans => m.vertex(v[next][k]),
                    _ => at(&caps[k], step * (i as f64 + t)),
                })
                .collect();
            fit.curve(&points).unwrap()
        });
        let edges = [0, 1].map(|k| m.add_edge(v[i][k], v[next][k], rows[k].clone()));
        for k in 0..2 {
            rings[k].push((edges[k], true));
        }
        let surface = Surface::from_columns(&rows, Knots::clamped(1, &[0.0, 1.0]).unwrap()).unwrap();
        let borders: [&[EdgeId]; 4] = [&[edges[0]], &[rising[next]], &[edges[1]], &[rising[i]]];
        m.patch_face(format!("side/{i}"), surface, borders, style()).unwrap();
    }
    Blade { model: m, rings, caps }
}

fn main() {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(u, v)| DVec2::new(u, v));
    let side = |a: DVec2, b: DVec2| Curve::segment(a, b);
    let surface = patch(100, 12);
    let whole =
        face(surface.clone().into(), (0..4).map(|i| side(corners[i], corners[(i + 1) % 4])).collect());
    time("integrals, bicubic 100 x 12, whole", 101, || face_integrals(&whole));
    // Ends trimmed by curves with 200 spans.
    let t: Vec<f64> = (0..=200).map(|i| f64::from(i) / 200.0).collect();
    let fit = Interpolator::new(3, &t).unwrap();
    let wave = |up: bool| -> Curve<DVec2> {
        let points: Vec<DVec2> = t
            .iter()
            .map(|&t| {
                let u = if up { 1.0 - t } else { t };
                DVec2::new(u, if up { 0.9 + 0.03 * (5.0 * u).sin() } else { 0.1 + 0.03 * (4.0 * u).cos() })
            })
            .collect();
        fit.curve(&points).unwrap()
    };
    let (low, high) = (wave(false), wave(true));
    let pcurves = vec![
        low.clone(),
        side(low.point(1.0), high.point(0.0)),
        high.clone(),
        side(high.point(1.0), low.point(0.0)),
    ];
    let trimmed = face(surface.into(), pcurves);
    time("integrals, bicubic 100 x 12, two trimmed ends", 101, || face_integrals(&trimmed));
    time("domain of the trimmed face, built", 101, || FaceDomain::new(&trimmed));
    let domain = FaceDomain::new(&trimmed);
    time("2000 samples of the trimmed face", 51, || domain.samples(2000).count());
    for flat in [true, false] {
        let kind = if flat { "plane caps" } else { "revolution caps" };
        let Blade { model: mut m, rings, caps } = blade(58, 200, flat);
        let bare = m.clone();
        let add = |m: &mut Model| {
            [0, 1].map(|k| {
                let loops = [LoopEdges { edges: &rings[k], near: DVec2::ZERO }];
                m.trimmed_face(format!("cap/{k}"), caps[k].clone(), &loops, 1e-7, style()).unwrap()
            })
        };
        time(&format!("two {kind} of 58 edges with 200 spans, made"), 21, || add(&mut bare.clone()));
        let ids = add(&mut m);
        let mut faces: Vec<FaceUse> = (0..58).map(|i| FaceUse { face: FaceId(i), forward: true }).collect();
        faces.extend([0, 1].map(|k| FaceUse { face: ids[k], forward: true }));
        let mut solid = Solid { name: "blade".into(), shells: vec![Shell { faces }], expected_genus: 0 };
        // Caps look out: one of the two is turned; try which.
        for turned in [58, 59] {
            solid.shells[0].faces[turned].forward = false;
            if m.check_solid(&solid).is_sound() {
                break;
            }
            solid.shells[0].faces[turned].forward = true;
        }
        let check = m.check_solid(&solid);
        println!("{check:?}");
        time(&format!("check, 60 faces, {kind}"), 101, || m.check_solid(&solid));
        // Edges with more knots than the surfaces: nothing but samples will do.
        let mut fine = m.clone();
        for edge in &mut fine.edges {
            if let EdgeCurve::BSpline(c) = &edge.curve {
                let breaks = c.breaks();
                let middles: Vec<f64> = breaks.windows(2).map(|p| 0.5 * (p[0] + p[1])).collect();
                edge.curve = c.with_knots_inserted(&middles).unwrap().into();
            }
        }
        assert!(fine.check_solid(&solid).is_sound());
        time(&format!("check, 60 faces, {kind}, 400 spans"), 101, || fine.check_solid(&solid));
        time(&format!("integrals, one side, {kind}"), 101, || face_integrals(&m.faces[5]));
        time(&format!("integrals, one cap, {kind}"), 51, || face_integrals(&m.faces[58]));
        time(&format!("model copied, {kind}"), 51, || m.clone());
        time(&format!("bounds, 60 faces, {kind}"), 51, || m.solid_bounds(&solid));
        time(&format!("integrals, 60 faces, {kind}"), 51, || m.face_integrals());
        let mass = m.solid_mass(&solid, &m.face_integrals());
        println!("{mass:?}");
    }
}
