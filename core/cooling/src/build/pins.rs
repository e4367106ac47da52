//! Pins: round bores with the metal inside, from side to side of a chamber.

use super::blank::Blank;
use super::camber_net::{CamberLine, CamberNet, CamberPoint};
use super::chambers::{BACK, FRONT};
use super::error::BuildError;
use super::fit::{greatest, nearest};
use super::ligaments::Ligaments;
use super::stack::Stack;
use super::style;
use crate::bore::{BoreNames, BoreShape, Frame, Hull, Mouth, circle};
use crate::plan::{PinArrayPlan, Plan};
use coolinggen_blade::Fault;
use coolinggen_brep::{CastHit, Caster, FaceId};
use glam::DVec3;

/// A pin as built.
#[derive(Clone, Debug)]
pub struct PinGeometry {
    /// Name of its array.
    pub array: String,
    /// Row, from 1 at the front, and number in it, from 1 at the hub.
    pub place: [usize; 2],
    /// The chamber.
    pub chamber: String,
    /// Middle of the axis, mm.
    pub center: DVec3,
    /// Unit direction of the axis, from the pressure side to the suction side.
    pub axis: DVec3,
    /// Millimetres.
    pub diameter: f64,
    /// Length of the axis in the coolant, mm.
    pub length: f64,
    /// Passage to the nearest other pin, mm; none if that is far.
    pub gap: Option<f64>,
}

/// Which pin it is.
#[derive(Clone, Copy)]
struct Label<'p> {
    array: &'p PinArrayPlan,
    place: [usize; 2],
}

impl Label<'_> {
    fn text(self) -> String {
        format!("pin {} in row {} of array \"{}\"", self.place[1], self.place[0], self.array.name)
    }

    fn fault(self, field: &str, code: &'static str, what: impl std::fmt::Display) -> Fault {
        let at = format!("/cooling/pin_arrays/{}{field}", self.array.index);
        Fault::new(at, code, format!("{} {what}", self.text()))
    }
}

/// A pin to be made.
struct Pin<'p> {
    label: Label<'p>,
    at: CamberPoint,
    passage: usize,
    /// Where the axis meets the pressure side and the suction side.
    mouths: [Mouth; 2],
}

/// Makes all arrays.
pub(super) fn add_pin_arrays(
    blank: &mut Blank<'_>,
    stack: &Stack,
    plan: &Plan,
) -> Result<Vec<PinGeometry>, BuildError> {
    if plan.pin_arrays.is_empty() {
        return Ok(Vec::new());
    }
    let net = CamberNet::new(&stack.sections);
    let (mut planned, mut faults) = (Vec::new(), Vec::new());
    for array in &plan.pin_arrays {
        let (passage, chamber) = blank.chamber(&plan.chambers[array.chamber].name)?;
        if let Some(fault) = beyond_chamber(array, stack.spans.chambers[array.chamber]) {
            faults.push(fault);
            continue;
        }
        let caster = Caster::new(blank.model, chamber.faces.iter().copied());
        let (front, back) = (array.chamber > 0, array.chamber + 1 < plan.chambers.len());
        let walls = [(front, FRONT[1]), (back, BACK[1])].map(|(wall, k)| wall.then(|| chamber.faces[k]));
        let room = Room { blank, caster, passage, walls };
        for pin in pins(&net, &room, array)? {
            match pin {
                Ok(pin) => planned.push(pin),
                Err(fault) => faults.push(*fault),
            }
        }
    }
    let hulls = planned.iter().map(|pin| (pin.hull(), pin.label.text()));
    let near = |i: usize, what| planned[i].label.fault("", "ligament", what);
    let (gaps, near) = Ligaments::default().add(hulls, plan.least_ligament, near);
    faults.extend(near);
    if !faults.is_empty() {
        return Err(BuildError::Refused(faults));
    }
    let mut made = Vec::with_capacity(planned.len());
    for (pin, gap) in planned.iter().zip(gaps) {
        blank.watch.go_on()?;
        match pin.make(blank) {
            Ok(()) => made.push(pin.geometry(&plan.chambers[pin.label.array.chamber].name, gap)),
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok(made) } else { Err(BuildError::Refused(faults)) }
}

/// The fault of an array that reaches past its chamber's span.
fn beyond_chamber(array: &PinArrayPlan, [low, high]: [f64; 2]) -> Option<Fault> {
    let beyond = array.span.into_iter().find(|v| !(low..=high).contains(v))?;
    let message = format!("the chamber reaches from span fraction {low:.4} to {high:.4}");
    let fault = Fault::new(format!("/cooling/pin_arrays/{}/span", array.index), "beyond_chamber", message);
    Some(fault.value(beyond).min(low).max(high).unit("span fraction"))
}

/// Most pins of an array.
const MOST: f64 = 10_000.0;

/// The pins of an array, row by row, each from hub to tip.
fn pins<'p>(
    net: &CamberNet<'_>,
    room: &Room<'_>,
    array: &'p PinArrayPlan,
) -> Result<Vec<Result<Pin<'p>, Box<Fault>>>, BuildError> {
    /// Lengths this much short of a whole number of pitches are that number.
    const SHORT: f64 = 1e-9;
    let [spanwise, streamwise] = array.pitches;
    let rows = net.least_length(array.camber[0], array.camber[1], array.span) / streamwise;
    let count = (rows + 1.0) * (net.line(array.camber[0], 0.0)?.length(array.span) / spanwise + 1.0);
    if !(count < MOST + 1.0) {
        let message = format!("the array has about {count:.0} pins");
        let fault = Fault::new(format!("/cooling/pin_arrays/{}", array.index), "count", message);
        return Ok(vec![Err(Box::new(fault.value(count.floor()).max(MOST).unit("pins")))]);
    }
    let mut out = Vec::new();
    for row in 0..=(rows + SHORT) as usize {
        let line = net.line(array.camber[0], row as f64 * streamwise)?;
        let length = line.length(array.span);
        let most = (length / spanwise + SHORT).floor();
        let shift = if row % 2 == 1 { array.stagger } else { 0.0 };
        // The pins of even rows stand about the middle; those of odd rows are shifted against them.
        let start = 0.5 * (length - most * spanwise) + shift * spanwise;
        let places = (-1..=most as i64).map(|j| start + j as f64 * spanwise);
        let within = |x: &f64| *x >= -SHORT * spanwise && *x <= length + SHORT * spanwise;
        for (i, place) in places.filter(within).enumerate() {
            let label = Label { array, place: [row + 1, i + 1] };
            out.push(Pin::placed(room, label, &line, line.beyond(array.span[0], place)));
        }
    }
    Ok(out)
}

