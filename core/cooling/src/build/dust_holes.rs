//! Dust holes: round bores from a chamber's end, or from the turn there, through the tip.

use super::blank::Blank;
use super::chambers::{BACK, FRONT};
use super::error::BuildError;
use super::fit::greatest;
use super::passages::ring_at;
use super::solids::Caps;
use super::stack::Stack;
use super::style;
use crate::bore::{BoreNames, BoreShape, Frame, Hull, Mouth, circle};
use crate::plan::{DustHolePlan, Plan};
use coolinggen_blade::{Fault, StreamSurface};
use coolinggen_brep::{CastHit, Caster, FaceDomain, FaceId, FaceUse};
use coolinggen_nurbs::{NurbsError, ParametricCurve, line_meets_surface};
use glam::{DVec2, DVec3};

/// A dust hole as built.
#[derive(Clone, Debug)]
pub struct DustHoleGeometry {
    /// Name.
    pub name: String,
    /// The passage that it empties.
    pub passage: String,
    /// Where the axis breaks out, mm.
    pub exit: DVec3,
    /// Unit direction of the axis, out of the blade.
    pub axis: DVec3,
    /// Millimetres.
    pub diameter: f64,
    /// Length of the axis in the metal, mm.
    pub length: f64,
    /// Metal to the nearest border of the tip face, or to the nearest other bore, mm.
    pub ligament: f64,
    /// The face of the breakout.
    pub breakout: FaceId,
}

/// A dust hole to be drilled.
struct Dust<'p> {
    plan: &'p DustHolePlan,
    passage: usize,
    /// The face that ends the chamber; none where a turn does.
    cap: Option<FaceId>,
    frame: Frame,
    mouths: [Mouth; 2],
    /// Metal round the exit, mm.
    edge: f64,
}

/// Drills all dust holes.
pub(super) fn add_dust_holes(
    blank: &mut Blank<'_>,
    stack: &Stack,
    plan: &Plan,
    caps: &Caps,
) -> Result<Vec<DustHoleGeometry>, BuildError> {
    if plan.dust_holes.is_empty() {
        return Ok(Vec::new());
    }
    let tip = caps.tip().ok_or(NurbsError::NotFound { what: "the tip face" })?;
    let turns = blank.passages.iter().flat_map(|p| &p.parts).filter(|part| part.turn == Some(1));
    let faces: Vec<FaceId> = turns.flat_map(|part| part.faces.iter().copied()).collect();
    let caster = Caster::new(blank.model, faces);
    let (mut planned, mut faults) = (Vec::new(), Vec::new());
    for hole in &plan.dust_holes {
        let (passage, _) = blank.chamber(&plan.chambers[hole.chamber].name)?;
        match Dust::placed(blank, &caster, (stack, plan), (passage, caps), tip, hole) {
            Ok(hole) => planned.push(hole),
            Err(fault) => faults.push(*fault),
        }
    }
    let hulls = planned.iter().map(|hole| (hole.hull(), hole.plan.label()));
    let least = blank.least_ligament;
    let (ligaments, near) =
        blank.ligaments.add(hulls, least, |i, what| planned[i].plan.fault("ligament", what));
    faults.extend(near);
    if !faults.is_empty() {
        return Err(BuildError::Refused(faults));
    }
    let mut made = Vec::with_capacity(planned.len());
    for (hole, ligament) in planned.iter().zip(ligaments) {
        blank.watch.go_on()?;
        match hole.drill(blank, tip) {
            Ok(exit) => made.push(hole.geometry(blank, exit, ligament)),
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok(made) } else { Err(BuildError::Refused(faults)) }
}

impl DustHolePlan {
    fn label(&self) -> String {
        format!("dust hole \"{}\"", self.name)
    }

    fn fault(&self, code: &'static str, what: impl std::fmt::Display) -> Fault {
        let at = format!("/cooling/dust_holes/{}", self.index);
        Fault::new(at, code, format!("{} {what}", self.label()))
    }
}

/// The point of a chamber's camber line at its end at the tip where a hole begins, with the directions downstream and
/// towards the suction side.
fn start(stack: &Stack, plan: &Plan, hole: &DustHolePlan) -> Result<[DVec3; 3], Box<Fault>> {
    const STEPS: u32 = 400;
    let sections = stack.of_chamber(hole.chamber);
    let last = sections[sections.len() - 1];
    let (section, offset) = (&stack.sections[last], &stack.offsets[last]);
    let ring = ring_at(stack, plan, hole.chamber, last)?;
    // The camber line from the middle of the chamber's front to that of its back.
    let fraction = |segment: usize| {
        let middle = ring.segments[segment].evaluate(&offset.outline, 0.5).0;
        let all = (0..=STEPS).map(|i| f64::from(i) / f64::from(STEPS));
        let distance = |f: &f64| offset.camber.at(*f).center.distance_squared(middle);
        all.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0.0)
    };
    let (front, back) = (fraction(FRONT[1]), fraction(BACK[1]));
    let circle = offset.camber.at(front + (back - front) * hole.position);
    let (point, dm, dt) = section.stream.to_space_derivatives(circle.center);
    let vector = |q: DVec2| (dm * q.x + dt * q.y).normalize();
    let side = offset.outline.frame(circle.suction).point - circle.center;
    Ok([point, vector(circle.tangent), vector(side)])
}

