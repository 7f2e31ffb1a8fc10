//! One correction of each strategy: what a controller spends on it in each
//! control cycle of 100 µs. `cargo bench -p compensator`
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use std::f64::consts::TAU;
use std::hint::black_box;

use axis_scalar::Scalar;
use cfnn::{FixedNetwork, Network, Scaling, ScalingRange, Shape, packed_len};
use compensator::{
    Cascade, Combined, Compensator, Drive, DriveModel, DriveSection, FeedbackDesign,
    FeedbackSettings, FeedforwardDrive, FrictionFeedforward, Mode, MotionEstimator,
    NetworkCompensation, NoCompensation, ObserverGains, Plan, PlanSettings, PlanWithFeedback,
    Planned, Reference, Sample, StrokeSections, Target, TransferFunction, TransferFunctionModel,
};
use criterion::{Criterion, criterion_group, criterion_main};
use foc_pmsm::{MotorParameters, Pmsm};
use lugre::{Exponential, LuGre, Parameters};

const T: f64 = 1e-4; // control period, s
const R: f64 = 0.01 / TAU; // travel per radian, m
const RANGES: [(f64, f64); 4] = [(0.1, 1.3), (-0.2, 0.2), (-3.0, 3.0), (-15.0, 15.0)];
const HIDDEN: [usize; 3] = [34, 19, 8];

/// Cycles of a motion, long enough that every cycle differs from the last.
const CYCLES: usize = 1000;

/// A sinusoidal motion, 50 mm at 0.5 Hz, its middle third of a second.
fn cycles() -> Vec<Sample> {
    let reference = |k: usize| {
        let (amplitude, rate) = (0.05, TAU * 0.5);
        let (sine, cosine) = (rate * (k as f64 * T + 0.3)).sin_cos();
        Reference {
            position: 0.6 + amplitude * sine,
            velocity: amplitude * rate * cosine,
            acceleration: -amplitude * rate * rate * sine,
        }
    };
    (0..CYCLES)
        .map(|k| Sample {
            reference: reference(k),
            next_reference: reference(k + 1),
            position: reference(k).position - 1e-6,
            motor_angle: 0.0,
            motor_speed: reference(k).velocity / R,
            iq: 0.5,
            last_command: 0.5,
        })
        .collect()
}

fn friction<S: Exponential>() -> FrictionFeedforward<S> {
    let parameters = Parameters {
        viscous: 0.0298,
        ..Parameters::LIU_2025
    };
    let law = LuGre::new(parameters.cast()).expect("valid parameters");
    FrictionFeedforward::new(
        law,
        FeedforwardDrive {
            travel_per_radian: S::of(R),
            torque_constant: S::of(1.641),
            period: S::of(T),
        },
    )
    .expect("valid parameters")
}

fn estimator<S: Scalar>() -> MotionEstimator<S> {
    MotionEstimator::new(S::of(R), S::of(T), ObserverGains::default()).expect("valid parameters")
}

/// Weights of the paper's size; what they say does not matter for the time.
fn weights(count: usize) -> Vec<f64> {
    (0..count)
        .map(|k| (k as f64 * 0.618_033_988_749_895).fract() - 0.5)
        .collect()
}

fn network() -> Network {
    let shape = Shape {
        inputs: 4,
        hidden: HIDDEN.to_vec(),
        outputs: 1,
    };
    let scaling = Scaling::from_ranges(&RANGES, &[(-2e-5, 2e-5)]).expect("valid ranges");
    let weights = weights(shape.parameters());
    Network::new(shape, scaling, weights).expect("a valid network")
}

fn bench<S: Scalar>(c: &mut Criterion, name: &str, mut law: impl Compensator<S>) {
    let cycles: Vec<Sample<S>> = cycles().iter().map(Sample::cast).collect();
    let mut next = 0;
    c.bench_function(name, |b| {
        b.iter(|| {
            next = (next + 1) % CYCLES;
            law.correct(black_box(&cycles[next]))
        });
    });
}

