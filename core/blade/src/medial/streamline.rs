//! Streamlines of the medial surface: cubic Bezier curves in the charts of their stream surfaces (section 2.2).

use crate::stream::StreamSurface;
use crate::stream::measure::Measure;
use glam::{DVec2, DVec3};

/// The six parameters of a streamline, first at the leading, then at the trailing edge; radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Angles {
    /// Machine angle of the edge.
    pub(crate) phi: [f64; 2],
    /// Angle from the circle (in the direction of growing phi) to the streamline, in (0, pi).
    pub(crate) beta: [f64; 2],
    /// How long the edge's direction is kept: the first and the last leg of the control polygon over the distance of
    /// its ends in the chart.
    pub(crate) zeta: [f64; 2],
}

/// A streamline of the medial surface: u runs over [0, 1] from the leading to the trailing edge.
#[derive(Clone, Debug)]
pub(crate) struct Streamline {
    surface: StreamSurface,
    /// Control points (M, T).
    controls: [DVec2; 4],
    /// Arc length in space over u.
    length: Measure,
}

/// The streamline would not run on from the leading to the trailing edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RunsBack;

/// Accuracy of arc lengths, mm.
const LENGTH: f64 = 1e-10;

impl Streamline {
    /// The streamline on `surface` between the values `m` of M at the edges (Eq. 6).
    ///
    /// # Errors
    /// [`RunsBack`] unless M grows all the way.
    pub(crate) fn new(surface: StreamSurface, m: [f64; 2], angles: &Angles) -> Result<Self, RunsBack> {
        let ends = [0, 1].map(|i| surface.chart_of_angle(m[i], angles.phi[i]));
        let reach = ends[0].distance(ends[1]);
        let leg = |i: usize| {
            let (sin, cos) = angles.beta[i].sin_cos();
            DVec2::new(sin, cos) * (angles.zeta[i] * reach)
        };
        let controls = [ends[0], ends[0] + leg(0), ends[1] - leg(1), ends[1]];
        // M' as a quadratic Bezier polynomial, positive if its least value is.
        let d = [0, 1, 2].map(|i| controls[i + 1].x - controls[i].x);
        let bend = d[0] - 2.0 * d[1] + d[2];
        let at = if bend > 0.0 { ((d[0] - d[1]) / bend).clamp(0.0, 1.0) } else { 0.0 };
        let least = (1.0 - at) * ((1.0 - at) * d[0] + at * d[1]) + at * ((1.0 - at) * d[1] + at * d[2]);
        if !(least.min(d[0]).min(d[2]) > 1e-3 * (m[1] - m[0])) {
            return Err(RunsBack);
        }
        let length = Measure::new(&[0.0, 1.0], LENGTH, |u| {
            let [q, dq, ddq] = cubic(&controls, u);
            let (point, along, _) = surface.to_space_derivatives(q);
            let (scale, speed) = (along.length(), dq.length());
            // scale = r / r_ref, so that its derivative in M is that of r over r_ref.
            let radius = point.y.hypot(point.z);
            let rise = (along.y * point.y + along.z * point.z) / radius * (scale / radius);
            (scale * speed, rise * dq.x * speed + scale * dq.dot(ddq) / speed)
        });
        Ok(Self { surface, controls, length })
    }

    /// Point at `u` and its derivative in u.
    pub(crate) fn at(&self, u: f64) -> (DVec3, DVec3) {
        let [q, dq, _] = cubic(&self.controls, u);
        let (point, along_m, along_t) = self.surface.to_space_derivatives(q);
        (point, along_m * dq.x + along_t * dq.y)
    }

    /// Arc length in space, mm.
    pub(crate) fn length(&self) -> f64 {
        self.length.total()
    }

    /// u where `fraction` of the arc length is behind.
    pub(crate) fn at_fraction(&self, fraction: f64) -> f64 {
        if fraction >= 1.0 {
            1.0
        } else {
            self.length.backward(fraction * self.length.total()).clamp(0.0, 1.0)
        }
    }

    /// Chart coordinates at `u`, and their first and second derivative.
    pub(crate) fn chart(&self, u: f64) -> [DVec2; 3] {
        cubic(&self.controls, u)
    }

    /// u at the chart coordinate M = `m`, which must lie between those of the edges.
    pub(crate) fn at_chart(&self, m: f64) -> f64 {
        let (mut low, mut high, mut u) = (0.0, 1.0, 0.5);
        for _ in 0..80 {
            let [q, d, _] = self.chart(u);
            let miss = q.x - m;
            *(if miss > 0.0 { &mut high } else { &mut low }) = u;
            let newton = u - miss / d.x;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - u).abs() <= 2.0 * f64::EPSILON {
                break;
            }
            u = next;
        }
        u
    }

    /// The stream surface it lies on.
    pub(crate) fn surface(&self) -> &StreamSurface {
        &self.surface
    }
}

/// Point and derivatives of a cubic Bezier curve.
fn cubic(b: &[DVec2; 4], u: f64) -> [DVec2; 3] {
    let w = 1.0 - u;
    let [d0, d1, d2] = [0, 1, 2].map(|i| (b[i + 1] - b[i]) * 3.0);
    let point = b[0] * (w * w * w) + b[1] * (3.0 * u * w * w) + b[2] * (3.0 * u * u * w) + b[3] * (u * u * u);
    let first = d0 * (w * w) + d1 * (2.0 * u * w) + d2 * (u * u);
    let second = ((d1 - d0) * w + (d2 - d1) * u) * 2.0;
    [point, first, second]
}
