//! Noise alone in each channel.

use std::ops::Range;

use axis_sim::{Axis, Balance, ClosedLoop, Replay, ReplayError, Trace};
use rayon::prelude::*;

use super::level::{noise_at, shows_noise, upper_level};
use super::{LogNoise, Rest, at_state, noise_series};
use crate::answers::{LogSet, State};

/// Noise alone in a channel.
#[derive(Clone, Debug)]
pub struct Floor {
    /// Root mean square.
    pub rms: f64,
    /// The greatest root mean square of a run: what is slow differs from run to run.
    pub most: f64,
    /// Root mean square in each log, of several runs the greatest.
    pub by_log: Vec<f64>,
    /// Whether that is the least that noise may be.
    pub is_least: bool,
    /// Independent values that its samples are worth, where what is slow is averaged:
    /// their number times the variance over the spectral density at zero frequency.
    pub independent: f64,
}

/// Parts of a log of which the sums show how noise adds up.
const BATCHES: usize = 32;

impl Floor {
    /// Of noise as it was simulated, one series a log. Sums over a part of a log have its
    /// length times the density near zero frequency as their variance (batch means).
    pub(crate) fn of(series: &[Vec<f64>]) -> Self {
        let (mut squares, mut of_sums, mut samples) = (0.0, 0.0, 0usize);
        for log in series {
            squares += log.iter().map(|v| v * v).sum::<f64>();
            let batches = log.chunks(log.len().div_ceil(BATCHES).max(1));
            of_sums += batches.map(|b| b.iter().sum::<f64>().powi(2)).sum::<f64>();
            samples += log.len();
        }
        let samples = samples.max(1) as f64;
        let worth = if of_sums > 0.0 {
            squares / of_sums
        } else {
            1.0
        };
        let rms = |log: &Vec<f64>| {
            let squares: f64 = log.iter().map(|v| v * v).sum();
            (squares / log.len().max(1) as f64).sqrt()
        };
        Self {
            rms: (squares / samples).sqrt(),
            most: (squares / samples).sqrt(),
            by_log: series.iter().map(rms).collect(),
            is_least: false,
            independent: samples * worth.min(1.0),
        }
    }
}

impl Floor {
    /// Of several runs.
    fn of_runs(runs: &[Self]) -> Self {
        let count = runs.len().max(1) as f64;
        let mean = |value: fn(&Self) -> f64| runs.iter().map(value).sum::<f64>() / count;
        let logs = runs.iter().map(|run| run.by_log.len()).max().unwrap_or(0);
        // What is slow differs from run to run, of a single log the more.
        let of_log = |log: usize| {
            let each = runs.iter().filter_map(|run| run.by_log.get(log));
            each.copied().fold(0.0, f64::max)
        };
        Self {
            rms: mean(|f| f.rms * f.rms).sqrt(),
            most: runs.iter().map(|f| f.rms).fold(0.0, f64::max),
            by_log: (0..logs).map(of_log).collect(),
            is_least: false,
            independent: mean(|f| f.independent),
        }
    }

    /// With this besides, RMS: what a simulation may be off by, or slow noise of a logger.
    pub(crate) fn beside(self, inexact: f64) -> Self {
        let by_log = self.by_log.iter().map(|rms| rms.hypot(inexact));
        Self {
            rms: self.rms.hypot(inexact),
            most: self.most.hypot(inexact),
            by_log: by_log.collect(),
            ..self
        }
    }
}

/// Runs with noise: on a move there and back friction sticks or not, and one run alone may
/// be far from the mean of many.
const RUNS: u64 = 6;

