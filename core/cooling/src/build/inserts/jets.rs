//! Jets: round bores through an insert's sheet, in arrays of rows and columns.

use super::super::blank::Blank;
use super::super::chambers::{BACK, FRONT};
use super::super::error::BuildError;
use super::super::ligaments::Ligaments;
use super::super::style;
use super::Insert;
use crate::bore::{BoreNames, BoreShape, Frame, Hull, Mouth, circle};
use crate::design::InsertSide;
use crate::plan::{InsertPlan, JetArrayPlan};
use coolinggen_blade::Fault;
use coolinggen_brep::{Caster, FaceId, Model};
use coolinggen_nurbs::{ParametricSurface, line_meets_surface};
use glam::{DVec2, DVec3};

/// A jet as built.
#[derive(Clone, Debug)]
pub struct JetGeometry {
    /// Name of the chamber in which its insert stands.
    pub insert: String,
    /// Name of its array.
    pub array: String,
    /// Number in the array, from 1, row by row from the hub.
    pub number: usize,
    /// Where its axis leaves the sheet, mm.
    pub exit: DVec3,
    /// Unit direction, out of the insert.
    pub axis: DVec3,
    /// Diameter, mm.
    pub diameter: f64,
    /// Length of the axis in the sheet, mm.
    pub length: f64,
    /// Distance along the axis from the sheet to what the jet impinges on, mm, with the name of that face; none where the
    /// axis meets no face of the chamber.
    pub target: Option<(f64, String)>,
    /// Greatest distances to the jets beside it and above it, diameters: x/d and y/d; none for a lone column or row.
    pub pitch_d: [Option<f64>; 2],
}

/// A jet to be bored.
struct Jet<'p> {
    array: &'p JetArrayPlan,
    pointer: &'p str,
    number: usize,
    exit: Mouth,
    inner: Mouth,
    point: DVec3,
    axis: DVec3,
    /// Towards the tip, along the sheet.
    up: DVec3,
    pitch_d: [Option<f64>; 2],
}

/// Bores the jets of all inserts.
pub(in super::super) fn add_jets(
    blank: &mut Blank<'_>,
    plans: &[InsertPlan],
) -> Result<Vec<JetGeometry>, BuildError> {
    let (mut made, mut faults) = (Vec::new(), Vec::new());
    for (index, plan) in plans.iter().enumerate().filter(|(_, plan)| !plan.jets.is_empty()) {
        let pointers: Vec<String> =
            (0..plan.jets.len()).map(|i| format!("{}/jets/{i}", plan.pointer())).collect();
        let insert = &blank.inserts[index];
        let inside = Caster::new(blank.model, insert.tubes[1].faces.iter().copied());
        let targets = Caster::new(blank.model, blank.passages[insert.passages[0]].faces.iter().copied());
        let mut jets = Vec::new();
        for (array, pointer) in plan.jets.iter().zip(&pointers) {
            match place(blank.model, insert, &inside, array, pointer) {
                Ok(more) => jets.extend(more),
                Err(fault) => faults.push(fault),
            }
        }
        faults.extend(overlaps(&jets));
        if !faults.is_empty() {
            continue;
        }
        let name = insert.name.clone();
        for jet in &jets {
            blank.watch.go_on()?;
            let target = target(blank.model, &targets, jet);
            match jet.bore(blank, index, &name) {
                Ok(()) => made.push(jet.geometry(&name, target)),
                Err(fault) => faults.push(fault),
            }
        }
    }
    if faults.is_empty() { Ok(made) } else { Err(BuildError::Refused(faults)) }
}

