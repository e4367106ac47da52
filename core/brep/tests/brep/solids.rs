//! Solids to test with.

use coolinggen_brep::{
    EdgeCurve, EdgeId, FaceId, FaceUse, LoopEdges, Model, Plane, Revolution, Shell, Solid, Style, VertexId,
};
use coolinggen_nurbs::{
    Curve, Homogeneous, Interpolator, Knots, ParametricCurve, RationalCurve, RationalSurface, Surface,
    interpolate_closed,
};
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

pub(crate) fn style() -> Style {
    Style { layer: "test".into(), color: [0.5; 3] }
}

pub(crate) fn solid(name: &str, faces: &[(FaceId, bool)], expected_genus: usize) -> Solid {
    let faces = faces.iter().map(|&(face, forward)| FaceUse { face, forward }).collect();
    Solid { name: name.into(), shells: vec![Shell { faces }], expected_genus }
}

pub(crate) fn segment(model: &mut Model, a: VertexId, b: VertexId) -> EdgeId {
    let curve = Curve::segment(model.vertex(a), model.vertex(b));
    model.add_edge(a, b, curve)
}

/// A box with a corner at `origin`, faces out.
pub(crate) fn cuboid(origin: DVec3, size: DVec3) -> (Model, Solid) {
    let mut m = Model::default();
    let corner = |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
    let v: Vec<VertexId> = (0..8).map(|i| m.add_vertex(origin + corner(i) * size)).collect();
    let mut edges = std::collections::HashMap::new();
    let mut faces = Vec::new();
    // Corners counterclockwise seen from outside.
    for (name, ring) in [
        ("bottom", [0, 2, 3, 1]),
        ("top", [4, 5, 7, 6]),
        ("front", [0, 1, 5, 4]),
        ("back", [2, 6, 7, 3]),
        ("left", [0, 4, 6, 2]),
        ("right", [1, 3, 7, 5]),
    ] {
        let mut lp = Vec::new();
        for i in 0..4 {
            let (a, b) = (ring[i], ring[(i + 1) % 4]);
            let id = *edges
                .entry((a.min(b), a.max(b)))
                .or_insert_with(|| segment(&mut m, v[a.min(b)], v[a.max(b)]));
            lp.push((id, a < b));
        }
        let p = |i: usize| m.vertex(v[ring[i]]);
        let x = (p(1) - p(0)).normalize();
        let plane = Plane { origin: p(0), x, y: (p(3) - p(0)).normalize() };
        let loops = [LoopEdges { edges: &lp, near: DVec2::ZERO }];
        faces.push((m.trimmed_face(name, plane, &loops, 1e-12, style()).unwrap(), true));
    }
    let solid = solid("box", &faces, 0);
    m.solids.push(solid.clone());
    (m, solid)
}

/// Half a turn about the x axis from `theta`: rational, two spans, exact.
pub(crate) fn half_turn(x: f64, r: f64, theta: f64) -> RationalCurve<DVec3> {
    let points: Vec<DVec3> = (0..5)
        .map(|i| {
            let (sin, cos) = (theta + FRAC_PI_2 * 0.5 * f64::from(i)).sin_cos();
            let r = if i % 2 == 1 { r * 2f64.sqrt() } else { r };
            DVec3::new(x, r * sin, r * cos)
        })
        .collect();
    let w = 0.5f64.sqrt();
    let knots = Knots::new(2, vec![0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0]).unwrap();
    RationalCurve::new(knots, &points, &[1.0, w, 1.0, w, 1.0]).unwrap()
}

