//! Film holes: rays of their rims, stepped through the metal.

use super::Confirmer;
use super::interior::{Place, law};
use coolinggen_nurbs::ParametricSurface;
use glam::DVec3;
use serde_json::Value;
use std::f64::consts::TAU;

/// Step along a ray, mm.
const STEP: f64 = 0.02;
/// Rays round a rim.
const AROUND: u32 = 24;

/// A hole's axis on the outer surface.
pub(super) struct Axis {
    pub(super) point: DVec3,
    pub(super) direction: DVec3,
    /// Unit vectors across the axis: towards downstream, and beside.
    across: [DVec3; 2],
    v: f64,
    /// Half the width and half the height of the rim at the chamber.
    half: [f64; 2],
    diameter: f64,
    inclination: f64,
}

impl Confirmer {
    /// The axes of a row, from hub to tip.
    pub(super) fn axes(&self, row: &Value) -> Option<Vec<Axis>> {
        let span = [row["span"][0].as_f64()?, row["span"][1].as_f64()?];
        let stagger = row["stagger"].as_f64().unwrap_or(0.0);
        let count = match row["count"].as_u64() {
            Some(count) => count as usize,
            None => {
                let at = |i: u32| self.on_surface(row, span[0] + (span[1] - span[0]) * f64::from(i) / 16.0);
                let points: Vec<DVec3> = (0..=16).map(|i| Some(at(i)?.0)).collect::<Option<_>>()?;
                let length: f64 = points.windows(2).map(|p| p[0].distance(p[1])).sum();
                (length / row["pitch"].as_f64()?).ceil() as usize
            }
        };
        let axis = |i: usize| {
            let v = span[0] + (span[1] - span[0]) * (i as f64 + 0.5 + stagger) / count as f64;
            let (point, normal, downstream) = self.on_surface(row, v)?;
            let number = |name: &str| Some(law(&row["hole"][name])?.at(v));
            let (alpha, beta) =
                (number("inclination_deg")?.to_radians(), number("compound_deg")?.to_radians());
            let towards_tip = self.slices.near(v + 0.02)?.surface.level(point).0 < 0.0;
            let up = normal.cross(downstream);
            let up = if (self.slices.near(v)?.surface.level(point + up).0 > 0.0) == towards_tip {
                up
            } else {
                -up
            };
            let along = downstream * beta.cos() + up * beta.sin();
            let direction = normal * alpha.sin() + along * alpha.cos();
            let x =
                (along - direction * along.dot(direction)).normalize_or(direction.any_orthonormal_vector());
            let across = [x, direction.cross(x)];
            let diameter = number("diameter")?;
            let wide = row["hole"]["shape"]["width_d"].as_f64().unwrap_or(1.0);
            let half = [0.5 * diameter, 0.5 * diameter * wide];
            Some(Axis { point, direction, across, v, half, diameter, inclination: alpha })
        };
        (0..count).map(axis).collect()
    }

    /// Point of a row's line on the outer surface, outward normal and direction downstream.
    fn on_surface(&self, row: &Value, v: f64) -> Option<(DVec3, DVec3, DVec3)> {
        let slice = self.slices.near(v)?;
        let side = usize::from(row["side"] == "pressure_side");
        let points = slice.side_with_nose(side);
        let ahead = points.len() - slice.sides[side].len();
        let index = match (row.get("camber_position"), row.get("surface_distance")) {
            (Some(place), _) => ahead + slice.camber_at(law(place)?.at(v)).2.touches[side],
            (None, Some(distance)) => {
                let wanted = law(distance)?.at(v) / slice.scale;
                let (mut run, mut k) = (0.0, 0);
                while run < wanted && k + 2 < points.len() {
                    run += points[k].at.distance(points[k + 1].at);
                    k += 1;
                }
                k
            }
            _ => return None,
        };
        let index = index.clamp(1, points.len() - 2);
        let p = points[index];
        let point = slice.surface.to_space(p.at);
        let along =
            slice.surface.to_space(points[index + 1].at) - slice.surface.to_space(points[index - 1].at);
        let (_, du, dw) = self.slices.blade.surface.first_derivatives(p.u, p.w);
        let normal = du.cross(dw).normalize();
        let touching = slice.camber.iter().min_by_key(|c| (ahead + c.touches[side]).abs_diff(index))?;
        let inside = slice.surface.to_space(touching.centre);
        let normal = if normal.dot(inside - point) > 0.0 { -normal } else { normal };
        let downstream = (along - normal * along.dot(normal)).normalize();
        Some((point, normal, downstream))
    }

    /// What a ray from the outer surface inwards runs through, each once, with the length in it, mm, up to the first chamber
    /// that it comes into by more than a graze.
    fn met(&self, from: DVec3, inwards: DVec3, v: f64) -> Vec<(Place, f64)> {
        /// Steps, and steps in a chamber that are no graze.
        const MOST: u32 = 500;
        const DEEP: f64 = 10.0 * STEP;
        let mut out: Vec<(Place, f64)> = Vec::new();
        for k in 1..=MOST {
            let point = from + inwards * (STEP * f64::from(k));
            let Some(slice) = self.slices.span_fraction(point, v).and_then(|v| self.slices.near(v)) else {
                break;
            };
            let q = slice.surface.to_chart(point);
            let place = self.interior.place(&slice, q);
            match out.last_mut() {
                Some((last, length)) if *last == place => *length += STEP,
                _ => out.push((place, STEP)),
            }
            if matches!(place, Place::Chamber(_)) && self.interior.depth(&slice, q) > DEEP {
                break;
            }
        }
        out
    }

