//! Statistics of a sampled record: its mean, how well that is known, and what
//! oscillates about it.

/// A record split into its mean and the rest.
pub(super) struct Series {
    pub mean: f64,
    rest: Vec<f64>,
}

/// A coherent oscillation.
pub(super) struct Oscillation {
    pub amplitude: f64,
    /// Hz.
    pub frequency: f64,
}

/// Lags between which noise has forgotten and an oscillation has not, s.
const FORGOTTEN: [f64; 2] = [0.032, 0.128];

impl Series {
    /// Of at least one sample. Equal ones leave a rest of exactly 0, which
    /// their sum, rounded, might not.
    pub fn of(samples: &[f64]) -> Self {
        let constant = samples.iter().all(|s| s == &samples[0]);
        let mean = if constant {
            samples[0]
        } else {
            samples.iter().sum::<f64>() / samples.len() as f64
        };
        Self {
            mean,
            rest: samples.iter().map(|s| s - mean).collect(),
        }
    }

    /// Standard error of the mean of correlated samples; `None` if they do not
    /// scatter. Noise that is `differenced` takes itself back, so that their
    /// correlations may make the mean better than that of white noise, as far
    /// as they are known.
    pub fn standard_error(&self, differenced: bool) -> Option<f64> {
        let rest = batch_means(&self.rest);
        let n = rest.len();
        let variance = autocovariance(&rest, 0);
        let least = if differenced {
            (5.0 / (n as f64).sqrt()).min(1.0)
        } else {
            1.0
        };
        let mut tau = 1.0_f64;
        for lag in 1..n / 4 {
            if lag as f64 > 5.0 * tau.max(1.0) {
                break;
            }
            tau += 2.0 * autocovariance(&rest, lag) / variance;
        }
        // n − 1: one degree of freedom went into the mean.
        let error = (variance * tau.max(least) / (n - 1) as f64).sqrt();
        (error > 0.0).then_some(error)
    }

    /// What is still correlated after noise has been forgotten, at a sample
    /// rate in Hz; `None` if that may be noise.
    pub fn oscillation(&self, sample_rate: f64) -> Option<Oscillation> {
        let n = self.rest.len();
        let variance = autocovariance(&self.rest, 0);
        if variance <= 0.0 {
            return None;
        }
        let [from, to] = FORGOTTEN.map(|t| (t * sample_rate).round() as usize);
        let last = to.max(32).min(n / 4);
        let first = from.max(8).min(last / 2);
        let every = ((last - first) / 96).max(1);
        let correlations: Vec<(f64, f64)> = (first..=last)
            .step_by(every)
            .map(|lag| (lag as f64, autocovariance(&self.rest, lag) / variance))
            .collect();
        let largest = correlations.iter().fold(0.0, |a: f64, c| a.max(c.1.abs()));
        if largest <= self.noise_correlation(first, largest, variance) {
            return None;
        }
        Some(Oscillation {
            amplitude: (2.0 * largest * variance).sqrt(),
            frequency: frequency(&correlations, 0.5 / every as f64) * sample_rate,
        })
    }

    /// The largest correlation at long lags that noise alone may leave, from
    /// its own at the short ones; an oscillation's share of these is at most
    /// what it leaves at the long ones, `coherent`.
    fn noise_correlation(&self, first: usize, coherent: f64, variance: f64) -> f64 {
        let every = (first / 32).max(1);
        let squares: f64 = (1..first)
            .step_by(every)
            .map(|lag| (autocovariance(&self.rest, lag) / variance).powi(2))
            .map(|square| (square - coherent * coherent).max(0.0))
            .sum();
        let sum = 1.0 + 2.0 * squares * every as f64;
        (4.5 * (sum / self.rest.len() as f64).sqrt()).min(0.5)
    }
}

/// How many samples in a row say the same: `τ = 1 + 2 Σ ρ_k` of residuals about zero, summed up to
/// the first lag beyond `5 τ`; at least 1.
pub(super) fn correlation_time(residuals: &[f64]) -> f64 {
    let variance = autocovariance(residuals, 0);
    let mut tau = 1.0_f64;
    if variance <= 0.0 {
        return tau;
    }
    for lag in 1..residuals.len() / 4 {
        if lag as f64 > 5.0 * tau.max(1.0) {
            break;
        }
        tau += 2.0 * autocovariance(residuals, lag) / variance;
    }
    tau.max(1.0)
}

/// The frequency, in cycles a sample up to `highest`, whose cosine fits the
/// correlations `(lag, value)` best: they have averaged the noise out.
fn frequency(correlations: &[(f64, f64)], highest: f64) -> f64 {
    const STEPS: usize = 1000;
    let step = highest / STEPS as f64;
    let fit = |k: usize| -> f64 {
        let angle = core::f64::consts::TAU * step * k as f64;
        let terms = correlations.iter();
        terms.map(|(lag, value)| value * (angle * lag).cos()).sum()
    };
    let fits: Vec<f64> = (0..=STEPS + 1).map(fit).collect();
    let best = (1..=STEPS).fold(1, |best, k| if fits[k] > fits[best] { k } else { best });
    // The vertex of the parabola through the best and its neighbours.
    let (left, middle, right) = (fits[best - 1], fits[best], fits[best + 1]);
    let bend = left - 2.0 * middle + right;
    let shift = if bend < 0.0 {
        (0.5 * (left - right) / bend).clamp(-0.5, 0.5)
    } else {
        0.0
    };
    (best as f64 + shift) * step
}

/// Autocovariance of centred samples at one lag, divided by `n` (biased, so
/// that it stays positive definite).
fn autocovariance(rest: &[f64], lag: usize) -> f64 {
    let shifted = &rest[lag..];
    let sum: f64 = rest.iter().zip(shifted).map(|(a, b)| a * b).sum();
    sum / rest.len() as f64
}

/// Means of neighbouring samples, fewer than 2¹⁴: they scatter as the mean of
/// all needs it, and bound the work on long records.
fn batch_means(rest: &[f64]) -> Vec<f64> {
    const MOST: usize = 1 << 14;
    let size = rest.len().div_ceil(MOST);
    rest.chunks_exact(size)
        .map(|batch| batch.iter().sum::<f64>() / size as f64)
        .collect()
}
