//! Profile curves: what thickness does along a streamline (section 2.3).

use coolinggen_nurbs::{Curve, NurbsError, ParametricCurve};
use glam::DVec2;

/// A profile p(t) = (x(t), y(t)) over [0, 1]: the part x of the streamline's length, from the leading edge, at which
/// the side stands `d y` off the medial surface. x(0) = 0, x'(0) = 0, y(0) = 0, x(1) = 1; x grows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Profile {
    curve: Curve<DVec2>,
}

/// What is wrong with a profile's control points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ProfileFlaw {
    /// Not a degree a Bezier curve can have here: points given.
    Count(usize),
    /// The control point of this index must have this x (or this y, where marked).
    Fixed { index: usize, x: Option<f64>, y: Option<f64> },
    /// x does not grow at this control point.
    Order(usize),
    /// The profile has no thickness at x.
    Thin { x: f64 },
}

impl Profile {
    /// The Bezier curve of `points`, degree 2 to 9.
    pub(crate) fn bezier(points: &[DVec2]) -> Result<Self, ProfileFlaw> {
        let last = points.len().wrapping_sub(1);
        if !(3..=10).contains(&points.len()) || points.iter().any(|p| !p.is_finite()) {
            return Err(ProfileFlaw::Count(points.len()));
        }
        let fixed = |index, x, y| Err(ProfileFlaw::Fixed { index, x, y });
        if points[0] != DVec2::ZERO {
            return fixed(0, Some(0.0), Some(0.0));
        }
        if points[1].x != 0.0 || !(points[1].y > 0.0) {
            return fixed(1, Some(0.0), None);
        }
        if points[last].x != 1.0 || !(points[last].y >= 0.0) {
            return fixed(last, Some(1.0), None);
        }
        if let Some(i) = (2..points.len()).find(|&i| {
            let step = points[i].x - points[i - 1].x;
            !(step >= 0.0) || (i == last && step == 0.0) || (i == 2 && step == 0.0)
        }) {
            return Err(ProfileFlaw::Order(i));
        }
        let profile = Curve::bezier(points.to_vec()).map_err(|_| ProfileFlaw::Count(points.len()))?;
        Self { curve: profile }.thick()
    }

    /// The thickness of the NACA four-digit sections, 1 at its greatest over both sides: y = 5 (0.2969 sqrt x -
    /// 0.1260 x - 0.3516 x^2 + 0.2843 x^3 - c x^4), with c = 0.1015, or 0.1036 for a tail that is closed. With x = t^2 it
    /// is a Bezier curve of degree 8.
    ///
    /// I. H. Abbott, A. E. von Doenhoff, *Theory of Wing Sections* (1959), section 6.4.
    pub(crate) fn naca_four_digit(closed: bool) -> Result<Self, NurbsError> {
        let last = if closed { 0.1036 } else { 0.1015 };
        // Powers of t.
        let y = [0.0, 0.2969, -0.1260, 0.0, -0.3516, 0.0, 0.2843, 0.0, -last].map(|c| 5.0 * c);
        let x = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let mut points: Vec<DVec2> =
            (0..=8).map(|k| DVec2::new(bernstein(&x, k), bernstein(&y, k))).collect();
        // What the tail's coefficients leave of zero.
        points[8] = DVec2::new(1.0, if closed { 0.0 } else { points[8].y });
        Ok(Self { curve: Curve::bezier(points)? })
    }

    /// A profile from a curve that the caller answers for.
    pub(crate) fn from_curve(curve: Curve<DVec2>) -> Self {
        Self { curve }
    }

    fn thick(self) -> Result<Self, ProfileFlaw> {
        let samples = 400;
        let thin = (1..samples).map(|i| self.at(f64::from(i) / f64::from(samples))[0]).find(|p| !(p.y > 0.0));
        match thin {
            Some(p) => Err(ProfileFlaw::Thin { x: p.x }),
            None => Ok(self),
        }
    }

    /// Point and first and second derivative at `t`.
    pub(crate) fn at(&self, t: f64) -> [DVec2; 3] {
        self.curve.derivatives(t)
    }

    /// y(t).
    pub(super) fn heights(&self) -> Curve<f64> {
        self.curve.map(|p| p.y)
    }

    /// t at which the leading edge ends: where the profile has turned by 1.1 radians from its tip, for a scale that is
    /// `slenderness` of the streamline's length.
    pub(crate) fn nose_end(&self, slenderness: f64) -> f64 {
        const TURN: f64 = 1.1;
        let turned = |t: f64| {
            let slope = self.at(t)[1];
            slope.x.atan2(slenderness * slope.y)
        };
        let steps = 400;
        let t = (1..steps).map(|i| f64::from(i) / f64::from(steps)).find(|&t| turned(t) >= TURN);
        t.unwrap_or(0.1).clamp(0.02, 0.5)
    }

    /// y at the trailing edge.
    pub(crate) fn tail(&self) -> f64 {
        self.curve.points()[self.curve.points().len() - 1].y
    }
}

/// Bernstein coefficient `k` of the polynomial with these coefficients of powers.
fn bernstein(powers: &[f64], k: usize) -> f64 {
    let n = powers.len() - 1;
    let binomial = |n: usize, k: usize| (0..k).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64);
    (0..=k).map(|i| binomial(k, i) / binomial(n, i) * powers[i]).sum()
}
