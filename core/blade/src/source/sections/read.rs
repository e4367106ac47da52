//! Reading one section: its points in order, its noses, which way it runs.

use super::points::gather;
use super::{Extreme, SectionSpec, SectionsSource, pointer};
use crate::fault::{Fault, Pointer};
use crate::section::{Nose, Ring, farthest_from, farthest_pair, find_noses};
use crate::stream::StreamSpace;
use glam::DVec2;

/// A section in order: leading edge, suction side, trailing edge, pressure side.
pub(super) struct Read {
    pub(super) ring: Ring,
    /// Leading and trailing edge.
    pub(super) noses: [Nose; 2],
    pub(super) notes: Vec<String>,
}

/// Reads all sections.
pub(super) fn all(source: &SectionsSource, _space: &StreamSpace) -> Result<Vec<Read>, Vec<Fault>> {
    let mut faults = Vec::new();
    let mut read = Vec::new();
    for (k, section) in source.sections.iter().enumerate() {
        match one(section, k, source.tolerance) {
            Ok(r) => read.push(r),
            Err(mut more) => faults.append(&mut more),
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    for end in 0..2 {
        agree(&mut read, end);
    }
    Ok(read)
}

/// An edge that is an arc in some sections and merely smooth in others is taken as smooth in all, so that its ends are
/// found alike and run evenly along the blade.
fn agree(read: &mut [Read], end: usize) {
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

/// The pointer to point `origin` of a section: suction-side points come before pressure-side points.
pub(super) fn pointer_of(section: &SectionSpec, k: usize, origin: usize) -> Pointer {
    let at = pointer(k);
    if section.points.is_some() {
        return at.at("points").at(origin);
    }
    let suction = section.suction_side.as_ref().map_or(0, Vec::len);
    if origin < suction {
        at.at("suction_side").at(origin)
    } else {
        at.at("pressure_side").at(origin - suction)
    }
}

fn one(section: &SectionSpec, k: usize, tolerance: f64) -> Result<Read, Vec<Fault>> {
    let mut notes = Vec::new();
    let (mut ring, edges) = gather(section, k, &mut notes)?;
    let ccw = ring.area() > 0.0;
    if !ccw {
        ring.reverse();
    }
    let place = |origin: usize| ring.origins.iter().position(|&o| o == origin).unwrap_or(0);
    let known = edges.map(|[l, t]| (place(l), place(t)));
    let (leading_tip, trailing_tip, extent) = ends(&ring, section, k, known)?;
    let mut noses = [
        find_noses(&ring, leading_tip, extent, tolerance),
        find_noses(&ring, trailing_tip, extent, tolerance),
    ];
    if known.is_none() && section.leading_edge.is_none() && section.trailing_edge.is_none() {
        // The flow comes from smaller m: the leading edge is the nose there.
        if middle(&ring, &noses[0]).x > middle(&ring, &noses[1]).x {
            noses.reverse();
        }
    }
    check_corners(&ring, &noses, section, k)?;
    orient(&mut ring, &mut noses, section.suction_side.as_ref().map(Vec::len));
    Ok(Read { ring, noses, notes })
}

/// Swaps the direction of the ring so that the suction side follows the leading edge.
fn orient(ring: &mut Ring, noses: &mut [Nose; 2], suction_count: Option<usize>) {
    let (l, t) = (center_index(ring, &noses[0]), center_index(ring, &noses[1]));
    let n = ring.len();
    let follows = match suction_count {
        // Sides are known: most points between the edges are of the suction side.
        Some(count) => {
            let between = (t + n - l) % n;
            let of_suction = (0..=between).filter(|k| ring.origins[(l + k) % n] < count).count();
            2 * of_suction > between
        }
        // The suction side is the longer one.
        None => ring.length(l, t) >= ring.length(t, l),
    };
    if !follows {
        ring.reverse();
        let flip = |i: usize| n - 1 - i;
        for nose in noses {
            *nose = match nose.clone() {
                Nose::Arc { circle, first, last } => {
                    Nose::Arc { circle, first: flip(last), last: flip(first) }
                }
                Nose::Sharp { at } => Nose::Sharp { at: flip(at) },
                Nose::Blunt { first, last } => Nose::Blunt { first: flip(last), last: flip(first) },
                Nose::Smooth { tip } => Nose::Smooth { tip: flip(tip) },
            };
        }
    }
}

fn center_index(ring: &Ring, nose: &Nose) -> usize {
    let n = ring.len();
    match nose {
        Nose::Arc { first, last, .. } | Nose::Blunt { first, last } => {
            (first + (last + n - first) % n / 2) % n
        }
        Nose::Sharp { at } => *at,
        Nose::Smooth { tip } => *tip,
    }
}

fn middle(ring: &Ring, nose: &Nose) -> DVec2 {
    match nose {
        Nose::Arc { circle, .. } => circle.center,
        _ => ring.points[center_index(ring, nose)],
    }
}

/// Positions of leading and trailing tip in the ring, and the section's greatest extent.
fn ends(
    ring: &Ring,
    section: &SectionSpec,
    k: usize,
    known: Option<(usize, usize)>,
) -> Result<(usize, usize, f64), Vec<Fault>> {
    let (a, b) = farthest_pair(ring);
    let extent = ring.points[a].distance(ring.points[b]);
    if let Some((l, t)) = known {
        return Ok((l, t, extent));
    }
    let mut faults = Vec::new();
    let mut given = |extreme: Option<Extreme>, key: &str| match extreme? {
        Extreme::Index(i) => {
            let found = ring.origins.iter().position(|&o| o == i);
            if found.is_none() {
                let message = format!("there is no point {i}");
                faults.push(Fault::new(pointer(k).at(key), "out_of_range", message).value(i));
            }
            found
        }
        Extreme::Point(p) => {
            let p = DVec2::from_array(p);
            if !p.is_finite() {
                faults
                    .push(Fault::new(pointer(k).at(key), "not_finite", "the point is not finite").unit("mm"));
                return None;
            }
            let near = |i: &usize| ring.points[*i].distance_squared(p);
            (0..ring.len()).min_by(|a, b| near(a).total_cmp(&near(b)))
        }
    };
    let leading = given(section.leading_edge, "leading_edge");
    let trailing = given(section.trailing_edge, "trailing_edge");
    if !faults.is_empty() {
        return Err(faults);
    }
    Ok(match (leading, trailing) {
        (Some(l), Some(t)) if l == t => {
            let message = "leading and trailing edge are the same point";
            return Err(vec![Fault::new(pointer(k).at("trailing_edge"), "ambiguous", message)]);
        }
        (Some(l), Some(t)) => (l, t, extent),
        (Some(l), None) => (l, farthest_from(ring, ring.points[l]), extent),
        (None, Some(t)) => (farthest_from(ring, ring.points[t]), t, extent),
        (None, None) => (a, b, extent),
    })
}

/// Refuses corners that are not at the trailing edge.
fn check_corners(ring: &Ring, noses: &[Nose; 2], section: &SectionSpec, k: usize) -> Result<(), Vec<Fault>> {
    let allowed = |i: usize| match noses[1] {
        Nose::Sharp { at } => at == i,
        Nose::Blunt { first, last } => first == i || last == i,
        _ => false,
    };
    let mut faults = Vec::new();
    for i in 0..ring.len() {
        let turn = ring.turn(i as isize);
        if turn.abs() > crate::section::CORNER && !allowed(i) {
            let message = format!("the outline has a corner of {:.0} degrees here", turn.to_degrees().abs());
            faults.push(
                Fault::new(pointer_of(section, k, ring.origins[i]), "corner", message)
                    .value(turn.to_degrees())
                    .max(crate::section::CORNER.to_degrees())
                    .unit("deg")
                    .hint("only the trailing edge may have corners; give round edges by more points"),
            );
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}
