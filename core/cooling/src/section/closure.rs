//! What closes a chamber at its front and back: a nose, a tail, or a wall.

use super::camber::{Camber, Contact};
use super::chamber::{ClosureKind, WallRequest};
use super::march::circle_of_radius;
use super::outline::Outline;
use super::refusal::Refusal;
use super::segment::Segment;
use glam::DVec2;

/// A closure: three segments and where they leave the two sides.
#[derive(Clone, Debug)]
pub(super) struct Closure {
    /// The segments as the ring runs: at the back from suction to pressure side, at the front the other way.
    pub(super) segments: [Segment; 3],
    /// Parameter on the suction side.
    pub(super) suction: f64,
    /// Parameter on the pressure side.
    pub(super) pressure: f64,
}

/// Which end of the chamber.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    Front,
    Back,
}

pub(super) fn closure(
    outline: &Outline,
    camber: &Camber,
    kind: &ClosureKind,
    end: End,
) -> Result<Closure, Refusal> {
    match kind {
        ClosureKind::Natural { ends } => Ok(natural_nose(outline, *ends)),
        ClosureKind::Rounded { radius } => rounded(outline, camber, *radius, end),
        ClosureKind::Wall(wall) => wall_closure(outline, camber, wall, end),
    }
}

/// The offset outline itself round the leading edge, from joint to joint: the curvature may jump there, and faces
/// that end there are smooth inside.
fn natural_nose(outline: &Outline, (pressure, suction): (f64, f64)) -> Closure {
    let nose = Segment::Side { from: pressure, to: suction };
    Closure { segments: nose.in_three(outline), suction, pressure }
}

/// The arc of the circle of the given radius that touches both sides.
fn rounded(outline: &Outline, camber: &Camber, radius: f64, end: End) -> Result<Closure, Refusal> {
    let near = match end {
        End::Front => camber.front(),
        End::Back => camber.back(),
    };
    let vanishes = || Refusal::ChamberVanishes { radius: camber.greatest_radius(), needed: radius };
    if camber.greatest_radius() <= radius {
        return Err(vanishes());
    }
    let circle = circle_of_radius(outline, near, radius).ok_or_else(vanishes)?;
    // Beyond the outline's ends there is no shell.
    let (low, high) = outline.domain();
    if circle.pressure < low || circle.suction > high {
        return Err(Refusal::NoInscribedCircle);
    }
    let (a, b) = (outline.frame(circle.suction).point, outline.frame(circle.pressure).point);
    let arc = match end {
        End::Front => Segment::arc(circle.center, b, a, Some(-circle.tangent)),
        End::Back => Segment::arc(circle.center, a, b, Some(circle.tangent)),
    };
    Ok(Closure { segments: arc.in_three(outline), suction: circle.suction, pressure: circle.pressure })
}

/// A wall's face with a fillet at each side (DESIGN 5.3, step 4).
fn wall_closure(
    outline: &Outline,
    camber: &Camber,
    wall: &WallRequest,
    end: End,
) -> Result<Closure, Refusal> {
    // Into the chamber: backwards from a wall at its front.
    let across = DVec2::new(wall.direction.y, -wall.direction.x);
    let backward = across * across.dot(wall.downstream).signum();
    let normal = if end == End::Front { backward } else { -backward };
    let near = nearest_contact(camber, wall.center);
    let reach = wall.half_thickness + wall.fillet;
    let root = |u: f64| wall_fillet(outline, wall, normal, reach, u);
    let outside = || Refusal::WallOutside { wall: wall.name.clone(), past: past_camber(camber, wall.center) };
    let (suction, center_a) = root(near.suction).ok_or_else(outside)?;
    let (pressure, center_b) = root(near.pressure).ok_or_else(outside)?;
    let (foot_a, foot_b) = (center_a - normal * wall.fillet, center_b - normal * wall.fillet);
    let straight = (foot_a - foot_b).dot(wall.direction);
    if !(straight > 0.0) {
        // How great they may be is sought where the whole chamber is known.
        return Err(Refusal::FilletTooLarge { wall: wall.name.clone(), radius: wall.fillet, greatest: 0.0 });
    }
    let (a, b) = (outline.frame(suction).point, outline.frame(pressure).point);
    let segments = match end {
        End::Back => [
            Segment::arc(center_a, a, foot_a, None),
            Segment::Line { from: foot_a, to: foot_b },
            Segment::arc(center_b, foot_b, b, None),
        ],
        End::Front => [
            Segment::arc(center_b, b, foot_b, None),
            Segment::Line { from: foot_b, to: foot_a },
            Segment::arc(center_a, foot_a, a, None),
        ],
    };
    Ok(Closure { segments, suction, pressure })
}

/// Parameter of the side at which a circle of the fillet's radius touches both it and the wall's face, and the
/// circle's centre: the root of `(O + r n - c) . n_w - (h + r)`.
fn wall_fillet(
    outline: &Outline,
    wall: &WallRequest,
    normal: DVec2,
    reach: f64,
    start: f64,
) -> Option<(f64, DVec2)> {
    let mut u = start;
    for _ in 0..60 {
        let f = outline.frame(u);
        let center = f.point + f.normal * wall.fillet;
        let value = (center - wall.center).dot(normal) - reach;
        if value.abs() < 1e-12 {
            let (low, high) = outline.domain();
            return (low..=high).contains(&u).then_some((u, center));
        }
        let slope = (f.derivative + f.normal_derivative * wall.fillet).dot(normal);
        let limit = 1.0 / f.speed;
        let change = (-value / slope).clamp(-limit, limit);
        if !change.is_finite() {
            return None;
        }
        u += change;
    }
    None
}

/// How far a point lies before the first or behind the last marched circle's centre; negative between them.
pub(super) fn past_camber(camber: &Camber, point: DVec2) -> f64 {
    let (front, back) = (camber.front(), camber.back());
    (front.center - point).dot(front.tangent).max((point - back.center).dot(back.tangent))
}

/// The marched circle nearest to a point.
fn nearest_contact(camber: &Camber, point: DVec2) -> &Contact {
    let mut best = camber.front();
    for c in camber.contacts() {
        if c.center.distance_squared(point) < best.center.distance_squared(point) {
            best = c;
        }
    }
    best
}
