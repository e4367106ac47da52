//! The surfaces and curves that faces and edges stand on.

use coolinggen_nurbs::{
    Curve, NurbsError, ParametricCurve, ParametricSurface, RationalCurve, RationalSurface, Surface,
    SurfaceDerivatives,
};
use glam::{DVec2, DVec3};

/// The curve of an edge, from its start vertex to its end vertex over the whole domain.
#[derive(Clone, Debug, PartialEq)]
pub enum EdgeCurve {
    /// A B-spline; degree 1 with two control points is a straight line.
    BSpline(Curve<DVec3>),
    /// A rational B-spline: only where a rational blade surface is cut along a parameter line.
    Rational(RationalCurve<DVec3>),
}

impl ParametricCurve<DVec3> for EdgeCurve {
    fn domain(&self) -> (f64, f64) {
        match self {
            Self::BSpline(c) => c.domain(),
            Self::Rational(c) => c.domain(),
        }
    }

    fn point(&self, t: f64) -> DVec3 {
        match self {
            Self::BSpline(c) => c.point(t),
            Self::Rational(c) => c.point(t),
        }
    }

    fn derivatives(&self, t: f64) -> [DVec3; 3] {
        match self {
            Self::BSpline(c) => c.derivatives(t),
            Self::Rational(c) => c.derivatives(t),
        }
    }

    fn breaks(&self) -> Vec<f64> {
        match self {
            Self::BSpline(c) => c.breaks(),
            Self::Rational(c) => c.breaks(),
        }
    }
}

impl From<Curve<DVec3>> for EdgeCurve {
    fn from(curve: Curve<DVec3>) -> Self {
        Self::BSpline(curve)
    }
}

impl From<RationalCurve<DVec3>> for EdgeCurve {
    fn from(curve: RationalCurve<DVec3>) -> Self {
        Self::Rational(curve)
    }
}

/// A plane with parameters in millimetres along its two axes: `origin + u x + v y`, normal `x cross y`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Point at `(0, 0)`, mm.
    pub origin: DVec3,
    /// Unit direction of u.
    pub x: DVec3,
    /// Unit direction of v, normal to `x`.
    pub y: DVec3,
}

/// A surface of revolution about the machine axis x: parameters are the angle theta in radians and the meridian's
/// parameter t; the point is `(x(t), r(t) sin theta, r(t) cos theta)`. Its natural normal (theta cross t) points
/// towards the axis where the meridian runs along +x.
#[derive(Clone, Debug, PartialEq)]
pub struct Revolution {
    meridian: Curve<DVec2>,
}

/// What a surface of revolution is when its meridian is a straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RevolutionKind {
    /// The meridian is parallel to the axis.
    Cylinder {
        /// Radius, mm.
        radius: f64,
    },
    /// The meridian is straight and inclined.
    Cone {
        /// A point of the meridian: axial position, mm.
        x: f64,
        /// Radius there, mm.
        radius: f64,
        /// `dr/dx`.
        slope: f64,
    },
    /// The meridian is normal to the axis: a plane of constant x.
    Disc {
        /// Axial position, mm.
        x: f64,
    },
    /// Anything else.
    General,
}

impl Revolution {
    /// Revolves `meridian`, points `(x, r)` in mm with `r > 0`.
    ///
    /// # Errors
    /// [`NurbsError::BadPoint`] for a control point that does not lie above the axis.
    pub fn new(meridian: Curve<DVec2>) -> Result<Self, NurbsError> {
        match meridian.points().iter().position(|p| !(p.y > 0.0)) {
            Some(index) => Err(NurbsError::BadPoint { index }),
            None => Ok(Self { meridian }),
        }
    }

    /// The meridian, points `(x, r)`.
    pub fn meridian(&self) -> &Curve<DVec2> {
        &self.meridian
    }

    /// Recognises straight meridians: all control points within `1e-12` of their extent on the line of the ends.
    pub fn kind(&self) -> RevolutionKind {
        let points = self.meridian.points();
        let (a, b) = (points[0], points[points.len() - 1]);
        let d = b - a;
        let straight = |p: &DVec2| d.perp_dot(*p - a).abs() <= 1e-12 * d.length_squared();
        if !points.iter().all(straight) {
            return RevolutionKind::General;
        }
        if d.y.abs() <= 1e-12 * d.x.abs() {
            RevolutionKind::Cylinder { radius: a.y }
        } else if d.x.abs() <= 1e-12 * d.y.abs() {
            RevolutionKind::Disc { x: a.x }
        } else {
            RevolutionKind::Cone { x: a.x, radius: a.y, slope: d.y / d.x }
        }
    }
}

