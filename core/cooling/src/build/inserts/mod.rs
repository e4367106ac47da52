//! Impingement inserts: a sheet in a chamber that parts its coolant into a plenum inside and a gap outside.
//!
//! Both faces of the sheet are chambers of a thicker shell between thicker walls (`walls.rs`), so that gap and thickness
//! are right in space wherever the shell's thickness is.

mod jets;
mod walls;

use super::chambers::{TubeLook, add_chamber, add_parted};
use super::error::BuildError;
use super::nodes::passage_nodes;
use super::passages::{Host, Passage, PassageEnd, PassagePart, face_names};
use super::sections::Grid;
use super::stack::Stack;
use super::style;
use super::tube::CutTube;
use crate::plan::{InsertPlan, Plan, ShellPlan};
use crate::watch::Watch;
use coolinggen_blade::{Blade, Fault, StreamSpace};
use coolinggen_brep::{FaceId, Model};
pub use jets::JetGeometry;
pub(super) use jets::add_jets;
use walls::{Sheet, SheetWall};

/// An insert in the model, with what its solid is made from; its plenum is a passage of its own.
#[derive(Clone, Debug)]
pub(super) struct Insert {
    /// Name of its chamber.
    pub(super) name: String,
    /// Index of the passage round it, and of its plenum.
    pub(super) passages: [usize; 2],
    /// The end that is open: 0 at the hub, 1 at the tip.
    pub(super) open: usize,
    /// Span fraction of the plate's outer face.
    pub(super) plate_v: f64,
    /// Faces towards the gap.
    pub(super) outside: Vec<FaceId>,
    /// Faces towards the metal it stands in, if the gap is closed.
    pub(super) seat: Option<CutTube>,
    /// Whether its faces' natural normals point out of the tube.
    pub(super) outward: bool,
    /// The rings of the tubes outside and inside, at the hub's and the tip's end.
    pub(super) tubes: [CutTube; 2],
}

/// An insert as built.
#[derive(Clone, Debug)]
pub struct InsertGeometry {
    /// Name of its chamber.
    pub name: String,
    /// All faces of the sheet towards the gap.
    pub sheet: Vec<FaceId>,
    /// The eight faces of the chamber, in the order of the ring; the second parameter of their surfaces is the span
    /// fraction.
    pub chamber: Vec<FaceId>,
    /// The same of the tube outside, less where bores have parted them.
    pub outside: Vec<FaceId>,
    /// The same of the tube inside.
    pub inside: Vec<FaceId>,
}

impl Insert {
    /// What of it is to be measured.
    pub(super) fn geometry(&self, passages: &[Passage]) -> InsertGeometry {
        let chamber = format!("chamber/{}", self.name);
        let parts = &passages[self.passages[0]].parts;
        let chamber = parts.iter().find(|p| p.path == chamber).map_or(Vec::new(), |p| p.faces.clone());
        let [outside, inside] = self.tubes.each_ref().map(|tube| tube.faces.clone());
        InsertGeometry { name: self.name.clone(), sheet: self.outside.clone(), chamber, outside, inside }
    }
}

/// What inserts are built from.
pub(super) struct InsertSite<'a> {
    pub(super) blade: &'a Blade,
    pub(super) space: &'a StreamSpace,
    pub(super) grid: &'a Grid,
    pub(super) plan: &'a Plan,
    pub(super) shell: &'a ShellPlan,
    pub(super) stack: &'a Stack,
    pub(super) watch: &'a dyn Watch,
}

/// Adds the faces of all inserts; each gains a passage, its plenum, and leaves its mark on the passage round it.
pub(super) fn add_inserts(
    model: &mut Model,
    site: &InsertSite<'_>,
    passages: &mut Vec<Passage>,
) -> Result<Vec<Insert>, BuildError> {
    let mut inserts = Vec::with_capacity(site.plan.inserts.len());
    let mut faults = Vec::new();
    for insert in &site.plan.inserts {
        match add_insert(model, site, insert, passages, inserts.len()) {
            Ok(made) => inserts.push(made),
            Err(error) => match error.blamed_on(&insert.pointer()) {
                BuildError::Refused(more) => faults.extend(more),
                other => return Err(other),
            },
        }
    }
    if faults.is_empty() { Ok(inserts) } else { Err(BuildError::Refused(faults)) }
}

