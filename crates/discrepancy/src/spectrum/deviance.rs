//! Spectral matrices, and minus twice the log-likelihood that they leave.

use nalgebra::{Complex, DMatrix};

use super::Amplitudes;
use super::layout::Layout;

impl Layout {
    /// The spectral matrix of each band.
    pub fn spectral_matrices(&self, rest: &Amplitudes) -> Vec<DMatrix<Complex<f64>>> {
        let m = self.channels;
        let mut sums = vec![DMatrix::<Complex<f64>>::zeros(m, m); self.counts.len()];
        for (bands, bins) in self.bands.iter().zip(rest) {
            for (&band, r) in bands.iter().zip(bins.chunks_exact(m)) {
                for i in 0..m {
                    for j in 0..m {
                        sums[band][(i, j)] += r[i] * r[j].conj();
                    }
                }
            }
        }
        let mean = |(sum, &values): (DMatrix<Complex<f64>>, &f64)| {
            self.regular(sum * Complex::new(1.0 / values.max(1.0), 0.0))
        };
        sums.into_iter().zip(&self.values).map(mean).collect()
    }

    /// A spectral matrix with what a simulation may be off by, and a share of each channel's
    /// own variance, on its diagonal.
    pub(crate) fn regular(&self, s: DMatrix<Complex<f64>>) -> DMatrix<Complex<f64>> {
        regular(s, &self.inexact)
    }

    /// D for the residual, S estimated from it.
    pub fn deviance(&self, rest: &Amplitudes) -> f64 {
        let matrices = self.spectral_matrices(rest);
        matrices.iter().zip(&self.values).map(deviance_of).sum()
    }
}

/// What a band with this spectral matrix adds to D.
pub(crate) fn deviance_of((s, &values): (&DMatrix<Complex<f64>>, &f64)) -> f64 {
    match s.clone().cholesky() {
        Some(c) => {
            let log_det: f64 = c.l_dirty().diagonal().iter().map(|d| 2.0 * d.re.ln()).sum();
            2.0 * values * log_det
        }
        None => f64::INFINITY,
    }
}

/// A spectral matrix with variances and a share of each channel's own on its diagonal.
pub(crate) fn regular(mut s: DMatrix<Complex<f64>>, added: &[f64]) -> DMatrix<Complex<f64>> {
    for i in 0..s.nrows() {
        let own = s[(i, i)].re;
        let more = added.get(i).copied().unwrap_or(0.0);
        s[(i, i)] += Complex::new(own * REGULAR + more + f64::MIN_POSITIVE, 0.0);
    }
    s
}

/// What of a channel's own variance is added to the diagonal: channels that
/// follow from others to rounding (the controller's output from its inputs)
/// would have none of their own.
const REGULAR: f64 = 1e-4;
