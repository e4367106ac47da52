//! Exact changes of closed surfaces: turned over, cut and joined elsewhere, rid of a seam.

use crate::surface::BladeSurface;
use coolinggen_nurbs::{Curve, Knots, NurbsError, RationalSurface, Surface, VectorSpace};

/// Applies an exact change of control nets to either form of surface.
macro_rules! on_net {
    ($surface:expr, $net:ident => $change:expr) => {
        Ok(match $surface {
            BladeSurface::BSpline($net) => BladeSurface::BSpline($change),
            BladeSurface::Rational(rational) => {
                let $net = rational.homogeneous();
                BladeSurface::Rational(RationalSurface::from_homogeneous($change)?)
            }
        })
    };
}

/// The surface with u and w exchanged.
pub(super) fn transposed(surface: &BladeSurface) -> Result<BladeSurface, NurbsError> {
    on_net!(surface, net => net.transposed())
}

/// The surface run through backwards in u.
pub(super) fn reversed_u(surface: &BladeSurface) -> Result<BladeSurface, NurbsError> {
    on_net!(surface, net => net_reversed_u(net)?)
}

/// The surface run through backwards in w.
pub(super) fn reversed_w(surface: &BladeSurface) -> Result<BladeSurface, NurbsError> {
    on_net!(surface, net => net_reversed_u(&net.transposed())?.transposed())
}

/// The surface on other domains in u and w.
pub(super) fn on_domain(
    surface: &BladeSurface,
    u: (f64, f64),
    w: (f64, f64),
) -> Result<BladeSurface, NurbsError> {
    on_net!(surface, net => {
        let knots_u = rescaled(net.knots_u(), u)?;
        Surface::new(knots_u, rescaled(net.knots_v(), w)?, net.points().to_vec())?
    })
}

/// The surface with clamped knots both ways.
pub(super) fn clamped(surface: &BladeSurface) -> Result<BladeSurface, NurbsError> {
    on_net!(surface, net => {
        let ((a, b), (c, d)) = coolinggen_nurbs::ParametricSurface::domain(net);
        net.restricted_u(a, b)?.restricted_v(c, d)?
    })
}

/// The surface with its last row of control points put equal to the first.
///
/// # Errors
/// [`NurbsError::NotJoined`] where weights differ: the same points, run through at another speed.
pub(super) fn closed_exactly(surface: &BladeSurface) -> Result<BladeSurface, NurbsError> {
    if let BladeSurface::Rational(rational) = surface {
        let net = rational.homogeneous();
        let columns = net.counts().1;
        let ends = net.points().iter().zip(&net.points()[net.points().len() - columns..]).take(columns);
        for (index, (a, b)) in ends.enumerate() {
            let gap = (a.weight / b.weight - 1.0).abs();
            if gap > 1e-9 {
                return Err(NurbsError::NotJoined { index, gap });
            }
        }
    }
    on_net!(surface, net => {
        let (rows, columns) = net.counts();
        let mut points = net.points().to_vec();
        points.copy_within(0..columns, (rows - 1) * columns);
        Surface::new(net.knots_u().clone(), net.knots_v().clone(), points)?
    })
}

/// The closed surface on u in [0, 1] begun at `start` instead: the part before comes after the rest. The former seam is
/// left as an interior knot of the least multiplicity that keeps every point within `tolerance`, mm; it comes with it.
pub(super) fn begun_at(
    surface: &BladeSurface,
    start: f64,
    tolerance: f64,
) -> Result<(BladeSurface, f64, usize), NurbsError> {
    let seam = 1.0 - start;
    let turned: Result<_, NurbsError> = on_net!(surface, net => {
        let front = net.restricted_u(start, 1.0)?;
        let back = net.restricted_u(0.0, start)?;
        glued(&[rebased(&front, (0.0, seam))?, rebased(&back, (seam, 1.0))?])?
    });
    let mut turned = turned?;
    let mut multiplicity = turned.knots_u().multiplicity(seam);
    while multiplicity > 0 {
        let Ok(less) = without_knot(&turned, seam, tolerance) else { break };
        turned = less;
        multiplicity -= 1;
    }
    Ok((turned, seam, multiplicity))
}

fn without_knot(surface: &BladeSurface, t: f64, tolerance: f64) -> Result<BladeSurface, NurbsError> {
    on_net!(surface, net => net_without_knot(net, t, tolerance)?)
}

/// The net with one occurrence of the knot `t` in u removed; no point moves by more than `tolerance`.
pub(in crate::source) fn net_without_knot<V: VectorSpace>(
    net: &Surface<V>,
    t: f64,
    tolerance: f64,
) -> Result<Surface<V>, NurbsError> {
    let (rows, columns) = net.counts();
    let mut reduced = Vec::with_capacity(columns);
    for j in 0..columns {
        let column = (0..rows).map(|i| net.points()[i * columns + j]).collect();
        reduced.push(Curve::new(net.knots_u().clone(), column)?.with_knot_removed(t, tolerance)?.0);
    }
    Surface::from_columns(&reduced, net.knots_v().clone())
}

/// One net from nets whose u domains follow each other and whose borders agree; equal degrees and v knots.
pub(in crate::source) fn glued<V: VectorSpace>(nets: &[Surface<V>]) -> Result<Surface<V>, NurbsError> {
    let Some(first) = nets.first() else {
        return Err(NurbsError::PointCount { count: 0, expected: 1 });
    };
    let (degree, columns) = (first.knots_u().degree(), first.counts().1);
    let mut values = first.knots_u().values().to_vec();
    let mut points = first.points().to_vec();
    for net in &nets[1..] {
        values.pop();
        values.extend_from_slice(&net.knots_u().values()[degree + 1..]);
        points.extend_from_slice(&net.points()[columns..]);
    }
    Surface::new(Knots::new(degree, values)?, first.knots_v().clone(), points)
}

/// The net on another domain in u.
pub(in crate::source) fn rebased<V: VectorSpace>(
    net: &Surface<V>,
    u: (f64, f64),
) -> Result<Surface<V>, NurbsError> {
    Surface::new(rescaled(net.knots_u(), u)?, net.knots_v().clone(), net.points().to_vec())
}

fn rescaled(knots: &Knots, (start, end): (f64, f64)) -> Result<Knots, NurbsError> {
    let (a, b) = knots.domain();
    let scale = (end - start) / (b - a);
    let map = |k: f64| match k {
        k if k == a => start,
        k if k == b => end,
        k => start + (k - a) * scale,
    };
    Knots::new(knots.degree(), knots.values().iter().map(|&k| map(k)).collect())
}

pub(in crate::source) fn net_reversed_u<V: VectorSpace>(net: &Surface<V>) -> Result<Surface<V>, NurbsError> {
    let (start, end) = net.knots_u().domain();
    let values = net.knots_u().values().iter().rev().map(|k| start + (end - k)).collect();
    let knots = Knots::new(net.knots_u().degree(), values)?;
    let points = net.points().chunks_exact(net.counts().1).rev().flatten().copied().collect();
    Surface::new(knots, net.knots_v().clone(), points)
}
