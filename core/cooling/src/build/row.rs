//! Rows: copies of a blade around the machine axis.

use super::annulus::add_walls;
use super::error::BuildError;
use super::tube::meet;
use crate::design::Pattern;
use crate::watch::Watch;
use coolinggen_blade::{Blade, Fault, StreamSpace, StreamSurface};
use coolinggen_brep::{
    Coedge, Edge, EdgeCurve, EdgeId, Face, FaceId, FaceUse, Loop, Model, Plane, Shell, Solid,
    SurfaceGeometry, VertexId,
};
use coolinggen_nurbs::{Homogeneous, NurbsError, ParametricSurface, RationalCurve, RationalSurface};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Stream surfaces on which neighbours are looked at, and nodes round the blade there.
const LEVELS: usize = 12;
const NODES: usize = 240;

/// Adds to a blade's model the other blades of its row, and hub and shroud where they are asked for.
///
/// # Errors
/// [`BuildError::Refused`] for blades that cut into each other, a linear cascade, and walls too thick for their contour.
pub fn add_row(
    model: &mut Model,
    blade: &Blade,
    space: &StreamSpace,
    pattern: &Pattern,
    watch: &dyn Watch,
) -> Result<(), BuildError> {
    if matches!(space, StreamSpace::Linear(_)) {
        let message = "a row around the machine axis needs an annular space";
        return Err(BuildError::Refused(vec![Fault::new("/pattern", "space", message)]));
    }
    check_room(blade, space, pattern.count)?;
    repeat(model, pattern.count, watch)?;
    add_walls(model, space, pattern)
}

/// Copies all solids of `model`, turned about the axis: `count` of each in all, evenly spread.
fn repeat(model: &mut Model, count: u32, watch: &dyn Watch) -> Result<(), BuildError> {
    let first = model.clone();
    for k in 1..count {
        watch.go_on()?;
        let angle = TAU * f64::from(k) / f64::from(count);
        let turn = Turn { sin: angle.sin(), cos: angle.cos() };
        let name = |name: &str| format!("{name}/{}", k + 1);
        let (vertices, edges, faces) = (model.vertices.len(), model.edges.len(), model.faces.len());
        model.vertices.extend(first.vertices.iter().map(|p| turn.point(*p)));
        for edge in &first.edges {
            let [start, end] = [edge.start, edge.end].map(|v| VertexId(v.0 + vertices));
            model.edges.push(Edge { start, end, curve: turn.curve(&edge.curve)? });
        }
        for face in &first.faces {
            // A surface of revolution stays what it is: its faces move in its parameter.
            let moved = matches!(face.surface, SurfaceGeometry::Revolution(_));
            let shift = DVec2::new(if moved { angle } else { 0.0 }, 0.0);
            let coedge = |c: &Coedge| Coedge {
                edge: EdgeId(c.edge.0 + edges),
                forward: c.forward,
                pcurve: c.pcurve.map(|p| *p + shift),
            };
            let bound = |l: &Loop| Loop { coedges: l.coedges.iter().map(coedge).collect() };
            model.faces.push(Face {
                name: name(&face.name),
                surface: turn.surface(&face.surface)?,
                loops: face.loops.iter().map(bound).collect(),
                style: face.style.clone(),
            });
        }
        for solid in &first.solids {
            let used = |f: &FaceUse| FaceUse { face: FaceId(f.face.0 + faces), forward: f.forward };
            let shell = |s: &Shell| Shell { faces: s.faces.iter().map(used).collect() };
            model.solids.push(Solid {
                name: name(&solid.name),
                shells: solid.shells.iter().map(shell).collect(),
                expected_genus: solid.expected_genus,
            });
        }
    }
    Ok(())
}

/// A turn about the machine axis.
struct Turn {
    sin: f64,
    cos: f64,
}

