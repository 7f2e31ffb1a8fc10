//! A hum in the loop: noise at one frequency.
//!
//! The spectrum of noise is taken as constant over bands, and a line in one of them would be the
//! weight of all its bins: what is missing there is not seen beside it, while an effect that happens to
//! take a twentieth of the line seems to explain a great deal. So where the rest has a line above the first
//! band on both sets of logs, which does not follow the motion and is there while the axis stands, its
//! wave is taken out of all channels of each log, by least squares, with a phase of its own in each.

use std::borrow::Cow;
use std::f64::consts::TAU;

use axis_sim::{Axis, ReplayError, Trace};
use nalgebra::{Complex, Matrix2, Vector2};

use super::motion::{MotionAndRest, Simulated};
use super::steady::Steadiness;
use crate::answers::{LogSet, Rest, State};

/// Frequencies at which the loop hums.
#[derive(Clone, Debug, Default)]
pub(crate) struct Hum {
    frequencies: Vec<f64>,
}

/// Most lines.
const LINES: usize = 3;

/// Power of a bin, as a multiple of the median of its band and channel, mean of all channels, that a line
/// has on the fitted logs: of noise, one in a million.
const LINE: f64 = 20.0;

/// And on the others.
const THERE_TOO: f64 = 10.0;

/// Steps of a frequency that are tried in one over a log's duration.
const STEPS: f64 = 16.0;

/// Width about a line in which its power is seen while the axis stands and moves, Hz.
const WIDTH: f64 = 6.0;

impl Hum {
    /// Of logs that are fitted and others, with their simulations.
    pub(crate) fn of(fit: Simulated, check: Simulated) -> Self {
        let mut hum = Self::default();
        if fit.0.is_balanced() {
            return hum;
        }
        let before = check.0.rest(check.1);
        let of_motion = MotionAndRest::new(fit, check);
        let steadiness = Steadiness::new(check.0, &before, check.1);
        let [mut of_fit, mut of_check] = [fit.0.rest(fit.1), before.clone()];
        while hum.frequencies.len() < LINES {
            let fitted = Lines::of(fit.0, &of_fit);
            let Some(peak) = fitted.strongest().filter(|(_, power)| *power >= LINE) else {
                break;
            };
            let frequency = fitted.refined(fit.0, &of_fit, peak.0);
            let checked = Lines::of(check.0, &of_check);
            let about = [frequency - 0.5 * WIDTH, frequency + 0.5 * WIDTH];
            let band = fit.0.layout.bands().map(|(edges, _)| edges);
            let band = band.into_iter().find(|edges| frequency < edges[1]);
            let is_hum = checked.at(frequency) >= THERE_TOO
                && steadiness.holds(about, &vec![0.0; check.0.channels.len()])
                && band.is_some_and(|band| !of_motion.follows(band));
            tracing::debug!(frequency, power = peak.1, is_hum, "line");
            if !is_hum {
                break;
            }
            hum.frequencies.push(frequency);
            take_out(fit.0, &mut of_fit, frequency);
            take_out(check.0, &mut of_check, frequency);
        }
        hum
    }

    /// Whether there is any.
    pub(crate) fn is_none(&self) -> bool {
        self.frequencies.is_empty()
    }

    /// The logs without it, as a machine at this state leaves it.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine does not run.
    pub(crate) fn out_of<'a>(
        &self,
        machine: &Axis,
        set: &'a LogSet,
        state: &State,
    ) -> Result<Cow<'a, LogSet>, ReplayError> {
        match self.is_none() {
            true => Ok(Cow::Borrowed(set)),
            false => {
                let traces = set.simulate(machine, state)?;
                Ok(Cow::Owned(self.taken_out(set, &traces)))
            }
        }
    }

    /// The same, of simulations of the logs.
    pub(crate) fn taken_out(&self, set: &LogSet, traces: &[Trace]) -> LogSet {
        let before = set.rest(traces);
        let mut after = before.clone();
        for frequency in &self.frequencies {
            take_out(set, &mut after, *frequency);
        }
        let mut set = set.clone();
        let logs = set.logs.iter_mut().zip(before.iter().zip(&after));
        for (log, (before, after)) in logs {
            let channels = log.hum.iter_mut().zip(before.iter().zip(after));
            for (hum, (before, after)) in channels {
                hum.resize(before.len(), 0.0);
                let wave = before.iter().zip(after).map(|(b, a)| b - a);
                hum.iter_mut().zip(wave).for_each(|(hum, w)| *hum += w);
            }
        }
        set
    }

    /// What must be known of it to read a result.
    pub(crate) fn notes(&self) -> Vec<String> {
        let one = |frequency: &f64| {
            format!(
                "the logs have a hum of {frequency:.2} Hz, which does not follow the motion and is there while the axis stands; it was taken out of them. A load that repeats as fast would look alike"
            )
        };
        self.frequencies.iter().map(one).collect()
    }
}

