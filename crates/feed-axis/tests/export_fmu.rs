//! `export fmu` as a user runs it; what the unit does is checked by axis-fmu and `.ci/fmu`.

use std::path::{Path, PathBuf};

use crate::common::{refuse, succeed};
use serde_json::Value;

/// A file that the command takes for the library of Linux on x86-64: its header, and the mark.
fn library(folder: &Path) -> PathBuf {
    let file = folder.join("library.so");
    let mut bytes = b"\x7fELF\x02\x01\x01".to_vec();
    bytes.resize(16, 0);
    bytes.extend([3, 0, 62, 0]);
    bytes.extend(axis_fmu::LIBRARY_MARK.as_bytes());
    std::fs::write(&file, bytes).unwrap();
    file
}

/// Likewise of Windows.
fn windows_library(folder: &Path) -> PathBuf {
    let file = folder.join("library.dll");
    let mut bytes = b"MZ".to_vec();
    bytes.resize(0x3c, 0);
    bytes.extend([0x40, 0, 0, 0]);
    bytes.extend(b"PE\0\0\x64\x86");
    bytes.resize(0x40 + 22, 0);
    bytes.extend([0, 0x20]);
    bytes.extend(axis_fmu::LIBRARY_MARK.as_bytes());
    std::fs::write(&file, bytes).unwrap();
    file
}

fn export<'a>(axis: &'a str, out: &'a Path, library: &'a Path) -> Vec<&'a str> {
    let [out, library] = [out, library].map(|path| path.to_str().unwrap());
    let to = ["--out", out, "--library", library];
    [&["export", "fmu", "--axis", axis][..], &to].concat()
}

#[test]
fn a_unit_is_written_whole_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let (out, library) = (folder.path().join("belt.fmu"), library(folder.path()));
    let export = export("data/axes/belt.toml", &out, &library);
    let said = succeed(&export);
    assert!(
        said.contains("FMI 3.0") && said.contains("0.000125 s"),
        "{said}"
    );
    let first = std::fs::read(&out).unwrap();
    let message = refuse(&export);
    assert!(
        message.contains("belt.fmu exists already") && message.contains("--force"),
        "{message}"
    );
    assert_eq!(std::fs::read(&out).unwrap(), first);
    let export = [&export[..], &["--force"]].concat();
    let told = succeed(&[&export[..], &["--format", "json"]].concat());
    let told: Value = serde_json::from_str(&told).unwrap();
    assert_eq!(
        (told["inputs"].as_u64(), told["bytes"].as_u64()),
        (Some(5), Some(first.len() as u64))
    );
    assert_eq!(std::fs::read(&out).unwrap(), first);
    let said = succeed(&[&export[..], &["--fmi", "2"]].concat());
    assert!(said.contains("FMI 2.0"), "{said}");
    assert_ne!(std::fs::read(&out).unwrap(), first);
    let told = succeed(&[&export[..], &["--plant", "--format", "json"]].concat());
    let told: Value = serde_json::from_str(&told).unwrap();
    assert_eq!(
        (told["kind"].as_str(), told["inputs"].as_u64()),
        (Some("plant alone"), Some(3))
    );
    // Nothing is left aside.
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
}

/// One library for each platform, which its header says.
#[test]
fn a_unit_takes_the_libraries_of_several_platforms() {
    let folder = tempfile::tempdir().unwrap();
    let (out, linux) = (folder.path().join("belt.fmu"), library(folder.path()));
    let windows = windows_library(folder.path());
    let export = export("data/axes/belt.toml", &out, &linux);
    let windows = windows.to_str().unwrap();
    let both = [&export[..], &["--force", "--library", windows]].concat();
    for (fmi, platforms) in [
        ("3", "x86_64-linux, x86_64-windows"),
        ("2", "linux64, win64"),
    ] {
        let said = succeed(&[&both[..], &["--fmi", fmi]].concat());
        assert!(said.contains(platforms), "{said}");
    }
    let message = refuse(&[&both[..], &["--library", linux.to_str().unwrap()]].concat());
    assert!(message.contains("binaries/x86_64-linux"), "{message}");
}

/// A unit with its correction inside: that it is among the resources, and what is said of it.
#[test]
fn a_compensated_unit_is_written_with_its_correction() {
    let folder = tempfile::tempdir().unwrap();
    let (out, library) = (folder.path().join("belt.fmu"), library(folder.path()));
    let export = export("data/axes/belt.toml", &out, &library);
    let export = [&export[..], &["--force"]].concat();
    let plan = [&export[..], &["--strategy", "plan"]].concat();
    let said = succeed(&plan);
    assert!(
        said.contains("corrected by plan; references are followed") && said.contains("late"),
        "{said}"
    );
    let told = succeed(&[&plan[..], &["--format", "json"]].concat());
    let told: Value = serde_json::from_str(&told).unwrap();
    assert_eq!(
        (told["kind"].as_str(), told["strategy"].as_str()),
        (Some("compensated closed loop"), Some("plan"))
    );
    assert!(told["look_ahead_cycles"].as_u64() > Some(2));
    for (strategy, words) in [
        ("adaptive", "plan, feedback"),
        ("drive-terms", "export drive"),
        ("network", "train"),
    ] {
        let run = folder.path().join("runs");
        let run = ["--strategy", strategy, "--run", run.to_str().unwrap()];
        let message = refuse(&[&export[..], &run].concat());
        assert!(message.contains(words), "{strategy}: {message}");
    }
    let message = refuse(&[&plan[..], &["--plant"]].concat());
    assert!(message.contains("--plant"), "{message}");
}

#[test]
fn what_cannot_be_exported_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let (out, library) = (folder.path().join("x.fmu"), library(folder.path()));
    let message = refuse(&export("data/axes/lugre-bench.toml", &out, &library));
    assert!(message.contains("[control]"), "{message}");
    let message = refuse(&export("no-such.toml", &out, &library));
    assert!(message.contains("no-such.toml"), "{message}");
    let axis = "data/axes/belt.toml";
    let message = refuse(&export(axis, &out, Path::new(axis)));
    assert!(
        message.contains("ELF") && message.contains("valid:"),
        "{message}"
    );
    let message = refuse(&export(axis, &out, Path::new("/bin/sh")));
    assert!(
        message.contains("cargo build --release -p feed-axis-fmu"),
        "{message}"
    );
    let message = refuse(&export(
        "data/axes/belt.toml",
        &out,
        Path::new("no-such.so"),
    ));
    assert!(message.contains("no-such.so"), "{message}");
    let other = [
        &export("data/axes/belt.toml", &out, &library)[..],
        &["--fmi", "1"],
    ]
    .concat();
    let message = refuse(&other);
    assert!(message.contains("[possible values: 2, 3]"), "{message}");
    assert!(!out.exists());
}
