//! Bores keep clear of each other: metal between neighbours, and pins' passages.

use crate::bore::{Hull, TOUCHING, neighbours};
use coolinggen_blade::Fault;

/// Bores that stand in the same body, as hulls.
#[derive(Clone, Debug, Default)]
pub(super) struct Ligaments {
    hulls: Vec<Hull>,
    /// What messages call them, e.g. `hole 3 of film row "ss1"`.
    names: Vec<String>,
}

impl Ligaments {
    /// Adds the planned bores of one kind: the distance of each to its nearest neighbour, if that is near, and a fault,
    /// made by `fault` from the bore's index and what is wrong, where it is less than `least` mm.
    pub(super) fn add(
        &mut self,
        planned: impl IntoIterator<Item = (Hull, String)>,
        least: f64,
        fault: impl Fn(usize, String) -> Fault,
    ) -> (Vec<Option<f64>>, Vec<Fault>) {
        let first = self.hulls.len();
        for (hull, name) in planned {
            self.hulls.push(hull);
            self.names.push(name);
        }
        let greatest = self.hulls[first..].iter().map(|h| h.radii[1]).fold(0.0, f64::max);
        let found = neighbours(&self.hulls, least.max(10.0 * greatest));
        let mut faults = Vec::new();
        for (i, neighbour) in found.iter().enumerate().skip(first) {
            // Once a pair: where each is the other's nearest, by the later one.
            let told = |index: usize| index > i && found[index].is_some_and(|back| back.index == i);
            let Some(neighbour) = neighbour.filter(|n| n.gap < least.max(TOUCHING) && !told(n.index)) else {
                continue;
            };
            let (gap, other) = (neighbour.gap, &self.names[neighbour.index]);
            let what = if gap < 0.0 {
                format!("meets {other} by {:.3} mm", -gap)
            } else {
                format!("leaves {gap:.3} mm to {other}")
            };
            faults.push(fault(i - first, what).value(gap).min(least).unit("mm"));
        }
        (found[first..].iter().map(|n| n.map(|n| n.gap)).collect(), faults)
    }
}
