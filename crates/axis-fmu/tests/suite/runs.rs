//! A unit is the closed loop, and obeys its laws.

use std::f64::consts::TAU;

use axis_fmu::{Unit, VariableKind};
use axis_sim::mechanism::Freedom;
use axis_sim::{ClosedLoop, Recorder, channels};
use compensator::NoCompensation;
use trajectories::Motion;

use crate::{get, ready, set, text, unit};

const PERIOD: f64 = 1e-4;

/// The files of the project that can be simulated in a closed loop.
const FILES: &[&str] = &[
    "liu2025.toml",
    "belt.toml",
    "rotary-table.toml",
    "linear-motor.toml",
];

/// Sets the references and makes one control cycle.
fn follow(unit: &mut Unit, motion: &dyn Motion, k: u32) {
    let period = unit.axes()[0].period;
    let now = motion.at(f64::from(k) * period);
    let inputs = unit
        .variables()
        .iter()
        .filter(|v| matches!(v.kind, VariableKind::Input(_)));
    let three: Vec<u32> = inputs.take(3).map(|v| v.reference).collect();
    for (reference, value) in three
        .iter()
        .zip([now.position, now.velocity, now.acceleration])
    {
        unit.set(*reference, value).unwrap();
    }
    unit.step(f64::from(k) * period, period).unwrap();
}

#[test]
fn a_run_is_the_closed_loops_to_the_bit() {
    for name in FILES {
        let mut unit = ready(name);
        let axis = unit.axes()[0].clone();
        let motion = axis.plan(&axis.trajectories[0]).unwrap();
        let mut log = Recorder::new(&axis);
        let closed_loop = ClosedLoop::new(&axis).unwrap();
        closed_loop.run(&motion, &mut NoCompensation, |cycle| log.push(cycle));
        let outputs: Vec<_> = unit.variables().iter().cloned().collect();
        for (k, cycle) in (0..).zip(log.cycles().iter().take(3000)) {
            follow(&mut unit, &motion, k);
            let mut compared = 0;
            for channel in channels(&axis) {
                let name = format!("drive.{}", channel.name(&axis));
                if let Some(output) = outputs.iter().find(|output| output.name == name) {
                    let [a, b] = [unit.get(output.reference).unwrap(), (channel.read)(cycle)];
                    assert!(
                        a.to_bits() == b.to_bits(),
                        "{name} in cycle {k}: {a} and {b}"
                    );
                    compared += 1;
                }
            }
            assert!(compared >= 4);
        }
    }
}

/// What the machine does at a communication point, the drive samples in the next cycle.
#[test]
fn the_machine_is_a_cycle_ahead_of_the_drive() {
    let mut unit = ready("liu2025.toml");
    let axis = unit.axes()[0].clone();
    let motion = axis.plan(&axis.trajectories[0]).unwrap();
    let mut machine = get(&mut unit, "machine.position_m");
    for k in 0..500 {
        follow(&mut unit, &motion, k);
        assert_eq!(get(&mut unit, "drive.position_m"), machine);
        machine = get(&mut unit, "machine.position_m");
    }
    assert!(machine > 0.6);
}

/// Communication steps of many cycles hold the inputs, as many of one cycle do.
#[test]
fn long_steps_are_many_short_ones() {
    let [mut short, mut long] = [ready("liu2025.toml"), ready("liu2025.toml")];
    for unit in [&mut short, &mut long] {
        set(unit, "position_ref_m", 0.6001);
    }
    for k in 0..50 {
        short.step(f64::from(k) * PERIOD, PERIOD).unwrap();
    }
    assert!((long.step(0.0, 50.0 * PERIOD).unwrap() - 50.0 * PERIOD).abs() < 1e-15);
    for variable in long.variables().clone().iter() {
        let reference = variable.reference;
        assert_eq!(long.get(reference).unwrap(), short.get(reference).unwrap());
    }
}

/// Steps that are no multiples of the period: the controller samples where it would, and between
/// two samples outputs are those of the last one.
#[test]
fn steps_of_any_length_sample_and_hold() {
    for name in FILES {
        let [mut whole, mut parts] = [ready(name), ready(name)];
        let period = whole.axes()[0].period;
        let start = whole.axes()[0].stroke.start;
        let reference = whole.variables().iter().nth(1).unwrap().name.clone();
        for unit in [&mut whole, &mut parts] {
            set(unit, &reference, start + 1e-4);
        }
        let outputs: Vec<String> = (whole.variables().iter())
            .filter(|v| matches!(v.kind, VariableKind::Output(_)))
            .map(|v| v.name.clone())
            .collect();
        let mut held = Vec::new();
        for k in 0..200_u32 {
            // Two periods in five steps: at 0.4, 0.8, 1.2, 1.6 and 2.
            let time = parts.time();
            parts.step(time, 0.4 * period).unwrap();
            if k % 5 == 4 {
                for _ in 0..2 {
                    let time = whole.time();
                    whole.step(time, period).unwrap();
                }
                for name in &outputs {
                    assert_eq!(
                        get(&mut parts, name),
                        get(&mut whole, name),
                        "{name} at {k}"
                    );
                }
            }
            // The points at 0.4 and 0.8 show the sample before them, those at 1.2 and 1.6 the next.
            let shown = get(&mut parts, &outputs[0]);
            match k % 5 {
                1 | 3 => assert_eq!(Some(&shown), held.last()),
                _ => held.push(shown),
            }
        }
        held.dedup();
        assert!(held.len() > 20, "{name}: it did not move");
    }
}