/// The solid of revolution about the x axis of a polygon `(x, r)` that runs counterclockwise: two faces a side.
/// With `exact`, parameter curves are straight lines (and leave the circles' parametrization aside).
pub(crate) fn revolved(polygon: &[DVec2], exact: bool) -> (Model, Solid) {
    let mut m = Model::default();
    let n = polygon.len();
    let at = |p: DVec2, half: usize| {
        let (sin, cos) = (PI * half as f64).sin_cos();
        DVec3::new(p.x, p.y * sin, p.y * cos)
    };
    // Ends of the half turns, as these compute them.
    let turns: Vec<[RationalCurve<DVec3>; 2]> =
        polygon.iter().map(|p| [0.0, PI].map(|theta| half_turn(p.x, p.y, theta))).collect();
    let v: Vec<[VertexId; 2]> =
        polygon.iter().map(|&p| [0, 1].map(|half| m.add_vertex(at(p, half)))).collect();
    let arcs: Vec<[EdgeId; 2]> = (0..n)
        .map(|i| [0, 1].map(|half| m.add_edge(v[i][half], v[i][1 - half], turns[i][half].clone())))
        .collect();
    let sides: Vec<[EdgeId; 2]> =
        (0..n).map(|i| [0, 1].map(|half| segment(&mut m, v[i][half], v[(i + 1) % n][half]))).collect();
    let mut faces = Vec::new();
    for i in 0..n {
        let j = (i + 1) % n;
        let surface = Revolution::new(Curve::segment(polygon[i], polygon[j])).unwrap();
        for half in 0..2 {
            let lp = [
                (arcs[i][half], true),
                (sides[i][1 - half], true),
                (arcs[j][half], false),
                (sides[i][half], false),
            ];
            let loops = [LoopEdges { edges: &lp, near: DVec2::new(PI * half as f64, 0.0) }];
            let name = format!("side/{i}/{half}");
            let id = m.trimmed_face(name, surface.clone(), &loops, 2e-7, style()).unwrap();
            if exact {
                for coedge in &mut m.faces[id.0].loops[0].coedges {
                    let c = &coedge.pcurve;
                    let (a, b) = (c.points()[0], c.points()[c.points().len() - 1]);
                    // Angles are whole half turns, parameters 0 or 1.
                    let round = |p: DVec2| DVec2::new((p.x / PI).round() * PI, p.y.round());
                    coedge.pcurve = Curve::segment(round(a), round(b));
                }
            }
            // With the meridian counterclockwise in (x, r), theta x t points out of the material.
            faces.push((id, true));
        }
    }
    let solid = solid("revolved", &faces, 1);
    m.solids.push(solid.clone());
    (m, solid)
}

/// Area and centroid of a polygon.
pub(crate) fn polygon_mass(polygon: &[DVec2]) -> (f64, DVec2) {
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    for i in 0..polygon.len() {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        area += 0.5 * a.perp_dot(b);
        moment += (a + b) * (a.perp_dot(b) / 6.0);
    }
    (area, moment / area)
}

fn quarter(i: usize) -> [(DVec2, f64); 3] {
    let at = |k: usize| DVec2::from_angle(FRAC_PI_2 * 0.5 * k as f64);
    [(at(2 * i), 1.0), (at(2 * i + 1), 0.5f64.sqrt()), (at(2 * i + 2), 1.0)]
        .map(|(p, w)| (p / w.powi(2).sqrt(), w))
}

/// A torus from 16 rational biquadratic patches, turned and moved.
pub(crate) fn torus(great: f64, small: f64, turn: DMat3, shift: DVec3) -> (Model, Solid) {
    let mut m = Model::default();
    let knots = || Knots::clamped(2, &[0.0, 1.0]).unwrap();
    let patch = |i: usize, j: usize| {
        let mut net = Vec::new();
        for (a, wa) in quarter(i) {
            for (b, wb) in quarter(j) {
                let ring = great + small * b.x;
                let p = DVec3::new(ring * a.x, ring * a.y, small * b.y);
                net.push(Homogeneous::new(turn * p + shift, wa * wb));
            }
        }
        RationalSurface::from_homogeneous(Surface::new(knots(), knots(), net).unwrap()).unwrap()
    };
    let patches: Vec<_> = (0..16).map(|k| patch(k / 4, k % 4)).collect();
    let faces = quilt(&mut m, &patches, 4, 4);
    let solid = solid("torus", &faces, 1);
    m.solids.push(solid.clone());
    (m, solid)
}

