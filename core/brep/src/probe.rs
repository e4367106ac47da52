//! Surfaces evaluated along curves: fast where neighbouring points share their knot spans.

use crate::cursor::Cursor;
use crate::geometry::SurfaceGeometry;
use crate::lanes::Lanes;
use crate::span::{Span, weighted_sum};
use coolinggen_nurbs::{Knots, MAX_DEGREE, ParametricSurface, Surface};
use glam::{DVec2, DVec3};

/// A surface with what was learned at the last point.
pub(crate) struct SurfaceProbe<'a> {
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
    pub(crate) fn new(surface: &'a SurfaceGeometry) -> Self {
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

    /// The points at four parameters, coordinate by coordinate.
    #[inline]
    pub(crate) fn four(&mut self, [u, v]: [Lanes; 2]) -> [Lanes; 3] {
        if let Kind::Revolution(meridian) = &mut self.kind {
            let [x, r] = meridian.four(v);
            let (sin, cos) = u.sin_cos();
            return [x, r * sin, r * cos];
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
