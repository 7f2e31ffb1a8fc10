//! The calls inside a control cycle, in both scalars, and inside an
//! integration step. Inputs change from call to call through the state, as in
//! a simulation: the times are latencies, not throughputs.

use axis_scalar::Scalar;
use core::f64::consts::PI;
use core::hint::black_box;
use criterion::{Criterion, criterion_group, criterion_main};
use foc_pmsm::inverter::{Inverter, Rotor};
use foc_pmsm::saturation::{AlgebraicSaturation, AlgebraicSaturationParameters, FluxMap};
use foc_pmsm::sensorless::{FluxObserver, FluxObserverParameters};
use foc_pmsm::svpwm::{Overmodulation, Svpwm};
use foc_pmsm::{
    AlphaBeta, Decoupling, DecouplingCurrent, Dq, FieldWeakening, FieldWeakeningParameters,
    FieldWeakeningState, FocError, Measurement, MotorParameters, OperatingLimits, OperatingPoint,
    Pmsm, Servo, ServoCorrection, ServoGains, ServoInput, ServoLimits, ServoReference, ServoState,
};

const RPM: f64 = PI / 30.0;
const PERIOD: f64 = 1e-4;

fn motor<T: Scalar>() -> Result<Pmsm<T>, FocError> {
    let parameters = MotorParameters {
        pole_pairs: 4,
        resistance: T::of(0.75),
        inductance_d: T::of(4.11e-3),
        inductance_q: T::of(13.2e-3),
        flux_linkage: T::ZERO,
    };
    Pmsm::new(parameters.from_torque_constant(T::of(1.641)))
}

fn servo<T: Scalar>() -> Result<Servo<T>, FocError> {
    let gains = ServoGains {
        position: T::of(280.2 * RPM / 1e-3),
        speed_p: T::of(0.0678 / RPM),
        speed_i: T::of(0.7122 / RPM),
        d_p: T::of(2.776),
        d_i: T::of(626.2),
        q_p: T::of(8.805),
        q_i: T::of(1003.3),
    };
    let limits = ServoLimits {
        current: T::of(15.0),
        voltage: T::of(540.0 / 3f64.sqrt()),
    };
    Servo::new(gains, limits, T::of(PERIOD))
}

fn field_weakening<T: Scalar>() -> Result<FieldWeakening<T>, FocError> {
    FieldWeakening::new(FieldWeakeningParameters {
        voltage_share: T::of(0.95),
        ki: T::of(11.4),
        current: T::of(13.0),
        period: T::of(PERIOD),
    })
}

/// What a drive computes in a cycle, at the currents that its voltage made.
fn cycles<T: Scalar>(c: &mut Criterion, scalar: &str) -> Result<(), FocError> {
    let (servo, law) = (servo::<T>()?, field_weakening::<T>()?);
    let reference = ServoReference {
        position: T::of(1e-6),
        motor_speed: T::of(0.01),
    };
    let correction = ServoCorrection::default();
    let measured = |current| Measurement {
        position: T::ZERO,
        motor_speed: T::of(0.02),
        current,
    };
    let (mut state, mut current) = (ServoState::default(), Dq::ZERO);
    c.bench_function(&format!("servo cycle, {scalar}"), |b| {
        b.iter(|| {
            let m = measured(current);
            let command = servo.cycle(
                &mut state,
                &ServoInput {
                    measurement: m,
                    reference: *black_box(&reference),
                    correction,
                },
            );
            current = command.voltage * T::of(1e-3);
            command
        })
    });
    let (mut state, mut current) = (ServoState::default(), Dq::ZERO);
    let mut field = FieldWeakeningState::default();
    c.bench_function(&format!("cycle with field weakening, {scalar}"), |b| {
        b.iter(|| {
            let point = OperatingPoint {
                id_ref: field.id_ref,
                ..OperatingPoint::at_dc_voltage(black_box(T::of(540.0)))
            };
            let m = measured(current);
            let reference = black_box(&reference);
            let command = servo.cycle_with(
                &mut state,
                &ServoInput {
                    measurement: m,
                    reference: *reference,
                    correction,
                },
                &point,
            );
            let most = servo.available_voltage(point.voltage_limit);
            law.update(&mut field, command.voltage, most);
            current = command.voltage * T::of(1e-3);
            command
        })
    });
    let current = AlphaBeta {
        alpha: T::of(3.0),
        beta: T::of(-2.0),
    };
    c.bench_function(&format!("Park transform, {scalar}"), |b| {
        b.iter(|| black_box(current).park(black_box(T::of(2.1))))
    });
    let modulator = Svpwm::new(T::of(540.0), Overmodulation::default())?;
    let voltage = AlphaBeta {
        alpha: T::of(40.0),
        beta: T::of(90.0),
    };
    c.bench_function(&format!("SVPWM duties, {scalar}"), |b| {
        b.iter(|| modulator.duties(black_box(voltage)))
    });
    Ok(())
}

