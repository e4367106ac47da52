//! Closest point on a surface from a start value: the hot loop of everything that measures walls.
//!
//! Newton's method on half the squared distance (thesis 2.3.1, with analytic derivatives in place of difference
//! quotients), made safe: a Hessian made positive definite where it is not, each step the exact
//! minimum of the quadratic model on the parameter rectangle (which is the active-set handling at borders), and a
//! line search that only accepts descent.

use super::project_curve::pieces_at;
use crate::bernstein::quadratic_minimum;
use crate::error::NurbsError;
use crate::surface::{ParametricSurface, SurfaceDerivatives};
use crate::vector::VectorSpace;
use glam::DVec3;

/// A closest point on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection<V = DVec3> {
    /// First parameter.
    pub u: f64,
    /// Second parameter.
    pub v: f64,
    /// The point on the surface.
    pub point: V,
    /// Its distance to the point projected.
    pub distance: f64,
}

/// The rest of the gradient at which the iteration ends, as a length on the surface over the size of the numbers
/// involved: a few roundings.
const RESIDUAL: f64 = 1e-14;
/// The rest accepted where rounding stops the descent before.
const RESIDUAL_AT_STALL: f64 = 1e-11;
const STEPS: usize = 60;
const HALVINGS: usize = 40;

/// The closest point to `point` near `hint`: the local minimum of the distance that descent from the hint leads to.
///
/// The derivative of the distance along the surface is zero within 1e-14 of the size of the numbers involved (the
/// coordinates and the extent of the surface), or has the sign that keeps a minimum on a border. Convergence is
/// quadratic where the surface is twice differentiable. With `closed_u` the borders `u = start` and `u = end` are
/// one line that the search may cross, kinked or not. Kinks inside (knots of full multiplicity) are handled too,
/// slower. The hint is moved into the domain first, around the period if closed.
///
/// # Errors
/// [`NurbsError::BadArgument`] for a hint or point that is not finite, [`NurbsError::NoConvergence`] with the rest of
/// the derivative, as a length, where the descent ends elsewhere.
pub fn project_on_surface<V: VectorSpace>(
    surface: &impl ParametricSurface<V>,
    point: V,
    hint: (f64, f64),
    closed_u: bool,
) -> Result<Projection<V>, NurbsError> {
    let bounds = Bounds::of(surface.domain());
    if !(hint.0.is_finite() && hint.1.is_finite() && point.is_finite_vector()) {
        let value = if hint.0.is_finite() { hint.1 } else { hint.0 };
        return Err(NurbsError::BadArgument { what: "start value of a projection", value });
    }
    let u = if closed_u { wrap(hint.0, bounds.u) } else { hint.0 };
    let start = State::at(surface, point, bounds.clamp(u, hint.1));
    match descend(surface, point, start, &bounds, closed_u) {
        Ok(state) => Ok(state.projection()),
        Err(stalled) => over_kinks(surface, point, stalled, closed_u).map(|s| s.projection()),
    }
}

/// `t` moved into `[start, end)` by whole periods, if it is outside of `[start, end]`.
pub(super) fn wrap(t: f64, (start, end): (f64, f64)) -> f64 {
    if t < start || t > end { start + (t - start).rem_euclid(end - start) } else { t }
}

/// The rectangle a search stays in.
struct Bounds {
    u: (f64, f64),
    v: (f64, f64),
}

impl Bounds {
    fn of((u, v): ((f64, f64), (f64, f64))) -> Self {
        Self { u, v }
    }

    fn clamp(&self, u: f64, v: f64) -> (f64, f64) {
        (u.clamp(self.u.0, self.u.1), v.clamp(self.v.0, self.v.1))
    }
}

/// Everything known at one pair of parameters.
#[derive(Clone, Copy)]
struct State<V> {
    u: f64,
    v: f64,
    d: SurfaceDerivatives<V>,
    /// From the point projected to the surface point.
    r: V,
    /// Half the squared distance, and its gradient.
    half: f64,
    gradient: [f64; 2],
    /// First fundamental form.
    metric: [f64; 3],
}

