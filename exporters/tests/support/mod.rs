//! Models built by hand: what the exporters are tried on.
#![allow(dead_code, unreachable_pub)]

pub mod airfoil;
pub mod blocks;
pub mod closed;
pub mod iges;
pub mod mesh;
pub mod perforated;
pub mod stl;
pub mod surfaces;

use coolinggen_brep::{
    Coedge, EdgeId, Face, FaceId, FaceUse, Loop, Model, Plane, Shell, Solid, Style, SurfaceGeometry, VertexId,
};
use coolinggen_nurbs::{Curve, ParametricCurve, Surface};
use glam::{DVec2, DVec3};

pub fn style(layer: &str, color: [f64; 3]) -> Style {
    Style { layer: layer.to_owned(), color }
}

pub fn line(model: &mut Model, a: VertexId, b: VertexId) -> EdgeId {
    let (p, q) = (model.vertex(a), model.vertex(b));
    model.add_edge(a, b, Curve::segment(p, q))
}

/// Area enclosed by a loop in the parameter plane, positive counterclockwise.
pub fn signed_area(bound: &Loop) -> f64 {
    let mut points = Vec::new();
    for c in &bound.coedges {
        points.extend((0..32).map(|i| c.parameter_at(f64::from(i) / 32.0)));
    }
    (0..points.len()).map(|i| 0.5 * points[i].perp_dot(points[(i + 1) % points.len()])).sum()
}

/// The loop run through the way a face needs it: the outer one counterclockwise, the inner ones clockwise.
pub fn oriented(mut bound: Loop, counterclockwise: bool) -> Loop {
    if (signed_area(&bound) > 0.0) != counterclockwise {
        bound.coedges.reverse();
        for c in &mut bound.coedges {
            c.forward = !c.forward;
        }
    }
    bound
}

/// A face with loops oriented as they must be; the first is the outer one.
pub fn face(
    model: &mut Model,
    name: &str,
    surface: SurfaceGeometry,
    loops: Vec<Loop>,
    style: Style,
) -> FaceId {
    let loops = loops.into_iter().enumerate().map(|(i, l)| oriented(l, i == 0)).collect();
    model.add_face(Face { name: name.to_owned(), surface, loops, style })
}

/// A loop of edges on a plane; curves are mapped into the plane's parameters control point by control point.
pub fn plane_loop(model: &Model, plane: &Plane, edges: &[(EdgeId, bool)]) -> Loop {
    let map = |p: &DVec3| DVec2::new((*p - plane.origin).dot(plane.x), (*p - plane.origin).dot(plane.y));
    let coedges = edges.iter().map(|&(edge, forward)| {
        let coolinggen_brep::EdgeCurve::BSpline(curve) = &model.edge(edge).curve else { unreachable!() };
        Coedge { edge, forward, pcurve: curve.map(map) }
    });
    Loop { coedges: coedges.collect() }
}

pub fn segment_on(domain: (f64, f64), a: DVec2, b: DVec2) -> Curve<DVec2> {
    Curve::segment(a, b).reparameterized(domain.0, domain.1)
}

/// A face over the whole domain of a B-spline surface: bottom and top run along u, left and right along v.
pub fn patch(
    model: &mut Model,
    name: &str,
    surface: Surface<DVec3>,
    [bottom, right, top, left]: [EdgeId; 4],
    style: Style,
) -> FaceId {
    let ((u0, u1), (v0, v1)) = (surface.knots_u().domain(), surface.knots_v().domain());
    let side = |edge: EdgeId, forward: bool, a: (f64, f64), b: (f64, f64)| Coedge {
        edge,
        forward,
        pcurve: segment_on(model.edge(edge).curve.domain(), a.into(), b.into()),
    };
    let coedges = vec![
        side(bottom, true, (u0, v0), (u1, v0)),
        side(right, true, (u1, v0), (u1, v1)),
        side(top, false, (u0, v1), (u1, v1)),
        side(left, false, (u0, v0), (u0, v1)),
    ];
    face(model, name, SurfaceGeometry::BSpline(surface), vec![Loop { coedges }], style)
}

pub fn uses(faces: &[FaceId], forward: bool) -> Vec<FaceUse> {
    faces.iter().map(|&face| FaceUse { face, forward }).collect()
}

pub fn solid(name: &str, shells: Vec<Vec<FaceUse>>, expected_genus: usize) -> Solid {
    let shells = shells.into_iter().map(|faces| Shell { faces }).collect();
    Solid { name: name.to_owned(), shells, expected_genus }
}

/// All models with solids, with their names.
pub fn all() -> Vec<(&'static str, Model)> {
    use airfoil::Walls;
    vec![
        ("box", blocks::cuboid()),
        ("hole", blocks::block_with_hole()),
        ("void", blocks::box_with_void()),
        ("cylinder", airfoil::hollow(Walls::Cylinder, 0.0, false)),
        ("cone", airfoil::hollow(Walls::Cone, 0.0, false)),
        ("cone_back", airfoil::hollow(Walls::Cone, 0.4, true)),
        ("general", airfoil::hollow(Walls::General, 0.3, false)),
        ("general_back", airfoil::hollow(Walls::General, 3.0, true)),
        ("disc", blocks::disc_sector()),
        ("thin", airfoil::hollow_with(Walls::Cone, 0.2, false, (19.9, 4.95))),
        ("saddle", surfaces::twisted_block()),
        ("round", surfaces::rational_cylinder()),
        ("perforated", perforated::sector(4, 5)),
    ]
}
