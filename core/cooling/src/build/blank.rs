//! What bores are drilled into: the outer surface and the passages.

use super::passages::{Branch, Passage};
use super::style;
use crate::bore::{BoreError, BoreNames, BoreShape, Drill, Mouth};
use coolinggen_blade::{Region, StreamSurface};
use coolinggen_brep::{Caster, Face, FaceDomain, FaceId, FaceUse, Loop, Model, SurfaceGeometry};
use coolinggen_nurbs::{ParametricCurve, ParametricSurface, Surface};
use glam::{DVec2, DVec3};

/// A blade with its passages, before its solids are made.
pub(super) struct Blank<'a> {
    pub(super) model: &'a mut Model,
    /// Faces of the outer surface; grows where bores part them.
    pub(super) outer: &'a mut Vec<FaceId>,
    pub(super) passages: &'a mut [Passage],
    /// Whether the outer faces' natural normals point out of the blade.
    pub(super) outward: bool,
    /// Hub and tip.
    pub(super) ends: &'a [StreamSurface; 2],
    /// Faces that bores have split off, each with the face whose surface it shares.
    pub(super) parts: Vec<(FaceId, FaceId)>,
}

impl Blank<'_> {
    /// Bores from a passage (the first mouth) through the outer surface (the second). Answers with the faces
    /// `<path>/exit` that close the coolant there, one for each outer face that the bore breaks out of.
    pub(super) fn bore_out(
        &mut self,
        drill: &mut Drill,
        shape: &BoreShape,
        passage: usize,
        [inner, outer]: [Mouth; 2],
        names: &BoreNames<'_>,
    ) -> Result<Vec<FaceId>, BoreError> {
        let [inner, outer] =
            [inner, outer].map(|mouth| Mouth { face: self.part_at(mouth.face, mouth.at), ..mouth });
        let faces = &self.passages[passage].faces;
        let bored = drill.bore(self.model, shape, [(faces, inner), (self.outer, outer)], names)?;
        let [lower, upper] = bored.imprints;
        self.passages[passage].faces.extend(lower.parts.iter().map(|(part, _)| *part));
        self.outer.extend(upper.parts.iter().map(|(part, _)| *part));
        for (part, from) in lower.parts.into_iter().chain(upper.parts) {
            let whole = self.parts.iter().find(|(known, _)| *known == from).map_or(from, |(_, whole)| *whole);
            self.parts.push((part, whole));
        }
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
            exits.push(add_exit(self.model, name, parent, border));
        }
        let ends = exits.iter().map(|&face| FaceUse { face, forward: self.outward }).collect();
        self.passages[passage].branches.push(Branch { faces: bored.faces, ends });
        Ok(exits)
    }

    /// The part of a face that holds a place in its parameters.
    fn part_at(&self, face: FaceId, at: DVec2) -> FaceId {
        let mut parts = self.parts.iter().filter(|(_, whole)| *whole == face).map(|(part, _)| *part);
        parts.find(|&part| FaceDomain::new(self.model.face(part)).contains(at)).unwrap_or(face)
    }

    /// What lines meet of one region of the outer surface, as it was before any bore.
    pub(super) fn outer_caster(&self, region: Region) -> Caster {
        let path = format!("blade/{}", region.name());
        let own = |face: &&FaceId| {
            let rest = self.model.face(**face).name.strip_prefix(&path);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        };
        Caster::new(self.model, self.outer.iter().filter(own).copied())
    }

    /// The outer face that a point of the blade's surface lies on, with u in [0, 1].
    pub(super) fn outer_face(&self, at: DVec2) -> Option<FaceId> {
        self.outer.iter().copied().find(|&face| {
            let ((u0, u1), _) = self.model.face(face).surface.domain();
            (u0..=u1).contains(&at.x)
        })
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
fn window(surface: &Surface<DVec3>, border: &Loop) -> Option<Surface<DVec3>> {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for q in border.coedges.iter().flat_map(|c| c.pcurve.points()) {
        (low, high) = (low.min(*q), high.max(*q));
    }
    let margin = 0.1 * (high - low);
    let ((u0, u1), (v0, v1)) = surface.domain();
    let (low, high) = ((low - margin).max(DVec2::new(u0, v0)), (high + margin).min(DVec2::new(u1, v1)));
    surface.restricted_u(low.x, high.x).ok()?.restricted_v(low.y, high.y).ok()
}
