//! The sections of a blade: profiles on a set of stream surfaces, with their camber and their walls.

use super::error::BuildError;
use crate::plan::WallPlan;
use crate::section::{Camber, Outline};
use coolinggen_blade::{Blade, Region, StreamSpace, StreamSurface};
use coolinggen_nurbs::{Curve, Interpolator, Knots, NurbsError, ParametricCurve, ParametricSurface};
use glam::{DVec2, DVec3};
use std::ops::RangeInclusive;

/// The outer profile on one stream surface, open at the trailing edge.
#[derive(Clone, Debug)]
pub(super) struct Section {
    pub(super) stream: StreamSurface,
    pub(super) outline: Outline,
    /// The blade's v-parameter at each node.
    pub(super) blade_v: Vec<f64>,
    pub(super) camber: Camber,
}

/// Parameters that all sections share.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// Nodes in u, increasing; negative on the pressure side.
    pub(super) nodes: Vec<f64>,
    /// Cubic interpolation of each region: pressure side, leading edge, suction side. The blade's curvature may
    /// jump between regions, so that no spline may run smoothly over their joints.
    pieces: [Piece; 3],
    /// Ends of the leading edge: pressure side, suction side.
    pub(super) leading_edge: (f64, f64),
    /// The foremost point.
    pub(super) nose: f64,
}

#[derive(Clone, Debug)]
struct Piece {
    /// Range of the nodes, joints included.
    nodes: RangeInclusive<usize>,
    interpolator: Interpolator,
}

impl Grid {
    /// Nodes at every knot of the blade and halfway between, all round but for the trailing edge.
    pub(super) fn new(blade: &Blade) -> Result<Self, BuildError> {
        let missing = || BuildError::NoCrossing { face: "blade".into(), v: 0.0 };
        let leading = blade.range(Region::LeadingEdge).ok_or_else(missing)?;
        let suction = blade.range(Region::SuctionSide).ok_or_else(missing)?;
        let pressure = blade.range(Region::PressureSide).ok_or_else(missing)?;
        let knots = blade.surface.breaks_u();
        let mut nodes = vec![pressure[0] - 1.0];
        let mut piece = |start: f64, end: f64, shift: f64| -> Result<Piece, BuildError> {
            let first = nodes.len() - 1;
            let inner = knots.iter().map(|k| k + shift).filter(|k| *k > start + 1e-9 && *k < end - 1e-9);
            for k in inner.chain([end]) {
                nodes.extend([0.5 * (nodes[nodes.len() - 1] + k), k]);
            }
            let range = first..=nodes.len() - 1;
            Ok(Piece { interpolator: Interpolator::new(3, &nodes[range.clone()])?, nodes: range })
        };
        // The leading edge begins at u = 0, where the pressure side ends.
        let pieces = [
            piece(pressure[0] - 1.0, leading[0], -1.0)?,
            piece(leading[0], leading[1], 0.0)?,
            piece(suction[0], suction[1], 0.0)?,
        ];
        let nose = foremost(blade, &nodes, suction[1]);
        Ok(Self { nodes, pieces, leading_edge: (leading[0], leading[1]), nose })
    }

    /// The nodes, the two at the trailing edge moved off its kink onto their sides.
    pub(super) fn inside(&self) -> Vec<f64> {
        const OFF: f64 = 1e-9;
        let mut nodes = self.nodes.clone();
        let last = nodes.len() - 1;
        (nodes[0], nodes[last]) = (nodes[0] + OFF, nodes[last] - OFF);
        nodes
    }

    /// The curve through points at the nodes: a cubic a region, continuous where they join.
    pub(super) fn curve(&self, points: &[DVec2]) -> Result<Curve<DVec2>, NurbsError> {
        let mut knots: Vec<f64> = Vec::new();
        let mut controls: Vec<DVec2> = Vec::new();
        for piece in &self.pieces {
            let curve = piece.interpolator.curve(&points[piece.nodes.clone()])?;
            let values = curve.knots().values();
            if controls.is_empty() {
                knots.extend(values);
                controls.extend(curve.points());
            } else {
                // Three knots at the joint hold the pieces together in their common point.
                knots.pop();
                knots.extend(&values[4..]);
                controls.extend(&curve.points()[1..]);
            }
        }
        Curve::new(Knots::new(3, knots)?, controls)
    }
}

