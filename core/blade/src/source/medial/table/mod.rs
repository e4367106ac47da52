//! Propeller blades from radial tables.

mod forms;
mod sections;

use super::assembly::{self, Finish};
use super::read;
use super::spec::{ClosingSpec, SkinSpec};
use crate::blade::Blade;
use crate::fault::{Fault, Pointer};
use crate::stream::StreamSpace;
use schemars::JsonSchema;
use sections::Sections;
use serde::{Deserialize, Serialize};

/// A propeller blade from the usual radial tables: sections on cylinders about the machine axis, along the pitch helix,
/// closed at the tip.
///
/// The design's `space` gives the hub that cuts the blade; its shroud lies at the tip radius or beyond. Columns are
/// interpolated over sqrt(1 - r/R), in which the outline of a round tip is smooth; there chord and thickness vanish, and
/// the blade has a tangent plane, that of the cylinder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PropellerTableSource {
    /// Diameter D = 2 R, mm, positive.
    #[schemars(extend("unit" = "mm", "exclusiveMinimum" = 0.0))]
    pub diameter: f64,
    /// The way it turns, seen from behind (from larger x).
    #[serde(default)]
    pub hand: Hand,
    /// Rows from the hub to the tip, at least 4; the last at r/R = 1 with the chord 0.
    pub rows: Vec<PropellerRow>,
    /// Thickness along the chord.
    #[serde(default)]
    pub thickness_form: ThicknessForm,
    /// Camber along the chord.
    #[serde(default)]
    pub mean_line: MeanLine,
    /// Axial position of the generator line, mm.
    #[serde(default)]
    #[schemars(title = "Axial position", extend("unit" = "mm"))]
    pub x: f64,
    /// Machine angle theta of the generator line, degrees.
    #[serde(default)]
    #[schemars(title = "Theta", extend("unit" = "deg"))]
    pub phi_deg: f64,
    /// How the trailing edge is closed: blunt, unless the thickness form is closed, or said otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub closing: Option<ClosingSpec>,
    /// The B-spline surface of both sides.
    #[serde(default)]
    pub skin: SkinSpec,
}

/// A section of a propeller blade.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PropellerRow {
    /// Radius over the tip radius, r/R, over 0 and up to 1.
    #[schemars(extend("unit" = "tip radii", "exclusiveMinimum" = 0.0))]
    pub radius_r: f64,
    /// Chord over the diameter, c/D.
    #[schemars(extend("unit" = "diameters"))]
    pub chord_d: f64,
    /// Pitch over the diameter, P/D, positive.
    #[schemars(extend("unit" = "diameters", "exclusiveMinimum" = 0.0))]
    pub pitch_d: f64,
    /// Skew angle of the middle of the chord, along the pitch helix towards the trailing edge, degrees.
    #[serde(default)]
    #[schemars(extend("unit" = "deg"))]
    pub skew_deg: f64,
    /// Rake over the diameter, towards larger x.
    #[serde(default)]
    #[schemars(extend("unit" = "diameters"))]
    pub rake_d: f64,
    /// Greatest camber over the chord, f/c.
    #[serde(default)]
    #[schemars(extend("unit" = "chords"))]
    pub camber_c: f64,
    /// Greatest thickness over the chord, t/c, positive.
    #[schemars(extend("unit" = "chords", "exclusiveMinimum" = 0.0))]
    pub thickness_c: f64,
}

/// The way a propeller turns, seen from behind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Hand {
    /// Clockwise.
    #[default]
    Right,
    /// Counterclockwise.
    Left,
}

/// Thickness along the chord.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ThicknessForm {
    /// NACA 66 with the nose and tail of the David Taylor Model Basin.
    #[default]
    #[serde(rename = "naca_66_modified")]
    Naca66Modified,
    /// NACA four-digit.
    #[serde(rename = "naca_4_digit")]
    Naca4Digit,
    /// NACA four-digit, closed at the tail.
    #[serde(rename = "naca_4_digit_closed")]
    Naca4DigitClosed,
}

