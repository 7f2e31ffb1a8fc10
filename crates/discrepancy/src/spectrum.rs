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

use std::ops::Range;

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
    /// Edges of the bands, Hz, one more than bands.
    edges: Vec<f64>,
    /// Per log: from when on it counts, s.
    begins: Vec<f64>,
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
        let bands = logs
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
        Self {
            channels,
            logs: blocks
                .into_iter()
                .zip(logs.iter().map(|log| log.0))
                .collect(),
            periods: logs.iter().map(|log| log.1).collect(),
            bands,
            counts,
            edges,
            begins: vec![0.0; logs.len()],
        }
    }

    /// The same, with logs that count from these times on, s.
    pub fn beginning(self, begins: Vec<f64>) -> Self {
        Self { begins, ..self }
    }

    /// Lower and upper edge of each band, Hz, and its number of bins.
    pub fn bands(&self) -> impl Iterator<Item = ([f64; 2], usize)> + '_ {
        let edges = self.edges.windows(2).map(|w| [w[0], w[1]]);
        edges.zip(self.counts.iter().copied())
    }

    /// Number of real numbers in the amplitudes.
    pub fn size(&self) -> usize {
        2 * self.channels * self.bins()
    }

    /// Number of frequencies.
    pub fn bins(&self) -> usize {
        self.counts.iter().sum()
    }

    /// Transforms the channels of one log, scaled so that white noise of unit
    /// variance in its samples has amplitudes of unit variance at low frequency.
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
                    out[k * self.channels + c] = value * scale;
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
        let first = ((self.begins[log] / self.periods[log]) as usize).min(n / 2);
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
        let mean = |(sum, &count): (DMatrix<C64>, &usize)| {
            regular(sum * C64::new(1.0 / count.max(1) as f64, 0.0))
        };
        sums.into_iter().zip(&self.counts).map(mean).collect()
    }

    /// D for the rest, S estimated from it.
    pub fn deviance(&self, rest: &Amplitudes) -> f64 {
        let matrices = self.spectral_matrices(rest);
        matrices.iter().zip(&self.counts).map(deviance_of).sum()
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
            for (&band, r) in bands.iter().zip(bins.chunks_exact(m)) {
                let factor = &whitener.factors[band];
                for i in 0..m {
                    let mut sum = C64::new(0.0, 0.0);
                    for j in 0..=i {
                        sum += factor[(i, j)] * r[j];
                    }
                    out.push(std::f64::consts::SQRT_2 * sum.re);
                    out.push(std::f64::consts::SQRT_2 * sum.im);
                }
            }
        }
        DVector::from_vec(out)
    }
}

impl Layout {
    /// All products of these columns, band by band.
    pub fn products(&self, columns: &[&Amplitudes]) -> Products {
        let m = self.channels;
        let width = columns.len() * m;
        let band = |b: usize| {
            // One row a bin: the real parts, then the imaginary ones.
            let mut re = DMatrix::<f64>::zeros(self.counts[b], width);
            let mut im = re.clone();
            for (c, column) in columns.iter().enumerate() {
                let bins = self.bands.iter().zip(*column);
                let bins = bins.flat_map(|(bands, a)| bands.iter().zip(a.chunks_exact(m)));
                let own = bins.filter(|(band, _)| **band == b);
                for (row, (_, values)) in own.enumerate() {
                    for (i, value) in values.iter().enumerate() {
                        re[(row, c * m + i)] = value.re;
                        im[(row, c * m + i)] = value.im;
                    }
                }
            }
            let (ret, imt) = (re.transpose(), im.transpose());
            let real = &ret * &re + &imt * &im;
            let cross = &imt * &re;
            let imaginary = &cross - cross.transpose();
            real.zip_map(&imaginary, C64::new)
        };
        Products {
            channels: m,
            counts: self.counts.clone(),
            bands: (0..self.counts.len()).map(band).collect(),
        }
    }
}

/// Products of columns between all channels, summed over the bins of each band:
/// what D and its linearised problem are made of, without the bins.
#[derive(Clone, Debug)]
pub struct Products {
    channels: usize,
    counts: Vec<usize>,
    /// Block (i, j) is Σ c_i c_jᴴ.
    bands: Vec<DMatrix<C64>>,
}

impl Products {
    fn columns(&self) -> usize {
        self.bands.first().map_or(0, |b| b.nrows() / self.channels)
    }

    /// Those of the first columns, `kept` of them, and of the sum of some others.
    pub fn merged(&self, kept: usize, summed: Range<usize>) -> Self {
        let m = self.channels;
        let band = |all: &DMatrix<C64>| {
            let block = |i: usize, j: usize| all.view((i * m, j * m), (m, m));
            let mut out = DMatrix::zeros((kept + 1) * m, (kept + 1) * m);
            let own = (kept * m, kept * m);
            out.view_mut((0, 0), own).copy_from(&all.view((0, 0), own));
            for i in summed.clone() {
                for j in 0..kept {
                    let mut cross = out.view_mut((kept * m, j * m), (m, m));
                    cross += block(i, j);
                    let mut cross = out.view_mut((j * m, kept * m), (m, m));
                    cross += block(j, i);
                }
                for j in summed.clone() {
                    let mut sum = out.view_mut(own, (m, m));
                    sum += block(i, j);
                }
            }
            out
        };
        Self {
            channels: m,
            counts: self.counts.clone(),
            bands: self.bands.iter().map(band).collect(),
        }
    }

