//! Faces of any shape: constrained Delaunay triangulation in a nearly isometric map of the parameters.

use super::TessellationOptions;
use super::field::Field;
use super::patch::{Fault, Limits, Patch};
use coolinggen_brep::SurfaceGeometry;
use glam::DVec2;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, PositionInTriangulation, Triangulation};
use std::collections::HashSet;

/// Rounds of refinement; three or four are the rule.
const ROUNDS: usize = 20;
/// Rounds after which a triangle that still stands askew is the border's fault, not the grid's.
const PATIENCE: usize = 2;
/// Rounds in which tilted triangles are divided; those that are turned over always are.
const TILTED: usize = 6;
/// Density of the first grid, as a share of what curvature at its worst asks for.
const START: f64 = 0.5;
/// Refinement bounds the turn of the normal over a triangle's side at this many times the angle asked for, which is
/// what the diagonal of a grid cell may have.
const DIAGONAL: f64 = 1.5;
/// Grid nodes keep this many steps away from the border.
const MARGIN: f64 = 0.4;

/// A node of the triangulation.
#[derive(Clone, Copy, Debug)]
struct Vertex {
    position: Point2<f64>,
    node: u32,
}

impl HasPosition for Vertex {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        self.position
    }
}

type Cdt = ConstrainedDelaunayTriangulation<Vertex>;

/// Why a border cannot be triangulated.
pub(crate) enum Unfit {
    /// Segments, by their first nodes, that cross others or beside which triangles stand askew: finer ones may not.
    Coarse(Vec<u32>),
    /// Two nodes lie in one place.
    Touching,
    /// It was told to stop.
    Stopped,
}

/// Fills the patch and says whether its triangles then keep the tolerances.
///
/// # Errors
/// [`Unfit`] for a border that crosses or touches itself, or beside which the cosine between a triangle's normal and the
/// surface's stays at `least` or below.
pub(crate) fn fill(
    patch: &mut Patch,
    surface: &SurfaceGeometry,
    field: &Field,
    o: &TessellationOptions,
    least: Option<f64>,
    stop: &dyn Fn() -> bool,
) -> Result<bool, Unfit> {
    patch.clear();
    // A coarse grid, refined where it must be, ends with fewer triangles than one that is fine enough everywhere.
    let density = if o.max_edge_mm.is_some() { 1.0 } else { START };
    for uv in grid(patch, field, density) {
        patch.push(surface, uv);
    }
    let map = Map::new(patch, field);
    let mut cdt = triangulate(patch, &map)?;
    let mut verified: HashSet<[u32; 3]> = HashSet::new();
    let limits = Limits {
        turn: (DIAGONAL * o.angle()).cos(),
        tilt: o.angle().cos(),
        shortest: 0.1 * o.chord_mm,
        tiny: o.chord_mm,
        close: 0.6 * o.chord_mm,
    };
    for round in 0..ROUNDS {
        if stop() {
            return Err(Unfit::Stopped);
        }
        patch.triangles = inside(&cdt);
        patch.exchange_diagonals(limits.tilt);
        let mut faults: Vec<Fault> = Vec::new();
        patch.inspect(
            surface,
            limits,
            |t| verified.insert(sorted(t)),
            |f| {
                if f.distance > o.sampled_chord() {
                    faults.push(f);
                }
            },
        );
        // A fault that this round leaves alone must be found again in the next.
        for f in &faults {
            verified.remove(&sorted(patch.triangles[f.triangle]));
        }
        if !matches!(surface, SurfaceGeometry::Plane(_)) {
            let askew: Vec<usize> =
                (0..patch.triangles.len()).filter(|&i| patch.is_askew(patch.triangles[i], limits)).collect();
            if let Some(least) = least.filter(|_| round >= PATIENCE) {
                let near = |&i: &usize| !(patch.uprightness(patch.triangles[i]) > least);
                let bad: Vec<usize> = askew.iter().copied().filter(near).collect();
                let segments = patch.long_segments(&bad, round >= 2 * PATIENCE, o.chord_mm);
                if !segments.is_empty() {
                    return Err(Unfit::Coarse(segments));
                }
            }
            // At a pole no number of nodes brings triangles to a normal that the surface does not have.
            let hopeless = |&i: &usize| round >= TILTED && patch.uprightness(patch.triangles[i]) > 0.0;
            if faults.is_empty() && !askew.is_empty() && askew.iter().all(hopeless) {
                break;
            }
            let worth = askew.into_iter().filter(|i| !hopeless(i));
            faults.extend(worth.map(|triangle| patch.middle(triangle)));
        }
        if faults.is_empty() {
            return Ok(true);
        }
        if !refine(&mut cdt, patch, surface, &map, faults) {
            break;
        }
    }
    patch.triangles = inside(&cdt);
    patch.exchange_diagonals(limits.tilt);
    Ok(false)
}

