//! Cut-out functions: the part of an extended medial surface that is the blade's (section 4.2).

use super::medial_surface::{points_met, stations};
use super::sides::{SIGN, Side, Tip, TwoSided};
use coolinggen_nurbs::{
    Constraint, ConstraintValue, Knots, LeastSquares, NurbsError, ParametricSurface, Surface,
    SurfaceDerivatives,
};
use glam::{DVec2, DVec3};

/// An extended medial surface m*(u*, v*) and the cut-out function c(u, v) = (u*, v*) before it, both B-splines: the medial
/// surface of a blade that ends in a point, with normals everywhere.
#[derive(Clone, Debug)]
pub(crate) struct CutOut {
    /// m*, a regular surface over [0, 1] both ways.
    pub(crate) extended: Surface<DVec3>,
    /// c. Its last column is one point (Eq. 29), its first two rows are equal (30), the last two points of its last
    /// row are equal (31), and the column before the last lies on a line with the tip (32).
    pub(crate) cut: Surface<DVec2>,
    /// Greatest distance of c from the edges asked, in u*.
    pub(crate) residual: f64,
}

impl CutOut {
    /// Cuts the part between `edges(v)`, u* of the leading and the trailing edge, which meet at v = 1, out of a surface.
    /// v* = 1 - (1 - v)^2: the tip is reached with the derivative zero, as Eq. 32 wants of v*.
    pub(crate) fn new(
        extended: Surface<DVec3>,
        knots_v: &Knots,
        edges: impl Fn(f64) -> [f64; 2],
    ) -> Result<Self, NurbsError> {
        let vs = stations(knots_v, knots_v.degree() + 3);
        let data: Vec<[f64; 2]> = vs.iter().map(|&v| edges(v)).collect();
        let last = vs.len() - 1;
        let (plain, met) = points_met(knots_v, &vs, &[0, last])?;
        let tip = data[last][0];
        let of = |k: usize| data.iter().map(|e| e[k]).collect::<Vec<f64>>();
        let ends = |line: &[f64]| met.iter().map(|c| datum(c, line)).collect::<Vec<f64>>();
        let leading = of(0);
        let leading = plain.curve(&leading, &ends(&leading))?;
        let constraints =
            [(0.0, 0), (1.0, 0), (1.0, 1)].map(|(v, order)| Constraint::derivative(knots_v, v, order));
        let [a, b, c] = constraints;
        let still = LeastSquares::new(knots_v.clone(), &vs, None, &[a?, b?, c?], None)?;
        let mut trailing = of(1);
        trailing[last] = tip;
        let trailing = still.curve(&trailing, &[trailing[0], tip, 0.0])?;
        let rise: Vec<f64> = vs.iter().map(|v| 1.0 - (1.0 - v) * (1.0 - v)).collect();
        let rise = plain.curve(&rise, &ends(&rise))?.curve;
        // u* = A + g(u) (B - A) with g = u^2 (3 - u) / 2 in Bernstein coefficients.
        let g = [0.0, 0.0, 0.5, 1.0];
        let columns = knots_v.control_count();
        let point = |g: f64, j: usize| {
            if j + 1 == columns {
                return DVec2::new(tip, 1.0);
            }
            let (a, b) = (leading.curve.points()[j], trailing.curve.points()[j]);
            let level = if j + 2 == columns { 1.0 } else { rise.points()[j] };
            // Eq. 31.
            let b = if j + 2 == columns { tip } else { b };
            DVec2::new(if g == 1.0 { b } else { a + g * (b - a) }, level)
        };
        let net = g.iter().flat_map(|&g| (0..columns).map(move |j| point(g, j)));
        let cut = Surface::new(Knots::clamped(3, &[0.0, 1.0])?, knots_v.clone(), net.collect())?;
        let residual = leading.greatest.max(trailing.greatest);
        Ok(Self { extended, cut, residual })
    }

    /// The unit normal n* o c, of the extended surface itself.
    pub(crate) fn normal(&self, u: f64, v: f64) -> DVec3 {
        let c = self.cut.point(u, v).clamp(DVec2::ZERO, DVec2::ONE);
        let (_, along, up) = self.extended.first_derivatives(c.x, c.y);
        along.cross(up).normalize()
    }
}

fn datum(value: &ConstraintValue, line: &[f64]) -> f64 {
    match *value {
        ConstraintValue::Data(i) => line[i],
        ConstraintValue::Zero => 0.0,
    }
}

/// m* o c by the chain rule.
impl ParametricSurface<DVec3> for CutOut {
    fn domain(&self) -> ((f64, f64), (f64, f64)) {
        ((0.0, 1.0), (0.0, 1.0))
    }

    fn derivatives(&self, u: f64, v: f64) -> SurfaceDerivatives<DVec3> {
        let c = self.cut.derivatives(u, v);
        let at = c.point.clamp(DVec2::ZERO, DVec2::ONE);
        let m = self.extended.derivatives(at.x, at.y);
        let first = |d: DVec2| m.u * d.x + m.v * d.y;
        let second =
            |a: DVec2, b: DVec2| m.uu * (a.x * b.x) + m.uv * (a.x * b.y + a.y * b.x) + m.vv * (a.y * b.y);
        SurfaceDerivatives {
            point: m.point,
            u: first(c.u),
            v: first(c.v),
            uu: second(c.u, c.u) + first(c.uu),
            uv: second(c.u, c.v) + first(c.uv),
            vv: second(c.v, c.v) + first(c.vv),
        }
    }

    fn breaks_u(&self) -> Vec<f64> {
        // The surface behind has its own, at places that depend on v.
        (0..=8).map(|k| f64::from(k) / 8.0).collect()
    }

    fn breaks_v(&self) -> Vec<f64> {
        self.cut.breaks_v()
    }
}

/// The sides b(t, v) = (m* o c)(u(t), v) +- d(v) (n* o c)(u(t), v) y(t) of a blade that ends in a point (Eq. 34, 35).
#[derive(Clone, Debug)]
pub(crate) struct PointedSides {
    /// The medial surface.
    pub(crate) medial: CutOut,
    /// The side along the normal, then the one against it: u(t) by Eq. 33, scaling functions that are zero at v = 1.
    pub(crate) sides: [Side; 2],
}

impl TwoSided for PointedSides {
    fn point(&self, k: usize, t: f64, v: f64) -> DVec3 {
        let side = &self.sides[k];
        let u = side.pace.at(t);
        let lift = SIGN[k] * side.scale.at(v) * side.profile.at(t)[0].y;
        self.medial.point(u, v) + self.medial.normal(u, v) * lift
    }

    fn nose(&self, k: usize) -> (f64, f64) {
        self.sides[k].nose()
    }

    fn tip(&self) -> Option<Tip> {
        // Eq. 39: the plane of m*_1 and n*.
        let c = self.medial.cut.point(0.0, 1.0);
        let m = self.medial.extended.derivatives(c.x, c.y);
        // Eq. 40: at the trailing edge n* is left of it.
        let edge = m.u.cross(m.v).normalize();
        Some(Tip { point: m.point, normal: m.u.cross(edge).normalize(), edge: Some(edge) })
    }
}
