//! The commands as a user runs them: the whole pipeline in its small version,
//! its figures, what it refuses, and what it leaves alone.

use std::process::{Command, Stdio};

use axis_log::{Mapping, read_log};
use serde_json::Value;

use crate::common::{refuse, root, run, succeed, text};
use crate::schema_of::assert_validates;

#[test]
fn help_names_every_command() {
    let help = succeed(&["--help"]);
    for command in [
        "pipeline",
        "sample",
        "train",
        "identify",
        "validate",
        "compensate",
        "study",
        "report",
        "simulate",
        "discover",
        "export",
        "new",
        "log",
        "man",
    ] {
        assert!(help.contains(command), "{command}");
        assert!(succeed(&[command, "--help"]).contains("Usage"), "{command}");
    }
}

/// Noise is the sensors' and nothing else: none to speak of changes nothing to speak of, and the
/// commands that have it say the same of it.
#[test]
fn noise_is_the_sensors_alone() {
    let words = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let of = |command: &str, option: &str| {
        let help = words(succeed(&[command, "--help"]));
        let (_, after) = help.split_once(&format!("{option} ")).unwrap();
        after.split(" --").next().unwrap().to_owned()
    };
    for option in ["--noise", "--exact"] {
        assert_eq!(of("simulate", option), of("compensate", option));
    }

    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let program = at("short.toml");
    let steps = "start_mm = 600\n[[steps]]\nmove_by = { by_mm = 2, velocity_mm_s = 50, acceleration_mm_s2 = 1000, jerk_mm_s3 = 50000 }\n";
    std::fs::write(&program, steps).unwrap();
    let position = |name: &str, more: &[&str]| {
        let log = at(name);
        let axis = "data/axes/liu2025.toml";
        let line = [
            "simulate",
            "--axis",
            axis,
            "--program",
            &program,
            "--log",
            &log,
        ];
        succeed(&[&line[..], more].concat());
        let log = read_log(
            std::path::Path::new(&log),
            &Mapping::default(),
            &["position_m"],
        )
        .unwrap();
        log.channel("position_m").unwrap().to_vec()
    };
    let apart = |a: &[f64], b: &[f64]| {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let still = position("still.csv", &[]);
    let near = apart(&still, &position("near.csv", &["--noise", "1e-6"]));
    let exact = apart(&still, &position("exact.csv", &["--exact"]));
    let noisy = apart(&still, &position("noisy.csv", &["--noise", "1"]));
    println!("a millionth {near:e}, exact {exact:e}, noise {noisy:e} m");
    assert!(near < 1e-12 && exact > 10.0 * near, "{near:e} {exact:e}");
    // Ten nanometres, and what the drive makes of them.
    assert!((1e-8..1e-6).contains(&noisy), "{noisy:e}");
}

#[test]
fn a_bad_axis_file_is_refused_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let good = std::fs::read_to_string(root().join("data/axes/liu2025.toml")).unwrap();
    let bad = folder.path().join("bad.toml");
    for (from, to, said) in [
        ("lead_mm = 10", "lead_inch = 0.4", "lead_inch"),
        (
            "table_mass_kg = 515",
            "table_mass_kg = -515",
            "table_mass_kg",
        ),
        ("dc_link_v = 540", "dc_link_v = nan", "dc_link_v"),
        ("[motor]", "[motor]\nwarp = 9", "warp"),
    ] {
        let content = good.replace(from, to);
        std::fs::write(&bad, &content).unwrap();
        let line = 1 + content.lines().position(|l| l.contains(said)).unwrap();
        let message = refuse(&["sample", "--axis", bad.to_str().unwrap()]);
        assert!(
            message.contains(said) && message.contains(&format!("bad.toml:{line}")),
            "{message}"
        );
        assert!(message.contains("valid"), "{message}");
    }
    let message = refuse(&["sample", "--axis", "no/such.toml"]);
    assert!(message.contains("no/such.toml"), "{message}");
}

#[test]
fn a_folder_that_cannot_be_written_is_told() {
    let message = refuse(&["sample", "--quick", "--out", "/dev/null/results"]);
    assert!(message.contains("/dev/null/results"), "{message}");
}

