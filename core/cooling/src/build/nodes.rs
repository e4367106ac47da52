//! Nodes: the parameters at which a segment's curves are interpolated, the same in all its sections.

use super::chambers::RingSection;
use super::error::BuildError;
use crate::section::SEGMENTS;
use crate::turn::mirrored;
use coolinggen_nurbs::{Curve, Interpolator, NurbsError, ParametricCurve};
use glam::DVec3;

/// How far a section curve may lie from the exact one and from its stream surface between nodes, mm.
const SHAPE_TOLERANCE: f64 = 2e-7;
const EDGE_TOLERANCE: f64 = 1e-8;
/// Most spans of equal length.
const MOST_EQUAL_SPANS: usize = 128;
/// Spans at which to give up.
const MOST_SPANS: usize = 1000;

/// A segment of a section, run through either way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strand<'a> {
    pub(super) section: &'a RingSection<'a>,
    pub(super) segment: usize,
    pub(super) reversed: bool,
}

impl Strand<'_> {
    /// Point and derivative at `t`.
    fn evaluate(&self, t: f64) -> (DVec3, DVec3) {
        if self.reversed {
            let (point, slope) = self.section.evaluate(self.segment, 1.0 - t);
            (point, -slope)
        } else {
            self.section.evaluate(self.segment, t)
        }
    }
}

/// Increasing parameters in [0, 1] and the cubic interpolation over them.
#[derive(Clone, Debug)]
pub(super) struct Nodes {
    parameters: Vec<f64>,
    interpolator: Interpolator,
}

impl Nodes {
    fn new(parameters: Vec<f64>) -> Result<Self, BuildError> {
        let interpolator = Interpolator::with_slopes(&parameters)?;
        Ok(Self { parameters, interpolator })
    }

    fn equal(spans: usize) -> Result<Self, BuildError> {
        Self::new((0..=spans).map(|i| i as f64 / spans as f64).collect())
    }

    /// The nodes of the segment run through the other way.
    fn reversed(&self) -> Result<Self, BuildError> {
        Self::new(self.parameters.iter().rev().map(|t| 1.0 - t).collect())
    }

    /// The cubic through points of a strand, with its exact end slopes; `ends` replace its end points.
    pub(super) fn curve(
        &self,
        strand: &Strand<'_>,
        ends: Option<(DVec3, DVec3)>,
    ) -> Result<Curve<DVec3>, BuildError> {
        let mut points: Vec<DVec3> = self.parameters.iter().map(|&t| strand.evaluate(t).0).collect();
        if let Some((start, end)) = ends {
            let last = points.len() - 1;
            (points[0], points[last]) = (start, end);
        }
        let (start, end) = (strand.evaluate(0.0).1, strand.evaluate(1.0).1);
        Ok(self.interpolator.curve_with_slopes(&points, start, end)?)
    }

    /// Errors of the strands in the middle of each span, relative to the tolerances.
    fn errors(&self, strands: &[Strand<'_>]) -> Result<Vec<f64>, BuildError> {
        let mut worst = vec![0.0f64; self.parameters.len() - 1];
        for strand in strands {
            let curve = self.curve(strand, None)?;
            for (pair, worst) in self.parameters.windows(2).zip(&mut worst) {
                let t = 0.5 * (pair[0] + pair[1]);
                let (point, exact) = (curve.point(t), strand.evaluate(t).0);
                let (level, gradient) = strand.section.stream.level(point);
                let off = level.abs() / gradient.length();
                *worst = worst.max(point.distance(exact) / SHAPE_TOLERANCE).max(off / EDGE_TOLERANCE);
            }
        }
        Ok(worst)
    }

    /// The spans with an error above 1 cut into halves.
    fn refined(&self, errors: &[f64]) -> Result<Self, BuildError> {
        let mut parameters = vec![self.parameters[0]];
        for (pair, error) in self.parameters.windows(2).zip(errors) {
            if *error > 1.0 {
                parameters.push(0.5 * (pair[0] + pair[1]));
            }
            parameters.push(pair[1]);
        }
        Self::new(parameters)
    }

    /// As few spans as keep the strands within the tolerances. Equal spans while that is cheap: the error falls with
    /// the fourth power of the step, so two trials tell. Then halves where it misses, which is where the outline's third
    /// derivative jumps.
    fn of(strands: &[Strand<'_>]) -> Result<Self, BuildError> {
        let mut nodes = Self::equal(6)?;
        loop {
            let errors = nodes.errors(strands)?;
            let ratio = errors.iter().fold(0.0, |a: f64, b| a.max(*b));
            if ratio <= 1.0 {
                return Ok(nodes);
            }
            let spans = errors.len();
            let wanted = ((spans as f64 * 1.05 * ratio.powf(0.25)).ceil() as usize).max(spans + 1);
            nodes = if spans < MOST_EQUAL_SPANS {
                Self::equal(wanted.min(MOST_EQUAL_SPANS))?
            } else if spans < MOST_SPANS {
                nodes.refined(&errors)?
            } else {
                let what = "a cubic for a chamber's section within 1e-8 mm";
                return Err(NurbsError::NotFound { what }.into());
            };
        }
    }
}

/// Nodes of the eight segments of each chamber of one passage, which is given by the chambers' sections. Segments that a turn joins have the same nodes, so
/// that the turn's faces share the chambers' control points; the first, middle and last section of each chamber are
/// judged.
pub(super) fn passage_nodes(chambers: &[&[RingSection<'_>]]) -> Result<Vec<Vec<Nodes>>, BuildError> {
    // A turn joins segment k to the mirrored one of the next chamber, run through the other way.
    let turned = |chamber: usize| !chamber.is_multiple_of(2);
    let place = |chamber: usize, k: usize| if turned(chamber) { mirrored(k) } else { k };
    let mut all: Vec<Vec<Nodes>> = vec![Vec::with_capacity(SEGMENTS); chambers.len()];
    let mut joined = Vec::with_capacity(SEGMENTS);
    for k in 0..SEGMENTS {
        let mut strands = Vec::new();
        for (chamber, sections) in chambers.iter().enumerate() {
            for i in [0, sections.len() / 2, sections.len() - 1] {
                let (segment, reversed) = (place(chamber, k), turned(chamber));
                strands.push(Strand { section: &sections[i], segment, reversed });
            }
        }
        joined.push(Nodes::of(&strands)?);
    }
    for (chamber, nodes) in all.iter_mut().enumerate() {
        for k in 0..SEGMENTS {
            let own = &joined[place(chamber, k)];
            nodes.push(if turned(chamber) { own.reversed()? } else { own.clone() });
        }
    }
    Ok(all)
}
