//! Where rays meet curves and surfaces.
//!
//! Without a start value by sphere tracing (Hart 1996, thesis 2.3.2): the distance to the nearest point is a step that
//! cannot pass anything. Newton's method finishes, and the result is checked: it lies on both things within
//! [`CERTIFIED`].

use super::project_surface::wrap;
use super::projector::{CurveProjector, SurfaceProjector};
use crate::curve::ParametricCurve;
use crate::edit::{BezierCurve, BezierSurface};
use crate::error::NurbsError;
use crate::surface::ParametricSurface;
use glam::{DMat2, DMat3, DVec2, DVec3};

/// How far a hit may be from the ray and from the curve or surface.
pub const CERTIFIED: f64 = 1e-9;
/// Steps of a march; rays that graze along something need many.
const STEPS: usize = 20_000;
/// Newton's method takes over at this distance, relative to the size of the thing.
const NEAR: f64 = 1e-6;
const NEWTON: usize = 40;

/// Where a ray meets a plane curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveHit {
    /// Length along the ray.
    pub distance: f64,
    /// Parameter on the curve.
    pub t: f64,
    /// The point on the curve.
    pub point: DVec2,
}

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceHit {
    /// Length along the ray.
    pub distance: f64,
    /// First parameter on the surface.
    pub u: f64,
    /// Second parameter on the surface.
    pub v: f64,
    /// The point on the surface.
    pub point: DVec3,
}

/// The first point where the ray from `origin` along `direction` (of any length) meets the curve, or none. Contacts
/// closer together than 1e-6 of the size of the curve count as one. A ray that touches within 1e-9 meets the curve.
///
/// # Errors
/// [`NurbsError::BadArgument`] for a direction that is zero or not finite, [`NurbsError::NoConvergence`] for a ray that
/// grazes for more than 20 000 steps; as [`CurveProjector::closest`].
pub fn march_to_curve<C: BezierCurve<Space = DVec2>>(
    projector: &CurveProjector<C>,
    origin: DVec2,
    direction: DVec2,
) -> Result<Option<CurveHit>, NurbsError> {
    let way = unit(direction.length(), origin.is_finite()).map(|length| direction / length)?;
    let (centre, radius) = projector.bounding_sphere();
    let Some(span) = sphere_span((origin - centre).dot(way), origin.distance_squared(centre), radius) else {
        return Ok(None);
    };
    let curve = projector.curve();
    march(
        span,
        radius,
        |s| {
            let near = projector.closest(origin + way * s)?;
            let finish = || {
                let exact = ray_meets_curve(curve, origin, way, near.t, s);
                exact.ok().or_else(|| touch_curve(curve, origin, way, near.t))
            };
            Ok((near.distance, if near.distance <= NEAR * radius { finish() } else { None }))
        },
        |hit: &CurveHit| hit.distance,
    )
}

/// The first point where the ray from `origin` along `direction` (of any length) meets the surface, or none, as
/// [`march_to_curve`].
///
/// # Errors
/// As [`march_to_curve`].
pub fn march_to_surface<S: BezierSurface<Space = DVec3>>(
    projector: &SurfaceProjector<S>,
    origin: DVec3,
    direction: DVec3,
) -> Result<Option<SurfaceHit>, NurbsError> {
    let way = unit(direction.length(), origin.is_finite()).map(|length| direction / length)?;
    let (centre, radius) = projector.bounding_sphere();
    let Some(span) = sphere_span((origin - centre).dot(way), origin.distance_squared(centre), radius) else {
        return Ok(None);
    };
    let (surface, closed_u) = (projector.surface(), projector.closed_u());
    march(
        span,
        radius,
        |s| {
            let near = projector.closest(origin + way * s)?;
            let finish = || {
                let exact = ray_meets_surface(surface, origin, way, (near.u, near.v), s, closed_u);
                exact.ok().or_else(|| touch_surface(surface, origin, way, (near.u, near.v)))
            };
            Ok((near.distance, if near.distance <= NEAR * radius { finish() } else { None }))
        },
        |hit: &SurfaceHit| hit.distance,
    )
}

