//! The untrimmed offset of a curve with kinks, as one curve of regular elements.

use super::curve::OffsetCurve;
use crate::curve::ParametricCurve;
use glam::DVec2;

/// Tangents that turn by less than this at a break do not make a kink.
const KINK: f64 = 1e-8;
/// Samples between breaks in the search for cusps.
const SAMPLES: usize = 48;

/// A regular part of the raw offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Element {
    /// The offset of the curve on a parameter interval where it runs forward.
    Along { from: f64, to: f64 },
    /// The arc around a kink at parameter `t`, on the outer side.
    Around { t: f64, corner: DVec2, start: f64, sweep: f64 },
}

/// Elements in order. Element `k` has the parameters `places[k]` to `places[k] + 1`; those that do not follow each
/// other in the plane leave a gap.
pub(super) struct Raw<'a, C> {
    pub(super) offset: &'a OffsetCurve<&'a C, f64>,
    pub(super) distance: f64,
    pub(super) elements: Vec<Element>,
    pub(super) places: Vec<f64>,
}

impl<'a, C: ParametricCurve<DVec2>> Raw<'a, C> {
    pub(super) fn new(offset: &'a OffsetCurve<&'a C, f64>, distance: f64, closed: bool) -> Self {
        let curve = *offset.curve();
        let breaks = curve.breaks();
        let mut raw = Self { offset, distance, elements: vec![], places: vec![] };
        let mut place = 0.0;
        for span in breaks.windows(2) {
            if span[0] > breaks[0] {
                raw.corner(span[0], span[0], &mut place);
            }
            for (from, to) in raw.forward_parts(span[0], span[1]) {
                // A part follows the one before if it starts where that ended.
                let follows = match raw.elements.last() {
                    Some(Element::Along { to, .. }) => *to == from && from == span[0],
                    Some(Element::Around { t, .. }) => *t == from,
                    None => true,
                };
                place += if follows { 0.0 } else { 1.0 };
                raw.push(Element::Along { from, to }, &mut place);
            }
        }
        if closed {
            raw.corner(breaks[breaks.len() - 1], breaks[0], &mut place);
        }
        raw
    }

    fn push(&mut self, element: Element, place: &mut f64) {
        self.elements.push(element);
        self.places.push(*place);
        *place += 1.0;
    }

    /// The arc or the gap at a break, between the tangents before `end` and after `start`.
    fn corner(&mut self, end: f64, start: f64, place: &mut f64) {
        let curve = *self.offset.curve();
        let before = curve.derivatives(end.next_down())[1];
        let after = curve.derivatives(start)[1];
        // Not `angle_to`, whose arc cosine loses half the digits.
        let turn = before.perp_dot(after).atan2(before.dot(after));
        if turn.abs() <= KINK {
            return;
        }
        if turn * self.distance > 0.0 {
            // The inner side: what comes next starts elsewhere.
            *place += 1.0;
            return;
        }
        // The offset left of the curve turns around the corner from one normal to the next.
        let start_angle = (before.perp() * self.distance).to_angle();
        let arc = Element::Around { t: end, corner: curve.point(end), start: start_angle, sweep: turn };
        // An arc follows only if the part before it ends here.
        let follows = matches!(self.elements.last(), Some(Element::Along { to, .. }) if *to == end);
        *place += if follows || self.elements.is_empty() { 0.0 } else { 1.0 };
        self.push(arc, place);
    }

