//! Caps and solids: the metal, and a coolant solid for all passages that bores join.

use super::cap::{Ring, add_cap, points_up};
use super::error::BuildError;
use super::passages::{Link, Passage, PassageEnd};
use super::style;
use super::tube::CutTube;
use coolinggen_blade::{StreamSpace, StreamSurface};
use coolinggen_brep::{FaceId, FaceUse, Model, Shell, Solid};

/// The face that ends a passage.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cap {
    /// As the coolant uses it.
    pub(super) used: FaceUse,
    /// Whether the passage is open there: the metal does not have the face.
    pub(super) open: bool,
    /// Side of the span: 0 the hub's, 1 the tip's.
    pub(super) side: usize,
}

/// The faces that end the passages and the blade.
pub(super) struct Caps {
    /// Of every passage.
    pub(super) passages: Vec<[Cap; 2]>,
    /// Hub and tip face as the metal uses them; the hub's alone where the blade ends in a point.
    pub(super) ends: Vec<FaceUse>,
}

impl Caps {
    /// Faces that end a passage below the tip (1) or above the hub (0).
    pub(super) fn closed(&self) -> Vec<(FaceId, usize)> {
        let caps = self.passages.iter().flatten().filter(|cap| !cap.open);
        caps.map(|cap| (cap.used.face, cap.side)).collect()
    }
}

/// Adds the faces that end the passages, and hub and tip with their openings.
pub(super) fn add_caps(
    model: &mut Model,
    space: &StreamSpace,
    ends: &[StreamSurface; 2],
    outer: &CutTube,
    passages: &[Passage],
) -> Result<Caps, BuildError> {
    let mut openings: [Vec<Ring>; 2] = [Vec::new(), Vec::new()];
    let mut caps = Vec::with_capacity(passages.len());
    for passage in passages {
        let both_open = passage.ends.iter().all(PassageEnd::is_open);
        let one_side = passage.ends[0].side == passage.ends[1].side;
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
            // Where both ends open on one side, the first chamber's is the inlet.
            let enters = if both_open && one_side { i == 0 } else { side == 0 };
            let (name, style) = match (open, enters, side) {
                (true, true, _) => (format!("coolant/inlet/{}", end.name), style::inlet()),
                (true, false, _) => (format!("coolant/outlet/{}", end.name), style::outlet()),
                (false, _, 0) => (format!("{}/hub_end", end.path), style::chamber(&end.name)),
                (false, _, _) => (format!("{}/tip_end", end.path), style::chamber(&end.name)),
            };
            let face = add_cap(model, name, style, stream, &end.ring, &[])?;
            let forward = points_up(model, face, stream) == (side == 1);
            if open {
                openings[side].push(end.ring.clone());
            }
            own.push(Cap { used: FaceUse { face, forward }, open, side });
        }
        caps.push([own[0], own[1]]);
    }
    let mut end_faces = Vec::with_capacity(2);
    for (side, name) in [(0, "blade/hub"), (1, "blade/tip")] {
        if outer.rings[side].edges.is_empty() {
            continue;
        }
        let stream = &ends[side];
        let face =
            add_cap(model, name.to_owned(), style::end(), stream, &outer.rings[side], &openings[side])?;
        let forward = points_up(model, face, stream) == (side == 1);
        end_faces.push(FaceUse { face, forward });
    }
    Ok(Caps { passages: caps, ends: end_faces })
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

/// Adds the solids: `metal`, and `coolant/<passage>` for every passage, `coolant/<passage>+<passage>` for those that
/// bores join.
pub(super) fn add_solids(
    model: &mut Model,
    outward: bool,
    outer: &[FaceId],
    passages: &[Passage],
    links: &[Link],
    caps: &Caps,
) {
    let mut metal = Shell::default();
    metal.faces.extend(outer.iter().map(|&face| FaceUse { face, forward: outward }));
    let (mut voids, mut coolants) = (Vec::new(), Vec::new());
    let mut through = 0;
    for body in bodies(passages.len(), links) {
        // The faces between the coolant and the metal, as the coolant uses them.
        let mut wet = Shell::default();
        let mut openings = Vec::new();
        let used = |faces: &[(FaceId, bool)]| -> Vec<FaceUse> {
            faces.iter().map(|&(face, forward)| FaceUse { face, forward }).collect()
        };
        // A graph of passages has one handle for each link beyond those that make it a tree; a pin is one more.
        let mut handles = body.links.len() + 1 - body.passages.len();
        let mut opened = 0;
        for &k in &body.passages {
            let passage = &passages[k];
            let own = passage.faces.iter();
            wet.faces.extend(own.map(|&face| FaceUse { face, forward: passage.outward }));
            for branch in &passage.branches {
                wet.faces.extend(used(&branch.faces));
                openings.extend(branch.ends.iter().copied());
                opened += usize::from(!branch.ends.is_empty());
            }
            for pin in &passage.pins {
                wet.faces.extend(used(pin));
            }
            handles += passage.pins.len();
            for cap in &caps.passages[k] {
                (if cap.open { &mut openings } else { &mut wet.faces }).push(cap.used);
                opened += usize::from(cap.open);
            }
        }
        for &i in &body.links {
            wet.faces.extend(used(&links[i].faces));
        }
        let dry = wet.reversed();
        if opened > 0 {
            metal.faces.extend(dry.faces);
        } else {
            voids.push(dry);
        }
        // The first opening makes a pocket of the coolant, every other one a handle of the metal; so does every handle
        // of the coolant.
        through += handles + opened.saturating_sub(1);
        let names: Vec<&str> = body.passages.iter().map(|&k| passages[k].name.as_str()).collect();
        let mut coolant = wet;
        coolant.faces.extend(openings);
        coolants.push(Solid {
            name: format!("coolant/{}", names.join("+")),
            shells: vec![coolant],
            expected_genus: handles,
        });
    }
    metal.faces.extend(&caps.ends);
    let mut shells = vec![metal];
    shells.extend(voids);
    model.solids.push(Solid { name: "metal".into(), shells, expected_genus: through });
    model.solids.extend(coolants);
}
