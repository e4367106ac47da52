//! From plan to B-rep: sections, lofts, caps, solids.

mod assemble;
mod bitangent;
mod cap;
mod chambers;
mod clearance;
mod error;
mod passages;
mod pointed;
mod probe;
mod radial_holes;
mod sections;
mod shell;
mod style;
mod tube;

pub use assemble::{CooledBlade, build};
pub use error::BuildError;
pub(crate) use probe::Probe;
pub use radial_holes::RadialHoleGeometry;
