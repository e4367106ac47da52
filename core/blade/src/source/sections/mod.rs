//! Blades given by points of sections.

mod agree;
mod check;
mod points;
mod read;

use super::assemble;
use crate::blade::{Blade, Region};
use crate::fault::{Fault, Pointer};
use crate::loft::{Loft, LoftSection};
use crate::section::Outline;
use crate::stream::StreamSpace;
use read::Read;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sections from hub to tip, each a closed list of points or a pair of sides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SectionsSource {
    /// The sections, in the order of increasing `span` or `z`. One alone makes a prismatic blade (linear cascades
    /// only).
    pub sections: Vec<SectionSpec>,
    /// How far the blade may leave the points where that makes its curvature even, mm, 0 to 0.1: leading and trailing
    /// edges given by points of an arc become exact arcs, and noise of measured or rounded points is smoothed away
    /// where that pays. 0 passes through every point.
    #[serde(default = "default_tolerance")]
    #[schemars(extend("unit" = "mm", "minimum" = 0.0, "maximum" = 0.1))]
    pub tolerance: f64,
}

fn default_tolerance() -> f64 {
    0.002
}

/// One section. Points are `[m, r_theta]` on the stream surface of `span` (m: meridional arc length from the start of
/// the contour, r_theta: radius times angle), `[x, y]` in a linear cascade or with `z`; mm. Any start, direction and
/// order of points is understood.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SectionSpec {
    /// Span fraction of the stream surface the points lie on, -0.15 to 1.15.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "span fraction", "minimum" = -0.15, "maximum" = 1.15))]
    pub span: Option<f64>,
    /// Instead of `span`: z of the plane the points (x, y) lie in, mm. In an annulus the blade is then cut by the
    /// stream surfaces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("unit" = "mm"))]
    pub z: Option<f64>,
    /// Points around the whole section; the last may repeat the first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<Vec<[f64; 2]>>,
    /// Instead of `points`: points of the suction side, from either edge to the other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub suction_side: Option<Vec<[f64; 2]>>,
    /// Points of the pressure side, from either edge to the other; the ends may repeat those of the suction side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure_side: Option<Vec<[f64; 2]>>,
    /// Where the leading edge is: an index into `points`, or a point; found if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leading_edge: Option<Extreme>,
    /// Where the trailing edge is: an index into `points`, or a point; found if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trailing_edge: Option<Extreme>,
}

/// An end of a section.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Extreme {
    /// Index into `points`, from 0.
    Index(usize),
    /// A point near it, in the section's coordinates, mm.
    Point([f64; 2]),
}

impl SectionsSource {
    /// Makes the blade.
    ///
    /// # Errors
    /// Every fault found.
    pub(super) fn blade(&self, space: &StreamSpace) -> Result<Blade, Vec<Fault>> {
        let sheets = check::sheets(self, space)?;
        let read = read::all(self, space)?;
        let mut sections = Vec::new();
        for (k, (sheet, read)) in sheets.into_iter().zip(&read).enumerate() {
            let outline =
                Outline::new(&read.ring, &read.noses[0], &read.noses[1], self.tolerance).map_err(|e| {
                    vec![Fault::new(pointer(k), "no_curve", format!("no curve through the points: {e}"))]
                })?;
            let w = check::parameter(&sheet, &read.ring.points, space)
                .map_err(|e| vec![Fault::new(pointer(k), "outside_contours", e.to_string()).unit("mm")])?;
            sections.push(LoftSection { w, sheet, outline });
        }
        check::increasing(&sections)?;
        let regions: Vec<Region> = sections[0].outline.pieces.iter().map(|p| p.region).collect();
        let odd = sections.iter().position(|s| s.outline.pieces.len() != regions.len());
        if let Some(k) = odd {
            let message = "some sections have a sharp trailing edge, others have none";
            return Err(vec![Fault::new(pointer(k), "trailing_edge", message).hint("make all of one kind")]);
        }
        let (mut blade, loft) = assemble::lofted(&sections, space, &Pointer::root().at("sections"))?;
        blade.fit.notes.extend(read.iter().flat_map(|r| r.notes.iter().cloned()));
        self.measure(&mut blade, &loft, &read, &sections);
        Ok(blade)
    }

    /// Distances of the given points from the blade.
    fn measure(&self, blade: &mut Blade, loft: &Loft, read: &[Read], given: &[LoftSection]) {
        for (k, (section, read)) in given.iter().zip(read).enumerate() {
            for (i, (&point, &place)) in read.ring.points.iter().zip(&section.outline.places).enumerate() {
                let p = section.sheet.point(point);
                let Ok(found) = blade.closest(p, (loft.u(k, place), section.w)) else { continue };
                blade.fit.points += 1;
                if found.distance > blade.fit.greatest_distance_mm {
                    blade.fit.greatest_distance_mm = found.distance;
                    blade.fit.worst_point =
                        read::pointer_of(&self.sections[k], k, read.ring.origins[i]).into();
                }
            }
        }
    }
}

fn pointer(k: usize) -> Pointer {
    Pointer::root().at("sections").at(k)
}
