//! The pieces a chamber's ring consists of.

use super::outline::Outline;
use coolinggen_nurbs::ParametricCurve;
use glam::DVec2;

/// One of the eight pieces of a chamber's ring, run through with a parameter in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Segment {
    /// A piece of the offset outline.
    Side {
        /// Parameter at the start.
        from: f64,
        /// Parameter at the end.
        to: f64,
    },
    /// A circular arc.
    Arc {
        /// Centre.
        center: DVec2,
        /// Radius.
        radius: f64,
        /// Angle at the start, radians.
        angle: f64,
        /// Signed angle run through, radians.
        sweep: f64,
    },
    /// A straight line.
    Line {
        /// Start.
        from: DVec2,
        /// End.
        to: DVec2,
    },
}

impl Segment {
    /// The arc about `center` from `from` to `to`, the short way round, or the one through the direction `via`.
    pub fn arc(center: DVec2, from: DVec2, to: DVec2, via: Option<DVec2>) -> Self {
        use std::f64::consts::{PI, TAU};
        let (a, b) = ((from - center).to_angle(), (to - center).to_angle());
        let mut sweep = (b - a + PI).rem_euclid(TAU) - PI;
        if let Some(via) = via
            && DVec2::from_angle(a + 0.5 * sweep).dot(via) < 0.0
        {
            sweep -= TAU * sweep.signum();
        }
        Self::Arc { center, radius: from.distance(center), angle: a, sweep }
    }

    /// Point and derivative at `t` in [0, 1].
    pub fn evaluate(&self, outline: &Outline, t: f64) -> (DVec2, DVec2) {
        match *self {
            Self::Side { from, to } => {
                // At its end a side may meet a joint, where the derivative jumps: stay on this side of it.
                let t = t.min(1.0 - 1e-13);
                let [p, d] = outline.curve().first_derivatives(from + (to - from) * t);
                (p, d * (to - from))
            }
            Self::Arc { center, radius, angle, sweep } => {
                let direction = DVec2::from_angle(angle + sweep * t);
                (center + direction * radius, direction.perp() * (radius * sweep))
            }
            Self::Line { from, to } => (from + (to - from) * t, to - from),
        }
    }

    /// Splits into three: arcs and lines evenly, sides evenly by turning angle, so that a nose is cut at its
    /// shoulders whatever its parametrisation.
    pub fn in_three(&self, outline: &Outline) -> [Self; 3] {
        match *self {
            Self::Arc { center, radius, angle, sweep } => {
                let third = sweep / 3.0;
                [0.0, 1.0, 2.0].map(|k| Self::Arc { center, radius, angle: angle + k * third, sweep: third })
            }
            Self::Line { from, to } => {
                let at = |k: f64| from + (to - from) * (k / 3.0);
                [0.0, 1.0, 2.0].map(|k| Self::Line { from: at(k), to: at(k + 1.0) })
            }
            Self::Side { from, to } => {
                let cuts = [1.0 / 3.0, 2.0 / 3.0].map(|f| turning_fraction(outline, from, to, f));
                [(from, cuts[0]), (cuts[0], cuts[1]), (cuts[1], to)].map(|(from, to)| Self::Side { from, to })
            }
        }
    }
}

/// Signed angle from `a` to `b`, exact for small angles too, where an arc cosine is not.
pub(crate) fn angle_between(a: DVec2, b: DVec2) -> f64 {
    a.perp_dot(b).atan2(a.dot(b))
}

/// Parameter between `from` and `to` at which the tangent has turned by `fraction` of its whole turn.
fn turning_fraction(outline: &Outline, from: f64, to: f64, fraction: f64) -> f64 {
    const SAMPLES: usize = 48;
    let at = |k: usize| from + (to - from) * k as f64 / SAMPLES as f64;
    let mut turned = [0.0; SAMPLES + 1];
    let mut before = outline.frame(from).tangent;
    for k in 1..=SAMPLES {
        let tangent = outline.frame(at(k)).tangent;
        turned[k] = turned[k - 1] + angle_between(before, tangent);
        before = tangent;
    }
    let target = turned[SAMPLES] * fraction;
    let k = (1..SAMPLES).find(|&k| (turned[k] - target) * turned[SAMPLES].signum() >= 0.0).unwrap_or(SAMPLES);
    // Within the sample interval the angle is smooth: regula falsi settles in a few steps.
    let (mut a, mut b) = (at(k - 1), at(k));
    let start = outline.frame(a).tangent;
    let goal = target - turned[k - 1];
    let (mut fa, mut fb) = (-goal, angle_between(start, outline.frame(b).tangent) - goal);
    for _ in 0..60 {
        if (b - a).abs() < 1e-15 || fb == fa {
            break;
        }
        let c = b - fb * (b - a) / (fb - fa);
        let fc = angle_between(start, outline.frame(c).tangent) - goal;
        if fc * fb < 0.0 {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        (b, fb) = (c, fc);
        if fc.abs() < 1e-14 {
            break;
        }
    }
    b
}
