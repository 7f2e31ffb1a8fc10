//! Training and prediction of the paper's network.

use std::hint::black_box;

use cfnn::train::{Dataset, Trainer, TrainingSettings, nguyen_widrow};
use cfnn::{FixedNetwork, Network, Predictor, Scaling, ScalingRange, Shape};
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::{Accum, Mat, Par};
use miette::{IntoDiagnostic, Result};

use super::timing::{least, least_of_calls};
use super::{Plan, Row};

const HIDDEN: [usize; 3] = [34, 19, 8];

fn shape() -> Shape {
    Shape {
        inputs: 4,
        hidden: HIDDEN.to_vec(),
        outputs: 1,
    }
}

pub fn rows(plan: &Plan) -> Result<Vec<Row>> {
    let mut rows = vec![epoch(plan)?];
    rows.extend(predictions(plan)?);
    Ok(rows)
}

/// An additive recurrence with irrational steps fills the cube evenly.
fn data(samples: usize) -> Result<Dataset> {
    let steps = [2.0f64, 3.0, 5.0, 7.0].map(f64::sqrt);
    let input: Vec<f64> = (1..=samples)
        .flat_map(|s| steps.map(|step| (s as f64 * step).fract() * 2.0 - 1.0))
        .collect();
    let target = input
        .chunks(4)
        .map(|x| x[0] + 0.1 * (20.0 * x[1]).tanh() + 0.05 * x[2] * x[3])
        .collect();
    Dataset::new(4, 1, input, target).into_diagnostic()
}

fn epoch(plan: &Plan) -> Result<Row> {
    let samples = plan.size(5000, 250);
    let data = data(samples)?;
    let settings = TrainingSettings {
        threads: plan.threads,
        epochs: usize::MAX,
        ..TrainingSettings::default()
    };
    let scaling = data.scaling().into_diagnostic()?;
    let mut trainer = Trainer::new(shape(), scaling, &data, settings).into_diagnostic()?;
    let n = shape().parameters();
    let jacobian = Mat::from_fn(samples, n, |i, j| ((i * 31 + j * 17) % 101) as f64 / 101.0);
    let mut square = Mat::<f64>::zeros(n, n);
    let mut product = || {
        triangular::matmul(
            square.as_mut(),
            BlockStructure::TriangularLower,
            Accum::Replace,
            jacobian.transpose(),
            BlockStructure::Rectangular,
            jacobian.as_ref(),
            BlockStructure::Rectangular,
            1.0,
            Par::rayon(plan.threads),
        );
    };
    // A settled training: one step refused, one taken.
    let two_trials = |trainer: &mut Trainer| while trainer.epoch().trials != 2 {};
    let patience = if plan.quick { 0 } else { 6 };
    for _ in 0..patience {
        trainer.epoch();
    }
    let [epoch, product] = least(
        plan.repetitions,
        [
            &mut || {
                if plan.quick {
                    trainer.epoch();
                } else {
                    two_trials(&mut trainer);
                }
            },
            &mut || plan.pool.install(&mut product),
        ],
    );
    Ok(Row {
        name: format!("epoch of 4-34-19-8-1, {samples} samples"),
        value: epoch,
        unit: "s",
        ratio: product / epoch,
        against: "faer's triangular product of the Jacobian",
    })
}

fn predictions(plan: &Plan) -> Result<Vec<Row>> {
    let ranges = [(-1.0, 1.0); 4];
    let scaling = Scaling::from_ranges(&ranges, &ranges[..1]).into_diagnostic()?;
    let weights = nguyen_widrow(&shape(), 1).into_diagnostic()?;
    let network = Network::new(shape(), scaling, weights).into_diagnostic()?;
    let single: Vec<f32> = network.packed_weights().iter().map(|&w| w as f32).collect();
    let unit = ScalingRange::new("bench", -1.0f32, 1.0).into_diagnostic()?;
    let fixed = FixedNetwork::<f32, 4, 1, 66>::new(&HIDDEN, &single, [unit; 4], [unit])
        .into_diagnostic()?;
    let plainly = network.clone();
    let mut predictor = Predictor::<4, 1>::new(network).into_diagnostic()?;
    let x = [0.1, -0.2, 0.3, 0.4];
    let [double, single, plain] = least_of_calls(
        plan.repetitions,
        plan.size(100, 10),
        [
            &mut || {
                black_box(predictor.predict(black_box(&x)));
            },
            &mut || {
                black_box(fixed.evaluate(black_box(&x.map(|x| x as f32))));
            },
            &mut || {
                black_box(plain(&plainly, black_box(&x)));
            },
        ],
    );
    let row = |name: &str, value: f64| Row {
        name: format!("prediction of 4-34-19-8-1, {name}"),
        value,
        unit: "s",
        ratio: plain / value,
        against: "the formula written down, f64",
    };
    Ok(vec![row("f64", double), row("f32, no_std", single)])
}

/// The network of one output as its definition says, on inputs in [-1, 1].
fn plain(network: &Network, input: &[f64; 4]) -> f64 {
    let mut seen = vec![1.0];
    seen.extend(input);
    let layers = network.shape().layers();
    let mut last = 0.0;
    for (l, layer) in layers.iter().enumerate() {
        let weights = &network.weights()[layer.first_parameter..];
        let sums: Vec<f64> = (0..layer.neurons)
            .map(|j| {
                let terms = seen.iter().enumerate();
                terms.map(|(i, a)| weights[i * layer.neurons + j] * a).sum()
            })
            .collect();
        if l + 1 == layers.len() {
            last = sums[0];
        } else {
            seen.extend(sums.iter().map(|sum| sum.tanh()));
        }
    }
    last
}
