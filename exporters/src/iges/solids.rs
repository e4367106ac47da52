//! Solids as manifold solid B-rep objects (186): shells (514) of faces (510) with loops (508) of edges, which stand in one
//! edge list (504), their ends in one vertex list (502).

use super::Faces;
use super::entities::{curve, pcurve};
use super::lines::{Directory, File, Pointer, Status};
use super::patch::{Patch, Place, Side};
use crate::ExportError;
use coolinggen_brep::{FaceId, Model, Solid};
use coolinggen_nurbs::Curve;
use glam::DVec2;

/// Writes these solids. Shells have their faces' normals out of the material, those of voids, too.
pub(super) fn write(file: &mut File, faces: &mut Faces<'_>, solids: &[&Solid]) -> Result<(), ExportError> {
    let model = faces.model;
    let used = faces.of(solids);
    let lists = Lists::new(file, model, &used);
    let mut made = vec![None; model.faces.len()];
    for id in used {
        made[id.0] = Some(face(file, faces, &lists, id)?);
    }
    for (number, solid) in solids.iter().enumerate() {
        let shells: Vec<Pointer> = solid
            .shells
            .iter()
            .map(|shell| {
                file.add(&Directory::new(514, 1, Status::Dependent), |r| {
                    r.integer(shell.faces.len());
                    for used in &shell.faces {
                        if let Some((face, swapped)) = made[used.face.0] {
                            r.pointer(face);
                            r.flag(used.forward != swapped);
                        }
                    }
                })
            })
            .collect();
        let label = label(&solid.name);
        let entry = Directory::new(186, 0, Status::Independent);
        file.add(&Directory { label: &label, subscript: number + 1, ..entry }, |r| {
            r.pointer(shells[0]);
            r.flag(true);
            r.integer(shells.len() - 1);
            for &shell in &shells[1..] {
                r.pointer(shell);
                r.flag(true);
            }
        });
    }
    Ok(())
}

/// The first letters of a solid's name: labels hold 8.
fn label(name: &str) -> String {
    let letters = name.chars().filter(char::is_ascii_alphanumeric).take(8);
    letters.map(|c| c.to_ascii_uppercase()).collect()
}

/// The file's lists of vertices and edges, and where in them those of the model are, from 1.
struct Lists {
    vertices: Pointer,
    edges: Pointer,
    vertex: Vec<usize>,
    edge: Vec<usize>,
}

impl Lists {
    /// Lists what these faces use, in the order in which they meet it.
    fn new(file: &mut File, model: &Model, faces: &[FaceId]) -> Self {
        let (mut vertex, mut edge) = (vec![0; model.vertices.len()], vec![0; model.edges.len()]);
        let (mut points, mut edges) = (Vec::new(), Vec::new());
        let loops = faces.iter().flat_map(|&f| &model.face(f).loops);
        for coedge in loops.flat_map(|l| &l.coedges) {
            if edge[coedge.edge.0] > 0 {
                continue;
            }
            let met = model.edge(coedge.edge);
            edges.push(met);
            edge[coedge.edge.0] = edges.len();
            for end in [met.start, met.end] {
                if vertex[end.0] == 0 {
                    points.push(model.vertex(end));
                    vertex[end.0] = points.len();
                }
            }
        }
        let vertices = file.add(&Directory::new(502, 1, Status::List), |r| {
            r.integer(points.len());
            points.iter().for_each(|&p| r.point(p));
        });
        let curves: Vec<Pointer> = edges.iter().map(|e| curve(file, &e.curve, true)).collect();
        let edges = file.add(&Directory::new(504, 1, Status::List), |r| {
            r.integer(edges.len());
            for (met, &curve) in edges.iter().zip(&curves) {
                r.pointer(curve);
                for end in [met.start, met.end] {
                    r.pointer(vertices);
                    r.integer(vertex[end.0]);
                }
            }
        });
        Self { vertices, edges, vertex, edge }
    }
}

/// A face, and whether its normal is against the model's.
fn face(
    file: &mut File,
    faces: &mut Faces<'_>,
    lists: &Lists,
    id: FaceId,
) -> Result<(Pointer, bool), ExportError> {
    let (model, face) = (faces.model, faces.model.face(id));
    let patch = Patch::new(face)?;
    let surface = faces.surface(file, id, &patch);
    let loops = patch.loops(model, face);
    let loops: Vec<Pointer> = loops.iter().map(|sides| bound(file, lists, sides)).collect();
    let entry = faces.directory(file, id, Directory::new(510, 1, Status::Dependent));
    let made = file.add(&entry, |r| {
        r.pointer(surface);
        r.integer(loops.len());
        // The first loop is the outer one.
        r.flag(true);
        loops.iter().for_each(|&l| r.pointer(l));
    });
    Ok((made, patch.swapped))
}

/// A loop: edges with their senses, and vertices for poles, each with its curve in parameters as the loop runs.
fn bound(file: &mut File, lists: &Lists, sides: &[Side]) -> Pointer {
    let flat: Vec<Pointer> = sides.iter().map(|side| pcurve(file, &side.curve)).collect();
    file.add(&Directory::new(508, 1, Status::Dependent), |r| {
        r.integer(sides.len());
        for (side, &flat) in sides.iter().zip(&flat) {
            let (is_vertex, list, index, along) = match side.on {
                Place::Edge { id, along } => (false, lists.edges, lists.edge[id.0], along),
                Place::Pole(vertex) => (true, lists.vertices, lists.vertex[vertex.0], true),
            };
            r.flag(is_vertex);
            r.pointer(list);
            r.integer(index);
            r.flag(along);
            // One curve in parameters.
            r.integer(1);
            r.flag(is_isoparametric(&side.curve));
            r.pointer(flat);
        }
    })
}

/// Whether one of the parameters stays the same.
fn is_isoparametric(curve: &Curve<DVec2>) -> bool {
    let first = curve.points()[0];
    let all = |same: fn(DVec2, DVec2) -> bool| curve.points().iter().all(|&p| same(p, first));
    all(|p, q| p.x == q.x) || all(|p, q| p.y == q.y)
}