/// A fault for every jet that meets the nearest one.
fn overlaps(jets: &[Jet<'_>]) -> Vec<Fault> {
    let planned = jets.iter().map(|jet| {
        let ends = [jet.point + jet.axis * jet.inner.z, jet.point];
        let name = format!("jet {} of array \"{}\"", jet.number, jet.array.name);
        (Hull { ends, radii: [0.5 * jet.array.diameter; 2] }, name)
    });
    Ligaments::default().add(planned, 0.0, |i, what| jets[i].fault("ligament", what)).1
}

/// The face that a line meets first, with where it does: parameters and distance.
fn met(model: &Model, caster: &Caster, origin: DVec3, direction: DVec3) -> Option<Mouth> {
    let met = caster.first(origin, direction, 1e-6)?;
    let hint = (met.at.x, met.at.y);
    let hit = line_meets_surface(&model.face(met.face).surface, origin, direction, hint, met.along)?;
    Some(Mouth { face: met.face, at: DVec2::new(hit.u, hit.v), z: hit.along })
}

/// Distance along the jet to the chamber's face that it impinges on, and the face's name.
fn target(model: &Model, targets: &Caster, jet: &Jet<'_>) -> Option<(f64, String)> {
    let met = met(model, targets, jet.point, jet.axis)?;
    Some((met.z, model.face(met.face).name.clone()))
}

/// Intervals in which the length of a face is measured across the span.
const STEPS: usize = 32;

/// The faces of one side of an insert's outside, in the direction in which positions are counted.
struct SideFaces<'m> {
    model: &'m Model,
    faces: Vec<FaceId>,
    reversed: bool,
    /// Span fractions between which gap and plenum lie opposite each other.
    span: (f64, f64),
}

impl<'m> SideFaces<'m> {
    fn new(model: &'m Model, insert: &Insert, side: InsertSide) -> Self {
        // In the order of a ring's segments.
        let (segments, reversed): (&[usize], bool) = match side {
            InsertSide::SuctionSide => (&[0], false),
            InsertSide::Back => (&BACK, false),
            InsertSide::PressureSide => (&[4], true),
            InsertSide::Front => (&FRONT, false),
        };
        let faces = segments.iter().map(|&k| insert.tubes[0].faces[k]).collect();
        let spans = insert.tubes.each_ref().map(|tube| model.face(tube.faces[0]).surface.domain().1);
        let span = (spans[0].0.max(spans[1].0), spans[0].1.min(spans[1].1));
        Self { model, faces, reversed, span }
    }

    fn point(&self, place: (FaceId, f64), v: f64) -> DVec3 {
        self.model.face(place.0).surface.point(place.1, v)
    }

    /// Places along the side at a span fraction, and the length up to each, mm.
    fn lengths(&self, v: f64) -> (Vec<(FaceId, f64)>, Vec<f64>) {
        let faces = self.faces.iter();
        let steps = faces.flat_map(|&face| (0..=STEPS).map(move |i| (face, i as f64 / STEPS as f64)));
        let mut places: Vec<(FaceId, f64)> = steps.collect();
        if self.reversed {
            places.reverse();
        }
        let mut lengths = vec![0.0; places.len()];
        for i in 1..places.len() {
            lengths[i] = lengths[i - 1] + self.point(places[i], v).distance(self.point(places[i - 1], v));
        }
        (places, lengths)
    }

    /// Length of the side at a span fraction, mm.
    fn length(&self, v: f64) -> f64 {
        self.lengths(v).1.last().copied().unwrap_or(0.0)
    }

    /// The place at a fraction of the side's length.
    fn at(&self, fraction: f64, v: f64) -> (FaceId, f64) {
        let (places, lengths) = self.lengths(v);
        let wanted = fraction * lengths[lengths.len() - 1];
        let k = lengths.partition_point(|&l| l < wanted).clamp(1, lengths.len() - 1);
        let ((before, t0), (face, t1)) = (places[k - 1], places[k]);
        let share = (wanted - lengths[k - 1]) / (lengths[k] - lengths[k - 1]);
        if before == face && share.is_finite() { (face, t0 + (t1 - t0) * share) } else { (face, t1) }
    }

    /// Length over the span along the middle of a part of the side, mm.
    fn height(&self, fraction: f64, [from, to]: [f64; 2]) -> f64 {
        let at = |i: usize| {
            let v = from + (to - from) * i as f64 / STEPS as f64;
            self.point(self.at(fraction, v), v)
        };
        (0..STEPS).map(|i| at(i).distance(at(i + 1))).sum()
    }
}

