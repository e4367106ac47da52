//! Caps and solids: the metal, the inserts, and a coolant solid for all passages that bores join.

use super::cap::{Ring, add_cap, points_up};
use super::error::BuildError;
use super::inlet::{Duct, upward};
use super::inserts::Insert;
use super::passages::{Host, Link, Passage};
use super::style;
use coolinggen_blade::{StreamSpace, StreamSurface};
use coolinggen_brep::{FaceId, FaceUse, Model, Shell, Solid};
use coolinggen_nurbs::NurbsError;
use glam::DVec3;

/// The face that ends a passage.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cap {
    /// As the coolant uses it.
    pub(super) used: FaceUse,
    /// Whether the passage is open there: the metal does not have the face.
    pub(super) open: bool,
    /// Side of the span: 0 the hub's, 1 the tip's.
    pub(super) side: usize,
    /// Whether it ends the metal, and not an insert.
    in_metal: bool,
}

/// The faces that end an insert, as the insert uses them.
pub(super) struct InsertCaps {
    /// At the open end, between the tubes outside and inside.
    rim: FaceUse,
    /// The outer face of the plate at the closed end.
    plate: FaceUse,
}

/// The faces that end the passages and the blade.
pub(super) struct Caps {
    /// Of every passage.
    pub(super) passages: Vec<[Cap; 2]>,
    /// Walls of the inlets' extensions, a list a passage.
    extensions: Vec<Vec<FaceUse>>,
    /// Of every insert.
    inserts: Vec<InsertCaps>,
    /// Hub and tip face as the metal uses them; the hub's alone where the blade ends in a point.
    pub(super) ends: Vec<FaceUse>,
}

impl Caps {
    /// The tip face.
    pub(super) fn tip(&self) -> Option<FaceUse> {
        self.ends.get(1).copied()
    }

    /// Faces of the metal that end a passage below the tip (1) or above the hub (0).
    pub(super) fn closed(&self) -> Vec<(FaceId, usize)> {
        let caps = self.passages.iter().flatten().filter(|cap| !cap.open && cap.in_metal);
        caps.map(|cap| (cap.used.face, cap.side)).collect()
    }
}

/// Adds the faces that end the passages, and hub and tip with their openings; `rings` are the outer surface's ends. Inlets
/// at the hub go on for `inlet_extension` mm.
pub(super) fn add_caps(
    model: &mut Model,
    space: &StreamSpace,
    ends: &[StreamSurface; 2],
    rings: &[Ring; 2],
    passages: &[Passage],
    inserts: &[Insert],
    inlet_extension: Option<f64>,
) -> Result<Caps, BuildError> {
    let mut openings: [Vec<Ring>; 2] = [Vec::new(), Vec::new()];
    let mut caps = Vec::with_capacity(passages.len());
    let mut extensions = vec![Vec::new(); passages.len()];
    let down = match inlet_extension {
        Some(length) => direction(model, &ends[0], passages, inserts)?.map(|up| (up, length)),
        None => None,
    };
    for (passage, extension) in passages.iter().zip(&mut extensions) {
        let mut own = Vec::with_capacity(2);
        for (i, end) in passage.ends.iter().enumerate() {
            let (open, side) = (end.is_open(), end.side);
            let middle;
            let stream = if open {
                &ends[side]
            } else {
                middle = space.surface(end.v)?;
                &middle
            };
            let (name, style) = match (open, passage.enters(i), side) {
                (true, true, _) => (format!("coolant/inlet/{}", end.name), style::inlet()),
                (true, false, _) => (format!("coolant/outlet/{}", end.name), style::outlet()),
                (false, _, 0) => (format!("{}/hub_end", end.path), end.style.clone()),
                (false, _, _) => (format!("{}/tip_end", end.path), end.style.clone()),
            };
            let in_metal = passage.host == Host::Metal;
            let used = match down {
                Some((up, length)) if passage.enters_at_hub(i) => {
                    let ring = seat(passages, inserts, passage).unwrap_or(&end.ring);
                    let duct = Duct::new(model, &name, ring, up, length)?;
                    let mut faces = duct.extend(model, &name, &end.ring, end.inserted.as_ref())?;
                    let closing = faces.pop();
                    *extension = faces;
                    closing
                        .ok_or(NurbsError::NotFound { what: "the face that closes an inlet's extension" })?
                }
                _ => {
                    let face = add_cap(model, name, style, stream, &end.ring, end.inserted.as_slice())?;
                    FaceUse { face, forward: points_up(model, face, stream) == (side == 1) }
                }
            };
            if open && in_metal {
                openings[side].push(end.ring.clone());
            }
            own.push(Cap { used, open, side, in_metal });
        }
        caps.push([own[0], own[1]]);
    }
    let mut insert_caps = Vec::with_capacity(inserts.len());
    for insert in inserts {
        if let Some(seat) = &insert.seat {
            openings[insert.open].push(seat.rings[insert.open].clone());
        }
        insert_caps.push(add_insert_caps(model, space, ends, insert)?);
    }
    let mut end_faces = Vec::with_capacity(2);
    for (side, name) in [(0, "blade/hub"), (1, "blade/tip")] {
        if rings[side].edges.is_empty() {
            continue;
        }
        let stream = &ends[side];
        let face = add_cap(model, name.to_owned(), style::end(), stream, &rings[side], &openings[side])?;
        let forward = points_up(model, face, stream) == (side == 1);
        end_faces.push(FaceUse { face, forward });
    }
    Ok(Caps { passages: caps, extensions, inserts: insert_caps, ends: end_faces })
}

