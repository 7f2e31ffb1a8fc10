//! Whether a residual is there whether the axis moves or not.
//!
//! What a machine lacks comes with its motion; noise that a sensor brings into the loop, or a
//! disturbance from outside, does not ask whether the axis stands.

use std::ops::Range;

use axis_fourier::Complex;
use axis_sim::Trace;

use super::motion::Simulated;
use crate::answers::{LogSet, Rest};

/// Speeds below which the axis stands, and above which it moves fast, as shares of the fastest.
const STANDS: f64 = 1e-3;
const FAST: f64 = 0.3;

/// Least power above the white noise that is there while the axis stands, as a share of what is there
/// while it moves slowly or fast. What comes with motion is not there while the axis stands; noise
/// may even be the greatest there, where the bristles that hold the axis swing. Of coloured noise in the
/// loops of two linear motors the share was 0.46 and more, above 25 Hz.
const STANDING: f64 = 0.25;

/// Times the white noise that there must be in a channel for it to tell anything.
const STANDS_OUT: f64 = 1.5;

/// Periods of a band's width that each of the three must last, in all logs together.
const LONG: f64 = 5.0;

/// Share of the power of a residual that its mean has at least where it stays. Of noise with a low
/// corner the
/// mean over a log of seconds has a hundredth.
const STAYS: f64 = 0.5;

/// Whether the residual of some channel is mostly one value in each log of both sets, of the same
/// sign in all: an
/// offset, or a force that does not change, is no noise, and does not follow the motion either.
pub(crate) fn stays(sets: [Simulated; 2]) -> bool {
    let logs = sets.iter().flat_map(|(set, traces)| {
        let rests = set.rest(traces).into_iter().zip(set.counted());
        rests.map(|(rest, counted)| {
            let channels = rest.iter();
            channels.map(|r| mostly(&r[counted.clone()])).collect()
        })
    });
    let logs: Vec<Vec<f64>> = logs.collect();
    let channels = logs.first().map_or(0, Vec::len);
    let in_all = |c: usize, sign: f64| logs.iter().all(|log| sign * log[c] > 0.0);
    (0..channels).any(|c| in_all(c, 1.0) || in_all(c, -1.0))
}

/// Sign of what a series mostly is; 0 of one whose mean has little of its power.
fn mostly(series: &[f64]) -> f64 {
    let count = series.len().max(1) as f64;
    let mean = series.iter().sum::<f64>() / count;
    let power = series.iter().map(|v| v * v).sum::<f64>() / count;
    if mean != 0.0 && mean * mean >= STAYS * power {
        mean.signum()
    } else {
        0.0
    }
}

/// Rests of logs, with what the axis does meanwhile.
pub(super) struct Steadiness<'a> {
    set: &'a LogSet,
    rest: &'a Rest,
    groups: Vec<Vec<Option<usize>>>,
}

impl<'a> Steadiness<'a> {
    /// `traces` are simulations of the logs.
    pub(super) fn new(set: &'a LogSet, rest: &'a Rest, traces: &[Trace]) -> Self {
        let groups = groups(set, traces);
        Self { set, rest, groups }
    }

    /// Whether the residual in a band (`[low, high]`, Hz), above its `white` noise (power by
    /// channel,
    /// as a variance), is there while the axis stands as while it moves, slowly or fast, in some channel in
    /// which it stands out; not where the logs show too little of one of the three.
    ///
    /// One channel is enough: friction may hold the load against noise that the current shows.
    pub(super) fn holds(&self, band: [f64; 2], white: &[f64]) -> bool {
        let width = band[1] - band[0];
        let mut channels = white.iter().enumerate();
        channels.any(|(c, white)| {
            let (mut sums, mut seconds) = ([0.0; 3], [0.0; 3]);
            for ((log, groups), rest) in self.set.logs.iter().zip(&self.groups).zip(self.rest) {
                let mut inside = only(&rest[c], log.period, band);
                without_what_stays(&mut inside, groups);
                for (group, value) in groups.iter().zip(inside) {
                    if let Some(group) = group {
                        sums[*group] += value * value / (2.0 * width);
                        seconds[*group] += log.period;
                    }
                }
            }
            let is_long = seconds.iter().all(|s| s * width >= LONG);
            let powers = [0, 1, 2].map(|g| sums[g] / f64::max(seconds[g], f64::MIN_POSITIVE));
            is_long && is_there_too(powers, *white)
        })
    }
}

/// Whether powers while an axis stands, moves slowly and moves fast stand out of white noise, and the
/// first is not far below the others.
fn is_there_too(powers: [f64; 3], white: f64) -> bool {
    let [standing, slow, fast] = powers.map(|p| p - white);
    let moving = slow.max(fast);
    standing.max(moving) > (STANDS_OUT - 1.0) * white && standing >= STANDING * moving
}

