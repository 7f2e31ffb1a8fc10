//! The laws of effects: what each does to the force on the load, or to the load's place.

use std::f64::consts::TAU;

use axis_sim::effects::{ActiveEffect, Effect};
use axis_sim::{Axis, ClosedLoop, Cycle, Start};
use compensator::NoCompensation;
use trajectories::{Limits, Motion, SCurve};

use crate::{Dwell, OTHERS, PRINTED, axis, number};

/// The axis with effects beside its own.
fn with(axis: &Axis, effects: &[(&str, &[f64])]) -> ClosedLoop {
    let mut axis = axis.clone();
    let active = effects.iter().map(|(name, values)| ActiveEffect {
        effect: Effect::named(name).unwrap(),
        values: values.to_vec(),
    });
    axis.effects.extend(active);
    ClosedLoop::new(&axis).unwrap()
}

/// What an effect adds to the force on the load in settled motion, and the force of the
/// transmission with it.
fn added(axis: &Axis, name: &str, values: &[f64], start: &Start) -> [f64; 2] {
    let seen = |effects: &[(&str, &[f64])]| {
        let state = with(axis, effects).start(start).unwrap();
        *state.plant().seen()
    };
    let (without, with) = (seen(&[]), seen(&[(name, values)]));
    [with.load - without.load, with.transmission_force]
}

fn start(position: f64, speed: f64) -> Start {
    Start {
        position,
        speed,
        time: 1.0,
        ..Start::default()
    }
}

fn assert_near(a: f64, b: f64, within: f64) {
    assert!(
        (a - b).abs() <= within,
        "{a:e} is not {b:e} within {within:e}"
    );
}

fn run(closed_loop: &ClosedLoop, motion: &impl Motion) -> Vec<Cycle> {
    let mut cycles = Vec::new();
    closed_loop
        .run(motion, &mut NoCompensation, |cycle| cycles.push(*cycle))
        .completed()
        .unwrap();
    cycles
}

fn motion(from: f64, to: f64, speed: f64) -> SCurve {
    SCurve::plan(from, to, &Limits::new(speed, 1.0, 20.0).unwrap()).unwrap()
}

#[test]
fn the_current_is_shown_too_great_and_the_torque_is_that_of_the_true_one() {
    let axis = axis(PRINTED);
    let motion = motion(0.6, 0.61, 0.05);
    let cycles = run(&with(&axis, &[("current-sensor-gain", &[0.25])]), &motion);
    let of = |key| number(&axis.actuator, key);
    let constant = axis.torque_constant();
    let reluctance = 1.5 * 4.0 * (of("inductance_d") - of("inductance_q"));
    for c in &cycles {
        assert_eq!(c.measured.current.q, 1.25 * c.current.q);
        assert_eq!(c.measured.current.d, 1.25 * c.current.d);
        let torque = (constant + reluctance * c.current.d) * c.current.q;
        assert_near(c.torque, torque, 1e-12);
    }
}

#[test]
fn a_share_of_the_transmitted_force_is_lost_both_ways() {
    for (file, ratio) in [(PRINTED, 0.3), ("belt.toml", 0.5), ("joint.toml", 0.3)] {
        let axis = axis(file);
        for (speed, acceleration) in [(0.05, 0.5), (0.05, -0.5), (-0.05, 0.5), (-0.05, -0.5)] {
            let start = Start {
                acceleration,
                ..start(axis.stroke.start, speed)
            };
            let [lost, force] = added(&axis, "load-dependent-friction", &[ratio], &start);
            assert_near(
                lost,
                ratio * force.abs() * speed.signum(),
                1e-9 * force.abs(),
            );
        }
    }
}

/// At full speed after a way s dry friction has fallen by F (1 − e^(−s/D)); a rest in
/// between does not count.
#[test]
fn friction_falls_with_the_way_travelled() {
    let axis = axis(PRINTED);
    let (force, distance, way) = (100.0, 0.05, 0.02);
    let loaded = |effects: &[(&str, &[f64])]| -> Vec<[f64; 2]> {
        let closed_loop = with(&axis, effects);
        let mut state = closed_loop.start(&Start::at(0.6)).unwrap();
        let (there, back) = (motion(0.6, 0.6 + way, 0.05), motion(0.6 + way, 0.6, 0.05));
        let dwell = Dwell {
            at: 0.6 + way,
            duration: 0.3,
        };
        let motions: [&dyn Motion; 3] = [&there, &dwell, &back];
        let mut travelled = 0.0;
        let mut seen = Vec::new();
        for motion in motions {
            for k in 0..closed_loop.cycles(motion) - 1 {
                let at = |k: u64| motion.at(k as f64 * axis.period);
                let before = state.plant().seen().position;
                closed_loop
                    .step(
                        &mut state,
                        [&at(k), &at(k + 1)],
                        &mut NoCompensation,
                        |_| (),
                    )
                    .unwrap();
                travelled += (state.plant().seen().position - before).abs();
                seen.push([travelled, state.plant().seen().load]);
            }
        }
        seen
    };
    let without = loaded(&[]);
    let with = loaded(&[("warming-friction", &[force, distance])]);
    let at = |travelled: f64| with.iter().position(|s| s[0] > travelled).unwrap();
    // Forward in the middle of the way, then back.
    for (travelled, direction) in [(0.5 * way, 1.0), (1.5 * way, -1.0)] {
        let k = at(travelled);
        let fallen = force * (1.0 - (-with[k][0] / distance).exp());
        // What speed and bristle of the two runs differ by is some 0.1 N.
        assert_near(
            with[k][1] - without[k][1],
            -direction * fallen,
            0.005 * force,
        );
    }
}

