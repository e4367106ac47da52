//! The medial surface as a B-spline, with its normals (sections 3.1 and 3.3).

use super::streamline::Streamline;
use coolinggen_nurbs::{
    Constraint, ConstraintValue, Knots, LeastSquares, NurbsError, ParametricSurface, Surface,
};
use glam::DVec3;

/// A B-spline surface m(u, v) near streamlines, u from the leading to the trailing edge, v from hub to shroud, both over
/// [0, 1]. Its first two rows of control points are equal (Eq. 9), so that m_1(0, v) = 0; its normals are well defined
/// all the same (Lemma 2).
///
/// Along each streamline the parameter runs as g(u) = u^2 (3 - u) / 2 of the arc length: it stands still at the leading
/// edge, as Eq. 9 wants, and equally for all streamlines, so that one u(t) serves all of them (remark 1 of the paper).
#[derive(Clone, Debug)]
pub(crate) struct MedialSurface {
    /// The surface.
    pub(crate) surface: Surface<DVec3>,
    /// Its unit normals as a B-spline n(u, v) of the same degrees and knots.
    pub(crate) normals: Surface<DVec3>,
    /// Greatest distance to the streamlines at equal parameters, seen between the data, mm.
    pub(crate) residual: f64,
    /// Greatest angle between streamlines and surface at leading and trailing edge, seen between the data, radians.
    pub(crate) angle_residual: f64,
    /// Greatest distance of n from the unit normal of the surface, seen between the data.
    pub(crate) normal_residual: f64,
}

/// The part of the arc length that is behind at u, and its derivatives at both ends.
fn pace(u: f64) -> f64 {
    0.5 * u * u * (3.0 - u)
}
/// g''(0) and g'(1).
const SECOND_AT_START: f64 = 3.0;
const FIRST_AT_END: f64 = 1.5;

/// Streamlines a span of the knots in v, and places a span of those in u: a span takes one control point.
const LINES: usize = 4;
const PLACES: usize = 6;

/// Streamlines at the stations that fits on some knots in v take, and some between to check these fits with.
#[derive(Clone, Debug)]
pub(crate) struct Streamlines {
    knots: Knots,
    v: Vec<f64>,
    lines: Vec<Streamline>,
    checks: Vec<(f64, Streamline)>,
}

impl Streamlines {
    /// Draws them; `streamline` draws the one of v.
    pub(crate) fn new<E>(knots: Knots, streamline: impl Fn(f64) -> Result<Streamline, E>) -> Result<Self, E> {
        let v = stations(&knots, LINES);
        let lines = v.iter().map(|&v| streamline(v)).collect::<Result<_, _>>()?;
        let between = |j: usize| 0.5 * (v[j] + v[j + 1]);
        let checks = [1, 3, 5, 7].map(|j| between(j * (v.len() - 2) / 8));
        let checks = checks.into_iter().map(|v| Ok((v, streamline(v)?))).collect::<Result<_, E>>()?;
        Ok(Self { knots, v, lines, checks })
    }
}

impl MedialSurface {
    /// The best surface on `knots_u` and the streamlines' knots in the sense of least squares (Eq. 10), with Eq. 9.
    /// Points, the direction at the leading edge and the derivative at the trailing edge are met.
    pub(crate) fn new(knots_u: &Knots, streamlines: &Streamlines) -> Result<Self, NurbsError> {
        let (us, vs) = (stations(knots_u, PLACES), &streamlines.v);
        let mut points = vec![DVec3::ZERO; (us.len() + 2) * vs.len()];
        for (j, line) in streamlines.lines.iter().enumerate() {
            for (i, p) in column(line, &us).into_iter().enumerate() {
                points[i * vs.len() + j] = p;
            }
        }
        // The last two rows are derivatives: constraints name them, their weights as data are zero.
        let n = us.len();
        let parameters: Vec<f64> = us.iter().copied().chain([0.0, 1.0]).collect();
        let weights: Vec<f64> = (0..n + 2).map(|i| if i < n { 1.0 } else { 0.0 }).collect();
        let along_u = [
            (Constraint::derivative(knots_u, 0.0, 0)?, ConstraintValue::Data(0)),
            (Constraint::difference(0, 1), ConstraintValue::Zero),
            (Constraint::derivative(knots_u, 0.0, 2)?, ConstraintValue::Data(n)),
            (Constraint::derivative(knots_u, 1.0, 0)?, ConstraintValue::Data(n - 1)),
            (Constraint::derivative(knots_u, 1.0, 1)?, ConstraintValue::Data(n + 1)),
        ];
        let (constraints_u, values_u): (Vec<_>, Vec<_>) = along_u.into_iter().unzip();
        let fit_u = LeastSquares::new(knots_u.clone(), &parameters, Some(&weights), &constraints_u, None)?;
        let (fit_v, values_v) = ends_met(&streamlines.knots, vs)?;
        let surface = with_equal_first_rows(&fit_u.surface(&fit_v, &points, &values_u, &values_v)?)?;
        let residual = residual(&surface, &streamlines.checks);
        let angle_residual = angle_residual(&surface, &streamlines.checks);
        let (normals, normal_residual) = normals(&surface, &us, vs)?;
        Ok(Self { surface, normals, residual, angle_residual, normal_residual })
    }
}

