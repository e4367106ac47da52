//! A film hole: where it stands in its row and what shape it has.

use super::super::sides::{Sides, SurfacePoint};
use crate::bore::{BoreShape, Frame, circle, rounded_rectangle, stretched_circle};
use crate::design::HoleShape;
use crate::plan::FilmRowPlan;
use coolinggen_blade::Fault;
use coolinggen_brep::Key;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// A hole to be drilled.
pub(super) struct Hole<'p> {
    pub(super) row: &'p FilmRowPlan,
    pub(super) pointer: String,
    pub(super) number: usize,
    pub(super) at: SurfacePoint,
    pub(super) axis: DVec3,
    pub(super) angles_deg: [f64; 2],
    pub(super) radius: f64,
    pub(super) pitch: Option<f64>,
}

/// The holes of a row from hub to tip.
pub(super) fn holes<'p>(sides: &Sides<'_>, row: &'p FilmRowPlan, pointer: &str) -> Vec<Hole<'p>> {
    let length = sides.row_length(row.side, &row.at, row.span);
    let count = row.holes.on(length);
    let pitch = (count > 1).then(|| length / count as f64);
    (0..count)
        .map(|i| {
            let part = (i as f64 + 0.5 + row.stagger) / count as f64;
            let v = row.span[0] + (row.span[1] - row.span[0]) * part;
            let at = sides.place(row.side, &row.at, v);
            let angles_deg = [row.inclination_deg.at(v), row.compound_deg.at(v)];
            let [alpha, beta] = angles_deg.map(f64::to_radians);
            let along = at.downstream * beta.cos() + at.spanwise * beta.sin();
            let axis = at.normal * alpha.sin() + along * alpha.cos();
            let radius = 0.5 * row.diameter.at(v);
            let pointer = pointer.to_owned();
            Hole { row, pointer, number: i + 1, at, axis, angles_deg, radius, pitch }
        })
        .collect()
}

impl Hole<'_> {
    /// What messages call it.
    pub(super) fn label(&self) -> String {
        format!("hole {} of film row \"{}\"", self.number, self.row.name)
    }

    /// Everything that what feeds it depends on, besides the passages.
    pub(super) fn key(&self) -> Key {
        let at = &self.at;
        let angles = (self.angles_deg[0], self.angles_deg[1]);
        let key = Key::of((at.point, at.downstream, at.spanwise)).and((self.axis, self.radius, angles));
        let key = match self.row.shape {
            HoleShape::Cylindrical => key.and(0_usize),
            HoleShape::Conical { expansion_deg } => key.and((1_usize, expansion_deg)),
            HoleShape::Shaped {
                metering_length_d: metering,
                lateral_expansion_deg: lateral,
                forward_expansion_deg: forward,
                corner_radius_d: corner,
            } => key.and((2_usize, metering)).and((lateral, forward, corner)),
            HoleShape::Racetrack { width_d } => key.and((3_usize, width_d)),
        };
        key.and(self.row.chamber.as_deref())
    }

    pub(super) fn fault(&self, code: &'static str, what: impl std::fmt::Display) -> Fault {
        let message = format!("{} {what}", self.label());
        Fault::new(self.pointer.clone(), code, message)
    }

    /// The shape of a hole of this length along the axis, the area of its exit over that of its metering part, and the
    /// width of its breakout between the side walls, mm.
    pub(super) fn shape(&self, length: f64) -> Result<(BoreShape, f64, f64), Fault> {
        let (r, alpha) = (self.radius, self.angles_deg[0].to_radians());
        let beta = self.angles_deg[1].to_radians();
        let downstream = self.at.downstream * beta.cos() + self.at.spanwise * beta.sin();
        // A hole normal to the surface has no downstream of its own.
        let frame = Frame::along(self.at.point, self.axis, downstream);
        let circle_area = PI * r * r;
        Ok(match self.row.shape {
            HoleShape::Cylindrical => (BoreShape::straight(frame, circle(-length, r), length), 1.0, 2.0 * r),
            HoleShape::Conical { expansion_deg } => {
                let exit = r + length * expansion_deg.to_radians().tan();
                let sections = vec![circle(-length, r), circle(0.0, exit)];
                (BoreShape { frame, sections }, (exit / r).powi(2), 2.0 * exit)
            }
            HoleShape::Racetrack { width_d } => {
                let half = DVec2::new(width_d * r, r);
                let outline = rounded_rectangle(-length, -half, half, r);
                (BoreShape::straight(frame, outline, length), 1.0, 2.0 * half.x)
            }
            HoleShape::Shaped {
                metering_length_d,
                lateral_expansion_deg,
                forward_expansion_deg,
                corner_radius_d,
            } => {
                // The exit is taken where the upstream edge breaks out (Schroeder and Thole, GT2014-25992).
                let (start, end) = (2.0 * r * metering_length_d - length, -r / alpha.tan());
                if !(end - start > 0.05 * r) {
                    let greatest = (end + length) / (2.0 * r);
                    let what = format!(
                        "has {length:.3} mm of wall along its axis, too little for its metering length"
                    );
                    let fault = self.fault("wall_too_thin", what).value(metering_length_d).max(greatest);
                    return Err(fault.unit("diameters"));
                }
                let (lateral, forward) = (
                    (end - start) * lateral_expansion_deg.to_radians().tan(),
                    (end - start) * forward_expansion_deg.to_radians().tan(),
                );
                let (low, high) = (DVec2::new(-r - lateral, -r), DVec2::new(r + lateral, r + forward));
                let corner = 2.0 * r * corner_radius_d;
                let exit = rounded_rectangle(end, low, high, corner);
                let size = high - low;
                let area = size.x * size.y - (4.0 - PI) * corner * corner;
                let mut sections = vec![stretched_circle(-length, r), stretched_circle(start, r)];
                // Ruled on beyond the exit the corners would go on shrinking; where too little of them would be left at
                // the downstream end, they have their size from halfway on.
                let farthest =
                    (r - start * forward / (end - start)) / (alpha.tan() - forward / (end - start));
                let farthest = if farthest > 0.0 { farthest.min(length) } else { length };
                let beyond = corner + (corner - r) * (farthest - end) / (end - start);
                if beyond < 0.5 * corner {
                    let (low, high) = (0.5 * (low + DVec2::splat(-r)), 0.5 * (high + DVec2::splat(r)));
                    sections.push(rounded_rectangle(0.5 * (start + end), low, high, corner));
                }
                sections.push(exit);
                // On a flat wall the side walls break out up to where the downstream wall begins.
                let (lateral, forward) =
                    (lateral_expansion_deg.to_radians().tan(), forward_expansion_deg.to_radians().tan());
                let breakout = if alpha.tan() > 2.0 * forward {
                    -start * forward / (alpha.tan() - forward)
                } else {
                    0.0
                };
                let width = 2.0 * (r + (breakout - start) * lateral);
                (BoreShape { frame, sections }, area / circle_area, width)
            }
        })
    }
}
