//! A step of the q current in the closed current loop at 10 kHz, with the
//! inverter averaged, switched, and left out (dq voltages held).

mod axis;

use axis::{DC_VOLTAGE, PERIOD, motor, servo};
use foc_pmsm::inverter::{Inverter, Rotor};
use foc_pmsm::svpwm::{Overmodulation, Svpwm};
use foc_pmsm::{Dq, Pmsm, ServoState};

#[derive(Clone, Copy)]
enum Model {
    /// dq voltages held over the period, as the paper's simulation does.
    Held,
    Averaged,
    Switched,
    /// Switched with 2 µs of dead time.
    DeadTime,
}

struct Run {
    /// At the sampling instants, A.
    currents: Vec<Dq>,
    longest_voltage: f64,
}

/// The loop from a start current to a reference, at constant speed, the
/// integrals settled for zero current.
fn run(model: Model, speed: f64, start: Dq, reference: Dq, periods: usize) -> Run {
    let (motor, servo) = (motor(), servo());
    let dead_time = if matches!(model, Model::DeadTime) {
        2e-6
    } else {
        0.0
    };
    let inverter = Inverter::new(DC_VOLTAGE, PERIOD, dead_time).unwrap();
    let modulator = Svpwm::new(DC_VOLTAGE, Overmodulation::default()).unwrap();
    let mut state = ServoState::settled(0.0, motor.steady_voltage(Dq::ZERO, speed));
    let mut i = start;
    let mut angle = 0.3;
    let mut currents = vec![i];
    let mut longest_voltage = 0.0_f64;
    for _ in 0..periods {
        let (u, limited_d, limited_q) = servo.current_loop(&mut state, reference - i, Dq::ZERO);
        assert!(
            !limited_d && !limited_q,
            "the comparison is for the linear range"
        );
        longest_voltage = longest_voltage.max(u.dot(u).sqrt());
        let rotor = Rotor {
            electrical_angle: angle,
            speed,
        };
        // The stator voltage stands still for a period: aim at its middle.
        let duties = modulator.duties(u.inverse_park(rotor.angle_after(&motor, PERIOD / 2.0)));
        i = match model {
            Model::Held => motor.step(i, u, speed, PERIOD),
            Model::Averaged => inverter.averaged_step(&motor, i, rotor, duties),
            Model::Switched | Model::DeadTime => inverter.switched_step(&motor, i, rotor, duties),
        };
        angle = rotor.angle_after(&motor, PERIOD);
        currents.push(i);
    }
    Run {
        currents,
        longest_voltage,
    }
}

fn length(i: Dq) -> f64 {
    i.dot(i).sqrt()
}

fn largest_difference(a: &Run, b: &Run) -> f64 {
    let pairs = a.currents.iter().zip(&b.currents);
    pairs.map(|(&x, &y)| length(x - y)).fold(0.0, f64::max)
}

/// How far two voltages of equal volt-seconds, both symmetric about the
/// period's middle, can drive the currents apart in one period.
///
/// In the stator, the flux obeys λ' = u − R Λ(t) λ + (magnets), with
/// ‖Λ‖ ≤ 1/L_d and ‖Λ'‖ ≤ ω_e/L_d. Its response to u(s) is Φ(T, s), with
/// ‖∂²Φ/∂s²‖ ≤ a² + a ω_e, a = R/L_d. Developed about T/2, the zeroth and
/// first moments of the difference w vanish; ∫ (s − T/2)²/2 |w| ds ≤
/// |w|max T³/24, and the current is at most flux/L_d.
fn per_period(motor: &Pmsm, speed: f64, largest: f64) -> f64 {
    let p = motor.parameters();
    let a = p.resistance / p.inductance_d;
    let second = a * a + a * motor.electrical_speed(speed).abs();
    second * largest * PERIOD.powi(3) / 24.0 / p.inductance_d
}

/// Sum over time of the loop's answer to a disturbance of 1 A in one period:
/// what a bounded difference in every period can add up to. The loop is
/// affine below its limits, so two runs give the answer.
fn accumulated(speed: f64) -> f64 {
    let reference = Dq { d: 0.0, q: 5.0 };
    let base = run(Model::Averaged, speed, Dq::ZERO, reference, 2000);
    [Dq { d: 1.0, q: 0.0 }, Dq { d: 0.0, q: 1.0 }]
        .map(|kick| {
            let kicked = run(Model::Averaged, speed, kick, reference, 2000);
            let pairs = base.currents.iter().zip(&kicked.currents);
            pairs.map(|(&x, &y)| length(x - y)).sum::<f64>()
        })
        .iter()
        .sum()
}

