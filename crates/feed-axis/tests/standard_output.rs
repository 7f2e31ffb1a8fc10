//! Standard output that is full, or that nobody reads to its end.

use std::process::{Command, Stdio};

use crate::common::{root, text};

/// Standard output that takes nothing: an error, no panic. `/dev/full` stands
/// for a full disk and, unlike a closed pipe, without a race.
#[test]
#[cfg(target_os = "linux")]
fn standard_output_that_fails_is_told() {
    let full = std::fs::OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_feed-axis"))
        .args(["simulate", "--trajectory", "1"])
        .current_dir(root())
        .stdout(Stdio::from(full))
        .stderr(Stdio::piped())
        .output()
        .unwrap();
    let message = text(&output);
    assert!(
        !output.status.success() && !message.contains("panicked"),
        "{message}"
    );
    assert!(message.contains("standard output"), "{message}");
}

/// As where `head` has what it wants: from commands, jobs, the manual, the help and a document.
#[test]
fn a_reader_that_leaves_is_no_error_to_tell() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    for arguments in [
        &["simulate", "--trajectory", "1"][..],
        &["simulate", "--trajectory", "1", "--format", "json"],
        &["simulate", "--trajectory", "1", "--log", "-", "--quiet"],
        &["sample", "--quick", "--out", out],
        &["sample", "--quick", "--out", out, "--shard", "1/1"],
        &["completions", "bash"],
        &["man"],
        &["schema", "axis"],
        &["discover", "--help"],
    ] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_feed-axis"))
            .args(arguments)
            .current_dir(root())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(text(&output), "", "{arguments:?}");
        assert!(
            output.status.code().is_some_and(|code| code < 2),
            "{arguments:?}"
        );
    }
}

/// `--log -` is the log that a file would hold, and nothing else; what was found stands on standard error.
#[test]
fn a_log_goes_to_standard_output() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("log.csv");
    let simulate = |log: &std::ffi::OsStr| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_feed-axis"));
        let axis = [
            "simulate",
            "--axis",
            "data/axes/linear-motor.toml",
            "--trajectory",
            "1",
            "--log",
        ];
        command
            .args(axis)
            .arg(log)
            .current_dir(root())
            .output()
            .unwrap()
    };
    let written = simulate(file.as_os_str());
    let piped = simulate("-".as_ref());
    assert!(piped.status.success());
    assert_eq!(piped.stdout, std::fs::read(file).unwrap());
    assert_eq!(piped.stderr, written.stdout);
}
