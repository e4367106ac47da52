//! A hollow airfoil between surfaces of revolution: metal and coolant that share the cavity's faces.

use super::{face, patch, solid, style, uses};
use coolinggen_brep::{Coedge, EdgeId, FaceId, FaceUse, Loop, Model, Revolution, SurfaceGeometry, VertexId};
use coolinggen_nurbs::{Curve, Interpolator, Surface};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

#[derive(Clone, Copy, PartialEq)]
pub enum Walls {
    Cylinder,
    Cone,
    General,
}

const CUTS: [f64; 5] = [-0.5, 0.5, PI - 0.6, PI + 0.6, 2.0 * PI - 0.5];
const X: (f64, f64) = (-40.0, 40.0);

/// Radius of the stream surface at span fraction v.
fn radius(walls: Walls, x: f64, v: f64) -> f64 {
    let (hub, tip) = match walls {
        Walls::Cylinder => (250.0, 310.0),
        Walls::Cone => (250.0 + 0.27 * x, 310.0 - 0.18 * x),
        Walls::General => (250.0 + 6.0 * (x / 30.0).sin(), 310.0 - 4.0 * (x / 25.0 + 0.3).cos()),
    };
    (1.0 - v) * hub + v * tip
}

fn point(walls: Walls, s: f64, v: f64, (a, b): (f64, f64), lean: f64) -> (DVec3, DVec2) {
    let (x, y) = (a * s.cos(), b * s.sin() * (1.0 + 0.4 * s.cos()));
    let (sin, cos) = (0.5 + 0.4 * v).sin_cos();
    let (x, y) = (cos * x - sin * y, sin * x + cos * y);
    let (r, theta) = (radius(walls, x, v), y / (250.0 + 60.0 * v) + lean + 0.02 * v);
    (DVec3::new(x, r * theta.sin(), r * theta.cos()), DVec2::new(theta, x))
}

/// The meridian at span fraction v with x as its parameter, or with -x where it runs backwards.
fn meridian(walls: Walls, v: f64, backwards: bool) -> Curve<DVec2> {
    let forwards = if walls == Walls::General {
        let x: Vec<f64> = (0..=100).map(|i| X.0 + (X.1 - X.0) * f64::from(i) / 100.0).collect();
        let points: Vec<DVec2> = x.iter().map(|&x| DVec2::new(x, radius(walls, x, v))).collect();
        Interpolator::new(3, &x).unwrap().curve(&points).unwrap()
    } else {
        let end = |x: f64| DVec2::new(x, radius(walls, x, v));
        Curve::segment(end(X.0), end(X.1)).reparameterized(X.0, X.1)
    };
    if backwards { forwards.reversed().reparameterized(-X.1, -X.0) } else { forwards }
}

/// Edges of the four patches at both ends, the patches, and the ends' parameter curves (theta, x).
struct Tube {
    faces: Vec<FaceId>,
    rings: [Vec<(EdgeId, Curve<DVec2>)>; 2],
}

