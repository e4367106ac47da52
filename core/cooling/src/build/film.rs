//! Film holes: from rows to bores between the outer surface and the passages.

use super::error::BuildError;
use super::passages::{Branch, Passage};
use super::sides::{Sides, SurfacePoint};
use super::style;
use crate::bore::{
    BoreError, BoreNames, BoreSection, BoreShape, Drill, Frame, Mouth, circle, rounded_rectangle,
    stretched_circle,
};
use crate::design::HoleShape;
use crate::plan::{FilmRowPlan, RowHoles};
use coolinggen_blade::Fault;
use coolinggen_brep::{Caster, Face, FaceId, FaceUse, Loop, Model, SurfaceGeometry};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// A film hole as built.
#[derive(Clone, Debug)]
pub struct FilmHoleGeometry {
    /// Name of its row.
    pub row: String,
    /// Number in the row, from 1 at the hub.
    pub number: usize,
    /// The passage that feeds it.
    pub passage: String,
    /// Where the axis breaks out, mm.
    pub exit: DVec3,
    /// Unit direction of the axis, out of the blade.
    pub axis: DVec3,
    /// Diameter of the metering part, mm.
    pub diameter: f64,
    /// Length of the axis in the metal, mm.
    pub length: f64,
    /// Angles to the surface and about its normal, degrees.
    pub angles_deg: [f64; 2],
    /// Area of the exit's section normal to the axis over that of the metering part.
    pub area_ratio: f64,
    /// Width of the exit across the axis over the distance between holes; none for a lone hole.
    pub coverage: Option<f64>,
    /// Faces of the breakout in the outer surface.
    pub exits: Vec<FaceId>,
}

/// What film holes are drilled into.
pub(super) struct Blank<'a> {
    pub(super) model: &'a mut Model,
    /// Faces of the outer surface; grows where holes part them.
    pub(super) outer: &'a mut Vec<FaceId>,
    pub(super) passages: &'a mut [Passage],
    /// Whether the outer faces' natural normals point out of the blade.
    pub(super) outward: bool,
}

/// A hole to be drilled.
struct Hole<'p> {
    row: &'p FilmRowPlan,
    pointer: String,
    number: usize,
    at: SurfacePoint,
    axis: DVec3,
    angles_deg: [f64; 2],
    radius: f64,
    pitch: Option<f64>,
}

/// Drills all rows.
pub(super) fn add_film_rows(
    blank: &mut Blank<'_>,
    sides: &Sides<'_>,
    rows: &[FilmRowPlan],
) -> Result<Vec<FilmHoleGeometry>, BuildError> {
    let passage_faces = blank.passages.iter().flat_map(|p| p.faces.iter().copied());
    let caster = Caster::new(blank.model, passage_faces);
    let mut drill = Drill::default();
    let mut drilled = Vec::new();
    let mut faults = Vec::new();
    for (k, row) in rows.iter().enumerate() {
        let pointer = format!("/cooling/film_rows/{k}");
        for hole in holes(sides, row, &pointer) {
            match drill_hole(blank, &caster, &mut drill, &hole) {
                Ok(made) => drilled.push(made),
                Err(fault) => faults.push(fault),
            }
        }
    }
    if faults.is_empty() { Ok(drilled) } else { Err(BuildError::Refused(faults)) }
}

/// The holes of a row from hub to tip.
fn holes<'p>(sides: &Sides<'_>, row: &'p FilmRowPlan, pointer: &str) -> Vec<Hole<'p>> {
    let length = sides.row_length(row.side, &row.at, row.span);
    let count = match row.holes {
        RowHoles::Count(count) => count as usize,
        RowHoles::Pitch(pitch) => ((length / pitch).ceil() as usize).max(1),
    };
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
    fn fault(&self, code: &'static str, what: impl std::fmt::Display) -> Fault {
        let message = format!("hole {} of film row \"{}\" {what}", self.number, self.row.name);
        Fault::new(self.pointer.clone(), code, message)
    }

    /// The shape of a hole of this length along the axis, and the area of its exit over that of its metering part.
    fn shape(&self, length: f64) -> Result<(BoreShape, f64, f64), Fault> {
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
                        "has {:.3} mm of wall along its axis, too little for its metering length",
                        length
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
                let exit: BoreSection = rounded_rectangle(end, low, high, corner);
                let size = high - low;
                let area = size.x * size.y - (4.0 - PI) * corner * corner;
                let sections = vec![stretched_circle(-length, r), stretched_circle(start, r), exit];
                (BoreShape { frame, sections }, area / circle_area, size.x)
            }
        })
    }
}