/// The direction against which inlets at the hub go on; none where there is no such inlet.
fn direction(
    model: &Model,
    hub: &StreamSurface,
    passages: &[Passage],
    inserts: &[Insert],
) -> Result<Option<DVec3>, BuildError> {
    let inlets = passages.iter().flat_map(|passage| {
        let own = (0..2).filter(|&i| passage.enters_at_hub(i)).map(|i| &passage.ends[i]);
        own.map(|end| (end.name.as_str(), seat(passages, inserts, passage).unwrap_or(&end.ring)))
    });
    upward(model, hub, inlets)
}

/// The opening of the chamber in which a plenum's insert stands.
fn seat<'a>(passages: &'a [Passage], inserts: &'a [Insert], plenum: &Passage) -> Option<&'a Ring> {
    let Host::Insert(index) = plenum.host else { return None };
    let insert = &inserts[index];
    let around = &passages[insert.passages[0]];
    let gap = around.ends.iter().find(|end| end.is_open() && end.inserted.is_some());
    let seat = insert.seat.as_ref().map(|seat| &seat.rings[insert.open]);
    seat.or_else(|| gap.map(|end| &end.ring))
}

fn add_insert_caps(
    model: &mut Model,
    space: &StreamSpace,
    ends: &[StreamSurface; 2],
    insert: &Insert,
) -> Result<InsertCaps, BuildError> {
    let [outside, inside] = &insert.tubes;
    let (open, closed) = (insert.open, 1 - insert.open);
    let mut cap = |part: &str, stream: &StreamSurface, ring: &Ring, inner: &[Ring], side: usize| {
        let name = format!("insert/{}/{part}", insert.name);
        let face = add_cap(model, name, style::insert(), stream, ring, inner)?;
        Ok::<_, BuildError>(FaceUse { face, forward: points_up(model, face, stream) == (side == 1) })
    };
    let outer = insert.seat.as_ref().unwrap_or(outside);
    let rim = cap("rim", &ends[open], &outer.rings[open], &inside.rings[open..=open], open)?;
    let plate = cap("plate", &space.surface(insert.plate_v)?, &outside.rings[closed], &[], closed)?;
    Ok(InsertCaps { rim, plate })
}

/// A body of coolant: passages that links join.
#[derive(Default)]
struct Body {
    passages: Vec<usize>,
    links: Vec<usize>,
}

