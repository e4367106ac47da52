//! Extremes inside faces.

use super::{BOUNDS_TOLERANCE_MM, Bounds};
use crate::domain::FaceDomain;
use crate::geometry::{Revolution, SurfaceGeometry};
use crate::model::Face;
use crate::span::full_spans;
use coolinggen_nurbs::{Homogeneous, Knots, ParametricCurve, ParametricSurface};
use glam::{DVec2, DVec3};
use std::cell::OnceCell;
use std::f64::consts::{FRAC_PI_2, PI};

/// Makes `bounds`, which holds the edges, hold the inside of the face.
pub(super) fn include(face: &Face, bounds: &mut Bounds) {
    let inside = Inside { face, domain: OnceCell::new() };
    match &face.surface {
        // Nothing in a plane is outside its border's box.
        SurfaceGeometry::Plane(_) => {}
        SurfaceGeometry::Revolution(s) => revolution(s, &inside, bounds),
        SurfaceGeometry::BSpline(s) => {
            let net =
                Net { knots: [s.knots_u(), s.knots_v()], points: |i: usize| s.points()[i], rational: false };
            net.include(&inside, bounds);
        }
        SurfaceGeometry::Rational(s) => {
            let h = s.homogeneous();
            let points = |i: usize| Homogeneous::project(&h.points()[i]);
            Net { knots: [h.knots_u(), h.knots_v()], points, rational: true }.include(&inside, bounds);
        }
    }
}

/// A face whose domain is prepared when first asked for.
struct Inside<'a> {
    face: &'a Face,
    domain: OnceCell<FaceDomain<'a>>,
}

impl Inside<'_> {
    fn contains(&self, at: DVec2) -> bool {
        self.domain.get_or_init(|| FaceDomain::new(self.face)).contains(at)
    }
}

/// Only where the radius has an extreme, straight up or down, left or right; extremes in x are circles, which meet
/// the border or close in themselves across a seam.
fn revolution(surface: &Revolution, inside: &Inside<'_>, bounds: &mut Bounds) {
    let meridian = surface.meridian();
    let (p, values) = (meridian.degree(), meridian.knots().values());
    for index in full_spans(meridian.knots()) {
        let hull = meridian.points()[index - p..=index].iter().map(|p| p.y);
        let (lowest, highest) = hull.fold((f64::INFINITY, 0.0f64), |(l, h), r| (l.min(r), h.max(r)));
        let flat = highest - lowest <= BOUNDS_TOLERANCE_MM;
        let reaches = |axis, sign| highest > bounds.reach(axis, sign) + BOUNDS_TOLERANCE_MM;
        let sticks_out = [1, 2].iter().any(|&axis| reaches(axis, 1.0) || reaches(axis, -1.0));
        if flat || !sticks_out {
            continue;
        }
        const STEPS: usize = 8;
        let at = |i: usize| values[index] + (values[index + 1] - values[index]) * i as f64 / STEPS as f64;
        for i in 0..STEPS {
            // The radius turns between two samples: halve to where.
            let (mut low, mut high) = (at(i), at(i + 1));
            let slope = |t: f64| meridian.derivatives(t)[1].y;
            let rising = slope(low) > 0.0;
            if rising == (slope(high) > 0.0) {
                continue;
            }
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if (slope(middle) > 0.0) == rising { low = middle } else { high = middle }
            }
            for (theta, axis, sign) in
                [(0.0, 2, 1.0), (FRAC_PI_2, 1, 1.0), (PI, 2, -1.0), (-FRAC_PI_2, 1, -1.0)]
            {
                let point = inside.face.surface.point(theta, low);
                if point[axis] * sign > bounds.reach(axis, sign) && inside.contains(DVec2::new(theta, low)) {
                    bounds.include(point);
                }
            }
        }
    }
}

/// Control points of a surface, projected.
struct Net<'a, P> {
    knots: [&'a Knots; 2],
    points: P,
    rational: bool,
}

