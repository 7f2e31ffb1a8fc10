//! The motor: torque from the power balance, steps, validation.

use crate::axis::{RATED_SPEED, TORQUE_CONSTANT, drawn_motor, log_uniform, motor};
use foc_pmsm::{Dq, FocError, MotorParameters, Pmsm};
use proptest::prelude::*;

fn dq(d: f64, q: f64) -> Dq {
    Dq { d, q }
}

fn distance(a: Dq, b: Dq) -> f64 {
    (a.d - b.d).hypot(a.q - b.q)
}

#[test]
fn torque_constant_is_torque_per_ampere() {
    assert!((motor().torque(dq(0.0, 1.0)) - TORQUE_CONSTANT).abs() < 1e-15);
    assert!((motor().q_current(24.0) - 24.0 / TORQUE_CONSTANT).abs() < 1e-14);
}

/// At standstill each axis is an RL circuit: i = u/R (1 − e^(−Rt/L)).
#[test]
fn standstill_is_two_rl_circuits() {
    let p = *motor().parameters();
    for h in [1e-6, 1e-4, 1e-2, 1.0] {
        let i = motor().step_exact(Dq::ZERO, dq(3.0, 6.0), 0.0, h);
        let rise = |u: f64, l: f64| -u / p.resistance * (-h * p.resistance / l).exp_m1();
        // Of up to 8 A; 2.7e-15 A measured.
        assert!((i.d - rise(3.0, p.inductance_d)).abs() < 2e-14);
        assert!((i.q - rise(6.0, p.inductance_q)).abs() < 2e-14);
    }
}

/// Without resistance the stator flux linkage of a short-circuited motor
/// stands still in the stator: in dq it turns backwards by p ω h.
#[test]
fn short_circuit_without_resistance_keeps_the_flux() {
    let p = MotorParameters {
        resistance: 0.0,
        ..*motor().parameters()
    };
    let free = Pmsm::new(p).unwrap();
    let flux = |i: Dq| dq(p.inductance_d * i.d + p.flux_linkage, p.inductance_q * i.q);
    for h in [1e-4, 1e-3, 0.05] {
        let end = flux(free.step_exact(dq(1.0, 2.0), Dq::ZERO, RATED_SPEED, h));
        let angle = free.electrical_speed(RATED_SPEED) * h;
        let expected = flux(dq(1.0, 2.0)).inverse_park(0.0).park(angle);
        // Up to 42 rad through seven squarings: 3.7e-15 of 0.27 V·s measured.
        assert!(distance(end, expected) < 3e-14);
    }
}

/// Halving the step of the midpoint rule quarters its error at equal time.
#[test]
fn midpoint_step_is_second_order() {
    let m = motor();
    let (i0, u, t) = (dq(1.0, -2.0), dq(20.0, 120.0), 4e-3);
    let exact = m.step_exact(i0, u, 150.0, t);
    let error = |n: i32| {
        let h = t / f64::from(n);
        let end = (0..n).fold(i0, |i, _| m.step(i, u, 150.0, h));
        distance(end, exact)
    };
    for n in [20, 40, 80, 160] {
        let order = (error(n) / error(2 * n)).log2();
        // The next term of the error is h² smaller: at n = 20 (ω_e h = 0.12)
        // it shifts the order by 0.0018.
        assert!((order - 2.0).abs() < 0.01, "n {n}: order {order}");
    }
}

#[test]
fn steps_of_any_length_are_stable() {
    let m = motor();
    let steady = dq(-1.0, 4.0);
    let u = m.steady_voltage(steady, RATED_SPEED);
    for h in [1e-3, 1.0, 1e6] {
        let mut i = dq(50.0, -50.0);
        let far = flux_norm(&m, i, steady);
        for _ in 0..1000 {
            let next = m.step(i, u, RATED_SPEED, h);
            // Rounding: 2.2e-17 V·s measured.
            assert!(flux_norm(&m, next, steady) <= flux_norm(&m, i, steady) + 2e-16);
            i = next;
        }
        assert!(flux_norm(&m, i, steady) < far);
    }
}

/// The flux linkage of a − b: the norm in which the rotation is a rotation.
fn flux_norm(m: &Pmsm, a: Dq, b: Dq) -> f64 {
    let p = m.parameters();
    let difference = a - b;
    (p.inductance_d * difference.d).hypot(p.inductance_q * difference.q)
}

fn current() -> impl Strategy<Value = f64> {
    -200.0..200.0
}

fn voltage() -> impl Strategy<Value = f64> {
    -1000.0..1000.0
}

/// Electrical, rad/s.
fn electrical_speed() -> impl Strategy<Value = f64> {
    -5000.0..5000.0
}

/// The powers, W, that the terms of the voltage equations turn over: what a
/// balance of them may round by.
fn turnover(m: &Pmsm, i: Dq, u: Dq, speed: f64) -> f64 {
    let p = m.parameters();
    let flux = p.inductance_d * i.d.abs() + p.inductance_q * i.q.abs() + p.flux_linkage;
    let currents = i.d.abs() + i.q.abs();
    let induced = m.electrical_speed(speed).abs() * flux;
    1.5 * currents * (u.d.abs() + u.q.abs() + p.resistance * currents + induced)
}

