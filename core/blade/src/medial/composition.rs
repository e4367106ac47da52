//! Both sides as one B-spline, exactly, and brought to a lower degree and fewer knots (section 3.4).

use super::sides::{SIGN, Sides, TwoSided};
use crate::law::Law;
use coolinggen_nurbs::{Curve, NurbsError, Surface};
use glam::DVec3;

/// The sides b(t, v) = m(u(t), v) +- d(v) n(u(t), v) y(t) (Eq. 26) as one B-spline surface S(s, v) by composition and
/// products: s runs over [0, 1] evenly in t, backwards along one side from its trailing edge to the nose, and on along the
/// other.
#[derive(Clone, Debug)]
pub(crate) struct Composition {
    /// The surface.
    pub(crate) surface: Surface<DVec3>,
    /// s at the leading edge.
    pub(crate) nose: f64,
    /// How far it is off at most, mm: nothing where the scales are polynomials of v, pieces of them, or constant.
    pub(crate) residual: f64,
}

/// Part of the tolerance that the scales as functions of v may take, and of what is left for each step: degree and knots
/// along the blade, degree and knots around it. They add up to 1.
const SCALES: f64 = 1e-3;
const STEPS: [f64; 4] = [0.15, 0.25, 0.25, 0.349];
/// How far points may move where the sides join with one derivative, in parts of the tolerance; else they do not.
const JOINT: f64 = 1e-4;

impl Composition {
    /// The composition that begins with side `first`, its scales within a part of `tolerance`, mm.
    ///
    /// # Errors
    /// [`NurbsError::NoConvergence`] where the sides leave the leading edge with speeds whose ratio changes along the
    /// span: they then have no derivative in common there.
    pub(super) fn new(sides: &Sides, first: usize, tolerance: f64) -> Result<Self, NurbsError> {
        let (scales, residual) = functions([0, 1].map(|k| &sides.sides[k].scale), SCALES * tolerance)?;
        let profiles = [0, 1].map(|k| sides.sides[k].profile.heights());
        let profiles = <[_; 2]>::from(profiles[0].compatible(&profiles[1])?);
        // Sides of one profile share u(t).
        let own = paced(sides, first)?;
        let shared = sides.sides[0].profile == sides.sides[1].profile;
        let other = if shared { own.clone() } else { paced(sides, 1 - first)? };
        let a = side(&own, SIGN[first], &profiles[first], &scales[first])?;
        let b = side(&other, SIGN[1 - first], &profiles[1 - first], &scales[1 - first])?;
        let speed = [first, 1 - first].map(|k| sides.nose(k).0);
        let nose = speed[0] / (speed[0] + speed[1]);
        let columns = (0..a.counts().1).map(|j| {
            let before = column(&a, j)?.reversed().reparameterized(0.0, nose);
            let after = column(&b, j)?.reparameterized(nose, 1.0);
            let whole = Curve::joined(&[before, after], JOINT * tolerance)?;
            Ok(whole.with_knot_removed(nose, JOINT * tolerance)?.0)
        });
        let columns = columns.collect::<Result<Vec<_>, NurbsError>>()?;
        let surface = Surface::from_columns(&columns, a.knots_v().clone())?;
        Ok(Self { surface, nose, residual })
    }

    /// A surface of `degree` within `tolerance` (mm) of the sides at equal parameters, that is proved: degrees
    /// are reduced, then knots removed, as long as control points say that no point moves too far. It has two
    /// continuous derivatives over the nose, where the composition has one.
    pub(super) fn within(&self, degree: [usize; 2], tolerance: f64) -> Result<Surface<DVec3>, NurbsError> {
        let share = |step: usize| STEPS[step] * tolerance;
        let (along, _) = self.surface.lowered_v(degree[1], share(0))?;
        let (along, _) = along.simplified_v(share(1))?;
        let (around, _) = along.lowered_u(degree[0], share(2))?;
        Ok(around.simplified_u(share(3))?.0)
    }
}

/// m(u(t), v) and n(u(t), v) for the u(t) of side `k`.
fn paced(sides: &Sides, k: usize) -> Result<[Surface<DVec3>; 2], NurbsError> {
    let pace = sides.sides[k].pace.curve();
    Ok([sides.medial.surface.composed_u(pace)?, sides.medial.normals.composed_u(pace)?])
}

/// A side over t and v, along the normals (`sign` 1) or against them (-1).
fn side(
    [medial, normals]: &[Surface<DVec3>; 2],
    sign: f64,
    profile: &Curve<f64>,
    scale: &Curve<f64>,
) -> Result<Surface<DVec3>, NurbsError> {
    // The medial surface times one, so that degrees and knots are those of what is added to it.
    let one = |f: &Curve<f64>| f.map(|_| 1.0);
    let middle = medial.times_v(&one(scale))?.times_u(&one(profile))?;
    let lift = normals.times_v(scale)?.times_u(profile)?;
    let points = middle.points().iter().zip(lift.points()).map(|(m, l)| *m + *l * sign);
    let (knots_u, knots_v) = (middle.knots_u().clone(), middle.knots_v().clone());
    Surface::new(knots_u, knots_v, points.collect())
}

/// Both scales as functions of v with the same degree and knots, and how far they are off.
fn functions(scales: [&Law; 2], tolerance: f64) -> Result<([Curve<f64>; 2], f64), NurbsError> {
    let (a, off_a) = scales[0].function(tolerance)?;
    let (b, off_b) = scales[1].function(tolerance)?;
    Ok((a.compatible(&b)?.into(), off_a.max(off_b)))
}

fn column(surface: &Surface<DVec3>, j: usize) -> Result<Curve<DVec3>, NurbsError> {
    let points = surface.points().iter().skip(j).step_by(surface.counts().1);
    Curve::new(surface.knots_u().clone(), points.copied().collect())
}
