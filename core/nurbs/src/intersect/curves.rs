//! Where two plane curves meet.
//!
//! Recursive subdivision (thesis 2.3.3) with enclosures in place of chords, so that nothing is missed: pairs of pieces
//! whose control polygons are separate are dropped; pairs whose tangents cannot be parallel meet at most once, and
//! Newton's method decides; pairs that may touch are cut where their tangents are parallel, after Newton's method on
//! that condition. What remains is halved.

use super::piece::{Piece, Source, may_be_parallel};
use crate::curve::ParametricCurve;
use crate::edit::BezierCurve;
use crate::error::NurbsError;
use glam::{DMat2, DVec2};

/// Curves closer than this touch.
pub const TOUCH: f64 = 1e-10;
/// Rest of Newton's method on crossings, relative to the size of the coordinates: a few roundings.
const RESIDUAL: f64 = 1e-12;
/// Pieces shorter than this part of the size are not halved further: between them curves cannot part and meet again
/// by more than touching.
const SMALLEST: f64 = 1e-6;
/// Pairs examined before the search is given up.
const BUDGET: usize = 400_000;
/// Sine of the angle below which tangents count as parallel.
const PARALLEL: f64 = 1e-6;
const NEWTON: usize = 30;

/// A point where two curves meet, or a curve meets itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Parameter on the first curve.
    pub s: f64,
    /// Parameter on the second curve.
    pub t: f64,
    /// The point, half way between the two.
    pub point: DVec2,
    /// Whether the tangents are parallel there, within 1e-6: the curves may touch or cross.
    pub tangential: bool,
}

/// All points where two B-splines (rational or not) meet, in the order of parameters on the first: crossings,
/// touching points and ends that lie on the other curve.
///
/// Crossings are exact to 1e-12 of the size of the coordinates; curves or ends within [`TOUCH`] count as touching.
/// Points between which the curves stay that close count as one. The enclosures are rigorous, nothing else is missed.
/// A curve closed at its seam reports a point there for both parameters.
///
/// # Errors
/// [`NurbsError::Coincident`] where the curves run together, [`NurbsError::NoConvergence`] if 400 000 pairs of pieces do
/// not settle it.
pub fn intersect_curves<A, B>(a: &A, b: &B) -> Result<Vec<Crossing>, NurbsError>
where
    A: BezierCurve<Space = DVec2>,
    B: BezierCurve<Space = DVec2>,
{
    crossings(&Source::exact(a), &Source::exact(b))
}

/// All points where two curves of any kind meet, such as offsets: [`intersect_curves`] with enclosures that are
/// estimated from samples. Curves must be smooth between their breaks, and not wiggle within an eighth of the
/// interval between two.
///
/// # Errors
/// As [`intersect_curves`].
pub fn intersect_parametric(
    a: &dyn ParametricCurve<DVec2>,
    b: &dyn ParametricCurve<DVec2>,
) -> Result<Vec<Crossing>, NurbsError> {
    crossings(&Source::adaptive(a), &Source::adaptive(b))
}

pub(crate) fn crossings(a: &Source<'_>, b: &Source<'_>) -> Result<Vec<Crossing>, NurbsError> {
    let mut search = Search::new(a, b);
    for p in &a.pieces {
        for q in &b.pieces {
            search.stack.push((p.clone(), q.clone()));
            search.run()?;
        }
    }
    Ok(search.merged())
}

/// Pairs of pieces still to be examined, and what was found.
pub(super) struct Search<'a> {
    a: &'a Source<'a>,
    b: &'a Source<'a>,
    pub(super) stack: Vec<(Piece, Piece)>,
    pub(super) found: Vec<Crossing>,
    pub(super) scale: f64,
    left: usize,
}

impl<'a> Search<'a> {
    pub(super) fn new(a: &'a Source<'a>, b: &'a Source<'a>) -> Self {
        let scale = a.scale.max(b.scale);
        Self { a, b, stack: vec![], found: vec![], scale, left: BUDGET }
    }

    /// Examines pairs until none is left.
    pub(super) fn run(&mut self) -> Result<(), NurbsError> {
        while let Some((p, q)) = self.stack.pop() {
            if p.separate(&q, TOUCH) {
                continue;
            }
            self.left = self.left.checked_sub(1).ok_or(NurbsError::NoConvergence {
                what: "separation of two curves",
                residual: p.length().max(q.length()),
            })?;
            let small = p.length().max(q.length()) <= SMALLEST * self.scale;
            match (p.directions(), q.directions()) {
                (Some(x), Some(y)) if !may_be_parallel(x, y) => {
                    if let Some(crossing) = self.cross(&p, &q) {
                        self.found.push(crossing);
                        continue;
                    }
                }
                (Some(_), Some(_)) if !small && p.turn() < 0.3 && q.turn() < 0.3 => {
                    self.check_coincidence(&p, &q)?;
                    if self.touch(&p, &q) {
                        continue;
                    }
                }
                _ => {}
            }
            self.halve(p, q);
        }
        Ok(())
    }

