//! Least-squares fits of B-splines, with weights, linear constraints and a smoothing term.

use super::constraint::Constraint;
use crate::curve::Curve;
use crate::error::NurbsError;
use crate::knots::Knots;
use crate::surface::Surface;
use crate::vector::VectorSpace;

/// The penalty `factor * integral |C^(order)|^2 dt` added to the sum of squared distances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smoothing {
    /// Order of the derivative penalised, 1 to the degree; 2 for cubics and 3 for quintics give natural smoothing
    /// splines.
    pub order: usize,
    /// Weight of the penalty.
    pub factor: f64,
}

/// A fitted curve with what it leaves at the data.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit<V> {
    /// The curve.
    pub curve: Curve<V>,
    /// Root mean square of the distances between data and the curve at the same parameter.
    pub rms: f64,
    /// Greatest of these distances.
    pub greatest: f64,
}

/// What a constraint of a surface fit equals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConstraintValue {
    /// Zero.
    Zero,
    /// The data at this index of the parameters, for fits that pass through some of their points.
    Data(usize),
}

/// Rounds of correction at most, and the relative correction at which they end.
const ROUNDS: usize = 12;
const SETTLED: f64 = 1e-15;

/// A factored least-squares problem: knots, parameters, weights, constraints and smoothing, ready for any number of
/// right-hand sides.
///
/// Minimises the weighted sum of squared distances at the parameters plus the smoothing penalty under the
/// constraints. The triangular factor comes from Givens rotations on the banded rows (Lawson and Hanson 1974, chapter
/// 27); solutions are corrected with their residuals (Bjoerck 1987), so that their accuracy is that of an orthogonal
/// method, and constraints hold to rounding.
#[derive(Clone, Debug)]
pub struct LeastSquares {
    knots: Knots,
    /// Rows of the problem: first column, factors times the root of the weight; data rows first.
    rows: Vec<(usize, Vec<f64>)>,
    root_weights: Vec<f64>,
    /// Constraints, scaled to greatest factors of 1, and what they were scaled by.
    constraints: Vec<Constraint>,
    scales: Vec<f64>,
    /// Constraint rows that fit the band are also rows of the problem: they determine what data may not.
    banded: Vec<bool>,
    /// Upper triangular factor: row i holds columns `i..=i + degree`.
    factor: Vec<f64>,
    /// Orthonormal basis of the constraints' columns `R^-T A^T`, one constraint after the other, and its triangle.
    basis: Vec<f64>,
    triangle: Vec<f64>,
}

impl LeastSquares {
    /// Factors the problem. `weights` are those of squared distances, one a parameter, or none for equal ones.
    /// Parameters must lie in the domain, in any order.
    ///
    /// # Errors
    /// [`NurbsError::PointCount`] for a wrong number of weights, [`NurbsError::OutOfDomain`] for a parameter,
    /// [`NurbsError::BadArgument`] for a weight or smoothing that is negative or not finite, or a constraint that
    /// depends on the others, [`NurbsError::BadParameters`] with the index of the first control point that data,
    /// smoothing and constraints leave free.
    pub fn new(
        knots: Knots,
        parameters: &[f64],
        weights: Option<&[f64]>,
        constraints: &[Constraint],
        smoothing: Option<Smoothing>,
    ) -> Result<Self, NurbsError> {
        let (start, end) = knots.domain();
        if let Some(w) = weights.filter(|w| w.len() != parameters.len()) {
            return Err(NurbsError::PointCount { count: w.len(), expected: parameters.len() });
        }
        let root = |w: f64| match w {
            w if w >= 0.0 && w.is_finite() => Ok(w.sqrt()),
            value => Err(NurbsError::BadArgument { what: "weight of a fit", value }),
        };
        let mut rows = Vec::with_capacity(parameters.len());
        let mut root_weights = Vec::with_capacity(parameters.len());
        for (i, &t) in parameters.iter().enumerate() {
            if !(t >= start && t <= end) {
                return Err(NurbsError::OutOfDomain { value: t, start, end });
            }
            let weight = root(weights.map_or(1.0, |w| w[i]))?;
            rows.push(scaled_row(&knots, t, 0, weight));
            root_weights.push(weight);
        }
        if let Some(s) = smoothing {
            if s.order == 0 || s.order > knots.degree() {
                return Err(NurbsError::Degree { degree: s.order, greatest: knots.degree() });
            }
            let factor = root(s.factor)?;
            rows.extend(penalty_rows(&knots, s.order, factor));
        }
        let count = knots.control_count();
        if let Some(k) =
            constraints.iter().position(|c| c.terms.iter().all(|t| t.1 == 0.0) || c.span().1 >= count)
        {
            return Err(NurbsError::BadArgument {
                what: "constraint without control point",
                value: k as f64,
            });
        }
        let size = |c: &Constraint| c.terms.iter().fold(0.0, |m: f64, t| m.max(t.1.abs()));
        let scales: Vec<f64> = constraints.iter().map(|c| 1.0 / size(c)).collect();
        let scaled =
            |(c, s): (&Constraint, &f64)| Constraint::new(c.terms.iter().map(|&(i, f)| (i, f * s)).collect());
        let banded = constraints.iter().map(|c| c.span().1 - c.span().0 <= knots.degree()).collect();
        let mut fit = Self {
            knots,
            rows,
            root_weights,
            constraints: constraints.iter().zip(&scales).map(scaled).collect(),
            scales,
            banded,
            factor: Vec::new(),
            basis: Vec::new(),
            triangle: Vec::new(),
        };
        fit.triangulate()?;
        fit.factor_constraints()?;
        Ok(fit)
    }