#[test]
fn a_kinematic_error_has_its_order_and_amplitude() {
    let axis = axis(PRINTED);
    let (amplitude, order) = (5e-6, 3.0);
    let motion = motion(0.6, 0.65, 0.02);
    let cycles = run(
        &with(
            &axis,
            &[("kinematic-error-harmonic", &[amplitude, order, 0.4])],
        ),
        &motion,
    );
    // Three whole turns at even speed.
    let angle = |c: &Cycle| c.motor_angle - cycles[0].motor_angle;
    let turns: Vec<&Cycle> = cycles
        .iter()
        .filter(|c| (TAU..4.0 * TAU).contains(&angle(c)))
        .collect();
    let wave = |n: f64| {
        let sum = turns.iter().fold([0.0; 2], |[s, c], cycle| {
            let ahead = cycle.position - axis.travel_per_radian() * cycle.motor_angle;
            let at = n * cycle.motor_angle;
            [s + ahead * at.sin(), c + ahead * at.cos()]
        });
        sum.map(|s| 2.0 * s / turns.len() as f64)
    };
    let [s, c] = wave(order);
    // Samples per turn are no whole number, and the elastic chain adds (f/f₁)² at 6 Hz.
    assert_near(s.hypot(c), amplitude, 0.02 * amplitude);
    assert_near(c.atan2(s), 0.4, 0.02);
    assert!(wave(2.0)[0].hypot(wave(2.0)[1]) < 0.02 * amplitude);
}

#[test]
fn once_per_turn_it_is_the_periodic_lead_error() {
    let axis = axis("belt.toml");
    let from = axis.stroke.start;
    let motion = motion(from, from + 0.02, 0.2);
    let harmonic = run(
        &with(&axis, &[("kinematic-error-harmonic", &[1e-5, 1.0, 0.3])]),
        &motion,
    );
    let lead = run(
        &with(&axis, &[("periodic-lead-error", &[1e-5, 0.3])]),
        &motion,
    );
    for (a, b) in harmonic.iter().zip(&lead) {
        assert_eq!(crate::bits(a), crate::bits(b));
    }
}

#[test]
fn forces_over_position_and_time_are_what_they_say() {
    let screw = axis(PRINTED);
    let x0 = screw.stroke.start;
    for x in [x0, x0 + 0.1, x0 - 0.2] {
        let [force, _] = added(&screw, "spring-force", &[500.0], &start(x, 0.05));
        assert_near(force, 500.0 * (x - x0), 1e-9);
    }

    let table = axis("rotary-table.toml");
    for x in [0.0, 0.5, 1.0] {
        let [torque, _] = added(&table, "gravity-imbalance", &[7.0, 0.2], &start(x, 0.05));
        assert_near(torque, 7.0 * (x + 0.2).sin(), 1e-9);
    }

    let motor = axis("linear-motor.toml");
    let pitch = number(&motor.actuator, "pole_pitch");
    for share in [0.0, 0.25, 0.5, 1.25] {
        let at = start(motor.stroke.start + share * pitch, 0.05);
        for order in [1.0, 2.0, 5.0] {
            let [force, _] = added(&motor, "force-ripple", &[9.0, order, 0.2], &at);
            let turns = 0.5 * order * at.position / pitch;
            assert_near(force, 9.0 * (TAU * turns + 0.2).sin(), 1e-9);
        }
    }

    for time in [0.0, 0.3, 2.0] {
        let at = Start {
            time,
            ..start(x0, 0.05)
        };
        let [force, _] = added(&screw, "cyclic-load", &[40.0, 0.8, 0.2], &at);
        assert_near(force, 40.0 * (TAU * time / 0.8 + 0.2).sin(), 1e-9);
    }
}

#[test]
fn settled_motion_has_all_elements_slide_and_the_body_carried_along() {
    for file in [PRINTED, "linear-motor.toml", "joint.toml"] {
        let axis = axis(file);
        for speed in [0.05, -0.05] {
            let at = Start {
                acceleration: 0.5,
                ..start(axis.stroke.start, speed)
            };
            let [force, _] = added(&axis, "maxwell-slip-hysteresis", &[30.0, 1e-4], &at);
            assert_near(force, 30.0 * speed.signum(), 1e-9);
            let [force, _] = added(&axis, "structural-resonance", &[8.0, 40.0, 0.03], &at);
            assert_near(force, 8.0 * 0.5, 1e-9);
        }
    }
}

