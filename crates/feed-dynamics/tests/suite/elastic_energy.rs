//! Energy of the elastic drive: what keeps it, what takes it, and that nothing adds
//! to it, whatever the stiffness and the step.

use feed_dynamics::{
    ElasticDrive, ElasticDriveParameters, ElasticStepper, NutErrors, Settled, TimeStepper,
};
use proptest::prelude::*;
use std::sync::Arc;

fn drive(inertias: [f64; 2], ratio: f64, stiffness: f64, beta: f64) -> ElasticDrive {
    ElasticDrive::new(ElasticDriveParameters {
        motor_inertia: inertias[0],
        load_inertia: inertias[1],
        travel_per_radian: ratio,
        stiffness: Arc::new(stiffness),
        stiffness_damping: beta,
    })
    .unwrap()
}

/// Numbers whose logarithm is spread evenly.
fn decades(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from..to).prop_map(|power| 10_f64.powf(power))
}

proptest! {
    /// Shaken at random, then let go, with and without a gap: from a thousandth to
    /// ten thousand times the step that resolves the resonance.
    #[test]
    fn energy_never_grows_by_itself(
        inertias in [decades(-6.0, 0.0), decades(-1.0, 4.0)],
        ratio in decades(-4.0, 0.0),
        beta in prop_oneof![Just(0.0), decades(-3.0, 2.0)],
        fastness in decades(-3.0, 4.0),
        step in decades(-6.0, -2.0),
        gap in prop_oneof![Just(0.0), decades(-3.0, 3.0)],
        torques in proptest::collection::vec(-1.0..1.0_f64, 40),
    ) {
        // ωh is `fastness`; β in steps; the gap in travels of a step.
        let mobility = 1.0 / inertias[1] + ratio * ratio / inertias[0];
        let stiffness = (fastness / step).powi(2) / mobility;
        let stepper =
            ElasticStepper::new(&drive(inertias, ratio, stiffness, beta * step), step).unwrap();
        let per_step = step * step * ratio / inertias[0];
        let errors = NutErrors::new(0.0, 0.0, gap * per_step).unwrap();
        let mut state = stepper.settled(0.0, &Settled::default()).unwrap();
        let mut most = 0.0_f64;
        for torque in torques.iter().chain(&[0.0]) {
            prop_assert!(stepper.step_through(&mut state, *torque, &errors, |_| 0.0).load.converged);
            most = most.max(stepper.energy(&state));
        }
        let mut before = stepper.energy(&state);
        for _ in 0..1000 {
            prop_assert!(stepper.step_through(&mut state, 0.0, &errors, |_| 0.0).load.converged);
            let after = stepper.energy(&state);
            // Rounding: of k δ, where δ is what k leaves of a travel (ωh)² as large;
            // 1.3e-14 in 3000 cases.
            let rounding = 5e-14 * (1.0 + fastness * fastness) * most;
            prop_assert!(after <= before + rounding, "{after:e} after {before:e} of {most:e}");
            before = after;
        }
    }
}

/// Greatest deviation of the energy from the work done on the drive, of the greatest
/// energy, under a constant torque and load from rest.
fn imbalance(beta: f64, step: f64) -> f64 {
    let (ratio, stiffness) = (0.02, 1e6);
    let stepper = ElasticStepper::new(&drive([2e-4, 12.0], ratio, stiffness, beta), step).unwrap();
    let mut state = stepper.settled(0.0, &Settled::default()).unwrap();
    let (mut work, mut most, mut off) = (0.0, 0.0_f64, 0.0_f64);
    for i in 0..2000 {
        let before = stepper.observe(&state);
        assert!(stepper.step(&mut state, 5.0, |_| 80.0).load.converged);
        let after = stepper.observe(&state);
        // Both grow from zero over the first step.
        let mean = if i == 0 { 0.5 } else { 1.0 };
        work += mean * 5.0 * (after.motor_angle - before.motor_angle);
        work -= mean * 80.0 * (after.displacement - before.displacement);
        let closing = |o: feed_dynamics::Observation| ratio * o.motor_speed - o.speed;
        let mean_closing = 0.5 * (closing(before) + closing(after));
        work -= step * beta * stiffness * mean_closing * mean_closing;
        let energy = stepper.energy(&state);
        most = most.max(energy);
        off = off.max((energy - work).abs());
    }
    off / most
}

