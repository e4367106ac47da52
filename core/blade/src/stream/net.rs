//! The S2m net: streamlines from hub to shroud as one surface N(s, v) = (x, r).

use coolinggen_nurbs::{BandedLu, Curve, Interpolator, Knots, NurbsError, ParametricCurve, Surface};
use glam::DVec2;

/// The net of linear transfinite interpolation: straight from hub to shroud at equal parameters.
pub(super) fn transfinite(hub: &Curve<DVec2>, shroud: &Curve<DVec2>) -> Result<Surface<DVec2>, NurbsError> {
    let knots = common_knots(&[hub, shroud])?;
    let columns = [in_space(hub, &knots)?, in_space(shroud, &knots)?];
    Surface::from_columns(&columns, Knots::clamped(1, &[0.0, 1.0])?)
}

/// The net through `streamlines` at increasing span fractions from 0 to 1, of degree 3 (less with fewer than four).
pub(super) fn lofted(v: &[f64], streamlines: &[Curve<DVec2>]) -> Result<Surface<DVec2>, NurbsError> {
    let all: Vec<_> = streamlines.iter().collect();
    let knots = common_knots(&all)?;
    let columns = streamlines.iter().map(|c| in_space(c, &knots)).collect::<Result<Vec<_>, _>>()?;
    Interpolator::new(3.min(v.len() - 1), v)?.loft(&columns)
}

/// The smallest knot vector on [0, 1] whose splines contain all `curves`, themselves on [0, 1].
fn common_knots(curves: &[&Curve<DVec2>]) -> Result<Knots, NurbsError> {
    let degree = curves.iter().map(|c| c.degree()).max().unwrap_or(1);
    let mut inner: Vec<(f64, usize)> = Vec::new();
    for c in curves {
        let breaks = c.knots().breaks();
        for &t in &breaks[1..breaks.len() - 1] {
            // A break of multiplicity m keeps degree - m derivatives.
            let multiplicity = (degree + c.knots().multiplicity(t)).saturating_sub(c.degree());
            match inner.iter_mut().find(|(k, _)| (*k - t).abs() <= 1e-12) {
                Some((_, m)) => *m = multiplicity.max(*m),
                None => inner.push((t, multiplicity)),
            }
        }
    }
    inner.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut values = vec![0.0; degree + 1];
    for (t, m) in inner {
        values.extend(std::iter::repeat_n(t, m));
    }
    values.extend(std::iter::repeat_n(1.0, degree + 1));
    Knots::new(degree, values)
}

/// `curve` on other knots that contain its own: by interpolation at the Greville abscissae, which is exact.
fn in_space(curve: &Curve<DVec2>, knots: &Knots) -> Result<Curve<DVec2>, NurbsError> {
    if curve.knots() == knots {
        return Ok(curve.clone());
    }
    let (p, sites) = (knots.degree(), knots.greville());
    let lu = BandedLu::factor(sites.len(), p, |i, row| {
        let basis = knots.basis(sites[i], 0);
        row[..=p].copy_from_slice(&basis.values[0][..=p]);
        basis.first
    })?;
    let mut points: Vec<DVec2> = sites.iter().map(|&s| curve.point(s)).collect();
    lu.solve(&mut points);
    Curve::new(knots.clone(), points)
}
