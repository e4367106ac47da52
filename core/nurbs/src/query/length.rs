//! Arc length and its inverse; curvature.

use crate::curve::ParametricCurve;
use crate::error::NurbsError;
use crate::quadrature::gauss;
use crate::vector::VectorSpace;
use glam::DVec2;
use std::marker::PhantomData;

/// Points of the rule on each interval.
const RULE: usize = 10;
/// Halvings of a span between breaks at most; a cusp costs all of them.
const DEPTH: usize = 45;

/// The arc length of a curve as a function of the parameter, and back; prepared once, asked often.
#[derive(Clone, Debug)]
pub struct ArcLength<V, C> {
    curve: C,
    rule: Vec<(f64, f64)>,
    nodes: Vec<f64>,
    /// Length up to each node.
    lengths: Vec<f64>,
    space: PhantomData<V>,
}

impl<V: VectorSpace, C: ParametricCurve<V>> ArcLength<V, C> {
    /// Prepares `curve` (or a reference to one) by adaptive Gauss quadrature of its speed between breaks: intervals
    /// are halved until that changes the total length by less than `tolerance`. The halves are kept, so that the true
    /// error is smaller by orders for smooth speeds.
    ///
    /// # Errors
    /// [`NurbsError::BadArgument`] for a tolerance that is not positive.
    pub fn new(curve: C, tolerance: f64) -> Result<Self, NurbsError> {
        if !(tolerance > 0.0) {
            return Err(NurbsError::BadArgument { what: "tolerance of an arc length", value: tolerance });
        }
        let breaks = curve.breaks();
        let mut all =
            Self { curve, rule: gauss(RULE), nodes: vec![], lengths: vec![0.0], space: PhantomData };
        let (start, end) = all.curve.domain();
        all.nodes.push(start);
        // A stack of intervals with the length found for them, the next one last.
        let mut stack: Vec<(f64, f64, f64, usize)> =
            breaks.windows(2).rev().map(|b| (b[0], b[1], all.integrate(b[0], b[1]), 0)).collect();
        while let Some((a, b, whole, depth)) = stack.pop() {
            let middle = 0.5 * (a + b);
            let halves = [all.integrate(a, middle), all.integrate(middle, b)];
            let change = (halves[0] + halves[1] - whole).abs();
            let share = tolerance * (b - a) / (end - start);
            if change <= share.max(4.0 * f64::EPSILON * whole) || depth == DEPTH {
                let before = all.lengths[all.lengths.len() - 1];
                all.nodes.extend([middle, b]);
                all.lengths.extend([before + halves[0], before + halves[0] + halves[1]]);
            } else {
                stack.push((middle, b, halves[1], depth + 1));
                stack.push((a, middle, halves[0], depth + 1));
            }
        }
        Ok(all)
    }

    fn speed(&self, t: f64) -> f64 {
        self.curve.derivatives(t)[1].norm()
    }

    fn integrate(&self, a: f64, b: f64) -> f64 {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        half * self.rule.iter().map(|&(x, w)| w * self.speed(middle + half * x)).sum::<f64>()
    }

    /// Length of the whole curve.
    pub fn total(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// Length from the start to `t`, which is clamped to the domain.
    pub fn length(&self, t: f64) -> f64 {
        let last = self.nodes.len() - 1;
        let t = t.clamp(self.nodes[0], self.nodes[last]);
        let i = self.nodes[1..last].partition_point(|&n| n <= t);
        self.lengths[i] + self.integrate(self.nodes[i], t)
    }

    /// The parameter at which the length from the start is `length` (clamped to the curve), to rounding of lengths:
    /// Newton's method inside a bracket.
    pub fn parameter(&self, length: f64) -> f64 {
        let last = self.nodes.len() - 1;
        let length = length.clamp(0.0, self.total());
        let i = self.lengths[1..last].partition_point(|&l| l <= length);
        let (mut low, mut high) = (self.nodes[i], self.nodes[i + 1]);
        let share = (length - self.lengths[i]) / (self.lengths[i + 1] - self.lengths[i]);
        let mut t = if share.is_finite() { low + (high - low) * share.clamp(0.0, 1.0) } else { low };
        for _ in 0..80 {
            let off = self.lengths[i] + self.integrate(self.nodes[i], t) - length;
            if off.abs() <= 2.0 * f64::EPSILON * self.total() {
                break;
            }
            if off > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - off / self.speed(t);
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if next == t {
                break;
            }
            t = next;
        }
        t
    }
}

/// Signed curvature of a plane curve at `t`: positive where it turns left. Not finite where the speed vanishes.
pub fn signed_curvature(curve: &impl ParametricCurve<DVec2>, t: f64) -> f64 {
    let [_, d, dd] = curve.derivatives(t);
    d.perp_dot(dd) / d.length_squared().powf(1.5)
}

/// Curvature of a curve at `t`, not negative, in any dimension. Not finite where the speed vanishes.
pub fn curvature<V: VectorSpace>(curve: &impl ParametricCurve<V>, t: f64) -> f64 {
    let [_, d, dd] = curve.derivatives(t);
    let square = d.inner(&d);
    // The part of the second derivative across the first one.
    let across = dd - d * (d.inner(&dd) / square);
    across.norm() / square
}
