//! Reading one section: its points in order, its noses, which way it runs.

use super::{Extreme, SectionSpec, SectionsSource, pointer};
use crate::fault::{Fault, Pointer};
use crate::section::{Nose, Ring, crossings, find_noses, farthest_from, farthest_pair, recover};
use crate::stream::StreamSpace;
use glam::DVec2;

/// Least and most points of a section.
const POINTS: std::ops::RangeInclusive<usize> = 8..=20_000;
/// Most points that are put in order.
const MOST_UNORDERED: usize = 4_000;

/// A section in order: leading edge, suction side, trailing edge, pressure side.
pub(super) struct Read {
    pub(super) ring: Ring,
    pub(super) leading: Nose,
    pub(super) trailing: Nose,
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
    if faults.is_empty() { Ok(read) } else { Err(faults) }
}

/// The pointer to point `origin` of a section: suction-side points come before pressure-side points.
pub(super) fn pointer_of(section: &SectionSpec, k: usize, origin: usize) -> Pointer {
    let at = pointer(k);
    if section.points.is_some() {
        return at.at("points").at(origin);
    }
    let suction = section.suction_side.as_ref().map_or(0, Vec::len);
    if origin < suction { at.at("suction_side").at(origin) } else { at.at("pressure_side").at(origin - suction) }
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
    let [leading, trailing] = noses;
    Ok(Read { ring, leading, trailing, notes })
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
                Nose::Arc { circle, first, last } => Nose::Arc { circle, first: flip(last), last: flip(first) },
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
        Nose::Arc { first, last, .. } | Nose::Blunt { first, last } => (first + (last + n - first) % n / 2) % n,
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
                faults.push(Fault::new(pointer(k).at(key), "not_finite", "the point is not finite").unit("mm"));
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

/// All points in order around the section; with sides also the origins of leading and trailing edge.
fn gather(
    section: &SectionSpec,
    k: usize,
    notes: &mut Vec<String>,
) -> Result<(Ring, Option<[usize; 2]>), Vec<Fault>> {
    let at = pointer(k);
    let (raw, suction): (Vec<[f64; 2]>, usize) =
        match (&section.points, &section.suction_side, &section.pressure_side) {
            (Some(points), None, None) => (points.clone(), 0),
            (None, Some(suction), Some(pressure)) => {
                (suction.iter().chain(pressure).copied().collect(), suction.len())
            }
            _ => {
                let message = "a section has either `points` or both `suction_side` and `pressure_side`";
                return Err(vec![Fault::new(at, "missing", message)]);
            }
        };
    let mut faults = Vec::new();
    if !POINTS.contains(&raw.len()) {
        let message = format!("{} points given, {} to {} needed", raw.len(), POINTS.start(), POINTS.end());
        faults.push(
            Fault::new(at, "point_count", message)
                .value(raw.len())
                .min(*POINTS.start() as f64)
                .max(*POINTS.end() as f64),
        );
        return Err(faults);
    }
    for (i, p) in raw.iter().enumerate() {
        if !p.iter().all(|c| c.is_finite() && c.abs() < 1e7) {
            let pointer = pointer_of(section, k, i);
            faults.push(Fault::new(pointer, "not_finite", "the point is not finite").unit("mm"));
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let points: Vec<DVec2> = raw.iter().map(|&p| DVec2::from_array(p)).collect();
    let (order, edges) = if suction > 0 && suction < points.len() {
        let (order, edges) = sides(&points, suction);
        (order, Some(edges))
    } else {
        ((0..points.len()).collect(), None)
    };
    let ring = Ring { points: order.iter().map(|&i| points[i]).collect(), origins: order };
    let (ring, edges) = without_repetition(ring, edges, section, k)?;
    let ring = in_order(ring, suction == 0, section, k, notes)?;
    Ok((ring, edges))
}

/// Both sides joined into one loop: suction side from the leading edge on, pressure side back; with the origins of the
/// first points of both edges.
fn sides(points: &[DVec2], suction: usize) -> (Vec<usize>, [usize; 2]) {
    let (s, p) = (0..suction, suction..points.len());
    let ends = [points[s.start], points[s.end - 1]];
    // The leading edge is the end with the smaller m, taken over both sides.
    let forward = ends[0].x <= ends[1].x;
    let mut order: Vec<usize> = if forward { s.collect() } else { s.rev().collect() };
    let trailing = order[order.len() - 1];
    let leading = order[0];
    let (first, last) = (points[p.start], points[p.end - 1]);
    // The pressure side goes on where the suction side ends.
    let runs_on = points[trailing].distance(first) + points[leading].distance(last)
        <= points[trailing].distance(last) + points[leading].distance(first);
    if runs_on {
        order.extend(p);
    } else {
        order.extend(p.rev());
    }
    (order, [leading, trailing])
}

/// Drops repetitions where lists join, refuses all others.
fn without_repetition(
    ring: Ring,
    mut edges: Option<[usize; 2]>,
    section: &SectionSpec,
    k: usize,
) -> Result<(Ring, Option<[usize; 2]>), Vec<Fault>> {
    let n = ring.len();
    let size = ring.points.iter().fold(0.0f64, |m, p| m.max(p.length()));
    let same = |a: DVec2, b: DVec2| a.distance(b) <= 1e-9 * (1.0 + size);
    let suction = section.suction_side.as_ref().map_or(0, Vec::len);
    let mut kept = Ring { points: Vec::with_capacity(n), origins: Vec::with_capacity(n) };
    let mut faults = Vec::new();
    // Equal points anywhere: sort by x, compare neighbours.
    let mut sorted: Vec<usize> = (0..n).collect();
    sorted.sort_by(|&a, &b| ring.points[a].x.total_cmp(&ring.points[b].x));
    let mut twin = vec![None; n];
    for (at, &i) in sorted.iter().enumerate() {
        for &j in &sorted[at + 1..] {
            if ring.points[j].x - ring.points[i].x > 1e-9 * (1.0 + size) {
                break;
            }
            if same(ring.points[i], ring.points[j]) {
                let (first, second) = (i.min(j), i.max(j));
                twin[second] = Some(twin[first].unwrap_or(first));
            }
        }
    }
    for i in 0..n {
        let Some(first) = twin[i] else {
            kept.points.push(ring.points[i]);
            kept.origins.push(ring.origins[i]);
            continue;
        };
        let closes = (first == 0 && i == n - 1) || (suction > 0 && first == suction - 1 && i == suction);
        if closes {
            // The point that is kept stands for the edge as well.
            if let Some(edges) = edges.as_mut() {
                for e in edges.iter_mut().filter(|e| **e == ring.origins[i]) {
                    *e = ring.origins[first];
                }
            }
            continue;
        }
        let message = format!(
            "the point repeats {}",
            pointer_of(section, k, ring.origins[first])
        );
        let p = ring.points[i];
        faults.push(
            Fault::new(pointer_of(section, k, ring.origins[i]), "duplicate_point", message)
                .value(serde_json::json!([p.x, p.y]))
                .unit("mm"),
        );
    }
    if faults.is_empty() && kept.len() < *POINTS.start() {
        let message = format!("{} different points given, {} needed", kept.len(), POINTS.start());
        faults.push(Fault::new(pointer(k), "point_count", message).value(kept.len()).min(*POINTS.start() as f64));
    }
    if faults.is_empty() { Ok((kept, edges)) } else { Err(faults) }
}

/// Refuses outlines that cross themselves; points in no order at all are put in order first.
fn in_order(
    ring: Ring,
    may_sort: bool,
    section: &SectionSpec,
    k: usize,
    notes: &mut Vec<String>,
) -> Result<Ring, Vec<Fault>> {
    let n = ring.len();
    let most = (n / 4).max(4);
    let found = crossings(&ring.points, most);
    let back = (0..n as isize).filter(|&i| ring.turn(i).abs() > 1.6).count();
    let scattered = found.len() >= most || back > 4;
    if found.is_empty() && !scattered {
        return check_area(ring, k);
    }
    if !scattered || !may_sort {
        return Err(vec![self_crossing(&ring, found.first().copied(), section, k)]);
    }
    if n > MOST_UNORDERED {
        let message = format!("{n} points in no order are too many to sort");
        return Err(vec![
            Fault::new(pointer(k).at("points"), "unordered", message)
                .value(n)
                .max(MOST_UNORDERED as f64)
                .hint("give the points in the order around the section"),
        ]);
    }
    let order = recover(&ring.points);
    let sorted = Ring {
        points: order.iter().map(|&i| ring.points[i]).collect(),
        origins: order.iter().map(|&i| ring.origins[i]).collect(),
    };
    let back = (0..n as isize).filter(|&i| sorted.turn(i).abs() > 1.6).count();
    let crossed = crossings(&sorted.points, 1);
    if !crossed.is_empty() || back > 3 {
        let message = "the points are in no order around the section, and none can be found that makes a smooth outline";
        return Err(vec![
            Fault::new(pointer(k).at("points"), "unordered", message)
                .hint("give the points in order, or denser"),
        ]);
    }
    notes.push(format!("section {k}: the points were put in order"));
    check_area(sorted, k)
}

fn check_area(ring: Ring, k: usize) -> Result<Ring, Vec<Fault>> {
    let perimeter = ring.perimeter();
    if ring.area().abs() > 1e-5 * perimeter * perimeter {
        return Ok(ring);
    }
    let message = format!("the points enclose next to nothing: {:.3e} mm2", ring.area().abs());
    Err(vec![Fault::new(pointer(k), "no_area", message).value(ring.area().abs()).unit("mm2")])
}

fn self_crossing(ring: &Ring, crossing: Option<(usize, usize)>, section: &SectionSpec, k: usize) -> Fault {
    let Some((i, j)) = crossing else {
        return Fault::new(pointer(k), "unordered", "the outline runs back and forth")
            .hint("give the points in the order along each side");
    };
    let name = |i: usize| pointer_of(section, k, ring.origins[i]).to_string();
    let p = ring.points[i];
    let message = format!(
        "the outline crosses itself: the segment after {} meets the one after {}, near ({:.4}, {:.4}) mm",
        name(i),
        name(j),
        p.x,
        p.y
    );
    Fault::new(name(i), "self_crossing", message).unit("mm")
}
