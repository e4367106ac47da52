//! Boxes: plain, pierced, hollow; and a sector between two discs.

use super::{face, line, patch, plane_loop, segment_on, solid, style, uses};
use coolinggen_brep::{
    Coedge, EdgeId, FaceId, FaceUse, Loop, Model, Plane, Revolution, SurfaceGeometry, VertexId,
};
use coolinggen_nurbs::{Curve, Interpolator, Knots, ParametricCurve, Surface};
use glam::{DVec2, DVec3};

/// The six faces of a box, natural normals outward, and the edges of the top and bottom.
struct Cuboid {
    faces: Vec<FaceId>,
    bottom: (Plane, Vec<(EdgeId, bool)>),
    top: (Plane, Vec<(EdgeId, bool)>),
}

fn cuboid_faces(m: &mut Model, prefix: &str, low: DVec3, high: DVec3, color: [f64; 3], caps: bool) -> Cuboid {
    let corner = |i: usize| {
        DVec3::new(
            if matches!(i % 4, 1 | 2) { high.x } else { low.x },
            if i % 4 >= 2 { high.y } else { low.y },
            if i >= 4 { high.z } else { low.z },
        )
    };
    let v: Vec<VertexId> = (0..8).map(|i| m.add_vertex(corner(i))).collect();
    let lower: Vec<EdgeId> = (0..4).map(|i| line(m, v[i], v[(i + 1) % 4])).collect();
    let upper: Vec<EdgeId> = (0..4).map(|i| line(m, v[4 + i], v[4 + (i + 1) % 4])).collect();
    let rise: Vec<EdgeId> = (0..4).map(|i| line(m, v[i], v[4 + i])).collect();
    let mut faces = Vec::new();
    for (i, name) in ["front", "right", "back", "left"].into_iter().enumerate() {
        let x = (corner((i + 1) % 4) - corner(i)).normalize();
        let plane = Plane { origin: corner(i), x, y: DVec3::Z };
        let edges = [(lower[i], true), (rise[(i + 1) % 4], true), (upper[i], false), (rise[i], false)];
        let bound = plane_loop(m, &plane, &edges);
        let name = format!("{prefix}/{name}");
        faces.push(face(m, &name, SurfaceGeometry::Plane(plane), vec![bound], style(prefix, color)));
    }
    let bottom = Plane { origin: corner(0), x: DVec3::Y, y: DVec3::X };
    let top = Plane { origin: corner(4), x: DVec3::X, y: DVec3::Y };
    let bottom = (bottom, lower.iter().rev().map(|&e| (e, false)).collect::<Vec<_>>());
    let top = (top, upper.iter().map(|&e| (e, true)).collect::<Vec<_>>());
    if caps {
        for (name, (plane, edges)) in [("bottom", &bottom), ("top", &top)] {
            let bound = plane_loop(m, plane, edges);
            let name = format!("{prefix}/{name}");
            faces.push(face(m, &name, SurfaceGeometry::Plane(*plane), vec![bound], style(prefix, color)));
        }
    }
    Cuboid { faces, bottom, top }
}

/// 30 x 20 x 10 mm, named with a quote, a space and an umlaut.
pub fn cuboid() -> Model {
    let mut m = Model::default();
    let c = cuboid_faces(
        &mut m,
        "bl\u{f6}ck a's",
        DVec3::ZERO,
        DVec3::new(30.0, 20.0, 10.0),
        [0.8, 0.1, 0.1],
        true,
    );
    m.solids.push(solid("metal", vec![uses(&c.faces, true)], 0));
    m
}