/// Takes a wave out of each channel of each log.
fn take_out(set: &LogSet, rest: &mut Rest, frequency: f64) {
    let logs = set.logs.iter().zip(set.counted());
    for ((log, counted), channels) in logs.zip(rest) {
        let turn = TAU * frequency * log.period;
        for channel in channels {
            let wave = wave(&channel[counted.clone()], turn);
            for (k, value) in channel[counted.clone()].iter_mut().enumerate() {
                *value -= (wave * turned(turn, k)).re;
            }
        }
    }
}

/// e^(−i·turn·k).
fn turned(turn: f64, k: usize) -> Complex<f64> {
    Complex::cis(-turn * k as f64)
}

/// The wave of least squares, as its real part times [`turned`].
fn wave(series: &[f64], turn: f64) -> Complex<f64> {
    let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
    for (k, value) in series.iter().enumerate() {
        let at = turned(turn, k);
        let row = Vector2::new(at.re, -at.im);
        normal += row * row.transpose();
        right += row * *value;
    }
    let found = normal.try_inverse().map(|inverse| inverse * right);
    found.map_or(Complex::new(0.0, 0.0), |w| Complex::new(w[0], w[1]))
}

/// Powers of a rest's bins beside the medians of their bands, mean of the channels.
struct Lines {
    /// Frequency, Hz, and power; the first band is left out.
    bins: Vec<(f64, f64)>,
    /// Median of each band and channel.
    medians: Vec<Vec<f64>>,
    bands: Vec<[f64; 2]>,
}

impl Lines {
    fn of(set: &LogSet, rest: &Rest) -> Self {
        let layout = &set.layout;
        let amplitudes = set.amplitudes(rest);
        let bands: Vec<[f64; 2]> = layout.bands().map(|(edges, _)| edges).collect();
        let band_of = |frequency: f64| bands.iter().position(|b| frequency < b[1]);
        let median = |b: usize, c: usize| {
            let mut powers: Vec<f64> = (layout.bins(&amplitudes))
                .filter(|(frequency, _)| band_of(*frequency) == Some(b))
                .map(|(_, bin)| bin[c].norm_sqr())
                .collect();
            powers.sort_by(f64::total_cmp);
            let middle = powers.get(powers.len() / 2).copied().unwrap_or(0.0);
            middle.max(f64::MIN_POSITIVE)
        };
        let channels = layout.channels();
        let medians: Vec<Vec<f64>> = (0..bands.len())
            .map(|b| (0..channels).map(|c| median(b, c)).collect())
            .collect();
        let beside = |(frequency, bin): (f64, &[Complex<f64>])| {
            let band = band_of(frequency).filter(|b| *b > 0)?;
            let powers = bin
                .iter()
                .zip(&medians[band])
                .map(|(v, m)| v.norm_sqr() / m);
            Some((frequency, powers.sum::<f64>() / channels as f64))
        };
        Self {
            bins: layout.bins(&amplitudes).filter_map(beside).collect(),
            medians,
            bands,
        }
    }

    fn strongest(&self) -> Option<(f64, f64)> {
        let bins = self.bins.iter().copied();
        bins.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The strongest bin within 1 Hz.
    fn at(&self, frequency: f64) -> f64 {
        let near = self
            .bins
            .iter()
            .filter(|(f, _)| (f - frequency).abs() < 1.0);
        near.map(|(_, power)| *power).fold(0.0, f64::max)
    }

    /// The frequency near a bin's at which waves take most of the rest.
    fn refined(&self, set: &LogSet, rest: &Rest, peak: f64) -> f64 {
        let longest = set.logs.iter().map(|l| l.log.len() as f64 * l.period);
        let width = 1.0 / longest.fold(f64::MIN_POSITIVE, f64::max);
        let band = self.bands.iter().position(|b| peak < b[1]).unwrap_or(0);
        let taken = |frequency: f64| -> f64 {
            let logs = set.logs.iter().zip(set.counted()).zip(rest);
            let of_log = logs.map(|((log, counted), channels)| -> f64 {
                let of_channel = |(&c, median): (&usize, &f64)| {
                    let series = &channels[c][counted.clone()];
                    wave(series, TAU * frequency * log.period).norm_sqr() * series.len() as f64
                        / median
                };
                set.fitted
                    .iter()
                    .zip(&self.medians[band])
                    .map(of_channel)
                    .sum()
            });
            of_log.sum()
        };
        let steps = -(1.5 * STEPS) as i32..=(1.5 * STEPS) as i32;
        let tried = steps.map(|k| peak + f64::from(k) * width / STEPS);
        let tried = tried.map(|f| (f, taken(f)));
        tried
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .map_or(peak, |t| t.0)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::{turned, wave};

    #[test]
    fn a_wave_is_found_with_its_phase_beside_a_drift() {
        let turn = TAU * 38.05e-3;
        let series: Vec<f64> = (0..7000)
            .map(|k| 3.0 * (turn * f64::from(k) + 0.7).sin() + 0.1 + 1e-5 * f64::from(k))
            .collect();
        let found = wave(&series, turn);
        let left = series.iter().enumerate();
        let left = left.map(|(k, v)| v - (found * turned(turn, k)).re);
        let largest = left.fold(0.0, |most: f64, v| most.max(v.abs()));
        // The drift alone.
        assert!(largest < 0.172, "{largest}");
        assert!((found.norm() - 3.0).abs() < 1e-3);
    }
}
