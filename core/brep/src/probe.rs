//! Surfaces evaluated along curves: fast where neighbouring points share their knot spans.

use crate::cursor::Cursor;
use crate::geometry::SurfaceGeometry;
use crate::lanes::{Lanes, Real};
use crate::span::{Span, weighted_sum};
use coolinggen_nurbs::{Knots, MAX_DEGREE, ParametricSurface, Surface};
use glam::{DVec2, DVec3};

/// A surface with what was learned at the last point: fast where the next one is near.
pub struct SurfaceProbe<'a> {
    pub(crate) surface: &'a SurfaceGeometry,
    kind: Kind<'a>,
}

enum Kind<'a> {
    /// The spans of the last point.
    BSpline(&'a Surface<DVec3>, Box<[Span; 2]>),
    /// The meridian's span of the last point.
    Revolution(Box<Cursor<'a, DVec2>>),
    /// Evaluated from scratch.
    Other,
}

impl<'a> SurfaceProbe<'a> {
    /// A probe that has learned nothing yet.
    pub fn new(surface: &'a SurfaceGeometry) -> Self {
        let first = |knots: &Knots| Span::new(knots, knots.span(knots.domain().0));
        let kind = match surface {
            SurfaceGeometry::BSpline(s) => {
                Kind::BSpline(s, Box::new([first(s.knots_u()), first(s.knots_v())]))
            }
            SurfaceGeometry::Revolution(s) => Kind::Revolution(Box::new(Cursor::new(s.meridian()))),
            _ => Kind::Other,
        };
        Self { surface, kind }
    }

    /// The point at `at`.
    #[inline]
    pub(crate) fn point(&mut self, at: DVec2) -> DVec3 {
        match &mut self.kind {
            Kind::BSpline(surface, spans) => {
                spans[0].seek(surface.knots_u(), at.x);
                spans[1].seek(surface.knots_v(), at.y);
                tensor(surface, spans, at)
            }
            Kind::Revolution(meridian) => {
                let (p, (sin, cos)) = (meridian.point(at.y), at.x.sin_cos());
                DVec3::new(p.x, p.y * sin, p.y * cos)
            }
            Kind::Other => self.surface.point(at.x, at.y),
        }
    }

    /// Point and first derivatives in u and v at `(u, v)`; outside the domain the end polynomials are continued.
    pub fn first_derivatives(&mut self, u: f64, v: f64) -> (DVec3, DVec3, DVec3) {
        if let Kind::BSpline(surface, spans) = &mut self.kind {
            spans[0].seek(surface.knots_u(), u);
            spans[1].seek(surface.knots_v(), v);
            match (surface.knots_u().degree(), surface.knots_v().degree()) {
                (3, 3) => return tensor_slopes::<4, 4>(surface, spans, u, v),
                (3, 1) => return tensor_slopes::<4, 2>(surface, spans, u, v),
                _ => {}
            }
        }
        self.surface.first_derivatives(u, v)
    }

    /// The points at four parameters, coordinate by coordinate.
    #[inline]
    pub(crate) fn four(&mut self, [u, v]: [Lanes; 2]) -> [Lanes; 3] {
        if let Kind::Revolution(meridian) = &mut self.kind {
            let [x, r] = meridian.four(v);
            let (sin, cos) = u.sin_cos();
            return [x, r * sin, r * cos];
        }
        if let Kind::BSpline(surface, spans) = &mut self.kind {
            spans[0].seek(surface.knots_u(), u.0[0]);
            spans[1].seek(surface.knots_v(), v.0[0]);
            // Mostly the four lie in the same spans.
            if spans[0].holds(u) && spans[1].holds(v) {
                match (surface.knots_u().degree(), surface.knots_v().degree()) {
                    (3, 3) => return fixed_tensor::<4, 4, Lanes>(surface, spans, [u, v]),
                    (3, 1) => return fixed_tensor::<4, 2, Lanes>(surface, spans, [u, v]),
                    _ => {}
                }
            }
        }
        let mut out = [Lanes::from(0.0); 3];
        for lane in 0..4 {
            let point = self.point(DVec2::new(u.0[lane], v.0[lane]));
            (out[0].0[lane], out[1].0[lane], out[2].0[lane]) = (point.x, point.y, point.z);
        }
        out
    }

    /// Unit normal at `at`; zero in a pole.
    pub(crate) fn normal(&self, at: DVec2) -> DVec3 {
        let (_, du, dv) = self.surface.first_derivatives(at.x, at.y);
        du.cross(dv).normalize_or_zero()
    }
}

#[inline]
fn tensor(surface: &Surface<DVec3>, spans: &[Span; 2], at: DVec2) -> DVec3 {
    match (surface.knots_u().degree(), surface.knots_v().degree()) {
        // The usual degrees have loops of known length.
        (3, 3) => {
            let [x, y, z] = fixed_tensor::<4, 4, f64>(surface, spans, [at.x, at.y]);
            return DVec3::new(x, y, z);
        }
        (3, 1) => {
            let [x, y, z] = fixed_tensor::<4, 2, f64>(surface, spans, [at.x, at.y]);
            return DVec3::new(x, y, z);
        }
        _ => {}
    }
    let q = surface.knots_v().degree();
    let count = surface.counts().1;
    let mut m = [0.0; MAX_DEGREE + 1];
    spans[1].values(at.y, &mut m);
    let mut across = [DVec3::ZERO; MAX_DEGREE + 1];
    let first = spans[0].first();
    for (i, point) in across[..=spans[0].index - first].iter_mut().enumerate() {
        let row = &surface.points()[(first + i) * count + spans[1].first()..];
        *point = weighted_sum(&m[..=q], row);
    }
    spans[0].blend(at.x, &across)
}

/// The point, or four of them in the same spans, for degrees `N - 1` and `M - 1`.
#[inline(always)]
fn fixed_tensor<const N: usize, const M: usize, T: Real>(
    surface: &Surface<DVec3>,
    spans: &[Span; 2],
    [u, v]: [T; 2],
) -> [T; 3] {
    let (n, m) = (spans[0].fixed_values::<N, T>(u), spans[1].fixed_values::<M, T>(v));
    let count = surface.counts().1;
    let mut out = [T::from(0.0); 3];
    for k in 0..N {
        let start = (spans[0].first() + k) * count + spans[1].first();
        let row = &surface.points()[start..start + M];
        let mut across = [T::from(0.0); 3];
        for l in 0..M {
            for (across, coordinate) in across.iter_mut().zip(row[l].to_array()) {
                *across = *across + m[l] * T::from(coordinate);
            }
        }
        for (out, across) in out.iter_mut().zip(across) {
            *out = *out + n[k] * across;
        }
    }
    out
}

/// Point and first derivatives for degrees `N - 1` and `M - 1`.
#[inline(always)]
fn tensor_slopes<const N: usize, const M: usize>(
    surface: &Surface<DVec3>,
    spans: &[Span; 2],
    u: f64,
    v: f64,
) -> (DVec3, DVec3, DVec3) {
    let ((n, d), (m, e)) = (spans[0].fixed_slopes::<N, f64>(u), spans[1].fixed_slopes::<M, f64>(v));
    let count = surface.counts().1;
    // Values and slopes side by side: pairs for vector instructions.
    let mut along = [[0.0; 2]; 3];
    let mut slopes = [0.0; 3];
    for k in 0..N {
        let start = (spans[0].first() + k) * count + spans[1].first();
        let row = &surface.points()[start..start + M];
        let mut across = [[0.0; 2]; 3];
        for l in 0..M {
            for (across, coordinate) in across.iter_mut().zip(row[l].to_array()) {
                across[0] += m[l] * coordinate;
                across[1] += e[l] * coordinate;
            }
        }
        for i in 0..3 {
            along[i][0] += n[k] * across[i][0];
            along[i][1] += n[k] * across[i][1];
            slopes[i] += d[k] * across[i][0];
        }
    }
    let [x, y, z] = along;
    (DVec3::new(x[0], y[0], z[0]), DVec3::from_array(slopes), DVec3::new(x[1], y[1], z[1]))
}
