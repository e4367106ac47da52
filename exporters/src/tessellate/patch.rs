//! Triangles of one face while they are made, and how well they follow the surface.

use super::boundary::Node;
use coolinggen_brep::SurfaceGeometry;
use coolinggen_nurbs::ParametricSurface;
use glam::{DVec2, DVec3};

/// Triangles over the parameters of a face; border nodes come first, loop by loop.
#[derive(Clone, Debug, Default)]
pub(crate) struct Patch {
    /// Parameters of the nodes.
    pub(crate) uv: Vec<DVec2>,
    /// Points of the nodes, mm.
    pub(crate) at: Vec<DVec3>,
    /// Unit natural normals of the surface at the nodes; zero where it has none.
    pub(crate) normals: Vec<DVec3>,
    /// Next node along the border, one a border node.
    pub(crate) next: Vec<u32>,
    /// Triangles, counterclockwise in the parameter plane.
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// A place where triangles leave the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fault {
    /// Distance in mm; infinite where normals turn too far or a triangle is turned over.
    pub(crate) distance: f64,
    /// Parameters of the place.
    pub(crate) uv: DVec2,
    /// Triangle it was found in.
    pub(crate) triangle: usize,
}

/// What [`Patch::inspect`] looks at more closely.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Cosine of the greatest turn of the normal over a side: more is a fault of infinite distance.
    pub(crate) turn: f64,
    /// Cosine of the greatest angle between a triangle's normal and the surface's at its corners.
    pub(crate) tilt: f64,
    /// Length below which a side may turn as it likes, mm.
    pub(crate) shortest: f64,
    /// Length of a triangle's longest side below which it may tilt as it likes, mm.
    pub(crate) tiny: f64,
    /// Distance above which a triangle is looked at in more places, mm.
    pub(crate) close: f64,
}

/// Middles of the sides in barycentric coordinates.
const SIDES: [[f64; 3]; 3] = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];
/// Middles between the centre and the corners.
const BETWEEN: [[f64; 3]; 3] = {
    const NEAR: f64 = 2.0 / 3.0;
    const FAR: f64 = 1.0 / 6.0;
    [[NEAR, FAR, FAR], [FAR, NEAR, FAR], [FAR, FAR, NEAR]]
};

fn worse(a: Fault, b: Fault) -> Fault {
    if b.distance > a.distance { b } else { a }
}

impl Patch {
    /// The border of a face without triangles yet.
    pub(crate) fn new(surface: &SurfaceGeometry, polygons: &[Vec<Node>], points: &[DVec3]) -> Self {
        let mut patch = Self::default();
        let nodes = || polygons.iter().flatten();
        let center = nodes().map(|n| n.uv).sum::<DVec2>() / nodes().count() as f64;
        for polygon in polygons {
            let first = patch.uv.len() as u32;
            let count = polygon.len() as u32;
            patch.uv.extend(polygon.iter().map(|n| n.uv));
            patch.at.extend(polygon.iter().map(|n| points[n.point as usize]));
            patch.normals.extend(polygon.iter().map(|n| normal(surface, n.uv, center)));
            patch.next.extend((0..count).map(|i| first + (i + 1) % count));
        }
        patch
    }

    /// Adds an inner node.
    pub(crate) fn push(&mut self, surface: &SurfaceGeometry, uv: DVec2) -> u32 {
        let (p, u, v) = surface.first_derivatives(uv.x, uv.y);
        self.uv.push(uv);
        self.at.push(p);
        self.normals.push(u.cross(v).normalize_or_zero());
        self.uv.len() as u32 - 1
    }

    /// Takes back all but the border.
    pub(crate) fn clear(&mut self) {
        self.uv.truncate(self.next.len());
        self.at.truncate(self.next.len());
        self.normals.truncate(self.next.len());
        self.triangles.clear();
    }

    fn is_border(&self, a: u32, b: u32) -> bool {
        self.next.get(a as usize) == Some(&b) || self.next.get(b as usize) == Some(&a)
    }

