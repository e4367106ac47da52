//! Closed section curves: from lists of points to smooth outlines with named parts.

mod builder;
mod chain;
mod circle;
mod joint;
mod noses;
mod order;
mod outline;
mod ring;

pub(crate) use circle::Circle;
pub(crate) use noses::{CORNER, Nose, farthest_from, farthest_pair, find as find_noses};
pub(crate) use order::recover;
pub(crate) use outline::{ArcSpan, Outline, Piece};
pub(crate) use ring::{Ring, centroid, crossings};
