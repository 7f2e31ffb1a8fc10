//! Even sampling.

use thiserror::Error;

use crate::log::Log;

/// Fewest samples that are judged.
pub const MIN_SAMPLES: usize = 100;
/// Highest sample rate, Hz: that of the fastest current loops whose logs are read.
pub const MAX_RATE_HZ: f64 = 20e3;
/// Lowest sample rate, Hz: a thousandth of the highest, so that no rate that is read is another
/// one whose time is in ms, µs or ns and was taken for s. What a log is used for may need more.
pub const MIN_RATE_HZ: f64 = MAX_RATE_HZ / 1e3;
/// Greatest deviation from the even grid, as a share of the period.
pub const MAX_JITTER: f64 = 0.05;

/// Both ends of the range of rates, for clocks that are a little off.
const RATE_SLACK: f64 = 1e-3;
/// Steps longer than this many periods are gaps.
const GAP_PERIODS: f64 = 1.5;

/// The even grid `t_k ≈ t_0 + k · period` that the instants lie on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampling {
    /// Time from sample to sample in s: the slope of the least-squares line
    /// through the instants over their index.
    pub period: f64,
    /// Samples per second in Hz, 1 / period.
    pub rate: f64,
    /// Greatest distance of an instant from that line, as a share of the period.
    pub jitter: f64,
}

/// Instants that are not an even grid.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SamplingError {
    /// Too few samples to judge.
    #[error("{found} samples: at least {MIN_SAMPLES} are needed")]
    TooFew {
        /// Samples of the log.
        found: usize,
    },
    /// A rate that is out of range.
    #[error(
        "the sample rate is {} Hz: it must lie between {MIN_RATE_HZ} and {MAX_RATE_HZ} Hz{}",
        in_digits(*rate), rate_hint(*rate)
    )]
    Rate {
        /// The rate found, Hz.
        rate: f64,
    },
    /// Samples are missing.
    #[error(
        "a gap of {length:.6} s after t_s = {time:.6} s, {:.1} periods of {period:.3e} s \
         ({count} such in the log): the samples must follow each other without gaps",
        length / period
    )]
    Gap {
        /// Instant before the first gap, s.
        time: f64,
        /// Time to the next instant, s.
        length: f64,
        /// The period, s.
        period: f64,
        /// Gaps in the log.
        count: usize,
    },
    /// Instants off the even grid.
    #[error(
        "the instant t_s = {time:.6} s is {:.1} % of a period ({period:.3e} s) off the even grid: \
         at most {} % are allowed",
        jitter * 100.0, MAX_JITTER * 100.0
    )]
    Jitter {
        /// The instant that is farthest off, s.
        time: f64,
        /// Its distance from the grid as a share of the period.
        jitter: f64,
        /// The period, s.
        period: f64,
    },
}

/// The sampling of a log, where it is even and without gaps.
///
/// The median step tells gaps from ordinary steps; the grid itself is the
/// least-squares line through the instants, because the median of time stamps
/// that were rounded to a few digits is off by up to half a digit each sample.
///
/// # Errors
/// The first of: [`SamplingError::TooFew`] below [`MIN_SAMPLES`];
/// [`SamplingError::Rate`] outside [`MIN_RATE_HZ`] to [`MAX_RATE_HZ`] by more
/// than 0.1 %; [`SamplingError::Gap`], a step longer than 1.5 periods;
/// [`SamplingError::Jitter`], an instant more than [`MAX_JITTER`] periods off
/// the grid.
pub fn check_sampling(log: &Log) -> Result<Sampling, SamplingError> {
    let time = log.time();
    if time.len() < MIN_SAMPLES {
        return Err(SamplingError::TooFew { found: time.len() });
    }
    let steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).collect();
    let longest = GAP_PERIODS * median(&steps);
    let (sum, count) = steps
        .iter()
        .filter(|&&s| s <= longest)
        .fold((0.0, 0.0), |(sum, count), s| (sum + s, count + 1.0));
    // The median itself is no gap, so count is not 0.
    let period = sum / count;
    check_rate(1.0 / period)?;
    check_gaps(time, &steps, longest, period)?;
    fit_grid(time)
}

fn median(steps: &[f64]) -> f64 {
    let mut sorted = steps.to_vec();
    let middle = sorted.len() / 2;
    *sorted.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The rate of samples that are so many seconds apart, Hz, where it is one at which logs are read.
///
/// # Errors
/// [`SamplingError::Rate`] outside [`MIN_RATE_HZ`] to [`MAX_RATE_HZ`] by more than 0.1 %.
pub fn rate_of(period: f64) -> Result<f64, SamplingError> {
    check_rate(1.0 / period).map(|()| 1.0 / period)
}

fn check_rate(rate: f64) -> Result<(), SamplingError> {
    let range = MIN_RATE_HZ * (1.0 - RATE_SLACK)..=MAX_RATE_HZ * (1.0 + RATE_SLACK);
    if range.contains(&rate) {
        Ok(())
    } else {
        Err(SamplingError::Rate { rate })
    }
}

fn check_gaps(time: &[f64], steps: &[f64], longest: f64, period: f64) -> Result<(), SamplingError> {
    let mut gaps = steps.iter().enumerate().filter(|&(_, &s)| s > longest);
    match gaps.next() {
        None => Ok(()),
        Some((k, &length)) => Err(SamplingError::Gap {
            time: time[k],
            length,
            period,
            count: 1 + gaps.count(),
        }),
    }
}

/// Least squares of t_k over k, both taken from their middle so that long logs
/// with large time stamps keep their digits.
fn fit_grid(time: &[f64]) -> Result<Sampling, SamplingError> {
    let n = time.len() as f64;
    let middle = (n - 1.0) / 2.0;
    let elapsed = |t: f64| t - time[0];
    let mean = time.iter().map(|&t| elapsed(t)).sum::<f64>() / n;
    let (mut cross, mut square) = (0.0, 0.0);
    for (k, &t) in time.iter().enumerate() {
        let index = k as f64 - middle;
        cross += index * (elapsed(t) - mean);
        square += index * index;
    }
    let period = cross / square;
    let off = |(k, &t): (usize, &f64)| {
        let grid = mean + (k as f64 - middle) * period;
        ((elapsed(t) - grid).abs() / period, t)
    };
    let (jitter, worst) = time
        .iter()
        .enumerate()
        .map(off)
        .fold((0.0, time[0]), |a, b| if b.0 > a.0 { b } else { a });
    if jitter > MAX_JITTER {
        return Err(SamplingError::Jitter {
            time: worst,
            jitter,
            period,
        });
    }
    Ok(Sampling {
        period,
        rate: 1.0 / period,
        jitter,
    })
}

/// Six digits, whatever the size: 0.000000 Hz says nothing.
fn in_digits(rate: f64) -> String {
    match (0.01..1e7).contains(&rate) {
        true => format!("{rate:.6}"),
        false => format!("{rate:.5e}"),
    }
}

/// A rate that is right but for a factor of 1000, 10⁶ or 10⁹ has its time in another
/// unit.
fn rate_hint(rate: f64) -> &'static str {
    let fits = |factor: f64| check_rate(rate * factor).is_ok();
    if fits(1e3) {
        "; the time may be in milliseconds"
    } else if fits(1e6) {
        "; the time may be in microseconds"
    } else if fits(1e9) {
        "; the time may be in nanoseconds"
    } else {
        ""
    }
}
