//! How far edges are from the images of their parameter curves.

use super::{EDGE_TOLERANCE_MM, EdgePlace};
use crate::cursor::Cursor;
use crate::geometry::{EdgeCurve, SurfaceGeometry};
use crate::lanes::Lanes;
use crate::model::{Coedge, Edge, FaceId};
use crate::probe::SurfaceProbe;
use crate::span::full_spans;
use coolinggen_nurbs::{Curve, Knots, ParametricCurve};
use glam::{DVec2, DVec3};

/// Places in each span where both are compared: the middle, where a cubic interpolant errs most, and three more
/// that are not its mirror images.
const FRACTIONS: [f64; 4] = [0.12, 0.33, 0.5, 0.79];

/// Less than this, mm, need not be told from nothing: rounding at 10 m.
const NEGLIGIBLE: f64 = 1e-11;

/// The greatest distance, mm, at the same parameters between `curve` and the image on `surface` of `pcurve`, which has
/// the same knots, as measured in the middle of each span: there interpolants err most.
pub fn deviation_amid_spans(surface: &SurfaceGeometry, curve: &Curve<DVec3>, pcurve: &Curve<DVec2>) -> f64 {
    let mut probe = SurfaceProbe::new(surface);
    let mut cursor = Cursor::new(curve);
    let mut worst = 0.0f64;
    for index in full_spans(curve.knots()) {
        cursor.enter(index);
        let t = 0.5 * (cursor.span.start + cursor.span.end);
        let at = cursor.span.point(t, pcurve.points());
        worst = worst.max(probe.point(at).distance_squared(cursor.point_in_span(t)));
    }
    worst.sqrt()
}

/// The greatest deviations so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gauge {
    /// Distance at the same parameter, mm, and where.
    pub(crate) deviation: (f64, Option<EdgePlace>),
    /// The part of it along the normal.
    pub(crate) distance: (f64, Option<EdgePlace>),
}

impl Gauge {
    /// Takes note of what another has found.
    pub(super) fn include(&mut self, other: &Self) {
        self.note(other.deviation.0, 0.0, other.deviation.1);
        self.note(0.0, other.distance.0, other.distance.1);
    }

    /// Compares an edge with its image on a face; returns the greatest deviation, or a bound on it that is below
    /// the greatest so far or negligible.
    pub(super) fn measure(
        &mut self,
        probe: &mut SurfaceProbe<'_>,
        face: FaceId,
        coedge: &Coedge,
        edge: &Edge,
    ) -> f64 {
        let place = |parameter| Some(EdgePlace { face, edge: coedge.edge, parameter });
        let pcurve = &coedge.pcurve;
        let mut flat = Cursor::new(pcurve);
        let curve = match &edge.curve {
            EdgeCurve::BSpline(curve) => curve,
            EdgeCurve::Rational(curve) => {
                let knots = [curve.homogeneous().knots(), pcurve.knots()];
                let worst = self.sample(knots, probe, place, |probe, t| {
                    let at = flat.four(t);
                    let points = t.0.map(|t| curve.point(t));
                    let point = [0, 1, 2].map(|i| Lanes(points.map(|p| p[i])));
                    (at, minus(point, probe.four(at)))
                });
                return self.sample_ends(worst, coedge, probe, place, |t| curve.point(t));
            }
        };
        let line = IsoLine::new(probe.surface, pcurve);
        if let Some(bound) = bound(curve, coedge, probe.surface, line.as_ref()) {
            if bound <= NEGLIGIBLE {
                self.note(bound, bound, place(curve.domain().0));
                return bound;
            }
            if bound <= self.deviation.0.min(self.distance.0).min(EDGE_TOLERANCE_MM) {
                return bound;
            }
        }
        let knots = [curve.knots(), pcurve.knots()];
        let mut cursor = Cursor::new(curve);
        let worst = if let Some(line) = &line {
            let mut image = Cursor::new(&line.curve);
            self.sample(knots, probe, place, |_, t| {
                let at = t.0.map(|t| line.at(t));
                let at = [Lanes(at.map(|p| p.x)), Lanes(at.map(|p| p.y))];
                (at, minus(cursor.four(t), image.four(at[line.axis])))
            })
        } else if curve.knots() == pcurve.knots() {
            // One basis serves both.
            self.sample(knots, probe, place, |probe, t| {
                cursor.seek(t.0[0]);
                let (point, at) = cursor.span.four(t, curve.points(), pcurve.points());
                (at, minus(point, probe.four(at)))
            })
        } else {
            self.sample(knots, probe, place, |probe, t| {
                let at = flat.four(t);
                (at, minus(cursor.four(t), probe.four(at)))
            })
        };
        self.sample_ends(worst, coedge, probe, place, |t| curve.point(t))
    }

