//! Residuals in frequency: complex amplitudes per channel, and the spectral
//! matrix of what is left.
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
//! from the rest itself, S_b = Σ r rᴴ / n_b; then D = 2 Σ_b n_b log det S_b
//! but for a constant.
//!
//! An amplitude at zero frequency is real: it adds log det S + rᵀ S⁻¹ r, half of
//! what a complex one with the same S does, and is half an independent value. Kept
//! as r/√2 and counted as a half in n_b, it enters all sums over bins as the others
//! do. The other real one, at half the sampling rate, lies above the highest
//! frequency that is used.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use nalgebra::{Complex, DMatrix, DVector};
use realfft::RealFftPlanner;

type C64 = Complex<f64>;

/// Amplitudes of all channels of all logs: `bins[log][bin * channels + channel]`.
pub type Amplitudes = Vec<Vec<C64>>;

/// How bands and bins are laid out for a set of logs.
#[derive(Clone, Debug)]
pub struct Layout {
    channels: usize,
    /// Per log: samples averaged into one, averages.
    logs: Vec<(usize, usize)>,
    /// Per log: time between averages, s.
    periods: Vec<f64>,
    /// Band of each bin, per log.
    bands: Vec<Vec<usize>>,
    /// Number of bins in each band.
    counts: Vec<usize>,
    /// Independent complex values in each band, for each channel: a half of each bin at
    /// zero frequency.
    values: Vec<f64>,
    /// Edges of the bands, Hz, one more than bands.
    edges: Vec<f64>,
    /// Per log: from when on it counts, s.
    begins: Vec<f64>,
    /// Variance, as of white noise, by which a simulation may be off in each channel.
    inexact: Vec<f64>,
}

/// Frequency above which nothing mechanical is left to see, Hz.
const HIGHEST: f64 = 400.0;

/// Rate to which faster logs are averaged in blocks before they are
/// transformed, Hz: measured and simulated ones alike, so nothing is biased.
const BLOCKS: f64 = 1e3;

/// Longest ramp at either end of a log, s.
const RAMP: f64 = 0.15;

/// Upper edge of the first band, Hz. Motion has its power below it; were it cut
/// finer, what the model lacks would pass for noise just where it sits, and the
/// fit would look away from it.
const FIRST_BAND: f64 = 25.0;

/// Fewest bins of a band, for each channel: S_b must be well above singular
/// even after a few dozen parameters were fitted to it.
const BINS_PER_CHANNEL: usize = 16;

impl Layout {
    /// Bands for logs of these lengths (samples, s) and this many channels.
    pub fn new(channels: usize, logs: &[(usize, f64)]) -> Self {
        let block = |&(_, h): &(usize, f64)| ((1.0 / (h * BLOCKS)).round() as usize).max(1);
        let blocks: Vec<usize> = logs.iter().map(block).collect();
        let averaged = |(&(n, h), &q): (&(usize, f64), &usize)| (n / q, h * q as f64);
        let logs: Vec<(usize, f64)> = logs.iter().zip(&blocks).map(averaged).collect();
        let logs = logs.as_slice();
        let bin_width = |&(n, h): &(usize, f64)| 1.0 / (n as f64 * h);
        let top = |log: &(usize, f64)| HIGHEST.min(0.45 / log.1);
        let per_hertz: f64 = logs.iter().map(|log| 1.0 / bin_width(log)).sum();
        let narrowest = (BINS_PER_CHANNEL * channels) as f64 / per_hertz;
        let end = logs.iter().map(top).fold(0.0, f64::max);
        let mut edges = vec![0.0_f64];
        while let Some(&last) = edges.last() {
            if last >= end {
                break;
            }
            edges.push((last + narrowest).max(FIRST_BAND).max(1.5 * last));
        }
        // A last band that is too narrow belongs to the one before.
        if edges.len() > 2 && end - edges[edges.len() - 2] < narrowest {
            edges.remove(edges.len() - 2);
        }
        let mut counts = vec![0; edges.len() - 1];
        let bands: Vec<Vec<usize>> = logs
            .iter()
            .map(|log| {
                let bins = (top(log) / bin_width(log)) as usize;
                (0..bins)
                    .map(|k| {
                        let f = k as f64 * bin_width(log);
                        let band = edges.partition_point(|&e| e <= f).clamp(1, counts.len()) - 1;
                        counts[band] += 1;
                        band
                    })
                    .collect()
            })
            .collect();
        // Every log has its bin at zero frequency in the first band.
        let mut values: Vec<f64> = counts.iter().map(|&n| n as f64).collect();
        values[0] -= 0.5 * begun(&bands) as f64;
        Self {
            channels,
            values,
            logs: blocks
                .into_iter()
                .zip(logs.iter().map(|log| log.0))
                .collect(),
            periods: logs.iter().map(|log| log.1).collect(),
            bands,
            counts,
            edges,
            begins: vec![0.0; logs.len()],
            inexact: vec![0.0; channels],
        }
    }

