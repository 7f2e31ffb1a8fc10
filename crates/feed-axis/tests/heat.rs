//! `heat`: hours of a duty.

use crate::common::{refuse, run, succeed};

const SCREW: &str = "data/axes/screw-heat.toml";

fn found(arguments: &[&str]) -> serde_json::Value {
    let mut all = vec!["heat", "--format", "json"];
    all.extend_from_slice(arguments);
    let output = run(&all);
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn last(list: &serde_json::Value) -> f64 {
    list.as_array().unwrap().last().unwrap().as_f64().unwrap()
}

/// The figures themselves are checked in `axis-thermal` and by `cargo test -p acceptance heat`.
#[test]
fn an_hour_warms_the_screw_and_makes_it_longer() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("heat.html").display().to_string();
    let hour = found(&["--axis", SCREW, "--at", "450", "950", "--report", &page]);
    assert_eq!(hour["measures_at"], "motor");
    assert_eq!(hour["nodes"].as_array().unwrap().len(), 8);
    assert_eq!(hour["time_min"].as_array().unwrap().len(), 241);
    assert!(last(&hour["time_min"]) == 60.0 && last(&hour["viscous_factor"]) < 0.9);
    let [near, far] = [0, 1].map(|i| last(&hour["places"][i]["screw_um"]));
    assert!(near > 10.0 && far > 2.0 * near, "{near} {far}");
    // From the loop's cycles, the same within a hundredth.
    let loops = found(&[
        "--axis",
        SCREW,
        "--at",
        "450",
        "950",
        "--losses",
        "simulation",
    ]);
    let simulated = last(&loops["places"][1]["screw_um"]);
    assert!((simulated / far - 1.0).abs() < 0.01, "{simulated} {far}");
    let html = std::fs::read_to_string(&page).unwrap();
    for text in [
        "Growth of the screw",
        "no measured log",
        "at 950 mm",
        "Screw from the driven end",
    ] {
        assert!(html.contains(text), "{text}");
    }
    assert!(!html.contains("Force of the screw"));
}

#[test]
fn a_screw_held_at_both_ends_has_a_force() {
    let held = [
        "--axis",
        SCREW,
        "--set",
        "mechanism.mounting=fixed-fixed",
        "--set",
        "thermal.screw_pretension_kn=8",
    ];
    let hour = found(&held);
    let [compression, tension] = ["compression_n", "tension_n"].map(|of| last(&hour["force"][of]));
    assert!(compression > 5e3 && (compression + tension - 8e3).abs() < 1e-6);
    let mut arguments = vec!["heat"];
    arguments.extend(held);
    assert!(succeed(&arguments).contains("held at both ends"));
}

/// Every kind of mechanism has bodies that warm up; those without a screw have no growth of one.
#[test]
fn every_mechanism_warms_up() {
    for (file, nodes) in [
        ("liu2025", 8),
        ("belt", 5),
        ("rack", 5),
        ("joint", 5),
        ("rotary-table", 5),
        ("linear-motor", 5),
        ("linear-stage", 5),
    ] {
        let axis = format!("data/axes/{file}.toml");
        let hour = found(&["--axis", &axis, "--duration", "10min"]);
        assert_eq!(hour["keys_of_the_file"], 0, "{file}");
        let found = hour["nodes"].as_array().unwrap();
        assert_eq!(found.len(), nodes, "{file}");
        let table = found.iter().find(|node| node["name"] == "table").unwrap();
        assert!(last(&table["temperature_c"]) > 20.001, "{file}");
        let places = hour["places"].as_array().unwrap();
        let turns = ["joint", "rotary-table"].contains(&file);
        assert_eq!(places.len(), if turns { 0 } else { 5 }, "{file}");
        let has_screw = nodes == 8;
        assert!(
            places
                .iter()
                .all(|place| place["screw_um"].is_null() != has_screw)
        );
    }
}

#[test]
fn what_cannot_be_heated_is_refused() {
    for (arguments, words) in [
        (vec!["--duration", "1"], "1h"),
        (
            vec!["--trajectory", "9"],
            "there is no such trajectory; the axis file has trajectories 1 (by",
        ),
        (vec!["--at", "1600"], "between 0 and 1500 mm"),
        (vec!["--dwell", "-1"], "--dwell"),
        (
            vec!["--set", "thermal.nut_dry_share=0.9"],
            "at most 1 together",
        ),
        (
            vec!["--set", "thermal.nut_capacity_j_per_k=-1"],
            "nut_capacity",
        ),
    ] {
        let mut all = vec!["heat", "--axis", SCREW];
        all.extend(&arguments);
        let message = refuse(&all);
        assert!(message.contains(words), "{arguments:?}: {message}");
    }
    // A screw's number for an axis without one.
    let message = refuse(&[
        "heat",
        "--axis",
        "data/axes/linear-motor.toml",
        "--set",
        "thermal.nut_to_screw_w_per_k=9",
    ]);
    assert!(
        message.contains("about a screw") && message.contains("table_capacity"),
        "{message}"
    );
    let message = refuse(&["heat", "--axis", "data/axes/joint.toml", "--at", "3"]);
    assert!(message.contains("turns"), "{message}");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("away.toml");
    let text = "start_mm = 600\n[[steps]]\nmove = { to_mm = 800, velocity_mm_s = 100, acceleration_mm_s2 = 225, jerk_mm_s3 = 1200 }\n";
    std::fs::write(&file, text).unwrap();
    let program = file.display().to_string();
    let message = refuse(&["heat", "--axis", SCREW, "--program", &program]);
    assert!(message.contains("ends where it begins"), "{message}");
    let back = "[[steps]]\nmove = { to_mm = 600, velocity_mm_s = 100, acceleration_mm_s2 = 225, jerk_mm_s3 = 1200 }\n";
    std::fs::write(&file, text.replace("800", "1800") + back).unwrap();
    let message = refuse(&["heat", "--axis", SCREW, "--program", &program]);
    assert!(message.contains("reaches from 0.6 to 1.8 m"), "{message}");
    std::fs::write(&file, text.to_owned() + back).unwrap();
    let hour = found(&["--axis", SCREW, "--program", &program]);
    assert!(last(&hour["loss_w"]) > 50.0);
    let message = refuse(&["heat", "--axis", "data/axes/emps.toml"]);
    assert!(
        message.contains("no [[trajectory]]: add one, or give a motion program"),
        "{message}"
    );
}
