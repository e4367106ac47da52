//! Solids from faces: the metal, and a coolant solid for every passage.

use super::blank::Blank;
use super::cap::{Ring, add_cap, points_up};
use super::clearance::{self, ChamberPolygon};
use super::error::BuildError;
use super::film::{FilmHoleGeometry, add_film_rows};
use super::inlet::add_extension;
use super::passages::{Passage, PassageEnd, PassageParts, add_chambers};
use super::pointed::add_pointed_tube;
use super::probe::Probe;
use super::radial_holes::{RadialHoleGeometry, patches, place};
use super::sections::{Grid, Section, span_fractions};
use super::sides::Sides;
use super::slots::{SlotGeometry, add_slot_rows};
use super::style;
use super::tube::{CutTube, Patch, add_tube};
use super::turns::{ShellCheck, settled, sites};
use crate::plan::Plan;
use coolinggen_blade::{Blade, Fault, StreamSpace, StreamSurface};
use coolinggen_brep::{FaceId, FaceUse, Model, Shell, Solid};

/// A built design.
#[derive(Clone, Debug)]
pub struct CooledBlade {
    /// The B-rep: solid `metal`, and `coolant/<passage>` for every passage.
    pub model: Model,
    /// Faces of the outer surface, and of the breakouts in it.
    pub outer_faces: Vec<FaceId>,
    /// Faces between metal and coolant.
    pub passage_faces: Vec<FaceId>,
    /// Hub and tip face of the metal; the hub's alone where the blade ends in a point.
    pub end_faces: Vec<FaceId>,
    /// Faces that end a passage below the tip (1) or above the hub (0).
    pub closed_ends: Vec<(FaceId, usize)>,
    /// The stream surfaces of hub and tip.
    pub end_surfaces: [StreamSurface; 2],
    /// What the passages consist of; radial holes are not among them.
    pub passages: Vec<PassageParts>,
    /// The radial holes.
    pub radial_holes: Vec<RadialHoleGeometry>,
    /// The film holes, row by row.
    pub film_holes: Vec<FilmHoleGeometry>,
    /// The slots, row by row.
    pub slots: Vec<SlotGeometry>,
}

/// Builds metal and coolant.
///
/// # Errors
/// [`BuildError::Refused`] with the faults of the design where what it asks for does not exist.
pub fn build(blade: &Blade, space: &StreamSpace, plan: &Plan) -> Result<CooledBlade, BuildError> {
    let mut model = Model::default();
    let ends = [space.surface(0.0)?, space.surface(1.0)?];
    let mut outer = add_blade(&mut model, blade, [&ends[0], &ends[1]]).map_err(|e| e.blamed_on("/blade"))?;
    let (mut passages, mut radial_holes) = (Vec::new(), Vec::new());
    let (mut film_holes, mut slots) = (Vec::new(), Vec::new());
    if !plan.chambers.is_empty() || !plan.radial_holes.is_empty() {
        if blade.surface.tip().is_some() {
            let message = "this blade ends in a point: there is no tip that passages could open at";
            return Err(BuildError::Refused(vec![Fault::new("/cooling", "pointed_tip", message)]));
        }
        let grid = Grid::new(blade)?;
        let mut polygons = Vec::new();
        let (mut sections, mut tails) = (Vec::new(), Vec::new());
        if let (Some(shell), false) = (&plan.shell, plan.chambers.is_empty()) {
            let blamed = |e: BuildError| e.blamed_on("/cooling/chambers");
            let stack = settled(blade, space, &grid, plan, shell).map_err(blamed)?;
            let turns = sites(&stack, plan).map_err(blamed)?;
            let check = ShellCheck { probe: Probe::new(blade), blade, space, shell };
            (passages, polygons) =
                add_chambers(&mut model, blade, &stack, plan, &turns, &check).map_err(blamed)?;
            tails = stack.tails();
            sections = stack.sections;
        }
        if !plan.radial_holes.is_empty() {
            radial_holes = place_radial_holes(blade, space, &grid, plan, &polygons)?;
            passages.extend(add_radial_holes(&mut model, &radial_holes, &ends)?);
        }
        if !plan.film_rows.is_empty() || !plan.slot_rows.is_empty() {
            if sections.is_empty() {
                let fractions = span_fractions(&[[0.0, 1.0]]);
                sections = fractions
                    .iter()
                    .map(|&v| Section::new(blade, space, &grid, v))
                    .collect::<Result<_, _>>()?;
            }
            let sides = Sides::new(blade, &grid, &sections);
            let (outer, outward) = (&mut outer.faces, blade.outward);
            let mut blank = Blank {
                model: &mut model,
                outer,
                passages: &mut passages,
                outward,
                ends: &ends,
                parts: Vec::new(),
            };
            film_holes = add_film_rows(&mut blank, &sides, &plan.film_rows, plan.least_ligament)?;
            slots = add_slot_rows(&mut blank, &sections, &tails, &plan.slot_rows, plan.least_ligament)?;
        }
    }
    let passage_faces = passages.iter().flat_map(|p| p.faces.iter().copied()).collect();
    let caps = add_solids(&mut model, (blade, space), &ends, &outer, &passages, plan.inlet_extension)?;
    let parts = passages.into_iter().filter(|p| !p.parts.is_empty());
    let parts = parts.map(|p| PassageParts { name: p.name, parts: p.parts }).collect();
    let mut outer_faces = outer.faces;
    outer_faces.extend(film_holes.iter().flat_map(|hole| &hole.exits));
    outer_faces.extend(slots.iter().flat_map(|slot| &slot.exits));
    Ok(CooledBlade {
        model,
        passages: parts,
        outer_faces,
        passage_faces,
        end_faces: caps.open,
        closed_ends: caps.closed,
        end_surfaces: ends,
        radial_holes,
        film_holes,
        slots,
    })
}

