//! Circles through points, by least squares.

use glam::DVec2;

/// A circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Circle {
    pub(crate) center: DVec2,
    pub(crate) radius: f64,
}

impl Circle {
    /// The circle with the least sum of squared distances to `points`, three or more: the algebraic fit (Kasa), then
    /// Gauss-Newton on the distances. None where the points lie on a line.
    pub(crate) fn fit(points: &[DVec2]) -> Option<Self> {
        let n = points.len() as f64;
        let mean = points.iter().sum::<DVec2>() / n;
        let (mut xx, mut xy, mut yy, mut right) = (0.0, 0.0, 0.0, DVec2::ZERO);
        for p in points {
            let d = *p - mean;
            xx += d.x * d.x;
            xy += d.x * d.y;
            yy += d.y * d.y;
            right += d * d.length_squared();
        }
        let determinant = xx * yy - xy * xy;
        if !(determinant > 1e-14 * (xx + yy) * (xx + yy)) {
            return None;
        }
        let shift =
            DVec2::new(right.x * yy - right.y * xy, right.y * xx - right.x * xy) / (2.0 * determinant);
        let mut circle =
            Self { center: mean + shift, radius: ((xx + yy) / n + shift.length_squared()).sqrt() };
        for _ in 0..4 {
            circle = circle.improved(points)?;
        }
        circle.radius.is_finite().then_some(circle)
    }

    /// One Gauss-Newton step on the distances to the points.
    fn improved(self, points: &[DVec2]) -> Option<Self> {
        let n = points.len() as f64;
        let (mut mean, mut mean_distance) = (DVec2::ZERO, 0.0);
        for p in points {
            let d = *p - self.center;
            mean += d / d.length();
            mean_distance += d.length();
        }
        (mean, mean_distance) = (mean / n, mean_distance / n);
        let (mut xx, mut xy, mut yy, mut right) = (0.0, 0.0, 0.0, DVec2::ZERO);
        for p in points {
            let d = *p - self.center;
            let e = d / d.length() - mean;
            xx += e.x * e.x;
            xy += e.x * e.y;
            yy += e.y * e.y;
            right += e * (d.length() - mean_distance);
        }
        let determinant = xx * yy - xy * xy;
        if !(determinant > 0.0) {
            return None;
        }
        let shift = DVec2::new(right.x * yy - right.y * xy, right.y * xx - right.x * xy) / determinant;
        Some(Self { center: self.center + shift, radius: mean_distance - mean.dot(shift) })
    }

    /// Distance of `p` from the circle.
    pub(crate) fn miss(&self, p: DVec2) -> f64 {
        ((p - self.center).length() - self.radius).abs()
    }

    /// Point at `angle`, radians from +x.
    pub(crate) fn point(&self, angle: f64) -> DVec2 {
        self.center + DVec2::from_angle(angle) * self.radius
    }

    /// Angle of `p` seen from the center.
    pub(crate) fn angle(&self, p: DVec2) -> f64 {
        (p - self.center).to_angle()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_a_short_arc() {
        let exact = Circle { center: DVec2::new(40.0, -3.0), radius: 1.7 };
        let points: Vec<_> = (0..12).map(|i| exact.point(0.3 + 0.1 * f64::from(i))).collect();
        let found = Circle::fit(&points).unwrap();
        assert!(found.center.distance(exact.center) < 1e-10 && (found.radius - 1.7).abs() < 1e-10);
        assert!(Circle::fit(&[DVec2::ZERO, DVec2::X, DVec2::X * 2.0]).is_none());
    }
}
