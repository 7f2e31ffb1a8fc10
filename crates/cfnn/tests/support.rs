//! What several tests need: any architecture, and a network written out by its definition.

use cfnn::{Activation, Architecture, Links, Shape};
use proptest::prelude::*;

pub const TRANSFERS: [Activation; 4] = [
    Activation::Tansig,
    Activation::Logsig,
    Activation::Purelin,
    Activation::Poslin,
];

/// A sequence that fills [-1, 1] evenly.
pub fn uniform(k: usize) -> f64 {
    2.0 * (k as f64 * 0.618_033_988_749_894_9).fract() - 1.0
}

/// Up to three hidden layers of any transfer functions, with one input dropped or none.
pub fn architectures() -> impl Strategy<Value = Architecture> {
    let hidden = prop::collection::vec((1..25usize, 0..4usize), 0..4);
    (1..4usize, hidden, 1..4usize, any::<bool>(), any::<bool>()).prop_map(
        |(inputs, hidden, outputs, plain, drop)| {
            let transfers: Vec<Activation> = hidden.iter().map(|&(_, t)| TRANSFERS[t]).collect();
            let shape = Shape {
                inputs,
                hidden: hidden.iter().map(|&(n, _)| n).collect(),
                outputs,
            };
            let dropped: &[usize] = if drop && inputs > 1 { &[1] } else { &[] };
            Architecture::from(shape)
                .with_links(if plain {
                    Links::FeedForward
                } else {
                    Links::Cascade
                })
                .with_transfers(&transfers)
                .unwrap()
                .without_inputs(dropped)
                .unwrap()
        },
    )
}

/// Scaled outputs, and the smallest distance of a poslin neuron from its corner.
pub fn reference(architecture: &Architecture, weights: &[f64], scaled: &[f64]) -> (Vec<f64>, f64) {
    let shape = architecture.shape();
    let (mut first, mut corner) = (0, f64::INFINITY);
    let mut earlier = vec![scaled.to_vec()];
    for (layer, &neurons) in shape.hidden.iter().chain([&shape.outputs]).enumerate() {
        let seen: usize = 1 + earlier.iter().map(Vec::len).sum::<usize>();
        let net: Vec<f64> = (0..neurons)
            .map(|j| {
                let mut row = 1;
                let mut sum = weights[first + j];
                for (group, values) in earlier.iter().enumerate() {
                    for (i, value) in values.iter().enumerate() {
                        let dropped = group == 0 && architecture.dropped_inputs().contains(&i);
                        let linked = architecture.links() == Links::Cascade || group == layer;
                        if linked && !dropped {
                            sum += weights[first + row * neurons + j] * value;
                        }
                        row += 1;
                    }
                }
                sum
            })
            .collect();
        first += seen * neurons;
        if layer == shape.hidden.len() {
            return (net, corner);
        }
        let value = |n: f64| match architecture.transfer(layer) {
            Activation::Tansig => libm::tanh(n),
            Activation::Logsig => 1.0 / (1.0 + libm::exp(-n)),
            Activation::Poslin => n.max(0.0),
            _ => n,
        };
        if architecture.transfer(layer) == Activation::Poslin {
            corner = net.iter().fold(corner, |least, n| least.min(n.abs()));
        }
        earlier.push(net.into_iter().map(value).collect());
    }
    unreachable!()
}
