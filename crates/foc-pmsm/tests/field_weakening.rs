//! Field weakening: above base speed the drive keeps following, below it
//! nothing changes.

use crate::axis::rigid::Rigid;
use crate::axis::{PERIOD, cast, drawn_current_loop, gains, limits, motor};
use axis_scalar::Scalar;
use foc_pmsm::{
    Dq, FieldWeakening, FieldWeakeningParameters, FieldWeakeningState, FocError, Measurement,
    MotorParameters, OperatingPoint, Pmsm, Servo, ServoCommand, ServoCorrection, ServoGains,
    ServoInput, ServoLimits, ServoReference, ServoState,
};
use proptest::prelude::*;

fn parameters() -> FieldWeakeningParameters {
    FieldWeakeningParameters {
        voltage_share: 0.95,
        // 60 1/s at 1280 rad/s electrical: K_f ω_e L_d.
        ki: 11.4,
        current: 13.0,
        period: PERIOD,
    }
}

/// The speed control of a spindle: no position loop.
fn spindle(limits: &ServoLimits) -> Servo {
    let gains = ServoGains {
        position: 0.0,
        ..gains()
    };
    cast::servo(&gains, limits, PERIOD).unwrap()
}

/// A voltage that is no number costs its own cycle: the next reference is that of a
/// law that has passed over it.
#[test]
fn a_voltage_that_is_no_number_does_not_stay() {
    let law = FieldWeakening::new(parameters()).unwrap();
    let most = 312.0;
    let q = |q| Dq { d: 0.0, q };
    let mut sound = FieldWeakeningState::default();
    law.update(&mut sound, q(most), most);
    let mut state = sound;
    assert!(sound.id_ref < 0.0);
    assert!(law.update(&mut state, q(f64::NAN), most).is_nan());
    assert!(law.update(&mut state, q(most), f64::NAN).is_nan());
    assert_eq!(state, sound);
    let next = law.update(&mut sound, q(most), most);
    assert_eq!(law.update(&mut state, q(most), most), next);
}

/// The same of the whole cascade, by each of its measurements, references and
/// corrections.
#[test]
fn a_measurement_that_is_no_number_does_not_stay_in_the_cascade() {
    let servo = cast::servo(&gains(), &limits(), PERIOD).unwrap();
    for place in 0..9 {
        let mut numbers = [1e-6, 0.3, 0.2, -0.1, 2e-6, 0.31, 1e-7, 0.01, 0.02];
        let cycle = |numbers: [f64; 9], state: &mut ServoState| {
            let [position, motor_speed, d, q, p_ref, v_ref, offset, speed, iq] = numbers;
            let m = Measurement {
                position,
                motor_speed,
                current: Dq { d, q },
            };
            let r = ServoReference {
                position: p_ref,
                motor_speed: v_ref,
            };
            let c = ServoCorrection {
                position_offset: offset,
                speed,
                iq,
            };
            servo.cycle(
                state,
                &ServoInput {
                    measurement: m,
                    reference: r,
                    correction: c,
                },
            )
        };
        let mut state = ServoState::settled(0.5, Dq { d: 1.0, q: 20.0 });
        let good = numbers;
        numbers[place] = f64::NAN;
        let bad = cycle(numbers, &mut state);
        assert!(bad.voltage.d.is_nan() || bad.voltage.q.is_nan(), "{place}");
        let next = cycle(good, &mut state);
        assert!(
            next.voltage.d.is_finite() && next.voltage.q.is_finite(),
            "{place}"
        );
    }
}

struct Sample {
    command: ServoCommand,
    speed: f64,
    reference: f64,
    current: Dq,
    id_ref: f64,
}

