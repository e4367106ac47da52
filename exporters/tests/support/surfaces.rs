//! Shapes chosen for their surfaces: twisted, rational, bumpy and trimmed.

use super::{face, line, patch, plane_loop, segment_on, solid, style, uses};
use coolinggen_brep::{
    Coedge, EdgeCurve, EdgeId, FaceId, FaceUse, Loop, Model, Plane, SurfaceGeometry, VertexId,
};
use coolinggen_nurbs::{
    Interpolator, Knots, ParametricCurve, ParametricSurface, RationalCurve, RationalSurface, Surface,
};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A block whose top is a hyperbolic paraboloid between four straight edges.
pub fn twisted_block() -> Model {
    let mut m = Model::default();
    let xy = [(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 30.0)];
    let heights = [10.0, 20.0, 8.0, 16.0];
    let low: Vec<VertexId> = xy.iter().map(|&(x, y)| m.add_vertex(DVec3::new(x, y, 0.0))).collect();
    let high: Vec<VertexId> =
        xy.iter().zip(heights).map(|(&(x, y), z)| m.add_vertex(DVec3::new(x, y, z))).collect();
    let lower: Vec<EdgeId> = (0..4).map(|i| line(&mut m, low[i], low[(i + 1) % 4])).collect();
    let rise: Vec<EdgeId> = (0..4).map(|i| line(&mut m, low[i], high[i])).collect();
    // Edges of the top in the directions of u and v.
    let upper = [(0, 1), (1, 2), (3, 2), (0, 3)].map(|(a, b)| line(&mut m, high[a], high[b]));
    let mut faces: Vec<FaceId> = Vec::new();
    let grey = [0.5, 0.5, 0.5];
    for i in 0..4 {
        let origin = m.vertex(low[i]);
        let x = (m.vertex(low[(i + 1) % 4]) - origin).normalize();
        let plane = Plane { origin, x, y: DVec3::Z };
        let edges = [(lower[i], true), (rise[(i + 1) % 4], true), (upper[i], i >= 2), (rise[i], false)];
        let bound = plane_loop(&m, &plane, &edges);
        faces.push(face(
            &mut m,
            &format!("side/{i}"),
            SurfaceGeometry::Plane(plane),
            vec![bound],
            style("side", grey),
        ));
    }
    let plane = Plane { origin: DVec3::ZERO, x: DVec3::Y, y: DVec3::X };
    let edges: Vec<(EdgeId, bool)> = lower.iter().rev().map(|&e| (e, false)).collect();
    let bound = plane_loop(&m, &plane, &edges);
    faces.push(face(&mut m, "bottom", SurfaceGeometry::Plane(plane), vec![bound], style("side", grey)));
    let knots = Knots::clamped(1, &[0.0, 1.0]).unwrap();
    let net = [0, 3, 1, 2].map(|i| m.vertex(high[i])).to_vec();
    let surface = Surface::new(knots.clone(), knots, net).unwrap();
    faces.push(patch(&mut m, "top", surface, upper, style("top", [0.8, 0.2, 0.2])));
    m.solids.push(solid("metal", vec![uses(&faces, true)], 0));
    m
}

