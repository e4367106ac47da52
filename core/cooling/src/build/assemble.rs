//! Solids from faces: the metal, and a coolant solid for every passage.

use super::cap::{Ring, add_cap, points_up};
use super::clearance;
use super::error::BuildError;
use super::passages::{Passage, PassageEnd, PassageParts, add_chambers};
use super::probe::Probe;
use super::radial_holes::{RadialHoleGeometry, patches, place};
use super::sections::{Grid, Section};
use super::style;
use super::tube::{CutTube, Patch, add_tube};
use super::turns::{ShellCheck, settled, sites};
use crate::plan::Plan;
use coolinggen_blade::{Blade, StreamSpace, StreamSurface};
use coolinggen_brep::{FaceId, FaceUse, Model, Shell, Solid};

/// A built design.
#[derive(Clone, Debug)]
pub struct CooledBlade {
    /// The B-rep: solid `metal`, and `coolant/<passage>` for every passage.
    pub model: Model,
    /// Faces of the outer surface.
    pub outer_faces: Vec<FaceId>,
    /// Faces between metal and coolant.
    pub passage_faces: Vec<FaceId>,
    /// Hub and tip face of the metal.
    pub end_faces: [FaceId; 2],
    /// Faces that end a passage below the tip (1) or above the hub (0).
    pub closed_ends: Vec<(FaceId, usize)>,
    /// The stream surfaces of hub and tip.
    pub end_surfaces: [StreamSurface; 2],
    /// What the passages consist of; radial holes are not among them.
    pub passages: Vec<PassageParts>,
    /// The radial holes.
    pub radial_holes: Vec<RadialHoleGeometry>,
}

/// Builds metal and coolant.
///
/// # Errors
/// [`BuildError::Refused`] with the faults of the design where what it asks for does not exist.
pub fn build(blade: &Blade, space: &StreamSpace, plan: &Plan) -> Result<CooledBlade, BuildError> {
    let mut model = Model::default();
    let ends = [space.surface(0.0)?, space.surface(1.0)?];
    let outer = add_blade(&mut model, blade, [&ends[0], &ends[1]])?;
    let mut passages = Vec::new();
    let mut radial_holes = Vec::new();
    if !plan.chambers.is_empty() || !plan.radial_holes.is_empty() {
        let grid = Grid::new(blade)?;
        let mut polygons = Vec::new();
        if let (Some(shell), false) = (&plan.shell, plan.chambers.is_empty()) {
            let stack = settled(blade, space, &grid, plan, shell)?;
            let turns = sites(&stack, plan)?;
            let check = ShellCheck { probe: Probe::new(blade), blade, space, shell };
            (passages, polygons) = add_chambers(&mut model, blade, &stack, plan, &turns, &check)?;
        }
        if !plan.radial_holes.is_empty() {
            let sections = [Section::new(blade, space, &grid, 0.0)?, Section::new(blade, space, &grid, 1.0)?];
            for hole in &plan.radial_holes {
                radial_holes.push(place(blade, [&sections[0], &sections[1]], hole)?);
            }
            clearance::check(blade, &radial_holes, &polygons)?;
            for hole in &radial_holes {
                let CutTube { faces, rings } = add_tube(&mut model, patches(hole)?, [&ends[0], &ends[1]])?;
                let [lower, upper] = rings;
                let end = |ring, side, v| PassageEnd {
                    ring,
                    side,
                    v,
                    name: hole.name.clone(),
                    path: format!("radial_hole/{}", hole.name),
                };
                let ends = [end(lower, 0, 0.0), end(upper, 1, 1.0)];
                passages.push(Passage {
                    name: hole.name.clone(),
                    faces,
                    parts: Vec::new(),
                    outward: true,
                    ends,
                });
            }
        }
    }
    let passage_faces = passages.iter().flat_map(|p| p.faces.iter().copied()).collect();
    let (end_faces, closed_ends) = add_solids(&mut model, blade, space, &ends, &outer, &passages)?;
    let parts = passages.into_iter().filter(|p| !p.parts.is_empty());
    let parts = parts.map(|p| PassageParts { name: p.name, parts: p.parts }).collect();
    Ok(CooledBlade {
        model,
        passages: parts,
        outer_faces: outer.faces,
        passage_faces,
        end_faces,
        closed_ends,
        end_surfaces: ends,
        radial_holes,
    })
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
    add_tube(model, patches, ends)
}

/// Hub and tip face, and the faces that close passages with their sides of the span.
type EndFaces = ([FaceId; 2], Vec<(FaceId, usize)>);

/// Caps and solids; answers with hub and tip face and the faces of closed ends.
fn add_solids(
    model: &mut Model,
    blade: &Blade,
    space: &StreamSpace,
    ends: &[StreamSurface; 2],
    outer: &CutTube,
    passages: &[Passage],
) -> Result<EndFaces, BuildError> {
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
        let both_open = passage.ends.iter().all(PassageEnd::is_open);
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
        if passage.ends.iter().any(PassageEnd::is_open) {
            metal.faces.extend(own.faces);
        } else {
            voids.push(own);
        }
        through += usize::from(both_open);
        coolants.push(Solid {
            name: format!("coolant/{}", passage.name),
            shells: vec![coolant],
            expected_genus: 0,
        });
    }
    let mut end_faces = [FaceId(0); 2];
    for (side, name) in [(0, "blade/hub"), (1, "blade/tip")] {
        let stream = &ends[side];
        let cap = add_cap(model, name.to_owned(), style::end(), stream, &outer.rings[side], &openings[side])?;
        let forward = points_up(model, cap, stream) == (side == 1);
        metal.faces.push(FaceUse { face: cap, forward });
        end_faces[side] = cap;
    }
    let mut shells = vec![metal];
    shells.extend(voids);
    model.solids.push(Solid { name: "metal".into(), shells, expected_genus: through });
    model.solids.extend(coolants);
    Ok((end_faces, closed_ends))
}