/// A control cycle takes the inputs of the point where it begins, though the next point comes
/// before its end.
#[test]
fn a_cycle_has_the_inputs_of_its_beginning() {
    let [mut early, mut late, mut never] = [(); 3].map(|()| ready("liu2025.toml"));
    set(&mut early, "position_ref_m", 0.6001);
    let mut point = 0.0;
    for (changed, step) in [(false, 0.5), (true, 0.5), (true, 1.0)] {
        if changed {
            set(&mut late, "position_ref_m", 0.6001);
        }
        for unit in [&mut early, &mut late, &mut never] {
            unit.step(point, step * PERIOD).unwrap();
        }
        point += step * PERIOD;
        let of = |unit: &mut Unit| get(unit, "drive.iq_ref_a");
        let (e, l, n) = (of(&mut early), of(&mut late), of(&mut never));
        assert_ne!(e, n);
        // Set at half of the first cycle, it counts in the second.
        assert_eq!(l == n, point < 1.5 * PERIOD, "{point}");
    }
}

/// The state between two samples is on the curve through both that has their speeds: by
/// Hermite's formula y(1/2) = (y0 + y1)/2 + T (v0 - v1)/8, off by T^4/384 times the fourth derivative.
#[test]
fn the_exact_state_between_samples_is_on_the_motions_curve() {
    for name in FILES {
        let (mut samples, mut between) = (ready(name), unit(name));
        set(&mut between, "unit.exact_between_samples", 1.0);
        between.enter_initialization(0.0, None).unwrap();
        between.exit_initialization().unwrap();
        let axis = samples.axes()[0].clone();
        let period = axis.period;
        let motion = axis.plan(&axis.trajectories[0]).unwrap();
        let names: Vec<String> = (samples.variables().iter())
            .filter(|v| v.name.starts_with("machine."))
            .map(|v| v.name.clone())
            .take(2)
            .collect();
        let (mut worst, mut moved) = (0.0_f64, 0.0_f64);
        for k in 0..400_u32 {
            let before = [0, 1].map(|i| get(&mut samples, &names[i]));
            follow(&mut samples, &motion, k);
            let after = [0, 1].map(|i| get(&mut samples, &names[i]));
            let now = motion.at(f64::from(k) * period);
            for (i, value) in (1..).zip([now.position, now.velocity, now.acceleration]) {
                between.set(i, value).unwrap();
            }
            let time = between.time();
            between.step(time, 0.5 * period).unwrap();
            let there = get(&mut between, &names[0]);
            let time = between.time();
            between.step(time, 0.5 * period).unwrap();
            let end = get(&mut between, &names[0]);
            assert_eq!(end, after[0], "{name}: looking at it changed the run");
            let curve = 0.5 * (before[0] + after[0]) + period * (before[1] - after[1]) / 8.0;
            worst = worst.max((there - curve).abs());
            moved = moved.max((after[0] - before[0]).abs());
        }
        println!("{name}: off by {worst:e} of {moved:e} in a cycle");
        assert!(worst < 1e-6 * moved, "{name}: {worst} of {moved}");
    }
}

/// What an output shows on the mean of the last half of two seconds of even motion under a
/// load, N or N·m.
fn at_speed(name: &str, output: &str, speed: f64, load: f64) -> f64 {
    let mut unit = ready(name);
    let period = unit.axes()[0].period;
    let start = unit.axes()[0].stroke.start;
    let [position_ref, velocity_ref, load_in] = match unit.axes()[0].freedom() {
        Freedom::Linear => ["position_ref_m", "velocity_ref_m_s", "load_force_n"],
        Freedom::Rotary => ["position_ref_rad", "velocity_ref_rad_s", "load_torque_n_m"],
    };
    set(&mut unit, velocity_ref, speed);
    set(&mut unit, load_in, load);
    let cycles = (2.0 / period) as u32;
    let mut sum = 0.0;
    for k in 0..cycles {
        let time = f64::from(k) * period;
        set(&mut unit, position_ref, start + speed * time);
        unit.step(time, period).unwrap();
        if k >= cycles / 2 {
            sum += get(&mut unit, output);
        }
    }
    sum / f64::from(cycles - cycles / 2)
}

