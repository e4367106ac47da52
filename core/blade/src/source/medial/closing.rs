//! Trailing edges: what joins the last line of one side to the first of the other.

use coolinggen_nurbs::{Constraint, Knots, LeastSquares, NurbsError, ParametricSurface, Surface};
use glam::DVec3;

/// The skin with its two borders in u put on one line, which they are but for rounding.
pub(super) fn sharp(skin: &Surface<DVec3>) -> Result<Surface<DVec3>, NurbsError> {
    let columns = skin.counts().1;
    let mut points = skin.points().to_vec();
    let last = points.len() - columns;
    points.copy_within(0..columns, last);
    Surface::new(skin.knots_u().clone(), skin.knots_v().clone(), points)
}

/// A straight strip from the last line of the skin to its first, on u in [0, 1].
pub(super) fn blunt(skin: &Surface<DVec3>) -> Result<Surface<DVec3>, NurbsError> {
    let (degree, columns) = (skin.knots_u().degree(), skin.counts().1);
    let points = skin.points();
    let (first, last) = (&points[..columns], &points[points.len() - columns..]);
    let mut net = Vec::with_capacity((degree + 1) * columns);
    for k in 0..=degree {
        let f = k as f64 / degree as f64;
        net.extend(last.iter().zip(first).map(|(a, b)| if k == degree { *b } else { a.lerp(*b, f) }));
    }
    Surface::new(Knots::clamped(degree, &[0.0, 1.0])?, skin.knots_v().clone(), net)
}

/// A round nose from the last line of the skin to its first, tangent to both sides: two arcs a section, each a cubic
/// within 3e-4 of the radius. u runs over [0, 1], the tip is at 1/2.
pub(super) fn rounded(skin: &Surface<DVec3>) -> Result<Surface<DVec3>, NurbsError> {
    let knots_v = skin.knots_v();
    let lines: Vec<f64> = {
        let breaks = knots_v.breaks();
        let each = 2 * (knots_v.degree() + 1);
        let inner = breaks
            .windows(2)
            .flat_map(|w| (0..each).map(move |k| w[0] + (w[1] - w[0]) * k as f64 / each as f64));
        inner.chain(breaks.last().copied()).collect()
    };
    let ((start, end), (low, high)) = skin.domain();
    let sections: Vec<[DVec3; 5]> = lines
        .iter()
        .map(|&v| {
            let (a, out_a, _) = skin.first_derivatives(end, v);
            let (b, into_b, _) = skin.first_derivatives(start, v);
            arcs(a, out_a.normalize(), b, -into_b.normalize())
        })
        .collect();
    let ends = [Constraint::derivative(knots_v, low, 0)?, Constraint::derivative(knots_v, high, 0)?];
    let fit = LeastSquares::new(knots_v.clone(), &lines, None, &ends, None)?;
    let columns = skin.counts().1;
    let points = skin.points();
    let mut net = points[points.len() - columns..].to_vec();
    for k in 0..5 {
        let row: Vec<DVec3> = sections.iter().map(|s| s[k]).collect();
        net.extend(fit.curve(&row, &[row[0], row[row.len() - 1]])?.curve.points());
    }
    net.extend(&points[..columns]);
    // Two cubics that join in the tip with one tangent.
    let knots = Knots::new(3, vec![0.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.5, 1.0, 1.0, 1.0, 1.0])?;
    let mut nose = Surface::new(knots, knots_v.clone(), net)?;
    for _ in 3..skin.knots_u().degree() {
        nose = nose.elevated_u()?;
    }
    Ok(nose)
}

/// Inner control points of the two arcs from `a`, left in direction `out`, to `b`, met against direction `into`: the
/// circle tangent to both at about equal distances from where the directions meet.
fn arcs(a: DVec3, out: DVec3, b: DVec3, into: DVec3) -> [DVec3; 5] {
    let middle = 0.5 * (a + b);
    let half = 0.5 * a.distance(b);
    if half == 0.0 {
        // The tip of a blade that ends in a point.
        return [a; 5];
    }
    let across = (a - b) / (2.0 * half);
    let ahead = (out + into).reject_from(across).normalize();
    // Half the angle between the sides.
    let wedge = 0.5 * (-(out - into).dot(across) * 0.5).clamp(-0.9, 0.9).asin() * 2.0;
    let radius = half / wedge.cos();
    let leg = radius * 4.0 / 3.0 * (0.25 * (std::f64::consts::FRAC_PI_2 - wedge)).tan();
    let tip = middle + ahead * (radius * (1.0 - wedge.sin()));
    [a + out * leg, tip + across * leg, tip, tip - across * leg, b + into * leg]
}
