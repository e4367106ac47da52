//! The blade's surface: B-spline or rational.

use coolinggen_brep::SurfaceGeometry;
use coolinggen_nurbs::{Knots, NurbsError, ParametricSurface, RationalSurface, Surface, SurfaceDerivatives};
use glam::DVec3;

/// A surface closed in u over [0, 1], from below the hub to beyond the shroud in w.
#[derive(Clone, Debug, PartialEq)]
pub enum BladeSurface {
    /// A B-spline surface.
    BSpline(Surface<DVec3>),
    /// A rational B-spline surface.
    Rational(RationalSurface<DVec3>),
}

impl BladeSurface {
    /// The part with u in `[a, b]`, `0 <= a < b <= 1`, on that domain: the surface of a side face.
    ///
    /// # Errors
    /// [`NurbsError`] for bounds outside the domain.
    pub fn patch(&self, a: f64, b: f64) -> Result<SurfaceGeometry, NurbsError> {
        Ok(match self {
            Self::BSpline(s) => SurfaceGeometry::BSpline(s.restricted_u(a, b)?),
            Self::Rational(s) => SurfaceGeometry::Rational(s.restricted_u(a, b)?),
        })
    }

    /// The whole as the geometry of a face.
    pub fn geometry(&self) -> SurfaceGeometry {
        match self {
            Self::BSpline(s) => SurfaceGeometry::BSpline(s.clone()),
            Self::Rational(s) => SurfaceGeometry::Rational(s.clone()),
        }
    }

    /// Knots in u.
    pub fn knots_u(&self) -> &Knots {
        match self {
            Self::BSpline(s) => s.knots_u(),
            Self::Rational(s) => s.homogeneous().knots_u(),
        }
    }

    /// Knots in w.
    pub fn knots_w(&self) -> &Knots {
        match self {
            Self::BSpline(s) => s.knots_v(),
            Self::Rational(s) => s.homogeneous().knots_v(),
        }
    }

    /// The point that the surface ends in at the upper end of w, if its last line is one point bit for bit.
    pub fn tip(&self) -> Option<DVec3> {
        let Self::BSpline(s) = self else { return None };
        let columns = s.counts().1;
        let tip = s.points()[columns - 1];
        s.points().iter().skip(columns - 1).step_by(columns).all(|p| *p == tip).then_some(tip)
    }

    /// Whether `d/du cross d/dw` points out of the closed surface, by the sense of rotation about it half way along w.
    pub(crate) fn is_outward(&self) -> bool {
        let ((start, end), (low, high)) = self.domain();
        let (n, w) = (128, 0.5 * (low + high));
        let looks: Vec<_> = (0..n)
            .map(|i| self.first_derivatives(start + (end - start) * f64::from(i) / f64::from(n), w))
            .collect();
        let middle = looks.iter().map(|l| l.0).sum::<DVec3>() / f64::from(n);
        let along = looks.iter().map(|l| l.2).sum::<DVec3>();
        let next = looks.iter().cycle().skip(1);
        looks.iter().zip(next).map(|(a, b)| (a.0 - middle).cross(b.0 - middle)).sum::<DVec3>().dot(along)
            > 0.0
    }

    /// The surface longer in w by `below` and `above`, where its end polynomials go on.
    pub(crate) fn extended_w(&self, below: f64, above: f64) -> Result<Self, NurbsError> {
        Ok(match self {
            Self::BSpline(s) => Self::BSpline(s.extended_v(below, above)?),
            Self::Rational(s) => Self::Rational(s.extended_v(below, above)?),
        })
    }
}

impl ParametricSurface<DVec3> for BladeSurface {
    fn domain(&self) -> ((f64, f64), (f64, f64)) {
        match self {
            Self::BSpline(s) => s.domain(),
            Self::Rational(s) => s.domain(),
        }
    }

    fn point(&self, u: f64, w: f64) -> DVec3 {
        match self {
            Self::BSpline(s) => s.point(u, w),
            Self::Rational(s) => s.point(u, w),
        }
    }

    fn first_derivatives(&self, u: f64, w: f64) -> (DVec3, DVec3, DVec3) {
        match self {
            Self::BSpline(s) => s.first_derivatives(u, w),
            Self::Rational(s) => s.first_derivatives(u, w),
        }
    }

    fn derivatives(&self, u: f64, w: f64) -> SurfaceDerivatives<DVec3> {
        match self {
            Self::BSpline(s) => s.derivatives(u, w),
            Self::Rational(s) => s.derivatives(u, w),
        }
    }

    fn breaks_u(&self) -> Vec<f64> {
        match self {
            Self::BSpline(s) => s.breaks_u(),
            Self::Rational(s) => s.breaks_u(),
        }
    }

    fn breaks_v(&self) -> Vec<f64> {
        match self {
            Self::BSpline(s) => s.breaks_v(),
            Self::Rational(s) => s.breaks_v(),
        }
    }
}
