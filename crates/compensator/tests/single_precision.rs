//! Every strategy in `f32` is that in `f64`, to a stated multiple of what `f32` rounds, along the six trajectories of
//! the paper (Table 12).
//!
//! Both take the same numbers: settings and samples are `f32`, and `f64` takes them exactly.

use cfnn::{FixedNetwork, NetworkScalar, ScalingRange, packed_len};
use compensator::{
    Combined, Compensator, Correction, FeedforwardDrive, FrictionFeedforward, MotionEstimator,
    NetworkCompensation, NoCompensation, ObserverGains, Reference, Sample, TransferFunction,
    TransferFunctionModel,
};
use lugre::{Exponential, LuGre, Parameters};
use trajectories::{Limits, Motion, SCurve};

const T: f32 = 1e-4;
const R: f32 = 0.01 / std::f32::consts::TAU;
const KT: f32 = 1.641;

/// mm/s, mm/s², mm/s³ over 300 mm.
const TABLE_12: [[f64; 3]; 6] = [
    [100.0, 225.0, 1200.0],
    [100.0, 225.0, 1400.0],
    [100.0, 120.0, 1000.0],
    [100.0, 140.0, 1000.0],
    [110.0, 160.0, 1000.0],
    [120.0, 160.0, 1000.0],
];

/// What a controller samples along a trajectory, with a table that lags by 0.1 ms and a transmission that winds up by
/// a thousandth of the speed.
fn samples(row: [f64; 3]) -> Vec<Sample<f32>> {
    let [v, a, j] = row.map(|x| x / 1000.0);
    let curve = SCurve::plan(0.6, 0.9, &Limits::new(v, a, j).unwrap()).unwrap();
    let period = f64::from(T);
    let reference = |time: f64| {
        let s = curve.at(time);
        Reference {
            position: s.position,
            velocity: s.velocity,
            acceleration: s.acceleration,
        }
    };
    let cycles = (curve.duration() / period) as u32 + 500;
    (0..cycles)
        .map(|k| {
            let time = f64::from(k) * period;
            let now = reference(time);
            let iq = 2.0 * now.acceleration + 0.4 * now.velocity.signum();
            let sample = Sample {
                reference: now,
                next_reference: reference(time + period),
                position: reference(time - period).position,
                motor_angle: 0.0,
                motor_speed: 1.001 * now.velocity / f64::from(R),
                iq,
                last_command: iq,
            };
            sample.cast()
        })
        .collect()
}

/// Greatest deviation of position (m) and current (A) from the law in `f64`, over all trajectories.
fn deviation(single: &mut dyn Compensator<f32>, double: &mut dyn Compensator) -> Correction {
    let mut worst = Correction::<f64>::default();
    for row in TABLE_12 {
        single.reset();
        double.reset();
        for sample in samples(row) {
            let (a, b) = (
                single.correct(&sample).cast::<f64>(),
                double.correct(&sample.cast()),
            );
            worst.position = worst.position.max((a.position - b.position).abs());
            worst.command = worst.command.max((a.command - b.command).abs());
        }
    }
    worst
}

/// `value` in units of `f32::EPSILON` of `size`.
fn units(name: &str, value: f64, size: f64) -> f64 {
    let units = value / (f64::from(f32::EPSILON) * size);
    println!("{name}: {value:.3e}, {units:.2} epsilon of {size:.3e}");
    units
}

fn friction<S: Exponential>() -> FrictionFeedforward<S> {
    let law = LuGre::new(Parameters::LIU_2025.cast::<f32>().cast()).unwrap();
    let of = |x: f32| S::of(f64::from(x));
    FrictionFeedforward::new(
        law,
        FeedforwardDrive {
            travel_per_radian: of(R),
            torque_constant: of(KT),
            period: of(T),
        },
    )
    .unwrap()
}

fn model() -> TransferFunctionModel<f32> {
    // Poles of 31.6 ms and 1 ms.
    let (slow, fast) = (0.996_84, 0.904_84);
    let coefficients = [2e-5, -1e-5, 5e-6];
    TransferFunctionModel::new(T, 1e-6, &[slow, fast, slow], &coefficients).unwrap()
}

fn estimator<S: Exponential>(gains: ObserverGains<f32>) -> MotionEstimator<S> {
    let of = |x: f32| S::of(f64::from(x));
    MotionEstimator::new(of(R), of(T), gains.cast()).unwrap()
}

const HIDDEN: [usize; 2] = [6, 3];
const WEIGHTS: usize = packed_len(4, &HIDDEN, 1);

/// Weights of a size that training gives; the last layer carries v T.
fn weights() -> [f32; WEIGHTS] {
    let mut state = 1u32;
    let mut weights = std::array::from_fn(|_| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1u32 << 23) as f32 - 1.0
    });
    let last = WEIGHTS - 14;
    weights[last..].copy_from_slice(&[
        0.0, 1e-3, 1.0, 5e-3, 1e-3, 1e-3, -1e-3, 2e-3, 1e-3, -2e-3, 1e-3, 1e-3, 2e-3, -1e-3,
    ]);
    weights
}

fn network<S: NetworkScalar + Exponential>(
    weights: &[S],
    gains: ObserverGains<f32>,
) -> impl Compensator<S> + '_ {
    let range = |end: f32| {
        let end = S::of(f64::from(end));
        ScalingRange::new("test", S::of(0.0) - end, end).unwrap()
    };
    let input = [1.5, 0.333, 1.0, 15.0].map(range);
    let model =
        FixedNetwork::<S, 4, 1, 14>::new(&HIDDEN, weights, input, [range(3.33e-5)]).unwrap();
    NetworkCompensation::new(model, estimator(gains))
}