/// What a simulation of the motor computes.
fn motors<T: Scalar>(c: &mut Criterion, scalar: &str) -> Result<(), FocError> {
    let motor = motor::<T>()?;
    let u = Dq {
        d: T::of(-3.0),
        q: T::of(30.0),
    };
    let (speed, h) = (T::of(20.0), T::of(2.5e-5));
    let mut i = Dq {
        d: T::ZERO,
        q: T::of(3.0),
    };
    c.bench_function(&format!("motor step, midpoint, {scalar}"), |b| {
        b.iter(|| {
            i = motor.step(i, black_box(u), black_box(speed), black_box(h));
            i
        })
    });
    Ok(())
}

/// What a drive may compute besides.
fn additions<T: Scalar>(c: &mut Criterion, scalar: &str) -> Result<(), FocError> {
    let (motor, servo) = (motor::<T>()?, servo::<T>()?);
    let decoupling = Decoupling::new(motor, DecouplingCurrent::Measured);
    let (mut state, mut current) = (ServoState::default(), Dq::ZERO);
    let reference = ServoReference::default();
    let point = OperatingPoint::default();
    c.bench_function(&format!("decoupled cycle, {scalar}"), |b| {
        b.iter(|| {
            let input = ServoInput {
                measurement: Measurement {
                    position: T::of(1e-6),
                    motor_speed: T::of(0.02),
                    current,
                },
                reference: *black_box(&reference),
                ..ServoInput::default()
            };
            let command = servo.cycle_decoupled(&mut state, &input, &point, &decoupling);
            current = command.voltage * T::of(1e-3);
            command
        })
    });
    let limits = OperatingLimits {
        current: T::of(15.0),
        voltage: T::of(312.0),
    };
    for (name, torque, speed) in [
        ("least current", 10.0, 100.0),
        ("field weakening", 6.0, 320.0),
        ("torque beyond the limits", 30.0, 320.0),
    ] {
        let (torque, speed) = (T::of(torque), T::of(speed));
        c.bench_function(&format!("operating currents, {name}, {scalar}"), |b| {
            b.iter(|| motor.operating_currents(black_box(torque), black_box(speed), &limits))
        });
    }
    let law = FluxObserverParameters::of(&motor, T::of(100.0), T::of(PERIOD));
    let observer = FluxObserver::new(motor, law)?;
    let mut state = observer.begin(T::ZERO, T::of(300.0));
    let (i, u) = (
        Dq {
            d: T::ZERO,
            q: T::of(3.0),
        },
        Dq {
            d: T::of(-12.0),
            q: T::of(84.0),
        },
    );
    c.bench_function(&format!("flux observer, {scalar}"), |b| {
        b.iter(|| {
            let i = i.inverse_park_sin_cos(black_box(T::of(0.6)), black_box(T::of(0.8)));
            let u = u.inverse_park_sin_cos(black_box(T::of(0.6)), black_box(T::of(0.8)));
            let estimate = observer.estimate(&state, i);
            observer.advance(&mut state, &estimate, u);
            estimate
        })
    });
    let map = AlgebraicSaturation::new(AlgebraicSaturationParameters {
        self_d: [T::of(17.4), T::of(373.0)],
        self_q: [T::of(52.1), T::of(658.0)],
        cross: T::of(1120.0),
        exponents_self: [5, 1],
        exponents_cross: [1, 0],
        magnets: T::ZERO,
    })?;
    let flux = Dq {
        d: T::of(0.5),
        q: T::of(0.2),
    };
    let current = map.current(flux);
    c.bench_function(&format!("current of a saturated flux, {scalar}"), |b| {
        b.iter(|| map.current(black_box(flux)))
    });
    c.bench_function(&format!("flux of a saturated current, {scalar}"), |b| {
        b.iter(|| map.flux(black_box(current)))
    });
    Ok(())
}

/// The slow ways, for checks.
fn checks(c: &mut Criterion) -> Result<(), FocError> {
    let motor = motor::<f64>()?;
    let (i, u) = (Dq { d: -0.5, q: 3.0 }, Dq { d: -3.0, q: 30.0 });
    c.bench_function("motor step, exact", |b| {
        b.iter(|| motor.step_exact(black_box(i), u, black_box(20.0), black_box(2.5e-5)))
    });
    let modulator = Svpwm::new(540.0, Overmodulation::default())?;
    let inverter = Inverter::new(540.0, PERIOD, 2e-6)?;
    let duties = modulator.duties(AlphaBeta {
        alpha: 40.0,
        beta: 90.0,
    });
    let rotor = Rotor {
        electrical_angle: 1.0,
        speed: 20.0,
    };
    c.bench_function("switched period", |b| {
        b.iter(|| inverter.switched_step(&motor, black_box(i), rotor, duties))
    });
    Ok(())
}

fn benches(c: &mut Criterion) {
    let all = cycles::<f64>(c, "f64")
        .and_then(|()| cycles::<f32>(c, "f32"))
        .and_then(|()| motors::<f64>(c, "f64"))
        .and_then(|()| motors::<f32>(c, "f32"))
        .and_then(|()| additions::<f64>(c, "f64"))
        .and_then(|()| additions::<f32>(c, "f32"))
        .and_then(|()| checks(c));
    if let Err(error) = all {
        panic!("{error}");
    }
}

criterion_group!(hot_paths, benches);
criterion_main!(hot_paths);
