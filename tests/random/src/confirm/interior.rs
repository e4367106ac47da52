//! Where the document says that metal and chambers are, point by point.

use super::slice::Slice;
use coolinggen_blade::{Law, LawSpec, Pointer};
use glam::DVec2;
use serde_json::Value;

/// A law of the document.
pub(super) fn law(value: &Value) -> Option<Law> {
    serde_json::from_value::<LawSpec>(value.clone()).ok()?.law(&Pointer::root()).ok()
}

pub(super) struct Wall {
    pub(super) name: String,
    position: Law,
    angle_deg: Law,
    thickness: Law,
}

/// Shell, walls and chambers.
pub(super) struct Interior {
    shell: [Law; 2],
    pub(super) walls: Vec<Wall>,
    /// Name, span if one is given, fillet radius.
    pub(super) chambers: Vec<(String, Option<[f64; 2]>, Law)>,
}

/// What a point belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    Shell,
    /// Metal of this wall.
    Wall(usize),
    /// This chamber, or metal beyond its span or in its fillets.
    Chamber(usize),
}

impl Interior {
    pub(super) fn of(cooling: &Value) -> Option<Self> {
        let shell = [law(&cooling["shell"]["suction_side"])?, law(&cooling["shell"]["pressure_side"])?];
        let list = |name: &str| cooling[name].as_array().cloned().unwrap_or_default();
        let wall = |w: &Value| {
            Some(Wall {
                name: w["name"].as_str()?.to_owned(),
                position: law(&w["position"])?,
                angle_deg: law(&w["angle_deg"])?,
                thickness: law(&w["thickness"])?,
            })
        };
        let chamber = |c: &Value| {
            let span = c["span"].as_array().and_then(|s| Some([s[0].as_f64()?, s[1].as_f64()?]));
            Some((c["name"].as_str()?.to_owned(), span, law(&c["fillet_radius"])?))
        };
        let walls = list("walls").iter().map(wall).collect::<Option<_>>()?;
        Some(Self { shell, walls, chambers: list("chambers").iter().map(chamber).collect::<Option<_>>()? })
    }

    /// The interior of a design without chambers.
    pub(super) fn none() -> Self {
        Self { shell: [Law::constant(0.0), Law::constant(0.0)], walls: Vec::new(), chambers: Vec::new() }
    }

    /// Thickness of the shell: suction side, pressure side, nose.
    pub(super) fn shell_at(&self, v: f64) -> [f64; 3] {
        let [s, p] = [0, 1].map(|k| self.shell[k].at(v));
        [s, p, s.min(p)]
    }

    /// Distance, mm, by which a point lies behind the mid plane of a wall, and half the wall's thickness.
    pub(super) fn behind(&self, slice: &Slice, wall: usize, q: DVec2) -> (f64, f64) {
        let (wall, v) = (&self.walls[wall], slice.surface.v());
        let (centre, tangent, circle) = slice.camber_at(wall.position.at(v));
        let suction = slice.sides[0][circle.touches[0]].at - centre;
        let turn = wall.angle_deg.at(v).to_radians() * tangent.perp_dot(suction).signum();
        let direction = DVec2::from_angle(turn).rotate(tangent);
        let across = direction.perp() * direction.perp().dot(tangent).signum();
        ((q - centre).dot(across) * slice.scale, 0.5 * wall.thickness.at(v))
    }

    /// How much farther from the sides a point lies than the shell is thick, mm.
    pub(super) fn depth(&self, slice: &Slice, q: DVec2) -> f64 {
        let (distances, shell) = (slice.distances(q), self.shell_at(slice.surface.v()));
        distances.iter().zip(&shell).map(|(d, t)| d - t).fold(f64::INFINITY, f64::min)
    }

    /// What a point within the profile belongs to.
    pub(super) fn place(&self, slice: &Slice, q: DVec2) -> Place {
        let (distances, shell) = (slice.distances(q), self.shell_at(slice.surface.v()));
        if distances.iter().zip(&shell).any(|(d, t)| d < t) {
            return Place::Shell;
        }
        let mut chamber = 0;
        for wall in 0..self.walls.len() {
            let (behind, half) = self.behind(slice, wall, q);
            if behind.abs() < half {
                return Place::Wall(wall);
            }
            chamber += usize::from(behind > 0.0);
        }
        Place::Chamber(chamber)
    }
}
