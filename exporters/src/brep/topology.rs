//! Records of vertices, edges, wires, faces, shells and solids: each after its parts, counted from the last.

use super::geometry::{self, Spaced};
use crate::ExportError;
use crate::forms::{CurveForm, Form, SurfaceForm, curve, jumps, pcurve, surface};
use crate::number::Real;
use coolinggen_brep::{EdgeId, FaceId, FaceUse, Model, Solid, VertexId};
use coolinggen_nurbs::{Curve, ParametricCurve};
use glam::DVec2;
use std::collections::HashMap;
use std::io::{self, Write};

/// Tolerance of vertices, edges and faces, mm: OpenCASCADE's least. Edges of built designs lie within a third of it.
const TOLERANCE: f64 = 1e-7;

/// Flags of records: free, modified, checked, orientable, closed, infinite, convex.
mod flags {
    pub(super) const VERTEX: &str = "0101101";
    pub(super) const EDGE: &str = "0101000";
    pub(super) const WIRE: &str = "0101100";
    pub(super) const FACE: &str = "0101000";
    pub(super) const SHELL: &str = "0101100";
    pub(super) const SOLID: &str = "0100000";
    pub(super) const COMPOUND: &str = "1100000";
}

/// A part of a record: its place in the list of records and how it is used.
#[derive(Clone, Copy)]
struct Part {
    record: usize,
    forward: bool,
}

/// A record with its parts.
enum Record {
    Vertex(VertexId),
    Edge(usize),
    /// An edge without length, with its curve on a surface.
    Pole {
        vertex: usize,
        curve: usize,
        surface: usize,
    },
    Wire(Vec<Part>),
    /// Index of the surface and the wires.
    Face(usize, Vec<Part>),
    Shell(Vec<Part>),
    Solid(Vec<Part>),
    Compound(Vec<Part>),
}

/// An edge with its curves.
struct EdgeRecord<'a> {
    ends: [usize; 2],
    curve: CurveForm<'a>,
    /// Surface, and its parameter curves: one, or two where the face runs through the edge both ways, the one along the
    /// edge first.
    pcurves: Vec<(usize, Vec<usize>)>,
}

/// What a file holds, in its order.
pub(super) struct Shapes<'a> {
    model: &'a Model,
    curves_2d: Vec<Curve<DVec2>>,
    edges: Vec<EdgeRecord<'a>>,
    surfaces: Vec<SurfaceForm<'a>>,
    records: Vec<Record>,
    of_vertex: HashMap<VertexId, usize>,
    /// Record and index among the edges.
    of_edge: HashMap<EdgeId, (usize, usize)>,
    of_face: HashMap<FaceId, (usize, bool)>,
}

impl<'a> Shapes<'a> {
    /// The solids as one shape.
    ///
    /// # Errors
    /// [`ExportError::BadTopology`] for an edge whose curve on a face has no form that a reader knows.
    pub(super) fn of(model: &'a Model, solids: &[&Solid]) -> Result<Self, ExportError> {
        let mut shapes = Self {
            model,
            curves_2d: Vec::new(),
            edges: Vec::new(),
            surfaces: Vec::new(),
            records: Vec::new(),
            of_vertex: HashMap::new(),
            of_edge: HashMap::new(),
            of_face: HashMap::new(),
        };
        let mut parts = Vec::with_capacity(solids.len());
        for solid in solids {
            let mut shells = Vec::with_capacity(solid.shells.len());
            for shell in &solid.shells {
                let faces = shell.faces.iter().map(|used| shapes.face(*used)).collect::<Result<_, _>>()?;
                shells.push(shapes.add(Record::Shell(faces)));
            }
            parts.push(shapes.add(Record::Solid(shells)));
        }
        if parts.len() > 1 {
            shapes.add(Record::Compound(parts));
        }
        Ok(shapes)
    }

    fn add(&mut self, record: Record) -> Part {
        self.records.push(record);
        Part { record: self.records.len() - 1, forward: true }
    }

