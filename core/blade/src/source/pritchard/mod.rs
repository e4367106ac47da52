//! Blades from the eleven-parameter turbine section.
//!
//! L. J. Pritchard, "An Eleven Parameter Axial Turbine Airfoil Geometry Model", ASME 85-GT-219 (1985).

mod section;

use super::{OUTSIDE_CONTOURS, assemble};
use crate::blade::{Blade, Region};
use crate::fault::{Fault, Pointer};
use crate::law::{Law, LawSpec};
use crate::loft::{Loft, LoftSection, Sheet};
use crate::section::{ArcSpan, Circle, Outline};
use crate::stream::{StreamSpace, StreamSurface};
use glam::DVec2;
use schemars::JsonSchema;
use section::{Flaw, Parameters, Section};
use serde::{Deserialize, Serialize};

/// Eleven parameters, each but the number of blades a law over the span, and where the section stands. The section is
/// drawn on the cylinder of `radius` and carried to the stream surface with its angles kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PritchardSource {
    /// Radius of the cylinder the section is drawn on, mm; the radius of the stream surface at the blade if not given.
    /// A linear cascade needs it for its pitch, 2 pi radius / blade_count.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "mm", "exclusiveMinimum" = 0.0))]
    pub radius: Option<LawSpec>,
    /// Extent along the axis, mm, positive.
    #[schemars(extend("unit" = "mm", "exclusiveMinimum" = 0.0))]
    pub axial_chord: LawSpec,
    /// Tangential distance of leading and trailing edge (the centres of their circles), mm; may be negative.
    #[schemars(extend("unit" = "mm"))]
    pub tangential_chord: LawSpec,
    /// Turning of the suction side between throat and trailing edge, degrees, 0 to 60.
    #[schemars(extend("unit" = "deg", "minimum" = 0.0, "maximum" = 60.0))]
    pub unguided_turning_deg: LawSpec,
    /// Blade angle at the inlet, from the axis, degrees, between -80 and 80.
    #[schemars(extend("unit" = "deg", "minimum" = -80.0, "maximum" = 80.0))]
    pub inlet_angle_deg: LawSpec,
    /// Half of the wedge angle at the inlet, degrees, 0 to 60.
    #[schemars(extend("unit" = "deg", "minimum" = 0.0, "maximum" = 60.0))]
    pub inlet_half_wedge_deg: LawSpec,
    /// Radius of the leading edge, mm, positive.
    #[schemars(extend("unit" = "mm", "exclusiveMinimum" = 0.0))]
    pub leading_edge_radius: LawSpec,
    /// Blade angle at the exit, from the axis, degrees, between -85 and 85; negative where the blade turns the flow
    /// down from the inlet angle.
    #[schemars(extend("unit" = "deg", "minimum" = -85.0, "maximum" = 85.0))]
    pub exit_angle_deg: LawSpec,
    /// Radius of the trailing edge, mm, positive.
    #[schemars(extend("unit" = "mm", "exclusiveMinimum" = 0.0))]
    pub trailing_edge_radius: LawSpec,
    /// Number of blades around the machine, at least 2.
    pub blade_count: u32,
    /// Width of the throat, mm, positive and less than the pitch.
    #[schemars(extend("unit" = "mm", "exclusiveMinimum" = 0.0))]
    pub throat: LawSpec,
    /// Axial position of the stacking point, mm.
    #[serde(default = "zero")]
    #[schemars(title = "Axial position", extend("unit" = "mm"))]
    pub x: LawSpec,
    /// Tangential position of the stacking point, radius times angle (y in a linear cascade), mm.
    #[serde(default = "zero")]
    #[schemars(title = "Tangential position", extend("unit" = "mm"))]
    pub r_theta: LawSpec,
    /// What stands at (`x`, `r_theta`).
    #[serde(default)]
    pub stacking: Stacking,
    /// Turn the section over: suction side below.
    #[serde(default)]
    pub mirrored: bool,
}

fn zero() -> LawSpec {
    LawSpec::Constant(0.0)
}

/// The point of a section that its position is given for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Stacking {
    /// The foremost point of the leading edge, at the height of its circle's centre.
    #[default]
    LeadingEdge,
    /// The centroid of the section's area.
    Centroid,
    /// The last point of the trailing edge, at the height of its circle's centre.
    TrailingEdge,
}