    /// Halves the longer piece, or records a contact of pieces that are too small for that.
    fn halve(&mut self, p: Piece, q: Piece) {
        let (x, y) = (p.length(), q.length());
        let middle = |p: &Piece| 0.5 * (p.a + p.b);
        let inside = |p: &Piece| middle(p) > p.a && middle(p) < p.b;
        if x.max(y) <= SMALLEST * self.scale || !inside(&p) || !inside(&q) {
            if let Some(contact) = self.contact(&p, &q) {
                self.found.push(contact);
            }
        } else if x >= y {
            let halves = self.a.split(&p, middle(&p));
            self.stack.extend(halves.map(|h| (h, q.clone())));
        } else {
            let halves = self.b.split(&q, middle(&q));
            self.stack.extend(halves.map(|h| (p.clone(), h)));
        }
    }

    /// The crossing of two pieces without parallel tangents, by Newton's method held inside them.
    fn cross(&self, p: &Piece, q: &Piece) -> Option<Crossing> {
        let mut s = 0.5 * (p.a + p.b);
        let mut t = 0.5 * (q.a + q.b);
        let mut best: Option<(f64, f64, f64)> = None;
        for _ in 0..NEWTON {
            let (x, y) = (self.a.at(s, p.a, p.b), self.b.at(t, q.a, q.b));
            let miss = y[0] - x[0];
            let rest = miss.length();
            if best.is_none_or(|b| rest < b.0) {
                best = Some((rest, s, t));
            } else if rest <= RESIDUAL * self.scale {
                break;
            }
            let step = DMat2::from_cols(x[1], -y[1]).inverse() * miss;
            if !step.is_finite() {
                break;
            }
            (s, t) = ((s + step.x).clamp(p.a, p.b), (t + step.y).clamp(q.a, q.b));
        }
        let (rest, s, t) = best?;
        // Ends that touch may miss by more than a crossing inside.
        let at_end = s == p.a || s == p.b || t == q.a || t == q.b;
        let enough = if at_end { TOUCH.max(RESIDUAL * self.scale) } else { RESIDUAL * self.scale };
        let (x, y) = (self.a.at(s, p.a, p.b)[1], self.b.at(t, q.a, q.b)[1]);
        let parallel = x.perp_dot(y).abs() <= PARALLEL * x.length() * y.length();
        (rest <= enough).then(|| self.crossing(s, t, parallel))
    }

    fn crossing(&self, s: f64, t: f64, tangential: bool) -> Crossing {
        Crossing { s, t, point: (self.a.point(s) + self.b.point(t)) * 0.5, tangential }
    }

