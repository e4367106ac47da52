//! One section of the cooled blade: all work in the chart `(M, T)` of one stream surface (thesis 4.1).
//!
//! A section is the outer profile less its trailing edge, run through from the pressure side over the leading edge
//! to the suction side; its offset by the shell thickness; the camber of both; and the chambers, each a ring of
//! eight segments in a fixed order, so that segment k of all sections lofts to one face.

mod camber;
mod chamber;
mod closure;
mod march;
mod outline;
mod refusal;
mod segment;
#[cfg(test)]
mod tests;

pub use camber::{Camber, Contact};
pub use chamber::{ChamberRing, ClosureKind, RingRequest, SEGMENTS, WallRequest, chamber_ring};
pub(crate) use march::circle_of_radius;
pub use outline::{Frame, Outline};
pub use refusal::Refusal;
pub use segment::Segment;
pub(crate) use segment::angle_between;
