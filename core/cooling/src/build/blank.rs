//! What bores are drilled into: the outer surface and the passages.

use super::error::BuildError;
use super::inserts::Insert;
use super::kept::KeptBores;
use super::ligaments::Ligaments;
use super::passages::{Branch, Host, Link, Passage, PassagePart};
use super::style;
use crate::bore::{BoreError, BoreNames, BoreShape, Bored, Mouth, Rim, Rims, Wholes};
use crate::watch::Watch;
use coolinggen_blade::{Region, StreamSurface};
use coolinggen_brep::{
    CastHit, Caster, Face, FaceDomain, FaceId, FaceUse, Key, Loop, Model, SurfaceGeometry,
};
use coolinggen_nurbs::{NurbsError, ParametricCurve, ParametricSurface, Surface};
use glam::{DVec2, DVec3};
use std::collections::HashMap;
use std::sync::Arc;

/// A blade with its passages, before its solids are made.
pub(super) struct Blank<'a> {
    pub(super) model: &'a mut Model,
    /// Faces of the outer surface; grows where bores part them.
    pub(super) outer: &'a mut Vec<FaceId>,
    pub(super) passages: &'a mut [Passage],
    pub(super) inserts: &'a mut [Insert],
    /// Bores that join passages.
    pub(super) links: Vec<Link>,
    /// Whether the outer faces' natural normals point out of the blade.
    pub(super) outward: bool,
    /// Hub and tip.
    pub(super) ends: &'a [StreamSurface; 2],
    /// Faces that bores have split off.
    pub(super) parts: Parts,
    /// Least metal between neighbouring bores, mm.
    pub(super) least_ligament: f64,
    /// The bores through metal.
    pub(super) ligaments: Ligaments,
    /// Their borders on the faces they end on.
    pub(super) rims: Rims,
    /// What is known of the bores of the build before.
    pub(super) kept: &'a mut KeptBores,
    pub(super) watch: &'a dyn Watch,
}

/// What a bore ends on.
#[derive(Clone, Copy)]
enum Side {
    /// The faces of this passage.
    Passage(usize),
    /// The faces of this insert towards the gap.
    Insert(usize),
    /// The outer surface.
    Outer,
    /// This face alone.
    Face(FaceId),
}

impl Side {
    fn faces<'s>(
        &'s self,
        passages: &'s [Passage],
        inserts: &'s [Insert],
        outer: &'s [FaceId],
    ) -> &'s [FaceId] {
        match self {
            Self::Passage(passage) => &passages[*passage].faces,
            Self::Insert(insert) => &inserts[*insert].outside,
            Self::Outer => outer,
            Self::Face(face) => std::slice::from_ref(face),
        }
    }
}

