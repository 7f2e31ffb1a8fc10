//! `heat`: hours of a duty.

use crate::common::{refuse, root, run, succeed};

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

/// A log of two hours on a machine of other numbers, by the network itself: the growth of each ten minutes at two
/// positions. How good a fit is, is for `axis-pipeline` and `axis-thermal`; here its words and its file count.
fn probed(folder: &std::path::Path, set: &[&str]) -> String {
    let mut text = String::from("t_s,duty_1,place_mm,growth_um\n0,0,450,0\n");
    let mut arguments = vec!["--axis", SCREW, "--at", "450", "950", "--duration", "2h"];
    for key in set {
        arguments.extend(["--set", key]);
    }
    let hours = found(&arguments);
    let growth = |place: usize, k: usize| hours["places"][place]["screw_um"][k].as_f64().unwrap();
    for k in (20..=240).step_by(20) {
        let t = 30.0 * k as f64;
        text += &format!(
            "{},1,450,{}\n{},1,950,{}\n",
            t,
            growth(0, k),
            t + 0.001,
            growth(1, k)
        );
    }
    let file = folder.join("probed.csv");
    std::fs::write(&file, text).unwrap();
    file.display().to_string()
}

#[test]
fn a_fitted_axis_file_predicts_the_log() {
    let folder = tempfile::tempdir().unwrap();
    let other = [
        "thermal.nut_to_table_w_per_k=7",
        "thermal.nut_viscous_share=0.48",
    ];
    let log = probed(folder.path(), &other);
    let out = folder.path().join("fitted.toml").display().to_string();
    let fitted = found(&["--axis", SCREW, "--fit", &log, "--out", &out]);
    assert_eq!(fitted["readings"], 18);
    assert_eq!(fitted["held_out_readings"], 7);
    let error = |of: &serde_json::Value| of["greatest_um"].as_f64().unwrap();
    assert!(error(&fitted["assumed_numbers"]) > 2.0, "{fitted}");
    assert!(error(&fitted["fitted_numbers"]) < 0.5, "{fitted}");
    let text = std::fs::read_to_string(&out).unwrap();
    assert!(
        text.starts_with("# [thermal] fitted by `feed-axis heat --fit`"),
        "{text}"
    );
    assert!(
        text.contains("Held out: the last 25 %, 7 readings"),
        "{text}"
    );
    // A file that people edit is not written over unasked.
    let over = ["heat", "--axis", SCREW, "--fit", &log, "--out", &out];
    assert!(refuse(&over).contains("--force"));
    // Fitted again: one such head, and the comments of the first file below it.
    let again = folder.path().join("again.toml").display().to_string();
    found(&["--axis", &out, "--fit", &log, "--out", &again]);
    let text = std::fs::read_to_string(&again).unwrap();
    for once in ["heat --fit`", "Held out:", "Such logs do not"] {
        assert_eq!(text.matches(once).count(), 1, "{once}: {text}");
    }
    let first = std::fs::read_to_string(root().join(SCREW)).unwrap();
    let line = first.lines().next().unwrap();
    assert!(
        text.contains(&format!("same growth.\n\n{line}\n")),
        "{text}"
    );
    // The file is an axis file, and predicts what it was fitted to.
    let csv = folder.path().join("growth.csv").display().to_string();
    let along = found(&[
        "--axis",
        &out,
        "--predict",
        &log,
        "--at",
        "950",
        "--out",
        &csv,
    ]);
    assert_eq!(along["readings"], 25);
    assert!(error(&along) < 0.5, "{along}");
    let rows = std::fs::read_to_string(&csv).unwrap();
    assert!(
        rows.starts_with("t_s,growth_at_950_mm_m,dry_factor_1,viscous_factor_1\n"),
        "{rows}"
    );
    assert_eq!(rows.lines().count(), 26);
    // From a homing after half an hour, set right each half hour.
    let arguments = [
        "heat",
        "--axis",
        SCREW,
        "--predict",
        &log,
        "--probe-each",
        "30min",
        "--homed",
        "30min",
    ];
    let words = succeed(&arguments);
    assert!(words.contains("since 1800 s"), "{words}");
    // At 60, 90 and 120 minutes, the last at the log's end.
    assert!(words.contains("set right by 3 probings"), "{words}");
}

