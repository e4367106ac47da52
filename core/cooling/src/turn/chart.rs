//! The map from the box in which a turn is drawn to space.

use super::fibre::{Fibres, Form, MOST_UNLIKE, Straight, fans};
use super::{TurnRefusal, TurnSection};
use crate::build::BuildError;
use coolinggen_nurbs::{ArcLength, Interpolator, ParametricSurface, Surface};
use glam::{DMat3, DVec2, DVec3};

/// Fractions of a fibre at which it is taken to space; a polynomial of degree 4 runs through them. A fibre is straight
/// in the conformal chart, nearly so in space.
const FRACTIONS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Gaps between the fibres. Offsets of measured blades carry jumps of curvature; where a fillet touches a side, the map
/// must have the side's own tangent.
const FIBRE_GAPS: usize = 300;

/// The box (x, eta, zeta) and its map: splines of degree 3 in x and zeta through exact points, of degree 4 in eta.
#[derive(Clone, Debug)]
pub(crate) struct TurnChart {
    /// Surfaces over (x, zeta) at the fractions eta.
    layers: Vec<Surface<DVec3>>,
    /// zeta of the sections.
    pub(super) levels: Vec<f64>,
    /// The range of x that it holds.
    pub(super) extent: [f64; 2],
}

/// A point of the map with its derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mapped {
    pub(super) point: DVec3,
    /// Columns: derivatives in x, eta, zeta.
    pub(super) slopes: DMat3,
}

