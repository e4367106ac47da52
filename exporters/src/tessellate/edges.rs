//! Edges as polylines that all faces share.

use super::TessellationOptions;
use super::field::Field;
use super::grading::{Grading, cells};
use coolinggen_brep::{Coedge, Edge, EdgeCurve};
use coolinggen_nurbs::{Curve, Knots, ParametricCurve};
use glam::{DVec2, DVec3};

/// Parameters at which an edge is cut into segments, both ends included.
///
/// Segments keep the chord and angle tolerances on the curve, and span at most one grid step of each face they
/// border (`uses`), so that the faces' triangles can keep theirs next to it.
pub(crate) fn divide(edge: &Edge, uses: &[(&Coedge, &Field)], o: &TessellationOptions) -> Vec<f64> {
    let knots = match &edge.curve {
        EdgeCurve::BSpline(c) => c.knots(),
        EdgeCurve::Rational(c) => c.homogeneous().knots(),
    };
    let (start, end) = edge.curve.domain();
    let breaks = knots.breaks();
    let straight = is_segment(&edge.curve);
    let per_span = if straight { 1 } else { 2 };
    let borders = cells(&breaks, start, end, per_span, 8);
    let mut densities: Vec<f64> =
        borders.windows(2).map(|b| density(&edge.curve, 0.5 * (b[0] + b[1]), straight, o)).collect();
    for (coedge, field) in uses {
        bordering(coedge, field, &borders, &mut densities);
    }
    let grading = Grading::new(borders, &densities, |t| is_kink(knots, t));
    let mut factor = 1.0;
    loop {
        let parameters = grading.divide(factor);
        let worst = if straight { 0.0 } else { worst_chord(&edge.curve, &parameters) };
        // Twice the steps is a quarter of the deviation; 4096 times the steps is beyond any smooth curve.
        if !(worst > o.sampled_chord()) || factor > 4096.0 {
            return parameters;
        }
        factor *= (worst / o.sampled_chord()).sqrt().clamp(1.1, 4.0);
    }
}

fn is_segment(curve: &EdgeCurve) -> bool {
    matches!(curve, EdgeCurve::BSpline(c) if c.degree() == 1 && c.points().len() == 2)
}

fn is_kink(knots: &Knots, t: f64) -> bool {
    knots.multiplicity(t) >= knots.degree()
}

/// Steps a unit of parameter that the curve itself needs at `t`.
fn density(curve: &EdgeCurve, t: f64, straight: bool, o: &TessellationOptions) -> f64 {
    let [_, d, dd] = curve.derivatives(t);
    let speed = d.length();
    let by_length = o.max_edge_mm.map_or(0.0, |m| speed / m);
    if straight || !(speed > 0.0) {
        return by_length;
    }
    let across = d.cross(dd).length() / speed;
    let by_chord = (across / (8.0 * o.sampled_chord())).sqrt();
    let by_turn = (across / speed / o.angle()).min(speed / (0.1 * o.chord_mm));
    by_chord.max(by_turn).max(by_length)
}

/// Raises `densities` to the grid steps that the face's field has along the edge.
fn bordering(coedge: &Coedge, field: &Field, borders: &[f64], densities: &mut [f64]) {
    if field.u.total() <= 0.0 && field.v.total() <= 0.0 {
        return;
    }
    let steps = |t: f64| {
        let p = coedge.pcurve.point(t);
        DVec2::new(field.u.steps_to(p.x), field.v.steps_to(p.y))
    };
    let mut before = steps(borders[0]);
    for (i, density) in densities.iter_mut().enumerate() {
        let after = steps(borders[i + 1]);
        let most = (after - before).abs().max_element();
        *density = density.max(most / (borders[i + 1] - borders[i]));
        before = after;
    }
}

/// Greatest distance of the curve from its chords, taken at the quarters.
fn worst_chord(curve: &EdgeCurve, parameters: &[f64]) -> f64 {
    let mut worst = 0.0f64;
    let mut before = curve.point(parameters[0]);
    for pair in parameters.windows(2) {
        let after = curve.point(pair[1]);
        for part in [0.25, 0.5, 0.75] {
            let p = curve.point(pair[0] + part * (pair[1] - pair[0]));
            worst = worst.max(distance_to_segment(p, before, after));
        }
        before = after;
    }
    worst
}

fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let d = b - a;
    let square = d.length_squared();
    let f = if square > 0.0 { ((p - a).dot(d) / square).clamp(0.0, 1.0) } else { 0.0 };
    p.distance(a + d * f)
}

/// Parameter bounds of a chain of parameter curves, sampled; exact for straight ones.
pub(crate) fn widen(curve: &Curve<DVec2>, low: &mut DVec2, high: &mut DVec2) {
    let (start, end) = curve.domain();
    let count = if curve.points().len() == 2 { 1 } else { 2 * curve.points().len() };
    for i in 0..=count {
        let p = curve.point(start + (end - start) * i as f64 / count as f64);
        *low = low.min(p);
        *high = high.max(p);
    }
}
