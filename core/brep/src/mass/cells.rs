//! Loops small against their surface, such as the rims of holes: by moments.
//!
//! Knot lines part the rectangle about a loop into cells. On each the integrands are smooth, and given by their values
//! at a grid of Gauss points: polynomials of low degree, which the loop's inside need only be known to by its moments.
//! Those are integrals of Legendre polynomials along the loop, by Green's theorem, the same for all integrands; no
//! point of the surface is evaluated along the loop.

use super::Sums;
use super::net::Frame;
use crate::boundary::{Path, cuts, walk};
use crate::gauss;
use crate::lanes::{Lanes, Real};
use crate::model::Loop;
use crate::span::{Span, weighted_sum};
use coolinggen_nurbs::{Knots, MAX_DEGREE, Surface};
use glam::{DVec2, DVec3};

/// Largest last term, and largest term before it, that a grid may show of an integrand, relative to its size: terms
/// fall from one degree to the next as the loop is small against the surface's curvature.
const LAST: f64 = 1e-13;
const BEFORE: f64 = 1e-11;

/// Largest coefficient of the cube that a short piece of a loop may have for four points: the terms of degree 8 that they
/// do not see are `3 BEND^3 / 44,100` of the cell.
const BEND: f64 = 1e-3;

/// Sums over the inside of `lp`, negative if it runs clockwise; none where cells would be many or their grids not
/// fine enough.
pub(super) fn integrate<V: Frame>(surface: &Surface<V>, lp: &Loop) -> Option<Sums> {
    let region = Region::new(surface, lp)?;
    region.sums::<6>().or_else(|| region.sums::<8>()).or_else(|| region.sums::<12>())
}

/// The rectangle about a loop.
struct Region<'s, V> {
    surface: &'s Surface<V>,
    lp: &'s Loop,
    knots: [&'s Knots; 2],
    /// Where cells begin and end, in u and v.
    lines: [Vec<f64>; 2],
}

impl<'s, V: Frame> Region<'s, V> {
    fn new(surface: &'s Surface<V>, lp: &'s Loop) -> Option<Self> {
        let points = || lp.coedges.iter().flat_map(|c| c.pcurve.points());
        let degrees = || lp.coedges.iter().map(|c| c.pcurve.degree());
        // Loops of straight lines are better summed up span by span; cubics are what parameter curves mostly are.
        if degrees().all(|degree| degree == 1) || degrees().any(|degree| degree > 3) {
            return None;
        }
        let (low, high) =
            points().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
        let knots = [surface.knots_u(), surface.knots_v()];
        let lines = [0, 1].map(|axis| {
            let (start, end) = knots[axis].domain();
            let values = knots[axis].values();
            let (from, to) = (low[axis].max(start), high[axis].min(end));
            let first = values.partition_point(|&k| k <= from);
            let inner = values[first..].iter().copied().take_while(|&k| k < to);
            let mut lines: Vec<f64> = [low[axis]].into_iter().chain(inner).chain([high[axis]]).collect();
            lines.dedup();
            lines
        });
        let cells = (lines[0].len() - 1) * (lines[1].len() - 1);
        (cells > 0 && cells <= 4 + points().count() / 4).then_some(Self { surface, lp, knots, lines })
    }

    /// Ends in u or v of the cells in one column or row.
    fn ends(&self, axis: usize, index: usize) -> (f64, f64) {
        (self.lines[axis][index], self.lines[axis][index + 1])
    }

    /// The sums with `K` by `K` points a cell; none if these are too few.
    fn sums<const K: usize>(&self) -> Option<Sums> {
        let legendre = Legendre::<K>::new();
        let rows = self.lines[1].len() - 1;
        let count = (self.lines[0].len() - 1) * rows;
        let mut grids = Vec::with_capacity(count);
        for index in 0..count {
            let (grid, noise) = self.grid::<K>(index / rows, index % rows);
            if !legendre.resolves(&grid, noise) {
                return None;
            }
            grids.push(grid);
        }
        let mut moments = vec![[[Lanes::from(0.0); K]; K]; count];
        self.walk(&mut moments);
        let mut sums = Sums::default();
        for (index, (grid, moments)) in grids.iter().zip(&moments).enumerate() {
            let (u, v) = (self.ends(0, index / rows), self.ends(1, index % rows));
            let scale = 0.25 * (u.1 - u.0) * (v.1 - v.0);
            let weights = legendre.weights(moments);
            for (row, weights) in grid.iter().zip(&weights) {
                for ((point, normal), weight) in row.iter().zip(weights) {
                    sums.add(weight * scale, *point, *normal);
                }
            }
        }
        Some(sums)
    }

