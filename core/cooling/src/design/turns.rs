//! Turns: the curved parts that join neighbouring chambers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A curved part of a channel, round the end of the wall between two neighbouring chambers.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Turn {
    /// Name, unique among the turns.
    #[schemars(regex(pattern = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$"))]
    pub name: String,
    /// Names of the two chambers, which are neighbours. Where they do not give their own span, their straight parts end
    /// so that the turn leaves the shell's metal below the tip or above the hub.
    pub between: [String; 2],
    /// Where the wall ends.
    pub end: SpanEnd,
    /// Height of the passage beyond the wall's end, mm, measured in space along the wall's mid line; `auto` makes the
    /// flow area there the mean of the two chambers'.
    #[serde(default)]
    #[schemars(extend("unit" = "mm", "minimum" = 0.01, "maximum" = 1000.0))]
    pub clearance: Clearance,
    /// Exponent of the superellipse that the outer side follows: 2 is an ellipse, more comes nearer to a rectangle.
    #[serde(default = "usual_exponent")]
    #[schemars(range(min = 2.0, max = 8.0))]
    pub exponent: f64,
}

/// An end of the span.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpanEnd {
    /// At the tip.
    Tip,
    /// At the hub.
    Hub,
}

impl SpanEnd {
    /// 0 at the hub, 1 at the tip.
    pub fn side(self) -> usize {
        match self {
            Self::Hub => 0,
            Self::Tip => 1,
        }
    }
}

/// A length, or the one that keeps the flow area.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Clearance {
    /// This many millimetres.
    Length(f64),
    /// As the flow area asks.
    Automatic(Automatic),
}

/// The word for a length that follows from others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Automatic {
    /// `auto`.
    Auto,
}

impl Default for Clearance {
    fn default() -> Self {
        Self::Automatic(Automatic::Auto)
    }
}

fn usual_exponent() -> f64 {
    2.5
}
