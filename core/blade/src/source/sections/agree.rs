//! What all sections of a blade must agree on: which way they run, and what their edges are.

use super::pointer;
use super::read::Read;
use crate::fault::Fault;
use crate::section::{Nose, Ring};
use glam::DVec2;

/// Less camber than this says nothing about the sides.
const NO_CAMBER: f64 = 1e-6;

/// From the leading to the trailing edge.
pub(super) fn chord(ring: &Ring, noses: &[Nose; 2]) -> DVec2 {
    let [l, t] = [&noses[0], &noses[1]].map(|nose| match nose {
        Nose::Arc { circle, .. } => circle.center,
        _ => ring.points[center_index(ring, nose)],
    });
    t - l
}

/// Gives all sections the same sense from leading to trailing edge: that of the section least steep against the flow,
/// or of the first that says where its edges are.
pub(super) fn flow(read: &mut [Read]) {
    let sureness = |r: &Read| {
        let d = chord(&r.ring, &r.noses);
        if r.given_edges { 2.0 } else { d.x.abs() / d.length() }
    };
    let surest = read.iter().enumerate().fold((0, -1.0), |best: (usize, f64), (k, r)| {
        let s = sureness(r);
        if s > best.1 { (k, s) } else { best }
    });
    let Some(reference) = read.get(surest.0).map(|r| chord(&r.ring, &r.noses)) else { return };
    for r in read.iter_mut().filter(|r| !r.given_edges) {
        if chord(&r.ring, &r.noses).dot(reference) < 0.0 {
            r.noses.reverse();
        }
    }
}

/// How much longer the side that follows the leading edge is than the other, over the perimeter: the suction side is
/// the longer one. 1 or -1 where it is known which side is which.
fn camber(r: &Read) -> f64 {
    let (l, t) = (center_index(&r.ring, &r.noses[0]), center_index(&r.ring, &r.noses[1]));
    let n = r.ring.len();
    let Some(count) = r.suction else {
        return (r.ring.length(l, t) - r.ring.length(t, l)) / r.ring.perimeter();
    };
    // Most points between the edges are of one side.
    let between = (t + n - l) % n;
    let of_suction = (0..=between).filter(|k| r.ring.origins[(l + k) % n] < count).count();
    if 2 * of_suction > between { 1.0 } else { -1.0 }
}

/// Turns all sections so that the suction side follows the leading edge: the way most of them are cambered. Sections
/// without camber follow the others; if none has any, the surface's normal points outwards.
pub(super) fn direction(read: &mut [Read]) -> Result<(), Vec<Fault>> {
    let total: f64 = read.iter().map(camber).sum();
    let turned = total < -NO_CAMBER;
    let wrong = |r: &Read| r.suction.is_some() && (camber(r) < 0.0) != turned;
    if let Some(k) = read.iter().position(wrong) {
        let message = "suction and pressure side lie the other way around than in the other sections";
        return Err(vec![Fault::new(pointer(k).at("suction_side"), "sides", message)]);
    }
    if turned {
        for r in read {
            let n = r.ring.len();
            r.ring.reverse();
            for nose in &mut r.noses {
                *nose = flipped(nose, n);
            }
        }
    }
    Ok(())
}

/// The nose in the reversed ring of `n` points.
fn flipped(nose: &Nose, n: usize) -> Nose {
    let flip = |i: usize| n - 1 - i;
    match nose.clone() {
        Nose::Arc { circle, first, last } => Nose::Arc { circle, first: flip(last), last: flip(first) },
        Nose::Sharp { at } => Nose::Sharp { at: flip(at) },
        Nose::Blunt { first, last } => Nose::Blunt { first: flip(last), last: flip(first) },
        Nose::Smooth { tip } => Nose::Smooth { tip: flip(tip) },
    }
}

/// The position in the middle of a nose.
pub(super) fn center_index(ring: &Ring, nose: &Nose) -> usize {
    let n = ring.len();
    match nose {
        Nose::Arc { first, last, .. } | Nose::Blunt { first, last } => {
            (first + (last + n - first) % n / 2) % n
        }
        Nose::Sharp { at } => *at,
        Nose::Smooth { tip } => *tip,
    }
}

/// An edge that is an arc in some sections and merely smooth in others is taken as smooth in all, so that its ends are
/// found alike and run evenly along the blade.
pub(super) fn edges(read: &mut [Read], end: usize) {
    let is_arc = |r: &Read| matches!(r.noses[end], Nose::Arc { .. });
    let is_smooth = |r: &Read| matches!(r.noses[end], Nose::Smooth { .. });
    let name = ["leading", "trailing"][end];
    let note = if read.iter().any(is_arc) && read.iter().any(is_smooth) {
        for r in read.iter_mut() {
            if matches!(r.noses[end], Nose::Arc { .. }) {
                r.noses[end] = Nose::Smooth { tip: center_index(&r.ring, &r.noses[end]) };
            }
        }
        format!("the {name} edge is circular in some sections only: drawn as a smooth curve in all")
    } else {
        let radii = read.iter().filter_map(|r| match &r.noses[end] {
            Nose::Arc { circle, .. } => Some(circle.radius),
            _ => None,
        });
        let (low, high) = radii.fold((f64::INFINITY, 0.0f64), |(a, b), r| (a.min(r), b.max(r)));
        match &read[0].noses[end] {
            Nose::Arc { .. } => format!("the {name} edge is circular, radius {low:.4} to {high:.4} mm"),
            Nose::Sharp { .. } => format!("the {name} edge is sharp"),
            Nose::Blunt { .. } => format!("the {name} edge is blunt"),
            Nose::Smooth { .. } => format!("the {name} edge is smooth, not circular"),
        }
    };
    read[0].notes.push(note);
}
