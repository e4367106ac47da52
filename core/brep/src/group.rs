//! Groups of faces, and short names that old file formats can hold.

use crate::model::{Face, FaceId, Model};
use std::collections::{BTreeMap, HashMap, HashSet};

/// Faces that a mesher or a solver treats alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Name, e.g. `film/ss1/exit`; unique.
    pub name: String,
    /// Name of exactly 8 letters and digits, unique among the groups. It depends on the name alone.
    pub alias: String,
    /// What its faces are for, e.g. `film_exit`.
    pub role: String,
    /// Red, green, blue in 0..=1, linear: that of its first face.
    pub color: [f64; 3],
}

/// The faces of a model in groups, each face in exactly one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grouping {
    groups: Vec<Group>,
    of_face: Vec<usize>,
    aliases: Vec<String>,
}

impl Grouping {
    /// Groups the faces of a model by the name and role that `group_of` gives each; the groups stand in the order in
    /// which faces first need them. Of several roles for one group the first counts.
    pub fn new(model: &Model, mut group_of: impl FnMut(&Face) -> (String, String)) -> Self {
        let mut groups: Vec<Group> = Vec::new();
        let mut known: HashMap<String, usize> = HashMap::new();
        let mut of_face = Vec::with_capacity(model.faces.len());
        for face in &model.faces {
            let (name, role) = group_of(face);
            let next = groups.len();
            let index = *known.entry(name.clone()).or_insert(next);
            if index == next {
                groups.push(Group { name, alias: String::new(), role, color: face.style.color });
            }
            of_face.push(index);
        }
        let names: Vec<&str> = groups.iter().map(|g| g.name.as_str()).collect();
        for (group, alias) in aliases(&names).into_iter().enumerate() {
            groups[group].alias = alias;
        }
        let names: Vec<&str> = model.faces.iter().map(|f| f.name.as_str()).collect();
        Self { aliases: aliases(&names), groups, of_face }
    }

    /// The groups.
    pub fn groups(&self) -> &[Group] {
        &self.groups
    }

    /// Index of the group of a face.
    pub fn index_of(&self, face: FaceId) -> usize {
        self.of_face[face.0]
    }

    /// The group of a face.
    pub fn of(&self, face: FaceId) -> &Group {
        &self.groups[self.of_face[face.0]]
    }

    /// Name of exactly 8 letters and digits of a face, unique among the faces. It depends on the face's name alone.
    pub fn alias(&self, face: FaceId) -> &str {
        &self.aliases[face.0]
    }
}

/// Digits of aliases.
const DIGITS: &[u8; 36] = b"0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ";

/// Aliases of different names. Where two names come to the same one, which of 10,000 names do once in 1,600 designs,
/// the one that sorts later gets another.
fn aliases(names: &[&str]) -> Vec<String> {
    let mut of_name: BTreeMap<&str, String> = names.iter().map(|n| (*n, String::new())).collect();
    let mut taken = HashSet::new();
    for (name, alias) in &mut of_name {
        let free = (0..).map(|salt| candidate(name, salt)).find(|c| taken.insert(c.clone()));
        *alias = free.unwrap_or_default();
    }
    names.iter().map(|n| of_name[n].clone()).collect()
}

/// The name's first letter and seven digits of its hash: FNV-1a, then the finalizer of `splitmix64`, since the upper
/// bits of the former are poorly mixed. Both are fixed for ever, as aliases must be.
fn candidate(name: &str, salt: u64) -> String {
    let mut hash = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64 ^ salt, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    hash = (hash ^ (hash >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    hash = (hash ^ (hash >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    hash ^= hash >> 31;
    let first = name.bytes().find(u8::is_ascii_alphabetic).unwrap_or(b'X').to_ascii_uppercase();
    let mut alias = String::from(char::from(first));
    for _ in 0..7 {
        alias.push(char::from(DIGITS[(hash % 36) as usize]));
        hash /= 36;
    }
    alias
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn aliases_are_short_unique_and_of_the_name_alone() {
        let names: Vec<String> = (0..20_000).map(|i| format!("film/ss1/{i:05}/bore/1")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let all = aliases(&names);
        assert_eq!(all.iter().collect::<HashSet<_>>().len(), names.len());
        assert!(
            all.iter()
                .all(|a| a.len() == 8 && a.starts_with('F') && a.bytes().all(|b| b.is_ascii_alphanumeric()))
        );
        assert_eq!(aliases(&names[7_000..7_001])[0], all[7_000]);
    }

    #[test]
    fn an_alias_taken_already_is_given_to_the_name_that_sorts_first() {
        // Found by trying: the first pair of these names with the same seven digits.
        let mut seen: HashMap<String, String> = HashMap::new();
        let twins = (0..2_000_000u32).find_map(|i| {
            let name = format!("f{i}");
            let other = seen.insert(candidate(&name, 0), name.clone())?;
            Some((other, name))
        });
        let (a, b) = twins.expect("two million names have twins");
        let both = aliases(&[&b, &a]);
        let first = if a < b { 1 } else { 0 };
        assert_ne!(both[0], both[1]);
        assert_eq!(both[first], candidate(&a, 0));
    }
}
