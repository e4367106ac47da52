//! Mutations of a document: numbers, types, structure, lengths of lists, and the text itself.

use super::draw::Draw;
use serde_json::{Map, Value, json};

/// The text of a mutated design.
pub(crate) fn mutated(design: &Value, draw: &mut Draw) -> String {
    let mut design = design.clone();
    // A gentle change leaves most designs sound enough to reach the build; the wild ones test what stands before.
    if draw.once_in(5) {
        for _ in 0..=draw.below(3) {
            let place = if draw.once_in(2) { &mut design["cooling"] } else { &mut design };
            change(place, draw, gentle);
        }
        return design.to_string();
    }
    for _ in 0..=draw.below(3) {
        change(&mut design, draw, wild);
    }
    let text = design.to_string();
    if draw.once_in(12) { spoilt(text, draw) } else { text }
}

/// Applies `how` to one value, each depth of the document being as likely as its neighbours: long lists of points do
/// not take all the changes.
fn change(value: &mut Value, draw: &mut Draw, how: fn(&mut Value, &mut Draw)) {
    let children = match value {
        Value::Array(items) => items.len(),
        Value::Object(members) => members.len(),
        _ => 0,
    };
    if children == 0 || draw.once_in(8) {
        return how(value, draw);
    }
    let k = draw.below(children);
    match value {
        Value::Array(items) => change(&mut items[k], draw, how),
        Value::Object(members) => {
            if let Some(member) = members.values_mut().nth(k) {
                change(member, draw, how);
            }
        }
        _ => {}
    }
}

/// Every number in it times nearly one; one number alone sometimes by more, up to where geometry gives way.
fn gentle(value: &mut Value, draw: &mut Draw) {
    match value {
        Value::Number(n) => {
            let factor = if draw.once_in(2) { draw.between(0.9, 1.1) } else { draw.between(0.2, 4.0) };
            let whole = n.is_u64() || n.is_i64();
            let changed = n.as_f64().unwrap_or(1.0) * factor;
            // Degrees stay whole numbers, dimensions need not.
            *value = if whole && draw.once_in(2) { json!(changed.round()) } else { json!(changed) };
        }
        Value::Array(items) => {
            let factor = draw.between(0.99, 1.01);
            items.iter_mut().for_each(|item| scale(item, factor));
        }
        _ => {}
    }
}

fn scale(value: &mut Value, factor: f64) {
    match value {
        Value::Number(n) => *value = json!(n.as_f64().unwrap_or(1.0) * factor),
        Value::Array(items) => items.iter_mut().for_each(|item| scale(item, factor)),
        _ => {}
    }
}

fn wild(value: &mut Value, draw: &mut Draw) {
    if draw.once_in(6) {
        *value = strange(draw);
        return;
    }
    match value {
        Value::Number(n) => *value = number(n.as_f64().unwrap_or(0.0), draw),
        Value::String(_) => *value = json!(*draw.of(&WORDS)),
        Value::Array(items) => list(items, draw),
        Value::Object(members) => object(members, draw),
        Value::Null | Value::Bool(_) => *value = strange(draw),
    }
}

const WORDS: [&str; 12] = [
    "",
    "NaN",
    "-Infinity",
    "1e999",
    "null",
    "camber",
    "step",
    "stream",
    "../../etc",
    "a/b~c",
    "sections",
    "Ünï\u{0}",
];

fn number(n: f64, draw: &mut Draw) -> Value {
    match draw.below(14) {
        0 => json!(-n),
        1 => json!(0),
        2 => json!(-0.0),
        3 => json!(*draw.of(&[1e308, -1e308, 1e30, -1e30, 1e9])),
        4 => json!(*draw.of(&[1e-300, -1e-300, 5e-324, 1e-12, 1e-6])),
        5 => json!(u64::MAX),
        6 => json!(i64::MIN),
        7 => json!(n + draw.between(-1.0, 1.0)),
        8 => json!(n * draw.between(0.1, 0.9)),
        9 => json!(n * draw.between(1.1, 10.0)),
        10 => json!(n * 1000.0),
        11 => json!(n.round()),
        12 => json!(draw.between(-1.0, 2.0)),
        _ => json!([[0, n], [draw.between(-0.5, 1.5), n * draw.between(0.5, 1.5)]]),
    }
}

fn strange(draw: &mut Draw) -> Value {
    match draw.below(10) {
        0 => Value::Null,
        1 => json!(true),
        2 => json!([]),
        3 => json!({}),
        4 => json!([[0, 1], [0, 1]]),
        5 => json!([[1, 1], [0, 2]]),
        6 => json!("x".repeat(draw.below(2000))),
        7 => json!(draw.between(-1e3, 1e3)),
        8 => (0..draw.below(100)).fold(json!(1), |inner, _| json!([inner])),
        _ => (0..draw.below(100)).fold(json!(1), |inner, _| json!({"kind": inner})),
    }
}

fn list(items: &mut Vec<Value>, draw: &mut Draw) {
    if items.is_empty() {
        items.push(strange(draw));
        return;
    }
    let (i, j) = (draw.below(items.len()), draw.below(items.len()));
    match draw.below(10) {
        0 => drop(items.remove(i)),
        1 => items.insert(i, items[i].clone()),
        2 => items.swap(i, j),
        3 => items.reverse(),
        4 => items.truncate(i),
        5 => items.extend(items.clone()),
        6 => items.rotate_left(i),
        7 => items.insert(i, strange(draw)),
        8 => items[i] = items[j].clone(),
        _ => {
            let one = items[i].clone();
            items.resize(items.len() + draw.below(2000), one);
        }
    }
}

fn object(members: &mut Map<String, Value>, draw: &mut Draw) {
    let names: Vec<String> = members.keys().cloned().collect();
    let name = if names.is_empty() { String::new() } else { draw.of(&names).clone() };
    match draw.below(4) {
        0 => drop(members.remove(&name)),
        1 => {
            if let Some(member) = members.remove(&name) {
                members.insert(format!("{name}s"), member);
            }
        }
        2 => drop(members.insert((*draw.of(&WORDS)).to_owned(), strange(draw))),
        _ => {
            let other = if names.is_empty() { String::new() } else { draw.of(&names).clone() };
            if let Some(member) = members.get(&other).cloned() {
                members.insert(name, member);
            }
        }
    }
}

const NOT_JSON: [&str; 7] = ["NaN", "Infinity", "1e999", "//", "\u{feff}", "[[[[", "-"];

/// The text cut short, with a character gone, or with a number that JSON does not have.
fn spoilt(mut text: String, draw: &mut Draw) -> String {
    let mut at = draw.below(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    match draw.below(4) {
        0 => text.truncate(at),
        1 => drop(text.remove(at)),
        2 => {
            let word: &&str = draw.of(&NOT_JSON);
            text.insert_str(at, word);
        }
        // The second name of two counts.
        _ => text = text.replacen(",\"", ",\"name\":\"twice\",\"", 1),
    }
    text
}
