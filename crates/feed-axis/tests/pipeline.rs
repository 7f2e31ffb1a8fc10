//! The whole pipeline in its small version: its figures, what it refuses, what it leaves alone.

use serde_json::Value;

use crate::common::{refuse, run, succeed};
use crate::schema_of::assert_validates;
use crate::simulate::{figure, peak};

#[test]
fn a_comparison_needs_two_finished_runs() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().to_str().unwrap();
    let message = refuse(&["report", "--compare", run, run]);
    assert!(message.contains("summary.json"), "{message}");
    std::fs::write(folder.path().join("summary.json"), "{}").unwrap();
    let message = refuse(&["report", "--compare", run, run]);
    assert!(
        message.contains("feed-axis pipeline --axis FILE --out"),
        "{message}"
    );
    refuse(&["report", "--compare", run]);
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

/// Two axes with the network of each, from the folder of results.
fn on_a_circle(runs: &str) {
    let axis = "data/axes/liu2025.toml";
    let circle = ["contour", "--x", axis, "--y", axis, "--radius", "5"];
    let found = |more: &[&str]| -> Value {
        let output = run(&[&circle[..], &["--laps", "2", "--format", "json"], more].concat());
        assert!(output.status.success(), "{output:?}");
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let network = ["--compensation", "network", "--runs", runs];
    let under = found(&[&network[..], &["--quick"]].concat());
    let none = found(&[]);
    let error = |found: &Value| {
        found["directions"][0]["laps"][1]["contour_error_um"]
            .as_f64()
            .unwrap()
    };
    assert!(error(&under) < 0.8 * error(&none), "{under} {none}");
    let rows = under["networks"].as_array().unwrap();
    assert_eq!((rows.len(), &rows[1]["axis"]), (2, &Value::from("Y")));
    assert!(rows[0]["unseen_um"][0].as_f64() < rows[0]["linear_um"][0].as_f64());
    // Those of another size are not taken.
    let message = refuse(&[&circle[..], &network].concat());
    assert!(
        message.contains("the trained network of liu2025") && message.contains("--quick"),
        "{message}"
    );
}

/// The whole pipeline of the paper's axis, small: its figures against the project's targets.
#[test]
fn the_quick_pipeline_meets_its_figures() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("liu2025");
    let out = out.to_str().unwrap();
    succeed(&["pipeline", "--quick", "--out", out]);
    check_figures(&read(out));
    on_a_circle(folder.path().to_str().unwrap());
    let page = std::fs::read_to_string(format!("{out}/report.html")).unwrap();
    assert!(page.len() > 100_000 && !page.contains("NaN"));
    assert!(page.contains("Margins of each case"));
    assert!(!page.contains("src=\"http") && !page.contains("href=\"http"));
}

const STAGE: &str = "data/axes/linear-stage.toml";

/// A command of the small pipeline of another axis.
fn on_the_stage<'a>(command: &'a str, out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&[command, "--quick", "--axis", STAGE, "--out", out], more].concat()
}

/// A second run that does nothing, another number of threads with the same figures, and damaged or
/// foreign results refused. The strategies that this axis cannot have are named, and the others stand
/// in summary and report.
#[test]
fn a_pipeline_guards_its_results_and_names_what_its_axis_cannot_have() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("stage");
    let out = out.to_str().unwrap();
    let said = succeed(&on_the_stage("pipeline", out, &[]));
    assert!(
        said.contains("feedback: left out, this axis cannot have it"),
        "{said}"
    );
    let summary = read(out);
    without_feedback(out, &summary);

    // Nothing is run twice.
    let again = succeed(&on_the_stage("pipeline", out, &[]));
    assert_eq!(again.matches("up to date").count(), 6, "{again}");
    // The same as one document, by the stages' names.
    let document = |command| -> Value {
        let output = run(&on_the_stage(command, out, &["--format", "json"]));
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let again = document("pipeline");
    assert_eq!(again["study"]["up_to_date"], true);
    assert_eq!(again["report"]["summary"], summary);
    let identified = document("identify");
    assert_eq!(identified["friction"]["parameters"][0]["name"], "T_C");

    // The same bits on one thread.
    let single = folder.path().join("single");
    let single = single.to_str().unwrap();
    succeed(&on_the_stage("pipeline", single, &["--threads", "1"]));
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
    let message = refuse(&on_the_stage("compensate", out, &[]));
    assert!(
        message.contains("network.cfnn") && message.contains("feed-axis train"),
        "{message}"
    );
    std::fs::write(&network, &whole).unwrap();
    let samples = format!("{out}/sample/training.samples");
    let whole = std::fs::read(&samples).unwrap();
    std::fs::write(&samples, &whole[..whole.len() - 7]).unwrap();
    let message = refuse(&on_the_stage("train", out, &[]));
    assert!(message.contains("training.samples"), "{message}");
    let other = "data/axes/rack.toml";
    let message = refuse(&["compensate", "--quick", "--out", out, "--axis", other]);
    assert!(message.contains("another axis file"), "{message}");

    // The pipeline corrects what is damaged.
    succeed(&on_the_stage("pipeline", out, &[]));
    assert_eq!(std::fs::read(&samples).unwrap(), whole);
}

/// What summary and report say where an axis cannot have feedback.
fn without_feedback(out: &str, summary: &Value) {
    // Of its only loop its file says 60°, which python-control agrees with; the least is with the heaviest load.
    let phase = summary["loops"]["model"]["phase_deg"].as_f64().unwrap();
    assert!((54.0..59.0).contains(&phase), "{phase}");
    let trajectories = &summary["trajectories"];
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
    // By an independent search and python-control: 1.51 at the start, a little more over the stroke.
    for which in ["model", "machine"] {
        let loops = &summary["loops"][which];
        let sensitivity = loops["sensitivity"].as_f64().unwrap();
        assert!((1.49..1.54).contains(&sensitivity), "{loops}");
        assert_eq!(
            (&loops["cases"], &loops["unstable"]),
            (&24.into(), &0.into())
        );
    }
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