    /// Points and normals (u cross v) of a cell's grid, v running fastest, and what rounding makes of the normals,
    /// relative to their length: derivatives are differences of control points far from the origin.
    fn grid<const K: usize>(&self, column: usize, row: usize) -> ([[(DVec3, DVec3); K]; K], f64) {
        let (u, v) = (self.ends(0, column), self.ends(1, row));
        let [ku, kv] = self.knots;
        let (p, q) = (ku.degree(), kv.degree());
        let span_u = Span::new(ku, ku.span(0.5 * (u.0 + u.1)));
        let span_v = Span::new(kv, kv.span(0.5 * (v.0 + v.1)));
        let rule = gauss::rule(K);
        let at_v: [_; K] = std::array::from_fn(|b| {
            let (mut n, mut d) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
            span_v.slopes(v.0 + (v.1 - v.0) * rule[b].0, &mut n, &mut d);
            (n, d)
        });
        let (mut n, mut d) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
        let (mut across, mut slopes) = ([V::default(); MAX_DEGREE + 1], [V::default(); MAX_DEGREE + 1]);
        let stride = self.surface.counts().1;
        let mut out = [[(DVec3::ZERO, DVec3::ZERO); K]; K];
        let mut noise = 0.0f64;
        for (a, out) in out.iter_mut().enumerate() {
            span_u.slopes(u.0 + (u.1 - u.0) * rule[a].0, &mut n, &mut d);
            across[..=q].fill(V::default());
            slopes[..=q].fill(V::default());
            for k in 0..=p {
                let points = &self.surface.points()[(span_u.first() + k) * stride + span_v.first()..];
                for l in 0..=q {
                    across[l] = across[l] + points[l] * n[k];
                    slopes[l] = slopes[l] + points[l] * d[k];
                }
            }
            for (out, (n, d)) in out.iter_mut().zip(&at_v) {
                let (n, d) = (&n[..=q], &d[..=q]);
                let (point, along_u) = (weighted_sum(n, &across), weighted_sum(n, &slopes));
                let [point, along_u, along_v] = point.frame(along_u, weighted_sum(d, &across));
                *out = (point, along_u.cross(along_v));
            }
            let size =
                |weights: &[f64], along: DVec3| weights.iter().map(|w| w.abs()).sum::<f64>() / along.length();
            let (e, l) = (&at_v[0].1[..=q], &at_v[0].0[..=q]);
            let point = weighted_sum(l, &across);
            let [point, along_u, along_v] = point.frame(weighted_sum(l, &slopes), weighted_sum(e, &across));
            noise = noise.max(point.length() * (size(&d[..=p], along_u) + size(e, along_v)));
        }
        (out, noise * f64::EPSILON)
    }

    /// Integrates the cells' polynomials along the loop.
    fn walk<const K: usize>(&self, moments: &mut [[[Lanes; K]; K]]) {
        let mut pieces = Vec::new();
        walk(self.lp, |path| {
            let (low, high) = path.hull();
            let crosses = |axis: usize| {
                let lines = &self.lines[axis];
                lines[1..lines.len() - 1].iter().any(|&k| low[axis] < k && k < high[axis])
            };
            if crosses(0) || crosses(1) {
                cuts(path, [Some(self.knots[0]), Some(self.knots[1])], &mut pieces);
                for pair in pieces.windows(2) {
                    self.piece(path, pair[0], pair[1], moments);
                }
            } else {
                self.piece(path, 0.0, 1.0, moments);
            }
        });
    }

