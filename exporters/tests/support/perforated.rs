//! A ring sector with rows of holes through it, two half faces a hole: what a film-cooled wall looks like to a mesh.

use super::{face, patch, plane_loop, segment_on, solid, style};
use coolinggen_brep::{
    Coedge, EdgeCurve, EdgeId, FaceUse, Loop, Model, Plane, Revolution, SurfaceGeometry, VertexId,
};
use coolinggen_nurbs::{Curve, Interpolator, Knots, ParametricCurve, Surface};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

const RADII: [f64; 2] = [30.0, 28.0];
const LENGTH: f64 = 60.0;
const ANGLES: (f64, f64) = (-0.7, 0.7);
const HOLE: f64 = 0.4;

fn at(x: f64, r: f64, theta: f64) -> DVec3 {
    DVec3::new(x, r * theta.sin(), r * theta.cos())
}

fn curve_of(m: &Model, e: EdgeId) -> Curve<DVec3> {
    match &m.edge(e).curve {
        EdgeCurve::BSpline(c) => c.clone(),
        EdgeCurve::Rational(_) => unreachable!(),
    }
}

/// Half a hole's border on the cylinder of radius `r`, with its parameter curve.
fn half(center: DVec2, r: f64, second: bool) -> (Curve<DVec3>, Curve<DVec2>) {
    let t: Vec<f64> = (0..=32).map(|i| f64::from(i) / 32.0).collect();
    let fit = Interpolator::new(3, &t).unwrap();
    let sign = if second { -1.0 } else { 1.0 };
    let flat: Vec<DVec2> = t
        .iter()
        .enumerate()
        .map(|(i, &t)| {
            // Sines that vanish exactly where the halves meet.
            let sin = if i == 0 || i == 32 { 0.0 } else { (PI * t).sin() };
            let cos = if i == 0 {
                1.0
            } else if i == 32 {
                -1.0
            } else {
                (PI * t).cos()
            };
            center + sign * HOLE * DVec2::new(sin / RADII[0], cos)
        })
        .collect();
    let points: Vec<DVec3> = flat.iter().map(|p| at(p.y, r, p.x)).collect();
    (fit.curve(&points).unwrap(), fit.curve(&flat).unwrap())
}

