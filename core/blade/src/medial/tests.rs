//! The paper's lemmas and propositions, on a runner blade whose streamlines turn from radial to axial.

use super::*;
use crate::fault::Pointer;
use crate::law::{Law, LawSpec};
use crate::stream::{Annular, ContourSpec, SpaceSpec, StreamSpace};
use coolinggen_nurbs::{Knots, NurbsError, ParametricCurve, ParametricSurface, project_on_surface};
use glam::{DVec2, DVec3};

const HUB: [[f64; 2]; 6] =
    [[0.0, 215.0], [6.0, 165.0], [25.0, 118.0], [52.0, 88.0], [100.0, 60.0], [168.0, 44.0]];
const SHROUD: [[f64; 2]; 6] =
    [[62.0, 225.0], [66.0, 197.0], [82.0, 174.0], [110.0, 162.0], [140.0, 158.0], [170.0, 158.0]];

fn law(points: &[[f64; 2]]) -> Law {
    LawSpec::Points(points.to_vec()).law(&Pointer::root()).unwrap()
}

/// A blade's parameters; angles in degrees.
struct Runner {
    space: Annular,
    traces: [Trace; 2],
    phi: [Law; 2],
    beta: [Law; 2],
    zeta: [Law; 2],
}

fn runner() -> Runner {
    let contour = |p: &[[f64; 2]]| ContourSpec::Points(p.to_vec());
    let spec = SpaceSpec::Annular { hub: contour(&HUB), shroud: contour(&SHROUD) };
    let StreamSpace::Annular(space) = spec.space(&Pointer::root()).unwrap() else { panic!("not annular") };
    let trace =
        |p: &[[f64; 2]]| Trace::new(contour(p).curve(&Pointer::root()).unwrap(), &space, false).unwrap();
    let traces = [
        trace(&[[0.5, 204.0], [32.0, 200.0], [66.0, 197.0]]),
        trace(&[[84.0, 67.0], [112.0, 112.0], [128.0, 159.0]]),
    ];
    Runner {
        traces,
        phi: [law(&[[0.0, 0.0], [0.5, 4.0], [1.0, 6.0]]), law(&[[0.0, 62.0], [0.5, 58.0], [1.0, 60.0]])],
        beta: [law(&[[0.0, 78.0], [0.5, 72.0], [1.0, 66.0]]), law(&[[0.0, 38.0], [0.5, 28.0], [1.0, 21.0]])],
        zeta: [law(&[[0.0, 0.3], [0.5, 0.4], [1.0, 0.35]]), law(&[[0.0, 0.35], [1.0, 0.3]])],
        space,
    }
}

impl Runner {
    fn streamline(&self, v: f64) -> Streamline {
        let surface = self.space.surface(v).unwrap();
        let m = [0, 1].map(|i| surface.chart_of_station(self.traces[i].station(&self.space, v).unwrap()));
        let angles = Angles {
            phi: [0, 1].map(|i| self.phi[i].at(v).to_radians()),
            beta: [0, 1].map(|i| self.beta[i].at(v).to_radians()),
            zeta: [0, 1].map(|i| self.zeta[i].at(v)),
        };
        Streamline::new(surface, m, &angles).unwrap()
    }

    fn medial(&self, spans: [usize; 2]) -> MedialSurface {
        let lines = |knots| Streamlines::new::<()>(knots, |v| Ok(self.streamline(v))).unwrap();
        let knots = |spans: usize| Knots::uniform(5, spans + 5).unwrap();
        MedialSurface::new(&knots(spans[0]), &lines(knots(spans[1]))).unwrap()
    }

    fn sides(&self, thickness: [&[[f64; 2]]; 2]) -> Sides {
        let medial = self.medial([32, 8]);
        let profile = Profile::naca_four_digit(false).unwrap();
        let pace = Pace::new(&medial.surface, &profile, 3, 1e-5).unwrap();
        let side = |t| Side { profile: profile.clone(), pace: pace.clone(), scale: law(t) };
        Sides { medial, sides: thickness.map(side) }
    }
}

