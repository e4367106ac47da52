//! Running integrals along a curve, tabulated in both directions.

/// `F(s) = integral of f from s_0 to s`, `f > 0`, and its inverse, by quintic Hermite pieces.
///
/// Nodes stand at the breaks given and wherever it takes more to keep both directions within the accuracy asked at the
/// middles of the pieces, where the error of a quintic Hermite piece is greatest. Beyond the ends the end pieces are
/// continued.
#[derive(Clone, Debug)]
pub(crate) struct Measure {
    starts: Vec<f64>,
    totals: Vec<f64>,
    pieces: Vec<Piece>,
}

#[derive(Clone, Copy, Debug)]
struct Piece {
    s: [f64; 2],
    total: [f64; 2],
    /// `f` at the ends, and `df/ds` there, from inside.
    density: [f64; 2],
    slope: [f64; 2],
}

impl Measure {
    const DEEPEST: u32 = 14;

    /// Tabulates `density(s)` = `(f, df/ds)` between increasing `breaks`, at least two, where `f` may have kinks.
    /// `accuracy` has the unit of `F` (mm).
    pub(crate) fn new(breaks: &[f64], accuracy: f64, density: impl Fn(f64) -> (f64, f64)) -> Self {
        let mut measure = Self { starts: Vec::new(), totals: Vec::new(), pieces: Vec::new() };
        let mut total = 0.0;
        for w in breaks.windows(2) {
            total = measure.fill([w[0], w[1]], total, (accuracy, Self::DEEPEST), &density);
        }
        measure
    }

    /// Adds pieces from `a` to `b`, where F is `before`, in up to 2^`deepest` parts; F at `b`.
    fn fill(
        &mut self,
        [a, b]: [f64; 2],
        before: f64,
        (accuracy, deepest): (f64, u32),
        density: &impl Fn(f64) -> (f64, f64),
    ) -> f64 {
        let middle = 0.5 * (a + b);
        let halves = [gauss(a, middle, density), gauss(middle, b, density)];
        let size = halves[0] + halves[1];
        let inset = 1e-13 * (b - a);
        let (start, end) = (density(a + inset), density(b - inset));
        let piece = Piece {
            s: [a, b],
            total: [before, before + size],
            density: [start.0, end.0],
            slope: [start.1, end.1],
        };
        let at = before + halves[0];
        let worst =
            (piece.forward(middle) - at).abs().max((piece.backward(at) - middle).abs() * start.0.min(end.0));
        let goal = accuracy.max(4.0 * f64::EPSILON * at.abs());
        if worst > goal && deepest > 0 {
            // The error of a piece falls with the sixth power of its length: about as many halvings at once as that takes.
            let halvings = ((worst / goal).log2() / 6.0).round().clamp(1.0, f64::from(deepest)) as u32;
            let parts = f64::from(1u32 << halvings);
            let cut = |k: f64| if k == parts { b } else { a + (b - a) * (k / parts) };
            let mut total = before;
            for k in 0..1u32 << halvings {
                let part = [cut(f64::from(k)), cut(f64::from(k + 1))];
                total = self.fill(part, total, (accuracy, deepest - halvings), density);
            }
            return total;
        }
        self.starts.push(a);
        self.totals.push(before);
        self.pieces.push(piece);
        before + size
    }

    /// `F(s)`.
    pub(crate) fn forward(&self, s: f64) -> f64 {
        self.pieces[find(&self.starts, s)].forward(s)
    }

    /// The `s` with `F(s) = total`.
    pub(crate) fn backward(&self, total: f64) -> f64 {
        self.pieces[find(&self.totals, total)].backward(total)
    }

    /// `F` over the whole.
    pub(crate) fn total(&self) -> f64 {
        self.pieces[self.pieces.len() - 1].total[1]
    }
}

fn find(starts: &[f64], value: f64) -> usize {
    starts[1..].partition_point(|&k| k <= value)
}

impl Piece {
    fn forward(&self, s: f64) -> f64 {
        hermite(s, self.s, self.total, self.density, self.slope)
    }

    fn backward(&self, total: f64) -> f64 {
        let first = self.density.map(|f| 1.0 / f);
        let second = [0, 1].map(|i| -self.slope[i] * first[i] * first[i] * first[i]);
        hermite(total, self.total, self.s, first, second)
    }
}

/// The quintic on `[x0, x1]` with values `y`, first derivatives `d` and second derivatives `c` at the ends.
fn hermite(x: f64, [x0, x1]: [f64; 2], [y0, y1]: [f64; 2], d: [f64; 2], c: [f64; 2]) -> f64 {
    let h = x1 - x0;
    // From the nearer end, so that the ends are met exactly.
    if x - x0 <= x1 - x {
        from_end((x - x0) / h, y0, y1, [d[0] * h, d[1] * h], c.map(|c| 0.5 * c * h * h))
    } else {
        from_end((x1 - x) / h, y1, y0, [-d[1] * h, -d[0] * h], [c[1], c[0]].map(|c| 0.5 * c * h * h))
    }
}

fn from_end(t: f64, y0: f64, y1: f64, [d0, d1]: [f64; 2], [c0, c1]: [f64; 2]) -> f64 {
    let (a, b, e) = (y1 - y0 - d0 - c0, d1 - d0 - 2.0 * c0, c1 - c0);
    let cubic = 10.0 * a - 4.0 * b + e;
    let quartic = -15.0 * a + 7.0 * b - 2.0 * e;
    let quintic = 6.0 * a - 3.0 * b + e;
    y0 + t * (d0 + t * (c0 + t * (cubic + t * (quartic + t * quintic))))
}

/// Gauss-Legendre quadrature with four points: on half a piece its error is of the ninth order in the piece's length,
/// far below that of the piece itself.
fn gauss(a: f64, b: f64, f: &impl Fn(f64) -> (f64, f64)) -> f64 {
    const NODES: [f64; 2] = [0.339_981_043_584_856_26, 0.861_136_311_594_052_6];
    const WEIGHTS: [f64; 2] = [0.652_145_154_862_546_1, 0.347_854_845_137_453_85];
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let mut sum = 0.0;
    for (x, w) in NODES.iter().zip(WEIGHTS) {
        sum += w * (f(middle - half * x).0 + f(middle + half * x).0);
    }
    half * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverts_a_logarithm() {
        // f = 100 / (1 + s): F = 100 ln(1 + s).
        let m = Measure::new(&[0.0, 0.3, 2.0], 1e-12, |s| (100.0 / (1.0 + s), -100.0 / (1.0 + s).powi(2)));
        assert!((m.total() - 100.0 * 3f64.ln()).abs() < 1e-12);
        for i in 0..=1000 {
            let s = f64::from(i) / 500.0;
            let exact = 100.0 * s.ln_1p();
            assert!((m.forward(s) - exact).abs() < 2e-12);
            assert!((m.backward(exact) - s).abs() < 6e-14);
        }
        assert!(m.pieces.len() < 140, "{}", m.pieces.len());
    }

    #[test]
    fn kinks_at_breaks_cost_nothing() {
        let m = Measure::new(&[0.0, 1.0, 2.0], 1e-12, |s| if s < 1.0 { (1.0, 0.0) } else { (3.0, 0.0) });
        assert!((m.forward(1.5) - 2.5).abs() < 1e-15);
        assert!((m.backward(2.5) - 1.5).abs() < 1e-15);
        assert_eq!(m.pieces.len(), 2);
    }
}
