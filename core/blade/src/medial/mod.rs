//! Medial design of blades: a medial surface from hydraulic parameters, and a profile put on both sides of it.
//!
//! M. Rossgatterer, B. Juettler, M. Kapl, G. Della Vecchia, "Medial design of blades for hydroelectric turbines and ship
//! propellers", Computers & Graphics 36 (2012). Equation and proposition numbers here are that paper's. Two things run
//! the other way than there, as everywhere in this crate: v = 0 is the hub and v = 1 the shroud, and the machine axis is
//! x. The paper's chart (mu, phi) is the chart (M, T) of a stream surface over its reference radius.
//!
//! The way: [`Trace`]s part the streamlines of the stream space into what lies before, in and behind the blade;
//! [`Streamline`]s are drawn in the charts; [`MedialSurface`] is a B-spline near all of them with normals; the
//! [`Pace`] u(t) makes its parameter run as the [`Profile`] does; [`Sides`] are the two sides as functions; [`Skin`]
//! is one B-spline surface near both, fitted to them or made of their [`Composition`].

mod composition;
mod cut_out;
mod deviation;
mod extended;
mod knots;
mod medial_surface;
mod nearest;
mod pace;
mod profile;
mod sides;
mod skin;
mod streamline;
mod trace;

#[cfg(test)]
mod tests;

pub(crate) use composition::Composition;
pub(crate) use cut_out::{CutOut, PointedSides};
pub(crate) use extended::{Continued, extended};
pub(crate) use medial_surface::{MedialSurface, Streamlines, unit_normal};
pub(crate) use pace::Pace;
pub(crate) use profile::{Profile, ProfileFlaw};
pub(crate) use sides::{Side, Sides, Tip, TwoSided};
pub(crate) use skin::{Skin, SkinSize};
pub(crate) use streamline::{Angles, Streamline};
pub(crate) use trace::{Trace, TraceFlaw};
