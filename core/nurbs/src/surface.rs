//! Tensor-product B-spline surfaces and their rational form.

use crate::curve::{Curve, project_derivatives};
use crate::error::NurbsError;
use crate::knots::{Basis, Knots, MAX_DEGREE};
use crate::vector::{Homogeneous, VectorSpace};
use glam::DVec3;

/// A surface point with its derivatives to second order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceDerivatives<V> {
    /// The point.
    pub point: V,
    /// First derivative in u.
    pub u: V,
    /// First derivative in v.
    pub v: V,
    /// Second derivative in u.
    pub uu: V,
    /// Mixed derivative.
    pub uv: V,
    /// Second derivative in v.
    pub vv: V,
}

impl SurfaceDerivatives<DVec3> {
    /// Unit normal along `u x v`; not finite where the two are parallel.
    pub fn normal(&self) -> DVec3 {
        self.u.cross(self.v).normalize()
    }

    /// Principal curvatures, the greater first, positive where the centre of curvature lies on the side that the normal
    /// along `u x v` points to; not finite where the two derivatives are parallel.
    pub fn principal_curvatures(&self) -> [f64; 2] {
        let normal = self.normal();
        let (e, f, g) = (self.u.dot(self.u), self.u.dot(self.v), self.v.dot(self.v));
        let (l, m, n) = (self.uu.dot(normal), self.uv.dot(normal), self.vv.dot(normal));
        let determinant = e * g - f * f;
        let mean = (e * n - 2.0 * f * m + g * l) / (2.0 * determinant);
        let gauss = (l * n - m * m) / determinant;
        let half = (mean * mean - gauss).max(0.0).sqrt();
        [mean + half, mean - half]
    }
}

/// What the methods on surfaces ask of a surface.
pub trait ParametricSurface<V: VectorSpace> {
    /// Parameter rectangle `((u_start, u_end), (v_start, v_end))`.
    fn domain(&self) -> ((f64, f64), (f64, f64));

    /// Point and derivatives to second order. Outside the domain the end polynomials are continued.
    fn derivatives(&self, u: f64, v: f64) -> SurfaceDerivatives<V>;

    /// Point at `(u, v)`.
    fn point(&self, u: f64, v: f64) -> V {
        self.derivatives(u, v).point
    }

    /// Point and first derivatives in u and v.
    fn first_derivatives(&self, u: f64, v: f64) -> (V, V, V) {
        let d = self.derivatives(u, v);
        (d.point, d.u, d.v)
    }

    /// Break points in u between which the surface is smooth, the ends included.
    fn breaks_u(&self) -> Vec<f64>;

    /// Break points in v between which the surface is smooth, the ends included.
    fn breaks_v(&self) -> Vec<f64>;
}

impl<V: VectorSpace, S: ParametricSurface<V> + ?Sized> ParametricSurface<V> for &S {
    fn domain(&self) -> ((f64, f64), (f64, f64)) {
        (**self).domain()
    }
    fn derivatives(&self, u: f64, v: f64) -> SurfaceDerivatives<V> {
        (**self).derivatives(u, v)
    }
    fn point(&self, u: f64, v: f64) -> V {
        (**self).point(u, v)
    }
    fn first_derivatives(&self, u: f64, v: f64) -> (V, V, V) {
        (**self).first_derivatives(u, v)
    }
    fn breaks_u(&self) -> Vec<f64> {
        (**self).breaks_u()
    }
    fn breaks_v(&self) -> Vec<f64> {
        (**self).breaks_v()
    }
}

/// A tensor-product B-spline surface; control point `(i, j)` stands at `i * count_v + j`.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface<V> {
    pub(crate) knots_u: Knots,
    pub(crate) knots_v: Knots,
    pub(crate) points: Vec<V>,
}

impl<V: VectorSpace> Surface<V> {
    /// A surface from two knot vectors and the control net, v running fastest.
    ///
    /// # Errors
    /// [`NurbsError::PointCount`] when they do not match, [`NurbsError::BadPoint`] for a point that is not finite.
    pub fn new(knots_u: Knots, knots_v: Knots, points: Vec<V>) -> Result<Self, NurbsError> {
        let expected = knots_u.control_count() * knots_v.control_count();
        if points.len() != expected {
            return Err(NurbsError::PointCount { count: points.len(), expected });
        }
        if let Some(index) = points.iter().position(|p| !p.is_finite_vector()) {
            return Err(NurbsError::BadPoint { index });
        }
        Ok(Self { knots_u, knots_v, points })
    }