/// Camber along the chord.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MeanLine {
    /// NACA a = 0.8.
    #[default]
    #[serde(rename = "naca_a08")]
    NacaA08,
    /// A parabola.
    Parabolic,
}

impl PropellerTableSource {
    /// Makes the blade.
    pub(in crate::source) fn blade(&self, space: &StreamSpace) -> Result<Blade, Vec<Fault>> {
        let mut faults = self.check(space);
        let profile = sections::thickness(self.thickness_form).map_err(assembly::failed)?;
        let closing = read::closing(self.closing, [profile.tail(); 2], &mut faults);
        self.skin.check(false, &mut faults);
        if !faults.is_empty() {
            return Err(faults);
        }
        let sections = Sections::new(self, profile).map_err(assembly::failed)?;
        sections.check()?;
        let finish =
            Finish { skin: &self.skin, closing, suction: 0, nose: None, blamed: "rows", notes: Vec::new() };
        assembly::blade(&sections, finish, space)
    }

    fn check(&self, space: &StreamSpace) -> Vec<Fault> {
        let mut faults = Vec::new();
        if !matches!(space, StreamSpace::Annular(_)) {
            let message = "a propeller blade stands in an annular space, on a hub";
            faults.push(Fault::new("/kind", "space", message));
        }
        let mut within = |pointer: Pointer, value: f64, (min, max): (f64, f64), unit: &'static str| {
            if !(min..=max).contains(&value) {
                let message = format!("must lie between {min} and {max} {unit}, but is {value}");
                let fault = Fault::new(pointer, "out_of_range", message.trim_end());
                faults.push(fault.value(value).min(min).max(max).unit(unit));
            }
        };
        let root = Pointer::root();
        within(root.at("diameter"), self.diameter, (1.0, 1e5), "mm");
        within(root.at("x"), self.x, (-1e6, 1e6), "mm");
        within(root.at("phi_deg"), self.phi_deg, (-3600.0, 3600.0), "deg");
        let rows = root.at("rows");
        for (i, row) in self.rows.iter().enumerate() {
            let at = rows.at(i);
            within(at.at("radius_r"), row.radius_r, (0.01, 1.0), "");
            let least = if i + 1 == self.rows.len() { 0.0 } else { 1e-3 };
            within(at.at("chord_d"), row.chord_d, (least, 3.0), "");
            within(at.at("pitch_d"), row.pitch_d, (0.05, 10.0), "");
            within(at.at("skew_deg"), row.skew_deg, (-120.0, 120.0), "deg");
            within(at.at("rake_d"), row.rake_d, (-1.0, 1.0), "");
            within(at.at("camber_c"), row.camber_c, (-0.2, 0.2), "");
            within(at.at("thickness_c"), row.thickness_c, (1e-3, 0.5), "");
        }
        let count = self.rows.len();
        if !(4..=200).contains(&count) {
            let message = format!("{count} rows given, 4 to 200 needed");
            faults.push(Fault::new(rows, "row_count", message).value(count).min(4.0).max(200.0));
            return faults;
        }
        for (i, pair) in self.rows.windows(2).enumerate() {
            if !(pair[1].radius_r > pair[0].radius_r) {
                let message = format!("r/R must grow: {} follows {}", pair[1].radius_r, pair[0].radius_r);
                let at = rows.at(i + 1).at("radius_r");
                faults.push(Fault::new(at, "not_increasing", message).value(pair[1].radius_r));
            }
        }
        let tip = &self.rows[count - 1];
        if tip.radius_r != 1.0 || tip.chord_d != 0.0 {
            let message = "the last row is the tip: r/R = 1 with the chord 0";
            faults.push(Fault::new(rows.at(count - 1), "tip", message));
        }
        faults
    }
}