/// Speed-up with 500 rad/s², 1 s at `top` (rad/s), down to 100 rad/s and 1 s
/// there, against 2 N·m.
fn run(top: f64, limits: &ServoLimits, law: Option<FieldWeakening>) -> Vec<Sample> {
    let (servo, mut drive) = (spindle(limits), Rigid::table(motor()));
    let (mut state, mut field) = (ServoState::default(), FieldWeakeningState::default());
    let (up, down) = (top / 500.0, (top - 100.0) / 500.0);
    let cycles = ((up + down + 2.0) / PERIOD) as u32;
    let cycle = |k| {
        let t = f64::from(k) * PERIOD;
        let slow_down = (t - up - 1.0).max(0.0);
        let reference = (500.0 * t).min((top - 500.0 * slow_down).max(100.0).min(top));
        let r = ServoReference {
            position: 0.0,
            motor_speed: reference,
        };
        let (m, c) = (drive.measure(), ServoCorrection::default());
        let command = match &law {
            None => servo.cycle(
                &mut state,
                &ServoInput {
                    measurement: m,
                    reference: r,
                    correction: c,
                },
            ),
            Some(law) => {
                let at = OperatingPoint {
                    id_ref: field.id_ref,
                    ..OperatingPoint::default()
                };
                let command = servo.cycle_with(
                    &mut state,
                    &ServoInput {
                        measurement: m,
                        reference: r,
                        correction: c,
                    },
                    &at,
                );
                let most = servo.available_voltage(at.voltage_limit);
                law.update(&mut field, command.voltage, most);
                command
            }
        };
        let sample = Sample {
            command,
            speed: drive.speed,
            reference,
            current: drive.current,
            id_ref: field.id_ref,
        };
        drive.advance(command.voltage, 2.0, PERIOD);
        sample
    };
    (0..cycles).map(cycle).collect()
}

/// 320 rad/s induce 350 V of 312 V.
const TOP: f64 = 320.0;

fn length(x: Dq) -> f64 {
    x.dot(x).sqrt()
}

#[test]
fn above_base_speed_the_motor_keeps_following() {
    let law = FieldWeakening::new(parameters()).unwrap();
    let (plain, weakened) = (run(TOP, &limits(), None), run(TOP, &limits(), Some(law)));
    let at_top = (TOP / 500.0 + 1.0) / PERIOD;
    let (before, after) = (&plain[at_top as usize - 1], &weakened[at_top as usize - 1]);

    // Without: no voltage is left, and the speed stays where it induces it all.
    assert!(before.command.saturated.voltage_q);
    assert!(before.speed < 0.92 * TOP, "{}", before.speed);
    // With: the speed is that asked for, in the voltage aimed at. Measured:
    // 2.0e-4 rad/s and 3.5e-6 of the voltage.
    assert!(!after.command.saturated.voltage_q);
    assert!((after.speed - TOP).abs() < 1e-3, "{}", after.speed);
    let aim = 0.95 * limits().voltage;
    assert!((length(after.command.voltage) - aim).abs() < 3e-5 * aim);
    // i_d from u = k U: ω_e (ψ + L_d i_d) ≈ √((k U)² − (ω_e L_q i_q)²).
    assert!(
        (-10.6..-10.5).contains(&after.current.d),
        "{:?}",
        after.current
    );

    let worst = |run: &[Sample]| {
        let errors = run.iter().map(|s| (s.speed - s.reference).abs());
        errors.fold(0.0, f64::max)
    };
    let ample = ServoLimits {
        voltage: 1e3,
        ..limits()
    };
    let (free, with, without) = (
        worst(&run(TOP, &ample, None)),
        worst(&weakened),
        worst(&plain),
    );
    // 4.6 rad/s where the acceleration sets in, with and without a limit; 40
    // without the law.
    assert!((with - free).abs() < 1e-9, "{with} {free}");
    assert!(without > 8.0 * free, "{without}");
    for s in &weakened {
        assert!((-13.0..=0.0).contains(&s.id_ref));
        assert!(s.command.iq_ref.hypot(s.id_ref) <= 15.0 + 1e-14);
    }
    // Back below base speed there is no d current left: 1.5e-7 A measured, and
    // 4.6e-5 rad/s.
    let last = &weakened[weakened.len() - 1];
    assert!(last.id_ref == 0.0 && last.current.d.abs() < 1e-6);
    assert!((last.speed - 100.0).abs() < 4e-4);
}

#[test]
fn below_base_speed_the_bits_are_those_without() {
    let law = FieldWeakening::new(parameters()).unwrap();
    let (plain, weakened) = (
        run(240.0, &limits(), None),
        run(240.0, &limits(), Some(law)),
    );
    for (a, b) in plain.iter().zip(&weakened) {
        assert_eq!(a.command, b.command);
        assert_eq!(b.id_ref.to_bits(), 0.0_f64.to_bits());
        assert_eq!(a.speed.to_bits(), b.speed.to_bits());
    }
}

