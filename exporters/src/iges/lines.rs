//! The lines of an IGES file: five sections of 80 columns, numbered; two lines of fixed fields an entity in the directory,
//! its parameters in free format.

use super::IgesOptions;
use crate::ExportError;
use crate::number::Real;
use glam::DVec3;
use std::fmt::{Display, Write as _};
use std::io::Write;

/// Columns of a line that parameters may take, before the number of their entity.
const PARAMETER_COLUMNS: usize = 64;

/// Columns that the global section may take.
const GLOBAL_COLUMNS: usize = 72;

/// Greatest number of a line.
const MOST_LINES: usize = 9_999_999;

/// An entity of the file, by its place in the directory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Pointer(usize);

impl Display for Pointer {
    /// The number of its first line in the directory.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        (2 * self.0 + 1).fmt(f)
    }
}

/// Part of what an entity's status number says: visible, and whether it stands alone and what it is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Status {
    /// Stands alone.
    Independent,
    /// Part of the entity that points to it.
    Dependent,
    /// The same, and its directory attributes are those of the entity that points to it.
    List,
    /// Part of another entity, and a curve in the parameters of a surface.
    Parametric,
    /// A definition, such as of a colour.
    Definition,
}

impl Status {
    fn digits(self) -> &'static str {
        match self {
            Self::Independent => "00000000",
            Self::Dependent => "00010000",
            Self::List => "00010001",
            Self::Parametric => "00010500",
            Self::Definition => "00000200",
        }
    }
}

/// What the directory says of an entity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Directory<'a> {
    /// Type number.
    pub(super) kind: u16,
    /// Form number.
    pub(super) form: u8,
    pub(super) status: Status,
    /// At most 8 letters and digits.
    pub(super) label: &'a str,
    /// Number behind the label; none for 0.
    pub(super) subscript: usize,
    /// Level; none for 0.
    pub(super) level: usize,
    /// A colour definition.
    pub(super) color: Option<Pointer>,
}

impl Directory<'static> {
    pub(super) fn new(kind: u16, form: u8, status: Status) -> Self {
        Self { kind, form, status, label: "", subscript: 0, level: 0, color: None }
    }
}

/// Parameters in free format, broken into lines between them.
struct Fields {
    width: usize,
    text: String,
    /// Where the last line begins.
    start: usize,
}

impl Fields {
    fn new(width: usize) -> Self {
        Self { width, text: String::new(), start: 0 }
    }

    fn clear(&mut self) {
        self.text.clear();
        self.start = 0;
    }

    fn put(&mut self, parameter: impl Display) {
        let before = self.text.len();
        // Writing into a string cannot fail.
        let _ = write!(self.text, "{parameter},");
        if self.text.len() - self.start > self.width && before > self.start {
            self.text.insert(before, '\n');
            self.start = before + 1;
        }
    }

    /// A string, which may take several lines: the only parameter that the format lets break.
    fn put_text(&mut self, text: &str) {
        let plain: String = text.chars().map(|c| if matches!(c, ' '..='~') { c } else { '_' }).collect();
        if plain.is_empty() {
            return self.put("");
        }
        let counted = format!("{}H{plain}", plain.len());
        if counted.len() < self.width {
            return self.put(counted);
        }
        for c in counted.chars().chain([',']) {
            if self.text.len() - self.start == self.width {
                self.text.push('\n');
                self.start = self.text.len();
            }
            self.text.push(c);
        }
    }

    /// The lines, the last one ended.
    fn lines(&mut self) -> impl Iterator<Item = &str> {
        self.text.pop();
        self.text.push(';');
        self.text.split('\n')
    }
}

/// The parameters of an entity.
pub(super) struct Record<'a> {
    fields: &'a mut Fields,
    farthest: &'a mut f64,
}

impl Record<'_> {
    pub(super) fn integer(&mut self, value: usize) {
        self.fields.put(value);
    }

    pub(super) fn flag(&mut self, value: bool) {
        self.fields.put(u8::from(value));
    }

    pub(super) fn pointer(&mut self, to: Pointer) {
        self.fields.put(to);
    }

    pub(super) fn real(&mut self, value: f64) {
        self.fields.put(Real(value));
    }

    /// One, which most weights are: there are as many as control points.
    pub(super) fn one(&mut self) {
        self.fields.put("1.");
    }

    /// A point in space.
    pub(super) fn point(&mut self, p: DVec3) {
        *self.farthest = self.farthest.max(p.abs().max_element());
        self.real(p.x);
        self.real(p.y);
        self.real(p.z);
    }
}

