//! From plan to B-rep: sections, lofts, caps, solids.

mod annulus;
mod assemble;
mod bitangent;
mod blank;
mod bridge;
mod cap;
mod chambers;
mod clearance;
mod error;
mod film;
mod nodes;
mod passages;
mod pointed;
mod probe;
mod radial_holes;
mod row;
mod sections;
mod shell;
mod sides;
mod slots;
mod spans;
mod stack;
mod style;
mod tube;
mod turns;

pub use assemble::{CooledBlade, build};
pub use error::BuildError;
pub use film::FilmHoleGeometry;
pub use passages::{PassagePart, PassageParts};
pub(crate) use probe::Probe;
pub use radial_holes::RadialHoleGeometry;
pub use row::add_row;
pub use slots::SlotGeometry;