    /// Compares between all knots; `off` gives surface parameters and the difference there.
    #[inline(always)]
    fn sample(
        &mut self,
        knots: [&Knots; 2],
        probe: &mut SurfaceProbe<'_>,
        place: impl Fn(f64) -> Option<EdgePlace>,
        mut off: impl FnMut(&mut SurfaceProbe<'_>, Lanes) -> ([Lanes; 2], [Lanes; 3]),
    ) -> f64 {
        let mut worst = 0.0f64;
        for_each_interval(knots, |start, end| {
            let t = Lanes(FRACTIONS.map(|fraction| start + (end - start) * fraction));
            let ([u, v], [x, y, z]) = off(probe, t);
            // Mostly this is all: neither a root nor a normal is needed.
            let limit = (worst * worst).min(self.distance.0 * self.distance.0);
            if (x * x + y * y + z * z).max() <= limit {
                return;
            }
            for lane in 0..4 {
                let off = DVec3::new(x.0[lane], y.0[lane], z.0[lane]);
                let at = DVec2::new(u.0[lane], v.0[lane]);
                worst = self.compare(worst, off, probe, at, || place(t.0[lane]));
            }
        });
        worst
    }

    /// Compares at the ends.
    fn sample_ends(
        &mut self,
        mut worst: f64,
        coedge: &Coedge,
        probe: &mut SurfaceProbe<'_>,
        place: impl Fn(f64) -> Option<EdgePlace>,
        mut point: impl FnMut(f64) -> DVec3,
    ) -> f64 {
        let (start, end) = coedge.pcurve.domain();
        for t in [start, end] {
            let at = coedge.pcurve.point(t);
            let off = point(t) - probe.point(at);
            worst = self.compare(worst, off, probe, at, || place(t));
        }
        worst
    }

    /// Takes note of the difference `off` at the surface parameters `at`.
    fn compare(
        &mut self,
        worst: f64,
        off: DVec3,
        probe: &SurfaceProbe<'_>,
        at: DVec2,
        place: impl Fn() -> Option<EdgePlace>,
    ) -> f64 {
        let deviation = off.length();
        let distance = if deviation > self.distance.0.max(NEGLIGIBLE) {
            off.dot(probe.normal(at)).abs()
        } else {
            // No more than the greatest so far, or rounding that is not worth a normal.
            deviation.min(NEGLIGIBLE)
        };
        if deviation > self.deviation.0 || distance > self.distance.0 || deviation.is_nan() {
            self.note(deviation, distance, place());
        }
        // NaN must not get lost.
        if deviation <= worst { worst } else { deviation }
    }

    fn note(&mut self, deviation: f64, distance: f64, place: Option<EdgePlace>) {
        if deviation > self.deviation.0 || deviation.is_nan() {
            self.deviation = (deviation, place);
        }
        if distance > self.distance.0 {
            self.distance = (distance, place);
        }
    }
}

#[inline(always)]
fn minus(a: [Lanes; 3], b: [Lanes; 3]) -> [Lanes; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A parameter line of a B-spline surface, as a straight parameter curve runs through it.
struct IsoLine {
    curve: Curve<DVec3>,
    /// The parameter that runs.
    axis: usize,
    /// Domain of the parameter curve, and its ends.
    domain: (f64, f64),
    ends: [DVec2; 2],
}

impl IsoLine {
    fn new(surface: &SurfaceGeometry, pcurve: &Curve<DVec2>) -> Option<Self> {
        let SurfaceGeometry::BSpline(surface) = surface else { return None };
        let ([a, b], 1) = (pcurve.points(), pcurve.degree()) else { return None };
        let (domain, ends) = (pcurve.domain(), [*a, *b]);
        if a.x == b.x {
            Some(Self { curve: surface.iso_u(a.x), axis: 1, domain, ends })
        } else if a.y == b.y {
            Some(Self { curve: surface.iso_v(a.y), axis: 0, domain, ends })
        } else {
            None
        }
    }

    fn at(&self, t: f64) -> DVec2 {
        self.ends[0].lerp(self.ends[1], (t - self.domain.0) / (self.domain.1 - self.domain.0))
    }
}

/// A bound on the deviation from control points, where edge and image are B-splines on the same knots.
fn bound(
    curve: &Curve<DVec3>,
    coedge: &Coedge,
    surface: &SurfaceGeometry,
    line: Option<&IsoLine>,
) -> Option<f64> {
    match (surface, line) {
        (SurfaceGeometry::Plane(plane), _) if curve.knots() == coedge.pcurve.knots() => {
            let image = coedge.pcurve.points().iter().map(|q| plane.origin + plane.x * q.x + plane.y * q.y);
            Some(farthest(curve.points().iter().copied(), image))
        }
        (_, Some(line)) => {
            let (image, axis) = (&line.curve, line.axis);
            let (knots, others) = (curve.knots(), image.knots());
            let (start, end) = others.domain();
            if knots.degree() != others.degree() || knots.values().len() != others.values().len() {
                return None;
            }
            let backwards = line.ends[0][axis] > line.ends[1][axis];
            let tolerance = 1e-14 * (end - start);
            let last = others.values().len() - 1;
            let same = knots.values().iter().enumerate().all(|(i, &t)| {
                let other = others.values()[if backwards { last - i } else { i }];
                (line.at(t)[axis] - other).abs() <= tolerance
            });
            let image = image.points().iter().copied();
            let points = curve.points().iter().copied();
            match (same, backwards) {
                (true, false) => Some(farthest(points, image)),
                (true, true) => Some(farthest(points, image.rev())),
                (false, _) => None,
            }
        }
        _ => None,
    }
}

fn farthest(a: impl Iterator<Item = DVec3>, b: impl Iterator<Item = DVec3>) -> f64 {
    a.zip(b).map(|(a, b)| a.distance_squared(b)).fold(0.0, f64::max).sqrt()
}

/// Calls `f` with each interval between neighbouring knots of the two knot vectors, which have the same domain.
#[inline(always)]
fn for_each_interval([a, b]: [&Knots; 2], mut f: impl FnMut(f64, f64)) {
    let (start, end) = a.domain();
    let inner = |k: &Knots| k.degree()..k.control_count() + 1;
    let (a, b) = (&a.values()[inner(a)], &b.values()[inner(b)]);
    let (mut i, mut j, mut from) = (0, 0, start);
    while from < end {
        while i < a.len() && a[i] <= from {
            i += 1;
        }
        while j < b.len() && b[j] <= from {
            j += 1;
        }
        let next = a.get(i).copied().unwrap_or(end).min(b.get(j).copied().unwrap_or(end));
        f(from, next);
        from = next;
    }
}
