//! Gauss-Legendre quadrature.

use std::sync::OnceLock;

/// Most points a rule has.
pub(crate) const MAX_POINTS: usize = 40;

/// Nodes in (0, 1) with their weights, which sum to 1: exact for polynomials of degree `2 n - 1`.
pub(crate) type Rule = [(f64, f64)];

/// The rule with `n` points, `n` limited to 1..=[`MAX_POINTS`].
pub(crate) fn rule(n: usize) -> &'static Rule {
    static RULES: [OnceLock<Vec<(f64, f64)>>; MAX_POINTS] = [const { OnceLock::new() }; MAX_POINTS];
    let n = n.clamp(1, MAX_POINTS);
    RULES[n - 1].get_or_init(|| compute(n))
}

/// Newton's method on the Legendre polynomial from Tricomi's approximation of its roots.
fn compute(n: usize) -> Vec<(f64, f64)> {
    let count = n as f64;
    let node = |i: usize| {
        let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (count + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..20 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=n {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = count * (x * value - before) / (x * x - 1.0);
            let step = value / slope;
            x -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_to_their_degree() {
        for n in 1..=MAX_POINTS {
            for degree in 0..2 * n {
                let sum: f64 = rule(n).iter().map(|(x, w)| w * x.powi(degree as i32)).sum();
                let exact = 1.0 / (degree as f64 + 1.0);
                assert!((sum - exact).abs() < 5e-15, "{n} points, degree {degree}: {sum} for {exact}");
            }
        }
    }
}
