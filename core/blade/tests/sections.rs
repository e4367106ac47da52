//! Blades from sections: the real C3X vane, a rotor, every way of giving points, refusals.

mod common;

use common::*;
use coolinggen_blade::{Blade, Region, StreamSpace};
use coolinggen_nurbs::ParametricSurface;
use glam::{DVec2, DVec3};
use serde_json::{Value, json};

/// Curvatures at `n` places of the region's profile at `w`, without the places next to its ends.
fn curvatures(blade: &Blade, region: Region, w: f64, n: usize) -> Vec<f64> {
    let [a, b] = blade.range(region).unwrap();
    (1..n)
        .map(|i| {
            let d = blade.surface.derivatives(a + (b - a) * i as f64 / n as f64, w);
            d.u.cross(d.uu).length() / d.u.length().powi(3)
        })
        .collect()
}

fn names(blade: &Blade) -> Vec<&'static str> {
    blade.regions.iter().map(|(r, _)| r.name()).collect()
}

/// The blade is closed, its regions follow each other around, and it is smooth over all joints but a sharp one.
fn check_shape(space: &StreamSpace, blade: &Blade) {
    let ((a, b), (low, high)) = blade.surface.domain();
    assert_eq!((a, b), (0.0, 1.0));
    assert_eq!(blade.regions[0].1[0], 0.0);
    assert_eq!(blade.regions.last().unwrap().1[1], 1.0);
    for pair in blade.regions.windows(2) {
        assert_eq!(pair[0].1[1], pair[1].1[0]);
    }
    for i in 0..=20 {
        let w = low + (high - low) * f64::from(i) / 20.0;
        assert!(blade.surface.point(0.0, w).distance(blade.surface.point(1.0, w)) < 1e-12);
        for (_, [joint, _]) in &blade.regions {
            let before = if *joint == 0.0 { 1.0 } else { *joint };
            let (_, u, _) = blade.surface.first_derivatives(before - 1e-12, w);
            let (_, v, _) = blade.surface.first_derivatives(*joint, w);
            let corner = blade.is_sharp() && blade.region_at(*joint) == Region::PressureSide;
            assert!(corner || u.angle_between(v) < 1e-6, "{w} {joint} {}", u.angle_between(v));
        }
    }
    // Every line crosses hub and shroud.
    for v in [-0.04, 0.0, 0.5, 1.0, 1.04] {
        let surface = space.surface(v).unwrap();
        let profile = blade.profile(&surface, &around(400)).unwrap();
        for (u, (w, q)) in around(400).iter().zip(&profile) {
            let p = blade.surface.point(*u, *w);
            assert!(surface.level(p).0.abs() < 1e-11 + 1e-15 * p.length());
            assert!(surface.to_space(*q).distance(p) < 1e-10);
        }
        let area = polygon_area(&profile.iter().map(|(_, q)| *q).collect::<Vec<_>>());
        assert_eq!(area > 0.0, blade.outward, "{v} {area} {:?}", blade.surface.domain());
    }
    // Outward means away from the middle line.
    let d = blade.surface.derivatives(0.5 * blade.regions[0].1[1], 0.5);
    let middle = around(100).iter().map(|&u| blade.surface.point(u, 0.5)).sum::<DVec3>() / 100.0;
    assert_eq!((d.point - middle).dot(d.normal()) > 0.0, blade.outward);
}

