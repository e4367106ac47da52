//! Circles and ellipses as rational quadratics.

use crate::curve::RationalCurve;
use crate::error::NurbsError;
use crate::knots::Knots;
use crate::vector::VectorSpace;
use std::f64::consts::{FRAC_PI_2, TAU};

impl<V: VectorSpace> RationalCurve<V> {
    /// The arc `centre + x cos a + y sin a` for the angle `a` from `start` to `start + sweep`, on [0, 1]: a circle if
    /// `x` and `y` have equal length and a right angle between them, in a plane or in space. Exact: rational quadratic
    /// pieces of at most 90 degrees (*The NURBS Book*, section 7.3).
    ///
    /// # Errors
    /// [`NurbsError::BadArgument`] for a sweep that is zero, beyond a full turn, or not finite;
    /// [`NurbsError::BadPoint`] for vectors that are not finite.
    pub fn arc(centre: V, x: V, y: V, start: f64, sweep: f64) -> Result<Self, NurbsError> {
        // A little slack for sweeps computed as sums.
        if !(sweep.abs() <= TAU * (1.0 + 1e-12)) || sweep == 0.0 || !start.is_finite() {
            return Err(NurbsError::BadArgument { what: "sweep of an arc", value: sweep });
        }
        let pieces = ((sweep.abs() / FRAC_PI_2 - 1e-9).ceil() as usize).clamp(1, 4);
        let step = sweep / pieces as f64;
        let weight = (0.5 * step).cos();
        let at = |angle: f64, scale: f64| {
            let (sin, cos) = angle.sin_cos();
            centre + x * (cos * scale) + y * (sin * scale)
        };
        let mut points = vec![at(start, 1.0)];
        let mut weights = vec![1.0];
        let mut values = vec![0.0; 3];
        for k in 0..pieces {
            let from = start + step * k as f64;
            points.extend([at(from + 0.5 * step, 1.0 / weight), at(from + step, 1.0)]);
            weights.extend([weight, 1.0]);
            let end = (k + 1) as f64 / pieces as f64;
            values.extend([end, end]);
        }
        values.push(1.0);
        // A full turn closes bit for bit.
        if sweep.abs() >= TAU * (1.0 - 1e-15) {
            let last = points.len() - 1;
            points[last] = points[0];
        }
        Self::new(Knots::new(2, values)?, &points, &weights)
    }
}

/// Breaks on [0, 1] for polynomial fits of an arc: one a quarter turn.
pub(crate) fn arc_points(sweep: f64) -> Vec<f64> {
    let pieces = (sweep.abs() / FRAC_PI_2).ceil().max(1.0);
    (0..=pieces as usize).map(|k| k as f64 / pieces).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::ParametricCurve;
    use glam::{DVec2, DVec3};

    #[test]
    fn arcs_are_round_and_end_where_they_should() {
        for sweep in [0.3, 1.6, -2.0, 4.0, TAU, -TAU] {
            let arc =
                RationalCurve::arc(DVec2::new(1.0, 2.0), DVec2::X * 3.0, DVec2::Y * 3.0, 0.4, sweep).unwrap();
            for i in 0..=100 {
                let p = arc.point(f64::from(i) / 100.0) - DVec2::new(1.0, 2.0);
                assert!((p.length() - 3.0).abs() < 1e-14);
            }
            let end = arc.point(1.0) - DVec2::new(1.0, 2.0);
            assert!(end.distance(DVec2::from_angle(0.4 + sweep) * 3.0) < 1e-14);
        }
        let ring = RationalCurve::arc(DVec3::Z, DVec3::X, DVec3::Y, 0.0, TAU).unwrap();
        assert_eq!(ring.point(0.0), ring.point(1.0));
        assert!(RationalCurve::arc(DVec2::ZERO, DVec2::X, DVec2::Y, 0.0, 7.0).is_err());
        assert!(RationalCurve::arc(DVec2::ZERO, DVec2::X, DVec2::Y, 0.0, 0.0).is_err());
    }
}