    /// Whether rays of the rim and of the axis come through more than the shell, or come into different chambers.
    pub(super) fn hole_meets_wall(&self, row: &Value, number: usize) -> Option<Result<String, String>> {
        // Less than this is the polygons' error.
        const LEAST: f64 = 0.03;
        let axes = self.axes(row)?;
        let axis = axes.get(number.checked_sub(1)?)?;
        let mut chambers = Vec::new();
        let (mut most, mut grazes) = ((0.0, 0), false);
        let rim = (0..AROUND).map(|i| {
            let (s, c) = (TAU * f64::from(i) / f64::from(AROUND)).sin_cos();
            axis.point + axis.across[0] * (axis.half[0] * s) + axis.across[1] * (axis.half[1] * c)
        });
        for from in rim.chain([axis.point]) {
            // The rim's rays begin outside: the whole way through the wall counts.
            let met = self.met(from, -axis.direction, axis.v);
            // Metal behind a chamber, or a long way through a thin one, before the ray is well inside.
            grazes |= met.iter().rposition(|m| m.0 == Place::Shell)
                > met.iter().position(|m| matches!(m.0, Place::Chamber(_)));
            for (place, length) in met {
                match place {
                    Place::Wall(wall) if length > most.0 => most = (length, wall),
                    Place::Chamber(k) => chambers.push(k),
                    _ => {}
                }
            }
        }
        chambers.sort_unstable();
        chambers.dedup();
        Some(if most.0 > LEAST {
            Ok(format!(
                "a ray of its rim runs {:.2} mm through wall {}",
                most.0, self.interior.walls[most.1].name
            ))
        } else if chambers.len() != 1 {
            Ok(format!("its rim opens into {} chambers", chambers.len()))
        } else if grazes {
            Ok("a ray of its rim only grazes the inside of the shell".into())
        } else {
            Err("all rays of its rim come into one chamber through the shell alone".into())
        })
    }

    /// Whether the metering part is longer than the shell along the axis.
    pub(super) fn too_short(&self, row: &Value, number: usize) -> Option<Result<String, String>> {
        let axes = self.axes(row)?;
        let axis = axes.get(number.checked_sub(1)?)?;
        let length: f64 = (self.met(axis.point, -axis.direction, axis.v).iter())
            .take_while(|m| !matches!(m.0, Place::Chamber(_)))
            .map(|m| m.1)
            .sum();
        let metering = row["hole"]["shape"]["metering_length_d"].as_f64()? * axis.diameter;
        // The upstream edge of the exit lies a little below the axis' breakout.
        let slant = 0.5 * axis.diameter / axis.inclination.tan();
        let what = format!("{length:.2} mm of metal along its axis, {:.2} mm asked for", metering + slant);
        Some(if length - STEP < metering + slant + 0.05 { Ok(what) } else { Err(what) })
    }

    /// The least distance between a hole and the other holes of all rows, less their radii or half the widths of their
    /// exits, mm.
    pub(super) fn nearest_hole(&self, row: usize, number: usize) -> Option<f64> {
        let rows = self.cooling["film_rows"].as_array()?;
        let all: Vec<Vec<Axis>> = rows.iter().map(|r| self.axes(r).unwrap_or_default()).collect();
        let one = all.get(row)?.get(number.checked_sub(1)?)?;
        let length = |row: usize| {
            let side = usize::from(rows[row]["side"] == "pressure_side");
            self.interior.shell_at(0.5)[side] / one.inclination.sin()
        };
        let points = |axis: &Axis, row: usize| -> Vec<DVec3> {
            (0..=30).map(|i| axis.point - axis.direction * (length(row) * f64::from(i) / 30.0)).collect()
        };
        let own = points(one, row);
        let others =
            all.iter().enumerate().flat_map(|(r, axes)| axes.iter().enumerate().map(move |(i, a)| (r, i, a)));
        let gaps = others.filter(|(r, i, _)| (*r, *i + 1) != (row, number)).map(|(r, _, other)| {
            let theirs = points(other, r);
            let between = own.iter().flat_map(|p| theirs.iter().map(move |q| p.distance(*q)));
            let inside = between.fold(f64::INFINITY, f64::min) - 0.5 * (one.diameter + other.diameter);
            if r != row {
                return inside;
            }
            // Neighbours of a row lie side by side where they come out.
            let apart = (other.point - one.point).reject_from(one.direction).length();
            let metal = self.met(one.point, -one.direction, one.v).first().map_or(0.0, |m| m.1);
            let wide: Option<f64> = [one, other].map(|a| exit_half(&rows[r], a, metal)).into_iter().sum();
            wide.map_or(inside, |wide| inside.min(apart - wide))
        });
        gaps.min_by(f64::total_cmp)
    }
}

/// Half the width between the side walls of a shaped hole in the surface, mm, where it is greatest: where the rounded corners
/// of its far side begin. None for other shapes, and where the exit does not lie along its row.
fn exit_half(row: &Value, axis: &Axis, length: f64) -> Option<f64> {
    let (hole, shape) = (&row["hole"], &row["hole"]["shape"]);
    let angle = |name: &str| Some(shape[name].as_f64()?.to_radians().tan());
    let (lateral, forward) = (angle("lateral_expansion_deg")?, angle("forward_expansion_deg")?);
    let metering = shape["metering_length_d"].as_f64()? * axis.diameter;
    let corner = shape["corner_radius_d"].as_f64()? * axis.diameter;
    if hole["compound_deg"].as_f64()? != 0.0 {
        return None;
    }
    // The far wall lies half + (s - metering) forward below the axis, the surface (s - length) tan(inclination).
    let (half, steep) = (0.5 * axis.diameter, axis.inclination.tan());
    let s = (half - corner - metering * forward + length * steep) / (steep - forward);
    Some(half + (s - metering).max(0.0) * lateral)
}
