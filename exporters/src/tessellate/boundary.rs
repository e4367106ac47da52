//! The border of a face as polygons in its parameters.

use coolinggen_brep::{Face, SurfaceGeometry};
use coolinggen_nurbs::{ParametricCurve, ParametricSurface};
use glam::DVec2;

/// Relative size below which differences of parameters are rounding.
const ROUNDING: f64 = 1e-9;

/// A corner of a border polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node {
    /// Point of the tessellation.
    pub(crate) point: u32,
    /// Parameters.
    pub(crate) uv: DVec2,
    /// Edge of the model that the segment **from** this node belongs to.
    pub(crate) edge: usize,
    /// Number of that segment along the edge.
    pub(crate) segment: usize,
}

/// Values of one parameter that straight borders run at, so that rounding does not make them wavy.
struct Levels {
    values: Vec<f64>,
    tolerance: f64,
}

impl Levels {
    fn new(range: (f64, f64), bounds: (f64, f64)) -> Self {
        let values = [bounds.0, bounds.1].into_iter().filter(|v| v.is_finite()).collect();
        Self { values, tolerance: ROUNDING * (range.1 - range.0) }
    }

    /// The known level at `value`, or `value` as a new one.
    fn snap(&mut self, value: f64) -> f64 {
        match self.values.iter().find(|&&v| (v - value).abs() <= self.tolerance) {
            Some(&known) => known,
            None => {
                self.values.push(value);
                value
            }
        }
    }
}

/// The loops of `face` as closed polygons in the direction of the loops. `parameters[e]` are the parameters that
/// edge `e` is cut at, `polylines[e]` its points.
pub(crate) fn polygons(
    face: &Face,
    (low, high): (DVec2, DVec2),
    parameters: &[Vec<f64>],
    polylines: &[Vec<u32>],
) -> Vec<Vec<Node>> {
    let (bounds_u, bounds_v) = match &face.surface {
        SurfaceGeometry::Plane(_) => Default::default(),
        surface => surface.domain(),
    };
    let mut levels = [Levels::new((low.x, high.x), bounds_u), Levels::new((low.y, high.y), bounds_v)];
    if matches!(face.surface, SurfaceGeometry::Plane(_)) {
        levels.iter_mut().for_each(|l| l.values.clear());
    }
    let gap = (high - low) * 1e-6;
    let mut out = Vec::with_capacity(face.loops.len());
    for bound in &face.loops {
        // Constant parameters of each edge.
        let constants: Vec<[Option<f64>; 2]> = bound
            .coedges
            .iter()
            .map(|c| {
                let first = c.pcurve.points()[0];
                [0, 1].map(|k| {
                    let level =
                        c.pcurve.points().iter().all(|p| (p[k] - first[k]).abs() <= levels[k].tolerance);
                    level.then(|| levels[k].snap(first[k]))
                })
            })
            .collect();
        let count = bound.coedges.len();
        let mut polygon: Vec<Node> = Vec::new();
        for (i, c) in bound.coedges.iter().enumerate() {
            let e = c.edge.0;
            let (t, ids) = (&parameters[e], &polylines[e]);
            let steps = t.len() - 1;
            let at = |k: usize| if c.forward { k } else { steps - k };
            let uv = |k: usize| {
                let mut p = c.pcurve.point(t[at(k)]);
                for axis in 0..2 {
                    if let Some(level) = constants[i][axis] {
                        p[axis] = level;
                    }
                }
                p
            };
            // The corner belongs to two edges: what either holds constant holds there.
            let before = (i + count - 1) % count;
            let mut corner = uv(0);
            let arrival = bound.coedges[before].parameter_at(1.0);
            let joined = (arrival - corner).abs().cmple(gap).all();
            if joined {
                for axis in 0..2 {
                    if let (None, Some(level)) = (constants[i][axis], constants[before][axis]) {
                        corner[axis] = level;
                    }
                }
            } else {
                // A side that is one point in space: both its ends, the same point of the mesh.
                let mut p = arrival;
                for axis in 0..2 {
                    if let Some(level) = constants[before][axis] {
                        p[axis] = level;
                    }
                }
                polygon.push(Node { point: ids[at(0)], uv: p, edge: usize::MAX, segment: 0 });
            }
            let node =
                |k: usize, uv: DVec2| Node { point: ids[at(k)], uv, edge: e, segment: at(k).min(at(k + 1)) };
            polygon.push(node(0, corner));
            polygon.extend((1..steps).map(|k| node(k, uv(k))));
        }
        out.push(polygon);
    }
    out
}
