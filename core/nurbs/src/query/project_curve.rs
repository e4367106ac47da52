//! Closest point on a curve from a start value.

use super::project_surface::wrap;
use crate::curve::ParametricCurve;
use crate::error::NurbsError;
use crate::vector::VectorSpace;

/// A closest point on a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveProjection<V> {
    /// Parameter.
    pub t: f64,
    /// The point on the curve.
    pub point: V,
    /// Its distance to the point projected.
    pub distance: f64,
}

const RESIDUAL: f64 = 1e-14;
const RESIDUAL_AT_STALL: f64 = 1e-11;
const STEPS: usize = 60;
const HALVINGS: usize = 40;

/// The closest point to `point` near `hint`: the local minimum of the distance that descent from the hint leads to
/// (thesis 2.3.1, Newton with analytic derivatives and a line search).
///
/// The derivative of the distance along the curve is zero within 1e-14 of the size of the numbers involved (the
/// coordinates and the length of the curve), or has the sign that keeps a minimum at an end or on a kink. With
/// `closed` the search may cross the seam. The hint is moved into the domain first, around the period if closed.
///
/// # Errors
/// [`NurbsError::BadArgument`] for a hint or point that is not finite, [`NurbsError::NoConvergence`] with the rest of
/// the derivative where the descent ends elsewhere.
pub fn project_on_curve<V: VectorSpace>(
    curve: &impl ParametricCurve<V>,
    point: V,
    hint: f64,
    closed: bool,
) -> Result<CurveProjection<V>, NurbsError> {
    if !(hint.is_finite() && point.is_finite_vector()) {
        return Err(NurbsError::BadArgument { what: "start value of a projection", value: hint });
    }
    let domain = curve.domain();
    let t = if closed { wrap(hint, domain) } else { hint };
    let start = State::at(curve, point, t.clamp(domain.0, domain.1));
    match descend(curve, point, start, domain, closed) {
        Ok(s) => Ok(s.projection()),
        Err(stalled) => over_kinks(curve, point, stalled, domain, closed).map(|s| s.projection()),
    }
}

/// Everything known at one parameter.
#[derive(Clone, Copy)]
struct State<V> {
    t: f64,
    d: [V; 3],
    r: V,
    /// Half the squared distance and its derivative.
    half: f64,
    slope: f64,
    /// Squared speed.
    metric: f64,
}

impl<V: VectorSpace> State<V> {
    fn at(curve: &impl ParametricCurve<V>, point: V, t: f64) -> Self {
        let d = curve.derivatives(t);
        let r = d[0] - point;
        Self { t, d, r, half: 0.5 * r.inner(&r), slope: r.inner(&d[1]), metric: d[1].inner(&d[1]) }
    }

    fn projection(&self) -> CurveProjection<V> {
        CurveProjection { t: self.t, point: self.d[0], distance: (2.0 * self.half).sqrt() }
    }

    fn held(&self, (start, end): (f64, f64)) -> bool {
        (self.t <= start && self.slope >= 0.0) || (self.t >= end && self.slope <= 0.0)
    }

    fn scale(&self, point: &V, (start, end): (f64, f64)) -> f64 {
        let span = end - start;
        (point.inner(point) + self.d[0].inner(&self.d[0]) + self.metric * span * span).sqrt()
    }

    /// Length on the curve of what is left of the slope; a derivative that is rounding (a cusp) has no part.
    fn residual(&self, bounds: (f64, f64), scale: f64) -> f64 {
        if self.held(bounds) || self.metric <= 1e-26 * scale * scale {
            0.0
        } else {
            self.slope.abs() / self.metric.sqrt()
        }
    }
}

/// What rounding may do to half the squared distance.
fn noise(half: f64, scale: f64) -> f64 {
    let rounding = 1e-15 * scale;
    rounding * (half.sqrt() + rounding)
}