/// Where the radial holes are, clear of everything.
fn place_radial_holes(
    blade: &Blade,
    space: &StreamSpace,
    grid: &Grid,
    plan: &Plan,
    polygons: &[ChamberPolygon],
) -> Result<Vec<RadialHoleGeometry>, BuildError> {
    let sections = [Section::new(blade, space, grid, 0.0)?, Section::new(blade, space, grid, 1.0)?];
    let placed = plan.radial_holes.iter().enumerate().map(|(k, hole)| {
        place(blade, [&sections[0], &sections[1]], hole).map_err(|e| e.blamed_on(&radial_hole_pointer(k)))
    });
    let placed = placed.collect::<Result<Vec<_>, _>>()?;
    clearance::check(blade, &placed, polygons)?;
    Ok(placed)
}

fn add_radial_holes(
    model: &mut Model,
    holes: &[RadialHoleGeometry],
    ends: &[StreamSurface; 2],
) -> Result<Vec<Passage>, BuildError> {
    let passages = holes.iter().enumerate().map(|(k, hole)| {
        let tube = patches(hole).and_then(|p| add_tube(model, p, [&ends[0], &ends[1]]));
        let CutTube { faces, rings } = tube.map_err(|e| e.blamed_on(&radial_hole_pointer(k)))?;
        let [lower, upper] = rings;
        let end = |ring, side, v| PassageEnd {
            ring,
            side,
            v,
            name: hole.name.clone(),
            path: format!("radial_hole/{}", hole.name),
        };
        Ok(Passage {
            name: hole.name.clone(),
            faces,
            parts: Vec::new(),
            outward: true,
            ends: [end(lower, 0, 0.0), end(upper, 1, 1.0)],
            branches: Vec::new(),
        })
    });
    passages.collect()
}

fn radial_hole_pointer(k: usize) -> String {
    format!("/cooling/radial_holes/{k}")
}

/// The outer surface, a face a region, cut at hub and tip. A region is parted where the surface is only continuous: a
/// face with a full knot inside is refused by FreeCAD's check, however smooth it is there.
fn add_blade(model: &mut Model, blade: &Blade, ends: [&StreamSurface; 2]) -> Result<CutTube, BuildError> {
    let knots = blade.surface.knots_u();
    let mut patches = Vec::new();
    for (region, [start, end]) in &blade.regions {
        let inside = knots.breaks().into_iter().filter(|k| k > start && k < end);
        let full: Vec<f64> = inside.filter(|&k| knots.multiplicity(k) >= knots.degree()).collect();
        let cuts: Vec<f64> = [*start].into_iter().chain(full).chain([*end]).collect();
        for (i, pair) in cuts.windows(2).enumerate() {
            let name = match cuts.len() {
                2 => format!("blade/{}", region.name()),
                _ => format!("blade/{}/{}", region.name(), i + 1),
            };
            patches.push(Patch {
                name,
                style: style::blade(),
                surface: blade.surface.patch(pair[0], pair[1])?,
            });
        }
    }
    match blade.surface.tip() {
        Some(tip) => add_pointed_tube(model, patches, ends[0], tip),
        None => add_tube(model, patches, ends),
    }
}

