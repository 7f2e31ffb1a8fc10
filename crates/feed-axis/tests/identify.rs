//! `identify` from logs: what the simulated machine's logs tell is what they tell a user who has them.

use std::path::Path;

use axis_sim::Axis;
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
    // The axis file with this friction: the machine's own is 4 N, 5 N and 15 N·s/m.
    let written = given.join("identify/axis.toml");
    let text = std::fs::read_to_string(&written).unwrap();
    let [coulomb, stiction, .., viscous] = from_logs["law"].as_array().unwrap().as_slice() else {
        panic!("{from_logs}");
    };
    let axis_found = Axis::read(&written).unwrap();
    let law = axis_found.friction.law.parameters();
    for (written, found) in [
        (law.coulomb, coulomb),
        (law.stiction, stiction),
        (law.viscous, viscous),
    ] {
        assert!(
            (written / found.as_f64().unwrap() - 1.0).abs() < 1e-6,
            "{text}"
        );
    }
    for said in [
        "[friction]   # found by `identify`",
        "coulomb_n = ",
        "# 95 %: ",
    ] {
        assert!(text.contains(said), "{text}");
    }
    assert!(told.contains("identify/axis.toml"), "{told}");
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

/// A friction of another kind, and of another coordinate: its keys and tolerances go.
#[test]
fn the_friction_of_a_log_takes_the_place_of_another_kind() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../data/axes/emps.toml"
    ));
    let text = text.unwrap().replace(
        "known_parameters_percent = 2",
        "known_parameters_percent = 2\npresliding = \"unknown\"",
    );
    let axis = folder.path().join("stage.toml");
    std::fs::write(&axis, text).unwrap();
    // Constant speeds in both directions: 20 N, and 200 N·s/m.
    let log = folder.path().join("speeds.csv");
    let mut rows = "t_s,q_meas_m,u_V\n".to_owned();
    let (mut t, mut x) = (0.0, 0.0);
    for k in 0..12 {
        let speed = 0.1 * f64::powi(0.6, k / 2) * if k % 2 == 0 { 1.0 } else { -1.0 };
        for i in 0..1500 {
            // Four levels of a reading.
            let noise = 0.01 * f64::from((7 * i) % 4) - 0.015;
            let force = 20.0 * f64::signum(speed) + 200.0 * speed;
            rows += &format!("{t:.3},{x:.9},{:.6}\n", force / 35.150_651_88 + noise);
            t += 1e-3;
            x += 1e-3 * speed;
        }
    }
    std::fs::write(&log, rows).unwrap();
    let out = folder.path().join("run");
    let [axis, log, to] = [&axis, &log, &out].map(|path| path.to_str().unwrap());
    let said = succeed(&["identify", "--axis", axis, "--out", to, "--log", log]);
    assert!(
        said.contains("no transfer functions: the axis has no [[trajectory]]"),
        "{said}"
    );
    let written = out.join("identify/axis.toml");
    let text = std::fs::read_to_string(&written).unwrap();
    assert!(
        text.contains("kind = \"lugre\"") && !text.contains("presliding"),
        "{text}"
    );
    let law = Axis::read(&written).unwrap().friction.law.parameters();
    assert!((law.coulomb / 20.0 - 1.0).abs() < 0.02, "{text}");
    assert!((law.viscous / 200.0 - 1.0).abs() < 0.05, "{text}");
}
