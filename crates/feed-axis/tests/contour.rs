//! `contour`: two axes on a circle.

use crate::common::{refuse, run, succeed};

const STAGE: &str = "data/axes/linear-stage.toml";

#[test]
fn a_plan_takes_away_most_of_a_circles_error() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("circle.html").display().to_string();
    let circle = |more: &[&str]| -> serde_json::Value {
        let mut arguments = vec![
            "contour", "--x", STAGE, "--y", STAGE, "--radius", "10", "--format", "json",
        ];
        arguments.extend_from_slice(more);
        let output = run(&arguments);
        assert!(output.status.success(), "{output:?}");
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let none = circle(&["--report", &page]);
    let plan = circle(&["--compensation", "plan"]);
    let error =
        |found: &serde_json::Value, way: &str| found[way]["contour_error_um"].as_f64().unwrap();
    for way in ["clockwise", "counterclockwise"] {
        assert!(error(&plan, way) < 0.1 * error(&none, way), "{none} {plan}");
        assert_eq!(none[way]["reversals"].as_array().unwrap().len(), 4);
    }
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("Radial deviation over angle"));
    let text = succeed(&["contour", "--x", STAGE, "--y", STAGE, "--radius", "10"]);
    assert!(text.contains("circular hysteresis H"), "{text}");
}

#[test]
fn what_cannot_run_a_circle_is_refused() {
    let turns = "data/axes/rotary-table.toml";
    let message = refuse(&["contour", "--x", STAGE, "--y", turns]);
    assert!(
        message.contains("--y") && message.contains("turns"),
        "{message}"
    );
    let message = refuse(&[
        "contour",
        "--x",
        STAGE,
        "--y",
        STAGE,
        "--compensation",
        "network",
    ]);
    assert!(message.contains("the trained network"), "{message}");
    let message = refuse(&["contour", "--x", STAGE, "--y", STAGE, "--radius", "-1"]);
    assert!(message.contains("radius"), "{message}");
    let message = refuse(&["contour", "--x", STAGE, "--y", STAGE, "--feed", "-1"]);
    assert!(
        message.contains("--feed") && message.contains("m/s"),
        "{message}"
    );
    // The stage goes 100 mm to either side of where it begins; the circle asks for 1.7 radii.
    let message = refuse(&["contour", "--x", STAGE, "--y", STAGE, "--radius", "60"]);
    assert!(
        message.contains("axis 1") && message.contains("valid"),
        "{message}"
    );
}
