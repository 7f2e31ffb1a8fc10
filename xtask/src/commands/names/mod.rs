//! `names`: one public name of a type belongs to one library crate alone, so that whoever uses
//! several of them, or reads their pages, need not ask which is meant.
//!
//! Types are structs, enums, unions, traits and aliases at their public paths; what macros make
//! is not seen. The library of `feed-axis` serves its two programs alone and is not asked.

mod public;

use std::collections::BTreeMap;
use std::path::Path;

use miette::{IntoDiagnostic, Result, miette};

use feed_axis::output::say;

/// Libraries of programs, which nobody adds to a project.
const PROGRAMS: [&str; 2] = ["feed-axis", "feed-axis-fmu"];

/// Runs the command.
pub fn command() -> Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    let mut crates = Vec::new();
    for entry in std::fs::read_dir(folder).into_diagnostic()? {
        crates.push(entry.into_diagnostic()?.path());
    }
    crates.sort();
    let mut names = BTreeMap::new();
    let mut asked = 0;
    for path in &crates {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if PROGRAMS.contains(&name.as_ref()) {
            continue;
        }
        asked += 1;
        for (type_name, place) in public::types(path, &name.replace('-', "_"))? {
            let places: &mut BTreeMap<_, _> = names.entry(type_name).or_default();
            // One is enough: modules of one crate may have types of the same name.
            places.insert(name.to_string(), place);
        }
    }
    let doubles = doubles(&names);
    if doubles.is_empty() {
        return say(format!(
            "names: {} names of public types, each of one of {asked} crates alone",
            names.len()
        ));
    }
    Err(miette!(
        "{} names of public types stand in more than one crate: rename all but one of each\n{}",
        doubles.len(),
        doubles.join("\n")
    ))
}

/// A line for each name that several crates have.
fn doubles(names: &BTreeMap<String, BTreeMap<String, String>>) -> Vec<String> {
    let several = names.iter().filter(|(_, places)| places.len() > 1);
    several
        .map(|(name, places)| {
            let places: Vec<&str> = places.values().map(String::as_str).collect();
            format!("{name}: {}", places.join(", "))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_of_two_crates_is_told_with_both_places() {
        let types = [
            ("Motion", "a", "a::Motion"),
            ("Motion", "b", "b::moves::Motion"),
            ("Axis", "a", "a::Axis"),
        ];
        let mut names: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
        for (name, of, place) in types {
            let places = names.entry(name.into()).or_default();
            places.insert(of.into(), place.into());
        }
        assert_eq!(doubles(&names), ["Motion: a::Motion, b::moves::Motion"]);
    }
}
