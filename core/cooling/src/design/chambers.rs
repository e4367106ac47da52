//! Chambers, the walls between them and the shell round them.

use coolinggen_blade::LawSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Metal between the outer surface and the chambers.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shell {
    /// Thickness on the suction side, mm, measured in space, normal to the outer surface.
    #[schemars(extend("unit" = "mm", "minimum" = 0.01, "maximum" = 1000.0))]
    pub suction_side: LawSpec,
    /// Thickness on the pressure side, mm, measured in space, normal to the outer surface.
    #[schemars(extend("unit" = "mm", "minimum" = 0.01, "maximum" = 1000.0))]
    pub pressure_side: LawSpec,
    /// Metal between the tip and the chambers and turns that do not give their own span, mm. Without it such chambers
    /// are open at the tip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.01, max = 1000.0), extend("unit" = "mm"))]
    pub tip: Option<f64>,
    /// Metal between the hub and the turns there whose chambers do not give their own span, mm; without it as much as
    /// at the tip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.01, max = 1000.0), extend("unit" = "mm"))]
    pub hub: Option<f64>,
}

/// A wall between two chambers.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// Name, unique among the walls.
    #[schemars(regex(pattern = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$"))]
    pub name: String,
    /// Where the mid line crosses the camber line of the outer profile: fraction of its length from the leading edge.
    #[schemars(extend("unit" = "camber fraction", "minimum" = 0.0, "maximum" = 1.0))]
    pub position: LawSpec,
    /// Angle between the camber line and the wall, degrees; 90 stands across, less leans towards the trailing edge
    /// on the suction side.
    #[serde(default = "right_angle")]
    #[schemars(extend("unit" = "deg", "minimum" = 20.0, "maximum" = 160.0))]
    pub angle_deg: LawSpec,
    /// Thickness, mm, measured in space, normal to the wall.
    #[schemars(extend("unit" = "mm", "minimum" = 0.01, "maximum" = 1000.0))]
    pub thickness: LawSpec,
}

fn right_angle() -> LawSpec {
    LawSpec::Constant(90.0)
}

/// A straight part of a channel.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chamber {
    /// Name, unique among chambers.
    #[schemars(regex(pattern = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,31}$"))]
    pub name: String,
    /// Span fractions at which it begins and ends; 0 is open at the hub, 1 open at the tip. Without it the chamber
    /// runs from the hub to the tip, less the shell's tip thickness. At a turn the straight part ends here and the turn
    /// goes on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "span fraction", "items" = {"type": "number", "minimum": 0.0, "maximum": 1.0}))]
    pub span: Option<[f64; 2]>,
    /// Radius of the fillets at its walls and of its rounded ends, mm. Round the leading edge the leading chamber
    /// follows the shell, unless it would be sharper than half this radius. Where an arc of this radius would end the
    /// trailing chamber only within a blunt trailing edge, the arc is as much greater as ends it before.
    #[schemars(extend("unit" = "mm", "minimum" = 0.01, "maximum" = 1000.0))]
    pub fillet_radius: LawSpec,
}
