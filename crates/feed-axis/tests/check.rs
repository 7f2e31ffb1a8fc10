//! `check`: the axis against the data sheets of its parts.

use crate::common::{refuse, run, succeed};
use serde_json::Value;

const RATED: &str = "data/axes/screw-rating.toml";

fn found(arguments: &[&str]) -> Value {
    let mut all = vec!["check", "--format", "json"];
    all.extend_from_slice(arguments);
    let output = run(&all);
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn item<'a>(found: &'a Value, name: &str) -> &'a Value {
    let items = found["items"].as_array().unwrap();
    items.iter().find(|item| item["name"] == name).unwrap()
}

/// The figures themselves are checked in `axis-rating` and `axis-sim`.
#[test]
fn an_axis_with_limits_has_a_verdict_on_every_item() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let (json, page) = (at("check.json"), at("check.html"));
    let text = succeed(&["check", "--axis", RATED, "--json", &json, "--report", &page]);
    for part in [
        "trajectories 1, 2 there and back, without a pause",
        "(simulated)",
        "none over, 0 not known",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let written: Value = serde_json::from_str(&std::fs::read_to_string(&json).unwrap()).unwrap();
    let printed = found(&["--axis", RATED]);
    assert_eq!(written["items"], printed["items"]);
    for item in written["items"].as_array().unwrap() {
        assert_eq!(item["verdict"], "ok", "{item}");
        let number = |name: &str| item[name].as_f64();
        if let (Some(value), Some(limit), Some(margin)) =
            (number("value"), number("limit"), number("margin"))
        {
            let ratio = if item["bound"] == "at most" {
                limit / value
            } else {
                value / limit
            };
            assert!(
                (ratio / margin - 1.0).abs() < 1e-12 && margin >= 1.0,
                "{item}"
            );
        }
    }
    let html = std::fs::read_to_string(&page).unwrap();
    for part in [
        "Against the data sheets",
        "nominal life of the nut",
        "Simulated and computed, not measured",
    ] {
        assert!(html.contains(part), "{part}");
    }
}

/// A verdict is a result: the exit code is 0.
#[test]
fn what_is_over_is_named() {
    let over = ["--axis", RATED, "--set", "rating.screw_length_mm=3000"];
    let found = found(&over);
    assert_eq!(item(&found, "screw_critical_speed")["verdict"], "over");
    assert!(
        item(&found, "screw_critical_speed")["margin"]
            .as_f64()
            .unwrap()
            < 1.0
    );
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("check.html").display().to_string();
    let mut arguments = vec!["check", "--report", &page];
    arguments.extend(over);
    let text = succeed(&arguments);
    assert!(text.contains("1 over (screw_critical_speed)"), "{text}");
    assert!(
        std::fs::read_to_string(&page)
            .unwrap()
            .contains("1 over (screw_critical_speed)")
    );
}

/// Every kind of mechanism, without a limit: what is missing is named, what it cannot have is left out.
#[test]
fn an_axis_without_limits_says_what_to_give() {
    for file in [
        "liu2025",
        "belt",
        "rack",
        "joint",
        "rotary-table",
        "linear-motor",
    ] {
        let axis = format!("data/axes/{file}.toml");
        let found = found(&["--axis", &axis, "--trajectory", "1"]);
        assert_eq!(found["keys_of_the_file"], 0, "{file}");
        let torque = item(&found, "motor_rms_torque");
        assert_eq!(torque["verdict"], "not known", "{file}");
        let unit = if file == "linear-motor" { "n" } else { "n_m" };
        let key = format!("continuous_torque_{unit}");
        assert_eq!(torque["give"][0], key.as_str(), "{file}");
        // With what is asked for there is a verdict.
        let set = format!("rating.{key}=1");
        let given = [
            "check",
            "--axis",
            &axis,
            "--trajectory",
            "1",
            "--set",
            &set,
            "--format",
            "json",
        ];
        let given: Value = serde_json::from_slice(&run(&given).stdout).unwrap();
        assert_ne!(
            item(&given, "motor_rms_torque")["verdict"],
            "not known",
            "{file}"
        );
        assert!(torque["value"].as_f64().unwrap() > 0.0, "{file}");
        let items = found["items"].as_array().unwrap();
        let has = |with: &str| {
            items
                .iter()
                .any(|item| item["name"].as_str().unwrap().starts_with(with))
        };
        assert_eq!(has("screw_"), file == "liu2025", "{file}");
        assert_eq!(has("belt_"), file == "belt", "{file}");
    }
    let text = succeed(&[
        "check",
        "--axis",
        "data/axes/belt.toml",
        "--trajectory",
        "1",
    ]);
    assert!(
        text.contains("not known: give belt_cord_limit_n in [rating]"),
        "{text}"
    );
}

