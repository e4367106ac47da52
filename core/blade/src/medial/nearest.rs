//! The B-spline surface nearest to points, with as many control points as asked.

use coolinggen_nurbs::{BandedLu, Knots, NurbsError, ParametricSurface, Surface, project_on_surface};
use glam::DVec3;

/// What a step may do to a control point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Freedom {
    /// It goes where it serves best.
    Free,
    /// It keeps its height along this unit vector.
    InPlane(DVec3),
    /// It stays.
    Held,
}

/// A point with the parameters of the surface's point closest to it, and the v that it had better be at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Foot {
    pub(super) target: DVec3,
    pub(super) s: f64,
    pub(super) v: f64,
    pub(super) asked: (f64, f64),
}

/// Steps at most, and the relative gains below which steps are the last.
const STEPS: usize = 60;
const SETTLED: f64 = 1e-4;
const SETTLED_STEPS: usize = 4;
/// Multiplications that the factors of all steps may take, a few seconds: surfaces of some thousand control points get
/// fewer steps, those of far more stay as they are.
const EFFORT: f64 = 4e9;
/// Damping to begin with, and how often a step is damped more.
const DAMPING: f64 = 1e-3;
const TRIES: usize = 12;
/// Weight of what a step does along the surface: it changes no distance, but without it there would be no one solution.
const ALONG: f64 = 1e-3;
/// Weights of the squared distances along u and v between a foot and the place asked. The surface is continued past its
/// ends in v, where lines that crowd or lean would run away.
const PULL: [f64; 2] = [1e-3, 1e-2];
/// Least gap between knots, in parts of an even one.
const GAP: f64 = 0.02;
/// Step of difference quotients over knots.
const STEP: f64 = 1e-7;

/// Moves the control points of `start`, a surface over [0, 1] both ways, and its inner knots in u if `knots` says so,
/// until the sum of squared distances of the feet's targets is least; gives that sum, too. Feet come in rows along u of
/// `lines` along v, and move along. `freedom` is that of control point (i, j).
///
/// Gauss-Newton with damping (Levenberg, Marquardt) on all unknowns at once. A distance changes by what the surface
/// moves along its normal there (tangent distance minimisation: W. Wang, H. Pottmann, Y. Liu, "Fitting B-spline curves
/// to point clouds by curvature-based squared distance minimization", ACM Transactions on Graphics 25, 2006), so that
/// parameters need no turns of their own: fits at fixed parameters, with knots and parameters moved in turn, end with ten
/// times the distance.
pub(super) fn nearest(
    start: Surface<DVec3>,
    feet: &mut Vec<Foot>,
    lines: usize,
    freedom: &dyn Fn(usize, usize) -> Freedom,
    knots: bool,
) -> Result<(Surface<DVec3>, f64), NurbsError> {
    let mut surface = start;
    let mut sum = project(&surface, feet, lines);
    let (mut damping, mut settled) = (DAMPING, 0);
    let steps = (EFFORT / Equations::effort(&surface)).min(STEPS as f64) as usize;
    for _ in 0..steps {
        let equations = Equations::new(&surface, feet, freedom, knots)?;
        let mut next = None;
        for _ in 0..TRIES {
            let stepped = equations.solve(damping).and_then(|step| stepped(&surface, &step));
            // Knots that change places make no surface: such a step is too long.
            if let Ok(stepped) = stepped {
                let mut moved = feet.clone();
                let after = project(&stepped, &mut moved, lines);
                if after < sum && disorder(&moved, lines) <= disorder(feet, lines) {
                    next = Some((stepped, moved, after));
                    break;
                }
            }
            damping *= 4.0;
        }
        let Some((stepped, moved, after)) = next else { break };
        settled = if sum - after < SETTLED * sum { settled + 1 } else { 0 };
        (surface, *feet, sum) = (stepped, moved, after);
        damping = (damping / 6.0).max(1e-8);
        if settled == SETTLED_STEPS {
            break;
        }
    }
    Ok((surface, sum))
}

/// How many neighbours among the targets have feet that are not in the same order: there the surface has folds that no
/// distance shows.
fn disorder(feet: &[Foot], lines: usize) -> usize {
    let off = |a: f64, b: f64| !(a < b || a == b && at_end(a));
    let along_v = feet.chunks_exact(lines).flat_map(|row| row.windows(2)).filter(|f| off(f[0].v, f[1].v));
    let along_u = feet.iter().zip(&feet[lines..]).filter(|(a, b)| off(a.s, b.s));
    along_v.count() + along_u.count()
}

/// Whether a parameter is at an end of [0, 1].
fn at_end(t: f64) -> bool {
    t <= 0.0 || t >= 1.0
}