    /// The surface whose control-net rows in v are the control points of `columns` (all with the same knots),
    /// one column for each control point in v: a loft, once the columns have been solved for.
    ///
    /// # Errors
    /// As [`Surface::new`]; [`NurbsError::KnotCount`] if the columns' knots differ.
    pub fn from_columns(columns: &[Curve<V>], knots_v: Knots) -> Result<Self, NurbsError> {
        let Some(first) = columns.first() else {
            return Err(NurbsError::PointCount { count: 0, expected: knots_v.control_count() });
        };
        if let Some(odd) = columns.iter().find(|c| c.knots != first.knots) {
            let least = first.knots.values().len();
            return Err(NurbsError::KnotCount { count: odd.knots.values().len(), least });
        }
        let count = first.points.len();
        let points = (0..count).flat_map(|i| columns.iter().map(move |c| c.points[i])).collect();
        Self::new(first.knots.clone(), knots_v, points)
    }

    /// Knots in u.
    pub fn knots_u(&self) -> &Knots {
        &self.knots_u
    }

    /// Knots in v.
    pub fn knots_v(&self) -> &Knots {
        &self.knots_v
    }

    /// Control net, v running fastest.
    pub fn points(&self) -> &[V] {
        &self.points
    }

    /// Number of control points in u and v.
    pub fn counts(&self) -> (usize, usize) {
        (self.knots_u.control_count(), self.knots_v.control_count())
    }

    /// The surface with the same knots whose control points are `f` of these: exact for every affine `f`.
    pub fn map<W: VectorSpace>(&self, f: impl FnMut(&V) -> W) -> Surface<W> {
        let (knots_u, knots_v) = (self.knots_u.clone(), self.knots_v.clone());
        Surface { knots_u, knots_v, points: self.points.iter().map(f).collect() }
    }

    /// The surface with u and v exchanged.
    pub fn transposed(&self) -> Self {
        let (nu, nv) = self.counts();
        let points = (0..nv).flat_map(|j| (0..nu).map(move |i| (i, j))).map(|(i, j)| self.points[i * nv + j]);
        Self { knots_u: self.knots_v.clone(), knots_v: self.knots_u.clone(), points: points.collect() }
    }

    /// The curve `v -> S(u, v)`.
    pub fn iso_u(&self, u: f64) -> Curve<V> {
        let (basis, nv) = (self.knots_u.basis(u, 0), self.knots_v.control_count());
        let points = (0..nv).map(|j| self.sum_u(&basis, 0, j)).collect();
        Curve { knots: self.knots_v.clone(), points }
    }

    /// The curve `u -> S(u, v)`.
    pub fn iso_v(&self, v: f64) -> Curve<V> {
        let (basis, q) = (self.knots_v.basis(v, 0), self.knots_v.degree());
        let points = self.points.chunks_exact(self.knots_v.control_count());
        let points = points.map(|row| weighted_sum(&basis.values[0][..=q], &row[basis.first..])).collect();
        Curve { knots: self.knots_u.clone(), points }
    }

    fn sum_u(&self, basis: &Basis, order: usize, j: usize) -> V {
        let (p, nv) = (self.knots_u.degree(), self.knots_v.control_count());
        let mut sum = V::default();
        for (k, &n) in basis.values[order][..=p].iter().enumerate() {
            sum = sum + self.points[(basis.first + k) * nv + j] * n;
        }
        sum
    }

    /// Mixed derivatives `[order in u][order in v]`, those with `i + j <= ORDER`.
    #[inline]
    fn table<const ORDER: usize>(&self, u: f64, v: f64) -> [[V; 3]; 3] {
        // The usual degrees have loops of known length: three times as fast.
        match (self.knots_u.degree(), self.knots_v.degree()) {
            (3, 3) => self.table_of::<ORDER, 4, 4>(u, v),
            (3, 1) => self.table_of::<ORDER, 4, 2>(u, v),
            (5, 3) => self.table_of::<ORDER, 6, 4>(u, v),
            (5, 5) => self.table_of::<ORDER, 6, 6>(u, v),
            (2, 2) => self.table_of::<ORDER, 3, 3>(u, v),
            _ => self.table_of::<ORDER, { MAX_DEGREE + 1 }, { MAX_DEGREE + 1 }>(u, v),
        }
    }

    #[inline]
    fn table_of<const ORDER: usize, const N: usize, const M: usize>(&self, u: f64, v: f64) -> [[V; 3]; 3] {
        let (su, sv) = (self.knots_u.span(u), self.knots_v.span(v));
        let p = if N <= MAX_DEGREE { N - 1 } else { self.knots_u.degree() };
        let q = if M <= MAX_DEGREE { M - 1 } else { self.knots_v.degree() };
        let bu = self.knots_u.basis_on::<N>(su, p, u);
        let bv = self.knots_v.basis_on::<M>(sv, q, v);
        let nv = self.knots_v.control_count();
        let mut out = [[V::default(); 3]; 3];
        for k in 0..=p {
            let start = (su - p + k) * nv + sv - q;
            let row = &self.points[start..=start + q];
            let along = |order: usize| {
                let mut sum = row[0] * bv[order][0];
                for l in 1..=q {
                    sum = sum + row[l] * bv[order][l];
                }
                sum
            };
            // Written out: a loop over the orders keeps `out` in memory, at twice the time.
            let point = along(0);
            out[0][0] = out[0][0] + point * bu[0][k];
            if ORDER >= 1 {
                let first = along(1);
                out[1][0] = out[1][0] + point * bu[1][k];
                out[0][1] = out[0][1] + first * bu[0][k];
                if ORDER >= 2 {
                    out[2][0] = out[2][0] + point * bu[2][k];
                    out[1][1] = out[1][1] + first * bu[1][k];
                    out[0][2] = out[0][2] + along(2) * bu[0][k];
                }
            }
        }
        out
    }
}

