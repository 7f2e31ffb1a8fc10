//! An offset of a phase current's sensor turns against the rotor.

use std::f64::consts::TAU;

use axis_sim::effects::{ActiveEffect, Effect};
use axis_sim::{Axis, ClosedLoop, Cycle};
use compensator::NoCompensation;
use trajectories::{Limits, SCurve};

use crate::axis;

fn run(axis: &Axis, values: &[f64]) -> Vec<Cycle> {
    let mut axis = axis.clone();
    axis.effects.push(ActiveEffect {
        effect: Effect::named("current-sensor-offset").unwrap(),
        values: values.to_vec(),
    });
    let limits = Limits::new(0.2, 2.0, 50.0).unwrap();
    let motion = SCurve::plan(0.0, 3.0, &limits).unwrap();
    let mut cycles = Vec::new();
    ClosedLoop::new(&axis)
        .unwrap()
        .run(&motion, &mut NoCompensation, |c| cycles.push(*c))
        .completed()
        .unwrap();
    cycles
}

/// Amplitude of a wave over the motor's angle, over whole periods of it in even motion.
fn amplitude(cycles: &[Cycle], order: f64, of: impl Fn(&Cycle) -> f64) -> f64 {
    let even: Vec<&Cycle> = cycles
        .iter()
        .filter(|c| c.reference.acceleration == 0.0 && c.reference.velocity > 0.19)
        .collect();
    let first = even[even.len() / 4].motor_angle;
    let periods = ((even[even.len() - 1].motor_angle - first) * order / TAU).floor();
    let last = first + periods * TAU / order;
    let inside = even
        .iter()
        .filter(|c| (first..last).contains(&c.motor_angle));
    let (mut sums, mut count) = ([0.0; 2], 0.0);
    for c in inside {
        let (sin, cos) = (order * c.motor_angle).sin_cos();
        sums[0] += of(c) * sin;
        sums[1] += of(c) * cos;
        count += 1.0;
    }
    2.0 * sums[0].hypot(sums[1]) / count
}

/// 22 pole pairs at 0.2 rad/s: 0.7 Hz, which the loops follow. The table turns evenly, so the true
/// current does not change, and what is shown ripples by 2/√3 √(a² + a b + b²).
#[test]
fn it_ripples_at_the_electrical_frequency() {
    let table = axis("rotary-table.toml");
    let clean = run(&table, &[0.0, 0.0]);
    for [a, b] in [[0.3, 0.0], [0.0, -0.2], [0.3, -0.2], [0.1, 0.1]] {
        let cycles = run(&table, &[a, b]);
        let expected = 2.0 / 3f64.sqrt() * f64::sqrt(a * a + a * b + b * b);
        let shown = amplitude(&cycles, 22.0, |c| c.measured.current.q);
        let of_d = amplitude(&cycles, 22.0, |c| c.measured.current.d - c.current.d);
        println!("{a} {b}: {shown} A, {of_d} A of {expected} A");
        assert!(
            (shown / expected - 1.0).abs() < 0.02,
            "{shown} of {expected}"
        );
        assert!((of_d / expected - 1.0).abs() < 2e-3, "{of_d} of {expected}");
    }
    assert!(amplitude(&clean, 22.0, |c| c.measured.current.q) < 2e-3);
}

/// At any angle the drive's Park transform of the two phases' offsets: those of a and b, less
/// their sum in c.
#[test]
fn what_is_shown_is_the_park_transform_of_the_phases() {
    let table = axis("rotary-table.toml");
    let [a, b] = [0.07, -0.31];
    for c in run(&table, &[a, b]).iter().step_by(97) {
        let at = 22.0 * c.motor_angle;
        let third = TAU / 3.0;
        let sum = |f: fn(f64) -> f64| {
            2.0 / 3.0 * (a * f(at) + b * f(at - third) - (a + b) * f(at + third))
        };
        let off = [
            c.measured.current.d - c.current.d - sum(f64::cos),
            c.measured.current.q - c.current.q + sum(f64::sin),
        ];
        assert!(off.iter().all(|off| off.abs() < 1e-9), "{off:?}");
    }
}

#[test]
fn at_zero_the_log_is_the_same_to_the_bit() {
    let table = axis("rotary-table.toml");
    let limits = Limits::new(0.2, 2.0, 50.0).unwrap();
    let motion = SCurve::plan(0.0, 3.0, &limits).unwrap();
    let mut without = Vec::new();
    ClosedLoop::new(&table)
        .unwrap()
        .run(&motion, &mut NoCompensation, |c| without.push(*c))
        .completed()
        .unwrap();
    for (a, b) in run(&table, &[0.0, 0.0]).iter().zip(&without) {
        let bits = |c: &Cycle| {
            [
                c.position,
                c.measured.current.d,
                c.measured.current.q,
                c.torque,
            ]
            .map(f64::to_bits)
        };
        assert_eq!(bits(a), bits(b), "{}", a.time);
    }
}