fn sorted(mut t: [u32; 3]) -> [u32; 3] {
    t.sort_unstable();
    t
}

/// The map from parameters to the plane of the triangulation.
struct Map {
    low: DVec2,
    scale: DVec2,
}

impl Map {
    fn new(patch: &Patch, field: &Field) -> Self {
        let low = patch.uv.iter().fold(DVec2::INFINITY, |m, p| m.min(*p));
        Self { low, scale: field.scale }
    }

    fn vertex(&self, uv: DVec2, node: u32) -> Vertex {
        let p = (uv - self.low) * self.scale;
        Vertex { position: Point2::new(clean(p.x), clean(p.y)), node }
    }
}

/// The triangulation refuses numbers too small to multiply.
fn clean(x: f64) -> f64 {
    if x.abs() < 1e-60 { 0.0 } else { x }
}

/// Nodes of the field's grid inside the border and not too close to it.
fn grid(patch: &Patch, field: &Field, density: f64) -> Vec<DVec2> {
    let (us, vs) = (field.u.divide(density * field.more.x), field.v.divide(density * field.more.y));
    let (us, vs) = (&us[1..us.len() - 1], &vs[1..vs.len() - 1]);
    if us.is_empty() || vs.is_empty() {
        return Vec::new();
    }
    // Where the border crosses each grid line, in steps along the line.
    let mut columns = vec![Vec::new(); us.len()];
    let mut rows = vec![Vec::new(); vs.len()];
    for (a, &b) in patch.next.iter().enumerate() {
        let (p, q) = (patch.uv[a], patch.uv[b as usize]);
        let crossings = |lines: &[f64], k: usize, out: &mut Vec<Vec<f64>>, steps: &dyn Fn(f64) -> f64| {
            let (low, high) = (p[k].min(q[k]), p[k].max(q[k]));
            let first = lines.partition_point(|&t| t < low);
            for (i, &t) in lines.iter().enumerate().skip(first).take_while(|&(_, &t)| t < high) {
                let f = (t - p[k]) / (q[k] - p[k]);
                out[i].push(steps(p[1 - k] + f * (q[1 - k] - p[1 - k])));
            }
        };
        crossings(us, 0, &mut columns, &|v| field.v.steps_to(v));
        crossings(vs, 1, &mut rows, &|u| field.u.steps_to(u));
    }
    for line in columns.iter_mut().chain(&mut rows) {
        line.sort_unstable_by(f64::total_cmp);
    }
    // Steps are measured in those actually made.
    let made = |total: f64, count: usize| total / (count + 1) as f64;
    let (made_u, made_v) = (made(field.u.total(), us.len()), made(field.v.total(), vs.len()));
    let clear = |line: &[f64], at: f64, step: f64| {
        let i = line.partition_point(|&c| c < at);
        let near = |c: Option<&f64>| c.is_some_and(|c| (c - at).abs() < MARGIN * step);
        i % 2 == 1 && !near(line.get(i)) && !near(i.checked_sub(1).and_then(|i| line.get(i)))
    };
    let mut out = Vec::new();
    for (j, &v) in vs.iter().enumerate() {
        for (i, &u) in us.iter().enumerate() {
            if clear(&columns[i], field.v.steps_to(v), made_v) && clear(&rows[j], field.u.steps_to(u), made_u)
            {
                out.push(DVec2::new(u, v));
            }
        }
    }
    out
}

