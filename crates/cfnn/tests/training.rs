//! Training: what it must reach, and that its bits depend on nothing else
//! than the data, the settings and the seed.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use cfnn::train::{
    Dataset, EarlyStopping, Initialisation, Normalisation, Trainer, TrainingOutcome,
    TrainingSettings,
};
use cfnn::{Error, Shape};

fn uniform(k: usize) -> f64 {
    2.0 * (k as f64 * 0.618_033_988_749_894_9).fract() - 1.0
}

/// Two inputs; outputs by the given function.
fn data(samples: usize, f: impl Fn(f64, f64) -> f64) -> Dataset {
    let input: Vec<f64> = (0..samples)
        .flat_map(|s| [uniform(s), 3.0 * uniform(31 * s + 5)])
        .collect();
    let target = input.chunks(2).map(|x| f(x[0], x[1])).collect();
    Dataset::new(2, 1, input, target).unwrap()
}

fn shape(hidden: &[usize]) -> Shape {
    Shape {
        inputs: 2,
        hidden: hidden.to_vec(),
        outputs: 1,
    }
}

fn trainer(hidden: &[usize], data: &Dataset, settings: TrainingSettings) -> Trainer {
    Trainer::new(shape(hidden), data.scaling().unwrap(), data, settings).unwrap()
}

fn bits(weights: &[f64]) -> Vec<u64> {
    weights.iter().map(|w| w.to_bits()).collect()
}

fn smooth(x: f64, y: f64) -> f64 {
    x + 0.3 * (2.0 * x).sin() * y + 0.1 * y * y
}

#[test]
fn purelin_network_recovers_a_linear_map_to_rounding() {
    let data = data(500, |x, y| 0.7 * x - 2.0 * y + 3.0);
    for settings in [
        TrainingSettings {
            epochs: 20,
            min_gradient: 0.0,
            ..TrainingSettings::default()
        },
        TrainingSettings {
            epochs: 0,
            initialisation: Initialisation::LinearStart,
            ..TrainingSettings::default()
        },
    ] {
        let mut trainer = trainer(&[], &data, settings);
        trainer.run(|_| ());
        let network = trainer.network();
        let mut scratch = network.scratch();
        assert_eq!((data.input(500), data.target(500)), (None, None));
        for s in 0..data.len() {
            let input = data.input(s).unwrap();
            let y = network.predict_one(input, &mut scratch).unwrap();
            // Values up to 10, a handful of roundings each way: 3.6e-15 measured.
            assert!((y - data.target(s).unwrap()[0]).abs() < 2e-14);
        }
    }
}

#[test]
fn linear_start_begins_at_the_linear_map() {
    let data = data(400, |x, y| x - y + 1e-3 * (5.0 * x).tanh());
    let settings = TrainingSettings {
        initialisation: Initialisation::LinearStart,
        ..TrainingSettings::default()
    };
    let start = trainer(&[6, 3], &data, settings.clone()).loss();
    let linear = trainer(&[], &data, settings).loss();
    // The same sums: equal measured, a few roundings where kernels differ.
    assert!((start / linear - 1.0).abs() < 2e-15, "{start} {linear}");
}

#[test]
fn levenberg_marquardt_fits_a_smooth_function() {
    let data = data(800, smooth);
    for initialisation in [
        Initialisation::NguyenWidrow,
        Initialisation::LinearStart,
        Initialisation::DataAdapted { axis_aligned: 0.5 },
    ] {
        let settings = TrainingSettings {
            epochs: 60,
            initialisation,
            // Neurons as steep as the data-adapted ones are hard to move by
            // the joint step alone.
            resolve_output: matches!(initialisation, Initialisation::DataAdapted { .. }),
            ..TrainingSettings::default()
        };
        let mut trainer = trainer(&[8, 5], &data, settings);
        let mut before = trainer.loss();
        trainer.run(|report| {
            assert!(report.loss <= before);
            before = report.loss;
        });
        // A thousandth of the range in RMS, far below what a linear map leaves.
        assert!(
            trainer.loss() < 1e-6,
            "{initialisation:?}: {}",
            trainer.loss()
        );
    }
}

/// A network can be fitted to what another of its shape computes.
#[test]
fn goal_is_met_on_a_realisable_function() {
    let data = data(300, |x, y| x + 0.5 * (2.0 * x - y).tanh());
    let settings = TrainingSettings {
        epochs: 200,
        goal: 1e-18,
        min_gradient: 0.0,
        resolve_output: true,
        normalisation: Normalisation::Mean,
        ..TrainingSettings::default()
    };
    let mut trainer = trainer(&[2], &data, settings);
    assert_eq!(trainer.run(|_| ()), TrainingOutcome::GoalMet);
    let epochs = trainer.history().len();
    let again = trainer.epoch();
    assert_eq!(again.epoch, epochs);
    assert_eq!(trainer.history().len(), epochs);
}

#[test]
fn resolving_the_output_layer_never_hurts_the_first_step() {
    let data = data(300, smooth);
    let loss = |resolve_output| {
        let settings = TrainingSettings {
            resolve_output,
            ..TrainingSettings::default()
        };
        let mut trainer = trainer(&[5], &data, settings);
        trainer.epoch().loss
    };
    assert!(loss(true) <= loss(false));
}

