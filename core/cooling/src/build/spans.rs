//! Where chambers begin and end along the span, and how far turns reach beyond them.

use super::error::BuildError;
use super::sections::{Grid, Section, wall_lines};
use crate::plan::{Plan, ShellPlan, TurnPlan};
use coolinggen_blade::{Blade, Fault, StreamSpace};
use coolinggen_nurbs::{ArcLength, Curve, Interpolator};
use glam::DVec3;

/// Span fractions of chambers and turns.
#[derive(Clone, Debug)]
pub(super) struct Spans {
    /// Of the chambers' straight parts.
    pub(super) chambers: Vec<[f64; 2]>,
    /// Of the turns, in the plan's order.
    pub(super) turns: Vec<TurnSpan>,
}

/// How far a turn reaches.
#[derive(Clone, Debug)]
pub(super) struct TurnSpan {
    /// Span fractions of its sections: the straight parts' end first, the last at its outer side or a little beyond.
    pub(super) fractions: Vec<f64>,
    /// Height of the passage beyond the wall's end, mm.
    pub(super) clearance: f64,
    /// Half the wall's thickness where the straight parts end, mm.
    pub(super) inner: f64,
    /// Radius of the fillets half way round, mm.
    pub(super) radius: f64,
    /// The greatest clearance for which there is room, mm.
    room: f64,
}

impl TurnSpan {
    /// Span fraction where the straight parts end.
    pub(super) fn joint(&self) -> f64 {
        self.fractions[0]
    }

    /// Distance of the outer side from the straight parts' end, mm.
    pub(super) fn outer(&self) -> f64 {
        self.inner + self.clearance
    }

    /// The refusal of a turn that does not keep to the room it has.
    pub(super) fn check(&self, turn: &TurnPlan) -> Option<Fault> {
        (self.clearance > self.room + 1e-6).then(|| {
            let end = ["hub", "tip"][turn.side()];
            let message = format!(
                "at span fraction {:.4} the turn's clearance of {:.3} mm leaves too little metal at the {end}",
                self.joint(),
                self.clearance
            );
            Fault::new(format!("{}/clearance", turn.pointer()), "no_room", message)
                .value(self.clearance)
                .max(self.room)
                .unit("mm")
                .hint("or chambers that end before")
        })
    }
}

/// Sections of a turn.
const TURN_SECTIONS: usize = 6;
/// Rounds of finding where straight parts end.
const ROUNDS: usize = 20;
/// How far beyond hub and tip walls are followed where the blade goes on.
const BEYOND: f64 = 0.03;
/// How far the last section may lie beyond the turn's outer side, relative to its height.
const OVERLAP: f64 = 0.01;

/// Spans for the clearances of the turns, mm.
pub(super) fn spans(
    blade: &Blade,
    space: &StreamSpace,
    grid: &Grid,
    plan: &Plan,
    shell: &ShellPlan,
    clearances: &[f64],
) -> Result<Spans, BuildError> {
    let limit = |side: usize| -> Result<f64, BuildError> {
        match [shell.hub, shell.tip][side] {
            None => Ok([0.0, 1.0][side]),
            Some(metal) => within(blade, space, grid, side, metal),
        }
    };
    let top = if shell.tip.is_some() { limit(1)? } else { 1.0 };
    let mut chambers: Vec<[f64; 2]> = plan.chambers.iter().map(|c| c.span.unwrap_or([0.0, top])).collect();
    let mut turns = Vec::with_capacity(plan.turns.len());
    let mut faults = Vec::new();
    let paths = Paths::new(blade, space, grid, plan)?;
    for (turn, &clearance) in plan.turns.iter().zip(clearances) {
        let side = turn.side();
        let path = paths.of(turn)?;
        let given = |k: usize| plan.chambers[k].span.map(|s| s[side]);
        let given = given(turn.front).or_else(|| given(turn.front + 1));
        let end = limit(side)?;
        if given.is_none() && [shell.hub, shell.tip][side].is_none() {
            let name = ["hub", "tip"][side];
            let message = format!("turn \"{}\" needs the metal left at the {name}", turn.name);
            let fault = Fault::new(format!("/cooling/shell/{name}"), "missing", message);
            faults.push(fault.hint("or a span of its chambers"));
            continue;
        }
        let sign = [-1.0, 1.0][side];
        let half = |v: f64| 0.5 * plan.walls[turn.front].thickness.at(v);
        let joint = match given {
            Some(v) => v,
            // The wall's thickness varies slowly: its value where the straight parts end settles fast.
            None => {
                (0..ROUNDS).fold(end, |v, _| path.parameter(path.length(end) - sign * (clearance + half(v))))
            }
        };
        let inner = half(joint);
        let height = |factor: f64| path.parameter(path.length(joint) + sign * (inner + clearance) * factor);
        let last = height(1.0 + OVERLAP);
        let step = (last - joint) / (TURN_SECTIONS - 1) as f64;
        let room = (path.length(end) - path.length(joint)).abs() - inner;
        let radius = [0, 1].map(|k| plan.chambers[turn.front + k].fillet_radius.at(joint));
        turns.push(TurnSpan {
            fractions: (0..TURN_SECTIONS).map(|i| joint + step * i as f64).collect(),
            clearance,
            inner,
            radius: 0.5 * (radius[0] + radius[1]),
            room,
        });
        chambers[turn.front][side] = joint;
        chambers[turn.front + 1][side] = joint;
    }
    for (k, [start, end]) in chambers.iter().enumerate() {
        const LEAST: f64 = 0.01;
        if !(end - start >= LEAST) {
            let message = format!("its turns leave the chamber a span from {start:.4} to {end:.4}");
            let fault = Fault::new(format!("/cooling/chambers/{k}"), "no_room", message);
            faults.push(fault.value(end - start).min(LEAST).unit("span fraction"));
        }
    }
    if faults.is_empty() { Ok(Spans { chambers, turns }) } else { Err(BuildError::Refused(faults)) }
}

