//! The stack: the sections of a blade over the span, with everything that chambers take from them.

use super::bridge::Bridged;
use super::error::BuildError;
use super::sections::{Grid, Section, WallLine, span_fractions, wall_lines};
use super::shell::{EndRadii, OffsetSection, offset_section};
use super::spans::{Spans, spans};
use crate::plan::{Plan, ShellPlan};
use coolinggen_blade::{Blade, StreamSpace};
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
    /// Where chambers and turns are.
    pub(super) spans: Spans,
    /// Where the leading chamber's sides give way to its nose, on the offset of each section; none where an arc that
    /// touches the sides closes it.
    pub(super) nose: Option<Vec<(f64, f64)>>,
}

impl Stack {
    /// Sections for the chambers and turns of `plan` inside `shell`, the turns with these clearances, mm.
    pub(super) fn new(
        blade: &Blade,
        space: &StreamSpace,
        grid: &Grid,
        plan: &Plan,
        shell: &ShellPlan,
        clearances: &[f64],
    ) -> Result<Self, BuildError> {
        let spans = spans(blade, space, grid, plan, shell, clearances)?;
        let mut fractions = span_fractions(&spans.chambers);
        fractions.extend(spans.turns.iter().flat_map(|t| &t.fractions));
        fractions.sort_by(f64::total_cmp);
        fractions.dedup();
        let front = reach(&spans, plan, 0);
        let sections =
            fractions.iter().map(|&v| Section::new(blade, space, grid, v)).collect::<Result<_, _>>()?;
        Self::through(blade, grid, sections, spans, plan, shell, Some(front))
    }

    /// The stack through given sections. `front` is the range of span fractions in which the leading chamber must be
    /// closed at its nose; none where nothing is asked of it.
    pub(super) fn through(
        blade: &Blade,
        grid: &Grid,
        sections: Vec<Section>,
        spans: Spans,
        plan: &Plan,
        shell: &ShellPlan,
        front: Option<[f64; 2]>,
    ) -> Result<Self, BuildError> {
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
        let nose = match front {
            None => None,
            Some(front) if natural_nose(grid, &sections, &offsets, plan, front) => {
                Some(vec![grid.leading_edge; sections.len()])
            }
            Some(front) => round_noses(grid, &sections, &mut offsets, front, ends)?,
        };
        Ok(Self { sections, offsets, walls, spans, nose })
    }

    /// The middle of the trailing chamber's end on each section.
    pub(super) fn tails(&self) -> Vec<DVec3> {
        let tail = |(s, o): (&Section, &OffsetSection)| s.stream.to_space(o.camber.back().center);
        self.sections.iter().zip(&self.offsets).map(tail).collect()
    }

    /// Indices of the sections that chamber `k` is lofted through: those within its span, less those nearer to a
    /// neighbour than a smooth loft bears. The ends stay.
    pub(super) fn of_chamber(&self, k: usize) -> Vec<usize> {
        const LEAST_GAP: f64 = 0.04;
        let [start, end] = self.spans.chambers[k];
        let v = |i: usize| self.sections[i].stream.v();
        let mut kept: Vec<usize> = Vec::new();
        for i in (0..self.sections.len()).filter(|&i| (start..=end).contains(&v(i))) {
            let clear =
                kept.last().is_none_or(|&last| v(i) - v(last) >= LEAST_GAP) && end - v(i) >= LEAST_GAP;
            if clear || v(i) == start || v(i) == end {
                kept.push(i);
            }
        }
        kept
    }

    /// Indices of the sections of a turn, away from the chambers.
    pub(super) fn of_turn(&self, turn: usize) -> Vec<usize> {
        let fractions = &self.spans.turns[turn].fractions;
        let find = |v: f64| self.sections.iter().position(|s| s.stream.v() == v);
        fractions.iter().filter_map(|&v| find(v)).collect()
    }
}

/// The range of span fractions in which chamber `k` has rings: its own, and those of its turns.
fn reach(spans: &Spans, plan: &Plan, k: usize) -> [f64; 2] {
    let [mut low, mut high] = spans.chambers[k];
    for (turn, span) in plan.turns.iter().zip(&spans.turns) {
        if turn.front == k || turn.front + 1 == k {
            let last = span.fractions[span.fractions.len() - 1];
            (low, high) = (low.min(last), high.max(last));
        }
    }
    [low, high]
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
