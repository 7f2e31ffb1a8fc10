//! Slow noise that a logger adds.
//!
//! A converter that drifts, or mains hum on its line, is not white, and low frequencies are
//! where a model lacks what it lacks. Both are told apart by the loop: it answers to all that
//! is there, and not to what was added behind it. A load that moves makes the controller ask
//! for current, and the current follows what is asked for. So of the residual's spectral matrix S
//! in a band, what channel c shows beside what the others predict,
//!
//! ```text
//! d(c) = 1 / (S⁻¹)cc − 1 / (N⁻¹)cc,
//! ```
//!
//! with the matrix N of noise that is known, is the logger's, where another channel, its witness, shows less than
//! half of its answer to as much, and that would stand out of the witness' noise. The command is the witness of
//! the position and of the current. Of the command itself it is the position: a controller asks for no more than what
//! it is shown makes it ask for.

use axis_sim::{Axis, ClosedLoop, ReplayError, Trace};
use nalgebra::{Complex, DMatrix};
use rayon::prelude::*;

use super::level::{noise_at, shows_noise};
use super::{Floor, LogNoise, Rest, SensorNoise, at_state, noise_series};
use crate::answers::effort::COMMANDS;
use crate::answers::{LogSet, State};

/// Slow noise of a logger.
#[derive(Clone, Debug, Default)]
pub(crate) struct SlowNoise {
    /// Variance per value in each band, by fitted channel; empty if none is known.
    powers: Vec<Vec<f64>>,
}

/// Runs with noise whose mean spectrum is that of the noise that is known.
const RUNS: u64 = 6;

/// Times the noise beside the others that there must be of it.
const STANDS_OUT: f64 = 1.5;

/// Share of the witness' own noise, which is known to a tenth, that its answer would be at least.
const WOULD_SHOW: f64 = 0.5;

/// Share of the answer that the witness may show by chance.
const SHOWS: f64 = 0.5;

/// That of these logs, beside simulations of them without noise.
///
/// # Errors
/// [`ReplayError`] if the machine does not run with noise.
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
    let runs = (1..=RUNS).into_par_iter().map(|seed| spectra(&noise, seed));
    let runs: Vec<Vec<Matrix>> = runs.collect::<Result<_, ReplayError>>()?;
    let share = Complex::new(1.0 / RUNS as f64, 0.0);
    let mean = |b: usize| -> Matrix {
        let first = &runs[0][b] * share;
        runs[1..]
            .iter()
            .fold(first, |sum, run| sum + &run[b] * share)
    };
    let known: Vec<Matrix> = (0..runs[0].len()).map(mean).collect();
    // What the position loop reads: of an axis without a sensor at the load the motor's angle.
    let of_load = place(&["position_m", "position_rad"]);
    let position = of_load.or_else(|| place(&["motor_angle_rad"]));
    let alone = alone(&noise.sensors, of_load.is_some());
    let of_position = spectra(&LogNoise::of_sensors(alone), 1)?;
    let seen = set.layout.spectral_matrices(&set.amplitudes(&rest));
    // Of two channels, how much power the first shows for that of the second, of noise of the position.
    let answer = |b: usize, [first, second]: [usize; 2]| {
        let of = &of_position[b];
        of[(first, first)].re / of[(second, second)].re.max(f64::MIN_POSITIVE)
    };
    let of = |c: usize| -> Vec<f64> {
        let witness = match position {
            Some(position) if c == command => position,
            _ => command,
        };
        let bands = set.layout.bands().enumerate();
        let one = |(b, _): (usize, _)| {
            let answer = match set.channels[set.fitted[c]] {
                _ if witness == c => return 0.0,
                _ if [Some(c), Some(witness)].contains(&position) => answer(b, [witness, c]),
                // A current is at most what is asked for.
                "iq_a" => 1.0,
                _ => return 0.0,
            };
            unanswered([&seen[b], &known[b]], [c, witness], answer)
        };
        bands.map(one).collect()
    };
    Ok(SlowNoise {
        powers: (0..set.fitted.len()).map(of).collect(),
    })
}

type Matrix = DMatrix<Complex<f64>>;

