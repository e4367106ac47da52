//! How a closure is run through: parametrisations that are continuously differentiable over its three segments.
//!
//! Blending two curves keeps their smoothness only in parameters in which both are smooth. A fillet and the straight line
//! beside it meet with one tangent but at different speeds; each closure therefore gets a parameter of its own in which
//! speeds agree, and closures are blended in that.

/// A smooth increasing map of [0, 1] onto itself with given slopes at both ends: the rational quadratic of Gregory and
/// Delbourgo (1982).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pace {
    start: f64,
    end: f64,
}

impl Pace {
    /// The map with slopes `start` and `end`, both positive.
    pub(super) fn new(start: f64, end: f64) -> Self {
        Self { start, end }
    }

    /// Paces of three segments with the speeds (first, last) of each; at the outer ends slopes are 1.
    pub(super) fn of_three(speeds: [[f64; 2]; 3]) -> [Self; 3] {
        // Slopes in the ratio of the speeds, with the product 1.
        let ratio = |k: usize| (speeds[k][1] / speeds[k + 1][0]).sqrt();
        let (first, second) = (ratio(0), ratio(1));
        [Self::new(1.0, first), Self::new(1.0 / first, second), Self::new(1.0 / second, 1.0)]
    }

    /// The value at `t`.
    pub(super) fn at(self, t: f64) -> f64 {
        let bump = t * (1.0 - t);
        (t * t + self.start * bump) / (1.0 + (self.start + self.end - 2.0) * bump)
    }

    /// The argument with the value `s`: the root of a quadratic.
    pub(super) fn inverse(self, s: f64) -> f64 {
        let excess = s * (self.start + self.end - 2.0);
        let (a, b, c) = (1.0 - self.start + excess, self.start - excess, -s);
        // Citardauq's form is exact for a = 0, too.
        let root = (b * b - 4.0 * a * c).max(0.0).sqrt();
        if b + root > 0.0 { -2.0 * c / (b + root) } else { (root - b) / (2.0 * a) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paces_increase_with_their_slopes_and_invert() {
        for (start, end) in [(1.0, 1.0), (0.2, 4.0), (5.0, 0.1), (3.0, 3.0), (0.3, 0.3)] {
            let pace = Pace::new(start, end);
            let step = 1e-7;
            assert!(((pace.at(step) - pace.at(0.0)) / step - start).abs() < 1e-4 * start.max(1.0));
            assert!(((pace.at(1.0) - pace.at(1.0 - step)) / step - end).abs() < 1e-4 * end.max(1.0));
            let mut before = -1.0;
            for i in 0..=100 {
                let t = f64::from(i) / 100.0;
                let s = pace.at(t);
                assert!(s > before);
                before = s;
                assert!((pace.inverse(s) - t).abs() < 1e-12, "{start} {end} {t}");
            }
        }
    }
}
