//! Where an axis stands still in a log: reference and measured channels.

use std::collections::VecDeque;

use axis_log::{Log, LogError};
use axis_sim::{Axis, position_shown, reference_in};

/// Reference speed below which a log stands still, m/s or rad/s.
pub(super) const AT_REST: f64 = 1e-3;

/// How long a standstill must be for the loop to have come to rest in its half, s.
pub(super) const REST_TIME: f64 = 0.2;

/// A measured channel stands where it changes by no more than so many times what it changes by in
/// the quietest standstill of the same length: the extremes of noise differ less than that from window to
/// window,
const QUIET: f64 = 2.0;

/// or, in logs without noise, by no more than this share of the range of the tracking error.
const SETTLED: f64 = 2e-3;

/// The motor's angle in a log.
const MOTOR: &str = "motor_angle_rad";

/// Windows of [`REST_TIME`] in which reference and measured channels stand still.
pub(super) struct Standstill {
    /// Samples from the first to the last of a window.
    pub(super) length: usize,
    /// First samples of the windows, rising.
    pub(super) starts: Vec<usize>,
}

impl Standstill {
    /// Those of a log with a reference.
    ///
    /// # Errors
    /// [`LogError`] where there is no reference or no position.
    pub(super) fn of(log: &Log, period: f64, machine: &Axis) -> Result<Self, LogError> {
        let reference = reference_in(log)?;
        let length = (REST_TIME / period).round() as usize;
        let still = ranges(reference, length + 1);
        let mut starts: Vec<usize> = (0..still.len())
            .filter(|&k| still[k] <= AT_REST * REST_TIME)
            .collect();
        let lever = machine.travel_per_radian();
        let motor = log.channel(MOTOR).ok().map(|angle| (angle, lever));
        let position = position_shown(log, machine)?;
        let measured = [(&*position, 1.0)].into_iter().chain(motor);
        let mut all = Vec::new();
        for (samples, lever) in measured {
            let pairs = reference.iter().zip(samples);
            let error: Vec<f64> = pairs.map(|(r, x)| r - lever * x).collect();
            let changes = ranges(&error, length + 1);
            let quietest = starts.iter().map(|&k| changes[k]).fold(f64::MAX, f64::min);
            let whole = ranges(&error, error.len());
            let settled = SETTLED * whole.first().copied().unwrap_or(0.0);
            all.push((changes, settled.max(QUIET * quietest)));
        }
        starts.retain(|&k| all.iter().all(|(changes, most)| changes[k] <= *most));
        Ok(Self { length, starts })
    }
}

/// Greatest minus smallest of each `length` neighbouring samples.
fn ranges(samples: &[f64], length: usize) -> Vec<f64> {
    let highest = highest(samples.iter().copied(), length);
    let lowest = self::highest(samples.iter().map(|x| -x), length);
    highest.iter().zip(lowest).map(|(h, l)| h + l).collect()
}

/// The greatest of each `length` neighbours.
fn highest(samples: impl Iterator<Item = f64>, length: usize) -> Vec<f64> {
    // Those that none behind them exceeds, with their places.
    let mut candidates: VecDeque<(usize, f64)> = VecDeque::new();
    let mut all = Vec::new();
    for (k, x) in samples.enumerate() {
        while candidates.back().is_some_and(|(_, before)| *before <= x) {
            candidates.pop_back();
        }
        candidates.push_back((k, x));
        if candidates[0].0 + length <= k {
            candidates.pop_front();
        }
        if k + 1 >= length.max(1) {
            all.push(candidates[0].1);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::ranges;

    #[test]
    fn a_range_is_that_of_its_window() {
        let samples: Vec<f64> = (0..60).map(|k| f64::from(k * k % 17)).collect();
        for length in [1, 2, 7, 60] {
            let found = ranges(&samples, length);
            assert_eq!(found.len(), 61 - length);
            for (window, range) in samples.windows(length).zip(found) {
                let high = window.iter().copied().fold(f64::MIN, f64::max);
                let low = window.iter().copied().fold(f64::MAX, f64::min);
                assert_eq!(range, high - low);
            }
        }
        assert!(ranges(&samples, 61).is_empty());
    }
}
