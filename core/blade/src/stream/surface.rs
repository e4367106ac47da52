//! One stream surface with its chart.

use super::meridian::Meridian;
use coolinggen_brep::{Plane, Revolution, SurfaceGeometry};
use coolinggen_nurbs::{Curve, NurbsError};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A stream surface: the surface of revolution of one streamline, or a plane of a linear cascade, with a chart
/// (M, T) in mm.
///
/// In an annulus the chart is conformal: `M = r_ref * integral of dm / r`, `T = r_ref * (theta - theta_0)`; angles are
/// kept and lengths are scaled by [`StreamSurface::scale`] alone. M = 0 at the blade's middle, where the scale is 1.
/// In a linear cascade the chart is (x, y) itself.
#[derive(Clone, Debug)]
pub struct StreamSurface {
    v: f64,
    geometry: SurfaceGeometry,
    form: Form,
}

#[derive(Clone, Debug)]
enum Form {
    Plane {
        z: f64,
    },
    Revolved {
        meridian: Box<Meridian>,
        /// Angle with T = 0, radians.
        reference_angle: f64,
        /// 1 where the shroud lies to the left of the streamline in (x, r), else -1.
        side: f64,
    },
}

impl StreamSurface {
    pub(super) fn plane(v: f64, z: f64) -> Self {
        let plane = Plane { origin: DVec3::new(0.0, 0.0, z), x: DVec3::X, y: DVec3::Y };
        Self { v, geometry: SurfaceGeometry::Plane(plane), form: Form::Plane { z } }
    }

    pub(super) fn revolved(
        v: f64,
        meridian: Curve<DVec2>,
        reference: f64,
        reference_angle: f64,
        side: f64,
    ) -> Result<Self, NurbsError> {
        let geometry = SurfaceGeometry::Revolution(Revolution::new(meridian.clone())?);
        let meridian = Box::new(Meridian::new(meridian, reference));
        Ok(Self { v, geometry, form: Form::Revolved { meridian, reference_angle, side } })
    }

    /// Span fraction.
    pub fn v(&self) -> f64 {
        self.v
    }

    /// The surface itself, as faces use it: a plane with parameters (x, y), or a revolution with parameters
    /// (theta, parameter of the meridian).
    pub fn geometry(&self) -> &SurfaceGeometry {
        &self.geometry
    }

    /// The point with chart coordinates `q`: exact to 1e-11 mm between the ends of the contour. Beyond them the end
    /// pieces are continued, smoothly but less exactly.
    pub fn to_space(&self, q: DVec2) -> DVec3 {
        match &self.form {
            Form::Plane { z } => q.extend(*z),
            Form::Revolved { meridian, reference_angle, .. } => {
                let p = meridian.point(meridian.at_conformal(q.x));
                lift(p, reference_angle + q.y / meridian.reference_radius)
            }
        }
    }

    /// The point with chart coordinates `q`, and its derivatives in M and T. They are normal to each other and both
    /// of length [`StreamSurface::scale`].
    pub fn to_space_derivatives(&self, q: DVec2) -> (DVec3, DVec3, DVec3) {
        match &self.form {
            Form::Plane { z } => (q.extend(*z), DVec3::X, DVec3::Y),
            Form::Revolved { meridian, reference_angle, .. } => {
                let (p, tangent) = meridian.tangent(meridian.at_conformal(q.x));
                let (sin, cos) = (reference_angle + q.y / meridian.reference_radius).sin_cos();
                let scale = p.y / meridian.reference_radius;
                let point = DVec3::new(p.x, p.y * sin, p.y * cos);
                let along_m = DVec3::new(tangent.x, tangent.y * sin, tangent.y * cos) * scale;
                (point, along_m, DVec3::new(0.0, cos, -sin) * scale)
            }
        }
    }

    /// Chart coordinates of `p`, or of the point of the surface closest to it in the meridional plane.
    pub fn to_chart(&self, p: DVec3) -> DVec2 {
        match &self.form {
            Form::Plane { .. } => p.truncate(),
            Form::Revolved { meridian, .. } => {
                let s = meridian.nearest(meridional(p), None);
                DVec2::new(meridian.conformal(s), self.turned(p) * meridian.reference_radius)
            }
        }
    }