/// The box with a 10 x 8 x 4 mm void.
pub fn box_with_void() -> Model {
    let mut m = Model::default();
    let outer =
        cuboid_faces(&mut m, "outer", DVec3::ZERO, DVec3::new(30.0, 20.0, 10.0), [0.5, 0.5, 0.6], true);
    let (low, high) = (DVec3::new(10.0, 6.0, 3.0), DVec3::new(20.0, 14.0, 7.0));
    let inner = cuboid_faces(&mut m, "void", low, high, [0.1, 0.4, 0.8], true);
    m.solids.push(solid("metal", vec![uses(&outer.faces, true), uses(&inner.faces, false)], 0));
    m.solids.push(solid("core", vec![uses(&inner.faces, true)], 0));
    m
}

/// Half a circle from `start` to `end` radians as a cubic through 33 points.
fn half_circle(center: DVec3, radius: f64, start: f64, end: f64) -> Curve<DVec3> {
    let t: Vec<f64> = (0..=32).map(|i| f64::from(i) / 32.0).collect();
    let at = |a: f64| center + radius * DVec3::new(a.cos(), a.sin(), 0.0);
    let mut points: Vec<DVec3> = t.iter().map(|&t| at(start + (end - start) * t)).collect();
    // Both halves meet in the same points to the bit.
    points[0] = center + DVec3::X * radius * if start == 0.0 { 1.0 } else { -1.0 };
    points[32] = center - DVec3::X * radius * if start == 0.0 { 1.0 } else { -1.0 };
    Interpolator::new(3, &t).unwrap().curve(&points).unwrap()
}

/// A 20 x 10 x 10 block with a tapered hole through it: two ruled half faces, two edges a loop.
pub fn block_with_hole() -> Model {
    let mut m = Model::default();
    let color = [0.7, 0.7, 0.75];
    let c = cuboid_faces(&mut m, "block", DVec3::ZERO, DVec3::new(20.0, 10.0, 10.0), color, false);
    let pi = std::f64::consts::PI;
    let rings: Vec<[EdgeId; 2]> = [(0.0, 1.5), (10.0, 2.0)]
        .map(|(z, r)| {
            let center = DVec3::new(9.0, 5.0, z);
            let (a, b) = (half_circle(center, r, 0.0, pi), half_circle(center, r, pi, 2.0 * pi));
            let (p, q) = (m.add_vertex(a.points()[0]), m.add_vertex(b.points()[0]));
            [m.add_edge(p, q, a), m.add_edge(q, p, b)]
        })
        .to_vec();
    let start = |m: &Model, e: EdgeId| m.edge(e).start;
    let rise = [0, 1].map(|k| {
        let (a, b) = (start(&m, rings[0][k]), start(&m, rings[1][k]));
        line(&mut m, a, b)
    });
    let mut tube = Vec::new();
    for k in 0..2 {
        let curve = |e: EdgeId| match &m.edge(e).curve {
            coolinggen_brep::EdgeCurve::BSpline(c) => c.clone(),
            coolinggen_brep::EdgeCurve::Rational(_) => unreachable!(),
        };
        let columns = [curve(rings[0][k]), curve(rings[1][k])];
        let surface = Surface::from_columns(&columns, Knots::clamped(1, &[0.0, 1.0]).unwrap()).unwrap();
        let edges = [rings[0][k], rise[1 - k], rings[1][k], rise[k]];
        let name = format!("hole/{}", ["first", "second"][k]);
        tube.push(patch(&mut m, &name, surface, edges, style("hole", [0.9, 0.5, 0.1])));
    }
    let mut faces = uses(&c.faces, true);
    for (ring, (name, (plane, edges))) in rings.iter().zip([("bottom", &c.bottom), ("top", &c.top)]) {
        let outer = plane_loop(&m, plane, edges);
        let inner = plane_loop(&m, plane, &[(ring[0], true), (ring[1], true)]);
        let name = format!("block/{name}");
        let id =
            face(&mut m, &name, SurfaceGeometry::Plane(*plane), vec![outer, inner], style("block", color));
        faces.push(FaceUse { face: id, forward: true });
    }
    faces.extend(uses(&tube, false));
    m.solids.push(solid("metal", vec![faces], 1));
    m
}