fn triangulate(patch: &Patch, map: &Map) -> Result<Cdt, Unfit> {
    let vertices: Vec<Vertex> = patch.uv.iter().enumerate().map(|(i, &p)| map.vertex(p, i as u32)).collect();
    let segments = patch.next.iter().enumerate().map(|(a, &b)| [a, b as usize]).collect();
    let count = vertices.len();
    let mut refused: Vec<[usize; 2]> = Vec::new();
    let cdt = Cdt::try_bulk_load_cdt(vertices, segments, |edge| refused.push(edge));
    let cdt = cdt.map_err(|_| Unfit::Touching)?;
    if cdt.num_vertices() != count {
        return Err(Unfit::Touching);
    }
    if refused.is_empty() {
        return Ok(cdt);
    }
    let mut crossing: Vec<u32> = Vec::new();
    let first = |a: u32, b: u32| if patch.next.get(a as usize) == Some(&b) { a } else { b };
    for [a, b] in refused {
        crossing.push(first(a as u32, b as u32));
        let ends = [a, b].map(FixedVertexHandle::from_index);
        for edge in cdt.get_conflicting_edges_between_vertices(ends[0], ends[1]) {
            let [p, q] = edge.vertices().map(|v| v.data().node);
            crossing.push(first(p, q));
        }
    }
    crossing.sort_unstable();
    crossing.dedup();
    Err(Unfit::Coarse(crossing))
}

/// Triangles inside the border: an odd number of border crossings away from the outside.
fn inside(cdt: &Cdt) -> Vec<[u32; 3]> {
    let mut depth = vec![u8::MAX; cdt.num_all_faces()];
    let outer = cdt.outer_face().fix();
    depth[outer.index()] = 0;
    let mut open = Vec::new();
    for edge in cdt.convex_hull() {
        // The hull's directed edges have the outer face to their left.
        if let Some(face) = edge.rev().face().as_inner() {
            let index = face.fix().index();
            if depth[index] == u8::MAX {
                depth[index] = u8::from(edge.is_constraint_edge());
                open.push(face);
            }
        }
    }
    while let Some(face) = open.pop() {
        let here = depth[face.fix().index()];
        for edge in face.adjacent_edges() {
            if let Some(other) = edge.rev().face().as_inner() {
                let index = other.fix().index();
                if depth[index] == u8::MAX {
                    depth[index] = here ^ u8::from(edge.is_constraint_edge());
                    open.push(other);
                }
            }
        }
    }
    let within = cdt.inner_faces().filter(|f| depth[f.fix().index()] == 1);
    within.map(|f| f.vertices().map(|v| v.data().node)).collect()
}

/// Inserts the places of the greatest faults, at most one a triangle. Says whether it inserted any.
fn refine(
    cdt: &mut Cdt,
    patch: &mut Patch,
    surface: &SurfaceGeometry,
    map: &Map,
    mut faults: Vec<Fault>,
) -> bool {
    faults.sort_by(|a, b| b.distance.total_cmp(&a.distance).then(a.triangle.cmp(&b.triangle)));
    let mut used = vec![false; patch.triangles.len()];
    let mut used_sides: HashSet<[u32; 2]> = HashSet::new();
    let mut inserted = false;
    for fault in faults {
        let t = patch.triangles[fault.triangle];
        let sides = [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(|[a, b]| [a.min(b), a.max(b)]);
        if used[fault.triangle] || sides.iter().any(|s| used_sides.contains(s)) {
            continue;
        }
        used[fault.triangle] = true;
        used_sides.extend(sides);
        let vertex = map.vertex(fault.uv, patch.uv.len() as u32);
        // An insertion at a vertex would replace it.
        let taken = matches!(cdt.locate(vertex.position), PositionInTriangulation::OnVertex(_));
        if taken || cdt.insert(vertex).is_err() {
            continue;
        }
        patch.push(surface, fault.uv);
        inserted = true;
    }
    inserted
}
