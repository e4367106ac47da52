//! The section itself: five points, two circles, two cubics and an arc.
//!
//! Coordinates as in the paper: x axial from the leading edge's foremost point, y tangential from the centre of the
//! trailing-edge circle; the suction side lies above.

use crate::section::Circle;
use glam::DVec2;
use std::f64::consts::{FRAC_PI_2, TAU};

/// The parameters at one span fraction; lengths in mm, angles in radians.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parameters {
    pub(super) radius: f64,
    pub(super) axial_chord: f64,
    pub(super) tangential_chord: f64,
    pub(super) unguided_turning: f64,
    pub(super) inlet_angle: f64,
    pub(super) inlet_half_wedge: f64,
    pub(super) leading_edge_radius: f64,
    pub(super) exit_angle: f64,
    pub(super) trailing_edge_radius: f64,
    pub(super) blade_count: f64,
    pub(super) throat: f64,
}

/// A section with its exit wedge solved for.
#[derive(Clone, Debug)]
pub(super) struct Section {
    pub(super) parameters: Parameters,
    /// Half of the exit wedge angle, radians.
    pub(super) exit_half_wedge: f64,
    /// Slope angles of the outline at the five points.
    angles: [f64; 5],
    /// Suction side at the trailing-edge circle, at the throat, at the leading-edge circle; pressure side at the
    /// leading-edge circle and at the trailing-edge circle.
    points: [DVec2; 5],
}

/// Why there is no section.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Flaw {
    /// The throat is as wide as the pitch, or wider, mm.
    Throat { pitch: f64 },
    /// No exit wedge angle lets an arc join throat and trailing edge.
    NoWedge,
    /// Points of a side are out of order along the axis: the edges are too large for the chord.
    Folded,
    /// The sides cross.
    Crossing,
}

/// Exit half wedge angles tried, radians.
const LEAST_WEDGE: f64 = -0.1;
const MOST_WEDGE: f64 = 0.9;