fn drill_hole(
    blank: &mut Blank<'_>,
    caster: &Caster,
    drill: &mut Drill,
    hole: &Hole<'_>,
) -> Result<FilmHoleGeometry, Fault> {
    let reach = 1e-6;
    let Some(met) = caster.first(hole.at.point, -hole.axis, reach) else {
        return Err(hole.fault("reaches_no_chamber", "reaches no chamber along its axis"));
    };
    let fed = blank.passages.iter().position(|p| p.faces.contains(&met.face));
    let Some(fed) = fed else {
        return Err(hole.fault("reaches_no_chamber", "reaches no chamber along its axis"));
    };
    let passage = blank.passages[fed].name.clone();
    if let Some(wanted) = hole.row.chamber.as_ref().filter(|c| **c != passage) {
        let what = format!("meets chamber \"{passage}\" before \"{wanted}\"");
        return Err(hole.fault("other_chamber", what));
    }
    let outer = outer_mouth(blank.model, blank.outer, hole);
    let Some(outer) = outer else {
        return Err(hole.fault("leaves_blade", "breaks out beyond hub or tip"));
    };
    let length = met.along;
    let (shape, area_ratio, width) = hole.shape(length)?;
    let inner = Mouth { face: met.face, at: met.at, z: -length };
    let path = format!("film/{}/{:03}", hole.row.name, hole.number);
    let stages: &[&str] = if shape.sections.len() > 2 { &["metering", "diffuser"] } else { &["bore"] };
    let style = style::film();
    let names = BoreNames { path: &path, stages, style: &style };
    let faces = blank.passages[fed].faces.clone();
    let bored = drill
        .bore(blank.model, &shape, [(&faces, inner), (blank.outer, outer)], &names)
        .map_err(|error| bore_fault(hole, &error))?;
    let [lower, upper] = bored.imprints;
    for (part, _) in lower.parts {
        blank.passages[fed].faces.push(part);
    }
    blank.outer.extend(upper.parts.iter().map(|(part, _)| *part));
    let exits: Vec<FaceId> = (upper.inside.into_iter().enumerate())
        .map(|(i, (parent, border))| {
            let name = if i == 0 { format!("{path}/exit") } else { format!("{path}/exit/{}", i + 1) };
            add_exit(blank.model, name, parent, border)
        })
        .collect();
    blank.passages[fed].branches.push(Branch {
        faces: bored.faces,
        ends: exits.iter().map(|&face| FaceUse { face, forward: blank.outward }).collect(),
    });
    Ok(FilmHoleGeometry {
        row: hole.row.name.clone(),
        number: hole.number,
        passage,
        exit: hole.at.point,
        axis: hole.axis,
        diameter: 2.0 * hole.radius,
        length,
        angles_deg: hole.angles_deg,
        area_ratio,
        coverage: hole.pitch.map(|pitch| width / pitch),
        exits,
    })
}

fn bore_fault(hole: &Hole<'_>, error: &BoreError) -> Fault {
    let code = match error {
        BoreError::Leaves(_) => "leaves_face",
        BoreError::TooShort(_) => "wall_too_thin",
        BoreError::Misses | BoreError::Inaccurate | BoreError::Geometry(_) => "geometry",
    };
    hole.fault(code, error)
}

/// The outer face on which the hole breaks out.
fn outer_mouth(model: &Model, outer: &[FaceId], hole: &Hole<'_>) -> Option<Mouth> {
    let at = hole.at.at;
    let face = outer.iter().copied().find(|&face| {
        let face = model.face(face);
        let ((u0, u1), _) = coolinggen_nurbs::ParametricSurface::domain(&face.surface);
        (u0..=u1).contains(&at.x)
    })?;
    Some(Mouth { face, at, z: 0.0 })
}

/// The face that closes the coolant where a hole breaks out: a piece of the outer surface no larger than it must be.
fn add_exit(model: &mut Model, name: String, parent: FaceId, border: Loop) -> FaceId {
    let surface = match &model.face(parent).surface {
        SurfaceGeometry::BSpline(surface) => {
            SurfaceGeometry::BSpline(window(surface, &border).unwrap_or_else(|| surface.clone()))
        }
        other => other.clone(),
    };
    model.add_face(Face { name, surface, loops: vec![border], style: style::outlet() })
}

/// The part of a surface that holds a loop, with a margin.
fn window(
    surface: &coolinggen_nurbs::Surface<DVec3>,
    border: &Loop,
) -> Option<coolinggen_nurbs::Surface<DVec3>> {
    use coolinggen_nurbs::ParametricSurface;
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for q in border.coedges.iter().flat_map(|c| c.pcurve.points()) {
        (low, high) = (low.min(*q), high.max(*q));
    }
    let margin = 0.1 * (high - low);
    let ((u0, u1), (v0, v1)) = surface.domain();
    let (low, high) = ((low - margin).max(DVec2::new(u0, v0)), (high + margin).min(DVec2::new(u1, v1)));
    surface.restricted_u(low.x, high.x).ok()?.restricted_v(low.y, high.y).ok()
}
