//! `identify` from logs: what the simulated machine's logs tell is what they tell a user who has them.

use std::path::Path;

use serde_json::Value;

use crate::common::{refuse, succeed};

fn friction(out: &Path) -> Value {
    let file = out.join("identify/friction.json");
    serde_json::from_slice(&std::fs::read(file).unwrap()).unwrap()
}

#[test]
fn logs_that_were_written_tell_the_same_again_and_feed_the_later_stages() {
    let folder = tempfile::tempdir().unwrap();
    let [made, given] = ["made", "given"].map(|name| folder.path().join(name));
    let [to_made, to_given] = [&made, &given].map(|path| path.to_str().unwrap());
    // Cheap to simulate.
    let axis = "data/axes/linear-stage.toml";
    let identify = ["identify", "--quick", "--axis", axis, "--out"];
    succeed(&[&identify[..], &[to_made]].concat());
    let logs = ["constant-speed.parquet", "pre-sliding.parquet"];
    let logs = logs.map(|name| made.join("identify").join(name).display().to_string());
    let log = [to_given, "--log", &logs[0], &logs[1]];
    let told = succeed(&[&identify[..], &log].concat());
    assert!(
        told.contains("95 %") && !told.contains("(simulated)"),
        "{told}"
    );
    let [simulated, from_logs] = [friction(&made), friction(&given)];
    assert_eq!(simulated["law"], from_logs["law"]);
    assert_eq!(
        simulated["runs"].as_array().map(Vec::len),
        from_logs["runs"].as_array().map(Vec::len)
    );
    // Nobody knows the truth of a real axis.
    assert!(simulated["parameters"][0]["truth"].is_number());
    assert!(from_logs["parameters"][0]["truth"].is_null());
    // Later stages need not be told of the logs.
    let simulate = [
        "simulate",
        "--quick",
        "--axis",
        axis,
        "--trajectory",
        "1",
        "--compensation",
        "lugre",
        "--out",
    ];
    succeed(&[&simulate[..], &[to_given]].concat());
    // A run without logs is the simulated machine's again.
    succeed(&[&identify[..], &[to_given]].concat());
    assert_eq!(friction(&given)["simulated"], true);
    assert!(!given.join("identify/logs.json").exists());
}

#[test]
fn a_log_without_torque_is_refused_with_the_channels_that_would_do() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("half.csv");
    let rows: String = (0..300)
        .map(|k| format!("{},{}\n", 1e-3 * f64::from(k), 1e-4 * f64::from(k)))
        .collect();
    std::fs::write(&log, "t_s,position_m\n".to_owned() + &rows).unwrap();
    let out = folder.path().join("run").display().to_string();
    let message = refuse(&["identify", "--out", &out, "--log", log.to_str().unwrap()]);
    assert!(
        message.contains("half.csv") && message.contains("iq_a"),
        "{message}"
    );
}
