//! The linear motor: metres and newtons.

use crate::axis::log_uniform;
use foc_pmsm::{
    Dq, FocError, LinearMotor, LinearMotorParameters, OperatingLimits, OperatingRegion,
};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn parameters() -> LinearMotorParameters {
    LinearMotorParameters {
        pole_pitch: 0.016,
        resistance: 2.6,
        inductance_d: 13e-3,
        inductance_q: 15e-3,
        flux_linkage: 0.0,
    }
    .from_force_constant(68.0)
}

proptest! {
    /// Electrical power = losses + change of the field's energy + force times velocity
    /// over a step, which has no force in it, to rounding.
    #[test]
    fn the_force_closes_the_power_balance(
        pitch in log_uniform(5e-3, 0.1), d in -50.0..50.0, q in -50.0..50.0,
        ud in -500.0..500.0, uq in -500.0..500.0, velocity in -10.0..10.0,
        h in log_uniform(1e-6, 1e-2),
    ) {
        let m = LinearMotor::new(LinearMotorParameters { pole_pitch: pitch, ..parameters() });
        let m = m.unwrap();
        let (i0, u) = (Dq { d, q }, Dq { d: ud, q: uq });
        let i1 = m.step(i0, u, velocity, h);
        let mean = (i0 + i1) * 0.5;
        let inner = m.motor();
        let stored = inner.magnetic_energy(i1) - inner.magnetic_energy(i0);
        let lost = h * inner.copper_loss(mean);
        let work = h * m.force(mean) * velocity;
        let supplied = h * 1.5 * u.dot(mean);
        let parts = inner.magnetic_energy(i0) + inner.magnetic_energy(i1) + lost
            + work.abs() + h * 1.5 * (ud.abs() + uq.abs()) * (mean.d.abs() + mean.q.abs());
        let reactive = m.rotational_voltage(mean, velocity);
        let parts = parts + h * 1.5 * (reactive.d * mean.d).abs();
        // 9.2e-16 measured.
        let error = (supplied - lost - stored - work).abs() / parts;
        prop_assert!(error < 4e-15, "{}", error);
    }

    /// Two pole pitches are a turn, and the angle is the integral of the speed.
    #[test]
    fn the_angle_turns_with_the_position(x in -3.0..3.0, pitch in log_uniform(5e-3, 0.1)) {
        let m = LinearMotor::new(LinearMotorParameters { pole_pitch: pitch, ..parameters() });
        let m = m.unwrap();
        let angle = m.electrical_angle(x);
        prop_assert!((0.0..=TAU).contains(&angle));
        let turned = m.electrical_angle(x + 0.25 * pitch) - angle;
        let error = (turned - 0.25 * PI + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
        prop_assert!(error.abs() < 1e-11, "{}", error);
        let by_speed = m.electrical_speed(0.25 * pitch);
        prop_assert!((by_speed - 0.25 * PI).abs() < 1e-14);
    }
}

#[test]
fn constants_by_hand() {
    let m = LinearMotor::new(parameters()).unwrap();
    // ψ = 68 · 0.016/(1.5 π).
    assert!((m.parameters().flux_linkage - 0.230_880_770_8).abs() < 1e-9);
    assert!((m.force(Dq { d: 0.0, q: 3.0 }) - 204.0).abs() < 1e-11);
    assert!((m.q_current(204.0) - 3.0).abs() < 1e-13);
    // Reluctance: 1.5 π/τ (L_d − L_q) i_d i_q = 1.5 · 196.35 · −2e-3 · −2 · 3.
    let more = m.force(Dq { d: -2.0, q: 3.0 }) - 204.0;
    assert!((more - 3.534_291_735_3).abs() < 1e-8);
    let u = m.steady_voltage(Dq { d: 0.0, q: 3.0 }, 2.0);
    let omega = PI * 2.0 / 0.016;
    assert!((u.d + omega * 15e-3 * 3.0).abs() < 1e-12);
    assert!((u.q - 2.6 * 3.0 - 68.0 * 2.0 / 1.5).abs() < 1e-12);
}

/// The currents of a force within the limits, and what is refused.
#[test]
fn operating_points_and_errors() {
    let m = LinearMotor::new(parameters()).unwrap();
    let limits = OperatingLimits {
        current: 12.0,
        voltage: 180.0,
    };
    let slow = m.operating_currents(-300.0, 0.5, &limits);
    assert_eq!(slow.region, OperatingRegion::Mtpa);
    assert!((slow.force + 300.0).abs() < 1e-10 && slow.current.q < 0.0);
    let fast = m.operating_currents(300.0, 4.0, &limits);
    assert_eq!(fast.region, OperatingRegion::FieldWeakening);
    assert!((fast.force - 300.0).abs() < 1e-9 && (m.force(fast.current) - 300.0).abs() < 1e-9);
    let u = m.steady_voltage(fast.current, 4.0);
    assert!((u.d.hypot(u.q) - 180.0).abs() < 1e-9);
    for pole_pitch in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let error = LinearMotor::new(LinearMotorParameters {
            pole_pitch,
            ..parameters()
        });
        let Err(FocError::OutOfRange { field, .. }) = error else {
            panic!("{error:?}");
        };
        assert_eq!(field, "pole_pitch");
    }
    let none = LinearMotorParameters {
        flux_linkage: 0.0,
        ..parameters()
    };
    assert!(LinearMotor::new(none).is_err());
    assert!(
        m.electrical_angle(f64::NAN).is_nan()
            && m.force(Dq {
                d: f64::NAN,
                q: 1.0
            })
            .is_nan()
    );
}
