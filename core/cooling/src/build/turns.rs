//! Turns in the model: from the stack's sections to faces between the chambers' end rings.

use super::chambers::column;
use super::clearance::ChamberPolygon;
use super::error::BuildError;
use super::passages::rings_beyond;
use super::probe::Probe;
use super::sections::Grid;
use super::spans::TurnSpan;
use super::stack::Stack;
use super::style;
use super::tube::CutTube;
use crate::plan::{Plan, ShellPlan, TurnPlan};
use crate::section::SEGMENTS;
use crate::turn::{
    EndRow, FORMS, Form, PARTS, TurnRefusal, TurnRequest, TurnSection, TurnShape, loft, mirrored,
};
use crate::watch::Watch;
use coolinggen_blade::{Blade, Fault, Region, StreamSpace};
use coolinggen_brep::{
    Coedge, EdgeId, Face, FaceId, Loop, Model, SurfaceGeometry, VertexId, straight_pcurve,
};
use coolinggen_nurbs::{Curve, NurbsError, ParametricCurve, ParametricSurface, Surface};
use glam::DVec3;

/// A turn with the sections it passes.
#[derive(Clone, Debug)]
pub(super) struct TurnSite<'a> {
    pub(super) plan: &'a TurnPlan,
    pub(super) span: &'a TurnSpan,
    sections: Vec<TurnSection<'a>>,
}

/// The turns of a stack, in the plan's order.
pub(super) fn sites<'a>(stack: &'a Stack, plan: &'a Plan) -> Result<Vec<TurnSite<'a>>, BuildError> {
    let mut sites = Vec::with_capacity(plan.turns.len());
    let mut faults = Vec::new();
    for (t, (turn, span)) in plan.turns.iter().zip(&stack.spans.turns).enumerate() {
        faults.extend(span.check(turn));
        let places = stack.of_turn(t);
        let rings = [turn.front, turn.front + 1].map(|k| rings_beyond(stack, plan, k, &places));
        let [Ok(front), Ok(back)] = rings else {
            faults.extend(rings.into_iter().filter_map(Result::err).map(|fault| *fault));
            continue;
        };
        let mut sections = Vec::with_capacity(places.len());
        for (i, rings) in places.into_iter().zip(front.into_iter().zip(back)) {
            let (section, line) = (&stack.sections[i], &stack.walls[turn.front][i]);
            sections.push(TurnSection {
                stream: &section.stream,
                outline: &stack.offsets[i].outline,
                camber: &section.camber,
                position: plan.walls[turn.front].position.at(section.stream.v()),
                wall: [line.center, line.direction],
                rings: rings.into(),
            });
        }
        sites.push(TurnSite { plan: turn, span, sections });
    }
    if faults.is_empty() { Ok(sites) } else { Err(BuildError::worst(faults)) }
}

/// Rounds of fitting clearances to the flow area.
const ROUNDS: usize = 6;
/// Relative difference of the flow areas that is good enough.
const AREA_TOLERANCE: f64 = 1e-3;

/// The stack with the clearances of all turns settled: those that the flow area decides are found by trial.
pub(super) fn settled(
    blade: &Blade,
    space: &StreamSpace,
    grid: &Grid,
    plan: &Plan,
    shell: &ShellPlan,
    watch: &dyn Watch,
) -> Result<Stack, BuildError> {
    // About the half chord of a chamber: a start from which the areas tell the rest.
    let start = 0.1 * space.height();
    let mut clearances: Vec<f64> = plan.turns.iter().map(|t| t.clearance.unwrap_or(start)).collect();
    for _ in 0..ROUNDS {
        let stack = Stack::new(blade, space, grid, plan, shell, &clearances, watch)?;
        let mut settled = true;
        for (clearance, site) in clearances.iter_mut().zip(sites(&stack, plan)?) {
            if site.plan.clearance.is_some() {
                continue;
            }
            watch.go_on()?;
            let shape = site.mapped(&std::array::from_fn(|_| coarse_nodes()))?;
            let [front, top, back] = [0.0, 0.5, 1.0].map(|p| shape.area(p));
            let wanted = 0.5 * (front + back);
            settled &= (top / wanted - 1.0).abs() <= AREA_TOLERANCE;
            // The area grows with the clearance by the width of the passage.
            *clearance += (wanted - top) / shape.width();
        }
        if settled {
            return Ok(stack);
        }
    }
    Stack::new(blade, space, grid, plan, shell, &clearances, watch)
}