/// What the axis does at each sample of each log: 0 if it stands, 1 where it moves slowly, 2
/// where it moves fast; none before a log counts.
fn groups(set: &LogSet, traces: &[Trace]) -> Vec<Vec<Option<usize>>> {
    let all = traces.iter().flat_map(|t| &t.speed);
    let fastest = all.fold(0.0, |most: f64, v| most.max(v.abs()));
    let of = |v: &f64| match v.abs() {
        v if v < STANDS * fastest => 0,
        v if v < FAST * fastest => 1,
        _ => 2,
    };
    let one = |(trace, counted): (&Trace, Range<usize>)| {
        let speeds = trace.speed.iter().enumerate();
        let group = |(k, v): (usize, &f64)| counted.contains(&k).then(|| of(v));
        speeds.map(group).collect()
    };
    traces.iter().zip(set.counted()).map(one).collect()
}

/// Takes the mean out of each standstill: a force that stays while the axis stands, or an offset, is there
/// then and no noise.
fn without_what_stays(values: &mut [f64], groups: &[Option<usize>]) {
    let mut at = 0;
    for run in groups.chunk_by(|a, b| a == b) {
        let (begin, stands) = (at, run.first() == Some(&Some(0)));
        at += run.len();
        let Some(standing) = values.get_mut(begin..at).filter(|_| stands) else {
            continue;
        };
        let mean = standing.iter().sum::<f64>() / standing.len() as f64;
        standing.iter_mut().for_each(|value| *value -= mean);
    }
}

/// Of a series, what lies in a band.
pub(super) fn only(series: &[f64], period: f64, [low, high]: [f64; 2]) -> Vec<f64> {
    let n = series.len();
    let inside = |k: usize| (low..high).contains(&(k as f64 / (n as f64 * period)));
    shaped(series, |k| if inside(k) { 1.0 } else { 0.0 })
}

/// A series whose bin k of n/2 + 1 counts so many times.
pub(super) fn shaped(series: &[f64], times: impl Fn(usize) -> f64) -> Vec<f64> {
    let n = series.len();
    let (forward, inverse) = (axis_fourier::forward(n), axis_fourier::inverse(n));
    let (mut samples, mut back) = (series.to_vec(), inverse.make_output_vec());
    let mut bins = forward.make_output_vec();
    // The lengths agree by construction, and ends that are real stay so.
    let mut done = forward.process(&mut samples, &mut bins);
    for (k, bin) in bins.iter_mut().enumerate() {
        *bin *= Complex::new(times(k) / n as f64, 0.0);
    }
    done = done.and_then(|()| inverse.process(&mut bins, &mut back));
    match done {
        Ok(()) => back,
        Err(_) => vec![0.0; n],
    }
}

#[cfg(test)]
mod tests {
    use super::{is_there_too, mostly, only, shaped, without_what_stays};

    const PERIOD: f64 = 1e-3;

    fn wave(hertz: f64) -> Vec<f64> {
        let turn = std::f64::consts::TAU * hertz * PERIOD;
        (0..4000).map(|k| (turn * k as f64).sin()).collect()
    }

    #[test]
    fn a_band_holds_the_waves_in_it_and_no_others() {
        let both: Vec<f64> = wave(27.25)
            .iter()
            .zip(wave(60.0))
            .map(|(a, b)| a + b)
            .collect();
        let off = |found: Vec<f64>, wanted: Vec<f64>| {
            let pairs = found.iter().zip(&wanted).map(|(a, b)| (a - b).abs());
            pairs.fold(0.0, f64::max)
        };
        assert!(off(only(&both, PERIOD, [25.0, 37.5]), wave(27.25)) < 1e-9);
        assert!(off(only(&both, PERIOD, [37.5, 84.0]), wave(60.0)) < 1e-9);
        assert!(off(shaped(&both, |_| 1.0), both.clone()) < 1e-9);
        assert!(off(only(&both, PERIOD, [100.0, 200.0]), vec![0.0; 4000]) < 1e-9);
    }

    #[test]
    fn a_force_that_stays_is_no_noise_of_a_standstill() {
        let groups = [Some(0), Some(0), Some(2), Some(0), Some(0), None];
        let mut values = [5.0, 7.0, 9.0, -3.0, -3.0, 1.0];
        without_what_stays(&mut values, &groups);
        assert_eq!(values, [-1.0, 1.0, 9.0, 0.0, 0.0, 1.0]);
    }

    #[test]
    fn a_rest_is_there_too_where_standing_is_not_far_below_moving() {
        assert!(is_there_too([2.0, 3.0, 4.0], 1.0));
        assert!(is_there_too([6.0, 1.6, 2.0], 1.0));
        assert!(!is_there_too([1.2, 3.0, 4.0], 1.0));
        assert!(is_there_too([9.0, 1.1, 4.0], 1.0));
        // A residual that is there where the axis moves alone, and one that is hardly there.
        assert!(!is_there_too([1.0, 1.6, 1.7], 1.0));
        assert!(!is_there_too([1.3, 1.4, 1.4], 1.0));
    }

    #[test]
    fn an_offset_is_most_of_a_rest_and_a_wave_is_not() {
        let wave = |offset: f64| -> Vec<f64> {
            let at = |k: usize| offset + (0.1 * k as f64).sin();
            (0..1000).map(at).collect()
        };
        assert_eq!([2.0, -2.0, 0.1].map(|o| mostly(&wave(o))), [1.0, -1.0, 0.0]);
        assert_eq!([mostly(&[0.0; 9]), mostly(&[])], [0.0; 2]);
    }
}