    /// The face as a shell uses it, added when it is first met.
    fn face(&mut self, used: FaceUse) -> Result<Part, ExportError> {
        let (record, same_normal) = match self.of_face.get(&used.face) {
            Some(known) => *known,
            None => {
                let added = self.add_face(used.face)?;
                self.of_face.insert(used.face, added);
                added
            }
        };
        Ok(Part { record, forward: used.forward == same_normal })
    }

    /// Its record, and whether its surface has the natural normal of the model's.
    fn add_face(&mut self, id: FaceId) -> Result<(usize, bool), ExportError> {
        let model = self.model;
        let face = model.face(id);
        let form = surface(face);
        let number = self.surfaces.len();
        let mut wires = Vec::with_capacity(face.loops.len());
        for bound in &face.loops {
            let mut parts = Vec::with_capacity(bound.coedges.len());
            // Where the loop runs in the surface's parameters: edge by edge, begin and end.
            let mut ways: Vec<[DVec2; 2]> = Vec::with_capacity(bound.coedges.len());
            for coedge in &bound.coedges {
                let (record, index) = self.edge(coedge.edge);
                if let Some(own) = pcurve(model, face, coedge, &form) {
                    let own = in_own_parameters(own, &form);
                    let (start, end) = own.domain();
                    let [begin, end] = if coedge.forward { [start, end] } else { [end, start] };
                    ways.push([own.point(begin), own.point(end)]);
                    let place = self.add_curve_2d(own);
                    let of_edge = &mut self.edges[index].pcurves;
                    match of_edge.last_mut().filter(|(surface, _)| *surface == number) {
                        Some((_, both)) => both.insert(usize::from(!coedge.forward), place),
                        None => of_edge.push((number, vec![place])),
                    }
                } else if !matches!(form.form, Form::Plane(_)) {
                    let what = "an edge has no curve in the parameters of its surface";
                    return Err(ExportError::BadTopology { at: face.name.clone(), what });
                }
                parts.push(Part { record, forward: coedge.forward });
            }
            if ways.len() == parts.len() {
                for (k, gap) in jumps(&ways) {
                    let vertex = self.vertex(model.end_of(&bound.coedges[k]));
                    parts.insert(k + 1, self.pole(vertex, number, gap));
                }
            }
            // Loops run counterclockwise about the natural normal, wires about the form's.
            let wire = self.add(Record::Wire(parts));
            wires.push(Part { forward: form.same_normal, ..wire });
        }
        let same_normal = form.same_normal;
        self.surfaces.push(form);
        Ok((self.add(Record::Face(number, wires)).record, same_normal))
    }

    /// An edge without length at a pole of a surface: it runs through the parameters that the pole has.
    fn pole(&mut self, vertex: usize, surface: usize, [from, to]: [DVec2; 2]) -> Part {
        let curve = self.add_curve_2d(Curve::segment(from, to));
        self.add(Record::Pole { vertex, curve, surface })
    }

    fn add_curve_2d(&mut self, curve: Curve<DVec2>) -> usize {
        self.curves_2d.push(curve);
        self.curves_2d.len() - 1
    }

    /// Record and index of an edge, added when it is first met.
    fn edge(&mut self, id: EdgeId) -> (usize, usize) {
        if let Some(known) = self.of_edge.get(&id) {
            return *known;
        }
        let model = self.model;
        let edge = model.edge(id);
        let ends = [edge.start, edge.end].map(|v| self.vertex(v));
        self.edges.push(EdgeRecord { ends, curve: curve(&edge.curve), pcurves: Vec::new() });
        let index = self.edges.len() - 1;
        let added = (self.add(Record::Edge(index)).record, index);
        self.of_edge.insert(id, added);
        added
    }

    fn vertex(&mut self, id: VertexId) -> usize {
        if let Some(known) = self.of_vertex.get(&id) {
            return *known;
        }
        let record = self.add(Record::Vertex(id)).record;
        self.of_vertex.insert(id, record);
        record
    }

