//! What a cascade with filters, feed-forward and blended feedback asks for, worked out by
//! hand from what it was shown.

use std::f64::consts::{PI, TAU};

use axis_sim::{Axis, ClosedLoop, Cycle, Measured, Sensors};
use compensator::NoCompensation;

use crate::changed;

const PERIOD: f64 = 1.0 / 8000.0;

/// The rack with perfect sensors and other keys of its control.
fn rack(keys: &str) -> Axis {
    let mut axis = changed("rack.toml", &[("position_rate_khz = 4", keys)]);
    axis.sensors = Sensors::default();
    axis
}

fn run(axis: &Axis, sense: impl FnMut(&mut Measured)) -> Vec<Cycle> {
    let motion = axis.plan(&axis.trajectories[1]).unwrap();
    let mut cycles = Vec::new();
    ClosedLoop::new(axis)
        .unwrap()
        .run_sensed(&motion, &mut NoCompensation, sense, |c| cycles.push(*c))
        .completed()
        .unwrap();
    cycles
}

/// A first-order low pass that has seen `value` for ever.
fn low_pass(frequency: f64, mut value: f64) -> impl FnMut(f64) -> f64 {
    let keep = (-TAU * frequency * PERIOD).exp();
    move |u| {
        value = keep * value + (1.0 - keep) * u;
        value
    }
}

/// (s² + 2 d ζ ω s + ω²)/(s² + 2 ζ ω s + ω²), bilinear about its middle, in direct form I.
fn notch(frequency: f64, damping: f64, depth: f64) -> impl FnMut(f64) -> f64 {
    let k = (PI * frequency * PERIOD).tan();
    let side = |by: f64| {
        [
            1.0 + by * k + k * k,
            2.0 * (k * k - 1.0),
            1.0 - by * k + k * k,
        ]
    };
    let (top, bottom) = (side(2.0 * depth * damping), side(2.0 * damping));
    let (mut given, mut made) = ([0.0; 2], [0.0; 2]);
    move |u| {
        let sum = top[0] * u + top[1] * given[0] + top[2] * given[1];
        let y = (sum - bottom[1] * made[0] - bottom[2] * made[1]) / bottom[0];
        (given, made) = ([u, given[0]], [y, made[0]]);
        y
    }
}

#[test]
fn filters_and_feed_forward_of_a_cascade() {
    let axis = rack(
        "acceleration_feedforward_n_m_s2_per_m = 2.2\nspeed_lowpass_hz = 1000\ncommand_lowpass_hz = 900\nnotch_hz = 320\nnotch_damping = 0.25\nnotch_depth = 0.2",
    );
    let cycles = run(&axis, |_| ());
    let travel = 0.063662 / 2.0 / 10.0;
    let mut speed = low_pass(1000.0, 0.0);
    let mut command = low_pass(900.0, 0.0);
    let mut notch = notch(320.0, 0.25, 0.2);
    let (mut sum, mut most, mut off) = (0.0, 0.0_f64, 0.0_f64);
    for c in &cycles {
        let lag = c.reference.position - c.measured.position;
        let wanted = (1e3 / 60.0 * lag + c.reference.velocity) / travel;
        let error = wanted - speed(c.measured.motor_speed);
        sum += error / 0.025 * PERIOD;
        let asked = error + sum + 2.2 * c.reference.acceleration;
        let effort = notch(command(asked));
        most = most.max(effort.abs());
        off = off.max((c.command.effort - effort).abs());
    }
    println!("filters: {off:e} of {most} N·m");
    // Measured 2.2e-14 of 2.6 N·m.
    assert!(off < 2e-13 && most > 1.0, "{off:e} of {most}");
}

#[test]
fn blended_feedback_is_slow_from_the_load_and_fast_from_the_motor() {
    let axis = rack("feedback = \"blend\"\nblend_hz = 40");
    let blended = run(&axis, |_| ());
    // The same by hand, in the position that a loop closed over the load is shown.
    let plain = rack("feedback = \"load\"");
    let travel = plain.travel_per_radian();
    let mut slow = low_pass(40.0, 0.0);
    let by_hand = run(&plain, |m| {
        let motor = travel * m.motor_angle;
        m.position = motor + slow(m.position - motor);
    });
    let without = run(&plain, |_| ());
    let apart = |a: &[Cycle], b: &[Cycle]| {
        let far = a
            .iter()
            .zip(b)
            .map(|(a, b)| (a.position - b.position).abs());
        far.fold(0.0, f64::max)
    };
    let (same, other) = (apart(&blended, &by_hand), apart(&blended, &without));
    println!("blend: {same:e} m, {other:e} m from the load's alone");
    // Measured 0, of positions of half a metre.
    assert!(same < 1e-15, "{same:e}");
    assert!(other > 1e-8, "{other:e}");
}
