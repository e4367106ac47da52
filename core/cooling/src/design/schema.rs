//! The JSON Schema of a design, and a check of a document against it that finds every fault.
//!
//! serde stops at its first error; a user wants all of them, with the pointer, the value, the limit and the unit. The
//! walker below knows the part of JSON Schema that the design types use, and nothing else.

use super::Design;
use super::spelling::nearest;
use super::words::add_titles;
use coolinggen_blade::Fault;
use serde_json::{Map, Value};
use std::sync::OnceLock;

/// JSON Schema (draft 2020-12) of a design, with what forms show beside each field.
pub fn design_schema() -> &'static Value {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    SCHEMA.get_or_init(|| {
        let mut schema = schemars::schema_for!(Design).to_value();
        add_titles(&mut schema);
        schema
    })
}

/// More faults than this are counted, not listed: a million bad points say no more than a hundred.
const LISTED: usize = 100;

/// All faults of `document` against the schema of a design.
pub fn schema_faults(document: &Value) -> Vec<Fault> {
    faults_against(design_schema(), document)
}

/// All faults of `document` against a schema that was derived from a type.
pub fn faults_against(schema: &'static Value, document: &Value) -> Vec<Fault> {
    let mut walk = Walk { root: schema, faults: Vec::new(), found: 0 };
    walk.check(schema, document, &mut String::new(), &Limits::default());
    if walk.found > LISTED {
        let message = format!("{} more faults of this kind are not listed", walk.found - LISTED);
        walk.faults.push(Fault::new("", "more", message));
    }
    walk.faults
}

struct Walk {
    root: &'static Value,
    faults: Vec<Fault>,
    found: usize,
}

/// Limits and unit said beside a `$ref`, which hold for the numbers below it: a law's limits hold for its values.
#[derive(Clone, Copy, Default)]
struct Limits {
    minimum: Option<f64>,
    maximum: Option<f64>,
    unit: Option<&'static str>,
    /// Below a law's schema: in its control points `[v, value]` the limits are the values', not the abscissae's.
    law: bool,
}

impl Limits {
    fn narrowed(&self, words: &Words) -> Self {
        // What the type holds limits what its field does not.
        let widest = (words.format == Some("uint32")).then_some(f64::from(u32::MAX));
        Self {
            minimum: words.minimum.or(self.minimum),
            maximum: words.maximum.or(self.maximum).or(widest),
            unit: words.unit.or(self.unit),
            law: self.law || words.law,
        }
    }
}

/// The words of a schema that every value is checked by, read in one pass: a table of points has thousands of values.
#[derive(Clone, Copy, Default)]
struct Words {
    reference: Option<&'static str>,
    any_of: Option<&'static [Value]>,
    one_of: Option<&'static [Value]>,
    constant: Option<&'static Value>,
    allowed: Option<&'static [Value]>,
    kind: Option<&'static Value>,
    format: Option<&'static str>,
    minimum: Option<f64>,
    maximum: Option<f64>,
    unit: Option<&'static str>,
    law: bool,
}

impl Words {
    fn of(schema: &'static Map<String, Value>) -> Self {
        let mut words = Self::default();
        for (key, word) in schema {
            let array = || word.as_array().map(Vec::as_slice);
            match key.as_str() {
                "$ref" => words.reference = word.as_str(),
                "anyOf" => words.any_of = array(),
                "oneOf" => words.one_of = array(),
                "const" => words.constant = Some(word),
                "enum" => words.allowed = array(),
                "type" => words.kind = Some(word),
                "format" => words.format = word.as_str(),
                "minimum" => words.minimum = word.as_f64(),
                "maximum" => words.maximum = word.as_f64(),
                "unit" => words.unit = word.as_str(),
                "law" => words.law = word == &Value::Bool(true),
                _ => {}
            }
        }
        words
    }
}

impl Walk {
    fn report(&mut self, fault: Fault) {
        self.found += 1;
        if self.found <= LISTED {
            self.faults.push(fault);
        }
    }