/// `rows` times `columns` holes.
pub fn sector(rows: usize, columns: usize) -> Model {
    let mut m = Model::default();
    let (a, b) = ANGLES;
    let corners = [(0.0, RADII[1]), (LENGTH, RADII[1]), (LENGTH, RADII[0]), (0.0, RADII[0])];
    let v: Vec<[VertexId; 2]> =
        corners.iter().map(|&(x, r)| [m.add_vertex(at(x, r, a)), m.add_vertex(at(x, r, b))]).collect();
    let t: Vec<f64> = (0..=80).map(|i| a + (b - a) * f64::from(i) / 80.0).collect();
    let fit = Interpolator::new(5, &t).unwrap();
    let arcs: Vec<EdgeId> = corners
        .iter()
        .zip(&v)
        .map(|(&(x, r), v)| {
            let mut points: Vec<DVec3> = t.iter().map(|&t| at(x, r, t)).collect();
            points[0] = m.vertex(v[0]);
            points[80] = m.vertex(v[1]);
            m.add_edge(v[0], v[1], fit.curve(&points).unwrap())
        })
        .collect();
    let spans: Vec<[EdgeId; 2]> =
        (0..4).map(|i| [0, 1].map(|k| super::line(&mut m, v[i][k], v[(i + 1) % 4][k]))).collect();

    // Holes: border halves on both cylinders, ruled half faces between them.
    let mut loops: [Vec<Loop>; 2] = [Vec::new(), Vec::new()];
    let mut used = Vec::new();
    for i in 0..rows * columns {
        let (row, column) = (i / columns, i % columns);
        let center = DVec2::new(
            a + (b - a) * (row as f64 + 0.5) / rows as f64,
            LENGTH * (column as f64 + 0.5 + 0.1 * (row % 2) as f64) / columns as f64,
        );
        let halves = RADII.map(|r| [half(center, r, false), half(center, r, true)]);
        let ends = halves.each_ref().map(|h| [0, 1].map(|k| m.add_vertex(h[k].0.points()[0])));
        let rings =
            [0, 1].map(|s| [0, 1].map(|k| m.add_edge(ends[s][k], ends[s][1 - k], halves[s][k].0.clone())));
        for s in 0..2 {
            let coedge =
                |k: usize| Coedge { edge: rings[s][k], forward: true, pcurve: halves[s][k].1.clone() };
            loops[s].push(Loop { coedges: vec![coedge(0), coedge(1)] });
        }
        let rise = [0, 1].map(|k| super::line(&mut m, ends[0][k], ends[1][k]));
        for k in 0..2 {
            let columns = [curve_of(&m, rings[0][k]), curve_of(&m, rings[1][k])];
            let surface = Surface::from_columns(&columns, Knots::clamped(1, &[0.0, 1.0]).unwrap()).unwrap();
            let edges = [rings[0][k], rise[1 - k], rings[1][k], rise[k]];
            let name = format!("film/r{row:02}/{column:03}/{}", ["first", "second"][k]);
            let id = patch(&mut m, &name, surface, edges, style("film", [0.9, 0.5, 0.1]));
            used.push(FaceUse { face: id, forward: true });
        }
    }
    let [outer, inner] = loops;
    let inner_loops = [inner, Vec::new(), outer, Vec::new()];
    for (i, (name, holes)) in ["inner", "rear", "outer", "front"].into_iter().zip(inner_loops).enumerate() {
        let j = (i + 1) % 4;
        let meridian = Curve::segment(DVec2::from(corners[i]), DVec2::from(corners[j]));
        // Holes' parameter curves hold x, the meridian runs over [0, 1].
        let (start, end) = (corners[i].0, corners[j].0);
        let on_meridian = |l: Loop| Loop {
            coedges: l
                .coedges
                .into_iter()
                .map(|c| Coedge {
                    pcurve: c.pcurve.map(|p| DVec2::new(p.x, (p.y - start) / (end - start))),
                    ..c
                })
                .collect(),
        };
        let side = |edge: EdgeId, p: (f64, f64), q: (f64, f64)| Coedge {
            edge,
            forward: true,
            pcurve: segment_on(m.edge(edge).curve.domain(), p.into(), q.into()),
        };
        let mut coedges = vec![
            side(arcs[i], (a, 0.0), (b, 0.0)),
            side(spans[i][1], (b, 0.0), (b, 1.0)),
            side(arcs[j], (a, 1.0), (b, 1.0)),
            side(spans[i][0], (a, 0.0), (a, 1.0)),
        ];
        coedges[2].forward = false;
        coedges[3].forward = false;
        let mut all = vec![Loop { coedges }];
        all.extend(holes.into_iter().map(on_meridian));
        let surface = SurfaceGeometry::Revolution(Revolution::new(meridian).unwrap());
        let id = face(&mut m, &format!("wall/{name}"), surface, all, style("wall", [0.6, 0.6, 0.65]));
        used.push(FaceUse { face: id, forward: true });
    }
    for k in 0..2 {
        let angle = [a, b][k];
        let radial = DVec3::new(0.0, angle.sin(), angle.cos());
        let (x, y) = if k == 0 { (radial, DVec3::X) } else { (DVec3::X, radial) };
        let plane = Plane { origin: m.vertex(v[0][k]), x, y };
        let edges: Vec<(EdgeId, bool)> = (0..4).map(|i| (spans[i][k], true)).collect();
        let bound = plane_loop(&m, &plane, &edges);
        let name = format!("wall/{}", ["start", "end"][k]);
        let id =
            face(&mut m, &name, SurfaceGeometry::Plane(plane), vec![bound], style("wall", [0.6, 0.6, 0.65]));
        let along = DVec3::new(0.0, plane.origin.z, -plane.origin.y);
        let forward = (x.cross(y).dot(along) > 0.0) == (k == 1);
        used.push(FaceUse { face: id, forward });
    }
    m.solids.push(solid("metal", vec![used], rows * columns));
    m
}
