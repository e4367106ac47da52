//! Whether a solid is closed, of the right genus, and how closely its edges keep to its faces.

mod deviation;
mod fault;
mod topology;

pub use fault::Fault;

use crate::model::{EdgeId, Face, FaceId, Loop, Model, Solid};
use crate::probe::SurfaceProbe;
use coolinggen_nurbs::ParametricCurve;
pub(crate) use deviation::Gauge;
pub use deviation::deviation_amid_spans;
use std::collections::HashMap;

/// Greatest distance between the end of an edge's curve and its vertex that passes, mm.
pub const VERTEX_TOLERANCE_MM: f64 = 1e-9;

/// Greatest distance between an edge and the image of its parameter curve that passes, mm: what OpenCASCADE takes
/// without raising tolerances. Stricter consumers judge by [`SolidCheck::max_edge_distance_mm`].
pub const EDGE_TOLERANCE_MM: f64 = 1e-6;

/// Where on a face's border something was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgePlace {
    /// The face.
    pub face: FaceId,
    /// The edge.
    pub edge: EdgeId,
    /// Parameter of the edge's curve.
    pub parameter: f64,
}

/// The findings of [`Model::check_solid`].
#[derive(Clone, Debug, PartialEq)]
pub struct SolidCheck {
    /// Every edge joins two faces in opposite directions, every loop is closed, every shell is one piece, and all
    /// of it within [`VERTEX_TOLERANCE_MM`] and [`EDGE_TOLERANCE_MM`].
    pub watertight: bool,
    /// Sum of the genera of the shells, from `V - E + F - (L - F) = 2 (S - G)`; nothing if the shells are no closed
    /// surfaces.
    pub genus_found: Option<usize>,
    /// What the design implies.
    pub genus_expected: usize,
    /// All that is wrong; empty for a sound solid.
    pub faults: Vec<Fault>,
    /// Greatest distance between the end of an edge's curve and its vertex, mm.
    pub max_vertex_gap_mm: f64,
    /// Greatest distance between an edge and the image of its parameter curve at the same parameter, mm: what a
    /// mesh made in parameters is off. Where both are B-splines on the same knots a bound, else the greatest of
    /// four samples a span.
    pub max_edge_deviation_mm: f64,
    /// Where that is.
    pub max_edge_deviation_at: Option<EdgePlace>,
    /// Greatest distance between an edge and a face it bounds, mm: the part of the deviation along the normal,
    /// correct to second order in the deviation. What a reader that projects edges onto faces finds.
    pub max_edge_distance_mm: f64,
    /// Where that is.
    pub max_edge_distance_at: Option<EdgePlace>,
}

/// What was found on one face.
#[derive(Clone, Debug, Default)]
pub(crate) struct FaceCheck {
    pub(crate) gauge: Gauge,
    pub(crate) faults: Vec<Fault>,
}

impl SolidCheck {
    /// Whether nothing at all is wrong.
    pub fn is_sound(&self) -> bool {
        self.faults.is_empty()
    }
}

impl Model {
    /// Checks topology and geometry of a solid of this model. Faults of faces that the solid does not use are not
    /// reported.
    pub fn check_solid(&self, solid: &Solid) -> SolidCheck {
        self.check_solid_by(solid, &mut |face| self.check_face(face))
    }

    /// [`Model::check_solid`] with the findings on each face from `on_face`.
    pub(crate) fn check_solid_by(
        &self,
        solid: &Solid,
        on_face: &mut dyn FnMut(FaceId) -> FaceCheck,
    ) -> SolidCheck {
        let mut check = SolidCheck {
            watertight: false,
            genus_found: None,
            genus_expected: solid.expected_genus,
            faults: Vec::new(),
            max_vertex_gap_mm: 0.0,
            max_edge_deviation_mm: 0.0,
            max_edge_deviation_at: None,
            max_edge_distance_mm: 0.0,
            max_edge_distance_at: None,
        };
        self.check_indices(solid, &mut check.faults);
        if !check.faults.is_empty() {
            return check;
        }
        self.check_names(solid, &mut check.faults);
        check.genus_found = topology::genus(self, solid, &mut check.faults);
        if check.genus_found != Some(solid.expected_genus) {
            check.faults.push(Fault::Genus { found: check.genus_found, expected: solid.expected_genus });
        }
        self.check_edges(solid, &mut check);
        let mut gauge = Gauge::default();
        for used in solid.faces() {
            let found = on_face(used.face);
            gauge.include(&found.gauge);
            check.faults.extend(found.faults);
        }
        (check.max_edge_deviation_mm, check.max_edge_deviation_at) = gauge.deviation;
        (check.max_edge_distance_mm, check.max_edge_distance_at) = gauge.distance;
        check.watertight = !solid.shells.is_empty() && !check.faults.iter().any(Fault::leaks);
        check
    }