#[test]
fn the_c3x_vane_is_drawn_faithfully() {
    let (space, blade) = built(&c3x());
    check_shape(&space, &blade);
    assert_eq!(names(&blade), ["leading_edge", "suction_side", "trailing_edge", "pressure_side"]);
    assert_eq!((blade.fit.points, blade.fit.spans_along), (78, 1));
    assert!(blade.fit.greatest_distance_mm < 0.002, "{}", blade.fit.greatest_distance_mm);
    assert!((120..=250).contains(&blade.fit.spans_around), "{}", blade.fit.spans_around);
    // The reported distance is the true one.
    for (i, p) in c3x_points().iter().enumerate() {
        let place = (0..2000).min_by(|&a, &b| {
            let at = |k: i32| blade.surface.point(f64::from(k) / 2000.0, 0.5).truncate().distance(*p);
            at(a).total_cmp(&at(b))
        });
        let hint = f64::from(place.unwrap()) / 2000.0;
        let z = 0.3 * 76.2;
        let foot = blade.closest(p.extend(z), (hint, 0.3)).unwrap();
        assert!(foot.distance <= blade.fit.greatest_distance_mm + 1e-12, "{i} {}", foot.distance);
    }
    // The polygon of the points has 2531.2 mm2.
    let surface = space.surface(0.5).unwrap();
    let outline: Vec<DVec2> =
        blade.profile(&surface, &around(20_000)).unwrap().into_iter().map(|(_, q)| q).collect();
    let area = polygon_area(&outline).abs();
    assert!((area / 2531.2 - 1.0).abs() < 0.003, "{area}");
    // Both edges are circles of the report's radii.
    for (region, radius, slack) in [(Region::LeadingEdge, 11.68, 0.02), (Region::TrailingEdge, 1.73, 0.02)] {
        for k in curvatures(&blade, region, 0.5, 200) {
            assert!((1.0 / k - radius).abs() < slack, "{region:?} {}", 1.0 / k);
        }
    }
    // No wiggles: along the sides the curvature never changes faster than from point to point of the table, and the
    // rounding of the table (0.5 um at 4.5 mm) is all that disturbs it.
    let pressure = curvatures(&blade, Region::PressureSide, 0.5, 400);
    assert!(pressure.iter().all(|k| (1e-3..9e-3).contains(k)), "{pressure:?}");
    let suction = curvatures(&blade, Region::SuctionSide, 0.5, 400);
    let peak = suction.iter().copied().fold(0.0, f64::max);
    assert!((0.065..0.08).contains(&peak), "{peak}");
    let turns = |k: &[f64], least: f64| {
        // Extremes that stand out by more than `least`.
        let (mut count, mut last, mut rising) = (0, k[0], None);
        for &k in k {
            if (k - last).abs() > least {
                let up = k > last;
                count += usize::from(rising.is_some_and(|r: bool| r != up));
                (rising, last) = (Some(up), k);
            } else if rising.is_some_and(|r| (k > last) == r) {
                last = k;
            }
        }
        count
    };
    // One hump behind the leading edge and one hollow, the nearly straight rear.
    assert_eq!(turns(&suction, 5e-4), 2);
    assert_eq!(turns(&pressure, 5e-4), 0);
}

#[test]
fn any_start_direction_and_order_of_points_gives_the_same_vane() {
    let (_, reference) = built(&c3x());
    let points = &c3x_points()[..78];
    let mut turned: Vec<DVec2> = points[30..].iter().chain(&points[..30]).copied().collect();
    turned.reverse();
    // A fixed shuffle.
    let mut shuffled = points.to_vec();
    let mut state = 12345u64;
    for i in (1..shuffled.len()).rev() {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        shuffled.swap(i, (state >> 33) as usize % (i + 1));
    }
    let reversed = |s: &[DVec2]| s.iter().rev().copied().collect::<Vec<_>>();
    // Sides joined in the middle of the circles: points 76 (index) and 34.
    let suction: Vec<DVec2> = points[75..].iter().chain(&points[..35]).copied().collect();
    let pressure = points[34..=75].to_vec();
    let ways: Vec<Value> = vec![
        json!({"points": listed(&turned)}),
        json!({"points": listed(&shuffled)}),
        json!({"suction_side": listed(&suction), "pressure_side": listed(&pressure)}),
        json!({"suction_side": listed(&reversed(&suction)), "pressure_side": listed(&pressure)}),
        json!({"suction_side": listed(&suction), "pressure_side": listed(&reversed(&pressure))}),
        json!({"suction_side": listed(&suction[1..]), "pressure_side": listed(&pressure), "span": 0.2}),
        json!({"points": listed(points), "leading_edge": 74, "trailing_edge": [77.0, -1.5]}),
        json!({"points": listed(points), "trailing_edge": 33}),
    ];
    for way in ways {
        let (space, blade) =
            built(&json!({"space": linear(), "blade": {"kind": "sections", "sections": [way]}}));
        check_shape(&space, &blade);
        assert_eq!(blade.outward, reference.outward);
        for (a, b) in blade.regions.iter().zip(&reference.regions) {
            assert_eq!(a.0, b.0);
            assert!((a.1[0] - b.1[0]).abs() < 1e-5, "{way}: {a:?} {b:?}");
        }
        for u in around(500) {
            let p = reference.surface.point(u, 0.4);
            assert!(blade.surface.point(u, 0.4).distance(p) < 2e-3);
            assert!(blade.closest(p, (u, 0.4)).unwrap().distance < 1e-5);
        }
    }
}

