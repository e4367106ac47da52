//! Start points on every branch of a section, by subdivision.

use super::{CERTIFIED, Plane};
use crate::bernstein::Net;
use crate::edit::BezierSurface;
use crate::error::NurbsError;
use glam::{DMat2, DVec2, DVec3};

/// Halvings of a patch in each direction at most.
const DEPTH: u32 = 20;
/// Cells examined before the search is given up.
const BUDGET: usize = 400_000;

/// What subdivision finds.
pub(super) struct Start {
    /// At least one point on every branch, on the borders of cells; domain borders first.
    pub(super) seeds: Vec<DVec2>,
    /// Points where the plane touches from one side.
    pub(super) contacts: Vec<DVec2>,
}

/// A part of a patch with the signed distance on it.
struct Cell {
    net: Net,
    low: DVec2,
    high: DVec2,
    depth: u32,
}

/// Subdivides the patches until the signed distance has no sign change on a cell, or one of its derivatives has none:
/// then every branch in the cell reaches the cell's border, where roots of one variable are the start points.
pub(super) fn start_points<S: BezierSurface<Space = DVec3>>(
    plane: &Plane<'_, S>,
) -> Result<Start, NurbsError> {
    let mut cells = vec![];
    for patch in plane.surface.homogeneous_patches() {
        let ((u0, u1), (v0, v1)) = (patch.knots_u().domain(), patch.knots_v().domain());
        let distance = |p: &crate::Homogeneous<DVec3>| plane.normal.dot(p.weighted - plane.origin * p.weight);
        let (nu, nv) = patch.counts();
        let net = Net { nu, nv, c: patch.points().iter().map(distance).collect() };
        let (low, high) = net.range();
        if low.abs().max(high.abs()) <= CERTIFIED {
            return Err(NurbsError::Coincident { from: u0, to: u1 });
        }
        cells.push(Cell { net, low: DVec2::new(u0, v0), high: DVec2::new(u1, v1), depth: 0 });
    }
    let mut start = Start { seeds: vec![], contacts: vec![] };
    let mut singular = vec![];
    let mut left = BUDGET;
    while let Some(cell) = cells.pop() {
        let (least, greatest) = cell.net.range();
        // A contact within the certificate is one, but rounding is none.
        if least > 0.1 * CERTIFIED || greatest < -0.1 * CERTIFIED {
            continue;
        }
        left = left.checked_sub(1).ok_or(NurbsError::NoConvergence {
            what: "search for start points of a section",
            residual: least.abs().min(greatest.abs()),
        })?;
        let (ru, rv) = (cell.net.derivative_u().range(), cell.net.derivative_v().range());
        let definite = |(low, high): (f64, f64)| low > 0.0 || high < 0.0;
        if definite(ru) || definite(rv) {
            border_roots(&cell, &mut start.seeds);
        } else if cell.depth == 2 * DEPTH {
            singular.push(0.5 * (cell.low + cell.high));
        } else {
            cells.extend(halves(&cell, ru, rv));
        }
    }
    for p in singular {
        if let Some(contact) = contact(plane, p) {
            add_contact(&mut start.contacts, contact);
        }
    }
    // Open branches are best started at their ends.
    let ((u0, u1), (v0, v1)) = plane.surface.domain();
    let inside = |p: &DVec2| p.x > u0 && p.x < u1 && p.y > v0 && p.y < v1;
    start.seeds.sort_by(|a, b| inside(a).cmp(&inside(b)).then(a.x.total_cmp(&b.x)).then(a.y.total_cmp(&b.y)));
    Ok(start)
}

fn halves(cell: &Cell, ru: (f64, f64), rv: (f64, f64)) -> [Cell; 2] {
    let middle = 0.5 * (cell.low + cell.high);
    let depth = cell.depth + 1;
    // Across the direction in which the distance changes more.
    let along_u = ru.1 - ru.0 >= rv.1 - rv.0;
    let (a, b) = if along_u { cell.net.halves_u() } else { cell.net.halves_v() };
    let (mut high, mut low) = (cell.high, cell.low);
    if along_u {
        (high.x, low.x) = (middle.x, middle.x);
    } else {
        (high.y, low.y) = (middle.y, middle.y);
    }
    [Cell { net: a, low: cell.low, high, depth }, Cell { net: b, low, high: cell.high, depth }]
}

