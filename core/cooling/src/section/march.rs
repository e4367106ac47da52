//! Marching from circle to circle along the camber curve (DESIGN 5.3, step 3).
//!
//! A circle is `(a, b, R)`: it touches the suction side at parameter a and the pressure side at b, so that
//! `A + R n_A = B + R n_B`. These are two equations for three unknowns; their solutions form the camber curve, which is
//! followed by a predictor along the null vector of the Jacobian and a minimum-norm Newton corrector. The tangent of
//! the centre's path halves the angle between the two side tangents exactly.

use super::camber::Contact;
use super::outline::{Frame, Outline};
use super::refusal::Refusal;
use glam::{DVec2, DVec3};

/// How far marching goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct MarchLimits {
    /// Contacts towards the front stay beyond these: suction side above, pressure side below.
    pub(super) front: (f64, f64),
    /// Contacts towards the back stay within these: suction side below, pressure side above.
    pub(super) back: (f64, f64),
    /// Smallest radius towards the front.
    pub(super) front_radius: f64,
    /// Smallest radius towards the back.
    pub(super) back_radius: f64,
    /// Greatest step of the centre.
    pub(super) step: f64,
    /// The foremost point, and the ends of suction and pressure side.
    pub(super) tips: [DVec2; 3],
}

impl MarchLimits {
    /// Whether a circle is well away from leading and trailing edge: there the camber line has no reason to end.
    fn in_the_middle(&self, center: DVec2, radius: f64) -> bool {
        self.tips.iter().all(|tip| tip.distance(center) > 2.0 * radius)
    }

    /// The least margin of a circle, see [`System::margin`]. The camber line ends where a circle comes near to
    /// osculating the nose; between the edges it goes on as long as it can.
    fn least_margin(&self, center: DVec2, radius: f64) -> f64 {
        if self.in_the_middle(center, radius) { 0.02 } else { 0.1 }
    }
}

/// Residual, the rows of its Jacobian and the frames at both contacts. The columns for a and b are per unit of
/// length along the sides, so that all three unknowns are lengths and "minimum norm" means something.
struct System {
    residual: DVec2,
    rows: [DVec3; 2],
    a: Frame,
    b: Frame,
}

impl System {
    fn new(outline: &Outline, a: f64, b: f64, radius: f64) -> Self {
        let (a, b) = (outline.frame(a), outline.frame(b));
        let along_a = (a.derivative + a.normal_derivative * radius) / a.speed;
        let along_b = -(b.derivative + b.normal_derivative * radius) / b.speed;
        let along_r = a.normal - b.normal;
        Self {
            residual: a.point + a.normal * radius - b.point - b.normal * radius,
            rows: [DVec3::new(along_a.x, along_b.x, along_r.x), DVec3::new(along_a.y, along_b.y, along_r.y)],
            a,
            b,
        }
    }

    /// The shortest change of (a, b, R) that cancels the linearised residual.
    fn correction(&self) -> Option<DVec3> {
        let [r0, r1] = self.rows;
        let (g00, g01, g11) = (r0.dot(r0), r0.dot(r1), r1.dot(r1));
        let determinant = g00 * g11 - g01 * g01;
        if !(determinant.abs() > 1e-14 * g00 * g11) {
            return None;
        }
        let f = self.residual;
        let y0 = (g11 * f.x - g01 * f.y) / determinant;
        let y1 = (g00 * f.y - g01 * f.x) / determinant;
        Some(-(r0 * y0 + r1 * y1))
    }

    /// Change of two of the unknowns with the third held fixed.
    fn correction_without(&self, fixed: usize) -> Option<DVec3> {
        let (i, j) = [(1, 2), (0, 2), (0, 1)][fixed];
        let [r0, r1] = self.rows;
        let determinant = r0[i] * r1[j] - r0[j] * r1[i];
        if !(determinant.abs() > 1e-12) {
            return None;
        }
        let f = self.residual;
        let mut change = DVec3::ZERO;
        change[i] = -(r1[j] * f.x - r0[j] * f.y) / determinant;
        change[j] = -(r0[i] * f.y - r1[i] * f.x) / determinant;
        Some(change)
    }

    fn apply(&self, (a, b, r): (f64, f64, f64), change: DVec3) -> (f64, f64, f64) {
        (a + change.x / self.a.speed, b + change.y / self.b.speed, r + change.z)
    }

    /// `1 - curvature * radius` at the tighter contact: zero where the circle osculates a side.
    fn margin(&self, radius: f64) -> f64 {
        Self::margin_at(&self.a, radius).min(Self::margin_at(&self.b, radius))
    }

