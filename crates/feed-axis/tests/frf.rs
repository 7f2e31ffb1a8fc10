//! `[excitation]`, `frf` and `tune --frf`: from an excited slide to gains that are safe on a machine with a hidden delay.

use serde_json::Value;

use crate::common::{refuse, run, succeed};
use crate::schema_of::assert_validates;

const AXIS: &str = "data/axes/rack.toml";
const LATE: &str = "actuator.delay_us=425";

/// A slide of the rack of 5 s at 50 mm/s with something added to its torque.
fn program(excitation: &str) -> String {
    format!(
        r#"start_mm = 500

[excitation]
{excitation}

[[steps]]
dwell = {{ duration_s = 0.1 }}

[[steps]]
move = {{ to_mm = 753, velocity_mm_s = 50, acceleration_mm_s2 = 1000, jerk_mm_s3 = 20000 }}

[[steps]]
dwell = {{ duration_s = 0.1 }}
"#
    )
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn at(&self, name: &str) -> String {
        self.0.path().join(name).display().to_string()
    }

    fn write(&self, name: &str, text: &str) -> String {
        let path = self.at(name);
        std::fs::write(&path, text).unwrap();
        path
    }
}

fn json(arguments: &[&str]) -> Value {
    let output = run(arguments);
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_hidden_delay_is_measured_and_tuned_with() {
    let folder = Folder::new();
    let prbs = "signal = \"prbs\"\namplitude_n_m = 4\nclock_cycles = 2\nregister = 12";
    let slide = folder.write("slide.toml", &program(prbs));
    let (log, page) = (folder.at("slide.parquet"), folder.at("frf.html"));
    // A delay of one cycle in the file, 0.3 ms more on the machine.
    succeed(&[
        "simulate",
        "--axis",
        AXIS,
        "--set",
        LATE,
        "--program",
        &slide,
        "--noise",
        "1",
        "--log",
        &log,
    ]);
    let found = json(&[
        "frf", &log, "--axis", AXIS, "--report", &page, "--format", "json",
    ]);
    assert_validates("frf", &found);
    let one = &found["measurements"][0];
    let late = one["comparison"]["delay_s"]["value"].as_f64().unwrap();
    assert!((late - 3e-4).abs() < 6e-6, "{late:e}");
    assert!(
        one["traps"].as_array().unwrap().is_empty(),
        "{}",
        one["traps"]
    );
    let said = succeed(&["frf", &log, "--axis", AXIS]);
    assert!(said.contains("0.300 ms later than the model's"), "{said}");
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("Command to motor speed") && html.contains("command_delay"));

    let greatest = |tuned: &str| {
        let found = json(&[
            "analyse", "--axis", tuned, "--set", LATE, "--mass", "1", "--format", "json",
        ]);
        found["worst"]["sensitivity"].as_f64().unwrap()
    };
    let (blind, seeing) = (folder.at("blind.toml"), folder.at("seeing.toml"));
    let tune = ["tune", "--axis", AXIS, "--mass", "1", "--no-notch", "--out"];
    succeed(&[&tune[..], &[&blind]].concat());
    let said = succeed(&[&tune[..], &[&seeing, "--frf", &log]].concat());
    assert!(
        said.contains("limits hold for 1 measured responses"),
        "{said}"
    );
    // Found: 2.86 and 1.60.
    let [blind, seeing] = [greatest(&blind), greatest(&seeing)];
    assert!(blind > 2.0 && seeing < 1.7, "{blind} {seeing}");
}

/// A log whose command is missing shows the machine's modes, and nothing that the drive has a part in.
#[test]
fn a_log_without_a_command_says_what_stands_in_its_place() {
    let folder = Folder::new();
    let axis = "data/axes/liu2025.toml";
    let slide = program("signal = \"prbs\"\namplitude_a = 2\nclock_cycles = 2\nregister = 11");
    let slide = folder.write("slide.toml", &slide);
    let log = folder.at("slide.csv");
    succeed(&[
        "simulate",
        "--axis",
        axis,
        "--program",
        &slide,
        "--noise",
        "1",
        "--log",
        &log,
    ]);
    let whole = std::fs::read_to_string(&log).unwrap();
    let head: Vec<&str> = whole.lines().next().unwrap().split(',').collect();
    let command = head.iter().position(|name| *name == "iq_ref_a").unwrap();
    let without = |line: &str| {
        let mut cells: Vec<&str> = line.split(',').collect();
        cells.remove(command);
        cells.join(",") + "\n"
    };
    let less: String = whole.lines().map(without).collect();
    let less = folder.write("less.csv", &less);
    let said = succeed(&["frf", &less, "--axis", axis]);
    for part in [
        "not usable: the log has no command (channel iq_ref_a), and iq_a, which follows it, stands in its place",
        "mode at 6",
    ] {
        assert!(said.contains(part), "no {part:?} in {said}");
    }
    for part in ["too many", "against the model", "maximum sensitivity"] {
        assert!(!said.contains(part), "{part:?} in {said}");
    }
    let out = folder.at("tuned.toml");
    let message = refuse(&["tune", "--axis", axis, "--out", &out, "--frf", &less]);
    assert!(message.contains("channel iq_ref_a"), "{message}");
    // With the command each mode stands beside the model's.
    let said = succeed(&["frf", &log, "--axis", axis]);
    assert!(said.contains("; the model's: 6"), "{said}");
}

