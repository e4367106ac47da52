//! Radial holes keep clear of the outer surface, of each other and of the chambers; those that do not are refused.

use super::error::BuildError;
use super::probe::Probe;
use super::radial_holes::RadialHoleGeometry;
use coolinggen_blade::{Blade, Fault, StreamSurface};
use glam::{DVec2, DVec3};

/// The ring of a chamber or turn on one stream surface, as a polygon in its chart.
#[derive(Clone, Debug)]
pub(super) struct ChamberPolygon {
    /// What it belongs to, as messages say it.
    pub(super) part: String,
    pub(super) stream: StreamSurface,
    pub(super) points: Vec<DVec2>,
}

/// Checks all holes against everything.
pub(super) fn check(
    blade: &Blade,
    holes: &[RadialHoleGeometry],
    chambers: &[ChamberPolygon],
) -> Result<(), BuildError> {
    let mut faults = Vec::new();
    let probe = Probe::new(blade);
    for (k, hole) in holes.iter().enumerate() {
        let at = format!("/cooling/radial_holes/{k}");
        let (room, station) = room_to_surface(&probe, hole).map_err(|e| e.blamed_on(&at))?;
        if !(room > 0.0) {
            let diameter = hole.diameter(station);
            let message = format!(
                "radial hole \"{}\" leaves the blade by {:.3} mm at span fraction {station:.2}",
                hole.name, -room
            );
            let fault =
                Fault::new(format!("{at}/diameter"), "leaves_blade", message).value(diameter).unit("mm");
            let greatest = 2.0 * room_about_axis(&probe, hole).map_err(|e| e.blamed_on(&at))?;
            faults.push(if greatest > 0.0 {
                fault.max(greatest)
            } else {
                fault.hint("its axis lies outside")
            });
        }
        for other in &holes[..k] {
            let (gap, station) = gap_between(hole, other);
            if !(gap > 0.0) {
                let message = format!(
                    "radial holes \"{}\" and \"{}\" overlap by {:.3} mm at span fraction {station:.2}",
                    hole.name, other.name, -gap
                );
                faults.push(Fault::new(at.clone(), "holes_meet", message).value(gap).min(0.0).unit("mm"));
            }
        }
        let met = chambers.iter().filter_map(|c| Some((c, gap_to_chamber(hole, c)?)));
        if let Some((chamber, gap)) = met.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, gap)| !(*gap > 0.0))
        {
            let message = format!(
                "radial hole \"{}\" meets {} by {:.3} mm at span fraction {:.2}",
                hole.name,
                chamber.part,
                -gap,
                chamber.stream.v()
            );
            faults.push(Fault::new(at.clone(), "hole_meets_chamber", message).value(gap).min(0.0).unit("mm"));
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(BuildError::Refused(faults)) }
}

const AROUND: usize = 16;
const ALONG: usize = 9;

/// Least metal between the hole and the outer surface, and the fraction of the axis where it is.
fn room_to_surface(probe: &Probe<'_>, hole: &RadialHoleGeometry) -> Result<(f64, f64), BuildError> {
    let axis = (hole.tip - hole.hub).normalize();
    let e1 = axis.any_orthonormal_vector();
    let e2 = axis.cross(e1);
    let mut least = (f64::INFINITY, 0.0);
    for j in 0..ALONG {
        let station = j as f64 / (ALONG - 1) as f64;
        for i in 0..AROUND {
            let direction = DVec2::from_angle(std::f64::consts::TAU * i as f64 / AROUND as f64);
            let radial = (e1 * direction.x + e2 * direction.y) * (0.5 * hole.diameter(station));
            let thickness = probe.thickness(hole.hub.lerp(hole.tip, station) + radial)?;
            if thickness < least.0 {
                least = (thickness, station);
            }
        }
    }
    Ok(least)
}

/// Least distance from the axis to the outer surface: a hole of this radius fits.
fn room_about_axis(probe: &Probe<'_>, hole: &RadialHoleGeometry) -> Result<f64, BuildError> {
    let mut least = f64::INFINITY;
    for j in 0..=4 * ALONG {
        let station = j as f64 / (4 * ALONG) as f64;
        least = least.min(probe.thickness(hole.hub.lerp(hole.tip, station))?);
    }
    Ok(least)
}

/// Least metal between two holes, taken at equal fractions of their axes.
fn gap_between(a: &RadialHoleGeometry, b: &RadialHoleGeometry) -> (f64, f64) {
    let at = |station: f64| {
        let between = a.hub.lerp(a.tip, station).distance(b.hub.lerp(b.tip, station));
        (between - 0.5 * (a.diameter(station) + b.diameter(station)), station)
    };
    let gaps = (0..=40).map(|i| at(f64::from(i) / 40.0));
    gaps.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0.0))
}

/// Metal between a hole and a chamber's ring on its stream surface; nothing where the axis does not cross it.
fn gap_to_chamber(hole: &RadialHoleGeometry, chamber: &ChamberPolygon) -> Option<f64> {
    let (point, station) = crossing(hole, &chamber.stream)?;
    let q = chamber.stream.to_chart(point);
    let scale = chamber.stream.scale(q);
    let count = chamber.points.len();
    let mut inside = false;
    let mut nearest = f64::INFINITY;
    for i in 0..count {
        let (a, b) = (chamber.points[i], chamber.points[(i + 1) % count]);
        let d = b - a;
        let t = ((q - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
        nearest = nearest.min(q.distance(a + d * t));
        if (a.y > q.y) != (b.y > q.y) && q.x < a.x + (q.y - a.y) / d.y * d.x {
            inside = !inside;
        }
    }
    let distance = if inside { -nearest } else { nearest };
    Some(distance * scale - 0.5 * hole.diameter(station))
}

/// Where the axis crosses a stream surface, and at which fraction of its length.
fn crossing(hole: &RadialHoleGeometry, stream: &StreamSurface) -> Option<(DVec3, f64)> {
    let run = hole.tip - hole.hub;
    let mut station = stream.v();
    for _ in 0..30 {
        let point = hole.hub + run * station;
        let (level, gradient) = stream.level(point);
        let step = level / gradient.dot(run);
        if !step.is_finite() {
            return None;
        }
        station -= step;
        if step.abs() < 1e-9 {
            return Some((hole.hub + run * station, station));
        }
    }
    None
}
