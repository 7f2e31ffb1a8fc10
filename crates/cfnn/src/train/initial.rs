//! Starting weights of the hidden layers.

use std::vec;
use std::vec::Vec;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::dataset::Dataset;
use crate::{Activation, Architecture, Error, Layer, Scaling, Shape};

/// Random numbers for one purpose, independent of the other purposes.
pub(super) fn generator(seed: u64, purpose: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(purpose);
    rng
}

/// Nguyen–Widrow starting weights from a seed, in the network's own order.
///
/// A hidden layer of `H` neurons over `R` inputs in `[-1, 1]` gets random
/// directions of length `1.4 H^{1/R}` and biases spread evenly, so that the
/// active parts of the neurons (net input -2 to 2) cover the inputs. Twice
/// the 0.7 of Nguyen and Widrow (1990), because MATLAB's `initnw` stretches
/// to tansig's active range. The output layer is uniform in `[-1, 1]`.
///
/// Earlier layers count as inputs of the later ones, since tansig's range is
/// `[-1, 1]` too.
///
/// # Errors
/// What [`Shape::validate`] refuses.
pub fn nguyen_widrow(shape: &Shape, seed: u64) -> Result<Vec<f64>, Error> {
    // Before the clone, which an invalid shape may be too large for.
    shape.validate()?;
    starting_weights(&Architecture::from(shape.clone()), seed)
}

/// Starting weights of any architecture: those of [`nguyen_widrow`], with
/// neurons that look along the links that there are. Logsig neurons have
/// twice the weights, since `logsig n = (1 + tanh(n/2))/2`. Purelin and poslin
/// have no active part: their weights are uniform with the variance `2/R` for
/// `R` links (He et al. 2015, doi 10.1109/ICCV.2015.123), their biases in
/// `[-1, 1]`.
///
/// # Errors
/// What [`Architecture::validate`] refuses.
pub fn starting_weights(architecture: &Architecture, seed: u64) -> Result<Vec<f64>, Error> {
    architecture.validate()?;
    let shape = architecture.shape();
    let mut rng = generator(seed, 0);
    let layers = shape.layers();
    let mut weights = vec![0.0; shape.parameters()];
    for (index, layer) in layers.iter().enumerate() {
        let own = &mut weights[layer.first_parameter..][..layer.parameters()];
        let seen = architecture.seen(index);
        let links: Vec<usize> = (1..layer.seen).filter(|&i| seen[i]).collect();
        if index + 1 == layers.len() {
            for (&sees, row) in seen.iter().zip(own.chunks_exact_mut(layer.neurons)) {
                if sees {
                    row.fill_with(|| symmetric(&mut rng));
                }
            }
            continue;
        }
        match architecture.transfer(index) {
            Activation::Tansig => nguyen_widrow_layer(1.4, layer, &links, own, &mut rng),
            Activation::Logsig => nguyen_widrow_layer(2.8, layer, &links, own, &mut rng),
            Activation::Purelin | Activation::Poslin => uniform_layer(layer, &links, own, &mut rng),
        }
    }
    Ok(weights)
}

fn symmetric(rng: &mut ChaCha8Rng) -> f64 {
    2.0 * rng.random::<f64>() - 1.0
}

fn uniform_layer(layer: &Layer, links: &[usize], own: &mut [f64], rng: &mut ChaCha8Rng) {
    let bound = libm::sqrt(6.0 / links.len() as f64);
    for j in 0..layer.neurons {
        own[j] = symmetric(rng);
        for &i in links {
            own[i * layer.neurons + j] = bound * symmetric(rng);
        }
    }
}

/// `active` is half the width of the active part, times 0.7.
fn nguyen_widrow_layer(
    active: f64,
    layer: &Layer,
    links: &[usize],
    own: &mut [f64],
    rng: &mut ChaCha8Rng,
) {
    let neurons = layer.neurons;
    let magnitude = active * libm::pow(neurons as f64, 1.0 / links.len() as f64);
    for j in 0..neurons {
        let direction = direction(links.len(), rng);
        for (&i, u) in links.iter().zip(&direction) {
            own[i * neurons + j] = magnitude * u;
        }
        let place = if neurons == 1 {
            0.0
        } else {
            2.0 * j as f64 / (neurons - 1) as f64 - 1.0
        };
        own[j] = magnitude * place * 1f64.copysign(direction[0]);
    }
}

/// A vector uniform in the cube, scaled to length 1; at least one dimension.
fn direction(dimensions: usize, rng: &mut ChaCha8Rng) -> Vec<f64> {
    loop {
        let v: Vec<f64> = (0..dimensions).map(|_| symmetric(rng)).collect();
        let length = libm::sqrt(v.iter().map(|x| x * x).sum());
        if length > 1e-3 {
            return v.iter().map(|x| x / length).collect();
        }
    }
}

/// What [`adapt_first_layer`] looks at.
pub(super) struct Placement<'a> {
    pub data: &'a Dataset,
    /// Training samples.
    pub chosen: &'a [usize],
    pub scaling: &'a Scaling,
    /// Inputs that the layer sees.
    pub inputs: &'a [usize],
    pub axis_aligned: f64,
    pub seed: u64,
}

/// Replaces the first hidden layer by neurons placed by the samples: see
/// [`super::Initialisation::DataAdapted`].
pub(super) fn adapt_first_layer(weights: &mut [f64], layer: &Layer, place: &Placement<'_>) {
    let (chosen, inputs) = (place.chosen, place.inputs);
    let mut rng = generator(place.seed, 2);
    let scaled = |s: usize, i: usize| place.data.scaled_input(place.scaling, s, i);
    let sorted: Vec<Vec<f64>> = (inputs.iter())
        .map(|&i| {
            let mut column: Vec<f64> = chosen.iter().map(|&s| scaled(s, i)).collect();
            column.sort_by(f64::total_cmp);
            column
        })
        .collect();
    let aligned = libm::round(place.axis_aligned * layer.neurons as f64) as usize;
    for j in 0..layer.neurons {
        let centre = chosen[rng.random_range(0..chosen.len())];
        let share = scale(layer.neurons, &mut rng);
        let direction = if j < aligned {
            (0..inputs.len())
                .map(|i| f64::from(i == j % inputs.len()))
                .collect()
        } else {
            direction(inputs.len(), &mut rng)
        };
        let mut bias = 0.0;
        for ((&i, u), sorted) in inputs.iter().zip(&direction).zip(&sorted) {
            let c = scaled(centre, i);
            let w = 1.4 * u / half_spread(sorted, c, share);
            weights[(i + 1) * layer.neurons + j] = w;
            bias -= w * c;
        }
        weights[j] = bias;
    }
}

/// Share of the samples that a neuron's active part covers on either side:
/// log-uniform from a quarter of an even share up to a half.
fn scale(neurons: usize, rng: &mut ChaCha8Rng) -> f64 {
    0.5 * libm::pow(2.0 * neurons as f64, -rng.random::<f64>())
}

/// Half the width of the interval around `centre` that holds the given share
/// of the samples on either side.
fn half_spread(sorted: &[f64], centre: f64, share: f64) -> f64 {
    let last = sorted.len() - 1;
    let reach = (share * last as f64).max(1.0) as usize;
    let rank = sorted.partition_point(|&x| x < centre).min(last);
    let (low, high) = (rank.saturating_sub(reach), (rank + reach).min(last));
    let ranks = (high - low).max(1) as f64;
    let width = (sorted[high] - sorted[low]) * reach as f64 / ranks;
    // Repeated values have no spacing; below this a slope resolves nothing.
    width.max(1e-6)
}
