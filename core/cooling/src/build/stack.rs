//! The stack: the sections of a blade over the span, with everything that chambers take from them.

use super::bridge::Bridged;
use super::error::BuildError;
use super::sections::{Grid, Section, WallLine, span_fractions, wall_lines, well_apart};
use super::shell::{EndRadii, OffsetSection, asked_thickness, offset_section};
use super::spans::{Spans, spans};
use crate::plan::{Plan, ShellPlan};
use crate::section::circle_of_radius;
use crate::watch::Watch;
use coolinggen_blade::{Blade, StreamSpace};
use coolinggen_nurbs::{ParametricCurve, ParametricSurface, Projection};
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
    /// Least share of the shell's thickness that this nose keeps.
    pub(super) kept: f64,
    /// How many times greater than the trailing chamber's fillets the arc is that ends it.
    pub(super) tail: f64,
    /// The middle of that arc on each section.
    pub(super) tails: Vec<DVec3>,
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
        watch: &dyn Watch,
    ) -> Result<Self, BuildError> {
        let spans = spans(blade, space, grid, plan, shell, clearances)?;
        let mut fractions = span_fractions(&spans.chambers);
        fractions.extend(spans.turns.iter().flat_map(|t| &t.fractions));
        fractions.sort_by(f64::total_cmp);
        fractions.dedup();
        let front = reach(&spans, plan, 0);
        let section = |&v: &f64| watch.go_on().and_then(|()| Section::new(blade, space, grid, v));
        let sections = fractions.iter().map(section).collect::<Result<_, _>>()?;
        Self::through(blade, grid, sections, spans, plan, shell, Some(front), watch)
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
        watch: &dyn Watch,
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
            watch.go_on()?;
            match offset_section(blade, grid, section, shell, ends(section)) {
                Ok(offset) => offsets.push(offset),
                Err(BuildError::Refused(faults)) => refusals.extend(faults),
                Err(other) => return Err(other),
            }
        }
        if !refusals.is_empty() {
            return Err(BuildError::worst(refusals));
        }
        let (nose, kept) = match front {
            None => (None, 1.0),
            Some(front) if natural_nose(grid, &sections, &offsets, plan, front) => {
                (Some(vec![grid.leading_edge; sections.len()]), 1.0)
            }
            Some(front) => match round_noses(blade, grid, &sections, &mut offsets, shell, front, ends)? {
                Some(noses) => (Some(noses.ends), noses.kept),
                None => (None, 1.0),
            },
        };
        let back = reach(&spans, plan, plan.chambers.len() - 1);
        let tail = tail(&sections, &offsets, back, |section| ends(section).in_chart(section).1);
        let tail_of = |(section, offset): (&Section, &OffsetSection)| {
            let back = offset.camber.back();
            // Without a blunt trailing edge it is the camber line's last circle.
            if tail == 1.0 {
                return section.stream.to_space(back.center);
            }
            let radius = tail * ends(section).back / section.scale(back.center);
            let arc = circle_of_radius(&offset.outline, back, radius);
            section.stream.to_space(arc.map_or(back.center, |arc| arc.center))
        };
        let tails = sections.iter().zip(&offsets).map(tail_of).collect();
        Ok(Self { sections, offsets, walls, spans, nose, kept, tail, tails })
    }

    /// Indices of the sections that chamber `k` is lofted through: those within its span, less those nearer to a
    /// neighbour than a smooth loft bears. The ends stay.
    pub(super) fn of_chamber(&self, k: usize) -> Vec<usize> {
        let [start, end] = self.spans.chambers[k];
        let v = |i: usize| self.sections[i].stream.v();
        let within: Vec<usize> =
            (0..self.sections.len()).filter(|&i| (start..=end).contains(&v(i))).collect();
        let fractions: Vec<f64> = within.iter().map(|&i| v(i)).collect();
        well_apart(&fractions).into_iter().map(|k| within[k]).collect()
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
///
/// # Errors
/// A nose so sharp that what bridges it would take metal from the shell.
fn round_noses(
    blade: &Blade,
    grid: &Grid,
    sections: &[Section],
    offsets: &mut [OffsetSection],
    shell: &ShellPlan,
    span: [f64; 2],
    radii: impl Fn(&Section) -> EndRadii,
) -> Result<Option<Noses>, BuildError> {
    let within = |section: &Section| (span[0]..=span[1]).contains(&section.stream.v());
    // Arcs that touch behind the joints leave the sides smooth as they are.
    let behind_joints = |offset: &OffsetSection| {
        let (pressure, suction) = grid.leading_edge;
        offset.circle.as_ref().is_some_and(|c| c.pressure < pressure && c.suction > suction)
    };
    if sections.iter().zip(&*offsets).all(|(section, offset)| !within(section) || behind_joints(offset)) {
        return Ok(None);
    }
    let widths = std::iter::once(None).chain(WIDTHS.map(Some));
    let (mut best, mut refusal) = (None::<Noses>, None);
    for width in widths {
        match Noses::new(blade, grid, (sections, &*offsets), shell, span, &radii, width) {
            Ok(noses) => {
                let done = noses.kept >= FULL && (width.is_none() || noses.bend <= MOST_BEND);
                if done || best.as_ref().is_none_or(|best| noses.better(best)) {
                    best = Some(noses);
                }
                if done {
                    break;
                }
            }
            // Wider ones may leave the sides no length: the first refusal says most.
            Err(error) => refusal = refusal.or(Some(error)),
        }
    }
    match (best, refusal) {
        (Some(mut best), _) if best.kept >= LEAST_KEPT => {
            let opened = std::mem::take(&mut best.offsets);
            offsets.iter_mut().zip(opened).for_each(|(offset, opened)| *offset = opened);
            Ok(Some(best))
        }
        (Some(best), _) => {
            let (section, offset) = (&sections[best.thinnest], &offsets[best.thinnest]);
            let radius = radii(section).in_chart(section).0;
            let scale = section.scale(best.offsets[best.thinnest].camber.front().center);
            let refusal = offset.nose_refusal(radius).in_space(scale, radii(section).front);
            Err(BuildError::refused("/cooling/chambers/0", section.stream.v(), &refusal))
        }
        (None, Some(refusal)) => Err(refusal),
        (None, None) => Ok(None),
    }
}

/// By how many end radii bridges reach beyond the sharp part of the nose, tried in turn where a spline over the sharp part
/// takes metal from the shell.
const WIDTHS: [f64; 9] = [0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0];
/// How many times sharper than the end's arc the nose over a bridge may be for the first try to be taken.
const MOST_BEND: f64 = 2.0;
/// Share of the shell's thickness that is all of it, as far as turns are concerned.
const FULL: f64 = 0.999;
/// Least share of the shell's thickness round a nose, where no bridge keeps more.
const LEAST_KEPT: f64 = 0.99;

/// The noses of all sections, bridged and opened alike.
struct Noses {
    offsets: Vec<OffsetSection>,
    /// Where the sides give way to the nose.
    ends: Vec<(f64, f64)>,
    /// How many times sharper than the end's arc the sharpest of them is.
    bend: f64,
    /// Least share of the shell's thickness that they keep, and index of the section where.
    kept: f64,
    thinnest: usize,
}

impl Noses {
    /// Whether these keep more of the shell, or as much and are less bent.
    fn better(&self, other: &Self) -> bool {
        let class = |noses: &Self| (noses.kept >= LEAST_KEPT, noses.kept >= FULL);
        class(self) > class(other) || (class(self) == class(other) && self.bend < other.bend)
    }

    /// Noses bridged by bridges of this width, in end radii, or by splines.
    fn new(
        blade: &Blade,
        grid: &Grid,
        (sections, offsets): (&[Section], &[OffsetSection]),
        shell: &ShellPlan,
        span: [f64; 2],
        radii: impl Fn(&Section) -> EndRadii,
        width: Option<f64>,
    ) -> Result<Self, BuildError> {
        let within = |section: &Section| (span[0]..=span[1]).contains(&section.stream.v());
        let bridged: Vec<Bridged> = (sections.iter().zip(offsets))
            .map(|(section, offset)| Bridged::new(grid, section, offset, radii(section), width))
            .collect::<Result<_, _>>()?;
        let mut joints = grid.leading_edge;
        for (pressure, suction) in bridged.iter().filter_map(Bridged::contacts) {
            joints = (joints.0.min(pressure), joints.1.max(suction));
        }
        let mut noses = Self { offsets: Vec::new(), ends: Vec::new(), bend: 0.0, kept: 1.0, thinnest: 0 };
        for (i, ((section, offset), bridged)) in sections.iter().zip(offsets).zip(&bridged).enumerate() {
            let (opened, at) = bridged.opened(grid, section, radii(section), joints)?;
            let radius = radii(section).in_chart(section).0;
            if within(section) && offset.sharp_nose.is_some() {
                let kept = kept_by_nose(blade, grid, section, &opened, shell, at)?;
                if kept < noses.kept {
                    (noses.kept, noses.thinnest) = (kept, i);
                }
                noses.bend = noses.bend.max(Bridged::bend(&opened, at, radius));
            }
            noses.offsets.push(opened);
            noses.ends.push(at);
        }
        Ok(noses)
    }
}

/// How many times greater than `radius` an arc must be to close the trailing chamber before the sides end: more than 1
/// where the trailing edge is so blunt that the arc asked for would touch it. One factor for the whole span, or the
/// chamber's end would bend where it sets in.
fn tail(
    sections: &[Section],
    offsets: &[OffsetSection],
    span: [f64; 2],
    radius: impl Fn(&Section) -> f64,
) -> f64 {
    let within = |section: &Section| (span[0]..=span[1]).contains(&section.stream.v());
    let factors =
        sections.iter().zip(offsets).filter(|(section, _)| within(section)).map(|(section, offset)| {
            let (back, radius) = (offset.camber.back(), radius(section));
            let (low, high) = offset.outline.domain();
            let fits = circle_of_radius(&offset.outline, back, radius)
                .is_none_or(|circle| circle.pressure >= low && circle.suction <= high);
            if fits { 1.0 } else { back.radius / radius }
        });
    factors.fold(1.0, f64::max)
}

/// The least share of the shell's thickness, in space, that the nose of an outline between two of its parameters keeps.
fn kept_by_nose(
    blade: &Blade,
    grid: &Grid,
    section: &Section,
    opened: &OffsetSection,
    shell: &ShellPlan,
    (start, end): (f64, f64),
) -> Result<f64, BuildError> {
    const SAMPLES: u32 = 40;
    let v = section.stream.v();
    let mut kept = f64::INFINITY;
    for i in 0..=SAMPLES {
        let u = start + (end - start) * f64::from(i) / f64::from(SAMPLES);
        let point = section.stream.to_space(opened.outline.curve().point(u));
        let foot = nearest_foot(blade, grid, section, point)?;
        // Round the leading edge the shell may be as thin as its thinner side.
        let asked = if (grid.leading_edge.0..=grid.leading_edge.1).contains(&foot.u) {
            shell.pressure_side.at(v).min(shell.suction_side.at(v))
        } else {
            asked_thickness(grid, shell, foot.u, v)
        };
        kept = kept.min(foot.distance / asked);
    }
    Ok(kept)
}

/// The foot of a point behind the leading edge on the blade, with u as the grid has it there: negative on the pressure
/// side.
fn nearest_foot(
    blade: &Blade,
    grid: &Grid,
    section: &Section,
    point: DVec3,
) -> Result<Projection, BuildError> {
    let (start, end) = grid.leading_edge;
    let reach = end - start;
    let about = (grid.nodes.iter().zip(&section.blade_v))
        .filter(|(u, _)| (start - reach..=end + reach).contains(*u))
        .min_by(|a, b| {
            let distance = |(u, w): (&f64, &f64)| blade.surface.point(u.rem_euclid(1.0), *w).distance(point);
            distance(*a).total_cmp(&distance(*b))
        });
    let (u, w) = about.map_or((grid.nose, 0.5), |(u, w)| (*u, *w));
    let foot = blade.closest(point, (u, w))?;
    Ok(Projection { u: if foot.u > 0.5 { foot.u - 1.0 } else { foot.u }, ..foot })
}
