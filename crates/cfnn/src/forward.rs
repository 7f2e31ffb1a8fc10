//! The evaluation kernel, without allocation, for both precisions.
//!
//! `activations` starts with the constant 1 (the bias), then the scaled
//! inputs, then one layer's outputs after the other. What a layer sees is
//! therefore always a prefix, which is what the cascade links mean, and the
//! bias needs no special case.

use crate::pack::{padded, strip_width};
use crate::{Activation, NetworkScalar, Transfers};

/// What a network is made of, but for its transfer functions.
pub(crate) struct Layers<'a, T> {
    pub inputs: usize,
    /// Neurons of each hidden layer.
    pub hidden: &'a [usize],
    /// Packed.
    pub weights: &'a [T],
}

/// Fills the hidden part of `activations` and writes the scaled outputs.
///
/// `activations[0]` must be 1 and the next `inputs` entries the scaled inputs.
#[inline(always)]
pub(crate) fn forward<T: NetworkScalar>(
    layers: &Layers<'_, T>,
    transfers: impl Transfers,
    activations: &mut [T],
    output: &mut [T],
) {
    let mut seen = 1 + layers.inputs;
    let mut rest = layers.weights;
    for (number, &neurons) in layers.hidden.iter().enumerate() {
        let (layer, later) = rest.split_at(seen * padded(neurons));
        let (input, free) = activations.split_at_mut(seen);
        // With the filling where there is room: what lies behind the layer is
        // overwritten next, and whole strips are faster.
        let whole = padded(neurons).min(free.len());
        let transfer = transfers.of_layer(number);
        affine(layer, input, &mut free[..whole], transfer);
        seen += neurons;
        rest = later;
    }
    affine(rest, &activations[..seen], output, Activation::Purelin);
}

/// `out = f(Wᵀ input)`, with `W` packed in strips.
#[inline(always)]
fn affine<T: NetworkScalar>(weights: &[T], input: &[T], out: &mut [T], transfer: Activation) {
    if let [single] = out {
        [*single] = transfer.of([dot(weights, input)]);
        return;
    }
    let (mut weights, mut out) = (weights, out);
    loop {
        let width = strip_width(out.len());
        let (own, later) = weights.split_at(width * input.len());
        weights = later;
        let (to, rest) = out.split_at_mut(width.min(out.len()));
        match width {
            20 => write(to, wide::<T, 20>(own, input), transfer),
            16 => write(to, wide::<T, 16>(own, input), transfer),
            12 => write(to, wide::<T, 12>(own, input), transfer),
            8 => write(to, narrow::<T, 8>(own, input), transfer),
            4 => write(to, narrow::<T, 4>(own, input), transfer),
            _ => return,
        }
        out = rest;
    }
}

/// The transfer function is taken while the sums are in registers: the length
/// is known, so the compiler needs no remainder, and the next strip's products
/// overlap with it.
#[inline(always)]
fn write<T: NetworkScalar, const C: usize>(to: &mut [T], mut sums: [T; C], transfer: Activation) {
    sums = transfer.of(sums);
    // The usual case as one copy of known length.
    if let Some(whole) = to.first_chunk_mut::<C>() {
        for (to, sum) in whole.iter_mut().zip(sums) {
            *to = sum;
        }
    } else {
        to.copy_from_slice(&sums[..to.len()]);
    }
}

/// `C` neurons at once, their sums held in registers.
#[inline(always)]
fn wide<T: NetworkScalar, const C: usize>(weights: &[T], input: &[T]) -> [T; C] {
    let mut sum = [T::ZERO; C];
    for (row, &a) in weights.as_chunks::<C>().0.iter().zip(input) {
        for c in 0..C {
            sum[c] += row[c] * a;
        }
    }
    sum
}

/// The same for few neurons, with a sum for each half of the inputs, since an
/// addition takes longer than its turn.
#[inline(always)]
fn narrow<T: NetworkScalar, const C: usize>(weights: &[T], input: &[T]) -> [T; C] {
    let half = input.len() / 2;
    let (upper, lower) = input.split_at(half);
    let (upper_rows, lower_rows) = weights.as_chunks::<C>().0.split_at(half);
    let (mut sum, mut other) = ([T::ZERO; C], [T::ZERO; C]);
    let upper = upper_rows.iter().zip(upper);
    for ((upper, &a), (lower, &b)) in upper.zip(lower_rows.iter().zip(lower)) {
        for c in 0..C {
            sum[c] += upper[c] * a;
            other[c] += lower[c] * b;
        }
    }
    if let (Some(row), Some(&a)) = (lower_rows.get(half), lower.get(half)) {
        for c in 0..C {
            other[c] += row[c] * a;
        }
    }
    for c in 0..C {
        sum[c] += other[c];
    }
    sum
}

/// Scalar product with eight partial sums, added pairwise.
#[inline(always)]
pub(crate) fn dot<T: NetworkScalar>(a: &[T], b: &[T]) -> T {
    let (a_chunks, a_rest) = a.as_chunks::<8>();
    let (b_chunks, b_rest) = b.as_chunks::<8>();
    let mut sum = [T::ZERO; 8];
    for (x, y) in a_chunks.iter().zip(b_chunks) {
        for c in 0..8 {
            sum[c] += x[c] * y[c];
        }
    }
    let mut tail = T::ZERO;
    for (&x, &y) in a_rest.iter().zip(b_rest) {
        tail += x * y;
    }
    let mut half = [T::ZERO; 4];
    for c in 0..4 {
        half[c] = sum[c] + sum[c + 4];
    }
    (half[0] + half[2]) + (half[1] + half[3]) + tail
}
