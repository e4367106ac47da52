//! Sections of surfaces by planes.

mod common;

use common::{blade, revolved, surface};
use coolinggen_nurbs::{
    BezierSurface, Interpolator, Knots, NurbsError, ParametricCurve, PlaneSection, RationalSurface, Surface,
    intersect_plane,
};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

fn sphere() -> RationalSurface<DVec3> {
    let h = 0.5f64.sqrt();
    let meridian = [(0.0, -2.0), (2.0, -2.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
    revolved(Knots::new(2, vec![0., 0., 0., 1., 1., 2., 2., 2.]).unwrap(), &meridian, &[1., h, 1., h, 1.])
}

fn torus() -> RationalSurface<DVec3> {
    let h = 0.5f64.sqrt();
    let square =
        [(4., 0.), (4., 1.), (3., 1.), (2., 1.), (2., 0.), (2., -1.), (3., -1.), (4., -1.), (4., 0.)];
    let knots = Knots::new(2, vec![0., 0., 0., 1., 1., 2., 2., 3., 3., 4., 4., 4.]).unwrap();
    revolved(knots, &square, &[1., h, 1., h, 1., h, 1., h, 1.])
}

/// `0.5 sin x sin y` over two periods in both directions.
fn waves() -> Surface<DVec3> {
    let t: Vec<f64> = (0..=48).map(|i| f64::from(i) / 48.0 * 4.0 * std::f64::consts::PI).collect();
    let fit = Interpolator::new(3, &t).unwrap();
    let column = |y: f64| {
        let points: Vec<DVec3> = t.iter().map(|&x| DVec3::new(x, y, 0.5 * x.sin() * y.sin())).collect();
        fit.curve(&points).unwrap()
    };
    fit.loft(&t.iter().map(|&y| column(y)).collect::<Vec<_>>()).unwrap()
}

/// Every point on both things, parameters that go with points, steps as asked, and no point twice.
fn verify<S: BezierSurface<Space = DVec3>>(
    s: &S,
    section: &PlaneSection,
    origin: DVec3,
    n: DVec3,
    longest: f64,
) {
    let n = n.normalize();
    for b in &section.branches {
        assert_eq!(b.points.len(), b.parameters.len());
        for (x, p) in b.points.iter().zip(&b.parameters) {
            assert!((*x - origin).dot(n).abs() <= 1e-9);
            assert!(s.point(p.x, p.y).distance(*x) < 1e-9);
        }
        assert!(b.points.windows(2).all(|w| w[0].distance(w[1]) <= 2.1 * longest && w[0] != w[1]));
        let ((u0, u1), (v0, v1)) = s.domain();
        if !b.closed {
            for p in [b.parameters[0], b.parameters[b.parameters.len() - 1]] {
                let border =
                    [p.x - u0, u1 - p.x, p.y - v0, v1 - p.y].into_iter().fold(f64::INFINITY, f64::min);
                assert!(border.abs() < 1e-12, "an open end inside: {p}");
            }
        }
    }
}

fn length(section: &PlaneSection) -> f64 {
    section.branches.iter().flat_map(|b| b.points.windows(2)).map(|w| w[0].distance(w[1])).sum()
}

static RUNS: AtomicUsize = AtomicUsize::new(0);
static REFUSED: AtomicUsize = AtomicUsize::new(0);

proptest! {
    #![proptest_config(common::fixed())]

    #[test]
    fn sections_of_a_sphere_are_circles(n in common::point(), share in -0.99f64..0.99) {
        prop_assume!(n.length() > 0.1);
        let n = n.normalize();
        let (s, origin) = (sphere(), n * (2.0 * share));
        // Planes through a pole of the parameters are singular there.
        let pole = |z: f64| (DVec3::Z * z - origin).dot(n).abs();
        prop_assume!(pole(2.0) > 1e-3 && pole(-2.0) > 1e-3);
        let section = intersect_plane(&s, origin, n, 1e-3, 0.2).unwrap();
        verify(&s, &section, origin, n, 0.2);
        let radius = 2.0 * (1.0 - share * share).sqrt();
        for x in section.branches.iter().flat_map(|b| &b.points) {
            prop_assert!((x.distance(origin) - radius).abs() < 1e-9);
        }
        // The whole circle: chords fall short of it by the sagitta only.
        let round = std::f64::consts::TAU * radius;
        prop_assert!(length(&section) < round && length(&section) > round * 0.98 - 1e-6, "{} of {}", length(&section), round);
    }

    #[test]
    fn random_surfaces_are_cut_where_samples_change_sides(s in surface(), n in common::point(), origin in common::point()) {
        prop_assume!(n.length() > 0.2);
        let (n, origin) = (n.normalize(), origin * 0.3);
        // Random surfaces have folds, where both derivatives are parallel: there the march says no. That is rare.
        let runs = RUNS.fetch_add(1, Relaxed) + 1;
        let section = match intersect_plane(&s, origin, n, 1e-3, 0.05) {
            Ok(section) => section,
            Err(e) => {
                let no_convergence = matches!(e, NurbsError::NoConvergence { .. });
                prop_assert!(no_convergence);
                prop_assert!(REFUSED.fetch_add(1, Relaxed) <= runs / 100);
                return Ok(());
            }
        };
        for b in section.branches.iter().filter(|b| !b.closed) {
            for p in [b.parameters[0], b.parameters[b.parameters.len() - 1]] {
                let border = [p.x, 1.0 - p.x, p.y, 1.0 - p.y].into_iter().fold(f64::INFINITY, f64::min);
                prop_assert!(border.abs() < 1e-12, "an open end inside: {}", p);
            }
        }
        let steps: Vec<_> = section.branches.iter().flat_map(|b| b.parameters.windows(2)).collect();
        for (x, p) in section.branches.iter().flat_map(|b| b.points.iter().zip(&b.parameters)) {
            prop_assert!((*x - origin).dot(n).abs() <= 1e-9);
            prop_assert!(s.point_at(*p).distance(*x) < 1e-9);
        }
        let g = |i: i32, j: i32| (s.point_at(DVec2::new(f64::from(i), f64::from(j)) / 40.0) - origin).dot(n);
        for i in 0..40 {
            for j in 0..40 {
                let corners = [g(i, j), g(i + 1, j), g(i, j + 1), g(i + 1, j + 1)];
                if corners.iter().any(|c| *c > 0.0) && corners.iter().any(|c| *c < 0.0) {
                    let centre = DVec2::new(f64::from(i) + 0.5, f64::from(j) + 0.5) / 40.0;
                    let foot = |w: &&[DVec2]| {
                        let way = w[1] - w[0];
                        let share = ((centre - w[0]).dot(way) / way.length_squared()).clamp(0.0, 1.0);
                        (w[0] + way * share).distance(centre)
                    };
                    let near = steps.iter().map(foot).fold(f64::INFINITY, f64::min);
                    prop_assert!(near < 0.05, "a branch near {} is missing: {}", centre, near);
                }
            }
        }
    }
}

trait At {
    fn point_at(&self, p: DVec2) -> DVec3;
}

impl<S: coolinggen_nurbs::ParametricSurface<DVec3>> At for S {
    fn point_at(&self, p: DVec2) -> DVec3 {
        self.point(p.x, p.y)
    }
}

#[test]
fn a_torus_has_two_circles_above_its_middle() {
    let s = torus();
    let section = intersect_plane(&s, DVec3::Z * 0.6, DVec3::Z, 1e-4, 0.5).unwrap();
    verify(&s, &section, DVec3::Z * 0.6, DVec3::Z, 0.5);
    assert_eq!(section.branches.len(), 2);
    let mut radii: Vec<f64> = section.branches.iter().map(|b| b.points[0].truncate().length()).collect();
    radii.sort_by(f64::total_cmp);
    assert!((radii[0] - 2.2).abs() < 1e-9 && (radii[1] - 3.8).abs() < 1e-9);
    // Both close over the seam in u.
    for b in &section.branches {
        assert!(b.closed);
        let c = b.interpolated().unwrap();
        let (start, end) = c.domain();
        for k in 0..=500 {
            let p = c.point(start + (end - start) * f64::from(k) / 500.0);
            assert!(
                (p.z - 0.6).abs() < 1e-9
                    && (p.truncate().length() - b.points[0].truncate().length()).abs() < 1e-4
            );
        }
    }
    assert_eq!(intersect_plane(&s, DVec3::Z * 1.1, DVec3::Z, 1e-4, 0.5).unwrap(), PlaneSection::default());
}

#[test]
fn a_loop_inside_a_patch_is_found_and_closed() {
    let s = torus();
    // A plane that cuts a small lens off the outside, between the seams.
    let n = DVec3::new(0.3f64.cos(), 0.3f64.sin(), 0.0) * 0.8 + DVec3::Z * 0.6;
    let origin = DVec3::new(0.3f64.cos(), 0.3f64.sin(), 0.0) * 3.0 + n * 0.97;
    let section = intersect_plane(&s, origin, n, 1e-4, 0.1).unwrap();
    verify(&s, &section, origin, n, 0.1);
    assert_eq!(section.branches.len(), 1);
    assert!(section.branches[0].closed);
    // And one that only touches there.
    let touching = intersect_plane(&s, origin + n * 0.03, n, 1e-4, 0.1).unwrap();
    assert_eq!((touching.branches.len(), touching.contacts.len()), (0, 1), "{touching:?}");
    let at = s.point_at(touching.contacts[0]);
    assert!(at.distance(origin + n * 0.03) < 1e-7);
    assert_eq!(intersect_plane(&s, origin + n * 0.0301, n, 1e-4, 0.1).unwrap(), PlaneSection::default());
}

#[test]
fn a_plane_through_a_saddle_gives_crossing_branches() {
    // x = 2 touches the inner equator: a figure of eight.
    let s = torus();
    let (origin, n) = (DVec3::new(0.0, 2.0, 0.0), DVec3::Y);
    let section = intersect_plane(&s, origin, n, 1e-3, 0.1).unwrap();
    verify(&s, &section, origin, n, 0.1);
    // (x^2 + y^2 + z^2 + 8)^2 = 36 (x^2 + y^2): Bernoulli-like, both lobes to x = sqrt(12) and z = 1.
    let extent = section.branches.iter().flat_map(|b| &b.points).fold(DVec3::ZERO, |m, p| m.max(p.abs()));
    assert!((extent.x - 12f64.sqrt()).abs() < 2e-3 && (extent.z - 1.0).abs() < 0.2, "{extent}");
    let right = |x: f64| section.branches.iter().flat_map(|b| &b.points).filter(|p| p.x * x > 0.5).count();
    assert!(right(1.0) > 20 && right(-1.0) > 20);
}

#[test]
fn all_hills_of_a_wavy_surface_are_found() {
    let s = waves();
    for (z, hills) in [(0.2, 8), (-0.3, 8), (0.45, 8), (0.51, 0)] {
        let section = intersect_plane(&s, DVec3::Z * z, DVec3::Z, 1e-3, 0.3).unwrap();
        verify(&s, &section, DVec3::Z * z, DVec3::Z, 0.3);
        assert_eq!(section.branches.len(), hills, "{z}");
        assert!(section.branches.iter().all(|b| b.closed));
    }
    // A slanted plane across everything: open branches from border to border.
    let (origin, n) = (DVec3::new(6.0, 6.0, 0.0), DVec3::new(1.0, 0.3, 0.2));
    let section = intersect_plane(&s, origin, n, 1e-3, 0.3).unwrap();
    verify(&s, &section, origin, n.normalize(), 0.3);
    assert_eq!(section.branches.len(), 1);
    assert!(!section.branches[0].closed);
}

#[test]
fn a_blade_is_cut_at_any_height_its_border_too() {
    let s = blade();
    for z in [0.0, 1e-7, 13.0, 35.0, 69.9999, 70.0] {
        let section = intersect_plane(&s, DVec3::Z * z, DVec3::Z, 1e-3, 2.0).unwrap();
        verify(&s, &section, DVec3::Z * z, DVec3::Z, 2.0);
        assert_eq!(section.branches.len(), 1, "{z}");
        let b = &section.branches[0];
        assert!(b.closed, "{z}");
        let u: Vec<f64> = b.parameters.iter().map(|p| p.x).collect();
        assert!(u.windows(2).all(|w| w[0] < w[1]) || u.windows(2).all(|w| w[0] > w[1]), "{z}");
        assert!((u[0] - u[u.len() - 1]).abs() == 1.0);
    }
    assert_eq!(intersect_plane(&s, DVec3::Z * 70.001, DVec3::Z, 1e-3, 2.0).unwrap(), PlaneSection::default());
    let tilted = DVec3::new(0.2, -0.3, 1.0);
    let section = intersect_plane(&s, DVec3::Z * 35.0, tilted, 1e-3, 2.0).unwrap();
    verify(&s, &section, DVec3::Z * 35.0, tilted, 2.0);
    assert_eq!((section.branches.len(), section.branches[0].closed), (1, true));
    assert!(matches!(
        intersect_plane(&s, DVec3::ZERO, DVec3::ZERO, 1.0, 1.0),
        Err(NurbsError::BadArgument { .. })
    ));
    let flat = Surface::new(
        Knots::uniform(1, 2).unwrap(),
        Knots::uniform(1, 2).unwrap(),
        vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::X + DVec3::Y],
    )
    .unwrap();
    assert!(matches!(
        intersect_plane(&flat, DVec3::ZERO, DVec3::Z, 1.0, 1.0),
        Err(NurbsError::Coincident { .. })
    ));
    let diagonal = intersect_plane(&flat, DVec3::ZERO, DVec3::new(1.0, -1.0, 0.0), 1e-3, 0.3).unwrap();
    assert_eq!(diagonal.branches.len(), 1);
    assert!((length(&diagonal) - 2f64.sqrt()).abs() < 1e-12);
}