    fn margin_at(contact: &Frame, radius: f64) -> f64 {
        1.0 + contact.normal_derivative.dot(contact.tangent) / contact.speed * radius
    }

    fn contact(&self, (suction, pressure, radius): (f64, f64, f64)) -> Contact {
        // The circle's centre moves at equal angles to both sides.
        let mut tangent = (self.a.normal - self.b.normal).normalize().perp();
        if tangent.dot(self.a.tangent) < 0.0 {
            tangent = -tangent;
        }
        Contact { suction, pressure, radius, center: self.a.point + self.a.normal * radius, tangent }
    }
}

/// Residual at which a circle counts as found, mm.
const CLOSED: f64 = 1e-12;
/// Cosine between the two contact normals beyond which the contacts are about to merge.
const NEARLY_ONE_POINT: f64 = 0.995;

/// Newton on two unknowns with one held; steps are limited to `limit`.
fn solve_with_fixed(
    outline: &Outline,
    start: (f64, f64, f64),
    fixed: usize,
    limit: f64,
) -> Option<(f64, f64, f64)> {
    let mut z = start;
    for _ in 0..60 {
        let system = System::new(outline, z.0, z.1, z.2);
        if system.residual.length() < CLOSED {
            return (z.2 > 0.0).then_some(z);
        }
        let change = system.correction_without(fixed)?;
        let size = change.abs().max_element();
        z = system.apply(z, change * (limit / size.max(limit)));
    }
    (System::new(outline, z.0, z.1, z.2).residual.length() < 1e3 * CLOSED && z.2 > 0.0).then_some(z)
}

/// The circles of the camber curve from front to back, found both ways from a circle at about 40 % of the suction side.
pub(super) fn march(outline: &Outline, nose: f64, limits: &MarchLimits) -> Result<Vec<Contact>, Refusal> {
    let start = start(outline, nose, limits).ok_or(Refusal::NoInscribedCircle)?;
    let mut contacts = walk(outline, start, -1.0, limits);
    contacts.reverse();
    let system = System::new(outline, start.0, start.1, start.2);
    contacts.push(system.contact(start));
    contacts.extend(walk(outline, start, 1.0, limits));
    for end in [contacts[0], contacts[contacts.len() - 1]] {
        if let Some(refusal) = hump(outline, nose, &end, limits) {
            return Err(refusal);
        }
    }
    Ok(contacts)
}

/// The circle of radius `radius` inside the outline that touches both sides, near `from` (thesis 2.3.5: a fillet of the
/// two sides); by way of circles between where the radii differ much.
pub(crate) fn circle_of_radius(outline: &Outline, from: &Contact, radius: f64) -> Option<Contact> {
    const STRIDE: f64 = 0.9;
    let mut z = (from.suction, from.pressure, from.radius);
    while z.2 != radius {
        let next = radius.clamp(STRIDE * z.2, z.2 / STRIDE);
        z = solve_with_fixed(outline, (z.0, z.1, next), 2, 0.3)?;
    }
    let system = System::new(outline, z.0, z.1, z.2);
    // Both contacts in one point solve the equations too, for any radius; and beyond the end of the medial axis the
    // contacts change places.
    let apart = system.a.normal.dot(system.b.normal) < NEARLY_ONE_POINT && z.0 > z.1;
    (apart && system.margin(radius) > 0.0).then(|| system.contact(z))
}

/// Whether the camber line ends at a circle away from both edges because a side bends there as tightly as the circle:
/// beyond it would fork into the hump.
fn hump(outline: &Outline, nose: f64, end: &Contact, limits: &MarchLimits) -> Option<Refusal> {
    let system = System::new(outline, end.suction, end.pressure, end.radius);
    // Marching halves its step as it comes near to the limit.
    let osculates = system.margin(end.radius) < 1.1 * limits.least_margin(end.center, end.radius);
    if !(osculates && limits.in_the_middle(end.center, end.radius)) {
        return None;
    }
    let on_suction = System::margin_at(&system.a, end.radius) <= System::margin_at(&system.b, end.radius);
    let (side, u, tail) = match on_suction {
        true => ("suction side", end.suction, limits.back.0),
        false => ("pressure side", end.pressure, limits.back.1),
    };
    let bend = 1.0 / outline.curvature(u);
    Some(Refusal::Hump { side, fraction: (u - nose) / (tail - nose), bend, radius: end.radius })
}

