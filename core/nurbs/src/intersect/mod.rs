//! Where curves and surfaces meet.

mod curves;
mod piece;
mod self_intersection;
mod surface_plane;

pub(crate) use curves::crossings as crossings_with;
pub use curves::{Crossing, TOUCH, intersect_curves, intersect_parametric};
pub(crate) use piece::Source;
pub(crate) use self_intersection::own_crossings;
pub use self_intersection::{self_intersections, self_intersections_parametric};
pub use surface_plane::{PlaneBranch, PlaneSection, intersect_plane};