/// The node of the middle section farthest from the trailing edge: the leading edge's region may reach farther along
/// one side than along the other.
fn foremost(blade: &Blade, nodes: &[f64], trailing: f64) -> f64 {
    const MIDDLE: f64 = 0.5;
    let end = blade.surface.point(trailing, MIDDLE);
    let distance = |u: f64| blade.surface.point(u.rem_euclid(1.0), MIDDLE).distance(end);
    let far = nodes.iter().copied().max_by(|a, b| distance(*a).total_cmp(&distance(*b)));
    far.unwrap_or(0.0)
}

impl Section {
    /// The section of `blade` on the stream surface at span fraction `v`.
    ///
    /// # Errors
    /// Faults of the blade where it has no such section.
    pub(super) fn new(blade: &Blade, space: &StreamSpace, grid: &Grid, v: f64) -> Result<Self, BuildError> {
        Self::cut(blade, space, grid, v).map_err(|e| e.blamed_on("/blade"))
    }

    fn cut(blade: &Blade, space: &StreamSpace, grid: &Grid, v: f64) -> Result<Self, BuildError> {
        let stream = space.surface(v)?;
        let crossings = blade.profile(&stream, &grid.nodes)?;
        let (blade_v, points): (Vec<f64>, Vec<DVec2>) = crossings.into_iter().unzip();
        let curve = grid.curve(&points)?;
        let turn: f64 = points.windows(2).map(|p| p[0].perp_dot(p[1])).sum::<f64>()
            + points[points.len() - 1].perp_dot(points[0]);
        let outline = Outline::new(curve, turn.signum());
        let length: f64 = points.windows(2).map(|p| p[0].distance(p[1])).sum();
        let camber = Camber::of(&outline, grid.nose, grid.leading_edge, (0.0, 0.0), length / 200.0)
            .map_err(|refusal| BuildError::refused("/blade", v, &refusal))?;
        Ok(Self { stream, outline, blade_v, camber })
    }

    /// Greatest step of marching the camber of an offset.
    pub(super) fn march_step(&self) -> f64 {
        self.camber.length() / 100.0
    }

    /// Length ratio of space to chart at a point.
    pub(super) fn scale(&self, q: DVec2) -> f64 {
        self.stream.scale(q)
    }
}

/// A wall in one section; lengths still as asked for, in space.
#[derive(Clone, Copy, Debug)]
pub(super) struct WallLine {
    pub(super) center: DVec2,
    /// Unit direction, towards the suction side.
    pub(super) direction: DVec2,
    /// Camber tangent, towards the trailing edge.
    pub(super) downstream: DVec2,
    /// Chart length of half the thickness.
    pub(super) half_thickness: f64,
}

/// The lines of a wall in all sections, with the thickness corrected for the wall's inclination to the stream
/// surfaces: a wall that leans by gamma is thinner than its section by cos gamma.
pub(super) fn wall_lines(sections: &[Section], wall: &WallPlan) -> Result<Vec<WallLine>, BuildError> {
    let mut lines = Vec::with_capacity(sections.len());
    for section in sections {
        let v = section.stream.v();
        let circle = section.camber.at(wall.position.at(v));
        // The suction side lies on this side of the camber line.
        let suction = section.outline.frame(circle.suction);
        let side = circle.tangent.perp_dot(suction.point - circle.center).signum();
        let angle = wall.angle_deg.at(v).to_radians() * side;
        let direction = DVec2::from_angle(angle).rotate(circle.tangent);
        let half_thickness = 0.5 * wall.thickness.at(v) / section.scale(circle.center);
        lines.push(WallLine { center: circle.center, direction, downstream: circle.tangent, half_thickness });
    }
    let path = over_span(sections, |i| sections[i].stream.to_space(lines[i].center))?;
    for (section, line) in sections.iter().zip(&mut lines) {
        let rise = path.derivatives(section.stream.v())[1];
        let (_, dm, dt) = section.stream.to_space_derivatives(line.center);
        let along = dm * line.direction.x + dt * line.direction.y;
        let across = line.direction.perp();
        let normal_in_section = (dm * across.x + dt * across.y).normalize();
        let cosine = normal_in_section.dot(along.cross(rise).normalize()).abs();
        line.half_thickness /= cosine;
    }
    Ok(lines)
}

