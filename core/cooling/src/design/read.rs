//! Reading a document of any size within bounds: lists longer than any that a design may have are counted, not kept.

use coolinggen_blade::{Fault, Pointer};
use serde::Deserializer;
use serde::de::{DeserializeSeed, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};
use std::cell::{Cell, RefCell};
use std::fmt;

/// Entries kept of a list: more than any that a design has use for.
const MOST_ENTRIES: usize = 100_000;
/// Values kept of a document: some 150 MB.
const MOST_VALUES: usize = 2_000_000;

/// Reads JSON; lists that are too long come back short, each with its fault.
///
/// # Errors
/// One fault with the line and column where the text is no JSON, or with what bound it breaks.
pub(super) fn read(text: &str) -> Result<(Value, Vec<Fault>), Vec<Fault>> {
    let bounds = Bounds::default();
    let mut reader = serde_json::Deserializer::from_str(text);
    let seed = Seed { bounds: &bounds, at: &Place::Root };
    let read = seed.deserialize(&mut reader).and_then(|value| reader.end().map(|()| value));
    let value = read.map_err(|e| {
        if bounds.values.get() > MOST_VALUES {
            let message = format!("the design has more than {MOST_VALUES} values");
            return vec![Fault::new("", "too_large", message).max(MOST_VALUES as f64).unit("values")];
        }
        let message = format!("not JSON: {e}");
        vec![Fault::new("", "syntax", message).hint("numbers such as NaN and comments are not JSON")]
    })?;
    Ok((value, bounds.faults.into_inner()))
}

/// What has been read so far.
#[derive(Default)]
struct Bounds {
    values: Cell<usize>,
    faults: RefCell<Vec<Fault>>,
}

/// Where in the document a value is; spelt out only for a fault.
enum Place<'a> {
    Root,
    Entry(&'a Place<'a>, usize),
    Member(&'a Place<'a>, &'a str),
}

impl Place<'_> {
    fn pointer(&self) -> Pointer {
        match self {
            Self::Root => Pointer::root(),
            Self::Entry(list, index) => list.pointer().at(index),
            Self::Member(object, name) => object.pointer().at(name),
        }
    }
}

/// Reads the value at a place.
#[derive(Clone, Copy)]
struct Seed<'a> {
    bounds: &'a Bounds,
    at: &'a Place<'a>,
}

impl<'de> DeserializeSeed<'de> for Seed<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, reader: D) -> Result<Value, D::Error> {
        self.bounds.values.set(self.bounds.values.get() + 1);
        if self.bounds.values.get() > MOST_VALUES {
            return Err(D::Error::custom("too many values"));
        }
        reader.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Seed<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_f64<E>(self, value: f64) -> Result<Value, E> {
        Ok(Number::from_f64(value).map_or(Value::Null, Value::Number))
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_string<E>(self, value: String) -> Result<Value, E> {
        Ok(value.into())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Value, A::Error> {
        let mut items = Vec::new();
        while items.len() < MOST_ENTRIES {
            let at = Place::Entry(self.at, items.len());
            match list.next_element_seed(Seed { bounds: self.bounds, at: &at })? {
                Some(item) => items.push(item),
                None => return Ok(Value::Array(items)),
            }
        }
        let mut count = items.len();
        while list.next_element::<IgnoredAny>()?.is_some() {
            count += 1;
        }
        if count > MOST_ENTRIES {
            let message = format!("has {count} entries, only the first {MOST_ENTRIES} were looked at");
            let fault = Fault::new(self.at.pointer(), "count", message).value(count).max(MOST_ENTRIES as f64);
            self.bounds.faults.borrow_mut().push(fault.unit("entries"));
        }
        Ok(Value::Array(items))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut object: A) -> Result<Value, A::Error> {
        let mut members = Map::new();
        while let Some(name) = object.next_key::<String>()? {
            let value =
                object.next_value_seed(Seed { bounds: self.bounds, at: &Place::Member(self.at, &name) })?;
            members.insert(name, value);
        }
        Ok(Value::Object(members))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_as_serde_json_does() {
        let text = r#" {"a~/": [1, -2, 3.5, 1e300, -0.0, 18446744073709551615, null, true, "\u00fc\n", {}, []], "a": 1, "a": 2} "#;
        let (value, faults) = read(text).unwrap();
        assert_eq!(value, serde_json::from_str::<Value>(text).unwrap());
        assert_eq!(faults, Vec::new());
    }

    #[test]
    fn what_is_no_json_is_refused() {
        for text in ["", "{", "[1,]", "NaN", "1e999", "{} {}", "{\"a\":1,}", "'a'", &"[".repeat(100_000)] {
            let faults = read(text).unwrap_err();
            assert_eq!((faults.len(), faults[0].code), (1, "syntax"), "{text:.20}");
        }
    }

    #[test]
    fn long_lists_are_counted_and_cut() {
        let long = vec!["0"; MOST_ENTRIES + 1].join(",");
        let (value, faults) = read(&format!("{{\"x\":[1,[{long}]],\"y\":[{long},0]}}")).unwrap();
        assert_eq!(value["x"][1].as_array().unwrap().len(), MOST_ENTRIES);
        let told: Vec<_> = faults.iter().map(|f| (f.pointer.as_str(), f.value.clone())).collect();
        assert_eq!(
            told,
            [("/x/1", Some((MOST_ENTRIES + 1).into())), ("/y", Some((MOST_ENTRIES + 2).into()))]
        );
        assert!(read(&format!("[{}]", &long[..2 * MOST_ENTRIES - 1])).unwrap().1.is_empty());
    }

    #[test]
    fn many_lists_are_too_much() {
        let list = format!("[{}]", vec!["0"; MOST_ENTRIES].join(","));
        let text = format!("[{}]", vec![list; MOST_VALUES / MOST_ENTRIES].join(","));
        assert_eq!(read(&text).unwrap_err()[0].code, "too_large");
    }
}
