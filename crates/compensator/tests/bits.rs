//! Strategies in `f64` give the bits that they have always given: a hash of a long run.
//!
//! `cargo test -p compensator bits -- --nocapture` prints the hash. It was made with the strategies in `f64`
//! alone, before they became generic over their scalar.
#![cfg(feature = "alloc")]

use cfnn::{Network, Predictor, Scaling, Shape};
use compensator::{
    Combined, Compensator, FeedforwardDrive, FrictionFeedforward, MotionEstimator,
    NetworkCompensation, ObserverGains, Reference, Sample, TransferFunction, TransferFunctionModel,
};
use lugre::{LuGre, Parameters};

const T: f64 = 1e-4;
const R: f64 = 0.01 / std::f64::consts::TAU;

/// FNV-1a of 64 bits, over the bits of numbers.
struct Hash(u64);

impl Hash {
    fn add(&mut self, value: f64) {
        for byte in value.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

/// Uniform numbers in [−1, 1), always the same.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

fn network() -> Predictor<4, 1> {
    let shape = Shape {
        inputs: 4,
        hidden: vec![6, 3],
        outputs: 1,
    };
    let ranges = [(0.0, 1.5), (-0.333, 0.333), (-1.0, 1.0), (-15.0, 15.0)];
    let scaling = Scaling::from_ranges(&ranges, &[(-3.33e-5, 3.33e-5)]).expect("valid");
    let mut random = Random(7);
    let weights = (0..shape.parameters()).map(|_| random.next()).collect();
    let network = Network::new(shape, scaling, weights).expect("valid");
    Predictor::new(network).expect("four inputs and one output")
}

/// A random walk about a motion.
fn samples() -> Vec<Sample> {
    let mut random = Random(1);
    let (mut velocity, mut position) = (0.0, 0.6);
    let mut references = Vec::new();
    for _ in 0..20_001 {
        let acceleration = random.next();
        velocity = 0.999 * velocity + T * acceleration;
        position += T * velocity;
        references.push(Reference {
            position,
            velocity,
            acceleration,
        });
    }
    references
        .windows(2)
        .map(|pair| Sample {
            reference: pair[0],
            next_reference: pair[1],
            position: pair[0].position + 1e-5 * random.next(),
            motor_angle: 0.0,
            motor_speed: pair[0].velocity / R + 0.1 * random.next(),
            iq: random.next(),
            last_command: 3.0 * random.next(),
        })
        .collect()
}

fn strategies() -> Vec<Box<dyn Compensator>> {
    let law = LuGre::new(Parameters::LIU_2025).expect("valid");
    let friction = FrictionFeedforward::new(
        law,
        FeedforwardDrive {
            travel_per_radian: R,
            torque_constant: 1.641,
            period: T,
        },
    )
    .expect("valid");
    let gains = ObserverGains::critically_damped(5.0).expect("valid");
    let estimators = [ObserverGains::default(), gains]
        .map(|gains| MotionEstimator::new(R, T, gains).expect("valid"));
    let model = TransferFunctionModel::new(T, 1e-6, &[0.99, 0.9, 0.5], &[1e-5, -2e-5, 3e-6])
        .expect("valid");
    let leading = TransferFunction::with_lead(model, 0.02).expect("valid");
    vec![
        Box::new(friction),
        Box::new(NetworkCompensation::new(network(), estimators[0])),
        Box::new(NetworkCompensation::new(network(), estimators[1])),
        Box::new(TransferFunction::new(model)),
        Box::new(Combined::new(leading, friction)),
    ]
}

#[test]
fn double_precision_keeps_its_bits() {
    let mut hash = Hash(0xcbf2_9ce4_8422_2325);
    let samples = samples();
    for mut strategy in strategies() {
        for sample in &samples {
            let correction = strategy.correct(sample);
            hash.add(correction.position);
            hash.add(correction.command);
        }
    }
    let model = TransferFunctionModel::new(T, 1e-6, &[0.99, 0.9], &[1e-5, -2e-5]).expect("valid");
    for i in 0..1000 {
        let (re, im) = model.response(f64::from(i));
        hash.add(re);
        hash.add(im);
    }
    let noise = ObserverGains::critically_damped(5.0)
        .expect("valid")
        .noise_gains();
    for value in [noise.position, noise.speed_times_period, noise.loop_input] {
        hash.add(value);
    }
    println!("{:#018x}", hash.0);
    assert_eq!(hash.0, 0x5e1c_9e2a_2f28_c76c);
}
