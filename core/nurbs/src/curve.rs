//! B-spline curves and their rational form.

use crate::error::NurbsError;
use crate::knots::{Knots, MAX_DEGREE};
use crate::vector::{Homogeneous, VectorSpace};

/// What the methods on curves ask of a curve; B-splines, rational B-splines and offsets are such curves.
pub trait ParametricCurve<V: VectorSpace> {
    /// Parameter interval `(start, end)`.
    fn domain(&self) -> (f64, f64);

    /// Point, first and second derivative at `t`. Outside the domain the end polynomials are continued.
    fn derivatives(&self, t: f64) -> [V; 3];

    /// Point at `t`.
    fn point(&self, t: f64) -> V {
        self.derivatives(t)[0]
    }

    /// Point and first derivative at `t`.
    fn first_derivatives(&self, t: f64) -> [V; 2] {
        let [point, slope, _] = self.derivatives(t);
        [point, slope]
    }

    /// Third derivative at `t`. B-splines give it exactly; other curves a central difference of the second one, good
    /// to about 1e-8 of the size of their higher derivatives.
    fn third_derivative(&self, t: f64) -> V {
        let (start, end) = self.domain();
        let step = 1e-4 * (end - start);
        (self.derivatives(t + step)[2] - self.derivatives(t - step)[2]) * (0.5 / step)
    }

    /// Break points between which the curve is smooth, the ends of the domain included.
    fn breaks(&self) -> Vec<f64> {
        let (start, end) = self.domain();
        vec![start, end]
    }
}

impl<V: VectorSpace, C: ParametricCurve<V> + ?Sized> ParametricCurve<V> for &C {
    fn domain(&self) -> (f64, f64) {
        (**self).domain()
    }
    fn derivatives(&self, t: f64) -> [V; 3] {
        (**self).derivatives(t)
    }
    fn point(&self, t: f64) -> V {
        (**self).point(t)
    }
    fn first_derivatives(&self, t: f64) -> [V; 2] {
        (**self).first_derivatives(t)
    }
    fn third_derivative(&self, t: f64) -> V {
        (**self).third_derivative(t)
    }
    fn breaks(&self) -> Vec<f64> {
        (**self).breaks()
    }
}

/// A B-spline curve with control points in `V`; a Bezier curve is one without interior knots.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve<V> {
    pub(crate) knots: Knots,
    pub(crate) points: Vec<V>,
}

impl<V: VectorSpace> Curve<V> {
    /// A curve from knots and control points.
    ///
    /// # Errors
    /// [`NurbsError::PointCount`] when they do not match, [`NurbsError::BadPoint`] for a point that is not finite.
    pub fn new(knots: Knots, points: Vec<V>) -> Result<Self, NurbsError> {
        if points.len() != knots.control_count() {
            return Err(NurbsError::PointCount { count: points.len(), expected: knots.control_count() });
        }
        if let Some(index) = points.iter().position(|p| !p.is_finite_vector()) {
            return Err(NurbsError::BadPoint { index });
        }
        Ok(Self { knots, points })
    }

    /// The Bezier curve with these control points on [0, 1].
    ///
    /// # Errors
    /// [`NurbsError::Degree`] for fewer than 2 or more than [`crate::MAX_DEGREE`] + 1 points.
    pub fn bezier(points: Vec<V>) -> Result<Self, NurbsError> {
        let degree = points.len().saturating_sub(1);
        Self::new(Knots::clamped(degree, &[0.0, 1.0])?, points)
    }

    /// The curve with its first and last control point replaced: for clamped curves its ends, made to meet others bit
    /// for bit.
    #[must_use]
    pub fn with_ends(mut self, start: V, end: V) -> Self {
        let last = self.points.len() - 1;
        self.points[0] = start;
        self.points[last] = end;
        self
    }

    /// The straight segment from `start` to `end`, degree 1 on [0, 1].
    pub fn segment(start: V, end: V) -> Self {
        let knots = Knots::clamped(1, &[0.0, 1.0]).expect("two break points make degree 1 knots");
        Self { knots, points: vec![start, end] }
    }

    /// Knot vector and degree.
    pub fn knots(&self) -> &Knots {
        &self.knots
    }