/// Faces of patches `[i * nj + j]` that close both ways; edges are their borders.
fn quilt(m: &mut Model, patches: &[RationalSurface<DVec3>], ni: usize, nj: usize) -> Vec<(FaceId, bool)> {
    let iso = |s: &RationalSurface<DVec3>, axis: usize| {
        let h = if axis == 0 { s.homogeneous().iso_v(0.0) } else { s.homogeneous().iso_u(0.0) };
        RationalCurve::from_homogeneous(h).unwrap()
    };
    let v: Vec<VertexId> = patches
        .iter()
        .map(|s| {
            let p = iso(s, 0).point(0.0);
            m.add_vertex(p)
        })
        .collect();
    let index = |i: usize, j: usize| (i % ni) * nj + j % nj;
    let mut edges = Vec::new();
    for i in 0..ni {
        for j in 0..nj {
            let s = &patches[index(i, j)];
            let along_u = m.add_edge(v[index(i, j)], v[index(i + 1, j)], iso(s, 0));
            let along_v = m.add_edge(v[index(i, j)], v[index(i, j + 1)], iso(s, 1));
            edges.push([along_u, along_v]);
        }
    }
    let mut faces = Vec::new();
    for i in 0..ni {
        for j in 0..nj {
            let e = |i: usize, j: usize, axis: usize| edges[index(i, j)][axis];
            let borders = [e(i, j, 0), e(i + 1, j, 1), e(i, j + 1, 0), e(i, j, 1)];
            let borders = [&borders[..1], &borders[1..2], &borders[2..3], &borders[3..4]];
            let id = m
                .patch_face(format!("patch/{i}/{j}"), patches[index(i, j)].clone(), borders, style())
                .unwrap();
            faces.push((id, true));
        }
    }
    faces
}

/// A sphere from 8 octants, each with a border that has shrunk to a pole.
pub(crate) fn sphere(radius: f64, center: DVec3) -> (Model, Solid) {
    let mut m = Model::default();
    let knots = || Knots::clamped(2, &[0.0, 1.0]).unwrap();
    let poles = [-1.0, 1.0].map(|z| m.add_vertex(center + DVec3::new(0.0, 0.0, radius * z)));
    let equator: Vec<VertexId> = (0..4)
        .map(|i| m.add_vertex(center + DVec2::from_angle(FRAC_PI_2 * f64::from(i)).extend(0.0) * radius))
        .collect();
    // Quadrants 3 and 0 of the meridian: south pole to equator, equator to north pole.
    let patch = |i: usize, north: bool| {
        let mut net = Vec::new();
        for (a, wa) in quarter(i) {
            for (b, wb) in quarter(if north { 0 } else { 3 }) {
                let b = if b.x.abs() < 1e-12 { DVec2::new(0.0, b.y) } else { b };
                net.push(Homogeneous::new(center + DVec3::new(b.x * a.x, b.x * a.y, b.y) * radius, wa * wb));
            }
        }
        RationalSurface::from_homogeneous(Surface::new(knots(), knots(), net).unwrap()).unwrap()
    };
    let patches: Vec<[_; 2]> = (0..4).map(|i| [false, true].map(|north| patch(i, north))).collect();
    let curve = |h| EdgeCurve::Rational(RationalCurve::from_homogeneous(h).unwrap());
    let mut around = Vec::new();
    let mut up = Vec::new();
    for i in 0..4 {
        let [south, north] = &patches[i];
        around.push(m.add_edge(equator[i], equator[(i + 1) % 4], curve(north.homogeneous().iso_v(0.0))));
        up.push([
            m.add_edge(poles[0], equator[i], curve(south.homogeneous().iso_u(0.0))),
            m.add_edge(equator[i], poles[1], curve(north.homogeneous().iso_u(0.0))),
        ]);
    }
    let mut faces = Vec::new();
    for i in 0..4 {
        let j = (i + 1) % 4;
        let [south, north] = &patches[i];
        let borders: [&[EdgeId]; 4] = [&[], &[up[j][0]], &[around[i]], &[up[i][0]]];
        faces.push((m.patch_face(format!("south/{i}"), south.clone(), borders, style()).unwrap(), true));
        let borders: [&[EdgeId]; 4] = [&[around[i]], &[up[j][1]], &[], &[up[i][1]]];
        faces.push((m.patch_face(format!("north/{i}"), north.clone(), borders, style()).unwrap(), true));
    }
    let solid = solid("sphere", &faces, 0);
    m.solids.push(solid.clone());
    (m, solid)
}

/// Closed sections that wobble as `wave` says, lofted into a tube with flat ends, two faces round. `n` spans in
/// each half, `levels` sections.
pub(crate) struct Tube {
    pub(crate) model: Model,
    /// Halves of the wall.
    pub(crate) walls: [FaceId; 2],
    pub(crate) caps: [FaceId; 2],
    pub(crate) solid: Solid,
}

