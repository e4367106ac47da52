//! Blades made with the medial method: what designs say of them.

mod assembly;
mod closing;
mod contour;
mod propeller;
mod read;
mod spec;
mod table;
mod turbine;

pub use propeller::PropellerSource;
pub use spec::{ClosingSpec, KnotsSpec, ProfileSpec, SideSpec, SkinMethod, SkinSpec};
pub use table::{Hand, MeanLine, PropellerRow, PropellerTableSource, ThicknessForm};
pub use turbine::TurbineSource;
