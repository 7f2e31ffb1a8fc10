//! Slow noise that a logger adds.
//!
//! A converter that drifts, or mains hum on its line, is not white, and low frequencies are
//! where a model lacks what it lacks. Both are told apart by the loop: it answers to all that
//! is there, and not to what was added behind it. A load that moves makes the controller ask
//! for current, and the current follows what is asked for. So of the rest's spectral matrix S
//! in a band, what channel c shows beside what the others foretell,
//!
//! ```text
//! d(c) = 1 / (S⁻¹)cc − 1 / (N⁻¹)cc,
//! ```
//!
//! with the matrix N of noise that is known, is the logger's, where the command shows less than
//! half of its answer to as much, and that would stand out of the command's noise.

use axis_sim::{Axis, ClosedLoop, ReplayError, Trace};
use nalgebra::{Complex, DMatrix};

use super::level::{noise_at, shows_noise};
use super::{LogNoise, Rest, SensorNoise, at_state, noise_series};
use crate::answers::effort::COMMANDS;
use crate::answers::{LogSet, State};

/// Slow noise of a logger.
#[derive(Clone, Debug, Default)]
pub(crate) struct SlowNoise {
    /// Variance per value in each band, by fitted channel; empty where none is known.
    powers: Vec<Vec<f64>>,
}

/// Runs with noise whose mean spectrum is that of the noise that is known.
const RUNS: u64 = 6;

/// Times the noise beside the others that there must be of it.
const STANDS_OUT: f64 = 1.5;

/// Share of the command's own noise, which is known to a tenth, that its answer would be at least.
const WOULD_SHOW: f64 = 0.5;

/// Share of the answer that the command may show by chance.
const SHOWS: f64 = 0.5;

/// That of these logs, beside simulations of them without noise.
///
/// # Errors
/// [`ReplayError`] where the machine does not run with noise.
pub(crate) fn slow_noise(
    machine: &Axis,
    set: &LogSet,
    state: &State,
    traces: &[Trace],
) -> Result<SlowNoise, ReplayError> {
    let axis = at_state(machine, state);
    let place = |names: &[&str]| {
        let fitted = set.fitted.iter();
        let mut names_of = fitted.map(|&c| set.channels[c]);
        names_of.position(|name| names.contains(&name))
    };
    let Some(command) = place(&COMMANDS).filter(|_| shows_noise(&axis, set)) else {
        return Ok(SlowNoise::default());
    };
    let rest = set.rest(traces);
    let closed_loop = ClosedLoop::new(&axis)?.without_noise();
    let noise = noise_at(&axis, set, &rest, traces);
    let spectra = |noise: &LogNoise, seed: u64| -> Result<Vec<Matrix>, ReplayError> {
        let run: Rest = noise_series(&closed_loop, set, traces, noise, seed)?;
        Ok(set.layout.spectral_matrices(&set.amplitudes(&run)))
    };
    let mut known = spectra(&noise, 1)?;
    for seed in 2..=RUNS {
        for (sum, run) in known.iter_mut().zip(spectra(&noise, seed)?) {
            *sum += run;
        }
    }
    let share = Complex::new(1.0 / RUNS as f64, 0.0);
    known.iter_mut().for_each(|sum| *sum *= share);
    let position = place(&["position_m", "position_rad"]);
    let of_position = spectra(&LogNoise::of_sensors(position_alone(&noise.sensors)), 1)?;
    let seen = set.layout.spectral_matrices(&set.amplitudes(&rest));
    let of = |c: usize| -> Vec<f64> {
        let bands = set.layout.bands().enumerate();
        let one = |(b, _): (usize, _)| {
            // The command's answer to what the channel shows, of powers. A current is at most
            // what is asked for.
            let answer = if Some(c) == position {
                let of = &of_position[b];
                of[(command, command)].re / of[(c, c)].re.max(f64::MIN_POSITIVE)
            } else if set.channels[set.fitted[c]] == "iq_a" {
                1.0
            } else {
                return 0.0;
            };
            let [all, noise] = [&seen[b], &known[b]].map(|m| beside_others(m, c));
            let added = all - noise;
            let of_command = |m: &Matrix| m[(command, command)].re;
            let [shown, own] = [of_command(&seen[b]), of_command(&known[b])];
            let asked = added * answer;
            let unanswered = asked >= WOULD_SHOW * own && shown - own < SHOWS * asked;
            if all > STANDS_OUT * noise && unanswered {
                added
            } else {
                0.0
            }
        };
        bands.map(one).collect()
    };
    Ok(SlowNoise {
        powers: (0..set.fitted.len()).map(of).collect(),
    })
}

type Matrix = DMatrix<Complex<f64>>;

/// Noise of the position alone, some of it in any case.
fn position_alone(all: &SensorNoise) -> SensorNoise {
    SensorNoise {
        position: all.position.max(f64::MIN_POSITIVE.sqrt()),
        angle: 0.0,
        speed: 0.0,
        current: 0.0,
    }
}

/// Power of a channel that the others do not foretell.
fn beside_others(spectral: &Matrix, channel: usize) -> f64 {
    let inverse = spectral.clone().cholesky().map(|c| c.inverse());
    inverse.map_or(0.0, |i| 1.0 / i[(channel, channel)].re)
}

impl SlowNoise {
    /// Known noise of a band with this beside it.
    pub(super) fn beside(&self, band: usize, mut known: Matrix) -> Matrix {
        for (c, powers) in self.powers.iter().enumerate() {
            known[(c, c)] += Complex::new(powers[band], 0.0);
        }
        known
    }

    /// Root mean square in a channel of these logs, of all their samples' bandwidth.
    pub(crate) fn rms(&self, set: &LogSet, channel: usize) -> f64 {
        let place = set.fitted.iter().position(|&c| c == channel);
        let Some(powers) = place.and_then(|p| self.powers.get(p)) else {
            return 0.0;
        };
        let in_bands = powers.iter().zip(set.layout.values());
        let sum: f64 = in_bands.map(|(power, values)| power * values).sum();
        let samples: usize = set.logs.iter().map(|l| l.log.len()).sum();
        (sum / (0.5 * samples as f64)).sqrt()
    }

    /// What must be known of it to read a result.
    pub(crate) fn notes(&self, set: &LogSet) -> Vec<String> {
        let one = |(p, powers): (usize, &Vec<f64>)| {
            let c = set.fitted[p];
            let bands = set.layout.bands().zip(powers);
            let highest = bands.filter(|(_, power)| **power > 0.0).last()?.0.0[1];
            Some(format!(
                "{}: {:.2e} RMS of noise below {highest:.0} Hz to which nothing in the loop answers; it is taken for the logger\u{2019}s",
                set.channels[c],
                self.rms(set, c)
            ))
        };
        self.powers.iter().enumerate().filter_map(one).collect()
    }
}