impl Blank<'_> {
    /// Bores from a passage (the first mouth) through the outer surface (the second). Answers with the faces
    /// `<path>/exit` that close the coolant there, one for each outer face that the bore breaks out of.
    pub(super) fn bore_out(
        &mut self,
        shape: &BoreShape,
        passage: usize,
        mouths: [Mouth; 2],
        names: &BoreNames<'_>,
    ) -> Result<Vec<FaceId>, BoreError> {
        let bored = self.bore(shape, [Side::Passage(passage), Side::Outer], mouths, names)?;
        let [_, upper] = bored.imprints;
        let mut exits = Vec::with_capacity(1);
        for (i, (parent, border)) in upper.inside.into_iter().enumerate() {
            let room = self.room_to_ends(&border);
            if !(room > 0.0) {
                return Err(BoreError::BeyondEnds(-room));
            }
            let name = if i == 0 {
                format!("{}/exit", names.path)
            } else {
                format!("{}/exit/{}", names.path, i + 1)
            };
            exits.push(self.add_exit(name, parent, border));
        }
        let ends = exits.iter().map(|&face| FaceUse { face, forward: self.outward }).collect();
        self.passages[passage].branches.push(Branch { faces: bored.faces, ends });
        Ok(exits)
    }

    /// Bores through the material between two bodies of coolant, or between two places of one: they become one coolant
    /// solid, or a passage with a handle more. Answers with the bore's faces, each with whether its natural normal
    /// points out of the coolant.
    pub(super) fn bore_between(
        &mut self,
        shape: &BoreShape,
        passages: [usize; 2],
        mouths: [Mouth; 2],
        names: &BoreNames<'_>,
    ) -> Result<Vec<(FaceId, bool)>, BoreError> {
        let bored = self.bore(shape, passages.map(Side::Passage), mouths, names)?;
        self.links.push(Link { passages, faces: bored.faces.clone(), host: Host::Metal });
        Ok(bored.faces)
    }

    /// Bores through the sheet of an insert, from its plenum (the first mouth) to the gap.
    pub(super) fn bore_jet(
        &mut self,
        shape: &BoreShape,
        insert: usize,
        mouths: [Mouth; 2],
        names: &BoreNames<'_>,
    ) -> Result<(), BoreError> {
        let [gap, plenum] = self.inserts[insert].passages;
        let bored = self.bore(shape, [Side::Passage(plenum), Side::Insert(insert)], mouths, names)?;
        self.links.push(Link { passages: [gap, plenum], faces: bored.faces, host: Host::Insert(insert) });
        Ok(())
    }

    /// A pin through a passage: metal inside the bore, coolant round it.
    pub(super) fn pin(
        &mut self,
        shape: &BoreShape,
        passage: usize,
        mouths: [Mouth; 2],
        names: &BoreNames<'_>,
    ) -> Result<(), BoreError> {
        let bored = self.bore(shape, [Side::Passage(passage); 2], mouths, names)?;
        let faces = bored.faces.into_iter().map(|(face, away)| (face, !away)).collect();
        self.passages[passage].pins.push(faces);
        Ok(())
    }

    /// Bores from a passage, or from the cap that closes it, through the tip face, which the metal uses as `tip`.
    /// Answers with the face `<path>/exit` that closes the coolant there.
    pub(super) fn bore_tip(
        &mut self,
        shape: &BoreShape,
        (passage, cap): (usize, Option<FaceId>),
        tip: FaceUse,
        mouths: [Mouth; 2],
        names: &BoreNames<'_>,
    ) -> Result<FaceId, BoreError> {
        let from = cap.map_or(Side::Passage(passage), Side::Face);
        let bored = self.bore(shape, [from, Side::Face(tip.face)], mouths, names)?;
        let [_, upper] = bored.imprints;
        let border = upper.inside.into_iter().next().map(|(_, border)| border).unwrap_or_default();
        let exit = self.add_exit(format!("{}/exit", names.path), tip.face, border);
        let ends = vec![FaceUse { face: exit, forward: tip.forward }];
        self.passages[passage].branches.push(Branch { faces: bored.faces, ends });
        Ok(exit)
    }

    /// Bores between the faces of two sides and keeps the parts that it makes of them.
    fn bore(
        &mut self,
        shape: &BoreShape,
        sides: [Side; 2],
        mouths: [Mouth; 2],
        names: &BoreNames<'_>,
    ) -> Result<Bored, BoreError> {
        let [lower, upper] = mouths.map(|mouth| Mouth { face: self.part_at(mouth.face, mouth.at), ..mouth });
        let ends = [
            (sides[0].faces(self.passages, self.inserts, self.outer), lower),
            (sides[1].faces(self.passages, self.inserts, self.outer), upper),
        ];
        let in_sheet = sides.iter().any(|side| matches!(side, Side::Insert(_)));
        let least = if in_sheet { 0.0 } else { self.least_ligament };
        let (rims, parts) = (&mut self.rims, &self.parts);
        let mut clear = |mut new: [Rim; 2]| {
            new.iter_mut().flat_map(|rim| &mut rim.faces).for_each(|face| *face = parts.whole(*face));
            rims.add(names.path, new, least)
        };
        let bored = self.kept.drill.bore(self.model, shape, ends, names, parts, &mut clear)?;
        for (side, imprint) in sides.iter().zip(&bored.imprints) {
            let faces = match side {
                Side::Passage(passage) => &mut self.passages[*passage].faces,
                Side::Insert(insert) => &mut self.inserts[*insert].outside,
                Side::Outer => &mut *self.outer,
                Side::Face(_) => continue,
            };
            faces.extend(imprint.parts.iter().map(|(part, _)| *part));
            for &(part, from) in &imprint.parts {
                let whole = self.parts.whole(from);
                self.parts.of.insert(part, whole);
            }
        }
        Ok(bored)
    }

    /// The face that a part was split off from, or the face itself.
    pub(super) fn whole(&self, face: FaceId) -> FaceId {
        self.parts.whole(face)
    }

    /// What lines meet of the passages.
    pub(super) fn passage_caster(&mut self) -> Arc<Caster> {
        let faces: Vec<FaceId> = self.passages.iter().flat_map(|p| p.faces.iter().copied()).collect();
        self.caster(&faces)
    }

    /// What lines meet of faces; parts are met as what they are parts of.
    pub(super) fn caster(&mut self, faces: &[FaceId]) -> Arc<Caster> {
        let lasting: Vec<FaceId> = faces.iter().copied().filter(|face| self.parts.lasts(*face)).collect();
        let key = lasting.iter().fold(Key::default(), |key, face| key.and(face.0));
        let kept = self.kept.casters.find(&key);
        kept.unwrap_or_else(|| {
            let caster = Arc::new(Caster::new(self.model, lasting));
            self.kept.casters.keep(key, Arc::clone(&caster));
            caster
        })
    }

    /// The part of a face that holds a place in its parameters.
    fn part_at(&self, face: FaceId, at: DVec2) -> FaceId {
        let face = self.whole(face);
        let mut parts: Vec<FaceId> =
            self.parts.of.iter().filter(|(_, whole)| **whole == face).map(|(part, _)| *part).collect();
        parts.sort();
        let holds = |part: &FaceId| FaceDomain::new(self.model.face(*part)).contains(at);
        parts.into_iter().find(holds).unwrap_or(face)
    }

    /// The chamber of this name, and the index of its passage.
    pub(super) fn chamber(&self, name: &str) -> Result<(usize, &PassagePart), BuildError> {
        let path = format!("chamber/{name}");
        let part = |passage: &'_ Passage| passage.parts.iter().position(|part| part.path == path);
        let mut passages = self.passages.iter().enumerate();
        let found = passages.find_map(|(i, passage)| Some((i, &passage.parts[part(passage)?])));
        Ok(found.ok_or(NurbsError::NotFound { what: "the passage of a chamber" })?)
    }

    /// Whether a line leaves a passage's coolant where it meets one of its faces.
    pub(super) fn leaves(&self, passage: usize, hit: &CastHit, direction: DVec3) -> bool {
        let (_, u, v) = self.model.face(hit.face).surface.first_derivatives(hit.at.x, hit.at.y);
        (u.cross(v).dot(direction) > 0.0) == self.passages[passage].outward
    }

    /// What lines meet of one region of the outer surface, as it was before any bore.
    pub(super) fn outer_caster(&mut self, region: Region) -> Arc<Caster> {
        let path = format!("blade/{}", region.name());
        let own = |face: &&FaceId| {
            let rest = self.model.face(**face).name.strip_prefix(&path);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        };
        let faces: Vec<FaceId> = self.outer.iter().filter(own).copied().collect();
        self.caster(&faces)
    }

    /// The outer face that a point of the blade's surface lies on, with u in [0, 1].
    pub(super) fn outer_face(&self, at: DVec2) -> Option<FaceId> {
        self.outer.iter().copied().find(|&face| {
            let ((u0, u1), _) = self.model.face(face).surface.domain();
            (u0..=u1).contains(&at.x)
        })
    }

    /// The face that closes the coolant where a hole breaks out: a piece of the outer surface no larger than it must be.
    fn add_exit(&mut self, name: String, parent: FaceId, border: Loop) -> FaceId {
        let surface = match &self.model.face(parent).surface {
            SurfaceGeometry::BSpline(surface) => {
                let whole = self.parts.whole(parent);
                let make =
                    || Ok::<_, NurbsError>(window(surface, &border).unwrap_or_else(|| surface.clone()));
                let window = if self.parts.lasts(whole) {
                    self.kept.windows.get_by(|| Key::of(whole.0).and(&*border.coedges), make)
                } else {
                    make()
                };
                SurfaceGeometry::BSpline(window.unwrap_or_else(|_| surface.clone()))
            }
            other => other.clone(),
        };
        self.model.add_face(Face { name, surface, loops: vec![border], style: style::outlet() })
    }

    /// Distance from a breakout to hub or tip, mm, negative beyond: the outer faces end there before their surface.
    fn room_to_ends(&self, border: &Loop) -> f64 {
        let mut room = f64::INFINITY;
        for coedge in &border.coedges {
            let curve = &self.model.edge(coedge.edge).curve;
            let (start, end) = curve.domain();
            for t in [start, 0.5 * (start + end)] {
                let p = curve.point(t);
                room = room.min(self.ends[0].level(p).0).min(-self.ends[1].level(p).0);
            }
        }
        room
    }
}