const THICKNESS: [&[[f64; 2]]; 2] = [&[[0.0, 12.0], [1.0, 8.0]]; 2];

/// Angle in degrees of `direction` from the circle about the machine axis through `p`, growing theta.
fn blade_angle(p: DVec3, direction: DVec3) -> f64 {
    direction.angle_between(DVec3::new(0.0, p.z, -p.y)).to_degrees()
}

#[test]
fn the_map_of_a_stream_surface_is_conformal_and_inverted_to_1e_10() {
    let runner = runner();
    for v in [0.0, 0.21, 0.5, 0.77, 1.0] {
        let surface = runner.space.surface(v).unwrap();
        let meridian = surface.meridian().unwrap().clone();
        let radius = meridian.point(0.5).y;
        let mut m = surface.chart_of_station(0.1);
        for k in 0..80 {
            let s = 0.1 + 0.01 * f64::from(k);
            // Eq. 3 with 2000 steps of Simpson's rule in place of the tables.
            let density = |s: f64| {
                let [p, d, _] = meridian.derivatives(s);
                d.length() / p.y
            };
            let q = DVec2::new(surface.chart_of_station(s), radius * (0.03 * f64::from(k) - 1.1));
            assert!((q.x - m).abs() < 1e-10 * radius, "{v} {s}: {} {m}", q.x);
            let h = 0.01 / 2000.0;
            let sum: f64 = (0..1000)
                .map(|i| {
                    let a = s + 2.0 * h * f64::from(i);
                    density(a) + 4.0 * density(a + h) + density(a + 2.0 * h)
                })
                .sum();
            m += radius * sum * h / 3.0;
            let (p, along_m, along_t) = surface.to_space_derivatives(q);
            assert!((surface.to_chart(p) - q).length() < 1e-10 * radius);
            assert!(
                along_m.dot(along_t).abs() < 1e-14 && (along_m.length() - along_t.length()).abs() < 1e-14
            );
        }
    }
}

#[test]
fn streamlines_keep_their_angles_in_space() {
    let runner = runner();
    let medial = runner.medial([32, 12]);
    for k in 0..=60 {
        let v = f64::from(k) / 60.0;
        let line = runner.streamline(v);
        for (i, u) in [(0, 0.0), (1, 1.0)] {
            let asked = runner.beta[i].at(v);
            let (p, along) = line.at(u);
            assert!((blade_angle(p, along) - asked).abs() < 1e-9);
            let phi = p.y.atan2(p.z).to_degrees();
            assert!((phi - runner.phi[i].at(v)).abs() < 1e-11);
            // The B-spline surface: its second derivative where the first is zero.
            let d = medial.surface.derivatives(u, v);
            let along = if i == 0 { d.uu } else { d.u };
            assert!(
                (blade_angle(d.point, along) - asked).abs() < 1e-6,
                "{v} {}",
                blade_angle(d.point, along) - asked
            );
            assert!(d.point.distance(p) < 1e-6, "{v} {:e}", d.point.distance(p));
        }
    }
}

#[test]
fn the_medial_surface_stands_still_at_the_leading_edge_and_has_normals_there() {
    let medial = runner().medial([64, 12]);
    let columns = medial.surface.counts().1;
    let points = medial.surface.points();
    assert_eq!(&points[..columns], &points[columns..2 * columns]);
    assert!(medial.residual < 5e-4, "{:e}", medial.residual);
    assert!(medial.normal_residual < 1e-4, "{:e}", medial.normal_residual);
    for v in [0.0, 0.3, 0.5, 0.9, 1.0] {
        assert_eq!(medial.surface.derivatives(0.0, v).u, DVec3::ZERO);
        // Lemma 2: the normals run into Eq. 13 without a jump.
        let edge = unit_normal(&medial.surface, 0.0, v);
        for u in [1e-9, 1e-7, 0.9999e-5, 1.0001e-5, 1e-4] {
            let near = unit_normal(&medial.surface, u, v);
            assert!(near.distance(edge) < 10.0 * u + 1e-10, "{u} {:e}", near.distance(edge));
        }
        let d = medial.surface.derivatives(0.0, v);
        assert!(edge.dot(d.v.normalize()).abs() < 1e-12 && edge.dot(d.uu.normalize()).abs() < 1e-12);
    }
}

