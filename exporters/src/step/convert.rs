//! From the model's solids to truck's compressed ones.

use super::geometry::{CurveEntity, Form, Placement, Point, SurfaceEntity};
use super::ruled::drawn_out;
use coolinggen_brep::{EdgeCurve, Face, Model, Revolution, RevolutionKind, Shell, Solid, SurfaceGeometry};
use coolinggen_nurbs::ParametricCurve;
use glam::DVec3;
use std::borrow::Cow;
use std::f64::consts::PI;
use truck_stepio::out::StepLength;
use truck_topology::compress::{
    CompressedEdge, CompressedEdgeIndex, CompressedFace, CompressedShell, CompressedSolid,
};

/// Slopes of a meridian that a native cone cannot carry well: its apex lies too far away, or it is nearly flat.
const CONE_SLOPES: std::ops::Range<f64> = 1e-6..1e6;

pub(crate) type StepShell<'a> = CompressedShell<Point, CurveEntity<'a>, SurfaceEntity<'a>>;
pub(crate) type StepSolid<'a> = CompressedSolid<Point, CurveEntity<'a>, SurfaceEntity<'a>>;

/// The solid with its own copies of the vertices, edges and faces it uses, numbered as the faces meet them.
pub(crate) fn solid<'a>(model: &'a Model, solid: &Solid) -> StepSolid<'a> {
    CompressedSolid { boundaries: solid.shells.iter().map(|s| shell(model, s)).collect() }
}

fn shell<'a>(model: &'a Model, shell: &Shell) -> StepShell<'a> {
    let mut vertex_of = vec![usize::MAX; model.vertices.len()];
    let mut edge_of = vec![usize::MAX; model.edges.len()];
    let mut out = CompressedShell { vertices: Vec::new(), edges: Vec::new(), faces: Vec::new() };
    for used in &shell.faces {
        let face = model.face(used.face);
        let mut boundaries = Vec::with_capacity(face.loops.len());
        for bound in &face.loops {
            let mut indices = Vec::with_capacity(bound.coedges.len());
            for coedge in &bound.coedges {
                let slot = &mut edge_of[coedge.edge.0];
                if *slot == usize::MAX {
                    *slot = out.edges.len();
                    let edge = model.edge(coedge.edge);
                    let mut vertex = |id: usize| {
                        if vertex_of[id] == usize::MAX {
                            vertex_of[id] = out.vertices.len();
                            out.vertices.push(Point(model.vertices[id]));
                        }
                        vertex_of[id]
                    };
                    let vertices = (vertex(edge.start.0), vertex(edge.end.0));
                    out.edges.push(CompressedEdge { vertices, curve: curve(&edge.curve) });
                }
                indices.push(CompressedEdgeIndex { index: *slot, orientation: coedge.forward });
            }
            boundaries.push(indices);
        }
        // truck reverses the bounds of a face with orientation false: the loops are given as seen against the
        // natural normal, which then points into the material.
        out.faces.push(CompressedFace { boundaries, orientation: used.forward, surface: surface(face) });
    }
    out
}

/// An upper bound of the number of entities that truck writes for a solid.
pub(crate) fn entities(solid: &StepSolid<'_>) -> usize {
    let bounds = |f: &CompressedFace<SurfaceEntity<'_>>| -> usize {
        f.boundaries.iter().map(|b| 2 + b.len()).sum::<usize>() + 1 + f.surface.step_length()
    };
    let shell = |s: &StepShell<'_>| -> usize {
        let edges = s.edges.iter().map(|e| 1 + e.curve.step_length()).sum::<usize>();
        2 + s.faces.iter().map(bounds).sum::<usize>() + edges + 2 * s.vertices.len()
    };
    1 + solid.boundaries.iter().map(shell).sum::<usize>()
}

