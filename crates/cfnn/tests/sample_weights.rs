//! Samples with weights: as if they were there several times, and weighted least squares.

use cfnn::train::{Dataset, Initialisation, Trainer, TrainingSettings};
use cfnn::{Error, Scaling, Shape};

use crate::support::uniform;

fn shape(hidden: &[usize]) -> Shape {
    Shape {
        inputs: 1,
        hidden: hidden.to_vec(),
        outputs: 2,
    }
}

fn scaling() -> Scaling {
    Scaling::from_ranges(&[(-1.0, 1.0)], &[(-1.0, 1.0); 2]).unwrap()
}

/// 300 samples, two blocks; with weights 0 to 3, or repeated as often.
fn samples(repeated: bool) -> Dataset {
    let (mut input, mut target, mut weights) = (vec![], vec![], vec![]);
    for k in 0..300 {
        let x = uniform(k);
        let times = if repeated { k % 4 } else { 1 };
        for _ in 0..times {
            input.push(x);
            target.extend([0.5 * libm::sin(4.0 * x), 0.3 * uniform(17 * k)]);
        }
        weights.push((k % 4) as f64);
    }
    let data = Dataset::new(1, 2, input, target).unwrap();
    if repeated {
        data
    } else {
        data.with_weights(weights).unwrap()
    }
}

/// The order of the sums differs; four steps enlarge that: 2.0e-12 of the loss and 4.4e-10 of the
/// weights measured.
#[test]
fn a_weight_counts_as_so_many_samples() {
    for (initialisation, resolve_output) in [
        (Initialisation::NguyenWidrow, false),
        (Initialisation::LinearStart, true),
    ] {
        let trained = |data: &Dataset| {
            let settings = TrainingSettings {
                epochs: 4,
                initial_damping: 1.0,
                threads: 1,
                initialisation,
                resolve_output,
                ..TrainingSettings::default()
            };
            let mut trainer = Trainer::new(shape(&[4, 3]), scaling(), data, settings).unwrap();
            trainer.run(|_| ());
            (trainer.network(), trainer.loss() * data.len() as f64)
        };
        let (weighted, loss) = trained(&samples(false));
        let (repeated, other) = trained(&samples(true));
        assert!(
            (loss - other).abs() < 6e-12 * other,
            "{loss} against {other}"
        );
        for (w, r) in weighted.weights().iter().zip(repeated.weights()) {
            assert!((w - r).abs() < 1.3e-9 * (1.0 + r.abs()), "{w} against {r}");
        }
    }
}

/// The line through weighted points, by the closed form of its slope: 1.7e-15 measured.
#[test]
fn a_line_is_the_weighted_regression() {
    let x: Vec<f64> = (0..50).map(uniform).collect();
    let y: Vec<f64> = x
        .iter()
        .enumerate()
        .map(|(k, x)| 0.3 * x + 0.2 * uniform(5 * k))
        .collect();
    let weights: Vec<f64> = (0..50).map(|k| 1.0 + uniform(3 * k)).collect();
    let sum = |f: &dyn Fn(usize) -> f64| (0..50).map(|k| weights[k] * f(k)).sum::<f64>();
    let total = sum(&|_| 1.0);
    let (mx, my) = (sum(&|k| x[k]) / total, sum(&|k| y[k]) / total);
    let slope = sum(&|k| (x[k] - mx) * (y[k] - my)) / sum(&|k| (x[k] - mx) * (x[k] - mx));
    let scaling = Scaling::from_ranges(&[(-1.0, 1.0)], &[(-1.0, 1.0)]).unwrap();
    let data = Dataset::new(1, 1, x, y)
        .unwrap()
        .with_weights(weights)
        .unwrap();
    let settings = TrainingSettings {
        initialisation: Initialisation::LinearStart,
        threads: 1,
        ..TrainingSettings::default()
    };
    let line = Shape {
        outputs: 1,
        ..shape(&[])
    };
    let trainer = Trainer::new(line, scaling, &data, settings).unwrap();
    let network = trainer.network();
    let found = [my - slope * mx, slope];
    for (w, expected) in network.weights().iter().zip(found) {
        assert!((w - expected).abs() < 5e-15, "{w} against {expected}");
    }
}

#[test]
fn weights_are_part_of_the_data() {
    let data = Dataset::new(1, 1, vec![0.0, 1.0], vec![0.0, 1.0]).unwrap();
    let with = |weights: &[f64]| data.clone().with_weights(weights.to_vec());
    assert_ne!(with(&[1.0, 2.0]).unwrap().fingerprint(), data.fingerprint());
    assert!(matches!(with(&[1.0]), Err(Error::Length { .. })));
    assert!(matches!(
        with(&[1.0, f64::NAN]),
        Err(Error::NotFinite { index: 1, .. })
    ));
    assert!(matches!(
        with(&[1.0, -1.0]),
        Err(Error::Negative { index: 1, .. })
    ));
    assert!(matches!(with(&[0.0, 0.0]), Err(Error::Negative { .. })));
}
