//! Impingement inserts.

use super::{ChamberPlan, Maker, RowHoles, TurnPlan};
use crate::design::{Cooling, Insert, InsertSide, JetArray};
use coolinggen_blade::{Fault, Law, Pointer};

/// An insert; see [`crate::design::Insert`].
#[derive(Clone, Debug, PartialEq)]
pub struct InsertPlan {
    /// Index in the design's list.
    pub index: usize,
    /// Index of its chamber.
    pub chamber: usize,
    /// Millimetres.
    pub gap: Law,
    /// Millimetres.
    pub thickness: Law,
    /// Radius of the outer corners, mm, if given.
    pub corner_radius: Option<Law>,
    /// Radius of the chamber's fillets, mm.
    pub fillet_radius: Law,
    /// Span fractions, if given.
    pub span: Option<[f64; 2]>,
    /// The closed end: 0 at the hub, 1 at the tip.
    pub closed: usize,
    /// Arrays of jets.
    pub jets: Vec<JetArrayPlan>,
}

/// An array of jets; see [`crate::design::JetArray`].
#[derive(Clone, Debug, PartialEq)]
pub struct JetArrayPlan {
    /// Name.
    pub name: String,
    /// Side of the insert.
    pub side: InsertSide,
    /// Millimetres.
    pub diameter: f64,
    /// Fractions of the side.
    pub position: [f64; 2],
    /// Columns: number or greatest pitch, mm.
    pub columns: RowHoles,
    /// Span fractions.
    pub span: [f64; 2],
    /// Rows: number or greatest pitch, mm.
    pub rows: RowHoles,
    /// Fraction of the distance between columns.
    pub stagger: f64,
}

impl InsertPlan {
    /// JSON pointer to the insert.
    pub fn pointer(&self) -> String {
        format!("/cooling/inserts/{}", self.index)
    }

    /// Radius of the outer corners, mm: as given; concentric with the chamber's; or as sharp as twice the thickness.
    pub fn corner(&self) -> Law {
        let concentric = self.fillet_radius.plus(-1.0, &self.gap);
        let least = 2.0 * self.thickness.bounds().1;
        match &self.corner_radius {
            Some(law) => law.clone(),
            None if concentric.bounds().0 >= least => concentric,
            None => Law::constant(concentric.bounds().1.max(least)),
        }
    }

    /// The open end: 0 at the hub, 1 at the tip.
    pub fn open(&self) -> usize {
        1 - self.closed
    }
}

/// Span fractions at which laws are compared.
fn stations() -> impl Iterator<Item = f64> {
    (0..=20).map(|k| f64::from(k) / 20.0)
}

impl Maker {
    pub(super) fn inserts(
        &mut self,
        cooling: &Cooling,
        chambers: &[ChamberPlan],
        turns: &[TurnPlan],
        list: &Pointer,
    ) -> Vec<InsertPlan> {
        let mut plans: Vec<InsertPlan> = Vec::new();
        for (index, insert) in cooling.inserts.iter().enumerate() {
            let at = list.at(index);
            let Some(chamber) = self.known(
                "chamber",
                &insert.chamber,
                chambers.iter().map(|c| c.name.as_str()),
                &at.at("chamber"),
            ) else {
                continue;
            };
            if plans.iter().any(|other| other.chamber == chamber) {
                let message = format!("chamber \"{}\" has an insert already", insert.chamber);
                self.faults
                    .push(Fault::new(at.at("chamber"), "taken", message).value(insert.chamber.as_str()));
                continue;
            }
            let plan = self.insert(index, insert, chamber, &chambers[chamber], &at);
            let (side, end) = (plan.open(), ["hub", "tip"][plan.open()]);
            let turn =
                turns.iter().find(|t| t.side() == side && (t.front == chamber || t.front + 1 == chamber));
            if let Some(turn) = turn {
                let message = format!("the insert opens at the {end}, where turn \"{}\" begins", turn.name);
                self.faults.push(Fault::new(at.at("closed_end"), "taken", message));
            }
            plans.push(plan);
        }
        plans
    }