fn unit(length: f64, finite: bool) -> Result<f64, NurbsError> {
    if length > 0.0 && length.is_finite() && finite {
        Ok(length)
    } else {
        Err(NurbsError::BadArgument { what: "direction of a ray", value: length })
    }
}

/// The part of a ray inside a sphere, with a margin; `along` is the position of the origin along the ray from the
/// centre, `square` its squared distance from it.
fn sphere_span(along: f64, square: f64, radius: f64) -> Option<(f64, f64)> {
    let radius = radius * (1.0 + 1e-9) + CERTIFIED;
    let half = radius * radius - (square - along * along);
    let (start, end) = (-along - half.max(0.0).sqrt(), -along + half.max(0.0).sqrt());
    (half >= 0.0 && end >= 0.0).then_some((start.max(0.0), end))
}

/// Sphere tracing; `look` gives the distance at a length along the ray, and a hit where it is near enough to try.
fn march<H>(
    (start, end): (f64, f64),
    size: f64,
    mut look: impl FnMut(f64) -> Result<(f64, Option<H>), NurbsError>,
    at: impl Fn(&H) -> f64,
) -> Result<Option<H>, NurbsError> {
    let mut s = start;
    for _ in 0..STEPS {
        let (distance, hit) = look(s)?;
        // A hit behind is one that was passed within its certificate, or that the ray starts from.
        let ahead = |hit: &H| at(hit) >= s - CERTIFIED && at(hit) <= s + 1e-2 * size;
        if let Some(hit) = hit.filter(ahead) {
            return Ok(Some(hit));
        }
        // Less than the certificate would be no step.
        s += distance.max(0.1 * CERTIFIED);
        if s > end {
            return Ok(None);
        }
    }
    Err(NurbsError::NoConvergence { what: "march along a grazing ray", residual: end - s })
}

/// Where the ray meets the curve near the parameter `hint`, by Newton's method on `curve(t) = origin + s direction`;
/// `distance` is a start value for the length. The direction must have unit length. The result is certified.
///
/// # Errors
/// [`NurbsError::NoConvergence`] with the distance left if it does not get below 1e-9 inside the domain, or if the ray
/// is met behind its origin.
pub fn ray_meets_curve(
    curve: &impl ParametricCurve<DVec2>,
    origin: DVec2,
    direction: DVec2,
    hint: f64,
    distance: f64,
) -> Result<CurveHit, NurbsError> {
    let (start, end) = curve.domain();
    let mut t = hint.clamp(start, end);
    let mut s = distance;
    let mut residual = f64::INFINITY;
    for _ in 0..NEWTON {
        let [point, tangent, _] = curve.derivatives(t);
        let miss = origin + direction * s - point;
        let now = miss.length();
        // Newton at its best: the last correction was rounding.
        if now >= 0.5 * residual && now <= CERTIFIED {
            break;
        }
        residual = now;
        let step = DMat2::from_cols(tangent, -direction).inverse() * miss;
        if !step.is_finite() {
            break;
        }
        t = (t + step.x).clamp(start, end);
        // Exact in s whatever t became.
        s = (curve.point(t) - origin).dot(direction);
    }
    let point = curve.point(t);
    let residual = point.distance(origin + direction * s);
    if residual <= CERTIFIED && s >= -CERTIFIED {
        Ok(CurveHit { distance: s, t, point })
    } else {
        Err(NurbsError::NoConvergence { what: "meeting of a ray and a curve", residual })
    }
}

