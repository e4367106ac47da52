//! The shape of a bore: sections across its axis.

use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Where a bore lies: x and y across the axis, z along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) origin: DVec3,
    pub(crate) x: DVec3,
    pub(crate) y: DVec3,
    /// Unit direction of the axis, `x cross y`.
    pub(crate) axis: DVec3,
}

impl Frame {
    /// The frame with the given axis whose y is the direction nearest to `toward`.
    pub(crate) fn along(origin: DVec3, axis: DVec3, toward: DVec3) -> Self {
        let y = (toward - axis * toward.dot(axis)).normalize();
        Self { origin, x: y.cross(axis), y, axis }
    }

    /// A point from its coordinates.
    pub(crate) fn point(&self, q: DVec2, z: f64) -> DVec3 {
        self.origin + self.vector(q) + self.axis * z
    }

    /// A vector across the axis.
    pub(crate) fn vector(&self, q: DVec2) -> DVec3 {
        self.x * q.x + self.y * q.y
    }
}

/// A piece of a section's outline, run through counterclockwise about the axis with a parameter in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Path {
    /// A circular arc; angles in radians from x towards y.
    Arc { center: DVec2, radius: f64, start: f64, sweep: f64 },
    /// A straight line.
    Line { from: DVec2, to: DVec2 },
    /// A straight line run through unevenly: it begins slowly for a `pace` above 1, and ends slowly for one below.
    /// For lines of a bore that fan out, so that their hits on a surface at a flat angle are evenly spaced.
    Fan { from: DVec2, to: DVec2, pace: f64 },
    /// A piece that has no length in this section.
    Point(DVec2),
}

impl Path {
    /// Point and derivative at `t`.
    pub(crate) fn evaluate(&self, t: f64) -> (DVec2, DVec2) {
        match *self {
            Self::Arc { center, radius, start, sweep } => {
                let direction = DVec2::from_angle(start + sweep * t);
                (center + direction * radius, direction.perp() * (radius * sweep))
            }
            Self::Line { from, to } => (from + (to - from) * t, to - from),
            Self::Fan { from, to, pace } => {
                let below = t + pace * (1.0 - t);
                (from + (to - from) * (t / below), (to - from) * (pace / (below * below)))
            }
            Self::Point(p) => (p, DVec2::ZERO),
        }
    }

    /// How the nodes of its pieces are spread.
    pub(super) fn grading(&self) -> Grading {
        match self {
            Self::Fan { .. } => Grading::TowardsEnds,
            Self::Arc { .. } | Self::Line { .. } | Self::Point(_) => Grading::Even,
        }
    }

    pub(crate) fn is_point(&self) -> bool {
        matches!(self, Self::Point(_))
    }
}

/// How nodes are spread over a piece of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Grading {
    Even,
    /// Twenty times as dense at both ends as evenly: for hits that run off at a flat angle there.
    TowardsEnds,
}

impl Grading {
    /// Speed at the ends relative to an even spread.
    const END_SPEED: f64 = 0.05;

    /// The parameter of the path at node `k` of `spans` between `from` and `to`.
    pub(super) fn at(self, (from, to): (f64, f64), k: usize, spans: usize) -> f64 {
        match self {
            Self::Even => from + (to - from) * k as f64 / spans as f64,
            Self::TowardsEnds => {
                let part = k as f64 / spans as f64;
                let wave = (2.0 * PI * part).sin() / (2.0 * PI);
                from + (to - from) * (part - (1.0 - Self::END_SPEED) * wave)
            }
        }
    }

    /// Derivative of the path's parameter at both ends in that of the piece, which runs over [0, 1].
    pub(super) fn end_speed(self, (from, to): (f64, f64)) -> f64 {
        match self {
            Self::Even => to - from,
            Self::TowardsEnds => (to - from) * Self::END_SPEED,
        }
    }
}

/// A section across the axis.
#[derive(Clone, Debug)]
pub(crate) struct BoreSection {
    /// Where on the axis, mm.
    pub(crate) z: f64,
    /// Its outline; all sections of a bore have as many paths, and path k of one is ruled to path k of the next.
    pub(crate) paths: Vec<Path>,
}

impl BoreSection {
    /// Points of the outline, `about` many or a few more, evenly over its paths.
    pub(crate) fn rim(&self, about: usize) -> Vec<DVec2> {
        let paths: Vec<&Path> = self.paths.iter().filter(|path| !path.is_point()).collect();
        let steps = about.div_ceil(paths.len().max(1));
        let at = move |i: usize| i as f64 / steps as f64;
        paths.into_iter().flat_map(|path| (0..steps).map(move |i| path.evaluate(at(i)).0)).collect()
    }
}

/// A bore's shape, its sections from the lower to the upper end, at least two.
#[derive(Clone, Debug)]
pub(crate) struct BoreShape {
    pub(crate) frame: Frame,
    pub(crate) sections: Vec<BoreSection>,
}

impl BoreShape {
    /// A straight bore of one outline; the two sections give its lines their direction.
    pub(crate) fn straight(frame: Frame, outline: BoreSection, length: f64) -> Self {
        let upper = BoreSection { z: outline.z + length, ..outline.clone() };
        Self { frame, sections: vec![outline, upper] }
    }
}

/// A circle in two halves.
pub(crate) fn circle(z: f64, radius: f64) -> BoreSection {
    let half = |start: f64| Path::Arc { center: DVec2::ZERO, radius, start, sweep: PI };
    BoreSection { z, paths: vec![half(0.0), half(PI)] }
}

/// A rectangle `[low, high]` with rounded corners, in eight paths: corner, side, corner, ... from the corner at high x
/// and high y on. Sides without length are points.
pub(crate) fn rounded_rectangle(z: f64, low: DVec2, high: DVec2, radius: f64) -> BoreSection {
    let inset = DVec2::splat(radius);
    let (low, high) = (low + inset, high - inset);
    let centers = [high, DVec2::new(low.x, high.y), low, DVec2::new(high.x, low.y)];
    let mut paths = Vec::with_capacity(8);
    for (k, &center) in centers.iter().enumerate() {
        let start = FRAC_PI_2 * k as f64;
        paths.push(Path::Arc { center, radius, start, sweep: FRAC_PI_2 });
        let reach = DVec2::from_angle(start + FRAC_PI_2) * radius;
        let (from, to) = (center + reach, centers[(k + 1) % 4] + reach);
        paths.push(if from.distance(to) > 1e-9 { Path::Line { from, to } } else { Path::Point(from) });
    }
    BoreSection { z, paths }
}

/// A circle of this radius, or where `height_d` is more than 1 a racetrack that is as many diameters high along y.
pub(crate) fn racetrack(z: f64, radius: f64, height_d: f64) -> BoreSection {
    if height_d == 1.0 {
        return circle(z, radius);
    }
    let half = DVec2::new(radius, radius * height_d);
    rounded_rectangle(z, -half, half, radius)
}

/// The section with its sides across y run through at a pace, slower by `pace` at high x than at low x.
pub(crate) fn fanned(mut section: BoreSection, pace: f64) -> BoreSection {
    for (k, pace) in [(1, pace), (5, 1.0 / pace)] {
        if let Path::Line { from, to } = section.paths[k] {
            section.paths[k] = Path::Fan { from, to, pace };
        }
    }
    section
}

/// A circle in the eight paths of a rounded rectangle: its quarters, and a point where each side will open.
pub(crate) fn stretched_circle(z: f64, radius: f64) -> BoreSection {
    rounded_rectangle(z, DVec2::splat(-radius), DVec2::splat(radius), radius)
}