/// A first circle: touching the suction side at 40 % or nearby, found by trying every point of the pressure side. The
/// first that is not near to osculating a side and has room to shrink to the least radii, or the one farthest from
/// osculating, or else the greatest: thin blades with a thick shell have room near the nose alone.
fn start(outline: &Outline, nose: f64, limits: &MarchLimits) -> Option<(f64, f64, f64)> {
    const CLEAR: f64 = 0.2;
    let least = limits.front_radius.max(limits.back_radius);
    let mut best: Option<([f64; 2], (f64, f64, f64))> = None;
    for fraction in [0.4, 0.3, 0.5, 0.2, 0.6, 0.1, 0.7, 0.8] {
        let Some(z) = circle_at(outline, nose, fraction, limits) else { continue };
        let margin = System::new(outline, z.0, z.1, z.2).margin(z.2);
        if margin > CLEAR && z.2 > least {
            return Some(z);
        }
        let rank = [(z.2 - least).min(0.0), margin];
        if best.is_none_or(|(other, _)| rank > other) {
            best = Some((rank, z));
        }
    }
    best.map(|(_, z)| z)
}

/// The circle that touches the suction side at a fraction of its length from the nose.
fn circle_at(outline: &Outline, nose: f64, fraction: f64, limits: &MarchLimits) -> Option<(f64, f64, f64)> {
    const TRIES: usize = 200;
    let a = nose + (limits.back.0 - nose) * fraction;
    let frame = outline.frame(a);
    let mut best = (0.0, f64::INFINITY);
    for k in 0..TRIES {
        let b = nose + (limits.back.1 - nose) * (0.02 + 0.96 * k as f64 / TRIES as f64);
        let w = outline.frame(b).point - frame.point;
        let toward = w.dot(frame.normal);
        // The circle through b that touches the suction side at a.
        let radius = 0.5 * w.length_squared() / toward;
        if toward > 0.0 && radius < best.1 {
            best = (b, radius);
        }
    }
    if !best.1.is_finite() {
        return None;
    }
    let z = solve_with_fixed(outline, (a, best.0, best.1), 0, 0.05 * best.1.max(0.5))?;
    (z.1 < nose && z.1 > limits.back.1).then_some(z)
}

/// Marches from `start` towards the back (`sign` +1) or the front (-1).
fn walk(outline: &Outline, start: (f64, f64, f64), sign: f64, limits: &MarchLimits) -> Vec<Contact> {
    let mut contacts = Vec::new();
    let mut z = start;
    let mut step = limits.step;
    while contacts.len() < 4000 {
        let here = System::new(outline, z.0, z.1, z.2);
        let null = here.rows[0].cross(here.rows[1]);
        // Velocity of the centre along the null vector, to make the step a length on the camber curve.
        let velocity = (here.a.tangent + here.a.normal_derivative * (z.2 / here.a.speed)) * null.x
            + here.a.normal * null.z;
        let direction = null / velocity.length() * sign * null.x.signum();
        let center = here.a.point + here.a.normal * z.2;
        let next = loop {
            match corrected(outline, here.apply(z, direction * step)) {
                Some((next, system)) if acceptable(z, next, &system, center, sign, step, limits) => {
                    break Some((next, system));
                }
                _ if step < 1e-6 * limits.step => break None,
                _ => step *= 0.5,
            }
        };
        let Some((next, system)) = next else { break };
        z = next;
        contacts.push(system.contact(z));
        step = (step * 1.5).min(limits.step);
    }
    contacts
}

fn corrected(outline: &Outline, start: (f64, f64, f64)) -> Option<((f64, f64, f64), System)> {
    let mut z = start;
    for _ in 0..12 {
        let system = System::new(outline, z.0, z.1, z.2);
        if system.residual.length() < CLOSED {
            return Some((z, system));
        }
        z = system.apply(z, system.correction()?);
    }
    None
}

fn acceptable(
    before: (f64, f64, f64),
    z: (f64, f64, f64),
    system: &System,
    center: DVec2,
    sign: f64,
    step: f64,
    limits: &MarchLimits,
) -> bool {
    let (radius, ((a_limit, b_limit), least)) = (
        z.2,
        if sign > 0.0 { (limits.back, limits.back_radius) } else { (limits.front, limits.front_radius) },
    );
    let moved = (z.0 - before.0) * sign > 0.0 && (before.1 - z.1) * sign > 0.0;
    let within = (a_limit - z.0) * sign >= 0.0 && (z.1 - b_limit) * sign >= 0.0;
    moved
        && within
        && radius >= least
        && system.margin(radius) > limits.least_margin(center_of(system, radius), radius)
        && system.a.normal.dot(system.b.normal) < NEARLY_ONE_POINT
        && center.distance(center_of(system, radius)) < 2.0 * step
}

fn center_of(system: &System, radius: f64) -> DVec2 {
    system.a.point + system.a.normal * radius
}
