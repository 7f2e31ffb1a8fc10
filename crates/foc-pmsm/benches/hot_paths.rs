//! The calls inside a control cycle, in both scalars, and inside an
//! integration step. Inputs change from call to call through the state, as in
//! a simulation: the times are latencies, not throughputs.

use axis_scalar::Scalar;
use core::f64::consts::PI;
use core::hint::black_box;
use criterion::{Criterion, criterion_group, criterion_main};
use foc_pmsm::inverter::{Inverter, Rotor};
use foc_pmsm::svpwm::{Overmodulation, Svpwm};
use foc_pmsm::{
    AlphaBeta, Dq, FieldWeakening, FieldWeakeningParameters, FieldWeakeningState, FocError,
    Measurement, MotorParameters, OperatingPoint, Pmsm, Servo, ServoCorrection, ServoGains,
    ServoLimits, ServoReference, ServoState,
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
            let command = servo.cycle(&mut state, &m, black_box(&reference), &correction);
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
            let command = servo.cycle_with(&mut state, &m, reference, &correction, &point);
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
        .and_then(|()| checks(c));
    if let Err(error) = all {
        panic!("{error}");
    }
}

criterion_group!(hot_paths, benches);
criterion_main!(hot_paths);
