//! Turns: the passage from one chamber to the next round the end of the wall between them (thesis 4.2, DESIGN 5.4).
//!
//! The thesis draws sections in planes through the turn's axis. Straight planes crease at chambers that lean and cut
//! through the shell of leaned blades, so a turn is drawn in a box and mapped ([`TurnChart`]): x runs across the wall along
//! the camber line, eta from the pressure side (0) to the suction side (1) along fibres that keep the wall's angle, zeta
//! in mm from the straight parts' end, along the wall. Sides are the faces eta = 0 and 1 of the box, whatever the blade
//! does there.
//!
//! A turn is a family of rings ([`TurnShape`]) over an angle psi from 0 (the front chamber's end) to pi (the back
//! chamber's). Each has eight segments in the front chamber's order: suction side, three of the inner closure round the
//! wall's end, pressure side, three of the outer closure. Segment k of all rings lofts to one face ([`loft`]).

mod chart;
mod closure;
mod fan;
mod fibre;
mod pace;
mod refusal;
mod shape;
mod side;
mod surfaces;
mod top;

pub(crate) use fibre::{FORMS, Form};
pub(crate) use refusal::TurnRefusal;
pub(crate) use shape::{TurnRequest, TurnShape};
pub(crate) use surfaces::{EndRow, loft};

use crate::section::{Camber, ChamberRing, Outline, SEGMENTS};
use coolinggen_blade::StreamSurface;
use glam::DVec2;

/// One stream surface that the turn passes, with what the chambers would be there if they went on.
#[derive(Clone, Debug)]
pub(crate) struct TurnSection<'a> {
    pub(crate) stream: &'a StreamSurface,
    /// Inner outline of the shell.
    pub(crate) outline: &'a Outline,
    /// Camber of the outer profile, along which stations are counted.
    pub(crate) camber: &'a Camber,
    /// Camber fraction of the wall.
    pub(crate) position: f64,
    /// Mid line of the wall: a point of the camber and the unit direction towards the suction side.
    pub(crate) wall: [DVec2; 2],
    /// Rings of the front and the back chamber.
    pub(crate) rings: [ChamberRing; 2],
}

/// Names of the eight segments.
pub(crate) const PARTS: [&str; SEGMENTS] = [
    "suction_side",
    "inner/fillet_suction_side",
    "inner",
    "inner/fillet_pressure_side",
    "pressure_side",
    "outer/fillet_pressure_side",
    "outer",
    "outer/fillet_suction_side",
];

/// Segment of the back chamber's ring that continues segment `k` of the front chamber's; it runs the other way.
pub(crate) fn mirrored(k: usize) -> usize {
    (SEGMENTS - k) % SEGMENTS
}