impl<V: VectorSpace> State<V> {
    #[inline]
    fn at(surface: &impl ParametricSurface<V>, point: V, (u, v): (f64, f64)) -> Self {
        let d = surface.derivatives(u, v);
        let r = d.point - point;
        let metric = [d.u.inner(&d.u), d.u.inner(&d.v), d.v.inner(&d.v)];
        Self { u, v, d, r, half: 0.5 * r.inner(&r), gradient: [r.inner(&d.u), r.inner(&d.v)], metric }
    }

    fn projection(&self) -> Projection<V> {
        Projection { u: self.u, v: self.v, point: self.d.point, distance: (2.0 * self.half).sqrt() }
    }

    /// Whether each parameter is held at its border by the gradient.
    #[inline]
    fn held(&self, bounds: &Bounds) -> [bool; 2] {
        let held =
            |t: f64, g: f64, (low, high): (f64, f64)| (t <= low && g >= 0.0) || (t >= high && g <= 0.0);
        [held(self.u, self.gradient[0], bounds.u), held(self.v, self.gradient[1], bounds.v)]
    }

    /// Size of the numbers that rounding acts on.
    #[inline]
    fn scale(&self, point: &V, bounds: &Bounds) -> f64 {
        let along = |square: f64, (a, b): (f64, f64)| square * (b - a) * (b - a);
        // A root of a sum of squares: within a factor of two of the sum of lengths, for one root.
        (point.inner(point)
            + self.d.point.inner(&self.d.point)
            + along(self.metric[0], bounds.u)
            + along(self.metric[2], bounds.v))
        .sqrt()
    }

    /// Length on the surface of what is left of the gradient; a derivative that is rounding (a pole) has no part.
    #[inline]
    fn residual(&self, held: [bool; 2], scale: f64) -> f64 {
        let least = 1e-26 * scale * scale;
        let left = |held: bool, g: f64, m: f64| if held || m <= least { 0.0 } else { g * g / m };
        left(held[0], self.gradient[0], self.metric[0])
            .max(left(held[1], self.gradient[1], self.metric[2]))
            .sqrt()
    }

    #[inline]
    fn hessian(&self) -> [f64; 3] {
        let [a, b, c] = self.metric;
        [a + self.r.inner(&self.d.uu), b + self.r.inner(&self.d.uv), c + self.r.inner(&self.d.vv)]
    }

    /// The minimum of the quadratic model on the rectangle, as a step; parameters held at a border stay there.
    #[inline]
    fn step(&self, bounds: &Bounds, held: [bool; 2]) -> [f64; 2] {
        let mut h = self.hessian();
        if held[0] || held[1] {
            // The model along the border alone decides: the whole one may be indefinite without harm.
            let along = |h: f64, m: f64| h.abs().max(1e-3 * m).max(f64::MIN_POSITIVE);
            h = [along(h[0], self.metric[0]), 0.0, along(h[2], self.metric[2])];
        } else if !(h[0] > 0.0 && h[2] > 0.0 && h[0] * h[2] - h[1] * h[1] > 1e-6 * h[0] * h[2]) {
            h = made_definite(h, self.metric);
        }
        let low = [bounds.u.0 - self.u, bounds.v.0 - self.v];
        let high = [bounds.u.1 - self.u, bounds.v.1 - self.v];
        let mut step = quadratic_minimum(h, self.gradient, low, high);
        // Half the domain is as far as a model can be trusted at all.
        let reach =
            (step[0].abs() / (bounds.u.1 - bounds.u.0)).max(step[1].abs() / (bounds.v.1 - bounds.v.0));
        if reach > 0.5 {
            step = step.map(|s| s * 0.5 / reach);
        }
        step
    }
}

/// The Hessian with its eigenvalues (relative to the lengths of the surface's derivatives) replaced by their
/// magnitudes: descent also leaves saddles and concave regions fast, where Gauss-Newton steps would creep.
#[cold]
fn made_definite(h: [f64; 3], metric: [f64; 3]) -> [f64; 3] {
    const LEAST: f64 = 1e-3;
    let (su, sv) = (metric[0].sqrt(), metric[2].sqrt());
    // Where one derivative vanishes (a pole), only the other parameter moves the point.
    if !(su.min(sv) > 1e-9 * su.max(sv)) {
        let size = su.max(sv).max(f64::MIN_POSITIVE);
        let along = |h: f64, s: f64| if s >= size { h.abs().max(LEAST * s * s) } else { size * size };
        return [along(h[0], su), 0.0, along(h[2], sv)];
    }
    let (a, b, c) = (h[0] / (su * su), h[1] / (su * sv), h[2] / (sv * sv));
    let (mean, half) = (0.5 * (a + c), 0.5 * (a - c));
    let radius = half.hypot(b);
    let (cos, sin) = if radius > 0.0 { (half / radius, b / radius) } else { (1.0, 0.0) };
    let (first, second) = ((mean + radius).abs().max(LEAST), (mean - radius).abs().max(LEAST));
    let (mean, radius) = (0.5 * (first + second), 0.5 * (first - second));
    [(mean + radius * cos) * su * su, radius * sin * su * sv, (mean - radius * cos) * sv * sv]
}

