//! Blades from a closed surface of any origin: put into order exactly.

mod regions;
pub(in crate::source) mod surgery;

use super::assemble;
use crate::blade::Blade;
use crate::error::BladeError;
use crate::fault::{Fault, Pointer};
use crate::stream::StreamSpace;
use crate::surface::BladeSurface;
use coolinggen_nurbs::{NurbsError, ParametricSurface};
use regions::{Crease, Joints};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where a surface's edges are, in its own parameter around the blade.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EdgesSpec {
    /// Parameters at which the leading edge meets the two sides. The edge is the part between them, over the seam if
    /// the first is greater than the second.
    pub leading_edge: [f64; 2],
    /// The same for the trailing edge; equal where it is sharp.
    pub trailing_edge: [f64; 2],
}

/// How far apart the borders of a surface given inline may lie to be one line, mm.
pub(super) const CLOSED: f64 = 1e-4;
/// How far a point of the surface may move where a needless knot is taken out at the seam, mm.
const SEAM: f64 = 1e-9;
/// Kinks and curvature jumps inside regions that are let pass: angle in radians.
const KINK: f64 = 0.02;

/// Turns a surface whose borders meet within `tolerance` mm into a blade: closed in u, from hub to shroud in w, u from the leading edge on. Every step is
/// exact up to rounding.
pub(super) fn blade(
    surface: &BladeSurface,
    edges: Option<&EdgesSpec>,
    tolerance: f64,
    space: &StreamSpace,
    at: &Pointer,
) -> Result<Blade, Vec<Fault>> {
    let failed = |e: NurbsError| {
        vec![Fault::new(at.clone(), "no_surface", format!("the surface cannot be used: {e}"))]
    };
    let outside = |e: BladeError| vec![Fault::new(at.clone(), "outside_contours", e.to_string()).unit("mm")];
    let surface = surgery::clamped(surface).map_err(failed)?;
    let (surface, around) = closed_in_u(surface, tolerance, at)?;
    let surface = surgery::closed_exactly(&surface).map_err(failed)?;
    let surface = along_span(surface, space, at)?;
    let surface = assemble::reaching(surface, space, at)?;
    let (creases, joints) = match edges {
        Some(edges) => (Vec::new(), given(edges, &surface, around, at)?),
        None => {
            let stream = space.surface(0.5).map_err(outside)?;
            let creases = regions::creases(&surface, 0.5);
            let joints = regions::find(&surface, &stream, &creases).map_err(outside)?;
            (creases, joints)
        }
    };
    let mut notes = Vec::new();
    let regions = regions::regions(&joints);
    let inside = |u: f64| regions.iter().any(|(_, r)| u > r[0] + 1e-7 && u < r[1] - 1e-7);
    let at_leading = |u: f64| u.min(1.0 - u) < 1e-7 || (u - regions[0].1[1]).abs() < 1e-7;
    let start = joints.leading[0];
    for Crease { u, angle, jump } in creases {
        let along = if joints.reversed { start - u } else { u - start }.rem_euclid(1.0);
        if angle > KINK && (inside(along) || at_leading(along)) {
            let message = format!(
                "the surface has a kink of {:.1} degrees at u = {u:.6} that is no end of the trailing edge",
                angle.to_degrees()
            );
            return Err(vec![
                Fault::new(at.clone(), "corner", message)
                    .value(angle.to_degrees())
                    .max(KINK.to_degrees())
                    .unit("deg")
                    .hint("only the trailing edge may have corners"),
            ]);
        }
        if !inside(along) {
            continue;
        }
        notes.push(format!(
            "the curvature changes by {:.0} % at once at u = {along:.4}, inside a region",
            100.0 * jump
        ));
    }
    let surface = if joints.reversed { surgery::reversed_u(&surface).map_err(failed)? } else { surface };
    let start = if joints.reversed { 1.0 - start } else { start };
    let surface = if start > 0.0 && start < 1.0 {
        surgery::begun_at(&surface, start, SEAM).map_err(failed)?.0
    } else {
        surface
    };
    let (outward, fit) = (surface.is_outward(), assemble::report(&surface));
    let fit = crate::blade::FitReport { notes, ..fit };
    Ok(Blade { surface, regions, outward, fit })
}

/// The surface closed in u over [0, 1], and its former domain around.
fn closed_in_u(
    surface: BladeSurface,
    tolerance: f64,
    at: &Pointer,
) -> Result<(BladeSurface, (f64, f64)), Vec<Fault>> {
    let failed = |e: NurbsError| vec![Fault::new(at.clone(), "no_surface", e.to_string())];
    let gaps = [gap(&surface), gap(&surgery::transposed(&surface).map_err(failed)?)];
    let surface = match gaps {
        [u, _] if u <= tolerance => surface,
        [_, v] if v <= tolerance => surgery::transposed(&surface).map_err(failed)?,
        [u, v] => {
            let message =
                format!("the surface is closed neither in u (gap {u:.3e} mm) nor in v (gap {v:.3e} mm)");
            return Err(vec![
                Fault::new(at.clone(), "not_closed", message).value(u.min(v)).max(tolerance).unit("mm"),
            ]);
        }
    };
    let (around, w) = surface.domain();
    Ok((surgery::on_domain(&surface, (0.0, 1.0), w).map_err(failed)?, around))
}

