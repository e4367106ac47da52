//! Offsets without self-intersections.
//!
//! The raw offset is cut wherever it meets itself; what is closer to the curve than the distance is dropped (thesis
//! 2.3.4 drops what lies between the parameters of a self-intersection, which is right for simple cases only); the rest
//! joins into loops. Parts that run back beyond the centre of curvature are dropped from the start, so that swallowtails
//! have no cusps to get caught on.

use super::curve::OffsetCurve;
use super::raw::{Element, Raw};
use crate::conic::arc_points;
use crate::curve::{Curve, ParametricCurve, RationalCurve};
use crate::edit::BezierCurve;
use crate::error::NurbsError;
use crate::fit::fit_function;
use crate::intersect::{Source, crossings_with, own_crossings};
use crate::query::CurveProjector;
use glam::DVec2;
use std::f64::consts::TAU;

/// How far the distance of a trimmed offset from its curve may be from the distance asked for, relative to the size of
/// the coordinates.
const EXACT: f64 = 1e-9;
/// Points at which every span of the result is verified.
const CHECKS: usize = 16;

/// One span of a trimmed offset.
#[derive(Clone, Debug, PartialEq)]
pub enum OffsetSpan {
    /// The offset of the curve from one parameter to another.
    Along {
        /// First parameter.
        from: f64,
        /// Last parameter, greater than the first.
        to: f64,
        /// The offset as a cubic B-spline on the same parameters, within the tolerance asked for.
        fitted: Curve<DVec2>,
    },
    /// The arc around a kink of the curve.
    Around {
        /// Parameter of the kink.
        t: f64,
        /// The kink.
        corner: DVec2,
        /// The arc, exact.
        arc: RationalCurve<DVec2>,
        /// The arc as a cubic B-spline on [0, 1], within the tolerance asked for.
        fitted: Curve<DVec2>,
    },
}

impl OffsetSpan {
    /// The B-spline of the span.
    pub fn fitted(&self) -> &Curve<DVec2> {
        match self {
            Self::Along { fitted, .. } | Self::Around { fitted, .. } => fitted,
        }
    }
}

/// A connected piece of a trimmed offset: spans in order, each starting where the one before ends.
#[derive(Clone, Debug, PartialEq)]
pub struct OffsetPiece {
    /// Whether the last span ends where the first one starts.
    pub closed: bool,
    /// The spans, in the direction of the curve.
    pub spans: Vec<OffsetSpan>,
}

/// The points at exactly `distance` from a plane curve on its left (negative: right) side: the offset without the
/// parts that come closer to the curve elsewhere. A closed curve gives closed pieces, several or none; an open one open
/// pieces, without caps around its ends. Kinks get arcs on their outer side.
///
/// Every span is verified at 17 points against the closest point on the curve: the distance is right within 1e-9 of the
/// size of the coordinates. Spans meet within the same. `tolerance` is that of the B-splines that come with the spans.
/// With `closed` the curve must end where it starts. The side left of a counterclockwise curve is its inside.
///
/// # Errors
/// [`NurbsError::BadArgument`] for a distance of zero or not finite, or where the speed of the curve vanishes;
/// [`NurbsError::NotJoined`] for a curve that is not closed as said; [`NurbsError::Coincident`] where the offset runs
/// along itself, as in the middle between parallel sides; [`NurbsError::NoConvergence`] if the result cannot be
/// verified.
pub fn trimmed_offset<C: BezierCurve<Space = DVec2>>(
    curve: &C,
    closed: bool,
    distance: f64,
    tolerance: f64,
) -> Result<Vec<OffsetPiece>, NurbsError> {
    if distance == 0.0 || !distance.is_finite() {
        return Err(NurbsError::BadArgument { what: "distance of an offset", value: distance });
    }
    let (start, end) = curve.domain();
    let gap = curve.point(start).distance(curve.point(end));
    let projector = CurveProjector::new(curve, closed);
    let (centre, radius) = projector.bounding_sphere();
    let scale = centre.length() + radius + distance.abs();
    if closed && !(gap <= EXACT * scale) {
        return Err(NurbsError::NotJoined { index: 0, gap });
    }
    check_speed(curve)?;
    let offset = OffsetCurve::new(curve, distance);
    let raw = Raw::new(&offset, distance, closed);
    if raw.elements.is_empty() {
        return Ok(vec![]);
    }
    let cuts = cuts(&raw, curve, closed)?;
    let trim = Trim { raw: &raw, projector: &projector, exact: EXACT * scale, tolerance };
    trim.pieces(&cuts, closed)
}