/// The span fraction that lies everywhere at least `metal` below the tip (side 1) or above the hub (side 0).
fn within(
    blade: &Blade,
    space: &StreamSpace,
    grid: &Grid,
    side: usize,
    metal: f64,
) -> Result<f64, BuildError> {
    let v = inside(space, &Section::new(blade, space, grid, [0.0, 1.0][side])?, side, metal)?;
    let left = [1.0 - v, v][side];
    if !(left > 0.05) {
        let name = ["hub", "tip"][side];
        let message = format!("the {name} thickness leaves no room for a chamber");
        let fault = Fault::new(format!("/cooling/shell/{name}"), "geometry", message).value(metal).unit("mm");
        return Err(BuildError::Refused(vec![fault]));
    }
    Ok(v)
}

/// The span fraction that lies everywhere at least `distance` mm below a section (side 1) or above it (side 0): stream
/// surfaces are no offsets of each other.
pub(super) fn inside(
    space: &StreamSpace,
    section: &Section,
    side: usize,
    distance: f64,
) -> Result<f64, BuildError> {
    const STEPS: u32 = 20;
    let sign = [-1.0, 1.0][side];
    let mut v = section.stream.v();
    for i in 0..=STEPS {
        let at = section.stream.to_space(section.camber.at(f64::from(i) / f64::from(STEPS)).center);
        let up = section.stream.level(at).1;
        let here = space.span_fraction(at - up * (sign * distance))?;
        v = if side == 1 { f64::min(v, here) } else { f64::max(v, here) };
    }
    Ok(v)
}

/// The walls' mid lines from hub to tip.
struct Paths<'a> {
    plan: &'a Plan,
    sections: Vec<Section>,
}

impl<'a> Paths<'a> {
    /// Sections only where there are turns to be placed.
    fn new(blade: &Blade, space: &StreamSpace, grid: &Grid, plan: &'a Plan) -> Result<Self, BuildError> {
        const STEPS: u32 = 8;
        let count = if plan.turns.is_empty() { 0 } else { STEPS + 1 };
        let through = |beyond: f64| {
            let v = |i: u32| -beyond + (1.0 + 2.0 * beyond) * f64::from(i) / f64::from(STEPS);
            (0..count).map(|i| Section::new(blade, space, grid, v(i))).collect::<Result<Vec<_>, _>>()
        };
        // A blade need not go on beyond its ends.
        let sections = through(BEYOND).or_else(|_| through(0.0))?;
        Ok(Self { plan, sections })
    }

    /// Arc length over the span fraction along the wall of a turn.
    fn of(&self, turn: &TurnPlan) -> Result<ArcLength<DVec3, Curve<DVec3>>, BuildError> {
        let lines = wall_lines(&self.sections, &self.plan.walls[turn.front])?;
        let vs: Vec<f64> = self.sections.iter().map(|s| s.stream.v()).collect();
        let feet: Vec<DVec3> =
            self.sections.iter().zip(&lines).map(|(s, l)| s.stream.to_space(l.center)).collect();
        Ok(ArcLength::new(Interpolator::new(3, &vs)?.curve(&feet)?, 1e-9)?)
    }
}