/// A harder transmission gives way by F/k x/(1 + x) less under the same force.
#[test]
fn a_hardening_transmission_gives_way_less() {
    let axis = axis(PRINTED);
    let share = 4.0;
    let under = |force: f64, share: f64| {
        let effects: [(&str, &[f64]); 2] = [
            ("constant-load", &[force]),
            ("hardening-stiffness", &[share]),
        ];
        let closed_loop = with(&axis, &effects);
        let dwell = Dwell {
            at: 0.6,
            duration: 0.5,
        };
        let mut state = closed_loop.start(&Start::at(0.6)).unwrap();
        let from = *state.plant().seen();
        for k in 0..closed_loop.cycles(&dwell) {
            let at = [&dwell.at(k as f64), &dwell.at(k as f64)];
            closed_loop
                .step(&mut state, at, &mut NoCompensation, |_| ())
                .unwrap();
        }
        let to = *state.plant().seen();
        let turned = axis.travel_per_radian() * (to.motor_angle - from.motor_angle);
        [turned - to.displacement, to.transmission_force]
    };
    for load in [4000.0, -4000.0] {
        let [linear, force] = under(load, 0.0);
        let compliance = linear / force;
        let [less, force] = under(load, share);
        let greatest = axis.torque_constant() * axis.actuator.limit() / axis.travel_per_radian();
        let x = share * force.abs() / greatest;
        let taken = force / axis.mechanism.stiffness().unwrap() * x / (1.0 + x);
        assert!(force * load > 0.0 && x > 0.3);
        assert_near(less, compliance * force - taken, 1e-4 * taken.abs());
    }
}

/// Greatest speed of the load in the first and the second half second of rest after a fast
/// move, as shares of the move's speed.
fn still_moving(axis: &Axis, effects: &[(&str, &[f64])]) -> [f64; 2] {
    let closed_loop = with(axis, effects);
    let fastest = &axis.trajectories[0].limits;
    let way = 0.02 * (axis.stroke.maximum - axis.stroke.minimum);
    let from = axis.stroke.start;
    let move_on = SCurve::plan(from, from + way, fastest).unwrap();
    let mut state = closed_loop.start(&Start::at(from)).unwrap();
    let cycles = closed_loop.cycles(&move_on);
    let half = (0.5 / axis.period) as u64;
    let mut most = [0.0_f64; 2];
    for k in 0..cycles + 2 * half {
        let at = |k: u64| move_on.at(k as f64 * axis.period);
        closed_loop
            .step(
                &mut state,
                [&at(k), &at(k + 1)],
                &mut NoCompensation,
                |_| (),
            )
            .unwrap();
        if k >= cycles {
            let most = &mut most[usize::from(k >= cycles + half)];
            *most = most.max(state.plant().seen().speed.abs());
        }
    }
    most.map(|speed| speed / fastest.velocity())
}

/// Forces that are known one step late, and springs that harden by them, put no energy in:
/// at the greatest value that a file may have, axes of all kinds come to rest as they do
/// without, and swing on no longer than the loop alone.
#[test]
fn what_is_known_a_step_late_stays_stable() {
    for file in OTHERS.iter().copied().chain([PRINTED]) {
        let axis = axis(file);
        if axis.mechanism.stiffness().is_none() {
            continue;
        }
        let [early, late] = still_moving(&axis, &[]);
        println!("{file}: {early:.1e} {late:.1e}");
        for (name, most) in [
            ("load-dependent-friction", 0.5),
            ("hardening-stiffness", 8.0),
        ] {
            let [first, then] = still_moving(&axis, &[(name, &[most])]);
            println!("{file} {name}: {first:.1e} {then:.1e}");
            assert!(
                first < 2.0 * early + 1e-3 && then < 2.0 * late + 1e-4,
                "{file} {name}"
            );
        }
    }
}

/// What a run remembers is its own: a copy goes on to the same bits, whatever runs in
/// between on the same loop.
#[test]
fn a_copy_of_a_run_remembers_what_it_does() {
    let axis = axis("linear-motor.toml");
    let closed_loop = with(
        &axis,
        &[
            ("maxwell-slip-hysteresis", &[30.0, 1e-4]),
            ("structural-resonance", &[3.0, 40.0, 0.03]),
            ("warming-friction", &[20.0, 0.05]),
        ],
    );
    let from = axis.stroke.start;
    let there = motion(from, from + 0.02, 0.2);
    let mut state = closed_loop.start(&Start::at(from)).unwrap();
    let go = |state: &mut axis_sim::LoopState, cycles: std::ops::Range<u64>| {
        for k in cycles {
            let at = |k: u64| there.at(k as f64 * axis.period);
            closed_loop
                .step(state, [&at(k), &at(k + 1)], &mut NoCompensation, |_| ())
                .unwrap();
        }
        *state.plant().seen()
    };
    go(&mut state, 0..300);
    let mut copy = state.clone();
    let first = go(&mut state, 300..600);
    assert_eq!(go(&mut copy, 300..600), first);
}
