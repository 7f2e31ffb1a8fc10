//! Settled states: their statics, and that they stay as they are.

use feed_dynamics::{ImplicitStepper, ModalStepper, Observation, Settled, TimeStepper};
use std::f64::consts::PI;

use crate::{COUPLINGS, drive, relative};

/// Runs a test on every stepper.
fn on_each(
    step: f64,
    mut test: impl FnMut(&str, &dyn Fn(f64, Settled, usize) -> Vec<Observation>),
) {
    let drive = drive();
    let modal = ModalStepper::new(&drive, step).unwrap();
    test("modal", &|x, motion, steps| {
        keep_up(&modal, x, motion, steps)
    });
    for coupling in COUPLINGS {
        let implicit = ImplicitStepper::new(&drive, coupling, step).unwrap();
        let name = format!("implicit, {coupling:?}");
        test(&name, &|x, motion, steps| {
            keep_up(&implicit, x, motion, steps)
        });
    }
}

fn keep_up<S: TimeStepper>(s: &S, x: f64, motion: Settled, steps: usize) -> Vec<Observation> {
    let torque = motion.motor_torque(&drive());
    let mut state = s.settled(x, &motion).unwrap();
    let mut seen = vec![s.observe(&state)];
    for _ in 0..steps {
        assert!(s.step(&mut state, torque, |_| motion.load).load.converged);
        seen.push(s.observe(&state));
    }
    seen
}

#[test]
fn statics_are_those_of_springs_in_series() {
    // A load F on the table winds the chain up by r F (1/K₁ + 1/K₂ + x/GJ) and
    // compresses the nut by F/k. Between nodes the shape functions are stiffer
    // by ξ(1 − ξ) l/GJ (beam-fem); the moving node sits on the nut.
    let (load, r) = (1000.0, drive().travel_per_radian());
    let rigidity = 206e9 / 2.6 * PI * 0.040_f64.powi(4) / 32.0;
    for x in [0.15, 0.43, 0.6, 0.825, 1.3] {
        let motion = Settled {
            load,
            ..Settled::default()
        };
        on_each(1e-4, |name, run| {
            let seen = run(x, motion, 0)[0];
            let xi = x / 0.15 - (x / 0.15_f64).floor();
            let moving = name.contains("MovingNode");
            let deficit = if moving {
                0.0
            } else {
                xi * (1.0 - xi) * 0.15 / rigidity
            };
            let soft = 2.0 / 2800.0 + x / rigidity - deficit;
            let angle = r * load * soft + load / 7.45e7 / r;
            // 4.5e-13 of a sum over modes, 1.8e-16 of one over springs.
            let rounding = if name == "modal" { 4e-12 } else { 2e-15 };
            assert!(
                relative(seen.motor_angle, angle) < rounding,
                "{name} {x}: {seen:?} {angle}"
            );
            assert_eq!(seen.displacement, 0.0);
            assert!(relative(seen.transmission_force, load) < 1e-15);
        });
    }
}

#[test]
fn a_loaded_axis_at_rest_stays_at_rest() {
    let motion = Settled {
        load: 750.0,
        ..Settled::default()
    };
    on_each(1e-4, |name, run| {
        let seen = run(0.43, motion, 1000);
        for o in &seen {
            // The axis is free, so what torque and load miss each other by in
            // rounding lets it drift: 5e-16 m, 9e-15 m/s and 6e-12 rad/s over 0.1 s
            // measured, of 11 µm of wind-up; 4e-11 of the angle, 1.5e-13 of the force.
            assert!(o.displacement.abs() < 1e-15, "{name}: {o:?}");
            assert!(
                o.speed.abs() < 5e-14 && o.motor_speed.abs() < 5e-11,
                "{name}: {o:?}"
            );
            assert!(
                relative(o.motor_angle, seen[0].motor_angle) < 1e-10,
                "{name}: {o:?}"
            );
            assert!(
                relative(o.transmission_force, 750.0) < 1e-12,
                "{name}: {o:?}"
            );
        }
    });
}

#[test]
fn accelerated_motion_stays_settled() {
    // Past the screw's end the nut stays on the last node, so that deflections
    // need not change with x: the acceleration must then be exact.
    let r = drive().travel_per_radian();
    let motion = Settled {
        speed: 0.08,
        acceleration: 0.9,
        load: 425.0,
    };
    let h = 1e-4;
    on_each(h, |name, run| {
        let seen = run(1.5, motion, 500);
        // The implicit stepper finds 4 N·m as the difference of stiffness times
        // angle: rounding is 5e-12 with 1e5 N·m/rad times a few rad, and 3e-10
        // with the moved node's element a thousandth as long at the end.
        let rounding = match name {
            "modal" => 1e-12,
            "implicit, ShapeFunctions" => 1e-11,
            _ => 3e-9,
        };
        for (i, o) in seen.iter().enumerate() {
            let t = i as f64 * h;
            let speed = 0.08 + 0.9 * t;
            let way = 0.08 * t + 0.45 * t * t;
            assert!(relative(o.speed, speed) < rounding, "{name} {t}: {o:?}");
            assert!(
                relative(o.motor_speed, speed / r) < rounding,
                "{name} {t}: {o:?}"
            );
            assert!(
                (o.displacement - way).abs() < rounding * way.max(1e-3),
                "{name} {t}: {o:?}"
            );
            // k (rθ − y) loses the digits of y: 7.45e7 N/m × 1e-17 m = 1e-9 N. 1.4e-9,
            // 1.8e-8 and 1.8e-6 N as measured.
            let lost = 1e-8_f64.max(2e4 * rounding);
            assert!(
                (o.transmission_force - 888.5).abs() < lost,
                "{name} {t}: {o:?}"
            );
        }
    });
}

#[test]
fn away_from_the_end_it_changes_only_with_x() {
    // The wind-up grows with x by F r²/GJ per metre, 1e-7 of the way; a
    // settled start must show nothing beyond that.
    let r = drive().travel_per_radian();
    let motion = Settled {
        speed: 0.1,
        acceleration: 0.5,
        load: 300.0,
    };
    on_each(1e-4, |name, run| {
        // Across the element boundary at 0.6 m.
        for o in run(0.59, motion, 2000) {
            let slip = (r * o.motor_speed - o.speed).abs() / o.speed;
            // 3.5e-7 as measured.
            assert!(slip < 2e-6, "{name}: slip {slip:e}");
        }
    });
}