/// Which of increasing span fractions a smooth curve can be drawn through: the ends, and those between that are not
/// nearer to a neighbour than it bears.
pub(super) fn well_apart(v: &[f64]) -> Vec<usize> {
    const LEAST_GAP: f64 = 0.04;
    let Some(last) = v.len().checked_sub(1) else { return Vec::new() };
    // In a short chamber, between two turns, thirds of the span stay: a cubic needs four sections.
    let gap = LEAST_GAP.min(0.25 * (v[last] - v[0]));
    let mut kept: Vec<usize> = Vec::new();
    for i in 0..=last {
        let clear = kept.last().is_none_or(|&k| v[i] - v[k] >= gap) && v[last] - v[i] >= gap;
        if clear || i == 0 || i == last {
            kept.push(i);
        }
    }
    kept
}

/// The smooth curve over the span through a point of each section, less those too near to a neighbour: turns have
/// sections so close to those of chambers that a curve through all would have any slope.
pub(super) fn over_span(
    sections: &[Section],
    point: impl Fn(usize) -> DVec3,
) -> Result<Curve<DVec3>, NurbsError> {
    let v: Vec<f64> = sections.iter().map(|s| s.stream.v()).collect();
    let kept = well_apart(&v);
    // A cubic needs four.
    let kept = if kept.len() < 4 { (0..v.len()).collect() } else { kept };
    let nodes: Vec<f64> = kept.iter().map(|&i| v[i]).collect();
    let points: Vec<DVec3> = kept.into_iter().map(point).collect();
    Interpolator::new(3, &nodes)?.curve(&points)
}

/// Greatest step of the span fraction from section to section.
const GREATEST_STEP: f64 = 0.1;
/// Least steps within a chamber: a cubic over the span needs four sections.
const LEAST_STEPS: usize = 3;

/// Span fractions of the sections: both ends of every chamber, and between them steps of at most a tenth, but three
/// at least in every chamber.
pub(super) fn span_fractions(spans: &[[f64; 2]]) -> Vec<f64> {
    let mut ends: Vec<f64> = spans.iter().flatten().copied().collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let mut parts: Vec<usize> =
        ends.windows(2).map(|e| ((e[1] - e[0]) / GREATEST_STEP).ceil().max(1.0) as usize).collect();
    for span in spans {
        let within = ends.windows(2).zip(&mut parts).filter(|(e, _)| e[0] >= span[0] && e[1] <= span[1]);
        let within: Vec<&mut usize> = within.map(|(_, parts)| parts).collect();
        let steps: usize = within.iter().map(|parts| **parts).sum();
        let times = LEAST_STEPS.div_ceil(steps.max(1));
        within.into_iter().for_each(|parts| *parts *= times);
    }
    let mut fractions = Vec::new();
    for (pair, parts) in ends.windows(2).zip(parts) {
        let gap = pair[1] - pair[0];
        fractions.extend((0..parts).map(|i| pair[0] + gap * i as f64 / parts as f64));
    }
    fractions.extend(ends.last());
    fractions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_chamber_has_four_sections_at_least_and_its_own_ends() {
        for spans in [
            vec![[0.0, 1.0]],
            vec![[0.2, 0.21]],
            vec![[0.0, 0.93], [0.1, 0.3], [0.25, 0.93]],
            vec![[0.0, 0.5], [0.45, 0.5], [0.5, 1.0]],
        ] {
            let fractions = span_fractions(&spans);
            assert!(fractions.windows(2).all(|f| f[1] > f[0] && f[1] - f[0] < GREATEST_STEP + 1e-12));
            for span in spans {
                let own = fractions.iter().filter(|v| (span[0]..=span[1]).contains(*v)).count();
                assert!(own > LEAST_STEPS, "{span:?}: {fractions:?}");
                assert!(span.iter().all(|end| fractions.contains(end)));
            }
        }
    }
}
