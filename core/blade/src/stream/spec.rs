//! What a design says about the space: contours, streamlines, or the planes of a linear cascade.

use super::{Annular, Linear, StreamSpace, net};
use crate::fault::{Fault, Pointer};
use coolinggen_nurbs::{Curve, Interpolator, Knots, ParametricCurve, Surface};
use glam::DVec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where the flow runs. Lengths in mm.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum SpaceSpec {
    /// Between a hub and a shroud of revolution about the machine axis x, given as contours `(x, r)` that run with
    /// the flow. Stream surfaces lie on straight lines from hub to shroud at equal parameters (point lists: equal
    /// fractions of their lengths).
    Annular {
        /// Hub contour, span fraction 0.
        hub: ContourSpec,
        /// Shroud (casing, tip) contour, span fraction 1.
        shroud: ContourSpec,
    },
    /// Between hub and shroud of revolution about the machine axis x, given streamline by streamline.
    Streamlines {
        /// Streamlines at increasing span fractions, the first at 0 (hub), the last at 1 (shroud).
        streamlines: Vec<StreamlineSpec>,
    },
    /// A linear cascade: sections in planes of constant z, flow along x.
    Linear {
        /// z of the hub plane, span fraction 0, mm.
        #[serde(default)]
        #[schemars(title = "Hub plane", extend("unit" = "mm"))]
        z0: f64,
        /// Span between hub and shroud plane, mm, positive.
        #[schemars(extend("unit" = "mm", "exclusiveMinimum" = 0.0))]
        height: f64,
    },
}

/// A contour in the meridional plane, run through with the flow.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ContourSpec {
    /// Points `[x, r]` in mm to pass through: two make a straight line, more a smooth curve.
    Points(Vec<[f64; 2]>),
    /// A B-spline.
    Spline(SplineSpec),
}

/// A B-spline contour; it must be smooth (no knot inside repeated `degree` times).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SplineSpec {
    /// Degree, 1 to 9.
    pub degree: usize,
    /// Clamped knots, not decreasing; `points + degree + 1` of them.
    pub knots: Vec<f64>,
    /// Control points `[x, r]`, mm.
    pub points: Vec<[f64; 2]>,
}

/// One streamline of the meridional plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StreamlineSpec {
    /// Span fraction, 0 at the hub, 1 at the shroud.
    #[schemars(title = "Span fraction", extend("unit" = "span fraction", "minimum" = 0.0, "maximum" = 1.0))]
    pub v: f64,
    /// Its contour, points `[x, r]` in mm or a B-spline, run through with the flow.
    pub contour: ContourSpec,
}

const MOST_POINTS: usize = 10_000;
const MOST_STREAMLINES: usize = 200;

impl SpaceSpec {
    /// Checks the space and makes it ready.
    ///
    /// # Errors
    /// Every fault found, with pointers below `pointer`.
    pub fn space(&self, pointer: &Pointer) -> Result<StreamSpace, Vec<Fault>> {
        match self {
            Self::Linear { z0, height } => linear(*z0, *height, pointer),
            Self::Annular { hub, shroud } => {
                let mut faults = Vec::new();
                let hub = collect(hub.curve(&pointer.at("hub")), &mut faults);
                let shroud = collect(shroud.curve(&pointer.at("shroud")), &mut faults);
                let (Some(hub), Some(shroud)) = (hub, shroud) else { return Err(faults) };
                annular(net::transfinite(&hub, &shroud), pointer, &pointer.at("shroud"))
            }
            Self::Streamlines { streamlines } => lofted(streamlines, &pointer.at("streamlines")),
        }
    }
}

fn collect<T>(result: Result<T, Vec<Fault>>, faults: &mut Vec<Fault>) -> Option<T> {
    result.map_err(|mut more| faults.append(&mut more)).ok()
}

fn linear(z0: f64, height: f64, pointer: &Pointer) -> Result<StreamSpace, Vec<Fault>> {
    let mut faults = Vec::new();
    if !z0.is_finite() {
        faults.push(Fault::new(pointer.at("z0"), "not_finite", "z0 is not finite").unit("mm"));
    }
    if !(height > 0.0 && height.is_finite()) {
        let message = format!("the height of a cascade must be positive, here it is {height} mm");
        faults.push(
            Fault::new(pointer.at("height"), "out_of_range", message).value(height).min(0.0).unit("mm"),
        );
    }
    if faults.is_empty() { Ok(StreamSpace::Linear(Linear { z0, height })) } else { Err(faults) }
}

