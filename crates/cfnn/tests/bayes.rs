//! Bayesian regularisation: the evidence of a linear network in closed form, and noisy samples.

use cfnn::train::{
    Bayesian, Checkpoint, Dataset, Hyperparameters, Normalisation, Trainer, TrainingOutcome,
    TrainingSettings,
};
use cfnn::{Error, Shape};

use crate::support::uniform;

fn settings() -> TrainingSettings {
    TrainingSettings {
        epochs: 2000,
        min_gradient: 0.0,
        threads: 1,
        ..TrainingSettings::regularised()
    }
}

/// Normal noise of deviation 1 (Box and Muller), number `k` of a linear congruential generator.
fn noise(k: usize) -> f64 {
    let mut state = k as u64;
    let mut next = || {
        state =
            (state.wrapping_mul(6_364_136_223_846_793_005)).wrapping_add(1_442_695_040_888_963_407);
        // Twice, since neighbouring numbers have neighbouring states.
        state = (state ^ (state >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        ((state >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    };
    let radius = libm::sqrt(-2.0 * libm::log(next()));
    radius * libm::cos(2.0 * std::f64::consts::PI * next())
}

/// Logarithm of the density of the targets if weights and noise are normal with variances `1/(2α)`
/// and `1/(2β)`: that of a normal vector with the covariance `C = ΦΦᵀ/(2α) + I/(2β)`, in which no
/// weight occurs (MacKay 1992, its equation before the expansion in the weights). With the expected
/// weights `Φᵀ C⁻¹ t / (2α)`.
fn evidence(rows: &[Vec<f64>], targets: &[f64], alpha: f64, beta: f64) -> (f64, Vec<f64>) {
    let n = rows.len();
    let mut c = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..n {
            let product: f64 = rows[i].iter().zip(&rows[j]).map(|(a, b)| a * b).sum();
            c[i][j] = product / (2.0 * alpha) + if i == j { 0.5 / beta } else { 0.0 };
        }
    }
    // Gaussian elimination of [C | t]; the pivots give the determinant.
    let mut t = targets.to_vec();
    let mut logarithm = 0.0;
    for k in 0..n {
        logarithm += libm::log(c[k][k]);
        for i in k + 1..n {
            let factor = c[i][k] / c[k][k];
            let (above, below) = c.split_at_mut(i);
            for (to, from) in below[0].iter_mut().zip(&above[k]).skip(k) {
                *to -= factor * from;
            }
            t[i] -= factor * t[k];
        }
    }
    for k in (0..n).rev() {
        let later: f64 = (k + 1..n).map(|j| c[k][j] * t[j]).sum();
        t[k] = (t[k] - later) / c[k][k];
    }
    let square: f64 = t.iter().zip(targets).map(|(a, b)| a * b).sum();
    let weights = (0..rows[0].len())
        .map(|w| rows.iter().zip(&t).map(|(row, t)| row[w] * t).sum::<f64>() / (2.0 * alpha))
        .collect();
    (-0.5 * (square + logarithm), weights)
}

/// A network without hidden layers is ridge regression: its α and β are where the evidence is largest,
/// its weights the expected ones, and `γ = 2 α Σ w²` of those.
#[test]
fn a_linear_network_finds_the_largest_evidence() {
    let (inputs, n) = (3, 40);
    let input: Vec<f64> = (0..n * inputs).map(|k| uniform(7 * k + 1)).collect();
    let target: Vec<f64> = (input.chunks(inputs).enumerate())
        .map(|(k, x)| 0.4 * x[0] - 0.1 * x[1] + 0.1 + 0.3 * noise(k))
        .collect();
    let data = Dataset::new(inputs, 1, input.clone(), target.clone()).unwrap();
    let scaling = data.scaling().unwrap();
    let rows: Vec<Vec<f64>> = (input.chunks(inputs))
        .map(|x| {
            let scaled = x
                .iter()
                .zip(scaling.input())
                .map(|(x, range)| range.to_unit(*x));
            std::iter::once(1.0).chain(scaled).collect()
        })
        .collect();
    let targets: Vec<f64> = target
        .iter()
        .map(|t| scaling.output()[0].to_unit(*t))
        .collect();
    let shape = Shape {
        inputs,
        hidden: vec![],
        outputs: 1,
    };
    let mut trainer = Trainer::new(shape, scaling, &data, settings()).unwrap();
    // Where rounding leaves no step that lowers the function.
    assert_eq!(trainer.run(|_| ()), TrainingOutcome::DampingLimit);
    let found = trainer.hyperparameters().unwrap();
    let Hyperparameters {
        alpha,
        beta,
        effective_parameters,
    } = found;
    let at =
        |a: f64, b: f64| evidence(&rows, &targets, alpha * libm::exp(a), beta * libm::exp(b)).0;
    let h = 1e-3;
    // Slopes by differences err by h² times a third derivative of about 1, 1e-6, of values near -20:
    // 6.9e-8 and 3.0e-6 measured.
    let slopes = [at(h, 0.0) - at(-h, 0.0), at(0.0, h) - at(0.0, -h)].map(|d| d / (2.0 * h));
    assert!(slopes.iter().all(|s| s.abs() < 9e-6), "{slopes:?}");
    for (a, b) in [(0.05, 0.0), (-0.05, 0.0), (0.0, 0.05), (0.0, -0.05)] {
        assert!(at(a, b) < at(0.0, 0.0), "larger beside {found:?}");
    }
    let (_, weights) = evidence(&rows, &targets, alpha, beta);
    // The function says nothing about weights closer than the root of its rounding, 1e-8 of them: 1.7e-9
    // measured.
    for (w, expected) in trainer.network().weights().iter().zip(&weights) {
        assert!((w - expected).abs() < 5e-9, "{w} against {expected}");
    }
    // 1.1e-8 of it measured.
    let gamma = 2.0 * alpha * weights.iter().map(|w| w * w).sum::<f64>();
    assert!(
        (effective_parameters - gamma).abs() < 3e-8 * gamma,
        "{effective_parameters} against {gamma}"
    );
    // The noise's deviation is 0.3 of the caller's units.
    assert!(effective_parameters > 1.0 && effective_parameters < 4.0);
}

/// 20 noisy samples of a sine, 31 parameters: mean squared errors on samples without noise.
fn errors_on_a_sine(seed: u64) -> [f64; 2] {
    let n = 20;
    let input: Vec<f64> = (0..n)
        .map(|k| 2.0 * k as f64 / (n - 1) as f64 - 1.0)
        .collect();
    let target = (input.iter().enumerate())
        .map(|(k, x)| libm::sin(std::f64::consts::PI * x) + 0.2 * noise(k + 1000 * seed as usize))
        .collect();
    let data = Dataset::new(1, 1, input, target).unwrap();
    let shape = Shape {
        inputs: 1,
        hidden: vec![10],
        outputs: 1,
    };
    let plain = TrainingSettings {
        epochs: 300,
        threads: 1,
        seed,
        ..TrainingSettings::default()
    };
    let bayesian = TrainingSettings {
        epochs: 300,
        threads: 1,
        seed,
        ..TrainingSettings::regularised()
    };
    [plain, bayesian].map(|settings| {
        let scaling = data.scaling().unwrap();
        let mut trainer = Trainer::new(shape.clone(), scaling, &data, settings).unwrap();
        trainer.run(|_| ());
        let network = trainer.network();
        let mut scratch = network.scratch();
        let square = |k: i32| {
            let x = f64::from(k) / 200.0;
            let error = network.predict_one(&[x], &mut scratch).unwrap()
                - libm::sin(std::f64::consts::PI * x);
            error * error
        };
        (-200..=200).map(square).sum::<f64>() / 401.0
    })
}

/// Of ten seeds all are better, by a factor of 3.2 at least and of 8.5 in the middle (measured); the limits
/// are a third of that.
#[test]
fn noisy_samples_are_smoothed() {
    let mut gains: Vec<f64> = (0..10)
        .map(|seed| {
            let [plain, bayesian] = errors_on_a_sine(seed);
            plain / bayesian
        })
        .collect();
    gains.sort_by(f64::total_cmp);
    assert!(gains[0] > 1.1 && gains[5] > 2.8, "{gains:?}");
}

fn sine() -> Dataset {
    let input: Vec<f64> = (0..60).map(uniform).collect();
    let target = (input.iter().enumerate()).map(|(k, x)| libm::sin(3.0 * x) + 0.1 * noise(k));
    let target = target.collect();
    Dataset::new(1, 1, input, target).unwrap()
}

fn trainer(data: &Dataset, settings: TrainingSettings) -> Result<Trainer, Error> {
    let shape = Shape {
        inputs: 1,
        hidden: vec![9, 5],
        outputs: 1,
    };
    Trainer::new(shape, data.scaling()?, data, settings)
}

/// Every report has its estimates, within their bounds; a checkpoint goes on with the same bits.
#[test]
fn estimates_are_reported_and_resumed() {
    let data = sine();
    let of = |epochs| TrainingSettings {
        epochs,
        ..settings()
    };
    let mut whole = trainer(&data, of(30)).unwrap();
    whole.run(|report| {
        let h = report.hyperparameters.unwrap();
        assert!(h.alpha > 0.0 && h.beta > 0.0, "{h:?}");
        assert!((0.0..=89.0).contains(&h.effective_parameters), "{h:?}");
    });
    let mut first = trainer(&data, of(11)).unwrap();
    first.run(|_| ());
    let mut checkpoint: Checkpoint = first.checkpoint();
    checkpoint.settings.epochs = 30;
    let mut second = Trainer::resume(&data, checkpoint).unwrap();
    second.run(|_| ());
    assert_eq!(whole.history(), second.history());
    assert_eq!(whole.network(), second.network());
    assert_eq!(whole.hyperparameters(), second.hyperparameters());
}

#[test]
fn bits_do_not_depend_on_the_threads() {
    let data = sine();
    let run = |threads| {
        let shape = Shape {
            inputs: 1,
            // 366 parameters: several tiles of the factor and its inverse.
            hidden: vec![20, 12],
            outputs: 1,
        };
        let settings = TrainingSettings {
            threads,
            epochs: 8,
            ..settings()
        };
        let mut trainer = Trainer::new(shape, data.scaling().unwrap(), &data, settings).unwrap();
        trainer.run(|_| ());
        trainer.checkpoint().history().to_vec()
    };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(3));
}

/// Samples without noise, and more parameters than samples: nothing overflows.
#[test]
fn samples_without_noise_are_fitted() {
    let x: Vec<f64> = (0..6).map(f64::from).collect();
    let y = x.iter().map(|x| 2.0 * x).collect();
    let data = Dataset::new(1, 1, x, y).unwrap();
    let mut trainer = trainer(&data, settings()).unwrap();
    trainer.run(|_| ());
    let h = trainer.hyperparameters().unwrap();
    assert!(h.beta.is_finite() && h.alpha.is_finite(), "{h:?}");
    // A little of the weights is always drawn to zero: 3.4e-9 measured.
    assert!(trainer.loss() < 1e-8, "{}", trainer.loss());
}

#[test]
fn settings_that_do_not_go_together_are_refused() {
    let data = sine();
    for wrong in [
        TrainingSettings {
            resolve_output: true,
            ..settings()
        },
        TrainingSettings {
            normalisation: Normalisation::Mean,
            ..settings()
        },
        TrainingSettings {
            bayesian: Some(Bayesian {
                tolerance: f64::NAN,
                ..Bayesian::default()
            }),
            ..settings()
        },
        TrainingSettings {
            bayesian: Some(Bayesian {
                estimate_below: 0.0,
                ..Bayesian::default()
            }),
            ..settings()
        },
    ] {
        assert!(matches!(trainer(&data, wrong), Err(Error::Setting { .. })));
    }
}