/// A cylinder about z of radius 5 and height 8 from four rational patches with rational borders.
pub fn rational_cylinder() -> Model {
    let mut m = Model::default();
    let corner = |k: usize, z: f64| {
        let (x, y) = [(5.0, 0.0), (0.0, 5.0), (-5.0, 0.0), (0.0, -5.0)][k % 4];
        DVec3::new(x, y, z)
    };
    let weights = [1.0, 0.5f64.sqrt(), 1.0];
    let knots = Knots::clamped(2, &[0.0, 1.0]).unwrap();
    let net = |k: usize, z: f64| {
        let (a, c) = (corner(k, z), corner(k + 1, z));
        [a, DVec3::new(a.x + c.x, a.y + c.y, z), c]
    };
    let levels = [0.0, 8.0];
    let v = levels.map(|z| [0, 1, 2, 3].map(|k| m.add_vertex(corner(k, z))));
    let arcs = [0, 1].map(|e| {
        [0, 1, 2, 3].map(|k| {
            let arc = RationalCurve::new(knots.clone(), &net(k, levels[e]), &weights).unwrap();
            m.add_edge(v[e][k], v[e][(k + 1) % 4], EdgeCurve::Rational(arc))
        })
    });
    let rise = [0, 1, 2, 3].map(|k| line(&mut m, v[0][k], v[1][k]));
    let mut used = Vec::new();
    let corners: [(f64, f64); 4] = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    for k in 0..4 {
        let points: Vec<DVec3> = net(k, 0.0).into_iter().zip(net(k, 8.0)).flat_map(|(a, b)| [a, b]).collect();
        let doubled: Vec<f64> = weights.iter().flat_map(|&w| [w, w]).collect();
        let straight = Knots::clamped(1, &[0.0, 1.0]).unwrap();
        let surface = RationalSurface::new(knots.clone(), straight, &points, &doubled).unwrap();
        let side = |edge: EdgeId, forward: bool, a: usize, b: usize| Coedge {
            edge,
            forward,
            pcurve: segment_on((0.0, 1.0), corners[a].into(), corners[b].into()),
        };
        let coedges = vec![
            side(arcs[0][k], true, 0, 1),
            side(rise[(k + 1) % 4], true, 1, 2),
            side(arcs[1][k], false, 3, 2),
            side(rise[k], false, 0, 3),
        ];
        let name = format!("side/{k}");
        let surface = SurfaceGeometry::Rational(surface);
        let id = face(&mut m, &name, surface, vec![Loop { coedges }], style("side", [0.3, 0.3, 0.8]));
        used.push(FaceUse { face: id, forward: true });
    }
    let t: Vec<f64> = (0..=64).map(|i| f64::from(i) / 64.0).collect();
    let fit = Interpolator::new(5, &t).unwrap();
    for (e, name) in ["bottom", "top"].into_iter().enumerate() {
        let origin = DVec3::new(0.0, 0.0, levels[e]);
        let plane = if e == 0 {
            Plane { origin, x: DVec3::Y, y: DVec3::X }
        } else {
            Plane { origin, x: DVec3::X, y: DVec3::Y }
        };
        let coedges = arcs[e].iter().map(|&edge| {
            let on_plane = |p: DVec3| DVec2::new((p - origin).dot(plane.x), (p - origin).dot(plane.y));
            let points: Vec<DVec2> = t.iter().map(|&t| on_plane(m.edge(edge).curve.point(t))).collect();
            Coedge { edge, forward: true, pcurve: fit.curve(&points).unwrap() }
        });
        let bound = Loop { coedges: coedges.collect() };
        let surface = SurfaceGeometry::Plane(plane);
        let id = face(&mut m, name, surface, vec![bound], style("caps", [0.8, 0.8, 0.3]));
        used.push(FaceUse { face: id, forward: true });
    }
    m.solids.push(solid("metal", vec![used], 0));
    m
}