    /// The parts of a span where the offset runs forward: between roots of the stretch.
    fn forward_parts(&self, a: f64, b: f64) -> Vec<(f64, f64)> {
        // Just inside the span, where derivatives are those of the span.
        let value = |t: f64| self.offset.stretch(if t >= b { b.next_down() } else { t });
        let at = |k: usize| if k == SAMPLES { b } else { a + (b - a) * k as f64 / SAMPLES as f64 };
        let mut nodes: Vec<(f64, f64)> = (0..=SAMPLES).map(|k| (at(k), value(at(k)))).collect();
        // Least values between samples may be negative: look for them.
        for k in (1..SAMPLES).rev() {
            let (left, here, right) = (nodes[k - 1], nodes[k], nodes[k + 1]);
            if here.1 > 0.0 && here.1 <= left.1 && here.1 <= right.1 && here.1 < 0.5 {
                let least = minimum(&value, left.0, right.0);
                if value(least) < 0.0 {
                    let place = if least > here.0 { k + 1 } else { k };
                    nodes.insert(place, (least, value(least)));
                }
            }
        }
        let mut parts = vec![];
        let mut from = (nodes[0].1 >= 0.0).then_some(a);
        for w in nodes.windows(2) {
            if (w[0].1 >= 0.0) != (w[1].1 >= 0.0) {
                let root = root(&value, w[0].0, w[1].0);
                match from.take() {
                    Some(start) => parts.push((start, root)),
                    None => from = Some(root),
                }
            }
        }
        if let Some(start) = from {
            parts.push((start, b));
        }
        parts.retain(|(from, to)| to > from);
        parts
    }

    /// The element at a parameter, and the parameter within it from 0 to 1.
    pub(super) fn locate(&self, place: f64) -> (usize, f64) {
        let after = self.places.partition_point(|&p| p <= place);
        let k = after.saturating_sub(1);
        (k, (place - self.places[k]).clamp(0.0, 1.0))
    }

    /// Point and derivatives of an element at its parameter from 0 to 1, always from within.
    pub(super) fn at(&self, k: usize, x: f64) -> [DVec2; 3] {
        match self.elements[k] {
            Element::Along { from, to } => {
                let length = to - from;
                let t = if x >= 1.0 { to.next_down() } else { from + length * x };
                let [p, d, dd] = self.offset.derivatives(t);
                [p, d * length, dd * (length * length)]
            }
            Element::Around { corner, start, sweep, .. } => {
                let radius = DVec2::from_angle(start + sweep * x) * self.distance.abs();
                [corner + radius, radius.perp() * sweep, radius * (-sweep * sweep)]
            }
        }
    }

    /// Parameter intervals of the elements.
    pub(super) fn intervals(&self) -> Vec<(f64, f64)> {
        self.places.iter().map(|&p| (p, p + 1.0)).collect()
    }
}

impl<C: ParametricCurve<DVec2>> ParametricCurve<DVec2> for Raw<'_, C> {
    fn domain(&self) -> (f64, f64) {
        (0.0, self.places.last().map_or(1.0, |p| p + 1.0))
    }

    fn derivatives(&self, place: f64) -> [DVec2; 3] {
        let (k, x) = self.locate(place);
        self.at(k, x)
    }

    fn breaks(&self) -> Vec<f64> {
        self.places.iter().copied().chain([self.domain().1]).collect()
    }
}

/// A root of `f` between points of different signs, to rounding of the argument: bisection.
fn root(f: &impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let negative = f(a) < 0.0;
    loop {
        let middle = 0.5 * (a + b);
        if !(middle > a && middle < b) {
            // The end where the offset still runs forward.
            return if negative { b } else { a };
        }
        if (f(middle) < 0.0) == negative { a = middle } else { b = middle }
    }
}

/// The least value of `f` on an interval where it has one minimum: golden section.
fn minimum(f: &impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let (mut x, mut y) = (b - ratio * (b - a), a + ratio * (b - a));
    let (mut fx, mut fy) = (f(x), f(y));
    for _ in 0..60 {
        if fx < fy {
            (b, y, fy) = (y, x, fx);
            x = b - ratio * (b - a);
            fx = f(x);
        } else {
            (a, x, fx) = (x, y, fy);
            y = a + ratio * (b - a);
            fy = f(y);
        }
    }
    0.5 * (a + b)
}