/// Faces that bores have split off.
#[derive(Clone, Debug)]
pub(super) struct Parts {
    /// Each with the face whose surface it shares.
    of: HashMap<FaceId, FaceId>,
    /// Number of faces before any bore.
    lasting: usize,
}

impl Parts {
    /// None yet, of a model with as many faces.
    pub(super) fn of(faces: usize) -> Self {
        Self { of: HashMap::new(), lasting: faces }
    }
}

impl Wholes for Parts {
    fn whole(&self, face: FaceId) -> FaceId {
        self.of.get(&face).copied().unwrap_or(face)
    }

    fn lasts(&self, face: FaceId) -> bool {
        face.0 < self.lasting
    }
}

/// The part of a surface that holds a loop, with a margin.
fn window(surface: &Surface<DVec3>, border: &Loop) -> Option<Surface<DVec3>> {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for q in border.coedges.iter().flat_map(|c| c.pcurve.points()) {
        (low, high) = (low.min(*q), high.max(*q));
    }
    let margin = 0.1 * (high - low);
    let ((u0, u1), (v0, v1)) = surface.domain();
    let (low, high) = ((low - margin).max(DVec2::new(u0, v0)), (high + margin).min(DVec2::new(u1, v1)));
    // Across the shorter side of the net first: what is cut then is small.
    if surface.counts().0 < surface.counts().1 {
        surface.restricted_v(low.y, high.y).ok()?.restricted_u(low.x, high.x).ok()
    } else {
        surface.restricted_u(low.x, high.x).ok()?.restricted_v(low.y, high.y).ok()
    }
}