/// Greatest distance between the borders u = start and u = end.
fn gap(surface: &BladeSurface) -> f64 {
    let ((a, b), (c, d)) = surface.domain();
    (0..=32)
        .map(|i| {
            let v = c + (d - c) * f64::from(i) / 32.0;
            surface.point(a, v).distance(surface.point(b, v))
        })
        .fold(0.0, f64::max)
}

/// The surface with w close to the span fraction, from hub to shroud.
fn along_span(surface: BladeSurface, space: &StreamSpace, at: &Pointer) -> Result<BladeSurface, Vec<Fault>> {
    let failed = |e: NurbsError| vec![Fault::new(at.clone(), "no_surface", e.to_string())];
    let (_, (low, high)) = surface.domain();
    let mean = |t: f64| {
        let mut sum = 0.0;
        for i in 0..16 {
            sum += space.span_fraction(surface.point(f64::from(i) / 16.0, t))?;
        }
        Ok::<f64, BladeError>(sum / 16.0)
    };
    // A surface may reach far beyond: two lines within the space are enough to scale w.
    let steps = 64;
    let lines: Vec<(f64, f64)> = (0..=steps)
        .filter_map(|i| {
            let t = low + (high - low) * f64::from(i) / f64::from(steps);
            mean(t).ok().filter(|v| (-0.3..=1.3).contains(v)).map(|v| (t, v))
        })
        .collect();
    let (Some(first), Some(last)) = (lines.first(), lines.last()) else {
        let message = "the surface does not lie between hub and shroud";
        return Err(vec![Fault::new(at.clone(), "outside_contours", message).unit("mm")]);
    };
    if !((last.1 - first.1).abs() > 0.2) {
        let message = format!(
            "the surface does not run from hub to shroud: it covers span fractions {:.3} to {:.3}",
            first.1.min(last.1),
            first.1.max(last.1)
        );
        return Err(vec![Fault::new(at.clone(), "short_of_contour", message)]);
    }
    let w = |t: f64| first.1 + (t - first.0) * (last.1 - first.1) / (last.0 - first.0);
    let (start, end) = (w(low), w(high));
    if start < end {
        return surgery::on_domain(&surface, (0.0, 1.0), (start, end)).map_err(failed);
    }
    let upright = surgery::reversed_w(&surface).map_err(failed)?;
    surgery::on_domain(&upright, (0.0, 1.0), (end, start)).map_err(failed)
}

/// Joints as the design gives them.
fn given(
    edges: &EdgesSpec,
    surface: &BladeSurface,
    around: (f64, f64),
    at: &Pointer,
) -> Result<Joints, Vec<Fault>> {
    let mut faults = Vec::new();
    let scaled = |t: f64| (t - around.0) / (around.1 - around.0);
    for (key, range) in [("leading_edge", edges.leading_edge), ("trailing_edge", edges.trailing_edge)] {
        for (i, t) in range.into_iter().enumerate() {
            if !(t >= around.0 && t <= around.1) {
                let message =
                    format!("the parameter {t} is outside the surface's {} to {}", around.0, around.1);
                faults.push(
                    Fault::new(at.at("edges").at(key).at(i), "out_of_range", message)
                        .value(t)
                        .min(around.0)
                        .max(around.1),
                );
            }
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let [l, t] = [edges.leading_edge, edges.trailing_edge].map(|r| r.map(scaled));
    // Once around from the start of the leading edge everything must come in order.
    let along = |u: f64| (u - l[0]).rem_euclid(1.0);
    if !(along(l[1]) > 0.0 && along(l[1]) < along(t[0]) && along(t[0]) <= along(t[1])) {
        let message = "leading and trailing edge overlap, or the leading edge is empty";
        return Err(vec![Fault::new(at.at("edges"), "out_of_order", message)]);
    }
    let length = |from: f64, to: f64| {
        let width = (to - from).rem_euclid(1.0);
        let point = |i: u32| surface.point((from + width * f64::from(i) / 200.0).rem_euclid(1.0), 0.5);
        (0..200).map(|i| point(i).distance(point(i + 1))).sum::<f64>()
    };
    let reversed = length(l[1], t[0]) < length(t[1], l[0]);
    let order = |r: [f64; 2]| if reversed { [r[1], r[0]] } else { r };
    Ok(Joints { leading: order(l), trailing: order(t), reversed })
}