/// The log of a run in the place of the run.
#[test]
fn a_log_is_a_duty() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let (log, program) = (at("there.csv"), at("back.toml"));
    let limits = "velocity_mm_s = 100, acceleration_mm_s2 = 225, jerk_mm_s3 = 1200";
    let steps = format!(
        "start_mm = 600\n[[steps]]\nmove = {{ to_mm = 700, {limits} }}\n[[steps]]\nmove = {{ to_mm = 600, {limits} }}\n"
    );
    std::fs::write(&program, steps).unwrap();
    succeed(&[
        "simulate",
        "--axis",
        RATED,
        "--program",
        &program,
        "--log",
        &log,
    ]);
    let simulated = found(&["--axis", RATED, "--program", &program]);
    let logged = found(&["--axis", RATED, "--log", &log]);
    assert_eq!(logged["is_measured"], true);
    for name in [
        "motor_rms_torque",
        "nut_life",
        "winding_rise",
        "motor_speed",
    ] {
        let [a, b] =
            [&simulated, &logged].map(|found| item(found, name)["value"].as_f64().unwrap());
        assert!((a / b - 1.0).abs() < 0.02, "{name}: {a} {b}");
    }
    assert!(succeed(&["check", "--axis", RATED, "--log", &log]).contains("(measured)"));
}

/// Torque and the motor's angle are a motion and what drives it, as for `identify`; what those refuse is refused here.
#[test]
fn a_log_is_read_as_every_command_reads_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let log = at("move.csv");
    succeed(&[
        "simulate",
        "--axis",
        RATED,
        "--trajectory",
        "1",
        "--log",
        &log,
    ]);
    let read = axis_log::read_log(
        std::path::Path::new(&log),
        &axis_log::Mapping::default(),
        &[],
    )
    .unwrap();
    let of = |name: &str| read.channel(name).unwrap();
    let constant = feed_axis::context::read_axis(&crate::common::root().join(RATED))
        .unwrap()
        .torque_constant();
    let rows = |every: usize| -> String {
        let row = |k: usize| {
            let torque = constant * of("iq_a")[k];
            format!("{},{},{torque}\n", read.time()[k], of("motor_angle_rad")[k])
        };
        let rows: String = (0..read.time().len()).step_by(every).map(row).collect();
        format!("t_s,motor_angle_rad,torque_n_m\n{rows}")
    };
    let (other, slow) = (at("other.csv"), at("slow.csv"));
    std::fs::write(&other, rows(1)).unwrap();
    std::fs::write(&slow, rows(1000)).unwrap();
    let [a, b] = [&log, &other].map(|log| found(&["--axis", RATED, "--log", log]));
    for name in ["motor_rms_torque", "motor_speed"] {
        let [a, b] = [&a, &b].map(|found| item(found, name)["value"].as_f64().unwrap());
        assert!((a / b - 1.0).abs() < 0.02, "{name}: {a} {b}");
    }
    let message = refuse(&["check", "--axis", RATED, "--log", &slow]);
    assert!(message.contains("at least 100 are needed"), "{message}");
}

/// A value without a bound is written otherwise than one that is not known.
#[test]
fn an_unbounded_margin_is_a_number_for_python() {
    let found = found(&["--axis", RATED, "--trajectory", "1"]);
    let items = found["items"].as_array().unwrap();
    let unbounded: Vec<&Value> = items
        .iter()
        .filter(|item| item["margin"] == "inf")
        .collect();
    assert!(!unbounded.is_empty(), "{found}");
    assert!(unbounded.iter().all(|item| item["verdict"] == "ok"));
    let none = items.iter().filter(|item| item["margin"].is_null());
    assert!(none.clone().all(|item| item["verdict"] == "not known"));
}

#[test]
fn what_is_no_duty_is_refused() {
    for (arguments, words) in [
        (
            vec!["--trajectory", "9"],
            "there is no such trajectory; the axis file has trajectories 1 (by",
        ),
        (vec!["--dwell", "-1"], "--dwell"),
        (vec!["--set", "rating.nut_preload_n=-1"], "nut_preload"),
        (
            vec!["--log", "no.csv", "--program", "no.toml"],
            "cannot be used with",
        ),
    ] {
        let mut all = vec!["check", "--axis", RATED];
        all.extend(&arguments);
        let message = refuse(&all);
        assert!(message.contains(words), "{arguments:?}: {message}");
    }
    let message = refuse(&["check", "--axis", "data/axes/emps.toml"]);
    assert!(message.contains("no [[trajectory]]"), "{message}");
}
