//! The stack: the sections of a blade over the span, with everything that chambers take from them.

use super::bridge::bridged;
use super::error::BuildError;
use super::sections::{Grid, Section, WallLine, span_fractions, wall_lines};
use super::shell::{EndRadii, OffsetSection, offset_section};
use crate::plan::{Plan, ShellPlan};
use coolinggen_blade::{Blade, Fault, StreamSpace};

/// Sections at all span fractions at which a chamber has one.
#[derive(Clone, Debug)]
pub(super) struct Stack {
    /// Leading edge and nodes that all sections share.
    pub(super) leading_edge: (f64, f64),
    /// Outer profiles.
    pub(super) sections: Vec<Section>,
    /// The shell's inner outlines, one a section.
    pub(super) offsets: Vec<OffsetSection>,
    /// Walls, each with a line a section.
    pub(super) walls: Vec<Vec<WallLine>>,
    /// Span ranges of the chambers.
    pub(super) spans: Vec<[f64; 2]>,
    /// Whether the leading chamber follows the offset profile round the nose.
    pub(super) natural_nose: bool,
}

impl Stack {
    /// Sections for the chambers of `plan` inside `shell`.
    pub(super) fn new(
        blade: &Blade,
        space: &StreamSpace,
        grid: &Grid,
        plan: &Plan,
        shell: &ShellPlan,
    ) -> Result<Self, BuildError> {
        let spans = spans(blade, space, grid, plan, shell)?;
        let fractions = span_fractions(&spans);
        let sections: Vec<Section> =
            fractions.iter().map(|&v| Section::new(blade, space, grid, v)).collect::<Result<_, _>>()?;
        let walls = plan.walls.iter().map(|wall| wall_lines(&sections, wall)).collect::<Result<_, _>>()?;
        let (first, last) = (&plan.chambers[0], &plan.chambers[plan.chambers.len() - 1]);
        let mut refusals = Vec::new();
        let mut offsets: Vec<OffsetSection> = Vec::with_capacity(sections.len());
        let ends = |section: &Section| {
            let v = section.stream.v();
            EndRadii { front: first.fillet_radius.at(v), back: last.fillet_radius.at(v) }
        };
        for section in &sections {
            match offset_section(blade, grid, section, shell, ends(section)) {
                Ok(offset) => offsets.push(offset),
                Err(BuildError::Refused(faults)) => refusals.extend(faults),
                Err(other) => return Err(other),
            }
        }
        if !refusals.is_empty() {
            return Err(BuildError::worst(refusals));
        }
        let natural_nose = natural_nose(grid, &sections, &offsets, plan, spans[0]);
        if !natural_nose {
            for (section, offset) in sections.iter().zip(&mut offsets) {
                *offset = bridged(grid, section, offset, ends(section))?;
            }
        }
        Ok(Self { leading_edge: grid.leading_edge, sections, offsets, walls, spans, natural_nose })
    }

    /// Indices of the sections within a span range.
    pub(super) fn within(&self, span: [f64; 2]) -> impl Iterator<Item = usize> + '_ {
        let inside = move |i: &usize| (span[0]..=span[1]).contains(&self.sections[*i].stream.v());
        (0..self.sections.len()).filter(inside)
    }
}

/// Span ranges of the chambers: as given, or from the hub to the tip less the shell's tip thickness.
fn spans(
    blade: &Blade,
    space: &StreamSpace,
    grid: &Grid,
    plan: &Plan,
    shell: &ShellPlan,
) -> Result<Vec<[f64; 2]>, BuildError> {
    let top = match shell.tip {
        None => 1.0,
        Some(tip) => {
            let section = Section::new(blade, space, grid, 1.0)?;
            let at = section.stream.to_space(section.camber.at(0.5).center);
            let gradient = section.stream.level(at).1;
            // The span fraction falls by this much a millimetre below the tip.
            let below = at - gradient.normalize() * tip;
            let v = space.span_fraction(below)?;
            if !(v > 0.05) {
                let message = "the tip thickness leaves no room for a chamber";
                let fault = Fault::new("/cooling/shell/tip", "geometry", message).value(tip).unit("mm");
                return Err(BuildError::Refused(vec![fault]));
            }
            v
        }
    };
    Ok(plan.chambers.iter().map(|c| c.span.unwrap_or([0.0, top])).collect())
}

/// Whether the leading chamber may follow the offset profile round the nose: it may where the nose is nowhere sharper
/// than half the fillet radius, neither in space nor in a section. One answer for all its sections, for a change of
/// form inside the span would show in the loft; the margin of two keeps blades that taper on one side of it.
fn natural_nose(
    grid: &Grid,
    sections: &[Section],
    offsets: &[OffsetSection],
    plan: &Plan,
    span: [f64; 2],
) -> bool {
    const SAMPLES: usize = 60;
    let (start, end) = grid.leading_edge;
    let within = |section: &Section| (span[0]..=span[1]).contains(&section.stream.v());
    sections.iter().zip(offsets).filter(|(section, _)| within(section)).all(|(section, offset)| {
        let front = offset.camber.front();
        let radius = plan.chambers[0].fillet_radius.at(section.stream.v()) / section.scale(front.center);
        // Inside the joints, where the curve has one curvature.
        let regular = (1..SAMPLES).all(|i| {
            let u = start + (end - start) * i as f64 / SAMPLES as f64;
            let forward = offset.outline.frame(u).derivative.dot(section.outline.frame(u).derivative) > 0.0;
            forward && offset.outline.curvature(u) * radius < 2.0
        });
        offset.sharp_nose.is_none() && front.radius > 0.5 * radius && regular
    })
}
