//! What the zero-phase Gaussians share: over a stream (`plan::smoothing`), over the signals of a log
//! (`adapt::kernel`), over a whole record (`learning::gauss`), over what depends on an angle
//! (`residual::basis`).

use axis_scalar::Scalar;

/// Partial sums, so that the compiler can use vectors.
const LANES: usize = 8;

/// e^(−m²/2), m deviations from the middle.
pub(crate) fn bell<T: Scalar>(deviations: T) -> T {
    (-T::HALF * deviations * deviations).exp()
}

/// Σ wᵢ (xᵢ − middle).
pub(crate) fn weighed_about<T: Scalar>(middle: T, weights: &[T], window: &[T]) -> T {
    let mut sums = [T::ZERO; LANES];
    let (w, x) = (weights.chunks_exact(LANES), window.chunks_exact(LANES));
    let rest = w.remainder().iter().zip(x.remainder());
    let tail: T = rest.map(|(w, x)| *w * (*x - middle)).sum();
    for (w, x) in w.zip(x) {
        for ((sum, w), x) in sums.iter_mut().zip(w).zip(x) {
            *sum += *w * (*x - middle);
        }
    }
    sums.into_iter().sum::<T>() + tail
}
