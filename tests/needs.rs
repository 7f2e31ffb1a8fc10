//! What tests need that a machine may lack: data that are not part of this project, programs.
//!
//! A test that goes without is left out, and says so here: `.ci/skipped` counts and names those at the end of
//! a run, and fails where what they need is there after all. Tests of any package include this file by its path.
#![allow(dead_code, reason = "each program of tests uses a part")]

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The folder of the workspace.
pub fn root() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let has_lock = |folder: &&Path| folder.join("Cargo.lock").is_file();
    let root = package.ancestors().find(has_lock);
    root.unwrap_or(package).to_path_buf()
}

/// A file or folder in the folder `shared` beside the project; where it is not there, the test is left out.
pub fn shared(path: &str) -> Option<PathBuf> {
    let found = root().join("../shared").join(path);
    if found.exists() {
        return Some(found);
    }
    skipped("shared", path);
    None
}

/// The same, or the file or folder that a variable of the environment names.
pub fn named_or_shared(variable: &str, path: &str) -> Option<PathBuf> {
    let named = std::env::var_os(variable).map(PathBuf::from);
    named
        .filter(|named| named.exists())
        .or_else(|| shared(path))
}

/// Says that the test which runs is left out, for want of `what`: a path in `shared`, or programs of which one
/// would do, with | between them (`program`).
pub fn skipped(kind: &str, what: &str) {
    let thread = std::thread::current();
    let test = thread.name().unwrap_or("a test").to_owned();
    eprintln!("skipped: {test} needs the {kind} {what}");
    // `target`, wherever it is: Cargo gives integration tests the folder `tmp` in it.
    let target = match option_env!("CARGO_TARGET_TMPDIR").and_then(|tmp| Path::new(tmp).parent()) {
        Some(target) => target.to_path_buf(),
        None => root().join("target"),
    };
    let line = format!("{kind}\t{what}\t{}: {test}\n", env!("CARGO_PKG_NAME"));
    let list = target.join("skipped-tests");
    let list = OpenOptions::new().create(true).append(true).open(list);
    // One write: lines of tests that run at once stay whole.
    list.and_then(|mut list| list.write_all(line.as_bytes()))
        .expect("the list of skipped tests in target/");
}
