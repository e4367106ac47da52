//! The annulus between two contours.

use super::BEYOND;
use super::surface::StreamSurface;
use crate::error::BladeError;
use coolinggen_nurbs::{Curve, ParametricSurface, Surface};
use glam::DVec2;

/// An annular stream space about the machine axis x, given by its net of streamlines N(s, v) = (x, r).
///
/// The streamline of span fraction v is the line N(., v), exactly; s runs over [0, 1] from the start of the contours
/// to their end. Nothing assumes that x grows along a streamline: contours may turn from axial to radial.
#[derive(Clone, Debug)]
pub struct Annular {
    net: Surface<DVec2>,
    /// Station of M = 0.
    reference: f64,
    reference_angle: f64,
    side: f64,
    /// Net points to start searches from: `(s, v, point)`.
    samples: Vec<(f64, f64, DVec2)>,
}

impl Annular {
    /// A space from a net without folds (the caller has checked), with M = 0 at s = 0.5 and T = 0 at theta = 0.
    pub(super) fn new(net: Surface<DVec2>) -> Self {
        let d = net.derivatives(0.5, 0.5);
        let side = if d.u.perp_dot(d.v) < 0.0 { -1.0 } else { 1.0 };
        let stations = net.breaks_u();
        let spans =
            stations.windows(2).flat_map(|w| (0..4).map(|k| w[0] + (w[1] - w[0]) * f64::from(k) / 4.0));
        let mut samples = Vec::new();
        for s in spans.chain([1.0]) {
            for v in [0.0, 0.25, 0.5, 0.75, 1.0] {
                samples.push((s, v, net.point(s, v)));
            }
        }
        Self { net, reference: 0.5, reference_angle: 0.0, side, samples }
    }

    /// The same space with M = 0 at station `s` and T = 0 at `angle` (radians): the blade's middle.
    #[must_use]
    pub fn with_reference(mut self, s: f64, angle: f64) -> Self {
        self.reference = s;
        self.reference_angle = angle;
        self
    }

    /// Station of M = 0 and angle of T = 0, radians.
    pub fn reference(&self) -> (f64, f64) {
        (self.reference, self.reference_angle)
    }

    /// The net of streamlines.
    pub fn net(&self) -> &Surface<DVec2> {
        &self.net
    }

    /// The streamline at `v`, extrapolated linearly beyond hub and shroud.
    pub fn streamline(&self, v: f64) -> Result<Curve<DVec2>, BladeError> {
        let inside = v.clamp(0.0, 1.0);
        let (knots, count) = (self.net.knots_v(), self.net.counts().1);
        let basis = knots.basis(inside, 1);
        let beyond = v - inside;
        let points = self.net.points().chunks_exact(count).map(|row| {
            let mut point = DVec2::ZERO;
            for k in 0..=knots.degree() {
                point += row[basis.first + k] * (basis.values[0][k] + beyond * basis.values[1][k]);
            }
            point
        });
        Ok(Curve::new(self.net.knots_u().clone(), points.collect())?)
    }

    pub(crate) fn surface(&self, v: f64) -> Result<StreamSurface, BladeError> {
        let meridian = self.streamline(v)?;
        Ok(StreamSurface::revolved(v, meridian, self.reference, self.reference_angle, self.side)?)
    }

    /// Net point and its derivatives in s and v, extrapolated linearly beyond hub and shroud.
    pub(crate) fn at(&self, s: f64, v: f64) -> (DVec2, DVec2, DVec2) {
        let inside = v.clamp(0.0, 1.0);
        let d = self.net.derivatives(s, inside);
        let beyond = v - inside;
        (d.point + d.v * beyond, d.u + d.uv * beyond, d.v)
    }

    /// Station and span fraction `(s, v)` of a meridional point (x, r), to 1e-12.
    ///
    /// # Errors
    /// [`BladeError::OutsideContours`] for a point beyond the ends of the contours (by more than a tenth of them) or
    /// more than half a span outside hub or shroud.
    pub fn coordinates(&self, p: DVec2) -> Result<(f64, f64), BladeError> {
        let outside = BladeError::OutsideContours { x: p.x, r: p.y };
        let mut best = (f64::INFINITY, 0.5, 0.5);
        for &(s, v, q) in &self.samples {
            let d = q.distance_squared(p);
            if d < best.0 {
                best = (d, s, v);
            }
        }
        let (mut s, mut v) = (best.1, best.2);
        for _ in 0..60 {
            let (q, along_s, along_v) = self.at(s, v);
            let (gap, area) = (p - q, along_s.perp_dot(along_v));
            let (ds, dv) = (gap.perp_dot(along_v) / area, along_s.perp_dot(gap) / area);
            if !(ds.is_finite() && dv.is_finite()) {
                return Err(outside);
            }
            s += ds.clamp(-0.1, 0.1);
            v += dv.clamp(-0.25, 0.25);
            if !(-0.2..=1.2).contains(&s) || !(-1.0..=2.0).contains(&v) {
                return Err(outside);
            }
            if ds.abs() < 1e-13 && dv.abs() < 1e-13 {
                break;
            }
        }
        let left = self.at(s, v).0.distance(p);
        let inside = (-0.1..=1.1).contains(&s) && (-0.5..=1.5).contains(&v);
        if inside && left <= 1e-9 * (1.0 + p.length()) { Ok((s, v)) } else { Err(outside) }
    }

    /// Distance from hub to shroud in the middle, mm.
    pub fn height(&self) -> f64 {
        self.net.point(self.reference, 0.0).distance(self.net.point(self.reference, 1.0))
    }

    /// Points of the net where it folds (its orientation turns over) or meets the axis, `(s, v, point)`: none for a
    /// usable space. Looked for on a grid over s in [0, 1] and v in [-0.15, 1.15].
    pub(super) fn flaw(&self) -> Option<(f64, f64, DVec2)> {
        let stations = self.net.breaks_u();
        let steps = (200 / (stations.len() - 1)).max(4) as u32;
        let spans = stations
            .windows(2)
            .flat_map(|w| (0..steps).map(move |k| w[0] + (w[1] - w[0]) * f64::from(k) / f64::from(steps)));
        for s in spans.chain([1.0]) {
            for k in 0..=26 {
                let v = -BEYOND + (1.0 + 2.0 * BEYOND) * f64::from(k) / 26.0;
                let (p, along_s, along_v) = self.at(s, v);
                let folded =
                    !(along_s.perp_dot(along_v) * self.side > 1e-9 * along_s.length() * along_v.length());
                if folded || !(p.y > 0.0) {
                    return Some((s, v, p));
                }
            }
        }
        None
    }
}
