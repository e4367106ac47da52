//! Sections of the smooth blocks of a surface, joined over its kinks.

use super::{CERTIFIED, PlaneBranch, PlaneSection};
use glam::DVec2;

/// Ends this close in parameters and space are one point of a kink.
const SAME: f64 = 1e-7;

/// The section without branches that run along the upper borders of a block: they belong to the next block, unless the
/// border is the surface's (`end`, in u and v).
pub(super) fn without_border(mut section: PlaneSection, upper: DVec2, end: (bool, bool)) -> PlaneSection {
    let along =
        |b: &PlaneBranch, axis: usize| b.parameters.iter().all(|p| (p[axis] - upper[axis]).abs() <= SAME);
    section.branches.retain(|b| (end.0 || !along(b, 0)) && (end.1 || !along(b, 1)));
    section
}

/// All branches of all blocks, those that meet at a kink made one.
pub(super) fn joined(parts: Vec<PlaneSection>) -> PlaneSection {
    let mut section = PlaneSection::default();
    let mut open: Vec<PlaneBranch> = vec![];
    for part in parts {
        section.contacts.extend(part.contacts);
        for b in part.branches {
            if b.closed { section.branches.push(b) } else { open.push(b) }
        }
    }
    while let Some(mut branch) = open.pop() {
        // Lengthen it at its end, then at its start, until nothing meets it.
        for _ in 0..2 {
            while let Some(k) = open.iter().position(|b| meets(&branch, b).is_some()) {
                let mut next = open.swap_remove(k);
                if meets(&branch, &next) == Some(false) {
                    reverse(&mut next);
                }
                branch.points.extend(next.points.drain(1..));
                branch.parameters.extend(next.parameters.drain(1..));
            }
            reverse(&mut branch);
        }
        let last = branch.points.len() - 1;
        if last > 2 && branch.points[0].distance(branch.points[last]) <= CERTIFIED {
            branch.closed = true;
            branch.points[last] = branch.points[0];
        }
        section.branches.push(branch);
    }
    section
}

/// Whether a branch goes on from the end of another: at its start (true) or, reversed, at its end (false).
fn meets(before: &PlaneBranch, after: &PlaneBranch) -> Option<bool> {
    let last = before.points.len() - 1;
    let same = |k: usize| {
        before.points[last].distance(after.points[k]) <= SAME
            && before.parameters[last].distance(after.parameters[k]) <= SAME
    };
    if same(0) { Some(true) } else { same(after.points.len() - 1).then_some(false) }
}

fn reverse(branch: &mut PlaneBranch) {
    branch.points.reverse();
    branch.parameters.reverse();
}
