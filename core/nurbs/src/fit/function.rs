//! Splines for functions that are known everywhere.

use super::interpolate::Interpolator;
use super::least_squares::Fit;
use crate::error::NurbsError;
use crate::vector::VectorSpace;

/// Points a span at which the deviation is measured.
const CHECKS: usize = 7;
/// Spans beyond which a function counts as not smooth.
const SPANS: usize = 20_000;

/// The C2 cubic that follows `f` (point and derivative at a parameter) within `tolerance` at equal parameters: it
/// interpolates at its breaks, with the function's derivatives at both ends, and spans are halved until the deviation
/// at 7 points inside each is below half the tolerance. Deviations reported are those measured.
///
/// `breaks` are where to start, the ends included; `f` should be smooth between them. The points at the breaks are
/// met to rounding.
///
/// # Errors
/// [`NurbsError::BadArgument`] for a tolerance that is not positive, [`NurbsError::BadParameters`] for breaks out of
/// order, [`NurbsError::NoConvergence`] with the deviation left when 20 000 spans are not enough.
pub fn fit_function<V: VectorSpace>(
    f: impl Fn(f64) -> [V; 2],
    breaks: &[f64],
    tolerance: f64,
) -> Result<Fit<V>, NurbsError> {
    if !(tolerance > 0.0) {
        return Err(NurbsError::BadArgument { what: "tolerance of a fit", value: tolerance });
    }
    let mut nodes = breaks.to_vec();
    // Points once computed are kept: halving a span adds its middle.
    let mut points: Vec<V> = nodes.iter().map(|&t| f(t)[0]).collect();
    loop {
        let slopes = [f(nodes[0])[1], f(nodes[nodes.len() - 1])[1]];
        let curve = Interpolator::with_slopes(&nodes)?.curve_with_slopes(&points, slopes[0], slopes[1])?;
        let (mut sum, mut greatest, mut refined, mut refined_points) = (0.0, 0.0f64, vec![], vec![]);
        for (i, span) in nodes.windows(2).enumerate() {
            refined.push(span[0]);
            refined_points.push(points[i]);
            let (mut worst, mut middle) = (0.0f64, points[i]);
            for k in 1..=CHECKS {
                let t = span[0] + (span[1] - span[0]) * k as f64 / (CHECKS + 1) as f64;
                let exact = f(t)[0];
                let basis = curve.knots().basis(t, 0);
                let at = curve.points[basis.first..].iter().zip(&basis.values[0][..4]);
                let distance = at.fold(V::default(), |s, (&p, &n)| s + p * n).distance_to(&exact);
                sum += distance * distance;
                worst = worst.max(distance);
                if 2 * k == CHECKS + 1 {
                    middle = exact;
                }
            }
            greatest = greatest.max(worst);
            let half = 0.5 * (span[0] + span[1]);
            if !(worst <= 0.5 * tolerance) && half > span[0] && half < span[1] {
                refined.push(half);
                refined_points.push(middle);
            }
        }
        if refined.len() + 1 == nodes.len() && greatest <= 0.5 * tolerance {
            let rms = (sum / (CHECKS * (nodes.len() - 1)) as f64).sqrt();
            return Ok(Fit { curve, rms, greatest });
        }
        if refined.len() + 1 == nodes.len() || refined.len() > SPANS || !greatest.is_finite() {
            let what = "spline within a tolerance of a function";
            return Err(NurbsError::NoConvergence { what, residual: greatest });
        }
        refined.push(nodes[nodes.len() - 1]);
        refined_points.push(points[points.len() - 1]);
        (nodes, points) = (refined, refined_points);
    }
}
