//! `layers`: every crate depends strictly downward, and no files of a crate take from one another in a circle.

mod circles;
mod crates;
mod modules;
mod tokens;

use std::path::Path;

use feed_axis::output::say;
use miette::{Result, miette};

use crate::packages::root;

/// Runs the command.
pub fn command() -> Result<()> {
    let root = root();
    let crates = crates::check(&root)?;
    let mut found = Vec::new();
    for folder in crates::folders(&root)? {
        found.extend(circles_in(&folder)?);
    }
    if found.is_empty() {
        return say(format!(
            "layers: {crates} crates depend strictly downward, and no files of one take from one another in a circle"
        ));
    }
    let found = found
        .join("\n")
        .replace(&format!("{}/", root.display()), "");
    Err(miette!(
        help = "move what both need into a file that needs neither",
        "files take from one another in a circle:\n{found}"
    ))
}

/// The circles of a crate in words, of its library and of its program.
fn circles_in(folder: &Path) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for root in ["src/lib.rs", "src/main.rs"].map(|file| folder.join(file)) {
        if root.exists() {
            let takes = modules::takes(&root)?;
            let circles = circles::circles(&takes);
            found.extend(circles.iter().map(|circle| circles::words(circle, &takes)));
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests;
