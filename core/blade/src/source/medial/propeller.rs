//! Propeller blades from hydraulic parameters.

use super::assembly::{self, Finish, failed};
use super::contour::Contour;
use super::read::{self, Sections};
use super::spec::{ClosingSpec, ProfileSpec, SideSpec, SkinSpec};
use crate::blade::Blade;
use crate::fault::{Fault, Pointer};
use crate::law::{Law, LawSpec};
use crate::medial::{Continued, CutOut, Pace, PointedSides, Profile, Side, extended};
use crate::source::OUTSIDE_CONTOURS;
use crate::stream::{ContourSpec, StreamSpace};
use coolinggen_nurbs::{Knots, NurbsError, ParametricSurface};
use glam::{DVec2, DVec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A propeller blade by the medial method (Rossgatterer, Juettler, Kapl, Della Vecchia 2012, section 4): closed at the tip,
/// where leading and trailing edge meet.
///
/// The design's `space` gives the hub that cuts the blade and the stream surfaces that its streamlines lie on; the tip
/// stands on its shroud or below. Laws run over v in [0, 1], where (1 - v)^2 is the part of the span that is left to the tip:
/// in v the outline of a round tip is smooth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PropellerSource {
    /// Trace of the leading edge in the meridional plane, from the hub to the tip, which it reaches along the streamline
    /// there: points `[x, r]` in mm or a B-spline.
    pub leading_edge: ContourSpec,
    /// Trace of the trailing edge, from the hub to the same tip, which it reaches across the streamline.
    pub trailing_edge: ContourSpec,
    /// Machine angle theta of the leading edge, degrees, -3600 to 3600.
    #[schemars(title = "Theta of the leading edge", extend("unit" = "deg", "minimum" = -3600.0, "maximum" = 3600.0))]
    pub phi0_deg: LawSpec,
    /// Machine angle theta of the trailing edge, degrees; at v = 1 that of the leading edge.
    #[schemars(title = "Theta of the trailing edge", extend("unit" = "deg", "minimum" = -3600.0, "maximum" = 3600.0))]
    pub phi1_deg: LawSpec,
    /// Angle of the streamlines at the leading edge, measured on the stream surface from the circle in the direction
    /// of growing theta, degrees, 2 to 178.
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
    /// Scale of the profile, mm, positive but for v = 1, where it is zero.
    #[schemars(extend("unit" = "mm", "minimum" = 0.0))]
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

#[cfg(test)]
mod tests;

/// A source that has been read.
struct Plan<'a> {
    contour: Contour<'a>,
    sections: Sections,
    /// Station and span fraction of the tip.
    tip: (f64, f64),
}

/// Spans of the extended medial surface and of the cut-out function along the span.
const SPANS: [usize; 3] = [32, 24, 24];
/// How far the extended surface reaches beyond the edges, in parts of their greatest distance.
const BEYOND: f64 = 0.1;
/// Root of the part of the span left at the last streamline that is drawn; the tip's own is its copy, moved to the tip.
const LAST: f64 = 0.05;
/// The residual of Eq. 33 that is good enough.
const PACE: f64 = 1e-4;
/// How far the cut-out function may be from the edges, in parts of the extended streamlines.
const CUT: f64 = 2e-3;

impl PropellerSource {
    /// Makes the blade.
    pub(in crate::source) fn blade(&self, space: &StreamSpace) -> Result<Blade, Vec<Fault>> {
        let plan = self.plan(space)?;
        let medial = plan.cut_out()?;
        let mut notes = vec![format!("cut-out function within {:.1e} of the edges", medial.residual)];
        let closing = plan.sections.closing;
        let (sides, suction) = plan.sides(medial)?;
        notes.push(Side::pace_note(&sides.sides));
        let finish = Finish { skin: &self.skin, closing, suction, nose: None, blamed: "thickness", notes };
        assembly::blade(&sides, finish, space)
    }

