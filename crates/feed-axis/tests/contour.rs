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

const XY: &str = "data/machines/liu2025-xy.toml";

#[test]
fn two_feeds_tell_squareness_from_crosstalk_and_correct_both() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("machine.html").display().to_string();
    let output = run(&[
        "contour",
        "--machine",
        XY,
        "--compensation",
        "plan",
        "--radius",
        "25",
        "--identify",
        "2,6",
        "--correct",
        "--report",
        &page,
        "--format",
        "json",
    ]);
    assert!(output.status.success(), "{output:?}");
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    for of in ["squareness_um_per_m", "crosstalk_um_per_m_per_s2"] {
        let value = found["identified"][of][0].as_f64().unwrap();
        // Measured: 20.0 and 20.0.
        assert!((value - 20.0).abs() < 0.5, "{found}");
    }
    assert_eq!(found["directions"].as_array().unwrap().len(), 2);
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("magnified") && html.contains("Found from circles at two feeds"));
    let message = refuse(&[
        "contour",
        "--machine",
        XY,
        "--compensation",
        "plan",
        "--radius",
        "25",
        "--identify",
        "3",
    ]);
    assert!(message.contains("5 of 6 unknowns"), "{message}");
}

#[test]
fn a_program_is_run_in_laps() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("part.ngc");
    std::fs::write(
        &program,
        "G21 G90\nG0 X2 Y0\nF1500\nG1 X8\nG3 X10 Y2 I0 J2\nG1 Y8\nG1 X2 Y0\nF3000\nG1 X0\n",
    )
    .unwrap();
    let program = program.display().to_string();
    let page = folder.path().join("part.html").display().to_string();
    let text = succeed(&[
        "contour",
        "--x",
        STAGE,
        "--y",
        STAGE,
        "--program",
        &program,
        "--laps",
        "2",
        "--report",
        &page,
    ]);
    assert!(
        text.contains("lap 2") && text.contains("corner at 15.142 mm, 135.0°"),
        "{text}"
    );
    assert!(text.contains("radius 2.0000 mm"), "{text}");
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("Path and tool, last lap") && html.contains("Tightest curves"));
}

#[test]
fn what_a_machine_cannot_run_is_said() {
    let message = refuse(&["contour", "--machine", "data/machines/none.toml"]);
    assert!(message.contains("none.toml"), "{message}");
    let message = refuse(&["contour", "--machine", XY, "--tilt", "35"]);
    assert!(
        message.contains("3 coordinates") && message.contains("has 2 axes"),
        "{message}"
    );
    let message = refuse(&["contour", "--machine", XY, "--laps", "0"]);
    assert!(message.contains("--laps"), "{message}");
    let message = refuse(&[
        "contour",
        "--machine",
        XY,
        "--butterfly",
        "--identify",
        "3,10",
    ]);
    assert!(message.contains("--identify takes circles"), "{message}");
    let message = refuse(&["contour", "--machine", XY, "--x", STAGE, "--y", STAGE]);
    assert!(message.contains("--machine"), "{message}");
    let message = refuse(&["contour", "--x", STAGE]);
    assert!(message.contains("--y"), "{message}");
    let message = refuse(&[
        "contour",
        "--machine",
        XY,
        "--program",
        "data/axes/rack.toml",
    ]);
    assert!(message.contains("line 1"), "{message}");
    let message = refuse(&["contour", "--machine", XY, "--nurbs", "data/axes/rack.toml"]);
    assert!(message.contains("--nurbs"), "{message}");
    let message = refuse(&["contour", "--machine", XY, "--feeds", "nan"]);
    assert!(message.contains("feed"), "{message}");
}
