//! The offset of a section whose nose is rounded: one smooth curve over the joints of the leading edge.
//!
//! Where a leading chamber follows the offset round the nose, its faces end at the joints of the leading edge and are
//! smooth inside. An arc of given radius may touch the offset before a joint in one section and behind it in the next;
//! then the jump of curvature at the joint would wander through the side faces. So it is spread over a short length.
//! The same holds for the arc's own ends where some sections have an arc and others, blunter ones, have none.

use super::error::BuildError;
use super::sections::{Grid, Section};
use super::shell::{EndRadii, OffsetSection};
use crate::section::{Camber, Contact, Outline, angle_between, circle_of_radius};
use coolinggen_nurbs::{Interpolator, ParametricCurve};
use glam::DVec2;
use std::ops::RangeInclusive;

/// Length to either side of a jump of curvature over which it is spread, relative to the distance between the profile
/// and its offset, or to the radius of the arc that makes it. It takes less than a thousandth of either.
const REACH: f64 = 0.03;

/// Distances from an arc's end, in reaches, at which the outline beside it has nodes: wider gaps would spread the jump of
/// curvature over more than asked.
const BESIDE: [f64; 5] = [16.0, 8.0, 4.0, 2.0, 1.0];

/// An offset parametrised by about its length in the chart, twice continuously differentiable, and bridging what is
/// too sharp for the chamber's front.
#[derive(Clone, Debug)]
pub(super) struct Bridged {
    pub(super) offset: OffsetSection,
    /// Parameters u of the grid and lengths that belong together.
    pairs: Vec<(f64, f64)>,
}

impl Bridged {
    /// Bridges the joints of the leading edge and the sharp part of the nose: without a `width` as a spline through what
    /// is left does, else by a [`bridge`] that reaches beyond the sharp part by `width` times the end's radius. The wider it
    /// is, the blunter, and the farther from the blade.
    pub(super) fn new(
        grid: &Grid,
        section: &Section,
        offset: &OffsetSection,
        ends: EndRadii,
        width: Option<f64>,
    ) -> Result<Self, BuildError> {
        let radii = ends.in_chart(section);
        let lost = too_sharp(grid, section, offset, radii.0).map(|lost| {
            let Some(width) = width else { return lost };
            let shoulders = [*lost.start(), *lost.end()].map(|u| offset.outline.curve().point(u));
            let near = |u: &&f64| {
                let point = offset.outline.curve().point(**u);
                shoulders.iter().any(|shoulder| shoulder.distance(point) < width * radii.0)
            };
            let (low, high) = (lost.start(), lost.end());
            grid.nodes.iter().filter(near).fold(*low..=*high, |l, u| l.start().min(*u)..=l.end().max(*u))
        });
        let (start, end) = grid.leading_edge;
        let joints = [start, end].map(|joint| {
            let at = offset.outline.curve().point(joint);
            (joint, at, REACH * at.distance(section.outline.curve().point(joint)))
        });
        let (mut kept, mut nodes, mut gap) = (Vec::new(), Vec::<(DVec2, DVec2)>::new(), false);
        for &u in &grid.nodes {
            let point = offset.outline.curve().point(u);
            let near = |(joint, at, reach): &(f64, DVec2, f64)| {
                (u - joint).abs() < 0.5 * (end - start) && point.distance(*at) < *reach
            };
            if lost.as_ref().is_some_and(|lost| lost.contains(&u)) {
                gap = true;
            } else if !joints.iter().any(near) {
                let node = (point, offset.outline.frame(u).tangent);
                if let Some(&last) = nodes.last().filter(|_| gap && width.is_some()) {
                    nodes.extend(bridge(last, node));
                }
                gap = false;
                kept.push((u, nodes.len()));
                nodes.push(node);
            }
        }
        let (outline, lengths) = through(&nodes, offset.outline.inward())?;
        let pairs: Vec<(f64, f64)> = kept.into_iter().map(|(u, node)| (u, lengths[node])).collect();
        let camber = camber(grid, section, &outline, &pairs, radii)?;
        // Where it exists the plain offset's circle is the better start: the bridge may have changed the front.
        let near = offset.circle.as_ref().map(|c| Contact {
            suction: length_at(&pairs, c.suction),
            pressure: length_at(&pairs, c.pressure),
            ..*c
        });
        let circle = circle_of_radius(&outline, near.as_ref().unwrap_or(camber.front()), radii.0);
        let sharp_nose = lost.map(|lost| length_at(&pairs, *lost.start())..=length_at(&pairs, *lost.end()));
        Ok(Self { offset: OffsetSection { outline, camber, sharp_nose, circle }, pairs })
    }