fn add_insert(
    model: &mut Model,
    site: &InsertSite<'_>,
    insert: &InsertPlan,
    passages: &mut Vec<Passage>,
    index: usize,
) -> Result<Insert, BuildError> {
    let (k, open, closed) = (insert.chamber, insert.open(), insert.closed);
    let name = site.plan.chambers[k].name.clone();
    let found = passages.iter().enumerate().find_map(|(p, passage)| {
        let end = passage.ends.iter().position(|end| end.side == open && end.name == name)?;
        Some((p, end))
    });
    let (around, end) = found.ok_or_else(|| {
        let message = format!("chamber \"{name}\" does not end where the insert opens");
        BuildError::Refused(vec![Fault::new(insert.pointer(), "geometry", message)])
    })?;
    let Sheet { reach, walls: [outer, inner] } = Sheet::new(site, insert)?;
    let path = format!("insert/{name}");
    let look = |part: &str| TubeLook {
        names: face_names(site.plan, k, &format!("{path}/{part}")),
        style: style::insert(),
    };
    let (seat, outside) = outer_tube(model, &outer, [look("seat"), look("outside")], reach.seat, open)?;
    let sections = inner.sections();
    let inside = add_chamber(model, &look("inside"), &sections, &passage_nodes(&[&sections])?[0])?;

    passages[around].ends[end].inserted = Some(outside.rings[open].clone());
    let plenum = format!("{name}/plenum");
    let end = |side: usize, v: f64| PassageEnd {
        ring: inside.rings[side].clone(),
        inserted: None,
        side,
        v,
        name: plenum.clone(),
        path: format!("{path}/inside"),
        style: style::insert(),
    };
    let chamber = format!("chamber/{name}");
    for part in passages[around].parts.iter_mut().filter(|part| part.path == chamber) {
        part.inserted = outside.faces.clone();
    }
    let [first, last] = [0, 1].map(|side| end(side, if side == open { side as f64 } else { reach.inner }));
    let faces = inside.faces.clone();
    passages.push(Passage {
        name: plenum.clone(),
        faces: faces.clone(),
        parts: vec![PassagePart {
            path: format!("{path}/inside"),
            turn: None,
            faces,
            inserted: Vec::new(),
            reversed: open == 1,
        }],
        outward: site.blade.outward,
        ends: if open == 0 { [first, last] } else { [last, first] },
        branches: Vec::new(),
        pins: Vec::new(),
        host: Host::Insert(index),
    });
    Ok(Insert {
        name,
        passages: [around, passages.len() - 1],
        open,
        plate_v: reach.span[closed],
        outside: outside.faces.clone(),
        seat,
        outward: site.blade.outward,
        tubes: [outside, inside],
    })
}

/// The tube outside, parted where it leaves its seat.
fn outer_tube(
    model: &mut Model,
    wall: &SheetWall,
    [seat_look, look]: [TubeLook; 2],
    seat: Option<f64>,
    open: usize,
) -> Result<(Option<CutTube>, CutTube), BuildError> {
    let sections = wall.sections();
    let nodes = &passage_nodes(&[&sections])?[0];
    let at = seat.and_then(|v| sections.iter().position(|s| s.stream.v() == v));
    let Some(at) = at else { return Ok((None, add_chamber(model, &look, &sections, nodes)?)) };
    let looks = if open == 0 { [&seat_look, &look] } else { [&look, &seat_look] };
    Ok(match add_parted(model, looks, &sections, nodes, at)? {
        (tube, None) => (None, tube),
        (below, Some(above)) if open == 0 => (Some(below), above),
        (below, Some(above)) => (Some(above), below),
    })
}
