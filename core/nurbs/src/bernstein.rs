//! Polynomials over the unit square in Bernstein form: bounds, halves and derivatives of what is sought for roots
//! or minima. A polynomial in one variable has one coefficient in v.

use crate::vector::{Homogeneous, VectorSpace};

/// Coefficients of a tensor-product Bernstein polynomial, v running fastest.
#[derive(Clone, Debug)]
pub(crate) struct Net {
    pub(crate) nu: usize,
    pub(crate) nv: usize,
    pub(crate) c: Vec<f64>,
}

impl Net {
    /// Least and greatest coefficient: the polynomial lies between (convex hull property).
    pub(crate) fn range(&self) -> (f64, f64) {
        self.c.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &c| (low.min(c), high.max(c)))
    }

    /// The place of the least coefficient, each at its Greville point.
    pub(crate) fn least_node(&self) -> [f64; 2] {
        let mut least = 0;
        for (k, c) in self.c.iter().enumerate() {
            if *c < self.c[least] {
                least = k;
            }
        }
        let place = |i: usize, n: usize| if n > 1 { i as f64 / (n - 1) as f64 } else { 0.5 };
        [place(least / self.nv, self.nu), place(least % self.nv, self.nv)]
    }

    /// `self + factor * other`, of equal degrees.
    pub(crate) fn plus(&self, factor: f64, other: &Self) -> Self {
        let c = self.c.iter().zip(&other.c).map(|(a, b)| a + factor * b).collect();
        Self { nu: self.nu, nv: self.nv, c }
    }

    /// The halves `u <= 1/2` and `u >= 1/2`, each on the unit square again (de Casteljau).
    pub(crate) fn halves_u(&self) -> (Self, Self) {
        let (nu, nv) = (self.nu, self.nv);
        let (mut low, mut high) = (self.clone(), self.clone());
        for r in 1..nu {
            for i in 0..nu - r {
                for j in 0..nv {
                    high.c[i * nv + j] = 0.5 * (high.c[i * nv + j] + high.c[(i + 1) * nv + j]);
                }
            }
            low.c[r * nv..(r + 1) * nv].copy_from_slice(&high.c[..nv]);
        }
        (low, high)
    }

    /// The halves `v <= 1/2` and `v >= 1/2`.
    pub(crate) fn halves_v(&self) -> (Self, Self) {
        let nv = self.nv;
        let (mut low, mut high) = (self.clone(), self.clone());
        for (low, high) in low.c.chunks_exact_mut(nv).zip(high.c.chunks_exact_mut(nv)) {
            for r in 1..nv {
                for j in 0..nv - r {
                    high[j] = 0.5 * (high[j] + high[j + 1]);
                }
                low[r] = high[0];
            }
        }
        (low, high)
    }

    /// The derivative in u, zero for a constant.
    pub(crate) fn derivative_u(&self) -> Self {
        let (nu, nv) = (self.nu, self.nv);
        if nu == 1 {
            return Self { nu, nv, c: vec![0.0; nv] };
        }
        let scale = (nu - 1) as f64;
        let c = (0..(nu - 1) * nv).map(|k| scale * (self.c[k + nv] - self.c[k])).collect();
        Self { nu: nu - 1, nv, c }
    }

    /// The derivative in v, zero for a constant.
    pub(crate) fn derivative_v(&self) -> Self {
        let (nu, nv) = (self.nu, self.nv);
        if nv == 1 {
            return Self { nu, nv, c: vec![0.0; nu] };
        }
        let scale = (nv - 1) as f64;
        let rows = self.c.chunks_exact(nv);
        let c = rows.flat_map(|row| row.windows(2).map(|w| scale * (w[1] - w[0]))).collect();
        Self { nu, nv: nv - 1, c }
    }

    /// The value at a point of the unit square.
    pub(crate) fn value(&self, u: f64, v: f64) -> f64 {
        let along_v = |row: &[f64]| casteljau(row, v);
        let column: Vec<f64> = self.c.chunks_exact(self.nv).map(along_v).collect();
        casteljau(&column, u)
    }

    /// The derivatives to second order, if bounds on them prove that the polynomial is convex on the square.
    pub(crate) fn convex(&self) -> Option<Derivatives> {
        let (u, v) = (self.derivative_u(), self.derivative_v());
        let uu = u.derivative_u();
        let least_uu = uu.range().0;
        if least_uu < 0.0 {
            return None;
        }
        let (uv, vv) = (u.derivative_v(), v.derivative_v());
        let least_vv = vv.range().0;
        let (low, high) = uv.range();
        let convex = least_vv >= 0.0 && least_uu * least_vv >= low.abs().max(high.abs()).powi(2);
        convex.then_some(Derivatives { u, v, uu, uv, vv })
    }

    /// A lower bound of a convex polynomial on the square, and the point whose tangent plane gives it: next to the
    /// minimum, where the bound is sharp to second order.
    pub(crate) fn convex_bound(&self, d: &Derivatives) -> (f64, [f64; 2]) {
        let mut x = [0.5, 0.5];
        for _ in 0..12 {
            let g = [d.u.value(x[0], x[1]), d.v.value(x[0], x[1])];
            let h = [d.uu.value(x[0], x[1]), d.uv.value(x[0], x[1]), d.vv.value(x[0], x[1])];
            let floor = 1e-12 * (h[0] + h[2]) + f64::MIN_POSITIVE;
            let h = [h[0] + floor, h[1], h[2] + floor];
            let step = quadratic_minimum(h, g, [-x[0], -x[1]], [1.0 - x[0], 1.0 - x[1]]);
            x = [(x[0] + step[0]).clamp(0.0, 1.0), (x[1] + step[1]).clamp(0.0, 1.0)];
            if step[0].abs().max(step[1].abs()) < 1e-9 {
                break;
            }
        }
        let lowest = |g: f64, x: f64| if g > 0.0 { -g * x } else { g * (1.0 - x) };
        let slack = lowest(d.u.value(x[0], x[1]), x[0]) + lowest(d.v.value(x[0], x[1]), x[1]);
        (self.value(x[0], x[1]) + slack, x)
    }

    /// Greatest second differences in u and v: how far the coefficients may be from the values.
    pub(crate) fn bend(&self) -> [f64; 2] {
        let (nu, nv) = (self.nu, self.nv);
        let c = &self.c;
        let mut bend = [0.0f64; 2];
        for k in 0..nu * nv {
            if k / nv + 2 < nu {
                bend[0] = bend[0].max((c[k] - 2.0 * c[k + nv] + c[k + 2 * nv]).abs());
            }
            if k % nv + 2 < nv {
                bend[1] = bend[1].max((c[k] - 2.0 * c[k + 1] + c[k + 2]).abs());
            }
        }
        bend
    }
}

