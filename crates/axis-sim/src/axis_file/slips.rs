//! What to say about a key or a word that does not exist.

use std::path::{Path, PathBuf};

use crate::part::{Key, Kind};

/// What is wrong with the key `given` in a table of `keys`.
pub(super) fn unknown_key(given: &str, place: &str, keys: &[Key]) -> String {
    let near_of = |among: &dyn Fn(&Key) -> bool| {
        let keys = keys.iter().filter(|key| among(key));
        let spellings =
            keys.flat_map(|key| key.spellings().into_iter().map(|s| (key.shown(&s), s)));
        nearest(given, spellings, |(_, spelling)| spelling)
    };
    let mut wrong = keys.iter().map(|key| (key, wrong_unit(given, key)));
    let wrong = wrong.find_map(|(key, wrong)| Some((key, wrong?)));
    let near = match wrong {
        // Its name may be how a longer one begins.
        Some((begun, wrong)) => {
            let near = near_of(&|key| key.name.starts_with(begun.name));
            let own = begun.spellings();
            if near.is_empty() || near.iter().any(|(_, spelling)| own.contains(spelling)) {
                return wrong;
            }
            near
        }
        None => near_of(&|_| true),
    };
    let near: Vec<String> = near.iter().map(|(shown, _)| format!("`{shown}`")).collect();
    format!("is not a key of {place}{}", hint(&near))
}

/// The keys that a table may have, as a list.
pub(super) fn list(keys: &[Key]) -> String {
    let mut all: Vec<String> = keys
        .iter()
        .map(|key| key.shown(&key.spellings().join(" | ")))
        .collect();
    all.sort();
    format!("one of: {}", all.join(", "))
}

/// What is said about a word that is none of `words`, as the end of a sentence.
pub(super) fn unknown_word(given: &str, words: &[&str]) -> String {
    let near = nearest(given, words.iter().copied(), |word| word);
    let near: Vec<String> = near.iter().map(|word| format!("\"{word}\"")).collect();
    hint(&near)
}

/// A quantity without a unit, or with one that does not exist.
fn wrong_unit(given: &str, key: &Key) -> Option<String> {
    let Kind::Quantity(dimension, _) = key.kind else {
        return None;
    };
    let rest = given.strip_prefix(key.name)?;
    let (units, unit_of) = (key.spellings().join(", "), dimension.name);
    if rest.is_empty() {
        return Some(format!("has no {unit_of}; there are {units}"));
    }
    let unit = rest.strip_prefix('_')?;
    Some(format!(
        "has the unit suffix `{unit}`, which is no {unit_of}; there are {units}"
    ))
}

/// TOML files beside a path that does not exist, of names like its own.
pub(super) fn files_near(path: &Path) -> Vec<String> {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let is_toml = |file: &PathBuf| file.extension().is_some_and(|end| end == "toml");
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let files = entries.map(|entry| entry.path()).filter(is_toml);
    let stem = |file: &Path| Some(file.file_stem()?.to_str()?.to_owned());
    let mut named: Vec<(PathBuf, String)> =
        files.filter_map(|f| stem(&f).map(|s| (f, s))).collect();
    named.sort();
    // Whether the path ends in `.toml` or was left without.
    let given = match path.extension() {
        Some(end) if end == "toml" => stem(path),
        _ => path
            .file_name()
            .and_then(|name| Some(name.to_str()?.to_owned())),
    };
    let near = given.map(|given| nearest(&given, named, |(_, stem)| stem));
    let shown = |(file, _): &(PathBuf, String)| match path.parent() == Some(Path::new("")) {
        true => file
            .file_name()
            .map_or_else(String::new, |n| n.display().to_string()),
        false => file.display().to_string(),
    };
    near.unwrap_or_default().iter().map(shown).collect()
}

fn hint(near: &[String]) -> String {
    if near.is_empty() {
        return String::new();
    }
    format!("; did you mean {}?", near.join(" or "))
}

/// The nearest candidates, where they are near enough: a third of the letters
/// away at most, a swap of neighbours counting as one.
fn nearest<T>(
    given: &str,
    candidates: impl IntoIterator<Item = T>,
    text: impl Fn(&T) -> &str,
) -> Vec<T> {
    let mut least = (given.chars().count() / 3).max(1);
    let mut near = Vec::new();
    for candidate in candidates {
        let distance = strsim::osa_distance(given, text(&candidate));
        if distance < least {
            near.clear();
            least = distance;
        }
        if distance == least {
            near.push(candidate);
        }
    }
    near
}