fn lofted(streamlines: &[StreamlineSpec], pointer: &Pointer) -> Result<StreamSpace, Vec<Fault>> {
    if !(2..=MOST_STREAMLINES).contains(&streamlines.len()) {
        let message = format!("{} streamlines given, 2 to {MOST_STREAMLINES} needed", streamlines.len());
        return Err(vec![
            Fault::new(pointer.clone(), "point_count", message)
                .value(streamlines.len())
                .min(2.0)
                .max(MOST_STREAMLINES as f64),
        ]);
    }
    let mut faults = Vec::new();
    for (i, s) in streamlines.iter().enumerate() {
        let wanted = match i {
            0 if s.v != 0.0 => Some("the first streamline is the hub: v = 0".to_owned()),
            i if i + 1 == streamlines.len() && s.v != 1.0 => {
                Some("the last streamline is the shroud: v = 1".to_owned())
            }
            i if i > 0 && !(s.v > streamlines[i - 1].v) => {
                Some(format!("span fractions must increase: {} follows {}", s.v, streamlines[i - 1].v))
            }
            _ => None,
        };
        if let Some(message) = wanted {
            faults.push(Fault::new(pointer.at(i).at("v"), "not_increasing", message).value(s.v));
        }
    }
    let curves: Vec<_> = streamlines
        .iter()
        .enumerate()
        .filter_map(|(i, s)| collect(s.contour.curve(&pointer.at(i).at("contour")), &mut faults))
        .collect();
    if !faults.is_empty() {
        return Err(faults);
    }
    let v: Vec<f64> = streamlines.iter().map(|s| s.v).collect();
    annular(net::lofted(&v, &curves), pointer, pointer)
}

fn annular(
    net: Result<Surface<DVec2>, coolinggen_nurbs::NurbsError>,
    pointer: &Pointer,
    shroud: &Pointer,
) -> Result<StreamSpace, Vec<Fault>> {
    let net = net.map_err(|e| vec![Fault::new(pointer.clone(), "bad_contour", e.to_string())])?;
    let annular = Annular::new(net);
    // Where the machine is mostly axial, the shroud is the outer contour.
    let (start, end) = (annular.at(0.0, 0.5).0, annular.at(1.0, 0.5).0);
    if (end.x - start.x).abs() > (end.y - start.y).abs() {
        let at = |s: f64| (annular.at(s, 0.0).0, annular.at(s, 1.0).0);
        let crossed = (0..=100).map(|i| at(f64::from(i) / 100.0)).find(|(hub, shroud)| !(shroud.y > hub.y));
        if let Some((hub, tip)) = crossed {
            let message = format!(
                "the hub lies above the shroud: hub r = {:.4} mm at x = {:.4} mm, shroud r = {:.4} mm at x = {:.4} mm",
                hub.y, hub.x, tip.y, tip.x
            );
            return Err(vec![
                Fault::new(shroud.clone(), "hub_above_shroud", message).value(tip.y).min(hub.y).unit("mm"),
            ]);
        }
    }
    if let Some((s, v, p)) = annular.flaw() {
        let (code, what) = if p.y > 0.0 {
            ("folded", "the stream surfaces cross")
        } else {
            ("out_of_range", "a stream surface meets the machine axis")
        };
        let message = format!(
            "{what} near x = {:.3} mm, r = {:.3} mm (span fraction {v:.2}, {:.0} % of the way)",
            p.x,
            p.y,
            100.0 * s
        );
        return Err(vec![Fault::new(pointer.clone(), code, message).unit("mm").hint(
            "hub and shroud run the same way, at a distance, and the space is needed 15 % beyond both",
        )]);
    }
    Ok(StreamSpace::Annular(annular))
}

impl ContourSpec {
    /// The contour over [0, 1].
    pub(crate) fn curve(&self, pointer: &Pointer) -> Result<Curve<DVec2>, Vec<Fault>> {
        let (points, pointer_to_points) = match self {
            Self::Points(points) => (points, pointer.clone()),
            Self::Spline(spline) => (&spline.points, pointer.at("points")),
        };
        check_points(points, &pointer_to_points)?;
        let bad = |pointer: Pointer, message: String| vec![Fault::new(pointer, "bad_contour", message)];
        let curve = match self {
            Self::Points(points) => {
                let points: Vec<DVec2> = points.iter().map(|&p| DVec2::from_array(p)).collect();
                through(&points).map_err(|e| bad(pointer.clone(), e.to_string()))?
            }
            Self::Spline(spline) => spline.curve(pointer)?,
        };
        let breaks = curve.breaks();
        let still =
            breaks.windows(2).flat_map(|w| (0..=8).map(|k| w[0] + (w[1] - w[0]) * f64::from(k) / 8.0));
        let least = 1e-9 * curve.points()[0].distance(curve.points()[curve.points().len() - 1]);
        if let Some(s) = still.into_iter().find(|&s| !(curve.derivatives(s)[1].length() > least)) {
            let p = curve.point(s);
            return Err(bad(
                pointer.clone(),
                format!("the contour stands still near x = {} mm, r = {} mm", p.x, p.y),
            ));
        }
        Ok(curve)
    }
}