/// Laws ready to be evaluated.
struct Laws {
    radius: Option<Law>,
    /// As in [`LAWS`].
    rest: Vec<Law>,
}

/// A section and where it stands.
struct Placed {
    surface: StreamSurface,
    drawn: Section,
    /// Chart coordinates of the stacking point.
    origin: DVec2,
    /// The stacking point as drawn.
    stack: DVec2,
    factor: f64,
    /// -1 if turned over.
    flip: f64,
}

impl Placed {
    fn carry(&self, p: DVec2) -> DVec2 {
        let d = (p - self.stack) * self.factor;
        self.origin + DVec2::new(d.x, self.flip * d.y)
    }

    fn carried(&self, points: Vec<DVec2>) -> Vec<DVec2> {
        points.into_iter().map(|p| self.carry(p)).collect()
    }

    fn arc(&self, (circle, ends): (Circle, [f64; 2])) -> ArcSpan {
        let circle = Circle { center: self.carry(circle.center), radius: circle.radius * self.factor };
        ArcSpan { circle, ends: ends.map(|a| self.flip * a) }
    }
}

/// Name, unit and open limits of the laws, in the order in which [`PritchardSource::laws`] lists them.
const LAWS: [(&str, &str, f64, f64); 11] = [
    ("axial_chord", "mm", 0.0, 1e5),
    ("tangential_chord", "mm", -1e5, 1e5),
    ("unguided_turning_deg", "deg", -1e-9, 60.0),
    ("inlet_angle_deg", "deg", -80.0, 80.0),
    ("inlet_half_wedge_deg", "deg", -1e-9, 60.0),
    ("leading_edge_radius", "mm", 0.0, 1e4),
    ("exit_angle_deg", "deg", -85.0, 85.0),
    ("trailing_edge_radius", "mm", 0.0, 1e4),
    ("throat", "mm", 0.0, 1e5),
    ("x", "mm", -1e6, 1e6),
    ("r_theta", "mm", -1e6, 1e6),
];

/// Spans between sections at first and at most; they are doubled until the loft is close enough between them.
const FEWEST: usize = 4;
const MOST: usize = 16;
/// How close, mm.
const CLOSE: f64 = 5e-4;
/// Points a side that its curve is drawn through. Curvature jumps where cubic and arc meet; through points this far
/// apart it passes over smoothly.
const SIDE_POINTS: usize = 90;

impl PritchardSource {
    /// Makes the blade.
    pub(super) fn blade(&self, space: &StreamSpace) -> Result<Blade, Vec<Fault>> {
        let laws = self.laws(space)?;
        let linear = matches!(space, StreamSpace::Linear(_));
        let constant = |l: &Law| l.bounds().0 == l.bounds().1;
        let at = Pointer::root();
        let mut blade = if linear && laws.radius.iter().chain(&laws.rest).all(constant) {
            let only = self.section(&laws, space, 0.5)?;
            let (mut blade, loft) = assemble::lofted(&[only], space, &at)?;
            blade.fit.greatest_distance_mm = self.distance(&blade, &loft, &laws, space, 0.5, 0)?;
            blade
        } else {
            self.lofted(&laws, space, &at)?
        };
        for (v, name) in [(0.0, "hub"), (1.0, "shroud")] {
            let wedge = self.placed(&laws, space, v)?.drawn.exit_half_wedge.to_degrees();
            blade.fit.notes.push(format!("half of the exit wedge angle at the {name}: {wedge:.3} deg"));
        }
        Ok(blade)
    }

    /// The loft of as many sections as it takes to be close between them.
    fn lofted(&self, laws: &Laws, space: &StreamSpace, at: &Pointer) -> Result<Blade, Vec<Fault>> {
        let mut spans = FEWEST;
        loop {
            let v = |k: usize, n: usize| k as f64 / n as f64;
            let mut sections = Vec::new();
            let mut faults = Vec::new();
            for k in 0..=spans {
                match self.section(laws, space, v(k, spans)) {
                    Ok(s) => sections.push(s),
                    Err(mut more) => faults.append(&mut more),
                }
            }
            if !faults.is_empty() {
                faults.dedup_by(|a, b| a.pointer == b.pointer && a.code == b.code);
                return Err(faults);
            }
            let (mut blade, loft) = assemble::lofted(&sections, space, at)?;
            let mut worst: f64 = 0.0;
            for k in 0..spans {
                let between = v(2 * k + 1, 2 * spans);
                worst = worst.max(self.distance(&blade, &loft, laws, space, between, k)?);
            }
            if worst <= CLOSE || spans >= MOST {
                blade.fit.greatest_distance_mm = worst;
                return Ok(blade);
            }
            spans *= 2;
        }
    }