proptest! {
    /// Electrical power = copper loss + d(magnetic energy)/dt + T ω. The
    /// torque equation follows from the voltage equations; it is not used in
    /// the left-hand side.
    #[test]
    fn torque_closes_the_power_balance(
        m in drawn_motor(), id in current(), iq in current(), ud in voltage(), uq in voltage(),
        electrical in electrical_speed(),
    ) {
        let p = *m.parameters();
        let speed = electrical / f64::from(p.pole_pairs);
        let (i, u) = (dq(id, iq), dq(ud, uq));
        let rate = m.derivative(i, u, speed);
        let stored = 1.5 * (p.inductance_d * id * rate.d + p.inductance_q * iq * rate.q);
        let mechanical = 1.5 * u.dot(i) - m.copper_loss(i) - stored;
        let error = (mechanical - m.torque(i) * speed).abs() / turnover(&m, i, u, speed);
        // 4.0e-16 measured.
        prop_assert!(error < 2e-15, "{}", error);
    }

    /// The same balance over a whole midpoint step, without discretisation
    /// error, for steps from 1 µs to 10 ms.
    #[test]
    fn midpoint_step_closes_the_energy_balance(
        m in drawn_motor(), id in current(), iq in current(), ud in voltage(), uq in voltage(),
        electrical in electrical_speed(), h in log_uniform(1e-6, 1e-2),
    ) {
        let speed = electrical / f64::from(m.parameters().pole_pairs);
        let (i0, u) = (dq(id, iq), dq(ud, uq));
        let i1 = m.step(i0, u, speed, h);
        let mean = (i0 + i1) * 0.5;
        let supplied = h * 1.5 * u.dot(mean);
        let stored = m.magnetic_energy(i1) - m.magnetic_energy(i0);
        let used = h * m.copper_loss(mean) + stored + h * m.torque(mean) * speed;
        let scale = m.magnetic_energy(i0) + m.magnetic_energy(i1)
            + h * turnover(&m, i0, u, speed) + h * turnover(&m, i1, u, speed);
        let error = (supplied - used).abs() / scale;
        // 2.6e-16 measured.
        prop_assert!(error < 2e-15, "{}", error);
    }

    #[test]
    fn steady_voltage_holds_the_current(
        m in drawn_motor(), id in current(), iq in current(), speed in -400.0..400.0,
        h in log_uniform(1e-6, 1.0),
    ) {
        let i = dq(id, iq);
        let u = m.steady_voltage(i, speed);
        prop_assert_eq!(m.derivative(i, u, speed), Dq::ZERO);
        prop_assert_eq!(m.step(i, u, speed, h), i);
        prop_assert_eq!(m.step_exact(i, u, speed, h), i);
    }

    /// Two exact half steps are one whole one, for steps that turn the rotor
    /// or decay by up to 100.
    #[test]
    fn exact_steps_compose(
        m in drawn_motor(), id in current(), iq in current(), ud in voltage(), uq in voltage(),
        electrical in electrical_speed(), share in log_uniform(1e-6, 1.0),
    ) {
        let p = *m.parameters();
        let speed = electrical / f64::from(p.pole_pairs);
        let fastest = p.resistance / p.inductance_d.min(p.inductance_q);
        let h = 100.0 * share / (fastest + electrical.abs());
        let (i, u) = (dq(id, iq), dq(ud, uq));
        let half = m.step_exact(i, u, speed, h / 2.0);
        let twice = m.step_exact(half, u, speed, h / 2.0);
        let whole = m.step_exact(i, u, speed, h);
        let change = distance(half, i) + distance(twice, half);
        let error = distance(twice, whole) / (distance(i, Dq::ZERO) + change);
        // 4.8e-15 measured.
        prop_assert!(error < 4e-14, "{}", error);
    }
}

#[test]
fn validation_names_the_field() {
    let good = *motor().parameters();
    let field = |p: MotorParameters| match Pmsm::new(p) {
        Err(FocError::OutOfRange { field, .. }) => field,
        other => panic!("{other:?}"),
    };
    assert_eq!(
        field(MotorParameters {
            resistance: -0.1,
            ..good
        }),
        "resistance"
    );
    assert_eq!(
        field(MotorParameters {
            inductance_d: 0.0,
            ..good
        }),
        "inductance_d"
    );
    assert_eq!(
        field(MotorParameters {
            inductance_q: f64::NAN,
            ..good
        }),
        "inductance_q"
    );
    assert_eq!(
        field(MotorParameters {
            flux_linkage: f64::INFINITY,
            ..good
        }),
        "flux_linkage"
    );
    let none = Pmsm::new(MotorParameters {
        pole_pairs: 0,
        ..good
    });
    assert_eq!(none, Err(FocError::NoPolePairs));
    let message = Pmsm::new(MotorParameters {
        inductance_d: -1.0,
        ..good
    })
    .unwrap_err()
    .to_string();
    assert_eq!(
        message,
        "inductance_d = -1 is not valid: must be finite, greater than 0 and not subnormal"
    );
}

#[test]
fn nan_is_not_hidden() {
    let m = motor();
    assert!(m.step(Dq::ZERO, dq(f64::NAN, 0.0), 1.0, 1e-4).q.is_nan());
    assert!(
        m.step_exact(Dq::ZERO, dq(1.0, 0.0), f64::INFINITY, 1e-4)
            .d
            .is_nan()
    );
}
