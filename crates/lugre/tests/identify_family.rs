//! Laws of the family from records: the truth is integrated here, as the papers print it, in
//! steps of 5 µs, and noise added; the 95 % intervals must hold it.

use crate::rig::Noise;
use lugre::identify::{
    BeforeRecord, FrictionIdentifyError, FrictionRecord, Identifiable, MeasuredMotion,
    UnknownNumbers, identify_law,
};
use lugre::{
    BoucWenOnset, Bristle, BristleParameters, DahlOnset, ElastoPlasticOnset, FrictionLevel,
    LinearOnset, MaxwellSlip, MaxwellSlipParameters, Onset, Regularisation, StaticFriction,
    StaticFrictionParameters, SteadyState,
};
use proptest::prelude::*;

const STEP: f64 = 5e-3;
const SAMPLES: usize = 400;
const PARTS: usize = 1000;
const NOISE: f64 = 0.5;
const STIFFNESS: f64 = 4e5;
const SEEDS: u64 = 40;

fn speed(t: f64) -> f64 {
    4e-3 * (3.1 * t).sin() + 2.5e-3 * (8.3 * t + 0.4).sin()
}

fn displacement(t: f64) -> f64 {
    -4e-3 / 3.1 * (3.1 * t).cos() - 2.5e-3 / 8.3 * (8.3 * t + 0.4).cos()
}

fn level(v: f64, backward: f64) -> f64 {
    let coulomb = if v > 0.0 { 60.0 } else { backward };
    coulomb * (1.0 + 0.4 * (-(v / 1.5e-3).powi(2)).exp())
}

/// Force at the samples: σ0 z + σ1 dz/dt + 300 v by Runge and Kutta's method.
fn bristle(rate: impl Fn(f64, f64) -> f64, damping: f64) -> Vec<f64> {
    let h = STEP / PARTS as f64;
    let (mut z, mut force) = (0.0, Vec::new());
    for k in 0..SAMPLES * PARTS {
        let t = k as f64 * h;
        let [v0, v1, v2] = [0.0, 0.5 * h, h].map(|by| speed(t + by));
        let a = rate(z, v0);
        if k % PARTS == 0 {
            force.push(STIFFNESS * z + damping * a + 300.0 * v0);
        }
        let b = rate(z + 0.5 * h * a, v1);
        let c = rate(z + 0.5 * h * b, v1);
        z += h / 6.0 * (a + 2.0 * (b + c) + rate(z + h * c, v2));
    }
    force
}

/// Elements of one state each, by Euler's method.
fn elements() -> Vec<f64> {
    let h = STEP / PARTS as f64;
    let (mut f, mut slips, mut last) = ([0.0_f64; 2], [false; 2], 0.0);
    let mut force = Vec::new();
    for k in 0..SAMPLES * PARTS {
        if k % PARTS == 0 {
            force.push(f[0] + f[1] + 300.0 * speed(k as f64 * h));
        }
        let v = speed((k as f64 + 0.5) * h);
        if v * last < 0.0 {
            slips = [false; 2];
        }
        last = v;
        let s = level(v, 60.0);
        for (i, (share, stiffness)) in [(0.35, 4e5), (0.65, 1e5)].into_iter().enumerate() {
            if slips[i] {
                f[i] += h * 800.0 * (share * v.signum() - f[i] / s);
            } else {
                f[i] += stiffness * v * h;
                slips[i] = f[i] * v.signum() >= share * s;
            }
        }
    }
    force
}

fn start(viscous: f64) -> SteadyState {
    let level = FrictionLevel {
        coulomb: 75.0,
        stiction: 90.0,
    };
    SteadyState {
        forward: level,
        backward: level,
        stribeck_speed: 2.2e-3,
        viscous,
        ..SteadyState::coulomb(75.0)
    }
}

fn law<O: Onset<f64>>(damping: f64, onset: O) -> Bristle<f64, O> {
    Bristle::new(BristleParameters {
        steady: start(100.0),
        stiffness: 1e6,
        damping,
        onset,
    })
    .unwrap()
}

