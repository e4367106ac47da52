//! Round passages from hub to tip.

use coolinggen_blade::LawSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A round passage, straight from hub to tip (NASA C3X).
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadialHole {
    /// Name, unique among the radial holes.
    #[schemars(regex(pattern = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$"))]
    pub name: String,
    /// Diameter normal to the axis, mm.
    #[schemars(extend("unit" = "mm", "minimum" = 0.01, "maximum" = 1000.0))]
    pub diameter: LawSpec,
    /// Where the axis meets hub and tip.
    pub at: HolePlacement,
}

/// Where the axis of a radial hole meets a stream surface; laws are taken at the hub and at the tip.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "frame", rename_all = "snake_case", deny_unknown_fields)]
pub enum HolePlacement {
    /// On the camber line of the outer profile, shifted across it.
    Camber {
        /// Fraction of the camber line's length from the leading edge.
        #[schemars(extend("unit" = "camber fraction", "minimum" = 0.0, "maximum" = 1.0))]
        position: LawSpec,
        /// Shift normal to the camber line, towards the suction side, mm.
        #[serde(default = "zero")]
        #[schemars(extend("unit" = "mm", "minimum" = -1000.0, "maximum" = 1000.0))]
        offset: LawSpec,
    },
    /// At stream-space coordinates; in a linear cascade m is x and t is y.
    Stream {
        /// Meridional arc length from the start of the contour, mm.
        #[schemars(extend("unit" = "mm", "minimum" = -100_000.0, "maximum" = 100_000.0))]
        m: LawSpec,
        /// r * theta, mm.
        #[schemars(extend("unit" = "mm", "minimum" = -100_000.0, "maximum" = 100_000.0))]
        t: LawSpec,
    },
    /// In the frame of the profile's pressure-side bitangent, as in NASA CR-168015: V runs along the straight edge laid
    /// on the pressure side, from the leading-edge extreme; U is normal to it, positive towards the suction side.
    Bitangent {
        /// Distance from the bitangent, mm.
        #[schemars(extend("unit" = "mm", "minimum" = -10_000.0, "maximum" = 10_000.0))]
        u: LawSpec,
        /// Distance along the bitangent from the leading-edge extreme, mm.
        #[schemars(extend("unit" = "mm", "minimum" = -10_000.0, "maximum" = 10_000.0))]
        v: LawSpec,
        /// Point `[M, T]` of the chart (in a linear cascade: `[x, y]`, mm) from which V is measured, instead of the
        /// profile's foremost point along the bitangent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        from: Option<[f64; 2]>,
    },
}

fn zero() -> LawSpec {
    LawSpec::Constant(0.0)
}
