//! What the coolant flows through: chambers and radial holes, as faces with their end rings.

use super::cap::Ring;
use super::chambers::{RingSection, add_chamber, segment_names};
use super::clearance::ChamberPolygon;
use super::error::BuildError;
use super::stack::Stack;
use crate::plan::Plan;
use crate::section::{ClosureKind, Refusal, RingRequest, WallRequest, chamber_ring};
use coolinggen_blade::{Blade, Fault};
use coolinggen_brep::{FaceId, FaceUse, Model};

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
    /// Bores that leave it.
    pub(super) branches: Vec<Branch>,
}

/// A bore that leaves a passage.
#[derive(Clone, Debug)]
pub(super) struct Branch {
    /// Its faces, each with whether its natural normal points out of the coolant.
    pub(super) faces: Vec<(FaceId, bool)>,
    /// What closes the coolant at its end.
    pub(super) ends: Vec<FaceUse>,
}

/// Builds all chambers and adds their faces to the model; answers with their rings as polygons, too.
pub(super) fn add_chambers(
    model: &mut Model,
    blade: &Blade,
    stack: &Stack,
    plan: &Plan,
) -> Result<(Vec<Passage>, Vec<ChamberPolygon>), BuildError> {
    let mut refusals = Vec::new();
    let mut passages = Vec::new();
    let mut polygons = Vec::new();
    for (k, chamber) in plan.chambers.iter().enumerate() {
        let (rings, refused) = chamber_rings(stack, plan, k);
        refusals.extend(refused);
        if !refusals.is_empty() {
            continue;
        }
        let wall_name = |w: usize| format!("wall/{}", plan.walls[w].name);
        let front = if k == 0 { "leading_edge".to_owned() } else { wall_name(k - 1) };
        let back = if k + 1 == plan.chambers.len() { "trailing_edge".to_owned() } else { wall_name(k) };
        let names = segment_names(&chamber.name, &front, &back);
        polygons.extend(rings.iter().map(|ring| ring.polygon(&chamber.name)));
        let tube = add_chamber(model, &chamber.name, names, &rings)?;
        passages.push(Passage {
            name: chamber.name.clone(),
            path: format!("chamber/{}", chamber.name),
            faces: tube.faces,
            // Chambers run round in the blade's own sense.
            outward: blade.outward,
            rings: tube.rings,
            span: stack.spans[k],
            branches: Vec::new(),
        });
    }
    if refusals.is_empty() { Ok((passages, polygons)) } else { Err(BuildError::worst(refusals)) }
}

/// The rings of chamber `k` in all sections of its span, and what is refused.
fn chamber_rings<'s>(stack: &'s Stack, plan: &Plan, k: usize) -> (Vec<RingSection<'s>>, Vec<Fault>) {
    let pointer = format!("/cooling/chambers/{k}");
    let (mut rings, mut refusals) = (Vec::new(), Vec::new());
    for i in stack.within(stack.spans[k]) {
        let (section, offset) = (&stack.sections[i], &stack.offsets[i]);
        let [front, back] = closures(stack, plan, k, i);
        let request = RingRequest { outline: &offset.outline, camber: &offset.camber, front, back };
        let ring = match k {
            0 if !offset.circle_is_clear() => Err(Refusal::NoseTooSharp),
            _ => chamber_ring(&request),
        };
        match ring {
            Ok(ring) => rings.push(RingSection { stream: &section.stream, outline: &offset.outline, ring }),
            Err(refusal) => {
                let radius = plan.chambers[k].fillet_radius.at(section.stream.v());
                let refusal = refusal.with_radius_in_space(radius);
                let at = blame(&pointer, &refusal);
                refusals.push(BuildError::fault(&at, section.stream.v(), &refusal));
            }
        }
    }
    (rings, refusals)
}

/// What closes chamber `k` in section `i` at its front and at its back.
fn closures(stack: &Stack, plan: &Plan, k: usize, i: usize) -> [ClosureKind; 2] {
    let (section, offset) = (&stack.sections[i], &stack.offsets[i]);
    let radius = plan.chambers[k].fillet_radius.at(section.stream.v());
    let wall = |w: usize| {
        let line = &stack.walls[w][i];
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
        0 => match &stack.nose {
            Some(ends) => ClosureKind::Natural { ends: ends[i] },
            None => rounded(offset.camber.front().center),
        },
        _ => wall(k - 1),
    };
    let back = if k + 1 == plan.chambers.len() { rounded(offset.camber.back().center) } else { wall(k) };
    [front, back]
}

/// The parameter to blame for a chamber's refusal.
fn blame(pointer: &str, refusal: &Refusal) -> String {
    match refusal {
        Refusal::FilletTooLarge { .. } => format!("{pointer}/fillet_radius"),
        _ => pointer.to_owned(),
    }
}
