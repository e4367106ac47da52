//! NURBS methods of chapter 2 of the CoolingGen thesis: evaluate, fit, project, march, intersect, offset, fillet.
//!
//! Everything works on the traits [`ParametricCurve`] and [`ParametricSurface`]; nothing here knows of topology.
//! Lengths have whatever unit the control points have. Every iterative method takes its accuracy as an argument
//! or names it, and answers with an error rather than a result that misses it.

mod banded;
mod bernstein;
mod conic;
mod curve;
mod edit;
mod error;
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
pub use fit::{
    Constraint, ConstraintValue, Fit, Interpolator, LeastSquares, Smoothing, closed_slope, fit_function,
    fit_within, interpolate_closed, smoothed,
};
pub use intersect::{
    Crossing, TOUCH, intersect_curves, intersect_parametric, self_intersections,
    self_intersections_parametric,
};
pub use knots::{Basis, Knots, MAX_DEGREE};
pub use offset::{OffsetCurve, OffsetLaw, OffsetPiece, OffsetSpan, trimmed_offset};
pub use query::{
    ArcLength, CERTIFIED, CurveHit, CurveProjection, CurveProjector, Projection, SurfaceHit,
    SurfaceProjector, curvature, march_to_curve, march_to_surface, project_on_curve, project_on_surface,
    ray_meets_curve, ray_meets_surface, signed_curvature,
};
pub use surface::{ParametricSurface, RationalSurface, Surface, SurfaceDerivatives};
pub use vector::{Homogeneous, VectorSpace};