/// How often the interval of each number holds the truth, over all seeds; at least 33 of 40
/// (binomial mean 38, three and a half standard deviations).
fn covers<L: Identifiable>(
    start: &L,
    clean: &[f64],
    unknown: UnknownNumbers,
    truth: &[(&str, usize, f64)],
) {
    let speeds: Vec<f64> = (0..SAMPLES).map(|k| speed(k as f64 * STEP)).collect();
    let mut held = vec![0; truth.len()];
    let mut sizes = vec![0.0; truth.len()];
    for seed in 0..SEEDS {
        let mut noise = Noise::new(900 + seed);
        let offset = if unknown.offset { 3.0 } else { 0.0 };
        let force: Vec<f64> = clean
            .iter()
            .map(|f| f + offset + NOISE * noise.normal())
            .collect();
        let record = FrictionRecord {
            time_step: STEP,
            motion: MeasuredMotion::Speed(&speeds),
            force: &force,
            noise: 1.0,
            before: BeforeRecord::Unloaded,
            skip: 0,
        };
        let fit = identify_law(start, &[record], &unknown).unwrap();
        assert_eq!(fit.estimates.len(), truth.len());
        if unknown.offset {
            assert!(fit.offset.covers(3.0, 5.0));
        }
        for (i, &(name, element, value)) in truth.iter().enumerate() {
            let found = fit.estimate(name, element).unwrap();
            let [least, greatest] = found.interval;
            held[i] += usize::from(least <= value && value <= greatest);
            sizes[i] += found.estimate.standard_error / value / SEEDS as f64;
        }
    }
    for (i, (name, element, _)) in truth.iter().enumerate() {
        println!(
            "{name} {element}: {} of {SEEDS}, {:.2} %",
            held[i],
            100.0 * sizes[i]
        );
    }
    assert!(held.iter().all(|held| *held >= 33), "{held:?}");
}

const LEVELS: [(&str, usize, f64); 4] = [
    ("forward.coulomb", 0, 60.0),
    ("forward.stiction", 0, 84.0),
    ("stribeck_speed", 0, 1.5e-3),
    ("viscous", 0, 300.0),
];

