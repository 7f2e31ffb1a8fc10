//! The calls inside a control cycle and inside an integration step. Inputs
//! change from call to call through the state, as in a simulation: the times
//! are latencies, not throughputs.

use core::f64::consts::PI;
use core::hint::black_box;
use criterion::{Criterion, criterion_group, criterion_main};
use foc_pmsm::inverter::{Inverter, Rotor};
use foc_pmsm::svpwm::{Overmodulation, Svpwm};
use foc_pmsm::{
    AlphaBeta, Correction, Dq, FocError, Measurement, MotorParameters, Pmsm, Reference, Servo,
    ServoGains, ServoLimits, ServoState,
};

const RPM: f64 = PI / 30.0;
const PERIOD: f64 = 1e-4;

fn motor() -> Result<Pmsm, FocError> {
    let parameters = MotorParameters {
        pole_pairs: 4,
        resistance: 0.75,
        inductance_d: 4.11e-3,
        inductance_q: 13.2e-3,
        flux_linkage: 0.0,
    };
    Pmsm::new(parameters.from_torque_constant(1.641))
}

fn servo() -> Result<Servo, FocError> {
    let gains = ServoGains {
        position: 280.2 * RPM / 1e-3,
        speed_p: 0.0678 / RPM,
        speed_i: 0.7122 / RPM,
        d_p: 2.776,
        d_i: 626.2,
        q_p: 8.805,
        q_i: 1003.3,
    };
    let limits = ServoLimits {
        current: 15.0,
        voltage: 540.0 / 3f64.sqrt(),
    };
    Servo::new(gains, limits, PERIOD)
}

fn benches(c: &mut Criterion) {
    let (motor, servo) = match (motor(), servo()) {
        (Ok(motor), Ok(servo)) => (motor, servo),
        (Err(error), _) | (_, Err(error)) => panic!("{error}"),
    };
    let u = Dq { d: -3.0, q: 30.0 };
    let mut i = Dq { d: 0.0, q: 3.0 };
    c.bench_function("motor step, midpoint", |b| {
        b.iter(|| {
            i = motor.step(i, black_box(u), black_box(20.0), black_box(2.5e-5));
            i
        })
    });
    c.bench_function("motor step, exact", |b| {
        b.iter(|| motor.step_exact(black_box(i), u, black_box(20.0), black_box(2.5e-5)))
    });

    let mut state = ServoState::default();
    let reference = Reference {
        position: 1e-6,
        motor_speed: 0.01,
    };
    let correction = Correction::default();
    let mut current = Dq::ZERO;
    c.bench_function("servo cycle", |b| {
        b.iter(|| {
            let m = Measurement {
                position: 0.0,
                motor_speed: 0.02,
                current,
            };
            let command = servo.cycle(&mut state, &m, black_box(&reference), &correction);
            current = command.voltage * 1e-3;
            command
        })
    });

    let Ok(modulator) = Svpwm::new(540.0, Overmodulation::default()) else {
        return;
    };
    let voltage = AlphaBeta {
        alpha: 40.0,
        beta: 90.0,
    };
    c.bench_function("SVPWM duties", |b| {
        b.iter(|| modulator.duties(black_box(voltage)))
    });
    let Ok(inverter) = Inverter::new(540.0, PERIOD, 2e-6) else {
        return;
    };
    let duties = modulator.duties(voltage);
    let rotor = Rotor {
        electrical_angle: 1.0,
        speed: 20.0,
    };
    c.bench_function("switched period", |b| {
        b.iter(|| inverter.switched_step(&motor, black_box(i), rotor, duties))
    });
}

criterion_group!(hot_paths, benches);
criterion_main!(hot_paths);