    /// Length on the surface per length in the chart at `q`: `r / r_ref`, 1 in a linear cascade.
    pub fn scale(&self, q: DVec2) -> f64 {
        match &self.form {
            Form::Plane { .. } => 1.0,
            Form::Revolved { meridian, .. } => {
                meridian.point(meridian.at_conformal(q.x)).y / meridian.reference_radius
            }
        }
    }

    /// Signed distance of `p` to the surface in mm, positive towards the shroud, and its gradient, a unit vector.
    /// Smooth near the surface.
    pub fn level(&self, p: DVec3) -> (f64, DVec3) {
        self.level_near(p, &mut None)
    }

    /// As [`StreamSurface::level`], starting from the station of the call before, which `station` keeps.
    pub(crate) fn level_near(&self, p: DVec3, station: &mut Option<f64>) -> (f64, DVec3) {
        match &self.form {
            Form::Plane { z } => (p.z - z, DVec3::Z),
            Form::Revolved { meridian, side, .. } => {
                let q = meridional(p);
                let (s, foot, tangent) = meridian.foot(q, *station);
                *station = Some(s);
                let normal = tangent.perp() * *side;
                let radial = if q.y > 0.0 { normal.y / q.y } else { 0.0 };
                ((q - foot).dot(normal), DVec3::new(normal.x, radial * p.y, radial * p.z))
            }
        }
    }

    /// Chart coordinates of a point of the surface whose station [`StreamSurface::level_near`] has found.
    pub(crate) fn chart_at(&self, p: DVec3, station: Option<f64>) -> DVec2 {
        match (&self.form, station) {
            (Form::Revolved { meridian, .. }, Some(s)) => {
                DVec2::new(meridian.conformal(s), self.turned(p) * meridian.reference_radius)
            }
            _ => self.to_chart(p),
        }
    }

    /// Parameters of `p` in [`StreamSurface::geometry`], or of the point closest to it in the meridional plane. The
    /// angle is the one within half a turn of the blade's mean angle.
    pub fn parameters(&self, p: DVec3) -> DVec2 {
        match &self.form {
            Form::Plane { .. } => p.truncate(),
            Form::Revolved { meridian, reference_angle, .. } => {
                DVec2::new(reference_angle + self.turned(p), meridian.nearest(meridional(p), None))
            }
        }
    }

    /// Parameters in [`StreamSurface::geometry`] of the point with chart coordinates `q`.
    pub fn parameters_of_chart(&self, q: DVec2) -> DVec2 {
        match &self.form {
            Form::Plane { .. } => q,
            Form::Revolved { meridian, reference_angle, .. } => {
                DVec2::new(reference_angle + q.y / meridian.reference_radius, meridian.at_conformal(q.x))
            }
        }
    }

    /// Chart coordinates of the user's stream coordinates: `m`, the meridional arc length from the start of the
    /// contour, and `r_theta`, radius times angle, both mm; (x, y) in a linear cascade.
    pub fn chart_of_stream(&self, m: f64, r_theta: f64) -> DVec2 {
        match &self.form {
            Form::Plane { .. } => DVec2::new(m, r_theta),
            Form::Revolved { meridian, reference_angle, .. } => {
                let s = meridian.at_arc(m);
                let turned = r_theta / meridian.point(s).y - reference_angle;
                DVec2::new(meridian.conformal(s), turned * meridian.reference_radius)
            }
        }
    }

    /// The user's stream coordinates `(m, r * theta)` of chart coordinates.
    pub fn stream_of_chart(&self, q: DVec2) -> (f64, f64) {
        match &self.form {
            Form::Plane { .. } => (q.x, q.y),
            Form::Revolved { meridian, reference_angle, .. } => {
                let s = meridian.at_conformal(q.x);
                let angle = reference_angle + q.y / meridian.reference_radius;
                (meridian.arc(s), meridian.point(s).y * angle)
            }
        }
    }