    /// Control points.
    pub fn points(&self) -> &[V] {
        &self.points
    }

    /// Degree.
    pub fn degree(&self) -> usize {
        self.knots.degree()
    }

    /// Point and the derivatives up to `ORDER` (at most 2).
    #[inline]
    fn table<const ORDER: usize>(&self, t: f64) -> [V; 3] {
        // The usual degrees have loops of known length.
        match self.degree() {
            1 => self.table_of::<ORDER, 2>(t),
            2 => self.table_of::<ORDER, 3>(t),
            3 => self.table_of::<ORDER, 4>(t),
            5 => self.table_of::<ORDER, 6>(t),
            // Profiles of four-digit sections.
            8 => self.table_of::<ORDER, 9>(t),
            _ => self.table_of::<ORDER, { MAX_DEGREE + 1 }>(t),
        }
    }

    #[inline]
    fn table_of<const ORDER: usize, const N: usize>(&self, t: f64) -> [V; 3] {
        let span = self.knots.span(t);
        let p = if N <= MAX_DEGREE { N - 1 } else { self.degree() };
        let basis = self.knots.basis_on::<N>(span, p, t);
        let points = &self.points[span - p..=span];
        let mut out = [V::default(); 3];
        for (sum, row) in out.iter_mut().zip(&basis).take(ORDER + 1) {
            for k in 0..=p {
                *sum = *sum + points[k] * row[k];
            }
        }
        out
    }

    /// The curve with the same knots whose control points are `f` of these: exact for every affine `f`.
    pub fn map<W: VectorSpace>(&self, f: impl FnMut(&V) -> W) -> Curve<W> {
        Curve { knots: self.knots.clone(), points: self.points.iter().map(f).collect() }
    }

    /// The same points run through backwards, on the same domain.
    pub fn reversed(&self) -> Self {
        let (start, end) = self.knots.domain();
        // The ends of the domain stay what they are, whatever rounding does between.
        let mirror = |&k: &f64| {
            if k == end {
                start
            } else if k == start {
                end
            } else {
                start + (end - k)
            }
        };
        let values: Vec<f64> = self.knots.values().iter().rev().map(mirror).collect();
        let knots = Knots::new(self.degree(), values).expect("mirrored knots keep their order");
        Self { knots, points: self.points.iter().rev().copied().collect() }
    }

    /// The same points on the domain `[start, end]`, `start < end`.
    pub fn reparameterized(&self, start: f64, end: f64) -> Self {
        let (a, b) = self.knots.domain();
        let scale = (end - start) / (b - a);
        let map = |k: f64| {
            if k == a {
                start
            } else if k == b {
                end
            } else {
                start + (k - a) * scale
            }
        };
        let values = self.knots.values().iter().map(|&k| map(k)).collect();
        let knots = Knots::new(self.degree(), values).expect("an increasing map keeps the order of knots");
        Self { knots, points: self.points.clone() }
    }
}

impl<V: VectorSpace> ParametricCurve<V> for Curve<V> {
    fn domain(&self) -> (f64, f64) {
        self.knots.domain()
    }

    fn point(&self, t: f64) -> V {
        self.table::<0>(t)[0]
    }

    fn first_derivatives(&self, t: f64) -> [V; 2] {
        let [point, slope, _] = self.table::<1>(t);
        [point, slope]
    }

    fn derivatives(&self, t: f64) -> [V; 3] {
        self.table::<2>(t)
    }

    fn third_derivative(&self, t: f64) -> V {
        let (first, row) = self.knots.derivative_row(t, 3);
        let points = &self.points[first..=first + self.degree()];
        points.iter().zip(&row).fold(V::default(), |sum, (&c, &n)| sum + c * n)
    }

    fn breaks(&self) -> Vec<f64> {
        self.knots.breaks()
    }
}

/// A rational B-spline (NURBS) curve: a B-spline in homogeneous coordinates, projected.
#[derive(Clone, Debug, PartialEq)]
pub struct RationalCurve<V> {
    pub(crate) homogeneous: Curve<Homogeneous<V>>,
}