impl SplineSpec {
    fn curve(&self, pointer: &Pointer) -> Result<Curve<DVec2>, Vec<Fault>> {
        let fault = |pointer: Pointer, message: String| vec![Fault::new(pointer, "bad_contour", message)];
        if !(1..=9).contains(&self.degree) {
            let message = format!("degree {} is outside 1..=9", self.degree);
            return Err(vec![
                Fault::new(pointer.at("degree"), "out_of_range", message)
                    .value(self.degree)
                    .min(1.0)
                    .max(9.0),
            ]);
        }
        let knots = Knots::new(self.degree, self.knots.clone())
            .map_err(|e| fault(pointer.at("knots"), e.to_string()))?;
        let breaks = knots.breaks();
        let kink = breaks[1..breaks.len() - 1].iter().find(|&&t| knots.multiplicity(t) >= self.degree);
        if let Some(t) = kink {
            let message = format!("knot {t} is repeated so often that the contour has a kink there");
            return Err(fault(pointer.at("knots"), message));
        }
        let (start, end) = knots.domain();
        if knots.multiplicity(start) != self.degree + 1 || knots.multiplicity(end) != self.degree + 1 {
            let message = "the knots are not clamped: the first and the last must stand degree + 1 times";
            return Err(fault(pointer.at("knots"), message.to_owned()));
        }
        let points = self.points.iter().map(|&p| DVec2::from_array(p)).collect();
        let curve = Curve::new(knots, points).map_err(|e| fault(pointer.at("points"), e.to_string()))?;
        Ok(curve.reparameterized(0.0, 1.0))
    }
}

fn check_points(points: &[[f64; 2]], pointer: &Pointer) -> Result<(), Vec<Fault>> {
    if !(2..=MOST_POINTS).contains(&points.len()) {
        let message = format!("{} points given, 2 to {MOST_POINTS} needed", points.len());
        return Err(vec![
            Fault::new(pointer.clone(), "point_count", message)
                .value(points.len())
                .min(2.0)
                .max(MOST_POINTS as f64),
        ]);
    }
    let mut faults = Vec::new();
    for (i, p) in points.iter().enumerate() {
        if !(p[0].is_finite() && p[1].is_finite() && p[0].abs() < 1e9 && p[1].abs() < 1e9) {
            faults.push(Fault::new(pointer.at(i), "not_finite", "the point is not finite").unit("mm"));
        } else if !(p[1] > 0.0) {
            let message = format!("the radius {} mm is not positive", p[1]);
            faults.push(
                Fault::new(pointer.at(i).at(1), "out_of_range", message).value(p[1]).min(0.0).unit("mm"),
            );
        } else if i > 0 && DVec2::from(*p).distance(DVec2::from(points[i - 1])) <= 1e-9 * (1.0 + p[1]) {
            let message = "the point repeats the one before";
            faults.push(Fault::new(pointer.at(i), "duplicate_point", message).unit("mm"));
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// A smooth curve through points on [0, 1] by chord length; points on a line give that line, exactly.
fn through(points: &[DVec2]) -> Result<Curve<DVec2>, coolinggen_nurbs::NurbsError> {
    let (first, last) = (points[0], points[points.len() - 1]);
    let along = last - first;
    let reach = along.length_squared();
    let on_line = |p: &DVec2| along.perp_dot(*p - first).abs() <= 1e-12 * reach;
    let advancing = points.windows(2).all(|w| (w[1] - w[0]).dot(along) > 0.0);
    if advancing && points.iter().all(on_line) {
        return Ok(Curve::segment(first, last));
    }
    let mut s = vec![0.0];
    for w in points.windows(2) {
        s.push(s[s.len() - 1] + w[0].distance(w[1]));
    }
    let total = s[s.len() - 1];
    let count = s.len();
    for (i, s) in s.iter_mut().enumerate() {
        *s = if i + 1 == count { 1.0 } else { *s / total };
    }
    Interpolator::new(3.min(points.len() - 1), &s)?.curve(points)
}
