//! Passages: centre line, flow area, perimeter and hydraulic diameter along each chain of chambers and turns.

use crate::build::{BuildError, PassagePart, PassageParts};
use coolinggen_brep::{FaceId, Key, Model, Numbered, SurfaceGeometry};
use coolinggen_nurbs::{Interpolator, ParametricCurve, ParametricSurface};
use glam::DVec3;
use serde::Serialize;

/// A passage from where the coolant enters to its other end.
#[derive(Clone, Debug, Serialize)]
pub struct PassageReport {
    /// Name: its first chamber's.
    pub name: String,
    /// Length of the centre line.
    pub length_mm: f64,
    /// Chambers and turns in order.
    pub parts: Vec<PartReport>,
    /// Places along it, the ends included; where parts meet there is one.
    pub stations: Vec<StationReport>,
}

/// A chamber or a turn of a passage.
#[derive(Clone, Debug, Serialize)]
pub struct PartReport {
    /// Path of its faces, e.g. `chamber/leading`.
    pub name: String,
    /// Lengths of the centre line where it begins and ends.
    pub from_to_mm: [f64; 2],
}

/// A place along a passage.
#[derive(Clone, Debug, Serialize)]
pub struct StationReport {
    /// Length of the centre line from the start.
    pub length_mm: f64,
    /// Point of the centre line: the centroid of the flow area.
    pub at_mm: [f64; 3],
    /// Flow area: the ring's vector area along the centre line.
    pub area_mm2: f64,
    /// Wetted perimeter.
    pub perimeter_mm: f64,
    /// Four times the area over the perimeter.
    pub hydraulic_diameter_mm: f64,
}

/// Intervals of a chamber and of a turn.
const CHAMBER_STEPS: u32 = 8;
const TURN_STEPS: u32 = 16;

/// Everything that the table of a passage depends on.
pub(super) fn key(passage: &PassageParts, numbered: &Numbered) -> Key {
    passage.parts.iter().fold(Key::of(&*passage.name), |key, part| {
        let numbers = |faces: &[FaceId]| faces.iter().map(|&face| numbered.of(face)).collect::<Vec<_>>();
        let key = key.and((&*part.path, part.turn, part.reversed));
        key.and((&*numbers(&part.faces), &*numbers(&part.inserted)))
    })
}

/// The table of one passage.
pub(super) fn passage(model: &Model, name: &str, parts: &[PassagePart]) -> Result<PassageReport, BuildError> {
    let mut rings = Vec::new();
    let mut borders = vec![0];
    for part in parts {
        let steps = if part.turn.is_some() { TURN_STEPS } else { CHAMBER_STEPS };
        let (_, (low, high)) = model.face(part.faces[0]).surface.domain();
        // Where parts meet their rings are one.
        for i in u32::from(!rings.is_empty())..=steps {
            let fraction = f64::from(i) / f64::from(steps);
            let fraction = if part.reversed { 1.0 - fraction } else { fraction };
            rings.push(Ring::of_part(model, part, low + (high - low) * fraction));
        }
        borders.push(rings.len() - 1);
    }
    let mut lengths = vec![0.0];
    for pair in rings.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + pair[0].center.distance(pair[1].center));
    }
    let centers: Vec<DVec3> = rings.iter().map(|r| r.center).collect();
    let line = Interpolator::new(3, &lengths)?.curve(&centers)?;
    let stations: Vec<StationReport> = rings
        .iter()
        .zip(&lengths)
        .map(|(ring, &length)| {
            let tangent = line.derivatives(length)[1].normalize();
            let area = ring.area.dot(tangent).abs();
            StationReport {
                length_mm: length,
                at_mm: ring.center.to_array(),
                area_mm2: area,
                perimeter_mm: ring.perimeter,
                hydraulic_diameter_mm: 4.0 * area / ring.perimeter,
            }
        })
        .collect();
    let parts = parts.iter().zip(borders.windows(2)).map(|(part, at)| PartReport {
        name: part.path.clone(),
        from_to_mm: [lengths[at[0]], lengths[at[1]]],
    });
    let length_mm = lengths[lengths.len() - 1];
    Ok(PassageReport { name: name.to_owned(), length_mm, parts: parts.collect(), stations })
}

/// A ring of the passage's faces.
struct Ring {
    /// Vector area.
    area: DVec3,
    perimeter: f64,
    center: DVec3,
}

/// Nodes and weights of Gauss' rule on [0, 1], exact for the vector area of cubics.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

impl Ring {
    /// The ring of a part at the parameter `v`, less that of an insert that stands there.
    fn of_part(model: &Model, part: &PassagePart, v: f64) -> Self {
        let whole = Self::of(model, &part.faces, v);
        let stands = part.inserted.first().is_some_and(|&face| {
            let (_, (low, high)) = model.face(face).surface.domain();
            (low..=high).contains(&v)
        });
        if !stands {
            return whole;
        }
        let insert = Self::of(model, &part.inserted, v);
        let area = whole.area - insert.area;
        let share = insert.area.length() / area.length();
        Self {
            area,
            perimeter: whole.perimeter + insert.perimeter,
            center: whole.center + (whole.center - insert.center) * share,
        }
    }

    /// The ring of faces at the parameter `v`, by Gauss' rule span by span.
    fn of(model: &Model, faces: &[FaceId], v: f64) -> Self {
        let origin = model.face(faces[0]).surface.point(0.0, v);
        let mut samples = Vec::new();
        for &id in faces {
            let surface = &model.face(id).surface;
            let line = match surface {
                SurfaceGeometry::BSpline(s) => Some(s.iso_v(v)),
                _ => None,
            };
            for span in surface.breaks_u().windows(2) {
                for (x, weight) in GAUSS {
                    let length = span[1] - span[0];
                    let u = span[0] + length * x;
                    let [point, along] = match &line {
                        Some(line) => line.first_derivatives(u),
                        None => {
                            let (point, along, _) = surface.first_derivatives(u, v);
                            [point, along]
                        }
                    };
                    samples.push((point - origin, along * (weight * length)));
                }
            }
        }
        let area = 0.5 * samples.iter().map(|(p, d)| p.cross(*d)).sum::<DVec3>();
        let normal = area.normalize();
        // Centroid of the triangles between the origin and the ring.
        let moment: DVec3 = samples.iter().map(|(p, d)| *p * (0.5 * p.cross(*d).dot(normal))).sum();
        let center = origin + moment * (2.0 / 3.0 / area.length());
        Self { area, perimeter: samples.iter().map(|(_, d)| d.length()).sum(), center }
    }
}