#[test]
fn what_cannot_be_measured_is_said() {
    let folder = Folder::new();
    let log = folder.at("move.parquet");
    succeed(&[
        "simulate",
        "--axis",
        AXIS,
        "--trajectory",
        "1",
        "--log",
        &log,
    ]);
    let said = succeed(&["frf", &log, "--axis", AXIS]);
    assert!(
        said.contains("not usable: the log has no excitation (channel excitation_n_m)"),
        "{said}"
    );
    let out = folder.at("tuned.toml");
    let message = refuse(&["tune", "--axis", AXIS, "--out", &out, "--frf", &log]);
    assert!(
        message.contains("cannot be tuned on measured response 1: the log has no"),
        "{message}"
    );
    assert!(!std::path::Path::new(&out).exists());

    for (excitation, said) in [
        (
            "signal = \"prbs\"",
            "the amplitude is missing; valid: amplitude_n_m, such as a tenth of the greatest command, 4",
        ),
        (
            "signal = \"prbs\"\namplitude_a = 2",
            "amplitude_a is not in the unit of this axis' command; valid: amplitude_n_m",
        ),
        (
            "signal = \"chirp\"\namplitude_n_m = 2\nclock_cycles = 2",
            "clock_cycles does not go with signal = \"chirp\"",
        ),
        (
            "signal = \"prbs\"\namplitude_n_m = 2\nregister = 40",
            "the shift register is 40; valid: 5 to 20 bits",
        ),
        (
            "signal = \"prbs\"\namplitude_n_m = -1",
            "the amplitude is -1; valid: above 0",
        ),
        (
            "signal = \"multisine\"\namplitude_n_m = 1\nto_hz = 9000",
            "the highest frequency is 9000",
        ),
        (
            "signal = \"prbs\"\namplitude_n_m = 1\nfrom_s = 9",
            "are no part of the program",
        ),
        (
            "signal = \"prbs\"\namplitude_n_m = 2,5",
            "decimal point: amplitude_n_m = 2.5",
        ),
        (
            "signal = \"noise\"\namplitude_n_m = 1",
            "unknown variant `noise`",
        ),
        (
            "signal = \"prbs\"\nloudness = 1",
            "unknown field `loudness`",
        ),
    ] {
        let file = folder.write("bad.toml", &program(excitation));
        let message = refuse(&["simulate", "--axis", AXIS, "--program", &file]);
        assert!(message.contains(said), "{excitation}: {message}");
    }
    // A program that never moves at constant speed.
    let still = "start_mm = 500\n[[steps]]\ndwell = { duration_s = 1 }\n[excitation]\nsignal = \"prbs\"\namplitude_n_m = 1\n";
    let still = folder.write("still.toml", still);
    let message = refuse(&["simulate", "--axis", AXIS, "--program", &still]);
    assert!(
        message.contains("never moves at constant speed"),
        "{message}"
    );
}

/// The same response by other excitations; a chirp has no periods.
#[test]
fn chirps_and_multisines_measure_too() {
    let folder = Folder::new();
    for (signal, method) in [
        (
            "signal = \"chirp\"\namplitude_n_m = 2\nfrom_hz = 2\nto_hz = 800",
            "segments of 0.833 s",
        ),
        (
            "signal = \"multisine\"\namplitude_n_m = 4\nto_hz = 800",
            "whole periods of 1.024 s",
        ),
    ] {
        let slide = folder.write("slide.toml", &program(signal));
        let log = folder.at("slide.csv");
        succeed(&[
            "simulate",
            "--axis",
            AXIS,
            "--program",
            &slide,
            "--noise",
            "1",
            "--log",
            &log,
        ]);
        let found = json(&["frf", &log, "--axis", AXIS, "--format", "json"]);
        let one = &found["measurements"][0];
        assert!(
            one["method"].as_str().unwrap().contains(method),
            "{}",
            one["method"]
        );
        let distance = one["comparison"]["distance"].as_f64().unwrap();
        let late = one["comparison"]["delay_s"]["value"].as_f64().unwrap();
        assert!(
            distance < 0.06 && late.abs() < 1e-5,
            "{signal}: {distance} {late}"
        );
    }
}