/// The form of an edge's curve.
pub(crate) fn curve(curve: &EdgeCurve) -> CurveEntity<'_> {
    match curve {
        EdgeCurve::BSpline(c) if c.degree() == 1 && c.points().len() == 2 => {
            CurveEntity::Line(c.points()[0], c.points()[1])
        }
        EdgeCurve::BSpline(c) => CurveEntity::BSpline(c),
        EdgeCurve::Rational(c) => CurveEntity::Rational(c),
    }
}

fn surface(face: &Face) -> SurfaceEntity<'_> {
    let same = |form| SurfaceEntity { form, same_normal: true };
    match &face.surface {
        SurfaceGeometry::BSpline(s) => {
            let s = drawn_out(s).map_or(Cow::Borrowed(s), Cow::Owned);
            if rather_transposed(s.counts()) {
                SurfaceEntity { form: Form::BSpline(Cow::Owned(s.transposed())), same_normal: false }
            } else {
                same(Form::BSpline(s))
            }
        }
        SurfaceGeometry::Rational(s) => same(Form::Rational(s)),
        SurfaceGeometry::Plane(p) => {
            same(Form::Plane(Placement { origin: p.origin, axis: p.x.cross(p.y), reference: p.x }))
        }
        SurfaceGeometry::Revolution(r) => revolution(r, seam(face)),
    }
}

/// Whether a surface goes out with u and v exchanged, so that most of its spans run in v.
///
/// OpenCASCADE's fixed rule for volumes (FreeCAD's `Shape.Volume`, build123d's `volume`) integrates across a face in u,
/// with few points however many spans there are, and along its edges in v. Exchanged, and with the edges' parameter
/// curves given, C3X and rotor are right to 4e-7; as they are, the vane's suction side alone is wrong by 3.1e-3.
fn rather_transposed((u, v): (usize, usize)) -> bool {
    u > v
}

/// Angle opposite to the face, where a periodic surface may have its seam: control points bound the parameter
/// curves.
pub(crate) fn seam(face: &Face) -> f64 {
    let angles = face.loops.iter().flat_map(|l| &l.coedges).flat_map(|c| c.pcurve.points()).map(|p| p.x);
    let (low, high) =
        angles.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), a| (low.min(a), high.max(a)));
    if low <= high { (0.5 * (low + high) + PI) % (2.0 * PI) } else { 0.0 }
}

/// Native forms where the meridian is straight. STEP's cylinder and cone have normals away from the axis; the
/// natural normal (theta cross t) points away from it where the meridian runs along -x. A surface of revolution
/// about -x has the model's own parameters and so its normal.
fn revolution(r: &Revolution, seam: f64) -> SurfaceEntity<'static> {
    let (sin, cos) = seam.sin_cos();
    let reference = DVec3::new(0.0, sin, cos);
    let points = r.meridian().points();
    let run = points[points.len() - 1] - points[0];
    let placement = |x: f64, axis: f64| Placement { origin: DVec3::X * x, axis: DVec3::X * axis, reference };
    match r.kind() {
        RevolutionKind::Cylinder { radius } => SurfaceEntity {
            form: Form::Cylinder { placement: placement(points[0].x, 1.0), radius },
            same_normal: run.x < 0.0,
        },
        RevolutionKind::Cone { x, radius, slope } if CONE_SLOPES.contains(&slope.abs()) => SurfaceEntity {
            form: Form::Cone { placement: placement(x, slope.signum()), radius, angle: slope.abs().atan() },
            same_normal: run.x < 0.0,
        },
        RevolutionKind::Disc { x } => {
            SurfaceEntity { form: Form::Plane(placement(x, run.y.signum())), same_normal: true }
        }
        _ => {
            let meridian = r.meridian().map(|p| DVec3::new(p.x, p.y * sin, p.y * cos));
            debug_assert!(meridian.domain() == r.meridian().domain());
            SurfaceEntity { form: Form::Revolved { meridian, axis: -DVec3::X }, same_normal: true }
        }
    }
}
