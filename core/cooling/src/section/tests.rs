//! A blade with a known camber: the envelope of circles of given radius along a curved line.

use super::*;
use coolinggen_nurbs::Interpolator;
use glam::DVec2;
use std::f64::consts::PI;

const RADIUS: f64 = 60.0;
const TURN: f64 = 0.9;

/// Camber point, unit tangent at arc length fraction s: a circular arc of radius 60 mm.
fn camber(s: f64) -> (DVec2, DVec2) {
    let angle = 0.5 * PI + 0.5 * TURN - TURN * s;
    (DVec2::from_angle(angle) * RADIUS, -DVec2::from_angle(angle).perp())
}

/// Radius of the inscribed circle and its derivative by arc length.
fn radius(s: f64) -> (f64, f64) {
    let length = TURN * RADIUS;
    let r = 2.0 + 9.0 * s * (1.0 - s).powi(2) - 1.2 * s;
    let slope = 9.0 * ((1.0 - s).powi(2) - 2.0 * s * (1.0 - s)) - 1.2;
    (r, slope / length)
}

/// Contact of the circle at s on the left (+1) or right (-1) side.
fn contact(s: f64, side: f64) -> DVec2 {
    let ((c, t), (r, slope)) = (camber(s), radius(s));
    c - t * (r * slope) + t.perp() * (side * r * (1.0 - slope * slope).sqrt())
}

/// The outline by arc length from the middle of the nose: right side backwards, nose arc, left side.
fn outline() -> Outline {
    let mut points = Vec::new();
    let n = 400;
    points.extend((0..n).map(|i| contact(1.0 - f64::from(i) / f64::from(n), -1.0)));
    let (center, _) = camber(0.0);
    let (a, b) = ((contact(0.0, -1.0) - center).to_angle(), (contact(0.0, 1.0) - center).to_angle());
    let sweep = (b - a).rem_euclid(2.0 * PI);
    let sweep = if sweep > PI { sweep - 2.0 * PI } else { sweep };
    // The nose is the long way round, against the direction of the camber.
    let forward = DVec2::from_angle(a + 0.5 * sweep).dot(camber(0.0).1) > 0.0;
    let sweep = if forward { sweep - 2.0 * PI * sweep.signum() } else { sweep };
    let arc = |f: f64| center + DVec2::from_angle(a + sweep * f) * radius(0.0).0;
    points.extend((0..120).map(|i| arc(f64::from(i) / 120.0)));
    points.extend((0..=n).map(|i| contact(f64::from(i) / f64::from(n), 1.0)));
    let mut nodes = vec![0.0];
    for pair in points.windows(2) {
        nodes.push(nodes[nodes.len() - 1] + pair[0].distance(pair[1]));
    }
    let middle = nodes[n as usize + 60];
    nodes.iter_mut().for_each(|u| *u -= middle);
    let curve = Interpolator::new(3, &nodes).unwrap().curve(&points).unwrap();
    // Clockwise about the material as drawn: left side is run through with the flow, material to its right.
    Outline::new(curve, -1.0)
}

/// Half the arc length of the nose.
fn half_nose() -> f64 {
    0.5 * radius(0.0).0 * PI
}

fn natural() -> ClosureKind {
    ClosureKind::Natural { ends: (-half_nose(), half_nose()) }
}

fn camber_of(outline: &Outline) -> Camber {
    let nose = half_nose();
    Camber::of(outline, 0.0, (-nose, nose), (0.0, 0.7), 0.5).unwrap()
}

#[test]
fn marching_finds_the_known_circles() {
    let camber_found = camber_of(&outline());
    assert!(camber_found.contacts().len() > 50);
    for c in camber_found.contacts() {
        // Foot of the found centre on the known arc, and the known radius there.
        let s = (0.5 * PI + 0.5 * TURN - c.center.to_angle()) / TURN;
        if s < 0.03 {
            // The curvature jumps where the nose arc ends; the test's spline follows it less closely there.
            continue;
        }
        assert!((c.center.length() - RADIUS).abs() < 2e-6, "centre off the camber at {s}");
        assert!((c.radius - radius(s).0).abs() < 2e-6, "radius at {s}: {} {}", c.radius, radius(s).0);
        assert!((c.tangent - camber(s).1).length() < 1e-5);
    }
    let middle = camber_found.at(0.5);
    assert!((middle.center.length() - RADIUS).abs() < 2e-6);
}

