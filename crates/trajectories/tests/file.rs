//! Programs read from and written to TOML.
#![cfg(feature = "serde")]

use proptest::prelude::*;
use trajectories::{Chirp, Limits, Motion, Program, ProgramUnit, Sine, Step, Sweep};

const PROGRAM: &str = r#"
start_mm = 600.0

[[steps]]
move = { to_mm = 900.0, velocity_mm_s = 100.0, acceleration_mm_s2 = 225.0, jerk_mm_s3 = 1200.0 }
[[steps]]
dwell = { duration_s = 0.5 }
[[steps]]
move_by = { by_mm = -50.0, velocity_mm_s = 20.0, acceleration_mm_s2 = 225.0, jerk_mm_s3 = 1200.0 }
[[steps]]
sine = { amplitude_mm = 1.0, frequency_hz = 5.0, cycles = 10 }
[[steps]]
chirp = { amplitude_mm = 0.1, from_frequency_hz = 1.0, to_frequency_hz = 100.0, duration_s = 10.0, ramp_s = 2.0, sweep = "logarithmic" }
[[steps]]
chirp = { amplitude_mm = 0.1, from_frequency_hz = 1.0, to_frequency_hz = 10.0, duration_s = 10.0 }
"#;

#[test]
fn millimetres_become_the_nearest_metres() {
    let program: Program = toml::from_str(PROGRAM).unwrap();
    assert_eq!(program.start(), 0.6);
    let steps = program.steps();
    let limits = Limits::new(0.1, 0.225, 1.2).unwrap();
    assert_eq!(steps[0], Step::Move { to: 0.9, limits });
    assert_eq!(steps[1], Step::Dwell { duration: 0.5 });
    let limits = Limits::new(0.02, 0.225, 1.2).unwrap();
    assert_eq!(steps[2], Step::MoveBy { by: -0.05, limits });
    assert_eq!(
        steps[3],
        Step::Sine(Sine {
            amplitude: 1e-3,
            frequency: 5.0,
            cycles: 10
        })
    );
    let chirp = Chirp {
        amplitude: 1e-4,
        from_frequency: 1.0,
        to_frequency: 100.0,
        duration: 10.0,
        ramp: 2.0,
        sweep: Sweep::Logarithmic,
    };
    assert_eq!(steps[4], Step::Chirp(chirp));
    // Left out: a tenth of the duration, and linear.
    let chirp = Chirp {
        to_frequency: 10.0,
        ramp: 1.0,
        sweep: Sweep::Linear,
        ..chirp
    };
    assert_eq!(steps[5], Step::Chirp(chirp));
    assert_eq!(program.end(), 0.85);
    // d/V + V/A + A/J; the dwell; d/V + 2 √(V/J); 12 periods; twice 10 s.
    let moves = 3.0 + 4.0 / 9.0 + 3.0 / 16.0 + 2.5 + 2.0 * (0.02f64 / 1.2).sqrt();
    let expected = moves + 0.5 + 2.4 + 20.0;
    // 3.6e-15 is one unit in the last place.
    assert!((program.duration() - expected).abs() < 1.5e-14);
}

#[test]
fn a_written_program_reads_back_the_same() {
    let program: Program = toml::from_str(PROGRAM).unwrap();
    let written = toml::to_string(&program).unwrap();
    assert_eq!(toml::from_str::<Program>(&written).unwrap(), program);
}

const TURNING: &str = r#"
start_deg = -30.0

[[steps]]
move = { to_deg = 60.0, velocity_deg_s = 90.0, acceleration_deg_s2 = 300.0, jerk_deg_s3 = 3000.0 }
[[steps]]
move_by = { by_deg = -15.0, velocity_deg_s = 20.0, acceleration_deg_s2 = 225.0, jerk_deg_s3 = 1200.0 }
[[steps]]
sine = { amplitude_deg = 1.5, frequency_hz = 5.0, cycles = 10 }
[[steps]]
chirp = { amplitude_deg = 0.1, from_frequency_hz = 1.0, to_frequency_hz = 100.0, duration_s = 10.0 }
"#;

