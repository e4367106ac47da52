//! Rims: the borders of bores on the faces they end on, and the metal between those that share a face.

use super::{BoreError, TOUCHING};
use coolinggen_brep::FaceId;
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// Distance from a rim's plane, relative to its reach, within which a face has not turned round.
const SAME_SIDE: f64 = 0.5;

/// The border of a bore on the faces it ends on, as a polygon.
#[derive(Clone, Debug)]
pub(crate) struct Rim {
    /// The faces it runs over.
    pub(crate) faces: Vec<FaceId>,
    points: Vec<DVec3>,
    center: DVec3,
    reach: f64,
}

impl Rim {
    /// The rim through points, in order.
    pub(crate) fn new(faces: Vec<FaceId>, points: Vec<DVec3>) -> Self {
        let center = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
        let reach = points.iter().map(|p| p.distance(center)).fold(0.0, f64::max);
        Self { faces, points, center, reach }
    }

    /// Distance to another rim on the same face, mm; negative where the two overlap.
    fn gap(&self, other: &Self) -> f64 {
        let outside = [(self, other), (other, self)].map(|(a, b)| {
            let distances = a.points.iter().map(|p| b.distance(*p));
            distances.fold((f64::INFINITY, false), |(least, met), (d, within)| (least.min(d), met || within))
        });
        let least = outside[0].0.min(outside[1].0);
        if outside.iter().any(|(_, met)| *met) { -least } else { least }
    }

    /// Distance of a point to the polygon, and whether it lies within as seen along the polygon's normal, on the same
    /// side of a face that turns round an end.
    fn distance(&self, p: DVec3) -> (f64, bool) {
        let n = self.points.len();
        let area: DVec3 = (0..n).map(|i| self.points[i].cross(self.points[(i + 1) % n])).sum();
        let normal = area.normalize_or_zero();
        let x = normal.any_orthonormal_vector();
        let y = normal.cross(x);
        let flat = |q: DVec3| DVec2::new((q - p).dot(x), (q - p).dot(y));
        let (mut least, mut within) = (f64::INFINITY, false);
        for i in 0..n {
            let (a, b) = (self.points[i], self.points[(i + 1) % n]);
            let d = b - a;
            let t = ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
            least = least.min(p.distance(a + d * t));
            let (a, b) = (flat(a), flat(b));
            if (a.y > 0.0) != (b.y > 0.0) && a.x - a.y / (b.y - a.y) * (b.x - a.x) > 0.0 {
                within = !within;
            }
        }
        (least, within && (p - self.center).dot(normal).abs() < SAME_SIDE * self.reach)
    }
}

/// All rims so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rims {
    rims: Vec<(String, Rim)>,
    on_face: HashMap<FaceId, Vec<usize>>,
}

impl Rims {
    /// Adds the rims of a bore, unless one overlaps another bore's on the same face or leaves less than `least` mm to it;
    /// `path` is the bore's.
    pub(crate) fn add(&mut self, path: &str, rims: [Rim; 2], least: f64) -> Result<(), BoreError> {
        for rim in &rims {
            let near = rim.faces.iter().filter_map(|face| self.on_face.get(face)).flatten();
            for &i in near {
                let (other_path, other) = &self.rims[i];
                if rim.center.distance(other.center) > rim.reach + other.reach + least {
                    continue;
                }
                let gap = rim.gap(other);
                if gap < least.max(TOUCHING) {
                    return Err(BoreError::Meets { other: other_path.clone(), gap, least });
                }
            }
        }
        for rim in rims {
            for &face in &rim.faces {
                self.on_face.entry(face).or_default().push(self.rims.len());
            }
            self.rims.push((path.to_owned(), rim));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(x: f64, radius: f64) -> Rim {
        let at = |i: u32| DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 48.0) * radius;
        Rim::new(vec![FaceId(0)], (0..48).map(|i| at(i).extend(0.0) + DVec3::X * x).collect())
    }

    /// A bore's rims, the second on no face.
    fn pair(rim: Rim) -> [Rim; 2] {
        [rim, Rim::new(Vec::new(), vec![DVec3::X, DVec3::Y, DVec3::Z])]
    }

    #[test]
    fn rims_keep_apart() {
        let mut rims = Rims::default();
        rims.add("a", [circle(0.0, 1.0), circle(2.6, 1.0)], 0.5).unwrap();
        let refused = |rim: Rim| match rims.clone().add("c", pair(rim), 0.5) {
            Err(BoreError::Meets { gap, .. }) => gap,
            result => panic!("{result:?}"),
        };
        // Too near, overlapping, inside and around.
        let gap = refused(circle(-2.4, 1.0));
        assert!((gap - 0.4).abs() < 1e-2, "{gap}");
        assert!(refused(circle(4.4, 1.0)) < 0.0);
        assert!(refused(circle(0.1, 0.3)) < 0.0);
        assert!(refused(circle(0.0, 1.4)) < 0.0);
        // On another face, and on the other side of the same one where it turns round.
        let mut elsewhere = circle(0.0, 1.0);
        elsewhere.faces = vec![FaceId(1)];
        rims.add("d", pair(elsewhere), 0.5).unwrap();
        let mut opposite = circle(0.0, 1.0);
        opposite.points.iter_mut().for_each(|p| p.z += 0.8);
        let opposite = Rim::new(opposite.faces, opposite.points);
        rims.add("e", pair(opposite), 0.5).unwrap();
    }
}