#[test]
fn torque_load_and_damping_account_for_all_of_the_energy() {
    // 2.0e-14, 1.7e-14, 1.9e-13 and 2.2e-14.
    for (beta, step, rounding) in [
        (0.0, 1e-4, 1e-13),
        (2e-5, 1e-4, 1e-13),
        (1e-3, 1e-3, 1e-12),
        (0.0, 1e-2, 1e-13),
    ] {
        let off = imbalance(beta, step);
        println!("imbalance at {beta}, {step}: {off:e}");
        assert!(off < rounding, "{off:e}");
    }
}

#[test]
fn the_momentum_grows_with_the_torque_alone() {
    // J ω / r + m v, whatever the two do to each other.
    let (inertias, ratio) = ([2e-4, 12.0], 0.02);
    let stepper = ElasticStepper::new(&drive(inertias, ratio, 1e6, 2e-5), 1e-4).unwrap();
    let mut state = stepper.settled(0.0, &Settled::default()).unwrap();
    let mut off = 0.0_f64;
    for i in 1..=5000 {
        assert!(stepper.step(&mut state, 3.0, |_| 0.0).load.converged);
        let o = stepper.observe(&state);
        let momentum = inertias[0] * o.motor_speed / ratio + inertias[1] * o.speed;
        // The torque grows from zero over the first step.
        let given = 3.0 / ratio * 1e-4 * (f64::from(i) - 0.5);
        off = off.max((momentum / given - 1.0).abs());
    }
    println!("momentum {off:e}");
    assert!(off < 3e-14, "{off:e}");
}

#[test]
fn a_drive_that_runs_free_keeps_its_speed_to_the_bit() {
    let stepper = ElasticStepper::new(&drive([2e-4, 12.0], 0.02, 1e6, 2e-5), 1e-4).unwrap();
    let motion = Settled {
        speed: 0.7,
        ..Settled::default()
    };
    let mut state = stepper.settled(3.0, &motion).unwrap();
    let before = stepper.observe(&state);
    let mut off = 0.0_f64;
    for i in 1..=5000 {
        assert!(stepper.step(&mut state, 0.0, |_| 0.0).load.converged);
        let (o, way) = (stepper.observe(&state), 0.7e-4 * f64::from(i));
        assert_eq!([o.speed, o.transmission_force], [0.7, 0.0]);
        assert_eq!(o.motor_speed, before.motor_speed);
        off = off.max((o.displacement / way - 1.0).abs());
        off = off.max((o.motor_angle * 0.02 / way - 1.0).abs());
    }
    println!("running free {off:e}");
    assert!(off < 8e-13, "{off:e}");
}

#[test]
fn a_joint_too_stiff_for_the_step_moves_as_one() {
    // ωh = 71 at 1 ms: against one inertia in closed form, T = sin(20 t).
    let inertias = [1e-4, 2e-2];
    let stepper = ElasticStepper::new(&drive(inertias, 1.0, 5e5, 1e-6), 1e-3).unwrap();
    let mut state = stepper.settled(0.0, &Settled::default()).unwrap();
    let total = inertias[0] + inertias[1];
    let mut off = 0.0_f64;
    for i in 1..=10_000 {
        let t = 1e-3 * f64::from(i);
        let _ = stepper.step(&mut state, (20.0 * t).sin(), |_| 0.0);
        let o = stepper.observe(&state);
        let speed = (1.0 - (20.0 * t).cos()) / (20.0 * total);
        off = off
            .max((o.speed - speed).abs())
            .max((o.motor_speed - speed).abs());
    }
    let greatest = 2.0 / (20.0 * total);
    println!("stiff joint: {:e} of the speed", off / greatest);
    // 4.7e-5: its phase is right, its speed is that of a torque that goes linearly.
    assert!(off < 3e-4 * greatest, "{off:e}");
}
