//! Gauss-Legendre rules.

/// Nodes on [-1, 1] and weights of the rule with `n` points (1 to 64), exact for polynomials of degree `2 n - 1`:
/// Newton's method on the Legendre polynomial from Tricomi's start values.
pub(crate) fn gauss(n: usize) -> Vec<(f64, f64)> {
    let rule = |i: usize| {
        let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut p, mut before) = (x, 1.0);
            for k in 2..=n {
                let k = k as f64;
                (p, before) = (((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k, p);
            }
            slope = n as f64 * (before - x * p) / (1.0 - x * x);
            x -= p / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(rule).collect()
}

/// Nodes and weights of the rule with `n` points on every span between `breaks`.
pub(crate) fn gauss_on_spans(breaks: &[f64], n: usize) -> (Vec<f64>, Vec<f64>) {
    let rule = gauss(n);
    let (mut nodes, mut weights) = (Vec::new(), Vec::new());
    for span in breaks.windows(2) {
        let half = 0.5 * (span[1] - span[0]);
        for &(x, w) in &rule {
            nodes.push(0.5 * (span[0] + span[1]) + half * x);
            weights.push(w * half);
        }
    }
    (nodes, weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_to_their_degree() {
        for n in 1..=20 {
            let rule = gauss(n);
            for power in 0..2 * n as i32 {
                let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(power)).sum();
                let exact = if power % 2 == 0 { 2.0 / f64::from(power + 1) } else { 0.0 };
                assert!((sum - exact).abs() < 1e-14, "{n} {power} {sum}");
            }
        }
    }
}
