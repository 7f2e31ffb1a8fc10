//! How noisy the sensors are that logs were taken with.

use axis_sim::{Axis, ClosedLoop, ReplayError, Trace};

use super::sensor::Sensor;
use super::sources::{Powers, variances};
use super::{LogNoise, Rest, SensorNoise, noise_series};
use crate::answers::LogSet;
use crate::answers::effort::COMMANDS;
use crate::spectrum::Layout;

/// Whether the logs of an axis show the noise of its sensors: not where the loop has no
/// memory and reads a position alone, of which command and position are one measurement, nor
/// in a torque balance.
pub fn shows_noise(axis: &Axis, set: &LogSet) -> bool {
    !axis.control.starts_in_motion() && !set.is_balanced()
}

/// Noise of the logs of an axis (its effects included), as their rest shows it beside
/// simulations without any: white.
///
/// The upper half of the bins lies above what the position loop answers to. There the
/// position and the angle show their own noise, the command that of the speed through the
/// speed controller, the d voltage that of the current through the current controller: by
/// how much is first guessed from the proportional gains. Then each sensor's noise is run
/// through the loop by itself, and what each of them and the logger make of the residual is
/// found from all channels and bands together ([`variances`]): no channel's noise is taken
/// from another alone.
pub fn noise_at(axis: &Axis, set: &LogSet, rest: &Rest, quiet: &[Trace]) -> LogNoise {
    Spectra::of(axis, set, rest, quiet).white()
}

/// Powers of a residual by channel and band, and of what each sensor's noise does there.
pub(super) struct Spectra<'a> {
    set: &'a LogSet,
    pub(super) bands: Bands,
    /// Of the residual.
    pub(super) observed: Powers,
    /// Noise of the sensors, guessed.
    pub(super) guess: SensorNoise,
    /// Of what each of them does with that, in the order of [`Sensor::ALL`].
    pub(super) answers: Vec<Powers>,
    /// Of the position sensors, as the logs show them.
    steps: [f64; 2],
}

impl<'a> Spectra<'a> {
    pub(super) fn of(axis: &Axis, set: &'a LogSet, rest: &Rest, quiet: &[Trace]) -> Self {
        let guess = Levels::of(set, rest).noise(axis);
        let bands = Bands::of(set);
        let observed = bands.powers(set, rest);
        let answers = answers(axis, set, quiet, &bands, guess, LogNoise::of_sensors);
        Self {
            set,
            answers: heard(answers, &observed),
            observed,
            guess,
            bands,
            steps: set.steps_shown(axis),
        }
    }

    /// Of what each sensor does with noise as guessed that is white up to where the bands end, and none
    /// above. What lies above comes back below where a log has a lower rate than the loop.
    pub(super) fn answers_in_bands(&self, axis: &Axis, quiet: &[Trace]) -> Vec<Powers> {
        let end = self.bands.edges().last().map_or(0.0, |[_, high]| high);
        let noise = |sensors| LogNoise::in_band(sensors, end);
        let answers = answers(axis, self.set, quiet, &self.bands, self.guess, noise);
        heard(answers, &self.observed)
    }

    /// What all sources make of the residual: the sensors as they were guessed, then loggers of
    /// unit
    /// variance.
    fn sources(&self) -> Vec<Powers> {
        let of_logger = |c: usize| {
            let mut own = self.bands.nothing(self.set);
            own[c].fill(1.0);
            own
        };
        let loggers = (0..self.set.channels.len()).map(of_logger);
        self.answers.iter().cloned().chain(loggers).collect()
    }