/// Newton's descent inside `bounds`; `Err` with the last state where it stalls.
#[inline]
fn descend<V: VectorSpace>(
    surface: &impl ParametricSurface<V>,
    point: V,
    start: State<V>,
    bounds: &Bounds,
    closed_u: bool,
) -> Result<State<V>, State<V>> {
    let mut s = start;
    for _ in 0..STEPS {
        let mut held = s.held(bounds);
        if closed_u
            && held[0]
            && s.gradient[0] != 0.0
            && let Some(other) = over_seam(surface, point, &s, bounds)
        {
            s = other;
            held = s.held(bounds);
        }
        let scale = s.scale(&point, bounds);
        if s.residual(held, scale) <= RESIDUAL * scale {
            match escape(surface, point, &s, held, bounds, scale) {
                Some(lower) => s = lower,
                None => return Ok(s),
            }
            continue;
        }
        let step = s.step(bounds, held);
        match search(surface, point, &s, step, bounds, scale) {
            Some(next) => s = next,
            None if s.residual(held, scale) <= RESIDUAL_AT_STALL * scale => return Ok(s),
            None => return Err(s),
        }
    }
    let residual = s.residual(s.held(bounds), s.scale(&point, bounds));
    if residual <= RESIDUAL_AT_STALL * s.scale(&point, bounds) { Ok(s) } else { Err(s) }
}

/// What rounding may do to half the squared distance.
fn noise(half: f64, scale: f64) -> f64 {
    let rounding = 1e-15 * scale;
    rounding * (half.sqrt() + rounding)
}

/// The first of the halved steps that descends far enough.
#[inline]
fn search<V: VectorSpace>(
    surface: &impl ParametricSurface<V>,
    point: V,
    s: &State<V>,
    step: [f64; 2],
    bounds: &Bounds,
    scale: f64,
) -> Option<State<V>> {
    let slope = s.gradient[0] * step[0] + s.gradient[1] * step[1];
    let mut factor = 1.0;
    for _ in 0..HALVINGS {
        let to = bounds.clamp(s.u + factor * step[0], s.v + factor * step[1]);
        if to == (s.u, s.v) {
            return None;
        }
        let next = State::at(surface, point, to);
        if next.half <= s.half + 1e-4 * factor * slope.min(0.0) + noise(s.half, scale) {
            return Some(next);
        }
        factor *= 0.5;
    }
    None
}

/// The other side of the seam, if the descent goes on there.
fn over_seam<V: VectorSpace>(
    surface: &impl ParametricSurface<V>,
    point: V,
    s: &State<V>,
    bounds: &Bounds,
) -> Option<State<V>> {
    let (low, high) = bounds.u;
    let forward = s.u >= high;
    let other = State::at(surface, point, (if forward { low } else { high }, s.v));
    let descends = if forward { other.gradient[0] < 0.0 } else { other.gradient[0] > 0.0 };
    (descends && other.half <= s.half + 1e-9 * s.metric[0].max(s.half)).then_some(other)
}