#[test]
fn a_rotor_stays_on_its_stream_surfaces() {
    let spans = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];
    let (space, blade) = built(&rotor(&spans));
    check_shape(&space, &blade);
    assert!(blade.fit.greatest_distance_mm < 2e-5, "{}", blade.fit.greatest_distance_mm);
    assert!(blade.fit.off_stream_surface_mm < 3e-8, "{}", blade.fit.off_stream_surface_mm);
    assert!(blade.fit.spans_around < 400);
    // Exact arcs were found: 2.2 mm and about 0.6 mm.
    let surface = space.surface(0.4).unwrap();
    let [a, b] = blade.range(Region::LeadingEdge).unwrap();
    let u: Vec<f64> = (0..50).map(|i| a + (b - a) * f64::from(i) / 49.0).collect();
    let arc = blade.profile(&surface, &u).unwrap();
    let length: f64 = arc.windows(2).map(|w| w[0].1.distance(w[1].1)).sum();
    assert!((5.0..8.0).contains(&length), "{length}");
    // The points between the sections given are near those of the law behind them.
    let surface = space.surface(0.5).unwrap();
    for p in section(0.5, 30) {
        let p = surface.stream_to_space(p.x, p.y);
        let near = around(2000).into_iter().min_by(|a, b| {
            let d = |u: f64| blade.surface.point(u, 0.5).distance(p);
            d(*a).total_cmp(&d(*b))
        });
        let foot = blade.closest(p, (near.unwrap(), 0.5)).unwrap();
        assert!(foot.distance < 0.02, "{}", foot.distance);
    }
    // The chart is centred on the blade.
    let q = surface.to_chart(blade.surface.point(0.3, 0.5));
    assert!(q.length() < 40.0, "{q}");
}

/// A symmetric aerofoil by the NACA four-digit thickness law with a closed trailing edge, `chord` long.
fn aerofoil(n: usize, chord: f64, open: bool) -> (Vec<DVec2>, Vec<DVec2>) {
    let last = if open { -0.1015 } else { -0.1036 };
    let side = |sign: f64| {
        (0..n)
            .map(|i| {
                let x: f64 = 0.5 - 0.5 * (std::f64::consts::PI * i as f64 / (n - 1) as f64).cos();
                let t = 0.9 * (0.2969 * x.sqrt() + x * (-0.126 + x * (-0.3516 + x * (0.2843 + x * last))));
                let camber = 0.3 * x * (1.0 - x);
                DVec2::new(x, camber + sign * t) * chord
            })
            .collect::<Vec<_>>()
    };
    (side(1.0), side(-1.0))
}

