//! What the chambers would be beyond the straight parts' end, in the box of the turn.

use super::chart::TurnChart;
use super::{TurnSection, mirrored};
use crate::build::BuildError;
use coolinggen_nurbs::{Curve, Interpolator, ParametricCurve};
use glam::{DVec2, DVec3};

/// A point of a chamber's ring as a function of zeta: (x, eta).
#[derive(Clone, Debug)]
pub(super) struct Path(Curve<DVec2>);

impl Path {
    /// (x, eta) at zeta.
    pub(super) fn at(&self, zeta: f64) -> DVec2 {
        self.0.point(zeta)
    }
}

/// Chart point of segment `k` of the turn at `t`, as the front (0) or back (1) chamber has it in a section.
pub(super) fn ring_point(section: &TurnSection<'_>, chamber: usize, k: usize, t: f64) -> DVec2 {
    let ring = &section.rings[chamber];
    match chamber {
        0 => ring.segments[k].evaluate(section.outline, t).0,
        _ => ring.segments[mirrored(k)].evaluate(section.outline, 1.0 - t).0,
    }
}

/// Coordinates in the box of segment `k` of the chamber's ring at `t` in section `i`, found from coordinates nearby.
pub(super) fn coordinates(
    chart: &TurnChart,
    section: &TurnSection<'_>,
    chamber: usize,
    (k, t): (usize, f64),
    near: DVec3,
) -> Option<DVec3> {
    let point = section.stream.to_space(ring_point(section, chamber, k, t));
    chart.inverse(point, near)
}

/// The paths of segment `k` at the parameters `ts`, which increase; none where the box does not reach.
pub(super) fn paths(
    chart: &TurnChart,
    sections: &[TurnSection<'_>],
    chamber: usize,
    k: usize,
    ts: &[f64],
) -> Result<Option<Vec<Path>>, BuildError> {
    let across = Interpolator::new(3, &chart.levels)?;
    let mut rows: Vec<Vec<DVec2>> = vec![Vec::with_capacity(sections.len()); ts.len()];
    // About where the segment begins; every point after it lies near the one before.
    let side = if chamber == 0 { -1.0 } else { 1.0 };
    for (section, &zeta) in sections.iter().zip(&chart.levels) {
        let far = if (1..=3).contains(&k) { 1.0 } else { 5.0 };
        let mut near = DVec3::new(side * far, 0.5, zeta);
        for (row, &t) in rows.iter_mut().zip(ts) {
            let Some(q) = coordinates(chart, section, chamber, (k, t), near) else { return Ok(None) };
            row.push(DVec2::new(q.x, q.y));
            near = q;
        }
    }
    let paths = rows.iter().map(|row| Ok(Path(across.curve(row)?))).collect::<Result<_, BuildError>>()?;
    Ok(Some(paths))
}