    /// Where the end circle touches, in the grid's parameters, and a little behind: (pressure side, suction side).
    pub(super) fn contacts(&self) -> Option<(f64, f64)> {
        let circle = self.offset.circle.as_ref()?;
        let reach = 2.0 * REACH * circle.radius;
        Some((self.u_at(circle.pressure - reach), self.u_at(circle.suction + reach)))
    }

    /// The grid's parameter u at a length.
    fn u_at(&self, length: f64) -> f64 {
        mapped(&self.pairs, length, |p| p.1, |p| p.0)
    }

    /// How many times sharper than the end's arc the nose is between two parameters of an opened outline.
    pub(super) fn bend(opened: &OffsetSection, (start, end): (f64, f64), radius: f64) -> f64 {
        const SAMPLES: u32 = 300;
        let at = |i: u32| start + (end - start) * (f64::from(i) + 0.5) / f64::from(SAMPLES);
        (0..SAMPLES).map(|i| opened.outline.curvature(at(i)) * radius).fold(0.0, f64::max)
    }

    /// The offset with its nose opened by the end circle, and where the parameters `ends` of the grid lie on it. Without
    /// a circle the nose is left as the bridge has made it. Whether it keeps the shell's thickness is for the caller to
    /// see: a bridge over a part that is too sharp cuts it short.
    pub(super) fn opened(
        &self,
        grid: &Grid,
        section: &Section,
        radii: EndRadii,
        ends: (f64, f64),
    ) -> Result<(OffsetSection, (f64, f64)), BuildError> {
        const ARC_NODES: u32 = 24;
        let Some(circle) = &self.offset.circle else {
            let ends = (length_at(&self.pairs, ends.0), length_at(&self.pairs, ends.1));
            return Ok((OffsetSection { sharp_nose: None, ..self.offset.clone() }, ends));
        };
        let outline = &self.offset.outline;
        let reach = REACH * circle.radius;
        let (mut kept, mut nodes) = (Vec::new(), Vec::new());
        let mut keep = |lengths: &mut dyn Iterator<Item = f64>, nodes: &mut Vec<(DVec2, DVec2)>| {
            for length in lengths {
                let frame = outline.frame(length);
                kept.push((self.u_at(length), nodes.len()));
                nodes.push((frame.point, frame.tangent));
            }
        };
        let clear = (BESIDE[0] + 8.0) * reach;
        let lengths = || self.pairs.iter().map(|p| p.1);
        let before = lengths().filter(|l| *l < circle.pressure - clear);
        keep(&mut before.chain(BESIDE.map(|k| circle.pressure - k * reach)), &mut nodes);
        // The arc runs from the pressure side to the suction side, round the front.
        let [from, to] = [circle.pressure, circle.suction]
            .map(|length| (outline.frame(length).point - circle.center).normalize());
        let sweep = angle_between(from, -circle.tangent) + angle_between(-circle.tangent, to);
        // Close to both ends, even between.
        let shares = (1..ARC_NODES).map(|i| f64::from(i) / f64::from(ARC_NODES));
        let least = REACH / sweep.abs();
        let mut angles = vec![least, 2.0 * least];
        angles.extend(shares.filter(|s| (3.0 * least..=1.0 - 3.0 * least).contains(s)));
        angles.extend([1.0 - 2.0 * least, 1.0 - least]);
        for share in angles {
            let direction = DVec2::from_angle(sweep * share).rotate(from);
            nodes.push((circle.center + direction * circle.radius, direction.perp() * sweep.signum()));
        }
        let after = lengths().filter(|l| *l > circle.suction + clear);
        let beside = BESIDE.iter().rev().map(|k| circle.suction + k * reach);
        keep(&mut beside.chain(after), &mut nodes);
        let (outline, lengths) = through(&nodes, outline.inward())?;
        let pairs: Vec<(f64, f64)> = kept.into_iter().map(|(u, node)| (u, lengths[node])).collect();
        let camber = camber(grid, section, &outline, &pairs, radii.in_chart(section))?;
        let ends = (length_at(&pairs, ends.0), length_at(&pairs, ends.1));
        Ok((OffsetSection { outline, camber, sharp_nose: None, circle: None }, ends))
    }
}

