//! Places by camber fraction and span fraction: the camber lines of all sections as one surface in space.

use super::sections::Section;
use coolinggen_nurbs::{ArcLength, Curve, Interpolator, NurbsError, ParametricCurve};
use glam::DVec3;

/// The camber lines of the outer profiles.
pub(super) struct CamberNet<'s> {
    sections: &'s [Section],
    /// Lengths in space along each section's camber line, at equal steps of its fraction.
    lengths: Vec<Vec<f64>>,
}

/// A point of the mid surface with its unit directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct CamberPoint {
    pub(super) point: DVec3,
    /// Normal to the mid surface, towards the suction side.
    pub(super) normal: DVec3,
    /// Along the span, towards the tip.
    pub(super) up: DVec3,
}

/// Steps along each camber line.
const STEPS: usize = 100;
/// Of lengths along the span, mm.
const LENGTH_TOLERANCE: f64 = 1e-9;

impl<'s> CamberNet<'s> {
    pub(super) fn new(sections: &'s [Section]) -> Self {
        let lengths = |section: &Section| {
            let at = |i: usize| section.stream.to_space(section.camber.at(i as f64 / STEPS as f64).center);
            let mut lengths = vec![0.0];
            for i in 1..=STEPS {
                lengths.push(lengths[i - 1] + at(i - 1).distance(at(i)));
            }
            lengths
        };
        Self { sections, lengths: sections.iter().map(lengths).collect() }
    }

    /// Length along the camber line from one fraction to another, the least of all sections within a span, mm.
    pub(super) fn least_length(&self, from: f64, to: f64, [low, high]: [f64; 2]) -> f64 {
        let length = |k: usize| self.length_at(k, to) - self.length_at(k, from);
        let near = |k: &usize| {
            let v = |i: usize| self.sections[i].stream.v();
            // The sections on both sides of the span belong to it, too.
            v((k + 1).min(self.sections.len() - 1)) >= low && v(k.saturating_sub(1)) <= high
        };
        (0..self.sections.len()).filter(near).map(length).fold(f64::INFINITY, f64::min)
    }

    fn length_at(&self, k: usize, fraction: f64) -> f64 {
        let place = fraction.clamp(0.0, 1.0) * STEPS as f64;
        let i = (place as usize).min(STEPS - 1);
        let lengths = &self.lengths[k];
        lengths[i] + (lengths[i + 1] - lengths[i]) * (place - i as f64)
    }

    /// The fraction at a length along the camber line of section `k`.
    fn fraction_at(&self, k: usize, length: f64) -> f64 {
        let lengths = &self.lengths[k];
        let i = lengths.partition_point(|&l| l <= length).clamp(1, STEPS);
        let part = (length - lengths[i - 1]) / (lengths[i] - lengths[i - 1]);
        ((i - 1) as f64 + part) / STEPS as f64
    }

    /// The line over the span that runs `beyond` mm behind a fraction of the camber lines.
    pub(super) fn line(&self, fraction: f64, beyond: f64) -> Result<CamberLine, NurbsError> {
        let v: Vec<f64> = self.sections.iter().map(|s| s.stream.v()).collect();
        let across = Interpolator::new(3, &v)?;
        let (mut points, mut downstream, mut suction) = (Vec::new(), Vec::new(), Vec::new());
        for (k, section) in self.sections.iter().enumerate() {
            let circle = section.camber.at(self.fraction_at(k, self.length_at(k, fraction) + beyond));
            let (point, dm, dt) = section.stream.to_space_derivatives(circle.center);
            points.push(point);
            downstream.push((dm * circle.tangent.x + dt * circle.tangent.y).normalize());
            let side = section.outline.frame(circle.suction).point - circle.center;
            suction.push((dm * side.x + dt * side.y).normalize());
        }
        let points = across.curve(&points)?;
        Ok(CamberLine {
            lengths: ArcLength::new(points.clone(), LENGTH_TOLERANCE)?,
            points,
            downstream: across.curve(&downstream)?,
            suction: across.curve(&suction)?,
        })
    }
}

/// A line over the span on the mid surface, with its directions.
pub(super) struct CamberLine {
    points: Curve<DVec3>,
    lengths: ArcLength<DVec3, Curve<DVec3>>,
    downstream: Curve<DVec3>,
    suction: Curve<DVec3>,
}

impl CamberLine {
    /// Length between two span fractions, mm.
    pub(super) fn length(&self, [low, high]: [f64; 2]) -> f64 {
        self.lengths.length(high) - self.lengths.length(low)
    }

    /// The span fraction at a length from another one.
    pub(super) fn beyond(&self, v: f64, length: f64) -> f64 {
        self.lengths.parameter(self.lengths.length(v) + length)
    }

    /// The place at a span fraction.
    pub(super) fn at(&self, v: f64) -> CamberPoint {
        let [point, rise, _] = self.points.derivatives(v);
        let up = rise.normalize();
        let normal = self.downstream.point(v).cross(up).normalize();
        CamberPoint { point, normal: normal * normal.dot(self.suction.point(v)).signum(), up }
    }
}
