//! Samples that jitter under even time stamps, as distinct from a channel that moves.
//!
//! A sample that is taken δ late shows v δ too much: what its neighbours do not predict of it grows
//! with the speed v, while noise and quantisation do not. With the cubic through two samples on
//! either side,
//!
//! ```text
//! r_k = x_k − (−x_{k−2} + 4 x_{k−1} + 4 x_{k+1} − x_{k+2}) / 6,
//! E r² = G (σ² + v² σ_δ²),     G = 1 + (1 + 16 + 16 + 1) / 36,
//! ```
//!
//! for noise σ and jitter σ_δ that are independent from sample to sample. Both follow from a line
//! through E r² over v². That the rest is independent shows in its own correlation from one sample
//! to the next, −0.8; what moves smoothly, as a vibration or the error of an encoder over a turn,
//! has another.

use super::hold::hold;
use super::quantum::quantum;
use crate::log::Log;
use crate::numeric::grid::Grid;
use crate::numeric::order::median;

/// How far the samples of a channel are off their even time stamps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleJitter {
    /// Standard deviation of the instants, s.
    pub rms: f64,
    /// Standard error of that, s.
    pub standard_error: f64,
    /// The standard deviation as a share of the sampling period.
    pub share: f64,
}

/// Variance of the rest over that of one sample.
const GAIN: f64 = 1.0 + 34.0 / 36.0;
/// Groups by speed.
const GROUPS: usize = 8;
/// Samples of a group at least.
const LEAST: usize = 40;
/// Slowest share of the greatest speed that is looked at, and quanta a sample: below, steps of
/// quantisation come one at a time and are no noise.
const SLOWEST: f64 = 0.05;
const QUANTA: f64 = 2.0;
/// Least jitter that is told, periods: less is what rounding of stamps and values makes.
const LEAST_SHARE: f64 = 2e-3;
/// Standard errors from 0 from which on jitter is told.
const SURE: f64 = 5.0;
/// Share of the squares that is taken in a group: corners of the motion are among the largest.
const TAKEN: f64 = 0.9;
/// The mean of that share of squared Gaussian numbers over their variance,
/// 1 − 2 z φ(z) / 0.9 at z = Φ⁻¹(0.95).
const MEAN_TAKEN: f64 = 0.622_99;
/// Correlation of independent samples' rest from one to the next is −56/70; half the way to what
/// noise of lower frequency has is told from it.
const INDEPENDENT: f64 = -0.5;

/// By how much a channel's samples are off its even time stamps, where the channel tells it:
/// where it moves at speeds that differ by three times or more, is not held, and what is not
/// predicted of it grows with speed, is independent from sample to sample and five standard errors
/// from none. `None` otherwise, and for a channel that is not there.
///
/// Samples marked as missing, and those beside them, are left out. Needs 40 bytes a sample.
/// The figure is within a tenth for jitter from 1 % of a period on, as far as noise lets it be seen.
pub fn sample_jitter(log: &Log, channel: &str) -> Option<SampleJitter> {
    let x = log.channel(channel).ok()?;
    let period = Grid::of(log.time())?.period;
    let step = quantum(x).map_or(0.0, |q| q.step);
    if hold(x, period, step).is_some() {
        return None;
    }
    let is_missing = |k: usize| {
        let around = k.saturating_sub(REACH)..k + REACH + 1;
        let mut holes = log.missing(channel).iter();
        holes.any(|hole| hole.start < around.end && around.start < hole.end)
    };
    let rests = Rests::of(x, step, is_missing)?;
    let [squared, error] = rests.slope()?;
    let is_sure = squared.is_finite() && squared >= SURE * error;
    if !is_sure || rests.correlation() > INDEPENDENT {
        return None;
    }
    let share = squared.sqrt();
    if share < LEAST_SHARE {
        return None;
    }
    Some(SampleJitter {
        rms: share * period,
        standard_error: 0.5 * error / share * period,
        share,
    })
}

/// Samples on either side of which the speed is taken.
const REACH: usize = 4;

/// What is not predicted of the samples that move.
struct Rests {
    /// Speed in units a sample, and rest over the root of the gain; by speed.
    by_speed: Vec<[f64; 2]>,
    /// Rests of neighbours.
    pairs: Vec<[f64; 2]>,
}