/// First and second derivatives of a [`Net`].
pub(crate) struct Derivatives {
    u: Net,
    v: Net,
    uu: Net,
    uv: Net,
    vv: Net,
}

/// Minimum of `g x + x H x / 2` over a rectangle, `H = [h0 h1; h1 h2]` positive definite.
#[inline]
pub(crate) fn quadratic_minimum(h: [f64; 3], g: [f64; 2], low: [f64; 2], high: [f64; 2]) -> [f64; 2] {
    let determinant = h[0] * h[2] - h[1] * h[1];
    if determinant > 0.0 {
        let inverse = 1.0 / determinant;
        let x = [(h[1] * g[1] - h[2] * g[0]) * inverse, (h[1] * g[0] - h[0] * g[1]) * inverse];
        if x[0] >= low[0] && x[0] <= high[0] && x[1] >= low[1] && x[1] <= high[1] {
            return x;
        }
    }
    // On the border: with `x[fixed]` at a bound, the other is the clamped minimum of a parabola.
    let along = |fixed: usize, at: f64| {
        let free = 1 - fixed;
        let slope = g[free] + h[1] * at;
        let curvature = h[2 * free];
        let mut x = [0.0; 2];
        x[fixed] = at;
        x[free] = (-slope / curvature).clamp(low[free], high[free]);
        let value = g[0] * x[0] + g[1] * x[1];
        (value + 0.5 * (h[0] * x[0] * x[0] + h[2] * x[1] * x[1]) + h[1] * x[0] * x[1], x)
    };
    let candidates = [along(0, low[0]), along(0, high[0]), along(1, low[1]), along(1, high[1])];
    candidates.iter().fold(candidates[0], |best, c| if c.0 < best.0 { *c } else { best }).1
}

/// Value of a Bernstein polynomial of one variable, by Horner's scheme on the scaled form.
fn casteljau(c: &[f64], t: f64) -> f64 {
    let n = c.len() - 1;
    let (mut power, mut binomial, s) = (1.0, 1.0, 1.0 - t);
    let mut sum = c[0];
    for i in 1..=n {
        power *= t;
        binomial *= (n + 1 - i) as f64 / i as f64;
        sum = sum * s + power * binomial * c[i];
    }
    sum
}

