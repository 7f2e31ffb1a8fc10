//! Every crate depends strictly downward.
//!
//! Cargo forbids cycles only. Each `Cargo.toml` says its layer in
//! `[package.metadata.layer]`; a dependency must lie on a lower one.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use miette::{IntoDiagnostic, Result, WrapErr, miette};
use toml::{Table, Value};

use feed_axis::context::read_text;

/// Number of crates, all of which depend strictly downward.
///
/// # Errors
/// Those that do not.
pub fn check(root: &Path) -> Result<usize> {
    let manifests = manifests(root)?;
    let mut levels = BTreeMap::new();
    for (path, manifest) in &manifests {
        levels.insert(name(manifest)?.to_owned(), level(path, manifest)?);
    }
    let mut wrong = Vec::new();
    for (_, manifest) in &manifests {
        let own = name(manifest)?;
        for dependency in dependencies(manifest) {
            if let Some(lower) = levels.get(dependency).filter(|l| **l >= levels[own]) {
                wrong.push(format!(
                    "{own} (layer {}) depends on {dependency} (layer {lower})",
                    levels[own]
                ));
            }
        }
    }
    if wrong.is_empty() {
        return Ok(levels.len());
    }
    Err(miette!(
        "dependencies must go to a lower layer:\n{}",
        wrong.join("\n")
    ))
}

/// The folders of all crates.
///
/// # Errors
/// If the folder `crates` cannot be read.
pub fn folders(root: &Path) -> Result<Vec<PathBuf>> {
    let mut paths = ["xtask", "tests", "tests/independent", "tests/outside"]
        .map(|p| root.join(p))
        .to_vec();
    for entry in std::fs::read_dir(root.join("crates")).into_diagnostic()? {
        paths.push(entry.into_diagnostic()?.path());
    }
    paths.sort();
    Ok(paths)
}

fn manifests(root: &Path) -> Result<Vec<(PathBuf, Table)>> {
    let read = |folder: PathBuf| -> Result<(PathBuf, Table)> {
        let path = folder.join("Cargo.toml");
        let manifest = read_text(&path)?
            .parse()
            .into_diagnostic()
            .wrap_err_with(|| format!("{} is not TOML", path.display()))?;
        Ok((path, manifest))
    };
    folders(root)?.into_iter().map(read).collect()
}

fn name(manifest: &Table) -> Result<&str> {
    manifest["package"]["name"]
        .as_str()
        .ok_or_else(|| miette!("a Cargo.toml has no package name"))
}

fn level(path: &Path, manifest: &Table) -> Result<i64> {
    manifest["package"]
        .get("metadata")
        .and_then(|metadata| metadata.get("layer")?.get("level")?.as_integer())
        .ok_or_else(|| {
            miette!(
                "{} says no level in [package.metadata.layer]",
                path.display()
            )
        })
}

fn dependencies(manifest: &Table) -> impl Iterator<Item = &str> {
    ["dependencies", "dev-dependencies", "build-dependencies"]
        .into_iter()
        .filter_map(|section| manifest.get(section).and_then(Value::as_table))
        .flat_map(|table| table.keys().map(String::as_str))
}
