//! The words that forms show: a title for every field and every alternative of the schema, made from its name where its
//! type does not say one.
//!
//! What a form needs stands in the schema beside each field: `title`, `description` (the tooltip), `unit`, `minimum`,
//! `exclusiveMinimum`, `maximum`, `default`; and `group`, the page of the form, at the fields of the design and of its
//! cooling.

use serde_json::{Map, Value};

/// Ends of names that say a unit, which the schema says apart.
const UNITS: [&str; 2] = ["_deg", "_d"];

/// Adds what is not there yet to a schema and all in it.
pub(super) fn add_titles(schema: &mut Value) {
    match schema {
        Value::Object(members) => {
            if let Some(Value::Object(properties)) = members.get_mut("properties") {
                for (name, field) in properties {
                    add_title(field, name);
                }
            }
            for list in ["oneOf", "anyOf"] {
                let alternatives = members.get_mut(list).and_then(Value::as_array_mut);
                for alternative in alternatives.into_iter().flatten() {
                    if let Some(name) = constant_of(alternative) {
                        add_title(alternative, &name);
                    }
                }
            }
            if let Some(Value::String(text)) = members.get_mut("description") {
                *text = flowing(text);
            }
            members.values_mut().for_each(add_titles);
        }
        Value::Array(entries) => entries.iter_mut().for_each(add_titles),
        _ => {}
    }
}

fn add_title(schema: &mut Value, name: &str) {
    if let Value::Object(members) = schema {
        members.entry("title").or_insert_with(|| title_of(name).into());
    }
}

/// What an alternative is told by: its own constant, or that of one of its fields.
fn constant_of(alternative: &Value) -> Option<String> {
    let of = |members: &Map<String, Value>| members.get("const")?.as_str().map(str::to_owned);
    let members = alternative.as_object()?;
    of(members).or_else(|| {
        let mut fields = members.get("properties")?.as_object()?.values();
        fields.find_map(|field| of(field.as_object()?))
    })
}

/// `lateral_expansion_deg` as `Lateral expansion`.
fn title_of(name: &str) -> String {
    let bare = UNITS.iter().find_map(|unit| name.strip_suffix(unit)).unwrap_or(name);
    let words = bare.replace(['_', '-'], " ");
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A text with line breaks between paragraphs alone.
fn flowing(text: &str) -> String {
    let paragraphs: Vec<String> = text.split("\n\n").map(|paragraph| paragraph.replace('\n', " ")).collect();
    paragraphs.join("\n\n")
}

#[cfg(test)]
mod tests {
    use super::super::design_schema;
    use super::*;

    #[test]
    fn titles_are_words() {
        assert_eq!(title_of("lateral_expansion_deg"), "Lateral expansion");
        assert_eq!(title_of("metering_length_d"), "Metering length");
        assert_eq!(title_of("medial-turbine"), "Medial turbine");
        assert_eq!(flowing("a\nb\n\nc"), "a b\n\nc");
    }

    /// Calls `see` with every field's path and schema.
    fn fields(schema: &Value, path: &str, see: &mut dyn FnMut(&str, &Map<String, Value>)) {
        match schema {
            Value::Object(members) => {
                let properties = members.get("properties").and_then(Value::as_object);
                for (name, field) in properties.into_iter().flatten() {
                    see(&format!("{path}/{name}"), field.as_object().unwrap());
                }
                members.iter().for_each(|(name, member)| fields(member, &format!("{path}/{name}"), see));
            }
            Value::Array(entries) => {
                entries.iter().enumerate().for_each(|(i, entry)| fields(entry, &format!("{path}/{i}"), see));
            }
            _ => {}
        }
    }

    #[test]
    fn every_field_has_what_a_form_shows() {
        /// Numbers without a unit.
        const PURE: [&str; 3] = ["exponent", "blade_count", "count"];
        let schema = design_schema();
        let (mut lacking, mut seen) = (Vec::new(), 0);
        fields(schema, "", &mut |path, field| {
            let name = path.rsplit('/').next().unwrap();
            if field.contains_key("const") {
                return;
            }
            seen += 1;
            for key in ["title", "description"] {
                if field.get(key).and_then(Value::as_str).is_none_or(str::is_empty) {
                    lacking.push(format!("{path}: {key}"));
                }
            }
            let text = field.get("type").map(Value::to_string).unwrap_or_default();
            let law = Value::Object(field.clone()).to_string().contains("#/$defs/LawSpec");
            if (text.contains("\"number\"") || law) && !PURE.contains(&name) && !field.contains_key("unit") {
                lacking.push(format!("{path}: unit"));
            }
        });
        assert_eq!(lacking, Vec::<String>::new());
        assert!(seen > 100, "{seen}");
        for page in [&schema["properties"], &schema["$defs"]["Cooling"]["properties"]] {
            for (name, field) in page.as_object().unwrap() {
                let grouped = field.get("group").is_some();
                assert!(grouped || ["format", "cooling"].contains(&name.as_str()), "{name}");
            }
        }
    }
}
