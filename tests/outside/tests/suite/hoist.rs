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
/// steps much shorter than the library's, under the torques that the loop gave.
fn plain(torques: &[f64], drag: f64, start: f64) -> Vec<f64> {
    const COULOMB: f64 = 60.0;
    const VISCOUS: f64 = 200.0;
    const BRISTLE: f64 = COULOMB / 200e-6;
    const DAMPING: f64 = 2e-4;
    const STEPS: usize = 50;
    let step = 1.0 / 4000.0 / STEPS as f64;
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
    for torque in torques {
        for _ in 0..STEPS {
            let a = rate(&s, *torque);
            let b = rate(&moved(&s, &a, 0.5 * step), *torque);
            let c = rate(&moved(&s, &b, 0.5 * step), *torque);
            let d = rate(&moved(&s, &c, step), *torque);
            s = std::array::from_fn(|i| {
                s[i] + step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i])
            });
        }
        positions.push(s[2]);
    }
    positions
}

fn worst(cycles: &[Cycle], drag: f64) -> f64 {
    // A torque is seen at the end of the cycle over which it acted.
    let torques: Vec<f64> = cycles[1..].iter().map(|cycle| cycle.torque).collect();
    let positions = plain(&torques, drag, cycles[0].position);
    let off = cycles
        .iter()
        .zip(positions)
        .map(|(c, x)| (c.position - x).abs());
    off.fold(0.0, f64::max)
}

/// With the outside effect and without it, over a whole motion of 400 mm. What is left
/// falls with the square of the library's step, as its method has it.
#[test]
fn the_loop_moves_the_load_as_a_plain_integrator_does() {
    let hoist = |step: &str, drag: &str| {
        // A torque that holds over the cycle, however many steps that has.
        let text = outside::HOIST.replace("bandwidth_hz = 500", "bandwidth_hz = 1e6");
        let text = text.replace("step_us = 250", step);
        run(&read(&format!("{text}{drag}")))
    };
    for (drag, coefficient) in [("", 0.0), (DRAG, 2000.0)] {
        let [long, short] =
            ["step_us = 125", "step_us = 31.25"].map(|step| worst(&hoist(step, drag), coefficient));
        eprintln!("OFF {long} {short}");
        assert!(short < 2e-5, "{short} m");
        assert!((12.0..20.0).contains(&(long / short)), "{long} {short} m");
    }
    // The comparison sees the drag: without it the load is elsewhere.
    let missed = worst(&hoist("step_us = 31.25", DRAG), 0.0);
    assert!(missed > 0.05, "{missed} m");
}

/// A drag of 0 changes nothing, to the bit.
#[test]
fn the_effect_vanishes_at_its_null() {
    let null = DRAG.replace("2000", "0");
    let (a, b) = (
        run(&read(outside::HOIST)),
        run(&read(&format!("{}{null}", outside::HOIST))),
    );
    assert_eq!(a.len(), b.len());
    assert!(a.iter().zip(&b).all(|(a, b)| a.position == b.position));
}
