//! The ring half way round, above the wall's end: made in the plane along the wall, so that fillets are true circles.

use super::TurnRefusal;
use super::chart::TurnChart;
use glam::{DVec2, DVec3};

/// The plane spanned by the wall's mid line and the fibre half way up.
struct Plane {
    origin: DVec3,
    /// Unit vectors: away from the chambers, towards the suction side.
    axes: [DVec3; 2],
}

impl Plane {
    fn project(&self, p: DVec3) -> DVec2 {
        let d = p - self.origin;
        DVec2::new(d.dot(self.axes[0]), d.dot(self.axes[1]))
    }
}

/// A closure in the plane: fillet, straight line, fillet, in the direction of the ring.
#[derive(Clone, Debug)]
struct Closure {
    /// Centres of the fillets at the suction side and the pressure side.
    centers: [DVec2; 2],
    /// Contacts with the sides.
    contacts: [DVec2; 2],
    /// Contacts with the straight line.
    feet: [DVec2; 2],
}

/// What is asked of the ring: heights of inner and outer closure and radius of the fillets, mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heights {
    pub(super) inner: f64,
    pub(super) outer: f64,
    pub(super) radius: f64,
}

/// The ring half way round: eta and zeta of both closures, at x = 0.
pub(super) struct Top<'a> {
    chart: &'a TurnChart,
    plane: Plane,
    inner: Closure,
    outer: Closure,
    /// Rough coordinates for inverting: eta and zeta of the corners.
    heights: Heights,
}

const SUCTION: usize = 0;
const PRESSURE: usize = 1;

impl<'a> Top<'a> {
    pub(super) fn new(chart: &'a TurnChart, heights: Heights) -> Result<Self, TurnRefusal> {
        let plane = plane(chart, heights.outer);
        let inner = closure(chart, &plane, heights.inner, heights.radius, 1.0);
        let outer = closure(chart, &plane, heights.outer, heights.radius, -1.0);
        let clearance = heights.outer - heights.inner;
        let least = 2.0 * heights.radius;
        let low = TurnRefusal::TooLow { clearance, least };
        let (Some(inner), Some(outer)) = (inner, outer) else { return Err(low) };
        for side in [SUCTION, PRESSURE] {
            let straight = outer.contacts[side].x - inner.contacts[side].x;
            if !(straight > 0.0) {
                let least = clearance - straight;
                return Err(TurnRefusal::TooLow { clearance, least });
            }
        }
        for closure in [&inner, &outer] {
            let straight = closure.feet[SUCTION].y - closure.feet[PRESSURE].y;
            if !(straight > 0.0) {
                let greatest = (heights.radius + 0.5 * straight).max(0.0);
                return Err(TurnRefusal::FilletTooLarge { radius: heights.radius, greatest });
            }
        }
        Ok(Self { chart, plane, inner, outer, heights })
    }

    /// (eta, zeta) of segment `k` (1 to 3 inner, 5 to 7 outer) at `t`.
    pub(super) fn at(&self, k: usize, t: f64) -> Option<DVec2> {
        let (closure, part, height) = match k {
            1..=3 => (&self.inner, k - 1, self.heights.inner),
            _ => (&self.outer, 7 - k, self.heights.outer),
        };
        // The outer closure runs from the pressure side to the suction side.
        let t = if k > 3 { 1.0 - t } else { t };
        let at = match part {
            0 => arc(closure.centers[SUCTION], closure.contacts[SUCTION], closure.feet[SUCTION], t),
            1 => closure.feet[SUCTION].lerp(closure.feet[PRESSURE], t),
            _ => arc(closure.centers[PRESSURE], closure.feet[PRESSURE], closure.contacts[PRESSURE], t),
        };
        let start = DVec2::new([0.9, 0.5, 0.1][part], height);
        invert(self.chart, &self.plane, at, start)
    }
}

