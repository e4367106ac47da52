//! Stream space and blade sources.
//!
//! A design says where the flow runs ([`SpaceSpec`]) and what blade stands in it ([`BladeSource`]); [`build`] makes a
//! [`StreamSpace`] and one closed [`Blade`] surface of them, or says everything that is wrong ([`Fault`]). Lengths are
//! millimetres and angles radians here; only the fields of designs are in degrees (their names end in `_deg`).

mod blade;
mod error;
mod fault;
mod law;
mod loft;
mod medial;
mod offset;
mod section;
mod source;
mod stream;
mod surface;

pub use blade::{Blade, FitReport, Region};
pub use error::BladeError;
pub use fault::{Fault, Pointer};
pub use law::{Law, LawSpec};
pub use source::closed::EdgesSpec;
pub use source::medial::{
    ClosingSpec, Hand, KnotsSpec, MeanLine, ProfileSpec, PropellerRow, PropellerSource, PropellerTableSource,
    SideSpec, SkinMethod, SkinSpec, ThicknessForm, TurbineSource,
};
pub use source::pritchard::{PritchardSource, Stacking};
pub use source::sections::{Extreme, SectionSpec, SectionsSource};
pub use source::step::StepSource;
pub use source::surface::SurfaceSource;
pub use source::{BladeSource, build};
pub use stream::{
    Annular, ContourSpec, Linear, SpaceSpec, SplineSpec, StreamSpace, StreamSurface, StreamlineSpec,
};
pub use surface::BladeSurface;