#[test]
fn more_control_points_bring_the_medial_surface_closer() {
    let runner = runner();
    let residuals = [8, 16, 32].map(|n| runner.medial([n, 8]).residual);
    assert!(residuals[1] < 0.3 * residuals[0] && residuals[2] < 0.3 * residuals[1], "{residuals:?}");
}

#[test]
fn the_pace_follows_the_profile() {
    let medial = runner().medial([32, 8]);
    let profile = Profile::naca_four_digit(false).unwrap();
    // As in the paper, and the degree that is used.
    for (degree, tolerance) in [(2, 2e-3), (3, 1e-5)] {
        let pace = Pace::new(&medial.surface, &profile, degree, tolerance).unwrap();
        assert!(pace.residual <= tolerance, "{degree} {:e}", pace.residual);
        assert_eq!((pace.at(0.0), pace.at(1.0)), (0.0, 1.0));
        for v in [0.0, 0.4, 1.0] {
            let n = 4000;
            let point = |i: u32| medial.surface.point(pace.at(f64::from(i) / f64::from(n)), v);
            let mut walked = vec![0.0];
            for i in 0..n {
                walked.push(walked[i as usize] + point(i).distance(point(i + 1)));
            }
            for i in (0..=n).step_by(100) {
                let part = walked[i as usize] / walked[n as usize];
                let asked = profile.at(f64::from(i) / f64::from(n))[0].x;
                assert!((part - asked).abs() < tolerance, "{degree} {v} {i} {:e}", part - asked);
            }
        }
    }
}

#[test]
fn knots_are_inserted_until_the_pace_is_right() {
    let medial = runner().medial([32, 8]);
    let profile = Profile::naca_four_digit(false).unwrap();
    let pace = |tolerance| Pace::new(&medial.surface, &profile, 2, tolerance).unwrap();
    let (coarse, fine) = (pace(0.05), pace(1e-3));
    assert!(coarse.residual > fine.residual && coarse.count() < fine.count());
}

#[test]
fn proposition_1_holds_for_the_sides() {
    let sides = runner().sides(THICKNESS);
    for k in 0..=50 {
        let v = f64::from(k) / 50.0;
        let [a, b] = [0, 1].map(|side| sides.derivatives(side, 0.0, v));
        assert_eq!(a.0, b.0);
        assert!((a.1 + b.1).length() <= 1e-9 * a.1.length(), "{v} {:?} {:?}", a.1, b.1);
        let normal = unit_normal(&sides.medial.surface, 0.0, v);
        assert!(a.1.normalize().distance(normal) < 1e-4);
    }
}

#[test]
fn proposition_1_holds_for_the_final_b_splines() {
    let sides = runner().sides(THICKNESS);
    for size in [
        SkinSize { degree: [2, 2], counts: [20, 10], optimised: false },
        SkinSize { degree: [3, 3], counts: [20, 10], optimised: true },
    ] {
        let skin = Skin::new(&sides, 1, size).unwrap();
        joined_at_the_nose(&sides, &skin);
    }
    let skin = Skin::within(&sides, 1, [3, 3], 1e-3, 1).unwrap();
    joined_at_the_nose(&sides, &skin);
    for v in [0.0, 1.0] {
        assert!(skin.surface.point(skin.place(0, 0.0), v).distance(nose_point(&sides, v)) < 1e-9);
    }
}

