//! Whether triangles close, and what they enclose; the command line's tests use it, too.

use glam::DVec3;
use std::collections::BTreeMap;

/// Sides that do not occur exactly once in each direction.
pub fn open_sides(triangles: &[[u32; 3]]) -> usize {
    let mut count: BTreeMap<(u32, u32), i64> = BTreeMap::new();
    for t in triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            *count.entry((a, b)).or_default() += 1;
        }
    }
    count.iter().filter(|&(&(a, b), &n)| n != 1 || count.get(&(b, a)) != Some(&1)).count()
}

pub fn volume(triangles: &[[u32; 3]], points: &[DVec3]) -> f64 {
    let base = points[triangles[0][0] as usize];
    let at = |i: u32| points[i as usize] - base;
    triangles.iter().map(|&[a, b, c]| at(a).dot(at(b).cross(at(c))) / 6.0).sum()
}

/// One index a distinct point, compared bit for bit but for the sign of zero.
pub fn welded(points: &[DVec3]) -> (Vec<u32>, Vec<DVec3>) {
    let mut known: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    let mut out = Vec::new();
    let index = |p: &DVec3| {
        *known.entry((*p + DVec3::ZERO).to_array().map(f64::to_bits)).or_insert_with(|| {
            out.push(*p);
            out.len() as u32 - 1
        })
    };
    (points.iter().map(index).collect(), out)
}