#[test]
fn degrees_become_radians_and_are_written_as_degrees() {
    let program: Program = toml::from_str(TURNING).unwrap();
    assert_eq!(program.unit(), ProgramUnit::Degrees);
    assert_eq!(program.start(), (-30.0_f64).to_radians());
    let degrees = f64::to_radians;
    let limits = Limits::new(degrees(90.0), degrees(300.0), degrees(3000.0)).unwrap();
    let to = degrees(60.0);
    assert_eq!(program.steps()[0], Step::Move { to, limits });
    assert!((program.end() - degrees(45.0)).abs() < 1e-15);
    let written = toml::to_string(&program).unwrap();
    assert!(!written.contains("mm"), "{written}");
    assert_eq!(toml::from_str::<Program>(&written).unwrap(), program);
    // Another scalar, and a program that was made here.
    assert_eq!(program.cast::<f32>().unwrap().unit(), ProgramUnit::Degrees);
    let made = Program::new(0.5, Vec::new()).unwrap();
    let written = toml::to_string(&made.with_unit(ProgramUnit::Degrees)).unwrap();
    assert!(
        written.starts_with("start_deg = 28.64788975654116"),
        "{written}"
    );
}

#[test]
fn a_program_has_one_unit() {
    let refused = |text: &str| toml::from_str::<Program>(text).unwrap_err().to_string();
    let mixed = refused(
        "start_mm = 0.0\n[[steps]]\nsine = { amplitude_deg = 1.0, frequency_hz = 5.0, cycles = 1 }",
    );
    let expected = "step 1 (sine): `amplitude_deg` in a program that is in millimetres: `amplitude_mm` would be right";
    assert!(mixed.contains(expected), "{mixed}");
    let both = refused("start_mm = 0.0\nstart_deg = 0.0\nsteps = []");
    assert!(
        both.contains("`start_deg` in a program that is in millimetres"),
        "{both}"
    );
    let neither = refused("steps = []");
    assert!(
        neither.contains("missing field `start_mm` or `start_deg`"),
        "{neither}"
    );
    let missing = refused(
        "start_deg = 0.0\n[[steps]]\nmove = { velocity_deg_s = 1.0, acceleration_deg_s2 = 1.0, jerk_deg_s3 = 1.0 }",
    );
    assert!(
        missing.contains("step 1 (move): missing field `to_deg`"),
        "{missing}"
    );
}

proptest! {
    /// Numbers that came from a file in millimetres go back to it bit for bit.
    #[test]
    fn numbers_survive_the_round_trip(start in -1e4..1e4f64, by in -1e4..1e4f64, v in 1e-3..1e4f64) {
        let text = format!(
            "start_mm = {start:?}\n[[steps]]\nmove_by = {{ by_mm = {by:?}, velocity_mm_s = {v:?}, \
             acceleration_mm_s2 = 1.0, jerk_mm_s3 = 1.0 }}\n"
        );
        let program: Program = toml::from_str(&text).unwrap();
        let written = toml::to_string(&program).unwrap();
        prop_assert_eq!(toml::from_str::<Program>(&written).unwrap(), program);
    }
}

#[test]
fn bad_files_are_refused() {
    let with = |step: &str| {
        let text = format!("start_mm = 0.0\n[[steps]]\n{step}\n");
        toml::from_str::<Program>(&text).unwrap_err().to_string()
    };
    let unit = with("dwell = { duration_ms = 5.0 }");
    assert!(
        unit.contains("available keys: duration_s") && unit.contains("line 3"),
        "{unit}"
    );
    let extra = with("dwell = { duration_s = 5.0, speed = 1.0 }");
    assert!(extra.contains("unexpected keys in table: speed"), "{extra}");
    let kind = with("jump = { to_mm = 5.0 }");
    assert!(kind.contains("unknown variant `jump`"), "{kind}");
    let missing = with("sine = { amplitude_mm = 1.0, cycles = 3 }");
    assert!(
        missing.contains("missing field `frequency_hz`"),
        "{missing}"
    );
    let wrong = with("dwell = { duration_s = \"long\" }");
    assert!(wrong.contains("invalid type"), "{wrong}");
    let invalid = with("dwell = { duration_s = nan }");
    assert!(
        invalid.contains("step 1 (dwell): duration is NaN s"),
        "{invalid}"
    );
    let limit = with(
        "move = { to_mm = 1.0, velocity_mm_s = -1.0, acceleration_mm_s2 = 1.0, jerk_mm_s3 = 1.0 }",
    );
    assert!(
        limit.contains("step 1 (move): velocity is -0.001 m/s"),
        "{limit}"
    );
    let top = toml::from_str::<Program>("start_mm = 0.0\nsteps = []\nstop_mm = 1.0").unwrap_err();
    assert!(top.to_string().contains("unknown field `stop_mm`"), "{top}");
}
