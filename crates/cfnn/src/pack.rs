//! The order of the weights for evaluation.
//!
//! A layer's neurons are cut into strips of 16 until 20 or fewer are left;
//! these are filled up with zeros to a multiple of 4. In a strip the weights
//! of one input to all its neurons lie side by side, then come those of the
//! next input. A single output neuron stays as it is.

use crate::error::same_length;
use crate::{Error, NetworkScalar};

/// Most neurons of a strip: their sums, what is multiplied, and a little more
/// fit into the sixteen vector registers of plain x86-64.
const WIDEST: usize = 20;

/// Width of the first strip of a layer with this many neurons left.
#[inline(always)]
pub(crate) const fn strip_width(neurons: usize) -> usize {
    if neurons > WIDEST {
        16
    } else {
        neurons.div_ceil(4) * 4
    }
}

/// Neurons of a layer with the filling.
#[inline(always)]
pub(crate) const fn padded(neurons: usize) -> usize {
    if neurons == 1 {
        1
    } else {
        neurons.div_ceil(4).saturating_mul(4)
    }
}

/// Numbers of activations and of parameters of a network; both saturate
/// instead of overflowing.
pub(crate) fn count(inputs: usize, hidden: &[usize], outputs: usize) -> (usize, usize) {
    let mut seen = inputs.saturating_add(1);
    let mut parameters = 0usize;
    for &neurons in hidden {
        parameters = parameters.saturating_add(seen.saturating_mul(neurons));
        seen = seen.saturating_add(neurons);
    }
    let last = seen.saturating_mul(outputs);
    (seen, parameters.saturating_add(last))
}

/// Length of the packed weights of a network; `usize::MAX` where it would be
/// more than that.
///
/// ```
/// assert_eq!(cfnn::packed_len(4, &[34, 19, 8], 1), 5 * 36 + 39 * 20 + 58 * 8 + 66);
/// ```
#[must_use]
pub const fn packed_len(inputs: usize, hidden: &[usize], outputs: usize) -> usize {
    let mut seen = inputs.saturating_add(1);
    let mut length = 0usize;
    let mut layer = 0;
    while layer < hidden.len() {
        length = length.saturating_add(seen.saturating_mul(padded(hidden[layer])));
        seen = seen.saturating_add(hidden[layer]);
        layer += 1;
    }
    length.saturating_add(seen.saturating_mul(padded(outputs)))
}

/// Puts weights in the order that [`crate::FixedNetwork`] reads.
///
/// `weights` are in the network's order (see the crate's documentation),
/// `packed` has [`packed_len`] elements.
///
/// # Errors
/// [`Error::Length`] if one of the slices does not fit the layer sizes.
pub fn pack<T: NetworkScalar>(
    inputs: usize,
    hidden: &[usize],
    outputs: usize,
    weights: &[T],
    packed: &mut [T],
) -> Result<(), Error> {
    let parameters = count(inputs, hidden, outputs).1;
    same_length("weights", weights.len(), parameters)?;
    let length = packed_len(inputs, hidden, outputs);
    same_length("packed weights", packed.len(), length)?;
    pack_layers(inputs, hidden, outputs, weights, packed);
    Ok(())
}

/// [`pack`] for slices known to have the right lengths.
pub(crate) fn pack_layers<T: NetworkScalar>(
    inputs: usize,
    hidden: &[usize],
    outputs: usize,
    weights: &[T],
    packed: &mut [T],
) {
    let (mut weights, mut packed) = (weights, packed);
    let mut seen = 1 + inputs;
    for &neurons in hidden.iter().chain([&outputs]) {
        let (layer, later) = weights.split_at(seen * neurons);
        let (into, free) = packed.split_at_mut(seen * padded(neurons));
        pack_layer(seen, neurons, layer, into);
        (weights, packed) = (later, free);
        seen += neurons;
    }
}

fn pack_layer<T: NetworkScalar>(seen: usize, neurons: usize, layer: &[T], into: &mut [T]) {
    if neurons == 1 {
        into.copy_from_slice(layer);
        return;
    }
    let (mut into, mut first) = (into, 0);
    while first < neurons {
        let width = strip_width(neurons - first);
        let (strip, later) = into.split_at_mut(width * seen);
        for (i, row) in strip.chunks_exact_mut(width).enumerate() {
            for (c, to) in row.iter_mut().enumerate() {
                let there = first + c < neurons;
                *to = if there {
                    layer[i * neurons + first + c]
                } else {
                    T::ZERO
                };
            }
        }
        into = later;
        first += width;
    }
}