fn with(more: &[(&'static str, usize, f64)]) -> Vec<(&'static str, usize, f64)> {
    LEVELS.iter().chain(more).copied().collect()
}

#[test]
fn lugre_with_levels_by_direction_and_damping() {
    let clean = bristle(|z, v| v - STIFFNESS * v.abs() * z / level(v, 66.0), 1500.0);
    let unknown = UnknownNumbers {
        directions: true,
        damping: true,
        ..UnknownNumbers::default()
    };
    let truth = with(&[
        ("backward.coulomb", 0, 66.0),
        ("backward.stiction", 0, 66.0 * 1.4),
        ("stiffness", 0, STIFFNESS),
        ("damping", 0, 1500.0),
    ]);
    covers(&law(0.0, LinearOnset {}), &clean, unknown, &truth);
}

#[test]
fn dahl_with_an_offset() {
    let clean = bristle(
        |z, v| {
            let left = 1.0 - STIFFNESS * z * v.signum() / level(v, 60.0);
            v * left.abs().powf(1.7) * left.signum()
        },
        0.0,
    );
    let unknown = UnknownNumbers {
        offset: true,
        ..UnknownNumbers::default()
    };
    let truth = with(&[("stiffness", 0, STIFFNESS), ("exponent", 0, 1.7)]);
    covers(
        &law(0.0, DahlOnset { exponent: 1.0 }),
        &clean,
        unknown,
        &truth,
    );
}

#[test]
fn elasto_plastic() {
    let clean = bristle(
        |z, v| {
            let (greatest, elastic) = (level(v, 60.0) / STIFFNESS, 0.6 * 60.0 / STIFFNESS);
            let alpha = if z * v <= 0.0 || z.abs() <= elastic {
                0.0
            } else if z.abs() >= greatest {
                1.0
            } else {
                let x = (z.abs() - 0.5 * (greatest + elastic)) / (greatest - elastic);
                0.5 + 0.5 * (std::f64::consts::PI * x).sin()
            };
            v * (1.0 - alpha * z.abs() / greatest)
        },
        0.0,
    );
    let truth = with(&[("stiffness", 0, STIFFNESS), ("elastic_share", 0, 0.6)]);
    let onset = ElastoPlasticOnset { elastic_share: 0.4 };
    covers(&law(0.0, onset), &clean, UnknownNumbers::default(), &truth);
}

#[test]
fn bouc_wen() {
    let clean = bristle(
        |z, v| {
            let y = STIFFNESS * z / level(v, 60.0);
            v - 0.75 * v.abs() * y * y.abs() - 0.25 * v * y * y
        },
        0.0,
    );
    let truth = with(&[
        ("stiffness", 0, STIFFNESS),
        ("exponent", 0, 2.0),
        ("loading_share", 0, 0.75),
    ]);
    let onset = BoucWenOnset {
        exponent: 1.4,
        loading_share: 0.9,
    };
    covers(&law(0.0, onset), &clean, UnknownNumbers::default(), &truth);
}

#[test]
fn maxwell_slip() {
    let law = MaxwellSlip::new(MaxwellSlipParameters {
        steady: start(100.0),
        shares: [0.5, 0.5],
        stiffness: [6e5, 2e5],
        attraction: 1500.0,
    })
    .unwrap();
    let truth = with(&[
        ("shares", 0, 0.35),
        ("shares", 1, 0.65),
        ("stiffness", 0, 4e5),
        ("stiffness", 1, 1e5),
        ("attraction", 0, 800.0),
    ]);
    covers(&law, &elements(), UnknownNumbers::default(), &truth);
}

#[test]
fn without_memory() {
    let clean: Vec<f64> = (0..SAMPLES)
        .map(|k| speed(k as f64 * STEP))
        .map(|v| level(v, 60.0) * (v / 4e-4).tanh() + 300.0 * v)
        .collect();
    let law = StaticFriction::new(StaticFrictionParameters {
        steady: start(100.0),
        transition_speed: 2e-4,
        regularisation: Regularisation::Tanh,
    })
    .unwrap();
    let truth = with(&[("transition_speed", 0, 4e-4)]);
    covers(&law, &clean, UnknownNumbers::default(), &truth);
}

/// A displacement with noise of 10 nm, in two records, of which one begins otherwise than it says.
/// Measured: within 1.1 standard errors.
#[test]
fn several_records_of_displacement() {
    let clean = bristle(|z, v| v - STIFFNESS * v.abs() * z / level(v, 60.0), 0.0);
    let mut noise = Noise::new(77);
    let x: Vec<f64> = (0..SAMPLES)
        .map(|k| displacement(k as f64 * STEP) + 1e-8 * noise.normal())
        .collect();
    let force: Vec<f64> = clean.iter().map(|f| f + 0.3 * noise.normal()).collect();
    let record = |range: std::ops::Range<usize>, before, noise| FrictionRecord {
        time_step: STEP,
        motion: MeasuredMotion::Displacement(&x[range.clone()]),
        force: &force[range],
        noise,
        before,
        skip: 60,
    };
    // In the 60 samples the first slides by 1.4 mm, nine deflections; what the second begins
    // with is right but for the speed.
    let records = [
        record(0..220, BeforeRecord::Backward, 0.3),
        record(180..400, BeforeRecord::Forward, 0.3),
    ];
    let fit = identify_law(
        &law(0.0, LinearOnset {}),
        &records,
        &UnknownNumbers::default(),
    )
    .unwrap();
    assert_eq!(fit.samples, 320);
    for (name, element, value) in with(&[("stiffness", 0, STIFFNESS)]) {
        let found = fit.estimate(name, element).unwrap().estimate;
        assert!(found.covers(value, 3.0), "{name}: {found:?}");
    }
}

#[test]
fn what_keeps_a_fit_from_being_one_is_said() {
    let start = law(0.0, LinearOnset {});
    let speeds: Vec<f64> = (0..SAMPLES).map(|k| 0.1 + speed(k as f64 * STEP)).collect();
    let force: Vec<f64> = speeds.iter().map(|v| 60.0 + 300.0 * v).collect();
    let good = FrictionRecord {
        time_step: STEP,
        motion: MeasuredMotion::Speed(&speeds),
        force: &force,
        noise: 1.0,
        before: BeforeRecord::Unloaded,
        skip: 10,
    };
    let fit = |record| identify_law(&start, &[record], &UnknownNumbers::default());
    let none = identify_law(&start, &[], &UnknownNumbers::default());
    assert!(matches!(
        none,
        Err(FrictionIdentifyError::TooFewSamples { .. })
    ));
    // Sliding fast all the time: nothing of the bristles shows.
    assert!(matches!(
        fit(good),
        Err(FrictionIdentifyError::NotIdentifiable { .. })
    ));
    for wrong in [
        FrictionRecord {
            time_step: 0.0,
            ..good
        },
        FrictionRecord {
            noise: f64::NAN,
            ..good
        },
        FrictionRecord {
            force: &force[1..],
            ..good
        },
        FrictionRecord {
            skip: usize::MAX,
            ..good
        },
        FrictionRecord {
            motion: MeasuredMotion::Speed(&[0.0; SAMPLES]),
            ..good
        },
        FrictionRecord {
            motion: MeasuredMotion::Displacement(&[f64::NAN; SAMPLES]),
            ..good
        },
        FrictionRecord {
            motion: MeasuredMotion::Speed(&[]),
            force: &[],
            ..good
        },
    ] {
        let error = fit(wrong).unwrap_err().to_string();
        assert!(error.len() > 20, "{error}");
    }
    let many = MaxwellSlip::new(MaxwellSlipParameters {
        steady: SteadyState::coulomb(60.0),
        shares: [0.05; 20],
        stiffness: [1e5; 20],
        attraction: 1.0,
    });
    let many = identify_law(&many.unwrap(), &[good], &UnknownNumbers::default());
    assert!(matches!(
        many,
        Err(FrictionIdentifyError::TooManyNumbers { .. })
    ));
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -1.0..1.0f64,
        1 => prop::num::f64::ANY,
        1 => prop::sample::select(vec![0.0, f64::NAN, 1e99, -1e99, 1e-300]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Any record and any start: a fit or an error.
    #[test]
    fn records_of_any_kind(
        motion in prop::collection::vec(-1.0..1.0f64, 60), odd in prop::collection::vec(number(), 4),
        (level, stiffness) in (-9.0..9.0f64, -9.0..9.0f64), time_step in number(), skip in 0..70_usize,
        [a, b] in prop::array::uniform2(prop::bool::ANY), quantised in prop::bool::ANY,
    ) {
        let mut motion = motion;
        if quantised {
            motion.iter_mut().for_each(|v| *v = v.round());
        }
        let mut force = motion.clone();
        if a {
            motion[7] = odd[0];
            force[9] = odd[1];
        }
        let record = FrictionRecord {
            time_step: if b { 1e-3 } else { time_step },
            motion: if odd[2] > 0.0 {
                MeasuredMotion::Speed(&motion)
            } else {
                MeasuredMotion::Displacement(&motion)
            },
            force: &force,
            noise: 1.0,
            before: BeforeRecord::Forward,
            skip,
        };
        let unknown = UnknownNumbers {
            directions: a,
            stribeck_exponent: b,
            viscous_terms: skip % 4,
            damping: true,
            offset: quantised,
            ..UnknownNumbers::default()
        };
        let start = Bristle::new(BristleParameters {
            steady: SteadyState::coulomb(10_f64.powf(level)),
            stiffness: 10_f64.powf(stiffness),
            damping: 0.0,
            onset: BoucWenOnset { exponent: 1.0, loading_share: 0.5 },
        });
        let whole = FrictionRecord { skip: 0, ..record };
        let _ = identify_law(&start.unwrap(), &[record, whole], &unknown);
    }
}
