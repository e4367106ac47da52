//! Outlines: closed curves made of one smooth piece a region.

use super::chain::{self, Chain, End};
use super::circle::Circle;
use super::joint::tangent_joint;
use super::noses::Nose;
use super::ring::Ring;
use crate::blade::Region;
use crate::stream::measure::Measure;
use coolinggen_nurbs::{Curve, NurbsError, ParametricCurve};
use glam::DVec2;
use std::f64::consts::TAU;
use std::rc::Rc;

/// A nose without breaks reaches to where the outline has turned by this from its tip, radians.
const NOSE_TURN: f64 = 1.1;
/// Accuracy of arc lengths, mm: they only say how fast u runs.
const ARC_ACCURACY: f64 = 1e-8;

/// The curve under a piece.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// Parameter = angle from +x.
    Arc(Circle),
    Spline(Rc<Curve<DVec2>>),
    /// A closed spline, continued around its period.
    Closed(Rc<Curve<DVec2>>),
}

/// A smooth piece of an outline, by arc length.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub(crate) region: Region,
    shape: Shape,
    /// Parameters of its ends; an arc may run backwards.
    range: [f64; 2],
    /// Arc length over the fraction of the range.
    measure: Measure,
}

/// The pieces of one section in the order leading edge, suction side, trailing edge (not if sharp), pressure side.
#[derive(Clone, Debug)]
pub(crate) struct Outline {
    pub(crate) pieces: Vec<Piece>,
    /// For every point of the ring: arc length from the start of the leading edge.
    pub(crate) places: Vec<f64>,
}

impl Shape {
    /// Point, first and second derivative.
    fn at(&self, t: f64) -> [DVec2; 3] {
        match self {
            Self::Arc(circle) => {
                let e = DVec2::from_angle(t) * circle.radius;
                [circle.center + e, e.perp(), -e]
            }
            Self::Spline(curve) => curve.derivatives(t),
            Self::Closed(curve) => {
                let (start, end) = curve.domain();
                curve.derivatives(start + (t - start).rem_euclid(end - start))
            }
        }
    }

    fn breaks_between(&self, a: f64, b: f64) -> Vec<f64> {
        let inner: Vec<f64> = match self {
            Self::Arc(_) => Vec::new(),
            Self::Spline(curve) => curve.breaks(),
            Self::Closed(curve) => {
                let (start, end) = curve.domain();
                let shifts = [-1.0, 0.0, 1.0].map(|k| k * (end - start));
                shifts.iter().flat_map(|k| curve.breaks().into_iter().map(move |t| t + k)).collect()
            }
        };
        let tiny = 1e-9 * (b - a).abs();
        let mut breaks = vec![a];
        breaks.extend(inner.into_iter().filter(|&t| t > a + tiny && t < b - tiny));
        breaks.push(b);
        breaks.dedup_by(|x, y| *x - *y <= tiny);
        breaks
    }
}

impl Piece {
    pub(crate) fn new(region: Region, shape: Shape, range: [f64; 2]) -> Self {
        let [a, b] = range;
        let fractions: Vec<f64> = match &shape {
            Shape::Arc(_) => vec![0.0, 1.0],
            _ => shape.breaks_between(a, b).into_iter().map(|t| (t - a) / (b - a)).collect(),
        };
        let width = b - a;
        let measure = Measure::new(&fractions, ARC_ACCURACY, |f| {
            let [_, d, dd] = shape.at(a + width * f);
            let speed = d.length();
            (speed * width.abs(), d.dot(dd) / speed * width * width.abs())
        });
        Self { region, shape, range, measure }
    }

    /// Arc length, mm.
    pub(crate) fn length(&self) -> f64 {
        self.measure.total()
    }

    /// Point and unit tangent at arc length `s`, and the curvature, positive to the left.
    pub(crate) fn at(&self, s: f64) -> (DVec2, DVec2, f64) {
        let [a, b] = self.range;
        let [p, d, dd] = self.shape.at(a + (b - a) * self.measure.backward(s));
        let speed = d.length();
        let sense = if b < a { -1.0 } else { 1.0 };
        (p, d * (sense / speed), sense * d.perp_dot(dd) / (speed * speed * speed))
    }