/// Where a line meets a stream surface: the multiple of its direction.
fn meets(stream: &StreamSurface, origin: DVec3, direction: DVec3) -> Option<f64> {
    let mut along = 0.0;
    for _ in 0..40 {
        let (level, gradient) = stream.level(origin + direction * along);
        let step = level / gradient.dot(direction);
        if !step.is_finite() {
            return None;
        }
        along -= step;
        if step.abs() < 1e-9 {
            return Some(along);
        }
    }
    None
}

/// Whether a circle about the frame's axis meets a face inside its loops all round.
fn within(blank: &Blank<'_>, face: FaceId, frame: &Frame, mouth: &Mouth, radius: f64) -> bool {
    let face = blank.model.face(face);
    let domain = FaceDomain::new(face);
    circle(0.0, radius).rim(24).into_iter().all(|q| {
        let hint = (mouth.at.x, mouth.at.y);
        let hit = line_meets_surface(&face.surface, frame.point(q, 0.0), frame.axis, hint, mouth.z);
        hit.is_some_and(|hit| domain.contains(DVec2::new(hit.u, hit.v)))
    })
}

impl<'p> Dust<'p> {
    fn placed(
        blank: &Blank<'_>,
        caster: &Caster,
        (stack, plan): (&Stack, &Plan),
        (passage, caps): (usize, &Caps),
        tip: FaceUse,
        hole: &'p DustHolePlan,
    ) -> Result<Self, Box<Fault>> {
        let name = &plan.chambers[hole.chamber].name;
        let boxed = |code, what: String| Box::new(hole.fault(code, what));
        let [from, downstream, suction] = start(stack, plan, hole)?;
        let stream = &blank.ends[1];
        let up = stream.level(from).1;
        let [lean, azimuth] = [hole.inclination_deg, hole.azimuth_deg].map(f64::to_radians);
        let aside = downstream * azimuth.cos() + suction * azimuth.sin();
        let aside = (aside - up * aside.dot(up)).normalize();
        let axis = up * lean.cos() + aside * lean.sin();
        let leaves = || boxed("leaves_tip", "does not reach the tip along its axis".to_owned());
        let frame = Frame::along(from, axis, if lean > 0.0 { aside } else { downstream });
        // Where a line leaves the coolant through a turn of this passage.
        let turns_out = |hit: &CastHit| {
            blank.passages[passage].faces.contains(&hit.face) && blank.leaves(passage, hit, axis)
        };
        let (cap, inner) = if plan.turn_at(hole.chamber, 1).is_some() {
            let hit = caster.first(from, axis, 0.0).filter(turns_out).ok_or_else(|| {
                boxed("reaches_no_chamber", "does not meet the turn at its chamber's end".to_owned())
            })?;
            (None, Mouth { face: hit.face, at: hit.at, z: hit.along })
        } else {
            let own = caps.passages[passage].iter().find(|cap| cap.side == 1);
            let closed = own.filter(|cap| !cap.open).ok_or_else(|| {
                boxed("open_chamber", format!("leaves chamber \"{name}\", which is open at the tip"))
            })?;
            let face = closed.used.face;
            let last = stack.of_chamber(hole.chamber).last().copied().unwrap_or(0);
            (Some(face), Mouth { face, at: stack.sections[last].stream.parameters(from), z: 0.0 })
        };
        let along = meets(stream, from, axis).filter(|z| *z > inner.z).ok_or_else(leaves)?;
        let exit = from + axis * along;
        let outer = Mouth { face: tip.face, at: stream.parameters(exit), z: along };
        let fits = |diameter: f64| {
            let inside = match cap {
                Some(face) => within(blank, face, &frame, &inner, 0.5 * diameter),
                None => circle(inner.z, 0.5 * diameter).rim(16).into_iter().all(|q| {
                    let met = caster.first(frame.point(q, 0.0), axis, 0.0);
                    met.is_some_and(|hit| hit.along < along && turns_out(&hit))
                }),
            };
            inside && within(blank, tip.face, &frame, &outer, 0.5 * diameter)
        };
        if !fits(hole.diameter) {
            let what = format!("runs past the end of chamber \"{name}\" or over the border of the tip");
            let fault = hole.fault("leaves_tip", what).value(hole.diameter).unit("mm");
            return Err(Box::new(match greatest(hole.diameter, fits) {
                Some(most) => fault.max(most),
                None => fault.hint("another position, or less inclined"),
            }));
        }
        let mut hole = Self { plan: hole, passage, cap, frame, mouths: [inner, outer], edge: f64::INFINITY };
        hole.edge = hole.room_at_tip(blank, tip.face);
        if hole.edge < blank.least_ligament {
            let what = format!("leaves {:.3} mm to the border of the tip", hole.edge);
            let fault = hole.plan.fault("ligament", what).value(hole.edge).min(blank.least_ligament);
            return Err(Box::new(fault.unit("mm")));
        }
        Ok(hole)
    }

