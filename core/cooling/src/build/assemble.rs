//! From plan to solids, step by step: outer surface, passages, bores, caps, solids.

use super::blank::{Blank, Parts};
use super::clearance::{self, ChamberPolygon};
use super::crossovers::{CrossoverGeometry, add_crossover_rows};
use super::dust_holes::{DustHoleGeometry, add_dust_holes};
use super::error::BuildError;
use super::film::{FilmHoleGeometry, add_film_rows};
use super::hollow::Hollow;
use super::inserts::{InsertGeometry, JetGeometry, add_jets};
use super::kept::KeptBuild;
use super::ligaments::Ligaments;
use super::passages::{Host, Passage, PassageEnd, PassageParts};
use super::pins::{PinGeometry, add_pin_arrays};
use super::pointed::add_pointed_tube;
use super::radial_holes::{RadialHoleGeometry, patches, place};
use super::sections::{Grid, Section, span_fractions};
use super::sides::Sides;
use super::slots::{SlotGeometry, add_slot_rows};
use super::solids::{SolidParts, add_caps, add_solids};
use super::stack::Stack;
use super::style;
use super::tube::{CutTube, Patch, add_tube};
use crate::bore::Rims;
use crate::plan::Plan;
use crate::watch::Watch;
use coolinggen_blade::{Blade, StreamSpace, StreamSurface};
use coolinggen_brep::{FaceId, Model};
use std::sync::Arc;

/// A built design.
#[derive(Clone, Debug)]
pub struct CooledBlade {
    /// The B-rep: solid `metal`, and `coolant/<passage>` for every passage; passages that bores join are one solid,
    /// `coolant/<passage>+<passage>`.
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
    /// The inserts.
    pub inserts: Vec<InsertGeometry>,
    /// Bores of all kinds.
    pub bores: Bores,
}

/// Bores of all kinds, row by row.
#[derive(Clone, Debug, Default)]
pub struct Bores {
    /// The film holes.
    pub film_holes: Vec<FilmHoleGeometry>,
    /// The slots.
    pub slots: Vec<SlotGeometry>,
    /// The crossover holes.
    pub crossovers: Vec<CrossoverGeometry>,
    /// The pins.
    pub pins: Vec<PinGeometry>,
    /// The dust holes.
    pub dust_holes: Vec<DustHoleGeometry>,
    /// The jets, insert by insert and array by array.
    pub jets: Vec<JetGeometry>,
}

