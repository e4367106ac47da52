//! The common parameter u of all sections.

use super::LoftSection;
use crate::section::{Outline, Piece};

/// Joints in u, from 0 to 1: the mean over the sections of the fractions of arc length at which regions begin.
pub(super) fn joints(sections: &[LoftSection]) -> Vec<f64> {
    let count = sections.first().map_or(0, |s| s.outline.pieces.len());
    let mut joints = vec![0.0; count + 1];
    for s in sections {
        let (total, mut sum) = (s.outline.length(), 0.0);
        for (k, p) in s.outline.pieces.iter().enumerate() {
            sum += p.length();
            joints[k + 1] += sum / total / sections.len() as f64;
        }
    }
    joints[count] = 1.0;
    joints
}

/// A section's arc length as a function of u: monotone, cubic in each region, C1 all around.
///
/// C1 matters: where the regions of all sections meet with one ratio of derivatives, so do those of the loft between
/// them, and the blade is smooth along the joints.
#[derive(Clone, Debug)]
pub(super) struct Reparameter {
    joints: Vec<f64>,
    /// Arc length at the joints.
    lengths: Vec<f64>,
    /// Its derivatives there.
    rates: Vec<f64>,
}

impl Reparameter {
    pub(super) fn new(joints: &[f64], outline: &Outline) -> Self {
        let n = joints.len() - 1;
        let mut lengths = vec![0.0];
        for length in outline.pieces.iter().map(Piece::length) {
            lengths.push(lengths[lengths.len() - 1] + length);
        }
        let width = |k: usize| joints[k % n + 1] - joints[k % n];
        let secant = |k: usize| (lengths[k % n + 1] - lengths[k % n]) / width(k);
        // The weighted harmonic mean of Fritsch and Butland keeps the cubics monotone.
        let rates = (0..=n).map(|k| {
            let (before, after) = (k + n - 1, k);
            let (a, b) = (2.0 * width(after) + width(before), width(after) + 2.0 * width(before));
            (a + b) / (a / secant(before) + b / secant(after))
        });
        let rates = rates.collect();
        Self { joints: joints.to_vec(), lengths, rates }
    }

    /// Arc length from the start of region `k` at `u` inside it, and its derivative.
    pub(super) fn within(&self, k: usize, u: f64) -> (f64, f64) {
        let h = self.joints[k + 1] - self.joints[k];
        let t = (u - self.joints[k]) / h;
        let rise = self.lengths[k + 1] - self.lengths[k];
        let (a, b) = (self.rates[k] * h, self.rates[k + 1] * h);
        let (c2, c3) = (3.0 * rise - 2.0 * a - b, a + b - 2.0 * rise);
        (t * (a + t * (c2 + t * c3)), (a + t * (2.0 * c2 + t * 3.0 * c3)) / h)
    }

    /// Arc length at `u`.
    pub(super) fn forward(&self, u: f64) -> f64 {
        let inner = &self.joints[1..self.joints.len() - 1];
        let k = inner.partition_point(|&j| j <= u);
        self.lengths[k] + self.within(k, u).0
    }

    /// u at arc length `s` from the start of the leading edge.
    pub(super) fn backward(&self, s: f64) -> f64 {
        let k = self.lengths[1..self.lengths.len() - 1].partition_point(|&l| l <= s);
        let (mut low, mut high) = (self.joints[k], self.joints[k + 1]);
        let (a, b) = (self.lengths[k], self.lengths[k + 1]);
        let mut u = low + (high - low) * ((s - a) / (b - a)).clamp(0.0, 1.0);
        for _ in 0..60 {
            let (length, rate) = self.within(k, u);
            let miss = a + length - s;
            if miss > 0.0 {
                high = u;
            } else {
                low = u;
            }
            let newton = u - miss / rate;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - u).abs() < 1e-12 {
                break;
            }
            u = next;
        }
        u
    }
}