    /// Greatest distance from the blade of points of the exact suction side at `v`, the most curved part; `k` is a
    /// lofted section nearby, for start values.
    fn distance(
        &self,
        blade: &Blade,
        loft: &Loft,
        laws: &Laws,
        space: &StreamSpace,
        v: f64,
        k: usize,
    ) -> Result<f64, Vec<Fault>> {
        let placed = self.placed(laws, space, v)?;
        let exact = placed.carried(placed.drawn.suction(SIDE_POINTS + SIDE_POINTS / 3));
        let total: f64 = exact.windows(2).map(|w| w[0].distance(w[1])).sum();
        let Some([from, to]) = blade.range(Region::SuctionSide) else { return Ok(0.0) };
        let sheet = Sheet::Chart(placed.surface.clone());
        let (mut worst, mut walked): (f64, f64) = (0.0, 0.0);
        let (start, end) = (loft.place(k, from), loft.place(k, to));
        for pair in exact.windows(2) {
            let u = loft.u(k, start + (end - start) * walked / total);
            let found = blade.closest(sheet.point(pair[0]), (u, v));
            worst = worst.max(found.map_or(0.0, |f| f.distance));
            walked += pair[0].distance(pair[1]);
        }
        Ok(worst)
    }

    /// The section at `v` as an outline in the chart of its stream surface.
    fn section(&self, laws: &Laws, space: &StreamSpace, v: f64) -> Result<LoftSection, Vec<Fault>> {
        let placed = self.placed(laws, space, v)?;
        let (leading, trailing) =
            (placed.arc(placed.drawn.leading_arc()), placed.arc(placed.drawn.trailing_arc()));
        let suction = placed.carried(placed.drawn.suction(SIDE_POINTS));
        let pressure = placed.carried(placed.drawn.pressure(SIDE_POINTS));
        let outline = Outline::drawn(&leading, &suction, &trailing, &pressure)
            .map_err(|e| vec![Fault::new("", "no_curve", e.to_string())])?;
        Ok(LoftSection { w: v, sheet: Sheet::Chart(placed.surface), outline })
    }

    /// The section at `v` with its place in the chart of its stream surface.
    fn placed(&self, laws: &Laws, space: &StreamSpace, v: f64) -> Result<Placed, Vec<Fault>> {
        let surface = space.surface(v).map_err(|e| vec![Fault::new("", OUTSIDE_CONTOURS, e.to_string())])?;
        let value = |k: usize| laws.rest[k].at(v);
        let x = value(9);
        let Some(station) = surface.chart_of_axial(x) else {
            let message = format!("the contours do not reach x = {x} mm at span fraction {v:.3}");
            return Err(vec![Fault::new("/x", "out_of_range", message).value(x).unit("mm")]);
        };
        let local = radius_at(&surface, station);
        let radius = laws.radius.as_ref().map_or(local, |law| law.at(v));
        let angle = |k: usize| value(k).to_radians();
        let parameters = Parameters {
            radius,
            axial_chord: value(0),
            tangential_chord: value(1),
            unguided_turning: angle(2).max(0.0),
            inlet_angle: angle(3),
            inlet_half_wedge: angle(4).max(0.0),
            leading_edge_radius: value(5),
            exit_angle: angle(6),
            trailing_edge_radius: value(7),
            blade_count: f64::from(self.blade_count),
            throat: value(8),
        };
        let drawn = Section::new(parameters).map_err(|flaw| vec![explain(flaw, &parameters, v)])?;
        // From the cylinder to the chart: angles are kept, lengths scaled.
        let (factor, origin) = match space {
            StreamSpace::Linear(_) => (1.0, DVec2::new(station, value(10))),
            StreamSpace::Annular(_) => {
                let reference = local / surface.scale(DVec2::new(station, 0.0));
                (reference / radius, surface.chart_of_angle(station, value(10) / local))
            }
        };
        let stack = self.stacking_point(&drawn);
        Ok(Placed { surface, drawn, origin, stack, factor, flip: if self.mirrored { -1.0 } else { 1.0 } })
    }

