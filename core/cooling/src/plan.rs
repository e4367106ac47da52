//! The plan: a design's cooling with its laws made ready and everything checked that needs no geometry.

mod turns;

pub use turns::{Chain, TurnPlan};

use crate::design::{Cooling, HolePlacement};
use coolinggen_blade::{Fault, Law, LawSpec, Pointer};
use std::collections::HashSet;

/// Cooling, ready to be built.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// The shell; there whenever there are chambers.
    pub shell: Option<ShellPlan>,
    /// Walls from front to back.
    pub walls: Vec<WallPlan>,
    /// Chambers from front to back, one more than walls, or none.
    pub chambers: Vec<ChamberPlan>,
    /// Turns, in the design's order.
    pub turns: Vec<TurnPlan>,
    /// Radial holes.
    pub radial_holes: Vec<RadialHolePlan>,
}

/// Shell thickness, mm.
#[derive(Clone, Debug)]
pub struct ShellPlan {
    /// On the suction side.
    pub suction_side: Law,
    /// On the pressure side.
    pub pressure_side: Law,
    /// At the tip, mm.
    pub tip: Option<f64>,
    /// At the hub, for turns, mm.
    pub hub: Option<f64>,
}

/// A wall; see [`crate::design::Wall`].
#[derive(Clone, Debug)]
pub struct WallPlan {
    /// Name.
    pub name: String,
    /// Camber fraction.
    pub position: Law,
    /// Degrees.
    pub angle_deg: Law,
    /// Millimetres.
    pub thickness: Law,
}

/// A chamber; see [`crate::design::Chamber`].
#[derive(Clone, Debug)]
pub struct ChamberPlan {
    /// Name.
    pub name: String,
    /// Span fractions, if given.
    pub span: Option<[f64; 2]>,
    /// Millimetres.
    pub fillet_radius: Law,
}

/// A radial hole; see [`crate::design::RadialHole`].
#[derive(Clone, Debug)]
pub struct RadialHolePlan {
    /// Name.
    pub name: String,
    /// Millimetres.
    pub diameter: Law,
    /// Where it meets a stream surface.
    pub at: PlacementPlan,
}

/// A placement with its two laws ready; see [`HolePlacement`].
#[derive(Clone, Debug)]
pub enum PlacementPlan {
    /// Camber fraction and offset.
    Camber(Law, Law),
    /// m and r * theta.
    Stream(Law, Law),
    /// U and V, and where V is measured from.
    Bitangent(Law, Law, Option<[f64; 2]>),
}

/// Span fractions nearer than this are one.
const LEAST_SPAN: f64 = 0.01;

impl Plan {
    /// Makes a design's cooling ready.
    ///
    /// # Errors
    /// Every fault that can be found without geometry.
    pub fn new(cooling: &Cooling) -> Result<Self, Vec<Fault>> {
        let mut maker = Maker { faults: Vec::new() };
        let root = Pointer::root().at("cooling");
        let plan = maker.plan(cooling, &root);
        if maker.faults.is_empty() { Ok(plan) } else { Err(maker.faults) }
    }
}

/// Collects faults while it makes the plan; a part with faults gets a stand-in.
struct Maker {
    faults: Vec<Fault>,
}

impl Maker {
    fn law(&mut self, spec: &LawSpec, at: &Pointer) -> Law {
        spec.law(at).unwrap_or_else(|faults| {
            self.faults.extend(faults);
            Law::constant(1.0)
        })
    }

