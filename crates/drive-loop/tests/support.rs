//! Axes of the project, and small ones of their own.

use axis_sim::Axis;

/// An example axis of the project.
pub fn example(name: &str) -> Axis {
    Axis::read(example_file(name).as_ref()).unwrap()
}

/// Its text.
pub fn example_text(name: &str) -> String {
    std::fs::read_to_string(example_file(name)).unwrap()
}

fn example_file(name: &str) -> String {
    format!("{}/../../data/axes/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

/// A slide of `MASS` kg with viscous friction `VISCOUS` under a force that follows its command within
/// a microsecond, sensors without errors: the loop can be written down.
pub const MASS: f64 = 20.0;
pub const VISCOUS: f64 = 40.0;
pub const PERIOD: f64 = 1e-4;
/// k_p (N·s/m), k_i (N/m), k_v (1/s).
pub const GAINS: [f64; 3] = [8000.0, 4e5, 60.0];

pub fn slide() -> Axis {
    slide_late(0)
}

/// The same whose force comes late, by so many µs.
pub fn slide_late(delay: u32) -> Axis {
    let [kp, ki, kv] = GAINS;
    let text = format!(
        r#"
schema = 2
name = "slide"
description = "a mass on a force"
[mechanism]
kind = "linear-motor"
slide_mass_kg = {MASS}
[actuator]
kind = "force-source"
force_limit_n = 2000
bandwidth_hz = 1e6
delay_us = {delay}
[control]
kind = "p-pi"
frequency_khz = 10
kv_per_s = {kv}
velocity_feedforward = 1.0
speed_proportional_n_s_per_m = {kp}
speed_integral_n_per_m = {ki}
[friction]
kind = "coulomb"
coulomb_n = 10
viscous_n_s_per_m = {VISCOUS}
presliding_um = 10
[stroke]
minimum_mm = 0
maximum_mm = 800
start_mm = 100
[simulation]
step_us = 50
[[trajectory]]
displacement_mm = 400
speed_mm_per_s = 500
acceleration_mm_per_s2 = 5000
jerk_mm_per_s3 = 200000
"#
    );
    Axis::parse("slide.toml", &text).unwrap()
}
