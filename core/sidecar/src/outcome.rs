//! How a command ends badly, and what it tells.

use coolinggen_blade::Fault;
use std::fmt;
use std::path::Path;
use std::process::ExitCode;

/// A failure and the form in which to tell it.
pub(crate) struct Failure {
    pub(crate) json: bool,
    pub(crate) kind: FailureKind,
}

/// What went wrong.
pub(crate) enum FailureKind {
    /// The design was refused: exit code 2.
    Refused(Vec<Fault>),
    /// Anything else: exit code 1.
    Other(String),
}

impl Failure {
    pub(crate) fn refused(faults: Vec<Fault>, json: bool) -> Self {
        Self { json, kind: FailureKind::Refused(faults) }
    }

    pub(crate) fn other(message: impl fmt::Display, json: bool) -> Self {
        Self { json, kind: FailureKind::Other(message.to_string()) }
    }

    pub(crate) fn file(what: &str, path: &Path, error: impl fmt::Display, json: bool) -> Self {
        Self::other(format!("cannot {what} {}: {error}", path.display()), json)
    }
}

impl FailureKind {
    pub(crate) fn report_text(self) -> ExitCode {
        match self {
            Self::Refused(faults) => {
                let plural = if faults.len() == 1 { "fault" } else { "faults" };
                eprintln!("the design was refused: {} {plural}", faults.len());
                for fault in &faults {
                    eprintln!("  {}", sentence(fault));
                }
                ExitCode::from(2)
            }
            Self::Other(message) => {
                eprintln!("error: {message}");
                ExitCode::FAILURE
            }
        }
    }

    pub(crate) fn report_json(self) -> ExitCode {
        let (value, code) = match self {
            Self::Refused(faults) => (serde_json::json!({ "faults": faults }), ExitCode::from(2)),
            Self::Other(message) => (serde_json::json!({ "error": message }), ExitCode::FAILURE),
        };
        println!("{value:#}");
        code
    }
}

/// A fault with its value, limits and unit, for people.
fn sentence(fault: &Fault) -> String {
    let mut text = fault.to_string();
    let mut numbers = Vec::new();
    if let Some(value) = &fault.value {
        numbers.push(format!("value {value}"));
    }
    if let Some(min) = fault.min {
        numbers.push(format!("least {min}"));
    }
    if let Some(max) = fault.max {
        numbers.push(format!("greatest {max}"));
    }
    if !numbers.is_empty() {
        let unit = if fault.unit.is_empty() { String::new() } else { format!(" {}", fault.unit) };
        text.push_str(&format!(" [{}{unit}]", numbers.join(", ")));
    }
    text
}
