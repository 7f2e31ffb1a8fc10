//! A hum in the loop: noise at one frequency.
//!
//! The spectrum of noise is taken as constant over bands, and a line in one of them would be the
//! weight of all its bins: what is missing there is not seen beside it, while an effect that
//! happens to
//! take a twentieth of the line seems to explain a great deal. So where the residual has a line
//! above
//! the first
//! band on both sets of logs, which does not follow the motion and is there while the axis stands,
//! its
//! wave is taken out of all channels of each log, by least squares, with a phase of its own in
//! each.
//! What is missing may look like a line, or hide one: after each effect that is named, the hum is
//! sought anew.

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

/// Power of a bin, as a multiple of the median of its band and channel, mean of all channels, that
/// a line
/// has on the fitted logs: of noise, one in a million.
const LINE: f64 = 20.0;

/// And on the others.
const THERE_TOO: f64 = 10.0;

/// Steps of a frequency that are tried in one over a log's duration.
const STEPS: f64 = 16.0;

/// Width about a line in which its power is seen while the axis stands and moves, Hz.
const WIDTH: f64 = 6.0;

/// Distance from a line that was a hum within which it is the same one, Hz.
const SAME: f64 = 1.0;

impl Hum {
    /// Of logs that are fitted and others, with their simulations. What is `known` for a hum is
    /// one where
    /// it still stands out.
    pub(crate) fn of(fit: Simulated, check: Simulated, known: &Self) -> Self {
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
            let is_noise = || {
                steadiness.holds(about, &vec![0.0; check.0.channels.len()])
                    && band.is_some_and(|band| !of_motion.follows(band))
            };
            let is_hum = checked.at(frequency) >= THERE_TOO && (known.has(frequency) || is_noise());
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

    /// Whether this frequency is one of its own.
    fn has(&self, frequency: f64) -> bool {
        let mut own = self.frequencies.iter();
        own.any(|f| (f - frequency).abs() < SAME)
    }

    /// Whether there is any.
    pub(crate) fn is_none(&self) -> bool {
        self.frequencies.is_empty()
    }

    /// The logs without it, as a machine at this state leaves it.
    ///
    /// # Errors
    /// [`ReplayError`] if the machine does not run.
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

    /// These logs without what was taken out of `other`, which are the same ones: what two
    /// machines leave of
    /// them is compared without one and the same hum.
    pub(crate) fn as_in(other: &LogSet, set: &LogSet) -> LogSet {
        let mut set = set.clone();
        for (log, other) in set.logs.iter_mut().zip(&other.logs) {
            log.hum.clone_from(&other.hum);
        }
        set
    }

    /// These logs with everything that hums in them.
    pub(crate) fn put_back(set: &LogSet) -> LogSet {
        let mut set = set.clone();
        for log in &mut set.logs {
            log.hum.iter_mut().for_each(Vec::clear);
        }
        set
    }

    /// What must be known of it to read a result.
    pub(crate) fn notes(&self) -> Vec<String> {
        let one = |frequency: &f64| {
            format!(
                "the logs have a hum of {frequency:.2} Hz, which does not follow the motion and is there at standstill; it was removed. A load that repeats at that frequency would look the same"
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

/// Powers of a residual's bins beside the medians of their bands, mean of the channels.
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
            .filter(|(f, _)| (f - frequency).abs() < SAME);
        near.map(|(_, power)| *power).fold(0.0, f64::max)
    }

    /// The frequency near a bin's at which waves take most of the residual.
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

    use axis_log::{Channel, Log};
    use axis_sim::{Axis, ClosedLoop, Recorder};
    use compensator::NoCompensation;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};
    use trajectories::{Limits, Program, Step};

    use super::{Hum, turned, wave};
    use crate::answers::{LogSet, State};

    /// A linear motor that moves there and back in a second and a half, and noise of each of its
    /// channels with a hum of 61.3 Hz three times as large.
    fn humming() -> (Axis, LogSet) {
        let file = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../data/axes/linear-motor.toml"
        );
        let machine = Axis::read(file.as_ref()).unwrap();
        let from = machine.stroke.start;
        let limits = Limits::new(0.2, 2.0, 40.0).unwrap();
        let rest = Step::Dwell { duration: 0.2 };
        let to = |to: f64| Step::Move { to, limits };
        let steps = vec![rest, to(from + 0.05), rest, to(from), rest];
        let program = Program::new(from, steps).unwrap();
        let mut recorder = Recorder::new(&machine);
        ClosedLoop::new(&machine)
            .unwrap()
            .without_noise()
            .run(&program, &mut NoCompensation, |c| recorder.push(c))
            .completed()
            .unwrap();
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let turn = TAU * 61.3 * machine.period;
        let mut noisy = |channel: &Channel| {
            let mut channel = channel.clone();
            let size = match channel.name.as_str() {
                "position_m" => 1e-8,
                "iq_a" | "iq_ref_a" => 0.01,
                "ud_v" | "uq_v" => 0.1,
                _ => 0.0,
            };
            for (k, x) in channel.samples.iter_mut().enumerate() {
                let normal: f64 = StandardNormal.sample(&mut random);
                *x += size * (normal + 3.0 * (turn * k as f64).sin());
            }
            channel
        };
        let log = recorder.log().unwrap();
        let log = Log::new(log.channels().iter().map(&mut noisy).collect()).unwrap();
        let logs = vec![("log".to_owned(), log, machine.period)];
        let set = LogSet::new(logs, &machine).unwrap();
        (machine, set)
    }

    /// A log that rests too little to tell a hum from what comes with motion; but what was known
    /// for
    /// one is one, as long as it stands out, and what was taken out is put back.
    #[test]
    fn a_hum_that_is_known_stays_out_while_it_stands_out() {
        let (machine, set) = humming();
        let traces = set.simulate(&machine, &State::initial(&machine)).unwrap();
        let of = |set: &LogSet, known: &Hum| Hum::of((set, &traces), (set, &traces), known);
        let power = |set: &LogSet| set.rest(&traces)[0][0].iter().map(|r| r * r).sum::<f64>();
        assert!(of(&set, &Hum::default()).is_none());

        let known = Hum {
            frequencies: vec![61.0],
        };
        let hum = of(&set, &known);
        let [found] = hum.frequencies[..] else {
            panic!("{hum:?}");
        };
        assert!((found - 61.3).abs() < 0.1, "{found}");
        let without = hum.taken_out(&set, &traces);
        // Noise of unit power, and a wave of 9/2.
        let ratio = power(&set) / power(&without);
        assert!((ratio - 5.5).abs() < 0.5, "{ratio}");
        assert!(of(&without, &known).is_none());
        assert_eq!(power(&Hum::put_back(&without)), power(&set));
        assert_eq!(power(&Hum::as_in(&without, &set)), power(&without));
    }

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
