//! Gains from the motor, the voltage's delay, and decoupling.

use crate::axis::{self, DC_VOLTAGE, PERIOD, RATED_SPEED, drawn_motor, log_uniform, motor};
use foc_pmsm::inverter::{Inverter, Rotor};
use foc_pmsm::svpwm::{Overmodulation, Svpwm};
use foc_pmsm::{
    CurrentGains, Decoupling, DecouplingCurrent, Dq, FocError, Measurement, MotorParameters,
    OperatingPoint, Pmsm, Servo, ServoGains, ServoInput, ServoLimits, ServoReference, ServoState,
    VoltageDelay,
};
use proptest::prelude::*;

fn dq(d: f64, q: f64) -> Dq {
    Dq { d, q }
}

/// A cascade of which only the current loop is used, without limits.
fn loops(gains: &CurrentGains, period: f64) -> Servo {
    let none = ServoGains {
        position: 0.0,
        speed_p: 0.0,
        speed_i: 0.0,
        d_p: 0.0,
        d_i: 0.0,
        q_p: 0.0,
        q_i: 0.0,
    };
    let limits = ServoLimits {
        current: f64::INFINITY,
        voltage: f64::INFINITY,
    };
    Servo::new(none.with_current(gains), limits, period).unwrap()
}

/// Currents after `time`, with a period so short that the loop is continuous in effect.
fn run(
    gains: &CurrentGains,
    decoupling: &Decoupling,
    m: &Pmsm,
    [reference, disturbance]: [Dq; 2],
    (speed, time): (f64, f64),
) -> Dq {
    let steps = 20_000;
    let h = time / f64::from(steps);
    let servo = loops(gains, h);
    let mut state = ServoState::settled(0.0, Dq::ZERO);
    let mut i = Dq::ZERO;
    for _ in 0..steps {
        let added = decoupling.voltage(i, reference, speed);
        let (u, _, _) = servo.current_loop(&mut state, reference - i, added);
        i = m.step(i, u + disturbance, speed, h);
    }
    i
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Both forms follow a step of the reference with α/(s + α) in both axes, at speed.
    #[test]
    fn a_step_is_of_first_order(
        m in drawn_motor(), ratio in log_uniform(2.0, 50.0), turns in -0.3..0.3,
        two in any::<bool>(), d in -5.0..5.0, q in -5.0..5.0,
    ) {
        let p = *m.parameters();
        // Faster than the windings' own R/L, so that the sampling is fine for both.
        let bandwidth = ratio * p.resistance / p.inductance_d.min(p.inductance_q);
        let gains = if two {
            CurrentGains::two_degrees_of_freedom(&m, bandwidth).unwrap()
        } else {
            CurrentGains::pole_zero(&m, bandwidth).unwrap()
        };
        let decoupling = Decoupling::new(m, DecouplingCurrent::Measured)
            .with_active_resistance(gains.active_resistance)
            .unwrap();
        let speed = turns * bandwidth / f64::from(p.pole_pairs);
        let after = (speed, 2.0 / bandwidth);
        let i = run(&gains, &decoupling, &m, [dq(d, q), Dq::ZERO], after);
        let reached = 1.0 - (-2.0_f64).exp();
        let error = (i - dq(d, q) * reached).dot(i - dq(d, q) * reached).sqrt();
        // Of first order in the period, α T = 1e-4; 1.6e-5 measured.
        prop_assert!(error < 1e-4 * (d.abs() + q.abs() + 1e-6), "{}", error);
    }

    /// A step of voltage V that the controller does not know of: with two degrees of
    /// freedom i = V/L t e^(−α t), by pole and zero
    /// V/(L (R/L − α)) (e^(−α t) − e^(−R t/L)).
    #[test]
    fn a_disturbance_dies(
        m in drawn_motor(), ratio in log_uniform(2.0, 50.0), v in 1.0..10.0, times in 0.5..3.0_f64,
    ) {
        let p = *m.parameters();
        let bandwidth = ratio * p.resistance / p.inductance_d.min(p.inductance_q);
        let t = times / bandwidth;
        let all = CurrentGains::two_degrees_of_freedom(&m, bandwidth).unwrap();
        let decoupling = Decoupling::new(m, DecouplingCurrent::Measured)
            .with_active_resistance(all.active_resistance)
            .unwrap();
        // Standing still: the magnets induce nothing.
        let fast = run(&all, &decoupling, &m, [Dq::ZERO, dq(v, v)], (0.0, t));
        let one = CurrentGains::pole_zero(&m, bandwidth).unwrap();
        let plain = Decoupling::new(m, DecouplingCurrent::Measured);
        let slow = run(&one, &plain, &m, [Dq::ZERO, dq(v, v)], (0.0, t));
        for (l, fast, slow) in
            [(p.inductance_d, fast.d, slow.d), (p.inductance_q, fast.q, slow.q)]
        {
            let both = v / l * t * (-times).exp();
            let own = p.resistance / l;
            let mixed = v / l * ((-times).exp() - (-own * t).exp()) / (own - bandwidth);
            // 1.3e-5 measured, of first order in the period.
            prop_assert!((fast - both).abs() < 1e-4 * v / (l * bandwidth), "{} {}", fast, both);
            prop_assert!((slow - mixed).abs() < 1e-4 * v / (l * bandwidth), "{} {}", slow, mixed);
        }
    }
}

