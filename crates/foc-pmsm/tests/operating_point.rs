//! A d current reference and a voltage limit in each cycle.

use crate::axis::rigid::Rigid;
use crate::axis::{
    PERIOD, cast, drawn_gains, drawn_period, gains, limits, log_uniform, motor, servo,
};
use axis_scalar::Scalar;
use foc_pmsm::{
    Dq, Measurement, OperatingPoint, ServoCorrection, ServoInput, ServoLimits, ServoReference,
    ServoState,
};
use proptest::prelude::*;

fn point(id_ref: f64, voltage_limit: f64) -> OperatingPoint {
    OperatingPoint {
        id_ref,
        voltage_limit,
    }
}

#[test]
fn the_d_reference_takes_its_share_of_the_current() {
    let servo = servo();
    let m = Measurement::default();
    let c = ServoCorrection {
        iq: 40.0,
        ..ServoCorrection::default()
    };
    let run = |at| {
        let mut state = ServoState::default();
        servo.cycle_with(
            &mut state,
            &ServoInput {
                measurement: m,
                correction: c,
                ..ServoInput::default()
            },
            &at,
        )
    };
    // 15² = 9² + 12².
    let weak = run(point(-9.0, f64::INFINITY));
    assert!(weak.saturated.current && weak.iq_ref == 12.0);
    // The d controller sees the reference: P e + I e T.
    assert!((weak.voltage.d + 9.0 * (2.776 + 626.2e-4)).abs() < 1e-14);
    // More than the limit is the limit, and leaves nothing.
    for id in [-16.0, 16.0, f64::NEG_INFINITY] {
        let all = run(point(id, f64::INFINITY));
        assert!(all.iq_ref == 0.0 && all.saturated.current, "{id}");
    }
    let only_d = servo.cycle_with(
        &mut ServoState::default(),
        &ServoInput {
            measurement: m,
            ..ServoInput::default()
        },
        &point(-16.0, f64::INFINITY),
    );
    assert!(only_d.saturated.current);
    assert!(run(point(f64::NAN, f64::INFINITY)).voltage.d.is_nan());
}

#[test]
fn the_dc_link_limits_linear_modulation() {
    let at = OperatingPoint::at_dc_voltage(300.0);
    assert_eq!(at.id_ref, 0.0);
    assert!((at.voltage_limit - 300.0 / 3f64.sqrt()).abs() < 1e-13);
    let servo = servo();
    let own = limits().voltage;
    assert_eq!(servo.available_voltage(at.voltage_limit), at.voltage_limit);
    for none in [1e3, f64::INFINITY, f64::NAN] {
        assert_eq!(servo.available_voltage(none), own);
    }
    assert_eq!(servo.available_voltage(-1.0), 0.0);
    // A link that is down leaves no voltage at all.
    let error = Dq { d: 3.0, q: 5.0 };
    let (u, d, q) =
        servo.current_loop_within(&mut ServoState::default(), error, Dq::ZERO, -f64::INFINITY);
    assert!(u == Dq::ZERO && d && q);
}

/// The mains fail for 50 ms in a fast motion: the voltage keeps to what the
/// link has, and afterwards the axis is as if nothing had been.
#[test]
fn a_sagging_dc_link_is_ridden_through() {
    let (servo, velocity) = (servo(), 0.3);
    let mut drive = Rigid::table(motor());
    let mut state = ServoState::default();
    let mut limited = 0;
    for k in 0..30_000 {
        let t = f64::from(k) * PERIOD;
        let r = ServoReference {
            position: velocity * t,
            motor_speed: velocity / drive.radius,
        };
        let sag = (10_000..10_500).contains(&k);
        // Turning at 188 rad/s induces 206 V.
        let dc_voltage = if sag { 320.0 } else { 540.0 };
        let at = OperatingPoint::at_dc_voltage(dc_voltage);
        let m = drive.measure();
        let command = servo.cycle_with(
            &mut state,
            &ServoInput {
                measurement: m,
                reference: r,
                ..ServoInput::default()
            },
            &at,
        );
        let length = command.voltage.dot(command.voltage).sqrt();
        assert!(length <= at.voltage_limit * (1.0 + 1e-15));
        limited += i32::from(sag && command.saturated.voltage_q);
        drive.advance(command.voltage, 5.0, PERIOD);
    }
    assert!(limited > 100, "{limited}"); // all 500 measured
    let error = velocity * 3.0 - drive.radius * drive.angle;
    assert!(error.abs() < 2e-12, "{error} m"); // 2.4e-13 m measured
}

