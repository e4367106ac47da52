//! The pass over truck's entities: names on faces and solids and parameter curves of edges, which truck leaves out.

use super::geometry::PcurveEntity;
use super::pcurves::Pcurve;
use super::product::PARAMETER_CONTEXT;
use super::text::{List, Ref, Text};
use std::fmt;
use std::io::{self, Write};
use truck_stepio::out::{StepDisplay, StepLength};

/// Entities below this number are truck's own preamble, which is replaced.
pub(crate) const FIRST_ENTITY: usize = 16;

/// What the writer learnt on the way.
#[derive(Default)]
pub(crate) struct Written {
    /// Entity of each solid.
    pub(crate) solids: Vec<usize>,
    /// Entity of each face, solid by solid.
    pub(crate) faces: Vec<usize>,
    /// First number that no entity has.
    pub(crate) next: usize,
}

/// What to put in.
pub(crate) struct Additions<'a> {
    /// Names of the solids.
    pub(crate) solids: &'a [&'a str],
    /// Names of the faces, solid by solid.
    pub(crate) faces: &'a [&'a str],
    /// Parameter curves of the edges, in the order in which truck writes edges; may be empty.
    pub(crate) pcurves: &'a [Vec<Pcurve>],
    /// A number above those of truck's entities.
    pub(crate) next: usize,
}

/// Takes truck's text line by line (one line is one entity, as our geometry prints), renames what must be renamed
/// and passes it on. The n-th `FACE_SURFACE` is face n, the n-th brep is solid n, the n-th `EDGE_CURVE` edge n.
pub(crate) struct Rewriter<'a, W: Write> {
    out: &'a mut W,
    line: String,
    additions: Additions<'a>,
    outer_bound_next: bool,
    /// Entity of each face's surface.
    surfaces: Vec<usize>,
    edges: usize,
    pub(crate) written: Written,
    pub(crate) error: Option<io::Error>,
}

impl<'a, W: Write> Rewriter<'a, W> {
    pub(crate) fn new(out: &'a mut W, additions: Additions<'a>) -> Self {
        Self {
            out,
            line: String::new(),
            outer_bound_next: false,
            surfaces: Vec::new(),
            edges: 0,
            written: Written { next: additions.next, ..Written::default() },
            additions,
            error: None,
        }
    }

    fn pass(&mut self) -> io::Result<()> {
        let line = &self.line;
        let Some((id, body)) = line.strip_prefix('#').and_then(|rest| rest.split_once(" = ")) else {
            return Ok(());
        };
        let Some(id) = id.parse::<usize>().ok().filter(|&id| id >= FIRST_ENTITY) else { return Ok(()) };
        if id >= self.additions.next {
            return Err(io::Error::other("more STEP entities than counted"));
        }
        if let Some(rest) = body.strip_prefix("FACE_SURFACE(''") {
            let name = self.additions.faces.get(self.written.faces.len()).copied().unwrap_or_default();
            self.written.faces.push(id);
            self.surfaces.push(references(rest).last().ok_or_else(|| unexpected(line))?);
            self.outer_bound_next = true;
            return writeln!(self.out, "#{id} = ADVANCED_FACE({}{rest}", Text(name));
        }
        if let (true, Some(rest)) = (self.outer_bound_next, body.strip_prefix("FACE_BOUND(")) {
            self.outer_bound_next = false;
            return writeln!(self.out, "#{id} = FACE_OUTER_BOUND({rest}");
        }
        if let Some(rest) = body.strip_prefix("EDGE_CURVE(") {
            self.edges += 1;
            let pcurves = self.additions.pcurves.get(self.edges - 1).map(Vec::as_slice).unwrap_or_default();
            let curve = references(rest).last().ok_or_else(|| unexpected(line))?;
            if let [_, ..] = pcurves {
                let own = self.written.next;
                let edge = rest.replace(&format!(" #{curve},"), &format!(" #{own},"));
                writeln!(self.out, "#{id} = EDGE_CURVE({edge}")?;
                return self.surface_curve(own, curve, pcurves);
            }
        }
        for kind in ["MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS"] {
            if let Some(rest) = body.strip_prefix(kind).and_then(|rest| rest.strip_prefix("(''")) {
                let name = self.additions.solids.get(self.written.solids.len()).copied().unwrap_or_default();
                self.written.solids.push(id);
                return writeln!(self.out, "#{id} = {kind}({}{rest}", Text(name));
            }
        }
        writeln!(self.out, "{line}")
    }

    /// A curve in space with its curves in parameters.
    fn surface_curve(&mut self, own: usize, curve: usize, pcurves: &[Pcurve]) -> io::Result<()> {
        let mut next = own + 1;
        let mut ids = Vec::with_capacity(pcurves.len());
        for pcurve in pcurves {
            let entity = PcurveEntity {
                surface: self.surfaces.get(pcurve.face).copied().unwrap_or_default(),
                curve: &pcurve.curve,
                context: PARAMETER_CONTEXT,
            };
            ids.push(Ref(next));
            next += entity.step_length();
            write!(self.out, "{}", StepDisplay::new(&entity, next - entity.step_length()))?;
        }
        self.written.next = next;
        writeln!(self.out, "#{own} = SURFACE_CURVE('',#{curve},{},.CURVE_3D.);", List(&ids))
    }
}

/// Numbers of the entities that a line without quoted names refers to.
fn references(text: &str) -> impl Iterator<Item = usize> {
    let digits = |piece: &str| piece.find(|c: char| !c.is_ascii_digit()).unwrap_or(piece.len());
    text.split('#').skip(1).filter_map(move |piece| piece[..digits(piece)].parse().ok())
}

fn unexpected(line: &str) -> io::Error {
    io::Error::other(format!("unexpected STEP line: {line}"))
}

impl<W: Write> fmt::Write for Rewriter<'_, W> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let mut rest = text;
        while let Some((head, tail)) = rest.split_once('\n') {
            self.line.push_str(head);
            let passed = self.pass();
            self.line.clear();
            if let Err(e) = passed {
                self.error = Some(e);
                return Err(fmt::Error);
            }
            rest = tail;
        }
        self.line.push_str(rest);
        Ok(())
    }
}