/// The parameters u about the nose where the offset is too sharp for an end circle of `radius`, or turns back.
fn too_sharp(
    grid: &Grid,
    section: &Section,
    offset: &OffsetSection,
    radius: f64,
) -> Option<RangeInclusive<f64>> {
    let (start, end) = grid.leading_edge;
    let inside = 1e-9 * (end - start);
    let mut lost = offset.sharp_nose.clone();
    for &node in grid.nodes.iter().filter(|u| (start..=end).contains(*u)) {
        let u = node.clamp(start + inside, end - inside);
        let (inner, outer) = (offset.outline.frame(u), section.outline.frame(u));
        if inner.derivative.dot(outer.derivative) <= 0.0 || offset.outline.curvature(u) * radius >= 2.0 {
            lost = Some(lost.map_or(node..=node, |l| l.start().min(node)..=l.end().max(node)));
        }
    }
    lost
}

/// Points between two others, with unit tangents: on the cubic whose ends point along the tangents and reach as far towards
/// where these meet as a circle's would. A spline left to itself would bulge where the nodes thin out.
fn bridge(from: (DVec2, DVec2), to: (DVec2, DVec2)) -> Vec<(DVec2, DVec2)> {
    const NODES: u32 = 16;
    let (turn, chord) = (angle_between(from.1, to.1), to.0 - from.0);
    let sine = turn.sin();
    // Lengths of the tangents up to where they meet; where they hardly do, those of a circle's.
    let reach = [chord.perp_dot(to.1) / sine, from.1.perp_dot(chord) / sine];
    let half = 0.5 * turn.abs();
    let round = 0.5 * chord.length() / half.cos().max(0.05);
    let reach = reach.map(|r| if r.is_finite() { r.clamp(0.5 * round, 2.0 * round) } else { round });
    let share = if half > 1e-6 { 4.0 / 3.0 * (0.5 * half).tan() / half.tan().max(1e-9) } else { 2.0 / 3.0 };
    let [a, b] = [from.0 + from.1 * (reach[0] * share), to.0 - to.1 * (reach[1] * share)];
    (1..NODES)
        .map(|i| {
            let t = f64::from(i) / f64::from(NODES);
            let s = 1.0 - t;
            let point =
                from.0 * (s * s * s) + a * (3.0 * s * s * t) + b * (3.0 * s * t * t) + to.0 * (t * t * t);
            let slope = (a - from.0) * (s * s) + (b - a) * (2.0 * s * t) + (to.0 - b) * (t * t);
            (point, slope.normalize())
        })
        .collect()
}

/// The smooth curve through points with their unit tangents, by about its length, and the lengths at the points.
fn through(nodes: &[(DVec2, DVec2)], inward: f64) -> Result<(Outline, Vec<f64>), BuildError> {
    let mut lengths = vec![0.0];
    for pair in nodes.windows(2) {
        let chord = pair[0].0.distance(pair[1].0);
        let half = 0.5 * angle_between(pair[0].1, pair[1].1);
        // The length of an arc that turns as far.
        let stretch = if half.abs() > 1e-6 { half / half.sin() } else { 1.0 };
        lengths.push(lengths[lengths.len() - 1] + chord * stretch);
    }
    let points: Vec<DVec2> = nodes.iter().map(|n| n.0).collect();
    Ok((Outline::new(Interpolator::new(3, &lengths)?.curve(&points)?, inward), lengths))
}

fn camber(
    grid: &Grid,
    section: &Section,
    outline: &Outline,
    pairs: &[(f64, f64)],
    radii: (f64, f64),
) -> Result<Camber, BuildError> {
    let joints = (length_at(pairs, grid.leading_edge.0), length_at(pairs, grid.leading_edge.1));
    Camber::of(outline, length_at(pairs, grid.nose), joints, radii, section.march_step())
        .map_err(|refusal| BuildError::refused("/cooling/shell", section.stream.v(), &refusal))
}

/// The length at the grid's parameter u.
fn length_at(pairs: &[(f64, f64)], u: f64) -> f64 {
    mapped(pairs, u, |p| p.0, |p| p.1)
}

/// The piecewise linear function through pairs, from one of their members to the other.
fn mapped(
    pairs: &[(f64, f64)],
    x: f64,
    from: impl Fn(&(f64, f64)) -> f64,
    to: impl Fn(&(f64, f64)) -> f64,
) -> f64 {
    let k = pairs.partition_point(|p| from(p) <= x).clamp(1, pairs.len() - 1);
    let (low, high) = (&pairs[k - 1], &pairs[k]);
    to(low) + (to(high) - to(low)) * (x - from(low)) / (from(high) - from(low))
}
