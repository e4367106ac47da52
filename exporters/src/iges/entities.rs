//! Geometry: rational B-spline curves (126) and surfaces (128), and colours (314).

use super::lines::{Directory, File, Pointer, Record, Status};
use super::patch::{Net, Patch};
use crate::materials::display_value;
use coolinggen_brep::EdgeCurve;
use coolinggen_nurbs::{Curve, Homogeneous, Knots, Surface, VectorSpace};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

/// The curve of an edge as it is, or run through backwards on the same domain.
pub(super) fn curve(file: &mut File, curve: &EdgeCurve, along: bool) -> Pointer {
    match curve {
        EdgeCurve::BSpline(c) if along => plain(file, c),
        EdgeCurve::BSpline(c) => plain(file, &c.reversed()),
        EdgeCurve::Rational(c) if along => rational(file, c.homogeneous()),
        EdgeCurve::Rational(c) => rational(file, &c.homogeneous().reversed()),
    }
}

fn plain(file: &mut File, c: &Curve<DVec3>) -> Pointer {
    file.add(&Directory::new(126, 0, Status::Dependent), |r| {
        spline(r, c, false, true);
        c.points().iter().for_each(|_| r.one());
        c.points().iter().for_each(|&p| r.point(p));
        ends(r, c.knots());
        r.point(DVec3::ZERO);
    })
}

fn rational(file: &mut File, c: &Curve<Homogeneous<DVec3>>) -> Pointer {
    file.add(&Directory::new(126, 0, Status::Dependent), |r| {
        spline(r, c, false, false);
        c.points().iter().for_each(|p| r.real(p.weight));
        c.points().iter().for_each(|p| r.point(p.project()));
        ends(r, c.knots());
        r.point(DVec3::ZERO);
    })
}

/// A curve in the parameters of a surface.
pub(super) fn pcurve(file: &mut File, c: &Curve<DVec2>) -> Pointer {
    file.add(&Directory::new(126, 0, Status::Parametric), |r| {
        spline(r, c, true, true);
        c.points().iter().for_each(|_| r.one());
        for p in c.points() {
            r.real(p.x);
            r.real(p.y);
            r.real(0.0);
        }
        ends(r, c.knots());
        // The normal of the plane of parameters.
        for x in DVec3::Z.to_array() {
            r.real(x);
        }
    })
}

/// Curves in the order of a loop as one: a composite curve (102), where there is more than one.
pub(super) fn composite(file: &mut File, status: Status, curves: &[Pointer]) -> Pointer {
    match curves {
        [one] => *one,
        many => file.add(&Directory::new(102, 0, status), |r| {
            r.integer(many.len());
            many.iter().for_each(|&c| r.pointer(c));
        }),
    }
}

/// What curves begin with: upper index, degree, planar, closed, polynomial and periodic flags, knots. No curve is closed,
/// since edges end in two vertices.
fn spline<V: VectorSpace>(r: &mut Record<'_>, c: &Curve<V>, planar: bool, polynomial: bool) {
    r.integer(c.points().len() - 1);
    r.integer(c.degree());
    [planar, false, polynomial, false].into_iter().for_each(|flag| r.flag(flag));
    c.knots().values().iter().for_each(|&k| r.real(k));
}

/// First and last parameter.
fn ends(r: &mut Record<'_>, knots: &Knots) {
    let (start, end) = knots.domain();
    r.real(start);
    r.real(end);
}

/// The surface of a face.
pub(super) fn surface(file: &mut File, patch: &Patch<'_>, label: &str, level: usize) -> Pointer {
    let entry = Directory { label, level, ..Directory::new(128, 0, Status::Dependent) };
    file.add(&entry, |r| match &patch.net {
        Net::Plain(s) => net(r, s, true, |r, _| r.one(), |&p| p),
        Net::Rational(s) => net(r, s, false, |r, p| r.real(p.weight), Homogeneous::project),
    })
}

/// Upper indices, degrees, flags, knots, weights and control points, these with u running fastest, and the domain.
///
/// No surface is called closed: readers make closed ones periodic, and parameters across the seam would be others.
fn net<V: VectorSpace>(
    r: &mut Record<'_>,
    s: &Surface<V>,
    polynomial: bool,
    weight: impl Fn(&mut Record<'_>, &V),
    place: impl Fn(&V) -> DVec3,
) {
    let ((nu, nv), (u, v)) = (s.counts(), (s.knots_u(), s.knots_v()));
    [nu - 1, nv - 1, u.degree(), v.degree()].into_iter().for_each(|n| r.integer(n));
    [false, false, polynomial, false, false].into_iter().for_each(|flag| r.flag(flag));
    u.values().iter().chain(v.values()).for_each(|&k| r.real(k));
    let points = || (0..nv).flat_map(|j| (0..nu).map(move |i| &s.points()[i * nv + j]));
    points().for_each(|p| weight(r, p));
    points().for_each(|p| r.point(place(p)));
    ends(r, u);
    ends(r, v);
}

/// The colours defined so far.
#[derive(Default)]
pub(super) struct Colors(BTreeMap<[u64; 3], Pointer>);

impl Colors {
    /// The definition of a colour, red, green and blue in 0..=1, linear: IGES has percents of what screens show.
    pub(super) fn of(&mut self, file: &mut File, color: [f64; 3]) -> Pointer {
        *self.0.entry(color.map(f64::to_bits)).or_insert_with(|| {
            file.add(&Directory::new(314, 0, Status::Definition), |r| {
                color.into_iter().for_each(|c| r.real(100.0 * display_value(c)));
            })
        })
    }
}
