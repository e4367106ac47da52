//! Solids from faces: the metal, and a coolant solid for every passage.

use super::cap::{Ring, add_cap, points_up};
use super::clearance;
use super::error::BuildError;
use super::passages::{Passage, add_chambers};
use super::pointed::add_pointed_tube;
use super::radial_holes::{RadialHoleGeometry, patches, place};
use super::sections::{Grid, Section};
use super::style;
use super::tube::{CutTube, Patch, add_tube};
use crate::plan::Plan;
use coolinggen_blade::{Blade, Fault, StreamSpace, StreamSurface};
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
    /// Hub and tip face of the metal; the hub's alone where the blade ends in a point.
    pub end_faces: Vec<FaceId>,
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
        if blade.surface.tip().is_some() {
            let message = "this blade ends in a point: there is no tip that passages could open at";
            return Err(BuildError::Refused(vec![Fault::new("/cooling", "pointed_tip", message)]));
        }
        let grid = Grid::new(blade)?;
        let polygons;
        (passages, polygons) = add_chambers(&mut model, blade, space, &grid, plan)?;
        if !plan.radial_holes.is_empty() {
            let sections = [Section::new(blade, space, &grid, 0.0)?, Section::new(blade, space, &grid, 1.0)?];
            for hole in &plan.radial_holes {
                radial_holes.push(place(blade, [&sections[0], &sections[1]], hole)?);
            }
            clearance::check(blade, &radial_holes, &polygons)?;
            for hole in &radial_holes {
                let CutTube { faces, rings } = add_tube(&mut model, patches(hole)?, [&ends[0], &ends[1]])?;
                let path = format!("radial_hole/{}", hole.name);
                passages.push(Passage {
                    name: hole.name.clone(),
                    path,
                    faces,
                    rings,
                    outward: true,
                    span: [0.0, 1.0],
                });
            }
        }
    }
    let passage_faces = passages.iter().flat_map(|p| p.faces.iter().copied()).collect();
    let end_faces = add_solids(&mut model, blade, space, &ends, &outer, &passages)?;
    Ok(CooledBlade { model, outer_faces: outer.faces, passage_faces, end_faces, radial_holes })
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

/// Caps and solids.
fn add_solids(
    model: &mut Model,
    blade: &Blade,
    space: &StreamSpace,
    ends: &[StreamSurface; 2],
    outer: &CutTube,
    passages: &[Passage],
) -> Result<Vec<FaceId>, BuildError> {
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
        let open = [passage.span[0] == 0.0, passage.span[1] == 1.0];
        for side in [0, 1] {
            let up_is_out = side == 1;
            let middle;
            let stream = if open[side] {
                &ends[side]
            } else {
                middle = space.surface(passage.span[side])?;
                &middle
            };
            let (name, style) = match (open[side], side) {
                (true, 0) => (format!("coolant/inlet/{}", passage.name), style::inlet()),
                (true, _) => (format!("coolant/outlet/{}", passage.name), style::outlet()),
                (false, 0) => (format!("{}/hub_end", passage.path), style::chamber(&passage.name)),
                (false, _) => (format!("{}/tip_end", passage.path), style::chamber(&passage.name)),
            };
            let cap = add_cap(model, name, style, stream, &passage.rings[side], &[])?;
            let forward = points_up(model, cap, stream) == up_is_out;
            coolant.faces.push(FaceUse { face: cap, forward });
            if open[side] {
                openings[side].push(passage.rings[side].clone());
            } else {
                own.faces.push(FaceUse { face: cap, forward: !forward });
            }
        }
        if open[0] || open[1] {
            metal.faces.extend(own.faces);
        } else {
            voids.push(own);
        }
        through += usize::from(open[0] && open[1]);
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
    Ok(end_faces)
}
