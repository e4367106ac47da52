//! The plan: a design's cooling with its laws made ready and everything checked that needs no geometry.

mod inner_bores;
mod inserts;
mod turns;

pub use inner_bores::{CrossoverRowPlan, DustHolePlan, PinArrayPlan};
pub use inserts::{InsertPlan, JetArrayPlan};
pub use turns::{Chain, TurnPlan};

use crate::design::{Chamber, Cooling, Cutback, FilmRow, HolePlacement, HoleShape, Side, SlotRow};
use coolinggen_blade::{Fault, Law, LawSpec, Pointer};
use std::collections::HashSet;

/// Cooling, ready to be built.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// The shell; there whenever there are chambers.
    pub shell: Option<ShellPlan>,
    /// Walls from front to back.
    pub walls: Vec<WallPlan>,
    /// Chambers from front to back, one more than walls, or none.
    pub chambers: Vec<ChamberPlan>,
    /// Turns, in the design's order.
    pub turns: Vec<TurnPlan>,
    /// Inserts, in the design's order.
    pub inserts: Vec<InsertPlan>,
    /// Radial holes.
    pub radial_holes: Vec<RadialHolePlan>,
    /// Rows of film holes.
    pub film_rows: Vec<FilmRowPlan>,
    /// Rows of slots.
    pub slot_rows: Vec<SlotRowPlan>,
    /// Rows of crossover holes.
    pub crossover_rows: Vec<CrossoverRowPlan>,
    /// Arrays of pins.
    pub pin_arrays: Vec<PinArrayPlan>,
    /// Dust holes.
    pub dust_holes: Vec<DustHolePlan>,
    /// Least metal between neighbouring holes, between slots and beside them, and least passage between neighbouring pins,
    /// mm.
    pub least_ligament: f64,
    /// How far the coolant goes on before its inlets at the hub, mm.
    pub inlet_extension: Option<f64>,
}

/// Shell thickness, mm.
#[derive(Clone, Debug, PartialEq)]
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
#[derive(Clone, Debug, PartialEq)]
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
#[derive(Clone, Debug, PartialEq)]
pub struct ChamberPlan {
    /// Name.
    pub name: String,
    /// Span fractions, if given.
    pub span: Option<[f64; 2]>,
    /// Millimetres.
    pub fillet_radius: Law,
}

/// A radial hole; see [`crate::design::RadialHole`].
#[derive(Clone, Debug, PartialEq)]
pub struct RadialHolePlan {
    /// Name.
    pub name: String,
    /// Millimetres.
    pub diameter: Law,
    /// Where it meets a stream surface.
    pub at: PlacementPlan,
}

/// A placement with its two laws ready; see [`HolePlacement`].
#[derive(Clone, Debug, PartialEq)]
pub enum PlacementPlan {
    /// Camber fraction and offset.
    Camber(Law, Law),
    /// m and r * theta.
    Stream(Law, Law),
    /// U and V, and where V is measured from.
    Bitangent(Law, Law, Option<[f64; 2]>),
}

/// A row of film holes; see [`crate::design::FilmRow`].
#[derive(Clone, Debug, PartialEq)]
pub struct FilmRowPlan {
    /// Name.
    pub name: String,
    /// Side of the blade.
    pub side: Side,
    /// Where on the side.
    pub at: RowPlacement,
    /// Span fractions.
    pub span: [f64; 2],
    /// Number of holes or greatest pitch, mm.
    pub holes: RowHoles,
    /// Fraction of the pitch.
    pub stagger: f64,
    /// The chamber that must feed it.
    pub chamber: Option<String>,
    /// Millimetres.
    pub diameter: Law,
    /// Degrees.
    pub inclination_deg: Law,
    /// Degrees.
    pub compound_deg: Law,
    /// Shape.
    pub shape: HoleShape,
}

/// Where a row runs on its side.
#[derive(Clone, Debug, PartialEq)]
pub enum RowPlacement {
    /// Fraction of the side's length.
    Position(Law),
    /// Length from the foremost point, mm.
    Distance(Law),
    /// Fraction of the camber line.
    Camber(Law),
}

/// A row of slots; see [`crate::design::SlotRow`].
#[derive(Clone, Debug, PartialEq)]
pub struct SlotRowPlan {
    /// Name.
    pub name: String,
    /// Span fractions.
    pub span: [f64; 2],
    /// Number of slots or greatest pitch, mm.
    pub slots: RowHoles,
    /// Millimetres along the span.
    pub height: f64,
    /// Millimetres across the blade.
    pub width: f64,
    /// Millimetres.
    pub corner_radius: f64,
    /// How the pressure side is cut back, if it is.
    pub cutback: Option<Cutback>,
}

/// How many holes a row has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RowHoles {
    /// As many.
    Count(u32),
    /// As few as keep this distance, mm.
    Pitch(f64),
}

impl RowHoles {
    /// The number on a row of this length, mm.
    pub fn on(self, length: f64) -> usize {
        match self {
            Self::Count(count) => count as usize,
            Self::Pitch(pitch) => ((length / pitch).ceil() as usize).max(1),
        }
    }
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

