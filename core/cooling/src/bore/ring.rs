//! Rings: cubics through the hits of a path, as exact as the checks of other programs ask.

use super::BoreError;
use super::shape::Grading;
use super::target::{Hit, Ray, Target};
use coolinggen_brep::{FaceId, deviation_amid_spans};
use coolinggen_nurbs::{Curve, Interpolator};
use glam::{DVec2, DVec3};
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// How far a delimiting curve may lie from its surface and from the image of its parameter curve, mm: FreeCAD's check
/// allows 7e-8 including the reader's own interpolation (DESIGN 6).
const TOLERANCE: f64 = 2e-8;
/// Spans of a piece at which to give up.
const MOST_SPANS: usize = 512;

/// A piece of a delimiting curve over [0, 1], in space and in the face's parameters.
#[derive(Clone, Debug)]
pub(super) struct Trace {
    pub(super) curve: Curve<DVec3>,
    pub(super) pcurve: Curve<DVec2>,
}

/// Cubic interpolation over equal steps of [0, 1] with given end slopes, kept by the number of spans.
#[derive(Clone, Debug, Default)]
pub(super) struct Interpolators(HashMap<usize, Interpolator>);

impl Interpolators {
    pub(super) fn of(&mut self, spans: usize) -> Result<&Interpolator, BoreError> {
        Ok(match self.0.entry(spans) {
            Entry::Occupied(found) => found.into_mut(),
            Entry::Vacant(place) => {
                let nodes: Vec<f64> = (0..=spans).map(|i| i as f64 / spans as f64).collect();
                place.insert(Interpolator::with_slopes(&nodes)?)
            }
        })
    }
}

/// What is to be traced: the hits of a path's rays between two parameters on one face.
pub(super) struct Stretch<'a, 'm> {
    pub(super) target: &'a Target<'m>,
    pub(super) face: FaceId,
    pub(super) rays: &'a dyn Fn(f64) -> Ray,
    pub(super) range: (f64, f64),
    pub(super) grading: Grading,
    /// Parameters and multiple of the ray at its start.
    pub(super) start: (DVec2, f64),
}

impl Stretch<'_, '_> {
    /// The trace in `spans` spans, and how far it is off relative to the tolerance.
    fn trace(&self, interpolators: &mut Interpolators, spans: usize) -> Result<(Trace, f64), BoreError> {
        let mut hits: Vec<Hit> = Vec::with_capacity(spans + 1);
        let mut before: Option<(f64, DVec2)> = None;
        for k in 0..=spans {
            let t = self.grading.at(self.range, k, spans);
            // Where the hits so far lead: the better the guess, the fewer the steps from it.
            let (near, along) = match hits.last() {
                None => self.start,
                Some(last) => {
                    let at = |k: usize| self.grading.at(self.range, k, spans);
                    let step = t - at(k - 1);
                    let turn = before.map_or(DVec2::ZERO, |(step, slope)| (last.at_slope - slope) / step);
                    before = Some((step, last.at_slope));
                    let by = (last.at_slope + turn * (0.5 * step)) * step;
                    (self.target.ahead(self.face, last.at, by), last.along)
                }
            };
            let hit = self.target.meet(self.face, &(self.rays)(t), near, along).ok_or(BoreError::Misses)?;
            hits.push(hit);
        }
        let points: Vec<DVec3> = hits.iter().map(|h| h.point).collect();
        let parameters: Vec<DVec2> = hits.iter().map(|h| h.at).collect();
        let (first, last) = (&hits[0], &hits[spans]);
        let scale = self.grading.end_speed(self.range);
        let interpolator = interpolators.of(spans)?;
        let curve = interpolator.curve_with_slopes(&points, first.slope * scale, last.slope * scale)?;
        let pcurve =
            interpolator.curve_with_slopes(&parameters, first.at_slope * scale, last.at_slope * scale)?;
        let worst = deviation_amid_spans(self.target.surface(self.face), &curve, &pcurve);
        Ok((Trace { curve, pcurve }, worst / TOLERANCE))
    }

    /// The trace with spans enough for the tolerance, `least` at least, and their number: the error falls with the
    /// fourth power of the step.
    pub(super) fn traced_closely(
        &self,
        interpolators: &mut Interpolators,
        least: usize,
    ) -> Result<(usize, Trace), BoreError> {
        let mut spans = least;
        loop {
            let (trace, ratio) = match self.trace(interpolators, spans) {
                Ok(traced) => traced,
                // Hits that lie far from each other are not found one from the other.
                Err(BoreError::Misses) if 2 * spans <= MOST_SPANS => {
                    spans *= 2;
                    continue;
                }
                Err(error) => return Err(error),
            };
            if ratio <= 1.0 {
                return Ok((spans, trace));
            }
            if spans >= MOST_SPANS {
                return Err(BoreError::Inaccurate);
            }
            let wanted = (spans as f64 * 1.05 * ratio.powf(0.25)).ceil() as usize;
            // A crude first trial tells little.
            spans = wanted.clamp(spans + 1, (4 * spans).min(MOST_SPANS));
        }
    }

    /// The trace in `spans` spans.
    pub(super) fn traced(&self, interpolators: &mut Interpolators, spans: usize) -> Result<Trace, BoreError> {
        Ok(self.trace(interpolators, spans)?.0)
    }
}