    fn triangulate(&mut self) -> Result<(), NurbsError> {
        let (n, width) = (self.knots.control_count(), self.knots.degree() + 1);
        self.factor = vec![0.0; n * width];
        let rows = self.rows.iter().cloned();
        let constraints = self.constraints.iter().zip(&self.banded).filter(|(_, b)| **b).map(|(c, _)| {
            let first = c.span().0.min(n - width);
            let mut row = vec![0.0; width];
            c.terms.iter().for_each(|&(i, f)| row[i - first] += f);
            (first, row)
        });
        // In the order of their first columns, so that rotations do not fill columns beyond a row's last.
        let mut ordered: Vec<(usize, Vec<f64>)> = rows.chain(constraints).collect();
        ordered.sort_by_key(|r| r.0);
        for (first, mut row) in ordered {
            for i in first..first + width {
                let lead = row[i - first];
                if lead != 0.0 {
                    let r = &mut self.factor[i * width..(i + 1) * width];
                    let length = r[0].hypot(lead);
                    let (cos, sin) = (r[0] / length, lead / length);
                    for k in i..first + width {
                        let (a, b) = (r[k - i], row[k - first]);
                        r[k - i] = cos * a + sin * b;
                        row[k - first] = cos * b - sin * a;
                    }
                }
            }
        }
        let largest = (0..n).fold(0.0, |m: f64, i| m.max(self.factor[i * width].abs()));
        match (0..n).find(|&i| !(self.factor[i * width].abs() > 1e-11 * largest)) {
            Some(index) => Err(NurbsError::BadParameters { index }),
            None => Ok(()),
        }
    }

    /// Modified Gram-Schmidt, twice, on the columns `R^-T a` of the constraints.
    fn factor_constraints(&mut self) -> Result<(), NurbsError> {
        let (n, m) = (self.knots.control_count(), self.constraints.len());
        self.triangle = vec![0.0; m * m];
        for k in 0..m {
            let mut column = vec![0.0; n];
            self.constraints[k].terms.iter().for_each(|&(i, f)| column[i] += f);
            self.solve_transposed(&mut column);
            let before = column.norm_of();
            for _ in 0..2 {
                for j in 0..k {
                    let q = &self.basis[j * n..(j + 1) * n];
                    let along: f64 = q.iter().zip(&column).map(|(a, b)| a * b).sum();
                    column.iter_mut().zip(q).for_each(|(c, q)| *c -= along * q);
                    self.triangle[j * m + k] += along;
                }
            }
            let length = column.norm_of();
            if !(length > 1e-10 * before) {
                let what = "index of a constraint that depends on those before it";
                return Err(NurbsError::BadArgument { what, value: k as f64 });
            }
            self.triangle[k * m + k] = length;
            self.basis.extend(column.iter().map(|c| c / length));
        }
        Ok(())
    }

    /// Knots of the result.
    pub fn knots(&self) -> &Knots {
        &self.knots
    }

    /// Number of data parameters.
    pub fn data_count(&self) -> usize {
        self.root_weights.len()
    }

