//! Parameter curves of edges.

use super::BuildError;
use crate::cursor::{Cursor, EdgeCursor};
use crate::foot::Feet;
use crate::geometry::{EdgeCurve, SurfaceGeometry};
use crate::lanes::Lanes;
use crate::probe::SurfaceProbe;
use crate::span::full_spans;
use coolinggen_nurbs::{BandedLu, Curve, Knots, NurbsError, ParametricCurve, ParametricSurface};
use glam::{DVec2, DVec3};

/// A parameter curve with how well it keeps to its edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Pcurve {
    /// The curve, over the domain of the edge's curve.
    pub curve: Curve<DVec2>,
    /// Greatest distance found between the edge and the image of the parameter curve at the same parameter, mm.
    pub deviation_mm: f64,
}

/// How often the spans of a parameter curve are halved in search of the accuracy asked for.
const HALVINGS: usize = 8;

/// The straight line from `start` to `end` over `domain`, that of the edge's curve: the parameter curve of an edge
/// along a parameter line.
///
/// # Errors
/// [`NurbsError::KnotOrder`] if the domain is empty or not finite, [`NurbsError::BadPoint`] if an end is not finite.
pub fn straight_pcurve(start: DVec2, end: DVec2, domain: (f64, f64)) -> Result<Curve<DVec2>, NurbsError> {
    Curve::new(Knots::clamped(1, &[domain.0, domain.1])?, vec![start, end])
}

/// The parameter curve of an edge that lies on a surface, with `|S(pcurve(t)) - C(t)|` at most `tolerance_mm` at
/// four places in each of its spans.
///
/// On a plane it is exact, the edge's control points in the plane's coordinates. Elsewhere the feet of the edge's
/// points are interpolated at the Greville abscissae of the edge's own knots (of the cubic knots of the same
/// smoothness where the degree is less than 3); spans are halved, at most eight times, while that is too coarse.
/// `near` is about where the edge starts in the surface's parameters: it picks the turn of theta on a surface of
/// revolution, and on B-spline surfaces the search starts there; planes ignore it.
///
/// # Errors
/// [`BuildError::OffSurface`] if the tolerance is missed, as it is when the edge itself is farther from the surface;
/// [`BuildError::Nurbs`] for an edge curve whose knots leave a gap.
pub fn interpolated_pcurve(
    curve: &EdgeCurve,
    surface: &SurfaceGeometry,
    near: DVec2,
    tolerance_mm: f64,
) -> Result<Pcurve, BuildError> {
    trace(curve, surface, near, false, tolerance_mm)
}

/// As [`interpolated_pcurve`], with `near` about where the edge ends.
pub(super) fn interpolated_backwards(
    curve: &EdgeCurve,
    surface: &SurfaceGeometry,
    near: DVec2,
    tolerance_mm: f64,
) -> Result<Pcurve, BuildError> {
    trace(curve, surface, near, true, tolerance_mm)
}

fn trace(
    curve: &EdgeCurve,
    surface: &SurfaceGeometry,
    near: DVec2,
    backwards: bool,
    tolerance: f64,
) -> Result<Pcurve, BuildError> {
    if let (SurfaceGeometry::Plane(plane), EdgeCurve::BSpline(spline)) = (surface, curve) {
        let flat =
            spline.map(|&p| DVec2::new((p - plane.origin).dot(plane.x), (p - plane.origin).dot(plane.y)));
        // Control points bound the height: no sample can be farther off.
        let normal = plane.x.cross(plane.y);
        let height = |p: &DVec3| (*p - plane.origin).dot(normal).abs();
        let deviation_mm = spline.points().iter().map(height).fold(0.0, f64::max);
        return accept(Pcurve { curve: flat, deviation_mm }, tolerance);
    }
    let mut knots = cubic_at_least(match curve {
        EdgeCurve::BSpline(c) => c.knots(),
        EdgeCurve::Rational(c) => c.homogeneous().knots(),
    })?;
    let mut halvings = 0;
    loop {
        let flat = interpolate(curve, surface, near, backwards, &knots)?;
        let deviation_mm = deviation(curve, surface, &flat);
        // Only what lies along the surface can be mended.
        let enough = deviation_mm <= tolerance || halvings == HALVINGS;
        if enough || deviation_along(curve, surface, &flat) <= 0.1 * tolerance {
            return accept(Pcurve { curve: flat, deviation_mm }, tolerance);
        }
        knots = halved(&knots)?;
        halvings += 1;
    }
}

