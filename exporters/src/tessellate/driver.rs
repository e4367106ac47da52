//! From a model to its tessellation: fields, edges, faces, points in one list.

use super::boundary::{self, Node};
use super::edges;
use super::field::Field;
use super::kept::{KeptFill, KeptMeshes, NumberedField, Prepared, edge_key, face_key};
use super::patch::Patch;
use super::{FaceMesh, Tessellation, TessellationOptions, delaunay, rectangle};
use crate::ExportError;
use coolinggen_brep::{Coedge, Edge, Face, FaceId, Key, Memo, Model};
use coolinggen_nurbs::ParametricCurve;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Rounds in which segments of edges are halved where a face's border crosses itself or comes too near to itself; each is
/// a quarter of the sagitta of the last.
const ROUNDS: usize = 12;
/// Rounds in which that is done for tilted triangles, too, not only for those that are turned over.
const TILTED: usize = 4;
/// Cells of a face's grid, or segments of an edge, beyond which tolerances are taken for a mistake.
const MOST_CELLS: f64 = 2e7;

/// Tessellates all faces of `model`.
///
/// # Errors
/// [`ExportError::BadOption`]; [`ExportError::BadTopology`] for a face without a border;
/// [`ExportError::Untriangulable`] for a face whose border crosses or touches itself however finely it is cut;
/// [`ExportError::TooLarge`] when tolerances ask for more than 2e7 cells of a face.
pub fn tessellate(model: &Model, options: &TessellationOptions) -> Result<Tessellation, ExportError> {
    tessellate_again(model, options, &mut KeptMeshes::default(), &|| false)
}