/// Moves the feet to the closest points and asks each for the mean s of its row; the sum of squares.
fn project(surface: &Surface<DVec3>, feet: &mut [Foot], lines: usize) -> f64 {
    let mut sum = 0.0;
    for row in feet.chunks_exact_mut(lines) {
        for foot in row.iter_mut() {
            // Where the descent stalls the foot is as good as before.
            if let Ok(p) = project_on_surface(surface, foot.target, (foot.s, foot.v), false) {
                (foot.s, foot.v) = (p.u, p.v);
            }
        }
        let mean = row.iter().map(|f| f.s).sum::<f64>() / lines as f64;
        for foot in row.iter_mut() {
            foot.asked.0 = mean;
            let (point, du, dv) = surface.first_derivatives(foot.s, foot.v);
            let slid = foot.slid(du, dv);
            sum +=
                point.distance_squared(foot.target) + PULL[0] * slid[0].powi(2) + PULL[1] * slid[1].powi(2);
        }
    }
    sum
}

impl Foot {
    /// How far it is from the place asked, along the derivatives in s and v.
    fn slid(&self, du: DVec3, dv: DVec3) -> [f64; 2] {
        [(self.s - self.asked.0) * du.length(), (self.v - self.asked.1) * dv.length()]
    }
}

/// The surface after a step: three numbers a control point, then the inner knots in u if they move.
fn stepped(surface: &Surface<DVec3>, step: &[f64]) -> Result<Surface<DVec3>, NurbsError> {
    let (points, knots) = step.split_at(3 * surface.points().len());
    let moved = surface.points().iter().zip(points.chunks_exact(3));
    let points = moved.map(|(p, d)| *p + DVec3::from_slice(d)).collect();
    let u = if knots.is_empty() { surface.knots_u().clone() } else { shifted(surface.knots_u(), knots)? };
    Surface::new(u, surface.knots_v().clone(), points)
}

/// Indices of the inner knots, which are simple.
fn inner(knots: &Knots) -> std::ops::Range<usize> {
    knots.degree() + 1..knots.control_count()
}

/// The knots with the inner ones moved; an error if they come too close.
fn shifted(knots: &Knots, by: &[f64]) -> Result<Knots, NurbsError> {
    let mut values = knots.values().to_vec();
    values[inner(knots)].iter_mut().zip(by).for_each(|(k, d)| *k += d);
    let (start, end) = knots.domain();
    let least = GAP * (end - start) / (by.len() + 1) as f64;
    let ordered = &values[knots.degree()..=knots.control_count()];
    if let Some(index) = (1..ordered.len()).find(|&i| !(ordered[i] - ordered[i - 1] >= least)) {
        return Err(NurbsError::KnotOrder { index, before: ordered[index - 1], value: ordered[index] });
    }
    Knots::new(knots.degree(), values)
}

/// Normal equations of one step: banded in the control points, bordered by the knots.
struct Equations {
    size: usize,
    width: usize,
    /// Row i, column i + k at `i * (width + 1) + k`.
    band: Vec<f64>,
    right: Vec<f64>,
    /// A column for each knot: products with the control points, then with the knots.
    knots: Vec<Vec<f64>>,
    right_knots: Vec<f64>,
}

impl Equations {
    fn width(surface: &Surface<DVec3>) -> usize {
        3 * (surface.knots_u().degree() * surface.counts().1 + surface.knots_v().degree()) + 2
    }

    /// Multiplications that factors take.
    fn effort(surface: &Surface<DVec3>) -> f64 {
        3.0 * surface.points().len() as f64 * (Self::width(surface) as f64).powi(2)
    }

    fn new(
        surface: &Surface<DVec3>,
        feet: &[Foot],
        freedom: &dyn Fn(usize, usize) -> Freedom,
        knots: bool,
    ) -> Result<Self, NurbsError> {
        let (size, width) = (3 * surface.points().len(), Self::width(surface));
        let (knots_u, knots_v) = (surface.knots_u(), surface.knots_v());
        let (p, q, columns) = (knots_u.degree(), knots_v.degree(), surface.counts().1);
        let changed = if knots { Changed::all(surface)? } else { Vec::new() };
        let count = changed.len();
        let mut equations = Self {
            size,
            width,
            band: vec![0.0; size * (width + 1)],
            right: vec![0.0; size],
            knots: vec![vec![0.0; size + count]; count],
            right_knots: vec![0.0; count],
        };
        let mut weights = vec![(0, 0.0, Freedom::Free); (p + 1) * (q + 1)];
        let mut entries = vec![(0, 0.0); 3 * weights.len()];
        for foot in feet {
            let (point, du, dv) = surface.first_derivatives(foot.s, foot.v);
            let normal = du.cross(dv);
            if normal == DVec3::ZERO {
                continue;
            }
            let (basis_u, basis_v) = (knots_u.basis(foot.s, 0), knots_v.basis(foot.v, 0));
            for (k, weight) in weights.iter_mut().enumerate() {
                let (i, j) = (k / (q + 1), k % (q + 1));
                let at = (basis_u.first + i, basis_v.first + j);
                let factor = basis_u.values[0][i] * basis_v.values[0][j];
                *weight = (at.0 * columns + at.1, factor, freedom(at.0, at.1));
            }
            let moves: Vec<(usize, DVec3)> = changed
                .iter()
                .enumerate()
                .filter(|(_, c)| c.concerns(foot))
                .map(|(k, c)| (k, (c.surface.point(foot.s, foot.v) - point) / STEP))
                .collect();
            let left = foot.target - point;
            let n = normal.normalize();
            // Where a border keeps the foot, the distance across it counts, too.
            let (across_v, across_u) = (n.cross(dv).normalize(), n.cross(du).normalize());
            // A foot behind its place is brought there by a surface that moves ahead.
            let slid = foot.slid(du, dv);
            let ahead = [du.dot(across_v), dv.dot(across_u)].map(f64::signum);
            let border = |t: f64| if at_end(t) { 1.0 } else { 0.0 };
            let rows = [
                (n, left.dot(n), 1.0),
                (across_v, left.dot(across_v), border(foot.s)),
                (across_u, left.dot(across_u), border(foot.v)),
                (across_v, slid[0] * ahead[0], PULL[0]),
                (across_u, slid[1] * ahead[1], PULL[1]),
                (across_v, 0.0, ALONG),
            ];
            for (direction, value, weight) in rows {
                for (k, &(index, factor, freedom)) in weights.iter().enumerate() {
                    let along = match freedom {
                        Freedom::Free => direction,
                        Freedom::InPlane(normal) => direction.reject_from_normalized(normal),
                        Freedom::Held => DVec3::ZERO,
                    };
                    for c in 0..3 {
                        entries[3 * k + c] = (3 * index + c, factor * along[c]);
                    }
                }
                let moves: Vec<(usize, f64)> = moves.iter().map(|(k, m)| (*k, m.dot(direction))).collect();
                equations.add(&entries, &moves, value, weight);
            }
        }
        Ok(equations)
    }

