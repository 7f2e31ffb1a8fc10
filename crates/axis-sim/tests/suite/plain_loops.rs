//! Loops of the other mechanisms against the obvious simulation of `plain`.

use std::f64::consts::{FRAC_PI_2, TAU};

use axis_sim::{Axis, ClosedLoop, Cycle};
use compensator::NoCompensation;
use trajectories::{Limits, Motion, SCurve};

use crate::plain::{Law, Masses, Plain, Row, Rub, Source};
use crate::{bits, changed};

/// A quick move from the stroke's start.
fn motion(axis: &Axis, by: f64, speed: f64, acceleration: f64, jerk: f64) -> SCurve {
    let limits = Limits::new(speed, acceleration, jerk).unwrap();
    SCurve::plan(axis.stroke.start, axis.stroke.start + by, &limits).unwrap()
}

fn follow(axis: &Axis, motion: &SCurve) -> Vec<Cycle> {
    let mut cycles = Vec::new();
    ClosedLoop::new(axis)
        .unwrap()
        .run(motion, &mut NoCompensation, |c| cycles.push(*c))
        .completed()
        .unwrap();
    cycles
}

fn plainly(plain: &Plain<'_>, cycles: &[Cycle], motion: &SCurve) -> Vec<Row> {
    plain.run(cycles.len(), |t| {
        let at = motion.at(t);
        [at.position, at.velocity]
    })
}

/// Greatest deviations of position, angle and torque.
fn apart(cycles: &[Cycle], rows: &[Row]) -> [f64; 3] {
    let mut most = [0.0_f64; 3];
    assert_eq!(cycles.len(), rows.len());
    for (c, row) in cycles.iter().zip(rows) {
        let ours = [c.position, c.motor_angle, c.torque];
        for (most, (a, b)) in most.iter_mut().zip(ours.iter().zip(row)) {
            *most = most.max((a - b).abs());
        }
    }
    most
}

/// Position, angle and torque at every sampling instant within `tolerance`.
fn check(name: &str, cycles: &[Cycle], rows: &[Row], tolerance: [f64; 3]) {
    let most = apart(cycles, rows);
    println!("{name}: position, angle, torque within {most:?}");
    let good = most.iter().zip(tolerance).all(|(a, b)| *a < b);
    assert!(good, "{name}: {most:?}");
    // They went somewhere.
    let way = cycles[cycles.len() - 1].position - cycles[0].position;
    assert!(way.abs() > 0.01, "{way}");
}

/// With perfect sensors, in steps of `step` µs.
fn rack(step: &str, changes: &[(&str, &str)]) -> Axis {
    let mut axis = changed(
        "rack.toml",
        &[&[("step_us = 62.5", step)], changes].concat(),
    );
    axis.sensors = axis_sim::Sensors::default();
    axis
}

const NO_ERROR: &dyn Fn(f64, f64) -> [f64; 2] = &|_, _| [0.0; 2];

fn plain_rack() -> Plain<'static> {
    let pinion: f64 = 0.063662 / 2.0;
    let stiffness = 1.0 / (pinion * pinion / 2.4e5 + 1.0 / 150e6);
    let period = 1.0 / 8000.0;
    Plain {
        masses: Masses::Two(0.0041, 300.0, pinion / 10.0, stiffness, 20e-6),
        friction: Rub::coulomb(90.0, 300.0, 10e-6),
        load: &|_| 0.0,
        error: NO_ERROR,
        source: Source {
            bandwidth: 800.0,
            cycles_late: 1.0,
            limit: 40.0,
        },
        law: Law::Cascade {
            kv: 1e3 / 60.0,
            gain: 1.0,
            time: 0.025,
            every: [2, 1],
        },
        period,
    }
}

#[test]
fn a_rack_under_p_pi_with_a_torque_source() {
    // Of second order; measured 2.4e-9 m, 7.6e-7 rad, 1.1e-3 N·m, then 3.9e-10, 1.2e-7, 1.8e-4,
    // and 1.5e-11, 4.8e-9, 7.3e-6.
    for (step, tolerance) in [
        ("step_us = 62.5", [1e-8, 5e-6, 5e-3]),
        ("step_us = 25", [2e-9, 6e-7, 1e-3]),
        ("step_us = 5", [1e-10, 3e-8, 5e-5]),
    ] {
        let axis = rack(step, &[]);
        let motion = motion(&axis, 0.05, 0.5, 5.0, 200.0);
        let cycles = follow(&axis, &motion);
        let rows = plainly(&plain_rack(), &cycles, &motion);
        check(&format!("rack, {step}"), &cycles, &rows, tolerance);
    }
}

/// A torque limit that the motion reaches, and a delay of a cycle and a half.
#[test]
fn a_limit_and_a_delay_between_cycles() {
    let changes = [
        ("torque_limit_n_m = 40", "torque_limit_n_m = 8"),
        ("delay_us = 125", "delay_us = 187.5"),
    ];
    let axis = rack("step_us = 5", &changes);
    let motion = motion(&axis, 0.05, 0.5, 5.0, 200.0);
    let cycles = follow(&axis, &motion);
    let mut plain = plain_rack();
    (plain.source.limit, plain.source.cycles_late) = (8.0, 1.5);
    let rows = plainly(&plain, &cycles, &motion);
    // Measured 3.2e-10 m, 9.6e-8 rad, 2.7e-5 N·m.
    check("limited and late", &cycles, &rows, [2e-9, 5e-7, 1e-4]);
    let limited = cycles.iter().filter(|c| c.command.saturated).count();
    assert!(limited > 100, "{limited}");
}

