//! Global minima of the distance by branch and bound over Bezier pieces, shared by curves and surfaces.
//!
//! A tree of bounding boxes leaves the few pieces that may hold something closer than the best known. On each of them
//! the Bernstein coefficients of `|X - w P|^2 - d^2 w^2` (a polynomial, rational pieces included) prove that nothing
//! is closer than `d`, or that the polynomial is convex and its minimum decides, or the piece is halved.

use crate::bernstein::{Net, squared_distance};
use crate::error::NurbsError;
use crate::vector::{Homogeneous, VectorSpace};

/// Coefficients below zero by less than this, of the size of the piece's numbers, are rounding.
const ROUNDING: f64 = 1e-14;
/// Boxes smaller than this, in parameters of their piece, decide nothing that Newton's method would not.
const SMALLEST: f64 = 1e-8;
/// Boxes examined before a search is given up.
const BUDGET: usize = 100_000;

/// A Bezier piece on its part of the domain; a curve has one control point in v.
#[derive(Clone, Debug)]
pub(super) struct Piece<V> {
    pub(super) u: (f64, f64),
    pub(super) v: (f64, f64),
    pub(super) counts: (usize, usize),
    pub(super) net: Vec<Homogeneous<V>>,
}

/// An axis-parallel box around pieces.
#[derive(Clone, Copy, Debug)]
struct Bound<V> {
    low: V,
    high: V,
}

impl<V: VectorSpace> Bound<V> {
    fn of(points: impl Iterator<Item = V>) -> Self {
        let mut bound: Option<Self> = None;
        for p in points {
            bound = Some(bound.map_or(Self { low: p, high: p }, |b| b.around(&Self { low: p, high: p })));
        }
        bound.unwrap_or(Self { low: V::default(), high: V::default() })
    }

    fn around(mut self, other: &Self) -> Self {
        for i in 0..V::DIMENSION {
            self.low = self.low.with_component(i, self.low.component(i).min(other.low.component(i)));
            self.high = self.high.with_component(i, self.high.component(i).max(other.high.component(i)));
        }
        self
    }

    fn squared_distance(&self, p: &V) -> f64 {
        let beyond = |i: usize| {
            let x = p.component(i);
            (self.low.component(i) - x).max(x - self.high.component(i)).max(0.0)
        };
        (0..V::DIMENSION).map(|i| beyond(i).powi(2)).sum()
    }
}

#[derive(Clone, Debug)]
enum Children {
    Pair(usize, usize),
    /// A piece, with sample points and their parameters.
    Leaf(usize),
}

/// Pieces of a curve or surface under a tree of boxes.
#[derive(Clone, Debug)]
pub(super) struct Pieces<V> {
    pieces: Vec<Piece<V>>,
    samples: Vec<Vec<(V, f64, f64)>>,
    nodes: Vec<(Bound<V>, Children)>,
}

impl<V: VectorSpace> Pieces<V> {
    /// `pieces` in a grid, v running fastest, `count_v` of them along v; `sample` evaluates.
    pub(super) fn new(pieces: Vec<Piece<V>>, count_v: usize, sample: impl Fn(f64, f64) -> V) -> Self {
        let at = |(a, b): (f64, f64), k: usize, n: usize| a + (b - a) * (k as f64 + 0.5) / n as f64;
        let samples = pieces.iter().map(|p| {
            let (m, n) = (p.counts.0.min(4), if p.counts.1 == 1 { 1 } else { p.counts.1.min(4) });
            let grid = (0..m * n).map(|k| (at(p.u, k / n, m), at(p.v, k % n, n)));
            grid.map(|(u, v)| (sample(u, v), u, v)).collect()
        });
        let samples = samples.collect();
        let count_u = pieces.len() / count_v;
        let mut all = Self { pieces, samples, nodes: Vec::new() };
        all.build((0, count_u), (0, count_v), count_v);
        all
    }

