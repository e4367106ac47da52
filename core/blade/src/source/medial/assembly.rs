//! From the sides to a closed blade.

use super::closing;
use super::spec::{ClosingSpec, KnotsSpec, SkinMethod, SkinSpec, not_composed};
use crate::blade::{Blade, FitReport, Region};
use crate::fault::{Fault, Pointer};
use crate::medial::{Composition, Skin, SkinSize, Tip, TwoSided};
use crate::source::assemble;
use crate::source::closed::surgery::{glued, rebased};
use crate::stream::StreamSpace;
use crate::surface::BladeSurface;
use coolinggen_nurbs::{NurbsError, ParametricSurface, Surface};
use glam::DVec3;

/// Grid of the error that is reported: points a side, lines.
const GRID: [usize; 2] = [81, 25];

/// What is tried where a tolerance is missed: how many times finer data, and what part of the tolerance.
const STRICTER: [(usize, f64); 2] = [(2, 0.6), (4, 0.3)];

/// Regions with their ranges of u.
type Regions = Vec<(Region, [f64; 2])>;

/// How sides become a blade.
pub(super) struct Finish<'a> {
    pub(super) skin: &'a SkinSpec,
    pub(super) closing: ClosingSpec,
    /// Index of the suction side.
    pub(super) suction: usize,
    /// t at which the leading edge ends on each side; none where the sides meet in it. They do on blades that end in a
    /// point: there a leading edge of its own would be a sliver, which OpenCASCADE finds to intersect itself.
    pub(super) nose: Option<[f64; 2]>,
    /// The field to blame where the blade does not reach hub or shroud.
    pub(super) blamed: &'static str,
    /// What to say of how the sides came about.
    pub(super) notes: Vec<String>,
}

/// The blade of two sides.
pub(super) fn blade(
    sides: &dyn TwoSided,
    finish: Finish<'_>,
    space: &StreamSpace,
) -> Result<Blade, Vec<Fault>> {
    let (spec, pressure) = (finish.skin, 1 - finish.suction);
    let measured = |skin: Result<Skin, NurbsError>| {
        let skin = skin.map_err(failed)?;
        let deviation = skin.deviation(sides, GRID[0], GRID[1]).map_err(failed)?;
        Ok::<_, Vec<Fault>>((skin, deviation))
    };
    let mut notes = finish.notes;
    let (skin, deviation) = match (spec.method, spec.control_points) {
        (SkinMethod::Composed, _) => {
            let composition =
                sides.composition(pressure, spec.tolerance).ok_or_else(|| vec![not_composed()])?;
            let composition = composition.map_err(not_joined)?;
            notes.push(composition_note(&composition));
            measured(Skin::composed(&composition, pressure, spec.degree, spec.tolerance))?
        }
        (SkinMethod::Fitted, Some(counts)) => {
            let optimised = spec.knots == KnotsSpec::Optimised;
            measured(Skin::new(sides, pressure, SkinSize { degree: spec.degree, counts, optimised }))?
        }
        (SkinMethod::Fitted, None) => {
            let within = |(fineness, share)| {
                measured(Skin::within(sides, pressure, spec.degree, share * spec.tolerance, fineness))
            };
            let mut made = within((1, 1.0))?;
            for attempt in STRICTER {
                if made.1.greatest <= spec.tolerance {
                    break;
                }
                made = within(attempt)?;
            }
            made
        }
    };
    let (count_u, count_v) = skin.surface.counts();
    if spec.control_points.is_none() && !(deviation.greatest <= spec.tolerance) {
        let message = format!(
            "the sides are {:.2e} mm off a surface of {count_u} x {count_v} control points: they change too fast",
            deviation.greatest
        );
        let fault = Fault::new("/skin", "no_surface", message);
        return Err(vec![fault.value(spec.tolerance).min(deviation.greatest).unit("mm")]);
    }
    let nose = [pressure, finish.suction].map(|k| skin.place(k, finish.nose.map_or(0.0, |nose| nose[k])));
    let (closed, regions) = closed(&skin, nose, finish.closing, sides.tip()).map_err(failed)?;
    let surface =
        assemble::reaching(BladeSurface::BSpline(closed), space, &Pointer::root().at(finish.blamed))?;
    notes.push(format!(
        "both sides by {count_u} x {count_v} control points of degree {} x {}: average error {:.2e} mm, greatest {:.2e} mm",
        spec.degree[0], spec.degree[1], deviation.average, deviation.greatest
    ));
    let outward = surface.is_outward();
    let fit = FitReport {
        greatest_distance_mm: deviation.greatest,
        average_distance_mm: Some(deviation.average),
        notes,
        ..assemble::report(&surface)
    };
    Ok(Blade { surface, regions, outward, fit })
}

