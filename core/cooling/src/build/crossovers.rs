//! Crossover holes: straight bores through the wall between two chambers.

use super::blank::Blank;
use super::chambers::{BACK, FRONT};
use super::error::BuildError;
use super::fit::{greatest, nearest};
use super::style;
use crate::bore::{BoreNames, BoreShape, Frame, Hull, Mouth, racetrack};
use crate::plan::{CrossoverRowPlan, Plan};
use coolinggen_blade::Fault;
use coolinggen_brep::{CastHit, Caster, FaceId, SurfaceGeometry};
use coolinggen_nurbs::ParametricSurface;
use glam::DVec3;

/// A crossover hole as built.
#[derive(Clone, Debug)]
pub struct CrossoverGeometry {
    /// Name of its row.
    pub row: String,
    /// Number in the row, from 1 at the hub.
    pub number: usize,
    /// The chambers before and behind the wall.
    pub chambers: [String; 2],
    /// Middle of the axis, mm.
    pub center: DVec3,
    /// Unit direction of the axis, from the chamber before the wall to the one behind it.
    pub axis: DVec3,
    /// Width normal to the axis, mm.
    pub diameter: f64,
    /// Size along the span, mm.
    pub height: f64,
    /// Length of the axis in the wall, mm.
    pub length: f64,
    /// Metal to the nearest other bore, mm; none if that is far.
    pub ligament: Option<f64>,
}

/// A wall as its two chambers have it.
struct Wall {
    passages: [usize; 2],
    chambers: [String; 2],
    /// Faces of the wall and its fillets, before and behind.
    faces: [Vec<FaceId>; 2],
    /// The flat faces before and behind.
    flats: [SurfaceGeometry; 2],
    /// Span fractions that both chambers have.
    span: [f64; 2],
}

impl Wall {
    fn of(blank: &Blank<'_>, plan: &Plan, wall: usize) -> Result<Self, BuildError> {
        let chambers = [wall, wall + 1].map(|k| plan.chambers[k].name.clone());
        let (front_passage, front) = blank.chamber(&chambers[0])?;
        let (back_passage, back) = blank.chamber(&chambers[1])?;
        let flats = [front.faces[BACK[1]], back.faces[FRONT[1]]];
        let flats = flats.map(|face| blank.model.face(face).surface.clone());
        let [(_, a), (_, b)] = [&flats[0], &flats[1]].map(ParametricSurface::domain);
        Ok(Self {
            passages: [front_passage, back_passage],
            faces: [BACK.map(|k| front.faces[k]).to_vec(), FRONT.map(|k| back.faces[k]).to_vec()],
            flats,
            span: [a.0.max(b.0), a.1.min(b.1)],
            chambers,
        })
    }

    /// The middle of the wall at a span fraction and a fraction of its width from the pressure side; the faces of the
    /// chamber before it run from the suction side, those behind it from the pressure side.
    fn middle(&self, v: f64, position: f64) -> DVec3 {
        let [front, back] = &self.flats;
        0.5 * (front.point(1.0 - position, v) + back.point(position, v))
    }

    /// The middle, the unit normal towards the back, the unit directions towards tip and suction side.
    fn frame(&self, v: f64, position: f64) -> [DVec3; 4] {
        let [front, back] = &self.flats;
        let (before, across, rise) = front.first_derivatives(1.0 - position, v);
        let (behind, other_across, other_rise) = back.first_derivatives(position, v);
        let through = behind - before;
        let toward_back = |normal: DVec3| normal.normalize() * normal.dot(through).signum();
        let normal =
            (toward_back(across.cross(rise)) + toward_back(other_across.cross(other_rise))).normalize();
        let rise = rise + other_rise;
        let up = (rise - normal * rise.dot(normal)).normalize();
        let suction = normal.cross(up);
        [0.5 * (before + behind), normal, up, suction * suction.dot(other_across).signum()]
    }

    fn length(&self, position: impl Fn(f64) -> f64, [start, end]: [f64; 2]) -> f64 {
        const STEPS: u32 = 16;
        let at = |i: u32| {
            let v = start + (end - start) * f64::from(i) / f64::from(STEPS);
            self.middle(v, position(v))
        };
        (0..STEPS).map(|i| at(i).distance(at(i + 1))).sum()
    }
}