impl Section {
    /// Solves for the exit wedge angle: the one with which the uncovered part of the suction side, from the throat to
    /// the trailing edge, is a circular arc tangent at both ends (Pritchard 1985, appendix F).
    pub(super) fn new(parameters: Parameters) -> Result<Self, Flaw> {
        let p = &parameters;
        let pitch = TAU * p.radius / p.blade_count;
        if !(p.throat + p.trailing_edge_radius < pitch) {
            return Err(Flaw::Throat { pitch });
        }
        // An arc's chord has the mean of the slopes at its ends.
        let miss = |wedge: f64| {
            let (first, second) = uncovered(p, pitch, wedge);
            let chord = first.0 - second.0;
            let angle = chord.to_angle() - 0.5 * (first.1 + second.1);
            if chord.x > 0.0 { angle } else { f64::NAN }
        };
        let steps = 200;
        let at = |i: usize| LEAST_WEDGE + (MOST_WEDGE - LEAST_WEDGE) * i as f64 / steps as f64;
        let bracket = (0..steps).find(|&i| miss(at(i)) * miss(at(i + 1)) <= 0.0).ok_or(Flaw::NoWedge)?;
        let (mut low, mut high) = (at(bracket), at(bracket + 1));
        let rising = miss(low) < miss(high);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (miss(middle) < 0.0) == rising {
                low = middle;
            } else {
                high = middle;
            }
        }
        let section = Self::with_wedge(parameters, pitch, 0.5 * (low + high));
        let [p1, p2, p3, p4, p5] = section.points;
        if !(p3.x < p2.x && p2.x < p1.x && p4.x < p5.x) {
            return Err(Flaw::Folded);
        }
        let mut outline = section.suction(40);
        outline.extend(section.pressure(40));
        if crate::section::crossings(&outline, 1).is_empty() { Ok(section) } else { Err(Flaw::Crossing) }
    }

    fn with_wedge(parameters: Parameters, pitch: f64, wedge: f64) -> Self {
        let p = &parameters;
        let (first, second) = uncovered(p, pitch, wedge);
        let (b3, b4) = (p.inlet_angle + p.inlet_half_wedge, p.inlet_angle - p.inlet_half_wedge);
        let b5 = p.exit_angle + wedge;
        let leading = DVec2::new(p.leading_edge_radius, p.tangential_chord);
        let trailing = DVec2::new(p.axial_chord - p.trailing_edge_radius, 0.0);
        let third = leading + DVec2::from_angle(b3 + FRAC_PI_2) * p.leading_edge_radius;
        let fourth = leading + DVec2::from_angle(b4 - FRAC_PI_2) * p.leading_edge_radius;
        let fifth = trailing + DVec2::from_angle(b5 - FRAC_PI_2) * p.trailing_edge_radius;
        Self {
            parameters,
            exit_half_wedge: wedge,
            angles: [first.1, second.1, b3, b4, b5],
            points: [first.0, second.0, third, fourth, fifth],
        }
    }

    /// The leading-edge circle with the angles at which its arc begins (pressure side) and ends.
    pub(super) fn leading_arc(&self) -> (Circle, [f64; 2]) {
        let p = &self.parameters;
        let center = DVec2::new(p.leading_edge_radius, p.tangential_chord);
        let ends = [self.angles[3] - FRAC_PI_2, self.angles[2] + FRAC_PI_2 - TAU];
        (Circle { center, radius: p.leading_edge_radius }, ends)
    }

    /// The trailing-edge circle with the angles at which its arc begins (suction side) and ends.
    pub(super) fn trailing_arc(&self) -> (Circle, [f64; 2]) {
        let p = &self.parameters;
        let center = DVec2::new(p.axial_chord - p.trailing_edge_radius, 0.0);
        let ends = [self.angles[0] + FRAC_PI_2, self.angles[4] - FRAC_PI_2];
        (Circle { center, radius: p.trailing_edge_radius }, ends)
    }

    /// About `count` points of the suction side, evenly spaced, from leading edge to trailing edge: the cubic up to
    /// the throat, then the arc.
    pub(super) fn suction(&self, count: usize) -> Vec<DVec2> {
        let [first, second, third, ..] = self.points;
        let covered = Cubic::new(third, self.angles[2], second, self.angles[1]);
        let turned = self.angles[1] - self.angles[0];
        let chord = second.distance(first);
        let (length, arc) = (covered.length(), chord * (0.5 * turned) / (0.5 * turned).sin());
        let arc = if arc.is_finite() { arc } else { chord };
        let share = length / (length + arc);
        let on_cubic = ((count as f64 * share).round() as usize).max(4);
        let on_arc = (count - on_cubic.min(count)).max(3);
        let mut points = covered.points(on_cubic);
        for i in 1..=on_arc {
            let f = i as f64 / on_arc as f64;
            // A chord of the arc from the throat on: its length and direction.
            let part = 0.5 * turned * f;
            let reach =
                if turned.abs() < 1e-9 { chord * f } else { chord * part.sin() / (0.5 * turned).sin() };
            points.push(second + DVec2::from_angle(self.angles[1] - part) * reach);
        }
        if let Some(last) = points.last_mut() {
            *last = first;
        }
        points
    }

    /// About `count` points of the pressure side, evenly spaced, from trailing edge to leading edge.
    pub(super) fn pressure(&self, count: usize) -> Vec<DVec2> {
        let [_, _, _, fourth, fifth] = self.points;
        let mut points = Cubic::new(fourth, self.angles[3], fifth, self.angles[4]).points(count.max(4));
        points.reverse();
        points
    }
}

/// Suction side at the trailing-edge circle and at the throat: points and slope angles.
fn uncovered(p: &Parameters, pitch: f64, wedge: f64) -> ((DVec2, f64), (DVec2, f64)) {
    let center = DVec2::new(p.axial_chord - p.trailing_edge_radius, 0.0);
    let b1 = p.exit_angle - wedge;
    let b2 = b1 + p.unguided_turning;
    let first = center + DVec2::from_angle(b1 + FRAC_PI_2) * p.trailing_edge_radius;
    // The throat is measured from the next blade's trailing-edge circle.
    let second = center
        + DVec2::new(0.0, pitch)
        + DVec2::from_angle(b2 - FRAC_PI_2) * (p.throat + p.trailing_edge_radius);
    ((first, b1), (second, b2))
}

