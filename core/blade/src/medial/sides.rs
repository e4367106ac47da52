//! The two sides of a blade: medial surface, normals, profile and scale put together (section 3.4).

use super::composition::Composition;
use super::medial_surface::MedialSurface;
use super::pace::Pace;
use super::profile::Profile;
use crate::law::Law;
use coolinggen_nurbs::{Basis, NurbsError, ParametricSurface};
use glam::DVec3;

/// Two sides of a blade as functions of t in [0, 1], from the leading to the trailing edge, and v in [0, 1].
pub(crate) trait TwoSided {
    /// The point of side `k` (0 or 1) at (t, v).
    fn point(&self, k: usize, t: f64, v: f64) -> DVec3;

    /// Points of side `k` at all `ts` and `vs`, a row for each t.
    fn grid(&self, k: usize, ts: &[f64], vs: &[f64]) -> Vec<Vec<DVec3>> {
        ts.iter().map(|&t| vs.iter().map(|&v| self.point(k, t, v)).collect()).collect()
    }

    /// How fast side `k` leaves the leading edge, d y'(0) half way up, and y''(0) / (2 y'(0)).
    fn nose(&self, k: usize) -> (f64, f64);

    /// Both sides as one B-spline, beginning with side `first`, within a part of `tolerance` (mm); none for sides whose
    /// composition is out of reach.
    fn composition(&self, _first: usize, _tolerance: f64) -> Option<Result<Composition, NurbsError>> {
        None
    }

    /// The point that all lines of constant t end in at v = 1, with the normal of the plane that they leave it in;
    /// none for a blade whose tip is open.
    fn tip(&self) -> Option<Tip> {
        None
    }
}

/// The tip of a blade that ends in a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tip {
    /// The point.
    pub(crate) point: DVec3,
    /// Unit normal of the tangent plane there.
    pub(crate) normal: DVec3,
    /// Unit direction in which the lines of t = 1 leave it, if they do so in one line (Proposition 2, 3).
    pub(crate) edge: Option<DVec3>,
}

/// What stands on one side of the medial surface.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    /// The profile curve p(t).
    pub(crate) profile: Profile,
    /// The reparameterization that belongs to its x(t).
    pub(crate) pace: Pace,
    /// The scaling function d(v), mm.
    pub(crate) scale: Law,
}

impl Side {
    /// What stands on each side, the first along the normal; `ways` are profile and scale of suction and pressure side, and
    /// `suction` is the index of the suction side. Sides of one profile share u(t).
    pub(crate) fn both(
        ways: [(Profile, Law); 2],
        suction: usize,
        pace: impl Fn(&Profile) -> Result<Pace, NurbsError>,
    ) -> Result<[Self; 2], NurbsError> {
        let [(profile, scale), (other_profile, other_scale)] = ways;
        let own = pace(&profile)?;
        let other = if profile == other_profile { own.clone() } else { pace(&other_profile)? };
        let mut sides = [
            Self { profile, pace: own, scale },
            Self { profile: other_profile, pace: other, scale: other_scale },
        ];
        if suction == 1 {
            sides.reverse();
        }
        Ok(sides)
    }

    /// What is to be reported of u(t), the residual of Eq. 20.
    pub(crate) fn pace_note(sides: &[Self; 2]) -> String {
        let residual = sides[0].pace.residual.max(sides[1].pace.residual);
        format!("pace along the profile within {residual:.1e} of its mean")
    }

    /// How fast it leaves the leading edge, d y'(0) half way up, and y''(0) / (2 y'(0)).
    pub(super) fn nose(&self) -> (f64, f64) {
        let [_, slope, change] = self.profile.at(0.0);
        (self.scale.at(0.5) * slope.y, 0.5 * change.y / slope.y)
    }
}

/// The sides b(t, v) = m(u(t), v) +- d(v) n(u(t), v) y(t) (Eq. 26); t runs from the leading (0) to the trailing edge (1).
#[derive(Clone, Debug)]
pub(crate) struct Sides {
    /// The medial surface with its normals.
    pub(crate) medial: MedialSurface,
    /// The side along the normal, then the one against it.
    pub(crate) sides: [Side; 2],
}

/// Which way each side lies from the medial surface.
pub(super) const SIGN: [f64; 2] = [1.0, -1.0];

impl TwoSided for Sides {
    fn point(&self, k: usize, t: f64, v: f64) -> DVec3 {
        let side = &self.sides[k];
        let u = side.pace.at(t);
        let lift = SIGN[k] * side.scale.at(v) * side.profile.at(t)[0].y;
        self.medial.surface.point(u, v) + self.medial.normals.point(u, v) * lift
    }

    fn grid(&self, k: usize, ts: &[f64], vs: &[f64]) -> Vec<Vec<DVec3>> {
        let side = &self.sides[k];
        let scales: Vec<f64> = vs.iter().map(|&v| SIGN[k] * side.scale.at(v)).collect();
        // Surface and normals have the same knots.
        let knots = self.medial.surface.knots_v();
        let bases: Vec<_> = vs.iter().map(|&v| knots.basis(v, 0)).collect();
        let row = |&t: &f64| {
            let (u, y) = (side.pace.at(t), side.profile.at(t)[0].y);
            let (m, n) = (self.medial.surface.iso_u(u), self.medial.normals.iso_u(u));
            let point = |(basis, scale): (&Basis, &f64)| {
                let range = basis.first..=basis.first + knots.degree();
                let (m, n) = (&m.points()[range.clone()], &n.points()[range]);
                let weighted =
                    basis.values[0].iter().zip(m).zip(n).map(|((f, m), n)| (*m + *n * (scale * y)) * *f);
                weighted.sum()
            };
            bases.iter().zip(&scales).map(point).collect()
        };
        ts.iter().map(row).collect()
    }

    fn nose(&self, k: usize) -> (f64, f64) {
        self.sides[k].nose()
    }

    fn composition(&self, first: usize, tolerance: f64) -> Option<Result<Composition, NurbsError>> {
        Some(Composition::new(self, first, tolerance))
    }
}

impl Sides {
    /// Point and derivatives in t and v of side `k` at (t, v).
    pub(crate) fn derivatives(&self, k: usize, t: f64, v: f64) -> (DVec3, DVec3, DVec3) {
        let side = &self.sides[k];
        let (u, pace) = side.pace.with_slope(t);
        let [p, slope, _] = side.profile.at(t);
        let (scale, rise) = side.scale.with_slope(v);
        let (m, n) =
            (self.medial.surface.first_derivatives(u, v), self.medial.normals.first_derivatives(u, v));
        let (lift, sign) = (SIGN[k] * scale * p.y, SIGN[k]);
        let along = m.1 * pace + n.1 * (pace * lift) + n.0 * (sign * scale * slope.y);
        let up = m.2 + n.2 * lift + n.0 * (sign * rise * p.y);
        (m.0 + n.0 * lift, along, up)
    }
}