impl TurnChart {
    /// The map over sections ordered away from the chambers, the first being where their straight parts end.
    pub(super) fn new(
        sections: &[TurnSection<'_>],
        form: Form,
    ) -> Result<Result<Self, TurnRefusal>, BuildError> {
        let first = &sections[0];
        let length = first.camber.length() * first.stream.scale(first.wall[0]);
        let mut fibres: Vec<Fibres<'_>> = sections.iter().map(|s| Fibres::new(s, length)).collect();
        if let Err(refusal) = fan_out(&mut fibres, form) {
            return Ok(Err(refusal));
        }
        let Some(extents) = fibres.iter().map(Fibres::extent).collect::<Option<Vec<_>>>() else {
            return Ok(Err(TurnRefusal::Unmapped));
        };
        let low = extents.iter().fold(0.0, |low: f64, e| low.min(e[0]));
        let high = extents.iter().fold(0.0, |high: f64, e| high.max(e[1]));
        let margin = 0.02 * (high - low);
        let xs: Vec<f64> = (0..=FIBRE_GAPS)
            .map(|i| low - margin + (high - low + 2.0 * margin) * i as f64 / FIBRE_GAPS as f64)
            .collect();
        let levels = levels(sections)?;
        let (along, across) = (Interpolator::new(3, &xs)?, Interpolator::new(3, &levels)?);
        let mut ends = Vec::with_capacity(sections.len());
        for fibres in &fibres {
            match fibres.ends(&xs) {
                Ok(found) => ends.push(found),
                Err(refusal) => return Ok(Err(refusal)),
            }
        }
        let mut layers = Vec::with_capacity(FRACTIONS.len());
        for eta in FRACTIONS {
            let mut curves = Vec::with_capacity(sections.len());
            for (section, ends) in sections.iter().zip(&ends) {
                let point = |[a, b]: &[DVec2; 2]| section.stream.to_space(b.lerp(*a, eta));
                let points: Vec<DVec3> = ends.iter().map(point).collect();
                curves.push(along.curve(&points)?);
            }
            layers.push(across.loft(&curves)?);
        }
        Ok(Ok(Self { layers, levels, extent: [low, high] }))
    }

    /// The point with coordinates `q` = (x, eta, zeta).
    pub(super) fn point(&self, q: DVec3) -> DVec3 {
        let (weights, _) = lagrange(q.y);
        let layers = self.layers.iter().zip(weights);
        layers.map(|(layer, w)| layer.point(q.x, q.z) * w).sum()
    }

    /// The point and its derivatives.
    pub(super) fn map(&self, q: DVec3) -> Mapped {
        let (weights, rates) = lagrange(q.y);
        let mut mapped = Mapped { point: DVec3::ZERO, slopes: DMat3::ZERO };
        for ((layer, w), rate) in self.layers.iter().zip(weights).zip(rates) {
            let (p, dx, dz) = layer.first_derivatives(q.x, q.z);
            mapped.point += p * w;
            mapped.slopes += DMat3::from_cols(dx * w, p * rate, dz * w);
        }
        mapped
    }

    /// Length in space of a direction of the box at `q`.
    pub(super) fn speed(&self, q: DVec3, direction: DVec3) -> f64 {
        (self.map(q).slopes * direction).length()
    }

    /// Coordinates of a point, by Newton's method from `start`, to 1e-10 mm.
    pub(super) fn inverse(&self, point: DVec3, start: DVec3) -> Option<DVec3> {
        let mut q = start;
        for _ in 0..60 {
            let mapped = self.map(q);
            let missing = point - mapped.point;
            let change = mapped.slopes.inverse() * missing;
            if !change.is_finite() {
                return None;
            }
            let limit = DVec3::new(2.0, 0.3, 1.0);
            q += change.clamp(-limit, limit);
            if missing.length() < 1e-10 {
                return Some(q);
            }
        }
        None
    }
}

/// Lets fibres fan out where they must, so that they reach all of the rings. One answer for all sections: the map is smooth
/// from one to the next.
fn fan_out(fibres: &mut [Fibres<'_>], form: Form) -> Result<(), TurnRefusal> {
    if let Form::Fanned(straight) = form {
        let fan = (straight, MOST_UNLIKE);
        return [0, 1]
            .into_iter()
            .try_for_each(|end| fibres.iter_mut().try_for_each(|f| f.fan_out(end, fan)));
    }
    for end in [0, 1] {
        if !fibres.iter().any(|f| f.must_fan(end)) {
            continue;
        }
        let mut refusal = None;
        let mut out = |fan: &(Straight, f64)| {
            let fanned = fibres.iter_mut().try_for_each(|f| f.fan_out(end, *fan));
            let reached = fanned.is_ok() && fibres.iter().all(|f| f.reaches(end));
            refusal = refusal.take().or(fanned.err());
            reached
        };
        match fans().find(&mut out) {
            // Towards both ends.
            Some((Straight::None, _)) => return Ok(()),
            Some(_) => {}
            None => return Err(refusal.unwrap_or(TurnRefusal::Unmapped)),
        }
    }
    Ok(())
}

/// Distance of the sections from the first one, mm, along the wall's mid line.
fn levels(sections: &[TurnSection<'_>]) -> Result<Vec<f64>, BuildError> {
    let sign = if sections[1].stream.v() > sections[0].stream.v() { 1.0 } else { -1.0 };
    let vs: Vec<f64> = sections.iter().map(|s| sign * s.stream.v()).collect();
    let feet: Vec<DVec3> = sections.iter().map(|s| s.stream.to_space(s.wall[0])).collect();
    let path = ArcLength::new(Interpolator::new(3, &vs)?.curve(&feet)?, 1e-10)?;
    Ok(vs.iter().map(|&v| path.length(v)).collect())
}

/// Lagrange's polynomials over [`FRACTIONS`] and their derivatives.
fn lagrange(eta: f64) -> ([f64; 5], [f64; 5]) {
    let (mut values, mut rates) = ([1.0; 5], [0.0; 5]);
    for k in 0..5 {
        for j in (0..5).filter(|&j| j != k) {
            let scale = 1.0 / (FRACTIONS[k] - FRACTIONS[j]);
            rates[k] = (rates[k] * (eta - FRACTIONS[j]) + values[k]) * scale;
            values[k] *= (eta - FRACTIONS[j]) * scale;
        }
    }
    (values, rates)
}
