//! Walls of the annulus: hub and shroud as solids of revolution.

use super::error::BuildError;
use super::style;
use crate::design::{AnnulusWall, Pattern};
use coolinggen_blade::{Fault, StreamSpace, StreamSurface};
use coolinggen_brep::{
    Coedge, EdgeId, Face, FaceUse, Loop, Model, Revolution, Shell, Solid, SurfaceGeometry, VertexId,
    straight_pcurve,
};
use coolinggen_nurbs::{Curve, Interpolator, NurbsError, ParametricCurve};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Parts of the turn that the surfaces are cut into: closed faces with a seam are read less well.
const SECTORS: usize = 3;
/// Steps of the arcs' interpolation: quintic over 2.5 degrees, exact to rounding.
const STEPS: usize = 48;
/// Nodes of a contour's parallel in a span of the contour.
const PARALLEL: usize = 12;

/// Adds the walls that are asked for.
pub(super) fn add_walls(model: &mut Model, space: &StreamSpace, pattern: &Pattern) -> Result<(), BuildError> {
    for (wall, name, v) in [(&pattern.hub, "hub", 0.0), (&pattern.shroud, "shroud", 1.0)] {
        if let Some(wall) = wall {
            add_wall(model, &space.surface(v)?, wall, name, if v > 0.5 { 1.0 } else { -1.0 })?;
        }
    }
    Ok(())
}

/// Adds the wall behind a stream surface, on its side `outward`: 1 is away from the hub.
fn add_wall(
    model: &mut Model,
    stream: &StreamSurface,
    wall: &AnnulusWall,
    name: &str,
    outward: f64,
) -> Result<(), BuildError> {
    let SurfaceGeometry::Revolution(surface) = stream.geometry() else {
        let message = "a linear cascade has no solid of revolution";
        return Err(BuildError::Refused(vec![Fault::new(format!("/pattern/{name}"), "space", message)]));
    };
    let contour = surface.meridian();
    let away = |p: DVec2| {
        let gradient = stream.level(DVec3::new(p.x, 0.0, p.y)).1;
        DVec2::new(gradient.x, gradient.z) * outward
    };
    let greatest = greatest_thickness(contour, away);
    if !(wall.thickness < greatest) {
        let message = format!(
            "a parallel of the {name} contour {} mm away folds or meets the axis: it may be {greatest:.4} mm away",
            wall.thickness
        );
        let fault = Fault::new(format!("/pattern/{name}/thickness"), "geometry", message);
        return Err(BuildError::Refused(vec![fault.value(wall.thickness).max(greatest).unit("mm")]));
    }
    let back = parallel(contour, away, wall.thickness)?;
    let ends = |c: &Curve<DVec2>| [c.points()[0], c.points()[c.points().len() - 1]];
    let ([a, b], [d, c]) = (ends(contour), ends(&back));
    // Once round the section of the wall: each meridian, whether it runs along, and its name.
    let around = [
        (contour.clone(), true, "contour"),
        (Curve::segment(b, c), true, "end"),
        (back, false, "back"),
        (Curve::segment(d, a), true, "start"),
    ];
    let faces = revolved(model, &around, name)?;
    model.solids.push(Solid { name: name.to_owned(), shells: vec![Shell { faces }], expected_genus: 1 });
    Ok(())
}

/// The least of what takes a parallel to the axis and to the contour's centres of curvature.
fn greatest_thickness(contour: &Curve<DVec2>, away: impl Fn(DVec2) -> DVec2) -> f64 {
    nodes(contour).into_iter().fold(f64::INFINITY, |least, t| {
        let [p, d, dd] = contour.derivatives(t);
        let normal = away(p);
        let bend = dd.dot(normal) / d.length_squared();
        let to_centre = if bend > 0.0 { 1.0 / bend } else { f64::INFINITY };
        let to_axis = if normal.y < 0.0 { p.y / -normal.y } else { f64::INFINITY };
        least.min(to_centre).min(to_axis)
    })
}

fn nodes(contour: &Curve<DVec2>) -> Vec<f64> {
    let breaks = contour.breaks();
    let spans = breaks.windows(2);
    let each = |w: &[f64]| [w[0], w[1] - w[0]];
    let inner = spans
        .map(each)
        .flat_map(|[start, step]| (0..PARALLEL).map(move |k| start + step * k as f64 / PARALLEL as f64));
    inner.chain(breaks.last().copied()).collect()
}