/// The cubic polynomial y(x) between two points with given slopes.
struct Cubic {
    start: DVec2,
    end: DVec2,
    slopes: [f64; 2],
}

impl Cubic {
    fn new(start: DVec2, start_angle: f64, end: DVec2, end_angle: f64) -> Self {
        Self { start, end, slopes: [start_angle.tan(), end_angle.tan()] }
    }

    fn at(&self, f: f64) -> DVec2 {
        let (h, rise) = (self.end.x - self.start.x, self.end.y - self.start.y);
        let [a, b] = self.slopes.map(|s| s * h);
        let y = f * (a + f * (3.0 * rise - 2.0 * a - b + f * (a + b - 2.0 * rise)));
        DVec2::new(self.start.x + h * f, self.start.y + y)
    }

    const LOOKS: usize = 600;

    fn lengths(&self) -> Vec<f64> {
        let mut sums = vec![0.0];
        for i in 0..Self::LOOKS {
            let at = |i: usize| self.at(i as f64 / Self::LOOKS as f64);
            sums.push(sums[i] + at(i).distance(at(i + 1)));
        }
        sums
    }

    fn length(&self) -> f64 {
        self.lengths()[Self::LOOKS]
    }

    /// `count` + 1 points at nearly equal distances, ends included.
    fn points(&self, count: usize) -> Vec<DVec2> {
        let sums = self.lengths();
        let inner = (1..count).map(|i| {
            let wanted = sums[Self::LOOKS] * i as f64 / count as f64;
            let k = sums.partition_point(|&s| s < wanted).max(1);
            self.at((k as f64 - (sums[k] - wanted) / (sums[k] - sums[k - 1])) / Self::LOOKS as f64)
        });
        std::iter::once(self.start).chain(inner).chain([self.end]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example of the paper, in inches.
    pub(crate) fn example() -> Parameters {
        Parameters {
            radius: 5.5,
            axial_chord: 1.102,
            tangential_chord: 0.591,
            unguided_turning: 6.3f64.to_radians(),
            inlet_angle: 35f64.to_radians(),
            inlet_half_wedge: 8f64.to_radians(),
            leading_edge_radius: 0.031,
            exit_angle: -57f64.to_radians(),
            trailing_edge_radius: 0.016,
            blade_count: 51.0,
            throat: 0.337,
        }
    }

    #[test]
    fn the_papers_example_has_the_papers_exit_wedge() {
        let section = Section::new(example()).unwrap();
        // The paper prints 3.32; its inputs are printed with three digits, and half a unit of the throat is 0.05.
        let wedge = section.exit_half_wedge.to_degrees();
        assert!((wedge - 3.32).abs() < 0.12, "{wedge}");
        // The paper's own equations (an arc about the meeting point of the normals) with the inputs as printed.
        assert!((wedge - 3.21088).abs() < 1e-5, "{wedge}");
        // The uncovered part is a circular arc with the slopes of its ends.
        let points = section.suction(300);
        let arc = &points[points.len() - 20..];
        let circle = Circle::fit(arc).unwrap();
        assert!(arc.iter().all(|p| circle.miss(*p) < 1e-9));
        assert!((circle.center - section.points[0]).dot(DVec2::from_angle(section.angles[0])).abs() < 1e-9);
    }

    #[test]
    fn refuses_what_does_not_close() {
        let wide = Parameters { throat: 0.7, ..example() };
        assert!(matches!(Section::new(wide), Err(Flaw::Throat { .. })));
        let odd = Parameters { leading_edge_radius: 1.0, ..example() };
        assert!(Section::new(odd).is_err());
    }
}
