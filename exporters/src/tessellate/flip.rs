//! Diagonals exchanged where triangles stand askew on the surface.
//!
//! The triangulation is a good one in a map of the parameters that is nearly isometric, but not near a pole: there the
//! lines of constant u and of constant v may run side by side in space, and three nodes that are far from a line in
//! the map are close to one in space. Such a triangle's plane has little to do with the surface's.

use super::patch::Patch;
use glam::DVec3;
use std::collections::HashMap;

/// Rounds of exchanges; a round looks at the triangles that the last one touched.
const ROUNDS: usize = 12;

impl Patch {
    /// Least cosine between a triangle's normal and the surface's at its corners; 1 where the triangle vanishes.
    pub(crate) fn uprightness(&self, t: [u32; 3]) -> f64 {
        if self.vanishes(t) {
            return 1.0;
        }
        let normal = self.cross(t).normalize_or_zero();
        let cosine = |&i: &u32| match self.normals[i as usize] {
            DVec3::ZERO => 1.0,
            n => n.dot(normal),
        };
        t.iter().map(cosine).fold(1.0, f64::min)
    }

    /// Exchanges the diagonals of triangles whose normals are off the surface's by more than the angle of this cosine, as
    /// long as the worse of two neighbours gets better by it. Borders stay.
    pub(crate) fn exchange_diagonals(&mut self, tilt: f64) {
        let mut bad: Vec<usize> =
            (0..self.triangles.len()).filter(|&i| self.uprightness(self.triangles[i]) < tilt).collect();
        if bad.is_empty() {
            return;
        }
        // The triangle to the left of each directed side.
        let mut left: HashMap<[u32; 2], usize> = HashMap::with_capacity(3 * self.triangles.len());
        for (i, t) in self.triangles.iter().enumerate() {
            left.extend(sides(*t).map(|s| (s, i)));
        }
        for _ in 0..ROUNDS {
            let mut touched = Vec::new();
            for i in bad {
                if let Some(j) = self.exchange_best(i, &mut left) {
                    touched.extend([i, j]);
                }
            }
            touched.sort_unstable();
            touched.dedup();
            if touched.is_empty() {
                return;
            }
            // Their neighbours may get better by them.
            let near = touched.iter().flat_map(|&i| sides(self.triangles[i]));
            let mut next: Vec<usize> = near.filter_map(|[a, b]| left.get(&[b, a]).copied()).collect();
            next.extend(&touched);
            next.sort_unstable();
            next.dedup();
            next.retain(|&i| self.uprightness(self.triangles[i]) < tilt);
            bad = next;
        }
    }

    /// Exchanges the diagonal between triangle `i` and that neighbour for which it helps most, which it names.
    fn exchange_best(&mut self, i: usize, left: &mut HashMap<[u32; 2], usize>) -> Option<usize> {
        let here = self.uprightness(self.triangles[i]);
        let mut best: Option<(f64, usize, [[u32; 3]; 2])> = None;
        for [a, b] in sides(self.triangles[i]) {
            let Some(&j) = left.get(&[b, a]) else { continue };
            let [c, d] = [i, j].map(|k| self.triangles[k].into_iter().find(|p| *p != a && *p != b));
            let (Some(c), Some(d)) = (c, d) else { continue };
            let pair = [[a, d, c], [d, b, c]];
            let inside = pair.iter().all(|t| self.turns_left(*t) && !self.vanishes(*t));
            if !inside || left.contains_key(&[c, d]) || left.contains_key(&[d, c]) {
                continue;
            }
            let before = here.min(self.uprightness(self.triangles[j]));
            let gain = pair.map(|t| self.uprightness(t)).into_iter().fold(1.0, f64::min) - before;
            if gain > 1e-9 && best.is_none_or(|(most, ..)| gain > most) {
                best = Some((gain, j, pair));
            }
        }
        let (_, j, pair) = best?;
        for k in [i, j] {
            for side in sides(self.triangles[k]) {
                left.remove(&side);
            }
        }
        for (k, t) in [i, j].into_iter().zip(pair) {
            self.triangles[k] = t;
            left.extend(sides(t).map(|s| (s, k)));
        }
        Some(j)
    }

    /// Whether a triangle is counterclockwise in the parameters.
    fn turns_left(&self, t: [u32; 3]) -> bool {
        let [a, b, c] = t.map(|i| self.uv[i as usize]);
        (b - a).perp_dot(c - a) > 0.0
    }
}

fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}