    fn insert(
        &mut self,
        index: usize,
        insert: &Insert,
        chamber: usize,
        around: &ChamberPlan,
        at: &Pointer,
    ) -> InsertPlan {
        let gap = self.law(&insert.gap, &at.at("gap"));
        let thickness = self.law(&insert.thickness, &at.at("thickness"));
        let fillet_radius = around.fillet_radius.clone();
        let corner_radius = insert.corner_radius.as_ref().map(|law| {
            let concentric = fillet_radius.plus(-1.0, &gap);
            self.corner_radius(law, &concentric, &thickness, &at.at("corner_radius"))
        });
        let closed = insert.closed_end.side();
        if let Some(span) = insert.span {
            self.ordered_span(span, at);
            let (open, edge) = (span[1 - closed], [0.0, 1.0][1 - closed]);
            if open != edge {
                let message =
                    format!("the insert's open end is at span fraction {open}, the blade's at {edge}");
                let fault = Fault::new(at.at("span").at(1 - closed), "limit", message).value(open);
                self.faults.push(fault.min(edge).max(edge).unit("span fraction"));
            }
        }
        let jets = &at.at("jets");
        self.unique(insert.jets.iter().map(|j| j.name.as_str()), jets);
        let arrays = insert.jets.iter().enumerate();
        let jets = arrays.filter_map(|(i, array)| self.jet_array(array, &jets.at(i))).collect();
        InsertPlan {
            index,
            chamber,
            gap,
            thickness,
            corner_radius,
            fillet_radius,
            span: insert.span,
            closed,
            jets,
        }
    }

    /// The law of the outer corners, which must leave a radius inside and keep the gap to the chamber's corners.
    fn corner_radius(
        &mut self,
        spec: &coolinggen_blade::LawSpec,
        concentric: &Law,
        thickness: &Law,
        at: &Pointer,
    ) -> Law {
        /// Radius left inside the corner, relative to the thickness.
        const INSIDE: f64 = 0.05;
        let law = self.law(spec, at);
        let needed = |v: f64| concentric.at(v).max((1.0 + INSIDE) * thickness.at(v));
        let lack = |v: f64| needed(v) - law.at(v);
        let worst = stations().max_by(|a, b| lack(*a).total_cmp(&lack(*b))).filter(|v| lack(*v) > 1e-12);
        if let Some(v) = worst {
            let message = format!(
                "at span fraction {v:.2} a corner of {:.3} mm comes nearer to the chamber's than the gap, or leaves no \
                 radius inside the sheet",
                law.at(v)
            );
            self.faults
                .push(Fault::new(at.clone(), "limit", message).value(law.at(v)).min(needed(v)).unit("mm"));
        }
        law
    }

    /// None, with faults, where the numbers of rows or columns are not said once.
    fn jet_array(&mut self, array: &JetArray, at: &Pointer) -> Option<JetArrayPlan> {
        self.ordered_span(array.span, at);
        let [from, to] = array.position;
        if to < from {
            let message = format!("the part [{from}, {to}] must not end before it starts");
            let fault = Fault::new(at.at("position"), "order", message).value(to).min(from);
            self.faults.push(fault.unit("fraction of the side"));
        }
        let pitch = |d: Option<f64>| d.map(|d| RowHoles::Pitch(d * array.diameter));
        let columns = [array.streamwise_count.map(RowHoles::Count), pitch(array.streamwise_pitch_d)];
        let rows = [array.spanwise_count.map(RowHoles::Count), pitch(array.spanwise_pitch_d)];
        let columns = self.one_of(columns, at, "streamwise_count or streamwise_pitch_d");
        let rows = self.one_of(rows, at, "spanwise_count or spanwise_pitch_d");
        Some(JetArrayPlan {
            name: array.name.clone(),
            side: array.side,
            diameter: array.diameter,
            position: array.position,
            columns: columns?,
            span: array.span,
            rows: rows?,
            stagger: array.stagger,
        })
    }
}