/// 60 degrees of a ring, r 20 to 30, x 0 to 5: revolutions that are discs and cylinders, planar sides.
pub fn disc_sector() -> Model {
    let mut m = Model::default();
    let (a, b) = (0.3f64, 0.3 + std::f64::consts::FRAC_PI_3);
    let corners = [(0.0, 20.0), (5.0, 20.0), (5.0, 30.0), (0.0, 30.0)];
    let at = |(x, r): (f64, f64), t: f64| DVec3::new(x, r * t.sin(), r * t.cos());
    let v: Vec<[VertexId; 2]> =
        corners.iter().map(|&c| [m.add_vertex(at(c, a)), m.add_vertex(at(c, b))]).collect();
    let t: Vec<f64> = (0..=60).map(|i| a + (b - a) * f64::from(i) / 60.0).collect();
    let fit = Interpolator::new(5, &t).unwrap();
    let arcs: Vec<EdgeId> = corners
        .iter()
        .zip(&v)
        .map(|(&c, v)| {
            let mut points: Vec<DVec3> = t.iter().map(|&t| at(c, t)).collect();
            points[0] = m.vertex(v[0]);
            points[60] = m.vertex(v[1]);
            m.add_edge(v[0], v[1], fit.curve(&points).unwrap())
        })
        .collect();
    let spans: Vec<[EdgeId; 2]> =
        (0..4).map(|i| [0, 1].map(|k| line(&mut m, v[i][k], v[(i + 1) % 4][k]))).collect();
    let mut faces = Vec::new();
    for (i, name) in ["inner", "rear", "outer", "front"].into_iter().enumerate() {
        let j = (i + 1) % 4;
        let meridian = Curve::segment(DVec2::from(corners[i]), DVec2::from(corners[j]));
        let surface = SurfaceGeometry::Revolution(Revolution::new(meridian).unwrap());
        let side = |edge: EdgeId, forward: bool, p: (f64, f64), q: (f64, f64)| Coedge {
            edge,
            forward,
            pcurve: segment_on(m.edge(edge).curve.domain(), p.into(), q.into()),
        };
        let coedges = vec![
            side(arcs[i], true, (a, 0.0), (b, 0.0)),
            side(spans[i][1], true, (b, 0.0), (b, 1.0)),
            side(arcs[j], false, (a, 1.0), (b, 1.0)),
            side(spans[i][0], false, (a, 0.0), (a, 1.0)),
        ];
        let name = format!("ring/{name}");
        faces.push(face(&mut m, &name, surface, vec![Loop { coedges }], style("ring", [0.2, 0.6, 0.3])));
    }
    // The meridian runs round the section with the axis below: its natural normals point out of it.
    let mut used = uses(&faces, true);
    for k in 0..2 {
        let angle = [a, b][k];
        let radial = DVec3::new(0.0, angle.sin(), angle.cos());
        let plane = if k == 0 {
            Plane { origin: m.vertex(v[0][0]), x: radial, y: DVec3::X }
        } else {
            Plane { origin: m.vertex(v[0][1]), x: DVec3::X, y: radial }
        };
        let edges: Vec<(EdgeId, bool)> = (0..4).map(|i| (spans[i][k], true)).collect();
        let bound = plane_loop(&m, &plane, &edges);
        let name = format!("ring/{}", ["start", "end"][k]);
        let id =
            face(&mut m, &name, SurfaceGeometry::Plane(plane), vec![bound], style("sides", [0.6, 0.6, 0.2]));
        used.push(FaceUse { face: id, forward: natural_points_out(&plane, k == 0) });
    }
    m.solids.push(solid("metal", vec![used], 0));
    m
}

/// Whether the normal of a side plane points against increasing theta (start) or along it (end).
fn natural_points_out(plane: &Plane, start: bool) -> bool {
    let normal = plane.x.cross(plane.y);
    let along = DVec3::new(0.0, plane.origin.z, -plane.origin.y);
    (normal.dot(along) < 0.0) == start
}
