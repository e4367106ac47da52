//! Curves and surfaces through or near given points.

mod constraint;
mod function;
mod interpolate;
mod least_squares;
mod smoothing;

pub use constraint::Constraint;
pub use function::fit_function;
pub use interpolate::{Interpolator, closed_slope, interpolate_closed};
pub use least_squares::{ConstraintValue, Fit, LeastSquares, Smoothing};
pub use smoothing::{fit_within, smoothed};