/// Noise alone in each channel: the loop is simulated with sensors as noisy as its logs
/// show, since most of what they do lies where the loop answers. Where the logs do not show
/// them, the upper spectrum is taken for white.
pub(crate) fn floors(
    machine: &Axis,
    set: &LogSet,
    state: &State,
    best: &Rest,
) -> Result<Vec<Floor>, ReplayError> {
    let axis = at_state(machine, state);
    if set.is_balanced() {
        let channel = |c: usize| {
            let noise = of_balances(&axis, set, best, c);
            noise.beside(set.inexactness(machine, c))
        };
        return Ok((0..set.channels.len()).map(channel).collect());
    }
    if !shows_noise(&axis, set) {
        let samples: usize = set.counted().iter().map(Range::len).sum();
        let white = |c: usize| {
            let rms = upper_level(set, best, c);
            let white = Floor {
                rms,
                most: rms,
                by_log: vec![rms; set.logs.len()],
                is_least: false,
                independent: samples as f64,
            };
            white.beside(set.inexactness(machine, c))
        };
        return Ok((0..set.channels.len()).map(white).collect());
    }
    let closed_loop = ClosedLoop::new(&axis)?.without_noise();
    let replays: Vec<&Replay> = set.replays();
    let quiet = |replay: &&Replay| replay.follow(&closed_loop, |_| ());
    let quiet: Vec<Trace> = (replays.par_iter().map(quiet)).collect::<Result<_, _>>()?;
    let noise = noise_at(&axis, set, best, &quiet);
    floors_of(machine, set, &quiet, &closed_loop, &noise)
}

/// Noise alone in each channel of logs that are replayed, with sensors and a logger like these.
///
/// # Errors
/// [`ReplayError`] if the machine does not run with noise.
pub(crate) fn floors_with(
    machine: &Axis,
    set: &LogSet,
    state: &State,
    traces: &[Trace],
    noise: &LogNoise,
) -> Result<Vec<Floor>, ReplayError> {
    let closed_loop = ClosedLoop::new(&at_state(machine, state))?.without_noise();
    floors_of(machine, set, traces, &closed_loop, noise)
}

/// The same, of a closed loop and what it does without noise.
fn floors_of(
    machine: &Axis,
    set: &LogSet,
    quiet: &[Trace],
    closed_loop: &ClosedLoop,
    noise: &LogNoise,
) -> Result<Vec<Floor>, ReplayError> {
    let run = |seed: u64| noise_series(closed_loop, set, quiet, noise, seed);
    let runs: Vec<Rest> = (0..RUNS)
        .into_par_iter()
        .map(run)
        .collect::<Result<_, _>>()?;
    let of = |c: usize| {
        let counted = |run: &Rest| -> Vec<Vec<f64>> {
            let logs = run.iter().zip(set.counted());
            logs.map(|(log, samples)| log[c][samples].to_vec())
                .collect()
        };
        let one = |run: &Rest| Floor::of(&counted(run));
        let inexact = set.inexactness(machine, c);
        Floor::of_runs(&runs.iter().map(one).collect::<Vec<_>>()).beside(inexact)
    };
    Ok((0..set.channels.len()).map(of).collect())
}

/// Noise of a balance's channel with the inertia that was fitted, and the uncertainty of its friction. Of
/// the torque that is the least that its log leaves possible or, where that is more, what its residual
/// has from one sample to the next. Nobody knows what its controller makes of its sensors' noise, nor what a
/// current has above the rate of its log: that comes back anywhere below it. All of it is in the
/// residual, so it is never more than that.
fn of_balances(axis: &Axis, set: &LogSet, rest: &Rest, channel: usize) -> Floor {
    let balances = set.balances();
    let samples = balances.iter().map(|b| b.quality().samples[0] as f64);
    let own = |b: &Balance| {
        let mut all = b.channels().into_iter().zip(b.noise(axis));
        let own = all.find(|(name, _)| *name == set.channels[channel]);
        own.map(|(_, noise)| noise)
    };
    let is_least = balances.iter().filter_map(|b| own(b)).any(|n| n.is_least);
    let squares = balances.iter().zip(rest).map(|(b, log)| {
        let own = own(b).map_or(0.0, |noise| noise.rms.powi(2));
        let rest = &log[channel];
        let most = rest.iter().map(|v| v * v).sum::<f64>() / rest.len().max(1) as f64;
        let (time, period) = (b.compared().time(), b.compared_period());
        let unlike = match is_least {
            true => unlike(rest, time, period, b.correlation(period)),
            false => 0.0,
        };
        f64::max(own, unlike).min(most)
    });
    let by_log: Vec<f64> = squares.collect();
    let pairs = samples.clone().zip(&by_log);
    let sum: f64 = pairs.map(|(n, s)| n * s).sum();
    let independent: f64 = samples.sum();
    let rms = (sum / independent.max(1.0)).sqrt();
    Floor {
        rms,
        most: rms,
        by_log: by_log.into_iter().map(f64::sqrt).collect(),
        is_least,
        independent,
    }
}