    /// White noise of sensors and loggers.
    pub(super) fn white(&self) -> LogNoise {
        let sources = self.sources();
        // A command is made of what the sensors show, and tells them from the logger. Without one
        // nobody knows, and neither comes first.
        let has_command = self.set.channels.iter().any(|c| COMMANDS.contains(c));
        let last = match has_command {
            true => self.answers.len(),
            false => sources.len(),
        };
        let bands = &self.bands;
        let found = variances(&self.observed, &sources, &bands.values, bands.upper, last);
        let (of_sensors, of_logger) = found.split_at(self.answers.len());
        let loop_noise = Sensor::ALL.iter().zip(of_sensors);
        let logger = self.set.channels.iter().zip(of_logger);
        let sensors = loop_noise.fold(self.guess, |noise, (s, p)| s.times(noise, p.sqrt()));
        let noise = LogNoise {
            logger: logger.map(|(&name, p)| (name, p.sqrt())).collect(),
            steps: self.steps,
            ..LogNoise::of_sensors(sensors)
        };
        tracing::debug!(?noise, "noise of the logs");
        noise
    }

    /// Powers of white noise.
    pub(super) fn predicted(&self, noise: &LogNoise) -> Powers {
        let (mut own, mut guess) = (noise.sensors, self.guess);
        let share = |sensor: &Sensor| match *sensor.of(&mut guess) {
            0.0 => 0.0,
            guess => (*sensor.of(&mut own) / guess).powi(2),
        };
        let of_sensors: Vec<f64> = Sensor::ALL.iter().map(share).collect();
        let names = self.set.channels.iter();
        let of_loggers = names.map(|name| noise.logger.get(name).map_or(0.0, |d| d * d));
        let shares: Vec<f64> = of_sensors.into_iter().chain(of_loggers).collect();
        let mut all = self.bands.nothing(self.set);
        for (source, share) in self.sources().iter().zip(shares) {
            for (into, powers) in all.iter_mut().flatten().zip(source.iter().flatten()) {
                *into += share * powers;
            }
        }
        all
    }
}

/// Powers of what each sensor's `noise` alone does to the logs, with levels as `guess`ed; nothing
/// where the machine does not run with it.
fn answers(
    axis: &Axis,
    set: &LogSet,
    quiet: &[Trace],
    bands: &Bands,
    guess: SensorNoise,
    noise: impl Fn(SensorNoise) -> LogNoise,
) -> Vec<Powers> {
    let run = |alone: SensorNoise| -> Result<Rest, ReplayError> {
        let closed_loop = ClosedLoop::new(axis)?.without_noise();
        noise_series(&closed_loop, set, quiet, &noise(alone), 0)
    };
    let answer = |sensor: Sensor| {
        let mut alone = sensor.alone(guess);
        match *sensor.of(&mut alone) {
            0.0 => bands.nothing(set),
            _ => run(alone).map_or_else(|_| bands.nothing(set), |rest| bands.powers(set, &rest)),
        }
    };
    Sensor::ALL.map(answer).into()
}

/// Least that a sensor's noise as guessed makes of a residual's power in some channel and band for
/// it to be
/// heard there. A sensor that the control does not read, and whose channel is compared without its noise, makes what
/// rounding makes of it: that would be amplified until it explains the residual, by 10¹⁴⁰ of a
/// joint's load sensor.
const HEARD: f64 = 1e-9;

/// What sensors do to the logs, and nothing of those that are not heard.
fn heard(mut answers: Vec<Powers>, observed: &Powers) -> Vec<Powers> {
    for answer in &mut answers {
        let mut cells = answer.iter().flatten().zip(observed.iter().flatten());
        let is_heard = cells.any(|(own, all)| *own > HEARD * all);
        if !is_heard {
            answer.iter_mut().flatten().for_each(|power| *power = 0.0);
        }
    }
    answers
}

/// Bands of the logs, for one channel at a time.
pub(super) struct Bands {
    layout: Layout,
    values: Vec<f64>,
    /// The first in the upper half of the frequencies.
    upper: usize,
}

impl Bands {
    fn of(set: &LogSet) -> Self {
        let sizes: Vec<(usize, f64)> = set.logs.iter().map(|l| (l.log.len(), l.period)).collect();
        let layout = Layout::new(1, &sizes);
        let edges: Vec<[f64; 2]> = layout.bands().map(|(edges, _)| edges).collect();
        let half = 0.5 * edges.last().map_or(0.0, |e| e[1]);
        // The last band in any case.
        let upper = edges.iter().position(|e| e[0] >= half);
        Self {
            values: layout.values().to_vec(),
            upper: upper.unwrap_or(edges.len().saturating_sub(1)),
            layout,
        }
    }

