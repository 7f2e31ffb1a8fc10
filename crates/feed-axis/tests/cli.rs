//! Help, options of several commands, and what is refused before any work.

use crate::common::{refuse, root, run, succeed, text};
use axis_log::{Mapping, read_log};

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
        ("[actuator]", "[actuator]\nwarp = 9", "warp"),
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

/// What is wrong with `--set` is said of the option, not of a line that the file does not have.
#[test]
fn a_key_set_wrongly_is_named_by_its_option() {
    let axis = "data/axes/liu2025.toml";
    let commands: [&[&str]; 5] = [
        &["analyse"],
        &["tune", "--out", "/dev/null/no.toml"],
        &["check", "--trajectory", "1"],
        &["heat"],
        &["compensate", "--strategy", "plan", "--moves", "1"],
    ];
    for command in commands {
        let with = |keys: &[&str]| {
            let keys: Vec<&str> = keys.iter().flat_map(|key| ["--set", key]).collect();
            let output = run(&[command, &["--axis", axis], &keys].concat());
            assert_eq!(output.status.code(), Some(2), "{output:?}");
            text(&output)
        };
        let message = with(&["control.frequency_khz=5", "mechanism.table_mass_kg=-515"]);
        for part in [
            "--set mechanism.table_mass_kg=-515: `mechanism.",
            "table_mass_kg` is -515; valid: a number from",
        ] {
            assert!(message.contains(part), "{message}");
        }
        assert!(!message.contains(".toml:"), "{message}");
        assert!(!message.contains("frequency_khz=5"), "{message}");
        let message = with(&["drive.table_mass_kg=415"]);
        assert!(
            message.contains("--set drive.table_mass_kg=415: "),
            "{message}"
        );
        assert!(
            message.contains("the file has no table drive, its tables are: "),
            "{message}"
        );
        let message = with(&["trajectory.2.displacement_mm=far"]);
        let part = "--set trajectory.2.displacement_mm=far: `trajectory[2].displacement_mm` is a text; valid:";
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_told() {
    let message = refuse(&["sample", "--quick", "--out", "/dev/null/results"]);
    assert!(message.contains("/dev/null/results"), "{message}");
}