#[test]
fn a_camber_point_lies_at_its_fraction_of_the_length() {
    let c = camber_of(&outline());
    let expected = |f: f64| f * c.length() - c.front().radius;
    let start = c.front().center.to_angle();
    for f in [0.2, 0.5, 0.8] {
        let along = (start - c.at(f).center.to_angle()) * RADIUS;
        assert!((along - expected(f)).abs() < 1e-4, "{along} {}", expected(f));
    }
}

fn wall(camber: &Camber, position: f64) -> WallRequest {
    let c = camber.at(position);
    WallRequest {
        name: "w".into(),
        center: c.center,
        direction: DVec2::from_angle(80f64.to_radians()).rotate(c.tangent),
        downstream: c.tangent,
        half_thickness: 0.5,
        fillet: 0.6,
    }
}

#[test]
fn rings_close_and_are_smooth_at_every_corner() {
    let outline = outline();
    let camber = camber_of(&outline);
    let kinds = [
        (natural(), ClosureKind::Wall(wall(&camber, 0.4))),
        (ClosureKind::Wall(wall(&camber, 0.4)), ClosureKind::Wall(wall(&camber, 0.65))),
        (ClosureKind::Wall(wall(&camber, 0.65)), ClosureKind::Rounded { radius: 0.9 }),
        (natural(), ClosureKind::Rounded { radius: 0.9 }),
        (ClosureKind::Rounded { radius: 1.5 }, ClosureKind::Rounded { radius: 0.9 }),
    ];
    // The circle of radius 1.5 does not exist in front: the nose has 2.0 and radii grow from there.
    for (i, (front, back)) in kinds.into_iter().enumerate() {
        let result = chamber_ring(&RingRequest { outline: &outline, camber: &camber, front, back });
        if i == 4 {
            assert!(matches!(result, Err(Refusal::ChamberVanishes { .. })), "{result:?}");
            continue;
        }
        let ring = result.unwrap();
        for k in 0..SEGMENTS {
            let (end, d_end) = ring.segments[k].evaluate(&outline, 1.0);
            let (start, d_start) = ring.segments[(k + 1) % SEGMENTS].evaluate(&outline, 0.0);
            assert!(
                end.distance(start) < 1e-11,
                "ring {i}: gap of {} after segment {k}",
                end.distance(start)
            );
            let turn = d_end.perp_dot(d_start).atan2(d_end.dot(d_start)).abs();
            assert!(turn < 1e-9, "ring {i}: kink of {turn} after segment {k}");
        }
    }
}

#[test]
fn a_wall_has_its_thickness() {
    let outline = outline();
    let camber = camber_of(&outline);
    let w = wall(&camber, 0.4);
    let normal = w.direction.perp();
    let ring =
        |front, back| chamber_ring(&RingRequest { outline: &outline, camber: &camber, front, back }).unwrap();
    let before = ring(natural(), ClosureKind::Wall(w.clone()));
    let after = ring(ClosureKind::Wall(w.clone()), ClosureKind::Rounded { radius: 0.9 });
    let face = |ring: &ChamberRing, k: usize| ring.segments[k].evaluate(&outline, 0.5).0;
    let gap = (face(&before, 2) - face(&after, 6)).dot(normal).abs();
    assert!((gap - 1.0).abs() < 1e-11, "{gap}");
}

#[test]
fn the_greatest_fillet_fits_and_no_greater_one() {
    let outline = outline();
    let camber = camber_of(&outline);
    let at =
        |position: f64, fillet: f64| ClosureKind::Wall(WallRequest { fillet, ..wall(&camber, position) });
    // Fillets that overlap on a wall, that reach past both sides, and that meet those of the next wall.
    let chambers: [&dyn Fn(f64) -> [ClosureKind; 2]; 3] = [
        &|fillet| [natural(), at(0.7, fillet)],
        &|fillet| [at(0.4, fillet), ClosureKind::Rounded { radius: 0.5 * fillet }],
        &|fillet| [at(0.40, fillet), at(0.46, fillet)],
    ];
    for (i, kinds) in chambers.into_iter().enumerate() {
        let build = |fillet: f64| {
            let [front, back] = kinds(fillet);
            chamber_ring(&RingRequest { outline: &outline, camber: &camber, front, back })
        };
        let Err(Refusal::FilletTooLarge { radius, greatest, .. }) = build(5.0) else {
            panic!("{i}: {:?}", build(5.0));
        };
        assert_eq!(radius, 5.0);
        assert!(build(0.999_999 * greatest).is_ok(), "{i}: {greatest}");
        assert!(build(1.000_001 * greatest).is_err(), "{i}: {greatest}");
    }
}
