//! Where a side leaves a circular nose.

use super::chain::{self, End};
use super::circle::Circle;
use glam::DVec2;

/// Points of the side that are looked at.
const REACH: usize = 6;

/// The angle on `circle` at which a side leaves it tangentially.
///
/// `end` is the angle of the last point known to lie on the arc, `sense` +1 if the arc runs counterclockwise towards
/// the side, else -1, and `side` the points that follow. Tables rarely have a point at the joint itself. The joint is
/// where the side's curvature runs most evenly: from a joint too early it would have to go on bending, from one too
/// late to bend back. `slack` is how far in mm the side may leave a point of the arc.
pub(super) fn tangent_joint(circle: &Circle, end: f64, sense: f64, side: &[DVec2], slack: f64) -> f64 {
    let side = &side[..side.len().min(REACH)];
    if side.len() < 3 {
        return end;
    }
    let next = side[0];
    // Back along the arc by what the slack allows (half of s^2 / radius), on to just before the next point.
    let back = (2.0 * slack / circle.radius).sqrt().min(0.2);
    let ahead = ((circle.angle(next) - end) * sense).rem_euclid(std::f64::consts::TAU);
    let gap = circle.point(end).distance(next) / circle.radius;
    let ahead = if ahead > std::f64::consts::PI { 0.0 } else { (0.9 * ahead).min(0.8 * gap) };
    // The far end matters little: the tangent there of the parabola through the last three points.
    let [a, b, c] = [side[side.len() - 3], side[side.len() - 2], side[side.len() - 1]];
    let (h, k) = (a.distance(b), b.distance(c));
    let (before, last) = ((b - a) / h, (c - b) / k);
    let far = End::Tangent((last + (last - before) * (k / (h + k))).normalize_or(last));
    let cost = |turned: f64| {
        let angle = end + sense * turned;
        let tangent = DVec2::from_angle(angle).perp() * sense;
        let mut points = vec![circle.point(angle)];
        points.extend_from_slice(side);
        if points[0].distance(next) < 1e-3 * gap * circle.radius {
            return f64::INFINITY;
        }
        let chain = chain::cubic(&points, End::Tangent(tangent), far);
        chain.map_or(f64::INFINITY, |c| chain::unevenness(&c, 3))
    };
    let steps = 8;
    let step = (ahead + back) / f64::from(steps);
    let tried = (0..=steps).map(|i| -back + step * f64::from(i)).map(|t| (cost(t), t));
    let best = tried.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |t| t.1);
    let turned = minimum(cost, (best - step).max(-back), (best + step).min(ahead), 1e-3 * (ahead + back));
    end + sense * turned
}

/// Where `cost` is least between `low` and `high`: golden section, finished by the parabola through the last three
/// values.
fn minimum(cost: impl Fn(f64) -> f64, mut low: f64, mut high: f64, width: f64) -> f64 {
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let (mut a, mut b) = (high - ratio * (high - low), low + ratio * (high - low));
    let (mut at_a, mut at_b) = (cost(a), cost(b));
    while high - low > width {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - ratio * (high - low);
            at_a = cost(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + ratio * (high - low);
            at_b = cost(b);
        }
    }
    let middle = 0.5 * (low + high);
    let h = 0.5 * (high - low);
    let [f, g, k] = [low, middle, high].map(&cost);
    let bend = f - 2.0 * g + k;
    let shift = if bend > 0.0 { 0.5 * h * (f - k) / bend } else { 0.0 };
    middle + if shift.abs() <= h { shift } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_joint_between_the_points() {
        // An arc that ends at 1 rad, followed by its tangent line; the table has the arc up to 0.8 rad only.
        let circle = Circle { center: DVec2::new(3.0, 4.0), radius: 2.0 };
        let (joint, along) = (circle.point(1.0), DVec2::from_angle(1.0).perp());
        let side: Vec<_> = (0..8).map(|i| joint + along * (0.9 + 2.0 * f64::from(i))).collect();
        let found = tangent_joint(&circle, 0.8, 1.0, &side, 1e-3);
        assert!((found - 1.0).abs() < 1e-5, "{found}");
        // And mirrored.
        let flip = |p: DVec2| DVec2::new(p.x, -p.y);
        let circle = Circle { center: flip(circle.center), radius: 2.0 };
        let side: Vec<_> = side.into_iter().map(flip).collect();
        let found = tangent_joint(&circle, -0.8, -1.0, &side, 1e-3);
        assert!((found + 1.0).abs() < 1e-5, "{found}");
    }
}