impl Rests {
    fn of(x: &[f64], step: f64, is_missing: impl Fn(usize) -> bool) -> Option<Self> {
        let last = x.len().checked_sub(2 * REACH + 1)?;
        let speed = |k: usize| (x[k + REACH] - x[k - REACH]).abs() / (2 * REACH) as f64;
        let rest = |k: usize| {
            let foreseen = (4.0 * (x[k - 1] + x[k + 1]) - x[k - 2] - x[k + 2]) / 6.0;
            (x[k] - foreseen) / GAIN.sqrt()
        };
        let all = REACH..last + REACH;
        let fastest = all.clone().map(speed).fold(0.0, f64::max);
        let slowest = (SLOWEST * fastest).max(QUANTA * step);
        let moves = |k: &usize| speed(*k) >= slowest && slowest > 0.0 && !is_missing(*k);
        let moving: Vec<usize> = all.filter(moves).collect();
        let mut by_speed: Vec<[f64; 2]> = moving.iter().map(|&k| [speed(k), rest(k)]).collect();
        by_speed.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let next = moving.windows(2).filter(|w| w[1] == w[0] + 1);
        let pairs = next.map(|w| [rest(w[0]) / speed(w[0]), rest(w[1]) / speed(w[1])]);
        (by_speed.len() >= GROUPS * LEAST).then_some(Self {
            pairs: pairs.collect(),
            by_speed,
        })
    }

    /// The squared jitter in squared samples, and its standard error: by weighted least squares
    /// over groups of like speed, in each the mean of all squares but the largest.
    fn slope(&self) -> Option<[f64; 2]> {
        let length = self.by_speed.len() / GROUPS;
        let groups: Vec<[f64; 2]> = self.by_speed.chunks_exact(length).map(group).collect();
        let (first, last) = (groups.first()?, groups.last()?);
        if last[0] < 9.0 * first[0] || groups.iter().any(|group| group[1] <= 0.0) {
            return None;
        }
        // The relative error of a mean of squares is √(2/n), and of five rests, which share
        // samples, two are independent.
        let relative = (2.0 / (0.4 * length as f64)).sqrt();
        let mut sums = [0.0; 5];
        for [x, y] in groups {
            let weight = (relative * y).powi(-2);
            for (sum, term) in sums.iter_mut().zip([1.0, x, x * x, y, x * y]) {
                *sum += weight * term;
            }
        }
        let [w, x, xx, y, xy] = sums;
        let determinant = w * xx - x * x;
        let slope = (w * xy - x * y) / determinant;
        // Less noise than none is none: the line then goes through 0.
        let level = (xx * y - x * xy) / determinant;
        match level < 0.0 {
            true => Some([xy / xx, xx.recip().sqrt()]),
            false => Some([slope, (w / determinant).sqrt()]),
        }
    }

    /// Of the rest over speed from one sample to the next; corners count no more than a few times
    /// what is usual.
    fn correlation(&self) -> f64 {
        let mut sizes: Vec<f64> = self.pairs.iter().map(|[a, _]| a.abs()).collect();
        let most = 4.0 * median(&mut sizes);
        let cut = |v: f64| v.clamp(-most, most);
        let sum = |of: fn(f64, f64) -> f64| -> f64 {
            self.pairs.iter().map(|&[a, b]| of(cut(a), cut(b))).sum()
        };
        sum(|a, b| a * b)
            / (sum(|a, _| a * a) * sum(|_, b| b * b))
                .sqrt()
                .max(f64::MIN_POSITIVE)
    }
}

/// Mean squared speed, and the variance of the rests.
fn group(rests: &[[f64; 2]]) -> [f64; 2] {
    let speed = rests.iter().map(|[v, _]| v * v).sum::<f64>() / rests.len() as f64;
    let mut squares: Vec<f64> = rests.iter().map(|[_, r]| r * r).collect();
    squares.sort_unstable_by(f64::total_cmp);
    let taken = ((TAKEN * squares.len() as f64) as usize).max(1);
    let mean = squares[..taken].iter().sum::<f64>() / taken as f64;
    [speed, mean / MEAN_TAKEN]
}
