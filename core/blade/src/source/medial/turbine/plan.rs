//! The geometry of a turbine blade, from laws to sides.

use super::Plan;
use crate::fault::Fault;
use crate::medial::{MedialSurface, Pace, Profile, Side, Sides, Streamlines, unit_normal};
use crate::source::medial::assembly::failed;
use coolinggen_nurbs::{Knots, NurbsError, ParametricSurface};

/// How close the medial surface is brought to its streamlines, in parts of their length, and the spans it is tried
/// with.
const MEDIAL: f64 = 2e-6;
/// How close its directions at the edges are brought to the angles asked, radians.
const ANGLE: f64 = 1e-8;
const SPANS: [[usize; 2]; 3] = [[32, 14], [64, 14], [64, 32]];
/// The residual of Eq. 19 that is good enough.
const PACE: f64 = 1e-5;

impl Plan<'_> {
    /// The medial surface, its knots doubled until it is close.
    pub(super) fn medial(&self) -> Result<MedialSurface, Vec<Fault>> {
        let length = self.contour.streamline(0.5, 0.5)?.length();
        let mut coarse: Option<(usize, Streamlines)> = None;
        for [around, along] in SPANS {
            let streamlines = match coarse.take() {
                Some((spans, lines)) if spans == along => lines,
                _ => Streamlines::new(self.contour.knots_v(along).map_err(failed)?, |v| {
                    self.contour.streamline(v, v)
                })?,
            };
            let knots = Knots::clamped(5, &even(around)).map_err(failed)?;
            let medial = MedialSurface::new(&knots, &streamlines).map_err(failed)?;
            let close = medial.residual <= MEDIAL * length
                && medial.normal_residual <= 1e2 * MEDIAL
                && medial.angle_residual <= ANGLE;
            if close || [around, along] == SPANS[SPANS.len() - 1] {
                return Ok(medial);
            }
            coarse = Some((along, streamlines));
        }
        Err(failed(NurbsError::NotFound { what: "spans for the medial surface" }))
    }

    /// The sides, and which of them is the suction side: the one that the medial surface bends away from.
    pub(super) fn sides(&self, medial: MedialSurface) -> Result<(Sides, usize), Vec<Fault>> {
        let suction = suction_side(&medial);
        let pace = |profile: &Profile| Pace::new(&medial.surface, profile, 3, PACE);
        let sides = Side::both(self.sections.sides.clone(), suction, pace).map_err(failed)?;
        Ok((Sides { medial, sides }, suction))
    }
}

/// 0 if the medial surface bends against its normal, else 1.
fn suction_side(medial: &MedialSurface) -> usize {
    let (around, along) = (40, 8);
    let mut sum = 0.0;
    for j in 0..=along {
        let v = f64::from(j) / f64::from(along);
        for i in 1..=around {
            let u = f64::from(i) / f64::from(around);
            let d = medial.surface.derivatives(u, v);
            // Curvature times arc length.
            sum += d.uu.dot(medial.normals.point(u, v)) / d.u.length();
        }
    }
    usize::from(sum > 0.0)
}

fn even(spans: usize) -> Vec<f64> {
    (0..=spans).map(|k| k as f64 / spans as f64).collect()
}

/// Refuses sides that fold over: thicker than the medial surface's curvature allows.
pub(super) fn unfolded(sides: &Sides) -> Result<(), Vec<Fault>> {
    let (around, along) = (60, 16);
    for k in [0, 1] {
        for (i, j) in (1..=around).flat_map(|i| (0..=along).map(move |j| (i, j))) {
            let (t, v) = (f64::from(i) / f64::from(around), f64::from(j) / f64::from(along));
            let (_, along_t, along_v) = sides.derivatives(k, t, v);
            let normal = unit_normal(&sides.medial.surface, sides.sides[k].pace.at(t), v);
            if !(along_t.cross(along_v).dot(normal) > 0.0) {
                let message = format!(
                    "the blade folds over itself at span fraction {v:.3}, {:.0} % of the way to the trailing edge",
                    100.0 * sides.sides[k].profile.at(t)[0].x
                );
                let scale = sides.sides[k].scale.at(v);
                let fault = Fault::new("/thickness", "folded", message).value(scale).unit("mm");
                return Err(vec![fault.hint("a thinner blade, or one less curved, has room for its sides")]);
            }
        }
    }
    Ok(())
}