/// The jets of an array, each with its mouths.
fn place<'p>(
    model: &Model,
    insert: &Insert,
    inside: &Caster,
    array: &'p JetArrayPlan,
    pointer: &'p str,
) -> Result<Vec<Jet<'p>>, Fault> {
    let side = SideFaces::new(model, insert, array.side);
    let (low, high) = side.span;
    if !(array.span[0] >= low && array.span[1] <= high) {
        let message = format!(
            "array \"{}\" runs from span fraction {} to {}, the sheet parts plenum and gap from {low:.4} to {high:.4}",
            array.name, array.span[0], array.span[1]
        );
        let (end, limit) = if array.span[0] < low { (0, low) } else { (1, high) };
        let fault = Fault::new(format!("{pointer}/span/{end}"), "limit", message).value(array.span[end]);
        let fault = if end == 0 { fault.min(limit) } else { fault.max(limit) };
        return Err(fault.unit("span fraction"));
    }
    let [from, to] = array.position;
    let middle = 0.5 * (array.span[0] + array.span[1]);
    let ends = [array.span[0], middle, array.span[1]];
    let width = (to - from) * ends.map(|v| side.length(v)).into_iter().fold(0.0, f64::max);
    let height = side.height(0.5 * (from + to), array.span);
    let (columns, rows) = (array.columns.on(width), array.rows.on(height));
    let pitch = |length: f64, count: usize| (count > 1).then(|| length / count as f64 / array.diameter);
    let pitch_d = [pitch(width, columns), pitch(height, rows)];
    let mut jets = Vec::with_capacity(rows * columns);
    for row in 0..rows {
        let v = array.span[0] + (array.span[1] - array.span[0]) * (row as f64 + 0.5) / rows as f64;
        // Half the shift to either side keeps every row within its part.
        let shift = array.stagger * [-0.5, 0.5][row % 2];
        for column in 0..columns {
            let fraction = from + (to - from) * (column as f64 + 0.5 + shift) / columns as f64;
            let (face, t) = side.at(fraction, v);
            let (point, along, up) = model.face(face).surface.first_derivatives(t, v);
            let axis = along.cross(up).normalize() * if insert.outward { 1.0 } else { -1.0 };
            let number = jets.len() + 1;
            let Some(inner) = met(model, inside, point, -axis) else {
                let message =
                    format!("jet {number} of array \"{}\" reaches no plenum along its axis", array.name);
                return Err(Fault::new(pointer, "reaches_no_chamber", message));
            };
            let inner = Mouth { z: -inner.z, ..inner };
            let exit = Mouth { face, at: DVec2::new(t, v), z: 0.0 };
            jets.push(Jet { array, pointer, number, exit, inner, point, axis, up, pitch_d });
        }
    }
    Ok(jets)
}

impl Jet<'_> {
    fn fault(&self, code: &'static str, what: impl std::fmt::Display) -> Fault {
        let message = format!("jet {} of array \"{}\" {what}", self.number, self.array.name);
        Fault::new(self.pointer, code, message)
    }

    fn bore(&self, blank: &mut Blank<'_>, insert: usize, name: &str) -> Result<(), Fault> {
        let length = -self.inner.z;
        let frame = Frame::along(self.point, self.axis, self.up);
        let shape = BoreShape::straight(frame, circle(-length, 0.5 * self.array.diameter), length);
        let path = format!("insert/{name}/jet/{}/{:03}", self.array.name, self.number);
        let style = style::jet();
        let names = BoreNames { path: &path, stages: &["bore"], style: &style };
        blank
            .bore_jet(&shape, insert, [self.inner, self.exit], &names)
            .map_err(|error| self.fault(error.code(), error))
    }

    fn geometry(&self, insert: &str, target: Option<(f64, String)>) -> JetGeometry {
        JetGeometry {
            insert: insert.to_owned(),
            array: self.array.name.clone(),
            number: self.number,
            exit: self.point,
            axis: self.axis,
            diameter: self.array.diameter,
            length: -self.inner.z,
            target,
            pitch_d: self.pitch_d,
        }
    }
}
