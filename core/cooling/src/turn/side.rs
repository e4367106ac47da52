//! A side of the shell's inner outline, going on past its ends.

use crate::section::{Outline, Segment};
use coolinggen_nurbs::ParametricCurve;
use glam::DVec2;

/// A side of the shell's inner outline between the chambers' far ends. Round a nose the outline itself turns away; the
/// side goes on along its tangent there, with a curvature that fades out after an angle: twice continuously
/// differentiable, and the two sides of a nose do not meet before its end, since tangents of a circle do not.
pub(super) struct Side<'a> {
    outline: &'a Outline,
    pub(super) low: f64,
    pub(super) high: f64,
    /// How far the continued side may turn beyond `low` and beyond `high`, radians.
    pub(super) turned: [f64; 2],
}

/// How far a continued side may turn, radians.
const TURNED: f64 = 0.1;

impl<'a> Side<'a> {
    /// The side from the start of one segment to the end of another.
    pub(super) fn new(outline: &'a Outline, from: &Segment, to: &Segment) -> Self {
        Self { outline, low: ends(from).0, high: ends(to).1, turned: [TURNED; 2] }
    }

    /// Point and derivative at `u`.
    pub(super) fn at(&self, u: f64) -> (DVec2, DVec2) {
        // At its end a side may meet a joint, where derivatives jump: stay on this side of it.
        let inside = 1e-9 * (self.high - self.low);
        let near = u.clamp(self.low + inside, self.high - inside);
        let [p, d, dd] = self.outline.curve().derivatives(near);
        let e = u - near;
        if e == 0.0 {
            return (p, d);
        }
        // dd fades as exp(-|e| / reach).
        let turned = self.turned[usize::from(e > 0.0)];
        let reach = turned * d.length_squared() / d.perp_dot(dd).abs();
        let reach = reach.min(10.0 * (self.high - self.low));
        let faded = -(-e.abs() / reach).exp_m1() * reach;
        (p + d * e + dd * (reach * (e.abs() - faded)), d + dd * (faded * e.signum()))
    }
}

/// Ends of a side segment.
fn ends(segment: &Segment) -> (f64, f64) {
    match *segment {
        Segment::Side { from, to } => (from, to),
        Segment::Arc { .. } | Segment::Line { .. } => (0.0, 0.0),
    }
}