/// Standard output that takes nothing: an error, no panic. `/dev/full` stands
/// for a full disk and, unlike a closed pipe, without a race.
#[test]
#[cfg(target_os = "linux")]
fn standard_output_that_fails_is_told() {
    let full = std::fs::OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_feed-axis"))
        .args(["simulate", "--trajectory", "1"])
        .current_dir(root())
        .stdout(Stdio::from(full))
        .stderr(Stdio::piped())
        .output()
        .unwrap();
    let message = text(&output);
    assert!(
        !output.status.success() && !message.contains("panicked"),
        "{message}"
    );
    assert!(message.contains("standard output"), "{message}");
}

/// As where `head` has what it wants: from commands, jobs, the manual, the help and a document.
#[test]
fn a_reader_that_leaves_is_no_error_to_tell() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    for arguments in [
        &["simulate", "--trajectory", "1"][..],
        &["simulate", "--trajectory", "1", "--format", "json"],
        &["sample", "--quick", "--out", out],
        &["sample", "--quick", "--out", out, "--shard", "1/1"],
        &["completions", "bash"],
        &["man"],
        &["schema", "axis"],
        &["discover", "--help"],
    ] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_feed-axis"))
            .args(arguments)
            .current_dir(root())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(text(&output), "", "{arguments:?}");
        assert!(
            output.status.code().is_some_and(|code| code < 2),
            "{arguments:?}"
        );
    }
}

#[test]
fn simulate_writes_a_log() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("log.csv");
    let program = folder.path().join("program.toml");
    std::fs::write(
        &program,
        "start_mm = 600.0\n[[steps]]\nsine = { amplitude_mm = 1.0, frequency_hz = 5.0, cycles = 2 }\n",
    )
    .unwrap();
    let said = succeed(&[
        "simulate",
        "--program",
        program.to_str().unwrap(),
        "--log",
        log.to_str().unwrap(),
    ]);
    assert!(said.contains("tracking error"), "{said}");
    let head = std::fs::read_to_string(&log).unwrap();
    assert!(head.starts_with("t_s,position_ref_m"), "{}", &head[..60]);
    let message = refuse(&["simulate", "--trajectory", "9"]);
    assert!(message.contains("1 to 6"), "{message}");
    let read = |path: &std::path::Path| read_log(path, &Mapping::default(), &[]).unwrap();
    let expected = read(&log);
    for name in ["log.parquet", "log.mat"] {
        let other = folder.path().join(name);
        let to = other.to_str().unwrap();
        succeed(&[
            "simulate",
            "--program",
            program.to_str().unwrap(),
            "--log",
            to,
        ]);
        assert!(read(&other) == expected, "{name}");
    }
    let message = refuse(&["simulate", "--trajectory", "1", "--log", "log.txt"]);
    assert!(message.contains(".csv or .parquet or .mat"), "{message}");
}

/// A program of an axis that turns is in degrees, and only that.
#[test]
fn programs_are_in_the_unit_of_the_axis() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("program.toml");
    let joint = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/joint.toml");
    let path = program.to_str().unwrap();
    let on_joint = ["simulate", "--axis", joint, "--program", path];
    let sine = |unit: &str| {
        let text = format!(
            "start_{unit} = 10\n[[steps]]\nsine = {{ amplitude_{unit} = 1, frequency_hz = 1, cycles = 1 }}\n"
        );
        std::fs::write(&program, text).unwrap();
    };
    sine("deg");
    let said = succeed(&on_joint);
    assert!(said.contains("tracking error"), "{said}");
    let message = refuse(&["simulate", "--program", path]);
    assert!(message.contains("start_mm, to_mm"), "{message}");
    sine("mm");
    let message = refuse(&on_joint);
    let expected = "the program is in millimetres, and the axis \"joint\" turns";
    assert!(message.replace("\n", " ").contains(expected), "{message}");
}

/// Figures for people have six digits at most; a run of years is refused with
/// the limit, at once, and leaves no log behind.
/// The points of a figure in a page, the title of which begins so.
fn figure(html: &str, title: &str) -> Value {
    let after = html.split(&format!("</b> {title}<")).nth(1).expect(title);
    let json = after.split("application/json\">").nth(1).unwrap();
    serde_json::from_str(json.split("</script>").next().unwrap()).unwrap()
}

