//! Turbine blades from hydraulic parameters.

mod assembly;

use super::read;
use crate::blade::Blade;
use crate::error::BladeError;
use crate::fault::{Fault, Pointer};
use crate::law::{Law, LawSpec};
use crate::medial::{
    Angles, MedialSurface, Pace, Profile, Side, Sides, Streamline, Streamlines, Trace, TraceFlaw,
};
use crate::source::OUTSIDE_CONTOURS;
use crate::stream::{Annular, ContourSpec, StreamSpace};
use coolinggen_nurbs::{Knots, NurbsError, ParametricSurface};
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
        Self { degree: cubic(), control_points: None, knots: KnotsSpec::default(), tolerance: close() }
    }
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

/// A source that has been read.
struct Plan<'a> {
    source: &'a TurbineSource,
    space: &'a Annular,
    traces: [Trace; 2],
    phi: [Law; 2],
    beta: [Law; 2],
    zeta: [Law; 2],
    /// Profile and scale of suction and pressure side.
    sides: [(Profile, Law); 2],
    closing: ClosingSpec,
}

/// How close the medial surface is brought to its streamlines, in parts of their length, and the spans it is tried
/// with.
const MEDIAL: f64 = 2e-6;
/// How close its directions at the edges are brought to the angles asked, radians.
const ANGLE: f64 = 1e-8;
const SPANS: [[usize; 2]; 3] = [[32, 14], [64, 14], [64, 32]];
/// The residual of Eq. 19 that is good enough.
const PACE: f64 = 1e-5;

impl TurbineSource {
    /// Makes the blade.
    pub(in crate::source) fn blade(&self, space: &StreamSpace) -> Result<Blade, Vec<Fault>> {
        let plan = self.plan(space)?;
        let medial = plan.medial()?;
        let (sides, suction) = plan.sides(medial)?;
        assembly::blade(&plan, &sides, suction, space)
    }

    fn plan<'a>(&'a self, space: &'a StreamSpace) -> Result<Plan<'a>, Vec<Fault>> {
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
            self.closing(p, other, &mut faults)
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
            source: self,
            space: annular,
            traces: leading.zip(trailing).map(|(a, b)| [a, b]).ok_or_else(missing)?,
            phi: both(phi)?,
            beta: both(beta)?,
            zeta: both(zeta)?,
            sides: [(profile, thickness), pressure],
            closing: closing.ok_or_else(missing)?,
        })
    }

    fn closing(&self, suction: &Profile, pressure: &Profile, faults: &mut Vec<Fault>) -> ClosingSpec {
        let tails = [suction.tail(), pressure.tail()];
        let open = tails[0] + tails[1] > 0.0;
        let closing = self.closing.unwrap_or(if open { ClosingSpec::Blunt } else { ClosingSpec::Sharp });
        let message = match (closing, open) {
            (ClosingSpec::Sharp, true) => "a sharp trailing edge needs a profile that ends with y = 0",
            (ClosingSpec::Blunt | ClosingSpec::Rounded, false) => {
                "a blunt or rounded trailing edge needs a profile that ends with y > 0"
            }
            _ => return closing,
        };
        faults.push(Fault::new("/closing", "closing", message).value(tails[0]));
        closing
    }
}

