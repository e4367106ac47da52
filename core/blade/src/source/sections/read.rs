//! Reading one section: its points in order, its noses, which way it runs.

use super::agree;
use super::points::gather;
use super::{Extreme, SectionSpec, SectionsSource, pointer};
use crate::fault::{Fault, Pointer};
use crate::section::{Nose, Ring, farthest_from, farthest_pair, find_noses};
use crate::stream::StreamSpace;
use glam::DVec2;

/// A section in order, counterclockwise until all sections agree on the order leading edge, suction side, trailing edge,
/// pressure side.
pub(super) struct Read {
    pub(super) ring: Ring,
    /// Leading and trailing edge.
    pub(super) noses: [Nose; 2],
    /// Whether the section says where its edges are.
    pub(super) given_edges: bool,
    /// Number of points of the suction side, which come first, if the section says which they are.
    pub(super) suction: Option<usize>,
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
    agree::flow(&mut read);
    for (k, r) in read.iter().enumerate() {
        if let Err(mut more) = check_corners(&r.ring, &r.noses, &source.sections[k], k) {
            faults.append(&mut more);
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    agree::direction(&mut read)?;
    for end in 0..2 {
        agree::edges(&mut read, end);
    }
    Ok(read)
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
    check_side_lengths(section, k)?;
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
    let given = section.leading_edge.is_some() || section.trailing_edge.is_some();
    // The flow comes from smaller m: the leading edge is the nose there.
    if !given && agree::chord(&ring, &noses).x < 0.0 {
        noses.reverse();
    }
    let suction = section.suction_side.as_ref().map(Vec::len);
    Ok(Read { ring, noses, given_edges: given, suction, notes })
}

/// Refuses sides that are too short to be sides, each by its own name.
fn check_side_lengths(section: &SectionSpec, k: usize) -> Result<(), Vec<Fault>> {
    const LEAST: usize = 3;
    let sides = [("suction_side", &section.suction_side), ("pressure_side", &section.pressure_side)];
    if sides.iter().any(|(_, side)| side.is_none()) {
        // One side alone is refused as that, by the reader.
        return Ok(());
    }
    let faults: Vec<Fault> = sides
        .into_iter()
        .filter_map(|(name, side)| Some((name, side.as_ref()?.len())))
        .filter(|(_, count)| *count < LEAST)
        .map(|(name, count)| {
            let message = format!("a side has at least {LEAST} points, here are {count}");
            Fault::new(pointer(k).at(name), "point_count", message).value(count).min(LEAST as f64)
        })
        .collect();
    if faults.is_empty() { Ok(()) } else { Err(faults) }
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
