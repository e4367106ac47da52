//! Where a loop jumps in the parameters of a surface, which it does only in a pole.

use glam::DVec2;

/// Distance in a surface's parameters between the end of one edge and the begin of the next that is a pole's, not a
/// rounding. Parameters are millimetres, radians or fractions.
const JUMP: f64 = 1e-6;

/// The pieces of a loop after which it jumps, the last first so that something can be put in behind each, with the
/// parameters from and to which it does. `ways` has the begin and the end of every piece, as the loop runs.
pub(crate) fn jumps(ways: &[[DVec2; 2]]) -> impl Iterator<Item = (usize, [DVec2; 2])> {
    let gap = |k: usize| [ways[k][1], ways[(k + 1) % ways.len()][0]];
    (0..ways.len()).rev().map(move |k| (k, gap(k))).filter(|(_, [from, to])| from.distance(*to) > JUMP)
}