    /// First nodes of the border segments that do not bound exactly one triangle, on their left.
    pub(crate) fn loose_border(&self) -> Vec<u32> {
        let mut count = vec![0i32; self.next.len()];
        for t in &self.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                if self.next.get(a as usize) == Some(&b) {
                    count[a as usize] += 1;
                } else if self.next.get(b as usize) == Some(&a) {
                    count[b as usize] += 2;
                }
            }
        }
        (0..self.next.len() as u32).filter(|&a| count[a as usize] != 1).collect()
    }

    /// Border segments longer than `shortest` mm, by their first nodes, that are the longest sides of these triangles; with
    /// `all` also those that begin or end in a corner of one that is turned over.
    pub(crate) fn long_segments(&self, triangles: &[usize], all: bool, shortest: f64) -> Vec<u32> {
        let mut before = vec![0; self.next.len()];
        for (a, &b) in self.next.iter().enumerate() {
            before[b as usize] = a as u32;
        }
        let mut out: Vec<u32> = Vec::new();
        for &i in triangles {
            let t = self.triangles[i];
            let ([a, b], _) = self.longest(t);
            if self.is_border(a, b) {
                out.push(if self.next.get(a as usize) == Some(&b) { a } else { b });
            } else if all && !(self.uprightness(t) > 0.0) {
                let corners = t.into_iter().filter(|&c| (c as usize) < before.len());
                out.extend(corners.flat_map(|c| [before[c as usize], c]));
            }
        }
        let length = |a: u32| self.at[a as usize].distance(self.at[self.next[a as usize] as usize]);
        out.retain(|&a| length(a) > shortest);
        out.sort_unstable();
        out.dedup();
        out
    }

    /// Normal of a triangle, not of unit length.
    pub(crate) fn cross(&self, [a, b, c]: [u32; 3]) -> DVec3 {
        let [a, b, c] = [a, b, c].map(|i| self.at[i as usize]);
        (b - a).cross(c - a)
    }

    /// Whether two corners of a triangle are one point: a side of the surface's parameters that is a pole.
    pub(crate) fn vanishes(&self, [a, b, c]: [u32; 3]) -> bool {
        let [a, b, c] = [a, b, c].map(|i| self.at[i as usize]);
        a == b || b == c || c == a
    }

    /// Whether a triangle faces away from the surface at a corner; or is tilted too far, unless it is tiny.
    pub(crate) fn is_askew(&self, t: [u32; 3], limits: Limits) -> bool {
        let upright = self.uprightness(t);
        !(upright > 0.0) || upright < limits.tilt && self.longest(t).1 > limits.tiny
    }

    /// The longest side of a triangle, and its length.
    fn longest(&self, [a, b, c]: [u32; 3]) -> ([u32; 2], f64) {
        let length = |s: [u32; 2]| (s, self.at[s[0] as usize].distance(self.at[s[1] as usize]));
        let longer = |a: ([u32; 2], f64), b: ([u32; 2], f64)| if b.1 > a.1 { b } else { a };
        longer(longer(length([a, b]), length([b, c])), length([c, a]))
    }

    /// Where a node straightens up a triangle that stands askew: in the middle of its longest side; in its centre if that is
    /// a border segment or the triangle is turned over.
    pub(crate) fn middle(&self, triangle: usize) -> Fault {
        let t = self.triangles[triangle];
        let ([a, b], _) = self.longest(t);
        let uv = if self.is_border(a, b) || !(self.uprightness(t) > 0.0) {
            t.iter().map(|&i| self.uv[i as usize]).sum::<DVec2>() / 3.0
        } else {
            0.5 * (self.uv[a as usize] + self.uv[b as usize])
        };
        Fault { distance: f64::INFINITY, uv, triangle }
    }

    /// Calls `report` with the greatest fault of each triangle for which `wanted` holds: at its centre, and at the
    /// middles of its inner sides, each side looked at from one of its triangles. Border sides are the edges'
    /// business.
    pub(crate) fn inspect(
        &self,
        surface: &SurfaceGeometry,
        Limits { turn, shortest, close, .. }: Limits,
        mut wanted: impl FnMut([u32; 3]) -> bool,
        mut report: impl FnMut(Fault),
    ) {
        if matches!(surface, SurfaceGeometry::Plane(_)) {
            return;
        }
        for (triangle, &t) in self.triangles.iter().enumerate() {
            if !wanted(t) {
                continue;
            }
            let [p, q, r] = t.map(|i| (self.uv[i as usize], self.at[i as usize]));
            let look = |w: [f64; 3]| {
                let uv = p.0 * w[0] + q.0 * w[1] + r.0 * w[2];
                let at = p.1 * w[0] + q.1 * w[1] + r.1 * w[2];
                Fault { distance: distance(surface, uv, at), uv, triangle }
            };
            let mut worst = look([1.0 / 3.0; 3]);
            for (k, middle) in SIDES.into_iter().enumerate() {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                if a < b && !self.is_border(a, b) {
                    let mut fault = look(middle);
                    let cosine = self.normals[a as usize].dot(self.normals[b as usize]);
                    let length = self.at[a as usize].distance(self.at[b as usize]);
                    if cosine < turn && length > shortest {
                        fault.distance = f64::INFINITY;
                    }
                    worst = worse(worst, fault);
                }
            }
            // Only where it may matter: between the centre and the corners.
            if worst.distance > close {
                worst = BETWEEN.into_iter().map(look).fold(worst, worse);
            }
            report(worst);
        }
    }

    /// Greatest distance found by [`Self::inspect`].
    pub(crate) fn worst(&self, surface: &SurfaceGeometry) -> f64 {
        let mut worst = 0.0f64;
        let limits = Limits { turn: -2.0, tilt: -2.0, shortest: 0.0, tiny: 0.0, close: f64::INFINITY };
        self.inspect(surface, limits, |_| true, |f| worst = worst.max(f.distance));
        worst
    }
}

/// Distance of `at` from the surface's tangent plane at `uv`, whose point is close to it: its distance from the
/// surface but for terms of higher order, however unevenly the parameters run.
fn distance(surface: &SurfaceGeometry, uv: DVec2, at: DVec3) -> f64 {
    let (p, u, v) = surface.first_derivatives(uv.x, uv.y);
    match u.cross(v).try_normalize() {
        Some(normal) => (p - at).dot(normal).abs(),
        None => p.distance(at),
    }
}

/// Unit normal along `u x v`; where the tangents fail, that of a point slightly towards `inside`; or zero.
fn normal(surface: &SurfaceGeometry, at: DVec2, inside: DVec2) -> DVec3 {
    for step in [0.0, 1e-6, 1e-4, 1e-2] {
        let p = at.lerp(inside, step);
        let (_, u, v) = surface.first_derivatives(p.x, p.y);
        let n = u.cross(v);
        if n.length_squared() > 1e-24 * u.length_squared() * v.length_squared() {
            return n.normalize_or_zero();
        }
    }
    DVec3::ZERO
}
