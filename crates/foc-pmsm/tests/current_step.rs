//! A step of the q current in the closed current loop, with the inverter
//! averaged, switched, and left out (dq voltages held).

use crate::axis::{CurrentLoop, drawn_current_loop, paper_current_loop};
use foc_pmsm::inverter::{Inverter, Rotor};
use foc_pmsm::svpwm::{Overmodulation, Svpwm};
use foc_pmsm::{Dq, ServoState};
use proptest::prelude::*;

#[derive(Clone, Copy)]
enum Model {
    /// dq voltages held over the period, as the paper's simulation does.
    Held,
    Averaged,
    Switched,
    /// Switched, with this dead time, s.
    DeadTime(f64),
}

/// The currents (A) at the sampling instants, from zero to `reference` (A) at
/// the constant mechanical `speed` (rad/s), the integrals settled for zero.
fn run(plant: &CurrentLoop, model: Model, speed: f64, reference: Dq, periods: usize) -> Vec<Dq> {
    let (motor, servo) = (&plant.motor, plant.servo());
    let dead_time = match model {
        Model::DeadTime(t) => t,
        _ => 0.0,
    };
    let inverter = Inverter::new(plant.dc_voltage, plant.period, dead_time).unwrap();
    let modulator = Svpwm::new(plant.dc_voltage, Overmodulation::default()).unwrap();
    let mut state = ServoState::settled(0.0, motor.steady_voltage(Dq::ZERO, speed));
    let (mut i, mut angle) = (Dq::ZERO, 0.3);
    let mut currents = vec![i];
    for _ in 0..periods {
        let (u, limited_d, limited_q) = servo.current_loop(&mut state, reference - i, Dq::ZERO);
        assert!(
            !limited_d && !limited_q,
            "the comparison is for the linear range"
        );
        let rotor = Rotor {
            electrical_angle: angle,
            speed,
        };
        // The stator voltage stands still for a period: aim at its middle.
        let duties = modulator.duties(u.inverse_park(rotor.angle_after(motor, plant.period / 2.0)));
        i = match model {
            Model::Held => motor.step(i, u, speed, plant.period),
            Model::Averaged => inverter.averaged_step(motor, i, rotor, duties),
            _ => inverter.switched_step(motor, i, rotor, duties),
        };
        angle = rotor.angle_after(motor, plant.period);
        currents.push(i);
    }
    currents
}

fn length(i: Dq) -> f64 {
    i.dot(i).sqrt()
}

fn largest_difference(a: &[Dq], b: &[Dq]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(&x, &y)| length(x - y)).fold(0.0, f64::max)
}

const STEP: Dq = Dq { d: 0.0, q: 5.0 };

/// The paper's drive. Switched and averaged voltage have the same
/// volt-seconds and are both symmetric about the period's middle, so their
/// currents at its end differ in the third order of the period only.
#[test]
fn switched_and_averaged_agree() {
    let plant = paper_current_loop();
    // Measured: 2.3e-6, 1.3e-5, 1.4e-4 A.
    for (speed, tolerance) in [(0.0, 1e-5), (20.0, 5e-5), (100.0, 5e-4)] {
        let averaged = run(&plant, Model::Averaged, speed, STEP, 400);
        let switched = run(&plant, Model::Switched, speed, STEP, 400);
        let got = largest_difference(&averaged, &switched);
        assert!(got <= tolerance, "{speed} rad/s: {got} A");
        assert!(got > 0.0, "the switched model must not be the averaged one");
        // 2 µs of dead time are far outside: 1.4 to 2.9 A.
        let dead = run(&plant, Model::DeadTime(2e-6), speed, STEP, 400);
        let lost = largest_difference(&averaged, &dead);
        assert!(lost > 0.5, "{speed} rad/s: {lost} A");
        for run in [&averaged, &switched] {
            let last = length(*run.last().unwrap() - STEP);
            assert!(last < 0.1); // 0.083 A, the slowest pole being near 110 1/s
        }
    }
}

