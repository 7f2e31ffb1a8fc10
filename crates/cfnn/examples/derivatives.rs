//! What an independent program can check: outputs, Jacobians and sensitivities of networks of every kind, a
//! regularised linear network and a regularised network with neurons, with the numbers that they follow from.
//! `docs/peers/cfnn/run` compares them.
//!
//! `cargo run --release -p cfnn --features train --example derivatives`
//!
//! Lines of `name,quantity,numbers...`; tables row by row.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use cfnn::train::{
    Bayesian, Dataset, Hyperparameters, Trainer, TrainingSettings, starting_weights,
};
use cfnn::{Activation, Architecture, Error, Links, Network, Scaling, Shape};

fn line(name: &str, quantity: &str, values: &[f64]) {
    let values: Vec<String> = values.iter().map(|v| format!("{v:e}")).collect();
    println!("{name},{quantity},{}", values.join(","));
}

/// A sequence that fills [-1, 1] evenly.
fn uniform(k: usize) -> f64 {
    2.0 * (k as f64 * 0.618_033_988_749_894_9).fract() - 1.0
}

fn describe(name: &str, network: &Network) {
    let architecture = network.architecture();
    let shape = architecture.shape();
    let code = |layer| match architecture.transfer(layer) {
        Activation::Tansig => 0.0,
        Activation::Logsig => 1.0,
        Activation::Purelin => 2.0,
        _ => 3.0,
    };
    let sizes = [shape.inputs]
        .into_iter()
        .chain(shape.hidden.iter().copied())
        .chain([shape.outputs]);
    line(name, "sizes", &sizes.map(|n| n as f64).collect::<Vec<_>>());
    let plain = architecture.links() == Links::FeedForward;
    line(name, "feed_forward", &[f64::from(u8::from(plain))]);
    line(
        name,
        "transfers",
        &(0..shape.hidden.len()).map(code).collect::<Vec<_>>(),
    );
    let dropped = architecture.dropped_inputs().iter().map(|&i| i as f64);
    line(name, "dropped", &dropped.collect::<Vec<_>>());
    let ends = |ranges: &[cfnn::ScalingRange<f64>]| -> Vec<f64> {
        ranges
            .iter()
            .flat_map(|r| [r.minimum(), r.maximum()])
            .collect()
    };
    line(name, "input_ranges", &ends(network.scaling().input()));
    line(name, "output_ranges", &ends(network.scaling().output()));
    line(name, "weights", network.weights());
}

/// Name, hidden layers, their transfer functions, links, dropped inputs.
type Case = (
    &'static str,
    &'static [usize],
    &'static [Activation],
    Links,
    &'static [usize],
);

fn networks() -> Result<(), Error> {
    use Activation::{Logsig, Poslin, Purelin, Tansig};
    let cases: [Case; 5] = [
        ("paper", &[34, 19, 8], &[Tansig; 3], Links::Cascade, &[]),
        ("plain", &[34, 19, 8], &[Tansig; 3], Links::FeedForward, &[]),
        ("logistic", &[12, 5], &[Logsig; 2], Links::Cascade, &[]),
        (
            "mixed",
            &[21, 1, 6],
            &[Poslin, Tansig, Purelin],
            Links::Cascade,
            &[2],
        ),
        ("linear", &[], &[], Links::FeedForward, &[0, 3]),
    ];
    for (name, hidden, transfers, links, dropped) in cases {
        let shape = Shape {
            inputs: 4,
            hidden: hidden.to_vec(),
            outputs: 2,
        };
        let architecture = Architecture::from(shape)
            .with_links(links)
            .with_transfers(transfers)?
            .without_inputs(dropped)?;
        let scaling = Scaling::from_ranges(
            &[(0.0, 1.5), (-0.33, 0.33), (-1.0, 1.0), (-15.0, 15.0)],
            &[(-3.0, 3.0), (0.0, 2.0)],
        )?;
        let weights = starting_weights(&architecture, 5)?;
        let network = Network::new(architecture, scaling, weights)?;
        describe(name, &network);
        let middle = [0.75, 0.0, 0.0, 0.0];
        let half = [0.75, 0.33, 1.0, 15.0];
        let rows: Vec<f64> = (0..40)
            .map(|k| middle[k % 4] + half[k % 4] * uniform(k))
            .collect();
        let mut outputs = [0.0; 20];
        network.evaluate_rows(&rows, &mut network.scratch(), &mut outputs)?;
        line(name, "inputs", &rows);
        line(name, "outputs", &outputs);
        line(name, "jacobian", &network.jacobian(&rows)?);
        line(name, "sensitivities", &network.sensitivities(&rows)?);
    }
    Ok(())
}

/// Samples of a function with an error that looks like noise.
fn regularised(name: &str, hidden: &[usize], f: impl Fn(&[f64]) -> f64) -> Result<(), Error> {
    let input: Vec<f64> = (0..80).map(|k| uniform(7 * k + 1)).collect();
    let noise = |k: usize| 0.2 * uniform(k * k * 31 + 17 * k);
    let target: Vec<f64> = (input.chunks(2).enumerate())
        .map(|(k, x)| f(x) + noise(k))
        .collect();
    let data = Dataset::new(2, 1, input.clone(), target.clone())?;
    let settings = TrainingSettings {
        epochs: 3000,
        min_gradient: 0.0,
        bayesian: Some(Bayesian {
            tolerance: 1e-10,
            ..Bayesian::default()
        }),
        threads: 1,
        ..TrainingSettings::regularised()
    };
    let shape = Shape {
        inputs: 2,
        hidden: hidden.to_vec(),
        outputs: 1,
    };
    let mut trainer = Trainer::new(shape, data.scaling()?, &data, settings)?;
    trainer.run(|_| ());
    describe(name, &trainer.network());
    line(name, "inputs", &input);
    line(name, "targets", &target);
    if let Some(found) = trainer.hyperparameters() {
        let Hyperparameters {
            alpha,
            beta,
            effective_parameters,
        } = found;
        line(name, "estimates", &[alpha, beta, effective_parameters]);
    }
    Ok(())
}

fn main() -> Result<(), Error> {
    networks()?;
    regularised("ridge", &[], |x| 0.5 * x[0] - 0.1 * x[1] + 0.2)?;
    regularised("neurons", &[6, 3], |x| (3.0 * x[0]).sin() * x[1])
}
