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

/// The message with which `contour` refuses this of the machine of two axes.
fn refused_on_xy(arguments: &[&str]) -> String {
    refuse(&[&["contour", "--machine", XY][..], arguments].concat())
}

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
        assert!((value - 20.0).abs() < 0.1, "{found}");
    }
    assert_eq!(found["directions"].as_array().unwrap().len(), 2);
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("magnified") && html.contains("Found from circles at two feeds"));
    let plan = ["--compensation", "plan", "--radius", "25"];
    let message = refused_on_xy(&[&plan[..], &["--identify", "3"]].concat());
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

/// A right angle with and without a blend of 1 mm; the closed form of a path that stops is twice that of one side.
#[test]
fn corners_of_a_program_are_blended() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("corner.ngc");
    let file = program.display().to_string();
    let found = |text: &str, more: &[&str]| -> serde_json::Value {
        std::fs::write(&program, text).unwrap();
        let asked = [
            "contour",
            "--x",
            STAGE,
            "--y",
            STAGE,
            "--program",
            &file,
            "--format",
            "json",
        ];
        let output = run(&[&asked[..], more].concat());
        assert!(output.status.success(), "{output:?}");
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()["directions"][0]
            .clone()
    };
    let corners = |found: &serde_json::Value| found["corners"].as_array().unwrap().len();
    let duration = |found: &serde_json::Value| found["duration_s"].as_f64().unwrap();
    let lines = "F3000\nG1 X20\nG1 Y20\n";
    let stopping = found(lines, &[]);
    // d/V + V/A + A/J of each side.
    let side = 0.02 / 0.05 + 0.05 / 1.0 + 1.0 / 20.0;
    assert_eq!(corners(&stopping), 1);
    assert!(
        (duration(&stopping) - 2.0 * side).abs() < 1e-9,
        "{stopping}"
    );
    let blended = found(lines, &["--blend", "1"]);
    assert!(corners(&blended) == 0 && duration(&blended) < 0.98 * duration(&stopping));
    // A line of the program more, and the same path.
    let by_word = found(&format!("G64 P1\n{lines}"), &[]);
    assert_eq!(by_word["laps"], blended["laps"]);
    assert_eq!(
        corners(&found(&format!("G61\n{lines}"), &["--blend", "1"])),
        1
    );
    let arc = found(lines, &["--blend", "1", "--blend-shape", "arc"]);
    assert_eq!(arc["curves"].as_array().unwrap().len(), 1);
    let asked = ["contour", "--x", STAGE, "--y", STAGE];
    let message = refuse(&[&asked[..], &["--blend", "1"]].concat());
    assert!(message.contains("--program"), "{message}");
    let message = refuse(&[&asked[..], &["--program", &file, "--blend", "-1"]].concat());
    assert!(
        message.contains("--blend is -1 mm; valid: from 1e-6"),
        "{message}"
    );
}

/// A quarter of a circle of 5 mm as a rational curve, at its feed and at two others: the curve is tightest
/// everywhere, so no place of it is listed, and each feed has its row.
#[test]
fn a_curve_from_a_file_is_run_at_several_feeds() {
    let folder = tempfile::tempdir().unwrap();
    let curve = folder.path().join("quarter.toml");
    let text = "degree = 2\npoints_mm = [[5, 0], [5, 5], [0, 5]]\nweights = [1, 0.7071067811865476, 1]\nknots = [0, 0, 0, 1, 1, 1]\n";
    std::fs::write(&curve, text).unwrap();
    let shown = curve.display().to_string();
    let asked = |feeds: &str| {
        run(&[
            "contour", "--x", STAGE, "--y", STAGE, "--nurbs", &shown, "--feed", "0.5", "--feeds",
            feeds, "--format", "json",
        ])
    };
    let output = asked("0.25,1");
    assert!(output.status.success(), "{output:?}");
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = found["feeds"].as_array().unwrap();
    let of = |row: usize, key: &str| rows[row][key].as_f64().unwrap();
    assert_eq!(
        [of(0, "feed_m_per_min"), of(1, "feed_m_per_min")],
        [0.25, 1.0]
    );
    // 7.854 mm at 0.25 m/min take 1.885 s, and some tenths to begin and end.
    assert!((1.885..2.2).contains(&of(0, "duration_s")), "{found}");
    assert!(of(1, "last_um") > of(0, "last_um"), "{found}");
    // Decimal commas are answered with what is meant.
    std::fs::write(&curve, text.replace("degree = 2", "degree = 2,0")).unwrap();
    let message = String::from_utf8(asked("1").stderr).unwrap();
    assert!(message.contains("decimal point: degree = 2.0"), "{message}");
}

#[test]
fn what_a_machine_cannot_run_is_said() {
    let message = refuse(&["contour", "--machine", "data/machines/none.toml"]);
    assert!(message.contains("none.toml"), "{message}");
    let message = refused_on_xy(&["--tilt", "35"]);
    assert!(
        message.contains("3 coordinates") && message.contains("has 2 axes"),
        "{message}"
    );
    let message = refused_on_xy(&["--laps", "0"]);
    assert!(message.contains("--laps"), "{message}");
    let message = refused_on_xy(&["--butterfly", "--identify", "3,10"]);
    assert!(message.contains("--identify takes circles"), "{message}");
    let message = refused_on_xy(&["--x", STAGE, "--y", STAGE]);
    assert!(message.contains("--machine"), "{message}");
    let message = refuse(&["contour", "--x", STAGE]);
    assert!(message.contains("--y"), "{message}");
    let message = refused_on_xy(&["--program", "data/axes/rack.toml"]);
    assert!(message.contains("line 1"), "{message}");
    let message = refused_on_xy(&["--nurbs", "data/axes/rack.toml"]);
    assert!(message.contains("--nurbs"), "{message}");
    let message = refused_on_xy(&["--feeds", "nan"]);
    assert!(message.contains("feed"), "{message}");
}