    fn resolve(&self, reference: &str) -> &'static Value {
        let pointer = reference.strip_prefix('#').unwrap_or(reference);
        self.root.pointer(pointer).unwrap_or(&Value::Bool(true))
    }

    fn check(&mut self, schema: &'static Value, value: &Value, pointer: &mut String, limits: &Limits) {
        let Some(schema) = schema.as_object() else { return };
        let words = Words::of(schema);
        let limits = limits.narrowed(&words);
        if let Some(reference) = words.reference {
            self.check(self.resolve(reference), value, pointer, &limits);
            return;
        }
        if let Some(options) = words.any_of.or(words.one_of) {
            self.check_options(options, value, pointer, &limits);
            return;
        }
        if let Some(expected) = words.constant {
            if value != expected {
                let message = format!("must be {expected}");
                self.report(Fault::new(&*pointer, "constant", message).value(shown(value)));
            }
            return;
        }
        if let Some(allowed) = words.allowed {
            if !allowed.contains(value) {
                let list: Vec<String> = allowed.iter().map(Value::to_string).collect();
                let message = format!("must be one of {}", list.join(", "));
                self.report(Fault::new(&*pointer, "choice", message).value(shown(value)));
            }
            return;
        }
        if !self.check_type(words.kind, value, pointer) {
            return;
        }
        match value {
            Value::Object(members) => self.check_object(schema, members, pointer),
            Value::Array(items) => self.check_array(schema, items, pointer, &limits),
            Value::Number(_) => self.check_number(value, pointer, &limits),
            Value::String(text) => self.check_string(schema, text, pointer),
            Value::Null | Value::Bool(_) => {}
        }
    }

    fn check_type(&mut self, kind: Option<&Value>, value: &Value, pointer: &str) -> bool {
        let names: Vec<&str> = match kind {
            Some(Value::String(name)) if is_of_type(value, name) => return true,
            Some(Value::String(name)) => vec![name],
            Some(Value::Array(names)) => names.iter().filter_map(Value::as_str).collect(),
            _ => return true,
        };
        if names.iter().any(|name| is_of_type(value, name)) {
            return true;
        }
        let message = format!("must be {}, not {}", names.join(" or "), type_name(value));
        self.report(Fault::new(pointer, "type", message).value(shown(value)));
        false
    }

    fn check_object(
        &mut self,
        schema: &'static Map<String, Value>,
        members: &Map<String, Value>,
        pointer: &mut String,
    ) {
        let empty = Map::new();
        let properties = schema.get("properties").and_then(Value::as_object);
        let known = |name: &str| properties.and_then(|p| p.get(name));
        for name in
            schema.get("required").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str)
        {
            if !members.contains_key(name) {
                let message = format!("the field \"{name}\" is missing");
                let at = format!("{pointer}/{}", escape(name));
                self.report(Fault::new(&at, "missing", message));
            }
        }
        let closed = schema.get("additionalProperties") == Some(&Value::Bool(false));
        for (name, member) in members {
            let length = pointer.len();
            pointer.push('/');
            pointer.push_str(&escape(name));
            if let Some(schema) = known(name) {
                // Limits do not reach into the fields of an object.
                self.check(schema, member, pointer, &Limits::default());
            } else if closed {
                let names = properties.unwrap_or(&empty).keys().map(String::as_str);
                let mut fault =
                    Fault::new(&*pointer, "unknown", format!("there is no field \"{name}\" here"));
                if let Some(near) = nearest(name, names) {
                    fault = fault.hint(format!("did you mean \"{near}\"?"));
                }
                self.report(fault);
            }
            pointer.truncate(length);
        }
    }

    fn check_array(
        &mut self,
        schema: &'static Map<String, Value>,
        items: &[Value],
        pointer: &mut String,
        limits: &Limits,
    ) {
        let bound = |key: &str| schema.get(key).and_then(Value::as_u64);
        let count = items.len() as u64;
        let (least, most) = (bound("minItems"), bound("maxItems"));
        if least.is_some_and(|least| count < least) || most.is_some_and(|most| count > most) {
            let fault = Fault::new(&*pointer, "count", format!("has {count} entries"));
            let fault = fault.value(count).unit("entries");
            self.report(between(fault, least.map(|n| n as f64), most.map(|n| n as f64)));
            if most.is_some_and(|most| count > most) {
                return;
            }
        }
        let (prefix, rest) = (schema.get("prefixItems").and_then(Value::as_array), schema.get("items"));
        for (i, item) in items.iter().enumerate() {
            let own = prefix.and_then(|p| p.get(i)).or(rest);
            if let Some(own) = own {
                let length = pointer.len();
                pointer.push('/');
                pointer.push_str(&i.to_string());
                let abscissa = limits.law && i == 0 && item.is_number();
                let limits = if abscissa { &Limits::default() } else { limits };
                self.check(own, item, pointer, limits);
                pointer.truncate(length);
            }
        }
    }

    fn check_number(&mut self, value: &Value, pointer: &str, limits: &Limits) {
        let Some(number) = value.as_f64() else { return };
        let low = limits.minimum.is_some_and(|least| !(number >= least));
        let high = limits.maximum.is_some_and(|most| !(number <= most));
        if low || high || !number.is_finite() {
            let side = if low { "too small" } else { "too large" };
            let fault = Fault::new(pointer, "range", side).value(shown(value));
            let mut fault = between(fault, limits.minimum, limits.maximum);
            if let Some(unit) = limits.unit {
                fault = fault.unit(unit);
            }
            self.report(fault);
        }
    }

    fn check_string(&mut self, schema: &Map<String, Value>, text: &str, pointer: &str) {
        let bound = |key: &str| schema.get(key).and_then(Value::as_u64);
        let letters = text.chars().count() as u64;
        let (least, most) = (bound("minLength"), bound("maxLength"));
        if least.is_some_and(|least| letters < least) || most.is_some_and(|most| letters > most) {
            let fault = Fault::new(pointer, "length", format!("has {letters} letters")).value(text);
            let fault = between(fault, least.map(|n| n as f64), most.map(|n| n as f64));
            self.report(fault.unit("letters"));
            return;
        }
        let Some(pattern) = schema.get("pattern").and_then(Value::as_str) else { return };
        if !name_matches(pattern, text) {
            let message = format!("must match {pattern}");
            self.report(
                Fault::new(pointer, "pattern", message)
                    .value(text)
                    .hint("letters, digits and signs in that pattern, beginning with a letter or digit"),
            );
        }
    }

    /// Alternatives: by their tag if they have one, else by JSON type.
    fn check_options(
        &mut self,
        options: &'static [Value],
        value: &Value,
        pointer: &mut String,
        limits: &Limits,
    ) {
        let options: Vec<&'static Value> = options.iter().map(|o| self.dereferenced(o)).collect();
        if let Some(tag) = options.iter().find_map(|o| tag_of(o)) {
            let Some(members) = value.as_object() else {
                let message = format!("must be object, not {}", type_name(value));
                self.report(Fault::new(&*pointer, "type", message).value(shown(value)));
                return;
            };
            let given = members.get(tag.0);
            let chosen = options.iter().find(|o| tag_of(o).is_some_and(|t| Some(t.1) == given));
            if let Some(chosen) = chosen {
                self.check(chosen, value, pointer, limits);
                return;
            }
            let names: Vec<String> = options.iter().filter_map(|o| Some(tag_of(o)?.1.to_string())).collect();
            let at = format!("{pointer}/{}", tag.0);
            let fault = match given {
                Some(given) => Fault::new(&at, "choice", format!("must be one of {}", names.join(", ")))
                    .value(shown(given)),
                None => Fault::new(&at, "missing", format!("the field \"{}\" is missing", tag.0))
                    .hint(format!("one of {}", names.join(", "))),
            };
            self.report(fault);
            return;
        }
        let constants: Vec<&Value> = options.iter().filter_map(|o| o.get("const")).collect();
        if constants.len() == options.len() {
            if !constants.contains(&value) {
                let list: Vec<String> = constants.iter().map(ToString::to_string).collect();
                let message = format!("must be one of {}", list.join(", "));
                self.report(Fault::new(&*pointer, "choice", message).value(shown(value)));
            }
            return;
        }
        let fits = |o: &&&'static Value| match o.get("type") {
            Some(Value::String(name)) => is_of_type(value, name),
            Some(Value::Array(names)) => names.iter().filter_map(Value::as_str).any(|n| is_of_type(value, n)),
            _ => o.get("const").is_none_or(|c| c == value),
        };
        if let Some(chosen) = options.iter().find(fits) {
            self.check(chosen, value, pointer, limits);
            return;
        }
        let names: Vec<&str> = options.iter().filter_map(|o| o.get("type")?.as_str()).collect();
        let message = format!("must be {}, not {}", names.join(" or "), type_name(value));
        self.report(Fault::new(&*pointer, "type", message).value(shown(value)));
    }

    fn dereferenced(&self, schema: &'static Value) -> &'static Value {
        match schema.get("$ref").and_then(Value::as_str) {
            Some(reference) => self.resolve(reference),
            None => schema,
        }
    }
}