    /// One equation, its entries in the order of their columns but for those of neighbours in v.
    fn add(&mut self, entries: &[(usize, f64)], knots: &[(usize, f64)], value: f64, weight: f64) {
        for (a, &(i, x)) in entries.iter().enumerate() {
            if x == 0.0 {
                continue;
            }
            let x = weight * x;
            self.right[i] += x * value;
            let row = &mut self.band[i * (self.width + 1)..(i + 1) * (self.width + 1)];
            for &(j, y) in &entries[a..] {
                row[j - i] += x * y;
            }
            for &(k, y) in knots {
                self.knots[k][i] += x * y;
            }
        }
        for &(k, x) in knots {
            self.right_knots[k] += weight * x * value;
            for &(l, y) in knots {
                self.knots[k][self.size + l] += weight * x * y;
            }
        }
    }

    /// The step, damped by this part of the diagonal.
    fn solve(&self, damping: f64) -> Result<Vec<f64>, NurbsError> {
        let (size, width, stride) = (self.size, self.width, self.width + 1);
        let damped = |d: f64| if d > 0.0 { d * (1.0 + damping) } else { 1.0 };
        let lu = BandedLu::factor(size, width, |i, row| {
            let lead = width.min(i);
            for k in 1..=lead {
                row[lead - k] = self.band[(i - k) * stride + k];
            }
            let ahead = stride.min(size - i);
            row[lead..lead + ahead].copy_from_slice(&self.band[i * stride..i * stride + ahead]);
            row[lead] = damped(row[lead]);
            i - lead
        })?;
        let mut step = self.right.clone();
        lu.solve(&mut step);
        // The knots' share by their Schur complement.
        let solved: Vec<Vec<f64>> = self
            .knots
            .iter()
            .map(|column| {
                let mut x = column[..size].to_vec();
                lu.solve(&mut x);
                x
            })
            .collect();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let count = self.knots.len();
        let knots = if count == 0 {
            Vec::new()
        } else {
            let full = BandedLu::factor(count, count - 1, |k, row| {
                for l in 0..count {
                    let own = self.knots[k][size + l];
                    row[l] = if k == l { damped(own) } else { own } - dot(&self.knots[k][..size], &solved[l]);
                }
                0
            })?;
            let mut right: Vec<f64> =
                (0..count).map(|k| self.right_knots[k] - dot(&self.knots[k][..size], &step)).collect();
            full.solve(&mut right);
            right
        };
        for (x, column) in knots.iter().zip(&solved) {
            step.iter_mut().zip(column).for_each(|(s, c)| *s -= x * c);
        }
        step.extend(knots);
        Ok(step)
    }
}

/// The surface with one inner knot in u moved a little.
struct Changed {
    surface: Surface<DVec3>,
    /// Where this changes something.
    support: (f64, f64),
}

impl Changed {
    fn all(surface: &Surface<DVec3>) -> Result<Vec<Self>, NurbsError> {
        let knots = surface.knots_u();
        let changed = |k: usize| {
            let mut values = knots.values().to_vec();
            let support = (values[k - knots.degree()], values[k + knots.degree()]);
            values[k] += STEP;
            let moved = Knots::new(knots.degree(), values)?;
            let surface = Surface::new(moved, surface.knots_v().clone(), surface.points().to_vec())?;
            Ok(Self { surface, support })
        };
        inner(knots).map(changed).collect()
    }

    fn concerns(&self, foot: &Foot) -> bool {
        self.support.0 <= foot.s && foot.s <= self.support.1
    }
}
