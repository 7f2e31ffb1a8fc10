//! Derivatives of one output by backpropagation through the cascade, without
//! allocation, for both precisions.
//!
//! With `ā_i = ∂ŷ/∂a_i` for each activation, a hidden neuron `j` has
//! `δ_j = f'(n_j) ā_j`, and each activation that it sees gains `w_ij δ_j`.
//! From the last layer to the first, `ā_j` is complete when it is needed.

use crate::forward::dot;
use crate::pack::{padded, strip_width};
use crate::{Activation, NetworkScalar, Transfers};

/// What an evaluation leaves behind.
#[derive(Clone, Copy)]
pub(crate) struct Evaluated<'a, T, X> {
    pub hidden: &'a [usize],
    pub outputs: usize,
    pub transfers: X,
    /// Packed.
    pub weights: &'a [T],
    /// As [`crate::forward::forward`] filled them.
    pub activations: &'a [T],
}

impl<T: NetworkScalar, X: Transfers> Evaluated<'_, T, X> {
    /// Derivatives of a scaled output: in `adjoint`, as long as the
    /// activations, by the scaled inputs where the inputs are, and by the net
    /// input of each hidden neuron where its value is.
    #[inline(always)]
    pub fn derivatives(&self, output: usize, adjoint: &mut [T]) {
        let mut seen = self.activations.len();
        let start = self.weights.len() - seen * padded(self.outputs);
        let (mut earlier, last) = self.weights.split_at(start);
        for (i, to) in adjoint.iter_mut().enumerate() {
            *to = last[place(self.outputs, seen, i, output)];
        }
        for (number, &neurons) in self.hidden.iter().enumerate().rev() {
            seen -= neurons;
            let (before, own) = earlier.split_at(earlier.len() - seen * padded(neurons));
            earlier = before;
            let (before, delta) = adjoint.split_at_mut(seen);
            let delta = &mut delta[..neurons];
            let values = &self.activations[seen..][..neurons];
            slopes(self.transfers.of_layer(number), values, delta);
            collect(own, delta, before);
        }
    }
}

#[inline(always)]
fn slopes<T: NetworkScalar>(transfer: Activation, values: &[T], delta: &mut [T]) {
    for (d, &a) in delta.iter_mut().zip(values) {
        *d *= transfer.slope(a);
    }
}

/// Adds `W δ` of a layer packed in strips.
#[inline(always)]
fn collect<T: NetworkScalar>(weights: &[T], delta: &[T], into: &mut [T]) {
    if let &[single] = delta {
        for (to, &w) in into.iter_mut().zip(weights) {
            *to += w * single;
        }
        return;
    }
    let (mut weights, mut delta) = (weights, delta);
    while !delta.is_empty() {
        let width = strip_width(delta.len());
        let (strip, later) = weights.split_at(width * into.len());
        let (own, others) = delta.split_at(width.min(delta.len()));
        for (to, row) in into.iter_mut().zip(strip.chunks_exact(width)) {
            *to += dot(&row[..own.len()], own);
        }
        (weights, delta) = (later, others);
    }
}

/// Place of the weight from activation `i` to neuron `j` in a packed layer.
fn place(neurons: usize, seen: usize, i: usize, j: usize) -> usize {
    if neurons == 1 {
        return i;
    }
    let (mut before, mut first) = (0, 0);
    loop {
        let width = strip_width(neurons - first);
        if j < first + width {
            return before + i * width + (j - first);
        }
        before += width * seen;
        first += width;
    }
}