/// The chamber that pins stand in.
struct Room<'b> {
    blank: &'b Blank<'b>,
    /// Its own faces: what else a line from outside may meet first does not matter.
    caster: Caster,
    passage: usize,
    /// Faces that no pin may end on: there it would be a part of the wall.
    walls: [Option<FaceId>; 2],
}

impl Room<'_> {
    /// Where a line from a point of the chamber leaves it; none where it does so through a wall, or the point lies
    /// outside.
    fn side(&self, from: DVec3, direction: DVec3) -> Option<CastHit> {
        let hit = self.caster.first(from, direction, 0.0)?;
        let on_wall = self.walls.contains(&Some(hit.face));
        (!on_wall && self.blank.leaves(self.passage, &hit, direction)).then_some(hit)
    }

    /// Whether a pin of this diameter stands in the chamber all round.
    fn holds(&self, at: &CamberPoint, diameter: f64) -> bool {
        let frame = Frame::along(at.point, at.normal, at.up);
        let mut rim = circle(0.0, 0.5 * diameter).rim(24).into_iter().map(|q| frame.point(q, 0.0));
        rim.all(|p| self.side(p, at.normal).is_some() && self.side(p, -at.normal).is_some())
    }
}

impl<'p> Pin<'p> {
    fn placed(room: &Room<'_>, label: Label<'p>, line: &CamberLine, v: f64) -> Result<Self, Box<Fault>> {
        let at = line.at(v);
        let diameter = label.array.diameter;
        let ends = [room.side(at.point, -at.normal), room.side(at.point, at.normal)];
        if let ([Some(low), Some(high)], true) = (ends, room.holds(&at, diameter)) {
            let mouth = |hit: CastHit, z: f64| Mouth { face: hit.face, at: hit.at, z };
            let mouths = [mouth(low, -low.along), mouth(high, high.along)];
            return Ok(Self { label, at, passage: room.passage, mouths });
        }
        let what = format!("does not stand clear between the sides of its chamber at span fraction {v:.4}");
        if let Some(most) = greatest(diameter, |d| room.holds(&at, d)) {
            let fault = label.fault("", "leaves_chamber", what).value(diameter).max(most);
            return Err(Box::new(fault.unit("mm").hint("a pin of this diameter would")));
        }
        // Along its row a pin stands where the chamber is.
        let [low, high] = label.array.span;
        let fits = |v: f64| room.holds(&line.at(v), diameter);
        let fault = label.fault("/span", "leaves_chamber", what).value(v).unit("span fraction");
        let middle = 0.5 * (low + high);
        Err(Box::new(match nearest(middle, v, fits) {
            Some(last) if v < middle => fault.min(last),
            Some(last) => fault.max(last),
            None => Fault { pointer: fault.pointer.replace("/span", "/camber"), ..fault }
                .hint("its row lies outside the chamber"),
        }))
    }

    fn length(&self) -> f64 {
        self.mouths[1].z - self.mouths[0].z
    }

    fn hull(&self) -> Hull {
        let ends = [0, 1].map(|side| self.at.point + self.at.normal * self.mouths[side].z);
        Hull::inside(ends, 0.5 * self.label.array.diameter)
    }

    fn make(&self, blank: &mut Blank<'_>) -> Result<(), Fault> {
        let outline = circle(self.mouths[0].z, 0.5 * self.label.array.diameter);
        let frame = Frame::along(self.at.point, self.at.normal, self.at.up);
        let shape = BoreShape::straight(frame, outline, self.length());
        let [row, number] = self.label.place;
        let path = format!("pin/{}/{row:02}/{number:03}", self.label.array.name);
        let style = style::pin();
        let names = BoreNames { path: &path, stages: &["side"], style: &style };
        blank
            .pin(&shape, self.passage, self.mouths, &names)
            .map_err(|error| self.label.fault("", error.code(), error))
    }

    fn geometry(&self, chamber: &str, gap: Option<f64>) -> PinGeometry {
        PinGeometry {
            array: self.label.array.name.clone(),
            place: self.label.place,
            chamber: chamber.to_owned(),
            center: self.at.point + self.at.normal * (0.5 * (self.mouths[0].z + self.mouths[1].z)),
            axis: self.at.normal,
            diameter: self.label.array.diameter,
            length: self.length(),
            gap,
        }
    }
}