/// What is to be reported of a composition.
fn composition_note(composition: &Composition) -> String {
    let surface = &composition.surface;
    let (count_u, count_v) = surface.counts();
    let (p, q) = (surface.knots_u().degree(), surface.knots_v().degree());
    format!(
        "composed of {count_u} x {count_v} control points of degree {p} x {q}, the scales within {:.1e} mm",
        composition.residual
    )
}

/// Sides without a derivative in common at the leading edge.
fn not_joined(e: NurbsError) -> Vec<Fault> {
    match e {
        NurbsError::NoConvergence { residual, .. } => {
            let message = format!(
                "the thickness of the two sides is not in one ratio along the span: composed, they would join {residual:.1e} \
                 mm from a common tangent"
            );
            let at = Pointer::root().at("skin").at("method");
            let fault = Fault::new(at, "no_composition", message).value("composed");
            vec![fault.hint("fitted, or a pressure side's thickness in proportion to the suction side's")]
        }
        e => failed(e),
    }
}

pub(super) fn failed(e: NurbsError) -> Vec<Fault> {
    vec![Fault::new("", "no_surface", format!("the parameters make no surface: {e}"))]
}

/// The closed surface from the start of the leading edge on, or from that line, with its regions.
fn closed(
    skin: &Skin,
    nose: [f64; 2],
    how: ClosingSpec,
    tip: Option<Tip>,
) -> Result<(Surface<DVec3>, Regions), NurbsError> {
    let net = match how {
        ClosingSpec::Sharp => closing::sharp(&skin.surface)?,
        ClosingSpec::Blunt | ClosingSpec::Rounded => skin.surface.clone(),
    };
    let tail = match how {
        ClosingSpec::Sharp => None,
        ClosingSpec::Blunt => Some(closing::blunt(&net)?),
        ClosingSpec::Rounded => Some(closing::rounded(&net)?),
    };
    // Parameters in proportion to lengths half way up.
    let length = |s: &Surface<DVec3>| -> f64 {
        let ((a, b), _) = s.domain();
        let at = |i: u32| s.point(a + (b - a) * f64::from(i) / 400.0, 0.5);
        (0..400).map(|i| at(i).distance(at(i + 1))).sum()
    };
    let sides = length(&net);
    let part = tail.as_ref().map_or(0.0, |t| length(t) / sides);
    let total = 1.0 + part;
    let front = net.restricted_u(nose[0], 1.0)?;
    let back = net.restricted_u(0.0, nose[0])?;
    let [a, b, c] = [nose[1] - nose[0], 1.0 - nose[0], 1.0 - nose[0] + part].map(|x| x / total);
    let mut pieces = vec![rebased(&front, (0.0, b))?];
    let leading = (a > 0.0).then_some((Region::LeadingEdge, [0.0, a]));
    let mut regions: Regions = leading.into_iter().chain([(Region::SuctionSide, [a, b])]).collect();
    if let Some(tail) = tail {
        pieces.push(rebased(&tail, (b, c))?);
        regions.push((Region::TrailingEdge, [b, c]));
    }
    let c = if part > 0.0 { c } else { b };
    pieces.push(rebased(&back, (c, 1.0))?);
    regions.push((Region::PressureSide, [c, 1.0]));
    let closed = glued(&pieces)?;
    // The seam is one line and the tip one point, bit for bit.
    let columns = closed.counts().1;
    let mut points = closed.points().to_vec();
    let last = points.len() - columns;
    if let Some(tip) = tip {
        points.iter_mut().skip(columns - 1).step_by(columns).for_each(|p| *p = tip.point);
    }
    points.copy_within(0..columns, last);
    Ok((Surface::new(closed.knots_u().clone(), closed.knots_v().clone(), points)?, regions))
}
