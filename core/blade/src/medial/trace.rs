//! The trace of the leading or the trailing edge in the meridional plane.

use crate::error::BladeError;
use crate::stream::Annular;
use coolinggen_nurbs::{Curve, ParametricCurve, ParametricSurface};
use glam::DVec2;

/// The trace of an edge: where it crosses each streamline.
#[derive(Clone, Debug)]
pub(crate) struct Trace {
    /// (x, r) over [0, 1], from hub to shroud; continued straight beyond its ends.
    curve: Curve<DVec2>,
    /// Whether it ends in a tip, beyond which there is no streamline to meet.
    pointed: bool,
}

/// Why a curve is no trace.
#[derive(Clone, Debug)]
pub(crate) enum TraceFlaw {
    /// A point of it lies beyond the ends of the contours.
    Outside(BladeError),
    /// It does not run from hub to shroud: span fractions at its start and end.
    Short { start: f64, end: f64 },
    /// Its span fraction does not increase at this one.
    TurnsBack { v: f64 },
}

/// How far a trace may end from hub and shroud, in span fractions; it is continued straight to them.
pub(crate) const SHORT: f64 = 0.02;
/// Least span fraction of a tip.
const LEAST_TIP: f64 = 0.2;
/// Points at which the order along the span is checked.
const CHECKS: u32 = 96;

impl Trace {
    /// Checks that `curve` crosses every streamline of `space` once, or every one below its end if that is a tip
    /// (`pointed`).
    pub(crate) fn new(curve: Curve<DVec2>, space: &Annular, pointed: bool) -> Result<Self, TraceFlaw> {
        let trace = Self { curve, pointed };
        let v = |i: u32| {
            let at = space.coordinates(trace.at(f64::from(i) / f64::from(CHECKS)).0);
            at.map(|(_, v)| v).map_err(TraceFlaw::Outside)
        };
        let all = (0..=CHECKS).map(v).collect::<Result<Vec<f64>, _>>()?;
        let (start, end) = (all[0], all[CHECKS as usize]);
        if start > SHORT || end < if pointed { LEAST_TIP } else { 1.0 - SHORT } {
            return Err(TraceFlaw::Short { start, end });
        }
        match all.windows(2).find(|pair| !(pair[1] > pair[0])) {
            Some(pair) => Err(TraceFlaw::TurnsBack { v: pair[0] }),
            None => Ok(trace),
        }
    }

    /// Station s on the streamline of span fraction `v` in [0, 1] at which the trace crosses it, to 1e-13.
    ///
    /// # Errors
    /// [`BladeError::OutsideContours`].
    pub(crate) fn station(&self, space: &Annular, v: f64) -> Result<f64, BladeError> {
        // Newton's method on the span fraction along the trace, between bisection bounds.
        let (mut low, mut high) = (-0.5, if self.pointed { 1.0 } else { 1.5 });
        let mut t = v;
        let mut s = 0.0;
        for _ in 0..80 {
            let (p, along) = self.at(t);
            let (station, fraction) = space.coordinates(p)?;
            s = station;
            let (_, net_s, net_v) = space.at(station, fraction);
            let slope = net_s.perp_dot(along) / net_s.perp_dot(net_v);
            let miss = fraction - v;
            if miss > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - miss / slope;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if miss.abs() < 1e-15 || (next - t).abs() <= 2.0 * f64::EPSILON {
                break;
            }
            t = next;
        }
        Ok(s)
    }

    /// The point (x, r) that it ends in, and its direction there.
    pub(crate) fn end(&self) -> (DVec2, DVec2) {
        self.at(1.0)
    }

    /// Span fractions between the ends at which the streamlines' directions at the trace are less smooth than
    /// elsewhere: at its knots, and where it crosses knots of the net of streamlines.
    pub(crate) fn breaks(&self, space: &Annular) -> Vec<f64> {
        let at = |t: f64| space.coordinates(self.at(t).0);
        let mut all: Vec<f64> = self.curve.breaks().into_iter().filter_map(|t| Some(at(t).ok()?.1)).collect();
        let stations = space.net().breaks_u();
        let t = |i: u32| f64::from(i) / f64::from(CHECKS);
        let sampled: Vec<Option<f64>> = (0..=CHECKS).map(|i| at(t(i)).ok().map(|(s, _)| s)).collect();
        for knot in stations {
            for i in 0..CHECKS {
                let pair = (sampled[i as usize], sampled[i as usize + 1]);
                let (Some(a), Some(b)) = pair else { continue };
                if (a < knot) == (b < knot) {
                    continue;
                }
                let (mut low, mut high) = (t(i), t(i + 1));
                for _ in 0..50 {
                    let middle = 0.5 * (low + high);
                    let before = at(middle).is_ok_and(|(s, _)| (s < knot) == (a < knot));
                    *(if before { &mut low } else { &mut high }) = middle;
                }
                all.extend(at(low).map(|(_, v)| v));
            }
        }
        all.retain(|v| *v > SHORT && *v < 1.0 - SHORT);
        all
    }

    fn at(&self, t: f64) -> (DVec2, DVec2) {
        let inside = t.clamp(0.0, 1.0);
        let [p, d, _] = self.curve.derivatives(inside);
        (p + d * (t - inside), d)
    }
}
