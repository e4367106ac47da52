//! Tracing the loops of a face that a ring runs over.

use super::RingPiece;
use crate::model::{Coedge, FaceId, Loop, Model, VertexId};
use std::collections::HashMap;

/// The loops of a face after a ring was drawn over its borders.
#[derive(Debug, Default)]
pub(super) struct Traced {
    /// Outer loops of what is left.
    pub(super) outside: Vec<Loop>,
    /// Outer loops of what the ring encloses.
    pub(super) inside: Vec<Loop>,
}

/// A run of the ring's pieces through one face, from border to border.
struct Chain {
    coedges: Vec<Coedge>,
    start: VertexId,
    end: VertexId,
}

/// Traces `face` anew; none where the ring's crossings are not vertices of the face's borders.
pub(super) fn trace(model: &Model, face: FaceId, ring: &[RingPiece]) -> Option<Traced> {
    let chains = chains(model, face, ring);
    // Inner loops are bores of their own: a ring that meets one finds no vertex there and is refused.
    let border = &model.face(face).loops.first()?.coedges;
    let leaving = border.iter().enumerate().map(|(i, coedge)| (model.start_of(coedge), i)).collect();
    let border = Border { model, coedges: border, leaving };
    let forward: HashMap<VertexId, usize> = chains.iter().enumerate().map(|(i, c)| (c.start, i)).collect();
    let backward: HashMap<VertexId, usize> = chains.iter().enumerate().map(|(i, c)| (c.end, i)).collect();
    let outside = border.follow(&chains, &forward, |c| (c.coedges.clone(), c.end))?;
    let inside = border.follow(&chains, &backward, |c| {
        let reversed = Loop { coedges: c.coedges.clone() }.reversed();
        (reversed.coedges, c.start)
    })?;
    Some(Traced { outside, inside })
}

/// The outer border of a face, to be followed from vertex to vertex.
struct Border<'m> {
    model: &'m Model,
    coedges: &'m [Coedge],
    /// Index of the coedge that leaves a vertex.
    leaving: HashMap<VertexId, usize>,
}

impl Border<'_> {
    /// Closed loops made of chains and of the borders between them: a chain is entered at the vertex that `entry` has it
    /// at, and `run` gives its coedges in the order they are run through and the vertex where they end.
    fn follow(
        &self,
        chains: &[Chain],
        entry: &HashMap<VertexId, usize>,
        run: impl Fn(&Chain) -> (Vec<Coedge>, VertexId),
    ) -> Option<Vec<Loop>> {
        let mut done = vec![false; chains.len()];
        let mut out = Vec::new();
        while let Some(first) = done.iter().position(|d| !d) {
            let mut coedges = Vec::new();
            let mut chain = first;
            loop {
                done[chain] = true;
                let (run, mut vertex) = run(&chains[chain]);
                coedges.extend(run);
                chain = loop {
                    if let Some(&next) = entry.get(&vertex) {
                        break next;
                    }
                    let coedge = &self.coedges[*self.leaving.get(&vertex)?];
                    coedges.push(coedge.clone());
                    vertex = self.model.end_of(coedge);
                    if coedges.len() > self.leaving.len() + 1000 {
                        return None;
                    }
                };
                if chain == first {
                    break;
                }
                if done[chain] {
                    return None;
                }
            }
            out.push(Loop { coedges });
        }
        Some(out)
    }
}

/// The runs of the ring through `face`.
fn chains(model: &Model, face: FaceId, ring: &[RingPiece]) -> Vec<Chain> {
    let n = ring.len();
    let mut out: Vec<Chain> = Vec::new();
    for i in 0..n {
        // A run begins where the piece before is in another face.
        if ring[i].face != face || ring[(i + n - 1) % n].face == face {
            continue;
        }
        let run = (0..n).map(|k| &ring[(i + k) % n]).take_while(|p| p.face == face);
        let coedges: Vec<Coedge> = run.map(|p| p.coedge.clone()).collect();
        let (start, end) = (model.start_of(&coedges[0]), model.end_of(&coedges[coedges.len() - 1]));
        out.push(Chain { coedges, start, end });
    }
    out
}
