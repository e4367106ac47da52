//! What designs say of profiles, trailing edges and skins.

use crate::fault::{Fault, Pointer};
use crate::law::LawSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A profile curve p(t) = (x(t), y(t)): x is the part of the streamline's length from the leading edge, y the distance
/// from the medial surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ProfileSpec {
    /// A Bezier curve of degree 2 to 9 that begins with `[0, 0]`, `[0, y]` and ends with `[1, y]`.
    Bezier {
        /// Control points `[x, y]`; x grows, y is positive in between.
        control_points: Vec<[f64; 2]>,
    },
    /// The thickness of the NACA four-digit sections, y = 0.5 at its greatest.
    #[serde(rename = "naca_4_digit")]
    Naca4Digit {
        /// Whether it is closed at the tail, else y = 0.0105 there.
        #[serde(default)]
        closed: bool,
    },
}

impl Default for ProfileSpec {
    fn default() -> Self {
        Self::Naca4Digit { closed: false }
    }
}

/// What differs on one side.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SideSpec {
    /// Its profile.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub profile: Option<ProfileSpec>,
    /// Its scale, mm, positive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "mm", "exclusiveMinimum" = 0.0))]
    pub thickness: Option<LawSpec>,
}

/// How the two sides are joined at the trailing edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ClosingSpec {
    /// In a line; the profile must end with y = 0.
    Sharp,
    /// By a straight strip; the profile must end with y > 0.
    Blunt,
    /// By a round nose tangent to both sides, behind the trace; the profile must end with y > 0.
    Rounded,
}

/// The B-spline surface of both sides, from trailing edge to trailing edge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SkinSpec {
    /// How the surface is made.
    #[serde(default)]
    pub method: SkinMethod,
    /// Degrees around the blade and along it, 2 to 9.
    #[serde(default = "cubic")]
    pub degree: [usize; 2],
    /// Control points around the blade and along it; as many as `tolerance` takes if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub control_points: Option<[usize; 2]>,
    /// Where the knots are put if `control_points` are given.
    #[serde(default)]
    pub knots: KnotsSpec,
    /// Greatest distance from the sides, mm, 1e-5 to 1, if `control_points` are not given.
    #[serde(default = "close")]
    #[schemars(extend("unit" = "mm", "minimum" = 1e-05, "maximum" = 1.0))]
    pub tolerance: f64,
}

fn cubic() -> [usize; 2] {
    [3, 3]
}

fn close() -> f64 {
    0.001
}

impl Default for SkinSpec {
    fn default() -> Self {
        Self {
            method: SkinMethod::default(),
            degree: cubic(),
            control_points: None,
            knots: KnotsSpec::default(),
            tolerance: close(),
        }
    }
}

/// How a skin is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SkinMethod {
    /// Fitted to points of the sides: `control_points`, or as many as `tolerance` takes.
    #[default]
    Fitted,
    /// Composed: the sides as one B-spline exactly, its degree reduced and knots removed within `tolerance`, which is
    /// proved for every point. For turbine blades.
    Composed,
}

/// Where knots are put.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum KnotsSpec {
    /// Evenly.
    Uniform,
    /// Where they leave the least distance.
    #[default]
    Optimised,
}

impl SkinSpec {
    /// Faults of it, with pointers below `/skin`; `composes` says whether sides of the source can be composed.
    pub(super) fn check(&self, composes: bool, faults: &mut Vec<Fault>) {
        let at = Pointer::root().at("skin");
        if self.method == SkinMethod::Composed {
            if !composes {
                faults.push(not_composed());
            }
            if self.control_points.is_some() {
                let message = "a composed skin has as many control points as its tolerance takes";
                let fault = Fault::new(at.at("control_points"), "excludes", message);
                faults.push(fault.hint("leave `control_points` out, or let the skin be fitted"));
            }
        }
        let mut range = |key: &str, index: usize, value: usize, min: usize, max: usize| {
            if !(min..=max).contains(&value) {
                let message = format!("must lie between {min} and {max}, but is {value}");
                let pointer = at.at(key).at(index);
                faults.push(
                    Fault::new(pointer, "out_of_range", message).value(value).min(min as f64).max(max as f64),
                );
            }
        };
        for i in [0, 1] {
            range("degree", i, self.degree[i], 2, 9);
            if let Some(counts) = self.control_points {
                range("control_points", i, counts[i], [2 * self.degree[0] + 2, self.degree[1] + 1][i], 400);
            }
        }
        if !(1e-5..=1.0).contains(&self.tolerance) {
            let message = format!("the tolerance must lie between 1e-5 and 1 mm, but is {}", self.tolerance);
            let fault = Fault::new(at.at("tolerance"), "out_of_range", message);
            faults.push(fault.value(self.tolerance).min(1e-5).max(1.0).unit("mm"));
        }
    }
}

/// Sides that are no composition of B-splines of moderate degree cannot be composed.
pub(super) fn not_composed() -> Fault {
    let message = "only sides of turbine blades can be composed: a propeller's medial surface is itself a composition of \
                   two surfaces, of a degree that no reader takes";
    Fault::new(Pointer::root().at("skin").at("method"), "no_composition", message)
        .value("composed")
        .hint("fitted")
}
