//! Edges, loops and shells: what holds without looking at any curve.

use super::Fault;
use crate::domain::signed_area;
use crate::model::{FaceUse, Loop, Model, Solid, VertexId};

const NONE: usize = usize::MAX;

/// A use of an edge, in the direction in which the shell's boundary runs seen from outside.
#[derive(Clone, Copy, Debug)]
struct Dart {
    edge: usize,
    /// Whether it runs along the edge.
    along: bool,
    /// The vertex it starts from.
    from: usize,
    /// Index of the face use in the shell.
    face: usize,
    /// The dart after it in its loop.
    next: usize,
    /// The dart of the face across.
    mate: usize,
}

/// Sum of the genera of the shells, nothing if one of them is no closed surface; reports what is wrong.
pub(super) fn genus(model: &Model, solid: &Solid, faults: &mut Vec<Fault>) -> Option<usize> {
    let mut used = vec![false; model.faces.len()];
    let mut darts_of = vec![[NONE; 2]; model.edges.len()];
    let mut sum = Some(0);
    for (index, shell) in solid.shells.iter().enumerate() {
        for face in &shell.faces {
            if std::mem::replace(&mut used[face.face.0], true) {
                faults.push(Fault::FaceUsedTwice { face: model.face(face.face).name.clone() });
            }
        }
        let before = faults.len();
        let (mut darts, loops) = collect(model, &shell.faces, faults);
        let edges = join(model, &shell.faces, &mut darts, &mut darts_of, faults);
        let parts = count_parts(model, index, &shell.faces, &darts, faults);
        let vertices =
            if faults.len() == before { count_vertices(model, &shell.faces, &darts, faults) } else { None };
        // chi = V - E + F - (L - F) = 2 (parts - genus)
        sum = sum.zip(vertices).and_then(|(sum, vertices)| {
            let positive = vertices + 2 * shell.faces.len();
            let twice = (edges + loops + 2 * parts).checked_sub(positive)?;
            (twice % 2 == 0).then_some(sum + twice / 2)
        });
    }
    sum
}

/// All darts of a shell, and the number of loops.
fn collect(model: &Model, faces: &[FaceUse], faults: &mut Vec<Fault>) -> (Vec<Dart>, usize) {
    let mut darts: Vec<Dart> = Vec::new();
    let mut loops = 0;
    for (index, used) in faces.iter().enumerate() {
        let face = model.face(used.face);
        if face.loops.is_empty() {
            faults.push(Fault::EmptyLoop { face: face.name.clone(), index: 0 });
        }
        for (l, lp) in face.loops.iter().enumerate() {
            loops += 1;
            let (begin, count) = (darts.len(), lp.coedges.len());
            if count == 0 {
                faults.push(Fault::EmptyLoop { face: face.name.clone(), index: l });
            }
            for (i, coedge) in lp.coedges.iter().enumerate() {
                let (from, to) = (model.start_of(coedge), model.end_of(coedge));
                if model.start_of(&lp.coedges[(i + 1) % count]) != to {
                    faults.push(Fault::OpenLoop { face: face.name.clone(), index: l, edge: coedge.edge });
                }
                // Seen from the other side a loop runs backwards.
                let next = if used.forward { (i + 1) % count } else { (i + count - 1) % count };
                darts.push(Dart {
                    edge: coedge.edge.0,
                    along: coedge.forward == used.forward,
                    from: if used.forward { from.0 } else { to.0 },
                    face: index,
                    next: begin + next,
                    mate: NONE,
                });
            }
        }
    }
    (darts, loops)
}

