//! One-dimensional grading: how densely a parameter interval must be divided.

/// A density over an interval, constant on each cell: the integral over a piece is the number of steps it needs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grading {
    /// Borders of the cells, increasing.
    borders: Vec<f64>,
    /// Integral of the density up to each border.
    sums: Vec<f64>,
    /// Borders at which a step must end: kinks, and both ends.
    stops: Vec<usize>,
}

impl Grading {
    /// `densities[i]` holds between `borders[i]` and `borders[i + 1]`; `is_kink` says where steps must end.
    pub(crate) fn new(borders: Vec<f64>, densities: &[f64], is_kink: impl Fn(f64) -> bool) -> Self {
        let mut sums = Vec::with_capacity(borders.len());
        sums.push(0.0);
        for (i, d) in densities.iter().enumerate() {
            sums.push(sums[i] + d * (borders[i + 1] - borders[i]));
        }
        let last = borders.len() - 1;
        let stops = (0..=last).filter(|&i| i == 0 || i == last || is_kink(borders[i])).collect();
        Self { borders, sums, stops }
    }

    /// Steps needed over the whole interval, not rounded.
    pub(crate) fn total(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// Steps needed up to `t`, not rounded; constant outside the interval.
    pub(crate) fn steps_to(&self, t: f64) -> f64 {
        let i = self.borders.partition_point(|&b| b <= t);
        if i == 0 {
            return 0.0;
        }
        if i >= self.borders.len() {
            return self.total();
        }
        let f = (t - self.borders[i - 1]) / (self.borders[i] - self.borders[i - 1]);
        self.sums[i - 1] + f * (self.sums[i] - self.sums[i - 1])
    }

    /// Parameters that divide the interval as densely as asked, `factor` times as densely: each piece between
    /// kinks into equal numbers of steps. Both ends are included.
    pub(crate) fn divide(&self, factor: f64) -> Vec<f64> {
        let mut out = vec![self.borders[0]];
        for pair in self.stops.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let steps = self.sums[b] - self.sums[a];
            // A hair over a whole number is that number.
            let count = (steps * factor - 1e-9).ceil().max(1.0);
            let mut cell = a;
            for k in 1..count as usize {
                let goal = self.sums[a] + steps * k as f64 / count;
                while cell + 1 < b && self.sums[cell + 1] < goal {
                    cell += 1;
                }
                let (low, high) = (self.sums[cell], self.sums[cell + 1]);
                let f = if high > low { (goal - low) / (high - low) } else { 0.5 };
                out.push(self.borders[cell] + f * (self.borders[cell + 1] - self.borders[cell]));
            }
            out.push(self.borders[b]);
        }
        out
    }
}

/// Borders of cells: every break inside `(start, end)` and both ends, each span divided so that there are at least
/// `least` cells and at least `per_span` a span.
pub(crate) fn cells(breaks: &[f64], start: f64, end: f64, per_span: usize, least: usize) -> Vec<f64> {
    let margin = 1e-9 * (end - start);
    let mut spans = vec![start];
    spans.extend(breaks.iter().copied().filter(|&b| b > start + margin && b < end - margin));
    spans.push(end);
    let each = per_span.max(least.div_ceil(spans.len() - 1));
    let mut out = Vec::with_capacity((spans.len() - 1) * each + 1);
    for pair in spans.windows(2) {
        out.extend((0..each).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / each as f64));
    }
    out.push(end);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn division_follows_the_density_and_keeps_kinks() {
        let g = Grading::new(vec![0.0, 1.0, 2.0], &[3.0, 0.0], |_| false);
        let t = g.divide(1.0);
        assert_eq!(t.len(), 4);
        assert!((t[1] - 1.0 / 3.0).abs() < 1e-12 && t[3] == 2.0);
        assert!((g.steps_to(0.5) - 1.5).abs() < 1e-12 && g.steps_to(1.7) == 3.0);
        let g = Grading::new(vec![0.0, 1.0, 2.0], &[0.1, 0.1], |t| t == 1.0);
        assert_eq!(g.divide(1.0), [0.0, 1.0, 2.0]);
    }

    #[test]
    fn cells_keep_breaks() {
        assert_eq!(cells(&[0.0, 0.5, 1.0], 0.25, 1.0, 2, 1), [0.25, 0.375, 0.5, 0.75, 1.0]);
        assert_eq!(cells(&[], 0.0, 1.0, 1, 4).len(), 5);
    }
}
