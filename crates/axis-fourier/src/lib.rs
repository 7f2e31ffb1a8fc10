//! Fourier transforms of real series of any length, forward and back.
//!
//! The transforms are those of [`realfft`] and `rustfft`. Their planner is generic, so each crate that
//! calls it compiles every kernel for every instruction set anew, which takes half a minute. Here it is called for
//! `f64`, once; other crates get a plan behind a trait object.
//!
//! ```
//! let plan = axis_fourier::forward(8);
//! let mut samples: Vec<f64> = (0..8).map(|j| (std::f64::consts::TAU * f64::from(j) / 8.0).cos()).collect();
//! let mut amplitudes = plan.make_output_vec();
//! plan.process(&mut samples, &mut amplitudes)?;
//! assert!((amplitudes[1].re - 4.0).abs() < 1e-12);
//! # Ok::<(), axis_fourier::FftError>(())
//! ```
//!
//! This crate knows nothing of windows, densities or rates: what an amplitude means is its caller's.

use std::sync::Arc;

use realfft::RealFftPlanner;
pub use realfft::num_complex::Complex;
pub use realfft::{ComplexToReal, FftError, RealToComplex};

/// A plan for X_k = Σ_j x_j e^(−2πi jk/n) of `n` real samples x_j, j = 0 to n − 1, at k = 0 to n/2
/// (rounded down): the other half are conjugates of these. Not scaled.
///
/// [`RealToComplex::process`] uses the samples as working memory, and fails only on slices of
/// other lengths.
#[must_use]
pub fn forward(n: usize) -> Arc<dyn RealToComplex<f64>> {
    RealFftPlanner::new().plan_fft_forward(n)
}

/// A plan for the way back: from the n/2 + 1 amplitudes of [`forward`] to `n` times the samples.
///
/// [`ComplexToReal::process`] uses the amplitudes as working memory. It fails on slices of other
/// lengths, and says so, with the result in place, where an amplitude that is real for every real series (the first; of even
/// `n` the last too) has an imaginary part.
#[must_use]
pub fn inverse(n: usize) -> Arc<dyn ComplexToReal<f64>> {
    RealFftPlanner::new().plan_fft_inverse(n)
}