/// Which hole it is.
#[derive(Clone, Copy)]
struct Label<'p> {
    row: &'p CrossoverRowPlan,
    number: usize,
}

impl Label<'_> {
    fn text(self) -> String {
        format!("hole {} of crossover row \"{}\"", self.number, self.row.name)
    }

    fn fault(self, code: &'static str, what: impl std::fmt::Display) -> Fault {
        let message = format!("{} {what}", self.text());
        Fault::new(format!("/cooling/crossover_rows/{}", self.row.index), code, message)
    }

    /// The fault of a hole whose axis does not meet the wall on both sides; `fits` tells whether it does at a share of
    /// its angles.
    fn misses(self, angles: [f64; 2], fits: impl Fn(f64) -> bool) -> Fault {
        let fault = self.fault("meets_no_wall", "does not meet the wall's faces on both sides");
        // The angle that leans more is blamed.
        let skewed = angles[1].abs() > angles[0].abs();
        let (field, angle) = if skewed { ("/skew_deg", angles[1]) } else { ("/inclination_deg", angles[0]) };
        let Some(limit) = nearest(0.0, 1.0, fits).map(|share| share * angle) else {
            return fault.hint("another position or span");
        };
        let fault = Fault { pointer: fault.pointer.clone() + field, ..fault }.value(angle).unit("deg");
        if angle > 0.0 { fault.max(limit) } else { fault.min(limit) }
    }
}

/// A crossover hole to be drilled.
struct Crossover<'p> {
    label: Label<'p>,
    passages: [usize; 2],
    chambers: [String; 2],
    middle: DVec3,
    axis: DVec3,
    up: DVec3,
    diameter: f64,
    /// Where the axis meets the chambers before and behind, mm along it.
    mouths: [Mouth; 2],
}

/// Drills all rows.
pub(super) fn add_crossover_rows(
    blank: &mut Blank<'_>,
    plan: &Plan,
) -> Result<Vec<CrossoverGeometry>, BuildError> {
    if plan.crossover_rows.is_empty() {
        return Ok(Vec::new());
    }
    let caster = Caster::new(blank.model, blank.passages.iter().flat_map(|p| p.faces.iter().copied()));
    let (mut planned, mut faults) = (Vec::new(), Vec::new());
    for row in &plan.crossover_rows {
        let wall = Wall::of(blank, plan, row.wall)?;
        match holes(blank, &caster, &wall, row) {
            Ok(holes) => planned.extend(holes),
            Err(refused) => faults.extend(refused),
        }
    }
    let hulls = planned.iter().map(|hole| (hole.hull(), hole.label.text()));
    let least = blank.least_ligament;
    let (ligaments, near) =
        blank.ligaments.add(hulls, least, |i, what| planned[i].label.fault("ligament", what));
    faults.extend(near);
    if !faults.is_empty() {
        return Err(BuildError::Refused(faults));
    }
    let mut made = Vec::with_capacity(planned.len());
    for (hole, ligament) in planned.iter().zip(ligaments) {
        blank.watch.go_on()?;
        match hole.drill(blank) {
            Ok(()) => made.push(hole.geometry(ligament)),
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok(made) } else { Err(BuildError::Refused(faults)) }
}

/// The holes of a row, from hub to tip, each where it meets both chambers all round.
fn holes<'p>(
    blank: &Blank<'_>,
    caster: &Caster,
    wall: &Wall,
    row: &'p CrossoverRowPlan,
) -> Result<Vec<Crossover<'p>>, Vec<Fault>> {
    let [low, high] = wall.span;
    if row.span[0] < low || row.span[1] > high {
        let [a, b] = &wall.chambers;
        let message = format!(
            "the wall stands between chambers \"{a}\" and \"{b}\" from span fraction {low:.4} to {high:.4} alone"
        );
        let value = if row.span[0] < low { row.span[0] } else { row.span[1] };
        let fault = Fault::new(format!("/cooling/crossover_rows/{}/span", row.index), "beyond_wall", message);
        return Err(vec![fault.value(value).min(low).max(high).unit("span fraction")]);
    }
    let count = row.holes.on(wall.length(|v| row.position.at(v), row.span));
    let (mut holes, mut faults) = (Vec::with_capacity(count), Vec::new());
    for i in 0..count {
        let v = row.span[0] + (row.span[1] - row.span[0]) * (i as f64 + 0.5) / count as f64;
        match Crossover::placed(blank, caster, wall, Label { row, number: i + 1 }, v) {
            Ok(hole) => holes.push(hole),
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok(holes) } else { Err(faults) }
}