    /// Fraction of the range at parameter `t` of the shape, not clamped; around the period where closed.
    fn fraction(&self, t: f64) -> f64 {
        let [a, b] = self.range;
        let t = match &self.shape {
            Shape::Closed(curve) => {
                let (start, end) = curve.domain();
                let period = end - start;
                // The representative nearest to the middle of the piece.
                t + period * ((0.5 * (a + b) - t) / period).round()
            }
            _ => t,
        };
        (t - a) / (b - a)
    }

    /// How far outside of the piece parameter `t` lies, 0 inside.
    fn outside(&self, t: f64) -> f64 {
        let f = self.fraction(t);
        (f - f.clamp(0.0, 1.0)).abs() * self.length()
    }

    /// Arc length at parameter `t` of the shape.
    fn place(&self, t: f64) -> f64 {
        self.measure.forward(self.fraction(t).clamp(0.0, 1.0))
    }
}

/// An arc of a circle between two angles, radians; it runs clockwise if they decrease.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArcSpan {
    pub(crate) circle: Circle,
    pub(crate) ends: [f64; 2],
}

impl ArcSpan {
    /// End condition where the arc begins (0) or ends (1).
    fn tangent(&self, end: usize) -> End {
        let sense = (self.ends[1] - self.ends[0]).signum();
        End::Tangent(DVec2::from_angle(self.ends[end]).perp() * sense)
    }

    fn piece(&self, region: Region) -> Piece {
        Piece::new(region, Shape::Arc(self.circle), self.ends)
    }
}

impl Outline {
    /// The outline of two arcs with sides drawn through points, ends included, tangent to the arcs.
    pub(crate) fn drawn(
        leading: &ArcSpan,
        suction: &[DVec2],
        trailing: &ArcSpan,
        pressure: &[DVec2],
    ) -> Result<Self, NurbsError> {
        let side = |region: Region, points: &[DVec2], before: &ArcSpan, after: &ArcSpan| {
            let chain = chain::open(points, before.tangent(1), after.tangent(0))?;
            let ends = [chain.parameters[0], chain.parameters[chain.parameters.len() - 1]];
            Ok(Piece::new(region, Shape::Spline(Rc::new(chain.curve)), ends))
        };
        let pieces = vec![
            leading.piece(Region::LeadingEdge),
            side(Region::SuctionSide, suction, leading, trailing)?,
            trailing.piece(Region::TrailingEdge),
            side(Region::PressureSide, pressure, trailing, leading)?,
        ];
        Ok(Self { pieces, places: Vec::new() })
    }

    /// Arc length once around, mm.
    pub(crate) fn length(&self) -> f64 {
        self.pieces.iter().map(Piece::length).sum()
    }

    /// The outline of a ring that runs leading edge, suction side, trailing edge, pressure side, with the noses found.
    /// `slack` is how far in mm the curve may leave points at the ends of arcs.
    pub(crate) fn new(ring: &Ring, leading: &Nose, trailing: &Nose, slack: f64) -> Result<Self, NurbsError> {
        let sense = if ring.area() < 0.0 { -1.0 } else { 1.0 };
        let mut builder = Builder { ring, sense, slack, pieces: Vec::new(), on: vec![(0, 0.0); ring.len()] };
        builder.build(leading, trailing)?;
        Ok(builder.finish())
    }
}

struct Builder<'a> {
    ring: &'a Ring,
    /// +1 if the ring runs counterclockwise.
    sense: f64,
    slack: f64,
    /// Pieces with the number of the curve they are cut from.
    pieces: Vec<(usize, Piece)>,
    /// For every ring point its curve and parameter there.
    on: Vec<(usize, f64)>,
}

/// The end of a chain: a point with its end condition, and the ring position next to it inside the chain.
#[derive(Clone, Copy)]
struct Anchor {
    point: DVec2,
    end: End,
    inner: isize,
}

/// A nose at which the chain before ends and the chain after begins.
struct Break {
    before: Anchor,
    after: Anchor,
}

fn side_after(nose: Region) -> Region {
    if nose == Region::LeadingEdge { Region::SuctionSide } else { Region::PressureSide }
}