#[test]
fn gains_by_hand() {
    let p = MotorParameters {
        pole_pairs: 2,
        resistance: 0.5,
        inductance_d: 2e-3,
        inductance_q: 4e-3,
        flux_linkage: 0.1,
    };
    let m = Pmsm::new(p).unwrap();
    let one = CurrentGains::pole_zero(&m, 1000.0).unwrap();
    assert_eq!((one.kp, one.ki), (dq(2.0, 4.0), dq(500.0, 500.0)));
    assert_eq!(one.active_resistance, Dq::ZERO);
    let two = CurrentGains::two_degrees_of_freedom(&m, 1000.0).unwrap();
    assert_eq!((two.kp, two.ki), (dq(2.0, 4.0), dq(2000.0, 4000.0)));
    assert_eq!(two.active_resistance, dq(1.5, 3.5));
    let servo = axis::gains().with_current(&one);
    assert_eq!((servo.d_p, servo.d_i), (2.0, 500.0));
    assert_eq!((servo.q_p, servo.q_i), (4.0, 500.0));
    assert_eq!(servo.position, axis::gains().position);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(CurrentGains::pole_zero(&m, bad).is_err());
        assert!(CurrentGains::two_degrees_of_freedom(&m, bad).is_err());
        assert!(CurrentGains::bandwidth(bad, 1.0).is_err());
        assert!(VoltageDelay::new(bad, 0.0).is_err());
    }
    for bad in [0.0, 1.6, -0.1, f64::NAN] {
        let error = CurrentGains::bandwidth(1e-4, bad).unwrap_err();
        assert!(matches!(
            error,
            FocError::OutOfRange {
                field: "phase_margin",
                ..
            }
        ));
    }
    let plain = Decoupling::new(m, DecouplingCurrent::Measured);
    assert!(plain.with_active_resistance(dq(0.0, f64::NAN)).is_err());
    assert!(VoltageDelay::new(1e-4, -1e-9).is_err());
}

/// The bandwidth of a phase margin: the loop α e^(−s T_d)/s at s = jα has the magnitude
/// 1 and leaves that angle to −180°.
#[test]
fn the_phase_margin_is_left() {
    for margin in [0.3_f64, 1.0, 1.5] {
        let delay = 1.5e-4;
        let alpha = CurrentGains::bandwidth(delay, margin).unwrap();
        let angle = -std::f64::consts::FRAC_PI_2 - alpha * delay;
        assert!((angle + std::f64::consts::PI - margin).abs() < 1e-15);
    }
}

/// The mean of a voltage that is held in the stator, seen from the rotor: exactly the
/// commanded direction, and the share of its length that is named.
#[test]
fn the_held_voltage_arrives() {
    for (computation, omega) in [(0.0, 840.0), (PERIOD, 840.0), (PERIOD, -6000.0), (0.0, 0.0)] {
        let delay = VoltageDelay::new(PERIOD, computation).unwrap();
        let (u, angle) = (dq(-40.0, 120.0), 0.7);
        let held = delay.inverse_park(u, angle, omega);
        let n = 2000;
        let mean = (0..n).fold(Dq::ZERO, |sum, k| {
            let t = computation + PERIOD * (f64::from(k) + 0.5) / f64::from(n);
            sum + held.park(angle + omega * t) * (1.0 / f64::from(n))
        });
        let wanted = u * delay.magnitude(omega);
        // The midpoint sum is off by (ω T/n)²/24 of a turn in the period at most; 4.7e-7 V measured.
        assert!((mean - wanted).dot(mean - wanted).sqrt() < 2e-6, "{mean:?}");
        assert!((delay.total() - computation - 0.5 * PERIOD).abs() < 1e-18);
    }
    let delay = VoltageDelay::new(PERIOD, PERIOD).unwrap();
    let turn = std::f64::consts::TAU / PERIOD;
    assert!((delay.magnitude(turn / 126.0) - 0.9999).abs() < 1e-4);
}