/// A curve near the parallel at a distance; straight where the contour is.
fn parallel(
    contour: &Curve<DVec2>,
    away: impl Fn(DVec2) -> DVec2,
    distance: f64,
) -> Result<Curve<DVec2>, NurbsError> {
    let at = |t: f64| {
        let p = contour.point(t);
        p + away(p) * distance
    };
    if contour.degree() == 1 && contour.points().len() == 2 {
        let (start, end) = contour.domain();
        return Ok(Curve::segment(at(start), at(end)));
    }
    let nodes = nodes(contour);
    let points: Vec<DVec2> = nodes.iter().map(|&t| at(t)).collect();
    Interpolator::new(3, &nodes)?.curve(&points)
}

/// The faces of meridians, each turned round the axis in sectors, that close round a section.
fn revolved(
    model: &mut Model,
    around: &[(Curve<DVec2>, bool, &str); 4],
    name: &str,
) -> Result<Vec<FaceUse>, BuildError> {
    let angle = |sector: usize| TAU * sector as f64 / SECTORS as f64;
    let corner = |k: usize| {
        let (meridian, along, _) = &around[k];
        let points = meridian.points();
        if *along { points[0] } else { points[points.len() - 1] }
    };
    let lift = |p: DVec2, (sin, cos): (f64, f64)| DVec3::new(p.x, p.y * sin, p.y * cos);
    let mut vertices = [[VertexId(0); SECTORS]; 4];
    for (k, row) in vertices.iter_mut().enumerate() {
        for (s, vertex) in row.iter_mut().enumerate() {
            *vertex = model.add_vertex(lift(corner(k), angle(s).sin_cos()));
        }
    }
    // Arcs from sector to sector through corner k, and meridian k at the start of each sector.
    let (mut arcs, mut meridians) = ([[EdgeId(0); SECTORS]; 4], [[EdgeId(0); SECTORS]; 4]);
    let steps: Vec<f64> = (0..=STEPS).map(|i| i as f64 / STEPS as f64).collect();
    let interpolator = Interpolator::new(5, &steps)?;
    for k in 0..4 {
        let (meridian, along, _) = &around[k];
        for s in 0..SECTORS {
            let [start, end] = [vertices[k][s], vertices[k][(s + 1) % SECTORS]];
            let width = angle(1);
            let points: Vec<DVec3> =
                steps.iter().map(|f| lift(corner(k), (angle(s) + width * f).sin_cos())).collect();
            let arc = interpolator.curve(&points)?.with_ends(model.vertex(start), model.vertex(end));
            arcs[k][s] = model.add_edge(start, end, arc);
            let [mut start, mut end] = [vertices[k][s], vertices[(k + 1) % 4][s]];
            if !along {
                std::mem::swap(&mut start, &mut end);
            }
            let curve = meridian.map(|p| lift(*p, angle(s).sin_cos()));
            meridians[k][s] =
                model.add_edge(start, end, curve.with_ends(model.vertex(start), model.vertex(end)));
        }
    }
    let mut faces = Vec::with_capacity(4 * SECTORS);
    // The natural normal lies to the right of a meridian: out of the section if that runs counterclockwise.
    let counterclockwise = (corner(1) - corner(0)).perp_dot(corner(3) - corner(0)) > 0.0;
    for (k, (meridian, along, part)) in around.iter().enumerate() {
        let (low, high) = meridian.domain();
        let surface = Revolution::new(meridian.clone())?;
        let [first, last] = if *along { [k, (k + 1) % 4] } else { [(k + 1) % 4, k] };
        for s in 0..SECTORS {
            let [from, to] = [angle(s), angle(s) + angle(1)];
            let coedges = vec![
                Coedge {
                    edge: arcs[first][s],
                    forward: true,
                    pcurve: straight_pcurve(DVec2::new(from, low), DVec2::new(to, low), (0.0, 1.0))?,
                },
                Coedge {
                    edge: meridians[k][(s + 1) % SECTORS],
                    forward: true,
                    pcurve: straight_pcurve(DVec2::new(to, low), DVec2::new(to, high), (low, high))?,
                },
                Coedge {
                    edge: arcs[last][s],
                    forward: false,
                    pcurve: straight_pcurve(DVec2::new(from, high), DVec2::new(to, high), (0.0, 1.0))?,
                },
                Coedge {
                    edge: meridians[k][s],
                    forward: false,
                    pcurve: straight_pcurve(DVec2::new(from, low), DVec2::new(from, high), (low, high))?,
                },
            ];
            let face = model.add_face(Face {
                name: format!("{name}/{part}/{}", s + 1),
                surface: surface.clone().into(),
                loops: vec![Loop { coedges }],
                style: style::annulus(),
            });
            faces.push(FaceUse { face, forward: counterclockwise == *along });
        }
    }
    Ok(faces)
}
