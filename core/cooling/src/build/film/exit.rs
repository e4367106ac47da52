//! Where a film hole breaks out.

use super::super::style;
use super::Blank;
use super::hole::Hole;
use coolinggen_blade::Fault;
use coolinggen_brep::{Face, FaceId, Loop, Model, SurfaceGeometry};
use coolinggen_nurbs::{ParametricCurve, ParametricSurface, Surface};
use glam::{DVec2, DVec3};

/// Refuses a breakout that reaches over hub or tip, where the outer faces end before their surface does.
pub(super) fn inside_blade(blank: &Blank<'_>, border: &Loop, hole: &Hole<'_>) -> Result<(), Fault> {
    for coedge in &border.coedges {
        let edge = blank.model.edge(coedge.edge);
        let (start, end) = edge.curve.domain();
        for t in [start, 0.5 * (start + end)] {
            let p = edge.curve.point(t);
            let room = blank.ends[0].level(p).0.min(-blank.ends[1].level(p).0);
            if !(room > 0.0) {
                let what = format!("breaks out {:.3} mm beyond hub or tip", -room);
                return Err(hole.fault("leaves_blade", what).value(room).min(0.0).unit("mm"));
            }
        }
    }
    Ok(())
}

/// The face that closes the coolant where a hole breaks out: a piece of the outer surface no larger than it must be.
pub(super) fn add_exit(model: &mut Model, name: String, parent: FaceId, border: Loop) -> FaceId {
    let surface = match &model.face(parent).surface {
        SurfaceGeometry::BSpline(surface) => {
            SurfaceGeometry::BSpline(window(surface, &border).unwrap_or_else(|| surface.clone()))
        }
        other => other.clone(),
    };
    model.add_face(Face { name, surface, loops: vec![border], style: style::outlet() })
}

/// The part of a surface that holds a loop, with a margin.
fn window(surface: &Surface<DVec3>, border: &Loop) -> Option<Surface<DVec3>> {
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for q in border.coedges.iter().flat_map(|c| c.pcurve.points()) {
        (low, high) = (low.min(*q), high.max(*q));
    }
    let margin = 0.1 * (high - low);
    let ((u0, u1), (v0, v1)) = surface.domain();
    let (low, high) = ((low - margin).max(DVec2::new(u0, v0)), (high + margin).min(DVec2::new(u1, v1)));
    surface.restricted_u(low.x, high.x).ok()?.restricted_v(low.y, high.y).ok()
}
