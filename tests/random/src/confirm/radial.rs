//! Radial holes: straight axes from hub to tip, against polygons and against each other.

use super::Confirmer;
use super::interior::law;
use glam::{DVec2, DVec3};

/// Sections that an axis is followed through.
const SECTIONS: u32 = 40;

impl Confirmer {
    /// Whether a hole comes out of the blade or into another hole.
    pub(super) fn radial_hole(&self, index: usize) -> Option<Result<String, String>> {
        let holes = self.cooling["radial_holes"].as_array()?;
        let radius = |k: usize, v: f64| Some(0.5 * law(&holes[k]["diameter"])?.at(v));
        let mut least = (f64::INFINITY, "the outer surface".to_owned());
        for i in 0..=SECTIONS {
            let v = f64::from(i) / f64::from(SECTIONS);
            let (point, own) = (self.on_axis(index, v)?, radius(index, v)?);
            let slice = self.slices.near(self.slices.span_fraction(point, v)?)?;
            let q = slice.surface.to_chart(point);
            let distance = slice.distances(q).into_iter().fold(f64::INFINITY, f64::min);
            let inside = within(q, slice.sides[0].iter().rev().chain(&slice.sides[1]).map(|p| p.at));
            let room = if inside { distance } else { -distance } - own;
            if room < least.0 {
                least = (room, "the outer surface".into());
            }
            for other in (0..holes.len()).filter(|k| *k != index) {
                let room = point.distance(self.on_axis(other, v)?) - own - radius(other, v)?;
                if room < least.0 {
                    least = (room, format!("radial hole {other}"));
                }
            }
        }
        let what = format!("{:.3} mm to {}", least.0, least.1);
        Some(if least.0 < 0.01 { Ok(what) } else { Err(what) })
    }

    /// A point of a hole's axis, between its places at hub and tip.
    fn on_axis(&self, hole: usize, v: f64) -> Option<DVec3> {
        let place = &self.cooling["radial_holes"][hole]["at"]["position"];
        let end = |v: f64| {
            let slice = self.slices.near(v)?;
            Some(slice.surface.to_space(slice.camber_at(law(place)?.at(v)).0))
        };
        Some(end(0.0)?.lerp(end(1.0)?, v))
    }
}

/// Whether a point lies within a polygon.
fn within(q: DVec2, points: impl Iterator<Item = DVec2> + Clone) -> bool {
    let next = points.clone().cycle().skip(1);
    points
        .zip(next)
        .filter(|(a, b)| (a.y > q.y) != (b.y > q.y) && q.x < a.x + (q.y - a.y) / (b.y - a.y) * (b.x - a.x))
        .count()
        % 2
        == 1
}