    fn plan<'a>(&self, space: &'a StreamSpace) -> Result<Plan<'a>, Vec<Fault>> {
        let StreamSpace::Annular(annular) = space else {
            let message = "a medial propeller blade stands in an annular space, on a hub";
            return Err(vec![Fault::new("/kind", "space", message)]);
        };
        let mut faults = Vec::new();
        let contour = Contour::read(
            [&self.leading_edge, &self.trailing_edge],
            [&self.phi0_deg, &self.phi1_deg, &self.beta0_deg, &self.beta1_deg, &self.zeta0, &self.zeta1],
            annular,
            true,
            &mut faults,
        );
        let sections = read::sections(
            (&self.profile, &self.thickness),
            self.pressure_side.as_ref(),
            self.closing,
            (0.0, 1e4),
            pointed,
            &mut faults,
        );
        self.skin.check(false, &mut faults);
        let tip = contour.as_ref().and_then(|c| tip(c, &mut faults));
        match contour.zip(sections).zip(tip) {
            Some(((contour, sections), tip)) if faults.is_empty() => Ok(Plan { contour, sections, tip }),
            _ => Err(faults),
        }
    }
}

/// Refuses a scale that does not end at the tip.
fn pointed(law: &Law, at: Pointer, faults: &mut Vec<Fault>) {
    let (end, slope) = law.with_slope(1.0 - 1e-9);
    let thin = (0..100).map(|i| f64::from(i) / 100.0).find(|&v| !(law.at(v) > 0.0));
    let message = if law.at(1.0) != 0.0 {
        format!("the thickness must be zero at the tip, v = 1, but is {} mm", law.at(1.0))
    } else if let Some(v) = thin {
        format!("the thickness is {} mm at v = {v}, before the tip", law.at(v))
    } else if !(slope < 0.0 && end > 0.0) {
        "the thickness must fall to zero at the tip with a slope".to_owned()
    } else {
        return;
    };
    faults.push(Fault::new(at, "tip", message).value(law.at(1.0)).unit("mm"));
}

/// Station and span fraction of the point that both edges end in.
fn tip(contour: &Contour<'_>, faults: &mut Vec<Fault>) -> Option<(f64, f64)> {
    let ends = [contour.traces[0].end(), contour.traces[1].end()];
    let gap = ends[0].0.distance(ends[1].0);
    let before = faults.len();
    if !(gap <= 1e-6) {
        let message = format!("leading and trailing edge end {gap:.3e} mm apart, not in one tip");
        faults.push(Fault::new("/trailing_edge", "tip", message).value(gap).max(1e-6).unit("mm"));
    }
    let apart = contour.phi[1].at(1.0) - contour.phi[0].at(1.0);
    if !(apart.abs() <= 1e-9) {
        let message = format!("at the tip, v = 1, phi1_deg is {apart:.3e} more than phi0_deg");
        faults.push(Fault::new("/phi1_deg", "tip", message).value(apart).max(0.0).unit("deg"));
    }
    let (s, v) = contour.space.coordinates(ends[0].0).ok()?;
    let (_, along, _) = contour.space.at(s, v);
    let turned = ends.map(|(_, d)| along.normalize().perp_dot(d.normalize()).abs().asin().to_degrees());
    for (name, off, least, most) in
        [("leading_edge", turned[0], 0.0, 3.0), ("trailing_edge", turned[1], 20.0, 90.0)]
    {
        if !(least..=most).contains(&off) {
            let message = format!(
                "the edge reaches the tip at {off:.1} degrees from the streamline, not {least} to {most}"
            );
            let fault = Fault::new(Pointer::root().at(name), "tip", message).value(off);
            faults.push(fault.min(least).max(most).unit("deg").hint(
                "a round tip: the leading edge runs into it along the streamline, the trailing edge across",
            ));
        }
    }
    (faults.len() == before).then_some((s, v))
}