/// The position loop at a quarter of the control frequency and the speed loop at half.
#[test]
fn loops_at_their_own_rates() {
    let rates = [(
        "position_rate_khz = 4",
        "position_rate_khz = 2\nspeed_rate_khz = 4",
    )];
    let axis = rack("step_us = 5", &rates);
    let motion = motion(&axis, 0.05, 0.5, 5.0, 200.0);
    let cycles = follow(&axis, &motion);
    let mut plain = plain_rack();
    if let Law::Cascade { every, .. } = &mut plain.law {
        *every = [4, 2];
    }
    let rows = plainly(&plain, &cycles, &motion);
    // Measured 1.8e-11 m, 5.6e-9 rad, 9.8e-6 N·m.
    check("own rates", &cycles, &rows, [1e-10, 3e-8, 5e-5]);
    for (k, pair) in cycles.windows(2).enumerate() {
        let held = |f: fn(&Cycle) -> f64| f(&pair[0]) == f(&pair[1]);
        assert!((k + 1) % 4 == 0 || held(|c| c.command.speed_ref), "{k}");
        assert!((k + 1) % 2 == 0 || held(|c| c.command.effort), "{k}");
    }
    // At the control frequency, they are as without rates, to the bit.
    let own = rack(
        "step_us = 25",
        &[(
            "position_rate_khz = 4",
            "position_rate_khz = 8\nspeed_rate_hz = 8000",
        )],
    );
    let none = rack("step_us = 25", &[("position_rate_khz = 4", "")]);
    let all = |axis: &Axis| -> Vec<_> { follow(axis, &motion).iter().flat_map(bits).collect() };
    assert!(all(&own) == all(&none));
}

#[test]
fn a_joint_under_gravity_with_a_kinematic_error() {
    // Measured 8.4e-8 rad, 1.3e-5 rad, 2.4e-4 N·m, then 2.0e-8, 3.2e-6, 5.7e-5, and 2.1e-10, 2.0e-8,
    // 1.2e-7.
    for (step, tolerance) in [
        ("step_us = 250", [5e-7, 5e-5, 1e-3]),
        ("step_us = 125", [1e-7, 2e-5, 2e-4]),
        ("step_us = 5", [1e-9, 1e-7, 5e-7]),
    ] {
        let mut axis = changed("joint.toml", &[("step_us = 250", step)]);
        axis.sensors = axis_sim::Sensors::default();
        let degree = TAU / 360.0;
        let motion = motion(&axis, 20.0 * degree, 1.0, 5.0, 60.0);
        let cycles = follow(&axis, &motion);
        let amplitude = 0.5 / 60.0 * degree;
        let plain = Plain {
            masses: Masses::Two(1e-4, 2.0, 0.01, 2.5e4, 0.2e-3),
            friction: Rub {
                coulomb: 6.0,
                stiction: 7.0,
                stribeck: 2.0 * degree,
                stiffness: 2e4,
                damping: 20.0,
                viscous: 8.0,
            },
            load: &|x| 60.0 * (x + FRAC_PI_2).sin(),
            error: &|angle, speed| {
                let (sin, cos) = (2.0 * angle).sin_cos();
                [amplitude * sin, amplitude * 2.0 * speed * cos]
            },
            source: Source {
                bandwidth: 500.0,
                cycles_late: 1.0,
                limit: 2.5,
            },
            law: Law::Cascade {
                kv: 6.0,
                gain: 0.02,
                time: 0.05,
                every: [4, 1],
            },
            period: 1.0 / 4000.0,
        };
        let rows = plainly(&plain, &cycles, &motion);
        check(&format!("joint, {step}"), &cycles, &rows, tolerance);
        // Gravity and the gear's error show.
        let mut without = Plain {
            error: NO_ERROR,
            ..plain
        };
        let far = apart(&cycles, &plainly(&without, &cycles, &motion))[0];
        assert!(far > 100.0 * tolerance[0], "{far:e}");
        without = Plain {
            load: &|_| 0.0,
            ..plain
        };
        let far = apart(&cycles, &plainly(&without, &cycles, &motion))[1];
        assert!(far > 100.0 * tolerance[1], "{far:e}");
    }
}

#[test]
fn a_linear_motor_under_pid() {
    // Of second order: 2.0e-10 m and 2.1e-3 N, 3.2e-11 m and 3.3e-4 N, 2.0e-12 m and 2.1e-5 N as
    // measured.
    for (step, tolerance) in [
        ("step_us = 50", [1e-9, 1e-9, 1e-2]),
        ("step_us = 20", [2e-10, 2e-10, 2e-3]),
        ("step_us = 5", [1e-11, 1e-11, 1e-4]),
    ] {
        let mut axis = changed("linear-stage.toml", &[("step_us = 50", step)]);
        axis.sensors = axis_sim::Sensors::default();
        let motion = motion(&axis, 0.02, 0.2, 4.0, 200.0);
        let cycles = follow(&axis, &motion);
        let plain = Plain {
            masses: Masses::One(8.0),
            friction: Rub {
                coulomb: 4.0,
                stiction: 5.0,
                stribeck: 5e-3,
                stiffness: 0.5e6,
                damping: 200.0,
                viscous: 15.0,
            },
            load: &|_| 10.0,
            error: NO_ERROR,
            source: Source {
                bandwidth: 600.0,
                cycles_late: 0.0,
                limit: 250.0,
            },
            law: Law::Pid {
                gains: [2.3e5, 7e6, 2300.0],
                lowpass: 500.0,
            },
            period: 1.0 / 5000.0,
        };
        let rows = plainly(&plain, &cycles, &motion);
        check(&format!("stage, {step}"), &cycles, &rows, tolerance);
    }
}