    /// The part of the plan that is built before any bore: what the others share.
    pub fn without_bores(&self) -> Self {
        let mut inserts = self.inserts.clone();
        inserts.iter_mut().for_each(|insert| insert.jets.clear());
        Self {
            shell: self.shell.clone(),
            walls: self.walls.clone(),
            chambers: self.chambers.clone(),
            turns: self.turns.clone(),
            inserts,
            radial_holes: self.radial_holes.clone(),
            ..Self::default()
        }
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
        let inserts = self.inserts(cooling, &chambers, &turns, &root.at("inserts"));
        let radial_holes = self.radial_holes(cooling, &root.at("radial_holes"));
        self.unique(cooling.film_rows.iter().map(|r| r.name.as_str()), &root.at("film_rows"));
        let film_rows = self.film_rows(cooling, &root.at("film_rows"));
        self.unique(cooling.slot_rows.iter().map(|r| r.name.as_str()), &root.at("slot_rows"));
        let slots = cooling.slot_rows.iter().enumerate();
        let slot_rows = slots
            .filter_map(|(i, row)| {
                self.slot_row(row, !cooling.chambers.is_empty(), &root.at("slot_rows").at(i))
            })
            .collect();
        Plan {
            shell,
            walls,
            chambers,
            turns,
            inserts,
            radial_holes,
            film_rows,
            slot_rows,
            crossover_rows: self.crossover_rows(cooling, &root.at("crossover_rows")),
            pin_arrays: self.pin_arrays(cooling, &root.at("pin_arrays")),
            dust_holes: self.dust_holes(cooling, &root.at("dust_holes")),
            least_ligament: cooling.least_ligament,
            inlet_extension: cooling.inlet_extension,
        }
    }

    /// None, with faults, where the row's number is not said once.
    fn slot_row(&mut self, row: &SlotRow, has_chambers: bool, at: &Pointer) -> Option<SlotRowPlan> {
        if !has_chambers {
            let message = "slots are fed by the trailing chamber, and there is none";
            self.faults.push(Fault::new(at.clone(), "missing", message));
        }
        let greatest = 0.5 * row.height.min(row.width);
        if row.corner_radius > greatest {
            let message = "the corners meet before they are round".to_owned();
            let fault = Fault::new(at.at("corner_radius"), "limit", message).value(row.corner_radius);
            self.faults.push(fault.max(greatest).unit("mm"));
        }
        self.ordered_span(row.span, at);
        let numbers = [row.count.map(RowHoles::Count), row.pitch.map(RowHoles::Pitch)];
        Some(SlotRowPlan {
            name: row.name.clone(),
            span: row.span,
            slots: self.one_of(numbers, at, "count or pitch")?,
            height: row.height,
            width: row.width,
            corner_radius: row.corner_radius,
            cutback: row.cutback,
        })
    }

    fn ordered_span(&mut self, span: [f64; 2], at: &Pointer) {
        if span[1] < span[0] {
            let message = format!("the span [{}, {}] must not end before it starts", span[0], span[1]);
            let fault = Fault::new(at.at("span"), "order", message).value(span[1]).min(span[0]);
            self.faults.push(fault.unit("span fraction"));
        }
    }

    fn film_rows(&mut self, cooling: &Cooling, list: &Pointer) -> Vec<FilmRowPlan> {
        let rows = cooling.film_rows.iter().enumerate();
        rows.filter_map(|(i, row)| self.film_row(row, &cooling.chambers, &list.at(i))).collect()
    }

    /// None, with faults, where the row's place or number is not said once.
    fn film_row(&mut self, row: &FilmRow, chambers: &[Chamber], at: &Pointer) -> Option<FilmRowPlan> {
        let mut law = |spec: &Option<LawSpec>, field: &str| spec.as_ref().map(|s| self.law(s, &at.at(field)));
        let placements = [
            law(&row.surface_position, "surface_position").map(RowPlacement::Position),
            law(&row.surface_distance, "surface_distance").map(RowPlacement::Distance),
            law(&row.camber_position, "camber_position").map(RowPlacement::Camber),
        ];
        let numbers = [row.count.map(RowHoles::Count), row.pitch.map(RowHoles::Pitch)];
        let hole = at.at("hole");
        let diameter = self.law(&row.hole.diameter, &hole.at("diameter"));
        let inclination_deg = self.law(&row.hole.inclination_deg, &hole.at("inclination_deg"));
        let compound_deg = self.law(&row.hole.compound_deg, &hole.at("compound_deg"));
        self.ordered_span(row.span, at);
        if let Some(name) = &row.chamber {
            self.known("chamber", name, chambers.iter().map(|c| c.name.as_str()), &at.at("chamber"));
        }
        let at_side = self.one_of(placements, at, "surface_position, surface_distance or camber_position");
        let holes = self.one_of(numbers, at, "count or pitch");
        Some(FilmRowPlan {
            name: row.name.clone(),
            side: row.side,
            at: at_side?,
            span: row.span,
            holes: holes?,
            stagger: row.stagger,
            chamber: row.chamber.clone(),
            diameter,
            inclination_deg,
            compound_deg,
            shape: row.hole.shape.clone(),
        })
    }

    /// The one that is given, or a fault.
    fn one_of<T, const N: usize>(&mut self, given: [Option<T>; N], at: &Pointer, names: &str) -> Option<T> {
        let mut given: Vec<T> = given.into_iter().flatten().collect();
        if given.len() == 1 {
            return given.pop();
        }
        let message = format!("exactly one of {names} must be given, {} are", given.len());
        self.faults.push(Fault::new(at.clone(), "one_of", message).value(given.len()).min(1.0).max(1.0));
        None
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
