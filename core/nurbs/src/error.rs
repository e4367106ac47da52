//! What can go wrong, with the numbers that say why.

use std::fmt;

/// A call that cannot be answered.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum NurbsError {
    /// Degree zero or above what evaluation supports.
    Degree {
        /// The degree given.
        degree: usize,
        /// The greatest degree supported.
        greatest: usize,
    },
    /// Too few knots.
    KnotCount {
        /// Knots given.
        count: usize,
        /// Least number needed.
        least: usize,
    },
    /// Knots that decrease, are not finite, or span nothing.
    KnotOrder {
        /// Index of the offending knot.
        index: usize,
        /// The knot before it.
        before: f64,
        /// The offending knot.
        value: f64,
    },
    /// Control points that do not match the knots, or too few points to fit.
    PointCount {
        /// Points given.
        count: usize,
        /// Points needed.
        expected: usize,
    },
    /// A control point or weight that is not finite, or a weight that is not positive.
    BadPoint {
        /// Index of the offending control point.
        index: usize,
    },
    /// Data parameters that are not increasing, or leave a basis function without data (Schoenberg-Whitney).
    BadParameters {
        /// Index of the offending parameter.
        index: usize,
    },
    /// An iteration ended away from its goal.
    NoConvergence {
        /// What was sought.
        what: &'static str,
        /// What was left, in the unit of the quantity.
        residual: f64,
    },
    /// The thing asked for does not exist.
    NotFound {
        /// What was sought.
        what: &'static str,
    },
    /// A parameter outside the domain.
    OutOfDomain {
        /// The parameter given.
        value: f64,
        /// Start of the domain.
        start: f64,
        /// End of the domain.
        end: f64,
    },
    /// A knot that would occur more often than the degree allows.
    Multiplicity {
        /// The knot.
        knot: f64,
        /// How often it may occur.
        greatest: usize,
    },
    /// Pieces that should meet and do not.
    NotJoined {
        /// Index of the piece that starts elsewhere.
        index: usize,
        /// Distance to the end of the piece before.
        gap: f64,
    },
    /// Curves that should meet in points run together.
    Coincident {
        /// Where that starts, as a parameter of the first curve, as far as it was examined.
        from: f64,
        /// Where it ends, as far as it was examined.
        to: f64,
    },
    /// A number that a method cannot work with: negative, not finite, or of no use.
    BadArgument {
        /// What the number is.
        what: &'static str,
        /// The number given.
        value: f64,
    },
}

impl fmt::Display for NurbsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Degree { degree, greatest } => write!(f, "degree {degree} is outside 1..={greatest}"),
            Self::KnotCount { count, least } => write!(f, "{count} knots given, at least {least} needed"),
            Self::KnotOrder { index, before, value } => {
                write!(
                    f,
                    "knot {index} is {value} after {before}: knots must be finite and must not decrease"
                )
            }
            Self::PointCount { count, expected } => write!(f, "{count} points given, {expected} needed"),
            Self::BadPoint { index } => {
                write!(f, "control point {index} is not finite or has no positive weight")
            }
            Self::BadParameters { index } => {
                write!(f, "parameter {index} is out of order or leaves a basis function without data")
            }
            Self::NoConvergence { what, residual } => write!(f, "{what}: no convergence, {residual:e} left"),
            Self::NotFound { what } => write!(f, "{what}: there is none"),
            Self::OutOfDomain { value, start, end } => {
                write!(f, "parameter {value} is outside [{start}, {end}]")
            }
            Self::Multiplicity { knot, greatest } => {
                write!(f, "knot {knot} would occur more than {greatest} times")
            }
            Self::NotJoined { index, gap } => write!(f, "piece {index} starts {gap:e} off the end before"),
            Self::Coincident { from, to } => write!(f, "the curves run together from {from} to {to}"),
            Self::BadArgument { what, value } => write!(f, "{what} cannot be {value}"),
        }
    }
}

impl std::error::Error for NurbsError {}
