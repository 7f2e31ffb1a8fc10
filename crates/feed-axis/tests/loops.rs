//! `analyse` and `tune`: from a new axis file to tuned gains.

use crate::common::{refuse, run, succeed};
use crate::schema_of::assert_validates;
use serde_json::Value;

fn json(arguments: &[&str]) -> Value {
    let output = run(arguments);
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The greatest tracking error of a trajectory, as `simulate` prints it.
fn peak(axis: &str) -> f64 {
    let said = succeed(&["simulate", "--axis", axis, "--trajectory", "1"]);
    let after = said.split("error max ").nth(1).unwrap();
    after.split(' ').next().unwrap().parse().unwrap()
}

#[test]
fn a_new_axis_is_looked_at_tuned_and_follows_better() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let out = folder.path().to_str().unwrap();
    succeed(&["new", "x", "--kind", "screw-datasheet", "--out", out]);
    let (axis, tuned, page) = (at("x.toml"), at("tuned.toml"), at("page.html"));

    let before = json(&[
        "analyse", "--axis", &axis, "--report", &page, "--format", "json",
    ]);
    assert_validates("loops", &before);
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("Nyquist"), "the page has its plots");

    let found = json(&["tune", "--axis", &axis, "--out", &tuned, "--format", "json"]);
    assert_validates("tuning", &found);
    let keys = found["keys"].as_array().unwrap();
    assert!(keys.iter().any(|k| k["key"] == "kv_per_s"), "{keys:?}");
    // The gains that were set, as drives take them.
    let of_drive = found["drive"].as_array().unwrap();
    let gain = of_drive.iter().find(|t| t["name"] == "speed_gain").unwrap();
    let set = keys
        .iter()
        .find(|k| k["key"] == "speed_proportional_a_per_rpm");
    // A per rpm to N·m·s/rad at 1.641 N·m/A.
    let expected = set.unwrap()["value"].as_f64().unwrap() * 30.0 / std::f64::consts::PI * 1.641;
    let sinamics = &gain["parameters"][1];
    assert_eq!(
        (&sinamics["drive"], &sinamics["parameter"]),
        (&"SINAMICS S210".into(), &"p1460".into())
    );
    assert!(
        (sinamics["value"].as_f64().unwrap() / expected - 1.0).abs() < 1e-4,
        "{sinamics}"
    );

    // Of the file that was written, analysed by itself: within the limits, but for the digits of its keys.
    let after = json(&["analyse", "--axis", &tuned, "--format", "json"]);
    let sensitivity = after["worst"]["sensitivity"].as_f64().unwrap();
    assert!(sensitivity < 1.605, "{sensitivity}");
    let late = json(&[
        "analyse", "--axis", &tuned, "--delay", "1", "--format", "json",
    ]);
    assert!(late["worst"]["sensitivity"].as_f64().unwrap() < 2.01);
    assert!(peak(&tuned) < 0.7 * peak(&axis));
}

#[test]
fn what_cannot_be_tuned_is_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("t.toml").display().to_string();
    let axis = "data/axes/rack.toml";
    let message = refuse(&[
        "tune",
        "--axis",
        axis,
        "--out",
        &out,
        "--sensitivity",
        "0.9",
    ]);
    assert!(message.contains("sensitivity"), "{message}");
    let message = refuse(&["analyse", "--axis", axis, "--position", "900"]);
    assert!(message.contains("stroke"), "{message}");
    let balance = "data/axes/lugre-bench.toml";
    for command in [&["tune", "--out", &out][..], &["analyse"]] {
        let message = refuse(&[command, &["--axis", balance]].concat());
        assert!(message.contains("[control] is none"), "{message}");
        assert!(message.contains("\"pid\" with proportional"), "{message}");
    }
    assert!(!std::path::Path::new(&out).exists());
}
