//! The pass over truck's entities: names on faces and solids, which truck leaves out.

use super::text::Text;
use std::fmt;
use std::io::{self, Write};

/// Entities below this number are truck's own preamble, which is replaced.
pub(crate) const FIRST_ENTITY: usize = 16;

/// What the writer learnt on the way.
#[derive(Default)]
pub(crate) struct Written {
    /// Entity of each solid.
    pub(crate) solids: Vec<usize>,
    /// Entity of each face, solid by solid.
    pub(crate) faces: Vec<usize>,
    /// Greatest entity number.
    pub(crate) last: usize,
}

/// Takes truck's text line by line (one line is one entity, as our geometry prints), renames what must be renamed
/// and passes it on. The n-th `FACE_SURFACE` is face n, the n-th brep is solid n.
pub(crate) struct Rewriter<'a, W: Write> {
    out: &'a mut W,
    line: String,
    solid_names: &'a [&'a str],
    face_names: &'a [&'a str],
    outer_bound_next: bool,
    pub(crate) written: Written,
    pub(crate) error: Option<io::Error>,
}

impl<'a, W: Write> Rewriter<'a, W> {
    pub(crate) fn new(out: &'a mut W, solid_names: &'a [&'a str], face_names: &'a [&'a str]) -> Self {
        Self {
            out,
            line: String::new(),
            solid_names,
            face_names,
            outer_bound_next: false,
            written: Written::default(),
            error: None,
        }
    }

    fn pass(&mut self) -> io::Result<()> {
        let line = &self.line;
        let Some((id, body)) = line.strip_prefix('#').and_then(|rest| rest.split_once(" = ")) else {
            return Ok(());
        };
        let Some(id) = id.parse::<usize>().ok().filter(|&id| id >= FIRST_ENTITY) else { return Ok(()) };
        self.written.last = self.written.last.max(id);
        if let Some(rest) = body.strip_prefix("FACE_SURFACE(''") {
            let name = self.face_names.get(self.written.faces.len()).copied().unwrap_or_default();
            self.written.faces.push(id);
            self.outer_bound_next = true;
            return writeln!(self.out, "#{id} = ADVANCED_FACE({}{rest}", Text(name));
        }
        if let (true, Some(rest)) = (self.outer_bound_next, body.strip_prefix("FACE_BOUND(")) {
            self.outer_bound_next = false;
            return writeln!(self.out, "#{id} = FACE_OUTER_BOUND({rest}");
        }
        for kind in ["MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS"] {
            if let Some(rest) = body.strip_prefix(kind).and_then(|rest| rest.strip_prefix("(''")) {
                let name = self.solid_names.get(self.written.solids.len()).copied().unwrap_or_default();
                self.written.solids.push(id);
                return writeln!(self.out, "#{id} = {kind}({}{rest}", Text(name));
            }
        }
        writeln!(self.out, "{line}")
    }
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