impl SkinSpec {
    fn check(&self, faults: &mut Vec<Fault>) {
        let at = Pointer::root().at("skin");
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

impl Plan<'_> {
    /// The streamline of `v`.
    fn streamline(&self, v: f64) -> Result<Streamline, Vec<Fault>> {
        let outside = |e: BladeError| vec![Fault::new("", OUTSIDE_CONTOURS, e.to_string()).unit("mm")];
        let surface = self.space.surface(v).map_err(outside)?;
        let mut m = [0.0; 2];
        for i in [0, 1] {
            let station = self.traces[i].station(self.space, v).map_err(outside)?;
            m[i] = surface.chart_of_station(station);
        }
        let angles = Angles {
            phi: [0, 1].map(|i| self.phi[i].at(v).to_radians()),
            beta: [0, 1].map(|i| self.beta[i].at(v).to_radians()),
            zeta: [0, 1].map(|i| self.zeta[i].at(v)),
        };
        Streamline::new(surface, m, &angles).map_err(|_| {
            let message = format!(
                "at span fraction {v:.3} the streamline does not run on from the leading to the trailing edge"
            );
            vec![
                Fault::new("/zeta0", "runs_back", message)
                    .value(angles.zeta[0])
                    .hint("smaller zeta0 or zeta1, or angles that fit phi1 - phi0 better"),
            ]
        })
    }

    /// The medial surface, its knots doubled until it is close.
    fn medial(&self) -> Result<MedialSurface, Vec<Fault>> {
        let length = self.streamline(0.5)?.length();
        self.wrapped()?;
        let mut coarse: Option<(usize, Streamlines)> = None;
        for [around, along] in SPANS {
            let streamlines = match coarse.take() {
                Some((spans, lines)) if spans == along => lines,
                _ => Streamlines::new(self.knots_v(along).map_err(failed)?, |v| self.streamline(v))?,
            };
            let knots = Knots::clamped(5, &even(around)).map_err(failed)?;
            let medial = MedialSurface::new(&knots, &streamlines).map_err(failed)?;
            let close = medial.residual <= MEDIAL * length
                && medial.normal_residual <= 1e2 * MEDIAL
                && medial.angle_residual <= ANGLE;
            if close || [around, along] == SPANS[SPANS.len() - 1] {
                return Ok(medial);
            }
            coarse = Some((along, streamlines));
        }
        Err(failed(NurbsError::NotFound { what: "spans for the medial surface" }))
    }

    /// Quintic knots over the span, with room for the kinks in derivatives that laws and traces have at their knots.
    fn knots_v(&self, spans: usize) -> Result<Knots, NurbsError> {
        let laws = [&self.phi, &self.beta, &self.zeta].into_iter().flatten();
        let mut breaks: Vec<f64> = laws.flat_map(Law::breaks).collect();
        breaks.extend(self.traces.iter().flat_map(|t| t.breaks(self.space)));
        breaks.extend([0.0, 1.0]);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
        let mut values = vec![0.0; 6];
        for pair in breaks.windows(2) {
            let parts = (spans as f64 * (pair[1] - pair[0])).ceil().max(1.0) as usize;
            let size = (pair[1] - pair[0]) / parts as f64;
            values.extend((1..parts).map(|k| pair[0] + size * k as f64));
            // Laws, traces and contours are twice differentiable at their knots, directions of contours once.
            values.extend(std::iter::repeat_n(pair[1], if pair[1] < 1.0 { 4 } else { 6 }));
        }
        Knots::new(5, values)
    }

    /// Refuses a blade that goes round the machine.
    fn wrapped(&self) -> Result<(), Vec<Fault>> {
        const MOST: f64 = 300.0;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for law in &self.phi {
            let (a, b) = law.bounds();
            (low, high) = (low.min(a), high.max(b));
        }
        if high - low <= MOST {
            return Ok(());
        }
        let message = format!("the blade covers {:.1} degrees of the machine, {MOST} at most", high - low);
        Err(vec![Fault::new("/phi1_deg", "out_of_range", message).value(high - low).max(MOST).unit("deg")])
    }

    /// The sides, and which of them is the suction side: the one that the medial surface bends away from.
    fn sides(&self, medial: MedialSurface) -> Result<(Sides, usize), Vec<Fault>> {
        let suction = suction_side(&medial);
        let side = |k: usize| -> Result<Side, NurbsError> {
            let (profile, scale) = self.sides[usize::from(k != suction)].clone();
            let pace = Pace::new(&medial.surface, &profile, 3, PACE)?;
            Ok(Side { profile, pace, scale })
        };
        let first = side(0).map_err(failed)?;
        let second = if self.sides[0].0 == self.sides[1].0 {
            let (profile, scale) = self.sides[usize::from(1 != suction)].clone();
            Side { profile, scale, pace: first.pace.clone() }
        } else {
            side(1).map_err(failed)?
        };
        Ok((Sides { medial, sides: [first, second] }, suction))
    }
}

/// 0 if the medial surface bends against its normal, else 1.
fn suction_side(medial: &MedialSurface) -> usize {
    let (around, along) = (40, 8);
    let mut sum = 0.0;
    for j in 0..=along {
        let v = f64::from(j) / f64::from(along);
        for i in 1..=around {
            let u = f64::from(i) / f64::from(around);
            let d = medial.surface.derivatives(u, v);
            // Curvature times arc length.
            sum += d.uu.dot(medial.normals.point(u, v)) / d.u.length();
        }
    }
    usize::from(sum > 0.0)
}

fn even(spans: usize) -> Vec<f64> {
    (0..=spans).map(|k| k as f64 / spans as f64).collect()
}

fn failed(e: NurbsError) -> Vec<Fault> {
    vec![Fault::new("", "no_surface", format!("the parameters make no surface: {e}"))]
}
