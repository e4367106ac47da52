//! The shell: the offset of the blade's surface, cut by the stream surfaces (DESIGN 5.3, steps 1, 2).

use super::error::BuildError;
use super::sections::{Grid, Section};
use crate::plan::ShellPlan;
use crate::section::{Camber, Contact, Outline, Refusal, circle_of_radius};
use coolinggen_blade::Blade;
use coolinggen_nurbs::ParametricSurface;
use std::ops::RangeInclusive;

/// An offset section: its outline and camber.
#[derive(Clone, Debug)]
pub(super) struct OffsetSection {
    pub(super) outline: Outline,
    pub(super) camber: Camber,
    /// Where the outer nose is too sharp for a chamber that follows it; there the outline is not corrected.
    pub(super) sharp_nose: Option<RangeInclusive<f64>>,
    /// The circle of the leading chamber's end radius at its front; none where the nose is blunter.
    pub(super) circle: Option<Contact>,
}

impl OffsetSection {
    /// Whether that circle touches behind the sharp part of the nose.
    pub(super) fn circle_is_clear(&self) -> bool {
        let (Some(circle), Some(sharp)) = (&self.circle, &self.sharp_nose) else { return true };
        !sharp.contains(&circle.pressure) && !sharp.contains(&circle.suction)
    }

    /// Why the leading chamber has no front of this radius, mm of the chart.
    pub(super) fn nose_refusal(&self, needed: f64) -> Refusal {
        let radius = self.camber.greatest_radius();
        if radius <= needed { Refusal::ChamberVanishes { radius, needed } } else { Refusal::NoseTooSharp }
    }
}

/// Smallest radii, mm in space, at which marching the offset's camber ends at (front, back).
#[derive(Clone, Copy, Debug)]
pub(super) struct EndRadii {
    pub(super) front: f64,
    pub(super) back: f64,
}

impl EndRadii {
    /// The radii in the chart of a section.
    pub(super) fn in_chart(self, section: &Section) -> (f64, f64) {
        let scale = section.scale(section.camber.at(0.5).center);
        (self.front / scale, self.back / scale)
    }
}

/// The inner outline of the shell on one section.
pub(super) fn offset_section(
    blade: &Blade,
    grid: &Grid,
    section: &Section,
    shell: &ShellPlan,
    ends: EndRadii,
) -> Result<OffsetSection, BuildError> {
    let v = section.stream.v();
    let asked: Vec<f64> = grid.nodes.iter().map(|&u| asked_thickness(grid, shell, u, v)).collect();
    let refused = |refusal: &Refusal| BuildError::refused("/cooling/shell", v, refusal);
    let thickness = 0.5 * (shell.pressure_side.at(v) + shell.suction_side.at(v));
    let room = room(section);
    let too_thick = |end: f64| refused(&Refusal::ShellTooThick { thickness, greatest: room - end, end });
    // Past the thickest circle no chamber is left, and none of what follows has a solution.
    if room - thickness <= ends.front.min(ends.back) {
        return Err(too_thick(ends.front.min(ends.back)));
    }
    let (radii, step) = (ends.in_chart(section), section.march_step());
    let camber_of = |outline: &Outline| {
        Camber::of(outline, grid.nose, grid.leading_edge, radii, step).map_err(|refusal| match refusal {
            Refusal::NoInscribedCircle if room - thickness <= ends.front.max(ends.back) => {
                too_thick(ends.front.max(ends.back))
            }
            other => refused(&other),
        })
    };
    let points = blade.offset_profile(&section.stream, &grid.inside(), &asked, &section.blade_v)?;
    let outline = Outline::new(grid.curve(&points)?, section.outline.inward());
    let camber = camber_of(&outline)?;
    let sharp_nose = sharp_nose(blade, grid, section, &asked, ends.front);
    let circle = circle_of_radius(&outline, camber.front(), radii.0);
    Ok(OffsetSection { outline, camber, sharp_nose, circle })
}

/// About the radius, mm in space, of the thickest circle inside the profile.
fn room(section: &Section) -> f64 {
    let radius = |c: &Contact| c.radius * section.scale(c.center);
    section.camber.contacts().iter().map(radius).fold(0.0, f64::max)
}

/// Where, about the leading edge, the surface of the shell would be sharper than half the fillet radius, or not exist
/// at all: the blade's curvature in space decides, which on a leaned blade is greater than that of its sections.
fn sharp_nose(
    blade: &Blade,
    grid: &Grid,
    section: &Section,
    asked: &[f64],
    fillet: f64,
) -> Option<RangeInclusive<f64>> {
    let (start, end) = grid.leading_edge;
    let inward = if blade.outward { -1.0 } else { 1.0 };
    // The curvature may jump at the joints: the leading edge's own counts.
    let inside = 1e-9 * (end - start);
    let sharp = |i: &usize| {
        let u = grid.nodes[*i].clamp(start + inside, end - inside);
        let d = blade.surface.derivatives(u.rem_euclid(1.0), section.blade_v[*i]);
        let greatest = d.principal_curvatures().map(|k| k * inward).into_iter().fold(0.0, f64::max);
        greatest * (asked[*i] + 0.5 * fillet) >= 1.0
    };
    let within: Vec<usize> =
        (0..grid.nodes.len()).filter(|&i| (start..=end).contains(&grid.nodes[i])).filter(sharp).collect();
    let (first, last) = (within.first()?, within.last()?);
    Some(grid.nodes[*first]..=grid.nodes[*last])
}

/// Thickness asked for at u: by side, blended with two continuous derivatives round the leading edge.
pub(super) fn asked_thickness(grid: &Grid, shell: &ShellPlan, u: f64, v: f64) -> f64 {
    let (start, end) = grid.leading_edge;
    let x = ((u - start) / (end - start)).clamp(0.0, 1.0);
    let blend = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
    let (pressure, suction) = (shell.pressure_side.at(v), shell.suction_side.at(v));
    pressure + (suction - pressure) * blend
}
