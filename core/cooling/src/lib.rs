//! From a design to named solids: the schema, the plan, chambers, radial holes, metal and coolant.
//!
//! [`design::Design::from_json`] reads a document and finds all its faults, [`generate`] builds it. Nothing here
//! knows of files other than those the design names.

mod bore;
pub mod build;
pub mod design;
mod generate;
mod groups;
pub mod plan;
pub mod report;
pub mod section;
mod turn;
mod watch;

pub use generate::{Generated, Made, Stopped, Warm, generate};
pub use watch::{Stage, Unwatched, Watch};