fn coarse_nodes() -> Vec<f64> {
    const SPANS: u32 = 8;
    (0..=SPANS).map(|i| f64::from(i) / f64::from(SPANS)).collect()
}

impl TurnSite<'_> {
    /// The shape of the turn with rings at these nodes, of the first form that has one.
    fn mapped(&self, nodes: &[Vec<f64>; SEGMENTS]) -> Result<TurnShape, BuildError> {
        self.first(|form| self.shape(form, nodes))
    }

    /// What the first form comes to that comes to anything; else why the very first does not.
    fn first<T>(
        &self,
        of: impl Fn(Form) -> Result<Result<T, TurnRefusal>, BuildError>,
    ) -> Result<T, BuildError> {
        let mut first = None;
        for form in FORMS {
            match of(form)? {
                Ok(found) => return Ok(found),
                Err(refusal) => first = first.or(Some(refusal)),
            }
        }
        Err(self.refused(&first.unwrap_or(TurnRefusal::Unmapped)))
    }

    /// The shape of the turn in a form, with rings at these nodes.
    fn shape(
        &self,
        form: Form,
        nodes: &[Vec<f64>; SEGMENTS],
    ) -> Result<Result<TurnShape, TurnRefusal>, BuildError> {
        let request = TurnRequest {
            sections: &self.sections,
            inner: self.span.inner,
            outer: self.span.outer(),
            radius: self.span.radius,
            exponent: self.plan.exponent,
            form,
            nodes: nodes.clone(),
        };
        TurnShape::new(&request)
    }

    fn refused(&self, refusal: &TurnRefusal) -> BuildError {
        let message = format!("at span fraction {:.4}: {refusal}", self.span.joint());
        let turn = self.plan.pointer();
        let chamber = format!("/cooling/chambers/{}/fillet_radius", self.plan.front);
        let fault = |pointer: &str| Fault::new(pointer, "geometry", message.clone()).unit("mm");
        let fault = match refusal {
            TurnRefusal::TooLow { clearance, least } => {
                fault(&format!("{turn}/clearance")).value(*clearance).min(*least)
            }
            TurnRefusal::FilletTooLarge { radius, greatest } => fault(&chamber).value(*radius).max(*greatest),
            TurnRefusal::NoSide { x } => fault(&turn).value(*x),
            TurnRefusal::ThinShell { found, asked, .. } => {
                fault(&turn).value(*found).min(*asked).hint("a smaller exponent, or another clearance")
            }
            TurnRefusal::Unmapped | TurnRefusal::Fold { .. } => fault(&turn),
        };
        BuildError::Refused(vec![fault])
    }

    /// Outlines in the turn's sections: of the passage without its wall, where radial holes keep clear of it.
    pub(super) fn polygons(&self) -> Vec<ChamberPolygon> {
        const STEPS: u32 = 12;
        let outline = |section: &TurnSection<'_>| {
            let parts = [(0, [4, 5, 6, 7, 0]), (1, [0, 1, 2, 3, 4])];
            let segments = parts.iter().flat_map(|(c, ks)| ks.iter().map(|&k| section.rings[*c].segments[k]));
            let at = |i: u32| f64::from(i) / f64::from(STEPS);
            segments.flat_map(|s| (0..STEPS).map(move |i| s.evaluate(section.outline, at(i)).0)).collect()
        };
        let polygon = |section: &TurnSection<'_>| ChamberPolygon {
            part: format!("turn \"{}\"", self.plan.name),
            stream: section.stream.clone(),
            points: outline(section),
        };
        let inside = self.sections.len() - 1;
        self.sections[..inside].iter().map(polygon).collect()
    }
}