fn weighted_sum<V: VectorSpace>(weights: &[f64], points: &[V]) -> V {
    let mut sum = V::default();
    for (&n, &c) in weights.iter().zip(points) {
        sum = sum + c * n;
    }
    sum
}

impl<V: VectorSpace> ParametricSurface<V> for Surface<V> {
    fn domain(&self) -> ((f64, f64), (f64, f64)) {
        (self.knots_u.domain(), self.knots_v.domain())
    }

    fn point(&self, u: f64, v: f64) -> V {
        self.table::<0>(u, v)[0][0]
    }

    fn first_derivatives(&self, u: f64, v: f64) -> (V, V, V) {
        let d = self.table::<1>(u, v);
        (d[0][0], d[1][0], d[0][1])
    }

    fn derivatives(&self, u: f64, v: f64) -> SurfaceDerivatives<V> {
        let d = self.table::<2>(u, v);
        SurfaceDerivatives { point: d[0][0], u: d[1][0], v: d[0][1], uu: d[2][0], uv: d[1][1], vv: d[0][2] }
    }

    fn breaks_u(&self) -> Vec<f64> {
        self.knots_u.breaks()
    }

    fn breaks_v(&self) -> Vec<f64> {
        self.knots_v.breaks()
    }
}

/// A rational B-spline (NURBS) surface: a B-spline in homogeneous coordinates, projected.
#[derive(Clone, Debug, PartialEq)]
pub struct RationalSurface<V> {
    pub(crate) homogeneous: Surface<Homogeneous<V>>,
}

impl<V: VectorSpace> RationalSurface<V> {
    /// A surface from knots, control net (v running fastest) and weights in the same order.
    ///
    /// # Errors
    /// As [`Surface::new`]; [`NurbsError::BadPoint`] also for a weight that is not positive.
    pub fn new(knots_u: Knots, knots_v: Knots, points: &[V], weights: &[f64]) -> Result<Self, NurbsError> {
        if weights.len() != points.len() {
            return Err(NurbsError::PointCount { count: weights.len(), expected: points.len() });
        }
        let embedded = points.iter().zip(weights).map(|(&p, &w)| Homogeneous::new(p, w)).collect();
        Self::from_homogeneous(Surface::new(knots_u, knots_v, embedded)?)
    }

    /// A surface from its homogeneous form.
    ///
    /// # Errors
    /// [`NurbsError::BadPoint`] for a weight that is not positive.
    pub fn from_homogeneous(homogeneous: Surface<Homogeneous<V>>) -> Result<Self, NurbsError> {
        match homogeneous.points.iter().position(|p| !(p.weight > 0.0)) {
            Some(index) => Err(NurbsError::BadPoint { index }),
            None => Ok(Self { homogeneous }),
        }
    }

    /// The homogeneous B-spline behind the surface.
    pub fn homogeneous(&self) -> &Surface<Homogeneous<V>> {
        &self.homogeneous
    }
}

impl<V: VectorSpace> ParametricSurface<V> for RationalSurface<V> {
    fn domain(&self) -> ((f64, f64), (f64, f64)) {
        self.homogeneous.domain()
    }

    fn point(&self, u: f64, v: f64) -> V {
        self.homogeneous.point(u, v).project()
    }

    fn derivatives(&self, u: f64, v: f64) -> SurfaceDerivatives<V> {
        let h = self.homogeneous.derivatives(u, v);
        let [point, du, duu] = project_derivatives([h.point, h.u, h.uu]);
        let [_, dv, dvv] = project_derivatives([h.point, h.v, h.vv]);
        let mixed = h.uv.weighted - du * h.v.weight - dv * h.u.weight - point * h.uv.weight;
        SurfaceDerivatives { point, u: du, v: dv, uu: duu, uv: mixed * (1.0 / h.point.weight), vv: dvv }
    }

    fn breaks_u(&self) -> Vec<f64> {
        self.homogeneous.breaks_u()
    }

    fn breaks_v(&self) -> Vec<f64> {
        self.homogeneous.breaks_v()
    }
}