    /// What is indexed must exist, or nothing else can be looked at.
    fn check_indices(&self, solid: &Solid, faults: &mut Vec<Fault>) {
        for used in solid.faces() {
            let Some(face) = self.faces.get(used.face.0) else {
                faults.push(Fault::NoFace { index: used.face.0 });
                continue;
            };
            for coedge in face.loops.iter().flat_map(|l| &l.coedges) {
                let (name, edge) = (|| face.name.clone(), coedge.edge);
                match self.edges.get(edge.0) {
                    None => faults.push(Fault::NoEdge { face: name(), edge }),
                    Some(e) if e.start.0.max(e.end.0) >= self.vertices.len() => {
                        faults.push(Fault::NoVertex { face: name(), edge });
                    }
                    Some(e) if e.start == e.end => faults.push(Fault::ClosedEdge { face: name(), edge }),
                    Some(_) => {}
                }
            }
        }
    }

    /// Names are unique in the whole model, or the solids could not be told apart in it.
    fn check_names(&self, solid: &Solid, faults: &mut Vec<Fault>) {
        let mut names: HashMap<&str, (usize, bool)> = HashMap::with_capacity(self.faces.len());
        for face in &self.faces {
            names.entry(&face.name).or_default().0 += 1;
        }
        for used in solid.faces() {
            let name = &self.face(used.face).name;
            if let Some((count, told)) = names.get_mut(name.as_str())
                && (*count > 1 || name.is_empty())
                && !std::mem::replace(told, true)
            {
                faults.push(Fault::Name { name: name.clone(), count: *count });
            }
        }
    }

    /// Gaps between the ends of curves and the vertices.
    fn check_edges(&self, solid: &Solid, check: &mut SolidCheck) {
        let mut seen = vec![false; self.edges.len()];
        for used in solid.faces() {
            let face = self.face(used.face);
            for id in face.loops.iter().flat_map(|l| &l.coedges).map(|c| c.edge) {
                if std::mem::replace(&mut seen[id.0], true) {
                    continue;
                }
                let edge = self.edge(id);
                let (start, end) = edge.curve.domain();
                let gap = |t: f64, vertex| edge.curve.point(t).distance(self.vertex(vertex));
                let gap = gap(start, edge.start).max(gap(end, edge.end));
                check.max_vertex_gap_mm = check.max_vertex_gap_mm.max(gap);
                if !(gap <= VERTEX_TOLERANCE_MM) {
                    check.faults.push(Fault::VertexGap { face: face.name.clone(), edge: id, gap_mm: gap });
                }
            }
        }
    }

    /// Loops in the parameter plane, and edges against the surface.
    pub(crate) fn check_face(&self, id: FaceId) -> FaceCheck {
        let mut check = FaceCheck::default();
        let FaceCheck { gauge, faults } = &mut check;
        let face = self.face(id);
        let name = || face.name.clone();
        let mut probe = SurfaceProbe::new(&face.surface);
        for (index, lp) in face.loops.iter().enumerate() {
            let before = faults.len();
            for coedge in &lp.coedges {
                let edge = self.edge(coedge.edge);
                if coedge.pcurve.domain() != edge.curve.domain() {
                    faults.push(Fault::PcurveDomain { face: name(), edge: coedge.edge });
                    continue;
                }
                let deviation = gauge.measure(&mut probe, id, coedge, edge);
                if !(deviation <= EDGE_TOLERANCE_MM) {
                    let deviation_mm = deviation;
                    faults.push(Fault::EdgeDeviation { face: name(), edge: coedge.edge, deviation_mm });
                }
            }
            self.check_closure(face, index, lp, &mut probe, faults);
            // A loop that is wrong anyway has no sense to speak of.
            if faults.len() == before {
                let area = topology::rough_area(lp);
                if !((area > 0.0) == (index == 0) && area != 0.0) {
                    faults.push(Fault::LoopSense { face: name(), index, area });
                }
            }
        }
        check
    }

    /// The jumps between parameter curves, which must be none, or on a pole of the surface.
    fn check_closure(
        &self,
        face: &Face,
        index: usize,
        lp: &Loop,
        probe: &mut SurfaceProbe<'_>,
        faults: &mut Vec<Fault>,
    ) {
        for (i, coedge) in lp.coedges.iter().enumerate() {
            let next = &lp.coedges[(i + 1) % lp.coedges.len()];
            let (from, to) = (coedge.parameter_at(1.0), next.parameter_at(0.0));
            if from == to {
                continue;
            }
            let vertex = self.vertex(self.end_of(coedge));
            let off = [0.25, 0.5, 0.75].map(|s| probe.point(from.lerp(to, s)).distance(vertex));
            let gap_mm = off.into_iter().fold(0.0, f64::max);
            if !(gap_mm <= EDGE_TOLERANCE_MM) {
                let face = face.name.clone();
                faults.push(Fault::ParameterGap { face, index, edge: coedge.edge, gap_mm });
            }
        }
    }
}
