//! Runs that stop before their end: what they leave says so itself.

use std::path::Path;

use crate::common::{run, text};
use axis_log::{Mapping, read_log};
use serde_json::Value;

/// A move of the paper's axis over the end of its stroke, 1500 mm.
const OVER_THE_END: &str = "start_mm = 1490\n[[steps]]\n\
    move = { to_mm = 1520, velocity_mm_s = 200, acceleration_mm_s2 = 2000, jerk_mm_s3 = 20000 }\n";
/// One that stays on it.
const INSIDE: &str = "start_mm = 1480\n[[steps]]\n\
    move = { to_mm = 1490, velocity_mm_s = 200, acceleration_mm_s2 = 2000, jerk_mm_s3 = 20000 }\n";

fn written(folder: &Path, name: &str, program: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, program).unwrap();
    path.to_str().unwrap().to_owned()
}

/// Whether bytes hold a text, one byte a character or two.
fn holds(bytes: &[u8], sought: &str) -> bool {
    let wide: Vec<u8> = sought.encode_utf16().flat_map(u16::to_le_bytes).collect();
    [sought.as_bytes(), &wide]
        .iter()
        .any(|sought| bytes.windows(sought.len()).any(|part| part == *sought))
}

const WHY: &str = "because the load left its stroke";

#[test]
fn a_log_a_page_and_a_document_say_that_their_run_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let over = written(folder.path(), "over.toml", OVER_THE_END);
    let mut rows = Vec::new();
    for format in ["csv", "parquet", "mat"] {
        let (log, page) = (at(&format!("log.{format}")), at("page.html"));
        let output = run(&[
            "simulate",
            "--program",
            &over,
            "--log",
            &log,
            "--report",
            &page,
            "--format",
            "json",
        ]);
        assert_eq!(output.status.code(), Some(1), "{}", text(&output));
        let found: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert!(found["stopped"].as_str().unwrap().contains(WHY), "{found}");
        assert!(found["errors_um"]["max"].as_f64().unwrap() > 0.0, "{found}");
        let bytes = std::fs::read(&log).unwrap();
        assert!(holds(&bytes, "stopped") && holds(&bytes, WHY), "{format}");
        let html = std::fs::read_to_string(&page).unwrap();
        assert!(html.contains("did not come to its end") && html.contains(WHY));
        // It is read as any other.
        let log = read_log(&log, &Mapping::default(), &[]).unwrap();
        assert_eq!(log.len() as u64, found["cycles"].as_u64().unwrap());
        rows.push(log);
    }
    assert!(rows[0] == rows[1] && rows[1] == rows[2]);
    let csv = std::fs::read_to_string(at("log.csv")).unwrap();
    let last = csv.lines().last().unwrap();
    assert!(
        last.starts_with("# stopped: the simulation stopped at t = "),
        "{last}"
    );
}

#[test]
fn what_comes_to_its_end_says_nothing_of_a_stop() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("log.csv");
    let inside = written(folder.path(), "inside.toml", INSIDE);
    let log = log.to_str().unwrap();
    let output = run(&[
        "simulate",
        "--program",
        &inside,
        "--log",
        log,
        "--format",
        "json",
    ]);
    assert!(output.status.success(), "{}", text(&output));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["stopped"], Value::Null);
    assert!(!std::fs::read_to_string(log).unwrap().contains('#'));
}

#[test]
fn moves_say_which_of_them_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let inside = written(folder.path(), "inside.toml", INSIDE);
    let over = written(folder.path(), "over.toml", OVER_THE_END);
    let json = folder.path().join("moves.json");
    let axis = "data/axes/liu2025.toml";
    let output = run(&[
        "compensate",
        "--axis",
        axis,
        "--machine",
        axis,
        "--strategy",
        "plan",
        "--moves",
        &inside,
        &over,
        &inside,
        "--json",
        json.to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output));
    assert!(text(&output).contains("stopped at"), "{}", text(&output));
    let found: Value = serde_json::from_slice(&std::fs::read(json).unwrap()).unwrap();
    // The one that came to its end, and where each series ended.
    assert_eq!(found["moves"].as_array().map(Vec::len), Some(1));
    let stopped = found["stopped"].as_array().unwrap();
    let under: Vec<&str> = stopped
        .iter()
        .filter_map(|s| s["strategy"].as_str())
        .collect();
    assert_eq!(under, ["none", "plan"]);
    for stop in stopped {
        assert_eq!(stop["move"], over.as_str());
        assert!(stop["why"].as_str().unwrap().contains(WHY), "{stop}");
    }
}
