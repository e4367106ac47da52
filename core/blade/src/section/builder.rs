//! Outlines from rings of points: curves through chains of points, cut into regions.

use super::chain::{self, Chain, End};
use super::joint::tangent_joint;
use super::noses::Nose;
use super::outline::{Outline, Piece, Shape};
use super::ring::Ring;
use crate::blade::Region;
use coolinggen_nurbs::NurbsError;
use glam::DVec2;
use std::f64::consts::TAU;
use std::rc::Rc;

/// A nose without breaks reaches to where the outline has turned by this from its tip, radians.
const NOSE_TURN: f64 = 1.1;

/// See [`Outline::new`].
pub(super) fn outline(
    ring: &Ring,
    leading: &Nose,
    trailing: &Nose,
    slack: f64,
) -> Result<Outline, NurbsError> {
    let sense = if ring.area() < 0.0 { -1.0 } else { 1.0 };
    let mut builder = Builder { ring, sense, slack, pieces: Vec::new(), on: vec![(0, 0.0); ring.len()] };
    builder.build(leading, trailing)?;
    Ok(builder.finish())
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
            let (Nose::Smooth { tip: a }, Nose::Smooth { tip: b }) = (leading, trailing) else {
                return Ok(());
            };
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
        let chain = chain::closed(&points, self.slack)?;
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
        let chain = chain::open(&points, start.end, end.end, self.slack)?;
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
