//! Quadrature points of bicubic nets two at a time: for vector instructions.

use super::Sums;
use super::net::Frame;
use crate::lanes::Lanes;
use glam::DVec3;

/// Two numbers.
pub(super) type Pair = Lanes<2>;

/// Four control points with their derivatives in the outer parameter, every coordinate twice.
pub(super) struct Row {
    values: [[Pair; 3]; 4],
    slopes: [[Pair; 3]; 4],
}

/// Sums of two halves of the points.
#[derive(Clone, Copy)]
pub(super) struct PairSums {
    area: Pair,
    position: [Pair; 3],
    normal: [Pair; 3],
    flux: Pair,
    moment: [Pair; 3],
}

impl Row {
    /// None where the control points are others than four of three coordinates each.
    #[inline(always)]
    pub(super) fn new<V: Frame>(values: &[V], slopes: &[V]) -> Option<Self> {
        if V::DIMENSION != 3 || values.len() != 4 || slopes.len() != 4 {
            return None;
        }
        let zero = [[Pair::from(0.0); 3]; 4];
        let mut row = Self { values: zero, slopes: zero };
        for k in 0..4 {
            let [value, slope, _] = values[k].frame(slopes[k], slopes[k]);
            for i in 0..3 {
                row.values[k][i] = Pair::from(value[i]);
                row.slopes[k][i] = Pair::from(slope[i]);
            }
        }
        Some(row)
    }
}

impl PairSums {
    pub(super) fn zero() -> Self {
        let (zero, three) = (Pair::from(0.0), [Pair::from(0.0); 3]);
        Self { area: zero, position: three, normal: three, flux: zero, moment: three }
    }

    /// Adds two points of a row, given by their basis values `n` and slopes `d`.
    #[inline(always)]
    pub(super) fn add(&mut self, row: &Row, weight: Pair, n: &[Pair; 4], d: &[Pair; 4]) {
        let point = blend(n, &row.values);
        let (a, b) = (blend(n, &row.slopes), blend(d, &row.values));
        let normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        let area = weight * dot(&normal, &normal).sqrt();
        let flux = weight * dot(&point, &normal);
        self.area = self.area + area;
        self.flux = self.flux + flux;
        for i in 0..3 {
            self.position[i] = self.position[i] + point[i] * area;
            self.normal[i] = self.normal[i] + normal[i] * weight;
            self.moment[i] = self.moment[i] + point[i] * flux;
        }
    }

    /// The sums of both halves; `sense` is -1 where the natural normal is the other way round.
    pub(super) fn total(self, sense: f64) -> Sums {
        let vector = |v: [Pair; 3]| DVec3::from_array(v.map(Pair::sum));
        Sums {
            area: self.area.sum(),
            position: vector(self.position),
            normal: vector(self.normal) * sense,
            flux: self.flux.sum() * sense,
            moment: vector(self.moment) * sense,
        }
    }
}

#[inline(always)]
fn blend(weights: &[Pair; 4], points: &[[Pair; 3]; 4]) -> [Pair; 3] {
    let mut sum = [Pair::from(0.0); 3];
    for k in 0..4 {
        for i in 0..3 {
            sum[i] = sum[i] + weights[k] * points[k][i];
        }
    }
    sum
}

#[inline(always)]
fn dot(a: &[Pair; 3], b: &[Pair; 3]) -> Pair {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
