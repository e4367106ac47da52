//! Turbine blades from hydraulic parameters.

mod plan;

use super::assembly::{self, Finish};
use super::read;
use super::spec::{ClosingSpec, ProfileSpec, SideSpec, SkinSpec};
use crate::blade::Blade;
use crate::fault::{Fault, Pointer};
use crate::law::{Law, LawSpec};
use crate::medial::{Profile, Trace, TraceFlaw};
use crate::source::OUTSIDE_CONTOURS;
use crate::stream::{Annular, ContourSpec, StreamSpace};
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
    pub phi0_deg: LawSpec,
    /// Machine angle theta of the trailing edge, degrees, -3600 to 3600.
    pub phi1_deg: LawSpec,
    /// Angle of the streamlines at the leading edge, measured on the stream surface from the circle in the direction
    /// of growing theta, degrees, 2 to 178; over 90 the streamline runs against theta.
    pub beta0_deg: LawSpec,
    /// The same at the trailing edge.
    pub beta1_deg: LawSpec,
    /// How long the direction at the leading edge is kept: length of the first leg of the control polygon over the
    /// distance of its ends (in the conformal chart), 0.02 to 1.
    #[serde(default = "third")]
    pub zeta0: LawSpec,
    /// The same at the trailing edge.
    #[serde(default = "third")]
    pub zeta1: LawSpec,
    /// Thickness along the streamlines.
    #[serde(default)]
    pub profile: ProfileSpec,
    /// Scale of the profile, mm, positive: each side stands `thickness` times the profile's y off the medial surface.
    /// For profiles that reach y = 0.5 it is the greatest thickness of the blade.
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
    space: &'a Annular,
    traces: [Trace; 2],
    phi: [Law; 2],
    beta: [Law; 2],
    zeta: [Law; 2],
    /// Profile and scale of suction and pressure side.
    sides: [(Profile, Law); 2],
    closing: ClosingSpec,
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
            format!("pace along the profile within {:.1e} of its mean", sides.sides[0].pace.residual),
        ];
        let finish = Finish { skin: &self.skin, closing: plan.closing, suction, nose, notes };
        assembly::blade(&sides, finish, space)
    }

    fn plan<'a>(&self, space: &'a StreamSpace) -> Result<Plan<'a>, Vec<Fault>> {
        let StreamSpace::Annular(annular) = space else {
            let message = "a medial turbine blade stands in an annular space, between a hub and a shroud";
            return Err(vec![Fault::new("/kind", "space", message)]);
        };
        let mut faults = Vec::new();
        let leading = trace(&self.leading_edge, "leading_edge", annular, &mut faults);
        let trailing = trace(&self.trailing_edge, "trailing_edge", annular, &mut faults);
        let turn = (-3600.0, 3600.0);
        let mut law = |spec, name, limits, unit| read::law(spec, name, limits, unit, &mut faults);
        let phi =
            [law(&self.phi0_deg, "phi0_deg", turn, "deg"), law(&self.phi1_deg, "phi1_deg", turn, "deg")];
        let angle = (2.0, 178.0);
        let beta = [
            law(&self.beta0_deg, "beta0_deg", angle, "deg"),
            law(&self.beta1_deg, "beta1_deg", angle, "deg"),
        ];
        let part = (0.02, 1.0);
        let zeta = [law(&self.zeta0, "zeta0", part, ""), law(&self.zeta1, "zeta1", part, "")];
        let thick = (1e-3, 1e4);
        let thickness = law(&self.thickness, "thickness", thick, "mm");
        let other = self.pressure_side.clone().unwrap_or_default();
        let other_thickness =
            other.thickness.as_ref().map(|spec| law(spec, "pressure_side/thickness", thick, "mm"));
        let profile = read::profile(&self.profile, &Pointer::root().at("profile"), &mut faults);
        let at = Pointer::root().at("pressure_side").at("profile");
        let other_profile = other.profile.as_ref().map(|spec| read::profile(spec, &at, &mut faults));
        self.skin.check(&mut faults);
        if let (Some(a), Some(b)) = (&leading, &trailing) {
            in_order(a, b, annular, &mut faults);
        }
        let closing = profile.as_ref().map(|p| {
            let other = other_profile.as_ref().and_then(Option::as_ref).unwrap_or(p);
            read::closing(self.closing, [p.tail(), other.tail()], &mut faults)
        });
        if !faults.is_empty() {
            return Err(faults);
        }
        let missing = || vec![Fault::new("", "missing", "the source could not be read")];
        let (profile, thickness) = profile.zip(thickness).ok_or_else(missing)?;
        let pressure = (
            other_profile.flatten().unwrap_or_else(|| profile.clone()),
            other_thickness.flatten().unwrap_or_else(|| thickness.clone()),
        );
        let both = |[a, b]: [Option<Law>; 2]| a.zip(b).map(|(a, b)| [a, b]).ok_or_else(missing);
        Ok(Plan {
            space: annular,
            traces: leading.zip(trailing).map(|(a, b)| [a, b]).ok_or_else(missing)?,
            phi: both(phi)?,
            beta: both(beta)?,
            zeta: both(zeta)?,
            sides: [(profile, thickness), pressure],
            closing: closing.ok_or_else(missing)?,
        })
    }
}

fn trace(spec: &ContourSpec, name: &str, space: &Annular, faults: &mut Vec<Fault>) -> Option<Trace> {
    let at = Pointer::root().at(name);
    let curve = spec.curve(&at).map_err(|mut more| faults.append(&mut more)).ok()?;
    let explain = |flaw| match flaw {
        TraceFlaw::Outside(e) => Fault::new(at.clone(), OUTSIDE_CONTOURS, e.to_string()).unit("mm"),
        TraceFlaw::Short { start, end } => {
            let message = format!(
                "the trace runs from span fraction {start:.4} to {end:.4}, not from hub (0) to shroud (1)"
            );
            Fault::new(at.clone(), "short_of_contour", message)
                .hint("its first point lies on the hub, its last on the shroud")
        }
        TraceFlaw::TurnsBack { v } => {
            let message = format!("the trace turns back at span fraction {v:.4}");
            Fault::new(at.clone(), "not_increasing", message).value(v)
        }
    };
    Trace::new(curve, space).map_err(|flaw| faults.push(explain(flaw))).ok()
}

/// Refuses edges that meet or stand in the wrong order.
fn in_order(leading: &Trace, trailing: &Trace, space: &Annular, faults: &mut Vec<Fault>) {
    for k in 0..=20 {
        let v = f64::from(k) / 20.0;
        let (Ok(a), Ok(b)) = (leading.station(space, v), trailing.station(space, v)) else { continue };
        if !(b > a + 1e-3) {
            let message =
                format!("at span fraction {v:.2} the trailing edge does not lie behind the leading edge");
            faults.push(
                Fault::new("/trailing_edge", "order", message).hint("contours and traces run with the flow"),
            );
            return;
        }
    }
}
