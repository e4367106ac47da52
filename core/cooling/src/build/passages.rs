//! What the coolant flows through: chambers and radial holes, as faces with their end rings.

use super::cap::Ring;
use super::chambers::{RingSection, add_chamber, segment_names};
use super::clearance::ChamberPolygon;
use super::error::BuildError;
use super::sections::{Grid, Section, WallLine, span_fractions, wall_lines};
use super::shell::{EndRadii, OffsetSection, offset_section};
use crate::plan::{Plan, ShellPlan};
use crate::section::{ClosureKind, Refusal, RingRequest, WallRequest, chamber_ring};
use coolinggen_blade::{Blade, Fault, StreamSpace};
use coolinggen_brep::{FaceId, Model};

/// One passage: its faces and where it begins and ends.
#[derive(Clone, Debug)]
pub(super) struct Passage {
    /// Path of the passage in names, e.g. `leading`.
    pub(super) name: String,
    /// Path of its faces, e.g. `chamber/leading`.
    pub(super) path: String,
    pub(super) faces: Vec<FaceId>,
    /// Whether the faces' natural normals point out of the coolant.
    pub(super) outward: bool,
    /// Lower and upper ring.
    pub(super) rings: [Ring; 2],
    /// Span fractions of the rings; 0 is open at the hub, 1 at the tip.
    pub(super) span: [f64; 2],
}

/// Builds all chambers and adds their faces to the model; answers with their rings as polygons, too.
pub(super) fn add_chambers(
    model: &mut Model,
    blade: &Blade,
    space: &StreamSpace,
    grid: &Grid,
    plan: &Plan,
) -> Result<(Vec<Passage>, Vec<ChamberPolygon>), BuildError> {
    let Some(shell) = plan.shell.as_ref().filter(|_| !plan.chambers.is_empty()) else {
        return Ok((Vec::new(), Vec::new()));
    };
    let spans = spans(blade, space, grid, plan, shell)?;
    let fractions = span_fractions(&spans);
    let sections: Vec<Section> =
        fractions.iter().map(|&v| Section::new(blade, space, grid, v)).collect::<Result<_, _>>()?;
    let walls: Vec<Vec<WallLine>> =
        plan.walls.iter().map(|wall| wall_lines(&sections, wall)).collect::<Result<_, _>>()?;
    let (first, last) = (&plan.chambers[0], &plan.chambers[plan.chambers.len() - 1]);
    let mut refusals = Vec::new();
    let mut offsets: Vec<OffsetSection> = Vec::with_capacity(sections.len());
    for section in &sections {
        let v = section.stream.v();
        let ends = EndRadii { front: first.fillet_radius.at(v), back: last.fillet_radius.at(v) };
        match offset_section(blade, grid, section, shell, ends) {
            Ok(offset) => offsets.push(offset),
            Err(BuildError::Refused(faults)) => refusals.extend(faults),
            Err(other) => return Err(other),
        }
    }
    if !refusals.is_empty() {
        return Err(BuildError::Refused(worst_by_pointer(refusals)));
    }
    let natural = natural_nose(grid, &sections, &offsets, plan, spans[0]);
    let mut passages = Vec::new();
    let mut polygons = Vec::new();
    for (k, (chamber, span)) in plan.chambers.iter().zip(&spans).enumerate() {
        let pointer = format!("/cooling/chambers/{k}");
        let mut rings = Vec::new();
        for (i, (section, offset)) in sections.iter().zip(&offsets).enumerate() {
            let v = section.stream.v();
            if !(span[0]..=span[1]).contains(&v) {
                continue;
            }
            let radius = chamber.fillet_radius.at(v);
            let wall = |w: usize| {
                let line = &walls[w][i];
                ClosureKind::Wall(WallRequest {
                    name: plan.walls[w].name.clone(),
                    center: line.center,
                    direction: line.direction,
                    downstream: line.downstream,
                    half_thickness: line.half_thickness,
                    fillet: radius / section.scale(line.center),
                })
            };
            let rounded = |at: glam::DVec2| ClosureKind::Rounded { radius: radius / section.scale(at) };
            let front = match k {
                0 if natural => ClosureKind::Natural { leading_edge: grid.leading_edge },
                0 => rounded(offset.camber.front().center),
                _ => wall(k - 1),
            };
            let back =
                if k + 1 == plan.chambers.len() { rounded(offset.camber.back().center) } else { wall(k) };
            let request = RingRequest { outline: &offset.outline, camber: &offset.camber, front, back };
            match chamber_ring(&request) {
                Ok(ring) => {
                    rings.push(RingSection { stream: &section.stream, outline: &offset.outline, ring });
                }
                Err(refusal) => {
                    let at = blame(&pointer, &refusal);
                    match BuildError::refused(&at, v, &refusal) {
                        BuildError::Refused(faults) => refusals.extend(faults),
                        other => return Err(other),
                    }
                }
            }
        }
        if refusals.is_empty() {
            let wall_name = |w: usize| format!("wall/{}", plan.walls[w].name);
            let front = if k == 0 { "leading_edge".to_owned() } else { wall_name(k - 1) };
            let back = if k + 1 == plan.chambers.len() { "trailing_edge".to_owned() } else { wall_name(k) };
            let names = segment_names(&chamber.name, &front, &back);
            polygons.extend(rings.iter().map(|ring| ring.polygon(&chamber.name)));
            let faces = add_chamber(model, &chamber.name, names, &rings)?;
            passages.push(Passage {
                name: chamber.name.clone(),
                path: format!("chamber/{}", chamber.name),
                faces: faces.faces,
                // Chambers run round in the blade's own sense.
                outward: blade.outward,
                rings: faces.rings,
                span: *span,
            });
        }
    }
    if refusals.is_empty() {
        Ok((passages, polygons))
    } else {
        Err(BuildError::Refused(worst_by_pointer(refusals)))
    }
}

/// The parameter to blame for a chamber's refusal.
fn blame(pointer: &str, refusal: &Refusal) -> String {
    match refusal {
        Refusal::FilletTooLarge { .. } => format!("{pointer}/fillet_radius"),
        _ => pointer.to_owned(),
    }
}

/// One fault a parameter: the section where it is worst says most; how many others there are is added.
fn worst_by_pointer(faults: Vec<Fault>) -> Vec<Fault> {
    let mut kept: Vec<(Fault, usize)> = Vec::new();
    for fault in faults {
        match kept.iter_mut().find(|(k, _)| k.pointer == fault.pointer) {
            None => kept.push((fault, 1)),
            Some((worst, count)) => {
                *count += 1;
                let excess = |f: &Fault| {
                    let value = f.value.as_ref().and_then(serde_json::Value::as_f64).unwrap_or(0.0);
                    f.max.map_or(0.0, |m| value - m) + f.min.map_or(0.0, |m| m - value)
                };
                if excess(&fault) > excess(worst) {
                    *worst = fault;
                }
            }
        }
    }
    kept.into_iter()
        .map(|(mut fault, count)| {
            if count > 1 {
                fault.message = format!("{} (worst of {count} sections)", fault.message);
            }
            fault
        })
        .collect()
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
/// than half the fillet radius. One answer for all its sections, for a change of form inside the span would show in the
/// loft; the margin of two keeps blades that taper on one side of it.
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
        front.radius > 0.5 * radius && regular
    })
}
