//! Imprinting: closed curves drawn over faces and their borders (DESIGN 5.5).
//!
//! A ring that lies within one face becomes an inner loop. One that crosses borders takes its part of each face it
//! touches: border edges are split where it crosses them, and the loops are traced anew, once for what is left of the
//! face and once for what the ring encloses. Nothing is intersected here: the ring comes with its crossings solved.

mod split;
mod trace;

use crate::build::BuildError;
use crate::domain::{FaceDomain, signed_area};
use crate::model::{Coedge, Face, FaceId, Loop, Model};

/// A piece of a ring: an edge within one face, run through as the border of a hole, the face's material to the left.
#[derive(Clone, Debug)]
pub struct RingPiece {
    /// The face.
    pub face: FaceId,
    /// The edge in its parameters.
    pub coedge: Coedge,
}

/// What an imprint did.
#[derive(Clone, Debug, Default)]
pub struct Imprint {
    /// Faces split off, each with the face it was part of. They bound the same solids.
    pub parts: Vec<(FaceId, FaceId)>,
    /// What the ring encloses, as outer loops of faces yet to be made, each with the face it was part of.
    pub inside: Vec<(FaceId, Loop)>,
}

impl Model {
    /// Cuts the inside of a ring out of the faces it runs over. Pieces follow each other, each beginning at the vertex
    /// where the one before ends; borders must have been split where the ring crosses them ([`Model::split_edge`]).
    ///
    /// # Errors
    /// [`BuildError::OpenLoop`] if the ring is not closed, or its crossings are not vertices of the borders.
    pub fn imprint(&mut self, ring: &[RingPiece]) -> Result<Imprint, BuildError> {
        let open = BuildError::OpenLoop { index: 0, gap: f64::INFINITY };
        for (i, piece) in ring.iter().enumerate() {
            let next = &ring[(i + 1) % ring.len()];
            if self.end_of(&piece.coedge) != self.start_of(&next.coedge) {
                return Err(open);
            }
        }
        let mut imprint = Imprint::default();
        let Some(first) = ring.first() else { return Err(open) };
        if ring.iter().all(|piece| piece.face == first.face) {
            let hole = Loop { coedges: ring.iter().map(|p| p.coedge.clone()).collect() };
            imprint.inside.push((first.face, hole.clone().reversed()));
            self.faces[first.face.0].loops.push(hole);
            return Ok(imprint);
        }
        let mut faces: Vec<FaceId> = ring.iter().map(|p| p.face).collect();
        faces.sort();
        faces.dedup();
        for face in faces {
            let traced = trace::trace(self, face, ring).ok_or_else(|| open.clone())?;
            imprint.inside.extend(traced.inside.into_iter().map(|l| (face, l)));
            let parts = self.rebuild(face, traced.outside);
            imprint.parts.extend(parts.into_iter().map(|part| (part, face)));
        }
        Ok(imprint)
    }

    /// Gives `face` the largest of the `outer` loops instead of its own and makes faces of the others; inner loops go
    /// where they lie.
    fn rebuild(&mut self, face: FaceId, mut outer: Vec<Loop>) -> Vec<FaceId> {
        outer.sort_by(|a, b| signed_area(b).total_cmp(&signed_area(a)));
        let mut outer = outer.into_iter();
        let Some(largest) = outer.next() else { return Vec::new() };
        self.faces[face.0].loops[0] = largest;
        let mut added = Vec::new();
        for border in outer {
            let old = self.face(face);
            let (name, surface, style) = (self.free_name(&old.name), old.surface.clone(), old.style.clone());
            let mut part = Face { name, surface, loops: vec![border], style };
            let domain = FaceDomain::new(&part);
            let inside = |hole: &Loop| domain.contains(hole.coedges[0].parameter_at(0.0));
            let (moved, kept): (Vec<Loop>, Vec<Loop>) =
                self.faces[face.0].loops.drain(1..).partition(|hole| inside(hole));
            drop(domain);
            self.faces[face.0].loops.extend(kept);
            part.loops.extend(moved);
            added.push(self.add_face(part));
        }
        added
    }

    /// `name` with the first number from 2 on that no face has yet.
    fn free_name(&self, name: &str) -> String {
        let taken = |candidate: &str| self.faces.iter().any(|f| f.name == candidate);
        let mut number = 2;
        loop {
            let candidate = format!("{name}/{number}");
            if !taken(&candidate) {
                return candidate;
            }
            number += 1;
        }
    }
}
