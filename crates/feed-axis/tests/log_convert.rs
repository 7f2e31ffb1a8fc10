//! `log convert`: the same log in channels and SI units, in another file.

use std::path::{Path, PathBuf};

use crate::common::{refuse, root, run, succeed};
use serde_json::Value;

/// Five samples as a drive exports them: milliseconds, millimetres, a column of no channel. Their values in SI are sums
/// of powers of two, so that no conversion rounds.
fn drive(folder: &Path) -> [String; 2] {
    let text = "time;Lage;X9\n0;0;1\n125;250;2\n250;500;3\n375;1000;4\n500;1500;5\n";
    let mut axis = std::fs::read_to_string(root().join("data/axes/rack.toml")).unwrap();
    axis += "\n[[log.column]]\nsource = \"time\"\nchannel = \"t_s\"\nunit = \"ms\"\n\
             \n[[log.column]]\nsource = \"Lage\"\nchannel = \"position_m\"\nunit = \"mm\"\n";
    let put = |name: &str, text: &str| {
        std::fs::write(folder.join(name), text).unwrap();
        folder.join(name).to_str().unwrap().to_owned()
    };
    [put("drive.csv", text), put("axis.toml", &axis)]
}

fn at(folder: &Path, name: &str) -> (PathBuf, String) {
    let path = folder.join(name);
    (path.clone(), path.to_str().unwrap().to_owned())
}

#[test]
fn log_convert_writes_channels_in_si() {
    let folder = tempfile::tempdir().unwrap();
    let [log, axis] = drive(folder.path());
    let (path, csv) = at(folder.path(), "out.csv");
    let said = succeed(&["log", "convert", &log, "--axis", &axis, "--out", &csv]);
    assert!(
        said.contains("left out, as no [[log.column]] names them: X9"),
        "{said}"
    );
    assert!(said.contains("5 samples at 8.0000 Hz"), "{said}");
    let expected = "t_s,position_m\n0,0\n0.125,0.25\n0.25,0.5\n0.375,1\n0.5,1.5\n";
    assert_eq!(std::fs::read_to_string(&path).unwrap(), expected);

    // Through the other formats and back: the same text, without a mapping.
    for name in ["out.parquet", "out.mat"] {
        let (_, other) = at(folder.path(), name);
        succeed(&["log", "convert", &csv, "--out", &other]);
        let (back, again) = at(folder.path(), "back.csv");
        succeed(&["log", "convert", &other, "--out", &again]);
        assert_eq!(std::fs::read_to_string(back).unwrap(), expected, "{name}");
    }
}

#[test]
fn log_convert_tells_programs_what_it_wrote() {
    let folder = tempfile::tempdir().unwrap();
    let [log, axis] = drive(folder.path());
    let (_, csv) = at(folder.path(), "out.csv");
    let output = run(&[
        "log", "convert", &log, "--axis", &axis, "--out", &csv, "--format", "json",
    ]);
    let told: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(
        (&told["samples"], &told["rate_hz"]),
        (&5.into(), &8.0.into())
    );
    assert_eq!(told["channels"][1]["name"], "position_m");
    assert_eq!(told["channels"][1]["unit"], "m");
    assert_eq!(told["left_out"][0], "X9");
}

/// What, where, and what would be valid; and nothing is written.
#[test]
fn log_convert_refuses_what_it_cannot_write() {
    let folder = tempfile::tempdir().unwrap();
    let [log, axis] = drive(folder.path());
    let (path, out) = at(folder.path(), "out.csv");
    let (_, sheet) = at(folder.path(), "out.xlsx");
    let message = refuse(&["log", "convert", &log, "--axis", &axis, "--out", &sheet]);
    assert!(message.contains(".csv or .parquet or .mat"), "{message}");
    let message = refuse(&["log", "convert", &log, "--out", &out]);
    assert!(message.contains("drive.csv: no log yet"), "{message}");
    let scope = "crates/axis-log/tests/data/halscope.log";
    let message = refuse(&["log", "convert", scope, "--out", &out]);
    for part in ["no column is a channel", "pid.x.output", "[[log.column]]"] {
        assert!(message.contains(part), "{message}");
    }
    let message = refuse(&["log", "convert", &log, "--rate", "-1", "--out", &out]);
    assert!(message.contains("a number above 0, in Hz"), "{message}");
    assert!(!path.exists());
    let before = std::fs::read(&log).unwrap();
    let again = folder.path().join(".").join("drive.csv");
    let again = again.to_str().unwrap();
    let message = refuse(&["log", "convert", &log, "--axis", &axis, "--out", again]);
    assert!(message.contains("the log that is read"), "{message}");
    assert_eq!(std::fs::read(&log).unwrap(), before);
}

/// What was not measured is not made up: it stays without a value in every format, and is counted.
#[test]
fn log_convert_leaves_holes_as_holes() {
    let folder = tempfile::tempdir().unwrap();
    let put = folder.path().join("holes.csv");
    // Two cells without a value, and a row that is not there at all (t = 0.625 s).
    let text = "t_s,position_m,torque_n_m\n0,0,1\n0.125,0.25,\n0.25,,2\n0.375,0.5,3\n0.5,1,4\n0.75,2,5\n0.875,3,6\n";
    std::fs::write(&put, text).unwrap();
    let log = put.to_str().unwrap();
    let expected = "t_s,position_m,torque_n_m\n0,0,1\n0.125,0.25,NaN\n0.25,NaN,2\n0.375,0.5,3\n0.5,1,4\n0.625,NaN,NaN\n0.75,2,5\n0.875,3,6\n";
    let mut from = log.to_owned();
    for name in ["out.parquet", "out.mat", "out.csv"] {
        let (path, out) = at(folder.path(), name);
        let output = run(&["log", "convert", &from, "--out", &out, "--format", "json"]);
        let told: Value = serde_json::from_slice(&output.stdout).unwrap();
        let holes = &told["without_value"];
        for (k, channel) in ["position_m", "torque_n_m"].into_iter().enumerate() {
            assert_eq!(holes[k]["channel"], channel, "{name}: {told}");
            assert_eq!(holes[k]["samples"], 2, "{name}: {told}");
        }
        if name == "out.csv" {
            assert_eq!(std::fs::read_to_string(path).unwrap(), expected);
        }
        from = out;
    }
    let (_, out) = at(folder.path(), "said.csv");
    let output = run(&["log", "convert", log, "--out", &out]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = "position_m: 2 sample(s) without a value";
    assert!(
        said.contains(line) && said.contains("NaN stands there"),
        "{said}"
    );
    assert!(!said.contains("straight line"), "{said}");
}
