//! Commands as a user runs them, from the project's folder. The tests of `feed-axis` and of
//! `xtask` share this file: each runs the program of its own package.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Cargo tells the tests of a package where its own programs are.
const PROGRAM: &str = match option_env!("CARGO_BIN_EXE_feed-axis") {
    Some(program) => program,
    None => env_of_xtask(),
};

const fn env_of_xtask() -> &'static str {
    match option_env!("CARGO_BIN_EXE_xtask") {
        Some(program) => program,
        None => panic!("a package with neither of the programs"),
    }
}

/// The folder of the workspace.
pub fn root() -> PathBuf {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let has_lock = |folder: &&Path| folder.join("Cargo.lock").is_file();
    package.ancestors().find(has_lock).unwrap().to_path_buf()
}

pub fn run(arguments: &[&str]) -> Output {
    Command::new(PROGRAM)
        .args(arguments)
        .current_dir(root())
        .output()
        .unwrap()
}

pub fn text(output: &Output) -> String {
    let both = [&output.stdout[..], &output.stderr[..]].concat();
    String::from_utf8(both).unwrap()
}

pub fn succeed(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", text(&output));
    text(&output)
}

/// The message of a command that must fail without a panic. Its box drawing
/// and line breaks are taken out.
pub fn refuse(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(!output.status.success(), "{arguments:?} was accepted");
    let message = text(&output);
    assert!(!message.contains("panicked"), "{message}");
    let plain: String = message
        .chars()
        .filter(|c| !"│╭╰─▶×├".contains(*c))
        .collect();
    plain.split_whitespace().collect::<Vec<_>>().join(" ")
}