#[test]
fn slow_logs_that_cannot_be_used_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("log.csv");
    std::fs::write(
        &file,
        "t_s,duty_1,place_mm,growth_um\n0,0,450,0\n600,2,450,7\n",
    )
    .unwrap();
    let log = file.display().to_string();
    let out = folder.path().join("out.toml").display().to_string();
    for (arguments, words) in [
        (vec!["--fit", &log, "--out", &out], "duty 2 in row 2"),
        (vec!["--fit", &log], "--out"),
        (
            vec!["--fit", &log, "--out", &out, "--held-out", "95"],
            "from 0 to 90",
        ),
        (
            vec!["--predict", &log],
            "valid: 0 for standstill, or from 1 to 1",
        ),
        (vec!["--predict", "none.csv"], "none.csv"),
        (
            vec!["--predict", &log, "--trajectory", "9"],
            "--trajectory 9: there is no such trajectory",
        ),
        (
            vec!["--predict", &log, "--program", "no-duty.toml"],
            "no-duty.toml",
        ),
    ] {
        let mut all = vec!["heat", "--axis", SCREW];
        all.extend(&arguments);
        let message = refuse(&all);
        assert!(message.contains(words), "{arguments:?}: {message}");
    }
    // Options for logs without a log.
    for arguments in [
        ["--out", &out],
        ["--duties", &log],
        ["--probe-against", "bed"],
        ["--probe-zero", "first"],
        ["--probe-each", "30min"],
        ["--homed", "30min"],
        ["--held-out", "10"],
    ] {
        let message = refuse(&[&["heat", "--axis", SCREW], &arguments[..]].concat());
        let asks = message.contains("--fit") || message.contains("--predict");
        assert!(asks, "{arguments:?}: {message}");
    }
    assert!(!std::path::Path::new(&out).exists());
}

/// Growth and friction, the moves cold and after five minutes of them.
#[test]
fn moves_are_made_on_an_axis_that_warms_up() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("stroke.toml");
    let step = |to: f64| {
        format!(
            "[[steps]]\nmove = {{ to_mm = {to}, velocity_mm_s = 200, acceleration_mm_s2 = 1000, jerk_mm_s3 = 10000 }}\n"
        )
    };
    std::fs::write(
        &program,
        format!("start_mm = 450\n{}{}", step(650.0), step(450.0)),
    )
    .unwrap();
    let program = program.display().to_string();
    let run_with = |axis: &str, moves: &[&str], after: &[&str]| {
        let mut all = vec![
            "compensate",
            "--format",
            "json",
            "--axis",
            axis,
            "--strategy",
            "plan",
            "--moves",
        ];
        all.extend(moves);
        all.push("--after");
        all.extend(after);
        run(&all)
    };
    let output = run_with(SCREW, &[&program], &["5min"]);
    assert!(output.status.success(), "{output:?}");
    let made: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let max = |pass: usize, of: &str| {
        made["passes"][pass]["errors_um"][of]["max"]
            .as_f64()
            .unwrap()
    };
    assert_eq!(made["passes"].as_array().unwrap().len(), 2);
    // In the seconds of the cold moves the screw grows by some tenths of a micrometre.
    let grown = max(0, "without_heat") - max(0, "with_heat");
    assert!((0.0..0.6).contains(&grown), "{made}");
    assert!(
        max(1, "without_heat") > 20.0 && max(1, "with_heat") < 3.0,
        "{made}"
    );
    for (axis, moves, after, words) in [
        (SCREW, vec!["1"], vec!["5min"], "end where they begin"),
        (
            SCREW,
            vec![program.as_str()],
            vec!["1h", "5min"],
            "do not rise",
        ),
        (SCREW, vec![program.as_str()], vec!["1s"], "--after"),
        (
            SCREW,
            vec![program.as_str()],
            vec!["5min", "301s"],
            "those after 301 s would begin before those after 300 s have ended",
        ),
        (
            "data/axes/screw-datasheet.toml",
            vec![program.as_str()],
            vec!["5min"],
            "[thermal]",
        ),
    ] {
        let output = run_with(axis, &moves, &after);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(
            !output.status.success() && message.contains(words),
            "{message}"
        );
    }
}