impl<P: Fn(usize) -> DVec3> Net<'_, P> {
    fn include(&self, inside: &Inside<'_>, bounds: &mut Bounds) {
        let (nu, nv) = (self.knots[0].control_count(), self.knots[1].control_count());
        let sticks_out = |bounds: &Bounds, p: DVec3| !bounds.contains(p, BOUNDS_TOLERANCE_MM);
        // Mostly the whole net is inside already.
        let out: Vec<bool> = (0..nu * nv).map(|i| sticks_out(bounds, (self.points)(i))).collect();
        if !out.contains(&true) {
            return;
        }
        let [p, q] = self.knots.map(Knots::degree);
        let mut cells = Vec::new();
        for i in full_spans(self.knots[0]) {
            let rows = i - p..=i;
            for j in full_spans(self.knots[1]) {
                let hull = || rows.clone().flat_map(|a| (j - q..=j).map(move |b| a * nv + b));
                if !hull().any(|k| out[k]) {
                    continue;
                }
                let hull = hull().map(&self.points);
                let hull = hull.fold(Bounds::EMPTY, |b, p| b.union(Bounds { min: p, max: p }));
                for (axis, sign) in (0..3).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]) {
                    let beyond = hull.reach(axis, sign) - bounds.reach(axis, sign);
                    if beyond > BOUNDS_TOLERANCE_MM {
                        cells.push((beyond, hull.reach(axis, sign), [i, j], axis, sign));
                    }
                }
            }
        }
        // Those that may reach farthest first: what they add mostly spares the others.
        cells.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (_, reach, spans, axis, sign) in cells {
            if reach > bounds.reach(axis, sign) + BOUNDS_TOLERANCE_MM && self.may_peak(spans, axis) {
                self.cell(spans, axis, sign, inside, bounds);
            }
        }
    }

    /// Whether a coordinate can have an extreme in one cell: not where it grows, or falls, from each control point to the
    /// next in one direction, for these differences make its derivative.
    fn may_peak(&self, [i, j]: [usize; 2], axis: usize) -> bool {
        if self.rational {
            return true;
        }
        let [p, q] = self.knots.map(Knots::degree);
        let nv = self.knots[1].control_count();
        let value = |a: usize, b: usize| (self.points)(a * nv + b)[axis];
        let (rows, columns) = (i - p..=i, j - q..=j);
        let up = rows.clone().skip(1).flat_map(|a| columns.clone().map(move |b| (a, b)));
        let across = rows.clone().flat_map(|a| columns.clone().skip(1).map(move |b| (a, b)));
        turns(up.map(|(a, b)| value(a, b) - value(a - 1, b)))
            && turns(across.map(|(a, b)| value(a, b) - value(a, b - 1)))
    }

    /// Looks for an extreme of the coordinate in one cell of the knots.
    fn cell(&self, spans: [usize; 2], axis: usize, sign: f64, inside: &Inside<'_>, bounds: &mut Bounds) {
        let knot = |d: usize, step: usize| self.knots[d].values()[spans[d] + step];
        let low = DVec2::new(knot(0, 0), knot(1, 0));
        let size = DVec2::new(knot(0, 1), knot(1, 1)) - low;
        let surface = &inside.face.surface;
        const STEPS: usize = 4;
        let samples = (0..=STEPS).flat_map(|a| (0..=STEPS).map(move |b| DVec2::new(a as f64, b as f64)));
        let samples = samples.map(|s| low + size * s / STEPS as f64);
        let valued = samples.map(|at| (sign * surface.point(at.x, at.y)[axis], at));
        let Some((_, best)) = valued.max_by(|a, b| a.0.total_cmp(&b.0)) else { return };
        let Some(summit) = climb(surface, axis, sign, best, size) else { return };
        // A little more than the cell: on a knot line either side will do.
        let within = ((summit - low) / size).cmpge(DVec2::splat(-0.01)).all()
            && ((summit - low) / size).cmple(DVec2::splat(1.01)).all();
        let point = surface.point(summit.x, summit.y);
        if within && sign * point[axis] > bounds.reach(axis, sign) && inside.contains(summit) {
            bounds.include(point);
        }
    }
}

/// Whether neither all differences are positive nor all negative.
fn turns(differences: impl Iterator<Item = f64>) -> bool {
    let (mut rises, mut falls) = (true, true);
    for difference in differences {
        rises &= difference > 0.0;
        falls &= difference < 0.0;
    }
    !rises && !falls
}

/// Newton's method for the place where the coordinate times `sign` is greatest; steps no longer than half a cell.
fn climb(surface: &SurfaceGeometry, axis: usize, sign: f64, start: DVec2, size: DVec2) -> Option<DVec2> {
    let mut at = start;
    for _ in 0..40 {
        let d = surface.derivatives(at.x, at.y);
        let g = DVec2::new(d.u[axis], d.v[axis]) * sign;
        let (a, b, c) = (sign * d.uu[axis], sign * d.uv[axis], sign * d.vv[axis]);
        let det = a * c - b * b;
        // On a dome Newton's step, elsewhere one uphill.
        let dome = a < 0.0 && det > 0.0;
        let newton = DVec2::new(b * g.y - c * g.x, b * g.x - a * g.y) / det;
        let step =
            if dome { newton } else { g * size * size / (g * size).length().max(f64::MIN_POSITIVE) * 0.25 };
        let share = (step / size).abs().max_element();
        let step = if share > 0.5 { step * (0.5 / share) } else { step };
        at += step;
        if ((at - start) / size).abs().max_element() > 3.0 || !at.is_finite() {
            return None;
        }
        if dome && share < 1e-10 {
            return Some(at);
        }
    }
    None
}