/// How much thinner than asked the shell may be round a turn, relatively.
const SHELL_TOLERANCE: f64 = 1e-3;

/// Measures the shell round the turns' sides and outer closures in space.
pub(super) struct ShellCheck<'a> {
    pub(super) probe: Probe<'a>,
    pub(super) blade: &'a Blade,
    pub(super) space: &'a StreamSpace,
    pub(super) shell: &'a ShellPlan,
    /// Share of the shell's thickness that the leading chamber's nose keeps: a turn cannot keep more of it.
    pub(super) kept: f64,
    pub(super) watch: &'a dyn Watch,
}

impl ShellCheck<'_> {
    /// The least thickness asked for about the parameter `u` of the blade: round the leading edge one side's passes into
    /// the other's, and it begins to do so a little beside the foot of a leaned blade's shell.
    fn asked(&self, u: f64, v: f64) -> f64 {
        let (suction, pressure) = (self.shell.suction_side.at(v), self.shell.pressure_side.at(v));
        let beside = self.blade.range(Region::LeadingEdge).map_or(0.0, |[start, end]| 0.1 * (end - start));
        let regions = [u - beside, u, u + beside].map(|u| self.blade.region_at(u));
        if regions.iter().all(|r| *r == Region::SuctionSide) {
            suction
        } else if regions.iter().all(|r| *r == Region::PressureSide) {
            pressure
        } else {
            suction.min(pressure)
        }
    }

    /// The place where a turn comes nearest to the outer surface, if that is nearer than the shell allows; `leading` if its
    /// outer closure begins as the leading chamber's nose.
    fn thin(&self, surfaces: &[Surface<DVec3>], leading: bool) -> Result<Option<TurnRefusal>, BuildError> {
        const ACROSS: u32 = 6;
        const ALONG: u32 = 12;
        let mut worst: Option<(f64, TurnRefusal)> = None;
        for k in [0, 4, 5, 6, 7] {
            let kept = if leading && k > 4 { self.kept } else { 1.0 };
            for (i, j) in (0..=ACROSS).flat_map(|i| (0..=ALONG).map(move |j| (i, j))) {
                let at = surfaces[k].point(f64::from(i) / f64::from(ACROSS), f64::from(j) / f64::from(ALONG));
                let foot = self.probe.foot(at)?;
                let found = self.probe.thickness_at(at, &foot);
                let asked = self.asked(foot.u, self.space.span_fraction(at)?);
                let ratio = found / asked;
                if ratio < kept - SHELL_TOLERANCE && worst.as_ref().is_none_or(|(least, _)| ratio < *least) {
                    worst = Some((ratio, TurnRefusal::ThinShell { part: PARTS[k], found, asked }));
                }
            }
        }
        Ok(worst.map(|(_, refusal)| refusal))
    }
}

