//! Thickness forms and mean lines of propeller sections.

use crate::medial::Profile;
use coolinggen_nurbs::{Interpolator, NurbsError};
use glam::DVec2;

/// The NACA 66 thickness form with the nose and tail of the David Taylor Model Basin: x, then half the thickness over
/// the greatest thickness. T. Brockett, DTMB report 1780 (1966).
const NACA_66_MODIFIED: [[f64; 2]; 27] = [
    [0.0, 0.0],
    [0.005, 0.0665],
    [0.0075, 0.0812],
    [0.0125, 0.1044],
    [0.025, 0.1466],
    [0.05, 0.2066],
    [0.075, 0.2525],
    [0.1, 0.2907],
    [0.15, 0.3521],
    [0.2, 0.4],
    [0.25, 0.4363],
    [0.3, 0.4637],
    [0.35, 0.4832],
    [0.4, 0.4952],
    [0.45, 0.5],
    [0.5, 0.4962],
    [0.55, 0.4846],
    [0.6, 0.4653],
    [0.65, 0.4383],
    [0.7, 0.4035],
    [0.75, 0.3612],
    [0.8, 0.311],
    [0.85, 0.2532],
    [0.9, 0.1877],
    [0.95, 0.1143],
    [0.975, 0.0748],
    [1.0, 0.0333],
];

/// The modified NACA 66 thickness form over t = sqrt x, in which its nose is smooth.
pub(super) fn naca_66_modified() -> Result<Profile, NurbsError> {
    let t: Vec<f64> = NACA_66_MODIFIED.iter().map(|p| p[0].sqrt()).collect();
    let points: Vec<DVec2> = NACA_66_MODIFIED.iter().map(|p| DVec2::from_array(*p)).collect();
    // x = t^2 is met exactly by a cubic, x'(0) = 0 with it but for rounding.
    let curve = Interpolator::new(3, &t)?.curve(&points)?;
    Ok(Profile::from_curve(curve))
}

/// Height of the NACA a = 0.8 mean line over its greatest, at the part `x` of the chord.
///
/// I. H. Abbott, A. E. von Doenhoff, *Theory of Wing Sections* (1959), equation 4.27.
pub(super) fn naca_a08(x: f64) -> f64 {
    const A: f64 = 0.8;
    /// Greatest value of the line for a lift coefficient of 1, at x = 0.5153.
    const GREATEST: f64 = 0.067_943_4;
    let square_log = |d: f64| if d == 0.0 { 0.0 } else { d * d * d.abs().ln() };
    let log = |x: f64| if x == 0.0 { 0.0 } else { x * x.ln() };
    let g = -(A * A * (0.5 * A.ln() - 0.25) + 0.25) / (1.0 - A);
    let h = (0.5 * square_log(1.0 - A) - 0.25 * (1.0 - A).powi(2)) / (1.0 - A) + g;
    let (tail, load) = (1.0 - x, A - x);
    let bracket = 0.5 * square_log(load) - 0.5 * square_log(tail) + 0.25 * tail * tail - 0.25 * load * load;
    (bracket / (1.0 - A) - log(x) + g - h * x) / (std::f64::consts::TAU * (A + 1.0)) / GREATEST
}

/// Height of the parabolic mean line over its greatest.
pub(super) fn parabola(x: f64) -> f64 {
    4.0 * x * (1.0 - x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_line_has_the_ordinates_of_the_tables() {
        // Abbott and von Doenhoff, appendix II: ordinates for a lift coefficient of 1, in parts of the chord.
        for (x, y) in [(0.05, 0.01841), (0.25, 0.05367), (0.5, 0.06790), (0.7, 0.06037), (0.9, 0.02435)] {
            assert!((naca_a08(x) * 0.067_943_4 - y).abs() < 1e-5, "{x}: {}", naca_a08(x) * 0.067_943_4);
        }
        let greatest = (0..=10_000).map(|i| naca_a08(f64::from(i) / 1e4)).fold(0.0, f64::max);
        assert!((greatest - 1.0).abs() < 1e-4, "{greatest}");
        assert!(naca_a08(0.0).abs() < 1e-12 && naca_a08(1.0).abs() < 1e-12);
    }

    #[test]
    fn the_thickness_form_runs_through_its_table() {
        let profile = naca_66_modified().unwrap();
        for [x, y] in NACA_66_MODIFIED {
            let p = profile.at(x.sqrt())[0];
            assert!((p - DVec2::new(x, y)).length() < 1e-14);
        }
        for i in 0..=100 {
            let t = f64::from(i) / 100.0;
            assert!((profile.at(t)[0].x - t * t).abs() < 1e-13);
        }
    }
}
