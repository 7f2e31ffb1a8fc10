//! `export fmu` as a user runs it; what the unit does is checked by axis-fmu and `.ci/fmu`.

use std::path::{Path, PathBuf};

use crate::common::{refuse, succeed};
use serde_json::Value;

/// A file that the command takes for the library: it holds its mark.
fn library(folder: &Path) -> PathBuf {
    let file = folder.join("library.so");
    std::fs::write(&file, axis_fmu::LIBRARY_MARK).unwrap();
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

/// A unit with its correction inside: that it is among the resources, and what is said of it.
#[test]
fn a_compensated_unit_is_written_with_its_correction() {
    let folder = tempfile::tempdir().unwrap();
    let (out, library) = (folder.path().join("belt.fmu"), library(folder.path()));
    let export = export("data/axes/belt.toml", &out, &library);
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
    let message = refuse(&export("data/axes/belt.toml", &out, Path::new("/bin/sh")));
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