/// The greatest magnitude of the first series of a figure.
fn peak(figure: &Value) -> f64 {
    let y = &figure["series"][0]["y"];
    let [start, step] = [0, 1].map(|k| y[k].as_f64().unwrap());
    let mut sum = 0;
    let values = y[2].as_array().unwrap().iter().map(|d| {
        sum += d.as_i64().unwrap();
        start + step * sum as f64
    });
    values.fold(0.0, |most, v| most.max(v.abs()))
}

/// The page shows the peak that the command prints, in words and in its figure.
#[test]
fn simulate_shows_its_motion() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("motion.html");
    let said = succeed(&[
        "simulate",
        "--axis",
        "data/axes/linear-stage.toml",
        "--trajectory",
        "1",
        "--report",
        page.to_str().unwrap(),
    ]);
    let printed = said.split("max ").nth(1).unwrap();
    let printed: f64 = printed.split(' ').next().unwrap().parse().unwrap();
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(
        html.contains(&format!("Tracking error: {printed:.0} µm peak")),
        "{printed}"
    );
    let error = figure(&html, "Tracking error");
    assert_eq!(
        (&error["x"]["unit"], &error["y"]["unit"]),
        (&"s".into(), &"m".into())
    );
    // Kept on a grid of 65 536 steps over the range.
    assert!(
        (1e6 * peak(&error) - printed).abs() < 4e-5 * printed,
        "{printed}"
    );
    for title in ["Position of the load", "Speed of the load", "Force command"] {
        assert!(peak(&figure(&html, title)) > 0.0, "{title}");
    }
}

#[test]
fn a_comparison_needs_two_finished_runs() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().to_str().unwrap();
    let message = refuse(&["report", "--compare", run, run]);
    assert!(message.contains("summary.json"), "{message}");
    std::fs::write(folder.path().join("summary.json"), "{}").unwrap();
    let message = refuse(&["report", "--compare", run, run]);
    assert!(message.contains("pipeline --out"), "{message}");
    refuse(&["report", "--compare", run]);
}

#[test]
fn simulate_rounds_its_figures_and_refuses_a_run_without_end() {
    let said = succeed(&["simulate", "--trajectory", "1"]);
    assert!(said.contains("3.63194 s, 36320 cycles"), "{said}");
    assert!(said.contains("max 54.453 µm, mean 5.34919 µm"), "{said}");

    let folder = tempfile::tempdir().unwrap();
    let (log, program) = (
        folder.path().join("log.csv"),
        folder.path().join("program.toml"),
    );
    std::fs::write(
        &program,
        "start_mm = 600.0\n[[steps]]\ndwell = { duration_s = 1e7 }\n",
    )
    .unwrap();
    let arguments = [
        "--program",
        program.to_str().unwrap(),
        "--log",
        log.to_str().unwrap(),
    ];
    let message = refuse(&[&["simulate"], &arguments[..]].concat());
    assert!(
        message.contains("1e11 internal steps, more than 1e10"),
        "{message}"
    );
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);

    // Told before anything is computed.
    let nowhere = ["--trajectory", "1", "--log", "/dev/null/log.csv"];
    let message = refuse(&[&["simulate"], &nowhere[..]].concat());
    assert!(message.contains("/dev/null/log.csv"), "{message}");
    let nowhere = ["--trajectory", "1", "--report", "/dev/null/motion.html"];
    let message = refuse(&[&["simulate"], &nowhere[..]].concat());
    assert!(message.contains("/dev/null/motion.html"), "{message}");
}

/// Two runs that are the same: no difference is claimed.
fn compare(a: &str, b: &str) {
    let folder = tempfile::tempdir().unwrap();
    let into = folder.path().to_str().unwrap();
    succeed(&["report", "--compare", a, b, "--out", into]);
    let page = std::fs::read_to_string(folder.path().join("compare.html")).unwrap();
    assert!(page.contains("B has 0 smaller and 0 greater"));
    assert!(page.contains("No setting: axis, seed, size and version are the same."));
    assert_eq!(peak(&figure(&page, "Trajectory 1, no compensation")), {
        let whole = std::fs::read_to_string(format!("{a}/report.html")).unwrap();
        peak(&figure(&whole, "Trajectory 1"))
    });
}

