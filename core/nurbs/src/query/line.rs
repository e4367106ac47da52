//! Where a straight line meets a surface.

use crate::surface::ParametricSurface;
use glam::{DMat3, DVec3};

/// Where a line meets a surface, and the surface's derivatives there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineHit {
    /// Multiple of the direction.
    pub along: f64,
    /// Parameters.
    pub u: f64,
    /// Parameters.
    pub v: f64,
    /// The point of the surface.
    pub point: DVec3,
    /// Derivative in u.
    pub du: DVec3,
    /// Derivative in v.
    pub dv: DVec3,
}

/// Distance between line and surface at which they count as met, mm.
const MET: f64 = 1e-10;
/// Distance at which one step more is the last, mm: derivatives from before the step are good to about as much.
const NEAR: f64 = 1e-8;
/// What the last step may leave, mm.
const NEGLIGIBLE: f64 = 1e-16;
const NEWTON: usize = 30;

/// The meeting of the line `origin + s direction` with the surface near the parameters `hint` and `s = along`, by
/// Newton's method. Neither the line nor the surface ends: outside its domain the surface's end polynomials are
/// continued, so that a caller can see over which border the line leaves. None where the method does not get within
/// 1e-10 mm.
pub fn line_meets_surface(
    surface: &impl ParametricSurface<DVec3>,
    origin: DVec3,
    direction: DVec3,
    hint: (f64, f64),
    along: f64,
) -> Option<LineHit> {
    line_meets(surface.domain(), |u, v| surface.first_derivatives(u, v), origin, direction, hint, along)
}

/// As [`line_meets_surface`], for the surface over `domain` whose point and first derivatives `surface` knows.
pub fn line_meets(
    ((u0, u1), (v0, v1)): ((f64, f64), (f64, f64)),
    mut surface: impl FnMut(f64, f64) -> (DVec3, DVec3, DVec3),
    origin: DVec3,
    direction: DVec3,
    hint: (f64, f64),
    along: f64,
) -> Option<LineHit> {
    let reach =
        |x: f64, low: f64, high: f64| if (high - low).is_finite() { (x / (high - low)).abs() } else { 0.0 };
    let ((mut u, mut v), mut s) = (hint, along);
    let unit = direction.normalize();
    let mut before = f64::INFINITY;
    for _ in 0..NEWTON {
        let (point, du, dv) = surface(u, v);
        let miss = origin + direction * s - point;
        // The method is linear along the line: only the distance from it tells how good the parameters are.
        let now = (miss - unit * miss.dot(unit)).length();
        let step = DMat3::from_cols(du, dv, -direction).inverse() * miss;
        if !step.is_finite() {
            return None;
        }
        // What the step leaves, as the method converges by squares: at the pace seen so far, or, before one is seen, at
        // that of curvatures by the tenth of a millimetre.
        let left = if before.is_finite() { now * (now / before) * (now / before) } else { 10.0 * now * now };
        // Or met, and no step makes it better: rounding is all that is left.
        if now <= NEAR && left <= NEGLIGIBLE || now <= MET && now >= 0.25 * before {
            return Some(LineHit {
                along: s + step.z,
                u: u + step.x,
                v: v + step.y,
                point: point + du * step.x + dv * step.y,
                du,
                dv,
            });
        }
        before = now;
        // Steps beyond a quarter of the domain are no longer local.
        let far = reach(step.x, u0, u1).max(reach(step.y, v0, v1));
        let factor = if far > 0.25 { 0.25 / far } else { 1.0 };
        (u, v, s) = (u + factor * step.x, v + factor * step.y, s + factor * step.z);
    }
    None
}