/// Holding the dq voltage instead of the stator voltage lets the vector turn
/// by ±ω_e T/2 about its middle: of second order as well.
#[test]
fn held_dq_voltages_agree_with_the_switched_inverter() {
    let plant = paper_current_loop();
    // Measured: 6.0e-6, 1.8e-4, 2.8e-3 A.
    for (speed, tolerance) in [(0.0, 2e-5), (20.0, 6e-4), (100.0, 1e-2)] {
        let held = run(&plant, Model::Held, speed, STEP, 400);
        let switched = run(&plant, Model::Switched, speed, STEP, 400);
        let got = largest_difference(&held, &switched);
        assert!(got <= tolerance, "{speed} rad/s: {got} A");
    }
}

/// A step of i_q shifts the d axis by ω_e L_q Δi_q volts. The integral takes
/// that over; until then P_id e_d holds against it, so that i_d stays below
/// the shift over P_id, and returns to 0.
#[test]
fn the_integral_decouples_the_d_axis() {
    let plant = paper_current_loop();
    let speed = 62.8;
    let p = *plant.motor.parameters();
    let shift = plant.motor.electrical_speed(speed) * p.inductance_q * STEP.q;
    let run = run(&plant, Model::Held, speed, STEP, 3000);
    let peak = run.iter().map(|i| i.d.abs()).fold(0.0, f64::max);
    // 3.1 A of 6.0 A.
    assert!(peak > 0.3 * shift / 2.776 && peak < shift / 2.776, "{peak}");
    // 0.3 s are 30 times the slowest time constant.
    // 5.6e-14 A measured.
    assert!(length(*run.last().unwrap() - STEP) < 5e-13);
}

/// With the rotational voltage as a feed-forward the axes are decoupled up
/// to the change within a period.
#[test]
fn feed_forward_decouples_sooner() {
    let plant = paper_current_loop();
    let (motor, servo) = (plant.motor, plant.servo());
    let peak = |feed: bool| {
        let speed = 62.8;
        let mut state = ServoState::default();
        if !feed {
            state = ServoState::settled(0.0, motor.steady_voltage(Dq::ZERO, speed));
        }
        let (mut i, mut peak) = (Dq::ZERO, 0.0_f64);
        for _ in 0..1000 {
            let forward = if feed {
                motor.rotational_voltage(i, speed)
            } else {
                Dq::ZERO
            };
            let (u, _, _) = servo.current_loop(&mut state, STEP - i, forward);
            i = motor.step(i, u, speed, plant.period);
            peak = peak.max(i.d.abs());
        }
        peak
    };
    // The remaining disturbance is that of half a period's change of i_q,
    // about P_iq T/(2 L_q) = 3 % of the step, and lasts as long as the step:
    // 0.07 A of 3.1 A.
    let (without, with) = (peak(false), peak(true));
    assert!(with < 0.1 * without, "{with} A with, {without} A without");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Any motor, any stable loop: a quarter of the difference is left when
    /// the loop is sampled twice as often.
    #[test]
    fn the_inverters_agree_to_second_order(
        plant in drawn_current_loop(), turn in 0.0..0.25,
    ) {
        let speed = turn * plant.bandwidth / plant.motor.electrical_speed(1.0);
        let difference = |plant: &CurrentLoop, model: Model, periods: usize| {
            let one = run(plant, model, speed, plant.reference, periods);
            let other = run(plant, Model::Switched, speed, plant.reference, periods);
            largest_difference(&one, &other) / length(plant.reference)
        };
        let fine = CurrentLoop { period: plant.period / 2.0, ..plant };
        let periods = (10.0 / (plant.bandwidth * plant.period)) as usize;
        for model in [Model::Averaged, Model::Held] {
            let coarse = difference(&plant, model, periods);
            let ratio = coarse / difference(&fine, model, 2 * periods);
            // 3.997 to 4.49 measured.
            prop_assert!((3.8..5.0).contains(&ratio), "{}", ratio);
        }
    }
}