    /// Adds the piece of `path` from `start` to `end`, which lies in one cell.
    fn piece<const K: usize>(&self, path: &Path<'_>, start: f64, end: f64, moments: &mut [[[Lanes; K]; K]]) {
        let cubic = Cubic::of(path, start, end);
        let middle = cubic.at(0.5);
        let place = |axis: usize| {
            let lines = &self.lines[axis];
            lines[1..lines.len() - 1].partition_point(|&k| k <= middle[axis])
        };
        let (column, row) = (place(0), place(1));
        let rows = self.lines[1].len() - 1;
        let ((u0, u1), (v0, v1)) = (self.ends(0, column), self.ends(1, row));
        // In a cell both coordinates run from -1 to 1.
        let scale = DVec2::new(2.0 / (u1 - u0), 2.0 / (v1 - v0));
        let cubic = cubic.scaled(DVec2::new(u0, v0), scale);
        let (from, to) = (cubic.at(0.0), cubic.at(1.0));
        if column > 0 {
            // Cells on the left are filled from side to side: of their polynomials only those constant in u remain.
            let (from, to) = (antiderivatives::<K, f64>(from.y), antiderivatives::<K, f64>(to.y));
            for column in 0..column {
                let into = &mut moments[column * rows + row][0];
                for j in 0..K {
                    into[j].0[0] += 2.0 * (to[j] - from[j]) / (2 * j + 1) as f64;
                }
            }
        }
        let into = &mut moments[column * rows + row];
        let extent = (to - from).abs().max_element();
        // A cubic piece makes degree 3 K + 2; little of it shows where the piece is short and bends little.
        let bend = cubic.0[3].abs().max_element();
        let n = if extent < 0.15 && bend < BEND {
            if K < 12 { 4 } else { 8 }
        } else if extent < 0.4 {
            if K < 12 { 8 } else { 12 }
        } else {
            (3 * K).div_ceil(2).next_multiple_of(4) + 4
        };
        for nodes in gauss::rule(n).chunks_exact(4) {
            let s = Lanes([0, 1, 2, 3].map(|lane| nodes[lane].0));
            let weight = Lanes([0, 1, 2, 3].map(|lane| nodes[lane].1));
            let [x, y, rate] = cubic.four(s);
            let rate = rate * weight;
            let across = antiderivatives::<K, Lanes>(x);
            let along = polynomials::<K, Lanes>(y);
            for j in 0..K {
                let along = along[j] * rate;
                for i in 0..K - j {
                    into[i][j] = into[i][j] + across[i] * along;
                }
            }
        }
    }
}

/// A piece of a path over [0, 1] as a cubic in powers of its parameter.
struct Cubic([DVec2; 4]);

impl Cubic {
    /// The piece of `path` from `start` to `end`, of degree 3 at most.
    fn of(path: &Path<'_>, start: f64, end: f64) -> Self {
        let ((p, d), (q, e)) = (path.slope(start), path.slope(end));
        let (d, e) = (d * (end - start), e * (end - start));
        Self([p, d, (q - p) * 3.0 - d * 2.0 - e, (p - q) * 2.0 + d + e])
    }

    fn at(&self, s: f64) -> DVec2 {
        let Self([a, b, c, d]) = *self;
        a + (b + (c + d * s) * s) * s
    }

    /// The same with coordinates that run from -1 at `low`, with `scale`.
    fn scaled(&self, low: DVec2, scale: DVec2) -> Self {
        let Self([a, b, c, d]) = *self;
        Self([(a - low) * scale - DVec2::ONE, b * scale, c * scale, d * scale])
    }

    /// Both coordinates and the derivative of the second one at four parameters.
    #[inline(always)]
    fn four(&self, s: Lanes) -> [Lanes; 3] {
        let Self([a, b, c, d]) = *self;
        let value = |k: usize| {
            let [a, b, c, d] = [a[k], b[k], c[k], d[k]].map(Lanes::from);
            a + (b + (c + d * s) * s) * s
        };
        let slope = Lanes::from(b.y) + (Lanes::from(2.0 * c.y) + Lanes::from(3.0 * d.y) * s) * s;
        [value(0), value(1), slope]
    }
}

