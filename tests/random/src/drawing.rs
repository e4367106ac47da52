//! The blade on paper: inscribed circles of a few sections, from points. It shares no method with the build, whose
//! camber is marched along exact curves.

use coolinggen_blade::{Region, build};
use coolinggen_cooling::design::Design;
use glam::{DVec2, DVec3};
use serde_json::Value;
use std::path::Path;

/// Sections drawn, span fractions.
const SPANS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// Points a side.
const POINTS: usize = 240;

/// A blade's sections.
pub struct Drawing {
    /// Sections from hub to tip.
    pub sections: Vec<Section>,
    /// Shortest height from hub to tip along the edges and the middle, mm.
    pub height: f64,
}

/// A section on paper.
pub struct Section {
    /// Span fraction.
    pub v: f64,
    /// Circles from front to back.
    circles: Vec<Circle>,
    /// Length of the camber line, mm.
    pub length: f64,
    /// Length in space of one unit of the chart.
    scale: f64,
    /// +1 where the suction side lies to the left of the camber line, -1 to its right.
    suction_left: f64,
    /// Millimetres from the foremost point to the end of the leading edge's region: suction side, pressure side.
    pub nose: [f64; 2],
}

#[derive(Clone, Copy)]
struct Circle {
    /// Fraction of the camber line.
    at: f64,
    radius: f64,
    centre: DVec3,
    /// Unit direction from the centre to the suction side.
    suction: DVec3,
    /// The centre in the chart.
    chart: DVec2,
}

impl Drawing {
    /// Draws a design's blade; none if it has faults.
    pub fn of(design: &Value) -> Option<Self> {
        let design = Design::from_json(&design.to_string()).ok()?;
        let (space, blade) = build(&design.space, &design.blade, Path::new(".")).ok()?;
        let range = |region| blade.range(region);
        let (leading, suction) = (range(Region::LeadingEdge)?, range(Region::SuctionSide)?);
        let pressure = range(Region::PressureSide)?;
        let line = |from: f64, to: f64, n: usize| -> Vec<f64> {
            (0..=n).map(|i| from + (to - from) * i as f64 / n as f64).collect()
        };
        let mut sections = Vec::new();
        let mut ends: Vec<Vec<DVec3>> = Vec::new();
        for v in SPANS {
            let surface = space.surface(v).ok()?;
            let points = |u: &[f64]| -> Option<Vec<DVec2>> {
                let profile = blade.profile(&surface, u).ok()?;
                Some(profile.into_iter().map(|(_, q)| q).collect())
            };
            let side_b = points(&line(pressure[0] - 1.0, pressure[1] - 1.0, POINTS))?;
            let nose = points(&line(leading[0], leading[1], POINTS / 3))?;
            let side_a = points(&line(suction[0], suction[1], POINTS))?;
            let middle = side_a[POINTS / 2];
            let scale = surface.scale(middle);
            ends.push([nose[0], middle, side_a[POINTS]].map(|q| surface.to_space(q)).to_vec());
            sections.push(Section::new(v, [&side_a, &side_b, &nose], scale, |q| surface.to_space(q))?);
        }
        let height = |k: usize| ends.windows(2).map(|pair| pair[0][k].distance(pair[1][k])).sum::<f64>();
        Some(Self { sections, height: height(0).min(height(1)).min(height(2)) })
    }

    /// Least over the sections.
    pub fn least(&self, of: impl Fn(&Section) -> f64) -> f64 {
        self.sections.iter().map(of).fold(f64::INFINITY, f64::min)
    }

    /// Greatest over the sections.
    pub fn greatest(&self, of: impl Fn(&Section) -> f64) -> f64 {
        self.sections.iter().map(of).fold(f64::NEG_INFINITY, f64::max)
    }

    /// How far the camber line's points at a fraction bow away from the straight line from hub to tip, mm.
    pub fn bow(&self, at: f64) -> f64 {
        let centres: Vec<DVec3> = self.sections.iter().map(|s| s.near(at).centre).collect();
        let (hub, tip) = (centres[0], centres[centres.len() - 1]);
        let axis = (tip - hub).normalize();
        centres.iter().map(|c| (*c - hub).reject_from(axis).length()).fold(0.0, f64::max)
    }

    /// Camber fractions between which all sections are at least so thick, mm.
    pub fn thicker(&self, than: f64) -> Option<[f64; 2]> {
        let mut range = [0.0f64, 1.0f64];
        for section in &self.sections {
            let thick = |c: &&Circle| 2.0 * c.radius > than;
            range[0] = range[0].max(section.circles.iter().find(thick)?.at);
            range[1] = range[1].min(section.circles.iter().rfind(thick)?.at);
        }
        (range[0] < range[1]).then_some(range)
    }
}

