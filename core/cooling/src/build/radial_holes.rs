//! Radial holes: round passages along a straight axis from hub to tip.

use super::bitangent::bitangent_frame;
use super::error::BuildError;
use super::sections::Section;
use super::style;
use super::tube::Patch;
use crate::plan::{PlacementPlan, RadialHolePlan};
use coolinggen_blade::{Blade, Law};
use coolinggen_brep::SurfaceGeometry;
use coolinggen_nurbs::{Curve, Interpolator, Knots, Surface};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// A radial hole in space.
#[derive(Clone, Debug)]
pub struct RadialHoleGeometry {
    /// Name.
    pub name: String,
    /// Where the axis meets the hub, mm.
    pub hub: DVec3,
    /// Where the axis meets the tip, mm.
    pub tip: DVec3,
    /// Diameter at the hub and at the tip, mm.
    pub diameters: [f64; 2],
    law: Law,
}

impl RadialHoleGeometry {
    /// Diameter at a fraction of the axis from hub to tip, mm.
    pub fn diameter(&self, fraction: f64) -> f64 {
        self.law.at(fraction)
    }
}

/// Where the hole's axis meets hub and tip.
pub(super) fn place(
    blade: &Blade,
    ends: [&Section; 2],
    hole: &RadialHolePlan,
) -> Result<RadialHoleGeometry, BuildError> {
    let mut points = [DVec3::ZERO; 2];
    for (section, point) in ends.into_iter().zip(&mut points) {
        let v = section.stream.v();
        let q = match &hole.at {
            PlacementPlan::Camber(position, offset) => {
                let circle = section.camber.at(position.at(v));
                let suction = section.outline.frame(circle.suction).point;
                let normal = circle.tangent.perp();
                let toward = normal * normal.dot(suction - circle.center).signum();
                circle.center + toward * (offset.at(v) / section.scale(circle.center))
            }
            PlacementPlan::Stream(m, t) => section.stream.chart_of_stream(m.at(v), t.at(v)),
            PlacementPlan::Bitangent(across, along, from) => {
                let frame = bitangent_frame(blade, &section.stream)?;
                let scale = section.scale(frame.origin);
                let origin = frame.origin_at(*from);
                origin + (frame.u * across.at(v) + frame.v * along.at(v)) / scale
            }
        };
        *point = section.stream.to_space(q);
    }
    let diameters = [hole.diameter.at(0.0), hole.diameter.at(1.0)];
    Ok(RadialHoleGeometry {
        name: hole.name.clone(),
        hub: points[0],
        tip: points[1],
        diameters,
        law: hole.diameter.clone(),
    })
}

/// Spans round half a circle: the cubic lies within `(pi / 48)^4 / 384` = 5e-8 radii of it.
const SPANS: usize = 48;
/// Nodes along the axis where the diameter varies.
const STATIONS: usize = 12;

/// The two half faces of the hole, reaching beyond hub and tip; their natural normals point away from the axis.
pub(super) fn patches(hole: &RadialHoleGeometry) -> Result<Vec<Patch>, BuildError> {
    let length = hole.hub.distance(hole.tip);
    let axis = (hole.tip - hole.hub) / length;
    let e1 = axis.any_orthonormal_vector();
    let e2 = axis.cross(e1);
    // Far enough beyond the ends to be cut off by surfaces inclined up to 60 degrees to the axis.
    let beyond = hole.diameters[0].max(hole.diameters[1]) + 0.02 * length;
    let (knots_v, stations) = stations(&hole.law, length, beyond)?;
    let style = style::radial_hole();
    let mut patches = Vec::new();
    for (half, part) in [(0.0, "a"), (1.0, "b")] {
        let arc = half_circle(half * PI)?;
        let columns: Vec<Curve<DVec3>> = stations
            .iter()
            .map(|&(s, radius)| arc.map(|c| hole.hub + axis * s + (e1 * c.x + e2 * c.y) * radius))
            .collect();
        let surface = Surface::from_columns(&columns, knots_v.clone())?;
        let surface = SurfaceGeometry::BSpline(surface);
        patches.push(Patch {
            name: format!("radial_hole/{}/{part}", hole.name),
            style: style.clone(),
            surface,
        });
    }
    Ok(patches)
}

/// Half the unit circle from `start` on, as a cubic over the angle.
fn half_circle(start: f64) -> Result<Curve<DVec2>, BuildError> {
    let nodes: Vec<f64> = (0..=SPANS).map(|i| start + PI * i as f64 / SPANS as f64).collect();
    let points: Vec<DVec2> = (0..=SPANS)
        .map(|i| match i {
            // Both halves end in the same points, bit for bit.
            0 => DVec2::new(if start == 0.0 { 1.0 } else { -1.0 }, 0.0),
            SPANS => DVec2::new(if start == 0.0 { -1.0 } else { 1.0 }, 0.0),
            i => DVec2::from_angle(nodes[i]),
        })
        .collect();
    let slope = |angle: f64| DVec2::from_angle(angle).perp();
    Ok(Interpolator::with_slopes(&nodes)?.curve_with_slopes(&points, slope(start), slope(start + PI))?)
}

/// Knots along the axis and the control values (station, radius): degree 1 for a constant diameter, else cubic.
fn stations(diameter: &Law, length: f64, beyond: f64) -> Result<(Knots, Vec<(f64, f64)>), BuildError> {
    let (start, end) = (-beyond, length + beyond);
    let (least, most) = diameter.bounds();
    if least == most {
        return Ok((Knots::clamped(1, &[start, end])?, vec![(start, 0.5 * least), (end, 0.5 * least)]));
    }
    let nodes: Vec<f64> =
        (0..=STATIONS).map(|i| start + (end - start) * i as f64 / STATIONS as f64).collect();
    let values: Vec<DVec2> = nodes.iter().map(|&s| DVec2::new(s, 0.5 * diameter.at(s / length))).collect();
    let curve = Interpolator::new(3, &nodes)?.curve(&values)?;
    Ok((curve.knots().clone(), curve.points().iter().map(|p| (p.x, p.y)).collect()))
}
