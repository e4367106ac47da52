//! What tessellating keeps for the next time: of faces and edges that are as they were, bit by bit, the triangles and the
//! segments are, too.

use super::boundary::Node;
use super::field::Field;
use super::patch::Patch;
use super::{TessellationOptions, driver::Cut};
use coolinggen_brep::{Coedge, Edge, Face, Key, Loop, Memo, Model};
use glam::{DVec2, DVec3};
use std::collections::HashMap;
use std::sync::Arc;

/// What tessellating keeps.
#[derive(Clone, Debug, Default)]
pub struct KeptMeshes {
    surfaces: Memo<u64>,
    /// Number of the last new surface or field.
    last: u64,
    /// Boxes in the parameters of faces whose loops run the right way round.
    boxes: Memo<(DVec2, DVec2)>,
    fields: Memo<Arc<NumberedField>>,
    /// Parameters and inner points of edges.
    pub(super) cuts: Memo<Arc<(Vec<f64>, Vec<DVec3>)>>,
    pub(super) fills: Memo<Arc<KeptFill>>,
}

/// A field with a number that no other has.
#[derive(Clone, Debug)]
pub(super) struct NumberedField {
    pub(super) number: u64,
    pub(super) field: Field,
}

/// The triangles of a face, and its border's nodes as places in the polylines of its loops, one after the other.
#[derive(Clone, Debug)]
pub(super) struct KeptFill {
    border: Vec<u32>,
    pub(super) patch: Patch,
    /// Whether the triangles keep the tolerances.
    pub(super) kept: bool,
}

/// What a face is, for its triangles.
#[derive(Clone, Debug)]
pub(super) struct Prepared {
    surface: u64,
    pub(super) low: DVec2,
    pub(super) high: DVec2,
    pub(super) field: Arc<NumberedField>,
}

impl KeptMeshes {
    /// The field of a face, now or before; none where a loop runs the wrong way round.
    pub(super) fn prepared(
        &mut self,
        face: &Face,
        options: &TessellationOptions,
        sound: impl FnOnce() -> Option<(DVec2, DVec2)>,
    ) -> Option<Prepared> {
        let last = &mut self.last;
        let mut next = || {
            *last += 1;
            *last
        };
        let surface = self.surfaces.get(Key::of(&face.surface), || Ok::<_, ()>(next())).ok()?;
        let (low, high) = self.boxes.get(bordered(Key::default(), &face.loops), || sound().ok_or(())).ok()?;
        let key = optioned(Key::of((surface, low, high)), options);
        let make = || {
            let field = Field::new(&face.surface, low, high, options);
            Ok::<_, ()>(Arc::new(NumberedField { number: next(), field }))
        };
        let field = self.fields.get(key, make).ok()?;
        Some(Prepared { surface, low, high, field })
    }

    /// How many edges have been cut so far, and how many faces filled.
    pub fn made(&self) -> [u64; 2] {
        [self.cuts.made(), self.fills.made()]
    }

    /// Ends a tessellation, which came to its end or was broken off.
    pub(super) fn end_round(&mut self, complete: bool) {
        self.surfaces.end_round(complete);
        self.boxes.end_round(complete);
        self.fields.end_round(complete);
        self.cuts.end_round(complete);
        self.fills.end_round(complete);
    }
}

fn optioned(key: Key, o: &TessellationOptions) -> Key {
    key.and((o.chord_mm, o.angle_deg, o.max_edge_mm))
}

fn bordered(key: Key, loops: &[Loop]) -> Key {
    loops.iter().fold(key, |key, bound| key.and(&*bound.coedges))
}

/// Everything that an edge's segments depend on.
pub(super) fn edge_key(edge: &Edge, uses: &[(&Coedge, &NumberedField)], o: &TessellationOptions) -> Key {
    let key = optioned(Key::of(&edge.curve), o);
    uses.iter().fold(key, |key, (coedge, field)| key.and((*coedge, field.number)))
}

/// Everything that a face's triangles depend on.
pub(super) fn face_key(
    face: &Face,
    prepared: &Prepared,
    cut: &Cut,
    o: &TessellationOptions,
    least: Option<f64>,
) -> Key {
    let key = optioned(Key::of((prepared.surface, prepared.field.number, least)), o);
    coedges(face).fold(bordered(key, &face.loops), |key, coedge| {
        let key = key.and(&*cut.parameters[coedge.edge.0]);
        cut.polylines[coedge.edge.0].iter().fold(key, |key, &p| key.and(cut.points[p as usize]))
    })
}

fn coedges(face: &Face) -> impl Iterator<Item = &Coedge> {
    face.loops.iter().flat_map(|bound| &bound.coedges)
}

impl KeptFill {
    pub(super) fn new(face: &Face, cut: &Cut, nodes: &[Node], patch: Patch, kept: bool) -> Self {
        let mut places: HashMap<u32, u32> = HashMap::new();
        let points = coedges(face).flat_map(|coedge| &cut.polylines[coedge.edge.0]);
        for (place, &point) in points.enumerate() {
            places.entry(point).or_insert(place as u32);
        }
        let border = nodes.iter().map(|node| places.get(&node.point).copied().unwrap_or_default()).collect();
        Self { border, patch, kept }
    }

    /// The points of the border's nodes.
    pub(super) fn border(&self, model: &Model, face: usize, cut: &Cut) -> Vec<u32> {
        let points = coedges(&model.faces[face]).flat_map(|coedge| &cut.polylines[coedge.edge.0]);
        let points: Vec<u32> = points.copied().collect();
        self.border.iter().map(|&place| points[place as usize]).collect()
    }
}
