//! The surface of a face in a form that CAD readers have natively.

use super::ruled::drawn_out;
use coolinggen_brep::{Face, Revolution, RevolutionKind, SurfaceGeometry};
use coolinggen_nurbs::{Curve, ParametricCurve, RationalSurface, Surface};
use glam::DVec3;
use std::borrow::Cow;
use std::f64::consts::PI;

/// Slopes of a meridian that a native cone cannot carry well: its apex lies too far away, or it is nearly flat.
const CONE_SLOPES: std::ops::Range<f64> = 1e-6..1e6;

/// Origin, axis and the direction that angles count from.
#[derive(Clone, Copy)]
pub(crate) struct Placement {
    pub(crate) origin: DVec3,
    pub(crate) axis: DVec3,
    pub(crate) reference: DVec3,
}

/// A surface, in the words of STEP; other formats have the same forms.
#[derive(Clone)]
pub(crate) enum Form<'a> {
    /// `PLANE`.
    Plane(Placement),
    /// `CYLINDRICAL_SURFACE`.
    Cylinder { placement: Placement, radius: f64 },
    /// `CONICAL_SURFACE`, angle positive in radians.
    Cone { placement: Placement, radius: f64, angle: f64 },
    /// `SURFACE_OF_REVOLUTION` about an axis through the origin.
    Revolved { meridian: Curve<DVec3>, axis: DVec3 },
    /// `B_SPLINE_SURFACE_WITH_KNOTS`.
    BSpline(Cow<'a, Surface<DVec3>>),
    /// The same, rational.
    Rational(&'a RationalSurface<DVec3>),
}

/// A surface and whether its normal is the natural normal of the model's surface.
#[derive(Clone)]
pub(crate) struct SurfaceForm<'a> {
    pub(crate) form: Form<'a>,
    pub(crate) same_normal: bool,
}

/// The form of a face's surface.
pub(crate) fn surface(face: &Face) -> SurfaceForm<'_> {
    let same = |form| SurfaceForm { form, same_normal: true };
    match &face.surface {
        SurfaceGeometry::BSpline(s) => {
            let s = drawn_out(s).map_or(Cow::Borrowed(s), Cow::Owned);
            if rather_transposed(s.counts()) {
                SurfaceForm { form: Form::BSpline(Cow::Owned(s.transposed())), same_normal: false }
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
pub(crate) fn rather_transposed((u, v): (usize, usize)) -> bool {
    u > v
}

/// Angle opposite to the face, where a periodic surface may have its seam: control points bound the parameter
/// curves.
pub(super) fn seam(face: &Face) -> f64 {
    let angles = face.loops.iter().flat_map(|l| &l.coedges).flat_map(|c| c.pcurve.points()).map(|p| p.x);
    let (low, high) =
        angles.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), a| (low.min(a), high.max(a)));
    if low <= high { (0.5 * (low + high) + PI) % (2.0 * PI) } else { 0.0 }
}

/// Native forms where the meridian is straight. STEP's cylinder and cone have normals away from the axis; the
/// natural normal (theta cross t) points away from it where the meridian runs along -x. A surface of revolution
/// about -x has the model's own parameters and so its normal.
fn revolution(r: &Revolution, seam: f64) -> SurfaceForm<'static> {
    let (sin, cos) = seam.sin_cos();
    let reference = DVec3::new(0.0, sin, cos);
    let points = r.meridian().points();
    let run = points[points.len() - 1] - points[0];
    // Parameters along a straight meridian of more points are no lengths.
    let plain = points.len() == 2;
    let placement = |x: f64, axis: f64| Placement { origin: DVec3::X * x, axis: DVec3::X * axis, reference };
    match r.kind() {
        RevolutionKind::Cylinder { radius } if plain => SurfaceForm {
            form: Form::Cylinder { placement: placement(points[0].x, 1.0), radius },
            same_normal: run.x < 0.0,
        },
        RevolutionKind::Cone { x, radius, slope } if plain && CONE_SLOPES.contains(&slope.abs()) => {
            SurfaceForm {
                form: Form::Cone {
                    placement: placement(x, slope.signum()),
                    radius,
                    angle: slope.abs().atan(),
                },
                same_normal: run.x < 0.0,
            }
        }
        RevolutionKind::Disc { x } => {
            SurfaceForm { form: Form::Plane(placement(x, run.y.signum())), same_normal: true }
        }
        _ => {
            let meridian = r.meridian().map(|p| DVec3::new(p.x, p.y * sin, p.y * cos));
            debug_assert!(meridian.domain() == r.meridian().domain());
            SurfaceForm { form: Form::Revolved { meridian, axis: -DVec3::X }, same_normal: true }
        }
    }
}
