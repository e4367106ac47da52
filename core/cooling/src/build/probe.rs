//! Thickness of the metal at any point of a passage.

use super::error::BuildError;
use coolinggen_blade::Blade;
use coolinggen_nurbs::{ParametricSurface, Projection};
use glam::DVec3;

/// Measures distances to the outer surface, starting each search at the nearest of a grid of its points.
pub(crate) struct Probe<'a> {
    blade: &'a Blade,
    clusters: Vec<Cluster>,
}

/// Neighbouring points of the grid, and a ball that holds them.
struct Cluster {
    center: DVec3,
    radius: f64,
    points: [(DVec3, (f64, f64)); CLUSTER],
}

/// Points of a cluster, a row round the blade.
const CLUSTER: usize = 8;
/// Points of the grid round the blade and along it, and clusters of them.
const AROUND: usize = 12 * CLUSTER;
const ALONG: usize = 9;
const CLUSTERS: usize = AROUND / CLUSTER * ALONG;

impl<'a> Probe<'a> {
    pub(crate) fn new(blade: &'a Blade) -> Self {
        let cluster = |i: usize, j: usize| {
            let points = std::array::from_fn(|k| {
                let (u, w) = ((i * CLUSTER + k) as f64 / AROUND as f64, j as f64 / (ALONG - 1) as f64);
                (blade.surface.point(u, w), (u, w))
            });
            let center = points.iter().map(|(q, _)| *q).sum::<DVec3>() / CLUSTER as f64;
            let radius = points.iter().map(|(q, _)| q.distance(center)).fold(0.0, f64::max);
            Cluster { center, radius, points }
        };
        let places = (0..AROUND / CLUSTER).flat_map(|i| (0..ALONG).map(move |j| (i, j)));
        Self { blade, clusters: places.map(|(i, j)| cluster(i, j)).collect() }
    }

    /// The point of the outer surface nearest to `p`.
    pub(crate) fn foot(&self, p: DVec3) -> Result<Projection, BuildError> {
        let mut best = (f64::INFINITY, (0.0, 0.0));
        let mut search = |cluster: &Cluster| {
            for (q, hint) in &cluster.points {
                let d = q.distance_squared(p);
                if d < best.0 {
                    best = (d, *hint);
                }
            }
            best.0.sqrt()
        };
        let mut away = [0.0; CLUSTERS];
        let (mut least, mut near) = (f64::INFINITY, 0);
        for (i, (away, cluster)) in away.iter_mut().zip(&self.clusters).enumerate() {
            *away = cluster.center.distance_squared(p);
            if *away < least {
                (least, near) = (*away, i);
            }
        }
        let mut least = search(&self.clusters[near]);
        for (away, cluster) in away.iter().zip(&self.clusters) {
            let reach = least + cluster.radius;
            if *away <= reach * reach {
                least = search(cluster);
            }
        }
        Ok(self.blade.closest(p, best.1)?)
    }

    /// Distance into the material, negative outside.
    pub(crate) fn thickness(&self, p: DVec3) -> Result<f64, BuildError> {
        Ok(self.thickness_at(p, &self.foot(p)?))
    }

    /// Distance into the material of a point whose foot is known.
    pub(crate) fn thickness_at(&self, p: DVec3, foot: &Projection) -> f64 {
        let (_, u, w) = self.blade.surface.first_derivatives(foot.u, foot.v);
        let outward = u.cross(w) * if self.blade.outward { 1.0 } else { -1.0 };
        if outward.dot(p - foot.point) <= 0.0 { foot.distance } else { -foot.distance }
    }
}