    fn stacking_point(&self, section: &Section) -> DVec2 {
        let p = &section.parameters;
        match self.stacking {
            Stacking::LeadingEdge => DVec2::new(0.0, p.tangential_chord),
            Stacking::TrailingEdge => DVec2::new(p.axial_chord, 0.0),
            Stacking::Centroid => {
                let mut outline = section.suction(200);
                let (circle, [a, b]) = section.trailing_arc();
                outline.extend((1..40).map(|i| circle.point(a + (b - a) * f64::from(i) / 40.0)));
                outline.extend(section.pressure(200));
                let (circle, [a, b]) = section.leading_arc();
                outline.extend((1..40).map(|i| circle.point(a + (b - a) * f64::from(i) / 40.0)));
                crate::section::centroid(&outline)
            }
        }
    }

    fn laws(&self, space: &StreamSpace) -> Result<Laws, Vec<Fault>> {
        let mut faults = Vec::new();
        let specs = [
            &self.axial_chord,
            &self.tangential_chord,
            &self.unguided_turning_deg,
            &self.inlet_angle_deg,
            &self.inlet_half_wedge_deg,
            &self.leading_edge_radius,
            &self.exit_angle_deg,
            &self.trailing_edge_radius,
            &self.throat,
            &self.x,
            &self.r_theta,
        ];
        let mut read = |spec: &LawSpec, (name, unit, min, max): (&str, &'static str, f64, f64)| {
            let pointer = Pointer::root().at(name);
            let law = spec.law(&pointer).map_err(|mut more| faults.append(&mut more)).ok()?;
            let (least, greatest) = law.bounds();
            for value in [least, greatest] {
                if !(value > min && value < max) {
                    let message = format!("{name} must lie between {min} and {max} {unit}, but is {value}");
                    faults.push(
                        Fault::new(pointer.clone(), "out_of_range", message)
                            .value(value)
                            .min(min)
                            .max(max)
                            .unit(unit),
                    );
                    break;
                }
            }
            Some(law)
        };
        let rest: Vec<Law> = specs.iter().zip(LAWS).filter_map(|(s, limits)| read(s, limits)).collect();
        let radius = self.radius.as_ref().and_then(|s| read(s, ("radius", "mm", 0.0, 1e6)));
        if self.radius.is_none() && matches!(space, StreamSpace::Linear(_)) {
            faults.push(
                Fault::new("/radius", "missing", "a linear cascade needs `radius`, for the pitch").unit("mm"),
            );
        }
        if self.blade_count < 2 {
            faults.push(
                Fault::new("/blade_count", "out_of_range", "there must be at least 2 blades")
                    .value(self.blade_count)
                    .min(2.0),
            );
        }
        if faults.is_empty() { Ok(Laws { radius, rest }) } else { Err(faults) }
    }
}

fn radius_at(surface: &StreamSurface, station: f64) -> f64 {
    let p = surface.to_space(DVec2::new(station, 0.0));
    p.y.hypot(p.z)
}

fn explain(flaw: Flaw, p: &Parameters, v: f64) -> Fault {
    match flaw {
        Flaw::Throat { pitch } => {
            let most = pitch - p.trailing_edge_radius;
            let message = format!(
                "the throat of {:.4} mm does not fit the pitch of {pitch:.4} mm at span fraction {v:.3}",
                p.throat
            );
            Fault::new("/throat", "out_of_range", message).value(p.throat).max(most).unit("mm")
        }
        Flaw::NoWedge => {
            let message = format!(
                "no exit wedge angle lets the suction side reach the throat of {:.4} mm at span fraction {v:.3}",
                p.throat
            );
            Fault::new("/throat", "no_section", message).value(p.throat).unit("mm").hint(
                "the throat of an uncambered exit is about the pitch times the cosine of the exit angle",
            )
        }
        Flaw::Folded => {
            let message = format!("the edges overlap within the axial chord at span fraction {v:.3}");
            Fault::new("/axial_chord", "no_section", message).value(p.axial_chord).unit("mm")
        }
        Flaw::Crossing => {
            let message = format!("suction and pressure side cross at span fraction {v:.3}");
            Fault::new("/inlet_half_wedge_deg", "self_crossing", message)
                .value(p.inlet_half_wedge.to_degrees())
                .unit("deg")
                .hint("more wedge at the inlet, larger edges, or less difference of the blade angles")
        }
    }
}