/// The surface of a face.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceGeometry {
    /// A B-spline surface.
    BSpline(Surface<DVec3>),
    /// A rational B-spline surface.
    Rational(RationalSurface<DVec3>),
    /// A plane.
    Plane(Plane),
    /// A surface of revolution about the machine axis.
    Revolution(Revolution),
}

impl From<Surface<DVec3>> for SurfaceGeometry {
    fn from(surface: Surface<DVec3>) -> Self {
        Self::BSpline(surface)
    }
}

impl From<RationalSurface<DVec3>> for SurfaceGeometry {
    fn from(surface: RationalSurface<DVec3>) -> Self {
        Self::Rational(surface)
    }
}

impl From<Plane> for SurfaceGeometry {
    fn from(surface: Plane) -> Self {
        Self::Plane(surface)
    }
}

impl From<Revolution> for SurfaceGeometry {
    fn from(surface: Revolution) -> Self {
        Self::Revolution(surface)
    }
}

impl ParametricSurface<DVec3> for SurfaceGeometry {
    /// Planes are unbounded and revolutions unbounded in theta; they answer with an infinite interval there.
    fn domain(&self) -> ((f64, f64), (f64, f64)) {
        const ALL: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
        match self {
            Self::BSpline(s) => s.domain(),
            Self::Rational(s) => s.domain(),
            Self::Plane(_) => (ALL, ALL),
            Self::Revolution(s) => (ALL, s.meridian.domain()),
        }
    }

    fn point(&self, u: f64, v: f64) -> DVec3 {
        match self {
            Self::BSpline(s) => s.point(u, v),
            Self::Rational(s) => s.point(u, v),
            Self::Plane(s) => s.origin + s.x * u + s.y * v,
            Self::Revolution(s) => {
                let (p, (sin, cos)) = (s.meridian.point(v), u.sin_cos());
                DVec3::new(p.x, p.y * sin, p.y * cos)
            }
        }
    }

    fn first_derivatives(&self, u: f64, v: f64) -> (DVec3, DVec3, DVec3) {
        match self {
            Self::BSpline(s) => s.first_derivatives(u, v),
            Self::Plane(s) => (self.point(u, v), s.x, s.y),
            Self::Rational(s) => s.first_derivatives(u, v),
            Self::Revolution(_) => {
                let d = self.derivatives(u, v);
                (d.point, d.u, d.v)
            }
        }
    }

    fn derivatives(&self, u: f64, v: f64) -> SurfaceDerivatives<DVec3> {
        match self {
            Self::BSpline(s) => s.derivatives(u, v),
            Self::Rational(s) => s.derivatives(u, v),
            Self::Plane(s) => SurfaceDerivatives {
                point: self.point(u, v),
                u: s.x,
                v: s.y,
                ..SurfaceDerivatives::default()
            },
            Self::Revolution(s) => {
                let ([p, d, dd], (sin, cos)) = (s.meridian.derivatives(v), u.sin_cos());
                SurfaceDerivatives {
                    point: DVec3::new(p.x, p.y * sin, p.y * cos),
                    u: DVec3::new(0.0, p.y * cos, -p.y * sin),
                    v: DVec3::new(d.x, d.y * sin, d.y * cos),
                    uu: DVec3::new(0.0, -p.y * sin, -p.y * cos),
                    uv: DVec3::new(0.0, d.y * cos, -d.y * sin),
                    vv: DVec3::new(dd.x, dd.y * sin, dd.y * cos),
                }
            }
        }
    }

    fn breaks_u(&self) -> Vec<f64> {
        match self {
            Self::BSpline(s) => s.breaks_u(),
            Self::Rational(s) => s.breaks_u(),
            Self::Plane(_) | Self::Revolution(_) => Vec::new(),
        }
    }

    fn breaks_v(&self) -> Vec<f64> {
        match self {
            Self::BSpline(s) => s.breaks_v(),
            Self::Rational(s) => s.breaks_v(),
            Self::Plane(_) => Vec::new(),
            Self::Revolution(s) => s.meridian.breaks(),
        }
    }
}
