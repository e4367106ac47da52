//! The stack: the sections of a blade over the span, with everything that chambers take from them.

use super::bridge::Bridged;
use super::error::BuildError;
use super::sections::{Grid, Section, WallLine, span_fractions, wall_lines};
use super::shell::{EndRadii, OffsetSection, offset_section};
use crate::plan::{Plan, ShellPlan};
use coolinggen_blade::{Blade, Fault, StreamSpace};
use glam::DVec3;

/// Sections at all span fractions at which a chamber has one.
#[derive(Clone, Debug)]
pub(super) struct Stack {
    /// Outer profiles.
    pub(super) sections: Vec<Section>,
    /// The shell's inner outlines, one a section.
    pub(super) offsets: Vec<OffsetSection>,
    /// Walls, each with a line a section.
    pub(super) walls: Vec<Vec<WallLine>>,
    /// Span ranges of the chambers.
    pub(super) spans: Vec<[f64; 2]>,
    /// Where the leading chamber's sides give way to its nose, on the offset of each section; none where an arc that
    /// touches the sides closes it.
    pub(super) nose: Option<Vec<(f64, f64)>>,
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
        let nose = if natural_nose(grid, &sections, &offsets, plan, spans[0]) {
            Some(vec![grid.leading_edge; sections.len()])
        } else {
            round_noses(grid, &sections, &mut offsets, spans[0], ends)?
        };
        Ok(Self { sections, offsets, walls, spans, nose })
    }

    /// The middle of the trailing chamber's end on each section.
    pub(super) fn tails(&self) -> Vec<DVec3> {
        let tail = |(s, o): (&Section, &OffsetSection)| s.stream.to_space(o.camber.back().center);
        self.sections.iter().zip(&self.offsets).map(tail).collect()
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
            // Stream surfaces are no offsets of each other: the least of the span fractions this far below the tip.
            const STEPS: u32 = 20;
            let section = Section::new(blade, space, grid, 1.0)?;
            let mut v = 1.0f64;
            for i in 0..=STEPS {
                let at = section.stream.to_space(section.camber.at(f64::from(i) / f64::from(STEPS)).center);
                let up = section.stream.level(at).1;
                v = v.min(space.span_fraction(at - up * tip)?);
            }
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

/// Gives the leading chamber a nose of its end radius. Where arcs of that radius touch the sides behind the leading edge
/// in every section, the answer is none: they will close the chamber. Where some touch the leading edge, or a section is
/// blunter than the arc, all noses run between the same two parameters behind the arcs, and the arcs become part of the
/// offsets.
fn round_noses(
    grid: &Grid,
    sections: &[Section],
    offsets: &mut [OffsetSection],
    span: [f64; 2],
    radii: impl Fn(&Section) -> EndRadii,
) -> Result<Option<Vec<(f64, f64)>>, BuildError> {
    let within = |section: &Section| (span[0]..=span[1]).contains(&section.stream.v());
    // Arcs that touch behind the joints leave the sides smooth as they are.
    let behind_joints = |offset: &OffsetSection| {
        let (pressure, suction) = grid.leading_edge;
        offset.circle.as_ref().is_some_and(|c| c.pressure < pressure && c.suction > suction)
    };
    if sections.iter().zip(&*offsets).all(|(section, offset)| !within(section) || behind_joints(offset)) {
        return Ok(None);
    }
    let bridged: Vec<Bridged> = (sections.iter().zip(&*offsets))
        .map(|(section, offset)| Bridged::new(grid, section, offset, radii(section)))
        .collect::<Result<_, _>>()?;
    let mut ends = grid.leading_edge;
    for (pressure, suction) in bridged.iter().filter_map(Bridged::contacts) {
        ends = (ends.0.min(pressure), ends.1.max(suction));
    }
    let mut nose = Vec::with_capacity(sections.len());
    for ((section, offset), bridged) in sections.iter().zip(offsets).zip(&bridged) {
        let (opened, at) = bridged.opened(grid, section, radii(section), ends)?;
        *offset = opened;
        nose.push(at);
    }
    Ok(Some(nose))
}