fn check_speed(curve: &impl ParametricCurve<DVec2>) -> Result<(), NurbsError> {
    for span in curve.breaks().windows(2) {
        for k in 0..=8 {
            let t =
                if k == 8 { span[1].next_down() } else { span[0] + (span[1] - span[0]) * f64::from(k) / 8.0 };
            let speed = curve.derivatives(t)[1].length() * (span[1] - span[0]);
            if !(speed > 0.0) {
                return Err(NurbsError::BadArgument { what: "speed of a curve to offset", value: speed });
            }
        }
    }
    Ok(())
}

/// Parameters of the raw offset where its distance to the curve may change sides, in order: where it meets itself, and
/// for open curves also where it meets the offset on the other side and the circles around ends and kinks.
fn cuts<C: BezierCurve<Space = DVec2>>(
    raw: &Raw<'_, C>,
    curve: &C,
    closed: bool,
) -> Result<Vec<f64>, NurbsError> {
    let source = Source::adaptive_on(raw, &raw.intervals());
    // Swallowtails may be small; their cusps are cut off.
    let own = own_crossings(&source, 0.0)?;
    let mut cuts: Vec<f64> = own.iter().flat_map(|c| [c.s, c.t]).collect();
    if !closed {
        let other = OffsetCurve::new(curve, -raw.distance);
        let other = Raw::new(&other, -raw.distance, false);
        let mut meet = |target: &Source<'_>| -> Result<(), NurbsError> {
            cuts.extend(crossings_with(&source, target)?.iter().map(|c| c.s));
            Ok(())
        };
        meet(&Source::adaptive_on(&other, &other.intervals()))?;
        let radius = raw.distance.abs();
        let (start, end) = curve.domain();
        for t in [start, end] {
            let centre = curve.point(t);
            let circle = RationalCurve::arc(centre, DVec2::X * radius, DVec2::Y * radius, 0.1, TAU)?;
            meet(&Source::exact(&circle))?;
        }
    }
    cuts.sort_by(f64::total_cmp);
    Ok(cuts)
}

/// A valid part of the raw offset between two cuts, within one element.
#[derive(Clone, Copy, Debug)]
struct Arc {
    element: usize,
    /// Parameters within the element.
    from: f64,
    to: f64,
    start: DVec2,
    end: DVec2,
}

struct Trim<'a, C: BezierCurve<Space = DVec2>> {
    raw: &'a Raw<'a, C>,
    projector: &'a CurveProjector<&'a C>,
    exact: f64,
    tolerance: f64,
}

