//! What the coolant flows through: chains of chambers and turns, and radial holes, as faces with their end rings.

use super::cap::Ring;
use super::chambers::{RingSection, TubeLook, add_chamber, segment_names};
use super::clearance::ChamberPolygon;
use super::error::BuildError;
use super::nodes::passage_nodes;
use super::stack::Stack;
use super::style;
use super::tube::CutTube;
use super::turns::{ShellCheck, TurnSite, add_turn};
use crate::plan::Plan;
use crate::section::{ChamberRing, ClosureKind, Refusal, RingRequest, SEGMENTS, WallRequest, chamber_ring};
use coolinggen_blade::{Blade, Fault};
use coolinggen_brep::{FaceId, FaceUse, Model, Style};

/// The parts of a passage in the order in which the coolant runs through them.
#[derive(Clone, Debug)]
pub struct PassageParts {
    /// Name of the passage.
    pub name: String,
    /// Chambers and turns.
    pub parts: Vec<PassagePart>,
}

/// A chamber or a turn.
#[derive(Clone, Debug)]
pub struct PassagePart {
    /// Path of its faces, e.g. `turn/a`.
    pub path: String,
    /// For a turn, the side of the span where it lies: 0 the hub's, 1 the tip's.
    pub turn: Option<usize>,
    /// Its eight faces in the order of the ring; the second parameter of their surfaces runs along the passage.
    pub faces: Vec<FaceId>,
    /// Faces of an insert that stands in it, in the same order; none where there is no insert.
    pub inserted: Vec<FaceId>,
    /// Whether that parameter runs against the coolant.
    pub reversed: bool,
}

/// One passage: its faces and where it begins and ends.
#[derive(Clone, Debug)]
pub(super) struct Passage {
    /// Name of its coolant: that of its first chamber, or of the radial hole.
    pub(super) name: String,
    pub(super) faces: Vec<FaceId>,
    /// Chambers and turns in order; none in a radial hole.
    pub(super) parts: Vec<PassagePart>,
    /// Whether the faces' natural normals point out of the coolant.
    pub(super) outward: bool,
    /// Where the faces end: at the hub (side 0) or at the tip (side 1).
    pub(super) ends: [PassageEnd; 2],
    /// Bores that leave it.
    pub(super) branches: Vec<Branch>,
    /// Pins that stand in it: their faces, each with whether its natural normal points out of the coolant.
    pub(super) pins: Vec<Vec<(FaceId, bool)>>,
    /// What it runs through.
    pub(super) host: Host,
}

/// The solid that a passage or a bore runs through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Host {
    /// The blade.
    Metal,
    /// This insert.
    Insert(usize),
}

/// An end of a passage.
#[derive(Clone, Debug)]
pub(super) struct PassageEnd {
    pub(super) ring: Ring,
    /// The ring of an insert that stands in it.
    pub(super) inserted: Option<Ring>,
    /// Side of the span: 0 the hub's, 1 the tip's.
    pub(super) side: usize,
    /// Span fraction of the ring; 0 is open at the hub, 1 at the tip.
    pub(super) v: f64,
    /// Name of the chamber or hole that ends here.
    pub(super) name: String,
    /// Path of its faces, e.g. `chamber/leading`.
    pub(super) path: String,
    /// How it looks where it is closed.
    pub(super) style: Style,
}

/// A bore that leaves a passage.
#[derive(Clone, Debug)]
pub(super) struct Branch {
    /// Its faces, each with whether its natural normal points out of the coolant.
    pub(super) faces: Vec<(FaceId, bool)>,
    /// What closes the coolant at its end.
    pub(super) ends: Vec<FaceUse>,
}

/// A bore through the material between two passages, or between two places of one.
#[derive(Clone, Debug)]
pub(super) struct Link {
    pub(super) passages: [usize; 2],
    /// Its faces, each with whether its natural normal points out of the coolant.
    pub(super) faces: Vec<(FaceId, bool)>,
    /// What it runs through.
    pub(super) host: Host,
}

impl Passage {
    /// Whether coolant enters at this end, if it is open. Where both ends open on one side, the first chamber's is the
    /// inlet; a plenum has no other opening.
    pub(super) fn enters(&self, end: usize) -> bool {
        let one_side = self.ends[0].side == self.ends[1].side;
        if one_side && self.ends.iter().all(PassageEnd::is_open) {
            end == 0
        } else {
            self.ends[end].side == 0 || self.host != Host::Metal
        }
    }

    /// Whether this end is an inlet at the hub.
    pub(super) fn enters_at_hub(&self, end: usize) -> bool {
        self.ends[end].is_open() && self.ends[end].side == 0 && self.enters(end)
    }
}

impl PassageEnd {
    pub(super) fn is_open(&self) -> bool {
        self.v == [0.0, 1.0][self.side]
    }
}