#[test]
fn switched_and_averaged_agree() {
    let motor = motor();
    for speed in [0.0, 20.0, 100.0] {
        let reference = Dq { d: 0.0, q: 5.0 };
        let averaged = run(Model::Averaged, speed, Dq::ZERO, reference, 400);
        let switched = run(Model::Switched, speed, Dq::ZERO, reference, 400);
        // A vector of the hexagon differs from another by at most 4/3 U_dc.
        let ripple = per_period(&motor, speed, 4.0 / 3.0 * DC_VOLTAGE);
        // Integration: the bound of the test in tests/inverter.rs.
        let bound = (ripple + 6e-5) * accumulated(speed);
        let got = largest_difference(&averaged, &switched);
        println!("{speed} rad/s: {got:.2e} A, bound {bound:.2e} A");
        assert!(got <= bound, "{speed} rad/s: {got} A, bound {bound} A");
        assert!(got > 0.0, "the switched model must not be the averaged one");
        // The bound is sharp enough to see 2 µs of dead time.
        let dead = run(Model::DeadTime, speed, Dq::ZERO, reference, 400);
        assert!(largest_difference(&averaged, &dead) > 4.0 * bound);
        // Both arrive: the slowest pole of the loop is near 110 1/s.
        for run in [&averaged, &switched] {
            let last = *run.currents.last().unwrap();
            assert!(length(last - reference) < 0.02 * 5.0);
        }
    }
}

/// Holding the dq voltage instead of the stator voltage lets the vector turn
/// by ±ω_e T/2 about its middle: symmetric in the mean, so again second
/// order, plus the cosine's (ω_e T)²/24 of the volt-seconds.
#[test]
fn held_dq_voltages_agree_with_the_switched_inverter() {
    let motor = motor();
    for speed in [0.0, 20.0, 100.0] {
        let reference = Dq { d: 0.0, q: 5.0 };
        let held = run(Model::Held, speed, Dq::ZERO, reference, 400);
        let switched = run(Model::Switched, speed, Dq::ZERO, reference, 400);
        let p = motor.parameters();
        let omega = motor.electrical_speed(speed);
        let turn = omega * PERIOD;
        let u = held.longest_voltage;
        let ripple = per_period(&motor, speed, 4.0 / 3.0 * DC_VOLTAGE + u);
        let cosine = u * turn * turn / 24.0 * PERIOD / p.inductance_d;
        // First moment of the turning vector, u ω_e T³/12, times a.
        let skew = u * omega * PERIOD.powi(3) / 12.0 * p.resistance / p.inductance_d.powi(2);
        // One midpoint step over the period: (ω_e T)²(L_q/L_d)/12 of the
        // largest change of current in a period.
        let angular = (turn * turn * p.inductance_q / p.inductance_d)
            + (p.resistance / p.inductance_d * PERIOD).powi(2);
        let change = held
            .currents
            .windows(2)
            .map(|w| length(w[1] - w[0]))
            .fold(0.0, f64::max);
        let midpoint = angular / 12.0 * change;
        let bound = (ripple + cosine + skew + midpoint + 6e-5) * accumulated(speed);
        let got = largest_difference(&held, &switched);
        println!("{speed} rad/s: {got:.2e} A, bound {bound:.2e} A");
        assert!(got <= bound, "{speed} rad/s: {got} A, bound {bound} A");
    }
}

/// A step of i_q shifts the d axis by ω_e L_q Δi_q volts. The integral takes
/// that over; until then P_id e_d holds against it, so that i_d stays below
/// the shift over P_id, and returns to 0.
#[test]
fn the_integral_decouples_the_d_axis() {
    let motor = motor();
    let (speed, step) = (62.8, 5.0);
    let shift = motor.electrical_speed(speed) * motor.parameters().inductance_q * step;
    let reference = Dq { d: 0.0, q: step };
    let run = run(Model::Held, speed, Dq::ZERO, reference, 3000);
    let peak = run.currents.iter().map(|i| i.d.abs()).fold(0.0, f64::max);
    println!("peak i_d {peak:.3} A of {:.3} A", shift / 2.776);
    assert!(peak > 0.0 && peak < shift / 2.776, "{peak}");
    // 0.3 s are 30 times the slowest time constant.
    assert!(length(*run.currents.last().unwrap() - reference) < 1e-9);
}

/// With the rotational voltage as a feed-forward the axes are decoupled up
/// to the change within a period.
#[test]
fn feed_forward_decouples_sooner() {
    let (motor, servo) = (motor(), servo());
    let reference = Dq { d: 0.0, q: 5.0 };
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
            let (u, _, _) = servo.current_loop(&mut state, reference - i, forward);
            i = motor.step(i, u, speed, PERIOD);
            peak = peak.max(i.d.abs());
        }
        peak
    };
    // The remaining disturbance is that of half a period's change of i_q,
    // about P_iq T/(2 L_q) = 3 % of the step, and lasts as long as the step.
    let (without, with) = (peak(false), peak(true));
    println!("peak i_d {without:.3} A without, {with:.3} A with feed-forward");
    assert!(with < 0.1 * without, "{with} A with, {without} A without");
}