impl Plan<'_> {
    /// The sides, and which of them is the suction side.
    fn sides(&self, medial: CutOut) -> Result<(PointedSides, usize), Vec<Fault>> {
        let suction = suction_side(&medial);
        let pace = |profile: &Profile| Pace::new(&medial, profile, 3, PACE);
        let sides = Side::both(self.sections.sides.clone(), suction, pace).map_err(failed)?;
        Ok((PointedSides { medial, sides }, suction))
    }

    /// The medial surface: extended, and cut out.
    fn cut_out(&self) -> Result<CutOut, Vec<Fault>> {
        let (tip_station, tip_fraction) = self.tip;
        let space = self.contour.space;
        let station = |edge: usize, v: f64| -> Result<f64, Vec<Fault>> {
            let left = (1.0 - v) * (1.0 - v);
            if left == 0.0 {
                return Ok(tip_station);
            }
            let at = self.contour.traces[edge].station(space, tip_fraction * (1.0 - left));
            at.map_err(|e| vec![Fault::new("", OUTSIDE_CONTOURS, e.to_string())])
        };
        let (mut low, mut high) = (tip_station, tip_station);
        for k in 0..50 {
            let v = f64::from(k) / 50.0;
            let (a, b) = (station(0, v)?, station(1, v)?);
            if !(b > a) {
                let message = format!("the trailing edge does not lie behind the leading edge at v = {v:.2}");
                return Err(vec![Fault::new("/trailing_edge", "order", message)]);
            }
            (low, high) = (low.min(a), high.max(b));
        }
        let margin = BEYOND * (high - low);
        let (low, high) = ((low - margin).max(0.0), (high + margin).min(1.0));
        let knots = |spans: usize, degree: usize| Knots::uniform(degree, spans + degree).map_err(failed);
        let line = |fraction: f64| self.line(fraction, [low, high]).map_err(Trouble);
        let made = extended::<Trouble>(&knots(SPANS[0], 5)?, &knots(SPANS[1], 5)?, line);
        let surface = made.map_err(|t| t.0)?;
        let part = |edge: usize, v: f64| station(edge, v).map_or(f64::NAN, |s| (s - low) / (high - low));
        let cut = CutOut::new(surface, &knots(SPANS[2], 3)?, |v| [part(0, v), part(1, v)]);
        let cut = cut.map_err(failed)?;
        if !(cut.residual <= CUT) {
            let message = format!(
                "the edges are {:.1e} of the streamlines' length off a B-spline that meets in a tip",
                cut.residual
            );
            let fault = Fault::new("/leading_edge", "tip", message).value(cut.residual).max(CUT);
            return Err(vec![fault.hint("smoother edges, or edges that meet in the tip as they should")]);
        }
        Ok(cut)
    }

    /// Points of the streamline at a part of the span, by the part of the stations from the first to the last.
    fn line(&self, part: f64, [low, high]: [f64; 2]) -> Result<Box<dyn Fn(f64) -> DVec3>, Vec<Fault>> {
        let (tip_station, tip_fraction) = self.tip;
        let left = (1.0 - part).max(LAST * LAST);
        let line = self.contour.streamline(tip_fraction * (1.0 - left), 1.0 - left.sqrt())?;
        let mut surface = line.surface().clone();
        let middle = line.chart(0.5)[0];
        let line = Continued::new(line);
        let mut moved = DVec2::ZERO;
        if 1.0 - part < LAST * LAST {
            // The same curve on the tip's stream surface, moved there.
            surface = self
                .contour
                .space
                .surface(tip_fraction)
                .map_err(|e| vec![Fault::new("", OUTSIDE_CONTOURS, e.to_string())])?;
            let m = surface.chart_of_station(tip_station);
            moved = surface.chart_of_angle(m, self.contour.phi[0].at(1.0).to_radians()) - middle;
        }
        Ok(Box::new(move |u| {
            let m = surface.chart_of_station(low + (high - low) * u);
            surface.to_space(DVec2::new(m, line.at(m - moved.x) + moved.y))
        }))
    }
}

/// 0 if the medial surface bends against its normal, else 1.
fn suction_side(medial: &CutOut) -> usize {
    let mut sum = 0.0;
    for (i, j) in (1..=40).flat_map(|i| (0..8).map(move |j| (i, j))) {
        let (u, v) = (f64::from(i) / 40.0, f64::from(j) / 9.0);
        let d = medial.derivatives(u, v);
        sum += d.uu.dot(medial.normal(u, v)) / d.u.length();
    }
    usize::from(sum > 0.0)
}

/// Faults of the design, or of the kernel as such.
struct Trouble(Vec<Fault>);

impl From<NurbsError> for Trouble {
    fn from(error: NurbsError) -> Self {
        Self(failed(error))
    }
}
