//! The blade with its passages, inserts and radial holes, before any bore.

use super::assemble::{add_blade, add_radial_holes, place_radial_holes};
use super::error::BuildError;
use super::inserts::{Insert, InsertSite, add_inserts};
use super::passages::{Passage, add_chambers};
use super::probe::Probe;
use super::radial_holes::RadialHoleGeometry;
use super::sections::Grid;
use super::stack::Stack;
use super::tube::CutTube;
use super::turns::{ShellCheck, settled, sites};
use crate::plan::Plan;
use crate::watch::Watch;
use coolinggen_blade::{Blade, Fault, StreamSpace, StreamSurface};
use coolinggen_brep::Model;

/// A blade with its passages.
#[derive(Clone, Debug)]
pub(super) struct Hollow {
    pub(super) model: Model,
    /// The outer surface.
    pub(super) outer: CutTube,
    pub(super) passages: Vec<Passage>,
    pub(super) inserts: Vec<Insert>,
    pub(super) radial_holes: Vec<RadialHoleGeometry>,
    /// What passages were drawn on; none where there are none.
    pub(super) grid: Option<Grid>,
    pub(super) stack: Option<Stack>,
    /// The stream surfaces of hub and tip.
    pub(super) ends: [StreamSurface; 2],
}

impl Hollow {
    /// Builds it; the plan is one without bores.
    pub(super) fn new(
        blade: &Blade,
        space: &StreamSpace,
        plan: &Plan,
        watch: &dyn Watch,
    ) -> Result<Self, BuildError> {
        let mut model = Model::default();
        let ends = [space.surface(0.0)?, space.surface(1.0)?];
        let outer = add_blade(&mut model, blade, [&ends[0], &ends[1]]).map_err(|e| e.blamed_on("/blade"))?;
        let mut passages = Vec::new();
        let mut inserts = Vec::new();
        let mut radial_holes = Vec::new();
        let (mut kept_grid, mut kept_stack) = (None, None);
        if !plan.chambers.is_empty() || !plan.radial_holes.is_empty() {
            if blade.surface.tip().is_some() {
                let message = "this blade ends in a point: there is no tip that passages could open at";
                return Err(BuildError::Refused(vec![Fault::new("/cooling", "pointed_tip", message)]));
            }
            let grid = kept_grid.insert(Grid::new(blade)?);
            let mut polygons = Vec::new();
            if let (Some(shell), false) = (&plan.shell, plan.chambers.is_empty()) {
                let blamed = |e: BuildError| e.blamed_on("/cooling/chambers");
                let stack =
                    kept_stack.insert(settled(blade, space, grid, plan, shell, watch).map_err(blamed)?);
                let turns = sites(stack, plan).map_err(blamed)?;
                let (probe, kept) = (Probe::new(blade), stack.kept);
                let check = ShellCheck { probe, blade, space, shell, kept, watch };
                (passages, polygons) =
                    add_chambers(&mut model, blade, stack, plan, &turns, &check).map_err(blamed)?;
                watch.go_on()?;
                let site = InsertSite { blade, space, grid, plan, shell, stack, watch };
                inserts = add_inserts(&mut model, &site, &mut passages)?;
            }
            if !plan.radial_holes.is_empty() {
                radial_holes = place_radial_holes(blade, space, grid, plan, &polygons)?;
                passages.extend(add_radial_holes(&mut model, &radial_holes, &ends)?);
            }
        }
        watch.go_on()?;
        Ok(Self { model, outer, passages, inserts, radial_holes, grid: kept_grid, stack: kept_stack, ends })
    }
}