/// Hub and tip face, and the faces that end passages inside.
struct Ends {
    open: Vec<FaceId>,
    closed: Vec<(FaceId, usize)>,
}

/// Caps and solids.
fn add_solids(
    model: &mut Model,
    (blade, space): (&Blade, &StreamSpace),
    ends: &[StreamSurface; 2],
    outer: &CutTube,
    passages: &[Passage],
    inlet_extension: Option<f64>,
) -> Result<Ends, BuildError> {
    let mut closed_ends = Vec::new();
    let mut metal = Shell::default();
    let mut voids = Vec::new();
    let mut coolants = Vec::new();
    let mut openings: [Vec<Ring>; 2] = [Vec::new(), Vec::new()];
    metal.faces.extend(outer.faces.iter().map(|&face| FaceUse { face, forward: blade.outward }));
    let mut through = 0;
    for passage in passages {
        let mut own = Shell {
            faces: passage.faces.iter().map(|&face| FaceUse { face, forward: !passage.outward }).collect(),
        };
        let mut coolant = Shell {
            faces: passage.faces.iter().map(|&face| FaceUse { face, forward: passage.outward }).collect(),
        };
        for branch in &passage.branches {
            let faces = branch.faces.iter();
            own.faces.extend(faces.clone().map(|&(face, outward)| FaceUse { face, forward: !outward }));
            coolant.faces.extend(faces.map(|&(face, outward)| FaceUse { face, forward: outward }));
            coolant.faces.extend(&branch.ends);
        }
        let both_open = passage.ends.iter().all(PassageEnd::is_open);
        let count = passage.ends.iter().filter(|end| end.is_open()).count()
            + passage.branches.iter().filter(|b| !b.ends.is_empty()).count();
        let one_side = passage.ends[0].side == passage.ends[1].side;
        for (i, end) in passage.ends.iter().enumerate() {
            let (open, side) = (end.is_open(), end.side);
            let middle;
            let stream = if open {
                &ends[side]
            } else {
                middle = space.surface(end.v)?;
                &middle
            };
            // Where both ends open on one side, the first chamber's is the inlet.
            let enters = if both_open && one_side { i == 0 } else { side == 0 };
            let (name, style) = match (open, enters, side) {
                (true, true, _) => (format!("coolant/inlet/{}", end.name), style::inlet()),
                (true, false, _) => (format!("coolant/outlet/{}", end.name), style::outlet()),
                (false, _, 0) => (format!("{}/hub_end", end.path), style::chamber(&end.name)),
                (false, _, _) => (format!("{}/tip_end", end.path), style::chamber(&end.name)),
            };
            if let (Some(length), true, 0) = (inlet_extension, open && enters, side) {
                coolant.faces.extend(add_extension(model, &name, stream, &end.ring, length)?);
                openings[side].push(end.ring.clone());
                continue;
            }
            let cap = add_cap(model, name, style, stream, &end.ring, &[])?;
            let forward = points_up(model, cap, stream) == (side == 1);
            coolant.faces.push(FaceUse { face: cap, forward });
            if open {
                openings[side].push(end.ring.clone());
            } else {
                own.faces.push(FaceUse { face: cap, forward: !forward });
                closed_ends.push((cap, side));
            }
        }
        if count > 0 {
            metal.faces.extend(own.faces);
        } else {
            voids.push(own);
        }
        // The first opening makes a pocket of the passage, every other one a handle.
        through += count.saturating_sub(1);
        coolants.push(Solid {
            name: format!("coolant/{}", passage.name),
            shells: vec![coolant],
            expected_genus: 0,
        });
    }
    let mut end_faces = Vec::new();
    for (side, name) in [(0, "blade/hub"), (1, "blade/tip")] {
        if outer.rings[side].edges.is_empty() {
            continue;
        }
        let stream = &ends[side];
        let cap = add_cap(model, name.to_owned(), style::end(), stream, &outer.rings[side], &openings[side])?;
        let forward = points_up(model, cap, stream) == (side == 1);
        metal.faces.push(FaceUse { face: cap, forward });
        end_faces.push(cap);
    }
    let mut shells = vec![metal];
    shells.extend(voids);
    model.solids.push(Solid { name: "metal".into(), shells, expected_genus: through });
    model.solids.extend(coolants);
    Ok(Ends { open: end_faces, closed: closed_ends })
}