impl Builder<'_> {
    fn build(&mut self, leading: &Nose, trailing: &Nose) -> Result<(), NurbsError> {
        let noses = [(Region::LeadingEdge, leading), (Region::TrailingEdge, trailing)];
        let smooth = noses.iter().find_map(|(region, nose)| match nose {
            Nose::Smooth { tip } => Some((*region, *tip)),
            _ => None,
        });
        let mut breaks = Vec::new();
        for (curve, (region, nose)) in noses.into_iter().enumerate() {
            // Curves are numbered: noses 0 and 1, the chains after them 2 and 3.
            if let Some(b) = self.nose(curve, region, nose)? {
                breaks.push((region, b));
            }
        }
        if breaks.is_empty() {
            let (Nose::Smooth { tip: a }, Nose::Smooth { tip: b }) = (leading, trailing) else { return Ok(()) };
            return self.closed(*a, *b);
        }
        for k in 0..breaks.len() {
            let (region, start) = (breaks[k].0, breaks[k].1.after);
            let end = breaks[(k + 1) % breaks.len()].1.before;
            let chain = self.chain(2 + k, &start, &end)?;
            let (mut from, to) = (chain.parameters[0], chain.parameters[chain.parameters.len() - 1]);
            let shape = Shape::Spline(Rc::new(chain.curve));
            let mut side = side_after(region);
            if let Some((nose, tip)) = smooth {
                let [a, b] = self.smooth_nose(&shape, [from, to], self.on[tip].1);
                self.add(2 + k, side, &shape, [from, a]);
                self.add(2 + k, nose, &shape, [a, b]);
                (side, from) = (side_after(nose), b);
            }
            self.add(2 + k, side, &shape, [from, to]);
        }
        Ok(())
    }

    fn add(&mut self, curve: usize, region: Region, shape: &Shape, range: [f64; 2]) {
        self.pieces.push((curve, Piece::new(region, shape.clone(), range)));
    }

    /// Both noses smooth: one closed curve, its seam half way along the suction side.
    fn closed(&mut self, leading: usize, trailing: usize) -> Result<(), NurbsError> {
        let n = self.ring.len();
        let first = leading + (trailing + n - leading) % n / 2;
        let points: Vec<DVec2> = (0..n).map(|k| self.ring.points[(first + k) % n]).collect();
        let chain = chain::closed(&points)?;
        for k in 0..n {
            self.on[(first + k) % n] = (2, chain.parameters[k]);
        }
        let period = chain.parameters[n] - chain.parameters[0];
        let shape = Shape::Closed(Rc::new(chain.curve));
        let everywhere = [f64::NEG_INFINITY, f64::INFINITY];
        let [a0, a1] = self.smooth_nose(&shape, everywhere, self.on[leading].1);
        let [b0, b1] = self.smooth_nose(&shape, everywhere, self.on[trailing].1);
        // From the leading edge the trailing edge comes after the seam.
        self.add(2, Region::LeadingEdge, &shape, [a0, a1]);
        self.add(2, Region::SuctionSide, &shape, [a1, b0 + period]);
        self.add(2, Region::TrailingEdge, &shape, [b0 + period, b1 + period]);
        self.add(2, Region::PressureSide, &shape, [b1 + period, a0 + period]);
        Ok(())
    }

    /// Adds the piece of a nose that is one by itself, and says where the chains beside it end; none if smooth.
    fn nose(&mut self, curve: usize, region: Region, nose: &Nose) -> Result<Option<Break>, NurbsError> {
        let ring = self.ring;
        let n = ring.len() as isize;
        let free = |at: usize, step: isize| Anchor {
            point: ring.points[at],
            end: End::Free,
            inner: at as isize + step,
        };
        Ok(match nose {
            Nose::Smooth { .. } => None,
            Nose::Sharp { at } => {
                // The kink belongs to the chain after it.
                Some(Break { before: free(*at, -1), after: free(*at, 1) })
            }
            Nose::Blunt { first, last } => {
                let (before, after) = (free(*first, -1), free(*last, 1));
                let base = self.chain(curve, &free(*first, 1), &free(*last, -1))?;
                let ends = [base.parameters[0], base.parameters[base.parameters.len() - 1]];
                self.on[*first] = (curve, ends[0]);
                self.on[*last] = (curve, ends[1]);
                self.add(curve, region, &Shape::Spline(Rc::new(base.curve)), ends);
                Some(Break { before, after })
            }
            Nose::Arc { circle, first, last } => {
                let (first, last) = (*first as isize, *last as isize);
                let reach = n / 3;
                let ahead: Vec<DVec2> = (1..=reach).map(|k| self.ring.at(last + k)).collect();
                let behind: Vec<DVec2> = (1..=reach).map(|k| self.ring.at(first - k)).collect();
                let start = circle.angle(self.ring.at(first));
                let end = circle.angle(self.ring.at(last));
                let start = tangent_joint(circle, start, -self.sense, &behind, self.slack);
                let end = tangent_joint(circle, end, self.sense, &ahead, self.slack);
                let turned = ((end - start) * self.sense).rem_euclid(TAU);
                let end = start + self.sense * turned;
                self.add(curve, region, &Shape::Arc(*circle), [start, end]);
                for k in 0..=(last - first).rem_euclid(n) {
                    let i = self.ring.index(first + k);
                    let ahead = ((circle.angle(self.ring.points[i]) - start) * self.sense).rem_euclid(TAU);
                    // Points just before the start have turned nearly a full circle.
                    let ahead = if ahead > 0.5 * (turned + TAU) { 0.0 } else { ahead.min(turned) };
                    self.on[i] = (curve, start + self.sense * ahead);
                }
                let anchor = |angle: f64, inner: isize| Anchor {
                    point: circle.point(angle),
                    end: End::Tangent(DVec2::from_angle(angle).perp() * self.sense),
                    inner,
                };
                Some(Break { before: anchor(start, first - 1), after: anchor(end, last + 1) })
            }
        })
    }

    /// The curve from one anchor to another through the ring points between.
    fn chain(&mut self, curve: usize, start: &Anchor, end: &Anchor) -> Result<Chain, NurbsError> {
        let n = self.ring.len() as isize;
        let count = (end.inner - start.inner + 1).rem_euclid(n);
        let mut points = vec![start.point];
        points.extend((0..count).map(|k| self.ring.at(start.inner + k)));
        points.push(end.point);
        let chain = chain::open(&points, start.end, end.end)?;
        for k in 0..count {
            let i = self.ring.index(start.inner + k);
            self.on[i] = (curve, chain.parameters[k as usize + 1]);
        }
        if start.end == End::Free {
            self.on[self.ring.index(start.inner - 1)] = (curve, chain.parameters[0]);
        }
        Ok(chain)
    }

    /// The range of parameters around `tip` that makes the nose of a curve without breaks: to where it has turned by
    /// [`NOSE_TURN`] on either side of its most curved place, within `bounds`.
    fn smooth_nose(&self, shape: &Shape, bounds: [f64; 2], tip: f64) -> [f64; 2] {
        let curvature = |t: f64| {
            let [_, d, dd] = shape.at(t);
            (self.sense * d.perp_dot(dd) / d.length().powi(3)).max(0.0)
        };
        let least = 4.0 / self.ring.perimeter();
        // The centre of the curvature's peak depends smoothly on the data, unlike the most curved point.
        let window = 1.5 / curvature(tip).max(least);
        let (mut weight, mut centre) = (0.0, 0.0);
        for i in -40..=40 {
            let t = (tip + window * f64::from(i) / 40.0).max(bounds[0]).min(bounds[1]);
            let k = curvature(t).powi(4);
            weight += k;
            centre += k * t;
        }
        let centre = if weight > 0.0 { centre / weight } else { tip };
        let step = 0.02 / curvature(centre).max(least);
        let most = (0.1 * self.ring.perimeter() / step) as usize;
        let walk = |direction: f64| {
            let (mut t, mut turned) = (centre, 0.0);
            for _ in 0..most.max(10) {
                let next = t + direction * step;
                if next <= bounds[0] + step || next >= bounds[1] - step {
                    break;
                }
                let more = step * curvature(0.5 * (t + next));
                if turned + more >= NOSE_TURN {
                    return t + direction * step * (NOSE_TURN - turned) / more;
                }
                (t, turned) = (next, turned + more);
            }
            t
        };
        [walk(-1.0), walk(1.0)]
    }

    fn finish(mut self) -> Outline {
        // One piece a region, in the order of regions.
        self.pieces.sort_by_key(|(_, p)| p.region);
        let mut starts = vec![0.0];
        for (_, p) in &self.pieces {
            starts.push(starts[starts.len() - 1] + p.length());
        }
        let places = self.on.iter().map(|&(curve, t)| {
            let on = self.pieces.iter().enumerate().filter(|(_, (c, _))| *c == curve);
            let found = on.map(|(i, (_, p))| (p.outside(t), i)).min_by(|a, b| a.0.total_cmp(&b.0));
            found.map_or(0.0, |(_, i)| starts[i] + self.pieces[i].1.place(t))
        });
        let places = places.collect();
        Outline { pieces: self.pieces.into_iter().map(|(_, p)| p).collect(), places }
    }
}
