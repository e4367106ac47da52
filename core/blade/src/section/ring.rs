//! Closed polygons of section points.

use glam::DVec2;

/// Points in order around a section, without repetition of the first; each with its index in the source's list.
#[derive(Clone, Debug)]
pub(crate) struct Ring {
    pub(crate) points: Vec<DVec2>,
    pub(crate) origins: Vec<usize>,
}

impl Ring {
    pub(crate) fn len(&self) -> usize {
        self.points.len()
    }

    /// Point `i`, counted around.
    pub(crate) fn at(&self, i: isize) -> DVec2 {
        self.points[self.index(i)]
    }

    pub(crate) fn index(&self, i: isize) -> usize {
        i.rem_euclid(self.len() as isize) as usize
    }

    /// The enclosed area, positive if the points run counterclockwise, mm2.
    pub(crate) fn area(&self) -> f64 {
        let n = self.len();
        let base = self.points[0];
        0.5 * (0..n).map(|i| (self.points[i] - base).perp_dot(self.points[(i + 1) % n] - base)).sum::<f64>()
    }

    /// The same ring the other way around.
    pub(crate) fn reverse(&mut self) {
        self.points.reverse();
        self.origins.reverse();
    }

    /// Angle by which the polygon turns at point `i`, radians, positive to the left.
    pub(crate) fn turn(&self, i: isize) -> f64 {
        let (a, b) = (self.at(i) - self.at(i - 1), self.at(i + 1) - self.at(i));
        a.perp_dot(b).atan2(a.dot(b))
    }

    /// Length of the polygon from point `from` to point `to` as it runs.
    pub(crate) fn length(&self, from: usize, to: usize) -> f64 {
        let n = self.len();
        let count = (to + n - from) % n;
        (0..count).map(|k| self.points[(from + k) % n].distance(self.points[(from + k + 1) % n])).sum()
    }

    /// Length once around.
    pub(crate) fn perimeter(&self) -> f64 {
        let n = self.len();
        (0..n).map(|i| self.points[i].distance(self.points[(i + 1) % n])).sum()
    }

    /// Curvature of the circle through three successive points around `i`, positive to the left.
    pub(crate) fn curvature(&self, i: isize) -> f64 {
        let (a, b) = (self.at(i) - self.at(i - 1), self.at(i + 1) - self.at(i));
        2.0 * a.perp_dot(b) / (a.length() * b.length() * (a + b).length())
    }
}

/// Centroid of the area of a closed polygon.
pub(crate) fn centroid(points: &[DVec2]) -> DVec2 {
    let base = points[0];
    let (mut area, mut sum) = (0.0, DVec2::ZERO);
    for w in points.windows(2) {
        let (a, b) = (w[0] - base, w[1] - base);
        let twice = a.perp_dot(b);
        area += twice;
        sum += (a + b) * twice;
    }
    base + sum / (3.0 * area)
}

/// Pairs of segments `(i, j)`, `i < j`, of the closed polygon that cross or touch, at most `most` of them.
pub(crate) fn crossings(points: &[DVec2], most: usize) -> Vec<(usize, usize)> {
    let n = points.len();
    let end = |i: usize| points[(i + 1) % n];
    let span = |i: usize| (points[i].x.min(end(i).x), points[i].x.max(end(i).x));
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| span(i).0.total_cmp(&span(j).0));
    // A sweep along x: only segments whose x ranges overlap are compared.
    let mut active: Vec<usize> = Vec::new();
    let mut found = Vec::new();
    for &i in &order {
        let start = span(i).0;
        active.retain(|&j| span(j).1 >= start);
        for &j in &active {
            let neighbours = (i + 1) % n == j || (j + 1) % n == i;
            if !neighbours && segments_meet(points[i], end(i), points[j], end(j)) {
                found.push((i.min(j), i.max(j)));
                if found.len() >= most {
                    return found;
                }
            }
        }
        active.push(i);
    }
    found.sort_unstable();
    found
}

fn segments_meet(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    let (c_side, d_side) = (side(a, b, c), side(a, b, d));
    let (a_side, b_side) = (side(c, d, a), side(c, d, b));
    if c_side * d_side < 0.0 && a_side * b_side < 0.0 {
        return true;
    }
    let within = |p: DVec2, q: DVec2, r: DVec2| (r - p).dot(r - q) <= 0.0;
    (c_side == 0.0 && within(a, b, c))
        || (d_side == 0.0 && within(a, b, d))
        || (a_side == 0.0 && within(c, d, a))
        || (b_side == 0.0 && within(c, d, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_crossing_of_an_eight() {
        let p = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]].map(DVec2::from_array);
        assert_eq!(crossings(&p, 10), vec![(0, 2)]);
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(DVec2::from_array);
        assert!(crossings(&square, 10).is_empty());
        let ring = Ring { points: square.to_vec(), origins: vec![0, 1, 2, 3] };
        assert!((ring.area() - 4.0).abs() < 1e-15);
        assert!((ring.turn(1) - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    }
}