/// The bodies of coolant, in the order of their first passages: union-find over the links.
fn bodies(count: usize, links: &[Link]) -> Vec<Body> {
    let mut parent: Vec<usize> = (0..count).collect();
    let root = |parent: &[usize], mut k: usize| {
        while parent[k] != k {
            k = parent[k];
        }
        k
    };
    for link in links {
        let [a, b] = link.passages.map(|k| root(&parent, k));
        // The first passage stays the root.
        parent[a.max(b)] = a.min(b);
    }
    let mut bodies: Vec<Body> = (0..count).map(|_| Body::default()).collect();
    for k in 0..count {
        bodies[root(&parent, k)].passages.push(k);
    }
    for (i, link) in links.iter().enumerate() {
        bodies[root(&parent, link.passages[0])].links.push(i);
    }
    bodies.retain(|body| !body.passages.is_empty());
    bodies
}

/// What solids are made of.
pub(super) struct SolidParts<'a> {
    /// Whether the outer faces' natural normals point out of the blade.
    pub(super) outward: bool,
    pub(super) outer: &'a [FaceId],
    pub(super) passages: &'a [Passage],
    pub(super) inserts: &'a [Insert],
    pub(super) links: &'a [Link],
    pub(super) caps: &'a Caps,
}

/// Adds the solids: `metal`, `insert/<chamber>` for every insert, and `coolant/<passage>` for every passage,
/// `coolant/<passage>+<passage>` for those that bores join; plenums that jets empty give no name.
pub(super) fn add_solids(model: &mut Model, parts: &SolidParts<'_>) {
    let mut metal = Shell::default();
    metal.faces.extend(parts.outer.iter().map(|&face| FaceUse { face, forward: parts.outward }));
    let mut inserts: Vec<Shell> = parts.inserts.iter().zip(&parts.caps.inserts).map(bare_insert).collect();
    let (mut voids, mut coolants) = (Vec::new(), Vec::new());
    let mut through = 0;
    for body in bodies(parts.passages.len(), parts.links) {
        let wet = parts.wet(&body);
        for (insert, faces) in inserts.iter_mut().zip(&wet.inserts) {
            insert.faces.extend(faces.reversed().faces);
        }
        let mut dry = wet.metal.reversed();
        let mut opened = wet.opened;
        for insert in parts.inserts.iter().filter(|i| body.passages.contains(&i.passages[0])) {
            let seat = insert.seat.iter().flat_map(|tube| &tube.faces);
            dry.faces.extend(seat.map(|&face| FaceUse { face, forward: !insert.outward }));
            opened += usize::from(insert.seat.is_some());
        }
        if opened > 0 {
            metal.faces.extend(dry.faces);
        } else if !dry.faces.is_empty() {
            voids.push(dry);
        }
        // The first opening makes a pocket of the coolant, every other one a handle of the metal; so does every handle
        // of the coolant that goes round metal.
        through += wet.handles_in_metal + opened.saturating_sub(1);
        let mut coolant = wet.metal;
        coolant.faces.extend(wet.inserts.into_iter().flat_map(|shell| shell.faces));
        coolant.faces.extend(wet.openings);
        coolants.push(Solid {
            name: format!("coolant/{}", parts.body_name(&body)),
            shells: vec![coolant],
            expected_genus: wet.handles,
        });
    }
    metal.faces.extend(&parts.caps.ends);
    let mut shells = vec![metal];
    shells.extend(voids);
    model.solids.push(Solid { name: "metal".into(), shells, expected_genus: through });
    for (i, (insert, shell)) in parts.inserts.iter().zip(inserts).enumerate() {
        // A closed tube has no handle; every jet makes one.
        let jets = parts.links.iter().filter(|link| link.host == Host::Insert(i)).count();
        let name = format!("insert/{}", insert.name);
        model.solids.push(Solid { name, shells: vec![shell], expected_genus: jets });
    }
    model.solids.extend(coolants);
}

