//! Curves at a distance from others.

mod curve;
mod raw;
mod trim;

pub use curve::{OffsetCurve, OffsetLaw};
pub use trim::{OffsetPiece, OffsetSpan, trimmed_offset};