impl Section {
    /// From points of the suction side (front to back), of the pressure side (back to front) and of the nose (pressure
    /// side to suction side) in a chart, and the length in space of one unit there.
    fn new(
        v: f64,
        [side_a, side_b, nose]: [&[DVec2]; 3],
        scale: f64,
        space: impl Fn(DVec2) -> DVec3,
    ) -> Option<Self> {
        let inwards = (side_b[side_b.len() / 2] - side_a[side_a.len() / 2]).normalize();
        let others: Vec<DVec2> = side_b.iter().chain(nose).copied().collect();
        let mut centres: Vec<(DVec2, f64, DVec2)> = Vec::new();
        for i in 1..side_a.len() - 1 {
            let normal = (side_a[i + 1] - side_a[i - 1]).perp().normalize();
            let middle = (side_a[side_a.len() / 2 + 1] - side_a[side_a.len() / 2 - 1]).perp();
            let normal = normal * middle.dot(inwards).signum();
            let radius = (others.iter())
                .filter_map(|q| {
                    let d = *q - side_a[i];
                    let along = d.dot(normal);
                    (along > 1e-9).then(|| d.length_squared() / (2.0 * along))
                })
                .fold(f64::INFINITY, f64::min);
            centres.push((side_a[i] + normal * radius, radius, side_a[i]));
        }
        let mut lengths = vec![0.0];
        for pair in centres.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + pair[0].0.distance(pair[1].0));
        }
        let (front, back) = (centres.first()?.1, centres.last()?.1);
        let length = front + lengths.last()? + back;
        let circles = (centres.iter().zip(&lengths))
            .map(|(c, l)| {
                let centre = space(c.0);
                let suction = (space(c.2) - centre).normalize();
                Circle { at: (front + l) / length, radius: c.1 * scale, centre, suction, chart: c.0 }
            })
            .collect();
        let (first, last) = (centres[0], centres[centres.len() - 1]);
        let suction_left = (last.0 - first.0).perp_dot(first.2 - first.0).signum();
        // The foremost point: farthest from the trailing edge.
        let tail = *side_a.last()?;
        let far =
            (0..nose.len()).max_by(|&i, &j| nose[i].distance(tail).total_cmp(&nose[j].distance(tail)))?;
        let along = |points: &[DVec2]| points.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>() * scale;
        Some(Self {
            v,
            circles,
            length: length * scale,
            scale,
            suction_left,
            nose: [along(&nose[far..]), along(&nose[..=far])],
        })
    }

    /// How far the circle about a camber fraction touches both sides ahead of its centre, per mm of distance from the camber
    /// line: as much as the circles grow.
    pub fn growth(&self, at: f64) -> f64 {
        const APART: f64 = 0.02;
        (self.radius(at + APART) - self.radius(at - APART)) / (2.0 * APART * self.length)
    }

    /// Where a line through the camber line's point at a fraction, at an angle to it, comes `room` mm away from it towards a
    /// side (0: suction side); in mm of the chart.
    pub fn across(&self, at: f64, angle: f64, room: f64, side: usize) -> DVec2 {
        let k = self.circles.partition_point(|c| c.at < at).clamp(3, self.circles.len() - 4);
        let (before, behind) = (self.circles[k - 3].chart, self.circles[k + 3].chart);
        let (a, b) = (self.circles[k - 1], self.circles[k]);
        let centre = a.chart.lerp(b.chart, (at - a.at) / (b.at - a.at));
        let direction = DVec2::from_angle(angle * self.suction_left).rotate((behind - before).normalize());
        let reach = room / angle.sin() * if side == 0 { 1.0 } else { -1.0 };
        centre * self.scale + direction * reach
    }

    /// The circle nearest behind a camber fraction.
    fn near(&self, at: f64) -> Circle {
        self.circles[self.circles.partition_point(|c| c.at < at).min(self.circles.len() - 1)]
    }

    /// Radius of the inscribed circle at a camber fraction, mm.
    pub fn radius(&self, at: f64) -> f64 {
        let behind = self.circles.partition_point(|c| c.at < at).clamp(1, self.circles.len() - 1);
        let (a, b) = (self.circles[behind - 1], self.circles[behind]);
        a.radius + (b.radius - a.radius) * ((at - a.at) / (b.at - a.at)).clamp(0.0, 1.0)
    }

    /// Least distance to a side, mm, from the axis of a slot: the straight line from the end of the trailing chamber, an arc
    /// of radius `fillet` between shells of the thickness `shell` (suction side, pressure side), to the trailing edge. Negative
    /// where a bent section leaves the line; none where the section has no such end.
    pub fn beside_slot(&self, shell: [f64; 2], fillet: f64) -> Option<f64> {
        let fits = |c: &Circle| 2.0 * c.radius >= shell[0] + shell[1] + 2.0 * fillet;
        let end = self.circles.iter().rposition(fits)?;
        let (last, edge) = (self.circles[end], self.circles.last()?.centre);
        // Between unequal shells the arc stands nearer to the thinner one.
        let tail = last.centre + last.suction * (0.5 * (shell[1] - shell[0]));
        // An arc about the centre of a round trailing edge keeps the shell's thickness all round.
        let Some(axis) = (edge - tail).try_normalize() else { return Some(last.radius) };
        let beside = |c: &Circle| c.radius - (c.centre - tail).reject_from(axis).length();
        self.circles[end..].iter().map(beside).min_by(f64::total_cmp)
    }

    /// Greatest radius of an inscribed circle, mm.
    pub fn greatest_radius(&self) -> f64 {
        self.circles.iter().map(|c| c.radius).fold(0.0, f64::max)
    }
}