/// Noise of the position alone, at the load or at the motor, some of it in any case.
fn alone(all: &SensorNoise, at_load: bool) -> SensorNoise {
    let own = |noise: f64, is_it: bool| match is_it {
        true => noise.max(f64::MIN_POSITIVE.sqrt()),
        false => 0.0,
    };
    SensorNoise {
        position: own(all.position, at_load),
        angle: own(all.angle, !at_load),
        ..SensorNoise::NONE
    }
}

/// Power that a `channel` shows beside the known noise and that its `witness` does not answer,
/// though it would with `answer` times as much; 0 if it does, or where that would not stand
/// out. Of the spectral matrices that are `seen` and `known`.
fn unanswered([seen, known]: [&Matrix; 2], [channel, witness]: [usize; 2], answer: f64) -> f64 {
    let [all, noise] = [seen, known].map(|m| beside_others(m, channel));
    let [shown, own] = [seen, known].map(|m| m[(witness, witness)].re);
    let added = all - noise;
    let asked = added * answer;
    let is_unanswered = asked >= WOULD_SHOW * own && shown - own < SHOWS * asked;
    match all > STANDS_OUT * noise && is_unanswered {
        true => added,
        false => 0.0,
    }
}

/// Power of a channel that the others do not predicts.
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

    /// Floors of the channels with this beside.
    pub(crate) fn beside_floors(&self, set: &LogSet, floors: Vec<Floor>) -> Vec<Floor> {
        let all = floors.into_iter().enumerate();
        all.map(|(c, floor)| floor.beside(self.rms(set, c)))
            .collect()
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

#[cfg(test)]
mod tests {
    use nalgebra::{Complex, DMatrix, DVector};

    use super::{Matrix, SlowNoise, unanswered};

    /// Current, command and voltage.
    const CHANNELS: [usize; 2] = [0, 1];

    /// Noise of unit power in each, that of the first two in part the same.
    fn known() -> Matrix {
        let real = DMatrix::from_row_slice(3, 3, &[1.0, 0.3, 0.0, 0.3, 1.0, 0.0, 0.0, 0.0, 1.0]);
        real.map(|v| Complex::new(v, 0.0))
    }

    /// The same with something beside it that shows so much in each channel.
    fn with(shows: [f64; 3]) -> Matrix {
        let by = DVector::from_iterator(3, shows.map(|v| Complex::new(v, 0.0)));
        known() + &by * by.adjoint()
    }

    fn found(seen: &Matrix, answer: f64) -> f64 {
        unanswered([seen, &known()], CHANNELS, answer)
    }

    #[test]
    fn what_one_channel_shows_and_the_command_does_not_is_the_loggers() {
        for power in [2.0, 9.0, 1e4] {
            let of_logger = found(&with([f64::sqrt(power), 0.0, 0.0]), 1.0);
            assert!((of_logger - power).abs() < 1e-9 * power, "{of_logger}");
        }
    }

    #[test]
    fn what_the_command_answers_is_the_machines_however_large() {
        for size in [1.0, 3.0, 100.0] {
            assert_eq!(found(&with([size, size, 0.2 * size]), 1.0), 0.0);
            // Though the voltages are as quiet as ever.
            assert_eq!(found(&with([size, size, 0.0]), 1.0), 0.0);
        }
    }

    #[test]
    fn nothing_is_found_in_noise_or_where_the_answer_would_not_show() {
        assert_eq!(found(&known(), 1.0), 0.0);
        assert_eq!(found(&with([3.0, 0.0, 0.0]), 0.01), 0.0);
    }

    #[test]
    fn it_stands_beside_the_known_noise_of_its_channel() {
        let slow = SlowNoise {
            powers: vec![vec![0.0, 4.0], vec![0.0; 2], vec![0.0; 2]],
        };
        assert_eq!(slow.beside(0, known()), known());
        assert_eq!(slow.beside(1, known()) - known(), {
            let mut only = Matrix::zeros(3, 3);
            only[(0, 0)] = Complex::new(4.0, 0.0);
            only
        });
        assert_eq!(SlowNoise::default().beside(1, known()), known());
    }
}