    /// Adds the nodes of a rectangle of pieces; the index of its root.
    fn build(&mut self, u: (usize, usize), v: (usize, usize), count_v: usize) -> usize {
        let (nu, nv) = (u.1 - u.0, v.1 - v.0);
        let node = if nu * nv == 1 {
            let index = u.0 * count_v + v.0;
            let hull = self.pieces[index].net.iter().map(Homogeneous::project);
            (Bound::of(hull), Children::Leaf(index))
        } else {
            let (a, b) = if nu >= nv {
                let middle = u.0 + nu / 2;
                (self.build((u.0, middle), v, count_v), self.build((middle, u.1), v, count_v))
            } else {
                let middle = v.0 + nv / 2;
                (self.build(u, (v.0, middle), count_v), self.build(u, (middle, v.1), count_v))
            };
            (self.nodes[a].0.around(&self.nodes[b].0), Children::Pair(a, b))
        };
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// A sphere around everything: centre and radius.
    pub(super) fn sphere(&self) -> (V, f64) {
        let bound = &self.nodes[self.nodes.len() - 1].0;
        ((bound.low + bound.high) * 0.5, 0.5 * bound.low.distance_to(&bound.high))
    }

    /// Visits the leaves that may be closer than `best` (a squared distance), near ones first. `visit` returns the
    /// new best.
    fn visit(
        &self,
        point: &V,
        mut best: f64,
        mut visit: impl FnMut(usize, f64) -> Result<f64, NurbsError>,
    ) -> Result<(), NurbsError> {
        let root = self.nodes.len() - 1;
        let mut stack = vec![(self.nodes[root].0.squared_distance(point), root)];
        while let Some((bound, node)) = stack.pop() {
            if bound >= best {
                continue;
            }
            match self.nodes[node].1 {
                Children::Leaf(piece) => best = visit(piece, best)?,
                Children::Pair(a, b) => {
                    let [a, b] = [a, b].map(|n| (self.nodes[n].0.squared_distance(point), n));
                    let (near, far) = if a.0 <= b.0 { (a, b) } else { (b, a) };
                    stack.extend([far, near]);
                }
            }
        }
        Ok(())
    }

    /// Finds the global minimum of the distance to `point`: `refine` is called with start values, descends from them
    /// and returns the distance it finds; the least of them is the minimum, up to rounding of the squares.
    pub(super) fn closest(
        &self,
        point: V,
        mut refine: impl FnMut(f64, f64) -> Result<f64, NurbsError>,
    ) -> Result<(), NurbsError> {
        let mut start = (0.0, 0.0);
        self.visit(&point, f64::INFINITY, |piece, mut best| {
            for &(sample, u, v) in &self.samples[piece] {
                let r = sample - point;
                let square = r.inner(&r);
                if square < best {
                    best = square;
                    start = (u, v);
                }
            }
            Ok(best)
        })?;
        let distance = refine(start.0, start.1)?;
        let mut left = BUDGET;
        self.visit(&point, distance * distance, |piece, best| {
            self.certify(&self.pieces[piece], point, best.sqrt(), &mut left, &mut refine).map(|d| d * d)
        })
    }

    /// Proves that nothing on `piece` is closer than the distance returned, improving it by `refine`.
    fn certify(
        &self,
        piece: &Piece<V>,
        point: V,
        mut distance: f64,
        left: &mut usize,
        refine: &mut impl FnMut(f64, f64) -> Result<f64, NurbsError>,
    ) -> Result<f64, NurbsError> {
        let (square, weight) = squared_distance(&piece.net, piece.counts, point);
        let rounding = ROUNDING * (square.range().1 + distance * distance * weight.range().1);
        let mut stack = vec![Box2 { square, weight, low: [0.0; 2], size: [1.0; 2] }];
        while let Some(b) = stack.pop() {
            let g = b.square.plus(-distance * distance, &b.weight);
            if g.range().0 >= -rounding {
                continue;
            }
            *left = left.checked_sub(1).ok_or(NurbsError::NoConvergence {
                what: "proof that a closest point is the closest",
                residual: distance,
            })?;
            let candidate = match g.convex() {
                Some(derivatives) => {
                    let (bound, at) = g.convex_bound(&derivatives);
                    if bound >= -rounding {
                        continue;
                    }
                    at
                }
                None => g.least_node(),
            };
            if g.value(candidate[0], candidate[1]) < -rounding {
                let at = |i: usize, (start, end): (f64, f64)| {
                    start + (end - start) * (b.low[i] + b.size[i] * candidate[i])
                };
                let found = refine(at(0, piece.u), at(1, piece.v))?;
                if found < distance {
                    distance = found;
                    stack.push(b);
                    continue;
                }
            }
            if b.size[0].max(b.size[1]) > SMALLEST {
                let along = usize::from(g.bend()[1] > g.bend()[0]);
                stack.extend(b.halves(along));
            }
        }
        Ok(distance)
    }
}

/// A part of a piece with the polynomials on it.
struct Box2 {
    square: Net,
    weight: Net,
    low: [f64; 2],
    size: [f64; 2],
}

impl Box2 {
    fn halves(&self, along: usize) -> [Self; 2] {
        let (square, weight) = if along == 0 {
            (self.square.halves_u(), self.weight.halves_u())
        } else {
            (self.square.halves_v(), self.weight.halves_v())
        };
        let mut size = self.size;
        size[along] *= 0.5;
        let mut high = self.low;
        high[along] += size[along];
        [
            Self { square: square.0, weight: weight.0, low: self.low, size },
            Self { square: square.1, weight: weight.1, low: high, size },
        ]
    }
}
