//! The moving node is handed over at an element boundary: nothing may jump.

use feed_dynamics::{ImplicitStepper, NutCoupling, Observation, Settled, TimeStepper};

use crate::drive;

/// Accelerates over the boundary at 0.6 m (forwards) or 0.45 m (backwards)
/// and on, the motor torque held at what rigid motion needs.
fn pass(coupling: NutCoupling, sign: f64) -> Vec<Observation> {
    let drive = drive();
    let stepper = ImplicitStepper::new(&drive, coupling, 1e-5).unwrap();
    let motion = Settled {
        speed: sign * 0.1,
        acceleration: sign * 0.5,
        load: sign * 420.0,
    };
    let torque = motion.motor_torque(&drive);
    let start = if sign > 0.0 { 0.595 } else { 0.455 };
    let mut state = stepper.settled(start, &motion).unwrap();
    (0..10_000)
        .map(|_| {
            let report = stepper.step(&mut state, torque, |_| motion.load);
            assert!(report.load.converged && report.on_screw);
            stepper.observe(&state)
        })
        .collect()
}

#[test]
fn handing_the_node_over_is_not_felt() {
    for sign in [1.0, -1.0] {
        let moving = pass(NutCoupling::MovingNode, sign);
        let fixed = pass(NutCoupling::ShapeFunctions, sign);
        assert!(moving.last().unwrap().displacement.abs() > 0.01);

        // The accelerations differ by what the discretisation changes in the
        // wind-up; 0.014 N of 678 N of nut force as measured.
        let most = |f: fn(&Observation) -> f64| {
            let apart = moving.iter().zip(&fixed).map(|(a, b)| (f(a) - f(b)).abs());
            apart.fold(0.0, f64::max)
        };
        let force = most(|o| o.transmission_force);
        let speed = most(|o| o.motor_speed);
        let table = most(|o| o.speed);

        // From one 10 µs step to the next: no jump.
        let jump = |seen: &[Observation], f: fn(&Observation) -> f64| {
            let steps = seen.windows(2).map(|w| (f(&w[1]) - f(&w[0])).abs());
            steps.fold(0.0, f64::max)
        };
        let force_jump = jump(&moving, |o| o.transmission_force);
        let speed_jump = jump(&moving, |o| o.motor_speed);
        println!(
            "{sign}: apart {force:.2e} N {speed:.2e} rad/s {table:.2e} m/s; \
             a step {force_jump:.2e} N {speed_jump:.2e} rad/s (fixed mesh {:.2e} {:.2e})",
            jump(&fixed, |o| o.transmission_force),
            jump(&fixed, |o| o.motor_speed),
        );
        assert!(force < 0.05, "{force}");
        assert!(speed < 5e-5, "{speed}");
        assert!(table < 1e-7, "{table}");
        // Rigid acceleration alone moves the motor by 3.1e-3 rad/s a step.
        assert!(
            speed_jump < 2.0 * 0.5 / drive().travel_per_radian() * 1e-5,
            "{speed_jump}"
        );
        assert!(force_jump < 0.02, "{force_jump}");
    }
}