/// Largest |i_d| of a step of 5 A in q at `speed`, the drive of the paper with its gains
/// and its inverter averaged, a period of computation.
fn largest_d(speed: f64, decoupling: Option<DecouplingCurrent>, delay_periods: f64) -> f64 {
    let m = motor();
    let gains = ServoGains {
        position: 0.0,
        speed_p: 0.0,
        speed_i: 0.0,
        ..axis::gains()
    };
    let servo = Servo::new(gains, axis::limits(), PERIOD).unwrap();
    let delay = VoltageDelay::new(PERIOD, delay_periods * PERIOD).unwrap();
    let modulator = Svpwm::new(DC_VOLTAGE, Overmodulation::default()).unwrap();
    let inverter = Inverter::new(DC_VOLTAGE, PERIOD, 0.0).unwrap();
    let start = if decoupling.is_some() {
        Dq::ZERO
    } else {
        m.steady_voltage(Dq::ZERO, speed)
    };
    let mut state = ServoState::settled(0.0, start);
    let (mut i, mut most) = (Dq::ZERO, 0.0_f64);
    let mut rotor = Rotor {
        electrical_angle: 0.0,
        speed,
    };
    let omega = m.electrical_speed(speed);
    let begin = m.steady_voltage(Dq::ZERO, speed);
    let mut waiting = modulator.duties(delay.inverse_park(begin, -omega * PERIOD, omega));
    for _ in 0..300 {
        let reference = dq(0.0, 5.0);
        let added = decoupling.map_or(Dq::ZERO, |current| {
            Decoupling::new(m, current).voltage(i, reference, speed)
        });
        let (u, _, _) = servo.current_loop(&mut state, reference - i, added);
        let next = modulator.duties(delay.inverse_park(u, rotor.electrical_angle, omega));
        let now = if delay_periods > 0.0 { waiting } else { next };
        waiting = next;
        i = inverter.averaged_step(&m, i, rotor, now);
        rotor.electrical_angle = rotor.angle_after(&m, PERIOD);
        most = most.max(i.d.abs());
    }
    most
}

/// What remains of the 3.1 A by which a step of 5 A in q moves i_d at 62.8 rad/s: 0.07 A
/// where the voltage stands at once, 0.22 A a period later. The reference alone leaves more
/// than half, since the q current with the gains of the paper is slower than it.
#[test]
fn decoupling_leaves_little_of_the_other_axis() {
    const MEASURED: Option<DecouplingCurrent> = Some(DecouplingCurrent::Measured);
    const REFERENCE: Option<DecouplingCurrent> = Some(DecouplingCurrent::Reference);
    for (current, delay, most) in [
        (None, 0.0, 3.093),
        (MEASURED, 0.0, 0.068),
        (MEASURED, 1.0, 0.220),
        (REFERENCE, 0.0, 1.810),
        (REFERENCE, 1.0, 1.843),
    ] {
        let left = largest_d(62.8, current, delay);
        assert!((left - most).abs() < 1e-3, "{current:?} {delay}: {left}");
    }
}

/// A cycle adds the voltage before its limit, and is that of `cycle_with` otherwise.
#[test]
fn a_cycle_adds_the_voltage() {
    let (servo, m) = (axis::servo(), motor());
    let now = Measurement {
        position: 1e-4,
        motor_speed: 60.0,
        current: dq(-0.4, 3.0),
    };
    let input = |measurement| ServoInput {
        measurement,
        reference: ServoReference {
            position: 1.2e-4,
            motor_speed: 61.0,
        },
        ..ServoInput::default()
    };
    let point = OperatingPoint {
        id_ref: -1.0,
        voltage_limit: 300.0,
    };
    let (mut plain, mut added) = (ServoState::default(), ServoState::default());
    let without = servo.cycle_with(&mut plain, &input(now), &point);
    let law = Decoupling::new(m, DecouplingCurrent::Measured);
    let with = servo.cycle_decoupled(&mut added, &input(now), &point, &law);
    assert_eq!(
        (with.speed_ref, with.iq_ref),
        (without.speed_ref, without.iq_ref)
    );
    let difference = with.voltage - without.voltage;
    let expected = m.rotational_voltage(now.current, 60.0);
    assert!((difference - expected).dot(difference - expected).sqrt() < 1e-12);
    assert!(!with.saturated.voltage_d && !with.saturated.voltage_q);
    assert_eq!((plain.d, plain.q), (added.d, added.q));

    // A speed that is no number costs its own period only.
    let lost = Measurement {
        motor_speed: f64::NAN,
        ..now
    };
    let broken = servo.cycle_decoupled(&mut added, &input(lost), &point, &law);
    assert!(broken.voltage.d.is_nan());
    let sound = servo.cycle_decoupled(&mut added, &input(now), &point, &law);
    assert!(sound.voltage.d.is_finite() && sound.voltage.q.is_finite());
    let fast = Measurement {
        motor_speed: RATED_SPEED * 3.0,
        ..now
    };
    let limited = servo.cycle_decoupled(&mut added, &input(fast), &point, &law);
    assert!(limited.voltage.dot(limited.voltage).sqrt() <= 300.0 * (1.0 + 1e-12));
}