    /// The same for simulations that may be off by these standard deviations, as of white
    /// noise, channel by channel: what is smaller says nothing.
    pub fn inexact(self, deviations: &[f64]) -> Self {
        Self {
            inexact: deviations.iter().map(|d| d * d).collect(),
            ..self
        }
    }

    /// The same, with logs that count from these times on, s.
    pub fn beginning(self, begins: Vec<f64>) -> Self {
        Self { begins, ..self }
    }

    /// Time from which on all logs count in full, s.
    pub fn full_weight_from(&self) -> f64 {
        self.begins.iter().copied().fold(0.0, f64::max) + RAMP
    }

    /// Lower and upper edge of each band, Hz, and its number of independent values.
    pub fn bands(&self) -> impl Iterator<Item = ([f64; 2], f64)> + '_ {
        let edges = self.edges.windows(2).map(|w| [w[0], w[1]]);
        edges.zip(self.values.iter().copied())
    }

    /// Number of channels.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Number of bins in each band.
    pub fn counts(&self) -> &[usize] {
        &self.counts
    }

    /// Number of independent complex values in each band, for each channel.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The channels of each bin of a band, logs one after another.
    pub fn bins_of<'a>(
        &'a self,
        band: usize,
        amplitudes: &'a Amplitudes,
    ) -> impl Iterator<Item = &'a [C64]> {
        let logs = self.bands.iter().zip(amplitudes);
        let bins = logs.flat_map(|(bands, a)| bands.iter().zip(a.chunks_exact(self.channels)));
        bins.filter(move |(b, _)| **b == band).map(|(_, bin)| bin)
    }

    /// Whether these are amplitudes of logs and channels like those of this layout.
    pub fn holds(&self, amplitudes: &Amplitudes) -> bool {
        let like = |(bands, a): (&Vec<usize>, &Vec<C64>)| bands.len() * self.channels == a.len();
        amplitudes.len() == self.bands.len() && self.bands.iter().zip(amplitudes).all(like)
    }

    /// Number of real numbers in the amplitudes.
    pub fn size(&self) -> usize {
        let bins: usize = self.counts.iter().sum();
        self.channels * (2 * bins - begun(&self.bands))
    }

    /// Transforms the channels of one log, scaled so that of white noise of unit
    /// variance in its samples each real number in the amplitudes has the variance 1/2
    /// at low frequency; the imaginary part at zero frequency is 0.
    ///
    /// Channels that are `free` count from no zero of their own: their mean is
    /// taken out.
    pub fn transform(&self, log: usize, series: &[Vec<f64>], free: &[bool]) -> Vec<C64> {
        let bins = self.bands[log].len();
        let (block, n) = self.logs[log];
        let fft = RealFftPlanner::<f64>::new().plan_fft_forward(n);
        let mut out = vec![C64::new(0.0, 0.0); bins * self.channels];
        let mut spectrum = fft.make_output_vec();
        let taper = self.taper(log);
        let power: f64 = taper.iter().map(|w| w * w).sum();
        let scale = (block as f64 / power).sqrt();
        for (c, samples) in series.iter().enumerate() {
            let mean = |block: &[f64]| block.iter().sum::<f64>() / block.len() as f64;
            let averages: Vec<f64> = samples.chunks_exact(block).map(mean).collect();
            let weighed = averages.iter().zip(&taper).map(|(x, w)| x * w);
            let zero = if free[c] {
                weighed.sum::<f64>() / taper.iter().sum::<f64>()
            } else {
                0.0
            };
            let pairs = averages.iter().zip(&taper);
            let mut input: Vec<f64> = pairs.map(|(x, w)| (x - zero) * w).collect();
            // The lengths agree by construction, so the transform cannot fail.
            if fft.process(&mut input, &mut spectrum).is_ok() {
                for (k, value) in spectrum.iter().take(bins).enumerate() {
                    let share = if k == 0 { FRAC_1_SQRT_2 } else { 1.0 };
                    out[k * self.channels + c] = value * (scale * share);
                }
            }
        }
        out
    }

    /// Cosine ramps at both ends of a log. Noise that has gone round the loop
    /// wanders, and ends elsewhere than it began; a transform takes that for a
    /// step, which something that happens at the start would explain. Nothing
    /// counts before the log's beginning.
    fn taper(&self, log: usize) -> Vec<f64> {
        let n = self.logs[log].1;
        let ramp = (RAMP / self.periods[log]).min(0.05 * n as f64).max(1.0);
        let first = ((self.begins[log] / self.periods[log]) as usize).min(n.saturating_sub(1));
        let at = |k: usize| {
            let Some(after) = k.checked_sub(first) else {
                return 0.0;
            };
            let edge = (after.min(n - 1 - k) as f64 + 0.5) / ramp;
            0.5 - 0.5 * (std::f64::consts::PI * edge.min(1.0)).cos()
        };
        (0..n).map(at).collect()
    }

    /// The spectral matrix of each band.
    pub fn spectral_matrices(&self, rest: &Amplitudes) -> Vec<DMatrix<C64>> {
        let m = self.channels;
        let mut sums = vec![DMatrix::<C64>::zeros(m, m); self.counts.len()];
        for (bands, bins) in self.bands.iter().zip(rest) {
            for (&band, r) in bands.iter().zip(bins.chunks_exact(m)) {
                for i in 0..m {
                    for j in 0..m {
                        sums[band][(i, j)] += r[i] * r[j].conj();
                    }
                }
            }
        }
        let mean = |(sum, &values): (DMatrix<C64>, &f64)| {
            self.regular(sum * C64::new(1.0 / values.max(1.0), 0.0))
        };
        sums.into_iter().zip(&self.values).map(mean).collect()
    }

    /// A spectral matrix with what a simulation may be off by, and a share of each channel's
    /// own variance, on its diagonal.
    pub(crate) fn regular(&self, s: DMatrix<C64>) -> DMatrix<C64> {
        regular(s, &self.inexact)
    }

    /// What [`Layout::inexact`] was given, squared.
    pub(crate) fn inexactness(&self) -> &[f64] {
        &self.inexact
    }

    /// D for the rest, S estimated from it.
    pub fn deviance(&self, rest: &Amplitudes) -> f64 {
        let matrices = self.spectral_matrices(rest);
        matrices.iter().zip(&self.values).map(deviance_of).sum()
    }

    /// What makes the rest white, for the spectral matrices given.
    pub fn whitener(&self, matrices: &[DMatrix<C64>]) -> Whitener {
        let identity = DMatrix::<C64>::identity(self.channels, self.channels);
        let inverse = |s: &DMatrix<C64>| {
            let factor = s.clone().cholesky().map(|c| c.l());
            let inverse = factor.and_then(|l| l.solve_lower_triangular(&identity));
            inverse.unwrap_or_else(|| identity.clone())
        };
        Whitener {
            factors: matrices.iter().map(inverse).collect(),
        }
    }

    /// Whitened amplitudes as one vector of real numbers of unit variance.
    pub fn whiten(&self, whitener: &Whitener, amplitudes: &Amplitudes) -> DVector<f64> {
        let m = self.channels;
        let mut out = Vec::with_capacity(self.size());
        for (bands, bins) in self.bands.iter().zip(amplitudes) {
            for (k, (&band, r)) in bands.iter().zip(bins.chunks_exact(m)).enumerate() {
                let factor = &whitener.factors[band];
                for i in 0..m {
                    let mut sum = C64::new(0.0, 0.0);
                    for j in 0..=i {
                        sum += factor[(i, j)] * r[j];
                    }
                    out.push(SQRT_2 * sum.re);
                    if k > 0 {
                        out.push(SQRT_2 * sum.im);
                    }
                }
            }
        }
        DVector::from_vec(out)
    }
}

