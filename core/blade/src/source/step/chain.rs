//! Patches joined around the blade.

use super::read::Patch;
use crate::source::closed::surgery;
use coolinggen_nurbs::{Homogeneous, Knots, NurbsError, ParametricSurface, Surface};
use glam::DVec3;

type Net = Surface<Homogeneous<DVec3>>;

/// A ring of patches, each turned so that its u runs on from the one before and its v along the blade.
#[derive(Clone, Debug)]
pub(super) struct Ring {
    /// Indices of the patches and their orientations.
    path: Vec<(usize, usize)>,
    /// Area, roughly, mm2.
    area: f64,
}

/// Points a border is compared at.
const LOOKS: usize = 9;
/// A knot at a border is needless if no point moves by more than this without it, mm.
const NEEDLESS: f64 = 1e-10;
/// Rings are sought from at most this many patches.
const MOST_STARTS: usize = 60;

impl Ring {
    /// Indices of the patches.
    pub(super) fn members(&self) -> Vec<usize> {
        self.path.iter().map(|(i, _)| *i).collect()
    }
}

/// The ring of patches with the greatest area, each meeting the next along a whole border within `tolerance` mm.
pub(super) fn ring(patches: &[Patch], tolerance: f64) -> Option<Ring> {
    let mut best: Option<Ring> = None;
    let nets: Vec<_> = patches.iter().map(|p| variants(&p.net)).collect();
    for start in 0..nets.len().min(MOST_STARTS) {
        // As it is, and with u and v exchanged; the other turns lead to the same rings.
        for turn in [0, 4] {
            let found = follow(&nets, start, turn, tolerance);
            let larger = |r: &Ring| best.as_ref().is_none_or(|b| r.area > b.area * (1.0 + 1e-9));
            if let Some(ring) = found.filter(larger) {
                best = Some(ring);
            }
        }
    }
    best
}

/// A net in one of its eight orientations: bit 0 of `turn` reverses u, bit 1 v, bit 2 exchanges them first.
struct Turned {
    /// Start and end border, at even distances of the parameter.
    borders: [[DVec3; LOOKS]; 2],
    area: f64,
}

fn variants(net: &Net) -> Vec<Turned> {
    let ((a, b), (c, d)) = net.domain();
    let look = |turn: usize, u: f64, v: f64| {
        let u = if turn & 1 == 0 { u } else { 1.0 - u };
        let v = if turn & 2 == 0 { v } else { 1.0 - v };
        let (u, v) = if turn & 4 == 0 { (u, v) } else { (v, u) };
        net.point(a + (b - a) * u, c + (d - c) * v).project()
    };
    let turned = (0..8).map(|turn| {
        let at = |u: f64, k: usize| look(turn, u, k as f64 / (LOOKS - 1) as f64);
        let borders = [0.0, 1.0].map(|u| std::array::from_fn(|k| at(u, k)));
        let around: f64 = (0..8)
            .map(|i| at(f64::from(i) / 8.0, LOOKS / 2).distance(at(f64::from(i + 1) / 8.0, LOOKS / 2)))
            .sum();
        Turned { borders, area: around * at(0.5, 0).distance(at(0.5, LOOKS - 1)) }
    });
    turned.collect()
}

/// The net in an orientation, on [0, 1] both ways.
fn oriented(net: &Net, turn: usize) -> Result<Net, NurbsError> {
    let ((a, b), (c, d)) = net.domain();
    let mut net = net.restricted_u(a, b)?.restricted_v(c, d)?;
    if turn & 4 != 0 {
        net = net.transposed();
    }
    if turn & 1 != 0 {
        net = surgery::net_reversed_u(&net)?;
    }
    if turn & 2 != 0 {
        net = surgery::net_reversed_u(&net.transposed())?.transposed();
    }
    net = surgery::rebased(&net, (0.0, 1.0))?;
    Ok(surgery::rebased(&net.transposed(), (0.0, 1.0))?.transposed())
}