/// The fault with its limits.
fn between(fault: Fault, least: Option<f64>, most: Option<f64>) -> Fault {
    let fault = match least {
        Some(least) => fault.min(least),
        None => fault,
    };
    match most {
        Some(most) => fault.max(most),
        None => fault,
    }
}

/// The field with a constant value by which an alternative is told, and that value.
fn tag_of(schema: &Value) -> Option<(&str, &Value)> {
    let properties = schema.get("properties")?.as_object()?;
    properties.iter().find_map(|(name, p)| Some((name.as_str(), p.get("const")?)))
}

/// A value short enough to print; long ones are cut.
fn shown(value: &Value) -> Value {
    match value {
        Value::Array(_) | Value::Object(_) => Value::from(type_name(value)),
        Value::String(text) if text.len() > 80 => Value::from(text.chars().take(80).collect::<String>()),
        _ => value.clone(),
    }
}

fn is_of_type(value: &Value, name: &str) -> bool {
    match name {
        "integer" => value.is_u64() || value.is_i64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        "null" => value.is_null(),
        _ => false,
    }
}

fn type_name(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(_) => "number",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    }
}

/// A JSON pointer's reference token (RFC 6901).
fn escape(name: &str) -> String {
    name.replace('~', "~0").replace('/', "~1")
}

/// The patterns that the design types use all have the form `^[A-Za-z0-9][A-Za-z0-9EXTRA]{0,MOST}$`: names.
fn name_matches(pattern: &str, text: &str) -> bool {
    let inner = pattern.strip_prefix("^[A-Za-z0-9][A-Za-z0-9").and_then(|p| p.strip_suffix("}$"));
    let Some((extra, most)) = inner.and_then(|p| p.split_once("]{0,")) else { return true };
    let most: usize = most.parse().unwrap_or(usize::MAX);
    let mut letters = text.bytes();
    let first = letters.next().is_some_and(|c| c.is_ascii_alphanumeric());
    first
        && text.len() <= most + 1
        && letters.all(|c| c.is_ascii_alphanumeric() || extra.as_bytes().contains(&c))
}