/// Logs that have any bin, and so one at zero frequency.
fn begun(bands: &[Vec<usize>]) -> usize {
    bands.iter().filter(|bins| !bins.is_empty()).count()
}

/// What a band with this spectral matrix adds to D.
pub(crate) fn deviance_of((s, &values): (&DMatrix<C64>, &f64)) -> f64 {
    match s.clone().cholesky() {
        Some(c) => {
            let log_det: f64 = c.l_dirty().diagonal().iter().map(|d| 2.0 * d.re.ln()).sum();
            2.0 * values * log_det
        }
        None => f64::INFINITY,
    }
}

/// A spectral matrix with variances and a share of each channel's own on its diagonal.
pub(crate) fn regular(mut s: DMatrix<C64>, added: &[f64]) -> DMatrix<C64> {
    for i in 0..s.nrows() {
        let own = s[(i, i)].re;
        let more = added.get(i).copied().unwrap_or(0.0);
        s[(i, i)] += C64::new(own * REGULAR + more + f64::MIN_POSITIVE, 0.0);
    }
    s
}

/// What of a channel's own variance is added to the diagonal: channels that
/// follow from others to rounding (the controller's output from its inputs)
/// would have none of their own.
const REGULAR: f64 = 1e-4;

/// Inverse Cholesky factors of the spectral matrices.
#[derive(Clone, Debug)]
pub struct Whitener {
    factors: Vec<DMatrix<C64>>,
}

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