    /// Metal between the exit and the borders of the tip face, its openings' too.
    fn room_at_tip(&self, blank: &Blank<'_>, tip: FaceId) -> f64 {
        const STEPS: u32 = 200;
        let across = |p: DVec3| {
            let d = p - self.frame.origin;
            DVec2::new(d.dot(self.frame.x), d.dot(self.frame.y))
        };
        let mut least = f64::INFINITY;
        for coedge in blank.model.face(tip).loops.iter().flat_map(|border| &border.coedges) {
            let curve = &blank.model.edge(coedge.edge).curve;
            let (start, end) = curve.domain();
            let mut before = across(curve.point(start));
            for i in 1..=STEPS {
                let here = across(curve.point(start + (end - start) * f64::from(i) / f64::from(STEPS)));
                let way = here - before;
                let foot = before - way * (before.dot(way) / way.length_squared()).clamp(-1.0, 0.0);
                least = least.min(foot.length());
                before = here;
            }
        }
        least - 0.5 * self.plan.diameter
    }

    fn hull(&self) -> Hull {
        let ends = self.mouths.map(|mouth| self.frame.point(DVec2::ZERO, mouth.z));
        Hull::inside(ends, 0.5 * self.plan.diameter)
    }

    fn drill(&self, blank: &mut Blank<'_>, tip: FaceUse) -> Result<FaceId, Fault> {
        let [inner, outer] = &self.mouths;
        let length = outer.z - inner.z;
        let shape = BoreShape::straight(self.frame, circle(inner.z, 0.5 * self.plan.diameter), length);
        let path = format!("dust_hole/{}", self.plan.name);
        let style = style::dust_hole();
        let names = BoreNames { path: &path, stages: &["bore"], style: &style };
        blank
            .bore_tip(&shape, (self.passage, self.cap), tip, self.mouths, &names)
            .map_err(|error| self.plan.fault(error.code(), error))
    }

    fn geometry(&self, blank: &Blank<'_>, breakout: FaceId, ligament: Option<f64>) -> DustHoleGeometry {
        DustHoleGeometry {
            name: self.plan.name.clone(),
            passage: blank.passages[self.passage].name.clone(),
            exit: self.frame.point(DVec2::ZERO, self.mouths[1].z),
            axis: self.frame.axis,
            diameter: self.plan.diameter,
            length: self.mouths[1].z - self.mouths[0].z,
            ligament: ligament.map_or(self.edge, |ligament| ligament.min(self.edge)),
            breakout,
        }
    }
}
