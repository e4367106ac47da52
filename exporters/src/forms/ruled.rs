//! Ruled surfaces that go on past the faces on them.
//!
//! Where two faces share an edge, FreeCAD's check has OpenCASCADE intersect their surfaces, and calls them
//! self-intersecting if what comes out is not the edge. A bore's rulings end on the edge, so that the curve to be followed is
//! the very border of one surface: it is left by rounding and found in pieces, some of them off by 1e-5 mm although both
//! surfaces pass within 1e-8 mm of the edge. A surface that goes on gives one curve, to 1e-7 mm.

use coolinggen_nurbs::Surface;
use glam::DVec3;

/// How far the rulings go on at either end, of their length.
const PAST: f64 = 0.02;

/// The surface with its rulings along v drawn out past both ends, in the same parameters; none where it is not ruled along
/// v, or where rulings that run together would cross.
pub(crate) fn drawn_out(surface: &Surface<DVec3>) -> Option<Surface<DVec3>> {
    if surface.knots_v().degree() != 1 || surface.counts().1 != 2 {
        return None;
    }
    let (start, end) = surface.knots_v().domain();
    let past = PAST * (end - start);
    let out = surface.extended_v(past, past).ok()?;
    let legs = |s: &Surface<DVec3>| -> Vec<DVec3> {
        s.points().windows(4).step_by(2).flat_map(|w| [w[2] - w[0], w[3] - w[1]]).collect()
    };
    legs(surface).iter().zip(legs(&out)).all(|(before, after)| before.dot(after) >= 0.0).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use coolinggen_nurbs::{Knots, ParametricSurface};

    /// A quarter of a bore whose upper ring is `scale` times the lower one, ruled in v or across.
    fn quarter(scale: f64, degree_v: usize) -> Surface<DVec3> {
        let ring = [(1.0, 0.0), (1.0, 0.55), (0.55, 1.0), (0.0, 1.0)];
        let rows = |z: usize| 1.0 + (scale - 1.0) * z as f64 / degree_v as f64;
        let at = |(x, y): (f64, f64), z: usize| DVec3::new(x * rows(z), y * rows(z), 6.0 * z as f64);
        let points = ring.into_iter().flat_map(|p| (0..=degree_v).map(move |z| at(p, z))).collect();
        let knots = |degree| Knots::clamped(degree, &[0.0, 1.0]).unwrap();
        Surface::new(knots(3), knots(degree_v), points).unwrap()
    }

    #[test]
    fn rulings_go_on_and_keep_their_parameters() {
        let surface = quarter(2.5, 1);
        let out = drawn_out(&surface).unwrap();
        assert_eq!(out.knots_v().domain(), (-PAST, 1.0 + PAST));
        assert_eq!(out.knots_u().values(), surface.knots_u().values());
        for (u, v) in [(0.0, 0.0), (0.3, 0.0), (0.7, 0.4), (1.0, 1.0), (0.2, 1.0)] {
            assert!(out.point(u, v).distance(surface.point(u, v)) < 1e-14);
        }
        let (low, high) = (surface.point(0.4, 0.0), surface.point(0.4, 1.0));
        assert!(out.point(0.4, -PAST).distance(low - (high - low) * PAST) < 1e-14);
    }

    #[test]
    fn rulings_that_run_together_do_not_cross() {
        assert!(drawn_out(&quarter(0.03, 1)).is_some());
        assert!(drawn_out(&quarter(0.01, 1)).is_none());
        assert!(drawn_out(&quarter(2.5, 3)).is_none());
    }
}