/// As [`tessellate`], reusing what `kept` has from the time before, until `stop` says so.
///
/// # Errors
/// As [`tessellate`]; [`ExportError::Stopped`].
pub fn tessellate_again(
    model: &Model,
    options: &TessellationOptions,
    kept: &mut KeptMeshes,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Tessellation, ExportError> {
    let result = tessellated(model, options, kept, stop);
    kept.end_round(result.is_ok());
    result
}

fn tessellated(
    model: &Model,
    options: &TessellationOptions,
    kept: &mut KeptMeshes,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Tessellation, ExportError> {
    options.check()?;
    let bare = |f: &&Face| f.loops.is_empty() || f.loops.iter().any(|l| l.coedges.is_empty());
    if let Some(face) = model.faces.iter().find(bare) {
        return Err(ExportError::BadTopology { at: face.name.clone(), what: "a face without a border" });
    }
    let mut faces: Vec<Prepared> = Vec::with_capacity(model.faces.len());
    for face in &model.faces {
        if stop() {
            return Err(ExportError::Stopped);
        }
        let Some(prepared) = kept.prepared(face, options, || (!wound(face)).then(|| parameter_box(face)))
        else {
            let what = "the outer loop must run counterclockwise in the parameters, inner ones clockwise";
            return Err(ExportError::BadTopology { at: face.name.clone(), what });
        };
        faces.push(prepared);
    }
    let cells = |f: &Field| f.u.total().max(1.0) * f.v.total().max(1.0);
    if faces.iter().any(|face| !(cells(&face.field.field) < MOST_CELLS)) {
        return Err(ExportError::TooLarge { what: "triangles of a face at these tolerances" });
    }
    let mut uses: Vec<Vec<(&Coedge, &NumberedField)>> = vec![Vec::new(); model.edges.len()];
    for (face, prepared) in model.faces.iter().zip(&faces) {
        for coedge in face.loops.iter().flat_map(|l| &l.coedges) {
            uses[coedge.edge.0].push((coedge, &*prepared.field));
        }
    }
    let mut cut = Cut::new(model, &uses, options, &mut kept.cuts);
    let mut done: Vec<Option<Arc<KeptFill>>> = vec![None; model.faces.len()];
    for round in 0.. {
        if stop() {
            return Err(ExportError::Stopped);
        }
        // A pole that no refinement straightens up must not cost all rounds.
        let least = match round {
            ..TILTED => Some(options.angle().cos()),
            TILTED..ROUNDS => Some(0.0),
            _ => None,
        };
        let open: Vec<usize> = (0..done.len()).filter(|&i| done[i].is_none()).collect();
        let key = |&i: &usize| face_key(&model.faces[i], &faces[i], &cut, options, least);
        let keys: Vec<Key> = open.par_iter().map(key).collect();
        let known: Vec<Option<Arc<KeptFill>>> = keys.iter().map(|key| kept.fills.find(key)).collect();
        let fill = |(&i, known): (&usize, &Option<Arc<KeptFill>>)| match known {
            Some(_) => None,
            None if stop() => Some(Err(Refusal::Stopped)),
            None => Some(fill(&model.faces[i], &faces[i], &cut, options, least, stop)),
        };
        let filled: Vec<Option<Result<KeptFill, Refusal>>> = open.par_iter().zip(&known).map(fill).collect();
        let mut wanted: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        for (((&i, key), known), filled) in open.iter().zip(keys).zip(known).zip(filled) {
            match filled {
                None => done[i] = known,
                Some(Ok(filled)) => {
                    let filled = Arc::new(filled);
                    kept.fills.keep(key, Arc::clone(&filled));
                    done[i] = Some(filled);
                }
                Some(Err(Refusal::Coarse(segments))) if round < ROUNDS => {
                    for (edge, k) in segments {
                        wanted.entry(edge).or_default().insert(k);
                    }
                }
                Some(Err(Refusal::Stopped)) => return Err(ExportError::Stopped),
                Some(Err(_)) => {
                    return Err(ExportError::Untriangulable { face: model.faces[i].name.clone() });
                }
            }
        }
        if wanted.is_empty() {
            break;
        }
        for (&edge, segments) in &wanted {
            cut.halve(model, edge, segments);
        }
        for (face, filled) in model.faces.iter().zip(&mut done) {
            if face.loops.iter().flat_map(|l| &l.coedges).any(|c| wanted.contains_key(&c.edge.0)) {
                *filled = None;
            }
        }
    }
    let done: Vec<Arc<KeptFill>> = done.into_iter().flatten().collect();
    assemble(model, cut, &done)
}

/// Why a face has no triangles yet.
enum Refusal {
    /// These segments are too long, as edges and numbers along them: they cross others, or triangles beside them turn
    /// over.
    Coarse(Vec<(usize, usize)>),
    /// The border meets itself in a node.
    Touching,
    /// It was told to stop.
    Stopped,
}

/// Whether a loop of the face runs the wrong way round.
fn wound(face: &Face) -> bool {
    face.loops.iter().enumerate().any(|(i, bound)| {
        let points = bound.coedges.iter().flat_map(|c| (0..24).map(|k| c.parameter_at(f64::from(k) / 24.0)));
        let points: Vec<DVec2> = points.collect();
        let from = |p: DVec2| p - points[0];
        let next = points.iter().cycle().skip(1);
        let area: f64 = points.iter().zip(next).map(|(&p, &q)| from(p).perp_dot(from(q))).sum();
        (area > 0.0) != (i == 0)
    })
}

/// All edges cut into segments.
pub(super) struct Cut {
    pub(super) points: Vec<DVec3>,
    pub(super) parameters: Vec<Vec<f64>>,
    pub(super) polylines: Vec<Vec<u32>>,
}

impl Cut {
    fn new(
        model: &Model,
        uses: &[Vec<(&Coedge, &NumberedField)>],
        o: &TessellationOptions,
        kept: &mut Memo<Arc<(Vec<f64>, Vec<DVec3>)>>,
    ) -> Self {
        let key = |(i, edge): (usize, &Edge)| edge_key(edge, &uses[i], o);
        let keys: Vec<Key> = model.edges.par_iter().enumerate().map(key).collect();
        let known: Vec<_> = keys.iter().map(|key| kept.find(key)).collect();
        let divide = |((i, edge), known): ((usize, &Edge), &Option<_>)| {
            known.clone().unwrap_or_else(|| {
                let fields: Vec<(&Coedge, &Field)> = uses[i].iter().map(|(c, f)| (*c, &f.field)).collect();
                let t = edges::divide(edge, &fields, o);
                let inner: Vec<DVec3> = t[1..t.len() - 1].iter().map(|&t| edge.curve.point(t)).collect();
                Arc::new((t, inner))
            })
        };
        let divided: Vec<_> = model.edges.par_iter().enumerate().zip(&known).map(divide).collect();
        for ((key, known), divided) in keys.into_iter().zip(known).zip(&divided) {
            if known.is_none() {
                kept.keep(key, Arc::clone(divided));
            }
        }
        let mut out = Self { points: model.vertices.clone(), parameters: Vec::new(), polylines: Vec::new() };
        for (edge, divided) in model.edges.iter().zip(divided) {
            let (t, inner) = (divided.0.clone(), &divided.1);
            let first = out.points.len() as u32;
            let mut polyline = vec![edge.start.0 as u32];
            polyline.extend((0..inner.len() as u32).map(|i| first + i));
            polyline.push(edge.end.0 as u32);
            out.points.extend_from_slice(inner);
            out.parameters.push(t);
            out.polylines.push(polyline);
        }
        out
    }

    /// Cuts these segments of an edge in two, in the middle of their parameters.
    fn halve(&mut self, model: &Model, edge: usize, segments: &BTreeSet<usize>) {
        let (parameters, polyline) = (&mut self.parameters[edge], &mut self.polylines[edge]);
        for &k in segments.iter().rev() {
            let middle = 0.5 * (parameters[k] + parameters[k + 1]);
            parameters.insert(k + 1, middle);
            polyline.insert(k + 1, self.points.len() as u32);
            self.points.push(model.edges[edge].curve.point(middle));
        }
    }
}

fn parameter_box(face: &Face) -> (DVec2, DVec2) {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    // The first loop goes round the others.
    for coedge in face.loops.iter().take(1).flat_map(|l| &l.coedges) {
        edges::widen(&coedge.pcurve, &mut low, &mut high);
    }
    (low, high)
}

/// Triangulates a face; or names the segments of edges that are too long for it: those that cross others, and those beside
/// which the cosine between a triangle's normal and the surface's is no more than `least`. Of two borders that run side by
/// side, nearer to each other than chords are to them, the chords may lie the other way round.
fn fill(
    face: &Face,
    prepared: &Prepared,
    cut: &Cut,
    o: &TessellationOptions,
    least: Option<f64>,
    stop: &dyn Fn() -> bool,
) -> Result<KeptFill, Refusal> {
    let field = &prepared.field.field;
    let bounds = (prepared.low, prepared.high);
    let polygons = boundary::polygons(face, bounds, &cut.parameters, &cut.polylines);
    let mut patch = Patch::new(&face.surface, &polygons, &cut.points);
    let nodes: Vec<Node> = polygons.into_iter().flatten().collect();
    let coarse = |starts: Vec<u32>| {
        let segments = starts.into_iter().map(|n| nodes[n as usize]);
        Refusal::Coarse(segments.filter(|n| n.edge != usize::MAX).map(|n| (n.edge, n.segment)).collect())
    };
    let mut kept = true;
    if !rectangle::fill(&mut patch, &face.surface, field, o) {
        kept = delaunay::fill(&mut patch, &face.surface, field, o, least, stop).map_err(
            |unfit| match unfit {
                delaunay::Unfit::Coarse(starts) => coarse(starts),
                delaunay::Unfit::Touching => Refusal::Touching,
                delaunay::Unfit::Stopped => Refusal::Stopped,
            },
        )?;
    }
    // Too coarse a border encloses nothing, or the wrong side.
    let loose = patch.loose_border();
    if !loose.is_empty() {
        return Err(coarse(loose));
    }
    Ok(KeptFill::new(face, cut, &nodes, patch, kept))
}

fn assemble(model: &Model, cut: Cut, filled: &[Arc<KeptFill>]) -> Result<Tessellation, ExportError> {
    let borders: Vec<Vec<u32>> =
        filled.iter().enumerate().map(|(i, filled)| filled.border(model, i, &cut)).collect();
    let faces = Vec::with_capacity(filled.len());
    let mut out = Tessellation { points: cut.points, edges: cut.polylines, faces, coarse: Vec::new() };
    for (i, (filled, mut points)) in filled.iter().zip(borders).enumerate() {
        let KeptFill { patch, kept, .. } = &**filled;
        if !kept {
            out.coarse.push(FaceId(i));
        }
        let border = patch.next.len();
        let first = out.points.len();
        points.extend((first..first + patch.uv.len() - border).map(|i| i as u32));
        out.points.extend_from_slice(&patch.at[border..]);
        if u32::try_from(out.points.len()).is_err() {
            return Err(ExportError::TooLarge { what: "points" });
        }
        let mut triangles = patch.triangles.clone();
        // Where a side is one point in space its triangles vanish.
        triangles.retain(|t| {
            let [a, b, c] = t.map(|i| points[i as usize]);
            a != b && b != c && c != a
        });
        out.faces.push(FaceMesh {
            points,
            parameters: patch.uv.clone(),
            normals: patch.normals.clone(),
            triangles,
        });
    }
    Ok(out)
}