fn accept(pcurve: Pcurve, tolerance_mm: f64) -> Result<Pcurve, BuildError> {
    let distance_mm = pcurve.deviation_mm;
    // Written so that NaN is refused.
    if distance_mm <= tolerance_mm {
        Ok(pcurve)
    } else {
        Err(BuildError::OffSurface { distance_mm, tolerance_mm })
    }
}

/// Interpolation of the feet at the Greville abscissae.
fn interpolate(
    curve: &EdgeCurve,
    surface: &SurfaceGeometry,
    near: DVec2,
    backwards: bool,
    knots: &Knots,
) -> Result<Curve<DVec2>, BuildError> {
    let sites = knots.greville();
    let count = sites.len();
    let mut feet = Feet::new(surface, near);
    let mut edge = EdgeCursor::new(curve);
    let mut right = vec![DVec2::ZERO; count];
    for i in 0..count {
        let i = if backwards { count - 1 - i } else { i };
        right[i] = feet.next(edge.point(sites[i]));
    }
    let degree = knots.degree();
    let lu = BandedLu::factor(count, degree, |i, row| {
        let basis = knots.basis(sites[i], 0);
        row[..=degree].copy_from_slice(&basis.values[0][..=degree]);
        basis.first
    })?;
    lu.solve(&mut right);
    Ok(Curve::new(knots.clone(), right)?)
}

/// Where in each span curves are compared.
const FRACTIONS: [f64; 4] = [0.15, 0.38, 0.5, 0.8];

/// Greatest distance between the curves.
fn deviation(curve: &EdgeCurve, surface: &SurfaceGeometry, flat: &Curve<DVec2>) -> f64 {
    let mut probe = SurfaceProbe::new(surface);
    let mut edge = EdgeCursor::new(curve);
    let mut span = Cursor::new(flat).span;
    let mut worst = 0.0f64;
    for index in full_spans(flat.knots()) {
        span.set(flat.knots(), index);
        let t = FRACTIONS.map(|f| span.start + (span.end - span.start) * f);
        let (at, []) = span.four(Lanes(t), flat.points(), flat.points());
        let [x, y, z] = probe.four(at);
        for lane in 0..4 {
            let off = edge.point(t[lane]).distance_squared(DVec3::new(x.0[lane], y.0[lane], z.0[lane]));
            // Unlike f64::max, this lets NaN through to be refused.
            worst = if off <= worst { worst } else { off };
        }
    }
    worst.sqrt()
}

/// Greatest part along the surface of the distance between the curves.
fn deviation_along(curve: &EdgeCurve, surface: &SurfaceGeometry, flat: &Curve<DVec2>) -> f64 {
    let breaks = flat.breaks();
    let along = |t: f64| {
        let at = flat.point(t);
        let (s, du, dv) = surface.first_derivatives(at.x, at.y);
        let (off, normal) = (curve.point(t) - s, du.cross(dv).normalize_or_zero());
        (off - normal * off.dot(normal)).length()
    };
    let times = breaks.windows(2).flat_map(|p| FRACTIONS.map(|f| p[0] + (p[1] - p[0]) * f));
    times.map(along).fold(0.0, f64::max)
}

/// The knots themselves, or those of degree 3 with the same breaks and the same continuity at them.
fn cubic_at_least(knots: &Knots) -> Result<Knots, NurbsError> {
    let missing = 3usize.saturating_sub(knots.degree());
    if missing == 0 {
        return Ok(knots.clone());
    }
    let (start, end) = knots.domain();
    let mut values = vec![start; 4];
    let inner = &knots.values()[knots.degree()..=knots.control_count()];
    for pair in inner.windows(2).filter(|pair| pair[0] > start && pair[0] < end) {
        // The last one of equal knots stands for those that are missing.
        let copies = if pair[0] < pair[1] { 1 + missing } else { 1 };
        values.extend(std::iter::repeat_n(pair[0], copies));
    }
    values.extend([end; 4]);
    Knots::new(3, values)
}

/// Knots with one more in the middle of each span.
fn halved(knots: &Knots) -> Result<Knots, NurbsError> {
    let mut values = Vec::with_capacity(2 * knots.values().len());
    for pair in knots.values().windows(2) {
        values.push(pair[0]);
        if pair[0] < pair[1] {
            values.push(0.5 * (pair[0] + pair[1]));
        }
    }
    values.extend(knots.values().last());
    Knots::new(knots.degree(), values)
}