fn descend<V: VectorSpace>(
    curve: &impl ParametricCurve<V>,
    point: V,
    start: State<V>,
    bounds: (f64, f64),
    closed: bool,
) -> Result<State<V>, State<V>> {
    let mut s = start;
    for _ in 0..STEPS {
        if closed && s.slope != 0.0 && s.held(bounds) {
            let forward = s.t >= bounds.1;
            let other = State::at(curve, point, if forward { bounds.0 } else { bounds.1 });
            let descends = if forward { other.slope < 0.0 } else { other.slope > 0.0 };
            if descends && other.half <= s.half + 1e-9 * s.metric.max(s.half) {
                s = other;
            }
        }
        let scale = s.scale(&point, bounds);
        let residual = s.residual(bounds, scale);
        let bend = s.metric + s.r.inner(&s.d[2]);
        let stationary = residual <= RESIDUAL * scale;
        if stationary && (s.held(bounds) || bend >= -1e-9 * s.metric) {
            return Ok(s);
        }
        let reach = 0.5 * (bounds.1 - bounds.0);
        let newton = -s.slope / bend.abs().max(1e-3 * s.metric).max(f64::MIN_POSITIVE);
        // A maximum is left to either side.
        let step = if stationary { 1e-2 * reach } else { newton.clamp(-reach, reach) };
        let demand = if stationary { -10.0 * noise(s.half, scale) } else { noise(s.half, scale) };
        let mut factor = 1.0;
        let next = (0..HALVINGS).find_map(|k| {
            let t = (s.t + factor * step).clamp(bounds.0, bounds.1);
            let next = State::at(curve, point, t);
            let enough = next.half <= s.half + (1e-4 * factor * step * s.slope).min(0.0) + demand;
            factor *= if stationary && k % 2 == 0 { -1.0 } else { 0.5 };
            (enough && t != s.t).then_some(next)
        });
        match next {
            Some(next) => s = next,
            None if residual <= RESIDUAL_AT_STALL * scale => return Ok(s),
            None => return Err(s),
        }
    }
    let scale = s.scale(&point, bounds);
    if s.residual(bounds, scale) <= RESIDUAL_AT_STALL * scale { Ok(s) } else { Err(s) }
}

/// The descent piece by piece between the breaks of the curve, for minima on kinks.
#[cold]
fn over_kinks<V: VectorSpace>(
    curve: &impl ParametricCurve<V>,
    point: V,
    from: State<V>,
    domain: (f64, f64),
    closed: bool,
) -> Result<State<V>, NurbsError> {
    let breaks = curve.breaks();
    let mut best = from;
    let mut settled = false;
    for _ in 0..STEPS {
        let mut improved = false;
        for &(i, t) in pieces_at(&breaks, best.t, closed).iter().flatten() {
            let last = i + 2 == breaks.len();
            let bounds = (breaks[i], if last { breaks[i + 1] } else { breaks[i + 1].next_down() });
            let start = State::at(curve, point, t.clamp(bounds.0, bounds.1));
            let Ok(end) = descend(curve, point, start, bounds, false) else { continue };
            if !settled || end.half < best.half - 4.0 * noise(best.half, end.scale(&point, domain)) {
                improved = true;
                settled = true;
                best = end;
            }
        }
        if !improved {
            break;
        }
    }
    if settled {
        return Ok(best);
    }
    let residual = best.residual(domain, best.scale(&point, domain));
    Err(NurbsError::NoConvergence { what: "closest point on a curve", residual })
}

/// The one or two intervals between breaks that `t` belongs to, up to rounding, each with `t` as it is there: at a
/// closed seam the second one has the other end of the period.
pub(super) fn pieces_at(breaks: &[f64], t: f64, closed: bool) -> [Option<(usize, f64)>; 2] {
    let last = breaks.len() - 2;
    let i = breaks[1..=last].partition_point(|&b| b <= t);
    let near = 1e-9 * (breaks[i + 1] - breaks[i]);
    let neighbour = if t - breaks[i] <= near {
        if i > 0 { Some((i - 1, t)) } else { closed.then_some((last, breaks[last + 1])) }
    } else if breaks[i + 1] - t <= near {
        if i < last { Some((i + 1, t)) } else { closed.then_some((0, breaks[0])) }
    } else {
        None
    };
    [Some((i, t)), neighbour]
}
