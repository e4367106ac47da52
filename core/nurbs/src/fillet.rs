//! Fillets between two plane curves.
//!
//! The centre of a circle that touches two curves lies on an offset of each (thesis theorem 2.3.15): all four pairs of
//! sides are intersected.

use crate::curve::{Curve, ParametricCurve, RationalCurve};
use crate::error::NurbsError;
use crate::intersect::intersect_parametric;
use crate::offset::OffsetCurve;
use glam::DVec2;
use std::f64::consts::{PI, TAU};

/// A circle that touches two curves, and the arc between the points of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fillet {
    /// Centre of the circle.
    pub centre: DVec2,
    /// Radius of the circle.
    pub radius: f64,
    /// Parameter of the contact with the first curve.
    pub s: f64,
    /// Parameter of the contact with the second curve.
    pub t: f64,
    /// Contact with the first curve.
    pub first: DVec2,
    /// Contact with the second curve.
    pub second: DVec2,
    /// Angle of the first contact seen from the centre.
    pub start_angle: f64,
    /// Angle from the first to the second contact, the shorter way, positive to the left.
    pub sweep: f64,
    /// Whether the arc continues the first curve from its start up to `s` (else: the reversed curve from its end).
    pub keeps_start: bool,
    /// Whether the arc runs on into the second curve from `t` to its end (else: into the reversed curve).
    pub keeps_end: bool,
    /// `1 - curvature / radius^-1` of each curve towards the centre: positive where circle and curve only touch, negative
    /// where the circle is larger than the curve's own and crosses it.
    pub clearance: (f64, f64),
}

impl Fillet {
    /// The arc from the first to the second contact as a rational quadratic on [0, 1], in pieces of at most 90 degrees.
    ///
    /// # Errors
    /// [`NurbsError::BadArgument`] where both contacts coincide.
    pub fn arc(&self) -> Result<RationalCurve<DVec2>, NurbsError> {
        let (x, y) = (DVec2::X * self.radius, DVec2::Y * self.radius);
        RationalCurve::arc(self.centre, x, y, self.start_angle, self.sweep)
    }

    /// The point of the arc at a share (0 to 1) of its angle.
    pub fn point(&self, share: f64) -> DVec2 {
        self.centre + DVec2::from_angle(self.start_angle + share * self.sweep) * self.radius
    }

    /// `count` points on the arc at equal angles, the contacts included.
    pub fn sampled(&self, count: usize) -> Vec<DVec2> {
        let last = count.saturating_sub(1).max(1) as f64;
        let inner = |k: usize| match k {
            0 => self.first,
            k if k + 1 == count => self.second,
            k => self.point(k as f64 / last),
        };
        (0..count).map(inner).collect()
    }

    /// The part of the first curve that the arc continues, as a parameter interval; `domain` is the curve's.
    pub fn first_part(&self, domain: (f64, f64)) -> (f64, f64) {
        if self.keeps_start { (domain.0, self.s) } else { (self.s, domain.1) }
    }

    /// The two B-splines cut back to what the arc joins: the part of the first, the part of the second.
    ///
    /// # Errors
    /// [`NurbsError::OutOfDomain`] where nothing is left of a curve, or the fillet is not of these curves.
    pub fn trimmed(
        &self,
        a: &Curve<DVec2>,
        b: &Curve<DVec2>,
    ) -> Result<(Curve<DVec2>, Curve<DVec2>), NurbsError> {
        let (x, y) = (self.first_part(a.domain()), self.second_part(b.domain()));
        Ok((a.restricted(x.0, x.1)?, b.restricted(y.0, y.1)?))
    }

    /// The part of the second curve that continues the arc, as a parameter interval; `domain` is the curve's.
    pub fn second_part(&self, domain: (f64, f64)) -> (f64, f64) {
        if self.keeps_end { (self.t, domain.1) } else { (domain.0, self.t) }
    }
}

/// All circles of `radius` that touch both curves, on either side of each, in the order of parameters on the first.
///
/// Contacts are exact to 1e-12 of the size of the coordinates: the centre is at the radius from both, along their
/// normals. Circles that touch one curve but cross it elsewhere are among the results; see [`Fillet::clearance`].
///
/// # Errors
/// [`NurbsError::BadArgument`] for a radius that is not positive; [`NurbsError::Coincident`] where circles fit all along,
/// as between parallel lines; [`NurbsError::NoConvergence`] as [`intersect_parametric`].
pub fn fillets(
    a: &dyn ParametricCurve<DVec2>,
    b: &dyn ParametricCurve<DVec2>,
    radius: f64,
) -> Result<Vec<Fillet>, NurbsError> {
    if !(radius > 0.0 && radius.is_finite()) {
        return Err(NurbsError::BadArgument { what: "radius of a fillet", value: radius });
    }
    let mut all = vec![];
    for left in [radius, -radius] {
        for right in [radius, -radius] {
            let (x, y) = (OffsetCurve::new(a, left), OffsetCurve::new(b, right));
            for crossing in intersect_parametric(&x, &y)? {
                let clearance = (x.stretch(crossing.s), y.stretch(crossing.t));
                all.push(fillet(a, b, radius, crossing.s, crossing.t, crossing.point, clearance));
            }
        }
    }
    all.sort_by(|p, q| p.s.total_cmp(&q.s).then(p.t.total_cmp(&q.t)));
    Ok(all)
}

/// The fillet of `radius` where the first curve ends and the second one starts: the one that keeps the start of the first
/// and the end of the second, clear of both, nearest to the corner.
///
/// # Errors
/// As [`fillets`]; [`NurbsError::NotFound`] where none fits.
pub fn corner_fillet(
    a: &dyn ParametricCurve<DVec2>,
    b: &dyn ParametricCurve<DVec2>,
    radius: f64,
) -> Result<Fillet, NurbsError> {
    let corner = a.point(a.domain().1);
    let fits = |f: &Fillet| f.keeps_start && f.keeps_end && f.clearance.0 > 0.0 && f.clearance.1 > 0.0;
    let away = |f: &Fillet| f.centre.distance_squared(corner);
    let found = fillets(a, b, radius)?.into_iter().filter(fits);
    found
        .min_by(|p, q| away(p).total_cmp(&away(q)))
        .ok_or(NurbsError::NotFound { what: "fillet of this radius" })
}

fn fillet(
    a: &dyn ParametricCurve<DVec2>,
    b: &dyn ParametricCurve<DVec2>,
    radius: f64,
    s: f64,
    t: f64,
    centre: DVec2,
    clearance: (f64, f64),
) -> Fillet {
    let ([first, along_a, _], [second, along_b, _]) = (a.derivatives(s), b.derivatives(t));
    let (from, to) = (first - centre, second - centre);
    let start_angle = from.to_angle();
    let sweep = (from.perp_dot(to).atan2(from.dot(to)) + PI).rem_euclid(TAU) - PI;
    // Directions of travel along the arc where it leaves and arrives.
    let sense = if sweep >= 0.0 { 1.0 } else { -1.0 };
    let keeps_start = along_a.dot(from.perp() * sense) > 0.0;
    let keeps_end = along_b.dot(to.perp() * sense) > 0.0;
    Fillet { centre, radius, s, t, first, second, start_angle, sweep, keeps_start, keeps_end, clearance }
}