/// The whole pipeline, small: its figures against the project's targets, a
/// second run that does nothing, another number of threads with the same
/// figures, and damaged or foreign results refused.
#[test]
fn the_quick_pipeline_meets_its_figures_and_guards_its_results() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let out = out.to_str().unwrap();
    succeed(&["pipeline", "--quick", "--out", out]);
    let summary = read(out);
    check_figures(&summary);
    let page = std::fs::read_to_string(format!("{out}/report.html")).unwrap();
    assert!(page.len() > 100_000 && !page.contains("NaN"));
    assert!(!page.contains("src=\"http") && !page.contains("href=\"http"));

    // Nothing is run twice.
    let again = succeed(&["pipeline", "--quick", "--out", out]);
    assert_eq!(again.matches("up to date").count(), 6, "{again}");
    // The same as one document, by the stages' names.
    let again = run(&["pipeline", "--quick", "--out", out, "--format", "json"]);
    let again: Value = serde_json::from_slice(&again.stdout).unwrap();
    assert_eq!(again["study"]["up_to_date"], true);
    assert_eq!(again["report"]["summary"], summary);
    let identified = run(&["identify", "--quick", "--out", out, "--format", "json"]);
    let identified: Value = serde_json::from_slice(&identified.stdout).unwrap();
    assert_eq!(identified["friction"]["parameters"][0]["name"], "T_C");

    // The same bits on one thread.
    let single = folder.path().join("single");
    let single = single.to_str().unwrap();
    succeed(&["pipeline", "--quick", "--threads", "1", "--out", single]);
    compare(out, single);
    let mut other = read(single);
    other["network"]["train_seconds"] = summary["network"]["train_seconds"].clone();
    assert_eq!(other, summary);

    // A flipped bit, a cut file, another axis: refused by the stages that follow.
    let network = format!("{out}/train/network.cfnn");
    let whole = std::fs::read(&network).unwrap();
    let mut flipped = whole.clone();
    flipped[whole.len() / 2] ^= 1;
    std::fs::write(&network, flipped).unwrap();
    let message = refuse(&["compensate", "--quick", "--out", out]);
    assert!(
        message.contains("network.cfnn") && message.contains("feed-axis train"),
        "{message}"
    );
    std::fs::write(&network, &whole).unwrap();
    let samples = format!("{out}/sample/training.samples");
    let whole = std::fs::read(&samples).unwrap();
    std::fs::write(&samples, &whole[..whole.len() - 7]).unwrap();
    let message = refuse(&["train", "--quick", "--out", out]);
    assert!(message.contains("training.samples"), "{message}");
    let other = "data/axes/liu2025-machine.toml";
    let message = refuse(&["compensate", "--quick", "--out", out, "--axis", other]);
    assert!(message.contains("another axis file"), "{message}");

    // The pipeline corrects what is damaged.
    succeed(&["pipeline", "--quick", "--out", out]);
    assert_eq!(std::fs::read(&samples).unwrap(), whole);
}

/// An axis that cannot have every strategy: what is left out is named, the others stand in
/// summary and report.
#[test]
fn a_pipeline_finishes_without_a_strategy_that_the_axis_cannot_have() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let out = out.to_str().unwrap();
    let axis = "data/axes/linear-stage.toml";
    let said = succeed(&["pipeline", "--quick", "--axis", axis, "--out", out]);
    assert!(
        said.contains("feedback: left out, this axis cannot have it"),
        "{said}"
    );
    let trajectories = &read(out)["trajectories"];
    for trajectory in trajectories.as_array().unwrap() {
        let compensated = &trajectory["errors_um"]["compensated"];
        assert!(compensated["plan"]["max"].is_f64(), "{compensated}");
        assert!(compensated.get("feedback").is_none(), "{compensated}");
    }
    let page = std::fs::read_to_string(format!("{out}/report.html")).unwrap();
    assert!(page.contains(
        "Left out, as no such compensation can be made for this axis: Plan and state feedback"
    ));
    assert!(!page.contains("NaN"));
}

