//! From lofted sections to a blade that reaches past hub and shroud.

use crate::blade::{Blade, FitReport};
use crate::error::BladeError;
use crate::fault::{Fault, Pointer};
use crate::loft::{Loft, LoftSection, Sheet};
use crate::stream::StreamSpace;
use crate::surface::BladeSurface;
use coolinggen_nurbs::ParametricSurface;

/// How far past hub and shroud the surface must reach, in span fractions.
const REACH: f64 = 0.06;
/// How far what is given may end short of hub or shroud.
const SHORT: f64 = 0.2;

/// Lofts `sections` and extends the loft. `at` is the parameter that faults are blamed on.
pub(super) fn lofted(
    sections: &[LoftSection],
    space: &StreamSpace,
    at: &Pointer,
) -> Result<(Blade, Loft), Vec<Fault>> {
    let failed = |e: coolinggen_nurbs::NurbsError| {
        vec![Fault::new(at.clone(), "no_surface", format!("the sections make no surface: {e}"))]
    };
    let doubled;
    let sections = match (sections, space) {
        ([only], StreamSpace::Linear(_)) => {
            doubled = prismatic(only, space);
            &doubled[..]
        }
        _ => sections,
    };
    let loft = Loft::new(sections).map_err(failed)?;
    let surface = reaching(BladeSurface::BSpline(loft.surface.clone()), space, at)?;
    let fit = FitReport { off_stream_surface_mm: loft.off_sheet, ..report(&surface) };
    let outward = surface.is_outward();
    Ok((Blade { surface, regions: loft.regions.clone(), outward, fit }, loft))
}

/// A report with the counts of spans.
pub(super) fn report(surface: &BladeSurface) -> FitReport {
    FitReport {
        spans_around: surface.knots_u().breaks().len() - 1,
        spans_along: surface.knots_w().breaks().len() - 1,
        ..FitReport::default()
    }
}

/// The one section of a prismatic blade at both ends of the reach.
fn prismatic(only: &LoftSection, space: &StreamSpace) -> Vec<LoftSection> {
    let at = |w: f64| space.surface(w).map(|s| LoftSection { w, sheet: Sheet::Stream(s), ..only.clone() });
    [-REACH, 1.0 + REACH].into_iter().filter_map(|w| at(w).ok()).collect()
}

/// Extends the surface in w, where its end polynomials go on, until it reaches past hub and shroud everywhere.
pub(super) fn reaching(
    mut surface: BladeSurface,
    space: &StreamSpace,
    at: &Pointer,
) -> Result<BladeSurface, Vec<Fault>> {
    let outside = |e: BladeError| vec![Fault::new(at.clone(), "outside_contours", e.to_string()).unit("mm")];
    for round in 0..6 {
        let short = missing(&surface, space).map_err(outside)?;
        if short.iter().all(|s| *s <= 0.0) {
            return Ok(surface);
        }
        if round == 0 {
            refuse_short(short, at)?;
        }
        let [below, above] = short.map(|s| if s > 0.0 { 1.05 * s + 0.002 } else { 0.0 });
        surface = surface
            .extended_w(below, above)
            .map_err(|e| vec![Fault::new(at.clone(), "no_surface", e.to_string())])?;
    }
    let message = "the blade cannot be extended past hub and shroud: it changes too fast near them";
    Err(vec![Fault::new(at.clone(), "short_of_contour", message)])
}

fn refuse_short(short: [f64; 2], at: &Pointer) -> Result<(), Vec<Fault>> {
    let mut faults = Vec::new();
    for (short, what) in short.into_iter().zip(["hub", "shroud"]) {
        let short = short - REACH;
        if short > SHORT {
            let message = format!("the blade ends {:.1} % of the span short of the {what}", 100.0 * short);
            faults.push(
                Fault::new(at.clone(), "short_of_contour", message)
                    .value(short)
                    .max(SHORT)
                    .hint(format!("let it reach the {what}, or beyond")),
            );
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// How much of a span fraction the surface ends short of its reach, at hub and shroud. A tip is not to reach beyond.
fn missing(surface: &BladeSurface, space: &StreamSpace) -> Result<[f64; 2], BladeError> {
    let (_, (low, high)) = surface.domain();
    let (mut below, mut above) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    for i in 0..96 {
        let u = f64::from(i) / 96.0;
        below = below.max(space.span_fraction(surface.point(u, low))? + REACH);
        above = above.max(1.0 + REACH - space.span_fraction(surface.point(u, high))?);
    }
    if surface.tip().is_some() {
        above = f64::NEG_INFINITY;
    }
    // Rounding of a reach met exactly does not call for more.
    Ok([below - 1e-9, above - 1e-9])
}