    fn unique<'n>(&mut self, names: impl Iterator<Item = &'n str>, list: &Pointer) {
        let mut seen = HashSet::new();
        for (i, name) in names.enumerate() {
            if !seen.insert(name) {
                let at = list.at(i).at("name");
                let message = format!("the name \"{name}\" is taken by an entry before");
                self.faults.push(Fault::new(at, "duplicate_name", message).value(name));
            }
        }
    }

    fn plan(&mut self, cooling: &Cooling, root: &Pointer) -> Plan {
        let shell = cooling.shell.as_ref().map(|shell| {
            let at = root.at("shell");
            ShellPlan {
                suction_side: self.law(&shell.suction_side, &at.at("suction_side")),
                pressure_side: self.law(&shell.pressure_side, &at.at("pressure_side")),
                tip: shell.tip,
                hub: shell.hub.or(shell.tip),
            }
        });
        if shell.is_none() && !cooling.chambers.is_empty() {
            let message = "chambers need the shell's thickness";
            self.faults.push(Fault::new(root.at("shell"), "missing", message));
        }
        self.unique(cooling.walls.iter().map(|w| w.name.as_str()), &root.at("walls"));
        self.unique(cooling.chambers.iter().map(|c| c.name.as_str()), &root.at("chambers"));
        self.unique(cooling.turns.iter().map(|t| t.name.as_str()), &root.at("turns"));
        self.unique(cooling.radial_holes.iter().map(|h| h.name.as_str()), &root.at("radial_holes"));
        let walls = self.walls(cooling, &root.at("walls"));
        let chambers = self.chambers(cooling, &root.at("chambers"));
        let turns = self.turns(cooling, &chambers, &root.at("turns"));
        let radial_holes = self.radial_holes(cooling, &root.at("radial_holes"));
        Plan { shell, walls, chambers, turns, radial_holes }
    }

    fn walls(&mut self, cooling: &Cooling, list: &Pointer) -> Vec<WallPlan> {
        let walls: Vec<WallPlan> = (cooling.walls.iter().enumerate())
            .map(|(i, wall)| {
                let at = list.at(i);
                WallPlan {
                    name: wall.name.clone(),
                    position: self.law(&wall.position, &at.at("position")),
                    angle_deg: self.law(&wall.angle_deg, &at.at("angle_deg")),
                    thickness: self.law(&wall.thickness, &at.at("thickness")),
                }
            })
            .collect();
        for (i, pair) in walls.windows(2).enumerate() {
            let crossed = (0..=20)
                .map(|k| f64::from(k) / 20.0)
                .find(|&v| !(pair[1].position.at(v) > pair[0].position.at(v)));
            if let Some(v) = crossed {
                let (before, here) = (pair[0].position.at(v), pair[1].position.at(v));
                let message = format!(
                    "at span fraction {v:.2} wall \"{}\" stands at {here:.4}, not behind wall \"{}\" at {before:.4}",
                    pair[1].name, pair[0].name
                );
                let at = list.at(i + 1).at("position");
                self.faults
                    .push(Fault::new(at, "order", message).value(here).min(before).unit("camber fraction"));
            }
        }
        walls
    }

    fn chambers(&mut self, cooling: &Cooling, list: &Pointer) -> Vec<ChamberPlan> {
        let (chambers, walls) = (cooling.chambers.len(), cooling.walls.len());
        if chambers != walls + 1 && (chambers > 0 || walls > 0) {
            let message =
                format!("{walls} walls part the blade into {} chambers, {chambers} are given", walls + 1);
            let expected = (walls + 1) as f64;
            self.faults
                .push(Fault::new(list.clone(), "count", message).value(chambers).min(expected).max(expected));
        }
        (cooling.chambers.iter().enumerate())
            .map(|(i, chamber)| {
                let at = list.at(i);
                if let Some([start, end]) = chamber.span
                    && !(end - start >= LEAST_SPAN)
                {
                    let message =
                        format!("the span [{start}, {end}] must end at least {LEAST_SPAN} above its start");
                    self.faults.push(
                        Fault::new(at.at("span"), "order", message)
                            .value(end)
                            .min(start + LEAST_SPAN)
                            .unit("span fraction"),
                    );
                }
                let fillet_radius = self.law(&chamber.fillet_radius, &at.at("fillet_radius"));
                ChamberPlan { name: chamber.name.clone(), span: chamber.span, fillet_radius }
            })
            .collect()
    }

    fn radial_holes(&mut self, cooling: &Cooling, list: &Pointer) -> Vec<RadialHolePlan> {
        (cooling.radial_holes.iter().enumerate())
            .map(|(i, hole)| {
                let at = list.at(i);
                let place = at.at("at");
                let at_plan = match &hole.at {
                    HolePlacement::Camber { position, offset } => PlacementPlan::Camber(
                        self.law(position, &place.at("position")),
                        self.law(offset, &place.at("offset")),
                    ),
                    HolePlacement::Stream { m, t } => {
                        PlacementPlan::Stream(self.law(m, &place.at("m")), self.law(t, &place.at("t")))
                    }
                    HolePlacement::Bitangent { u, v, from } => PlacementPlan::Bitangent(
                        self.law(u, &place.at("u")),
                        self.law(v, &place.at("v")),
                        *from,
                    ),
                };
                let diameter = self.law(&hole.diameter, &at.at("diameter"));
                RadialHolePlan { name: hole.name.clone(), diameter, at: at_plan }
            })
            .collect()
    }
}