/// The axis of the paper as plan and feedback see it, its screw a spring.
fn planned() -> (DriveModel, Vec<Mode>) {
    let motor = Pmsm::new(
        MotorParameters {
            pole_pairs: 4,
            resistance: 0.75,
            inductance_d: 4.11e-3,
            inductance_q: 13.2e-3,
            flux_linkage: 0.0,
        }
        .from_torque_constant(1.641),
    )
    .expect("a motor");
    let section = DriveSection {
        compliance: 1e-3,
        rotating: 0.0085,
        lagging: 0.002,
        load: 0.0,
    };
    let parameters = Parameters {
        viscous: 0.0298,
        ..Parameters::LIU_2025
    };
    let model = DriveModel {
        travel: R,
        load_inertia: 515.0,
        friction: LuGre::new(parameters).expect("a law"),
        lever: R,
        along: StrokeSections::new([0.0, 1.5], |_| section).expect("a stroke"),
        kinematics: compensator::Kinematics::default(),
        drive: Drive::FieldOriented {
            motor,
            gear: 1.0,
            d: [2.776, 626.2],
            q: [8.805, 1003.3],
            voltage: 311.0,
            late: 0.0,
        },
        delay: 0.0,
        effort_limit: 15.0,
        cascade: Cascade {
            position: 29_342.0,
            velocity_feedforward: 1.0,
            acceleration_feedforward: 0.0,
            speed: 0.6474,
            speed_integral: 6.8,
            from_motor: false,
            signal_path: compensator::SignalPath::default(),
        },
        period: T,
    };
    let mode = |frequency: f64, motor, load| Mode {
        frequency: TAU * frequency,
        damping: 1e-5 * (TAU * frequency) * (TAU * frequency),
        motor,
        load,
    };
    let modes = vec![
        mode(0.0, 10.17, 0.01619),
        mode(62.8, 5.115, -0.04059),
        mode(139.1, -7.621, -0.00564),
    ];
    (model, modes)
}

/// The plan and the feedback around it, each cycle's set point being asked for.
fn feedback(c: &mut Criterion) {
    let (model, modes) = planned();
    let settings = FeedbackSettings {
        sensitivity: f64::INFINITY,
        sensitivity_late: f64::INFINITY,
        ..FeedbackSettings::default()
    };
    let design = FeedbackDesign::new(&model, &modes, &settings).expect("a design");
    let cycles = cycles();
    let target = move |k: usize| Target::of(cycles[k % CYCLES].reference);
    let plan = || Plan::new(&model, &PlanSettings::default(), target.clone()).expect("a plan");
    bench(c, "plan", plan());
    let law = PlanWithFeedback::new(plan(), design.feedback());
    bench(c, "plan with feedback", law);
    let rows = self::cycles();
    let mut double = design.feedback();
    let mut single = double.cast::<f32>();
    let mut next = 0;
    c.bench_function("feedback alone", |b| {
        b.iter(|| {
            next = (next + 1) % CYCLES;
            let planned = Planned {
                motor_speed: rows[next].motor_speed,
                position: rows[next].position,
                sticking: 0.02,
                ..Planned::default()
            };
            double.correct(black_box(&rows[next]), &planned)
        });
    });
    let rows: Vec<Sample<f32>> = rows.iter().map(Sample::cast).collect();
    c.bench_function("feedback alone, f32", |b| {
        b.iter(|| {
            next = (next + 1) % CYCLES;
            let planned = Planned {
                motor_speed: rows[next].motor_speed,
                position: rows[next].position,
                sticking: 0.02,
                ..Planned::default()
            };
            single.correct(black_box(&rows[next]), &planned)
        });
    });
}

fn corrections(c: &mut Criterion) {
    feedback(c);
    bench::<f64>(c, "none", NoCompensation);
    bench(c, "friction feedforward", friction::<f64>());
    bench(c, "friction feedforward, f32", friction::<f32>());
    let poles = [0.9, 0.8, 0.7, 0.6];
    for order in [1, 2, 4] {
        let coefficients = [1e-7; 4];
        let model = TransferFunctionModel::new(T, 1e-6, &poles[..order], &coefficients[..order])
            .expect("stable poles");
        let name = format!("transfer function, order {order}");
        bench(c, &name, TransferFunction::new(model));
        let single = model.cast::<f32>().expect("stable poles");
        bench(c, &format!("{name}, f32"), TransferFunction::new(single));
    }
    let predictor = || cfnn::Predictor::<4, 1>::new(network()).expect("four inputs, one output");
    let compensation = || NetworkCompensation::new(predictor(), estimator());
    bench(c, "network 4-34-19-8-1, f64", compensation());
    bench(
        c,
        "network 4-34-19-8-1 and friction",
        Combined::new(compensation(), friction::<f64>()),
    );
    single(c);
}

/// The controller's form: borrowed weights in single precision.
fn single(c: &mut Criterion) {
    let packed: Vec<f32> = weights(packed_len(4, &HIDDEN, 1))
        .iter()
        .map(|&w| w as f32)
        .collect();
    let range = |low: f64, high: f64| ScalingRange::new("bench", low as f32, high as f32);
    let input = RANGES.map(|(low, high)| range(low, high).expect("a valid range"));
    let output = [range(-2e-5, 2e-5).expect("a valid range")];
    let model = FixedNetwork::<f32, 4, 1, 66>::new(&HIDDEN, &packed, input, output)
        .expect("a valid network");
    bench(
        c,
        "network 4-34-19-8-1, f32, borrowed weights",
        NetworkCompensation::new(model, estimator::<f64>()),
    );
    bench(
        c,
        "network 4-34-19-8-1 and friction, all f32",
        Combined::new(
            NetworkCompensation::new(model, estimator::<f32>()),
            friction::<f32>(),
        ),
    );
}

criterion_group!(benches, corrections);
criterion_main!(benches);
