//! What results depend on.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Named inputs, as text: program, files, seed, settings.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Inputs(BTreeMap<String, String>);

impl Inputs {
    /// With one more.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl ToString) -> Self {
        self.0.insert(name.to_owned(), value.to_string());
        self
    }

    /// BLAKE3 of all names and values, in hexadecimal digits.
    pub fn key(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        for text in self.0.iter().flat_map(|(name, value)| [name, value]) {
            hasher.update(&(text.len() as u64).to_le_bytes());
            hasher.update(text.as_bytes());
        }
        hasher.finalize().to_hex().to_string()
    }

    /// What differs in `other`, in words; empty if nothing does.
    pub fn difference(&self, other: &Self) -> String {
        let names = self.0.keys().chain(other.0.keys());
        let differs = |name: &&String| self.0.get(*name) != other.0.get(*name);
        let mut names: Vec<&String> = names.filter(differs).collect();
        names.sort();
        names.dedup();
        let line = |name: &String| {
            let value = |of: &Self| of.0.get(name).map_or("none".to_owned(), |v| short(v));
            let [own, others] = [value(self), value(other)];
            format!("{name} is {others}, not {own}")
        };
        let lines: Vec<String> = names.into_iter().map(line).collect();
        lines.join("; ")
    }
}

/// The beginning of a long value.
fn short(value: &str) -> String {
    const MOST: usize = 40;
    match value.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &value[..end]),
        None => value.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_key_tells_inputs_apart_and_the_difference_says_how() {
        let one = Inputs::default().with("seed", 1).with("axis", "ab");
        assert_eq!(one.key(), one.clone().with("seed", 1).key());
        assert_eq!(one.difference(&one), "");
        let other = one.clone().with("seed", 2).with("quick", true);
        assert_ne!(one.key(), other.key());
        let said = one.difference(&other);
        assert_eq!(said, "quick is true, not none; seed is 2, not 1");
        // What belongs to a name and what to its value counts.
        let moved = Inputs::default().with("see", "d1").with("axis", "ab");
        assert_ne!(one.key(), moved.key());
    }
}
