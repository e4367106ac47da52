//! Turns and the passages they make of chambers.

use super::{ChamberPlan, Maker};
use crate::design::{Clearance, Cooling, SpanEnd, Turn};
use coolinggen_blade::{Fault, Pointer};

/// A turn; see [`crate::design::Turn`].
#[derive(Clone, Debug, PartialEq)]
pub struct TurnPlan {
    /// Name.
    pub name: String,
    /// Index in the design's list.
    pub index: usize,
    /// The chamber before the wall; the next one lies behind it.
    pub front: usize,
    /// Where.
    pub end: SpanEnd,
    /// Millimetres; none where the flow area decides.
    pub clearance: Option<f64>,
    /// Of the outer side's superellipse.
    pub exponent: f64,
}

impl TurnPlan {
    /// 0 at the hub, 1 at the tip.
    pub fn side(&self) -> usize {
        self.end.side()
    }

    /// JSON pointer to the turn.
    pub fn pointer(&self) -> String {
        format!("/cooling/turns/{}", self.index)
    }
}

/// Spans nearer than this are one.
const SAME_SPAN: f64 = 1e-9;

impl Maker {
    pub(super) fn turns(
        &mut self,
        cooling: &Cooling,
        chambers: &[ChamberPlan],
        list: &Pointer,
    ) -> Vec<TurnPlan> {
        let turns: Vec<TurnPlan> = (cooling.turns.iter().enumerate())
            .filter_map(|(i, turn)| self.turn(i, turn, chambers, &list.at(i)))
            .collect();
        for (k, turn) in turns.iter().enumerate() {
            let at = list.at(turn.index).at("between");
            if let Some(other) = turns[..k].iter().find(|o| o.front == turn.front && o.end != turn.end) {
                let message = format!(
                    "with turn \"{}\" it closes a ring that no coolant enters: chambers \"{}\" and \"{}\"",
                    other.name,
                    chambers[turn.front].name,
                    chambers[turn.front + 1].name
                );
                self.faults.push(Fault::new(at.clone(), "ring", message));
            }
            let taken = turns[..k].iter().find(|o| o.end == turn.end && o.front.abs_diff(turn.front) <= 1);
            if let Some(other) = taken {
                let shared = turn.front.max(other.front);
                let message =
                    format!("chamber \"{}\" has turn \"{}\" at this end", chambers[shared].name, other.name);
                self.faults.push(Fault::new(at, "taken", message));
            }
        }
        turns
    }

    fn turn(
        &mut self,
        index: usize,
        turn: &Turn,
        chambers: &[ChamberPlan],
        at: &Pointer,
    ) -> Option<TurnPlan> {
        let mut places = [0; 2];
        for (k, name) in turn.between.iter().enumerate() {
            let known = chambers.iter().map(|c| c.name.as_str());
            let place = self.known("chamber", name, known, &at.at("between").at(k))?;
            places[k] = place;
        }
        let front = places[0].min(places[1]);
        if places[0].abs_diff(places[1]) != 1 {
            let message =
                format!("chambers \"{}\" and \"{}\" are no neighbours", turn.between[0], turn.between[1]);
            self.faults.push(Fault::new(at.at("between"), "not_neighbours", message));
            return None;
        }
        let clearance = match turn.clearance {
            Clearance::Length(length) => Some(length),
            Clearance::Automatic(_) => None,
        };
        let (name, exponent) = (turn.name.clone(), turn.exponent);
        let plan = TurnPlan { name, index, front, end: turn.end, clearance, exponent };
        self.straight_ends(&plan, chambers, at);
        Some(plan)
    }

    /// The two straight parts end on one stream surface, which leaves room for the turn.
    fn straight_ends(&mut self, turn: &TurnPlan, chambers: &[ChamberPlan], at: &Pointer) {
        let side = turn.side();
        let end = |k: usize| chambers[k].span.map(|span| span[side]);
        if let (Some(here), Some(there)) = (end(turn.front), end(turn.front + 1))
            && (here - there).abs() > SAME_SPAN
        {
            let message = format!(
                "chamber \"{}\" ends at span fraction {there}, \"{}\" at {here}: a turn joins them at one",
                chambers[turn.front + 1].name,
                chambers[turn.front].name
            );
            self.faults.push(
                Fault::new(at.at("between"), "spans_differ", message)
                    .value(there)
                    .min(here)
                    .max(here)
                    .unit("span fraction"),
            );
        }
        let given = end(turn.front).or_else(|| end(turn.front + 1));
        if let Some(v) = given.filter(|&v| v == [0.0, 1.0][side]) {
            let message =
                format!("the chambers' straight parts end at span fraction {v}, which leaves no room");
            let mut fault = Fault::new(at.clone(), "no_room", message).value(v).unit("span fraction");
            fault = if side == 1 { fault.max(1.0) } else { fault.min(0.0) };
            self.faults.push(fault.hint("give the chambers a span that ends before, or none"));
        }
    }
}

/// Chains of chambers and the turns between them, from front to back: one a passage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chain {
    /// Chambers, in order.
    pub chambers: Vec<usize>,
    /// Turns between them, as indices of the plan's turns: one fewer.
    pub turns: Vec<usize>,
}

impl super::Plan {
    /// The chains of chambers that turns make; chambers without turns stand alone.
    pub fn chains(&self) -> Vec<Chain> {
        let mut chains: Vec<Chain> = Vec::new();
        for k in 0..self.chambers.len() {
            let turn = (k > 0).then(|| self.turns.iter().position(|t| t.front == k - 1)).flatten();
            match (turn, chains.last_mut()) {
                (Some(turn), Some(chain)) => {
                    chain.turns.push(turn);
                    chain.chambers.push(k);
                }
                _ => chains.push(Chain { chambers: vec![k], turns: Vec::new() }),
            }
        }
        chains
    }

    /// The turn at an end (0 hub, 1 tip) of chamber `k`.
    pub fn turn_at(&self, k: usize, side: usize) -> Option<&TurnPlan> {
        self.turns.iter().find(|t| t.side() == side && (t.front == k || t.front + 1 == k))
    }
}