fn plane(chart: &TurnChart, height: f64) -> Plane {
    let middle = chart.map(DVec3::new(0.0, 0.5, 0.5 * height));
    let across = middle.slopes.y_axis.normalize();
    let up = middle.slopes.z_axis;
    Plane { origin: middle.point, axes: [(up - across * up.dot(across)).normalize(), across] }
}

/// The point of the arc about `center` from `from` to `to`, the short way round.
fn arc(center: DVec2, from: DVec2, to: DVec2, t: f64) -> DVec2 {
    let (a, b) = (from - center, to - center);
    center + DVec2::from_angle(crate::section::angle_between(a, b) * t).rotate(a)
}

/// The closure at height `zeta`; the passage lies above it (`sign` +1) or below (-1).
fn closure(chart: &TurnChart, plane: &Plane, zeta: f64, radius: f64, sign: f64) -> Option<Closure> {
    let corner = |eta: f64| plane.project(chart.point(DVec3::new(0.0, eta, zeta)));
    let (a, b) = (corner(1.0), corner(0.0));
    let along = (a - b).normalize();
    // Into the passage.
    let normal = DVec2::new(along.y, -along.x) * sign;
    let (center_a, contact_a) = fillet(chart, plane, 1.0, zeta + sign * radius, radius, (a, normal))?;
    let (center_b, contact_b) = fillet(chart, plane, 0.0, zeta + sign * radius, radius, (a, normal))?;
    Some(Closure {
        centers: [center_a, center_b],
        contacts: [contact_a, contact_b],
        feet: [center_a - normal * radius, center_b - normal * radius],
    })
}

/// Centre and contact on the side `eta` of the circle that touches it and the line through `line.0` with the normal
/// `line.1` (DESIGN 5.3, step 4): one root.
fn fillet(
    chart: &TurnChart,
    plane: &Plane,
    eta: f64,
    start: f64,
    radius: f64,
    line: (DVec2, DVec2),
) -> Option<(DVec2, DVec2)> {
    let into = if eta > 0.5 { 1.0 } else { -1.0 };
    let circle = |zeta: f64| {
        let mapped = chart.map(DVec3::new(0.0, eta, zeta));
        let rise =
            DVec2::new(mapped.slopes.z_axis.dot(plane.axes[0]), mapped.slopes.z_axis.dot(plane.axes[1]));
        let contact = plane.project(mapped.point);
        (contact + DVec2::new(rise.y, -rise.x).normalize() * (radius * into), contact)
    };
    let off = |zeta: f64| (circle(zeta).0 - line.0).dot(line.1) - radius;
    let mut zeta = start;
    for _ in 0..50 {
        const STEP: f64 = 1e-5;
        let change = -off(zeta) * 2.0 * STEP / (off(zeta + STEP) - off(zeta - STEP));
        if !change.is_finite() {
            return None;
        }
        zeta += change.clamp(-1.0, 1.0);
        if change.abs() < 1e-11 {
            return Some(circle(zeta));
        }
    }
    None
}

/// (eta, zeta) of a point of the plane, at x = 0.
fn invert(chart: &TurnChart, plane: &Plane, at: DVec2, start: DVec2) -> Option<DVec2> {
    let mut q = start;
    for _ in 0..50 {
        let mapped = chart.map(DVec3::new(0.0, q.x, q.y));
        let missing = at - plane.project(mapped.point);
        let flat = |d: DVec3| DVec2::new(d.dot(plane.axes[0]), d.dot(plane.axes[1]));
        let (e, z) = (flat(mapped.slopes.y_axis), flat(mapped.slopes.z_axis));
        let change = DVec2::new(missing.perp_dot(z), e.perp_dot(missing)) / e.perp_dot(z);
        if !change.is_finite() {
            return None;
        }
        q += change.clamp(DVec2::new(-0.3, -1.0), DVec2::new(0.3, 1.0));
        if missing.length() < 1e-11 {
            return Some(q);
        }
    }
    None
}
