//! What can stop an export.

use std::fmt;
use std::io;

/// Why an export was not written.
#[derive(Debug)]
#[non_exhaustive]
pub enum ExportError {
    /// The writer or the file system failed.
    Io(io::Error),
    /// A solid was asked for that the model does not have.
    UnknownSolid {
        /// Name asked for.
        name: String,
        /// Names the model has.
        known: Vec<String>,
    },
    /// There is no solid to write.
    NoSolid,
    /// A solid, shell, face or loop that cannot be exported as it stands.
    BadTopology {
        /// Name of the face or solid.
        at: String,
        /// What is wrong with it.
        what: &'static str,
    },
    /// A tolerance that is not a positive number.
    BadOption {
        /// The option.
        name: &'static str,
        /// The value given.
        value: f64,
    },
    /// A face whose border crosses itself in the face's parameters, so that it has no triangulation.
    Untriangulable {
        /// Name of the face.
        face: String,
    },
    /// A mesh or file too large for its format's counters.
    TooLarge {
        /// What overflows.
        what: &'static str,
    },
    /// It was told to stop.
    Stopped,
}

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(e) => write!(f, "{e}"),
            Self::UnknownSolid { name, known } => {
                write!(f, "there is no solid `{name}`; the model has: {}", known.join(", "))
            }
            Self::NoSolid => write!(f, "the model has no solid to export"),
            Self::BadTopology { at, what } => write!(f, "`{at}`: {what}"),
            Self::BadOption { name, value } => write!(f, "{name} is {value}, it must be a positive number"),
            Self::Untriangulable { face } => {
                write!(f, "face `{face}`: its border crosses itself in the parameters of its surface")
            }
            Self::Stopped => write!(f, "it was told to stop"),
            Self::TooLarge { what } => write!(f, "{what} do not fit the format's counters"),
        }
    }
}

impl std::error::Error for ExportError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io(e) => Some(e),
            _ => None,
        }
    }
}

impl From<io::Error> for ExportError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}
