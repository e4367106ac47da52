//! ISO 10303-21 clear text: just enough to find entities and their parameters.
//!
//! The file is cut into instances first; parameters are parsed when asked for. A blade needs a few hundred of the
//! hundreds of thousands of instances that an assembly may have.

use std::collections::BTreeMap;

/// An exchange file, cut into instances.
pub(super) struct Exchange<'a> {
    instances: BTreeMap<u64, &'a str>,
}

/// A parameter.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    /// `#12`.
    Reference(u64),
    /// A number, integer or real.
    Number(f64),
    /// `'text'`, without its quotes.
    Text(String),
    /// `.ENUM.`, or `$` and `*` as an empty one.
    Word(String),
    /// `( ... )`.
    List(Vec<Value>),
    /// `TYPE( ... )`.
    Typed(String, Vec<Value>),
}

/// Why a file cannot be read.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Broken {
    /// Nothing in it.
    Empty,
    /// It does not begin like a STEP file.
    NotStep,
    /// It has no end.
    CutShort,
    /// An instance that is no instance.
    Malformed { id: u64 },
    /// A reference to an instance that is not there.
    Dangling { id: u64 },
}

/// Lists are nested at most this deep.
const DEEPEST: usize = 12;

impl<'a> Exchange<'a> {
    /// Cuts `text` into instances.
    pub(super) fn new(text: &'a str) -> Result<Self, Broken> {
        let trimmed = text.trim_start_matches('\u{feff}').trim();
        if trimmed.is_empty() {
            return Err(Broken::Empty);
        }
        if !trimmed.starts_with("ISO-10303-21") {
            return Err(Broken::NotStep);
        }
        let mut instances = BTreeMap::new();
        let mut ended = false;
        for statement in (Statements { rest: trimmed }) {
            if statement.starts_with("END-ISO-10303-21") {
                ended = true;
                break;
            }
            let Some(body) = statement.strip_prefix('#') else { continue };
            let Some((id, body)) = body.split_once('=') else { continue };
            if let Ok(id) = id.trim().parse() {
                instances.insert(id, body.trim());
            }
        }
        if ended { Ok(Self { instances }) } else { Err(Broken::CutShort) }
    }

    /// All instances whose text contains `word`, with their records: one for a simple instance, several for a complex
    /// one.
    pub(super) fn with_word(&self, word: &str) -> Result<Vec<(u64, Vec<Value>)>, Broken> {
        let named = self.instances.iter().filter(|(_, body)| body.contains(word));
        named.map(|(&id, body)| Ok((id, records(body).ok_or(Broken::Malformed { id })?))).collect()
    }

    /// The records of instance `id`.
    pub(super) fn records(&self, id: u64) -> Result<Vec<Value>, Broken> {
        let body = self.instances.get(&id).ok_or(Broken::Dangling { id })?;
        records(body).ok_or(Broken::Malformed { id })
    }

    /// How many instances of each kind of elementary or swept surface there are: what a file has instead.
    pub(super) fn surface_kinds(&self) -> BTreeMap<&'a str, usize> {
        let mut kinds = BTreeMap::new();
        for body in self.instances.values() {
            let keyword = body.split('(').next().unwrap_or("").trim();
            if keyword.ends_with("_SURFACE") || keyword.starts_with("SURFACE_OF_") || keyword == "PLANE" {
                *kinds.entry(keyword).or_insert(0) += 1;
            }
        }
        kinds
    }
}

/// The parameters of the record named `keyword`.
pub(super) fn record<'v>(records: &'v [Value], keyword: &str) -> Option<&'v [Value]> {
    records.iter().find_map(|r| match r {
        Value::Typed(name, values) if name == keyword => Some(&values[..]),
        _ => None,
    })
}

/// Statements up to their semicolons, without comments around them.
struct Statements<'a> {
    rest: &'a str,
}

impl<'a> Iterator for Statements<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        loop {
            self.rest = self.rest.trim_start();
            if let Some(comment) = self.rest.strip_prefix("/*") {
                self.rest = comment.split_once("*/").map_or("", |(_, after)| after);
                continue;
            }
            break;
        }
        let bytes = self.rest.as_bytes();
        let mut quoted = false;
        for (i, b) in bytes.iter().enumerate() {
            match b {
                b'\'' => quoted = !quoted,
                b';' if !quoted => {
                    let statement = &self.rest[..i];
                    self.rest = &self.rest[i + 1..];
                    return Some(statement.trim());
                }
                _ => {}
            }
        }
        // What is left has no end.
        self.rest = "";
        None
    }
}

fn records(body: &str) -> Option<Vec<Value>> {
    let mut parser = Parser { bytes: body.as_bytes(), at: 0 };
    parser.skip();
    if parser.peek() == Some(b'(') {
        // A complex instance: records one after the other in parentheses.
        parser.at += 1;
        let mut records = Vec::new();
        loop {
            parser.skip();
            if parser.peek()? == b')' {
                return Some(records);
            }
            records.push(parser.value(0)?);
        }
    }
    Some(vec![parser.value(0)?])
}