/// Variance of a residual, were all that is unlike from one sample to the next noise, flat up to
/// the
/// low-pass: half the mean square of neighbours' differences over 1 − ρ, ρ being such noise's
/// correlation over a sample. The variance over this is von Neumann's ratio (Ann. Math. Statist.
/// 12 (1941) 367, doi:10.1214/aoms/1177731677): what a law lacks goes on for many samples.
fn unlike(rest: &[f64], time: &[f64], period: f64, correlation: f64) -> f64 {
    let pairs = rest.windows(2).zip(time.windows(2));
    let neighbours = pairs.filter(|(_, t)| t[1] - t[0] < 1.5 * period);
    let squares = neighbours.map(|(r, _)| (r[1] - r[0]).powi(2));
    let (sum, count) = squares.fold((0.0, 0.0), |(sum, n), square| (sum + square, n + 1.0));
    sum / f64::max(count, 1.0) / (2.0 * (1.0 - correlation))
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::unlike;

    const PERIOD: f64 = 0.01;

    /// Noise of unit variance whose neighbours are correlated by `memory`, at times with a gap
    /// after each hundred samples.
    fn noise(memory: f64) -> (Vec<f64>, Vec<f64>) {
        let mut random = ChaCha8Rng::seed_from_u64(11);
        let mut value: f64 = StandardNormal.sample(&mut random);
        let mut next = |_: usize| {
            let new: f64 = StandardNormal.sample(&mut random);
            value = memory * value + (1.0 - memory * memory).sqrt() * new;
            value
        };
        let rest = (0..20_000).map(&mut next).collect();
        let time = (0..20_000).map(|k| PERIOD * (k + 50 * (k / 100)) as f64);
        (rest, time.collect())
    }

    /// Of 2·10⁴ samples a variance is known to a hundredth.
    #[test]
    fn noise_with_the_filters_correlation_has_its_variance() {
        for memory in [0.0, 0.23, 0.6] {
            let (rest, time) = noise(memory);
            let found = unlike(&rest, &time, PERIOD, memory);
            assert!((found - 1.0).abs() < 0.05, "{memory}: {found}");
        }
    }

    /// A force that is there for seconds, and changes sign at each gap, is no noise.
    #[test]
    fn what_goes_on_for_many_samples_counts_for_nothing() {
        let (noise, time) = noise(0.0);
        let sign = |k: usize| {
            if (k / 100).is_multiple_of(2) {
                1.0
            } else {
                -1.0
            }
        };
        let pairs = noise.iter().enumerate();
        let rest: Vec<f64> = pairs.map(|(k, n)| 30.0 * sign(k) + n).collect();
        let found = unlike(&rest, &time, PERIOD, 0.0);
        assert!((found - 1.0).abs() < 0.05, "{found}");
        let slow = |k: usize| 30.0 * (k as f64 * PERIOD).sin();
        let rest: Vec<f64> = (0..noise.len()).map(slow).collect();
        assert!(unlike(&rest, &time, PERIOD, 0.0) < 0.05);
    }
}