/// Roots of the distance on the four sides of a cell.
fn border_roots(cell: &Cell, seeds: &mut Vec<DVec2>) {
    let (nu, nv) = (cell.net.nu, cell.net.nv);
    let c = &cell.net.c;
    let size = cell.high - cell.low;
    let row = |i: usize| c[i * nv..(i + 1) * nv].to_vec();
    let column = |j: usize| (0..nu).map(|i| c[i * nv + j]).collect::<Vec<f64>>();
    for (coefficients, at_high) in [(row(0), false), (row(nu - 1), true)] {
        let u = if at_high { cell.high.x } else { cell.low.x };
        roots(coefficients, |x| seeds.push(DVec2::new(u, cell.low.y + size.y * x)));
    }
    for (coefficients, at_high) in [(column(0), false), (column(nv - 1), true)] {
        let v = if at_high { cell.high.y } else { cell.low.y };
        roots(coefficients, |x| seeds.push(DVec2::new(cell.low.x + size.x * x, v)));
    }
}

/// Calls `found` for every root on [0, 1] of a Bernstein polynomial; once, in the middle, for one that vanishes.
fn roots(coefficients: Vec<f64>, mut found: impl FnMut(f64)) {
    let size = coefficients.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    if size <= 0.1 * CERTIFIED {
        found(0.5);
        return;
    }
    let mut stack = vec![(Net { nu: coefficients.len(), nv: 1, c: coefficients }, 0.0, 1.0)];
    while let Some((net, low, high)) = stack.pop() {
        let (least, greatest) = net.range();
        if least > 0.0 || greatest < 0.0 {
            continue;
        }
        let changes = net.c.windows(2).filter(|w| (w[0] < 0.0) != (w[1] < 0.0)).count();
        let ends = (net.c[0], net.c[net.nu - 1]);
        if high - low < 1e-12 || ends.0 == 0.0 || ends.1 == 0.0 {
            // An end that is a root exactly, or a multiple one.
            found(if ends.1 == 0.0 { high } else { low });
            if high - low < 1e-12 || changes == 0 {
                continue;
            }
        }
        if changes == 1 && (ends.0 < 0.0) != (ends.1 < 0.0) {
            found(low + (high - low) * bisect(&net));
        } else {
            let (a, b) = net.halves_u();
            let middle = 0.5 * (low + high);
            if !(middle > low && middle < high) {
                continue;
            }
            stack.extend([(a, low, middle), (b, middle, high)]);
        }
    }
}

/// The root of a polynomial with one change of sign.
fn bisect(net: &Net) -> f64 {
    let (mut a, mut b) = (0.0, 1.0);
    let negative = net.c[0] < 0.0;
    loop {
        let middle = 0.5 * (a + b);
        if !(middle > a && middle < b) {
            return middle;
        }
        if (net.value(middle, 0.0) < 0.0) == negative { a = middle } else { b = middle }
    }
}

/// Adds a point of contact unless it is there already.
pub(super) fn add_contact(contacts: &mut Vec<DVec2>, contact: DVec2) {
    if contacts.iter().all(|c| c.distance(contact) > 1e-6) {
        contacts.push(contact);
    }
}

/// The point near `p` where the plane is parallel to the tangent plane, if it is in the plane and the surface stays on
/// one side of it there.
pub(super) fn contact<S: BezierSurface<Space = DVec3>>(plane: &Plane<'_, S>, p: DVec2) -> Option<DVec2> {
    touching(plane, p).filter(|t| t.1 > 0.0).map(|t| t.0)
}

/// The point near `p` where the plane is parallel to the tangent plane, if it is in the plane and the surface is on both
/// sides of it there.
pub(super) fn saddle<S: BezierSurface<Space = DVec3>>(plane: &Plane<'_, S>, p: DVec2) -> Option<DVec2> {
    touching(plane, p).filter(|t| t.1 < 0.0).map(|t| t.0)
}

/// A stationary point of the signed distance near `p` that lies in the plane, by Newton's method, and the determinant
/// of the second derivatives there.
fn touching<S: BezierSurface<Space = DVec3>>(plane: &Plane<'_, S>, mut p: DVec2) -> Option<(DVec2, f64)> {
    let ((u0, u1), (v0, v1)) = plane.surface.domain();
    let (low, high) = (DVec2::new(u0, v0), DVec2::new(u1, v1));
    let hessian = |p: DVec2| {
        let d = plane.surface.derivatives(p.x, p.y);
        let n = plane.normal;
        let gradient = DVec2::new(n.dot(d.u), n.dot(d.v));
        (
            gradient,
            DMat2::from_cols(DVec2::new(n.dot(d.uu), n.dot(d.uv)), DVec2::new(n.dot(d.uv), n.dot(d.vv))),
        )
    };
    for _ in 0..30 {
        let (gradient, h) = hessian(p);
        let step = h.inverse() * gradient;
        if !step.is_finite() {
            break;
        }
        p = (p - step).clamp(low, high);
    }
    (plane.at(p).0.abs() <= CERTIFIED).then(|| (p, hessian(p).1.determinant()))
}
