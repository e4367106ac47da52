//! Faults of a design: what is wrong where, and what would be right.

use serde::Serialize;
use serde_json::Value;
use std::fmt;

/// One thing that is wrong with a design. A check collects all it finds before it refuses.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fault {
    /// JSON pointer (RFC 6901) to the parameter, e.g. `/blade/sections/3/suction_side/17`.
    pub pointer: String,
    /// A word for programs, e.g. `out_of_range`, `self_crossing`, `duplicate_point`; it does not change between
    /// releases.
    pub code: &'static str,
    /// The value found, if it is short enough to print.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<Value>,
    /// Least value allowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Greatest value allowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// Unit of value and limits: `mm`, `deg`, or empty.
    #[serde(skip_serializing_if = "str::is_empty")]
    pub unit: &'static str,
    /// What is wrong, in one sentence with the numbers.
    pub message: String,
    /// What to do about it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hint: Option<String>,
}

impl Fault {
    /// A fault at `pointer`.
    pub fn new(pointer: impl Into<String>, code: &'static str, message: impl Into<String>) -> Self {
        Self {
            pointer: pointer.into(),
            code,
            value: None,
            min: None,
            max: None,
            unit: "",
            message: message.into(),
            hint: None,
        }
    }

    /// Adds the value found.
    #[must_use]
    pub fn value(mut self, value: impl Into<Value>) -> Self {
        self.value = Some(value.into());
        self
    }

    /// Adds the least value allowed.
    #[must_use]
    pub fn min(mut self, min: f64) -> Self {
        self.min = Some(min);
        self
    }

    /// Adds the greatest value allowed.
    #[must_use]
    pub fn max(mut self, max: f64) -> Self {
        self.max = Some(max);
        self
    }

    /// Adds the unit of value and limits.
    #[must_use]
    pub fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    /// Adds what to do about it.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// The same fault with `prefix`, itself a JSON pointer, before its pointer.
    #[must_use]
    pub fn under(mut self, prefix: &str) -> Self {
        self.pointer.insert_str(0, prefix);
        self
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", if self.pointer.is_empty() { "/" } else { &self.pointer }, self.message)?;
        if let Some(hint) = &self.hint {
            write!(f, " ({hint})")?;
        }
        Ok(())
    }
}

/// A JSON pointer that grows while a check descends.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Pointer(String);

impl Pointer {
    /// The pointer to the whole.
    pub fn root() -> Self {
        Self::default()
    }

    /// The pointer to `key` (a field's name or an index) below this one.
    #[must_use]
    pub fn at(&self, key: impl fmt::Display) -> Self {
        let key = key.to_string().replace('~', "~0").replace('/', "~1");
        Self(format!("{}/{key}", self.0))
    }
}

impl From<Pointer> for String {
    fn from(pointer: Pointer) -> Self {
        pointer.0
    }
}

impl fmt::Display for Pointer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}
