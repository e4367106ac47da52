//! Blades given by a surface, inline.

use super::closed::{self, EdgesSpec};
use crate::blade::Blade;
use crate::fault::{Fault, Pointer};
use crate::stream::StreamSpace;
use crate::surface::BladeSurface;
use coolinggen_nurbs::{Knots, RationalSurface, Surface};
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A B-spline or NURBS surface, closed in one parameter and from hub to shroud in the other. It is used exactly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfaceSource {
    /// Degree in u, 1 to 9; around the blade at least 2.
    pub degree_u: usize,
    /// Degree in v, 1 to 9.
    pub degree_v: usize,
    /// Knots in u, not decreasing.
    pub knots_u: Vec<f64>,
    /// Knots in v, not decreasing.
    pub knots_v: Vec<f64>,
    /// Control points `[x, y, z]` in mm: a list over u of lists over v.
    pub points: Vec<Vec<[f64; 3]>>,
    /// Weights in the same order, positive; all 1 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Vec<Vec<f64>>>,
    /// Where the edges are; found if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub edges: Option<EdgesSpec>,
}

const MOST_POINTS: usize = 400_000;

impl SurfaceSource {
    /// Makes the blade.
    pub(super) fn blade(&self, space: &StreamSpace) -> Result<Blade, Vec<Fault>> {
        let surface = self.surface()?;
        closed::blade(&surface, self.edges.as_ref(), closed::CLOSED, space, &Pointer::root())
    }

    fn surface(&self) -> Result<BladeSurface, Vec<Fault>> {
        let mut faults = Vec::new();
        let mut knots = |degree: usize, values: &[f64], name: &str| {
            if !(1..=9).contains(&degree) {
                let message = format!("degree {degree} is outside 1..=9");
                let key = format!("degree_{name}");
                let fault = Fault::new(Pointer::root().at(key), "out_of_range", message);
                faults.push(fault.value(degree).min(1.0).max(9.0));
                return None;
            }
            let key = format!("knots_{name}");
            let read = Knots::new(degree, values.to_vec());
            read.map_err(|e| faults.push(Fault::new(Pointer::root().at(key), "bad_knots", e.to_string())))
                .ok()
        };
        let u = knots(self.degree_u, &self.knots_u, "u");
        let v = knots(self.degree_v, &self.knots_v, "v");
        let (Some(u), Some(v)) = (u, v) else { return Err(faults) };
        let (rows, columns) = (u.control_count(), v.control_count());
        let points = self.net(&self.points, rows, columns, "points", &mut faults);
        if let Some(i) = points.iter().position(|p| !p.iter().all(|c| c.is_finite() && c.abs() < 1e7)) {
            let pointer = Pointer::root().at("points").at(i / columns).at(i % columns);
            faults.push(Fault::new(pointer, "not_finite", "the control point is not finite").unit("mm"));
        }
        let weights = self.weights.as_ref().map(|w| self.net(w, rows, columns, "weights", &mut faults));
        for (i, w) in weights.iter().flatten().enumerate() {
            if !(*w > 0.0 && w.is_finite()) {
                let pointer = Pointer::root().at("weights").at(i / columns).at(i % columns);
                let message = format!("the weight {w} is not positive");
                faults.push(Fault::new(pointer, "out_of_range", message).value(*w).min(0.0));
            }
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        let points: Vec<DVec3> = points.into_iter().map(DVec3::from_array).collect();
        let surface = match weights.filter(|w| w.iter().any(|x| *x != w[0])) {
            None => Surface::new(u, v, points).map(BladeSurface::BSpline),
            Some(w) => RationalSurface::new(u, v, &points, &w).map(BladeSurface::Rational),
        };
        surface.map_err(|e| vec![Fault::new("/points", "bad_surface", e.to_string())])
    }

    /// The entries of a net in one list, checked against the counts that the knots ask for.
    fn net<T: Copy>(
        &self,
        net: &[Vec<T>],
        rows: usize,
        columns: usize,
        name: &str,
        faults: &mut Vec<Fault>,
    ) -> Vec<T> {
        let at = Pointer::root().at(name);
        if rows.saturating_mul(columns) > MOST_POINTS {
            let message = format!("{rows} times {columns} control points are more than {MOST_POINTS}");
            faults.push(Fault::new(at, "point_count", message).max(MOST_POINTS as f64));
            return Vec::new();
        }
        if net.len() != rows {
            let message = format!("{} rows given, {rows} belong to the knots in u", net.len());
            faults.push(
                Fault::new(at, "point_count", message).value(net.len()).min(rows as f64).max(rows as f64),
            );
            return Vec::new();
        }
        if let Some(i) = net.iter().position(|row| row.len() != columns) {
            let message = format!("{} entries given, {columns} belong to the knots in v", net[i].len());
            faults.push(
                Fault::new(at.at(i), "point_count", message)
                    .value(net[i].len())
                    .min(columns as f64)
                    .max(columns as f64),
            );
            return Vec::new();
        }
        net.iter().flatten().copied().collect()
    }
}
