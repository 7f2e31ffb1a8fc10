//! How logs are cut into bins and bands.

use nalgebra::Complex;

use super::Amplitudes;
use super::transform::{RAMP, Transform};

/// How bands and bins are laid out for a set of logs.
#[derive(Clone, Debug)]
pub struct Layout {
    pub(super) channels: usize,
    /// Per log: samples averaged into one, averages.
    pub(super) logs: Vec<(usize, usize)>,
    /// Per log: time between averages, s.
    pub(super) periods: Vec<f64>,
    /// Per log: what its averages are transformed with.
    pub(super) transforms: Vec<Transform>,
    /// Band of each bin, per log.
    pub(super) bands: Vec<Vec<usize>>,
    /// Number of bins in each band.
    pub(super) counts: Vec<usize>,
    /// Independent complex values in each band, for each channel: a half of each bin at
    /// zero frequency.
    pub(super) values: Vec<f64>,
    /// Edges of the bands, Hz, one more than bands.
    pub(super) edges: Vec<f64>,
    /// Per log: from when on it counts, s.
    begins: Vec<f64>,
    /// Variance, as of white noise, by which a simulation may be off in each channel.
    pub(super) inexact: Vec<f64>,
}

/// Frequency above which nothing mechanical is left to see, Hz.
const HIGHEST: f64 = 400.0;

/// Rate to which faster logs are averaged in blocks before they are
/// transformed, Hz: measured and simulated ones alike, so nothing is biased.
const BLOCKS: f64 = 1e3;

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
        let transforms = logs.iter().map(|&(n, h)| Transform::new(n, h, 0.0));
        Self {
            channels,
            values,
            transforms: transforms.collect(),
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
        let logs = self.logs.iter().zip(&self.periods).zip(&begins);
        let transforms = logs.map(|((&(_, n), &h), &begin)| Transform::new(n, h, begin));
        Self {
            transforms: transforms.collect(),
            begins,
            ..self
        }
    }

    /// Time from which on a log counts, s.
    pub fn begins(&self, log: usize) -> f64 {
        self.begins.get(log).copied().unwrap_or(0.0)
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
    ) -> impl Iterator<Item = &'a [Complex<f64>]> {
        let logs = self.bands.iter().zip(amplitudes);
        let bins = logs.flat_map(|(bands, a)| bands.iter().zip(a.chunks_exact(self.channels)));
        bins.filter(move |(b, _)| **b == band).map(|(_, bin)| bin)
    }

    /// Frequency (Hz) and channels of each bin, logs one after another.
    pub fn bins<'a>(
        &'a self,
        amplitudes: &'a Amplitudes,
    ) -> impl Iterator<Item = (f64, &'a [Complex<f64>])> {
        let widths = self.logs.iter().zip(&self.periods);
        let widths = widths.map(|((_, n), period)| 1.0 / (*n as f64 * period));
        let logs = widths.zip(amplitudes);
        logs.flat_map(|(width, bins)| {
            let bins = bins.chunks_exact(self.channels).enumerate();
            bins.map(move |(k, bin)| (k as f64 * width, bin))
        })
    }

    /// Sets all to 0 but a band of a channel.
    pub(crate) fn keep(&self, amplitudes: &mut Amplitudes, band: usize, channel: usize) {
        for (bands, bins) in self.bands.iter().zip(amplitudes) {
            for (b, bin) in bands.iter().zip(bins.chunks_exact_mut(self.channels)) {
                for (c, value) in bin.iter_mut().enumerate() {
                    if *b != band || c != channel {
                        *value = Complex::new(0.0, 0.0);
                    }
                }
            }
        }
    }

    /// Whether these are amplitudes of logs and channels like those of this layout.
    pub fn holds(&self, amplitudes: &Amplitudes) -> bool {
        let like =
            |(bands, a): (&Vec<usize>, &Vec<Complex<f64>>)| bands.len() * self.channels == a.len();
        amplitudes.len() == self.bands.len() && self.bands.iter().zip(amplitudes).all(like)
    }

    /// Power of each channel, the mean of these runs.
    pub(crate) fn power(&self, runs: &[Amplitudes]) -> Vec<f64> {
        let mut power = vec![0.0; self.channels];
        let bins = runs.iter().flatten();
        for bin in bins.flat_map(|log| log.chunks_exact(self.channels)) {
            for (sum, value) in power.iter_mut().zip(bin) {
                *sum += value.norm_sqr() / runs.len() as f64;
            }
        }
        power
    }

    /// Number of real numbers in the amplitudes.
    pub fn size(&self) -> usize {
        let bins: usize = self.counts.iter().sum();
        self.channels * (2 * bins - begun(&self.bands))
    }

    /// What [`Layout::inexact`] was given, squared.
    pub(crate) fn inexactness(&self) -> &[f64] {
        &self.inexact
    }
}

/// Logs that have any bin, and so one at zero frequency.
fn begun(bands: &[Vec<usize>]) -> usize {
    bands.iter().filter(|bins| !bins.is_empty()).count()
}
