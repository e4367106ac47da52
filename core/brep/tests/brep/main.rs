//! The boundary representation from outside: solids with known volumes, and solids with known faults.

mod bounds;
mod build;
mod check;
mod domain;
mod mass;
mod mass_small;
mod mass_trimmed;
mod mutations;
mod solids;
