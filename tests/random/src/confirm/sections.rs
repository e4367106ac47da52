//! What does not fit into a section: circles, fillets, slots; and sides that bend too tightly for a camber line.

use super::Confirmer;
use super::slice::Slice;
use glam::{DVec2, DVec3};
use serde_json::Value;

impl Confirmer {
    /// Whether the section has no room for a circle as great as the shell and the chamber's end ask for.
    pub(super) fn no_room(&self, v: f64, needed: f64) -> Option<Result<String, String>> {
        let slice = self.slices.near(v)?;
        let [s, p, _] = self.interior.shell_at(v);
        let greatest = slice.camber.iter().map(|c| c.radius * slice.scale).fold(0.0, f64::max);
        let asked = 0.5 * (s + p) + needed;
        let what = format!(
            "the greatest of {} circles has {greatest:.3} mm, {asked:.3} mm are asked for",
            slice.camber.len()
        );
        Some(if greatest < asked + 0.01 { Ok(what) } else { Err(what) })
    }

    /// Whether some point of the suction side is touched by no circle that touches the other side, too, because the side
    /// itself is in the way; likewise for the pressure side.
    pub(super) fn hump(&self, v: f64) -> Option<Result<String, String>> {
        let slice = self.slices.near(v)?;
        let mut worst = (1.0, 0.0, 0);
        for side in 0..2 {
            let points: Vec<DVec2> = slice.sides[side].iter().map(|p| p.at).collect();
            for circle in &slice.camber {
                let i = circle.touches[side];
                // Away from the edges, where no camber line is looked for.
                if i < points.len() / 10 || i > points.len() * 9 / 10 {
                    continue;
                }
                let normal = (circle.centre - points[i]).normalize();
                let own = (0..points.len()).filter(|j| j.abs_diff(i) > 2).map(|j| {
                    let d = points[j] - points[i];
                    let toward = d.dot(normal);
                    if toward > 1e-9 { d.length_squared() / (2.0 * toward) } else { f64::INFINITY }
                });
                let own = own.fold(f64::INFINITY, f64::min);
                if own / circle.radius < worst.0 {
                    worst = (own / circle.radius, own * slice.scale, side);
                }
            }
        }
        let (share, radius, side) = worst;
        let side = ["suction side", "pressure side"][side];
        Some(if share < 1.0 {
            Ok(format!(
                "a circle of {radius:.3} mm already touches the {side} twice, {share:.3} of the one across"
            ))
        } else {
            Err("every point of both sides is touched by a circle across".into())
        })
    }

    /// Whether the centres of fillets of this radius in chamber `k` do not form a quadrilateral: they keep `shell + radius`
    /// from the sides and `half + radius` from the walls, and each of these must bound them somewhere.
    pub(super) fn fillets_overlap(&self, v: f64, k: usize, radius: f64) -> Option<Result<String, String>> {
        const ACROSS: usize = 240;
        const NEAR: f64 = 0.04;
        let slice = self.slices.near(v)?;
        let shell = self.interior.shell_at(v);
        let walls: Vec<(usize, f64)> =
            [(k.checked_sub(1), 1.0), ((k < self.interior.walls.len()).then_some(k), -1.0)]
                .into_iter()
                .filter_map(|(wall, sign)| Some((wall?, sign)))
                .collect();
        // Room of a point, mm, to suction side, pressure side and the walls.
        let rooms = |q: DVec2| -> Vec<f64> {
            let [s, p, n] = slice.distances(q);
            let mut rooms = vec![s.min(n) - shell[0] - radius, p.min(n) - shell[1] - radius];
            rooms.extend(walls.iter().map(|(wall, sign)| {
                let (behind, half) = self.interior.behind(&slice, *wall, q);
                behind * sign - half - radius
            }));
            rooms
        };
        let (low, high) = self.about(&slice, &walls)?;
        let mut bound = vec![false; 2 + walls.len()];
        let mut any = 0;
        for i in 0..=ACROSS {
            for j in 0..=ACROSS {
                let part = DVec2::new(i as f64, j as f64) / ACROSS as f64;
                let rooms = rooms(low + (high - low) * part);
                if rooms.iter().any(|room| *room < 0.0) {
                    continue;
                }
                any += 1;
                let step = NEAR.max(2.0 * (high - low).max_element() * slice.scale / ACROSS as f64);
                rooms.iter().zip(&mut bound).for_each(|(room, bound)| *bound |= *room < step);
            }
        }
        let missing = bound.iter().filter(|b| !**b).count();
        let what = format!(
            "{any} of {} points bear a fillet's centre, {missing} of {} borders not reached",
            ACROSS * ACROSS,
            bound.len()
        );
        Some(if missing > 0 { Ok(what) } else { Err(what) })
    }

