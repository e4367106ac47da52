//! Blades made with the medial method: what designs say of them.

mod closing;
mod read;
mod turbine;

pub use turbine::{ClosingSpec, KnotsSpec, ProfileSpec, SideSpec, SkinSpec, TurbineSource};
