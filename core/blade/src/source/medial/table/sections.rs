//! The sides of a propeller blade as functions: sections on cylinders.

use super::{Hand, MeanLine, PropellerTableSource, ThicknessForm, forms};
use crate::fault::Fault;
use crate::medial::{Profile, Tip, TwoSided};
use coolinggen_nurbs::{Curve, Interpolator, NurbsError, ParametricCurve};
use glam::DVec3;

/// The thickness of a form.
pub(super) fn thickness(form: ThicknessForm) -> Result<Profile, NurbsError> {
    match form {
        ThicknessForm::Naca66Modified => forms::naca_66_modified(),
        ThicknessForm::Naca4Digit => Profile::naca_four_digit(false),
        ThicknessForm::Naca4DigitClosed => Profile::naca_four_digit(true),
    }
}

/// The sections of a blade over v in [0, 1]: r/R = 1 - (1 - h) (1 - v)^2 with h at the first row. Chord, camber and
/// thickness fall linearly in v to zero at the tip, radii with the square: so all lines of constant t leave the tip
/// in the plane that touches the cylinder there (Proposition 2, with the cylinder's radius for the cut-out function).
pub(super) struct Sections {
    tip_radius: f64,
    hub: f64,
    /// Columns over 1 - v: chord (mm), pitch over 2 pi (mm), skew (radians), rake (mm), camber and thickness (mm).
    columns: [Curve<f64>; 6],
    profile: Profile,
    mean_line: MeanLine,
    /// 1 for a right-handed propeller, -1 for a left-handed one.
    turn: f64,
    x: f64,
    phi: f64,
}

impl Sections {
    pub(super) fn new(source: &PropellerTableSource, profile: Profile) -> Result<Self, NurbsError> {
        let (rows, d) = (&source.rows, source.diameter);
        let hub = rows[0].radius_r;
        // From the tip, where 1 - v = 0, to the hub.
        let nodes: Vec<f64> = rows.iter().rev().map(|r| ((1.0 - r.radius_r) / (1.0 - hub)).sqrt()).collect();
        let interpolator = Interpolator::new(3, &nodes)?;
        let column = |value: &dyn Fn(&super::PropellerRow) -> f64| {
            interpolator.curve(&rows.iter().rev().map(value).collect::<Vec<f64>>())
        };
        Ok(Self {
            tip_radius: 0.5 * d,
            hub,
            columns: [
                column(&|r| r.chord_d * d)?,
                column(&|r| r.pitch_d * d / std::f64::consts::TAU)?,
                column(&|r| r.skew_deg.to_radians())?,
                column(&|r| r.rake_d * d)?,
                column(&|r| r.camber_c * r.chord_d * d)?,
                column(&|r| r.thickness_c * r.chord_d * d)?,
            ],
            profile,
            mean_line: source.mean_line,
            turn: if source.hand == Hand::Right { 1.0 } else { -1.0 },
            x: source.x,
            phi: source.phi_deg.to_radians(),
        })
    }

    /// Refuses tables whose interpolation has no chord or thickness between rows.
    pub(super) fn check(&self) -> Result<(), Vec<Fault>> {
        for i in 0..200 {
            let v = f64::from(i) / 200.0;
            let [chord, pitch, .., thickness] = self.at(v);
            if !(chord.min(thickness).min(pitch) > 0.0) {
                let message = format!(
                    "between the rows, at r/R = {:.4}, chord, pitch or thickness is not positive",
                    self.radius(v) / self.tip_radius
                );
                return Err(vec![Fault::new("/rows", "no_surface", message)]);
            }
        }
        Ok(())
    }

    fn radius(&self, v: f64) -> f64 {
        self.tip_radius * (1.0 - (1.0 - self.hub) * (1.0 - v).powi(2))
    }

    /// Values of the columns.
    fn at(&self, v: f64) -> [f64; 6] {
        std::array::from_fn(|k| self.columns[k].point(1.0 - v))
    }
}

impl TwoSided for Sections {
    /// Side 0 is the suction side.
    fn point(&self, k: usize, t: f64, v: f64) -> DVec3 {
        let r = self.radius(v);
        let [chord, pitch, skew, rake, camber, thickness] = self.at(v);
        let p = self.profile.at(t)[0];
        let line = match self.mean_line {
            MeanLine::NacaA08 => forms::naca_a08(p.x.clamp(0.0, 1.0)),
            MeanLine::Parabolic => forms::parabola(p.x),
        };
        let off = camber * line + if k == 0 { 1.0 } else { -1.0 } * thickness * p.y;
        // Unrolled: axial, and against the way it turns. The helix falls by its pitch a turn.
        let slant = r.hypot(pitch);
        let (sin, cos) = (pitch / slant, r / slant);
        let along = (p.x - 0.5) * chord + r * skew / cos;
        let axial = self.x + rake + along * sin - off * cos;
        let against = along * cos + off * sin;
        let theta = self.phi - self.turn * against / r;
        let (sin, cos) = theta.sin_cos();
        DVec3::new(axial, r * sin, r * cos)
    }

    fn nose(&self, _: usize) -> (f64, f64) {
        let [_, slope, change] = self.profile.at(0.0);
        (self.at(0.5)[5] * slope.y, 0.5 * change.y / slope.y)
    }

    fn tip(&self) -> Option<Tip> {
        let point = self.point(0, 0.0, 1.0);
        Some(Tip { point, normal: DVec3::new(0.0, point.y, point.z).normalize(), edge: None })
    }
}
