//! `simulate`: its log, its page, its figures, and motions that it refuses.

use axis_log::{Mapping, read_log};
use serde_json::Value;

use crate::common::{refuse, succeed};

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
    assert!(
        message.contains("has trajectories 1 (by 300 mm at up to 100 mm/s), 2 (by"),
        "{message}"
    );
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

/// The points of a figure in a page, the title of which begins so.
pub fn figure(html: &str, title: &str) -> Value {
    let after = html.split(&format!("</b> {title}<")).nth(1).expect(title);
    let json = after.split("application/json\">").nth(1).unwrap();
    serde_json::from_str(json.split("</script>").next().unwrap()).unwrap()
}

/// The greatest magnitude of the first series of a figure.
pub fn peak(figure: &Value) -> f64 {
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
fn a_decimal_comma_in_a_program_is_answered_with_the_line_as_it_should_be() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("comma.toml").display().to_string();
    std::fs::write(&file, "start_mm = 600,5\n").unwrap();
    for command in ["simulate", "heat"] {
        let message = refuse(&[
            command,
            "--axis",
            "data/axes/screw-heat.toml",
            "--program",
            &file,
        ]);
        assert!(
            message.contains("decimal point: start_mm = 600.5"),
            "{message}"
        );
    }
}

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

/// Figures for people have six digits at most; a run of years is refused with
/// the limit, at once, and leaves no log behind.
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