/// A default that is not there is no default: what to give instead is said.
#[test]
fn outside_of_the_project_an_axis_file_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [
        &["pipeline"][..],
        &["simulate", "--trajectory", "1"],
        &["export", "drive", "--out", "drive"],
        &["export", "c", "--strategy", "plan", "--out", "c"],
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_feed-axis"))
            .args(arguments)
            .current_dir(folder.path())
            .output()
            .unwrap();
        let message = text(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        for help in ["--axis FILE", "feed-axis new NAME --kind KIND"] {
            assert!(message.contains(help), "{message}");
        }
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

fn read(out: &str) -> Value {
    let text = std::fs::read_to_string(format!("{out}/summary.json")).unwrap();
    let summary = serde_json::from_str(&text).unwrap();
    assert_validates("summary", &summary);
    summary
}

/// Columns 3 and 4 of the spec's table: max, mean of the model and of the
/// machine, µm, from an independent program.
const CONVERGED: [[f64; 4]; 6] = [
    [54.453, 5.3491, 55.889, 6.5557],
    [57.671, 5.3559, 59.204, 6.6828],
    [50.888, 3.0319, 52.220, 5.0092],
    [50.888, 3.5094, 52.220, 5.3596],
    [50.888, 4.2488, 52.220, 6.3426],
    [50.888, 4.4928, 52.220, 7.0091],
];
/// Peaks of the paper's Table 15, prediction model with LuGre, µm.
const PAPER_PEAKS: [f64; 6] = [17.07, 15.32, 17.19, 19.07, 11.88, 12.79];

fn check_figures(summary: &Value) {
    let trajectories = summary["trajectories"].as_array().unwrap();
    assert_eq!(trajectories.len(), 6);
    let (mut best_peak, mut best_mean) = (0.0_f64, 0.0_f64);
    for (i, t) in trajectories.iter().enumerate() {
        let errors = &t["errors_um"];
        let figure = |path: &str| {
            let value = path.split('/').fold(errors, |value, key| &value[key]);
            value
                .as_f64()
                .unwrap_or_else(|| panic!("{path} in {errors}"))
        };
        let near = |path: &str, truth: f64, by: f64| {
            let value = figure(path);
            assert!(
                (value - truth).abs() <= by,
                "trajectory {}: {path} = {value}, not {truth}",
                i + 1
            );
        };
        let [model_max, model_mean, machine_max, machine_mean] = CONVERGED[i];
        near("model/max", model_max, 0.02);
        near("model/mean", model_mean, 0.005);
        near("machine/max", machine_max, 0.02);
        near("machine/mean", machine_mean, 0.005);
        // One cycle ahead there is next to nothing to miss.
        near("predicted/network/max", machine_max, 0.1);
        // A linear model sees the inertia's error but not the break-away peak.
        let linear = figure("predicted/transfer_function/max") / machine_max;
        assert!(
            (0.2..1.0).contains(&linear),
            "transfer function predicts {linear} of the peak"
        );

        let alone = figure("compensated/network/max");
        assert!((27.0..=36.0).contains(&alone), "network alone {alone}");
        let both = figure("compensated/network_lugre/max");
        assert!(both <= PAPER_PEAKS[i], "network and LuGre {both}");
        best_peak = best_peak.max(1.0 - both / machine_max);
        best_mean = best_mean.max(1.0 - figure("compensated/network_lugre/mean") / machine_mean);
        // A linear model of the error does better than none, and with LuGre than LuGre alone.
        assert!(figure("compensated/transfer_function/max") < machine_max);
        assert!(
            figure("compensated/transfer_function_lugre/max") < figure("compensated/lugre/max")
        );
    }
    assert!(best_peak >= 0.767, "best peak reduction {best_peak}");
    assert!(best_mean >= 0.637, "best mean reduction {best_mean}");
    let network = &summary["network"];
    let value = |key: &str| network[key].as_f64().unwrap();
    // Even the small network beats the linear map; the full one by far more.
    assert!(value("max_abs_error_um") < value("linear_max_abs_error_um"));
    assert!(value("mean_abs_error_um") < value("linear_mean_abs_error_um"));
}
