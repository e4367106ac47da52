//! The two faces of a sheet: the chamber's contour as it would be in a thicker shell between thicker walls.

use super::super::chambers::RingSection;
use super::super::error::BuildError;
use super::super::fit::nearest;
use super::super::passages::ring_of;
use super::super::sections::{Section, span_fractions};
use super::super::spans::{Spans, inside};
use super::super::stack::Stack;
use super::InsertSite;
use crate::plan::{InsertPlan, Plan, ShellPlan};
use crate::section::ChamberRing;
use coolinggen_blade::{Fault, Law};

/// Where an insert begins and ends.
#[derive(Clone, Debug)]
pub(super) struct Reach {
    /// Span fractions of the tube outside, plate included.
    pub(super) span: [f64; 2],
    /// Span fraction of the plate's inner face.
    pub(super) inner: f64,
    /// Span fraction at which it leaves the metal that it stands in, if it does.
    pub(super) seat: Option<f64>,
}

/// Least part of the span between seat and plate.
const LEAST_SPAN: f64 = 0.01;

impl Reach {
    pub(super) fn new(site: &InsertSite<'_>, insert: &InsertPlan) -> Result<Self, BuildError> {
        let (open, closed) = (insert.open(), insert.closed);
        let chamber = site.stack.spans.chambers[insert.chamber];
        let section = |v: f64| Section::new(site.blade, site.space, site.grid, v);
        let gap = insert.gap.at(chamber[closed]);
        let limit = inside(site.space, &section(chamber[closed])?, closed, gap)?;
        let sign = [-1.0, 1.0][closed];
        let end = insert.span.map_or(limit, |span| span[closed]);
        let pointer = insert.pointer();
        if sign * (end - limit) > 1e-12 {
            let message = format!("the insert's end keeps less than its gap of {gap:.3} mm to the chamber's");
            let fault = Fault::new(format!("{pointer}/span/{closed}"), "limit", message).value(end);
            let fault = if closed == 1 { fault.max(limit) } else { fault.min(limit) };
            return Err(BuildError::Refused(vec![fault.unit("span fraction")]));
        }
        let inner = inside(site.space, &section(end)?, closed, insert.thickness.bounds().1)?;
        let start = chamber[open];
        let length = sign * (inner - start);
        if !(length >= LEAST_SPAN) {
            let message = format!("the insert leaves a plenum over {length:.4} of the span");
            let fault =
                Fault::new(format!("{pointer}/span"), "no_room", message).value(length).min(LEAST_SPAN);
            return Err(BuildError::Refused(vec![fault.unit("span fraction")]));
        }
        let edge = open as f64;
        let mut span = [edge; 2];
        span[closed] = end;
        Ok(Self { span, inner, seat: (start != edge).then_some(start) })
    }

    /// Span fractions of the sections of the tube outside.
    fn outer_fractions(&self) -> Vec<f64> {
        let beyond_seat =
            self.seat.map(|seat| if seat < self.inner { [seat, self.span[1]] } else { [self.span[0], seat] });
        let spans: Vec<[f64; 2]> = [self.span].into_iter().chain(beyond_seat).collect();
        span_fractions(&spans)
    }

    /// Span fractions of the tube inside.
    fn inner_span(&self) -> [f64; 2] {
        // The plate's inner face takes the place of its outer one.
        self.span.map(|v| if v == 0.0 || v == 1.0 { v } else { self.inner })
    }
}

/// One face of a sheet: its contour on every section.
#[derive(Debug)]
pub(super) struct SheetWall {
    stack: Stack,
    rings: Vec<ChamberRing>,
}

impl SheetWall {
    /// The contours on their stream surfaces.
    pub(super) fn sections(&self) -> Vec<RingSection<'_>> {
        let sections = self.stack.sections.iter().zip(&self.stack.offsets);
        (sections.zip(&self.rings))
            .map(|((s, o), ring)| RingSection { stream: &s.stream, outline: &o.outline, ring: ring.clone() })
            .collect()
    }
}

/// Least part of a gap or a thickness that is tried where all of it does not fit.
const LEAST_FACTOR: f64 = 1e-3;

/// A sheet: where it reaches, and its faces towards the gap and towards the plenum.
#[derive(Debug)]
pub(super) struct Sheet {
    pub(super) reach: Reach,
    pub(super) walls: [SheetWall; 2],
}