impl<V: VectorSpace> RationalCurve<V> {
    /// A curve from knots, control points and their weights.
    ///
    /// # Errors
    /// As [`Curve::new`]; [`NurbsError::BadPoint`] also for a weight that is not positive.
    pub fn new(knots: Knots, points: &[V], weights: &[f64]) -> Result<Self, NurbsError> {
        if weights.len() != points.len() {
            return Err(NurbsError::PointCount { count: weights.len(), expected: points.len() });
        }
        let embedded = points.iter().zip(weights).map(|(&p, &w)| Homogeneous::new(p, w)).collect();
        Self::from_homogeneous(Curve::new(knots, embedded)?)
    }

    /// A curve from its homogeneous form.
    ///
    /// # Errors
    /// [`NurbsError::BadPoint`] for a weight that is not positive.
    pub fn from_homogeneous(homogeneous: Curve<Homogeneous<V>>) -> Result<Self, NurbsError> {
        match homogeneous.points.iter().position(|p| !(p.weight > 0.0)) {
            Some(index) => Err(NurbsError::BadPoint { index }),
            None => Ok(Self { homogeneous }),
        }
    }

    /// The homogeneous B-spline behind the curve.
    pub fn homogeneous(&self) -> &Curve<Homogeneous<V>> {
        &self.homogeneous
    }
}

/// Quotient rule for a point and two derivatives in homogeneous coordinates (*The NURBS Book*, equation 4.8).
pub(crate) fn project_derivatives<V: VectorSpace>(h: [Homogeneous<V>; 3]) -> [V; 3] {
    let inverse = 1.0 / h[0].weight;
    let point = h[0].weighted * inverse;
    let first = (h[1].weighted - point * h[1].weight) * inverse;
    let second = (h[2].weighted - first * (2.0 * h[1].weight) - point * h[2].weight) * inverse;
    [point, first, second]
}

impl<V: VectorSpace> ParametricCurve<V> for RationalCurve<V> {
    fn domain(&self) -> (f64, f64) {
        self.homogeneous.domain()
    }

    fn point(&self, t: f64) -> V {
        self.homogeneous.point(t).project()
    }

    fn derivatives(&self, t: f64) -> [V; 3] {
        project_derivatives(self.homogeneous.derivatives(t))
    }

    fn third_derivative(&self, t: f64) -> V {
        let h = self.homogeneous.derivatives(t);
        let third = self.homogeneous.third_derivative(t);
        let [point, first, second] = project_derivatives(h);
        let rest = second * (3.0 * h[1].weight) + first * (3.0 * h[2].weight) + point * third.weight;
        (third.weighted - rest) * (1.0 / h[0].weight)
    }

    fn breaks(&self) -> Vec<f64> {
        self.homogeneous.breaks()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn a_rational_quadratic_is_a_circle() {
        let points = [DVec2::new(1.0, 0.0), DVec2::new(1.0, 1.0), DVec2::new(0.0, 1.0)];
        let knots = Knots::clamped(2, &[0.0, 1.0]).unwrap();
        let arc = RationalCurve::new(knots, &points, &[1.0, 0.5f64.sqrt(), 1.0]).unwrap();
        for i in 0..=20 {
            let [p, d, dd] = arc.derivatives(f64::from(i) / 20.0);
            assert!((p.length() - 1.0).abs() < 1e-15);
            assert!(p.dot(d).abs() < 1e-14);
            let h = 1e-5;
            let t = f64::from(i) / 20.0;
            let difference = (arc.derivatives(t + h)[2] - arc.derivatives(t - h)[2]) / (2.0 * h);
            assert!(arc.third_derivative(t).distance(difference) < 1e-7);
            // Curvature 1.
            assert!((d.perp_dot(dd) / d.length().powi(3) - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn second_derivative_of_a_cubic_is_exact() {
        // x = t^3 on [0, 1] in Bezier form.
        let c = Curve::bezier(vec![0.0, 0.0, 0.0, 1.0]).unwrap();
        for i in 0..=10 {
            let t = f64::from(i) / 10.0;
            let [x, d, dd] = c.derivatives(t);
            assert!((x - t.powi(3)).abs() < 1e-15);
            assert!((d - 3.0 * t * t).abs() < 1e-14);
            assert!((dd - 6.0 * t).abs() < 1e-14);
            assert!((c.third_derivative(t) - 6.0).abs() < 1e-13);
        }
    }
}
