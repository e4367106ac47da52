//! What a surface asks of its mesh: steps in u and v by curvature, turn of the normal and length.

use super::TessellationOptions;
use super::grading::{Grading, cells};
use coolinggen_brep::SurfaceGeometry;
use coolinggen_nurbs::{Knots, ParametricSurface};
use glam::DVec2;

/// Share of one step that a flat direction is given, so that twist has something to be measured against.
const FLOOR: f64 = 0.1;
/// Longest over shortest side of the metric that triangles are well shaped in. More saves triangles on nearly straight
/// walls, until the flattest of them tilt.
const ANISOTROPY: f64 = 10.0;

/// Grid lines of a face and a metric in which its triangles are to be well shaped.
#[derive(Clone, Debug)]
pub(crate) struct Field {
    /// Grading in u.
    pub(crate) u: Grading,
    /// Grading in v.
    pub(crate) v: Grading,
    /// Factors from parameters to millimetres, stretched where curvature asks for long triangles.
    pub(crate) scale: DVec2,
    /// Factors on the gradings for grid cells that are no longer than the metric likes.
    pub(crate) more: DVec2,
}

/// The fundamental forms at a point.
struct Sample {
    length_u: f64,
    length_v: f64,
    bend_u: f64,
    bend_v: f64,
    twist: f64,
    turn_u: f64,
    turn_v: f64,
}

fn sample(surface: &SurfaceGeometry, u: f64, v: f64) -> Option<Sample> {
    let d = surface.derivatives(u, v);
    let n = d.u.cross(d.v);
    let square = n.length_squared();
    let (e, f, g) = (d.u.length_squared(), d.u.dot(d.v), d.v.length_squared());
    if !(square > 1e-24 * e * g) || !square.is_finite() {
        return None;
    }
    let n = n / square.sqrt();
    let (l, m, k) = (d.uu.dot(n), d.uv.dot(n), d.vv.dot(n));
    // Weingarten: the normal's derivatives in terms of the tangents.
    let turn = |along: f64, across: f64, own: f64, other: f64| {
        let (a, b) = ((f * across - other * along) / square, (f * along - own * across) / square);
        (a * a * own + 2.0 * a * b * f + b * b * other).max(0.0).sqrt()
    };
    Some(Sample {
        length_u: e.sqrt(),
        length_v: g.sqrt(),
        bend_u: l.abs().sqrt(),
        bend_v: k.abs().sqrt(),
        twist: m.abs(),
        turn_u: turn(l, m, e, g),
        turn_v: turn(k, m, g, e),
    })
}

/// Greatest values over a row or column of samples.
#[derive(Clone, Copy, Default)]
struct Line {
    length: f64,
    bend: f64,
    turn: f64,
}

impl Line {
    fn widen(&mut self, length: f64, bend: f64, turn: f64) {
        self.length = self.length.max(length);
        self.bend = self.bend.max(bend);
        self.turn = self.turn.max(turn);
    }
}

impl Field {
    /// The field of `surface` over the parameter rectangle `low..high`.
    pub(crate) fn new(surface: &SurfaceGeometry, low: DVec2, high: DVec2, o: &TessellationOptions) -> Self {
        let (borders_u, borders_v) = sampling(surface, low, high);
        let middle = |b: &[f64], i: usize| 0.5 * (b[i] + b[i + 1]);
        let (nu, nv) = (borders_u.len() - 1, borders_v.len() - 1);
        let (mut lines_u, mut lines_v) = (vec![Line::default(); nu], vec![Line::default(); nv]);
        let mut twists = Vec::with_capacity(nu * nv);
        for i in 0..nu {
            for j in 0..nv {
                let Some(s) = sample(surface, middle(&borders_u, i), middle(&borders_v, j)) else { continue };
                lines_u[i].widen(s.length_u, s.bend_u, s.turn_u);
                lines_v[j].widen(s.length_v, s.bend_v, s.turn_v);
                twists.push((i, j, s.twist));
            }
        }
        let extent = |lines: &[Line], b: &[f64], of: fn(&Line) -> f64| -> f64 {
            lines.iter().zip(b.windows(2)).map(|(l, b)| of(l) * (b[1] - b[0])).sum()
        };
        let (size_u, size_v) =
            (extent(&lines_u, &borders_u, |l| l.length), extent(&lines_v, &borders_v, |l| l.length));
        // Deviation of a chord over a step h with second derivative b^2 along the normal: (b h)^2 / 8.
        let budget = (8.0 * o.sampled_chord()).sqrt();
        let floor = FLOOR * budget / size_u.max(size_v).max(f64::MIN_POSITIVE);
        for l in lines_u.iter_mut().chain(&mut lines_v) {
            l.bend += floor * l.length;
        }
        let twist = twists.iter().fold(0.0f64, |worst, &(i, j, m)| {
            let scale = lines_u[i].bend * lines_v[j].bend;
            if scale > 0.0 { worst.max(m / scale) } else { worst }
        });
        let (need_u, need_v) = (
            extent(&lines_u, &borders_u, |l| l.bend) / budget,
            extent(&lines_v, &borders_v, |l| l.bend) / budget,
        );
        let (share_u, share_v) = shares(need_u, need_v, twist);
        let density = |l: &Line, share: f64| {
            let by_turn = (l.turn / o.angle()).min(l.length / (0.1 * o.chord_mm));
            let by_length = o.max_edge_mm.map_or(0.0, |m| l.length / m);
            (l.bend / (share * budget)).max(by_turn).max(by_length)
        };
        let densities =
            |lines: &[Line], share: f64| lines.iter().map(|l| density(l, share)).collect::<Vec<_>>();
        let (kinks_u, kinks_v) = kinks(surface);
        let u = Grading::new(borders_u, &densities(&lines_u, share_u), |t| kinks_u.contains(&t));
        let v = Grading::new(borders_v, &densities(&lines_v, share_v), |t| kinks_v.contains(&t));
        let (scale, more) = metric(low, high, (size_u, size_v), (&u, &v));
        Self { u, v, scale, more }
    }
}

