//! The eight surfaces of a turn: lofts of its rings between the chambers' own end rings.

use super::shape::{STENCIL, TurnShape};
use super::{PARTS, TurnRefusal};
use crate::build::BuildError;
use crate::section::SEGMENTS;
use crate::watch::Watch;
use coolinggen_nurbs::{Curve, Interpolator, ParametricCurve, ParametricSurface, Surface};
use glam::DVec3;
use std::f64::consts::PI;

/// The end of a chamber at the turn: each segment's border, in the turn's order and direction, and how the chamber's
/// surface arrives there.
#[derive(Clone, Debug)]
pub(crate) struct EndRow {
    /// Borders, bit for bit.
    pub(crate) curves: Vec<Curve<DVec3>>,
    /// Derivatives of the surfaces across the border, as curves over it.
    pub(crate) across: Vec<Curve<DVec3>>,
}

/// Eight surfaces over (t, q): t along the ring, q from 0 at the first chamber's end to 1 at the second's.
#[derive(Clone, Debug)]
pub(crate) struct TurnSurfaces {
    pub(crate) surfaces: Vec<Surface<DVec3>>,
    /// Greatest distance of the shape between the rings from the lofts, normal to them, mm.
    pub(crate) deviation: f64,
}

/// Distance between loft and shape that ends the refinement, mm; shapes blend, so that this is smoothness rather than
/// truth.
const TOLERANCE: f64 = 1e-3;
const LEAST_ROWS: usize = 16;
const MOST_ROWS: usize = 192;

/// Lofts the rings between the ends of the front and the back chamber, from `first` (0 front, 1 back) to the other.
pub(crate) fn loft(
    shape: &TurnShape,
    ends: &[EndRow; 2],
    first: usize,
    watch: &dyn Watch,
) -> Result<TurnSurfaces, BuildError> {
    let mut rows = LEAST_ROWS;
    loop {
        watch.go_on()?;
        let made = loft_rows(shape, ends, first, rows)?;
        if made.deviation <= TOLERANCE || rows >= MOST_ROWS {
            return Ok(made);
        }
        // Even, so that one ring stands half way round.
        rows += rows / 4 * 2;
    }
}

impl TurnSurfaces {
    /// A surface that folds over: one whose normal turns by a right angle or more between neighbours of a grid.
    pub(crate) fn fold(&self) -> Option<TurnRefusal> {
        self.surfaces.iter().zip(PARTS).find(|(s, _)| folds(s)).map(|(_, part)| TurnRefusal::Fold { part })
    }
}

fn folds(surface: &Surface<DVec3>) -> bool {
    const ACROSS: u32 = 16;
    let along = surface.breaks_v();
    let normal = |i: u32, v: f64| {
        let (_, du, dv) = surface.first_derivatives(f64::from(i) / f64::from(ACROSS), v);
        du.cross(dv)
    };
    let rows: Vec<Vec<DVec3>> = along.iter().map(|&v| (0..=ACROSS).map(|i| normal(i, v)).collect()).collect();
    // Written so that NaN counts as a fold.
    let turns = |a: &DVec3, b: &DVec3| !(a.dot(*b) > 0.0);
    rows.iter().any(|row| row.windows(2).any(|p| turns(&p[0], &p[1])))
        || rows.windows(2).any(|pair| pair[0].iter().zip(&pair[1]).any(|(a, b)| turns(a, b)))
}

/// Values of a segment's curve at the nodes with the slopes at both ends, from values at its stations.
fn with_slopes(values: &[DVec3]) -> (Vec<DVec3>, DVec3, DVec3) {
    let last = values.len() - 1;
    // Second order one-sided differences.
    let slope = |a: DVec3, b: DVec3, c: DVec3| (b * 4.0 - a * 3.0 - c) / (2.0 * STENCIL);
    let start = slope(values[0], values[1], values[2]);
    let end = -slope(values[last], values[last - 1], values[last - 2]);
    let mut nodes = vec![values[0]];
    nodes.extend(&values[3..last - 2]);
    nodes.push(values[last]);
    (nodes, start, end)
}