/// A lower state next to a stationary one that is no minimum (a saddle, or the farthest point).
fn escape<V: VectorSpace>(
    surface: &impl ParametricSurface<V>,
    point: V,
    s: &State<V>,
    held: [bool; 2],
    bounds: &Bounds,
    scale: f64,
) -> Option<State<V>> {
    let mut h = s.hessian();
    let m = s.metric;
    if m[0] <= 1e-24 * scale * scale && s.gradient[1] != 0.0 {
        return around_pole(surface, point, s, bounds, scale);
    }
    // Curvatures relative to the metric, so that rounding is told from saddles.
    let floor = |i: usize| -1e-9 * m[i];
    for (i, &held) in held.iter().enumerate() {
        if held {
            h[2 * i] = h[2 * i].max(m[2 * i]);
            h[1] = 0.0;
        }
    }
    let indefinite = h[0] * h[2] - h[1] * h[1] < -1e-9 * m[0] * m[2];
    if !(h[0] < floor(0) || h[2] < floor(2) || indefinite) {
        return None;
    }
    // The direction of least curvature in the metric `diag(m)`.
    let (a, b, c) = (h[0] / m[0], h[1] / (m[0] * m[2]).sqrt(), h[2] / m[2]);
    let angle = 0.5 * (2.0 * b).atan2(a - c) + std::f64::consts::FRAC_PI_2;
    let direction = [angle.cos() / m[0].sqrt(), angle.sin() / m[2].sqrt()];
    let size = m[0].sqrt() * (bounds.u.1 - bounds.u.0) + m[2].sqrt() * (bounds.v.1 - bounds.v.0);
    let mut length = 1e-2 * size;
    while length > 1e-7 * size {
        for signed in [length, -length] {
            let to = bounds.clamp(s.u + signed * direction[0], s.v + signed * direction[1]);
            let next = State::at(surface, point, to);
            if next.half < s.half - 10.0 * noise(s.half, scale) {
                return Some(next);
            }
        }
        length *= 0.25;
    }
    None
}

/// A lower state next to a border in v that is one point (the pole of a sphere), where u says in which direction
/// to leave it.
fn around_pole<V: VectorSpace>(
    surface: &impl ParametricSurface<V>,
    point: V,
    s: &State<V>,
    bounds: &Bounds,
    scale: f64,
) -> Option<State<V>> {
    const DIRECTIONS: usize = 16;
    let inward = if s.v <= bounds.v.0 { 1.0 } else { -1.0 };
    let (start, end) = bounds.u;
    let mut best = (0.0, s.u);
    for k in 0..DIRECTIONS {
        let u = start + (end - start) * k as f64 / DIRECTIONS as f64;
        let slope = inward * State::at(surface, point, (u, s.v)).gradient[1];
        if slope < best.0 {
            best = (slope, u);
        }
    }
    let mut step = 1e-2 * (bounds.v.1 - bounds.v.0);
    for _ in 0..HALVINGS {
        let next = State::at(surface, point, bounds.clamp(best.1, s.v + inward * step));
        if next.half < s.half - 10.0 * noise(s.half, scale) {
            return Some(next);
        }
        step *= 0.5;
    }
    None
}

/// The descent patch by patch between the breaks of the surface, for minima on kinks.
#[cold]
fn over_kinks<V: VectorSpace>(
    surface: &impl ParametricSurface<V>,
    point: V,
    from: State<V>,
    closed_u: bool,
) -> Result<State<V>, NurbsError> {
    let whole = Bounds::of(surface.domain());
    let (breaks_u, breaks_v) = (surface.breaks_u(), surface.breaks_v());
    // Patches are open at their upper ends, where derivatives belong to the next patch.
    let interval = |breaks: &[f64], i: usize| {
        let last = i + 2 == breaks.len();
        (breaks[i], if last { breaks[i + 1] } else { breaks[i + 1].next_down() })
    };
    let mut best = from;
    let mut settled = false;
    for _ in 0..STEPS {
        let around_u = pieces_at(&breaks_u, best.u, closed_u);
        let around_v = pieces_at(&breaks_v, best.v, false);
        let mut improved = false;
        for &(i, u) in around_u.iter().flatten() {
            for &(j, v) in around_v.iter().flatten() {
                let patch = Bounds { u: interval(&breaks_u, i), v: interval(&breaks_v, j) };
                let start = State::at(surface, point, patch.clamp(u, v));
                let Ok(end) = descend(surface, point, start, &patch, false) else { continue };
                let scale = end.scale(&point, &whole);
                if !settled || end.half < best.half - 4.0 * noise(best.half, scale) {
                    improved = true;
                    settled = true;
                    best = end;
                }
            }
        }
        if !improved {
            break;
        }
    }
    if settled {
        return Ok(best);
    }
    let residual = best.residual(best.held(&whole), best.scale(&point, &whole));
    Err(NurbsError::NoConvergence { what: "closest point on a surface", residual })
}