/// Shares `(a, b)` of the tolerance for steps in u and v, with `a^2 + b^2 + 2 twist a b <= 1`, that need the fewest
/// cells; steps along the border count twice, for the neighbours'.
fn shares(need_u: f64, need_v: f64, twist: f64) -> (f64, f64) {
    let mut best = (f64::INFINITY, 1.0, 1.0);
    let mut count = need_v.ceil().max(1.0);
    for _ in 0..60 {
        let b = need_v / count;
        let rest = 1.0 + b * b * (twist * twist - 1.0);
        let a = rest.max(0.0).sqrt() - twist * b;
        if a > 0.0 {
            let other = (need_u / a).ceil().max(1.0);
            let cells = other * count + 2.0 * (other + count);
            if cells < best.0 {
                best = (cells, a, b);
            }
            if need_u <= a {
                break;
            }
        }
        count = (count * 1.15).floor().max(count + 1.0);
    }
    // Whole numbers of steps leave slack: hand u what v's rounding leaves over.
    (best.1, best.2.max(1e-12))
}

/// Cell borders at which the surface is sampled: finer than its knot spans, coarse where it is known to be simple.
fn sampling(surface: &SurfaceGeometry, low: DVec2, high: DVec2) -> (Vec<f64>, Vec<f64>) {
    let borders = |breaks: &[f64], low: f64, high: f64, degree: usize| {
        let (per_span, least) = match degree {
            1 => (1, 2),
            _ if breaks.len() > 16 => (1, 6),
            _ => (2, 6),
        };
        cells(breaks, low, high, per_span, least)
    };
    let spline = |u: &Knots, v: &Knots| {
        (borders(&u.breaks(), low.x, high.x, u.degree()), borders(&v.breaks(), low.y, high.y, v.degree()))
    };
    match surface {
        SurfaceGeometry::BSpline(s) => spline(s.knots_u(), s.knots_v()),
        SurfaceGeometry::Rational(s) => spline(s.homogeneous().knots_u(), s.homogeneous().knots_v()),
        SurfaceGeometry::Plane(_) => (vec![low.x, high.x], vec![low.y, high.y]),
        // Nothing changes with theta.
        SurfaceGeometry::Revolution(r) => {
            let k = r.meridian().knots();
            (vec![low.x, high.x], borders(&k.breaks(), low.y, high.y, k.degree()))
        }
    }
}

/// Knots over which the surface is only continuous.
fn kinks(surface: &SurfaceGeometry) -> (Vec<f64>, Vec<f64>) {
    let of = |k: &Knots| -> Vec<f64> {
        let breaks = k.breaks();
        let inner = &breaks[1..breaks.len() - 1];
        inner.iter().copied().filter(|&t| k.multiplicity(t) >= k.degree()).collect()
    };
    match surface {
        SurfaceGeometry::BSpline(s) => (of(s.knots_u()), of(s.knots_v())),
        SurfaceGeometry::Rational(s) => (of(s.homogeneous().knots_u()), of(s.homogeneous().knots_v())),
        SurfaceGeometry::Plane(_) => (Vec::new(), Vec::new()),
        SurfaceGeometry::Revolution(r) => (Vec::new(), of(r.meridian().knots())),
    }
}

/// Millimetres a parameter, stretched towards the ratio of the steps that curvature asks for; and how many times more
/// steps than that each direction needs to keep to that ratio.
fn metric(low: DVec2, high: DVec2, size: (f64, f64), grading: (&Grading, &Grading)) -> (DVec2, DVec2) {
    let range = high - low;
    let ratio = |size: f64, range: f64| if size > 0.0 && range > 0.0 { size / range } else { 1.0 };
    let lengths = DVec2::new(ratio(size.0, range.x), ratio(size.1, range.y));
    let step = |size: f64, g: &Grading| size / g.total().max(f64::MIN_POSITIVE);
    let wanted = step(size.1, grading.1) / step(size.0, grading.0);
    if !(wanted > 0.0 && wanted.is_finite()) {
        return (lengths, DVec2::ONE);
    }
    let stretch = wanted.clamp(1.0 / ANISOTROPY, ANISOTROPY);
    let more = DVec2::new((stretch / wanted).max(1.0), (wanted / stretch).max(1.0));
    let root = stretch.sqrt();
    (DVec2::new(lengths.x * root, lengths.y / root), more)
}