    /// The point with the user's stream coordinates, mm.
    pub fn stream_to_space(&self, m: f64, r_theta: f64) -> DVec3 {
        match &self.form {
            Form::Plane { z } => DVec3::new(m, r_theta, *z),
            Form::Revolved { meridian, .. } => {
                let p = meridian.point(meridian.at_arc(m));
                lift(p, r_theta / p.y)
            }
        }
    }

    /// M where the stream surface first reaches the axial position `x`, mm; none if it does not.
    pub fn chart_of_axial(&self, x: f64) -> Option<f64> {
        match &self.form {
            Form::Plane { .. } => Some(x),
            Form::Revolved { meridian, .. } => meridian.at_axial(x).map(|s| meridian.conformal(s)),
        }
    }

    /// Chart coordinates of the point at M = `m` with the angle `theta`, radians; `theta` is not brought into a range.
    pub fn chart_of_angle(&self, m: f64, theta: f64) -> DVec2 {
        match &self.form {
            Form::Plane { .. } => DVec2::new(m, theta),
            Form::Revolved { meridian, reference_angle, .. } => {
                DVec2::new(m, (theta - reference_angle) * meridian.reference_radius)
            }
        }
    }

    /// M at parameter `s` of the streamline; `s` itself in a linear cascade.
    pub(crate) fn chart_of_station(&self, s: f64) -> f64 {
        match &self.form {
            Form::Plane { .. } => s,
            Form::Revolved { meridian, .. } => meridian.conformal(s),
        }
    }

    /// The derivative of [`StreamSurface::stream_to_space`] along the direction `(dm, d(r theta))`.
    pub(crate) fn stream_direction(&self, m: f64, r_theta: f64, direction: DVec2) -> DVec3 {
        match &self.form {
            Form::Plane { .. } => direction.extend(0.0),
            Form::Revolved { meridian, .. } => {
                let (p, tangent) = meridian.tangent(meridian.at_arc(m));
                let theta = r_theta / p.y;
                let (sin, cos) = theta.sin_cos();
                // theta = (r theta) / r turns back as r grows along m.
                let around = direction.y - theta * tangent.y * direction.x;
                DVec3::new(tangent.x, tangent.y * sin, tangent.y * cos) * direction.x
                    + DVec3::new(0.0, cos, -sin) * around
            }
        }
    }

    /// M at the two ends of the contour; unbounded in a linear cascade.
    pub fn chart_extent(&self) -> (f64, f64) {
        match &self.form {
            Form::Plane { .. } => (f64::NEG_INFINITY, f64::INFINITY),
            Form::Revolved { meridian, .. } => (meridian.conformal(0.0), meridian.conformal(1.0)),
        }
    }

    /// Whether `q` lies between the ends of the contour, where the chart is exact.
    pub fn in_chart_domain(&self, q: DVec2) -> bool {
        let (start, end) = self.chart_extent();
        q.is_finite() && start <= q.x && q.x <= end
    }

    /// Meridional arc length from the start of the contour to its end, mm; unbounded in a linear cascade.
    pub fn meridional_length(&self) -> f64 {
        match &self.form {
            Form::Plane { .. } => f64::INFINITY,
            Form::Revolved { meridian, .. } => meridian.length(),
        }
    }

    /// The streamline, points (x, r) over [0, 1]; none in a linear cascade.
    pub fn meridian(&self) -> Option<&Curve<DVec2>> {
        match &self.form {
            Form::Plane { .. } => None,
            Form::Revolved { meridian, .. } => Some(meridian.curve()),
        }
    }

    /// Angle of `p` less the reference angle, within half a turn.
    fn turned(&self, p: DVec3) -> f64 {
        let Form::Revolved { reference_angle, .. } = &self.form else { return 0.0 };
        let d = p.y.atan2(p.z) - reference_angle;
        if d > PI {
            d - TAU
        } else if d < -PI {
            d + TAU
        } else {
            d
        }
    }
}

/// (x, r) of a point.
pub(super) fn meridional(p: DVec3) -> DVec2 {
    DVec2::new(p.x, p.y.hypot(p.z))
}

/// The point with (x, r) and angle.
fn lift(p: DVec2, angle: f64) -> DVec3 {
    let (sin, cos) = angle.sin_cos();
    DVec3::new(p.x, p.y * sin, p.y * cos)
}