/// Builds all chambers and turns and adds their faces to the model; answers with their rings as polygons, too.
pub(super) fn add_chambers(
    model: &mut Model,
    blade: &Blade,
    stack: &Stack,
    plan: &Plan,
    turns: &[TurnSite<'_>],
    check: &ShellCheck<'_>,
) -> Result<(Vec<Passage>, Vec<ChamberPolygon>), BuildError> {
    let mut refusals = Vec::new();
    let mut rings = Vec::with_capacity(plan.chambers.len());
    for k in 0..plan.chambers.len() {
        let (found, refused) = chamber_rings(stack, plan, k);
        rings.push(found);
        refusals.extend(refused);
    }
    if !refusals.is_empty() {
        return Err(BuildError::worst(refusals));
    }
    let polygons = plan.chambers.iter().zip(&rings);
    let polygons = polygons.flat_map(|(c, rings)| rings.iter().map(|ring| ring.polygon(&c.name)));
    let polygons = polygons.chain(turns.iter().flat_map(TurnSite::polygons)).collect();
    let mut passages = Vec::new();
    for chain in plan.chains() {
        let sections: Vec<&[RingSection<'_>]> = chain.chambers.iter().map(|&k| &rings[k][..]).collect();
        let nodes = passage_nodes(&sections)?;
        let mut tubes = Vec::with_capacity(sections.len());
        for ((&k, sections), nodes) in chain.chambers.iter().zip(&sections).zip(&nodes) {
            let name = &plan.chambers[k].name;
            let names = face_names(plan, k, &format!("chamber/{name}"));
            let look = TubeLook { names, style: style::chamber(name) };
            check.watch.go_on()?;
            tubes.push(add_chamber(model, &look, sections, nodes)?);
        }
        // A chamber ends where it has no turn; alone it ends at both sides.
        let away = |turn: Option<&usize>| turn.map(|&t| 1 - plan.turns[t].side());
        let sides = [away(chain.turns.first()).unwrap_or(0), away(chain.turns.last()).unwrap_or(1)];
        let mut parts: Vec<PassagePart> = Vec::new();
        let mut from = sides[0];
        for (i, (&k, tube)) in chain.chambers.iter().zip(&tubes).enumerate() {
            let (path, faces) = (format!("chamber/{}", plan.chambers[k].name), tube.faces.clone());
            parts.push(PassagePart { path, turn: None, faces, inserted: Vec::new(), reversed: from == 1 });
            from = 1 - from;
            if let Some(&t) = chain.turns.get(i) {
                let faces = add_turn(model, &turns[t], [tube, &tubes[i + 1]], check)?;
                let path = format!("turn/{}", plan.turns[t].name);
                parts.push(PassagePart {
                    path,
                    turn: Some(plan.turns[t].side()),
                    faces,
                    inserted: Vec::new(),
                    reversed: plan.turns[t].side() == 0,
                });
            }
        }
        let (first, last) = (chain.chambers[0], chain.chambers[chain.chambers.len() - 1]);
        let end = |k: usize, tube: &CutTube, side: usize| PassageEnd {
            ring: tube.rings[side].clone(),
            inserted: None,
            side,
            v: stack.spans.chambers[k][side],
            name: plan.chambers[k].name.clone(),
            path: format!("chamber/{}", plan.chambers[k].name),
            style: style::chamber(&plan.chambers[k].name),
        };
        passages.push(Passage {
            name: plan.chambers[first].name.clone(),
            faces: parts.iter().flat_map(|p| p.faces.iter().copied()).collect(),
            parts,
            // Chambers run round in the blade's own sense.
            outward: blade.outward,
            ends: [end(first, &tubes[0], sides[0]), end(last, &tubes[tubes.len() - 1], sides[1])],
            branches: Vec::new(),
            pins: Vec::new(),
            host: Host::Metal,
        });
    }
    Ok((passages, polygons))
}

/// Names below a path of the faces of chamber `k` or of a tube in it.
pub(super) fn face_names(plan: &Plan, k: usize, path: &str) -> [String; SEGMENTS] {
    let wall_name = |w: usize| format!("wall/{}", plan.walls[w].name);
    let front = if k == 0 { "leading_edge".to_owned() } else { wall_name(k - 1) };
    let back = if k + 1 == plan.chambers.len() { "trailing_edge".to_owned() } else { wall_name(k) };
    segment_names(path, &front, &back)
}

/// The rings of chamber `k` in all sections of its span, and what is refused.
fn chamber_rings<'s>(stack: &'s Stack, plan: &Plan, k: usize) -> (Vec<RingSection<'s>>, Vec<Fault>) {
    let (mut rings, mut refusals) = (Vec::new(), Vec::new());
    for i in stack.of_chamber(k) {
        match ring_at(stack, plan, k, i) {
            Ok(ring) => rings.push(RingSection {
                stream: &stack.sections[i].stream,
                outline: &stack.offsets[i].outline,
                ring,
            }),
            Err(fault) => refusals.push(*fault),
        }
    }
    (rings, refusals)
}

/// The ring of chamber `k` in section `i`, or what is refused.
pub(super) fn ring_at(stack: &Stack, plan: &Plan, k: usize, i: usize) -> Result<ChamberRing, Box<Fault>> {
    ring_of(stack, plan, k, i).map_err(|refusal| refused(stack, plan, k, i, &refusal))
}

/// The refusal of chamber `k` in section `i`.
fn refused(stack: &Stack, plan: &Plan, k: usize, i: usize, refusal: &Refusal) -> Box<Fault> {
    let v = stack.sections[i].stream.v();
    Box::new(BuildError::fault(&blame(plan, k, refusal), v, refusal))
}

/// The rings that chamber `k` would have in the `sections` of a turn if it went on, from its own last one. There is no
/// chamber beyond that, only a form that the turn leaves: where the blade gets too thin for the fillets, they shrink, with
/// the square of the way.
pub(super) fn rings_beyond(
    stack: &Stack,
    plan: &Plan,
    k: usize,
    sections: &[usize],
) -> Result<Vec<ChamberRing>, Box<Fault>> {
    const FITTING: f64 = 0.9;
    let way = |n: usize| (n as f64 / (sections.len() - 1) as f64).powi(2);
    let tried: Vec<Result<ChamberRing, Refusal>> =
        sections.iter().map(|&i| ring_of(stack, plan, k, i)).collect();
    let mut loss = 0.0f64;
    for (n, ring) in tried.iter().enumerate().skip(1) {
        if let Err(Refusal::FilletTooLarge { radius, greatest, .. }) = ring {
            loss = loss.max((1.0 - FITTING * greatest / radius) / way(n));
        }
    }
    let of = |(n, ring): (usize, Result<ChamberRing, Refusal>)| {
        let ring = match ring {
            Err(Refusal::FilletTooLarge { .. }) | Ok(_) if n > 0 && loss > 0.0 && loss < 1.0 => {
                ring_with(stack, plan, k, sections[n], 1.0 - loss * way(n))
            }
            other => other,
        };
        ring.map_err(|refusal| refused(stack, plan, k, sections[n], &refusal))
    };
    tried.into_iter().enumerate().map(of).collect()
}

/// The ring of chamber `k` in section `i`; a refusal has its lengths in space.
pub(super) fn ring_of(stack: &Stack, plan: &Plan, k: usize, i: usize) -> Result<ChamberRing, Refusal> {
    ring_with(stack, plan, k, i, 1.0)
}

/// The same with fillets at walls of a `share` of their radius.
fn ring_with(stack: &Stack, plan: &Plan, k: usize, i: usize, share: f64) -> Result<ChamberRing, Refusal> {
    let (section, offset) = (&stack.sections[i], &stack.offsets[i]);
    let v = section.stream.v();
    let (radius, scale) = (plan.chambers[k].fillet_radius.at(v), section.scale(offset.camber.at(0.5).center));
    let [front, back] = closures(stack, plan, k, i, share);
    let request = RingRequest { outline: &offset.outline, camber: &offset.camber, front, back };
    let ring = match k {
        0 if !offset.circle_is_clear() => Err(offset.nose_refusal(radius / scale)),
        _ => chamber_ring(&request),
    };
    ring.map_err(|refusal| refusal.in_space(scale, radius))
}

/// What closes chamber `k` in section `i` at its front and at its back, with fillets at walls of a `share` of their
/// radius.
fn closures(stack: &Stack, plan: &Plan, k: usize, i: usize, share: f64) -> [ClosureKind; 2] {
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
            fillet: share * radius / section.scale(line.center),
        })
    };
    let rounded =
        |at: glam::DVec2, times: f64| ClosureKind::Rounded { radius: times * radius / section.scale(at) };
    let front = match k {
        0 => match &stack.nose {
            Some(ends) => ClosureKind::Natural { ends: ends[i] },
            None => rounded(offset.camber.front().center, 1.0),
        },
        _ => wall(k - 1),
    };
    let back =
        if k + 1 == plan.chambers.len() { rounded(offset.camber.back().center, stack.tail) } else { wall(k) };
    [front, back]
}

/// The parameter to blame for a refusal of chamber `k`: the wall that stands wrong, where it is one's.
fn blame(plan: &Plan, k: usize, refusal: &Refusal) -> String {
    let chamber = format!("/cooling/chambers/{k}");
    match refusal {
        Refusal::FilletTooLarge { .. } => format!("{chamber}/fillet_radius"),
        Refusal::WallOutside { wall, .. } => {
            let found = plan.walls.iter().position(|w| w.name == *wall);
            found.map_or(chamber, |w| format!("/cooling/walls/{w}"))
        }
        // Of two walls that cross, the one behind the chamber.
        Refusal::ChamberTooShort { .. } if !plan.walls.is_empty() => {
            format!("/cooling/walls/{}", k.min(plan.walls.len() - 1))
        }
        _ => chamber,
    }
}
