//! Measures of a model's faces, kept from one build to the next for what is as it was.

use crate::check::{EdgePlace, FaceCheck, SolidCheck};
use crate::mass::{FaceIntegrals, Sums, integrals_by, loop_sums};
use crate::memo::{Key, Memo};
use crate::model::{EdgeId, Face, FaceId, Loop, Model, Solid};
use std::collections::HashMap;

/// What measuring has found on surfaces, loops and faces.
#[derive(Clone, Debug, Default)]
pub struct Measures {
    surfaces: Memo<u64>,
    /// Number of the last new surface.
    last: u64,
    sums: Memo<Sums>,
    checks: Memo<FaceCheck>,
}

/// What has been found on the faces of one model: faces that solids share are checked once.
#[derive(Clone, Debug, Default)]
pub struct Checked(HashMap<FaceId, FaceCheck>);

/// A number for the surface of each face of a model: equal surfaces have equal ones, as long as they are kept.
#[derive(Clone, Debug)]
pub struct Numbered(Vec<u64>);

impl Numbered {
    /// The number of a face's surface.
    pub fn of(&self, face: FaceId) -> u64 {
        self.0[face.0]
    }
}

impl Measures {
    /// Measures of a model that is built once: nothing is kept.
    pub fn once() -> Self {
        Self { surfaces: Memo::idle(), last: 0, sums: Memo::idle(), checks: Memo::idle() }
    }

    /// Numbers the surfaces of a model.
    pub fn numbered(&mut self, model: &Model) -> Numbered {
        if self.surfaces.is_idle() {
            let before = self.last;
            self.last += model.faces.len() as u64;
            return Numbered((before + 1..=self.last).collect());
        }
        Numbered(model.faces.iter().map(|face| self.number(Key::of(&face.surface))).collect())
    }

    /// The number of whatever has this key.
    pub fn number(&mut self, key: Key) -> u64 {
        let last = &mut self.last;
        let number = self.surfaces.find(&key);
        number.unwrap_or_else(|| {
            *last += 1;
            self.surfaces.keep(key, *last);
            *last
        })
    }

    /// As [`crate::face_integrals`], of every face of the model; worth nothing once `stop` has said so.
    pub fn face_integrals(
        &mut self,
        model: &Model,
        numbered: &Numbered,
        stop: &dyn Fn() -> bool,
    ) -> Vec<FaceIntegrals> {
        let sums = &mut self.sums;
        let mut of_face = |(face, number): (&Face, &u64)| {
            integrals_by(face, &mut |surface, bound| {
                let key = || Key::of(*number).and(&*bound.coedges);
                let make = || if stop() { Err(()) } else { Ok(loop_sums(surface, bound)) };
                sums.get_by(key, make).unwrap_or_default()
            })
        };
        model.faces.iter().zip(&numbered.0).map(&mut of_face).collect()
    }

    /// As [`Model::check_solid`], with what was found on faces of the model before; worth nothing once `stop` has said so.
    pub fn check_solid(
        &mut self,
        model: &Model,
        solid: &Solid,
        (numbered, checked): (&Numbered, &mut Checked),
        stop: &dyn Fn() -> bool,
    ) -> SolidCheck {
        model.check_solid_by(solid, &mut |id| {
            let found = checked.0.entry(id).or_insert_with(|| self.check_face(model, id, numbered, stop));
            found.clone()
        })
    }

    fn check_face(
        &mut self,
        model: &Model,
        id: FaceId,
        numbered: &Numbered,
        stop: &dyn Fn() -> bool,
    ) -> FaceCheck {
        if stop() {
            return FaceCheck::default();
        }
        let checks = &mut self.checks;
        if checks.is_idle() {
            return model.check_face(id);
        }
        let face = model.face(id);
        let key = Key::of(numbered.of(id)).and(face.loops.len());
        let key = face.loops.iter().fold(key, |key, bound| bordered(model, bound, key));
        if let Some(mut found) = checks.find(&key) {
            for place in [&mut found.gauge.deviation.1, &mut found.gauge.distance.1] {
                *place = place.map(|place| placed(place, id, face));
            }
            return found;
        }
        let found = model.check_face(id);
        // Faults name what may have another name the next time.
        if found.faults.is_empty() {
            let mut kept = found.clone();
            for place in [&mut kept.gauge.deviation.1, &mut kept.gauge.distance.1] {
                *place = place.map(|place| ordinal(place, face));
            }
            checks.keep(key, kept);
        }
        found
    }

    /// See [`Memo::end_round`].
    pub fn end_round(&mut self, complete: bool) {
        self.surfaces.end_round(complete);
        self.sums.end_round(complete);
        self.checks.end_round(complete);
    }

    /// Numbers of loops integrated and of faces checked so far.
    pub fn made(&self) -> [u64; 2] {
        [self.sums.made(), self.checks.made()]
    }
}

/// A loop with all that its edges are in space.
fn bordered(model: &Model, bound: &Loop, key: Key) -> Key {
    bound.coedges.iter().fold(key.and(&*bound.coedges), |key, coedge| {
        let edge = model.edge(coedge.edge);
        key.and((&edge.curve, model.vertex(edge.start), model.vertex(edge.end)))
    })
}

/// A place with the ordinal of its edge in the face's loops.
fn ordinal(place: EdgePlace, face: &Face) -> EdgePlace {
    let mut edges = face.loops.iter().flat_map(|l| &l.coedges).map(|c| c.edge);
    let ordinal = edges.position(|edge| edge == place.edge).unwrap_or_default();
    EdgePlace { edge: EdgeId(ordinal), ..place }
}

/// The place of an ordinal.
fn placed(place: EdgePlace, id: FaceId, face: &Face) -> EdgePlace {
    let mut edges = face.loops.iter().flat_map(|l| &l.coedges).map(|c| c.edge);
    EdgePlace { face: id, edge: edges.nth(place.edge.0).unwrap_or(place.edge), ..place }
}
