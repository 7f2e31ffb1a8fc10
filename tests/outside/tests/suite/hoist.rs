//! Mechanism and effect in the closed loop, against closed forms and a plain integrator.

use axis_sim::{Axis, ClosedLoop, Cycle, Start};
use compensator::NoCompensation;

use crate::{DRAG, read};

const TRAVEL: f64 = 0.05 / 20.0;
const MOTOR_INERTIA: f64 = 0.002;
const MASS: f64 = 200.0;
const WEIGHT: f64 = 1962.0;

/// k(x) = c/(L − x), N/m.
fn chain_stiffness(x: f64) -> f64 {
    2e7 / (5.0 - x)
}

fn run(axis: &Axis) -> Vec<Cycle> {
    let motion = axis.plan(&axis.trajectories[0]).unwrap();
    let mut cycles = Vec::new();
    ClosedLoop::new(axis)
        .unwrap()
        .run(&motion, &mut NoCompensation, |cycle| cycles.push(*cycle))
        .completed()
        .unwrap();
    cycles
}

/// At rest the chain is longer by F/k, and the motor holds r F.
#[test]
fn at_rest_the_chain_is_stretched_by_the_weight() {
    let axis = read(outside::HOIST);
    let closed_loop = ClosedLoop::new(&axis).unwrap();
    for x in [0.5, 2.0, 3.9] {
        let state = closed_loop.start(&Start::at(x)).unwrap();
        let seen = *state.plant().seen();
        let stretch = TRAVEL * seen.motor_angle - seen.position;
        let expected = WEIGHT / chain_stiffness(x);
        assert!(
            (stretch / expected - 1.0).abs() < 1e-11,
            "{x}: {stretch} {expected}"
        );
        assert!((seen.transmission_force / WEIGHT - 1.0).abs() < 1e-12);
        let resonance =
            (chain_stiffness(x) * (1.0 / MASS + TRAVEL * TRAVEL / MOTOR_INERTIA)).sqrt();
        let modes = axis.mechanism.modes(x).unwrap();
        assert!(
            (modes[0] / resonance - 1.0).abs() < 1e-14,
            "{modes:?} {resonance}"
        );
    }
}

/// The hoist's equations as they stand in textbooks, by a Runge-Kutta method of order 4 in
/// steps much shorter than the library's, under the torques that the loop gave at the
/// ends of cycles of `period` seconds, and that it takes as linear between them.
fn plain(torques: &[f64], period: f64, drag: f64, start: f64) -> Vec<f64> {
    const COULOMB: f64 = 60.0;
    const VISCOUS: f64 = 200.0;
    const BRISTLE: f64 = COULOMB / 200e-6;
    const DAMPING: f64 = 2e-4;
    const STEPS: usize = 50;
    let step = period / STEPS as f64;
    // Motor angle and speed, load position and speed, bristle deflection.
    let rate = |s: &[f64; 5], torque: f64| {
        let [angle, motor_speed, x, speed, bristle] = *s;
        let pull =
            chain_stiffness(x) * (TRAVEL * angle - x + DAMPING * (TRAVEL * motor_speed - speed));
        let friction = BRISTLE * bristle + VISCOUS * speed;
        let load = WEIGHT + friction + drag * speed * speed.abs();
        [
            motor_speed,
            (torque - TRAVEL * pull) / MOTOR_INERTIA,
            speed,
            (pull - load) / MASS,
            speed - speed.abs() * BRISTLE * bristle / COULOMB,
        ]
    };
    let moved = |s: &[f64; 5], by: &[f64; 5], h: f64| -> [f64; 5] {
        std::array::from_fn(|i| s[i] + h * by[i])
    };
    let angle = (start + WEIGHT / chain_stiffness(start)) / TRAVEL;
    let mut s = [angle, 0.0, start, 0.0, 0.0];
    let mut positions = vec![start];
    for pair in torques.windows(2) {
        for k in 0..STEPS {
            let torque =
                |share: f64| pair[0] + (k as f64 + share) / STEPS as f64 * (pair[1] - pair[0]);
            let a = rate(&s, torque(0.0));
            let b = rate(&moved(&s, &a, 0.5 * step), torque(0.5));
            let c = rate(&moved(&s, &b, 0.5 * step), torque(0.5));
            let d = rate(&moved(&s, &c, step), torque(1.0));
            s = std::array::from_fn(|i| {
                s[i] + step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i])
            });
        }
        positions.push(s[2]);
    }
    positions
}

fn worst(axis: &Axis, cycles: &[Cycle], drag: f64) -> f64 {
    // The motor holds the weight before the first cycle, where no torque is seen yet.
    let mut torques: Vec<f64> = cycles.iter().map(|cycle| cycle.torque).collect();
    torques[0] = TRAVEL * WEIGHT;
    let positions = plain(&torques, axis.period, drag, cycles[0].position);
    let off = cycles.iter().zip(positions);
    let off = off.map(|(cycle, x)| (cycle.position - x).abs());
    off.fold(0.0, f64::max)
}

/// With the outside effect and without it, over a whole motion of 400 mm. What is left
/// falls with the square of the step, as the library's method has it.
#[test]
fn the_loop_moves_the_load_as_a_plain_integrator_does() {
    for (drag, coefficient) in [("", 0.0), (DRAG, 2000.0)] {
        // One step a cycle, of 250 and of 125 µs.
        let [long, short] = [[250, 4], [125, 8]].map(|[step, frequency]| {
            let text = outside::HOIST
                .replace("step_us = 250", &format!("step_us = {step}"))
                .replace("frequency_khz = 4", &format!("frequency_khz = {frequency}"));
            let axis = read(&format!("{text}{drag}"));
            worst(&axis, &run(&axis), coefficient)
        });
        assert!(long < 1e-7, "{long} m");
        assert!((3.9..4.1).contains(&(long / short)), "{long} {short} m");
    }
    // The comparison sees the drag: without it the load is elsewhere.
    let axis = read(&format!("{}{DRAG}", outside::HOIST));
    let missed = worst(&axis, &run(&axis), 0.0);
    assert!(missed > 0.1, "{missed} m");
}

/// A drag of 0 changes nothing but last bits: how steep a drag is nobody knows beforehand, so
/// the load at the end of a step is searched for more closely with one.
#[test]
fn the_effect_vanishes_at_its_null() {
    let null = DRAG.replace("2000", "0");
    let (a, b) = (
        run(&read(outside::HOIST)),
        run(&read(&format!("{}{null}", outside::HOIST))),
    );
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().zip(&b);
    let most = pairs.fold(0.0_f64, |most, (a, b)| {
        most.max((a.position - b.position).abs())
    });
    // Measured 1.4e-11.
    assert!(most < 1e-10, "{most:e} m");
}
