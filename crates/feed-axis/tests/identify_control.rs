//! What `identify-control` refuses, and what it writes.

use axis_sim::Axis;

use crate::common::{refuse, succeed};

/// Nothing is read or estimated first: no file with such a controller could be written.
#[test]
fn a_controller_that_is_too_slow_for_the_current_is_not_looked_for() {
    let axis = "data/axes/linear-motor.toml";
    let logs = [
        "--fit",
        "fit.csv",
        "--check",
        "check.csv",
        "--out",
        "axis.toml",
    ];
    let slow = ["identify-control", "--axis", axis, "--frequency-hz", "2000"];
    let message = refuse(&[&slow[..], &logs].concat());
    for part in [
        axis,
        "2000 Hz",
        "current_d_proportional = 90 V/A",
        "less than",
    ] {
        assert!(message.contains(part), "{message}");
    }
}

/// An axis on a screw, of which the command is a torque; its control frequency is another than the
/// command line's.
const AXIS: &str = r#"
schema = 2
name = "made"
[mechanism]
kind = "screw-datasheet"
motor_inertia_kg_m2 = 0.011
lead_mm = 12
length_mm = 1100
root_diameter_mm = 36
mounting = "fixed-free"
bearing_stiffness_n_per_um = 700
nut_stiffness_n_per_um = 450
table_mass_kg = 380
stiffness_damping_us = 10
[actuator]
kind = "torque-source"
torque_limit_n_m = 90
bandwidth_hz = 500
[control]
kind = "p-pi"
frequency_hz = 2000
kv_per_s = 12
velocity_feedforward = 1
speed_proportional_n_m_s_per_rad = 2
[friction]
kind = "lugre-at-motor"
coulomb_n_m = 0.4
stiction_n_m = 0.5
stribeck_speed_rpm = 25
bristle_stiffness_n_m_per_rad = 15
bristle_damping_n_m_s_per_rad = 0
viscous_n_m_s_per_rad = 0
[stroke]
minimum_mm = 0
maximum_mm = 900
start_mm = 200
[simulation]
step_us = 50
[[trajectory]]
displacement_mm = 300
speed_mm_per_s = 300
acceleration_mm_per_s2 = 3000
jerk_mm_per_s3 = 60000
"#;

/// A log at 1 kHz: there and back, 25 ms late and with a vibration of its own, without which a position error in
/// proportion to the speed would pass for feed-forward; and the command of a cascade with a velocity feed-forward
/// of 17.6, which no axis file takes.
fn made(way: f64, seconds: f64) -> String {
    let period = 1e-3;
    let ramp = |t: f64| {
        let s = (t / seconds).clamp(0.0, 1.0);
        s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
    };
    let reference = |t: f64| 0.2 + way * (ramp(t - 0.3) - ramp(t - 0.6 - seconds));
    let vibration =
        |t: f64| 2e-3 * (45.0 * t).sin() * ramp(t - 0.3) * ramp(1.0 + 2.0 * seconds - t);
    let position = |t: f64| reference(t - 0.025) + vibration(t);
    let travel = 0.012 / std::f64::consts::TAU;
    let mut integral = 0.0;
    let mut lines = vec!["t_s,position_ref_m,position_m,torque_ref_n_m".to_owned()];
    for k in 0..(1e3 * (1.0 + 2.0 * seconds)) as usize {
        let t = k as f64 * period;
        let slope = |of: &dyn Fn(f64) -> f64| (of(t + 1e-6) - of(t - 1e-6)) / 2e-6;
        let asked = 9.0 * (reference(t) - position(t)) + 17.6 * slope(&reference);
        let off = (asked - slope(&position)) / travel;
        integral += 0.004 * off * period;
        let command = 0.008 * off + integral;
        lines.push(format!(
            "{t:.3},{:.9},{:.9},{command:.9}",
            reference(t),
            position(t)
        ));
    }
    lines.join("\n") + "\n"
}

#[test]
fn what_is_written_can_be_read_and_a_gain_beyond_its_limit_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let axis = write("made.toml", AXIS);
    let [fit, check] = [("fit.csv", 0.3, 0.9), ("check.csv", 0.2, 0.5)]
        .map(|(name, way, seconds)| write(name, &made(way, seconds)));
    let out = folder.path().join("estimated.toml");
    let said = succeed(&[
        "identify-control",
        "--axis",
        &axis,
        "--fit",
        &fit,
        "--check",
        &check,
        "--frequency-hz",
        "1000",
        "--out",
        out.to_str().unwrap(),
    ]);
    assert!(
        said.contains("not determined by these logs: velocity_feedforward"),
        "{said}"
    );
    let found = Axis::read(&out).unwrap();
    let values = found.control.values();
    assert_eq!(
        values.optional("velocity_feedforward"),
        Some(10.0),
        "{said}"
    );
    assert!((found.period - 1e-3).abs() < 1e-12, "{}", found.period);
}