impl<'p> Crossover<'p> {
    fn placed(
        blank: &Blank<'_>,
        caster: &Caster,
        wall: &Wall,
        label: Label<'p>,
        v: f64,
    ) -> Result<Self, Fault> {
        let row = label.row;
        let [middle, normal, up, suction] = wall.frame(v, row.position.at(v));
        let angles = [row.inclination_deg.at(v), row.skew_deg.at(v)];
        let axis = |share: f64| {
            let [tip, side] = angles.map(|degrees| (share * degrees).to_radians().tan());
            (normal + up * tip + suction * side).normalize()
        };
        let met = |side: usize, from: DVec3, axis: DVec3| -> Option<CastHit> {
            let hit = caster.first(from, if side == 0 { -axis } else { axis }, 1e-6)?;
            wall.faces[side].contains(&blank.whole(hit.face)).then_some(hit)
        };
        let ends = |axis: DVec3| Some([met(0, middle, axis)?, met(1, middle, axis)?]);
        let Some([before, behind]) = ends(axis(1.0)) else {
            return Err(label.misses(angles, |share| ends(axis(share)).is_some()));
        };
        let mouth = |hit: CastHit, z: f64| Mouth { face: hit.face, at: hit.at, z };
        let mouths = [mouth(before, -before.along), mouth(behind, behind.along)];
        // All round: each line of the bore must begin and end on the wall or on its fillets.
        let (axis, diameter) = (axis(1.0), row.diameter.at(v));
        let frame = Frame::along(middle, axis, up);
        let fits = |diameter: f64| {
            let rim = racetrack(0.0, 0.5 * diameter, row.height_d).rim(16);
            // From the middle of the wall, where there is metal however much the bore is inclined.
            let mut points = rim.into_iter().map(|q| {
                let across = frame.vector(q);
                middle + across - axis * (across.dot(normal) / axis.dot(normal))
            });
            points.all(|p| met(0, p, axis).is_some() && met(1, p, axis).is_some())
        };
        if !fits(diameter) {
            let what = "runs over the fillets of the wall or past its end".to_owned();
            let fault = label.fault("leaves_wall", what).value(diameter).unit("mm");
            return Err(match greatest(diameter, fits) {
                Some(most) => fault.max(most),
                None => fault.hint("another position or span"),
            });
        }
        let (passages, chambers) = (wall.passages, wall.chambers.clone());
        Ok(Self { label, passages, chambers, middle, axis, up, diameter, mouths })
    }

    fn height(&self) -> f64 {
        self.diameter * self.label.row.height_d
    }

    fn length(&self) -> f64 {
        self.mouths[1].z - self.mouths[0].z
    }

    fn hull(&self) -> Hull {
        let ends = [0, 1].map(|side| self.middle + self.axis * self.mouths[side].z);
        Hull::inside(ends, 0.5 * self.height())
    }

    fn drill(&self, blank: &mut Blank<'_>) -> Result<(), Fault> {
        let outline = racetrack(self.mouths[0].z, 0.5 * self.diameter, self.label.row.height_d);
        let frame = Frame::along(self.middle, self.axis, self.up);
        let shape = BoreShape::straight(frame, outline, self.length());
        let path = format!("crossover/{}/{:03}", self.label.row.name, self.label.number);
        let style = style::crossover();
        let names = BoreNames { path: &path, stages: &["bore"], style: &style };
        blank
            .bore_between(&shape, self.passages, self.mouths, &names)
            .map(|_| ())
            .map_err(|error| self.label.fault(error.code(), error))
    }

    fn geometry(&self, ligament: Option<f64>) -> CrossoverGeometry {
        CrossoverGeometry {
            row: self.label.row.name.clone(),
            number: self.label.number,
            chambers: self.chambers.clone(),
            center: self.middle + self.axis * (0.5 * (self.mouths[0].z + self.mouths[1].z)),
            axis: self.axis,
            diameter: self.diameter,
            height: self.height(),
            length: self.length(),
            ligament,
        }
    }
}
