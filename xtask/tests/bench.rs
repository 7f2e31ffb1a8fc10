//! `bench` at a small size: that every row runs and is reported. No time is
//! asserted; the figures of a busy machine say nothing.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

#[test]
fn every_row_is_measured_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bench.json");
    let output = Command::new(env!("CARGO_BIN_EXE_xtask"))
        .args(["bench", "--quick", "--json"])
        .arg(&file)
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."))
        .output()
        .unwrap();
    let said = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
    assert!(output.status.success(), "{said}");

    let rows: Vec<Value> = serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
    for part in [
        "closed loop,",
        "closed loops on 2 threads",
        "closed loop of rack",
        "closed loop of belt",
        "closed loop of gear",
        "closed loop of linear-motor",
        "one-cycle samples",
        "streamed to disk",
        "epoch",
        "prediction of 4-34-19-8-1, f64",
        "prediction of 4-34-19-8-1, f32",
        "Latin hypercube",
        "design, time",
        "design, centred discrepancy",
        "S-curve, planned",
        "S-curve, one sample",
        "M and K",
        "six modes",
    ] {
        let row = rows
            .iter()
            .find(|row| row["name"].as_str().unwrap().contains(part))
            .unwrap_or_else(|| panic!("no row {part}"));
        for number in ["value", "ratio"] {
            let value = row[number].as_f64().unwrap();
            assert!(value.is_finite() && value > 0.0, "{row}");
        }
        assert!(["s", "1"].contains(&row["unit"].as_str().unwrap()), "{row}");
        // The terminal shows the same rows.
        assert!(said.contains(row["name"].as_str().unwrap()), "{said}");
    }
    assert_eq!(rows.len(), 18);
}