/// Binomial coefficients `n` over `0..=n`.
pub(crate) fn binomials(n: usize) -> Vec<f64> {
    let mut row = vec![1.0];
    for i in 1..=n {
        row.push(row[i - 1] * (n + 1 - i) as f64 / i as f64);
    }
    row
}

/// The squared length of a homogeneous net's `weighted - weight * point`, and the squared weight: numerator and
/// denominator of the squared distance to `point`.
pub(crate) fn squared_distance<V: VectorSpace>(
    net: &[Homogeneous<V>],
    (nu, nv): (usize, usize),
    point: V,
) -> (Net, Net) {
    let (bu, bv) = (binomials(nu - 1), binomials(nv - 1));
    let (cu, cv) = (binomials(2 * nu - 2), binomials(2 * nv - 2));
    let (mu, mv) = (2 * nu - 1, 2 * nv - 1);
    let scaled: Vec<(V, f64)> = (0..nu * nv)
        .map(|k| {
            let b = bu[k / nv] * bv[k % nv];
            ((net[k].weighted - point * net[k].weight) * b, net[k].weight * b)
        })
        .collect();
    let mut square = vec![0.0; mu * mv];
    let mut weight = vec![0.0; mu * mv];
    for (a, &(x, w)) in scaled.iter().enumerate() {
        // Each pair of different points counts twice.
        for (b, &(y, z)) in scaled.iter().enumerate().skip(a) {
            let twice = if a == b { 1.0 } else { 2.0 };
            let k = (a / nv + b / nv) * mv + a % nv + b % nv;
            square[k] += twice * x.inner(&y);
            weight[k] += twice * w * z;
        }
    }
    for k in 0..mu * mv {
        let inverse = 1.0 / (cu[k / mv] * cv[k % mv]);
        square[k] *= inverse;
        weight[k] *= inverse;
    }
    (Net { nu: mu, nv: mv, c: square }, Net { nu: mu, nv: mv, c: weight })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Net {
        let c = (0..12).map(|k| f64::from(k * 7 % 5) - 1.5 + 0.1 * f64::from(k)).collect();
        Net { nu: 4, nv: 3, c }
    }

    #[test]
    fn halves_and_derivatives_agree_with_values() {
        let n = sample();
        let (low, high) = n.halves_u();
        let (left, right) = n.halves_v();
        let (du, dv) = (n.derivative_u(), n.derivative_v());
        for i in 0..=10 {
            for j in 0..=10 {
                let (u, v) = (f64::from(i) / 10.0, f64::from(j) / 10.0);
                assert!((low.value(u, v) - n.value(0.5 * u, v)).abs() < 1e-14);
                assert!((high.value(u, v) - n.value(0.5 + 0.5 * u, v)).abs() < 1e-14);
                assert!((left.value(u, v) - n.value(u, 0.5 * v)).abs() < 1e-14);
                assert!((right.value(u, v) - n.value(u, 0.5 + 0.5 * v)).abs() < 1e-14);
                let h = 1e-6;
                assert!((du.value(u, v) - (n.value(u + h, v) - n.value(u - h, v)) / (2.0 * h)).abs() < 1e-8);
                assert!((dv.value(u, v) - (n.value(u, v + h) - n.value(u, v - h)) / (2.0 * h)).abs() < 1e-8);
                let (least, greatest) = n.range();
                assert!(n.value(u, v) >= least && n.value(u, v) <= greatest);
            }
        }
    }

    #[test]
    fn convexity_is_certified_only_where_it_holds() {
        let bowl = Net { nu: 3, nv: 3, c: vec![2., 1., 2., 1., 0., 1., 2., 1., 2.] };
        let (bound, at) = bowl.convex_bound(&bowl.convex().unwrap());
        let exact = bowl.value(0.5, 0.5);
        assert!(bound <= exact && bound > exact - 1e-12 && at == [0.5, 0.5]);
        let saddle = Net { nu: 3, nv: 3, c: vec![0., 1., 0., -1., 0., -1., 0., 1., 0.] };
        assert!(saddle.convex().is_none());
        assert!(Net { nu: 3, nv: 1, c: vec![1., 0., 1.] }.convex().is_some());
        assert!(Net { nu: 3, nv: 1, c: vec![1., 2., 1.] }.convex().is_none());
    }
}
