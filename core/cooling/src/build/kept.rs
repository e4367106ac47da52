//! What building keeps for the next build of a similar design.
//!
//! Two stages come one after the other: the blade with its passages, which depends on the outer surface and on what the
//! design says of shell, walls, chambers, turns, inserts and radial holes; and the bores, each of which depends on that and
//! on itself, and on the borders that others have parted before it.

use super::film::Feed;
use super::hollow::Hollow;
use super::slots::PlannedSlot;
use crate::bore::Drill;
use crate::plan::Plan;
use coolinggen_blade::Blade;
use coolinggen_brep::{Caster, Memo};
use coolinggen_nurbs::Surface;
use glam::DVec3;
use std::sync::Arc;

/// What building keeps.
#[derive(Clone, Debug, Default)]
pub struct KeptBuild {
    hollow: Option<KeptHollow>,
    /// What is known of bores in that.
    pub(super) bores: KeptBores,
    made: u64,
    once: bool,
}

/// The last blade with its passages, and what it was made from: the outer surface with its space, which are made
/// together, and a plan with nothing else in it.
#[derive(Clone, Debug)]
struct KeptHollow {
    outer: Arc<Blade>,
    plan: Plan,
    hollow: Arc<Hollow>,
}

/// What is known of the bores in one blade with its passages.
#[derive(Clone, Debug, Default)]
pub(super) struct KeptBores {
    pub(super) drill: Drill,
    /// Triangles of faces, by the faces.
    pub(super) casters: Memo<Arc<Caster>>,
    /// What feeds film holes.
    pub(super) feeds: Memo<Arc<Feed>>,
    /// Slots before they are drilled.
    pub(super) slots: Memo<Arc<PlannedSlot>>,
    /// The pieces of the outer surface that close the coolant where bores break out.
    pub(super) windows: Memo<Surface<DVec3>>,
}

impl KeptBores {
    /// For bores that are made once: nothing is kept of them but what serves several.
    fn once() -> Self {
        Self { drill: Drill::once(), windows: Memo::idle(), ..Self::default() }
    }
}

impl KeptBuild {
    /// For a design that is built once: nothing is kept but what serves several bores.
    pub fn once() -> Self {
        Self { bores: KeptBores::once(), once: true, ..Self::default() }
    }

    /// The blade with its passages for this plan: the last one, or one that `make` makes.
    pub(super) fn hollow<E>(
        &mut self,
        outer: &Arc<Blade>,
        plan: &Plan,
        make: impl FnOnce(&Plan) -> Result<Hollow, E>,
    ) -> Result<Arc<Hollow>, E> {
        let plan = plan.without_bores();
        if let Some(kept) = &self.hollow
            && Arc::ptr_eq(&kept.outer, outer)
            && kept.plan == plan
        {
            return Ok(Arc::clone(&kept.hollow));
        }
        let hollow = Arc::new(make(&plan)?);
        self.made += 1;
        self.bores = if self.once { KeptBores::once() } else { KeptBores::default() };
        self.hollow = Some(KeptHollow { outer: Arc::clone(outer), plan, hollow: Arc::clone(&hollow) });
        Ok(hollow)
    }

    /// Ends a build, which came to its end or was broken off.
    pub fn end_round(&mut self, complete: bool) {
        let KeptBores { drill, casters, feeds, slots, windows } = &mut self.bores;
        drill.end_round(complete);
        casters.end_round(complete);
        feeds.end_round(complete);
        slots.end_round(complete);
        windows.end_round(complete);
    }

    /// How many blades with passages have been made so far, and in the last of them how many bores.
    pub fn made(&self) -> [u64; 2] {
        [self.made, self.bores.drill.made()]
    }
}