#[test]
fn validation_names_the_field_and_nan_passes() {
    let good = parameters();
    let field = |p| match FieldWeakening::new(p) {
        Err(FocError::OutOfRange { field, .. }) => field,
        other => panic!("{other:?}"),
    };
    for voltage_share in [0.0, 1.0, f64::NAN] {
        let bad = FieldWeakeningParameters {
            voltage_share,
            ..good
        };
        assert_eq!(field(bad), "voltage_share");
    }
    for bad in [0.0, -1.0, f64::INFINITY, f64::NAN] {
        assert_eq!(field(FieldWeakeningParameters { ki: bad, ..good }), "ki");
        let current = FieldWeakeningParameters {
            current: bad,
            ..good
        };
        assert_eq!(field(current), "current");
        let period = FieldWeakeningParameters {
            period: bad,
            ..good
        };
        assert_eq!(field(period), "period");
    }
    let law = FieldWeakening::new(good).unwrap();
    let mut state = FieldWeakeningState::default();
    let nan = Dq {
        d: f64::NAN,
        q: 0.0,
    };
    assert!(law.update(&mut state, nan, 300.0).is_nan());
}

/// A motor turned at constant speed, without torque, on a link that has
/// 1/`over` of what it induces: |u|/U, and i_d, in the end.
fn settle<T: Scalar>(
    motor: &Pmsm,
    gains: &ServoGains,
    period: f64,
    omega: f64,
    over: f64,
) -> [f64; 3] {
    let p = *motor.parameters();
    let voltage = omega * p.flux_linkage / over;
    let limits = ServoLimits {
        current: f64::INFINITY,
        voltage,
    };
    let servo = cast::servo::<T>(gains, &limits, period).unwrap();
    let bandwidth = gains.d_p / p.inductance_d;
    let law = FieldWeakening::new(FieldWeakeningParameters {
        voltage_share: T::of(0.95),
        ki: T::of(bandwidth / 20.0 / (omega * p.inductance_d)),
        current: T::of(p.flux_linkage / p.inductance_d),
        period: T::of(period),
    })
    .unwrap();
    let speed = T::of(omega / f64::from(p.pole_pairs));
    let motor = cast::motor::<T>(motor);
    let (mut state, mut field) = (ServoState::default(), FieldWeakeningState::default());
    let (mut i, mut u) = (Dq::ZERO, Dq::ZERO);
    for _ in 0..(1500.0 / (bandwidth * period)) as u32 {
        let reference = Dq {
            d: field.id_ref,
            q: T::ZERO,
        };
        (u, _, _) = servo.current_loop(&mut state, reference - i, Dq::ZERO);
        law.update(&mut field, u, servo.limits().voltage);
        i = motor.step(i, u, speed, servo.period());
    }
    let (u, i) = (cast::widened(u), cast::widened(i));
    [length(u) / voltage, i.d, i.q]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Any motor of little resistance, in either scalar: above base speed the
    /// voltage settles at the share aimed at, below it i_d is 0.
    #[test]
    fn the_voltage_settles_at_its_share(
        plant in drawn_current_loop(), turn in 0.05..0.2, over in 0.7..1.4, decay in 0.0..0.05,
    ) {
        let omega = turn * plant.bandwidth;
        let p = *plant.motor.parameters();
        let resistance = decay * omega * p.inductance_d.min(p.inductance_q);
        let motor = Pmsm::new(MotorParameters { resistance, ..p }).unwrap();
        let largest = p.flux_linkage / p.inductance_d;
        let f64s = settle::<f64>(&motor, &plant.gains, plant.period, omega, over);
        let f32s = settle::<f32>(&motor, &plant.gains, plant.period, omega, over);
        // Measured: 1.8e-14 and 9.4e-6.
        for ([share, id, iq], rounding) in [(f64s, 1e-13), (f32s, 5e-5)] {
            prop_assert!(iq.abs() < rounding * largest, "{}", iq / largest);
            if over < 0.94 {
                prop_assert!(id.abs() < rounding * largest);
            } else if over > 0.96 {
                prop_assert!((share - 0.95).abs() < rounding, "{}", share);
                prop_assert!(id < 0.0);
            }
        }
    }
}