/// Finds the mates; returns the number of edges.
fn join(
    model: &Model,
    faces: &[FaceUse],
    darts: &mut [Dart],
    darts_of: &mut [[usize; 2]],
    faults: &mut Vec<Fault>,
) -> usize {
    let mut edges = 0;
    let mut crowded = Vec::new();
    for (index, dart) in darts.iter().enumerate() {
        match &mut darts_of[dart.edge] {
            [first, _] if *first == NONE => {
                *first = index;
                edges += 1;
            }
            [_, second] if *second == NONE => *second = index,
            _ => crowded.push(dart.edge),
        }
    }
    let name = |dart: &Dart| model.face(faces[dart.face].face).name.clone();
    for index in 0..darts.len() {
        let dart = darts[index];
        // Each edge is looked at once, and left clean for the next shell.
        let [first, second] = std::mem::replace(&mut darts_of[dart.edge], [NONE; 2]);
        if first == NONE {
            continue;
        }
        let edge = crate::model::EdgeId(dart.edge);
        if second == NONE || crowded.contains(&dart.edge) {
            let faces = darts.iter().filter(|d| d.edge == dart.edge).map(name).collect();
            faults.push(Fault::EdgeUses { edge, faces });
            continue;
        }
        (darts[first].mate, darts[second].mate) = (second, first);
        if darts[first].along == darts[second].along {
            faults.push(Fault::EdgeSense { edge, faces: [name(&darts[first]), name(&darts[second])] });
        }
    }
    edges
}

/// Pieces of the shell that edges hold together.
fn count_parts(
    model: &Model,
    shell: usize,
    faces: &[FaceUse],
    darts: &[Dart],
    faults: &mut Vec<Fault>,
) -> usize {
    let mut parent: Vec<usize> = (0..faces.len()).collect();
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    for dart in darts.iter().filter(|d| d.mate != NONE) {
        let (a, b) = (root(&mut parent, dart.face), root(&mut parent, darts[dart.mate].face));
        parent[a.max(b)] = a.min(b);
    }
    let parts: Vec<usize> = (0..faces.len()).filter(|&i| parent[i] == i).collect();
    if parts.len() != 1 {
        let faces = parts.iter().map(|&i| model.face(faces[i].face).name.clone()).collect();
        faults.push(Fault::PartedShell { shell, faces });
    }
    parts.len()
}

/// Number of vertices, if the faces round each of them make one fan.
fn count_vertices(
    model: &Model,
    faces: &[FaceUse],
    darts: &[Dart],
    faults: &mut Vec<Fault>,
) -> Option<usize> {
    let mut fans: Vec<Vec<usize>> = vec![Vec::new(); model.vertices.len()];
    let mut seen = vec![false; darts.len()];
    for start in 0..darts.len() {
        if seen[start] {
            continue;
        }
        fans[darts[start].from].push(darts[start].face);
        let mut dart = start;
        while !std::mem::replace(&mut seen[dart], true) {
            dart = darts[darts[dart].mate].next;
        }
    }
    let mut single = true;
    for (vertex, fan) in fans.iter().enumerate().filter(|(_, fan)| fan.len() > 1) {
        let faces = fan.iter().map(|&f| model.face(faces[f].face).name.clone()).collect();
        faults.push(Fault::PinchedVertex { vertex: VertexId(vertex), faces });
        single = false;
    }
    single.then(|| fans.iter().filter(|fan| !fan.is_empty()).count())
}

/// About the area that a loop encloses: that of its control points, or, where these do not settle the sign, of
/// points on the curves.
pub(super) fn rough_area(lp: &Loop) -> f64 {
    let Some(first) = lp.coedges.first() else { return 0.0 };
    let base = first.parameter_at(0.0);
    let (mut area, mut slack) = (0.0, 0.0);
    for (i, coedge) in lp.coedges.iter().enumerate() {
        let points = coedge.pcurve.points();
        let mut sum = 0.0;
        let mut last = points[1] - points[0];
        for pair in points.windows(2) {
            let step = pair[1] - pair[0];
            sum += 0.5 * (pair[0] - base).perp_dot(step);
            // Between polygon and curve there is a fraction of this.
            slack += step.length() * (step - last).length();
            last = step;
        }
        area += if coedge.forward { sum } else { -sum };
        // The jump to the next coedge: nothing but in a pole.
        let (from, to) = (coedge.parameter_at(1.0), lp.coedges[(i + 1) % lp.coedges.len()].parameter_at(0.0));
        area += 0.5 * (from - base).perp_dot(to - base);
    }
    if area.abs() > slack { area } else { signed_area(lp) }
}
