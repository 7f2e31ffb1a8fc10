//! Commands as a user runs them, from the project's folder.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

pub fn feed_axis(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_feed-axis"))
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
    let output = feed_axis(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", text(&output));
    text(&output)
}

/// The message of a command that must fail without a panic. Its box drawing
/// and line breaks are taken out.
pub fn refuse(arguments: &[&str]) -> String {
    let output = feed_axis(arguments);
    assert!(!output.status.success(), "{arguments:?} was accepted");
    let message = text(&output);
    assert!(!message.contains("panicked"), "{message}");
    let plain: String = message
        .chars()
        .filter(|c| !"│╭╰─▶×├".contains(*c))
        .collect();
    plain.split_whitespace().collect::<Vec<_>>().join(" ")
}