    /// Lower and upper edge of each, Hz.
    pub(super) fn edges(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.layout.bands().map(|(edges, _)| edges)
    }

    fn nothing(&self, set: &LogSet) -> Powers {
        vec![vec![0.0; self.values.len()]; set.channels.len()]
    }

    /// Mean power of a residual in each channel and band.
    pub(super) fn powers(&self, set: &LogSet, rest: &Rest) -> Powers {
        let channel = |c: usize| {
            let amplitudes = rest.iter().enumerate().map(|(l, log)| {
                self.layout
                    .transform(l, &log[c..=c], &[set.counts_from_its_mean(c)])
            });
            let matrices = self.layout.spectral_matrices(&amplitudes.collect());
            matrices.iter().map(|s| s[(0, 0)].re).collect()
        };
        (0..set.channels.len()).map(channel).collect()
    }
}

/// RMS of white noise with the level of the upper half of the bins, of the channels that
/// show a sensor each.
struct Levels {
    position: f64,
    angle: f64,
    command: f64,
    voltage: f64,
    /// Measured, not commanded.
    current: f64,
}

impl Levels {
    fn of(set: &LogSet, rest: &Rest) -> Self {
        let level = |names: &[&str]| {
            let channel = set.channels.iter().position(|c| names.contains(c));
            channel.map_or(0.0, |c| upper_level(set, rest, c))
        };
        Self {
            position: level(&["position_m", "position_rad"]),
            angle: level(&["motor_angle_rad"]),
            command: level(&COMMANDS),
            voltage: level(&["ud_v"]),
            current: level(&["iq_a"]),
        }
    }

    /// By the proportional gains alone. Where neither command nor voltage is logged, the
    /// current stands for both.
    fn noise(&self, axis: &Axis) -> SensorNoise {
        let either = |first: f64, other: f64| if first > 0.0 { first } else { other };
        let per = |level: f64, gain: Option<f64>| match gain {
            Some(gain) if gain > 0.0 => level / gain,
            _ => 0.0,
        };
        SensorNoise {
            position: self.position,
            angle: self.angle,
            // A speed that is derived from an angle has that angle's noise.
            speed: match axis.derives_speed() {
                true => 0.0,
                false => per(
                    either(self.command, self.current),
                    axis.control.speed_gain(),
                ),
            },
            current: match axis.actuator.current_gain() {
                gain if self.voltage > 0.0 => per(self.voltage, gain),
                _ => self.current,
            },
        }
    }
}

/// RMS of white noise with the level of the upper half of a channel's bins.
pub fn upper_level(set: &LogSet, rest: &Rest, channel: usize) -> f64 {
    let sizes: Vec<(usize, f64)> = set.logs.iter().map(|l| (l.log.len(), l.period)).collect();
    let layout = Layout::new(1, &sizes);
    let (mut sum, mut n) = (0.0, 0usize);
    for (log, series) in rest.iter().enumerate() {
        let bins = layout.transform(log, &series[channel..=channel], &[false]);
        for value in &bins[bins.len() / 2..] {
            sum += value.norm_sqr();
            n += 1;
        }
    }
    (sum / n.max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::heard;

    /// Of two channels and two bands.
    #[test]
    fn what_rounding_makes_of_a_sensors_noise_is_not_heard() {
        let observed = vec![vec![1.0, 2.0], vec![4e-8, 1e-8]];
        let sensor = vec![vec![0.0, 1e-12], vec![1e-9, 0.0]];
        let dust = vec![vec![1e-30, 1e-28], vec![0.0, 1e-31]];
        let all = heard(vec![sensor.clone(), dust], &observed);
        assert_eq!(all, [sensor, vec![vec![0.0; 2]; 2]]);
    }
}