impl Sheet {
    /// The sheet of an insert.
    ///
    /// # Errors
    /// A refusal with the greatest gap or thickness that fits.
    pub(super) fn new(site: &InsertSite<'_>, insert: &InsertPlan) -> Result<Self, BuildError> {
        let reach = Reach::new(site, insert)?;
        Self::within(site, insert, reach).map_err(|error| {
            // The gap or the thickness alone may be too great, and corners that follow from them.
            let fits = |trial: &InsertPlan| {
                Reach::new(site, trial).and_then(|reach| Self::within(site, trial, reach)).is_ok()
            };
            let less_gap = |f: f64| fits(&InsertPlan { gap: insert.gap.times(f), ..insert.clone() });
            if let Some(factor) = nearest(LEAST_FACTOR, 1.0, less_gap) {
                return refusal(&error, insert, "gap", &insert.gap, factor);
            }
            let thinner =
                |f: f64| fits(&InsertPlan { thickness: insert.thickness.times(f), ..insert.clone() });
            match nearest(LEAST_FACTOR, 1.0, thinner) {
                Some(factor) => refusal(&error, insert, "thickness", &insert.thickness, factor),
                None => blamed_on_insert(error, &insert.pointer()),
            }
        })
    }

    fn within(site: &InsertSite<'_>, insert: &InsertPlan, reach: Reach) -> Result<Self, BuildError> {
        let cut = |fractions: Vec<f64>| -> Result<Vec<Section>, BuildError> {
            fractions.iter().map(|&v| Section::new(site.blade, site.space, site.grid, v)).collect()
        };
        let corner = insert.corner();
        let outside = sheet_wall(site, insert, cut(reach.outer_fractions())?, &insert.gap, &corner)?;
        let (depth, corner) = (insert.gap.plus(1.0, &insert.thickness), corner.plus(-1.0, &insert.thickness));
        let sections = cut(span_fractions(&[reach.inner_span()]))?;
        let inside = sheet_wall(site, insert, sections, &depth, &corner)?;
        Ok(Self { reach, walls: [outside, inside] })
    }
}

/// The same refusal, with what it says of other parts of the design said of the insert.
fn blamed_on_insert(error: BuildError, pointer: &str) -> BuildError {
    let BuildError::Refused(faults) = error else { return error };
    let faults = faults.into_iter().map(|fault| match fault.pointer.starts_with(pointer) {
        true => fault,
        false => Fault { pointer: pointer.to_owned(), ..fault },
    });
    BuildError::Refused(faults.collect())
}

/// What is refused, said of a field of the insert of which `factor` times its law would fit.
fn refusal(error: &BuildError, insert: &InsertPlan, field: &str, law: &Law, factor: f64) -> BuildError {
    let value = law.bounds().1;
    let what = match error {
        BuildError::Refused(faults) => faults.first().map(|fault| fault.message.clone()),
        _ => None,
    };
    let what = what.unwrap_or_else(|| error.to_string());
    let message = format!("the sheet does not fit into its chamber: {what}");
    let fault = Fault::new(format!("{}/{field}", insert.pointer()), "no_room", message);
    BuildError::Refused(vec![fault.value(value).max(factor * value).unit("mm")])
}

/// The contour of the insert's chamber at some depth behind its faces, with corners of the given radius.
fn sheet_wall(
    site: &InsertSite<'_>,
    insert: &InsertPlan,
    sections: Vec<Section>,
    depth: &Law,
    corner: &Law,
) -> Result<SheetWall, BuildError> {
    let shell = ShellPlan {
        suction_side: site.shell.suction_side.plus(1.0, depth),
        pressure_side: site.shell.pressure_side.plus(1.0, depth),
        ..site.shell.clone()
    };
    let mut plan =
        Plan { walls: site.plan.walls.clone(), chambers: site.plan.chambers.clone(), ..Plan::default() };
    plan.walls.iter_mut().for_each(|wall| wall.thickness = wall.thickness.plus(2.0, depth));
    plan.chambers.iter_mut().for_each(|chamber| chamber.fillet_radius = corner.clone());
    let span = [sections[0].stream.v(), sections[sections.len() - 1].stream.v()];
    let spans = Spans { chambers: vec![span; plan.chambers.len()], turns: Vec::new() };
    let k = insert.chamber;
    // Only the leading chamber has a nose.
    let front = (k == 0).then_some(span);
    let stack = Stack::through(site.blade, site.grid, sections, spans, &plan, &shell, front, site.watch)?;
    let mut rings = Vec::with_capacity(stack.sections.len());
    let mut faults = Vec::new();
    for (i, section) in stack.sections.iter().enumerate() {
        match ring_of(&stack, &plan, k, i) {
            Ok(ring) => rings.push(ring),
            Err(refusal) => {
                let at = format!("{}/corner_radius", insert.pointer());
                faults.push(BuildError::fault(&at, section.stream.v(), &refusal));
            }
        }
    }
    if faults.is_empty() { Ok(SheetWall { stack, rings }) } else { Err(BuildError::worst(faults)) }
}
