//! Recovering the order of points around a section.

use glam::DVec2;

/// Neighbours looked at for each point.
const NEAR: usize = 10;
/// Rounds of improvement before giving up.
const ROUNDS: usize = 60;

/// Indices of `points` in an order around the outline they were taken from: a short closed tour, by greedy matching of
/// neighbours, then exchanging pairs of links (2-opt) and moving short runs (or-opt) as long as it gets shorter.
///
/// For points dense against the thickness of a section the outline is the shortest tour. The caller checks that the
/// result makes sense.
pub(crate) fn recover(points: &[DVec2]) -> Vec<usize> {
    let n = points.len();
    if n < 4 {
        return (0..n).collect();
    }
    let near = neighbours(points);
    let mut tour = Tour::new(points, greedy(points, &near));
    for _ in 0..ROUNDS {
        let mut better = false;
        for a in 0..n {
            for &b in &near[a] {
                better |= tour.exchange(a, b) || tour.shift(a, b);
            }
        }
        if !better {
            break;
        }
    }
    tour.order
}

/// The nearest points of each, nearest first: by a sweep along x.
fn neighbours(points: &[DVec2]) -> Vec<Vec<usize>> {
    let n = points.len();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| points[i].x.total_cmp(&points[j].x));
    let mut near = vec![Vec::new(); n];
    for (at, &i) in order.iter().enumerate() {
        let mut best: Vec<(f64, usize)> = Vec::with_capacity(NEAR + 1);
        let full = |best: &Vec<(f64, usize)>, dx: f64| best.len() == NEAR && dx * dx > best[NEAR - 1].0;
        let mut consider = |j: usize| {
            let dx = (points[j].x - points[i].x).abs();
            if full(&best, dx) {
                return false;
            }
            let entry = (points[i].distance_squared(points[j]), j);
            let place = best.partition_point(|e| e.0 <= entry.0);
            best.insert(place, entry);
            best.truncate(NEAR);
            true
        };
        for &j in &order[at + 1..] {
            if !consider(j) {
                break;
            }
        }
        for &j in order[..at].iter().rev() {
            if !consider(j) {
                break;
            }
        }
        near[i] = best.into_iter().map(|(_, j)| j).collect();
    }
    near
}

/// A tour that joins nearest ends first.
fn greedy(points: &[DVec2], near: &[Vec<usize>]) -> Vec<usize> {
    let n = points.len();
    let mut links: Vec<(f64, usize, usize)> = Vec::new();
    for i in 0..n {
        links.extend(near[i].iter().map(|&j| (points[i].distance_squared(points[j]), i.min(j), i.max(j))));
    }
    links.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    links.dedup();
    let mut group: Vec<usize> = (0..n).collect();
    fn root(group: &mut [usize], mut i: usize) -> usize {
        while group[i] != i {
            group[i] = group[group[i]];
            i = group[i];
        }
        i
    }
    let mut joined: Vec<Vec<usize>> = vec![Vec::new(); n];
    for (_, i, j) in links {
        let (a, b) = (root(&mut group, i), root(&mut group, j));
        if a != b && joined[i].len() < 2 && joined[j].len() < 2 {
            joined[i].push(j);
            joined[j].push(i);
            group[a] = b;
        }
    }
    // Paths are left: string them together, each time the nearest free end.
    let mut used = vec![false; n];
    let mut order = Vec::with_capacity(n);
    while order.len() < n {
        let open = |i: &usize| !used[*i] && joined[*i].len() < 2;
        let from = order.last().map_or(DVec2::ZERO, |&i: &usize| points[i]);
        let far = |i: &usize| points[*i].distance_squared(from);
        let Some(start) = (0..n).filter(open).min_by(|a, b| far(a).total_cmp(&far(b))) else { break };
        let mut at = Some(start);
        while let Some(i) = at {
            used[i] = true;
            order.push(i);
            at = joined[i].iter().copied().find(|&j| !used[j]);
        }
    }
    order
}

struct Tour<'a> {
    points: &'a [DVec2],
    order: Vec<usize>,
    place: Vec<usize>,
}

impl<'a> Tour<'a> {
    fn new(points: &'a [DVec2], order: Vec<usize>) -> Self {
        let mut place = vec![0; order.len()];
        for (k, &i) in order.iter().enumerate() {
            place[i] = k;
        }
        Self { points, order, place }
    }

    fn at(&self, place: usize) -> usize {
        self.order[place % self.order.len()]
    }

    fn distance(&self, i: usize, j: usize) -> f64 {
        self.points[i].distance(self.points[j])
    }

    /// Replaces the links (a, after a) and (b, after b) by (a, b) and (after a, after b) if that is shorter.
    fn exchange(&mut self, a: usize, b: usize) -> bool {
        let n = self.order.len();
        let (mut i, mut j) = (self.place[a], self.place[b]);
        if i > j {
            (i, j) = (j, i);
        }
        let (a, after_a, b, after_b) = (self.at(i), self.at(i + 1), self.at(j), self.at(j + 1));
        if after_a == b || after_b == a {
            return false;
        }
        let saved = self.distance(a, after_a) + self.distance(b, after_b)
            - self.distance(a, b)
            - self.distance(after_a, after_b);
        if saved <= 1e-12 * self.distance(a, after_a) {
            return false;
        }
        debug_assert!(j < n);
        self.order[i + 1..=j].reverse();
        for k in i + 1..=j {
            self.place[self.order[k]] = k;
        }
        true
    }

    /// Moves the run of one to three points that starts at `a` to between `b` and its successor if that is shorter.
    fn shift(&mut self, a: usize, b: usize) -> bool {
        let n = self.order.len();
        for length in 1..=3.min(n.saturating_sub(3)) {
            let i = self.place[a];
            let j = self.place[b];
            // The run must not contain b, nor b be its predecessor.
            let offset = (j + n - i) % n;
            if offset < length || offset == n - 1 {
                continue;
            }
            let (before, first, last, after) =
                (self.at(i + n - 1), self.at(i), self.at(i + length - 1), self.at(i + length));
            let next = self.at(j + 1);
            let removed =
                self.distance(before, first) + self.distance(last, after) - self.distance(before, after);
            let straight = self.distance(b, first) + self.distance(last, next);
            let flipped = self.distance(b, last) + self.distance(first, next);
            let added = straight.min(flipped) - self.distance(b, next);
            if added < removed - 1e-12 * removed.abs() {
                let mut run: Vec<usize> = (0..length).map(|k| self.at(i + k)).collect();
                if flipped < straight {
                    run.reverse();
                }
                let mut order = Vec::with_capacity(n);
                for k in length..n {
                    let p = self.at(i + k);
                    order.push(p);
                    if p == b {
                        order.extend_from_slice(&run);
                    }
                }
                self.order = order;
                for (k, &p) in self.order.iter().enumerate() {
                    self.place[p] = k;
                }
                return true;
            }
        }
        false
    }
}
