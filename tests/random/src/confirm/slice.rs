//! A section of a blade as points: what refusals are confirmed on. Nothing here is marched, lofted or offset.

use coolinggen_blade::{Blade, Region, StreamSpace, StreamSurface};
use glam::{DVec2, DVec3};
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

/// Points a side, and round the nose.
const POINTS: usize = 500;
/// Slices over the span: a point is looked up in the nearest one.
const SLICES: f64 = 400.0;

/// A blade, sliced where it is asked for.
pub(super) struct Slices {
    pub(super) blade: Blade,
    space: StreamSpace,
    known: RefCell<HashMap<i64, Option<Rc<Slice>>>>,
}

impl Slices {
    pub(super) fn new(space: StreamSpace, blade: Blade) -> Self {
        Self { blade, space, known: RefCell::default() }
    }

    /// The slice nearest to a span fraction; none where the blade has no such section.
    pub(super) fn near(&self, v: f64) -> Option<Rc<Slice>> {
        let key = (v * SLICES).round() as i64;
        if let Some(known) = self.known.borrow().get(&key) {
            return known.clone();
        }
        let made = Slice::new(&self.space, &self.blade, key as f64 / SLICES).map(Rc::new);
        self.known.borrow_mut().insert(key, made.clone());
        made
    }

    /// The span fraction of a point, from the stream surfaces next to `near`.
    pub(super) fn span_fraction(&self, point: DVec3, near: f64) -> Option<f64> {
        const APART: f64 = 0.05;
        let mut v = near;
        for _ in 0..3 {
            let (a, b) = (self.near(v)?, self.near(if v > 0.5 { v - APART } else { v + APART })?);
            let (from, to) = (a.surface.level(point).0, b.surface.level(point).0);
            v = a.surface.v() + (b.surface.v() - a.surface.v()) * from / (from - to);
        }
        Some(v.clamp(-0.05, 1.05))
    }
}

/// A point of a side: in the chart, and the blade's parameters.
#[derive(Clone, Copy)]
pub(super) struct SidePoint {
    pub(super) at: DVec2,
    pub(super) u: f64,
    pub(super) w: f64,
}

/// A circle that touches both sides: the smallest through another point of the outline of those that touch the suction
/// side at one of its points.
#[derive(Clone, Copy)]
pub(super) struct Circle {
    /// Fraction of the camber line.
    pub(super) fraction: f64,
    pub(super) centre: DVec2,
    /// Of the chart.
    pub(super) radius: f64,
    /// Indices of the points where it touches: suction side, pressure side.
    pub(super) touches: [usize; 2],
}

/// A section.
pub(super) struct Slice {
    pub(super) surface: StreamSurface,
    /// Length in space of one unit of the chart, at the middle.
    pub(super) scale: f64,
    /// Suction side and pressure side, from front to back.
    pub(super) sides: [Vec<SidePoint>; 2],
    /// Round the leading edge, from the pressure side to the suction side.
    pub(super) nose: Vec<SidePoint>,
    pub(super) camber: Vec<Circle>,
}

impl Slice {
    fn new(space: &StreamSpace, blade: &Blade, v: f64) -> Option<Self> {
        let surface = space.surface(v).ok()?;
        let points = |[from, to]: [f64; 2], shift: f64| -> Option<Vec<SidePoint>> {
            let step = (to - from) / POINTS as f64;
            let u: Vec<f64> = (0..=POINTS).map(|i| from + shift + step * i as f64).collect();
            let profile = blade.profile(&surface, &u).ok()?;
            Some(
                u.into_iter()
                    .zip(profile)
                    .map(|(u, (w, at))| SidePoint { at, u: u.rem_euclid(1.0), w })
                    .collect(),
            )
        };
        let suction = points(blade.range(Region::SuctionSide)?, 0.0)?;
        let mut pressure = points(blade.range(Region::PressureSide)?, -1.0)?;
        pressure.reverse();
        let nose = points(blade.range(Region::LeadingEdge)?, 0.0)?;
        let scale = surface.scale(suction[POINTS / 2].at.lerp(pressure[POINTS / 2].at, 0.5));
        let camber = camber(&suction, &pressure, &nose);
        (camber.len() > 10).then_some(Self { surface, scale, sides: [suction, pressure], nose, camber })
    }