#[test]
fn bits_do_not_depend_on_the_threads() {
    // 3000 samples and 514 parameters: several blocks, tasks and panels.
    let data = data(3000, smooth);
    let run = |threads| {
        let settings = TrainingSettings {
            epochs: 3,
            threads,
            resolve_output: true,
            ..TrainingSettings::default()
        };
        let mut trainer = trainer(&[17, 9, 5], &data, settings);
        trainer.run(|_| ());
        (
            bits(trainer.network().weights()),
            trainer.history().to_vec(),
        )
    };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(4));
}

/// In a pool of the caller's, and in rayon's global one.
#[test]
fn bits_do_not_depend_on_the_pool() {
    let data = data(1000, smooth);
    let run = |caller_pool| {
        let settings = TrainingSettings {
            epochs: 2,
            threads: 1,
            caller_pool,
            resolve_output: true,
            ..TrainingSettings::default()
        };
        let mut trainer = trainer(&[17, 9, 5], &data, settings);
        trainer.run(|_| ());
        bits(trainer.network().weights())
    };
    let own = run(false);
    assert_eq!(own, run(true));
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        assert_eq!(own, pool.build().unwrap().install(|| run(true)));
    }
}

#[test]
fn resumed_training_gives_the_same_bits() {
    let data = data(300, smooth);
    let settings = |epochs| TrainingSettings {
        epochs,
        validation: Some(EarlyStopping {
            fraction: 0.2,
            patience: 50,
        }),
        seed: 3,
        ..TrainingSettings::default()
    };
    let mut whole = trainer(&[6, 4], &data, settings(12));
    whole.run(|_| ());
    let mut first = trainer(&[6, 4], &data, settings(5));
    assert_eq!(first.run(|_| ()), TrainingOutcome::EpochsDone);
    let mut checkpoint = first.checkpoint();
    checkpoint.settings.epochs = 12;
    let mut second = Trainer::resume(&data, checkpoint.clone()).unwrap();
    second.run(|_| ());
    assert_eq!(whole.history(), second.history());
    assert_eq!(
        bits(whole.network().weights()),
        bits(second.network().weights())
    );
    assert_eq!(whole.checkpoint(), second.checkpoint());
    let other = self::data(300, |x, _| x);
    assert!(matches!(
        Trainer::resume(&other, checkpoint),
        Err(Error::OtherData { .. })
    ));
}

#[test]
fn early_stopping_returns_the_best_network() {
    // Few samples, much noise, many neurons: the validation loss must turn.
    let noise = |x: f64, y: f64| x + (1e4 * (x + 7.3 * y)).sin();
    let data = data(80, noise);
    let settings = TrainingSettings {
        epochs: 200,
        validation: Some(EarlyStopping {
            fraction: 0.3,
            patience: 6,
        }),
        ..TrainingSettings::default()
    };
    let mut trainer = trainer(&[12], &data, settings);
    assert_eq!(trainer.run(|_| ()), TrainingOutcome::ValidationStopped);
    let losses: Vec<f64> = (trainer.history().iter())
        .map(|r| r.validation_loss.unwrap())
        .collect();
    let best = losses.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!(losses[losses.len() - 7], best);
    assert_ne!(
        bits(trainer.network().weights()),
        bits(trainer.latest_network().weights())
    );
}

#[test]
fn damping_limit_ends_a_training_that_cannot_go_on() {
    // Too few neurons: the loss has a minimum above zero.
    let data = data(100, |x, y| (3.0 * x).sin() * y);
    let settings = TrainingSettings {
        epochs: 2000,
        min_gradient: 0.0,
        ..TrainingSettings::default()
    };
    let mut trainer = trainer(&[], &data, settings);
    assert_eq!(trainer.run(|_| ()), TrainingOutcome::DampingLimit);
}

#[test]
fn bad_settings_and_data_are_refused() {
    let data = data(50, smooth);
    let wrong = [
        TrainingSettings {
            initial_damping: 0.0,
            ..TrainingSettings::default()
        },
        TrainingSettings {
            damping_increase: 1.0,
            ..TrainingSettings::default()
        },
        TrainingSettings {
            damping_decrease: f64::NAN,
            ..TrainingSettings::default()
        },
        TrainingSettings {
            validation: Some(EarlyStopping {
                fraction: 1.0,
                patience: 6,
            }),
            ..TrainingSettings::default()
        },
        TrainingSettings {
            initialisation: Initialisation::DataAdapted { axis_aligned: 1.5 },
            ..TrainingSettings::default()
        },
    ];
    for settings in wrong {
        let refused = Trainer::new(shape(&[3]), data.scaling().unwrap(), &data, settings);
        assert!(matches!(refused, Err(Error::Setting { .. })));
    }
    assert!(Dataset::new(2, 1, vec![1.0; 5], vec![1.0; 2]).is_err());
    assert!(Dataset::new(2, 1, vec![1.0; 4], vec![1.0, f64::NAN]).is_err());
    assert!(Dataset::new(2, 1, vec![], vec![]).is_err());
}