    /// A box of the chart about the part of a slice between walls.
    fn about(&self, slice: &Slice, walls: &[(usize, f64)]) -> Option<(DVec2, DVec2)> {
        let points = slice.sides.iter().flatten().map(|p| p.at).filter(|q| {
            walls.iter().all(|(wall, sign)| self.interior.behind(slice, *wall, *q).0 * sign > -1.0)
        });
        points.fold(None, |b: Option<(DVec2, DVec2)>, q| {
            Some(b.map_or((q, q), |(low, high)| (low.min(q), high.max(q))))
        })
    }

    /// The least metal beside a slot's axis in the sections at its ends and its middle, less half its width, mm.
    pub(super) fn beside_slot(&self, row: &Value, number: usize) -> Option<Result<String, String>> {
        let value = |name: &str| row[name].as_f64();
        let (count, width, height) = (value("count")?, value("width")?, value("height")?);
        let span = [row["span"][0].as_f64()?, row["span"][1].as_f64()?];
        let middle = span[0] + (span[1] - span[0]) * (number as f64 - 0.5) / count;
        let least = [-0.5, 0.0, 0.5].into_iter().filter_map(|part| {
            let (hub, tip) = (self.slices.near(0.0)?, self.slices.near(1.0)?);
            let at = |s: &Slice| -> DVec3 { s.surface.to_space(s.sides[0][0].at) };
            let v = middle + part * height / at(&hub).distance(at(&tip));
            self.beside_axis(v).map(|room| room - 0.5 * width)
        });
        let least = least.min_by(f64::total_cmp)?;
        let what = format!("{least:.3} mm of metal beside it in its sections");
        // A slot may be refused for a little less metal than the polygons show.
        Some(if least < 0.02 { Ok(what) } else { Err(what) })
    }

    /// Least distance, mm, from a slot's axis to the sides in a section.
    fn beside_axis(&self, v: f64) -> Option<f64> {
        let slice = self.slices.near(v)?;
        let [s, p, _] = self.interior.shell_at(v);
        let fillet = self.interior.chambers.last()?.2.at(v);
        let end = slice.camber.iter().rfind(|c| c.radius * slice.scale >= 0.5 * (s + p) + fillet)?;
        // Between unequal shells the arc stands nearer to the thinner one.
        let suction = (slice.sides[0][end.touches[0]].at - end.centre).normalize();
        let tail = end.centre + suction * (0.5 * (p - s) / slice.scale);
        let last = |side: usize| slice.sides[side].last().copied();
        let (a, b) = (last(0)?, last(1)?);
        // The middle of a round trailing edge, or of what is between the sides.
        let u = [0.5 * (a.u + b.u)];
        let edge = self.slices.blade.profile(&slice.surface, &u).ok()?[0].1;
        let length = tail.distance(edge);
        let behind = (fillet / slice.scale / length).min(0.9);
        // Near the edge the sides end: the metal there is what is left of half the edge.
        let steps = (0..=60).map(|i| behind + (0.98 - behind) * f64::from(i) / 60.0);
        let room = steps.map(|part| {
            let [s, p, _] = slice.distances(tail.lerp(edge, part));
            s.min(p)
        });
        room.min_by(f64::total_cmp)
    }
}
