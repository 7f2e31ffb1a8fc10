//! A copy of the project that may be published, so that cargo treats its crates so.
//!
//! Cargo lets crates take each other from their packages only where they may be published, which
//! `publish = false` forbids. The copy says `publish = true`; the project does not.

use std::path::{Path, PathBuf};
use std::process::Command;

use miette::{IntoDiagnostic, Result, WrapErr, miette};

use feed_axis::context::read_text;

use crate::packages::root;

/// What stands in the workspace's manifest until a person turns it on.
const OFF: &str = "\npublish = false\n";
const ON: &str = "\npublish = true\n";

/// Copies every file that git knows, as it is now, to `folder`, and allows publishing there.
pub fn make(folder: &Path) -> Result<()> {
    if folder.exists() {
        std::fs::remove_dir_all(folder).into_diagnostic()?;
    }
    for file in files()? {
        let (from, to) = (root().join(&file), folder.join(&file));
        // Known to git, but removed.
        if !from.exists() {
            continue;
        }
        let about = || format!("cannot copy {} to {}", from.display(), to.display());
        std::fs::create_dir_all(to.parent().unwrap_or(folder)).into_diagnostic()?;
        // What a link names, not the link, which would lead out of the copy.
        std::fs::copy(&from, &to)
            .into_diagnostic()
            .wrap_err_with(about)?;
    }
    let manifest = folder.join("Cargo.toml");
    let text = allowed(&read_text(&manifest)?);
    std::fs::write(manifest, text).into_diagnostic()
}

fn allowed(manifest: &str) -> String {
    manifest.replacen(OFF, ON, 1)
}

fn files() -> Result<Vec<PathBuf>> {
    let mut command = Command::new("git");
    command.args(["ls-files", "-z"]).current_dir(root());
    let output = command
        .output()
        .into_diagnostic()
        .wrap_err("cannot run git")?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(miette!("git does not list the project's files: {said}"));
    }
    let names = String::from_utf8(output.stdout).into_diagnostic()?;
    let names = names.split('\0').filter(|name| !name.is_empty());
    Ok(names.map(PathBuf::from).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn publishing_is_off_here_and_on_in_the_copy() {
        let manifest = read_text(&root().join("Cargo.toml")).unwrap();
        let copied = allowed(&manifest);
        assert!(manifest.contains(OFF) && !copied.contains(OFF) && copied.contains(ON));
    }
}