impl Turn {
    fn point(&self, p: DVec3) -> DVec3 {
        DVec3::new(p.x, p.y * self.cos + p.z * self.sin, p.z * self.cos - p.y * self.sin)
    }

    fn weighted(&self, p: &Homogeneous<DVec3>) -> Homogeneous<DVec3> {
        Homogeneous { weighted: self.point(p.weighted), weight: p.weight }
    }

    fn curve(&self, curve: &EdgeCurve) -> Result<EdgeCurve, NurbsError> {
        Ok(match curve {
            EdgeCurve::BSpline(c) => c.map(|p| self.point(*p)).into(),
            EdgeCurve::Rational(c) => {
                RationalCurve::from_homogeneous(c.homogeneous().map(|p| self.weighted(p)))?.into()
            }
        })
    }

    fn surface(&self, surface: &SurfaceGeometry) -> Result<SurfaceGeometry, NurbsError> {
        Ok(match surface {
            SurfaceGeometry::BSpline(s) => s.map(|p| self.point(*p)).into(),
            SurfaceGeometry::Rational(s) => {
                RationalSurface::from_homogeneous(s.homogeneous().map(|p| self.weighted(p)))?.into()
            }
            SurfaceGeometry::Plane(p) => {
                let [origin, x, y] = [p.origin, p.x, p.y].map(|p| self.point(p));
                Plane { origin, x, y }.into()
            }
            SurfaceGeometry::Revolution(r) => r.clone().into(),
        })
    }
}

/// Refuses a count of blades that cut into their neighbours, and says how many would not.
fn check_room(blade: &Blade, space: &StreamSpace, count: u32) -> Result<(), BuildError> {
    if count < 2 {
        return Ok(());
    }
    let mut sections = Vec::new();
    for j in 0..LEVELS {
        let level = j as f64 / (LEVELS - 1) as f64;
        let stream = space.surface(level)?;
        if let Some(outline) = outline(blade, &stream, level) {
            // The chart is as wide as the reference radius times the angle.
            let [zero, one] = [0.0, 1.0].map(|t| stream.parameters_of_chart(DVec2::new(0.0, t)).x);
            sections.push((level, outline, TAU / (one - zero)));
        }
    }
    let tight = |count: u32| {
        sections.iter().find(|(_, outline, turn)| cross(outline, DVec2::new(0.0, turn / f64::from(count))))
    };
    let Some((level, ..)) = tight(count) else { return Ok(()) };
    let most = (1..count).rev().find(|&n| n < 2 || tight(n).is_none()).unwrap_or(1);
    let message = format!("of {count} blades each cuts into the next at span fraction {level:.2}");
    let fault =
        Fault::new("/pattern/count", "geometry", message).value(f64::from(count)).max(f64::from(most));
    Err(BuildError::Refused(vec![fault]))
}

/// The blade's section with a stream surface, in its chart; none where the blade has ended.
fn outline(blade: &Blade, stream: &StreamSurface, level: f64) -> Option<Vec<DVec2>> {
    let (_, (low, high)) = blade.surface.domain();
    let mut v = low + (high - low) * level.clamp(0.05, 0.95);
    (0..NODES)
        .map(|i| {
            let u = i as f64 / NODES as f64;
            v = meet(&blade.surface, u, v, stream)?;
            Some(stream.to_chart(blade.surface.point(u, v)))
        })
        .collect()
}

/// Whether a closed polygon and its copy moved by `shift` cross.
fn cross(polygon: &[DVec2], shift: DVec2) -> bool {
    let count = polygon.len();
    let side = |i: usize| [polygon[i], polygon[(i + 1) % count]];
    let left = |[a, b]: [DVec2; 2], p: DVec2| (b - a).perp_dot(p - a) > 0.0;
    (0..count).any(|i| {
        let a = side(i);
        (0..count).any(|j| {
            let b = side(j).map(|p| p + shift);
            left(a, b[0]) != left(a, b[1]) && left(b, a[0]) != left(b, a[1])
        })
    })
}