pub(crate) fn tube(n: usize, levels: usize, wave: &[f64], turn: DMat3, shift: DVec3) -> Tube {
    let closed: Vec<Curve<DVec3>> = (0..levels).map(|k| section(n, k, levels, wave, turn, shift)).collect();
    let heights: Vec<f64> = (0..levels).map(|k| k as f64 / (levels - 1) as f64).collect();
    let loft = Interpolator::new(3, &heights).unwrap();
    let mut m = Model::default();
    let halves = [0, 1].map(|half| {
        let sections: Vec<Curve<DVec3>> = closed.iter().map(|c| half_of(c, half)).collect();
        loft.loft(&sections).unwrap()
    });
    let corner = |half: usize, v: f64| halves[half].iso_v(v).points()[0];
    let v: Vec<[VertexId; 2]> =
        [0.0, 1.0].iter().map(|&z| [0, 1].map(|half| m.add_vertex(corner(half, z)))).collect();
    let rings: Vec<[EdgeId; 2]> = [0.0, 1.0]
        .iter()
        .enumerate()
        .map(|(k, &z)| [0, 1].map(|half| m.add_edge(v[k][half], v[k][1 - half], halves[half].iso_v(z))))
        .collect();
    let seams = [0, 1].map(|half| m.add_edge(v[0][half], v[1][half], halves[half].iso_u(0.0)));
    let walls = [0, 1].map(|half| {
        let borders = [rings[0][half], seams[1 - half], rings[1][half], seams[half]];
        let borders = [&borders[..1], &borders[1..2], &borders[2..3], &borders[3..4]];
        m.patch_face(format!("wall/{half}"), halves[half].clone(), borders, style()).unwrap()
    });
    let caps = [0, 1].map(|k| {
        let origin = shift + turn * DVec3::new(0.0, 0.0, 20.0 * k as f64);
        let plane = Plane { origin, x: turn.x_axis, y: turn.y_axis };
        let lp = [(rings[k][0], true), (rings[k][1], true)];
        let loops = [LoopEdges { edges: &lp, near: DVec2::ZERO }];
        m.trimmed_face(format!("cap/{k}"), plane, &loops, 1e-10, style()).unwrap()
    });
    let solid = solid("tube", &[(walls[0], true), (walls[1], true), (caps[0], false), (caps[1], true)], 0);
    m.solids.push(solid.clone());
    Tube { model: m, walls, caps, solid }
}

/// A closed cubic through `2 n` points, counterclockwise seen along -z, in the plane of its level.
fn section(n: usize, level: usize, levels: usize, wave: &[f64], turn: DMat3, shift: DVec3) -> Curve<DVec3> {
    let z = 20.0 * level as f64 / (levels - 1) as f64;
    let points: Vec<DVec3> = (0..=2 * n)
        .map(|i| {
            let a = TAU * (i % (2 * n)) as f64 / (2 * n) as f64;
            let wobble: f64 =
                wave.iter().enumerate().map(|(k, w)| w * ((k + 1) as f64 * a + z * w * 0.3).sin()).sum();
            turn * (DVec2::from_angle(a) * (5.0 + wobble)).extend(z) + shift
        })
        .collect();
    let t: Vec<f64> = (0..=2 * n).map(|i| i as f64 / n as f64).collect();
    interpolate_closed(&t, &points).unwrap()
}

/// The part of a closed section on [0, 1] or [1, 2], on the domain [0, 1], by interpolation on the same knots with
/// the same end slopes: for a cubic spline, the same curve.
fn half_of(c: &Curve<DVec3>, half: usize) -> Curve<DVec3> {
    let breaks: Vec<f64> =
        c.breaks().into_iter().filter(|t| (0.0..=1.0).contains(&(t - half as f64))).collect();
    let points: Vec<DVec3> = breaks.iter().map(|&t| c.point(t)).collect();
    let mut points = points;
    if half == 1 {
        // Closed bit for bit.
        let last = points.len() - 1;
        points[last] = c.point(0.0);
    }
    let t: Vec<f64> = breaks.iter().map(|t| t - half as f64).collect();
    let slope = |t: f64| c.derivatives(t)[1];
    let (start, end) = (slope(half as f64), slope(half as f64 + 1.0));
    Interpolator::with_slopes(&t).unwrap().curve_with_slopes(&points, start, end).unwrap()
}

/// A rotation from three angles.
pub(crate) fn rotation(a: f64, b: f64, c: f64) -> DMat3 {
    DMat3::from_euler(glam::EulerRot::XYZ, a, b, c)
}