#[test]
fn no_compensation_is_nothing() {
    let worst = deviation(&mut NoCompensation, &mut NoCompensation);
    assert_eq!(worst, Correction::default());
}

#[test]
fn friction_feedforward() {
    let worst = deviation(&mut friction(), &mut friction());
    // The torque is a sum of T_S, σ1 ω and σ2 ω at 120 mm/s.
    let p = Parameters::LIU_2025;
    let size = p.stiction + (p.damping + p.viscous) * 0.12 / f64::from(R);
    assert!(units("friction", worst.command, size / f64::from(KT)) < 10.0); // 2.2 measured
    assert_eq!(worst.position, 0.0);
}

#[test]
fn transfer_function() {
    let (single, double) = (model(), model().cast().unwrap());
    let worst = deviation(
        &mut TransferFunction::new(single),
        &mut TransferFunction::new(double),
    );
    // Each section rounds every cycle and forgets in 1/(1 − p) = 316 cycles; 58 measured.
    let peak = 0.225 * 2.0 * double.dc_gain().abs();
    assert!(units("transfer function", worst.position, peak) < 200.0);
    let lead = 0.02;
    let mut single = TransferFunction::with_lead(single, lead).unwrap();
    let mut double = TransferFunction::with_lead(double, f64::from(lead)).unwrap();
    let worst = deviation(&mut single, &mut double);
    // The lead divides a difference of errors by 1/200 of itself.
    let size = peak * f64::from(lead / T);
    assert!(units("with lead", worst.position, size) < 10.0); // 2.8 measured
    assert_eq!(worst.command, 0.0);
}

#[test]
fn network_compensation() {
    let narrow = weights();
    let wide = narrow.map(f64::from);
    let deviation = |gains| {
        let worst = deviation(&mut network(&narrow, gains), &mut network(&wide, gains));
        assert_eq!(worst.command, 0.0);
        worst.position
    };
    // The scale as it is: only the increment rounds, 12 µm at 120 mm/s; 6.7 measured.
    let plain = deviation(ObserverGains::default());
    assert!(units("network", plain, 1.2e-5) < 20.0);
    // A smoothed position is a new number of 0.9 m, and it rounds; 0.93 measured.
    let smoothed = deviation(ObserverGains::critically_damped(5.0).unwrap());
    assert!(units("network, smoothed", smoothed, 0.9) < 3.0);
}

#[test]
fn combined() {
    let narrow = weights();
    let wide = narrow.map(f64::from);
    let gains = ObserverGains::default();
    let mut single = Combined::new(network(&narrow, gains), friction());
    let mut double = Combined::new(network(&wide, gains), friction());
    let worst = deviation(&mut single, &mut double);
    let parts = [
        deviation(&mut network(&narrow, gains), &mut network(&wide, gains)),
        deviation(&mut friction(), &mut friction()),
    ];
    assert_eq!(
        (worst.position, worst.command),
        (parts[0].position, parts[1].command)
    );
}

/// Speed and acceleration: differences of positions are exact, so what rounds is the way of a cycle, 12 µm at
/// 120 mm/s, which the gains magnify by β/T and βγ/T².
#[test]
fn estimates() {
    let gains = ObserverGains::default();
    let (mut single, mut double) = (estimator::<f32>(gains), estimator::<f64>(gains));
    let mut worst = [0.0_f64; 3];
    for row in TABLE_12 {
        single.reset();
        double.reset();
        for sample in samples(row) {
            let (a, b) = (single.update(&sample), double.update(&sample.cast()));
            let off = [
                f64::from(a.position) - b.position,
                f64::from(a.velocity) - b.velocity,
                f64::from(a.acceleration) - b.acceleration,
            ];
            worst = std::array::from_fn(|i| worst[i].max(off[i].abs()));
        }
    }
    let (speed, gamma, period) = (0.12, 0.05, f64::from(T));
    // 0.63 and 0.66 measured.
    assert_eq!(worst[0], 0.0);
    assert!(units("speed", worst[1], speed) < 2.0);
    assert!(units("acceleration", worst[2], speed * gamma / period) < 2.0);
}

#[test]
fn responses_and_noise() {
    let (single, double) = (model(), model().cast::<f64>().unwrap());
    for frequency in [0.0_f32, 1.0, 10.0, 100.0, 1000.0] {
        let (a, b) = (
            single.response(frequency),
            double.response(f64::from(frequency)),
        );
        let off = (f64::from(a.0) - b.0)
            .abs()
            .max((f64::from(a.1) - b.1).abs());
        // 1 − p loses what p rounds: 53 at 1 Hz, 2.8 at the most elsewhere.
        assert!(units("response", off, double.dc_gain().abs()) < 200.0);
    }
    let gains = ObserverGains::<f32>::critically_damped(10.0).unwrap();
    let (a, b) = (gains.noise_gains(), gains.cast::<f64>().noise_gains());
    assert!(
        units(
            "noise",
            (f64::from(a.loop_input) - b.loop_input).abs(),
            b.loop_input
        ) < 2.0
    );
}

#[test]
fn settings_outside_are_refused() {
    let model = TransferFunctionModel::new(1e-4, 0.0, &[1.0 - 1e-9], &[1.0]).unwrap();
    let message = model.cast::<f32>().unwrap_err().to_string();
    assert!(message.contains("pole = 1 is not valid"), "{message}");
    assert!(MotionEstimator::new(1e-30_f32, T, ObserverGains::default()).is_err());
}