/// In even motion the motor's power beside friction's is the load's: ΔT ω = F v, so
/// ΔT = F r, r the travel per radian; a force on the load bears the same force. In the unit
/// that the variable is declared with, whatever the mechanism and the actuator.
#[test]
fn the_motor_bears_the_load() {
    for (name, output, speed, load, travel) in [
        (
            "liu2025.toml",
            "machine.motor_torque_n_m",
            0.05,
            300.0,
            0.01 / TAU,
        ),
        (
            "screw-datasheet.toml",
            "machine.motor_torque_n_m",
            0.05,
            300.0,
            0.01 / TAU,
        ),
        (
            "rack.toml",
            "machine.motor_torque_n_m",
            0.05,
            300.0,
            0.063662 / 20.0,
        ),
        (
            "belt.toml",
            "machine.motor_torque_n_m",
            0.05,
            10.0,
            0.063662 / 10.0,
        ),
        ("joint.toml", "machine.motor_torque_n_m", 0.05, 3.0, 0.01),
        (
            "rotary-table.toml",
            "machine.motor_torque_n_m",
            0.05,
            3.0,
            1.0,
        ),
        (
            "linear-motor.toml",
            "machine.motor_force_n",
            0.05,
            30.0,
            1.0,
        ),
        ("emps.toml", "machine.motor_force_n", 0.05, 30.0, 1.0),
    ] {
        let variables = unit(name).variables().clone();
        let declared = variables
            .named(output)
            .unwrap_or_else(|| panic!("{name}: {output}"));
        let unit = if output.ends_with("_n") { "N" } else { "N.m" };
        assert_eq!(declared.measure.as_ref().unwrap().name, unit);
        let more = at_speed(name, output, speed, load) - at_speed(name, output, speed, 0.0);
        println!("{name}: {more} of {}", load * travel);
        // The joint's arm hangs by the wind-up lower under the load: 2 in 1000.
        assert!(
            (more / (load * travel) - 1.0).abs() < 5e-3,
            "{name}: {more}"
        );
    }
}

/// A torque that is added and the load that it bears leave the axis where it is: at rest the
/// controller has nothing to do.
#[test]
fn an_offset_of_the_motor_bears_a_load() {
    let travel = unit("liu2025.toml").axes()[0].travel_per_radian();
    let way = |offset: f64| {
        let mut unit = ready("liu2025.toml");
        set(&mut unit, "load_force_n", 300.0);
        set(&mut unit, "torque_offset_n_m", offset);
        for k in 0..2000 {
            unit.step(f64::from(k) * PERIOD, PERIOD).unwrap();
        }
        (
            get(&mut unit, "drive.iq_ref_a"),
            get(&mut unit, "drive.iq_feedforward_a"),
        )
    };
    let (asked, added) = way(300.0 * travel);
    assert!(
        added > 0.0 && (asked - added).abs() < 0.1 * added,
        "{asked} A, {added} A"
    );
    let (_, none) = way(0.0);
    assert_eq!(none, 0.0);
}

/// States: what is restored goes on as it did, also in another instance, also with another
/// sensor's noise on the way.
#[test]
fn a_restored_state_goes_on_to_the_bit() {
    for name in FILES {
        let mut unit = ready(name);
        let axis = unit.axes()[0].clone();
        let motion = axis.plan(&axis.trajectories[0]).unwrap();
        for k in 0..200 {
            follow(&mut unit, &motion, k);
        }
        let saved = unit.clone();
        let outputs = |unit: &mut Unit| -> Vec<u64> {
            let all = unit.variables().clone();
            all.iter()
                .map(|v| unit.get(v.reference).unwrap().to_bits())
                .collect()
        };
        let go_on = |unit: &mut Unit| {
            (200..400).for_each(|k| follow(unit, &motion, k));
            outputs(unit)
        };
        let first = go_on(&mut unit);
        let mut restored = saved;
        assert_eq!(first, go_on(&mut restored), "{name}");
        // And a reset begins as it began.
        unit.reset();
        let mut fresh = crate::unit(name);
        for unit in [&mut unit, &mut fresh] {
            unit.enter_initialization(0.0, None).unwrap();
            unit.exit_initialization().unwrap();
            (0..20).for_each(|k| follow(unit, &motion, k));
        }
        assert_eq!(outputs(&mut unit), outputs(&mut fresh), "{name}");
    }
}

/// Every axis file that has a control makes a unit; without one it says so.
#[test]
fn every_axis_makes_a_unit() {
    let mut made = 0;
    for entry in std::fs::read_dir(crate::file("")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        if !name.ends_with(".toml") {
            continue;
        }
        let axis = axis_sim::Axis::parse(&name, &text(&name)).unwrap();
        match Unit::new(&name, &text(&name)) {
            Ok(mut unit) => {
                unit.enter_initialization(0.0, None).unwrap();
                unit.exit_initialization().unwrap();
                let period = axis.period;
                unit.step(0.0, 10.0 * period).unwrap();
                made += 1;
            }
            Err(error) => {
                assert!(!axis.has_control(), "{name}: {error}");
                assert!(error.to_string().contains("control"), "{error}");
            }
        }
    }
    assert!(made >= 10);
}