/// Where the ray meets the surface near the parameters `hint`, by Newton's method; `distance` is a start value for the
/// length. The direction must have unit length. With `closed_u` the iteration may cross the seam. The result is
/// certified: the point is within 1e-9 of the ray.
///
/// # Errors
/// [`NurbsError::NoConvergence`] with the distance left if it does not get below 1e-9 inside the domain, or if the ray
/// is met behind its origin.
pub fn ray_meets_surface(
    surface: &impl ParametricSurface<DVec3>,
    origin: DVec3,
    direction: DVec3,
    hint: (f64, f64),
    distance: f64,
    closed_u: bool,
) -> Result<SurfaceHit, NurbsError> {
    let (du, dv) = surface.domain();
    let inside = |u: f64, v: f64| {
        let u = if closed_u { wrap(u, du) } else { u.clamp(du.0, du.1) };
        (u, v.clamp(dv.0, dv.1))
    };
    let (mut u, mut v) = inside(hint.0, hint.1);
    let mut s = distance;
    let mut residual = f64::INFINITY;
    for _ in 0..NEWTON {
        let (point, su, sv) = surface.first_derivatives(u, v);
        let miss = origin + direction * s - point;
        let now = miss.length();
        if now >= 0.5 * residual && now <= CERTIFIED {
            break;
        }
        residual = now;
        let step = DMat3::from_cols(su, sv, -direction).inverse() * miss;
        if !step.is_finite() {
            break;
        }
        // Steps beyond a quarter of the domain are no longer local.
        let reach = (step.x / (du.1 - du.0)).abs().max((step.y / (dv.1 - dv.0)).abs());
        let factor = if reach > 0.25 { 0.25 / reach } else { 1.0 };
        (u, v) = inside(u + factor * step.x, v + factor * step.y);
        s += factor * step.z;
    }
    let point = surface.point(u, v);
    // Exact in s whatever the last step was.
    s = (point - origin).dot(direction);
    let residual = point.distance(origin + direction * s);
    if residual <= CERTIFIED && s >= -CERTIFIED {
        Ok(SurfaceHit { distance: s, u, v, point })
    } else {
        Err(NurbsError::NoConvergence { what: "meeting of a ray and a surface", residual })
    }
}

/// A touching ray: the point where the curve turns back from the line, if that is on it.
fn touch_curve(
    curve: &impl ParametricCurve<DVec2>,
    origin: DVec2,
    direction: DVec2,
    hint: f64,
) -> Option<CurveHit> {
    let (start, end) = curve.domain();
    let mut t = hint;
    for _ in 0..NEWTON {
        let [_, tangent, bend] = curve.derivatives(t);
        let step = direction.perp_dot(tangent) / direction.perp_dot(bend);
        if !step.is_finite() {
            break;
        }
        t = (t - step).clamp(start, end);
    }
    let point = curve.point(t);
    let s = (point - origin).dot(direction);
    let near = point.distance(origin + direction * s) <= CERTIFIED && s >= -CERTIFIED;
    near.then_some(CurveHit { distance: s, t, point })
}

/// A touching ray: the surface point nearest to the ray, if it is on it.
fn touch_surface(
    surface: &impl ParametricSurface<DVec3>,
    origin: DVec3,
    direction: DVec3,
    hint: (f64, f64),
) -> Option<SurfaceHit> {
    let (du, dv) = surface.domain();
    let (mut u, mut v) = hint;
    for _ in 0..2 * NEWTON {
        // Newton on the squared distance to the line; at a contact it is singular along the ray and converges by a
        // constant factor.
        let d = surface.derivatives(u, v);
        let across = |x: DVec3| x - direction * x.dot(direction);
        let (a, b, r) = (across(d.u), across(d.v), across(d.point - origin));
        let gradient = DVec2::new(r.dot(a), r.dot(b));
        let (h0, h1, h2) = (a.dot(a) + r.dot(d.uu), a.dot(b) + r.dot(d.uv), b.dot(b) + r.dot(d.vv));
        let ridge = 1e-12 * (a.dot(a) + b.dot(b));
        let h = DMat2::from_cols(DVec2::new(h0 + ridge, h1), DVec2::new(h1, h2 + ridge));
        let step = h.inverse() * gradient;
        if !step.is_finite() {
            break;
        }
        u = (u - step.x).clamp(du.0, du.1);
        v = (v - step.y).clamp(dv.0, dv.1);
    }
    let point = surface.point(u, v);
    let s = (point - origin).dot(direction);
    let near = point.distance(origin + direction * s) <= CERTIFIED && s >= -CERTIFIED;
    near.then_some(SurfaceHit { distance: s, u, v, point })
}
