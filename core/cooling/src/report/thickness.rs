//! Wall thickness: the distance in space from the passages to the outer surface.

use super::KeptMeasures;
use crate::build::{BuildError, CooledBlade, Probe};
use crate::watch::Watch;
use coolinggen_blade::Blade;
use coolinggen_brep::{Face, FaceId, Key, Numbered};
use coolinggen_nurbs::{ParametricCurve, ParametricSurface};
use glam::{DVec2, DVec3};
use serde::Serialize;

/// Thickness at one point of a passage.
#[derive(Clone, Debug, Serialize)]
pub struct ThinnestWall {
    /// Thickness, mm; negative where the passage has left the blade.
    pub min: f64,
    /// Where, on the passage's side, mm.
    pub at_mm: [f64; 3],
    /// Name of the passage's face.
    pub face: String,
}

/// The thinnest wall of every passage face, in the order of the faces, and of its closed ends: sampled on a grid, then
/// refined on the thinnest side face of all.
pub(super) fn thinnest_walls(
    blade: &Blade,
    cooled: &CooledBlade,
    kept: &mut KeptMeasures,
    numbered: &Numbered,
    watch: &dyn Watch,
) -> Result<Vec<ThinnestWall>, BuildError> {
    let probe = Probe::new(blade);
    let outer = kept.faces.number(Key::of((blade.surface.geometry(), blade.outward)));
    let key = |id: FaceId| {
        let (low, high) = range(cooled.model.face(id));
        Key::of((outer, numbered.of(id))).and((low, high))
    };
    let [coarsely, closely] = &mut kept.walls;
    let mut walls = Vec::new();
    let mut least: Option<(usize, FaceId, DVec2)> = None;
    for &id in &cooled.passage_faces {
        watch.go_on()?;
        let face = cooled.model.face(id);
        let (q, thickness) = coarsely.get(key(id), || coarse(&probe, face))?;
        if least.as_ref().is_none_or(|(k, ..)| thickness < at(&walls, *k)) {
            least = Some((walls.len(), id, q));
        }
        walls.push(wall(face, q, thickness));
    }
    for &(id, side) in &cooled.closed_ends {
        walls.push(end_wall(cooled, cooled.model.face(id), side));
    }
    for part in cooled.passages.iter().flat_map(|p| &p.parts) {
        let Some(side) = part.turn else { continue };
        walls.extend(part.faces.iter().map(|&id| turn_wall(cooled, cooled.model.face(id), side)));
    }
    if let Some((k, id, q)) = least {
        let face = cooled.model.face(id);
        let (q, thickness) = closely.get(key(id), || refined(&probe, face, q))?;
        walls[k] = wall(face, q, thickness);
    }
    Ok(walls)
}

/// Metal between a passage's closed end and the hub (0) or tip (1): both are nearly parallel, so that the face's border
/// tells.
fn end_wall(cooled: &CooledBlade, face: &Face, side: usize) -> ThinnestWall {
    const SAMPLES: u32 = 8;
    let mut thinnest = ThinnestWall { min: f64::INFINITY, at_mm: [0.0; 3], face: face.name.clone() };
    for coedge in face.loops.iter().flat_map(|l| &l.coedges) {
        for i in 0..SAMPLES {
            let q = coedge.parameter_at(f64::from(i) / f64::from(SAMPLES));
            let p = face.surface.point(q.x, q.y);
            let below = depth(cooled, p, side);
            if below < thinnest.min {
                thinnest = ThinnestWall { min: below, at_mm: p.to_array(), ..thinnest };
            }
        }
    }
    thinnest
}

/// Metal between a turn's face and the hub (0) or tip (1), on a grid.
fn turn_wall(cooled: &CooledBlade, face: &Face, side: usize) -> ThinnestWall {
    const STEPS: u32 = 12;
    let mut thinnest = ThinnestWall { min: f64::INFINITY, at_mm: [0.0; 3], face: face.name.clone() };
    for (i, j) in (0..=STEPS).flat_map(|i| (0..=STEPS).map(move |j| (i, j))) {
        let p = face.surface.point(f64::from(i) / f64::from(STEPS), f64::from(j) / f64::from(STEPS));
        let metal = depth(cooled, p, side);
        if metal < thinnest.min {
            thinnest = ThinnestWall { min: metal, at_mm: p.to_array(), ..thinnest };
        }
    }
    thinnest
}

/// Distance of a point above the hub (0) or below the tip (1).
fn depth(cooled: &CooledBlade, p: DVec3, side: usize) -> f64 {
    cooled.end_surfaces[side].level(p).0 * if side == 1 { -1.0 } else { 1.0 }
}

fn at(walls: &[ThinnestWall], k: usize) -> f64 {
    walls[k].min
}

fn wall(face: &Face, q: DVec2, min: f64) -> ThinnestWall {
    ThinnestWall { min, at_mm: face.surface.point(q.x, q.y).to_array(), face: face.name.clone() }
}

/// Range of a face's loops in its parameters, by the control points of the pcurves.
fn range(face: &Face) -> (DVec2, DVec2) {
    let mut low = DVec2::INFINITY;
    let mut high = DVec2::NEG_INFINITY;
    for coedge in face.loops.iter().flat_map(|l| &l.coedges) {
        let (start, end) = coedge.pcurve.domain();
        for i in 0..=8 {
            let q = coedge.pcurve.point(start + (end - start) * f64::from(i) / 8.0);
            low = low.min(q);
            high = high.max(q);
        }
    }
    (low, high)
}

fn coarse(probe: &Probe<'_>, face: &Face) -> Result<(DVec2, f64), BuildError> {
    let (low, high) = range(face);
    let spans = face.surface.breaks_u().len();
    let (across, along) = (if spans > 24 { 13 } else { 5 }, 9);
    let mut best = (low, f64::INFINITY);
    for i in 0..across {
        for j in 0..along {
            let f = DVec2::new(f64::from(i) / f64::from(across - 1), f64::from(j) / f64::from(along - 1));
            let q = low + (high - low) * f;
            let thickness = probe.thickness(face.surface.point(q.x, q.y))?;
            if thickness < best.1 {
                best = (q, thickness);
            }
        }
    }
    Ok(best)
}

/// Pattern search about `start`: steps to the better of eight neighbours, halved where there is none.
fn refined(probe: &Probe<'_>, face: &Face, start: DVec2) -> Result<(DVec2, f64), BuildError> {
    let (low, high) = range(face);
    let mut step = (high - low) * 0.08;
    let mut best = (start, probe.thickness(face.surface.point(start.x, start.y))?);
    for _ in 0..60 {
        let center = best.0;
        for direction in [
            (1.0, 0.0),
            (-1.0, 0.0),
            (0.0, 1.0),
            (0.0, -1.0),
            (1.0, 1.0),
            (1.0, -1.0),
            (-1.0, 1.0),
            (-1.0, -1.0),
        ] {
            let q = (center + step * DVec2::from(direction)).clamp(low, high);
            let thickness = probe.thickness(face.surface.point(q.x, q.y))?;
            if thickness < best.1 {
                best = (q, thickness);
            }
        }
        if best.0 == center {
            step *= 0.5;
            if step.max_element() < 1e-7 * (high - low).max_element() {
                break;
            }
        }
    }
    Ok(best)
}
