//! NURBS methods of chapter 2 of the CoolingGen thesis: evaluate, fit, project, march, intersect, offset, fillet.
//!
//! Everything works on the traits [`ParametricCurve`] and [`ParametricSurface`]; nothing here knows of topology.
//! Lengths have whatever unit the control points have. Every iterative method takes its accuracy as an argument
//! or names it, and answers with an error rather than a result that misses it.

mod banded;
mod curve;
mod error;
mod interpolate;
mod knots;
mod surface;
mod vector;

pub use banded::BandedLu;
pub use curve::{Curve, ParametricCurve, RationalCurve};
pub use error::NurbsError;
pub use interpolate::{Interpolator, closed_slope, interpolate_closed};
pub use knots::{Basis, Knots, MAX_DEGREE};
pub use surface::{ParametricSurface, RationalSurface, Surface, SurfaceDerivatives};
pub use vector::{Homogeneous, VectorSpace};