/// Points at `us` and the two derivatives that constraints need: the second at the start, the first at the end.
fn column(streamline: &Streamline, us: &[f64]) -> Vec<DVec3> {
    let length = streamline.length();
    let mut out: Vec<DVec3> = us.iter().map(|&u| streamline.at(streamline.at_fraction(pace(u))).0).collect();
    out.push(streamline.at(0.0).1.normalize() * (SECOND_AT_START * length));
    out.push(streamline.at(1.0).1.normalize() * (FIRST_AT_END * length));
    out
}

/// Data parameters for a fit on `knots`: `each` evenly in every span, more at repeated knots, the breaks among them.
pub(super) fn stations(knots: &Knots, each: usize) -> Vec<f64> {
    let breaks = knots.breaks();
    let last = breaks.len() - 1;
    let repeated = |i: usize| i > 0 && i < last && knots.multiplicity(breaks[i]) > 1;
    let mut out = Vec::new();
    for i in 0..last {
        let count = if repeated(i) || repeated(i + 1) { each.max(knots.degree() + 3) } else { each };
        out.extend((0..count).map(|k| breaks[i] + (breaks[i + 1] - breaks[i]) * k as f64 / count as f64));
    }
    out.push(breaks[last]);
    out
}

/// A fit that meets the data of these indices, and what its constraints equal.
pub(super) fn points_met(
    knots: &Knots,
    parameters: &[f64],
    met: &[usize],
) -> Result<(LeastSquares, Vec<ConstraintValue>), NurbsError> {
    let constraint = |i: &usize| Constraint::derivative(knots, parameters[*i], 0);
    let constraints = met.iter().map(constraint).collect::<Result<Vec<_>, _>>()?;
    let fit = LeastSquares::new(knots.clone(), parameters, None, &constraints, None)?;
    Ok((fit, met.iter().map(|&i| ConstraintValue::Data(i)).collect()))
}

/// A fit that meets the first and the last datum.
pub(super) fn ends_met(
    knots: &Knots,
    parameters: &[f64],
) -> Result<(LeastSquares, Vec<ConstraintValue>), NurbsError> {
    points_met(knots, parameters, &[0, parameters.len() - 1])
}

/// The surface with its second row of control points put equal to the first, which it is but for rounding.
fn with_equal_first_rows(surface: &Surface<DVec3>) -> Result<Surface<DVec3>, NurbsError> {
    let columns = surface.counts().1;
    let mut points = surface.points().to_vec();
    points.copy_within(0..columns, columns);
    Surface::new(surface.knots_u().clone(), surface.knots_v().clone(), points)
}

/// The unit normal of a medial surface, Eq. 13 at the leading edge.
pub(crate) fn unit_normal(surface: &Surface<DVec3>, u: f64, v: f64) -> DVec3 {
    // Near the edge m_1(u) = u m_11(u / 2) but for terms in u^3, without the cancellation.
    const NEAR: f64 = 1e-5;
    let d = surface.derivatives(u, v);
    let along = if u < NEAR { surface.derivatives(0.5 * u, v).uu } else { d.u };
    along.cross(d.v).normalize()
}

fn normals(surface: &Surface<DVec3>, us: &[f64], vs: &[f64]) -> Result<(Surface<DVec3>, f64), NurbsError> {
    let (fit_u, values_u) = ends_met(surface.knots_u(), us)?;
    let (fit_v, values_v) = ends_met(surface.knots_v(), vs)?;
    let grid = us.iter().flat_map(|&u| vs.iter().map(move |&v| unit_normal(surface, u, v)));
    let normals = fit_u.surface(&fit_v, &grid.collect::<Vec<_>>(), &values_u, &values_v)?;
    let mut worst: f64 = 0.0;
    // Between the data, at every other place.
    for u in us.windows(2).step_by(2).map(|w| 0.5 * (w[0] + w[1])) {
        for v in vs.windows(2).step_by(2).map(|w| 0.5 * (w[0] + w[1])) {
            worst = worst.max(normals.point(u, v).distance(unit_normal(surface, u, v)));
        }
    }
    Ok((normals, worst))
}

fn residual(surface: &Surface<DVec3>, checks: &[(f64, Streamline)]) -> f64 {
    let mut worst: f64 = 0.0;
    for (v, line) in checks {
        for i in 0..=200 {
            let u = f64::from(i) / 200.0;
            worst = worst.max(surface.point(u, *v).distance(line.at(line.at_fraction(pace(u))).0));
        }
    }
    worst
}

fn angle_residual(surface: &Surface<DVec3>, checks: &[(f64, Streamline)]) -> f64 {
    let mut worst: f64 = 0.0;
    for (v, line) in checks {
        // The first derivative is zero at the leading edge: the second one has the direction.
        let ends = [(surface.derivatives(0.0, *v).uu, 0.0), (surface.derivatives(1.0, *v).u, 1.0)];
        for (along, u) in ends {
            let asked = line.at(u).1.normalize();
            worst = worst.max(along.normalize().cross(asked).length());
        }
    }
    worst
}