fn loft_rows(
    shape: &TurnShape,
    ends: &[EndRow; 2],
    first: usize,
    count: usize,
) -> Result<TurnSurfaces, BuildError> {
    let second = 1 - first;
    let sign = if first == 0 { 1.0 } else { -1.0 };
    let place = |q: f64| if first == 0 { q } else { 1.0 - q };
    let parameters: Vec<f64> = (0..=count).map(|i| i as f64 / count as f64).collect();
    let across = Interpolator::with_slopes(&parameters)?;
    // Values at all stations of all rows, corners shared bit for bit between neighbours.
    let mut rows: Vec<[Vec<DVec3>; SEGMENTS]> =
        (1..count).map(|i| std::array::from_fn(|k| shape.points(k, place(parameters[i])))).collect();
    let mut slopes = [first, second].map(|chamber| end_slopes(shape, &ends[chamber], chamber, sign));
    rows.iter_mut().chain(&mut slopes).for_each(share_corners);
    let mut surfaces = Vec::with_capacity(SEGMENTS);
    let mut deviation = 0.0f64;
    for k in 0..SEGMENTS {
        let border = &ends[0].curves[k];
        let along = Interpolator::with_slopes(&border.breaks())?;
        let curve = |values: &[DVec3]| -> Result<Vec<DVec3>, BuildError> {
            let (points, start, end) = with_slopes(values);
            Ok(along.curve_with_slopes(&points, start, end)?.points().to_vec())
        };
        let mut nets = vec![ends[first].curves[k].points().to_vec()];
        for row in &rows {
            nets.push(curve(&row[k])?);
        }
        nets.push(ends[second].curves[k].points().to_vec());
        let (start, finish) = (curve(&slopes[0][k])?, curve(&slopes[1][k])?);
        let mut net = Vec::new();
        for i in 0..start.len() {
            let column: Vec<DVec3> = nets.iter().map(|row| row[i]).collect();
            let mut lofted = across.curve_with_slopes(&column, start[i], finish[i])?.points().to_vec();
            let end = lofted.len() - 1;
            (lofted[0], lofted[end]) = (column[0], column[count]);
            net.extend(lofted);
        }
        let surface = Surface::new(border.knots().clone(), across.knots().clone(), net)?;
        deviation = deviation.max(deviation_between(shape, k, &surface, &parameters, place));
        surfaces.push(surface);
    }
    Ok(TurnSurfaces { surfaces, deviation })
}

/// Derivatives in q at an end ring, with the sense of q: along the chamber's surface, so that both have one tangent
/// plane.
fn end_slopes(shape: &TurnShape, end: &EndRow, chamber: usize, sign: f64) -> [Vec<DVec3>; SEGMENTS] {
    std::array::from_fn(|k| {
        let rises = shape.rise(k, chamber).into_iter().zip(shape.end_ring(k, chamber));
        let stations = shape.stations[k].iter().zip(rises);
        stations
            .map(|(&t, (rise, q))| {
                let across = end.across[k].point(t);
                let zeta = (shape.chart.map(q).slopes.inverse() * across).z;
                across * (sign * rise / zeta * PI)
            })
            .collect()
    })
}

/// Gives the last value of each segment the bits of the next segment's first.
fn share_corners(row: &mut [Vec<DVec3>; SEGMENTS]) {
    for k in 0..SEGMENTS {
        let corner = row[(k + 1) % SEGMENTS][0];
        if let Some(last) = row[k].last_mut() {
            *last = corner;
        }
    }
}

/// Greatest distance of the shape half way between the rings from the surface, normal to it.
fn deviation_between(
    shape: &TurnShape,
    k: usize,
    surface: &Surface<DVec3>,
    parameters: &[f64],
    place: impl Fn(f64) -> f64,
) -> f64 {
    let mut worst = 0.0f64;
    for pair in parameters.windows(2) {
        let q = 0.5 * (pair[0] + pair[1]);
        for (&t, point) in shape.stations[k].iter().zip(shape.points(k, place(q))) {
            let (at, du, dv) = surface.first_derivatives(t, q);
            worst = worst.max((point - at).dot(du.cross(dv).normalize_or_zero()).abs());
        }
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;
    use coolinggen_nurbs::Knots;

    /// A strip over x from 0 to 1 whose three rows stand at these y.
    fn strip(rows: [f64; 3]) -> TurnSurfaces {
        let points = [0.0, 1.0].into_iter().flat_map(|x| rows.map(|y| DVec3::new(x, y, 0.1 * y * y)));
        let knots = |breaks: &[f64]| Knots::clamped(1, breaks).unwrap();
        let surface = Surface::new(knots(&[0.0, 1.0]), knots(&[0.0, 0.5, 1.0]), points.collect()).unwrap();
        TurnSurfaces { surfaces: vec![surface], deviation: 0.0 }
    }

    #[test]
    fn a_face_that_runs_back_over_itself_is_a_fold() {
        assert_eq!(strip([0.0, 1.0, 2.0]).fold(), None);
        assert_eq!(strip([0.0, 1.0, 0.4]).fold(), Some(TurnRefusal::Fold { part: PARTS[0] }));
    }
}
