//! What measuring keeps for the next report of a similar design.

use super::Range;
use super::passages::PassageReport;
use coolinggen_brep::{Measures, Memo};
use glam::DVec2;

/// What measuring keeps, by the surfaces that it was found on.
#[derive(Clone, Debug, Default)]
pub struct KeptMeasures {
    pub(super) faces: Measures,
    /// Where on a face the metal is thinnest, and how thin: roughly, and found more closely.
    pub(super) walls: [Memo<(DVec2, f64)>; 2],
    pub(super) passages: Memo<PassageReport>,
    /// Distances between the tubes of inserts.
    pub(super) gaps: Memo<Range>,
}

impl KeptMeasures {
    /// For a design that is measured once: nothing is kept.
    pub fn once() -> Self {
        Self { faces: Measures::once(), ..Self::default() }
    }

    /// Ends a report, which came to its end or was broken off.
    pub fn end_round(&mut self, complete: bool) {
        self.faces.end_round(complete);
        self.walls.iter_mut().for_each(|walls| walls.end_round(complete));
        self.passages.end_round(complete);
        self.gaps.end_round(complete);
    }

    /// How many loops have been integrated so far and how many faces checked.
    pub fn made(&self) -> [u64; 2] {
        self.faces.made()
    }
}