impl<C: BezierCurve<Space = DVec2>> Trim<'_, C> {
    /// By how much a point of an element is closer to the curve than it should be.
    fn deficit(&self, element: usize, x: f64) -> Result<f64, NurbsError> {
        let point = self.raw.at(element, x)[0];
        Ok(self.raw.distance.abs() - self.projector.closest(point)?.distance)
    }

    fn pieces(&self, cuts: &[f64], closed: bool) -> Result<Vec<OffsetPiece>, NurbsError> {
        let arcs = self.valid_arcs(cuts)?;
        let chains = self.chains(&arcs, closed)?;
        let mut pieces = Vec::with_capacity(chains.len());
        for (chain, closed) in chains {
            let spans = self.spans(&arcs, &chain, closed)?;
            pieces.push(OffsetPiece { closed, spans });
        }
        Ok(pieces)
    }

    fn valid_arcs(&self, cuts: &[f64]) -> Result<Vec<Arc>, NurbsError> {
        let mut arcs = vec![];
        for element in 0..self.raw.elements.len() {
            let place = self.raw.places[element];
            let mut ends = vec![0.0];
            ends.extend(cuts.iter().map(|c| c - place).filter(|x| *x > 1e-14 && *x < 1.0 - 1e-14));
            ends.push(1.0);
            ends.dedup();
            for w in ends.windows(2) {
                if self.deficit(element, 0.5 * (w[0] + w[1]))? <= self.exact {
                    let [start, end] = [w[0], w[1]].map(|x| self.raw.at(element, x)[0]);
                    arcs.push(Arc { element, from: w[0], to: w[1], start, end });
                }
            }
        }
        Ok(arcs)
    }

    /// Joins arcs end to start: first those that follow each other on the raw offset, then those that meet at a
    /// crossing.
    fn chains(&self, arcs: &[Arc], closed: bool) -> Result<Vec<(Vec<usize>, bool)>, NurbsError> {
        let n = arcs.len();
        let mut next: Vec<Option<usize>> = vec![None; n];
        let mut taken = vec![false; n];
        let last = self.raw.places[self.raw.places.len() - 1] + 1.0;
        let place = |a: &Arc, x: f64| self.raw.places[a.element] + x;
        for i in 0..n {
            let end = place(&arcs[i], arcs[i].to);
            let follows = |b: &Arc| {
                let start = place(b, b.from);
                start == end || (closed && end == last && start == 0.0)
            };
            let near = |b: &Arc| b.start.distance(arcs[i].end) <= 10.0 * self.exact;
            if let Some(j) = (0..n).find(|&j| !taken[j] && follows(&arcs[j]) && near(&arcs[j])) {
                next[i] = Some(j);
                taken[j] = true;
            }
        }
        for i in 0..n {
            if next[i].is_none() {
                let distance = |&j: &usize| arcs[j].start.distance(arcs[i].end);
                let nearest =
                    (0..n).filter(|&j| !taken[j]).min_by(|a, b| distance(a).total_cmp(&distance(b)));
                if let Some(j) = nearest.filter(|j| distance(j) <= 100.0 * self.exact) {
                    next[i] = Some(j);
                    taken[j] = true;
                } else if closed {
                    let residual = nearest.map_or(f64::INFINITY, |j| distance(&j));
                    let what = "joining of a trimmed offset";
                    return Err(NurbsError::NoConvergence { what, residual });
                }
            }
        }
        // Open chains start at arcs that follow nothing; what remains are loops.
        let mut used = vec![false; n];
        let mut chains = vec![];
        let heads = (0..n).filter(|&i| !taken[i]).chain(0..n);
        for head in heads {
            if used[head] {
                continue;
            }
            let mut chain = vec![];
            let mut at = Some(head);
            while let Some(i) = at.filter(|&i| !used[i]) {
                used[i] = true;
                chain.push(i);
                at = next[i];
            }
            chains.push((chain, at == Some(head)));
        }
        Ok(chains)
    }

    /// Spans of a chain: neighbouring arcs of one smooth run of the curve become one.
    fn spans(&self, arcs: &[Arc], chain: &[usize], closed: bool) -> Result<Vec<OffsetSpan>, NurbsError> {
        let mut runs: Vec<Run> = vec![];
        for &i in chain {
            let run = self.run(&arcs[i]);
            match runs.last_mut() {
                Some(last) if last.continues_with(&run) => last.to = run.to,
                _ => runs.push(run),
            }
        }
        // A loop may have been entered in the middle of a run.
        if closed && runs.len() > 1 && runs[runs.len() - 1].continues_with(&runs[0]) {
            let first = runs.remove(0);
            if let Some(last) = runs.last_mut() {
                last.to = first.to;
            }
        }
        runs.iter().filter(|r| r.to > r.from).map(|r| self.span(r)).collect()
    }

    fn run(&self, arc: &Arc) -> Run {
        match self.raw.elements[arc.element] {
            Element::Along { from, to } => {
                let at = |x: f64| if x == 1.0 { to } else { from + (to - from) * x };
                Run { corner: None, from: at(arc.from), to: at(arc.to) }
            }
            Element::Around { .. } => Run { corner: Some(arc.element), from: arc.from, to: arc.to },
        }
    }

    fn span(&self, run: &Run) -> Result<OffsetSpan, NurbsError> {
        let (from, to) = (run.from, run.to);
        for k in 0..=CHECKS {
            let x = from + (to - from) * k as f64 / CHECKS as f64;
            let point = match run.corner {
                Some(element) => self.raw.at(element, x)[0],
                None => self.raw.offset.point(if k == CHECKS { to.next_down() } else { x }),
            };
            let residual = (self.projector.closest(point)?.distance - self.raw.distance.abs()).abs();
            if !(residual <= self.exact) {
                let what = "distance of a trimmed offset from its curve";
                return Err(NurbsError::NoConvergence { what, residual });
            }
        }
        if let Some((element, Element::Around { t, corner, start, sweep })) =
            run.corner.map(|e| (e, self.raw.elements[e]))
        {
            let radius = self.raw.distance.abs();
            let (first, turn) = (start + sweep * from, sweep * (to - from));
            let arc = RationalCurve::arc(corner, DVec2::X * radius, DVec2::Y * radius, first, turn)?;
            let f = |x: f64| {
                let [p, d, _] = self.raw.at(element, from + (to - from) * x);
                [p, d * (to - from)]
            };
            let fitted = fit_function(f, &arc_points(turn), self.tolerance)?.curve;
            return Ok(OffsetSpan::Around { t, corner, arc, fitted });
        }
        let mut breaks = vec![from];
        breaks.extend(self.raw.offset.breaks().into_iter().filter(|b| *b > from && *b < to));
        breaks.push(to);
        let f = |t: f64| {
            let [p, d, _] = self.raw.offset.derivatives(if t >= to { to.next_down() } else { t });
            [p, d]
        };
        let fitted = fit_function(f, &breaks, self.tolerance)?.curve;
        Ok(OffsetSpan::Along { from, to, fitted })
    }
}

/// A part of the result in the parameters of the curve, or of the arc around a corner.
#[derive(Clone, Copy, Debug)]
struct Run {
    corner: Option<usize>,
    from: f64,
    to: f64,
}

impl Run {
    fn continues_with(&self, next: &Self) -> bool {
        self.corner == next.corner && self.to == next.from
    }
}