    /// Distances in space to suction side, pressure side and nose, mm.
    pub(super) fn distances(&self, q: DVec2) -> [f64; 3] {
        let side = |k: usize| to_polyline(q, self.sides[k].iter().map(|p| p.at)) * self.scale;
        [side(0), side(1), to_polyline(q, self.nose.iter().map(|p| p.at)) * self.scale]
    }

    /// The points of a side from the foremost one, which lies on the nose, to the trailing edge.
    pub(super) fn side_with_nose(&self, side: usize) -> Vec<SidePoint> {
        let points = &self.sides[side];
        let tail = points[points.len() - 1].at;
        let away = |i: &usize| self.nose[*i].at.distance(tail);
        let far = (0..self.nose.len()).max_by(|i, j| away(i).total_cmp(&away(j))).unwrap_or(0);
        // The last point of the nose is the side's first.
        let mut round: Vec<SidePoint> = match side {
            0 => self.nose[far..].to_vec(),
            _ => self.nose[..=far].iter().rev().copied().collect(),
        };
        round.pop();
        round.extend(points);
        round
    }

    /// Centre and unit tangent of the camber line at a fraction, and the circle nearest to it.
    pub(super) fn camber_at(&self, fraction: f64) -> (DVec2, DVec2, Circle) {
        let k = self.camber.partition_point(|c| c.fraction < fraction).clamp(1, self.camber.len() - 1);
        let (a, b) = (self.camber[k - 1], self.camber[k]);
        let part = (fraction - a.fraction) / (b.fraction - a.fraction);
        let wide = |i: usize| self.camber[i.min(self.camber.len() - 1)].centre;
        let tangent = (wide(k + 2) - wide(k.saturating_sub(3))).normalize();
        (a.centre.lerp(b.centre, part), tangent, if part < 0.5 { a } else { b })
    }
}

/// Distance of a point from a polyline.
fn to_polyline(q: DVec2, points: impl Iterator<Item = DVec2>) -> f64 {
    let mut least = f64::INFINITY;
    let mut last: Option<DVec2> = None;
    for p in points {
        if let Some(from) = last {
            let d = p - from;
            let t = ((q - from).dot(d) / d.length_squared()).clamp(0.0, 1.0);
            least = least.min(q.distance_squared(from + d * t));
        }
        last = Some(p);
    }
    least.sqrt()
}

fn camber(suction: &[SidePoint], pressure: &[SidePoint], nose: &[SidePoint]) -> Vec<Circle> {
    let inwards = pressure[POINTS / 2].at - suction[POINTS / 2].at;
    let along = (suction[POINTS / 2 + 1].at - suction[POINTS / 2 - 1].at).perp();
    let sign = along.dot(inwards).signum();
    let mut circles: Vec<Circle> = Vec::new();
    for i in 1..suction.len() - 1 {
        let normal = (suction[i + 1].at - suction[i - 1].at).perp().normalize() * sign;
        let through = |q: DVec2| {
            let d = q - suction[i].at;
            let toward = d.dot(normal);
            if toward > 1e-9 { d.length_squared() / (2.0 * toward) } else { f64::INFINITY }
        };
        let at_nose = nose.iter().map(|q| through(q.at)).fold(f64::INFINITY, f64::min);
        let radii = pressure.iter().map(|p| through(p.at)).enumerate();
        let Some((j, radius)) = radii.min_by(|a, b| a.1.total_cmp(&b.1)) else { continue };
        let radius = radius.min(at_nose);
        if radius.is_finite() {
            let centre = suction[i].at + normal * radius;
            circles.push(Circle { fraction: 0.0, centre, radius, touches: [i, j] });
        }
    }
    let mut run = circles.first().map_or(0.0, |c| c.radius);
    for k in 0..circles.len() {
        if k > 0 {
            run += circles[k].centre.distance(circles[k - 1].centre);
        }
        circles[k].fraction = run;
    }
    let whole = run + circles.last().map_or(0.0, |c| c.radius);
    circles.iter_mut().for_each(|c| c.fraction /= whole);
    circles
}
