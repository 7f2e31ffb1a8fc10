//! The strategies on a controller of one's own: a rigid axis with LuGre
//! friction, position P and speed PI at 10 kHz, nothing of the simulator.
//!
//! `cargo run -p compensator --example one_controller`
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use std::f64::consts::TAU;

use compensator::{
    Candidates, Combined, Compensator, FeedforwardDrive, FrictionFeedforward, MotionEstimator,
    MotionRecord, NetworkCompensation, NoCompensation, ObserverGains, Reference, Sample,
    TransferFunction, TransferFunctionError, TransferFunctionFit, identify_transfer_function,
};
use lugre::{LuGre, Parameters};

const T: f64 = 1e-4; // control period, s
const R: f64 = 0.01 / TAU; // travel per radian, m
const KT: f64 = 1.641; // torque constant, N·m/A
const INERTIA: f64 = 0.006; // at the screw, kg·m²
const P: f64 = 29_342.0; // position gain, rad/s per m
const SPEED_GAINS: (f64, f64) = (0.647, 6.8); // A/(rad/s), A/rad

/// There and back in `duration` seconds, `speed` m/s at the most.
fn reference(time: f64, duration: f64, speed: f64) -> Reference {
    let (phase, rate) = (TAU * time / duration, TAU / duration);
    let (half, full) = (phase.sin(), (2.0 * phase).sin());
    Reference {
        position: speed / rate * (half.powi(3) * 4.0 / 3.0 / 1.54),
        velocity: speed * (4.0 * half * half * phase.cos() / 1.54),
        acceleration: speed * rate * 4.0 / 1.54 * (full * phase.cos() - half.powi(3)),
    }
}

/// Reference accelerations and tracking errors of one motion.
fn run(friction: &LuGre, law: &mut impl Compensator, duration: f64, speed: f64) -> [Vec<f64>; 2] {
    let (mut position, mut omega, mut bristle) = (0.0, 0.0, 0.0);
    let (mut integral, mut iq) = (0.0, 0.0);
    let (mut accelerations, mut errors) = (Vec::new(), Vec::new());
    law.reset();
    for k in 0..(duration / T) as u32 {
        let now = reference(f64::from(k) * T, duration, speed);
        let correction = law.correct(&Sample {
            reference: now,
            next_reference: reference(f64::from(k + 1) * T, duration, speed),
            position,
            motor_angle: 0.0,
            motor_speed: omega,
            iq,
            last_command: iq,
        });
        accelerations.push(now.acceleration);
        errors.push(now.position - position);
        // The servo, with the correction in its two places.
        let position_input = now.position - position + correction.position;
        let deviation = P * position_input + now.velocity / R - omega;
        integral += SPEED_GAINS.1 * deviation * T;
        iq = SPEED_GAINS.0 * deviation + integral + correction.command;
        // The axis: friction over a step of constant speed, then the momentum.
        let (next_bristle, drag) = friction.step_torque(bristle, omega, omega, T);
        let next_omega = omega + T * (KT * iq - drag) / INERTIA;
        position += R * T * 0.5 * (omega + next_omega);
        (omega, bristle) = (next_omega, next_bristle);
    }
    [accelerations, errors]
}

/// The linear model of what `law` leaves of the error, from two motions.
fn identify(
    friction: &LuGre,
    mut law: impl Compensator,
) -> Result<TransferFunctionFit, TransferFunctionError> {
    let [training, validation] =
        [(1.0, 0.1), (0.7, 0.06)].map(|(duration, speed)| run(friction, &mut law, duration, speed));
    let [training, validation] =
        [&training, &validation].map(|[acceleration, error]| MotionRecord {
            period: T,
            acceleration,
            error,
        });
    identify_transfer_function(&[training], &[validation], &Candidates::for_period(T))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let friction = LuGre::new(Parameters {
        viscous: 0.0298,
        ..Parameters::LIU_2025
    })?;
    let feedforward = FrictionFeedforward::new(
        friction,
        FeedforwardDrive {
            travel_per_radian: R,
            torque_constant: KT,
            period: T,
        },
    )?;
    let fit = identify(&friction, NoCompensation)?;
    // What friction feed-forward leaves is another error: identified with it.
    let fit_on_top = identify(&friction, feedforward)?;
    println!("linear model: {:?}", fit.chosen);

    let estimator = MotionEstimator::new(R, T, ObserverGains::default())?;
    // Kinematics in the place of a trained network.
    let network = NetworkCompensation::new(|_, v, a, _| v * T + 0.5 * a * T * T, estimator);
    let plain = TransferFunction::new(fit.model);
    let on_top = TransferFunction::new(fit_on_top.model);
    let leading = TransferFunction::with_lead(fit.model, 1.0 / (P * R))?;
    let peak = |name: &str, law: &mut dyn Compensator| {
        let [_, errors] = run(&friction, &mut &mut *law, 0.8, 0.08);
        let peak = errors.iter().fold(0.0_f64, |peak, e| peak.max(e.abs()));
        println!("{name:<34}{:8.2} µm", 1e6 * peak);
    };
    println!("peak error, there and back in 0.8 s");
    peak("none", &mut NoCompensation);
    peak("friction", &mut feedforward.clone());
    peak("network (kinematic)", &mut network.clone());
    peak(
        "network + friction",
        &mut Combined::new(network, feedforward),
    );
    peak("transfer function", &mut plain.clone());
    peak("transfer function, lead", &mut leading.clone());
    peak(
        "transfer function + friction",
        &mut Combined::new(plain, feedforward),
    );
    peak(
        "the same, identified together",
        &mut Combined::new(on_top, feedforward),
    );
    Ok(())
}
