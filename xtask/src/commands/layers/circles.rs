//! Files that take from one another in a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::modules::Takes;

/// The circles, each as its files: of two files in one, each takes from the other, directly or through others.
pub fn circles(takes: &Takes) -> Vec<BTreeSet<&Path>> {
    let mut next: BTreeMap<&Path, Vec<&Path>> = BTreeMap::new();
    for (from, to) in takes.keys() {
        next.entry(from).or_default().push(to);
    }
    let reached: BTreeMap<&Path, BTreeSet<&Path>> = next
        .keys()
        .map(|from| (*from, reached(from, &next)))
        .collect();
    let mut circles = BTreeSet::new();
    for (file, others) in reached
        .iter()
        .filter(|(file, others)| others.contains(*file))
    {
        let back = |other: &&Path| reached.get(other).is_some_and(|all| all.contains(file));
        circles.insert(others.iter().copied().filter(back).collect::<BTreeSet<_>>());
    }
    circles.into_iter().collect()
}

fn reached<'a>(from: &'a Path, next: &BTreeMap<&'a Path, Vec<&'a Path>>) -> BTreeSet<&'a Path> {
    let mut reached = BTreeSet::new();
    let mut open = vec![from];
    while let Some(file) = open.pop() {
        let targets = next.get(file).into_iter().flatten();
        open.extend(targets.filter(|target| reached.insert(**target)));
    }
    reached
}

/// A circle in words: which file takes which names from which.
pub fn words(circle: &BTreeSet<&Path>, takes: &Takes) -> String {
    let inside = takes
        .iter()
        .filter(|((from, to), _)| circle.contains(from.as_path()) && circle.contains(to.as_path()));
    let lines: Vec<String> = inside
        .map(|((from, to), names)| {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            format!(
                "  {} takes from {}: {}",
                from.display(),
                to.display(),
                names.join(", ")
            )
        })
        .collect();
    format!("{} files:\n{}", circle.len(), lines.join("\n"))
}