fn tube(m: &mut Model, walls: Walls, size: (f64, f64), top: f64, lean: f64) -> Tube {
    let cavity = top < 1.0;
    let prefix = if cavity { "chamber" } else { "blade" };
    let levels: Vec<f64> = (0..=6).map(|i| top * f64::from(i) / 6.0).collect();
    let along = Interpolator::new(3, &levels).unwrap();
    let mut surfaces: Vec<Surface<DVec3>> = Vec::new();
    let mut curves: [Vec<Curve<DVec2>>; 2] = [Vec::new(), Vec::new()];
    for k in 0..4 {
        let (a, b) = (CUTS[k], CUTS[k + 1]);
        let n = (96.0 * (b - a)).ceil() as usize;
        let at = |i: usize| if i == n { b } else { a + (b - a) * i as f64 / n as f64 };
        let t: Vec<f64> = (0..=n).map(at).collect();
        let fit = Interpolator::new(3, &t).unwrap();
        // The last cut is the first one, one turn on: take the same points.
        let s = |i: usize| if k == 3 && i == n { CUTS[0] } else { t[i] };
        let sections: Vec<Curve<DVec3>> = levels
            .iter()
            .map(|&v| {
                let points: Vec<DVec3> = (0..=n).map(|i| point(walls, s(i), v, size, lean).0).collect();
                fit.curve(&points).unwrap()
            })
            .collect();
        surfaces.push(along.loft(&sections).unwrap());
        for (end, v) in [(0, 0.0), (1, top)] {
            let points: Vec<DVec2> = (0..=n).map(|i| point(walls, s(i), v, size, lean).1).collect();
            curves[end].push(fit.curve(&points).unwrap());
        }
    }
    let net = |s: &Surface<DVec3>, j: usize| {
        let (nu, nv) = s.counts();
        let points = (0..nu).map(|i| s.points()[i * nv + if j == 0 { 0 } else { nv - 1 }]).collect();
        Curve::new(s.knots_u().clone(), points).unwrap()
    };
    let mut ring_edges: [Vec<EdgeId>; 2] = [Vec::new(), Vec::new()];
    let mut corners: [Vec<VertexId>; 2] = [Vec::new(), Vec::new()];
    for end in 0..2 {
        let rows: Vec<Curve<DVec3>> = surfaces.iter().map(|s| net(s, end)).collect();
        corners[end] = rows.iter().map(|c| m.add_vertex(c.points()[0])).collect();
        for (k, row) in rows.into_iter().enumerate() {
            ring_edges[end].push(m.add_edge(corners[end][k], corners[end][(k + 1) % 4], row));
        }
    }
    let rise: Vec<EdgeId> = (0..4)
        .map(|k| {
            let s = &surfaces[k];
            let curve = Curve::new(s.knots_v().clone(), s.points()[..s.counts().1].to_vec()).unwrap();
            m.add_edge(corners[0][k], corners[1][k], curve)
        })
        .collect();
    let mut faces = Vec::new();
    for (k, surface) in surfaces.into_iter().enumerate() {
        let name =
            format!("{prefix}/{}", ["leading_edge", "suction_side", "trailing_edge", "pressure_side"][k]);
        let edges = [ring_edges[0][k], rise[(k + 1) % 4], ring_edges[1][k], rise[k]];
        let color = if cavity { [0.1, 0.3, 0.8] } else { [0.7, 0.7, 0.7] };
        faces.push(patch(m, &name, surface, edges, style(prefix, color)));
    }
    let rings = [0, 1]
        .map(|end| ring_edges[end].iter().copied().zip(curves[end].iter().cloned()).collect::<Vec<_>>());
    Tube { faces, rings }
}

fn ring_loop(ring: &[(EdgeId, Curve<DVec2>)], backwards: bool) -> Loop {
    let sign = if backwards { -1.0 } else { 1.0 };
    let coedge = |(edge, pcurve): &(EdgeId, Curve<DVec2>)| Coedge {
        edge: *edge,
        forward: true,
        pcurve: pcurve.map(|p| DVec2::new(p.x, sign * p.y)),
    };
    Loop { coedges: ring.iter().map(coedge).collect() }
}

/// Metal and coolant, turned by `lean` radians about the axis, meridians running along +x or backwards.
pub fn hollow(walls: Walls, lean: f64, backwards: bool) -> Model {
    hollow_with(walls, lean, backwards, (16.0, 3.2))
}

/// The same with half length and half thickness of the cavity; the outer ones are 20 and 5 mm.
pub fn hollow_with(walls: Walls, lean: f64, backwards: bool, cavity: (f64, f64)) -> Model {
    let mut m = Model::default();
    let outer = tube(&mut m, walls, (20.0, 5.0), 1.0, lean);
    let inner = tube(&mut m, walls, cavity, 0.9, lean);
    let surface =
        |v: f64| SurfaceGeometry::Revolution(Revolution::new(meridian(walls, v, backwards)).unwrap());
    let rings = |r: &Tube, end: usize| ring_loop(&r.rings[end], backwards);
    let cap = |m: &mut Model, name: &str, v: f64, loops: Vec<Loop>| {
        face(m, name, surface(v), loops, style("caps", [0.3, 0.7, 0.3]))
    };
    let hub = cap(&mut m, "blade/hub", 0.0, vec![rings(&outer, 0), rings(&inner, 0)]);
    let tip = cap(&mut m, "blade/tip", 1.0, vec![rings(&outer, 1)]);
    let end = cap(&mut m, "chamber/end", 0.9, vec![rings(&inner, 1)]);
    let inlet = cap(&mut m, "coolant/inlet", 0.0, vec![rings(&inner, 0)]);
    // The natural normal of a revolution points to the axis where the meridian runs along +x.
    let inward = !backwards;
    let mut metal = uses(&outer.faces, true);
    metal.extend([
        FaceUse { face: hub, forward: inward },
        FaceUse { face: tip, forward: !inward },
        FaceUse { face: end, forward: inward },
    ]);
    metal.extend(uses(&inner.faces, false));
    let mut coolant = uses(&inner.faces, true);
    coolant.extend([FaceUse { face: end, forward: !inward }, FaceUse { face: inlet, forward: inward }]);
    m.solids.push(solid("metal", vec![metal], 0));
    m.solids.push(solid("coolant", vec![coolant], 0));
    m
}