fn default_changes_nothing<T: Scalar>(
    servo: &foc_pmsm::Servo<T>,
    inputs: &[[f64; 4]],
) -> Result<(), TestCaseError> {
    let (mut a, mut b) = (ServoState::default(), ServoState::default());
    for &[position, speed, id, iq] in inputs {
        let m = Measurement {
            position: T::of(position),
            motor_speed: T::of(speed),
            current: cast::dq(Dq { d: id, q: iq }),
        };
        let (r, c) = (ServoReference::default(), ServoCorrection::default());
        let one = servo.cycle(
            &mut a,
            &ServoInput {
                measurement: m,
                reference: r,
                correction: c,
            },
        );
        let two = servo.cycle_with(
            &mut b,
            &ServoInput {
                measurement: m,
                reference: r,
                correction: c,
            },
            &OperatingPoint::default(),
        );
        prop_assert_eq!((one, a), (two, b));
    }
    Ok(())
}

fn limits_hold<T: Scalar>(
    servo: &foc_pmsm::Servo<T>,
    at: [f64; 2],
    inputs: &[[f64; 4]],
) -> Result<(), TestCaseError> {
    let at = OperatingPoint {
        id_ref: T::of(at[0]),
        voltage_limit: T::of(at[1]),
    };
    let room = T::ONE + T::of(4.0) * T::EPSILON;
    let most = servo.limits().current;
    let id = at.id_ref.max(-most).min(most);
    let mut state = ServoState::default();
    for &[position, speed, d, q] in inputs {
        let m = Measurement {
            position: T::of(position),
            motor_speed: T::of(speed),
            current: cast::dq(Dq { d, q }),
        };
        let (r, c) = (ServoReference::default(), ServoCorrection::default());
        let command = servo.cycle_with(
            &mut state,
            &ServoInput {
                measurement: m,
                reference: r,
                correction: c,
            },
            &at,
        );
        let i = Dq {
            d: id,
            q: command.iq_ref,
        };
        prop_assert!(i.dot(i).sqrt() <= most * room);
        let u = command.voltage;
        prop_assert!(u.dot(u).sqrt() <= servo.available_voltage(at.voltage_limit) * room);
    }
    Ok(())
}

fn inputs() -> impl Strategy<Value = Vec<[f64; 4]>> {
    let one = [-1.0..1.0, -500.0..500.0, -50.0..50.0, -50.0..50.0];
    prop::collection::vec(one, 1..30)
}

proptest! {
    #[test]
    fn without_a_point_the_bits_are_those_of_a_cycle(
        gains in drawn_gains(), period in drawn_period(), current in log_uniform(0.1, 1e3),
        voltage in log_uniform(1.0, 1e3), inputs in inputs(),
    ) {
        let limits = ServoLimits { current, voltage };
        default_changes_nothing(&cast::servo::<f64>(&gains, &limits, period).unwrap(), &inputs)?;
        default_changes_nothing(&cast::servo::<f32>(&gains, &limits, period).unwrap(), &inputs)?;
    }

    #[test]
    fn both_lengths_keep_their_limits(
        gains in drawn_gains(), period in drawn_period(), current in log_uniform(0.1, 1e3),
        voltage in log_uniform(1.0, 1e3), id in -2e3..2e3, share in 0.0..2.0, inputs in inputs(),
    ) {
        let limits = ServoLimits { current, voltage };
        let at = [id, share * voltage];
        limits_hold(&cast::servo::<f64>(&gains, &limits, period).unwrap(), at, &inputs)?;
        limits_hold(&cast::servo::<f32>(&gains, &limits, period).unwrap(), at, &inputs)?;
    }
}

/// Without limits nothing is limited, in the greatest numbers either.
#[test]
fn no_limit_is_none() {
    let none = ServoLimits {
        current: f64::INFINITY,
        voltage: f64::INFINITY,
    };
    let free = cast::servo::<f64>(&gains(), &none, PERIOD).unwrap();
    for id in [0.0, -5.0, 1e200] {
        assert_eq!(free.q_current_limit(id), f64::INFINITY);
    }
    let huge = ServoLimits {
        current: 1e300,
        ..limits()
    };
    let huge = cast::servo::<f64>(&gains(), &huge, PERIOD).unwrap();
    assert_eq!(huge.q_current_limit(0.0), 1e300);
    assert_eq!(servo().q_current_limit(-9.0), 12.0);
    assert_eq!(servo().q_current_limit(99.0), 0.0);
}