    /// The best curve for `points` (one a parameter) whose constraints equal `values` (one a constraint).
    ///
    /// # Errors
    /// [`NurbsError::PointCount`] for a wrong number of either, [`NurbsError::BadPoint`] for one that is not finite,
    /// [`NurbsError::NoConvergence`] for a problem too ill-conditioned to be solved to nine digits.
    pub fn curve<V: VectorSpace>(&self, points: &[V], values: &[V]) -> Result<Fit<V>, NurbsError> {
        let curve = Curve::new(self.knots.clone(), self.solve(points, values)?)?;
        let (mut sum, mut greatest) = (0.0, 0.0f64);
        for (point, (row, weight)) in points.iter().zip(self.rows.iter().zip(&self.root_weights)) {
            let at = if *weight > 0.0 { dot(row, &curve.points) * (1.0 / weight) } else { *point };
            let distance = at.distance_to(point);
            sum += distance * distance;
            greatest = greatest.max(distance);
        }
        Ok(Fit { curve, rms: (sum / points.len().max(1) as f64).sqrt(), greatest })
    }

    /// The best tensor-product surface for a grid of points, `self` along u and `along_v` along v; point `(i, j)` at
    /// `i * along_v.data_count() + j`. Every constraint equals zero or the data it names, in both directions.
    ///
    /// # Errors
    /// As [`LeastSquares::curve`].
    pub fn surface<V: VectorSpace>(
        &self,
        along_v: &Self,
        points: &[V],
        values_u: &[ConstraintValue],
        values_v: &[ConstraintValue],
    ) -> Result<Surface<V>, NurbsError> {
        let (mu, mv) = (self.data_count(), along_v.data_count());
        if points.len() != mu * mv {
            return Err(NurbsError::PointCount { count: points.len(), expected: mu * mv });
        }
        let (nu, nv) = (self.knots.control_count(), along_v.knots.control_count());
        let mut rows = Vec::with_capacity(mu * nv);
        for row in points.chunks_exact(mv) {
            rows.extend(along_v.solve(row, &right_side(row, values_v)?)?);
        }
        let mut net = vec![V::default(); nu * nv];
        for j in 0..nv {
            let column: Vec<V> = (0..mu).map(|i| rows[i * nv + j]).collect();
            for (i, p) in self.solve(&column, &right_side(&column, values_u)?)?.into_iter().enumerate() {
                net[i * nv + j] = p;
            }
        }
        Surface::new(self.knots.clone(), along_v.knots.clone(), net)
    }

    fn solve<V: VectorSpace>(&self, points: &[V], values: &[V]) -> Result<Vec<V>, NurbsError> {
        for (given, expected) in [(points, self.data_count()), (values, self.constraints.len())] {
            if given.len() != expected {
                return Err(NurbsError::PointCount { count: given.len(), expected });
            }
            if let Some(index) = given.iter().position(|p| !p.is_finite_vector()) {
                return Err(NurbsError::BadPoint { index });
            }
        }
        let n = self.knots.control_count();
        let mut x = vec![V::default(); n];
        // The first round solves, the others correct, each by a factor of the squared condition times rounding.
        for round in 0..ROUNDS {
            let mut gradient = vec![V::default(); n];
            for (i, (first, row)) in self.rows.iter().enumerate() {
                let model = dot(&(*first, row), &x);
                let left =
                    if i < points.len() { points[i] * self.root_weights[i] - model } else { model * -1.0 };
                for (k, &f) in row.iter().enumerate() {
                    gradient[first + k] = gradient[first + k] + left * f;
                }
            }
            let mut left = Vec::with_capacity(values.len());
            for (k, c) in self.constraints.iter().enumerate() {
                let value = values[k] * self.scales[k];
                let rest = c.terms.iter().fold(value, |sum, &(i, f)| sum - x[i] * f);
                if self.banded[k] {
                    c.terms.iter().for_each(|&(i, f)| gradient[i] = gradient[i] + rest * f);
                }
                left.push(rest);
            }
            let step = self.constrained_step(gradient, left);
            x.iter_mut().zip(&step).for_each(|(x, &d)| *x = *x + d);
            let size = |v: &[V]| v.iter().map(|p| p.inner(p)).sum::<f64>().sqrt();
            let residual = size(&step) / size(&x).max(f64::MIN_POSITIVE);
            if residual <= SETTLED && round > 0 {
                break;
            }
            if round + 1 == ROUNDS && !(residual <= 1e-9) {
                return Err(NurbsError::NoConvergence {
                    what: "ill-conditioned least-squares fit",
                    residual,
                });
            }
        }
        Ok(x)
    }

