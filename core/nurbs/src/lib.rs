//! NURBS methods of chapter 2 of the CoolingGen thesis: evaluate, fit, project, march, intersect, offset, fillet.
//!
//! Everything works on the traits [`ParametricCurve`] and [`ParametricSurface`]; nothing here knows of topology.
//! Methods that guarantee to miss nothing ask for [`BezierCurve`] or [`BezierSurface`]: pieces inside the convex hulls of
//! their control points. Lengths have whatever unit the control points have. Every iterative method takes its accuracy
//! as an argument or names it, and answers with an error rather than a result that misses it. Evaluation does not
//! allocate; bad input is an error, not a panic.
//!
//! # Map
//!
//! - `vector`, `knots`, `curve`, `surface`: what everything is made of; [`Homogeneous`] makes the rational forms.
//! - `edit`: the same points with other knots, degree or domain, products and compositions. Insert, split, extend, remove,
//!   elevate, reduce, multiply, compose, cut into Bezier pieces.
//! - `fit`: curves and surfaces through or near points. Interpolation, least squares with constraints, smoothing,
//!   splines for functions.
//! - `query`: closest points (from a start value, and proved), arc length, curvature, hits of rays.
//! - `intersect`: plane curves with each other and themselves, surfaces with planes.
//! - `offset`, `fillet`, `conic`: curves made from curves.
//! - `bernstein`, `quadrature`, `banded`: the arithmetic below.

mod banded;
mod bernstein;
mod conic;
mod curve;
mod edit;
mod error;
mod fillet;
mod fit;
mod intersect;
mod knots;
mod offset;
mod quadrature;
mod query;
mod surface;
mod vector;

pub use banded::BandedLu;
pub use curve::{Curve, ParametricCurve, RationalCurve};
pub use edit::{BezierCurve, BezierSurface};
pub use error::NurbsError;
pub use fillet::{Fillet, corner_fillet, fillets};
pub use fit::{
    Constraint, ConstraintValue, Fit, Interpolator, LeastSquares, Smoothing, closed_slope, fit_function,
    fit_within, interpolate_closed, smoothed,
};
pub use intersect::{
    Crossing, PlaneBranch, PlaneSection, TOUCH, intersect_curves, intersect_parametric, intersect_plane,
    self_intersections, self_intersections_parametric,
};
pub use knots::{Basis, Knots, MAX_DEGREE};
pub use offset::{OffsetCurve, OffsetLaw, OffsetPiece, OffsetSpan, trimmed_offset};
pub use query::{
    ArcLength, CERTIFIED, CurveHit, CurveProjection, CurveProjector, LineHit, Projection, SurfaceHit,
    SurfaceProjector, curvature, line_meets, line_meets_surface, march_to_curve, march_to_surface,
    project_on_curve, project_on_surface, ray_meets_curve, ray_meets_surface, signed_curvature,
};
pub use surface::{ParametricSurface, RationalSurface, Surface, SurfaceDerivatives};
pub use vector::{Homogeneous, VectorSpace};
