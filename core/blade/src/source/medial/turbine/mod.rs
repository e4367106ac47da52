//! Turbine blades from hydraulic parameters.

mod plan;

use super::assembly::{self, Finish};
use super::contour::Contour;
use super::read::{self, Sections};
use super::spec::{ClosingSpec, ProfileSpec, SideSpec, SkinSpec};
use crate::blade::Blade;
use crate::fault::Fault;
use crate::law::LawSpec;
use crate::medial::Side;
use crate::stream::{ContourSpec, StreamSpace};
use coolinggen_nurbs::ParametricCurve;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A turbine blade by the medial method (Rossgatterer, Juettler, Kapl, Della Vecchia 2012): streamlines from angles at the
/// edges, a medial surface through them, a profile on both sides of it.
///
/// The meridian contour is made of the design's annular `space`, whose hub and shroud it shares, and the traces of
/// the edges here. The streamlines of the medial surface lie on the stream surfaces of the space, which also cut the
/// blade and carry its cooling. Laws run over the span fraction v, 0 at the hub.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TurbineSource {
    /// Trace of the leading edge in the meridional plane, from hub to shroud: points `[x, r]` in mm or a B-spline.
    pub leading_edge: ContourSpec,
    /// Trace of the trailing edge, from hub to shroud.
    pub trailing_edge: ContourSpec,
    /// Machine angle theta of the leading edge, degrees, -3600 to 3600.
    #[schemars(title = "Theta of the leading edge", extend("unit" = "deg", "minimum" = -3600.0, "maximum" = 3600.0))]
    pub phi0_deg: LawSpec,
    /// Machine angle theta of the trailing edge, degrees, -3600 to 3600.
    #[schemars(title = "Theta of the trailing edge", extend("unit" = "deg", "minimum" = -3600.0, "maximum" = 3600.0))]
    pub phi1_deg: LawSpec,
    /// Angle of the streamlines at the leading edge, measured on the stream surface from the circle in the direction
    /// of growing theta, degrees, 2 to 178; over 90 the streamline runs against theta.
    #[schemars(title = "Angle at the leading edge", extend("unit" = "deg", "minimum" = 2.0, "maximum" = 178.0))]
    pub beta0_deg: LawSpec,
    /// The same at the trailing edge.
    #[schemars(title = "Angle at the trailing edge", extend("unit" = "deg", "minimum" = 2.0, "maximum" = 178.0))]
    pub beta1_deg: LawSpec,
    /// How long the direction at the leading edge is kept: length of the first leg of the control polygon over the
    /// distance of its ends (in the conformal chart), 0.02 to 1.
    #[serde(default = "third")]
    #[schemars(title = "Leg at the leading edge", extend("unit" = "fraction of the chord", "minimum" = 0.02, "maximum" = 1.0))]
    pub zeta0: LawSpec,
    /// The same at the trailing edge.
    #[serde(default = "third")]
    #[schemars(title = "Leg at the trailing edge", extend("unit" = "fraction of the chord", "minimum" = 0.02, "maximum" = 1.0))]
    pub zeta1: LawSpec,
    /// Thickness along the streamlines.
    #[serde(default)]
    pub profile: ProfileSpec,
    /// Scale of the profile, mm, positive: each side stands `thickness` times the profile's y off the medial surface.
    /// For profiles that reach y = 0.5 it is the greatest thickness of the blade.
    #[schemars(extend("unit" = "mm", "exclusiveMinimum" = 0.0))]
    pub thickness: LawSpec,
    /// Another profile or thickness for the pressure side alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure_side: Option<SideSpec>,
    /// How the trailing edge is closed: sharp if the profile ends with y = 0, else blunt, unless said otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub closing: Option<ClosingSpec>,
    /// The B-spline surface of both sides.
    #[serde(default)]
    pub skin: SkinSpec,
}

fn third() -> LawSpec {
    LawSpec::Constant(1.0 / 3.0)
}

/// A source that has been read.
struct Plan<'a> {
    contour: Contour<'a>,
    sections: Sections,
}

impl TurbineSource {
    /// Makes the blade.
    pub(in crate::source) fn blade(&self, space: &StreamSpace) -> Result<Blade, Vec<Fault>> {
        let plan = self.plan(space)?;
        let medial = plan.medial()?;
        let (sides, suction) = plan.sides(medial)?;
        plan::unfolded(&sides)?;
        let middle = sides.medial.surface.iso_v(0.5);
        let at = |i: u32| middle.point(f64::from(i) / 200.0);
        let length: f64 = (0..200).map(|i| at(i).distance(at(i + 1))).sum();
        let nose = [0, 1].map(|k| {
            let side = &sides.sides[k];
            side.profile.nose_end(side.scale.at(0.5) / length)
        });
        let notes = vec![
            format!("medial surface within {:.1e} mm of its streamlines", sides.medial.residual),
            format!(
                "blade angles of the medial surface within {:.1e} deg",
                sides.medial.angle_residual.to_degrees()
            ),
            format!("normals within {:.1e}", sides.medial.normal_residual),
            Side::pace_note(&sides.sides),
        ];
        let finish = Finish {
            skin: &self.skin,
            closing: plan.sections.closing,
            suction,
            nose: Some(nose),
            blamed: "thickness",
            notes,
        };
        assembly::blade(&sides, finish, space)
    }

    fn plan<'a>(&self, space: &'a StreamSpace) -> Result<Plan<'a>, Vec<Fault>> {
        let StreamSpace::Annular(annular) = space else {
            let message = "a medial turbine blade stands in an annular space, between a hub and a shroud";
            return Err(vec![Fault::new("/kind", "space", message)]);
        };
        let mut faults = Vec::new();
        let contour = Contour::read(
            [&self.leading_edge, &self.trailing_edge],
            [&self.phi0_deg, &self.phi1_deg, &self.beta0_deg, &self.beta1_deg, &self.zeta0, &self.zeta1],
            annular,
            false,
            &mut faults,
        );
        let sections = read::sections(
            (&self.profile, &self.thickness),
            self.pressure_side.as_ref(),
            self.closing,
            (1e-3, 1e4),
            |_, _, _| (),
            &mut faults,
        );
        self.skin.check(true, &mut faults);
        match contour.zip(sections) {
            Some((contour, sections)) if faults.is_empty() => Ok(Plan { contour, sections }),
            _ => Err(faults),
        }
    }
}
