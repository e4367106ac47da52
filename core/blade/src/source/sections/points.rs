//! The points of one section as a closed polygon that does not cross itself.

use super::read::pointer_of;
use super::{SectionSpec, pointer};
use crate::fault::Fault;
use crate::section::{Ring, crossings, recover};
use glam::DVec2;

/// Least and most points of a section.
const POINTS: std::ops::RangeInclusive<usize> = 8..=20_000;
/// Most points that are put in order.
const MOST_UNORDERED: usize = 4_000;

/// All points in order around the section; with sides also the origins of leading and trailing edge.
pub(super) fn gather(
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
        let message = format!("the point repeats {}", pointer_of(section, k, ring.origins[first]));
        let p = ring.points[i];
        faults.push(
            Fault::new(pointer_of(section, k, ring.origins[i]), "duplicate_point", message)
                .value(serde_json::json!([p.x, p.y]))
                .unit("mm"),
        );
    }
    if faults.is_empty() && kept.len() < *POINTS.start() {
        let message = format!("{} different points given, {} needed", kept.len(), POINTS.start());
        faults.push(
            Fault::new(pointer(k), "point_count", message).value(kept.len()).min(*POINTS.start() as f64),
        );
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