    /// Looks for parallel tangents of two almost straight pieces. If there is one, the pair is replaced by the pairs of
    /// parts before and after it, and a contact there is recorded and cut out.
    fn touch(&mut self, p: &Piece, q: &Piece) -> bool {
        let Some((s, t, bend)) = self.parallel(p, q) else { return false };
        let (x, y) = (self.a.at(s, p.a, p.b), self.b.at(t, q.a, q.b));
        let gap = x[0].distance(y[0]);
        let mut margin = [0.0, 0.0];
        if gap <= TOUCH {
            self.found.push(self.crossing(s, t, true));
            // Beyond this the curves are a hundred times farther apart than what counts as touching.
            let length = (200.0 * TOUCH / bend).sqrt();
            margin = [length / x[1].length(), length / y[1].length()];
        } else if s - p.a < 0.01 * (p.b - p.a) || p.b - s < 0.01 * (p.b - p.a) {
            // A cut near an end would not make the pieces smaller.
            return false;
        }
        let cut = |source: &Source<'_>, piece: &Piece, at: f64, margin: f64| {
            [source.part(piece, piece.a, at - margin), source.part(piece, at + margin, piece.b)]
        };
        let others = cut(self.b, q, t, margin[1]);
        for part in cut(self.a, p, s, margin[0]).into_iter().flatten() {
            let pairs = others.iter().flatten().map(|o| (part.clone(), o.clone()));
            self.stack.extend(pairs);
        }
        true
    }

    /// Parameters of parallel tangents that face each other, and the difference of curvatures there, by Newton's
    /// method on `(A - B) . B' = 0`, `A' x B' = 0`; none if it leaves the pieces.
    fn parallel(&self, p: &Piece, q: &Piece) -> Option<(f64, f64, f64)> {
        let mut s = 0.5 * (p.a + p.b);
        let mut t = 0.5 * (q.a + q.b);
        for _ in 0..NEWTON {
            let (x, y) = (self.a.at(s, p.a, p.b), self.b.at(t, q.a, q.b));
            let off = x[0] - y[0];
            let value = DVec2::new(off.dot(y[1]), x[1].perp_dot(y[1]));
            let jacobian = DMat2::from_cols(
                DVec2::new(x[1].dot(y[1]), x[2].perp_dot(y[1])),
                DVec2::new(off.dot(y[2]) - y[1].length_squared(), x[1].perp_dot(y[2])),
            );
            let step = jacobian.inverse() * value;
            if !step.is_finite() {
                return None;
            }
            let next = (s - step.x, t - step.y);
            // Half a piece beyond its ends is not on the way to something inside.
            let (reach, range) = (0.5 * (p.b - p.a), 0.5 * (q.b - q.a));
            if next.0 < p.a - reach || next.0 > p.b + reach || next.1 < q.a - range || next.1 > q.b + range {
                return None;
            }
            let settled = step.x.abs() <= 1e-12 * (p.b - p.a) && step.y.abs() <= 1e-12 * (q.b - q.a);
            (s, t) = (next.0.clamp(p.a, p.b), next.1.clamp(q.a, q.b));
            if settled {
                if (s, t) != next {
                    return None;
                }
                let curvature = |d: [DVec2; 3]| d[1].perp_dot(d[2]) / d[1].length().powi(3);
                let sense = x[1].dot(y[1]).signum();
                let bend = (curvature(x) - sense * curvature(y)).abs();
                // Curves of the same curvature need another way.
                return (bend * p.length().max(q.length()) > 1e-6).then_some((s, t, bend));
            }
        }
        None
    }

    /// Tells curves that run together from curves that touch.
    fn check_coincidence(&self, p: &Piece, q: &Piece) -> Result<(), NurbsError> {
        // The part of p that faces q, if any of a length that a touching point cannot have.
        if p.length() < 1e-2 * self.scale || q.length() < 1e-2 * self.scale {
            return Ok(());
        }
        let mut together: Option<(f64, f64)> = None;
        let mut count = 0;
        for k in 0..=8 {
            let s = p.a + (p.b - p.a) * f64::from(k) / 8.0;
            let point = self.a.point(s);
            let hint = q.a + (q.b - q.a) * f64::from(k) / 8.0;
            if self.foot(point, hint, (q.a, q.b)) <= TOUCH {
                count += 1;
                together = Some((together.map_or(s, |t| t.0), s));
            }
        }
        match together {
            Some((from, to)) if count >= 5 => Err(NurbsError::Coincident { from, to }),
            _ => Ok(()),
        }
    }

    /// Distance of a point to the second curve on an almost straight part of it: Newton's method from a start value.
    fn foot(&self, point: DVec2, hint: f64, (low, high): (f64, f64)) -> f64 {
        let mut t = hint;
        for _ in 0..NEWTON {
            let [b, d, dd] = self.b.at(t, low, high);
            let miss = point - b;
            let bend = d.length_squared() - miss.dot(dd);
            let step = miss.dot(d) / if bend > 0.5 * d.length_squared() { bend } else { d.length_squared() };
            let next = (t + step).clamp(low, high);
            if !next.is_finite() || next == t {
                break;
            }
            t = next;
        }
        self.b.at(t, low, high)[0].distance(point)
    }

    /// A contact of two tiny pieces: their nearest points, by Gauss-Newton on the distance.
    fn contact(&self, p: &Piece, q: &Piece) -> Option<Crossing> {
        let (mut s, mut t) = (0.5 * (p.a + p.b), 0.5 * (q.a + q.b));
        for _ in 0..NEWTON {
            let (x, y) = (self.a.at(s, p.a, p.b), self.b.at(t, q.a, q.b));
            let miss = y[0] - x[0];
            // Alternating feet: one on the other's tangent, held inside.
            let next = (s + miss.dot(x[1]) / x[1].length_squared()).clamp(p.a, p.b);
            if !next.is_finite() {
                break;
            }
            s = next;
            let x = self.a.at(s, p.a, p.b);
            let foot = (t + (x[0] - y[0]).dot(y[1]) / y[1].length_squared()).clamp(q.a, q.b);
            if !foot.is_finite() {
                break;
            }
            t = foot;
        }
        (self.a.point(s).distance(self.b.point(t)) <= TOUCH).then(|| self.crossing(s, t, true))
    }

    /// What was found, in order, each point once: points between which the curves do not part are one.
    pub(super) fn merged(mut self) -> Vec<Crossing> {
        let mut found = std::mem::take(&mut self.found);
        found.sort_by(|a, b| a.s.total_cmp(&b.s).then(a.t.total_cmp(&b.t)));
        let mut kept: Vec<Crossing> = Vec::with_capacity(found.len());
        for c in found {
            match kept.iter_mut().rev().find(|k| self.together(k, &c)) {
                // A crossing says more than a contact.
                Some(k) if k.tangential && !c.tangential => *k = c,
                Some(_) => {}
                None => kept.push(c),
            }
        }
        kept
    }

    /// Whether the curves stay within [`TOUCH`] of each other between two points, sampled.
    fn together(&self, k: &Crossing, c: &Crossing) -> bool {
        let between = |x: f64| {
            let (s, t) = (k.s + x * (c.s - k.s), k.t + x * (c.t - k.t));
            self.foot(self.a.point(s), t, (k.t.min(c.t), k.t.max(c.t))) <= TOUCH
        };
        k.point.distance(c.point) <= 1e-2 * self.scale && [0.5, 0.25, 0.75].into_iter().all(between)
    }
}
