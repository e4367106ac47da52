//! The spaces that control points live in.

use glam::{DVec2, DVec3};
use std::fmt::Debug;
use std::ops::{Add, Mul, Sub};

/// A real vector space of fixed dimension: what a control point must be.
///
/// B-spline algorithms (de Boor, knot insertion, degree elevation, ...) use linear combinations only, so one
/// implementation serves laws (`f64`), parameter curves ([`DVec2`]), space curves ([`DVec3`]) and, through
/// [`Homogeneous`], their rational forms.
pub trait VectorSpace:
    Copy
    + Debug
    + Default
    + PartialEq
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<f64, Output = Self>
    + Send
    + Sync
    + 'static
{
    /// Number of components.
    const DIMENSION: usize;

    /// Component `i`, `i < DIMENSION`.
    fn component(&self, i: usize) -> f64;

    /// Vector with component `i` set to `value`.
    fn with_component(self, i: usize, value: f64) -> Self;

    /// Euclidean inner product.
    #[inline]
    fn inner(&self, other: &Self) -> f64 {
        (0..Self::DIMENSION).map(|i| self.component(i) * other.component(i)).sum()
    }

    /// Euclidean length.
    fn norm(&self) -> f64 {
        self.inner(self).sqrt()
    }

    /// Euclidean distance to `other`.
    fn distance_to(&self, other: &Self) -> f64 {
        (*self - *other).norm()
    }

    /// Whether all components are finite.
    fn is_finite_vector(&self) -> bool {
        (0..Self::DIMENSION).all(|i| self.component(i).is_finite())
    }
}

impl VectorSpace for f64 {
    const DIMENSION: usize = 1;
    #[inline]
    fn component(&self, _: usize) -> f64 {
        *self
    }
    fn with_component(self, _: usize, value: f64) -> Self {
        value
    }
}

impl VectorSpace for DVec2 {
    const DIMENSION: usize = 2;
    #[inline]
    fn component(&self, i: usize) -> f64 {
        self[i]
    }
    fn with_component(mut self, i: usize, value: f64) -> Self {
        self[i] = value;
        self
    }
    #[inline]
    fn inner(&self, other: &Self) -> f64 {
        self.dot(*other)
    }
}

impl VectorSpace for DVec3 {
    const DIMENSION: usize = 3;
    #[inline]
    fn component(&self, i: usize) -> f64 {
        self[i]
    }
    fn with_component(mut self, i: usize, value: f64) -> Self {
        self[i] = value;
        self
    }
    #[inline]
    fn inner(&self, other: &Self) -> f64 {
        self.dot(*other)
    }
}

/// A point in homogeneous coordinates, stored as `(weight * point, weight)`: the embedding of thesis section 2.2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Homogeneous<V> {
    /// `weight * point`.
    pub weighted: V,
    /// The weight, positive for a proper point.
    pub weight: f64,
}

impl<V: VectorSpace> Homogeneous<V> {
    /// Embeds `point` with `weight`.
    pub fn new(point: V, weight: f64) -> Self {
        Self { weighted: point * weight, weight }
    }

    /// Projects back: `weighted / weight`.
    pub fn project(&self) -> V {
        self.weighted * (1.0 / self.weight)
    }
}

impl<V: VectorSpace> Add for Homogeneous<V> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { weighted: self.weighted + other.weighted, weight: self.weight + other.weight }
    }
}

impl<V: VectorSpace> Sub for Homogeneous<V> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { weighted: self.weighted - other.weighted, weight: self.weight - other.weight }
    }
}

impl<V: VectorSpace> Mul<f64> for Homogeneous<V> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { weighted: self.weighted * factor, weight: self.weight * factor }
    }
}

impl<V: VectorSpace> VectorSpace for Homogeneous<V> {
    const DIMENSION: usize = V::DIMENSION + 1;
    #[inline]
    fn component(&self, i: usize) -> f64 {
        if i < V::DIMENSION { self.weighted.component(i) } else { self.weight }
    }
    fn with_component(mut self, i: usize, value: f64) -> Self {
        if i < V::DIMENSION {
            self.weighted = self.weighted.with_component(i, value);
        } else {
            self.weight = value;
        }
        self
    }
}
