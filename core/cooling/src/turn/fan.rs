//! Fibres that fan out towards an end of a turn where sides run too steeply to be crossed at the wall's angle.
//!
//! The sides of a leading chamber that follows a blunt nose may end nearly across the camber line: fibres at the wall's
//! angle would graze one side there, or pass it. Towards such an end fibres join places at about the same share of the way
//! along both sides, so that the last one joins the sides' own ends.

use super::pace::Pace;
use super::side::Side;
use glam::DVec2;

/// How the parameter of a side runs in a fan.
struct Way {
    from: f64,
    to: f64,
    pace: Pace,
}

/// Fibres between the one at `from` and the sides' ends, and beyond those.
pub(super) struct Fan {
    from: f64,
    /// x of the sides' ends, less `from`.
    reach: f64,
    /// Along the suction side and the pressure side.
    ways: [Way; 2],
}

/// Of a side: its parameter where the fan begins, the rate at which it grows with x there, and its value at the end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    pub(super) u: f64,
    pub(super) rate: f64,
    pub(super) end: f64,
}

impl Fan {
    /// The fan from the fibre at `from` on, which goes on there as the sides' fibres do; none where a side runs the wrong
    /// way, or hardly runs: where by the rates at which the fan begins one side would reach more than `unlike` times
    /// farther than the other.
    pub(super) fn new(from: f64, sides: [Start; 2], unlike: f64) -> Option<Self> {
        let lengths = sides.map(|s| (s.end - s.u) / s.rate);
        let reach = 0.5 * (lengths[0] + lengths[1]);
        let ratio = lengths[0] / lengths[1];
        if !(from * reach >= 0.0 && (1.0 / unlike..=unlike).contains(&ratio)) {
            return None;
        }
        let ways = sides.map(|s| {
            let pace = Pace::new(s.rate * reach / (s.end - s.u), 1.0);
            Way { from: s.u, to: s.end, pace }
        });
        Some(Self { from, reach, ways })
    }

    /// Whether the fibre at x belongs to the fan.
    pub(super) fn holds(&self, x: f64) -> bool {
        (x - self.from) * self.reach > 0.0
    }

    /// Ends of the fibre at x on the suction and the pressure side.
    pub(super) fn ends(&self, sides: &[Side<'_>; 2], x: f64) -> [DVec2; 2] {
        let share = (x - self.from) / self.reach;
        std::array::from_fn(|k| {
            let Way { from, to, pace } = &self.ways[k];
            // Beyond the end at the speed of the end, which is 1.
            let share = if share < 1.0 { pace.at(share) } else { share };
            sides[k].at(from + (to - from) * share).0
        })
    }

    /// x of the first fibre beyond all `points`, which lie behind the sides' ends as seen from `inside`; none where the
    /// continued sides cross before.
    pub(super) fn beyond(&self, sides: &[Side<'_>; 2], points: &[DVec2], inside: DVec2) -> Option<f64> {
        const STEPS: u32 = 1000;
        const STEP: f64 = 2e-3;
        let [a, b] = self.ends(sides, self.from + self.reach);
        let across = a - b;
        for i in 0..STEPS {
            let x = self.from + self.reach * (1.0 + STEP * f64::from(i));
            let [a, b] = self.ends(sides, x);
            if !((a - b).dot(across) > 0.0) {
                return None;
            }
            let off = |p: DVec2| (a - b).perp_dot(p - b);
            let side = off(inside).signum();
            if points.iter().all(|p| off(*p) * side > 0.0) {
                return Some(x);
            }
        }
        None
    }
}