/// Builds metal and coolant, reusing what `kept` has from the build before, and telling `watch`. `space` is the one that
/// the blade was made in.
///
/// # Errors
/// [`BuildError::Refused`] with the faults of the design where what it asks for does not exist;
/// [`BuildError::Cancelled`].
pub fn build(
    blade: &Arc<Blade>,
    space: &StreamSpace,
    plan: &Plan,
    kept: &mut KeptBuild,
    watch: &dyn Watch,
) -> Result<CooledBlade, BuildError> {
    let hollow = kept.hollow(blade, plan, |plan| Hollow::new(blade, space, plan, watch))?;
    let Hollow { mut model, mut outer, mut passages, mut inserts, radial_holes, .. } = (*hollow).clone();
    let Hollow { grid, stack, ends, .. } = &*hollow;
    let lasting = model.faces.len();
    let mut blank = Blank {
        model: &mut model,
        outer: &mut outer.faces,
        passages: &mut passages,
        inserts: &mut inserts,
        links: Vec::new(),
        outward: blade.outward,
        ends,
        parts: Parts::of(lasting),
        least_ligament: plan.least_ligament,
        ligaments: Ligaments::default(),
        rims: Rims::default(),
        kept: &mut kept.bores,
        watch,
    };
    let mut bores = match grid {
        Some(grid) => add_bores(&mut blank, (blade, space, grid), stack.as_ref(), plan)?,
        None => Bores::default(),
    };
    let rings = &outer.rings;
    watch.go_on()?;
    let caps =
        add_caps(blank.model, space, ends, rings, blank.passages, blank.inserts, plan.inlet_extension)?;
    if let Some(stack) = stack {
        bores.dust_holes = add_dust_holes(&mut blank, stack, plan, &caps)?;
    }
    let links = blank.links;
    let in_metal = passages.iter().filter(|p| p.host == Host::Metal);
    let passage_faces = in_metal.flat_map(|p| p.faces.iter().copied()).collect();
    let parts = SolidParts {
        outward: blade.outward,
        outer: &outer.faces,
        passages: &passages,
        inserts: &inserts,
        links: &links,
        caps: &caps,
    };
    add_solids(&mut model, &parts);
    let inserts = inserts.iter().map(|insert| insert.geometry(&passages)).collect();
    let parts = passages.into_iter().filter(|p| !p.parts.is_empty());
    let parts = parts.map(|p| PassageParts { name: p.name, parts: p.parts }).collect();
    let mut outer_faces = outer.faces;
    outer_faces.extend(bores.film_holes.iter().flat_map(|hole| &hole.exits));
    outer_faces.extend(bores.slots.iter().flat_map(|slot| &slot.exits));
    Ok(CooledBlade {
        model,
        passages: parts,
        outer_faces,
        passage_faces,
        end_faces: caps.ends.iter().map(|used| used.face).collect(),
        closed_ends: caps.closed(),
        end_surfaces: ends.clone(),
        radial_holes,
        inserts,
        bores,
    })
}

/// All bores but those that need caps.
fn add_bores(
    blank: &mut Blank<'_>,
    (blade, space, grid): (&Blade, &StreamSpace, &Grid),
    stack: Option<&Stack>,
    plan: &Plan,
) -> Result<Bores, BuildError> {
    let mut bores = Bores::default();
    if !plan.film_rows.is_empty() {
        let own: Vec<Section>;
        let sections = match stack {
            Some(stack) => &stack.sections,
            None => {
                let fractions = span_fractions(&[[0.0, 1.0]]);
                let sections = fractions.iter().map(|&v| Section::new(blade, space, grid, v));
                own = sections.collect::<Result<_, _>>()?;
                &own
            }
        };
        bores.film_holes = add_film_rows(blank, &Sides::new(blade, grid, sections), &plan.film_rows)?;
    }
    if let Some(stack) = stack {
        bores.slots =
            add_slot_rows(blank, &stack.sections, &stack.tails, &plan.slot_rows, plan.least_ligament)?;
        bores.crossovers = add_crossover_rows(blank, plan)?;
        bores.pins = add_pin_arrays(blank, stack, plan)?;
    }
    bores.jets = add_jets(blank, &plan.inserts)?;
    Ok(bores)
}

/// Where the radial holes are, clear of everything.
pub(super) fn place_radial_holes(
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

pub(super) fn add_radial_holes(
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
            inserted: None,
            side,
            v,
            name: hole.name.clone(),
            path: format!("radial_hole/{}", hole.name),
            style: style::radial_hole(),
        };
        Ok(Passage {
            name: hole.name.clone(),
            faces,
            parts: Vec::new(),
            outward: true,
            ends: [end(lower, 0, 0.0), end(upper, 1, 1.0)],
            branches: Vec::new(),
            pins: Vec::new(),
            host: Host::Metal,
        })
    });
    passages.collect()
}

fn radial_hole_pointer(k: usize) -> String {
    format!("/cooling/radial_holes/{k}")
}

/// The outer surface, a face a region, cut at hub and tip. A region is parted where the surface is only continuous: a
/// face with a full knot inside is refused by FreeCAD's check, however smooth it is there.
pub(super) fn add_blade(
    model: &mut Model,
    blade: &Blade,
    ends: [&StreamSurface; 2],
) -> Result<CutTube, BuildError> {
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