/// Adds the faces of a turn between its front and back chamber; their natural normals point as the chambers' do.
pub(super) fn add_turn(
    model: &mut Model,
    site: &TurnSite<'_>,
    chambers: [&CutTube; 2],
    check: &ShellCheck<'_>,
) -> Result<Vec<FaceId>, BuildError> {
    let side = site.plan.side();
    let ends = [end_row(model, chambers[0], side, false)?, end_row(model, chambers[1], side, true)?];
    let nodes = std::array::from_fn(|k| ends[0].curves[k].breaks());
    // With q away from the front chamber's end at the tip, towards it at the hub, (t, q) turns as the chambers' (t, v).
    let first = 1 - side;
    let lofted = site.first(|form| {
        let shape = match site.shape(form, &nodes)? {
            Ok(shape) => shape,
            Err(refusal) => return Ok(Err(refusal)),
        };
        let lofted = loft(&shape, &ends, first, check.watch)?;
        let refusal = match lofted.fold() {
            None => check.thin(&lofted.surfaces, site.plan.front == 0)?,
            folded => folded,
        };
        Ok(refusal.map_or(Ok(lofted), Err))
    })?;
    // Edge of segment k in the end ring of a chamber, and whether it runs with t.
    let border = |chamber: usize, k: usize| {
        let segment = if chamber == 0 { k } else { mirrored(k) };
        (chambers[chamber].rings[side].edges[segment].0, chamber == 0)
    };
    let start = |model: &Model, chamber: usize, k: usize| -> VertexId {
        let (edge, with) = border(chamber, k);
        let edge = model.edge(edge);
        if with { edge.start } else { edge.end }
    };
    let uprights: Vec<EdgeId> = (0..SEGMENTS)
        .map(|k| {
            let surface = &lofted.surfaces[k];
            let row = surface.points()[..surface.counts().1].to_vec();
            let curve = Curve::new(surface.knots_v().clone(), row)?;
            let (from, to) = (start(model, first, k), start(model, 1 - first, k));
            Ok(model.add_edge(from, to, curve))
        })
        .collect::<Result<_, BuildError>>()?;
    let style = style::turn(&site.plan.name);
    let mut faces = Vec::with_capacity(SEGMENTS);
    for (k, (surface, part)) in lofted.surfaces.into_iter().zip(PARTS).enumerate() {
        let name = format!("turn/{}/{part}", site.plan.name);
        let line = |from: [f64; 2], to: [f64; 2]| straight_pcurve(from.into(), to.into(), (0.0, 1.0));
        let ring = |chamber: usize, q: f64| {
            let (edge, with) = border(chamber, k);
            let pcurve = if with { line([0.0, q], [1.0, q]) } else { line([1.0, q], [0.0, q]) };
            Ok::<_, BuildError>(Coedge { edge, forward: with == (q == 0.0), pcurve: pcurve? })
        };
        let next = uprights[(k + 1) % SEGMENTS];
        let coedges = vec![
            ring(first, 0.0)?,
            Coedge { edge: next, forward: true, pcurve: line([1.0, 0.0], [1.0, 1.0])? },
            ring(1 - first, 1.0)?,
            Coedge { edge: uprights[k], forward: false, pcurve: line([0.0, 0.0], [0.0, 1.0])? },
        ];
        let (surface, loops) = (SurfaceGeometry::BSpline(surface), vec![Loop { coedges }]);
        faces.push(model.add_face(Face { name, surface, loops, style: style.clone() }));
    }
    Ok(faces)
}

/// The end of a chamber at a turn, in the turn's order; `back` for the chamber behind the wall.
fn end_row(model: &Model, chamber: &CutTube, side: usize, back: bool) -> Result<EndRow, BuildError> {
    let mut curves = Vec::with_capacity(SEGMENTS);
    let mut across = Vec::with_capacity(SEGMENTS);
    for k in 0..SEGMENTS {
        let face = chamber.faces[if back { mirrored(k) } else { k }];
        let SurfaceGeometry::BSpline(surface) = &model.face(face).surface else {
            return Err(NurbsError::NotFound { what: "the spline of a chamber's face" }.into());
        };
        let (border, slope) = (border(surface, side)?, slope(surface, side)?);
        curves.push(if back { border.reversed() } else { border });
        across.push(if back { slope.reversed() } else { slope });
    }
    Ok(EndRow { curves, across })
}

/// The border of a lofted surface at its first (0) or last (1) section.
fn border(surface: &Surface<DVec3>, side: usize) -> Result<Curve<DVec3>, BuildError> {
    column(surface, if side == 0 { 0 } else { surface.counts().1 - 1 })
}

/// The derivative in v along that border: of a clamped spline, the difference of its two outer rows.
fn slope(surface: &Surface<DVec3>, side: usize) -> Result<Curve<DVec3>, BuildError> {
    let (count, knots) = (surface.counts().1, surface.knots_v());
    let (values, degree) = (knots.values(), knots.degree());
    let (low, at) = if side == 0 { (0, degree) } else { (count - 2, count - 1) };
    let rate = degree as f64 / (values[at + 1] - values[at]);
    let (before, after) = (column(surface, low)?, column(surface, low + 1)?);
    let points = before.points().iter().zip(after.points()).map(|(a, b)| (*b - *a) * rate).collect();
    Ok(Curve::new(surface.knots_u().clone(), points)?)
}