/// Legendre polynomials of degree 0 to `K - 1` at `x`.
#[inline(always)]
fn polynomials<const K: usize, T: Real>(x: T) -> [T; K] {
    let mut out = [T::from(1.0); K];
    out[1] = x;
    for k in 2..K {
        let (a, b) = ((2 * k - 1) as f64 / k as f64, (k - 1) as f64 / k as f64);
        out[k] = T::from(a) * x * out[k - 1] - T::from(b) * out[k - 2];
    }
    out
}

/// Antiderivatives, from -1 on, of the Legendre polynomials of degree `k < K`, times `2 k + 1`.
#[inline(always)]
fn antiderivatives<const K: usize, T: Real>(x: T) -> [T; K] {
    let (mut before, mut p) = (T::from(1.0), x);
    let mut out = [x + T::from(1.0); K];
    for k in 1..K {
        let (a, b) = ((2 * k + 1) as f64 / (k + 1) as f64, k as f64 / (k + 1) as f64);
        let next = T::from(a) * x * p - T::from(b) * before;
        out[k] = next - before;
        (before, p) = (p, next);
    }
    out
}

/// Legendre polynomials at the points of Gauss's rule.
struct Legendre<const K: usize> {
    /// `[degree][point]`, times the point's weight.
    weighted: [[f64; K]; K],
}

impl<const K: usize> Legendre<K> {
    fn new() -> Self {
        let mut weighted = [[0.0; K]; K];
        for (a, &(s, w)) in gauss::rule(K).iter().enumerate() {
            for (k, value) in polynomials::<K, f64>(2.0 * s - 1.0).into_iter().enumerate() {
                weighted[k][a] = w * value;
            }
        }
        Self { weighted }
    }

    /// Weights of a grid's points, from the moments of the degrees below `K` in both variables together, which come
    /// times `2 i + 1`.
    fn weights(&self, moments: &[[Lanes; K]; K]) -> [[f64; K]; K] {
        let mut out = [[0.0; K]; K];
        let mut half = [[0.0; K]; K];
        for i in 0..K {
            for j in 0..K - i {
                let [a, b, c, d] = moments[i][j].0;
                let moment = (a + b + c + d) * (2 * j + 1) as f64;
                for b in 0..K {
                    half[i][b] += moment * self.weighted[j][b];
                }
            }
        }
        for i in 0..K {
            for a in 0..K {
                for b in 0..K {
                    out[a][b] += self.weighted[i][a] * half[i][b];
                }
            }
        }
        out
    }

    /// Whether the integrands on a grid, with rounding by `noise`, have no terms to speak of that it cannot show: the
    /// last two it shows along its middle lines have vanished.
    fn resolves(&self, grid: &[[(DVec3, DVec3); K]; K], noise: f64) -> bool {
        let along = |line: &dyn Fn(usize) -> (DVec3, DVec3)| {
            let (mut last, mut before) = ([0.0; 5], [0.0; 5]);
            let mut scale = [0.0f64; 5];
            for k in 0..K {
                let (point, normal) = line(k);
                let (area, flux) = (normal.length(), point.dot(normal));
                let size = point.length();
                let values = [area, flux, flux * point.x, flux * point.y, flux * point.z];
                let sizes = [area, area * size, area * size * size, area * size * size, area * size * size];
                for i in 0..5 {
                    last[i] += self.weighted[K - 1][k] * values[i];
                    before[i] += self.weighted[K - 2][k] * values[i];
                    scale[i] = scale[i].max(sizes[i]);
                }
            }
            let factor = (2 * K - 1) as f64;
            (0..5).all(|i| {
                let (last, before) = (last[i].abs() * factor, before[i].abs() * factor);
                last <= (LAST + noise) * scale[i] && before <= (BEFORE + noise) * scale[i]
            })
        };
        along(&|k| grid[k][K / 2]) && along(&|k| grid[K / 2][k])
    }
}
