//! The camber curve: centres of the circles that touch both sides, by arc length.

use super::march::{MarchLimits, march};
use super::outline::Outline;
use super::refusal::Refusal;
use super::segment::angle_between;
use glam::DVec2;

/// An inscribed circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Parameter of the contact on the suction side.
    pub suction: f64,
    /// Parameter of the contact on the pressure side.
    pub pressure: f64,
    /// Radius.
    pub radius: f64,
    /// Centre.
    pub center: DVec2,
    /// Unit tangent of the camber curve, towards the trailing edge.
    pub tangent: DVec2,
}

/// A camber curve: circles from front to back with the arc length of their centres.
#[derive(Clone, Debug)]
pub struct Camber {
    contacts: Vec<Contact>,
    lengths: Vec<f64>,
}

impl Camber {
    /// The camber of an outline within limits.
    pub(super) fn within(outline: &Outline, nose: f64, limits: &MarchLimits) -> Result<Self, Refusal> {
        Self::from_contacts(march(outline, nose, limits)?)
    }

    fn from_contacts(mut contacts: Vec<Contact>) -> Result<Self, Refusal> {
        contacts.dedup_by(|b, a| a.center.distance(b.center) < 1e-6);
        if contacts.len() < 2 {
            return Err(Refusal::NoInscribedCircle);
        }
        let mut lengths = vec![0.0];
        for pair in contacts.windows(2) {
            let (chord, turn) = (
                pair[0].center.distance(pair[1].center),
                angle_between(pair[0].tangent, pair[1].tangent).abs(),
            );
            // Length of the circular arc with this chord and turn.
            let stretch = if turn > 1e-6 { 0.5 * turn / (0.5 * turn).sin() } else { 1.0 };
            lengths.push(lengths[lengths.len() - 1] + chord * stretch);
        }
        Ok(Self { contacts, lengths })
    }

    /// The circles, from front to back.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }

    /// The foremost circle.
    pub fn front(&self) -> &Contact {
        &self.contacts[0]
    }

    /// The rearmost circle.
    pub fn back(&self) -> &Contact {
        &self.contacts[self.contacts.len() - 1]
    }

    /// The greatest radius.
    pub fn greatest_radius(&self) -> f64 {
        self.contacts.iter().map(|c| c.radius).fold(0.0, f64::max)
    }

    /// Length of the camber line from the leading edge to the trailing edge: the marched curve and, at both
    /// ends, the radius of the end circle.
    pub fn length(&self) -> f64 {
        self.front().radius + self.lengths[self.lengths.len() - 1] + self.back().radius
    }

    /// The circle about the camber line's point at `fraction` of its length; contacts, radius and centre by cubic
    /// or linear interpolation between marched circles, straight beyond the first and the last.
    pub fn at(&self, fraction: f64) -> Contact {
        let s = fraction * self.length() - self.front().radius;
        let n = self.contacts.len();
        if s <= 0.0 {
            return Contact { center: self.front().center + self.front().tangent * s, ..*self.front() };
        }
        if s >= self.lengths[n - 1] {
            let beyond = s - self.lengths[n - 1];
            return Contact { center: self.back().center + self.back().tangent * beyond, ..*self.back() };
        }
        let k = self.lengths.partition_point(|&l| l <= s).clamp(1, n - 1);
        let (a, b) = (&self.contacts[k - 1], &self.contacts[k]);
        let h = self.lengths[k] - self.lengths[k - 1];
        let x = (s - self.lengths[k - 1]) / h;
        let mix = |p: f64, q: f64| p + (q - p) * x;
        // Cubic Hermite for the centre, its derivative for the tangent.
        let (x2, x3) = (x * x, x * x * x);
        let center = a.center * (2.0 * x3 - 3.0 * x2 + 1.0)
            + a.tangent * (h * (x3 - 2.0 * x2 + x))
            + b.center * (3.0 * x2 - 2.0 * x3)
            + b.tangent * (h * (x3 - x2));
        let slope = (b.center - a.center) * ((6.0 * x - 6.0 * x2) / h)
            + a.tangent * (3.0 * x2 - 4.0 * x + 1.0)
            + b.tangent * (3.0 * x2 - 2.0 * x);
        Contact {
            suction: mix(a.suction, b.suction),
            pressure: mix(a.pressure, b.pressure),
            radius: mix(a.radius, b.radius),
            center,
            tangent: slope.normalize(),
        }
    }
}