    /// `R^-1 (p + Q T^-T (b - Q^T-part))`: the step for a gradient, under constraints that still miss `left`.
    fn constrained_step<V: VectorSpace>(&self, mut gradient: Vec<V>, left: Vec<V>) -> Vec<V> {
        let (n, m) = (gradient.len(), left.len());
        self.solve_transposed(&mut gradient);
        // In the variables y = R x the constraints are T^T (Q^T y) = left.
        let mut inner = left;
        for k in 0..m {
            for j in 0..k {
                inner[k] = inner[k] - inner[j] * self.triangle[j * m + k];
            }
            inner[k] = inner[k] * (1.0 / self.triangle[k * m + k]);
        }
        for (k, wanted) in inner.iter().enumerate() {
            let q = &self.basis[k * n..(k + 1) * n];
            let now = q.iter().zip(&gradient).fold(V::default(), |sum, (&q, &g)| sum + g * q);
            let change = *wanted - now;
            gradient.iter_mut().zip(q).for_each(|(g, &q)| *g = *g + change * q);
        }
        let width = self.knots.degree() + 1;
        for i in (0..n).rev() {
            let r = &self.factor[i * width..(i + 1) * width];
            let mut value = gradient[i];
            for k in 1..width.min(n - i) {
                value = value - gradient[i + k] * r[k];
            }
            gradient[i] = value * (1.0 / r[0]);
        }
        gradient
    }

    /// Solves `R^T y = right` in place.
    fn solve_transposed<V: VectorSpace>(&self, right: &mut [V]) {
        let width = self.knots.degree() + 1;
        for i in 0..right.len() {
            let mut value = right[i];
            for k in 1..width.min(i + 1) {
                value = value - right[i - k] * self.factor[(i - k) * width + k];
            }
            right[i] = value * (1.0 / self.factor[i * width]);
        }
    }
}

trait Norm {
    fn norm_of(&self) -> f64;
}

impl Norm for Vec<f64> {
    fn norm_of(&self) -> f64 {
        self.iter().map(|c| c * c).sum::<f64>().sqrt()
    }
}

fn dot<V: VectorSpace>((first, row): &(usize, impl AsRef<[f64]>), x: &[V]) -> V {
    let row = row.as_ref();
    row.iter().zip(&x[*first..]).fold(V::default(), |sum, (&f, &x)| sum + x * f)
}

fn right_side<V: VectorSpace>(data: &[V], values: &[ConstraintValue]) -> Result<Vec<V>, NurbsError> {
    let value = |v: &ConstraintValue| match *v {
        ConstraintValue::Zero => Ok(V::default()),
        ConstraintValue::Data(i) => {
            data.get(i).copied().ok_or(NurbsError::PointCount { count: data.len(), expected: i + 1 })
        }
    };
    values.iter().map(value).collect()
}

fn scaled_row(knots: &Knots, t: f64, order: usize, factor: f64) -> (usize, Vec<f64>) {
    let (first, row) = knots.derivative_row(t, order);
    (first, row[..=knots.degree()].iter().map(|f| f * factor).collect())
}

/// Rows whose sum of squares is `factor^2 * integral |C^(order)|^2`, exact: Gauss points on every span.
fn penalty_rows(knots: &Knots, order: usize, factor: f64) -> Vec<(usize, Vec<f64>)> {
    let rule = crate::quadrature::gauss(knots.degree() - order + 1);
    let breaks = knots.breaks();
    let mut rows = Vec::with_capacity(rule.len() * breaks.len());
    for span in breaks.windows(2) {
        let half = 0.5 * (span[1] - span[0]);
        for &(x, w) in &rule {
            let t = 0.5 * (span[0] + span[1]) + half * x;
            rows.push(scaled_row(knots, t, order, factor * (w * half).sqrt()));
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::ParametricCurve;

    #[test]
    fn the_penalty_is_the_integral() {
        // x = t^3 on [0, 2]: integral of (6 t)^2 = 96.
        let knots = Knots::clamped(3, &[0.0, 0.5, 2.0]).unwrap();
        let t: Vec<f64> = (0..=20).map(|i| f64::from(i) / 10.0).collect();
        let data: Vec<f64> = t.iter().map(|t| t * t * t).collect();
        let fit = LeastSquares::new(knots.clone(), &t, None, &[], None).unwrap().curve(&data, &[]).unwrap();
        let rows = penalty_rows(&knots, 2, 0.5);
        let sum: f64 = rows.iter().map(|r| dot(r, &fit.curve.points).powi(2)).sum();
        assert!((sum - 24.0).abs() < 1e-11, "{sum}");
        assert!((fit.curve.point(1.3) - 1.3f64.powi(3)).abs() < 1e-13);
    }
}