#[test]
fn sharp_and_blunt_trailing_edges_and_smooth_noses_are_recognised() {
    let (upper, lower) = aerofoil(60, 50.0, false);
    let section = json!({"suction_side": listed(&upper), "pressure_side": listed(&lower)});
    let (space, blade) =
        built(&json!({"space": linear(), "blade": {"kind": "sections", "sections": [section]}}));
    check_shape(&space, &blade);
    assert!(blade.is_sharp());
    assert_eq!(names(&blade), ["leading_edge", "suction_side", "pressure_side"]);
    assert!(blade.fit.greatest_distance_mm < 1e-3, "{}", blade.fit.greatest_distance_mm);
    let kink = blade.range(Region::PressureSide).unwrap()[0];
    assert!(blade.surface.point(kink, 0.5).truncate().distance(DVec2::new(50.0, 0.0)) < 1e-9);
    // The nose: radius 1.1019 t^2 c of the law, times (0.9 / 0.2 * 0.2)^2... the tip is near the origin.
    let [a, b] = blade.range(Region::LeadingEdge).unwrap();
    let inside = (1..50)
        .any(|i| blade.surface.point(a + (b - a) * f64::from(i) / 50.0, 0.5).truncate().length() < 0.2);
    assert!(inside);

    let (upper, lower) = aerofoil(60, 50.0, true);
    let section = json!({"suction_side": listed(&upper), "pressure_side": listed(&lower)});
    let mut points = upper.clone();
    points.extend(lower[1..].iter().rev());
    for section in [section, json!({"points": listed(&points)})] {
        let (_, blade) =
            built(&json!({"space": linear(), "blade": {"kind": "sections", "sections": [section]}}));
        assert_eq!(names(&blade).len(), 4);
        let [a, b] = blade.range(Region::TrailingEdge).unwrap();
        let ends = [a, b].map(|u| blade.surface.point(u, 0.5).truncate());
        assert!(ends[0].distance(upper[59]) < 1e-9 && ends[1].distance(lower[59]) < 1e-9);
        // The base is straight.
        assert!(
            blade.surface.point(0.5 * (a + b), 0.5).truncate().distance(0.5 * (ends[0] + ends[1])) < 1e-9
        );
    }
}

#[test]
fn an_ellipse_has_smooth_edges_at_its_ends() {
    let points: Vec<DVec2> = (0..90)
        .map(|i| {
            let a = f64::from(i) / 90.0 * std::f64::consts::TAU;
            DVec2::new(20.0 * a.cos(), 6.0 * a.sin())
        })
        .collect();
    let design =
        json!({"space": linear(), "blade": {"kind": "sections", "sections": [{"points": listed(&points)}]}});
    let (space, blade) = built(&design);
    check_shape(&space, &blade);
    assert_eq!(names(&blade).len(), 4);
    assert!(blade.fit.greatest_distance_mm < 1e-5, "{}", blade.fit.greatest_distance_mm);
    for (region, x) in [(Region::LeadingEdge, -20.0), (Region::TrailingEdge, 20.0)] {
        let [a, b] = blade.range(region).unwrap();
        let tip = blade.surface.point(0.5 * (a + b), 0.5);
        assert!(tip.truncate().distance(DVec2::new(x, 0.0)) < 1e-3, "{tip}");
    }
    // Smooth over the joints too: the curvature is that of the ellipse everywhere.
    for u in around(1000) {
        let d = blade.surface.derivatives(u, 0.5);
        let k = d.u.cross(d.uu).length() / d.u.length().powi(3);
        let (s, c) = (d.point.y / 6.0, d.point.x / 20.0);
        let exact = 120.0 / (400.0 * s * s + 36.0 * c * c).powf(1.5);
        assert!((k / exact - 1.0).abs() < 0.02, "{u} {k} {exact}");
    }
}