    /// The spectral matrix in each band of the first column less the others times x.
    fn spectral_matrices(&self, x: &DVector<f64>) -> Vec<DMatrix<C64>> {
        let m = self.channels;
        let y = |i: usize| if i == 0 { 1.0 } else { -x[i - 1] };
        let one = |(band, &count): (&DMatrix<C64>, &usize)| {
            let mut sum = DMatrix::<C64>::zeros(m, m);
            for i in 0..=x.len() {
                for j in 0..=x.len() {
                    let weight = C64::new(y(i) * y(j), 0.0);
                    sum += band.view((i * m, j * m), (m, m)) * weight;
                }
            }
            regular(sum / C64::new(count.max(1) as f64, 0.0))
        };
        self.bands.iter().zip(&self.counts).map(one).collect()
    }

    /// Products of all columns, whitened as the first less the others times x asks
    /// for.
    pub fn weighed(&self, x: &DVector<f64>) -> DMatrix<f64> {
        let (m, n) = (self.channels, self.columns());
        let mut all = DMatrix::zeros(n, n);
        for (band, s) in self.bands.iter().zip(self.spectral_matrices(x)) {
            let Some(inverse) = s.cholesky().map(|c| c.inverse()) else {
                continue;
            };
            for i in 0..n {
                for j in 0..n {
                    let block = band.view((i * m, j * m), (m, m));
                    // The inverse is Hermitian: tr(S⁻¹ B) = Σ conj(S⁻¹) ∘ B.
                    let trace: C64 = block
                        .iter()
                        .zip(inverse.iter())
                        .map(|(b, s)| b * s.conj())
                        .sum();
                    all[(i, j)] += 2.0 * trace.re;
                }
            }
        }
        all
    }

    /// D of the first column less the others times x.
    pub fn deviance(&self, x: &DVector<f64>) -> f64 {
        let matrices = self.spectral_matrices(x);
        matrices.iter().zip(&self.counts).map(deviance_of).sum()
    }
}

/// What a band with this spectral matrix adds to D.
fn deviance_of((s, &count): (&DMatrix<C64>, &usize)) -> f64 {
    match s.clone().cholesky() {
        Some(c) => {
            let log_det: f64 = c.l_dirty().diagonal().iter().map(|d| 2.0 * d.re.ln()).sum();
            2.0 * count as f64 * log_det
        }
        None => f64::INFINITY,
    }
}

/// A spectral matrix with a share of each channel's own variance added to it.
fn regular(mut s: DMatrix<C64>) -> DMatrix<C64> {
    for i in 0..s.nrows() {
        let own = s[(i, i)].re;
        s[(i, i)] += C64::new(own * REGULAR + f64::MIN_POSITIVE, 0.0);
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
    use rand::rngs::StdRng;
    use rand::{RngExt, SeedableRng};

    use super::*;

    /// Amplitudes of noise in two channels of a log of 1 s at 1 kHz.
    fn noise(layout: &Layout, rng: &mut StdRng) -> Amplitudes {
        let mut samples = || (0..1000).map(|_| rng.random_range(-1.0..1.0)).collect();
        let series: [Vec<f64>; 2] = [samples(), samples()];
        vec![layout.transform(0, &series, &[false, false])]
    }

    #[test]
    fn products_hold_what_the_bins_hold() {
        let layout = Layout::new(2, &[(1000, 1e-3)]);
        let mut rng = StdRng::seed_from_u64(5);
        let all: Vec<Amplitudes> = (0..5).map(|_| noise(&layout, &mut rng)).collect();
        let products = layout.products(&all.iter().collect::<Vec<_>>());
        // The rest, one column, and the sum of two of three slots.
        let merged = products.merged(2, 3..5);
        let x = DVector::from_vec(vec![0.3, -0.7]);
        let left = |bin: usize| {
            all[0][0][bin] - all[1][0][bin] * 0.3 + (all[3][0][bin] + all[4][0][bin]) * 0.7
        };
        let rest: Amplitudes = vec![(0..all[0][0].len()).map(left).collect()];
        let direct = layout.deviance(&rest);
        assert!((merged.deviance(&x) - direct).abs() < 1e-9 * direct.abs());
        let whitener = layout.whitener(&layout.spectral_matrices(&rest));
        let white = |a: &Amplitudes| layout.whiten(&whitener, a);
        let sum: Amplitudes = vec![
            all[3][0]
                .iter()
                .zip(&all[4][0])
                .map(|(a, b)| a + b)
                .collect(),
        ];
        let columns = DMatrix::from_columns(&[white(&all[0]), white(&all[1]), white(&sum)]);
        let gram = columns.tr_mul(&columns);
        assert!((merged.weighed(&x) - &gram).norm() < 1e-9 * gram.norm());
    }
}