    /// The tables of curves and surfaces.
    pub(super) fn write_geometry(&self, out: &mut impl Write) -> io::Result<()> {
        writeln!(out, "Curve2ds {}", self.curves_2d.len())?;
        self.curves_2d.iter().try_for_each(|c| geometry::curve_2d(c, out))?;
        writeln!(out, "Curves {}", self.edges.len())?;
        self.edges.iter().try_for_each(|e| geometry::curve_3d(&e.curve, out))?;
        writeln!(out, "Polygon3D 0\nPolygonOnTriangulations 0\nSurfaces {}", self.surfaces.len())?;
        self.surfaces.iter().try_for_each(|s| geometry::surface(s, out))?;
        writeln!(out, "Triangulations 0")
    }

    /// The table of shapes, and that the last of them is meant.
    pub(super) fn write_topology(&self, out: &mut impl Write) -> io::Result<()> {
        writeln!(out, "\nTShapes {}", self.records.len())?;
        self.records.iter().try_for_each(|record| self.write_record(record, out))?;
        writeln!(out, "\n+1 0 ")
    }

    fn write_record(&self, record: &Record, out: &mut impl Write) -> io::Result<()> {
        match record {
            Record::Vertex(id) => {
                writeln!(
                    out,
                    "Ve\n{TOLERANCE:e}\n{}\n0 0\n\n{}",
                    Spaced(self.model.vertex(*id)),
                    flags::VERTEX
                )?;
                self.write_parts(&[], out)
            }
            Record::Edge(index) => {
                let edge = &self.edges[*index];
                let (start, end) = edge.curve.domain();
                let (start, end) = (Real(start), Real(end));
                // Same parameters, same range, not degenerate; then the curve in space and those on surfaces.
                writeln!(out, "Ed\n {TOLERANCE:e} 1 1 0\n1  {} 0 {start} {end}", index + 1)?;
                for (surface, curves) in &edge.pcurves {
                    match curves[..] {
                        [along, against] => writeln!(
                            out,
                            "3  {} {}C0 {} 0 {start} {end}",
                            along + 1,
                            against + 1,
                            surface + 1
                        )?,
                        _ => writeln!(out, "2  {} {} 0 {start} {end}", curves[0] + 1, surface + 1)?,
                    }
                }
                writeln!(out, "0\n\n{}", flags::EDGE)?;
                let [first, last] = edge.ends;
                let ends = [Part { record: first, forward: true }, Part { record: last, forward: false }];
                self.write_parts(&ends, out)
            }
            Record::Pole { vertex, curve, surface } => {
                writeln!(
                    out,
                    "Ed\n {TOLERANCE:e} 1 1 1\n2  {} {} 0 0 1\n0\n\n{}",
                    curve + 1,
                    surface + 1,
                    flags::EDGE
                )?;
                let end = |forward| Part { record: *vertex, forward };
                self.write_parts(&[end(true), end(false)], out)
            }
            Record::Wire(edges) => {
                writeln!(out, "Wi\n\n{}", flags::WIRE)?;
                self.write_parts(edges, out)
            }
            Record::Face(surface, wires) => {
                writeln!(out, "Fa\n0  {TOLERANCE:e} {} 0\n\n{}", surface + 1, flags::FACE)?;
                self.write_parts(wires, out)
            }
            Record::Shell(faces) => {
                writeln!(out, "Sh\n\n{}", flags::SHELL)?;
                self.write_parts(faces, out)
            }
            Record::Solid(shells) => {
                writeln!(out, "So\n\n{}", flags::SOLID)?;
                self.write_parts(shells, out)
            }
            Record::Compound(solids) => {
                writeln!(out, "Co\n\n{}", flags::COMPOUND)?;
                self.write_parts(solids, out)
            }
        }
    }

    fn write_parts(&self, parts: &[Part], out: &mut impl Write) -> io::Result<()> {
        for part in parts {
            let sign = if part.forward { '+' } else { '-' };
            write!(out, "{sign}{} 0 ", self.records.len() - part.record)?;
        }
        writeln!(out, "*")
    }
}

/// STEP measures cones along their axis, OpenCASCADE along their sides.
fn in_own_parameters(curve: Curve<DVec2>, form: &SurfaceForm<'_>) -> Curve<DVec2> {
    match form.form {
        Form::Cone { angle, .. } => curve.map(|p| DVec2::new(p.x, p.y / angle.cos())),
        _ => curve,
    }
}
