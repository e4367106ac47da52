//! The open outline of a section and its local frame.

use coolinggen_nurbs::{Curve, ParametricCurve};
use glam::DVec2;

/// A smooth open curve in the chart: pressure side (from the trailing edge), leading edge, suction side (to the
/// trailing edge), by the blade's parameter u, which is negative on the pressure side.
#[derive(Clone, Debug)]
pub struct Outline {
    curve: Curve<DVec2>,
    /// +1 where the material lies to the left of the direction of u, -1 to the right.
    inward: f64,
}

/// Point, derivative and moving frame at one parameter.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// The point.
    pub point: DVec2,
    /// Derivative in u.
    pub derivative: DVec2,
    /// Length of the derivative.
    pub speed: f64,
    /// Unit tangent.
    pub tangent: DVec2,
    /// Unit normal into the material.
    pub normal: DVec2,
    /// Derivative of the normal in u.
    pub normal_derivative: DVec2,
}

impl Outline {
    /// An outline from its curve; `inward` is +1 if the material lies to the left of increasing u, else -1.
    pub fn new(curve: Curve<DVec2>, inward: f64) -> Self {
        Self { curve, inward }
    }

    /// The curve.
    pub fn curve(&self) -> &Curve<DVec2> {
        &self.curve
    }

    /// Side of the material.
    pub fn inward(&self) -> f64 {
        self.inward
    }

    /// Parameter interval.
    pub fn domain(&self) -> (f64, f64) {
        self.curve.domain()
    }

    /// Frame at `u`; past the ends the end polynomials are continued.
    pub fn frame(&self, u: f64) -> Frame {
        let [point, derivative, second] = self.curve.derivatives(u);
        let speed = derivative.length();
        let tangent = derivative / speed;
        let tangent_derivative = (second - tangent * tangent.dot(second)) / speed;
        Frame {
            point,
            derivative,
            speed,
            tangent,
            normal: tangent.perp() * self.inward,
            normal_derivative: tangent_derivative.perp() * self.inward,
        }
    }

    /// Curvature at `u`, positive where the centre lies in the material.
    pub fn curvature(&self, u: f64) -> f64 {
        let f = self.frame(u);
        -f.normal_derivative.dot(f.tangent) / f.speed
    }
}