/// No solid: one face of a surface with bumps of `height` mm inside an ellipse of its parameters, with a hole of
/// `hole` times the surface's extent.
pub fn trimmed_bumps(height: f64, phase: f64, hole: f64) -> Model {
    let mut m = Model::default();
    let (ku, kv) = (Knots::uniform(3, 20).unwrap(), Knots::uniform(3, 12).unwrap());
    let net = (0..20)
        .flat_map(|i| (0..12).map(move |j| (f64::from(i), f64::from(j))))
        .map(|(i, j)| {
            DVec3::new(4.0 * i, 5.0 * j, height * (0.9 * i + phase).sin() * (0.7 * j + 0.05 * i * j).cos())
        })
        .collect();
    let surface = Surface::new(ku, kv, net).unwrap();
    let t: Vec<f64> = (0..=400).map(|i| f64::from(i) / 400.0).collect();
    let fit = Interpolator::new(3, &t).unwrap();
    let mut loops = Vec::new();
    for (center, size) in [((0.5, 0.5), 0.45), ((0.6, 0.55), hole)] {
        let at = |a: f64| DVec2::from(center) + size * DVec2::new((TAU * a).cos(), (TAU * a).sin());
        let halves = [0.0, 0.5].map(|start| {
            let flat: Vec<DVec2> = t.iter().map(|&t| at((start + 0.5 * t) % 1.0)).collect();
            fit.curve(&flat).unwrap()
        });
        let vertices = halves.each_ref().map(|h| {
            let p = h.points()[0];
            m.add_vertex(surface.point(p.x, p.y))
        });
        let coedges = [0, 1].map(|k| {
            let mut points: Vec<DVec3> = t
                .iter()
                .map(|&t| {
                    let p = halves[k].point(t);
                    surface.point(p.x, p.y)
                })
                .collect();
            points[0] = m.vertex(vertices[k]);
            points[400] = m.vertex(vertices[1 - k]);
            let edge = m.add_edge(vertices[k], vertices[1 - k], fit.curve(&points).unwrap());
            Coedge { edge, forward: true, pcurve: halves[k].clone() }
        });
        loops.push(Loop { coedges: coedges.to_vec() });
    }
    face(&mut m, "bumps", SurfaceGeometry::BSpline(surface), loops, style("bumps", [0.4, 0.6, 0.4]));
    m
}

/// No solid: a quarter of a flat ring between radii of 40 and 50 mm in polar parameters, with a window whose outer side
/// runs `gap` mm inside the ring's outer border at one end, and ten times as far at the other. In the parameters both are
/// straight; in space the border's chords cut into the window.
pub fn window_near_border(gap: f64) -> Model {
    let mut m = Model::default();
    let weights = [1.0, 0.5f64.sqrt(), 1.0];
    let net: Vec<DVec3> = [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
        .into_iter()
        .flat_map(|(x, y)| [50.0, 40.0].map(|r| DVec3::new(r * x, r * y, 0.0)))
        .collect();
    let doubled: Vec<f64> = weights.iter().flat_map(|&w| [w, w]).collect();
    let (ku, kv) = (Knots::clamped(2, &[0.0, 1.0]).unwrap(), Knots::clamped(1, &[0.0, 1.0]).unwrap());
    let surface = RationalSurface::new(ku, kv, &net, &doubled).unwrap();
    let t: Vec<f64> = (0..=200).map(|i| f64::from(i) / 200.0).collect();
    let fit = Interpolator::new(3, &t).unwrap();
    let at = |p: DVec2| surface.point(p.x, p.y);
    let near = gap / 10.0;
    let outer = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let window = [(0.3, near), (0.7, 10.0 * near), (0.7, 0.5), (0.3, 0.5)];
    let mut loops = Vec::new();
    for corners in [outer, window] {
        let corners = corners.map(DVec2::from);
        let vertices = corners.map(|p| m.add_vertex(at(p)));
        let mut coedges = Vec::new();
        for k in 0..4 {
            let next = (k + 1) % 4;
            let pcurve = segment_on((0.0, 1.0), corners[k], corners[next]);
            let mut points: Vec<DVec3> = t.iter().map(|&t| at(pcurve.point(t))).collect();
            points[0] = m.vertex(vertices[k]);
            points[200] = m.vertex(vertices[next]);
            let edge = m.add_edge(vertices[k], vertices[next], fit.curve(&points).unwrap());
            coedges.push(Coedge { edge, forward: true, pcurve });
        }
        loops.push(Loop { coedges });
    }
    face(&mut m, "ring", SurfaceGeometry::Rational(surface), loops, style("ring", [0.4, 0.6, 0.4]));
    m
}
