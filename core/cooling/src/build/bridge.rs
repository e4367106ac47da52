//! The offset of a section whose nose is rounded: one smooth curve over the joints of the leading edge.
//!
//! Where a leading chamber follows the offset round the nose, its faces end at the joints of the leading edge and are
//! smooth inside. An arc of given radius may touch the offset before a joint in one section and behind it in the next;
//! then the jump of curvature at the joint would wander through the side faces. So it is spread over a short length.

use super::error::BuildError;
use super::sections::{Grid, Section};
use super::shell::{EndRadii, OffsetSection};
use crate::section::{Camber, Outline, angle_between};
use coolinggen_nurbs::{Interpolator, ParametricCurve};

/// Length to either side of a joint over which the jump of curvature is spread, relative to the distance between the
/// profile and its offset. It changes the thickness there by less than a percent.
const REACH: f64 = 0.1;

/// The section with its outline parametrised by about its length in the chart, twice continuously differentiable, and
/// bridging what is too sharp for the chamber's front.
pub(super) fn bridged(
    grid: &Grid,
    section: &Section,
    offset: &OffsetSection,
    ends: EndRadii,
) -> Result<OffsetSection, BuildError> {
    let outline = &offset.outline;
    let radii = ends.in_chart(section);
    let points: Vec<_> = grid.nodes.iter().map(|&u| outline.curve().point(u)).collect();
    let (start, end) = grid.leading_edge;
    let sharp = |u: f64| {
        let inside = u.clamp(start + 1e-9 * (end - start), end - 1e-9 * (end - start));
        let (inner, outer) = (outline.frame(inside), section.outline.frame(inside));
        let degenerate =
            inner.derivative.dot(outer.derivative) <= 0.0 || outline.curvature(inside) * radii.0 >= 2.0;
        degenerate || offset.sharp_nose.as_ref().is_some_and(|s| s.contains(&u))
    };
    let mut lost = offset.sharp_nose.clone();
    for &u in grid.nodes.iter().filter(|u| (start..=end).contains(u)).filter(|u| sharp(**u)) {
        lost = Some(lost.map_or(u..=u, |l| l.start().min(u)..=l.end().max(u)));
    }
    let near_joint = |i: usize| {
        [start, end].into_iter().any(|joint| {
            let at = outline.curve().point(joint);
            let reach = REACH * at.distance(section.outline.curve().point(joint));
            (grid.nodes[i] - joint).abs() < 0.5 * (end - start) && points[i].distance(at) < reach
        })
    };
    let kept: Vec<usize> = (0..points.len())
        .filter(|&i| !near_joint(i) && !lost.as_ref().is_some_and(|l| l.contains(&grid.nodes[i])))
        .collect();
    let mut lengths = vec![0.0];
    for pair in kept.windows(2) {
        let chord = points[pair[0]].distance(points[pair[1]]);
        let tangents = [pair[0], pair[1]].map(|i| outline.frame(grid.nodes[i]).tangent);
        let half = 0.5 * angle_between(tangents[0], tangents[1]);
        // The length of an arc that turns as far.
        let stretch = if half.abs() > 1e-6 { half / half.sin() } else { 1.0 };
        lengths.push(lengths[lengths.len() - 1] + chord * stretch);
    }
    let kept_points: Vec<_> = kept.iter().map(|&i| points[i]).collect();
    let curve = Interpolator::new(3, &lengths)?.curve(&kept_points)?;
    let length_at = |u: f64| {
        let k = kept.partition_point(|&i| grid.nodes[i] <= u).clamp(1, kept.len() - 1);
        let (low, high) = (grid.nodes[kept[k - 1]], grid.nodes[kept[k]]);
        lengths[k - 1] + (lengths[k] - lengths[k - 1]) * (u - low) / (high - low)
    };
    let outline = Outline::new(curve, outline.inward());
    let joints = (length_at(start), length_at(end));
    let camber = Camber::of(&outline, length_at(grid.nose), joints, radii, section.march_step())
        .map_err(|refusal| BuildError::refused("/cooling/shell", section.stream.v(), &refusal))?;
    let sharp_nose = lost.map(|l| length_at(*l.start())..=length_at(*l.end()));
    Ok(OffsetSection { outline, camber, sharp_nose })
}
