//! Changes of representation: the same points with other knots, degree or domain.
//!
//! Every method works on the control points of any [`VectorSpace`](crate::VectorSpace), so that the rational forms
//! come for free: their methods edit the homogeneous B-spline and check that its weights stay positive.

mod bezier;
mod compose;
mod elevate;
mod extend;
mod insert;
mod lower;
mod product;
mod reduce;
mod remove;
mod split;

pub use bezier::{BezierCurve, BezierSurface};
