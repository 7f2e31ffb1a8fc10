//! `names`: one public name of a type stands for one thing in all library crates, so that
//! whoever uses several of them, or reads their pages, need not ask which is meant.
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
            names.entry(type_name).or_insert_with(Vec::new).push(place);
        }
    }
    let doubles = doubles(&names);
    if doubles.is_empty() {
        return say(format!(
            "names: {} public types of {asked} crates, each name once",
            names.len()
        ));
    }
    Err(miette!(
        "{} names stand for more than one public type:\n{}",
        doubles.len(),
        doubles.join("\n")
    ))
}

/// A line for each name that has more than one place.
fn doubles(names: &BTreeMap<String, Vec<String>>) -> Vec<String> {
    let several = names.iter().filter(|(_, places)| places.len() > 1);
    several
        .map(|(name, places)| format!("{name}: {}", places.join(", ")))
        .collect()
}