#[test]
fn noise_is_smoothed_within_the_tolerance_and_only_then() {
    // An ellipse with 1 um of noise.
    let mut state = 7u64;
    let mut noise = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((state >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 2e-3
    };
    let n = 300;
    let points: Vec<DVec2> = around(n)
        .iter()
        .map(|a| {
            let (s, c) = (a * std::f64::consts::TAU).sin_cos();
            DVec2::new(20.0 * c + noise(), 6.0 * s + noise())
        })
        .collect();
    let roughness = |tolerance: f64| {
        let design = json!({"space": linear(), "blade":
            {"kind": "sections", "sections": [{"points": listed(&points)}], "tolerance": tolerance}});
        let (_, blade) = built(&design);
        let distance = blade.fit.greatest_distance_mm;
        assert!(distance <= tolerance + 2e-4, "{distance}");
        // Greatest error of the curvature, relative to that at the tips.
        let errors = around(2000).into_iter().map(|u| {
            let d = blade.surface.derivatives(u, 0.5);
            let k = d.u.cross(d.uu).z / d.u.length().powi(3);
            let (s, c) = (d.point.y / 6.0, d.point.x / 20.0);
            (k.abs() - 120.0 / (400.0 * s * s + 36.0 * c * c).powf(1.5)).abs() * 1.8
        });
        errors.fold(0.0, f64::max)
    };
    let (rough, smooth) = (roughness(0.0), roughness(0.005));
    assert!(rough > 0.5 && smooth < 0.2, "{rough} {smooth}");
}

#[test]
fn planar_sections_in_an_annulus_are_cut() {
    let sections: Vec<Value> = [240.0, 262.0, 284.0, 306.0, 328.0]
        .iter()
        .map(|z| {
            let v = (z - 250.0) / 60.0;
            let points: Vec<DVec2> = section(v, 50).iter().map(|p| *p - DVec2::new(30.0, 0.0)).collect();
            json!({"z": z, "points": listed(&points)})
        })
        .collect();
    let design = json!({"space": annulus(), "blade": {"kind": "sections", "sections": sections}});
    let (space, blade) = built(&design);
    check_shape(&space, &blade);
    // The planes are planes of the blade: its points there are the points given.
    assert!(blade.fit.greatest_distance_mm < 2e-5, "{}", blade.fit.greatest_distance_mm);
    let surface = space.surface(0.5).unwrap();
    let profile = blade.profile(&surface, &around(300)).unwrap();
    let radii: Vec<f64> = profile.iter().map(|(_, q)| surface.scale(*q)).collect();
    assert!(radii.iter().fold(0.0f64, |m, r| m.max(*r)) > 1.01);
}

#[test]
fn refuses_bad_sections_with_all_faults_at_once() {
    let points = c3x_points()[..78].to_vec();
    let one =
        |section: Value| json!({"space": linear(), "blade": {"kind": "sections", "sections": [section]}});
    let at = |pointer: &str, code: &'static str| (format!("/blade{pointer}"), code);

    let mut duplicate = points.clone();
    duplicate[20] = duplicate[10];
    duplicate[21] = duplicate[11];
    assert_eq!(
        refused(&one(json!({"points": listed(&duplicate)}))),
        [at("/sections/0/points/20", "duplicate_point"), at("/sections/0/points/21", "duplicate_point")]
    );

    let mut crossing = points.clone();
    crossing.swap(24, 44);
    assert_eq!(refused(&one(json!({"points": listed(&crossing)})))[0].1, "self_crossing");

    assert_eq!(refused(&one(json!({"points": []}))), [at("/sections/0", "point_count")]);
    assert_eq!(refused(&one(json!({}))), [at("/sections/0", "missing")]);
    assert_eq!(
        refused(&one(json!({"points": [[0, 0]], "suction_side": [[0, 0]]}))),
        [at("/sections/0", "missing")]
    );
    assert_eq!(
        refused(&one(json!({"points": listed(&points), "leading_edge": 900}))),
        [at("/sections/0/leading_edge", "out_of_range")]
    );
    let flat: Vec<DVec2> = (0..40).map(|i| DVec2::new(f64::from(i), 2.0)).collect();
    assert!(!refused(&one(json!({"points": listed(&flat)}))).is_empty());
    let none = json!({"space": linear(), "blade": {"kind": "sections", "sections": []}});
    assert_eq!(refused(&none), [at("/sections", "section_count")]);
    let million =
        json!({"space": linear(), "blade": {"kind": "sections", "sections": vec![json!({}); 100_000]}});
    assert_eq!(refused(&million), [at("/sections", "section_count")]);

    // Several at once, in several sections.
    let both = json!({"space": linear(), "blade": {"kind": "sections", "sections": [
        {"span": 0.0, "points": listed(&duplicate)}, {"span": 1.0, "points": []}]}});
    assert_eq!(refused(&both).len(), 3);
    let disordered = json!({"space": linear(), "blade": {"kind": "sections", "sections": [
        {"span": 0.6, "points": listed(&points)}, {"span": 0.4, "points": listed(&points)}]}});
    assert_eq!(refused(&disordered), [at("/sections/1/span", "not_increasing")]);
    let short = json!({"space": linear(), "blade": {"kind": "sections", "sections": [
        {"span": 0.4, "points": listed(&points)}, {"span": 0.6, "points": listed(&points)}]}});
    assert_eq!(refused(&short), [at("/sections", "short_of_contour"), at("/sections", "short_of_contour")]);
    let mixed = json!({"space": linear(), "blade": {"kind": "sections", "sections": [
        {"span": 0.0, "points": listed(&points)}, {"z": 76.2, "points": listed(&points)}]}});
    assert_eq!(refused(&mixed), [at("/sections/1/z", "mixed")]);

    // The contours must cover the blade.
    let mut rotor = rotor(&[0.0, 0.5, 1.0]);
    rotor["space"] =
        json!({"kind": "annular", "hub": [[-30, 250], [20, 251]], "shroud": [[-30, 305], [20, 306]]});
    assert_eq!(refused(&rotor)[0], ("/space".to_owned(), "outside_contours"));
}

#[test]
fn a_radial_machine_works_like_an_axial_one() {
    // The flow turns from radially inward to axial: two quarter circles.
    let arc = |radius: f64| -> Vec<[f64; 2]> {
        let angle = |i: u32| f64::from(i) / 10.0 * std::f64::consts::FRAC_PI_2;
        (0..=10).map(|i| [60.0 - radius * angle(i).cos(), 90.0 - radius * angle(i).sin()]).collect()
    };
    let sections: Vec<Value> = [0.0, 0.25, 0.5, 0.75, 1.0]
        .iter()
        .map(|v| {
            let length = (60.0 - 35.0 * v) * std::f64::consts::FRAC_PI_2;
            let points: Vec<DVec2> = around(100)
                .iter()
                .map(|a| {
                    let (s, c) = (a * std::f64::consts::TAU).sin_cos();
                    DVec2::new(length * (0.5 - 0.3 * c), 4.0 * s + 6.0 * c + 2.0 * v)
                })
                .collect();
            json!({"span": v, "points": listed(&points)})
        })
        .collect();
    let design = json!({"space": {"kind": "annular", "hub": arc(60.0), "shroud": arc(25.0)},
        "blade": {"kind": "sections", "sections": sections}});
    let (space, blade) = built(&design);
    check_shape(&space, &blade);
    assert!(blade.fit.greatest_distance_mm < 2e-3, "{}", blade.fit.greatest_distance_mm);
    // The leading edge is upstream, at the larger radius.
    let [a, b] = blade.range(Region::LeadingEdge).unwrap();
    let p = blade.surface.point(0.5 * (a + b), 0.5);
    let q = blade.surface.point(
        0.5 * (blade.range(Region::TrailingEdge).unwrap()[0] + blade.range(Region::TrailingEdge).unwrap()[1]),
        0.5,
    );
    assert!(p.y.hypot(p.z) > q.y.hypot(q.z) + 10.0);
}