struct Parser<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Parser<'_> {
    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn skip(&mut self) {
        loop {
            while self.peek().is_some_and(|b| b.is_ascii_whitespace()) {
                self.at += 1;
            }
            if !self.bytes[self.at.min(self.bytes.len())..].starts_with(b"/*") {
                return;
            }
            let rest = &self.bytes[self.at + 2..];
            let end = rest.windows(2).position(|w| w == b"*/");
            self.at = end.map_or(self.bytes.len(), |e| self.at + 4 + e);
        }
    }

    fn word(&mut self, allowed: impl Fn(u8) -> bool) -> String {
        let start = self.at;
        while self.peek().is_some_and(&allowed) {
            self.at += 1;
        }
        String::from_utf8_lossy(&self.bytes[start..self.at]).into_owned()
    }

    fn value(&mut self, depth: usize) -> Option<Value> {
        if depth > DEEPEST {
            return None;
        }
        self.skip();
        match self.peek()? {
            b'#' => {
                self.at += 1;
                self.word(|b| b.is_ascii_digit()).parse().ok().map(Value::Reference)
            }
            b'\'' => self.text().map(Value::Text),
            b'.' => {
                self.at += 1;
                let word = self.word(|b| b.is_ascii_alphanumeric() || b == b'_');
                self.at += 1;
                Some(Value::Word(word))
            }
            b'$' | b'*' => {
                self.at += 1;
                Some(Value::Word(String::new()))
            }
            b'"' => {
                self.at += 1;
                let word = self.word(|b| b != b'"');
                self.at += 1;
                Some(Value::Word(word))
            }
            b'(' => self.list(depth).map(Value::List),
            b if b.is_ascii_digit() || b == b'-' || b == b'+' => {
                let number = self.word(|b| b.is_ascii_digit() || b"+-.eE".contains(&b));
                number.parse().ok().map(Value::Number)
            }
            b if b.is_ascii_alphabetic() || b == b'_' => {
                let name = self.word(|b| b.is_ascii_alphanumeric() || b == b'_');
                self.skip();
                if self.peek()? == b'(' { self.list(depth).map(|l| Value::Typed(name, l)) } else { None }
            }
            _ => None,
        }
    }

    fn list(&mut self, depth: usize) -> Option<Vec<Value>> {
        self.at += 1;
        let mut values = Vec::new();
        loop {
            self.skip();
            match self.peek()? {
                b')' => {
                    self.at += 1;
                    return Some(values);
                }
                b',' => self.at += 1,
                _ => values.push(self.value(depth + 1)?),
            }
        }
    }

    fn text(&mut self) -> Option<String> {
        self.at += 1;
        let mut text = Vec::new();
        loop {
            let b = self.peek()?;
            self.at += 1;
            if b == b'\'' {
                // A doubled quote is one quote.
                if self.peek() != Some(b'\'') {
                    return Some(String::from_utf8_lossy(&text).into_owned());
                }
                self.at += 1;
            }
            text.push(b);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_simple_and_complex_instances() {
        let text = "ISO-10303-21;\nHEADER;ENDSEC;\nDATA;\n/* a ; comment */\n#1 = CARTESIAN_POINT('it''s; here',(1.,-2.5E1,3));\n\
                    #2=(A(#1,.T.)B((1,2),(3)) C());\nENDSEC;\nEND-ISO-10303-21;\n";
        let file = Exchange::new(text).unwrap();
        let one = file.records(1).unwrap();
        let point = record(&one, "CARTESIAN_POINT").unwrap();
        assert_eq!(point[0], Value::Text("it's; here".into()));
        assert_eq!(point[1], Value::List(vec![Value::Number(1.0), Value::Number(-25.0), Value::Number(3.0)]));
        let two = file.records(2).unwrap();
        assert_eq!(record(&two, "A").unwrap(), [Value::Reference(1), Value::Word("T".into())]);
        assert_eq!(record(&two, "B").unwrap().len(), 2);
        assert!(record(&two, "C").unwrap().is_empty());
        assert_eq!(file.records(3), Err(Broken::Dangling { id: 3 }));
    }

    #[test]
    fn says_what_is_wrong() {
        assert_eq!(Exchange::new("  \n").err(), Some(Broken::Empty));
        assert_eq!(Exchange::new("solid cube").err(), Some(Broken::NotStep));
        let cut = "ISO-10303-21;DATA;#1=CARTESIAN_POINT('',(1.,2";
        assert_eq!(Exchange::new(cut).err(), Some(Broken::CutShort));
        let deep = format!("ISO-10303-21;DATA;#1=A({});ENDSEC;END-ISO-10303-21;", "(".repeat(5000));
        assert_eq!(Exchange::new(&deep).unwrap().records(1), Err(Broken::Malformed { id: 1 }));
    }
}