#[test]
fn a_composition_is_both_sides_exactly_and_its_skin_stays_within_the_tolerance() {
    // The second pair of scales is no polynomial of v.
    let bent: [&[[f64; 2]]; 2] =
        [&[[0.0, 12.0], [0.2, 11.0], [1.0, 8.0]], &[[0.0, 6.0], [0.2, 5.5], [1.0, 4.0]]];
    for thickness in [THICKNESS, bent] {
        let sides = runner().sides(thickness);
        let tolerance = 1e-3;
        let exact = sides.composition(1, tolerance).unwrap().unwrap();
        assert!(if thickness == bent { exact.residual < 1e-3 * tolerance } else { exact.residual == 0.0 });
        let skin = Skin::composed(&exact, 1, [3, 3], tolerance).unwrap();
        joined_at_the_nose(&sides, &skin);
        let (mut off, mut greatest) = (0.0f64, 0.0f64);
        for (k, i, j) in (0..2).flat_map(|k| (0..=97).flat_map(move |i| (0..=23).map(move |j| (k, i, j)))) {
            let (t, v) = (f64::from(i) / 97.0, f64::from(j) / 23.0);
            let (s, asked) = (skin.place(k, t), sides.point(k, t, v));
            off = off.max(exact.surface.point(s, v).distance(asked));
            greatest = greatest.max(skin.surface.point(s, v).distance(asked));
        }
        // Joining takes a knot away, which costs up to a ten-thousandth of the tolerance.
        assert!(off < 2e-4 * tolerance + exact.residual, "{off:e}");
        assert!(greatest <= tolerance, "{greatest:e}");
        let (composed, full) = (skin.surface.counts(), exact.surface.counts());
        assert!(composed.0 * composed.1 * 20 < full.0 * full.1, "{composed:?} of {full:?}");
    }
}

#[test]
fn sides_without_a_common_tangent_are_not_composed() {
    let sides = runner().sides([&[[0.0, 12.0], [1.0, 8.0]], &[[0.0, 7.0], [1.0, 2.0]]]);
    assert!(matches!(sides.composition(0, 1e-3), Some(Err(NurbsError::NoConvergence { .. }))));
}

/// The two sides as B-splines of their own: opposite derivatives, one normal and the asked leading edge between them.
fn joined_at_the_nose(sides: &Sides, skin: &Skin) {
    let nose = skin.place(0, 0.0);
    let backwards = skin.surface.restricted_u(0.0, nose).unwrap();
    let onwards = skin.surface.restricted_u(nose, 1.0).unwrap();
    for k in 0..=40 {
        let v = f64::from(k) / 40.0;
        let (a, b) = (backwards.first_derivatives(nose, v), onwards.first_derivatives(nose, v));
        // Both run away from the leading edge: b_1(-) is the derivative against s.
        assert!((b.1 - a.1).length() <= 1e-9 * b.1.length(), "{v} {:e}", (b.1 - a.1).length() / b.1.length());
        let normals = [a, b].map(|d| d.1.cross(d.2).normalize());
        assert!(normals[0].distance(normals[1]) < 1e-9);
        // With few control points the nose is not met, and lines of constant s lean.
        let off =
            project_on_surface(&skin.surface, sides.point(0, 0.0, v), (nose, v), false).unwrap().distance;
        assert!(off < 2e-2, "{v} {off:e}");
    }
}

fn nose_point(sides: &Sides, v: f64) -> DVec3 {
    sides.medial.surface.point(0.0, v)
}

#[test]
fn sides_of_different_thickness_meet_smoothly() {
    let sides = runner().sides([&[[0.0, 12.0], [1.0, 8.0]], &[[0.0, 7.0], [1.0, 4.0]]]);
    let skin = Skin::within(&sides, 1, [3, 3], 2e-3, 1).unwrap();
    joined_at_the_nose(&sides, &skin);
    assert!(skin.deviation(&sides, 61, 17).unwrap().greatest < 5e-3);
}

#[test]
fn few_control_points_are_enough_for_the_paper_s_errors() {
    let sides = runner().sides(THICKNESS);
    let error = |counts, optimised| {
        let skin = Skin::new(&sides, 1, SkinSize { degree: [2, 2], counts, optimised }).unwrap();
        skin.deviation(&sides, 61, 17).unwrap().average
    };
    // Table 1, whose blade is 1.15 times as large: control points and the error with non-uniform knots; the whole table
    // is the bench's.
    assert!(1.15 * error([10, 5], true) < 0.5 * 0.1, "of 10 x 10, with half as many");
    let (uniform, optimised) = (error([20, 10], false), error([20, 10], true));
    assert!(optimised <= uniform && 1.15 * optimised < 0.5 * 0.06, "{uniform} {optimised}");
}