fn follow(nets: &[Vec<Turned>], start: usize, turn: usize, tolerance: f64) -> Option<Ring> {
    let meets =
        |a: &[DVec3; LOOKS], b: &[DVec3; LOOKS]| a.iter().zip(b).all(|(p, q)| p.distance(*q) <= tolerance);
    let long = |border: &[DVec3; LOOKS]| border[0].distance(border[LOOKS - 1]) > 10.0 * tolerance;
    let first = &nets[start][turn];
    if !long(&first.borders[0]) {
        return None;
    }
    let mut path = vec![(start, turn)];
    loop {
        let (i, t) = path[path.len() - 1];
        let end = &nets[i][t].borders[1];
        if meets(end, &first.borders[0]) {
            let area = path.iter().map(|&(i, t)| nets[i][t].area).sum();
            return Some(Ring { path, area });
        }
        let unused = (0..nets.len()).filter(|i| path.iter().all(|(used, _)| used != i));
        let next = unused
            .flat_map(|i| (0..8).map(move |t| (i, t)))
            .find(|&(i, t)| meets(end, &nets[i][t].borders[0]))?;
        path.push(next);
    }
}

/// One closed net from a ring: degrees are raised and knots inserted until borders agree, the parameter of each patch is
/// scaled so that it runs on at the same speed, and knots needed no more are taken out. Also the greatest distance by
/// which a border was moved to close a gap, mm.
pub(super) fn joined(ring: &Ring, patches: &[Patch]) -> Result<(Net, f64), NurbsError> {
    let nets = ring.path.iter().map(|&(i, turn)| oriented(&patches[i].net, turn));
    let mut nets = nets.collect::<Result<Vec<_>, _>>()?;
    let degrees =
        nets.iter().fold((0, 0), |(p, q), n| (p.max(n.knots_u().degree()), q.max(n.knots_v().degree())));
    for net in &mut nets {
        while net.knots_u().degree() < degrees.0 {
            *net = net.elevated_u()?;
        }
        while net.knots_v().degree() < degrees.1 {
            *net = net.elevated_v()?;
        }
    }
    let knots_v: Vec<Knots> = nets.iter().map(|n| n.knots_v().clone()).collect();
    for net in &mut nets {
        *net = net.with_knots_inserted_v(&missing(net.knots_v(), &knots_v))?;
    }
    let mut gap: f64 = 0.0;
    for k in 1..nets.len() {
        let (before, after) = (&nets[k - 1], &nets[k]);
        let columns = before.counts().1;
        let last = &before.points()[before.points().len() - columns..];
        // Homogeneous coordinates are known up to a factor: that of the weights.
        let factor = last[0].weight / after.points()[0].weight;
        let scaled = after.map(|p| *p * factor);
        for (a, b) in last.iter().zip(scaled.points()) {
            // Unequal weights are the same points at another speed: no join.
            let weights = (a.weight / b.weight - 1.0).abs();
            gap = gap.max(a.project().distance(b.project())).max(if weights > 1e-9 { 1.0 } else { 0.0 });
        }
        nets[k] = scaled;
    }
    let (mut at, mut width) = (0.0, 1.0);
    let mut placed: Vec<Net> = Vec::new();
    for (k, net) in nets.iter().enumerate() {
        if k > 0 {
            width = speed(net, 0.0) * width / speed(&nets[k - 1], 1.0);
        }
        if !(width.is_finite() && width > 1e-9) {
            width = 1.0;
        }
        placed.push(surgery::rebased(net, (at, at + width))?);
        at += width;
    }
    let mut whole = surgery::glued(&placed)?;
    for net in &placed[1..] {
        let border = net.knots_u().domain().0;
        while let Ok(less) = surgery::net_without_knot(&whole, border, NEEDLESS) {
            whole = less;
        }
    }
    Ok((whole, gap))
}

/// Mean length of the derivative in u along the border at `u`.
fn speed(net: &Net, u: f64) -> f64 {
    (0..LOOKS)
        .map(|k| {
            let d = net.derivatives(u, k as f64 / (LOOKS - 1) as f64);
            let point = d.point.project();
            ((d.u.weighted - point * d.u.weight) * (1.0 / d.point.weight)).length()
        })
        .sum()
}

/// Knots that `own` lacks to have all of `others`. Knots within 1e-9 of each other are the same.
fn missing(own: &Knots, others: &[Knots]) -> Vec<f64> {
    let mut lacking: Vec<(f64, usize)> = Vec::new();
    for other in others {
        let breaks = other.breaks();
        for &t in &breaks[1..breaks.len() - 1] {
            let near = |k: f64| (k - t).abs() <= 1e-9;
            let have = own.values().iter().filter(|k| near(**k)).count();
            let wanted = other.multiplicity(t).saturating_sub(have);
            match lacking.iter_mut().find(|(k, _)| near(*k)) {
                Some((_, count)) => *count = wanted.max(*count),
                None => lacking.push((t, wanted)),
            }
        }
    }
    lacking.into_iter().flat_map(|(t, count)| std::iter::repeat_n(t, count)).collect()
}
