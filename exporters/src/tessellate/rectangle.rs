//! Faces that are whole rectangles of their parameters: graded rows, no search.

use super::TessellationOptions;
use super::field::Field;
use super::patch::Patch;
use coolinggen_brep::SurfaceGeometry;
use coolinggen_nurbs::ParametricSurface;
use glam::DVec2;

/// The four sides of a rectangle as border nodes: bottom and top in the direction of u, left and right in that
/// of v; corners belong to two sides.
struct Sides {
    bottom: Vec<u32>,
    right: Vec<u32>,
    top: Vec<u32>,
    left: Vec<u32>,
}

/// Splits a border that runs counterclockwise round a rectangle; `None` for any other.
fn sides(patch: &Patch) -> Option<Sides> {
    let (uv, count) = (&patch.uv, patch.next.len());
    if patch.next.iter().enumerate().any(|(i, &n)| n as usize != (i + 1) % count) {
        return None;
    }
    let low = uv.iter().fold(DVec2::INFINITY, |m, p| m.min(*p));
    let high = uv.iter().fold(DVec2::NEG_INFINITY, |m, p| m.max(*p));
    let start = uv.iter().position(|p| *p == low)?;
    let mut sides: [Vec<u32>; 4] = Default::default();
    let mut side = 0;
    for k in 0..=count {
        let i = (start + k) % count;
        let p = uv[i];
        // Coordinate along the side, the one held, its value, and where the side ends.
        let on = match side {
            0 => p.y == low.y,
            1 => p.x == high.x,
            2 => p.y == high.y,
            _ => p.x == low.x,
        };
        if !on {
            return None;
        }
        if let Some(&before) = sides[side].last() {
            let b = uv[before as usize];
            let ahead = match side {
                0 => p.x > b.x,
                1 => p.y > b.y,
                2 => p.x < b.x,
                _ => p.y < b.y,
            };
            if !ahead {
                return None;
            }
        }
        sides[side].push(i as u32);
        let corner = match side {
            0 => p.x == high.x,
            1 => p.y == high.y,
            2 => p.x == low.x,
            _ => false,
        };
        if corner {
            side += 1;
            sides[side].push(i as u32);
        }
    }
    let [bottom, right, mut top, mut left] = sides;
    top.reverse();
    left.reverse();
    (side == 3).then_some(Sides { bottom, right, top, left })
}

/// Fills the patch if it is a rectangle whose triangles then keep the tolerance; otherwise leaves it without
/// triangles and says `false`.
pub(crate) fn fill(
    patch: &mut Patch,
    surface: &SurfaceGeometry,
    field: &Field,
    o: &TessellationOptions,
) -> bool {
    let Some(sides) = sides(patch) else { return false };
    let tilt = o.angle().cos();
    let mut factor = 1.0;
    for _ in 0..3 {
        let (us, vs) = (field.u.divide(factor), field.v.divide(factor));
        if !rows(patch, surface, &sides, &us[1..us.len() - 1], &vs[1..vs.len() - 1]) {
            break;
        }
        let worst = patch.worst(surface);
        if worst <= o.sampled_chord() && patch.triangles.iter().all(|&t| patch.uprightness(t) > tilt) {
            return true;
        }
        patch.clear();
        factor *= (worst / o.sampled_chord()).sqrt().clamp(1.1, 3.0);
    }
    patch.clear();
    false
}

fn rows(patch: &mut Patch, surface: &SurfaceGeometry, sides: &Sides, us: &[f64], vs: &[f64]) -> bool {
    let Sides { bottom, right, top, left } = sides;
    if vs.is_empty() {
        return strip(patch, [bottom, top], [left, right], 0);
    }
    if us.is_empty() {
        return strip(patch, [left, right], [bottom, top], 1);
    }
    let grid: Vec<Vec<u32>> =
        vs.iter().map(|&v| us.iter().map(|&u| patch.push(surface, DVec2::new(u, v))).collect()).collect();
    for pair in grid.windows(2) {
        for i in 1..us.len() {
            let [a, b, c, d] = [pair[0][i - 1], pair[0][i], pair[1][i], pair[1][i - 1]];
            if first_diagonal(patch, surface, [a, b, c, d]) {
                patch.triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                patch.triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    let column = |i: usize| grid.iter().map(|row| row[i]).collect::<Vec<u32>>();
    zip(patch, &sides.bottom, &grid[0], 0, true);
    zip(patch, &sides.top, &grid[grid.len() - 1], 0, false);
    zip(patch, &sides.left, &column(0), 1, false);
    zip(patch, &sides.right, &column(us.len() - 1), 1, true);
    true
}

/// A rectangle that needs no inner nodes: triangles between two `rails` that run along `axis`. Where an end between
/// them has nodes of its own, the first step of the rails is given to that end. Says no where the rails are too short
/// for that.
fn strip(patch: &mut Patch, rails: [&[u32]; 2], ends: [&[u32]; 2], axis: usize) -> bool {
    let [trim_start, trim_stop] = ends.map(|end| usize::from(end.len() > 2));
    if rails.iter().any(|r| r.len() < 1 + trim_start + trim_stop) {
        return false;
    }
    let cut = rails.map(|r| &r[trim_start..r.len() - trim_stop]);
    // Seen along u the second rail lies to the left, seen along v to the right.
    let left = axis == 0;
    zip(patch, cut[0], cut[1], axis, left);
    if trim_start > 0 {
        zip(patch, ends[0], &rails.map(|r| r[1]), 1 - axis, !left);
    }
    if trim_stop > 0 {
        zip(patch, &rails.map(|r| r[r.len() - 2]), ends[1], 1 - axis, !left);
    }
    true
}

/// Whether the diagonal from `a` to `c` runs closer to the surface than the one from `b` to `d`.
fn first_diagonal(patch: &Patch, surface: &SurfaceGeometry, [a, b, c, d]: [u32; 4]) -> bool {
    let at = |i: u32| patch.at[i as usize];
    let uv = (patch.uv[a as usize] + patch.uv[c as usize]) * 0.5;
    let middle = surface.point(uv.x, uv.y);
    let normal = (at(c) - at(a)).cross(at(d) - at(b));
    let off = |p: u32, q: u32| (middle - (at(p) + at(q)) * 0.5).dot(normal).abs();
    off(a, c) <= off(b, d)
}

/// Triangles between two chains that run the same way along `axis`; `left` says that the second chain lies to the
/// left of the first one.
fn zip(patch: &mut Patch, first: &[u32], second: &[u32], axis: usize, left: bool) {
    let (mut i, mut j) = (0, 0);
    let t = |chain: &[u32], k: usize| patch.uv[chain[k] as usize][axis];
    while i + 1 < first.len() || j + 1 < second.len() {
        let along_first = if i + 1 == first.len() {
            false
        } else if j + 1 == second.len() {
            true
        } else {
            t(first, i) + t(first, i + 1) <= t(second, j) + t(second, j + 1)
        };
        let triangle = if along_first {
            i += 1;
            [first[i - 1], first[i], second[j]]
        } else {
            j += 1;
            [first[i], second[j], second[j - 1]]
        };
        let [a, b, c] = triangle;
        patch.triangles.push(if left { [a, b, c] } else { [a, c, b] });
    }
}
