//! The evaluation kernel, without allocation, for both precisions.
//!
//! `activations` starts with the constant 1 (the bias), then the scaled
//! inputs, then one layer's outputs after the other. What a layer sees is
//! therefore always a prefix, which is what the cascade links mean, and the
//! bias needs no special case.

use crate::Real;
use crate::pack::{padded, strip_width};

/// Fills the hidden part of `activations` and writes the scaled outputs.
///
/// `weights` are packed; `activations[0]` must be 1 and the next `inputs` entries the scaled inputs.
#[inline(always)]
pub(crate) fn forward<T: Real>(
    inputs: usize,
    hidden: &[usize],
    weights: &[T],
    activations: &mut [T],
    output: &mut [T],
) {
    let mut seen = 1 + inputs;
    let mut rest = weights;
    for &neurons in hidden {
        let (layer, later) = rest.split_at(seen * padded(neurons));
        let (input, free) = activations.split_at_mut(seen);
        // With the filling where there is room: what lies behind the layer is
        // overwritten next, and whole strips are faster.
        let whole = padded(neurons).min(free.len());
        affine(layer, input, &mut free[..whole]);
        tansig(&mut free[..whole]);
        seen += neurons;
        rest = later;
    }
    affine(rest, &activations[..seen], output);
}

/// Elements of tansig taken together.
const CHUNK: usize = 4;

#[inline(always)]
fn tansig<T: Real>(values: &mut [T]) {
    let (chunks, rest) = values.as_chunks_mut::<CHUNK>();
    for chunk in chunks {
        for value in chunk {
            *value = value.tansig();
        }
    }
    for value in rest {
        *value = value.tansig();
    }
}

/// `out = Wᵀ input`, with `W` packed in strips.
#[inline(always)]
fn affine<T: Real>(weights: &[T], input: &[T], out: &mut [T]) {
    if let [single] = out {
        *single = dot(weights, input);
        return;
    }
    let (mut weights, mut out) = (weights, out);
    loop {
        let width = strip_width(out.len());
        let (own, later) = weights.split_at(width * input.len());
        weights = later;
        let (to, rest) = out.split_at_mut(width.min(out.len()));
        match width {
            16 => write(to, &wide::<T, 16>(own, input)),
            12 => write(to, &wide::<T, 12>(own, input)),
            8 => write(to, &narrow::<T, 8>(own, input)),
            4 => write(to, &narrow::<T, 4>(own, input)),
            _ => return,
        }
        out = rest;
    }
}

#[inline(always)]
fn write<T: Real, const C: usize>(to: &mut [T], sums: &[T; C]) {
    // The usual case as one copy of known length.
    if let Some(whole) = to.first_chunk_mut::<C>() {
        *whole = *sums;
    } else {
        to.copy_from_slice(&sums[..to.len()]);
    }
}

/// `C` neurons at once, their sums held in registers.
#[inline(always)]
fn wide<T: Real, const C: usize>(weights: &[T], input: &[T]) -> [T; C] {
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
fn narrow<T: Real, const C: usize>(weights: &[T], input: &[T]) -> [T; C] {
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
fn dot<T: Real>(a: &[T], b: &[T]) -> T {
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