/// The nine duties of the example logs.
fn duties() -> Vec<String> {
    (1..=9)
        .map(|n| format!("data/heat/duty-{n}.toml"))
        .collect()
}

fn discover(arguments: &[&str]) -> Vec<String> {
    let mut all: Vec<String> = vec!["discover".to_owned()];
    all.extend(arguments.iter().map(|a| (*a).to_owned()));
    all.push("--duties".to_owned());
    all.extend(duties());
    all
}

fn borrowed(all: &[String]) -> Vec<&str> {
    all.iter().map(String::as_str).collect()
}

/// A log of hours of another machine: growth and friction that falls with warmth, with a page and an axis file.
#[test]
fn discover_names_growth_and_warming_friction_in_logs_of_hours() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().display().to_string();
    let log = "data/heat/probed.csv";
    let said = succeed(&borrowed(&discover(&[
        "--axis", SCREW, "--fit", log, "--out", &out,
    ])));
    assert!(
        said.contains("thermal-expansion and warming-friction"),
        "{said}"
    );
    let text = std::fs::read_to_string(folder.path().join("discovery.json")).unwrap();
    let found: discrepancy::Discovery = serde_json::from_str(&text).unwrap();
    assert_eq!(found.verdict, discrepancy::Verdict::Explained);
    assert_eq!(found.answer, "thermal-network");
    assert_eq!(found.likenesses.len(), 2);
    let growth = &found.effects.iter().find(|e| e.name == "thermal-expansion");
    let growth = &growth.unwrap().parameters[0];
    assert!(
        growth.name == "growth" && growth.value > 1.5e-4,
        "{growth:?}"
    );
    let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    assert!(page.contains("thermal network") && page.contains("growth at 500 mm"));
    // The axis file is one of the fitted numbers.
    let axis = folder.path().join("axis.toml").display().to_string();
    let hour = found_in(&axis);
    assert!(hour["keys_of_the_file"].as_u64().unwrap() > 10);
}

fn found_in(axis: &str) -> serde_json::Value {
    found(&["--axis", axis, "--duration", "10min"])
}

#[test]
fn discover_says_what_a_log_of_hours_needs() {
    let log = "data/heat/probed.csv";
    let base = ["--axis", SCREW, "--fit", log];
    for (more, words) in [
        (
            vec!["--accept", "backlash"],
            "--accept is for logs of motion",
        ),
        (vec!["--balance"], "--balance is for logs of motion"),
    ] {
        let mut all = base.to_vec();
        all.extend(more);
        let message = refuse(&borrowed(&discover(&all)));
        assert!(message.contains(words), "{message}");
    }
    let bare = "data/axes/screw-datasheet.toml";
    let message = refuse(&borrowed(&discover(&["--axis", bare, "--fit", log])));
    assert!(
        message.contains("no [thermal]") && message.contains("nut_viscous_share"),
        "{message}"
    );
    let message = refuse(&["discover", "--axis", SCREW, "--fit", log]);
    assert!(message.contains("has duty 1"), "{message}");
}

#[test]
fn log_inspect_shows_a_log_of_hours() {
    let seen = succeed(&["log", "inspect", "data/heat/probed.csv"]);
    assert!(seen.contains("a log of hours, for discover and heat --fit"));
    assert!(seen.contains("growth_um"));
}

#[test]
fn discover_refuses_duties_beside_a_log_of_motion() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().display().to_string();
    let log = folder.path().join("moved.csv").display().to_string();
    let motor = ["--axis", "data/axes/linear-motor.toml", "--out", &out];
    let moved = ["simulate", "--trajectory", "1", "--log", &log];
    succeed(&[&moved[..], &motor].concat());
    let duties = ["--check", &log, "--duties", "data/heat/duty-1.toml"];
    let message = refuse(&[&["discover", "--fit", &log], &duties[..], &motor].concat());
    assert!(
        message.contains("--duties is for logs of hours"),
        "{message}"
    );
}
