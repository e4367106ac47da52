//! Medial surfaces that reach beyond the edges of a blade (section 4.1).

use super::medial_surface::{ends_met, stations};
use super::streamline::Streamline;
use coolinggen_nurbs::{Knots, NurbsError, Surface};
use glam::{DVec2, DVec3};

/// Data a span of the fit.
const EACH: usize = 8;

/// A streamline continued beyond both edges, with two continuous derivatives: the curvature it ends with decays over
/// half its length.
#[derive(Clone, Debug)]
pub(crate) struct Continued {
    line: Streamline,
    /// Point, slope dT/dM and its derivative at the edges.
    ends: [(DVec2, f64, f64); 2],
}

impl Continued {
    pub(crate) fn new(line: Streamline) -> Self {
        let ends = [0.0, 1.0].map(|u| {
            let [q, d, dd] = line.chart(u);
            (q, d.y / d.x, (dd.y * d.x - d.y * dd.x) / d.x.powi(3))
        });
        Self { line, ends }
    }

    /// T at M.
    pub(crate) fn at(&self, m: f64) -> f64 {
        let [first, last] = &self.ends;
        let decay = 0.5 * (last.0.x - first.0.x);
        let beyond = |&(q, slope, bend): &(DVec2, f64, f64), away: f64, sign: f64| {
            q.y + sign * slope * away + bend * decay * (away - decay * -(-away / decay).exp_m1())
        };
        if m <= first.0.x {
            beyond(first, first.0.x - m, -1.0)
        } else if m >= last.0.x {
            beyond(last, m - last.0.x, 1.0)
        } else {
            self.line.chart(self.line.at_chart(m))[0].y
        }
    }
}

/// An extended medial surface m*(u*, v*): the best in the sense of least squares through lines of constant v*, which
/// `line(v*)` draws. The first and the last line are met at their ends.
pub(crate) fn extended<E: From<NurbsError>>(
    knots_u: &Knots,
    knots_v: &Knots,
    line: impl Fn(f64) -> Result<Box<dyn Fn(f64) -> DVec3>, E>,
) -> Result<Surface<DVec3>, E> {
    let (us, vs) = (stations(knots_u, EACH), stations(knots_v, EACH));
    let mut points = vec![DVec3::ZERO; us.len() * vs.len()];
    for (j, &v) in vs.iter().enumerate() {
        let at = line(v)?;
        for (i, &u) in us.iter().enumerate() {
            points[i * vs.len() + j] = at(u);
        }
    }
    let (fit_u, values_u) = ends_met(knots_u, &us)?;
    let (fit_v, values_v) = ends_met(knots_v, &vs)?;
    Ok(fit_u.surface(&fit_v, &points, &values_u, &values_v)?)
}