/// The faces of an insert that no coolant touches.
fn bare_insert((insert, caps): (&Insert, &InsertCaps)) -> Shell {
    let seat = insert.seat.iter().flat_map(|tube| &tube.faces);
    let seat = seat.map(|&face| FaceUse { face, forward: insert.outward });
    Shell { faces: seat.chain([caps.rim]).collect() }
}

/// The faces of a body of coolant, as it uses them.
struct Wet {
    /// Towards the metal.
    metal: Shell,
    /// Towards each insert.
    inserts: Vec<Shell>,
    /// Where coolant enters and leaves.
    openings: Vec<FaceUse>,
    /// Number of places at which it leaves the metal.
    opened: usize,
    /// Handles of the body.
    handles: usize,
    /// Of these, the ones that go round metal.
    handles_in_metal: usize,
}

impl SolidParts<'_> {
    fn wet(&self, body: &Body) -> Wet {
        let used = |faces: &[(FaceId, bool)]| -> Vec<FaceUse> {
            faces.iter().map(|&(face, forward)| FaceUse { face, forward }).collect()
        };
        let in_metal = |host: Host| host == Host::Metal;
        let passages = || body.passages.iter().map(|&k| &self.passages[k]);
        let links = || body.links.iter().map(|&i| &self.links[i]);
        let pins: usize = passages().map(|p| p.pins.len()).sum();
        let trees = [passages().count(), passages().filter(|p| in_metal(p.host)).count()];
        let joints = [links().count(), links().filter(|l| in_metal(l.host)).count()];
        // A graph of passages has one handle for each link beyond those that make it a tree; a pin is one more.
        let handles = [0, 1].map(|i| (joints[i] + 1).saturating_sub(trees[i].max(1)) + pins);
        let mut wet = Wet {
            metal: Shell::default(),
            inserts: vec![Shell::default(); self.inserts.len()],
            openings: Vec::new(),
            opened: 0,
            handles: handles[0],
            handles_in_metal: handles[1],
        };
        for &k in &body.passages {
            let passage = &self.passages[k];
            for branch in &passage.branches {
                wet.metal.faces.extend(used(&branch.faces));
                wet.openings.extend(branch.ends.iter().copied());
                wet.opened += usize::from(!branch.ends.is_empty());
            }
            for pin in &passage.pins {
                wet.metal.faces.extend(used(pin));
            }
            let own = passage.faces.iter();
            let own = own.map(|&face| FaceUse { face, forward: passage.outward });
            wet.shell(passage.host).faces.extend(own);
            wet.openings.extend(&self.caps.extensions[k]);
            for cap in &self.caps.passages[k] {
                if cap.open {
                    wet.openings.push(cap.used);
                    wet.opened += usize::from(cap.in_metal);
                } else {
                    wet.shell(passage.host).faces.push(cap.used);
                }
            }
            for (i, (insert, caps)) in self.inserts.iter().zip(&self.caps.inserts).enumerate() {
                if insert.passages[0] == k {
                    let outside = insert.outside.iter();
                    let outside = outside.map(|&face| FaceUse { face, forward: !insert.outward });
                    let plate = FaceUse { forward: !caps.plate.forward, ..caps.plate };
                    wet.inserts[i].faces.extend(outside.chain([plate]));
                }
            }
        }
        for link in links() {
            wet.shell(link.host).faces.extend(used(&link.faces));
        }
        wet
    }

    /// Its passages' names; a plenum's only where it stands alone.
    fn body_name(&self, body: &Body) -> String {
        let passages = || body.passages.iter().map(|&k| &self.passages[k]);
        let in_metal: Vec<&str> =
            passages().filter(|p| p.host == Host::Metal).map(|p| p.name.as_str()).collect();
        if in_metal.is_empty() { passages().map(|p| p.name.as_str()).collect() } else { in_metal.join("+") }
    }
}

impl Wet {
    /// The faces towards a solid.
    fn shell(&mut self, host: Host) -> &mut Shell {
        match host {
            Host::Metal => &mut self.metal,
            Host::Insert(i) => &mut self.inserts[i],
        }
    }
}