/// Directory and parameters of the entities so far.
pub(super) struct File {
    entities: usize,
    directory: String,
    parameters: String,
    parameter_lines: usize,
    fields: Fields,
    /// Greatest coordinate, mm.
    farthest: f64,
}

impl Default for File {
    fn default() -> Self {
        Self {
            entities: 0,
            directory: String::new(),
            parameters: String::new(),
            parameter_lines: 0,
            fields: Fields::new(PARAMETER_COLUMNS),
            farthest: 0.0,
        }
    }
}

impl File {
    /// Adds an entity with the parameters that `fill` gives after its type number.
    pub(super) fn add(&mut self, entry: &Directory<'_>, fill: impl FnOnce(&mut Record<'_>)) -> Pointer {
        let at = Pointer(self.entities);
        self.entities += 1;
        let first = self.parameter_lines + 1;
        self.fields.clear();
        self.fields.put(entry.kind);
        fill(&mut Record { fields: &mut self.fields, farthest: &mut self.farthest });
        for line in self.fields.lines() {
            self.parameter_lines += 1;
            // Writing into a string cannot fail, here and below.
            let _ = writeln!(self.parameters, "{line:<64} {at:>7}P{:07}", self.parameter_lines);
        }
        let count = self.parameter_lines + 1 - first;
        let (kind, line) = (entry.kind, 2 * at.0 + 1);
        let _ = writeln!(
            self.directory,
            "{kind:>8}{first:>8}{0:>8}{0:>8}{1:>8}{0:>8}{0:>8}{0:>8}{2}D{line:07}",
            0,
            entry.level,
            entry.status.digits()
        );
        let color = entry.color.map_or_else(|| "0".to_owned(), |c| format!("-{c}"));
        let _ = writeln!(
            self.directory,
            "{kind:>8}{0:>8}{color:>8}{count:>8}{1:>8}{2:>16}{3:>8}{4:>8}D{5:07}",
            0,
            entry.form,
            "",
            entry.label,
            entry.subscript,
            line + 1
        );
        at
    }

    /// Writes the whole file.
    pub(super) fn write(&self, options: &IgesOptions, out: &mut impl Write) -> Result<(), ExportError> {
        if self.parameter_lines > MOST_LINES || 2 * self.entities > MOST_LINES {
            return Err(ExportError::TooLarge { what: "the lines of an IGES file" });
        }
        writeln!(out, "{:<72}S{:07}", "Cooled blade, boundary representation, mm", 1)?;
        let mut global = global(options, self.farthest);
        let mut count = 0;
        for line in global.lines() {
            count += 1;
            writeln!(out, "{line:<72}G{count:07}")?;
        }
        out.write_all(self.directory.as_bytes())?;
        out.write_all(self.parameters.as_bytes())?;
        let end = format!("S{:07}G{count:07}D{:07}P{:07}", 1, 2 * self.entities, self.parameter_lines);
        writeln!(out, "{end:<72}T{:07}", 1)?;
        Ok(())
    }
}

/// The 26 parameters of the global section.
fn global(options: &IgesOptions, farthest: f64) -> Fields {
    let mut g = Fields::new(GLOBAL_COLUMNS);
    g.put_text(",");
    g.put_text(";");
    g.put_text(&options.name);
    g.put_text(&options.file_name);
    g.put_text("coolinggen");
    g.put_text(concat!("coolinggen ", env!("CARGO_PKG_VERSION")));
    // Bits of integers; powers of ten and digits of single and of double reals.
    for number in [32, 38, 6, 308, 15] {
        g.put(number);
    }
    g.put_text(&options.name);
    g.put(Real(1.0));
    // Millimetres.
    g.put(2);
    g.put_text("MM");
    // Line weights: one, of no width.
    g.put(1);
    g.put(Real(0.0));
    g.put_text(&options.time_stamp);
    g.put(Real(options.resolution_mm));
    g.put(Real(farthest));
    g.put_text(&options.author);
    g.put_text(&options.organisation);
    // Version 5.3, no drafting standard.
    g.put(11);
    g.put(0);
    g.put_text(&options.time_stamp);
    g.put_text("");
    g
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_break_between_and_strings_anywhere() {
        let mut fields = Fields::new(10);
        for n in [1234, 5678, 9, 10] {
            fields.put(n);
        }
        fields.put_text("abcdefghijkl\u{e9}");
        assert_eq!(fields.lines().collect::<Vec<_>>(), ["1234,5678,", "9,10,13Hab", "cdefghijkl", "_;"]);
        let mut fields = Fields::new(10);
        fields.put(1234567);
        fields.put_text("ab");
        fields.put_text("");
        assert_eq!(fields.lines().collect::<Vec<_>>(), ["1234567,", "2Hab,;"]);
    }
}
