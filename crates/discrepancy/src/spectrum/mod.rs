//! Residuals in frequency: complex amplitudes per channel, and the spectral
//! matrix of the residual.
//!
//! Noise in a closed loop is coloured, and common to all channels: sensor
//! noise goes round the loop. For a stationary Gaussian rest the transformed
//! samples of different frequencies are independent, with the spectral matrix
//! S(f) between channels, and minus twice the log-likelihood is (P. Whittle,
//! Arkiv för Matematik 2 (1953) 423–434, doi:10.1007/BF02590998)
//!
//! ```text
//! D = 2 Σ_f [ log det S(f) + r(f)ᴴ S(f)⁻¹ r(f) ]
//! ```
//!
//! S is taken constant over bands of neighbouring frequencies and estimated
//! from the residual itself, S_b = Σ r rᴴ / n_b; then D = 2 Σ_b n_b log det S_b
//! but for a constant.
//!
//! An amplitude at zero frequency is real: it adds log det S + rᵀ S⁻¹ r, half of
//! what a complex one with the same S does, and is half an independent value. Kept
//! as r/√2 and counted as a half in n_b, it enters all sums over bins as the others
//! do. The other real one, at half the sampling rate, lies above the highest
//! frequency that is used.

mod amplitudes;
mod deviance;
mod layout;
mod lomb;
mod transform;
mod whitener;

use nalgebra::Complex;

pub(crate) use self::deviance::{deviance_of, regular};
pub use self::layout::Layout;
pub(crate) use self::lomb::{share_of_wave, waves};
pub use self::whitener::Whitener;

/// Amplitudes of all channels of all logs: `bins[log][bin * channels + channel]`.
pub type Amplitudes = Vec<Vec<Complex<f64>>>;

#[cfg(test)]
mod tests {
    use nalgebra::{Complex, DMatrix, DVector};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::Layout;

    /// Runs of white noise.
    const RUNS: usize = 3000;

    /// Two channels of noise with unit variance, of logs of unequal length.
    fn noise(layout: &Layout, random: &mut ChaCha8Rng) -> super::Amplitudes {
        let mut series =
            |n: usize| -> Vec<f64> { (0..n).map(|_| StandardNormal.sample(random)).collect() };
        let logs = [400, 333].map(|n| [series(n), series(n)]);
        let one = |(i, log): (usize, &[Vec<f64>; 2])| layout.transform(i, log, &[false; 2]);
        logs.iter().enumerate().map(one).collect()
    }

    /// Measured: variances from 0.911 to 1.087, as the ramps correlate what is lowest;
    /// fourth moments from 2.37 to 3.65, means of matrices within 0.0054. A number of the
    /// bin at zero frequency has twice the variance where it is taken for complex.
    #[test]
    fn every_whitened_number_of_white_noise_has_unit_variance() {
        let layout = Layout::new(2, &[(400, 1e-3), (333, 1e-3)]);
        let white = vec![DMatrix::identity(2, 2); layout.counts().len()];
        let whitener = layout.whitener(&white);
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut squares = DVector::zeros(layout.size());
        let mut fourths = squares.clone();
        let mut matrices = white.iter().map(|w| w * Complex::ZERO).collect::<Vec<_>>();
        let (mut sum, mut spread) = (0.0, 0.0);
        for _ in 0..RUNS {
            let run = noise(&layout, &mut random);
            let seen = layout.whiten(&whitener, &run).map(|x| x * x);
            let all = seen.sum() - layout.size() as f64;
            sum += all / RUNS as f64;
            spread += all * all / RUNS as f64;
            fourths += seen.map(|x| x * x) / RUNS as f64;
            squares += seen / RUNS as f64;
            for (mean, own) in matrices.iter_mut().zip(layout.spectral_matrices(&run)) {
                *mean += own / Complex::new(RUNS as f64, 0.0);
            }
        }
        // χ² of as many degrees of freedom, but for what the ramps mix between neighbours.
        assert!(sum.abs() < 10.0, "{sum}");
        let variance = 2.0 * layout.size() as f64;
        assert!((spread / variance - 1.0).abs() < 0.2, "{spread}");
        let off = |moment: &DVector<f64>, of: f64| moment.map(|m| (m - of).abs()).max();
        assert!(off(&squares, 1.0) < 0.2, "{squares}");
        assert!(off(&fourths, 3.0) < 1.2, "{fourths}");
        for own in &matrices {
            let from_identity = (own - &white[0]).map(|c| c.norm()).max();
            assert!(from_identity < 0.03, "{own}");
        }
    }

    /// At half the sampling rate amplitudes are real as well: no bin lies there.
    #[test]
    fn no_bin_reaches_half_the_sampling_rate() {
        for n in 1..300 {
            for period in [1e-3, 1.3e-3, 4e-3, 1e-2] {
                let layout = Layout::new(1, &[(n, period)]);
                let bins: usize = layout.counts().iter().sum();
                assert!(2 * bins < n.max(1) + 1, "{n} {period}: {bins}");
            }
        }
    }
}
